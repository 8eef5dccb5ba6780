#include "liquid/common/cell_groups.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "grid/strips.hpp"

namespace lockstep {

namespace {
/// Part of a tile's cells that are members.
enum class Membership { none, some, all };

template <int dim>
Membership membership_of(const SolidCells<dim>& solids, const std::vector<char>& is_member,
                         int tile) {
  const int begin = tile * tile_volume<dim>, end = begin + tile_volume<dim>;
  const auto first = is_member.begin() + begin, last = is_member.begin() + end;
  const auto is_one = [](char member) { return member != 0; };
  if (std::none_of(first, last, is_one))
    return Membership::none;
  if (!std::all_of(first, last, is_one))
    return Membership::some;
  for (int row = begin; row < end; row += tile_width<dim>)
    if (!is_row_of<dim>(CellState::fluid, solids.state.cells.data() + row) ||
        (!solids.occluded.empty() && !is_row_of<dim>('\0', solids.occluded.data() + row)))
      return Membership::some;
  return Membership::all;
}

/// Joins the members of this rank, full tiles as a whole.
template <int dim>
class Joiner {
 public:
  Joiner(const TiledGrid<dim>& grid, const SolidCells<dim>& solids,
         const std::vector<char>& is_member)
      : grid_(grid), solids_(solids), is_member_(is_member), sets_(grid.n_owned_cells()) {
    for (int tile = 0; tile < grid.n_owned_tiles(); ++tile)
      members_.push_back(membership_of(solids, is_member, tile));
    for (int tile = 0; tile < grid.n_owned_tiles(); ++tile)
      join_tile(tile);
  }

  bool is_member(int cell) const { return is_member_[cell] && solids_.is_fluid(cell); }
  int root(int cell) { return sets_.root(cell); }
  /// Calls f(cell) for the owned members.
  template <typename Function>
  void for_each_member(const Function& f) const {
    for (int tile = 0; tile < grid_.n_owned_tiles(); ++tile)
      if (members_[tile] != Membership::none)
        for (int cell = tile * tile_volume<dim>; cell < (tile + 1) * tile_volume<dim>; ++cell)
          if (is_member(cell))
            f(cell);
  }
  /// Pairs of an owned cell and a ghost.
  const std::vector<std::pair<int, int>>& across() const { return across_; }

 private:
  void join_tile(int tile) {
    const int begin = tile * tile_volume<dim>;
    if (members_[tile] == Membership::none)
      return;
    if (members_[tile] == Membership::all)
      sets_.join_run(begin, tile_volume<dim>);
    for (int i = 0; i < 2 * dim; ++i)
      if (members_[tile] == Membership::some)
        join_cells(begin, i, [](int) { return true; });
      else
        join_side(tile, i);
  }
  /// Joins a full tile with what is beyond its side i.
  void join_side(int tile, int i) {
    const int shift = log_tile_width<dim> * (i / 2);
    const int layer = i % 2 == 0 ? 0 : tile_width<dim> - 1;
    const int begin = tile * tile_volume<dim>;
    const int other = grid_.neighbor(begin + (layer << shift), i / 2, i % 2);
    if (other < 0 || (i % 2 == 1 && grid_.owned(other)))
      return;
    if (grid_.owned(other) && members_[TiledGrid<dim>::tile_of(other)] == Membership::all)
      sets_.join(begin, other);
    else
      join_cells(begin, i,
                 [&](int offset) { return (offset >> shift & (tile_width<dim> - 1)) == layer; });
  }
  /// Joins the cells of a tile for which `counts` holds with their neighbours there.
  template <typename Function>
  void join_cells(int begin, int i, const Function& counts) {
    for (int cell = begin; cell < begin + tile_volume<dim>; ++cell) {
      if (!counts(cell - begin) || !is_member(cell))
        continue;
      const int other = grid_.neighbor(cell, i / 2, i % 2);
      if (other < 0 || (i % 2 == 1 && grid_.owned(other)) || !is_member(other))
        continue;
      const int face = i % 2 == 0 ? cell : other;
      if (!solids_.occluded.empty() && (solids_.occluded[face] >> (i / 2) & 1))
        continue;
      if (grid_.owned(other))
        sets_.join(cell, other);
      else
        across_.emplace_back(cell, other);
    }
  }

  const TiledGrid<dim>& grid_;
  const SolidCells<dim>& solids_;
  const std::vector<char>& is_member_;
  DisjointSets sets_;
  std::vector<Membership> members_;  ///< members in owned tiles
  std::vector<std::pair<int, int>> across_;
};

/// Numbers groups of some ranks from 0; those that hang together get one number, in the order of
/// the smallest lattice number in each. Returns the number of each, and how many there are.
std::pair<std::vector<int>, int> number_groups(const std::vector<GlobalIndex>& smallest,
                                               const std::vector<GlobalIndex>& pairs) {
  const int n = static_cast<int>(smallest.size());
  std::vector<int> order(n), rank(n), number(n);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) { return smallest[a] < smallest[b]; });
  for (int i = 0; i < n; ++i)
    rank[order[i]] = i;
  DisjointSets sets(n);
  for (std::size_t i = 0; i < pairs.size(); i += 2)
    sets.join(rank[pairs[i]], rank[pairs[i + 1]]);
  int n_groups = 0;
  for (int i = 0; i < n; ++i) {
    const int root = sets.root(i);
    number[order[i]] = root == i ? n_groups++ : number[order[root]];
  }
  return {number, n_groups};
}

/// Beside cells that are not stored, though inside the domain.
template <int dim>
bool at_band_edge(const TiledGrid<dim>& grid, int cell) {
  for (int i = 0; i < 2 * dim; ++i) {
    const int axis = i / 2, last = i % 2 == 0 ? 0 : grid.n_cells()[axis] - 1;
    if (grid.neighbor(cell, axis, i % 2) < 0 &&
        (grid.description().periodic[axis] || grid.coordinates(cell)[axis] != last))
      return true;
  }
  return false;
}

/// All groups at the rim of the cells that are stored become the first of them.
template <int dim>
void join_at_band_edge(const TiledGrid<dim>& grid, CellGroups& groups) {
  std::vector<char> touches(groups.n, 0);
  grid.for_each_owned_cell([&](int cell) {
    const int group = groups.of_cell[cell];
    if (group >= 0 && touches[group] == 0)
      touches[group] = at_band_edge(grid, cell);
  });
  max_over_ranks(grid.comm(), touches);
  int first = 0;
  while (first < groups.n && touches[first] == 0)
    ++first;
  for (int& group : groups.of_cell)
    if (group >= 0 && touches[group] > 0)
      group = first;
}

void make_unique(std::vector<std::pair<int, int>>& pairs) {
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
}
}  // namespace

template <int dim>
CellGroups find_groups(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                       const std::vector<char>& is_member) {
  const TiledGrid<dim>& grid = domain.grid;
  Joiner<dim> joiner(grid, solids, is_member);
  CellGroups groups;
  groups.of_cell.assign(grid.n_stored_cells(), -1);
  std::vector<int>& of_cell = groups.of_cell;
  // First by the groups of this rank; a root comes before the others of its set.
  std::vector<GlobalIndex> smallest;
  int n_before = 0;
  joiner.for_each_member([&](int cell) {
    const int root = joiner.root(cell);
    if (root == cell) {
      of_cell[cell] = static_cast<int>(smallest.size());
      smallest.push_back(grid.global_id(cell));
      return;
    }
    of_cell[cell] = of_cell[root];
    // Numbers grow along a row.
    if (cell % tile_width<dim> == 0 || of_cell[cell - 1] != of_cell[cell])
      smallest[of_cell[cell]] = std::min(smallest[of_cell[cell]], grid.global_id(cell));
  });
  std::vector<GlobalIndex> pairs;
  if (grid.comm()->getSize() > 1) {
    // The groups of all ranks are few; what joins them is shared by all.
    n_before =
        static_cast<int>(exclusive_sum(grid.comm(), static_cast<GlobalIndex>(smallest.size())));
    joiner.for_each_member([&](int cell) { of_cell[cell] += n_before; });
    domain.halo.fill(of_cell);
    std::vector<std::pair<int, int>> joined;
    for (const auto& [cell, other] : joiner.across())
      joined.emplace_back(of_cell[cell], of_cell[other]);
    make_unique(joined);
    for (const auto& [a, b] : joined)
      pairs.insert(pairs.end(), {a, b});
    smallest = gather_all(grid.comm(), smallest);
    pairs = gather_all(grid.comm(), pairs);
  }
  const auto [number, n] = number_groups(smallest, pairs);
  groups.n = n;
  for (int& group : of_cell)
    if (group >= 0)
      group = number[group];
  return groups;
}

namespace {
template <int dim>
CellGroups closed_spaces_of(const MacDomain<dim>& domain, const SolidCells<dim>& solids) {
  const std::size_t n_cells = solids.state.cells.size();
  CellGroups spaces{std::vector<int>(n_cells, -1), 1};
  for (std::size_t cell = 0; cell < n_cells; ++cell)
    if (solids.is_fluid(static_cast<int>(cell)))
      spaces.of_cell[cell] = 0;
  if (!solids.state.surface)
    return spaces;
  spaces = find_groups(domain, solids, std::vector<char>(n_cells, 1));
  if (!domain.grid.is_complete())
    join_at_band_edge(domain.grid, spaces);
  return spaces;
}
}  // namespace

template <int dim>
const CellGroups& find_closed_spaces(const MacDomain<dim>& domain, const SolidCells<dim>& solids) {
  if (!solids.closed_spaces)
    solids.closed_spaces = std::make_shared<const CellGroups>(closed_spaces_of(domain, solids));
  return *solids.closed_spaces;
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
    int found = -1;
    double nearest = 0;
    for (int i = 0; i < 2 * dim; ++i) {
      const int other = solids.seen_neighbor(grid, cell, i / 2, i % 2);
      if (other < 0 || label[other] < 0)
        continue;
      const double distance = std::abs(phi[other]);
      if (found < 0 || distance < nearest || (distance == nearest && label[other] < found)) {
        found = label[other];
        nearest = distance;
      }
    }
    return found;
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

template const CellGroups& find_closed_spaces<2>(const MacDomain<2>&, const SolidCells<2>&);
template const CellGroups& find_closed_spaces<3>(const MacDomain<3>&, const SolidCells<3>&);
template void spread_labels<2>(const MacDomain<2>&, const SolidCells<2>&, const CellField&, int,
                               std::vector<int>&);
template void spread_labels<3>(const MacDomain<3>&, const SolidCells<3>&, const CellField&, int,
                               std::vector<int>&);
template CellGroups find_groups<2>(const MacDomain<2>&, const SolidCells<2>&,
                                   const std::vector<char>&);
template CellGroups find_groups<3>(const MacDomain<3>&, const SolidCells<3>&,
                                   const std::vector<char>&);

}  // namespace lockstep
