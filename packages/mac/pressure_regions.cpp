#include <Tpetra_Map.hpp>
#include <algorithm>
#include <numeric>
#include <utility>

#include "mac/pressure_system.hpp"

namespace lockstep {

namespace {
/// Disjoint sets of 0 .. n-1; the root is the smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(int n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }
  int root(int i) {
    while (parent_[i] != i)
      i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(int i, int j) {
    i = root(i);
    j = root(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<int> parent_;
};

/// What one rank knows of the components in its cells.
struct LocalComponents {
  std::vector<GlobalIndex> label;  ///< of each stored cell: lattice number of the component's first
                                   ///< cell on its rank, or no_index
  std::vector<GlobalIndex> labels;  ///< all labels here
  std::vector<GlobalIndex> fixed;   ///< labels whose pressure level is fixed
  std::vector<std::pair<GlobalIndex, GlobalIndex>> joined;  ///< across ranks
};

template <int dim>
LocalComponents local_components(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry) {
  const TiledGrid<dim>& grid = domain.grid;
  const auto& cells = geometry.state.cells;
  DisjointSets sets(grid.n_owned_cells());
  std::vector<int> fixed_cells;
  std::vector<std::pair<int, int>> across;
  grid.for_each_owned_cell_with_neighbors([&](int cell, const auto& neighbors) {
    if (cells[cell] != CellState::fluid)
      return;
    for (int axis = 0; axis < dim; ++axis)
      for (int end = 0; end < 2; ++end) {
        const int other = neighbors[2 * axis + end];
        const int face = end == 0 ? cell : other;
        if (face < 0 || geometry.open_fraction(axis, face) == 0)
          continue;
        if (other < 0 || cells[other] != CellState::fluid)
          fixed_cells.push_back(cell);
        else if (!grid.owned(other))
          across.emplace_back(cell, other);
        else if (end == 0)
          sets.join(cell, other);
      }
  });

  LocalComponents result;
  result.label.assign(grid.n_stored_cells(), no_index);
  // First the smallest lattice number of each set at its root, then that for all its cells.
  grid.for_each_owned_cell([&](int cell) {
    if (cells[cell] != CellState::fluid)
      return;
    GlobalIndex& label = result.label[sets.root(cell)];
    const GlobalIndex id = grid.global_id(cell);
    label = label == no_index ? id : std::min(label, id);
  });
  grid.for_each_owned_cell([&](int cell) {
    if (cells[cell] != CellState::fluid)
      return;
    const int root = sets.root(cell);
    result.label[cell] = result.label[root];
    if (root == cell)
      result.labels.push_back(result.label[cell]);
  });
  domain.halo.fill(result.label);
  for (const int cell : fixed_cells)
    result.fixed.push_back(result.label[cell]);
  for (const auto& [cell, other] : across)
    result.joined.emplace_back(result.label[cell], result.label[other]);
  std::sort(result.fixed.begin(), result.fixed.end());
  result.fixed.erase(std::unique(result.fixed.begin(), result.fixed.end()), result.fixed.end());
  std::sort(result.joined.begin(), result.joined.end());
  result.joined.erase(std::unique(result.joined.begin(), result.joined.end()), result.joined.end());
  return result;
}
}  // namespace

template <int dim>
PressureRegions find_regions(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry) {
  const TiledGrid<dim>& grid = domain.grid;
  const LocalComponents mine = local_components(domain, geometry);

  // The components of all ranks are few; what joins them is shared by all.
  std::vector<GlobalIndex> labels = gather_all(grid.comm(), mine.labels);
  std::sort(labels.begin(), labels.end());
  const auto position = [&](GlobalIndex label) {
    return static_cast<int>(std::lower_bound(labels.begin(), labels.end(), label) - labels.begin());
  };
  std::vector<GlobalIndex> pairs;
  for (const auto& [a, b] : mine.joined) {
    pairs.push_back(a);
    pairs.push_back(b);
  }
  pairs = gather_all(grid.comm(), pairs);
  DisjointSets sets(static_cast<int>(labels.size()));
  for (std::size_t i = 0; i < pairs.size(); i += 2)
    sets.join(position(pairs[i]), position(pairs[i + 1]));

  PressureRegions regions;
  std::vector<int> region(labels.size());
  for (std::size_t i = 0; i < labels.size(); ++i) {
    const int root = sets.root(static_cast<int>(i));
    region[i] = root == static_cast<int>(i) ? regions.n_regions++ : region[root];
  }
  regions.has_dirichlet.assign(regions.n_regions, 0);
  for (const GlobalIndex label : gather_all(grid.comm(), mine.fixed))
    regions.has_dirichlet[region[position(label)]] = 1;
  regions.of_unknown.reserve(geometry.pressure_map->getNodeNumElements());
  GlobalIndex last_label = no_index;
  int last_region = -1;
  grid.for_each_owned_cell([&](int cell) {
    if (geometry.state.cells[cell] != CellState::fluid)
      return;
    if (mine.label[cell] != last_label) {
      last_label = mine.label[cell];
      last_region = region[position(last_label)];
    }
    regions.of_unknown.push_back(last_region);
  });
  return regions;
}

template PressureRegions find_regions<2>(const MacDomain<2>&, const MacGeometry<2>&);
template PressureRegions find_regions<3>(const MacDomain<3>&, const MacGeometry<3>&);

}  // namespace lockstep
