#include "deformable/strain_limit.hpp"

#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <set>

namespace lockstep {

namespace {

/// The first colour that no neighbour has, edge by edge in the order given.
std::vector<int> greedy_colors(const std::vector<LimitedEdge>& edges) {
  int n_nodes = 0;
  for (const LimitedEdge& edge : edges)
    n_nodes = std::max({n_nodes, edge.corners[0] + 1, edge.corners[1] + 1});
  std::vector<std::set<int>> taken(n_nodes);
  std::vector<int> colors;
  for (const LimitedEdge& edge : edges) {
    auto &a = taken[edge.corners[0]], &b = taken[edge.corners[1]];
    int color = 0;
    while (a.count(color) > 0 || b.count(color) > 0)
      ++color;
    a.insert(color);
    b.insert(color);
    colors.push_back(color);
  }
  return colors;
}

}  // namespace

template <int dim>
std::vector<LimitedEdge> limited_edges(const std::vector<Point<dim>>& vertices,
                                       const std::vector<std::array<int, dim>>& simplices,
                                       double mesh_stretch, double stretch) {
  std::set<std::array<int, 2>> ends;
  for (const auto& simplex : simplices) {
    for (int k = 0; k < (dim == 2 ? 1 : 3); ++k) {
      const int a = simplex[k], b = simplex[(k + 1) % dim];
      ends.insert({std::min(a, b), std::max(a, b)});
    }
  }
  std::vector<LimitedEdge> edges;
  for (const auto& [a, b] : ends) {
    const double rest = (vertices[b] - vertices[a]).norm() / mesh_stretch;
    edges.push_back({{a, b}, (1 + stretch) * rest});
  }
  return edges;
}

template <int dim>
StrainLimit<dim>::StrainLimit(const std::vector<LimitedEdge>& edges, const NodeSpace<dim>& space,
                              int rank) {
  const std::vector<int> colors = greedy_colors(edges);
  const auto& numbers = space.numbers();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    colors_.resize(std::max<std::size_t>(colors_.size(), colors[e] + 1));
    const auto [a, b] = edges[e].corners;
    if (numbers.rank[a] == rank || numbers.rank[b] == rank)
      colors_[colors[e]].edges.push_back({{numbers.local[a], numbers.local[b]}, edges[e].longest});
  }
  if (space.dof_map()->getComm()->getSize() == 1)
    return;
  for (std::size_t c = 0; c < colors_.size(); ++c) {
    std::vector<char> is_changed(space.n_local(), 0);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      for (const int corner : edges[e].corners) {
        if (colors[e] == static_cast<int>(c) && numbers.local[corner] >= 0)
          is_changed[numbers.local[corner]] = 1;
      }
    }
    prepare_exchange(colors_[c], is_changed, space);
  }
}

template <int dim>
void StrainLimit<dim>::prepare_exchange(Color& color, const std::vector<char>& is_changed,
                                        const NodeSpace<dim>& space) const {
  std::vector<GlobalIndex> dofs;
  for (int i = 0; i < space.n_local(); ++i) {
    if (!is_changed[i])
      continue;
    (i < space.n_owned() ? color.owned : color.ghosts).push_back(i);
    for (int a = 0; a < dim && i >= space.n_owned(); ++a)
      dofs.push_back(space.global_dof(dim * i + a));
  }
  const auto ghosts =
      rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                  Teuchos::arrayViewFromVector(dofs), 0, space.dof_map()->getComm()));
  color.import = rcp(new Import(space.dof_map(), ghosts));
}

/// The velocities of ghosts from their owners.
template <int dim>
void StrainLimit<dim>::exchange(const Color& color, Vector& sent, Nodes& velocity) const {
  if (color.import.is_null())
    return;
  {
    const auto values = sent.getDataNonConst();
    for (const int i : color.owned)
      Eigen::Map<Point<dim>>(values.getRawPtr() + dim * i) = velocity[i];
  }
  Vector received(color.import->getTargetMap());
  received.doImport(sent, *color.import, Tpetra::INSERT);
  const auto values = received.getData();
  for (std::size_t k = 0; k < color.ghosts.size(); ++k)
    velocity[color.ghosts[k]] = Eigen::Map<const Point<dim>>(values.getRawPtr() + dim * k);
}

template <int dim>
double StrainLimit<dim>::sweep(const std::vector<LimitedEdge>& edges, const Nodes& x,
                               const Nodes& inverse_mass, double dt, Nodes& velocity,
                               Nodes& impulse) const {
  double worst = 0;
  for (const LimitedEdge& edge : edges) {
    const auto [a, b] = edge.corners;
    const Point<dim> span = x[b] - x[a] + dt * (velocity[b] - velocity[a]);
    const double length = span.norm(), excess = length - edge.longest;
    if (excess <= 0)
      continue;
    worst = std::max(worst, excess / edge.longest);
    const Point<dim> direction = span / length;
    const double mobility = direction.cwiseAbs2().dot(inverse_mass[a] + inverse_mass[b]);
    if (mobility == 0)
      continue;
    const Point<dim> pull = excess / (dt * mobility) * direction;
    velocity[a] += inverse_mass[a].cwiseProduct(pull);
    velocity[b] -= inverse_mass[b].cwiseProduct(pull);
    impulse[a] += pull;
    impulse[b] -= pull;
  }
  return worst;
}

template <int dim>
double StrainLimit<dim>::apply(const Nodes& x, const Nodes& inverse_mass, double dt,
                               const NodeSpace<dim>& space, Nodes& velocity, Nodes& impulse) const {
  constexpr int most_sweeps = 100;
  constexpr double tolerance = 1e-3;
  double worst = 0;
  Vector sent(space.dof_map());
  for (int s = 0; s < most_sweeps; ++s) {
    worst = 0;
    for (const Color& color : colors_) {
      worst = std::max(worst, sweep(color.edges, x, inverse_mass, dt, velocity, impulse));
      exchange(color, sent, velocity);
    }
    worst = max_all(space.dof_map()->getComm(), worst);
    if (worst <= tolerance)
      break;
  }
  return worst;
}

template std::vector<LimitedEdge> limited_edges<2>(const std::vector<Point<2>>&,
                                                   const std::vector<std::array<int, 2>>&, double,
                                                   double);
template std::vector<LimitedEdge> limited_edges<3>(const std::vector<Point<3>>&,
                                                   const std::vector<std::array<int, 3>>&, double,
                                                   double);
template class StrainLimit<2>;
template class StrainLimit<3>;

}  // namespace lockstep
