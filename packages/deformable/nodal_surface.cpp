#include "deformable/nodal_surface.hpp"

#include <algorithm>
#include <numeric>

namespace lockstep {

namespace {

/// Description of a body whose simplices follow those of the solids `before`.
template <int dim>
SolidDescription description_of(const DeformableBody<dim>& body,
                                const std::vector<SolidDescription>& before) {
  SolidDescription solid;
  solid.name = body.name;
  solid.closed = body.closed;
  solid.rigid = false;
  solid.density = body.density;
  solid.restitution = body.restitution;
  solid.friction = body.friction;
  solid.index_in_model = static_cast<int>(before.size());
  solid.simplex_begin = before.empty() ? 0 : before.back().simplex_end;
  solid.simplex_end = solid.simplex_begin + static_cast<int>(body.surface.size());
  return solid;
}

}  // namespace

template <int dim>
NodalSurface<dim>::NodalSurface(const std::vector<DeformableBody<dim>>& bodies,
                                const BodyNodes<dim>& nodes)
    : nodes_(nodes) {
  const auto& numbers = nodes.space.numbers();
  std::vector<int> rank_of_vertex;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    solids_.push_back(description_of(bodies[b], solids_));
    solids_[b].vertex_begin = static_cast<int>(node_.size());
    std::vector<int> vertex(bodies[b].n_nodes(), -1);
    for (auto simplex : bodies[b].surface) {
      for (int& corner : simplex) {
        const int node = corner;
        if (vertex[node] < 0) {
          const int original = nodes.bodies[b].node_begin + node, rank = numbers.rank[original];
          vertex[node] = static_cast<int>(node_.size());
          node_.push_back(numbers.global[original]);
          rank_of_vertex.push_back(rank);
          own_node_.push_back(rank == nodes.comm->getRank() ? numbers.local[original] : -1);
        }
        corner = vertex[node];
      }
      mesh_.simplices.push_back(simplex);
    }
    solids_[b].vertex_end = static_cast<int>(node_.size());
  }
  gathered_.resize(node_.size());
  std::iota(gathered_.begin(), gathered_.end(), 0);
  std::stable_sort(gathered_.begin(), gathered_.end(),
                   [&](int a, int b) { return rank_of_vertex[a] < rank_of_vertex[b]; });
  velocity_.assign(node_.size(), Point<dim>::Zero());
}

template <int dim>
void NodalSurface<dim>::velocity_row(const SurfacePoint<dim>& point, VelocityRow<dim>& row) const {
  row.clear();
  for (int k = 0; k < dim; ++k) {
    if (point.barycentric[k] == 0)
      continue;
    const GlobalIndex node = node_[mesh_.simplices[point.simplex][k]];
    for (int a = 0; a < dim; ++a) {
      row.dofs.push_back(dim * node + a);
      row.coefficients.push_back(point.barycentric[k] * Point<dim>::Unit(a));
    }
  }
}

template <int dim>
Point<dim> NodalSurface<dim>::velocity_at(const SurfacePoint<dim>& point) const {
  Point<dim> sum = Point<dim>::Zero();
  for (int k = 0; k < dim; ++k)
    sum += point.barycentric[k] * velocity_[mesh_.simplices[point.simplex][k]];
  return sum;
}

template <int dim>
void NodalSurface<dim>::move(const Nodes& velocity) {
  std::vector<Nodes> values = gather({&nodes_.x, &velocity});
  mesh_.vertices = std::move(values[0]);
  velocity_ = std::move(values[1]);
}

template <int dim>
void NodalSurface<dim>::place(Nodes velocity) {
  mesh_.vertices = gather({&nodes_.x})[0];
  velocity_ = std::move(velocity);
}

template <int dim>
std::vector<std::vector<Point<dim>>> NodalSurface<dim>::gather(
    std::initializer_list<const Nodes*> of_nodes) const {
  std::vector<double> mine;
  for (const int vertex : gathered_) {
    const int node = own_node_[vertex];
    for (const Nodes* values : of_nodes) {
      if (node >= 0)
        mine.insert(mine.end(), (*values)[node].data(), (*values)[node].data() + dim);
    }
  }
  const std::vector<double> all = gather_all(nodes_.comm, mine);
  std::vector<Nodes> of_vertices(of_nodes.size(), Nodes(node_.size()));
  const double* next = all.data();
  for (const int vertex : gathered_) {
    for (Nodes& values : of_vertices) {
      values[vertex] = Eigen::Map<const Point<dim>>(next);
      next += dim;
    }
  }
  return of_vertices;
}

template <int dim>
std::array<Point<dim>, dim> NodalSurface<dim>::corners(int simplex,
                                                       const Nodes& of_vertices) const {
  std::array<Point<dim>, dim> values;
  for (int k = 0; k < dim; ++k)
    values[k] = of_vertices[mesh_.simplices[simplex][k]];
  return values;
}

template class NodalSurface<2>;
template class NodalSurface<3>;

}  // namespace lockstep
