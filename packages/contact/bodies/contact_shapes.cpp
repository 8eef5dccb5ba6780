#include "contact/bodies/contact_shapes.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <algorithm>
#include <iterator>
#include <map>

#include "base/round_off.hpp"
#include "contact/bodies/inverse_mass.hpp"
#include "geometry/simplex_queries.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

constexpr double smooth_cosine = 0.87;  // edges that bend by less than 30 degrees are smooth

template <int dim>
std::array<Point<dim>, dim> corners_of(const SurfaceMesh<dim>& mesh, int simplex) {
  std::array<Point<dim>, dim> corners;
  for (int k = 0; k < dim; ++k)
    corners[k] = mesh.vertices[mesh.simplices[simplex][k]];
  return corners;
}

std::vector<SurfaceEdge> find_edges(const SurfaceMesh<3>& mesh, const SolidDescription& solid) {
  std::map<std::array<int, 2>, SurfaceEdge> edges;
  for (int simplex = solid.simplex_begin; simplex < solid.simplex_end; ++simplex) {
    for (int k = 0; k < 3; ++k) {
      std::array<int, 2> ends{mesh.simplices[simplex][k], mesh.simplices[simplex][(k + 1) % 3]};
      std::sort(ends.begin(), ends.end());
      SurfaceEdge& edge = edges[ends];
      edge.vertices = ends;
      edge.simplices[edge.simplices[0] < 0 ? 0 : 1] = simplex;
    }
  }
  std::vector<SurfaceEdge> all;
  for (const auto& [ends, edge] : edges)
    all.push_back(edge);
  return all;
}

/// Returns the velocity of a row for these velocities of dofs, by id; zero if there are none.
template <int dim>
Point<dim> sum_of(const std::vector<double>& of_dofs, const VelocityRow<dim>& row) {
  Point<dim> sum = Point<dim>::Zero();
  for (std::size_t k = 0; k < row.dofs.size() && !of_dofs.empty(); ++k)
    sum += of_dofs[row.dofs[k]] * row.coefficients[k];
  return sum;
}

bool is_sharp(const SurfaceMesh<3>& mesh, const SurfaceEdge& edge) {
  if (edge.simplices[1] < 0)
    return true;
  const Point<3> one = area_vector<3>(corners_of(mesh, edge.simplices[0])).normalized();
  const Point<3> other = area_vector<3>(corners_of(mesh, edge.simplices[1])).normalized();
  return one.dot(other) <= smooth_cosine;
}

}  // namespace

template <int dim>
ContactTopology<dim>::ContactTopology(const SurfaceMesh<dim>& mesh,
                                      const std::vector<SolidDescription>& solids)
    : simplices_(mesh.simplices), begin_(mesh.vertices.size() + 1, 0) {
  for (const auto& simplex : simplices_) {
    for (int vertex : simplex)
      ++begin_[vertex + 1];
  }
  for (std::size_t v = 1; v < begin_.size(); ++v)
    begin_[v] += begin_[v - 1];
  around_.resize(begin_.back());
  std::vector<int> next = begin_;
  for (int s = 0; s < static_cast<int>(simplices_.size()); ++s) {
    for (int vertex : simplices_[s])
      around_[next[vertex]++] = s;
  }
  edges_.resize(solids.size());
  sharp_edges_.resize(solids.size());
  orders_.resize(solids.size());
  if constexpr (dim == 3) {
    for (std::size_t i = 0; i < solids.size(); ++i) {
      edges_[i] = find_edges(mesh, solids[i]);
      std::copy_if(edges_[i].begin(), edges_[i].end(), std::back_inserter(sharp_edges_[i]),
                   [&mesh](const SurfaceEdge& edge) { return is_sharp(mesh, edge); });
    }
  }
}

template <int dim>
bool ContactTopology<dim>::connected(int vertex, int other) const {
  return std::any_of(begin(vertex), end(vertex), [this, other](int s) {
    return std::find(simplices_[s].begin(), simplices_[s].end(), other) != simplices_[s].end();
  });
}

template <int dim>
ContactShapes<dim>::ContactShapes(const SolidSystem<dim>& system, ContactTopology<dim>& topology)
    : system_(system), topology_(&topology), mesh_(system.surface()) {
  add_images();
  if (!topology.belongs_to(mesh_))
    topology = ContactTopology<dim>(mesh_, solids());
  solid_bounds_.resize(n_solids());
  bounds_.resize(mesh_.simplices.size());
  for (int i = 0; i < n_solids(); ++i) {
    for (int s = solids()[i].simplex_begin; s < solids()[i].simplex_end; ++s) {
      for (int vertex : mesh_.simplices[s])
        bounds_[s].extend(mesh_.vertices[vertex]);
      solid_bounds_[i].extend(bounds_[s]);
    }
  }
  find_combinations();
  find_carriers();
  find_held();
}

template <int dim>
void ContactShapes<dim>::add_images() {
  images_ = contact_images(system_, mesh_);
  if (images_.empty())
    return;
  with_images_ = system_.solids();
  for (const auto& image : images_)
    with_images_.push_back(append_copy<dim>(with_images_[image.solid], image.shift, mesh_));
}

template <int dim>
bool ContactShapes<dim>::may_meet(int solid, int other) const {
  if (!is_image(solid) && !is_image(other))
    return true;
  if (is_image(solid) && is_image(other))
    return false;
  const int own = is_image(solid) ? other : solid,
            repeated = source(is_image(solid) ? solid : other);
  return own < repeated || (own > repeated && !system_.repeated().includes(own));
}

template <int dim>
SurfacePoint<dim> ContactShapes<dim>::known_to_system(SurfacePoint<dim> point) const {
  if (images_.empty() || point.simplex < system_.solids().back().simplex_end)
    return point;
  const auto last = std::upper_bound(
      with_images_.begin(), with_images_.end(), point.simplex,
      [](int simplex, const SolidDescription& solid) { return simplex < solid.simplex_end; });
  const int solid = source(static_cast<int>(last - with_images_.begin()));
  point.simplex += with_images_[solid].simplex_begin - last->simplex_begin;
  return point;
}

/// Contacts are the same on all ranks, so all know all combinations.
template <int dim>
void ContactShapes<dim>::find_combinations() {
  const Reduction& reduction = system_.reduction();
  if (!reduction.has_combinations())
    return;
  std::vector<double> mine;
  const Map& rows = *system_.map();
  for_each_entry(*reduction.combinations(), [&](int row, GlobalIndex dof, double weight) {
    mine.insert(mine.end(), {double(rows.getGlobalElement(row)), double(dof), weight});
  });
  const std::vector<double> all = gather_all(system_.comm(), mine);
  for (std::size_t k = 0; k + 2 < all.size(); k += 3)
    combinations_[static_cast<GlobalIndex>(all[k])].emplace_back(
        static_cast<GlobalIndex>(all[k + 1]), all[k + 2]);
}

/// Finds the carriers of attached nodes, so that all ranks know them.
template <int dim>
void ContactShapes<dim>::find_carriers() {
  if (!system_.reduction().has_combinations())
    return;
  std::vector<double> mine;
  for (const AttachedNode<dim>& node : system_.attached())
    mine.insert(mine.end(), {double(node.dofs[0]), double(node.solid)});
  const std::vector<double> all = gather_all(system_.comm(), mine);
  if (all.empty())
    return;
  std::unordered_map<GlobalIndex, int> carrier_of;
  for (std::size_t k = 0; k + 1 < all.size(); k += 2)
    carrier_of.emplace(static_cast<GlobalIndex>(all[k]), static_cast<int>(all[k + 1]));
  carriers_.assign(mesh_.vertices.size(), -1);
  VelocityRow<dim> row;
  for (const SolidDescription& solid : solids()) {
    if (solid.rigid || solid.prescribed)
      continue;
    for (int v = solid.vertex_begin; v < solid.vertex_end; ++v) {
      const SurfacePoint<dim> point = at_vertex(v);
      if (point.simplex < 0)
        continue;
      system_.velocity_row(point, point.position, row);
      for (std::size_t k = 0; k < row.dofs.size(); ++k) {
        const auto found = carrier_of.find(row.dofs[k]);
        if (found != carrier_of.end() && !row.coefficients[k].isZero(0))
          carriers_[v] = found->second;
      }
    }
  }
}

template <int dim>
bool ContactShapes<dim>::hangs_on(int vertex, int solid) const {
  if (carriers_.empty())
    return false;
  return std::any_of(topology_->begin(vertex), topology_->end(vertex), [&](int s) {
    const auto& corners = mesh_.simplices[s];
    return std::any_of(corners.begin(), corners.end(),
                       [&](int corner) { return carriers_[corner] == solid; });
  });
}

template <int dim>
bool ContactShapes<dim>::hangs_on(const SurfacePoint<dim>& point, int solid) const {
  for (int k = 0; k < dim && !carriers_.empty(); ++k) {
    if (point.barycentric[k] != 0 && hangs_on(mesh_.simplices[point.simplex][k], solid))
      return true;
  }
  return false;
}

template <int dim>
void ContactShapes<dim>::velocity_row(const SurfacePoint<dim>& point, const Point<dim>& x,
                                      VelocityRow<dim>& row) const {
  system_.velocity_row(known_to_system(point), x, row);
  resolve(row);
}

template <int dim>
Point<dim> ContactShapes<dim>::rigid_velocity(int solid, const Point<dim>& x,
                                              const std::vector<double>& velocity) const {
  VelocityRow<dim> row;
  system_.rigid_row(source(solid), x, row);
  const Point<dim> error = sum_of<dim>(constraint_error_, row);
  resolve(row);
  return error + sum_of<dim>(velocity, row);
}

template <int dim>
void ContactShapes<dim>::rigid_row(int solid, const Point<dim>& x, VelocityRow<dim>& row) const {
  system_.rigid_row(source(solid), x, row);
  resolve(row);
}

template <int dim>
std::vector<GlobalIndex> ContactShapes<dim>::rigid_dofs(int solid) const {
  VelocityRow<dim> row;
  rigid_row(solid, Point<dim>::Zero(), row);
  return row.dofs;
}

/// Dofs that are combinations are replaced by what they are made of.
template <int dim>
void ContactShapes<dim>::resolve(VelocityRow<dim>& row) const {
  if (combinations_.empty())
    return;
  VelocityRow<dim> reduced;
  for (std::size_t k = 0; k < row.dofs.size(); ++k) {
    const auto combination = combinations_.find(row.dofs[k]);
    if (combination == combinations_.end()) {
      reduced.dofs.push_back(row.dofs[k]);
      reduced.coefficients.push_back(row.coefficients[k]);
      continue;
    }
    for (const auto& [dof, weight] : combination->second) {
      reduced.dofs.push_back(dof);
      reduced.coefficients.push_back(weight * row.coefficients[k]);
    }
  }
  row = std::move(reduced);
}

template <int dim>
std::vector<std::pair<GlobalIndex, double>> ContactShapes<dim>::resolved(
    const std::vector<std::pair<GlobalIndex, double>>& terms) const {
  std::vector<std::pair<GlobalIndex, double>> all;
  for (const auto& [dof, weight] : terms) {
    const auto combination = combinations_.find(dof);
    if (combination == combinations_.end())
      all.emplace_back(dof, weight);
    else
      for (const auto& [inner, part] : combination->second)
        all.emplace_back(inner, weight * part);
  }
  return all;
}

template <int dim>
std::vector<GlobalIndex> ContactShapes<dim>::leading_dofs() const {
  std::vector<GlobalIndex> dofs;
  for (const auto& [dof, terms] : combinations_) {
    for (const auto& [other, weight] : terms)
      dofs.push_back(other);
  }
  return dofs;
}

template <int dim>
Point<dim> ContactShapes<dim>::velocity_by(const std::vector<double>& of_dofs,
                                           const SurfacePoint<dim>& point,
                                           const Point<dim>& x) const {
  if (of_dofs.empty())
    return Point<dim>::Zero();
  VelocityRow<dim> row;
  system_.velocity_row(known_to_system(point), x, row);
  return sum_of<dim>(of_dofs, row);
}

template <int dim>
void ContactShapes<dim>::find_held() {
  held_.assign(mesh_.vertices.size(), false);
  std::vector<double> free;
  if (system_.reduction().has_given())
    free = replicated(system_, *system_.reduction().unknowns());
  VelocityRow<dim> row;
  for (int i = 0; i < n_solids(); ++i) {
    if (solids()[i].prescribed)
      std::fill(held_.begin() + solids()[i].vertex_begin, held_.begin() + solids()[i].vertex_end,
                true);
    if (solids()[i].prescribed || solids()[i].rigid || free.empty())
      continue;
    for (int v = solids()[i].vertex_begin; v < solids()[i].vertex_end; ++v) {
      const SurfacePoint<dim> point = at_vertex(v);
      if (point.simplex < 0)
        continue;
      velocity_row(point, point.position, row);
      held_[v] = std::all_of(row.dofs.begin(), row.dofs.end(),
                             [&free](GlobalIndex dof) { return free[dof] == 0; });
    }
  }
}

template <int dim>
std::array<Point<dim>, dim> ContactShapes<dim>::corners(int simplex) const {
  return corners_of(mesh_, simplex);
}

template <int dim>
Point<dim> ContactShapes<dim>::normal(int simplex) const {
  return area_vector<dim>(corners(simplex)).normalized();
}

template <int dim>
Point<dim> ContactShapes<dim>::vertex_normal(int vertex) const {
  Point<dim> sum = Point<dim>::Zero();
  for (const int* s = topology_->begin(vertex); s != topology_->end(vertex); ++s)
    sum += area_vector<dim>(corners(*s));
  return sum.normalized();
}

template <int dim>
std::optional<Point<dim>> ContactShapes<dim>::smooth_normal(const SurfacePoint<dim>& point) const {
  Point<dim> sum = Point<dim>::Zero();
  for (int k = 0; k < dim; ++k) {
    const int vertex = mesh_.simplices[point.simplex][k];
    const Point<dim> around = vertex_normal(vertex);
    for (const int* s = topology_->begin(vertex); s != topology_->end(vertex); ++s) {
      if (normal(*s).dot(around) < smooth_cosine)
        return {};
    }
    sum += point.barycentric[k] * around;
  }
  return sum.normalized();
}

template <int dim>
SurfacePoint<dim> ContactShapes<dim>::at_vertex(int vertex) const {
  SurfacePoint<dim> point;
  point.position = mesh_.vertices[vertex];
  if (topology_->begin(vertex) == topology_->end(vertex))
    return point;
  point.simplex = *topology_->begin(vertex);
  const auto& simplex = mesh_.simplices[point.simplex];
  point.barycentric[std::find(simplex.begin(), simplex.end(), vertex) - simplex.begin()] = 1;
  return point;
}

template <int dim>
template <typename ForEach>
bool ContactShapes<dim>::inside_of(const ForEach& for_each_simplex, const Point<dim>& x,
                                   double radius) const {
  const double tie = rounding::differences * radius;
  double nearest = radius, alignment = 0;
  for_each_simplex([&](int s) {
    if (bounds_[s].squaredExteriorDistance(x) > nearest * nearest)
      return;
    const auto closest = closest_on_simplex<dim>(corners(s), x);
    if (closest.distance > nearest + tie)
      return;
    // Among the simplices that share the closest point, the one that faces x decides.
    const double facing = normal(s).dot(x - closest.position);
    if (closest.distance < nearest - tie || std::abs(facing) > std::abs(alignment))
      alignment = facing;
    nearest = std::min(nearest, closest.distance);
  });
  return alignment < 0;
}

template <int dim>
bool ContactShapes<dim>::inside(int solid, const Point<dim>& x, double radius) const {
  const auto all = [this, solid](const auto& look) {
    for (int s = solids()[solid].simplex_begin; s < solids()[solid].simplex_end; ++s)
      look(s);
  };
  return inside_of(all, x, radius);
}

template <int dim>
bool ContactShapes<dim>::inside(const std::vector<int>& simplices, const Point<dim>& x,
                                double radius) const {
  return inside_of(
      [&simplices](const auto& look) { std::for_each(simplices.begin(), simplices.end(), look); },
      x, radius);
}

template class ContactTopology<2>;
template class ContactTopology<3>;
template class ContactShapes<2>;
template class ContactShapes<3>;

}  // namespace lockstep
