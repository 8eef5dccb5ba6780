#include "deformable/volume_sweep.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <map>

namespace lockstep {
namespace {

template <int dim>
using Corners = std::array<Point<dim>, dim>;

template <int dim>
Point<dim> mean_of(const Corners<dim>& corners) {
  Point<dim> mean = Point<dim>::Zero();
  for (const Point<dim>& corner : corners)
    mean += corner / dim;
  return mean;
}

template <int dim>
Corners<dim> advanced(Corners<dim> corners, const Corners<dim>& step, double share) {
  for (int k = 0; k < dim; ++k)
    corners[k] += share * step[k];
  return corners;
}

/// Volume that a simplex sweeps along its normal when its corners take straight steps: its area
/// vector is of second order in the time, so that Simpson's rule is exact.
template <int dim>
double swept(const Corners<dim>& corners, const Corners<dim>& step) {
  const Point<dim> area = area_vector<dim>(corners) +
                          4 * area_vector<dim>(advanced<dim>(corners, step, 0.5)) +
                          area_vector<dim>(advanced<dim>(corners, step, 1));
  return area.dot(mean_of<dim>(step)) / 6;
}

}  // namespace

/// A shell ends at sides that one simplex alone has.
template <int dim>
VolumeSweep<dim>::VolumeSweep(const BodyNodes<dim>& nodes, const NodalSurface<dim>& surface,
                              const std::vector<SolidState<dim>>& states, const BodyTurn<dim>& turn)
    : nodes_(nodes), surface_(surface), states_(states), turn_(turn) {
  const SurfaceMesh<dim>& mesh = surface.mesh();
  std::vector<char> is_boundary(nodes_.n_owned(), 0);
  for (const SolidDescription& solid : surface.solids()) {
    if (solid.closed)
      continue;
    std::map<std::vector<int>, int> sides;  // sides of simplices, by their vertices
    for (int s = solid.simplex_begin; s < solid.simplex_end; ++s) {
      for (int k = 0; k < dim; ++k) {
        std::vector<int> side(mesh.simplices[s].begin(), mesh.simplices[s].end());
        side.erase(side.begin() + k);
        std::sort(side.begin(), side.end());
        ++sides[side];
      }
    }
    for (const auto& [side, n] : sides) {
      for (const int v : side) {
        if (const int node = surface.own_node(v); n == 1 && node >= 0)
          is_boundary[node] = 1;
      }
    }
  }
  for (int i = 0; i < nodes_.n_owned(); ++i) {
    if (is_boundary[i])
      boundary_nodes_.push_back(i);
  }
}

/// Per solid: does a shell end at nodes that are not held?
template <int dim>
std::vector<char> VolumeSweep<dim>::free_boundary_nodes() const {
  const auto& solids = surface_.solids();
  std::vector<int> n_held(nodes_.n_owned(), 0);  // axes
  for (const int dof : nodes_.held.dofs())
    ++n_held[dof / dim];
  std::vector<double> n_free(solids.size(), 0);
  for (const int node : boundary_nodes_) {
    if (n_held[node] < dim)
      ++n_free[nodes_.body_of[node]];
  }
  sum_all(nodes_.comm, n_free.data(), static_cast<int>(n_free.size()));
  std::vector<char> result(solids.size(), 0);
  for (std::size_t b = 0; b < solids.size(); ++b)
    result[b] = n_free[b] > 0;
  return result;
}

template <int dim>
std::vector<char> VolumeSweep<dim>::can_sweep(const Box<dim>& domain) const {
  const SurfaceMesh<dim>& mesh = surface_.mesh();
  const auto& solids = surface_.solids();
  std::vector<double> attached(nodes_.bodies.size(), 0);
  std::vector<char> on_surface;
  if (!nodes_.attached.empty()) {
    on_surface.assign(nodes_.n_owned(), 0);
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      if (const int node = surface_.own_node(static_cast<int>(v)); node >= 0)
        on_surface[node] = 1;
    }
  }
  for (const auto& [node, carrier] : nodes_.attached) {
    const int b = nodes_.body_of[node];
    if (!solids[b].closed || on_surface[node] != 0)
      attached[b] = 1;
  }
  sum_all(nodes_.comm, attached.data(), static_cast<int>(attached.size()));
  const bool any_shell =
      std::any_of(solids.begin(), solids.end(), [](const auto& solid) { return !solid.closed; });
  std::vector<char> has_free_boundary(solids.size(), 0);
  if (any_shell)
    has_free_boundary = free_boundary_nodes();
  const Point<dim> margin = 1e-6 * domain.sizes();  // a rim on the floor is inside
  const Box<dim> reach(domain.min() - margin, domain.max() + margin);
  std::vector<char> can(solids.size());
  for (std::size_t b = 0; b < can.size(); ++b) {
    can[b] = attached[b] == 0 && !has_free_boundary[b] && !turn_.is_turning(static_cast<int>(b));
    for (int v = solids[b].vertex_begin; v < solids[b].vertex_end; ++v)
      can[b] = can[b] && reach.contains(mesh.vertices[v]);
  }
  return can;
}

/// Returns for each vertex its share of the area vectors around it.
template <int dim>
std::vector<Point<dim>> VolumeSweep<dim>::area_shares() const {
  const SurfaceMesh<dim>& mesh = surface_.mesh();
  Nodes shares(mesh.vertices.size(), Point<dim>::Zero());
  for (std::size_t s = 0; s < mesh.simplices.size(); ++s) {
    const Point<dim> area =
        area_vector<dim>(surface_.corners(static_cast<int>(s), mesh.vertices)) / dim;
    for (const int v : mesh.simplices[s])
      shares[v] += area;
  }
  return shares;
}

template <int dim>
RCP<const Vector> VolumeSweep<dim>::swept_per_velocity() const {
  Nodes mine(nodes_.n_owned(), Point<dim>::Zero());
  const Nodes shares = area_shares();
  for (std::size_t v = 0; v < shares.size(); ++v) {
    if (const int node = surface_.own_node(static_cast<int>(v)); node >= 0)
      mine[node] = shares[v];
  }
  return nodes_.space.vector(mine);
}

/// The directions [any] in which owned nodes go to sweep volume: in bodies away from their centre
/// of mass, so that they are strained evenly; in shells along the normal. Both keep the centre of
/// mass and turn nothing. Held dofs and attached nodes stay.
template <int dim>
std::vector<Point<dim>> VolumeSweep<dim>::swelling() const {
  const SurfaceMesh<dim>& mesh = surface_.mesh();
  Nodes direction(nodes_.n_owned(), Point<dim>::Zero());
  for (int i = 0; i < nodes_.n_owned(); ++i) {
    if (nodes_.body(i).closed)
      direction[i] = nodes_.x[i] - states_[nodes_.body_of[i]].center_of_mass;
  }
  const Nodes shares = area_shares();
  std::vector<double> area(shares.size(), 0);
  for (std::size_t s = 0; s < mesh.simplices.size(); ++s) {
    for (const int v : mesh.simplices[s])
      area[v] +=
          area_vector<dim>(surface_.corners(static_cast<int>(s), mesh.vertices)).norm() / dim;
  }
  for (std::size_t v = 0; v < shares.size(); ++v) {
    const int i = surface_.own_node(static_cast<int>(v));
    if (i >= 0 && !nodes_.body(i).closed && area[v] > 0)
      direction[i] = shares[v] / area[v];
  }
  nodes_.hold(direction);
  return direction;
}

template <int dim>
void VolumeSweep<dim>::sweep(double dt, const std::vector<double>& volumes,
                             Vector& velocity) const {
  if (std::all_of(volumes.begin(), volumes.end(), [](double v) { return std::isnan(v); }))
    return;
  const SurfaceMesh<dim>& mesh = surface_.mesh();
  const auto& solids = surface_.solids();
  const Nodes own_direction = swelling();
  Nodes own_velocity = nodes_.space.owned(velocity);
  const std::vector<Nodes> at_surface = surface_.gather({&own_direction, &own_velocity});
  const Nodes &direction = at_surface[0], &surface_velocity = at_surface[1];
  std::vector<double> speed(solids.size(), 0);  // along the direction, of each solid
  for (std::size_t b = 0; b < solids.size(); ++b) {
    if (std::isnan(volumes[b]))
      continue;
    constexpr int most_iterations = 20;
    double change = 0;
    for (int k = 0; k < most_iterations; ++k) {
      double missing = volumes[b], slope = 0, size = std::abs(volumes[b]);
      for (int s = solids[b].simplex_begin; s < solids[b].simplex_end; ++s) {
        const auto corners = surface_.corners(s, mesh.vertices),
                   along = surface_.corners(s, direction);
        auto step = surface_.corners(s, surface_velocity);
        for (int j = 0; j < dim; ++j)
          step[j] = dt * step[j] + change * along[j];
        const double of_simplex = swept<dim>(corners, step);
        missing -= of_simplex;
        size += std::abs(of_simplex);
        slope += area_vector<dim>(advanced<dim>(corners, step, 1)).dot(mean_of<dim>(along));
      }
      if (!(slope > 0))
        change = 0;  // collapsed: no way to swell
      if (!(slope > 0) || std::abs(missing) <= 1e-15 * size)
        break;
      change += missing / slope;
    }
    speed[b] = change / dt;
  }
  for (int i = 0; i < nodes_.n_owned(); ++i)
    own_velocity[i] += speed[nodes_.body_of[i]] * own_direction[i];
  velocity.update(1, *nodes_.space.vector(own_velocity), 0);
}

template class VolumeSweep<2>;
template class VolumeSweep<3>;

}  // namespace lockstep
