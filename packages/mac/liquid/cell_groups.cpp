#include "mac/liquid/cell_groups.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/disjoint_sets.hpp"

namespace lockstep {

namespace {
/// Joins the members of this rank; lists the pairs of an owned cell and a ghost.
template <int dim>
void join_members(const TiledGrid<dim>& grid, const SolidCells<dim>& solids,
                  const std::vector<char>& is_member, DisjointSets& sets,
                  std::vector<std::pair<int, int>>& across) {
  grid.for_each_owned_cell_with_neighbors([&](int cell, const auto& neighbors) {
    if (!is_member[cell] || !solids.is_fluid(cell))
      return;
    for (int i = 0; i < 2 * dim; ++i) {
      const int other = neighbors[i];
      if (other < 0 || !is_member[other] || (i % 2 == 1 && grid.owned(other)) ||
          !solids.is_fluid(other))
        continue;
      const int face = i % 2 == 0 ? cell : other;
      if (!solids.blocked.empty() && (solids.blocked[face] >> (i / 2) & 1))
        continue;
      if (grid.owned(other))
        sets.join(cell, other);
      else
        across.emplace_back(cell, other);
    }
  });
}

using Labels = std::vector<GlobalIndex>;

/// Smallest lattice number of the members joined here, of each owned member.
template <int dim>
Labels label_members(const TiledGrid<dim>& grid, const SolidCells<dim>& solids,
                     const std::vector<char>& is_member, DisjointSets& sets, Labels& all) {
  Labels label(grid.n_stored_cells(), no_index);
  const auto for_each_member = [&](const auto& f) {
    grid.for_each_owned_cell([&](int cell) {
      if (is_member[cell] && solids.is_fluid(cell))
        f(cell, sets.root(cell));
    });
  };
  int last_root = -1, last_cell = -1;
  for_each_member([&](int cell, int root) {
    // Numbers grow along a row.
    const bool goes_on = root == last_root && cell == last_cell + 1 && cell % tile_width<dim> > 0;
    last_root = root;
    last_cell = cell;
    if (goes_on)
      return;
    const GlobalIndex id = grid.global_id(cell);
    label[root] = label[root] == no_index ? id : std::min(label[root], id);
  });
  for_each_member([&](int cell, int root) {
    label[cell] = label[root];
    if (root == cell)
      all.push_back(label[cell]);
  });
  return label;
}

void make_unique(std::vector<std::pair<GlobalIndex, GlobalIndex>>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}
}  // namespace

template <int dim>
CellGroups find_groups(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                       const std::vector<char>& is_member) {
  const TiledGrid<dim>& grid = domain.grid;
  DisjointSets here(grid.n_owned_cells());
  std::vector<std::pair<int, int>> across;
  join_members(grid, solids, is_member, here, across);
  Labels mine;
  Labels label = label_members(grid, solids, is_member, here, mine);
  domain.halo.fill(label);

  // The groups of all ranks are few; what joins them is shared by all.
  std::vector<std::pair<GlobalIndex, GlobalIndex>> joined;
  for (const auto& [cell, other] : across)
    joined.emplace_back(label[cell], label[other]);
  make_unique(joined);
  Labels pairs;
  for (const auto& [a, b] : joined)
    pairs.insert(pairs.end(), {a, b});
  Labels labels = gather_all(grid.comm(), mine);
  pairs = gather_all(grid.comm(), pairs);
  std::sort(labels.begin(), labels.end());
  const auto position = [&](GlobalIndex wanted) {
    return static_cast<int>(std::lower_bound(labels.begin(), labels.end(), wanted) -
                            labels.begin());
  };
  DisjointSets all(static_cast<int>(labels.size()));
  for (std::size_t i = 0; i < pairs.size(); i += 2)
    all.join(position(pairs[i]), position(pairs[i + 1]));

  CellGroups groups;
  std::vector<int> number(labels.size());
  for (int i = 0; i < static_cast<int>(labels.size()); ++i) {
    const int root = all.root(i);
    number[i] = root == i ? groups.n++ : number[root];
  }
  groups.of_cell.assign(grid.n_stored_cells(), -1);
  GlobalIndex last_label = no_index;
  int last_number = -1;
  for (int cell = 0; cell < grid.n_stored_cells(); ++cell) {
    if (label[cell] == no_index)
      continue;
    if (label[cell] != last_label) {
      last_label = label[cell];
      last_number = number[position(last_label)];
    }
    groups.of_cell[cell] = last_number;
  }
  return groups;
}

template <int dim>
void spread_labels(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                   const CellField& phi, int layers, std::vector<int>& label) {
  const TiledGrid<dim>& grid = domain.grid;
  const double deepest = (layers + 1) * domain.spacing();
  std::vector<int> waiting;
  grid.for_each_owned_cell([&](int cell) {
    if (label[cell] < 0 && std::abs(phi[cell]) < deepest && solids.is_fluid(cell))
      waiting.push_back(cell);
  });
  const auto neighbor_label = [&](int cell) {
    for (int i = 0; i < 2 * dim; ++i) {
      const int other = solids.seen_neighbor(grid, cell, i / 2, i % 2);
      if (other >= 0 && label[other] >= 0)
        return label[other];
    }
    return -1;
  };
  std::vector<int> still_waiting;
  std::vector<std::pair<int, int>> found;
  for (int layer = 0; layer < layers; ++layer) {
    still_waiting.clear();
    found.clear();
    for (const int cell : waiting) {
      const int label_there = neighbor_label(cell);
      if (label_there >= 0)
        found.emplace_back(cell, label_there);
      else
        still_waiting.push_back(cell);
    }
    for (const auto& [cell, value] : found)
      label[cell] = value;
    waiting.swap(still_waiting);
    domain.halo.fill(label);
  }
}

template void spread_labels<2>(const MacDomain<2>&, const SolidCells<2>&, const CellField&, int,
                               std::vector<int>&);
template void spread_labels<3>(const MacDomain<3>&, const SolidCells<3>&, const CellField&, int,
                               std::vector<int>&);
template CellGroups find_groups<2>(const MacDomain<2>&, const SolidCells<2>&,
                                   const std::vector<char>&);
template CellGroups find_groups<3>(const MacDomain<3>&, const SolidCells<3>&,
                                   const std::vector<char>&);

}  // namespace lockstep
