#include "grid/tile_partition.hpp"

#include <metis.h>

#include <limits>
#include <numeric>

#include "base/errors.hpp"
#include "base/interruption.hpp"

namespace lockstep {
namespace {

/// The graph of face neighbours in METIS' compressed form; edges weigh the cells they cut.
struct TileGraph {
  std::vector<idx_t> row_begin, neighbors, cut_cells;
};

template <int dim>
TileGraph tile_graph(const TileLattice<dim>& lattice, const std::vector<GlobalIndex>& tiles) {
  TileGraph graph;
  graph.row_begin.push_back(0);
  for (const GlobalIndex number : tiles) {
    const Index<dim> tile = lattice.tile_coordinates(number);
    const Index<dim> size = lattice.domain_extent(tile);
    for (int axis = 0; axis < dim; ++axis) {
      GlobalIndex previous = no_index;
      for (int side = 0; side < 2; ++side) {
        const GlobalIndex other = lattice.neighbor_tile(tile, axis, side);
        // One and two tiles along a periodic axis would give loops and double edges.
        if (other == no_index || other == number || other == previous)
          continue;
        const auto found = std::lower_bound(tiles.begin(), tiles.end(), other);
        if (found == tiles.end() || *found != other)
          continue;
        previous = other;
        int area = 1;
        for (int a = 0; a < dim; ++a)
          if (a != axis)
            area *= size[a];
        graph.neighbors.push_back(static_cast<idx_t>(found - tiles.begin()));
        graph.cut_cells.push_back(area);
      }
    }
    graph.row_begin.push_back(static_cast<idx_t>(graph.neighbors.size()));
  }
  return graph;
}

GlobalIndex largest_load(const std::vector<int>& parts, const std::vector<GlobalIndex>& weights,
                         int n_parts) {
  std::vector<GlobalIndex> loads(n_parts, 0);
  for (std::size_t i = 0; i < parts.size(); ++i)
    loads[parts[i]] += weights[i];
  return *std::max_element(loads.begin(), loads.end());
}

template <int dim>
std::vector<int> cut_morton_curve(const TileLattice<dim>& lattice,
                                  const std::vector<GlobalIndex>& tiles,
                                  const std::vector<GlobalIndex>& weights, int n_parts) {
  std::vector<std::pair<GlobalIndex, int>> curve(tiles.size());
  for (std::size_t i = 0; i < tiles.size(); ++i)
    curve[i] = {morton_code<dim>(lattice.tile_coordinates(tiles[i])), static_cast<int>(i)};
  std::sort(curve.begin(), curve.end());
  const double total =
      static_cast<double>(std::accumulate(weights.begin(), weights.end(), GlobalIndex{0}));
  std::vector<int> parts(tiles.size());
  double before = 0;
  for (const auto& [code, i] : curve) {
    const double middle = before + 0.5 * static_cast<double>(weights[i]);
    parts[i] = std::min(n_parts - 1, static_cast<int>(middle / total * n_parts));
    before += static_cast<double>(weights[i]);
  }
  return parts;
}

template <int dim>
std::vector<int> partition_by_metis(const TileLattice<dim>& lattice,
                                    const std::vector<GlobalIndex>& tiles,
                                    const std::vector<GlobalIndex>& weights, int n_parts) {
  TileGraph graph = tile_graph(lattice, tiles);
  const GlobalIndex total = std::accumulate(weights.begin(), weights.end(), GlobalIndex{0});
  // METIS sums the weights in 32 bits.
  const GlobalIndex divisor = 1 + total / (1 << 30);
  std::vector<idx_t> vertex_weights(tiles.size());
  for (std::size_t i = 0; i < tiles.size(); ++i)
    vertex_weights[i] = static_cast<idx_t>(std::max<GlobalIndex>(1, weights[i] / divisor));

  idx_t n_tiles = static_cast<idx_t>(tiles.size()), n_constraints = 1, n = n_parts, cut = 0;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = 1;
  const auto metis = n_parts <= 8 ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  std::vector<idx_t> parts(tiles.size(), 0);
  const HeldSignals held;
  const int status = metis(&n_tiles, &n_constraints, graph.row_begin.data(), graph.neighbors.data(),
                           vertex_weights.data(), nullptr, graph.cut_cells.data(), &n, nullptr,
                           nullptr, options, &cut, parts.data());
  check_input(status == METIS_OK,
              "METIS could not divide {} grid tiles among {} ranks (status {}); use fewer ranks or "
              "a coarser grid.",
              tiles.size(), n_parts, status);
  return {parts.begin(), parts.end()};
}

}  // namespace

template <int dim>
std::vector<int> partition_tiles(const TileLattice<dim>& lattice,
                                 const std::vector<GlobalIndex>& tile_numbers,
                                 const std::vector<GlobalIndex>& weights, int n_parts) {
  const std::size_t n_tiles = tile_numbers.size();
  LOCKSTEP_ASSERT(weights.size() == n_tiles && n_parts >= 1);
  if (n_parts == 1)
    return std::vector<int>(n_tiles, 0);
  if (n_tiles <= static_cast<std::size_t>(n_parts)) {
    std::vector<int> parts(n_tiles);
    std::iota(parts.begin(), parts.end(), 0);
    return parts;
  }
  check_input(n_tiles < std::size_t{std::numeric_limits<idx_t>::max()} / (2 * dim),
              "The grid has {} tiles, more than METIS can number; use a coarser grid.", n_tiles);
  std::vector<GlobalIndex> work(weights);
  for (GlobalIndex& w : work)
    w = std::max<GlobalIndex>(1, w);

  std::vector<int> parts = partition_by_metis(lattice, tile_numbers, work, n_parts);
  const GlobalIndex load = largest_load(parts, work, n_parts);
  const GlobalIndex total = std::accumulate(work.begin(), work.end(), GlobalIndex{0});
  if (10 * load * n_parts <= 11 * total)
    return parts;
  std::vector<int> curve_parts = cut_morton_curve(lattice, tile_numbers, work, n_parts);
  return largest_load(curve_parts, work, n_parts) < load ? curve_parts : parts;
}

template std::vector<int> partition_tiles(const TileLattice<2>&, const std::vector<GlobalIndex>&,
                                          const std::vector<GlobalIndex>&, int);
template std::vector<int> partition_tiles(const TileLattice<3>&, const std::vector<GlobalIndex>&,
                                          const std::vector<GlobalIndex>&, int);

}  // namespace lockstep
