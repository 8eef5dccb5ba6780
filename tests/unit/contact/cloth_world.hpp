#pragma once
#include "contact_world.hpp"
#include "deformable/deformable_solids.hpp"
#include "deformable/elements/shell_elements.hpp"

namespace lockstep::test {

/// Cloth of a mesh, of surface density one: soft, and flat at rest.
template <int dim>
DeformableBody<dim> cloth(const SurfaceMesh<dim>& mesh, double youngs_modulus = 100) {
  DeformableBody<dim> body;
  const SheetMaterial material{youngs_modulus, 0.3, 0.01, 0.01};
  body.name = "cloth";
  body.closed = false;
  body.density = 1;
  body.integration = TimeIntegration::fully_implicit;
  body.position = mesh.vertices;
  body.velocity.assign(mesh.vertices.size(), Point<dim>::Zero());
  body.force = body.velocity;
  body.locked.resize(mesh.vertices.size());
  for (auto& locked : body.locked)
    locked.fill(false);
  body.surface = mesh.simplices;
  body.elements.push_back(membrane_elements<dim>(mesh, material, 1));
  body.elements.push_back(bending_elements<dim>(mesh, material, true));
  body.mass_elements.n_corners = dim;
  for (const auto& simplex : mesh.simplices) {
    std::array<Point<dim>, dim> corners;
    for (int k = 0; k < dim; ++k)
      corners[k] = mesh.vertices[simplex[k]];
    body.element_measure.push_back(area_vector<dim>(corners).norm());
    body.mass_elements.nodes.insert(body.mass_elements.nodes.end(), simplex.begin(), simplex.end());
  }
  return body;
}

/// A flat square (2D: a line), normal to the last axis.
template <int dim>
DeformableBody<dim> sheet(double size, const Point<dim>& center, double spacing,
                          double youngs_modulus = 100) {
  SurfaceMesh<dim> mesh = plate_surface<dim>(Point<dim>::Constant(size), dim - 1, spacing);
  for (auto& vertex : mesh.vertices)
    vertex += center;
  return cloth<dim>(mesh, youngs_modulus);
}

/// Deformable and rigid bodies without fluid. The deformables come first.
template <int dim>
class ClothWorld {
 public:
  ClothWorld(std::vector<DeformableBody<dim>> cloths, std::vector<RigidBody<dim>> bodies,
             const Point<dim>& gravity, std::vector<HalfSpace> walls = {},
             const GaussSeidelOptions& options = {},
             const Communicator& comm = world_communicator())
      : contact(options, std::move(walls), h) {
    std::vector<std::unique_ptr<SolidModel<dim>>> models;
    models.push_back(
        std::make_unique<DeformableSolids<dim>>("cloth", std::move(cloths), gravity, comm));
    if (!bodies.empty())
      models.push_back(std::make_unique<RigidBodies<dim>>(std::move(bodies), gravity, comm));
    solids = std::make_unique<SolidSystem<dim>>(std::move(models), comm);
  }

  void step(double dt) {
    const auto half = solved(*solids->explicit_momentum(time, dt / 2), dt / 2);
    position_report = contact.resolve(*solids, ContactPhase::position, dt, *half);
    solids->move(*half, time, dt);
    const auto star = solids->velocity_of(*solids->explicit_momentum(time, dt));
    const Momentum<dim> before = momentum_of(*star);
    velocity_report = contact.resolve(*solids, ContactPhase::velocity, dt, *star);
    contact_change = momentum_of(*star) - before;
    const auto momentum = make_vector(solids->map());
    apply(*solids->mass(), *star, *momentum);
    solids->set_velocity(*solved(*momentum, dt));
    time += dt;
  }

  Momentum<dim> momentum_of(const Vector& velocity) const {
    const auto stacked = make_vector(solids->map());
    apply(*solids->mass(), velocity, *stacked);
    return solids->momentum(*stacked);
  }
  SolidState<dim> state(int i) const { return solids->states()[i]; }

  std::unique_ptr<SolidSystem<dim>> solids;
  GaussSeidelContact<dim> contact;
  Momentum<dim> contact_change;  ///< change of the solids' momentum by contact in S2
  ContactReport<dim> position_report, velocity_report;
  double time = 0;

 private:
  /// (M_S - dt D) V = momentum.
  RCP<Vector> solved(const Vector& momentum, double dt) const {
    return solids->velocity_of(momentum, dt, solids->reduction());
  }
};

/// Edges that pass through simplices (2D: segments that cross), of all pairs that share no vertex:
/// by signs of volumes and nothing of what contact uses.
template <int dim>
int n_crossings(const SurfaceMesh<dim>& mesh);

template <>
inline int n_crossings<2>(const SurfaceMesh<2>& mesh) {
  // Round-off on a straight side is no crossing.
  const auto side = [&mesh](int a, int b, int c) {
    const Point<2> u = mesh.vertices[b] - mesh.vertices[a], w = mesh.vertices[c] - mesh.vertices[a];
    const double value = u.x() * w.y() - u.y() * w.x();
    return std::abs(value) > 1e-13 * u.norm() * w.norm() ? value : 0;
  };
  int n = 0;
  for (std::size_t i = 0; i < mesh.simplices.size(); ++i) {
    for (std::size_t j = i + 1; j < mesh.simplices.size(); ++j) {
      const auto [a, b] = mesh.simplices[i];
      const auto [c, d] = mesh.simplices[j];
      if (a == c || a == d || b == c || b == d)
        continue;
      if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0)
        ++n;
    }
  }
  return n;
}

template <>
inline int n_crossings<3>(const SurfaceMesh<3>& mesh) {
  const auto& x = mesh.vertices;
  // Round-off in a flat sheet is no crossing.
  const auto volume = [&x](int a, int b, int c, int d) {
    const Point<3> u = x[b] - x[a], v = x[c] - x[a], w = x[d] - x[a];
    const double value = u.cross(v).dot(w);
    return std::abs(value) > 1e-13 * u.norm() * v.norm() * w.norm() ? value : 0;
  };
  int n = 0;
  for (const auto& edges : mesh.simplices) {
    for (int k = 0; k < 3; ++k) {
      const int p = edges[k], q = edges[(k + 1) % 3];
      const Box<3> box(x[p].cwiseMin(x[q]), x[p].cwiseMax(x[q]));
      for (const auto& [a, b, c] : mesh.simplices) {
        if (p == a || p == b || p == c || q == a || q == b || q == c)
          continue;
        Box<3> other(x[a]);
        other.extend(x[b]);
        other.extend(x[c]);
        if (!box.intersects(other) || volume(a, b, c, p) * volume(a, b, c, q) >= 0)
          continue;
        const double u = volume(p, q, a, b), v = volume(p, q, b, c), w = volume(p, q, c, a);
        if ((u > 0 && v > 0 && w > 0) || (u < 0 && v < 0 && w < 0))
          ++n;
      }
    }
  }
  return n;
}

template <int dim>
int n_crossings(const SolidSystem<dim>& solids) {
  return n_crossings<dim>(solids.snapshot()->mesh());
}

}  // namespace lockstep::test
