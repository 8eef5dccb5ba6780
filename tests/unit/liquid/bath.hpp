#pragma once
#include <algorithm>
#include <cmath>
#include <functional>

#include "liquid/register_interfaces.hpp"
#include "parameters/validate.hpp"
#include "support/world.hpp"

namespace lockstep::test {

/// This rank alone.
inline Communicator self() {
  return Teuchos::rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
}

/// n cells along each side of a cube with open sides, from 0 to `length`.
template <int dim>
DomainDescription<dim> open_cube(int n, double length = 1) {
  DomainDescription<dim> description;
  description.grid.spacing = length / n;
  description.grid.n_cells.fill(n);
  description.grid.store_upper_face.fill(true);
  for (auto& axis : description.boundary.sides)
    for (auto& side : axis)
      side.type = SideType::open;
  return description;
}

/// A cube with walls on all sides.
template <int dim>
DomainDescription<dim> closed_cube(int n) {
  DomainDescription<dim> description;
  description.grid.spacing = 1.0 / n;
  description.grid.n_cells.fill(n);
  return description;
}

/// An interface in a given flow.
template <int dim>
struct Bath {
  using Velocity = std::function<Point<dim>(const Point<dim>&)>;

  explicit Bath(const DomainDescription<dim>& of, const Communicator& comm = world())
      : description(of), domain(of, comm), ray_halo(domain.grid) {
    for (auto& component : velocity)
      component.assign(domain.grid.n_stored_cells(), 0);
    surface.velocity = [](const SurfacePoint<dim>&) { return Point<dim>(Point<dim>::Zero()); };
  }

  std::unique_ptr<InterfaceModel<dim>> make(const std::string& name, ParameterList list = {}) {
    InterfaceRegistry<dim> interfaces{"interface"};
    register_interfaces<dim>(interfaces);
    validate(list, interfaces.valid_parameters(name), Source{"test", {}}, "Free Surface");
    return interfaces.create(name, list, domain);
  }
  void set_velocity(const Velocity& u) {
    for (int a = 0; a < dim; ++a)
      domain.grid.for_each_owned_face(
          a, [&](int c) { velocity[a][c] = u(domain.grid.face_center(a, c))[a]; });
  }
  /// The surface of the next step.
  void move(std::shared_ptr<const SurfaceSnapshot<dim>> before,
            std::shared_ptr<const SurfaceSnapshot<dim>> after, double dt) {
    surface.before = before;
    surface.after = after;
    surface.velocity = [before, after, dt](const SurfacePoint<dim>& point) {
      const auto from = before->corners(point.simplex), to = after->corners(point.simplex);
      Point<dim> u = Point<dim>::Zero();
      for (int k = 0; k < dim; ++k)
        u += point.barycentric[k] * (to[k] - from[k]) / dt;
      return u;
    };
  }
  void step(InterfaceModel<dim>& model, double time, double dt) {
    model.advance(
        {velocity, surface, ray_halo, kept, time, dt, sources, sinks, Point<dim>::Zero(), open});
  }
  /// phi at a point of the interior that this rank owns: multilinear.
  double at(const CellField& phi, const Point<dim>& x) const {
    const double h = domain.spacing();
    Index<dim> base;
    Point<dim> weight;
    for (int a = 0; a < dim; ++a) {
      const double t = (x[a] - domain.grid.lower()[a]) / h - 0.5;
      base[a] = std::clamp(static_cast<int>(std::floor(t)), 0, domain.grid.n_cells()[a] - 2);
      weight[a] = t - base[a];
    }
    double value = 0;
    for (int k = 0; k < 1 << dim; ++k) {
      Index<dim> c = base;
      double w = 1;
      for (int a = 0; a < dim; ++a) {
        c[a] += k >> a & 1;
        w *= (k >> a & 1) ? weight[a] : 1 - weight[a];
      }
      value += w * phi[domain.grid.cell(c)];
    }
    return value;
  }
  struct Areas {
    double liquid = 0,
           wrong = 0;  ///< area of {phi < 0}; area of points whose sign is not that of `exact`
  };
  /// Measures with s^dim samples a cell.
  Areas measure(const CellField& phi, const SignedDistance<dim>& exact, int s = 4) const {
    std::array<double, 2> sum{};
    const double h = domain.spacing();
    domain.grid.for_each_owned_cell([&](int cell) {
      const Point<dim> corner = domain.grid.center(cell) - Point<dim>::Constant(0.5 * h);
      const bool far =
          std::abs(phi[cell]) > 3 * h && std::abs(exact(domain.grid.center(cell))) > 3 * h;
      const int n = far ? 1 : s;
      for (int i = 0, all = static_cast<int>(std::lround(std::pow(n, dim))); i < all; ++i) {
        Point<dim> x = corner;
        for (int a = 0, rest = i; a < dim; ++a, rest /= n)
          x[a] += (rest % n + 0.5) / n * h;
        const bool wet = (far ? phi[cell] : at(phi, x)) < 0;
        sum[0] += wet * std::pow(h / n, dim);
        sum[1] += (wet != (exact(x) < 0)) * std::pow(h / n, dim);
      }
    });
    sum_over_ranks(domain.grid.comm(), sum);
    return {sum[0], sum[1]};
  }

  DomainDescription<dim> description;
  MacDomain<dim> domain;
  RayHalo<dim> ray_halo;
  KeptSurface<dim> kept;
  MovingSurface<dim> surface;
  FaceField<dim> velocity;
  std::vector<SignedDistance<dim>> sources, sinks;
  std::function<double(int axis, int cell)> open;  ///< parts of faces
};

/// One solid, its mesh moved to a place.
template <int dim>
std::shared_ptr<const SurfaceSnapshot<dim>> snapshot(SurfaceMesh<dim> mesh, const Point<dim>& place,
                                                     bool closed) {
  for (Point<dim>& x : mesh.vertices)
    x += place;
  SolidDescription solid;
  solid.closed = closed;
  solid.simplex_end = static_cast<int>(mesh.simplices.size());
  solid.vertex_end = static_cast<int>(mesh.vertices.size());
  return std::make_shared<const SurfaceSnapshot<dim>>(std::move(mesh),
                                                      std::vector<SolidDescription>{solid});
}

/// Turns about the middle of the unit cube, without divergence, faster outside.
template <int dim>
Point<dim> swirl(const Point<dim>& x) {
  Point<dim> u = Point<dim>::Zero();
  u[0] = 0.5 - x[1] + 0.05 * std::sin(2 * pi * x[dim - 1]) * (dim - 2);
  u[1] = x[0] - 0.5;
  return u;
}

template <int dim>
SignedDistance<dim> ball(const Point<dim>& center, double radius) {
  return [=](const Point<dim>& x) { return (x - center).norm() - radius; };
}

}  // namespace lockstep::test
