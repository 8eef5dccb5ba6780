// Volumes swept by surfaces in S1, see VolumeSweeper.
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <map>

#include "deformable/deformable_solids.hpp"

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

template <int dim>
std::array<Point<dim>, dim> DeformableSolids<dim>::of_corners(int simplex,
                                                              const Nodes& of_vertices) const {
  std::array<Point<dim>, dim> corners;
  for (int k = 0; k < dim; ++k)
    corners[k] = of_vertices[surface_.simplices[simplex][k]];
  return corners;
}

/// A shell ends at sides that one simplex alone has.
template <int dim>
void DeformableSolids<dim>::find_boundary_nodes() {
  std::vector<char> is_boundary(space_.n_owned(), 0);
  for (const SolidDescription& solid : solids_) {
    if (solid.closed)
      continue;
    std::map<std::vector<int>, int> sides;  // sides of simplices, by their vertices
    for (int s = solid.simplex_begin; s < solid.simplex_end; ++s) {
      for (int k = 0; k < dim; ++k) {
        std::vector<int> side(surface_.simplices[s].begin(), surface_.simplices[s].end());
        side.erase(side.begin() + k);
        std::sort(side.begin(), side.end());
        ++sides[side];
      }
    }
    for (const auto& [side, n] : sides) {
      for (const int v : side) {
        const GlobalIndex dof = dim * surface_node_[v];
        if (n == 1 && space_.dof_map()->isNodeGlobalElement(dof))
          is_boundary[space_.dof_map()->getLocalElement(dof) / dim] = 1;
      }
    }
  }
  for (int i = 0; i < space_.n_owned(); ++i) {
    if (is_boundary[i])
      boundary_nodes_.push_back(i);
  }
}

/// Per solid: does a shell end at nodes that are not held?
template <int dim>
std::vector<char> DeformableSolids<dim>::free_boundary_nodes() const {
  std::vector<int> n_held(space_.n_owned(), 0);  // axes
  for (const int dof : held_.dofs())
    ++n_held[dof / dim];
  std::vector<char> result(solids_.size(), 0);
  for (const int node : boundary_nodes_) {
    if (n_held[node] < dim)
      result[body_of_node_[node]] = 1;
  }
  max_over_ranks(comm_, result);
  return result;
}

template <int dim>
std::vector<char> DeformableSolids<dim>::can_sweep(const Box<dim>& domain) const {
  std::vector<char> attached(bodies_.size(), 0);
  std::vector<char> on_surface;
  if (!attached_.empty()) {
    on_surface.assign(space_.n_owned(), 0);
    for (const GlobalIndex node : surface_node_) {
      if (space_.dof_map()->isNodeGlobalElement(dim * node))
        on_surface[space_.dof_map()->getLocalElement(dim * node) / dim] = 1;
    }
  }
  for (const auto& [node, carrier] : attached_) {
    const int b = body_of_node_[node];
    if (!solids_[b].closed || on_surface[node] != 0)
      attached[b] = 1;
  }
  max_over_ranks(comm_, attached);
  const bool any_shell =
      std::any_of(solids_.begin(), solids_.end(), [](const auto& solid) { return !solid.closed; });
  std::vector<char> has_free_boundary(solids_.size(), 0);
  if (any_shell)
    has_free_boundary = free_boundary_nodes();
  const Point<dim> margin = 1e-6 * domain.sizes();  // a rim on the floor is inside
  const Box<dim> reach(domain.min() - margin, domain.max() + margin);
  std::vector<char> can(solids_.size());
  for (std::size_t b = 0; b < can.size(); ++b) {
    can[b] = attached[b] == 0 && !has_free_boundary[b];
    for (int v = solids_[b].vertex_begin; v < solids_[b].vertex_end; ++v)
      can[b] = can[b] && reach.contains(surface_.vertices[v]);
  }
  return can;
}

/// Returns for each vertex its share of the area vectors around it.
template <int dim>
std::vector<Point<dim>> DeformableSolids<dim>::area_shares() const {
  Nodes shares(surface_.vertices.size(), Point<dim>::Zero());
  for (std::size_t s = 0; s < surface_.simplices.size(); ++s) {
    const Point<dim> area =
        area_vector<dim>(of_corners(static_cast<int>(s), surface_.vertices)) / dim;
    for (const int v : surface_.simplices[s])
      shares[v] += area;
  }
  return shares;
}

template <int dim>
RCP<const Vector> DeformableSolids<dim>::swept_per_velocity() const {
  Nodes mine(space_.n_owned(), Point<dim>::Zero());
  const Nodes shares = area_shares();
  for (std::size_t v = 0; v < shares.size(); ++v) {
    const GlobalIndex dof = dim * surface_node_[v];
    if (space_.dof_map()->isNodeGlobalElement(dof))
      mine[space_.dof_map()->getLocalElement(dof) / dim] = shares[v];
  }
  return space_.vector(mine);
}

template <int dim>
std::vector<int> DeformableSolids<dim>::solid_of_row() const {
  std::vector<int> solids;
  for (int i = 0; i < space_.n_owned(); ++i)
    solids.insert(solids.end(), dim, body_of_node_[i]);
  return solids;
}

/// The directions [any] in which owned nodes go to sweep volume: in bodies away from their centre
/// of mass, so that they are strained evenly; in shells along the normal. Both keep the centre of
/// mass and turn nothing. Held dofs and attached nodes stay.
template <int dim>
std::vector<Point<dim>> DeformableSolids<dim>::swelling() const {
  Nodes direction(space_.n_owned(), Point<dim>::Zero());
  for (int i = 0; i < space_.n_owned(); ++i) {
    const int b = body_of_node_[i];
    if (solids_[b].closed)
      direction[i] = x_[i] - states_[b].center_of_mass;
  }
  const Nodes shares = area_shares();
  std::vector<double> area(shares.size(), 0);
  for (std::size_t s = 0; s < surface_.simplices.size(); ++s) {
    for (const int v : surface_.simplices[s])
      area[v] += area_vector<dim>(of_corners(static_cast<int>(s), surface_.vertices)).norm() / dim;
  }
  for (std::size_t v = 0; v < shares.size(); ++v) {
    const GlobalIndex dof = dim * surface_node_[v];
    if (!space_.dof_map()->isNodeGlobalElement(dof))
      continue;
    const int i = space_.dof_map()->getLocalElement(dof) / dim;
    if (!solids_[body_of_node_[i]].closed && area[v] > 0)
      direction[i] = shares[v] / area[v];
  }
  for (const int dof : held_.dofs())
    direction[dof / dim][dof % dim] = 0;
  for (const auto& [node, carrier] : attached_)
    direction[node] = Point<dim>::Zero();
  return direction;
}

template <int dim>
void DeformableSolids<dim>::sweep(double dt, const std::vector<double>& volumes,
                                  Vector& velocity) const {
  if (std::all_of(volumes.begin(), volumes.end(), [](double v) { return std::isnan(v); }))
    return;
  const Nodes own_direction = swelling();
  Nodes own_velocity = space_.owned(velocity);
  const std::vector<Nodes> at_surface = surface_values({&own_direction, &own_velocity});
  const Nodes &direction = at_surface[0], &surface_velocity = at_surface[1];
  std::vector<double> speed(solids_.size(), 0);  // along the direction, of each solid
  for (std::size_t b = 0; b < solids_.size(); ++b) {
    if (std::isnan(volumes[b]))
      continue;
    constexpr int most_iterations = 20;
    double change = 0;
    for (int k = 0; k < most_iterations; ++k) {
      double missing = volumes[b], slope = 0, size = std::abs(volumes[b]);
      for (int s = solids_[b].simplex_begin; s < solids_[b].simplex_end; ++s) {
        const auto corners = of_corners(s, surface_.vertices), along = of_corners(s, direction);
        auto step = of_corners(s, surface_velocity);
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
  for (int i = 0; i < space_.n_owned(); ++i)
    own_velocity[i] += speed[body_of_node_[i]] * own_direction[i];
  velocity.update(1, *space_.vector(own_velocity), 0);
}

template std::array<Point<2>, 2> DeformableSolids<2>::of_corners(
    int, const std::vector<Point<2>>&) const;
template void DeformableSolids<2>::find_boundary_nodes();
template std::vector<char> DeformableSolids<2>::free_boundary_nodes() const;
template std::vector<char> DeformableSolids<2>::can_sweep(const Box<2>&) const;
template std::vector<Point<2>> DeformableSolids<2>::area_shares() const;
template RCP<const Vector> DeformableSolids<2>::swept_per_velocity() const;
template std::vector<int> DeformableSolids<2>::solid_of_row() const;
template std::vector<Point<2>> DeformableSolids<2>::swelling() const;
template void DeformableSolids<2>::sweep(double, const std::vector<double>&, Vector&) const;
template std::array<Point<3>, 3> DeformableSolids<3>::of_corners(
    int, const std::vector<Point<3>>&) const;
template void DeformableSolids<3>::find_boundary_nodes();
template std::vector<char> DeformableSolids<3>::free_boundary_nodes() const;
template std::vector<char> DeformableSolids<3>::can_sweep(const Box<3>&) const;
template std::vector<Point<3>> DeformableSolids<3>::area_shares() const;
template RCP<const Vector> DeformableSolids<3>::swept_per_velocity() const;
template std::vector<int> DeformableSolids<3>::solid_of_row() const;
template std::vector<Point<3>> DeformableSolids<3>::swelling() const;
template void DeformableSolids<3>::sweep(double, const std::vector<double>&, Vector&) const;

}  // namespace lockstep
