#include <Tpetra_Map.hpp>
#include <algorithm>
#include <utility>

#include "base/disjoint_sets.hpp"
#include "mac/pressure/pressure_system.hpp"

namespace lockstep {

namespace {
/// Components of one rank's cells.
struct LocalComponents {
  std::vector<GlobalIndex> label;  ///< label of each stored cell: lattice number of the component's
                                   ///< first cell on its rank, or no_index
  std::vector<GlobalIndex> labels;  ///< all labels here
  std::vector<GlobalIndex> fixed;   ///< labels whose pressure level is fixed
  std::vector<std::pair<GlobalIndex, GlobalIndex>> joined;  ///< across ranks
};

template <typename State>
bool all_are(const std::vector<State>& states, int begin, int n, State value) {
  bool same = true;
  for (int i = begin; i < begin + n; ++i)
    same &= states[i] == value;
  return same;
}

/// Joins the cells of this rank that are connected, row by row.
template <int dim>
class ComponentFinder {
 public:
  ComponentFinder(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry)
      : sets(domain.grid.n_owned_cells()),
        grid_(domain.grid),
        geometry_(geometry),
        cells_(geometry.state.cells) {
    grid_.for_each_owned_strip([&](const CellStrip<dim>& row) { join_row(row); });
    sets.flatten();
  }

  DisjointSets sets;
  std::vector<int> fixed_cells;             ///< at open sides
  std::vector<std::pair<int, int>> across;  ///< cells joined with ghosts

 private:
  /// All cells of the row are fluid and connected along it.
  bool is_one(int begin, int n) const {
    if (geometry_.is_regular(begin))
      return true;
    return all_are(cells_, begin, n, CellState::fluid) &&
           all_are(geometry_.state.faces[0], begin + 1, n - 1, FaceState::free);
  }
  void join_row(const CellStrip<dim>& row) {
    const bool one = is_one(row.begin, row.n);
    if (one) {
      if (!geometry_.is_regular(row.begin))
        sets.join_run(row.begin, row.n);
      else if (row.begin % tile_volume<dim> == 0)
        sets.join_run(row.begin, tile_volume<dim>);
      look(row.begin, row.neighbors[0], 0, 0);
      look(row.begin + row.n - 1, row.neighbors[1], 0, 1);
    } else {
      for (int x = 0; x < row.n; ++x) {
        const int cell = row.begin + x;
        if (cells_[cell] != CellState::fluid)
          continue;
        look(cell, x > 0 ? cell - 1 : row.neighbors[0], 0, 0);
        look(cell, x < row.n - 1 ? cell + 1 : row.neighbors[1], 0, 1);
      }
    }
    for (int axis = 1; axis < dim; ++axis)
      for (int end = 0; end < 2; ++end)
        join_rows(row, one, axis, end);
  }
  void join_rows(const CellStrip<dim>& row, bool one, int axis, int end) {
    const int other = row.neighbors[2 * axis + end];
    if (geometry_.is_regular(row.begin) && other >= 0 &&
        TiledGrid<dim>::tile_of(other) == TiledGrid<dim>::tile_of(row.begin))
      return;
    if (one && other >= 0 && grid_.owned(other) && is_one(other, row.n)) {
      if (end == 1)  // the other row does it
        return;
      if (all_are(geometry_.state.faces[axis], row.begin, row.n, FaceState::free)) {
        sets.join(row.begin, other);
        return;
      }
    }
    for (int x = 0; x < row.n; ++x)
      if (cells_[row.begin + x] == CellState::fluid)
        look(row.begin + x, other < 0 ? -1 : other + x, axis, end);
  }
  /// A fluid cell and its neighbour.
  void look(int cell, int other, int axis, int end) {
    const int face = end == 0 ? cell : other;
    if (face < 0 || geometry_.open_fraction(axis, face) == 0)
      return;
    if (other < 0 || cells_[other] != CellState::fluid)
      fixed_cells.push_back(cell);
    else if (!grid_.owned(other))
      across.emplace_back(cell, other);
    else if (end == 0)
      sets.join(cell, other);
  }

  const TiledGrid<dim>& grid_;
  const MacGeometry<dim>& geometry_;
  const std::vector<CellState>& cells_;
};

/// Calls f(first, n) for runs of fluid cells in a row that are known to be connected.
template <int dim, typename Function>
void for_each_run(const MacGeometry<dim>& geometry, const CellStrip<dim>& row, const Function& f) {
  if (geometry.is_regular(row.begin))
    return f(row.begin, row.n);
  for (int cell = row.begin; cell < row.begin + row.n; ++cell)
    if (geometry.state.cells[cell] == CellState::fluid)
      f(cell, 1);
}

template <int dim>
LocalComponents local_components(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry) {
  const TiledGrid<dim>& grid = domain.grid;
  ComponentFinder<dim> found(domain, geometry);

  LocalComponents result;
  result.label.assign(grid.n_stored_cells(), no_index);
  // First the smallest lattice number of each set at its root, then that for all its cells. Numbers
  // grow along a row: only where another set begins one may be smaller.
  grid.for_each_owned_strip([&](const CellStrip<dim>& row) {
    int last_root = -1;
    for_each_run(geometry, row, [&](int cell, int) {
      const int root = found.sets.root(cell);
      if (std::exchange(last_root, root) == root)
        return;
      GlobalIndex& label = result.label[root];
      const GlobalIndex id = grid.global_id(cell);
      label = label == no_index ? id : std::min(label, id);
    });
  });
  grid.for_each_owned_strip([&](const CellStrip<dim>& row) {
    for_each_run(geometry, row, [&](int cell, int n) {
      const int root = found.sets.root(cell);
      std::fill_n(result.label.begin() + cell, n, result.label[root]);
      if (root == cell)
        result.labels.push_back(result.label[cell]);
    });
  });
  domain.halo.fill(result.label);
  for (const int cell : found.fixed_cells)
    result.fixed.push_back(result.label[cell]);
  for (const auto& [cell, other] : found.across)
    result.joined.emplace_back(result.label[cell], result.label[other]);
  std::sort(result.fixed.begin(), result.fixed.end());
  result.fixed.erase(std::unique(result.fixed.begin(), result.fixed.end()), result.fixed.end());
  std::sort(result.joined.begin(), result.joined.end());
  result.joined.erase(std::unique(result.joined.begin(), result.joined.end()), result.joined.end());
  return result;
}

/// The lists of all ranks, one after the other.
struct SharedComponents {
  std::vector<GlobalIndex> labels, fixed, joined;  ///< `joined` has two numbers a pair
};

/// In one exchange: each rank sends how long its lists are, and the lists.
SharedComponents shared(const LocalComponents& mine, const Communicator& comm) {
  std::vector<GlobalIndex> packed = {static_cast<GlobalIndex>(mine.labels.size()),
                                     static_cast<GlobalIndex>(mine.fixed.size()),
                                     static_cast<GlobalIndex>(2 * mine.joined.size())};
  packed.insert(packed.end(), mine.labels.begin(), mine.labels.end());
  packed.insert(packed.end(), mine.fixed.begin(), mine.fixed.end());
  for (const auto& [a, b] : mine.joined)
    packed.insert(packed.end(), {a, b});
  SharedComponents all;
  const std::vector<GlobalIndex> received = gather_all(comm, packed);
  for (auto next = received.begin(); next != received.end();) {
    const auto sizes = next;
    next += 3;
    int list = 0;
    for (auto* of_all : {&all.labels, &all.fixed, &all.joined}) {
      const auto end = next + sizes[list++];
      of_all->insert(of_all->end(), next, end);
      next = end;
    }
  }
  return all;
}
}  // namespace

template <int dim>
PressureRegions find_regions(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry) {
  const TiledGrid<dim>& grid = domain.grid;
  const LocalComponents mine = local_components(domain, geometry);

  // The components of all ranks are few; what joins them is shared by all.
  SharedComponents all = shared(mine, grid.comm());
  std::sort(all.labels.begin(), all.labels.end());
  const auto position = [&](GlobalIndex label) {
    return static_cast<int>(std::lower_bound(all.labels.begin(), all.labels.end(), label) -
                            all.labels.begin());
  };
  DisjointSets sets(static_cast<int>(all.labels.size()));
  for (std::size_t i = 0; i < all.joined.size(); i += 2)
    sets.join(position(all.joined[i]), position(all.joined[i + 1]));

  PressureRegions regions;
  std::vector<int> region(all.labels.size());
  for (std::size_t i = 0; i < all.labels.size(); ++i) {
    const int root = sets.root(static_cast<int>(i));
    region[i] = root == static_cast<int>(i) ? regions.n_regions++ : region[root];
  }
  regions.has_dirichlet.assign(regions.n_regions, 0);
  for (const GlobalIndex label : all.fixed)
    regions.has_dirichlet[region[position(label)]] = 1;
  regions.of_unknown.reserve(geometry.pressure_map->getNodeNumElements());
  GlobalIndex last_label = no_index;
  int last_region = -1;
  grid.for_each_owned_strip([&](const CellStrip<dim>& row) {
    for_each_run(geometry, row, [&](int cell, int n) {
      if (std::exchange(last_label, mine.label[cell]) != mine.label[cell])
        last_region = region[position(last_label)];
      regions.of_unknown.insert(regions.of_unknown.end(), n, last_region);
    });
  });
  return regions;
}

template PressureRegions find_regions<2>(const MacDomain<2>&, const MacGeometry<2>&);
template PressureRegions find_regions<3>(const MacDomain<3>&, const MacGeometry<3>&);

}  // namespace lockstep
