#include "grid/tile_partition.hpp"

#include <metis.h>

#include <algorithm>
#include <limits>
#include <numeric>

#include "base/errors.hpp"
#include "base/signals.hpp"

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

/// The largest sum over a part.
double largest_sum(const std::vector<GlobalIndex>& values, const std::vector<int>& parts,
                   int n_parts) {
  std::vector<GlobalIndex> sums(n_parts, 0);
  for (std::size_t i = 0; i < values.size(); ++i)
    sums[parts[i]] += values[i];
  return static_cast<double>(*std::max_element(sums.begin(), sums.end()));
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

/// Cuts tiles straight across, the first cut normal to an axis, each later one to the longest; of
/// equals the last, along which rows stay whole.
template <int dim>
class StraightCuts {
 public:
  StraightCuts(const TileLattice<dim>& lattice, const std::vector<GlobalIndex>& tiles,
               const std::vector<GlobalIndex>& weights)
      : weights_(weights), parts_(tiles.size(), 0) {
    for (const GlobalIndex tile : tiles)
      tiles_.push_back(lattice.tile_coordinates(tile));
  }
  std::vector<int> parts(int n_parts, int first_axis) {
    std::vector<int> all(tiles_.size());
    std::iota(all.begin(), all.end(), 0);
    cut(all.begin(), all.end(), 0, n_parts, first_axis);
    return parts_;
  }

 private:
  using Place = std::vector<int>::iterator;

  int longest_axis(Place begin, Place end) const {
    Index<dim> low = tiles_[*begin], high = low;
    for (Place i = begin; i != end; ++i)
      for (int a = 0; a < dim; ++a) {
        low[a] = std::min(low[a], tiles_[*i][a]);
        high[a] = std::max(high[a], tiles_[*i][a]);
      }
    int longest = dim - 1;
    for (int a = dim - 1; a >= 0; --a)
      if (high[a] - low[a] > high[longest] - low[longest])
        longest = a;
    return longest;
  }
  void cut(Place begin, Place end, int first_part, int n_parts, int axis) {
    if (n_parts == 1 || begin == end) {
      for (Place i = begin; i != end; ++i)
        parts_[*i] = first_part;
      return;
    }
    const auto key = [&](int tile) {
      Index<dim> result = tiles_[tile];
      std::swap(result[0], result[axis]);
      return result;
    };
    std::sort(begin, end, [&](int a, int b) { return key(a) < key(b); });
    double total = 0;
    for (Place i = begin; i != end; ++i)
      total += static_cast<double>(weights_[*i]);
    const int n_below = n_parts / 2;
    double rest = total * n_below / n_parts;
    Place middle = begin;
    while (middle != end && rest >= 0.5 * static_cast<double>(weights_[*middle]))
      rest -= static_cast<double>(weights_[*middle++]);
    const auto part = [&](Place from, Place to, int first, int n) {
      cut(from, to, first, n, from == to ? 0 : longest_axis(from, to));
    };
    part(begin, middle, first_part, n_below);
    part(middle, end, first_part + n_below, n_parts - n_below);
  }

  const std::vector<GlobalIndex>& weights_;
  std::vector<Index<dim>> tiles_;
  std::vector<int> parts_;
};

/// Weights whose sum METIS can take, in 32 bits.
std::vector<idx_t> weights_for_metis(const std::vector<const std::vector<GlobalIndex>*>& weights) {
  const std::size_t n_tiles = weights.front()->size();
  std::vector<idx_t> result(n_tiles * weights.size());
  for (std::size_t c = 0; c < weights.size(); ++c) {
    const std::vector<GlobalIndex>& values = *weights[c];
    const GlobalIndex total = std::accumulate(values.begin(), values.end(), GlobalIndex{0});
    const GlobalIndex divisor = 1 + total / (1 << 30);
    for (std::size_t i = 0; i < n_tiles; ++i)
      result[i * weights.size() + c] =
          static_cast<idx_t>(values[i] == 0 ? 0 : std::max<GlobalIndex>(1, values[i] / divisor));
  }
  return result;
}

/// Shares each of the weights evenly.
std::vector<int> partition_by_metis(const TileGraph& graph,
                                    const std::vector<const std::vector<GlobalIndex>*>& weights,
                                    int n_parts) {
  TileGraph copy = graph;  // METIS takes no constants
  std::vector<idx_t> vertex_weights = weights_for_metis(weights);
  idx_t n_tiles = static_cast<idx_t>(weights.front()->size()),
        n_constraints = static_cast<idx_t>(weights.size()), n = n_parts, cut = 0;
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_NUMBERING] = 0;
  options[METIS_OPTION_SEED] = 1;
  const auto metis = n_parts <= 8 ? METIS_PartGraphRecursive : METIS_PartGraphKway;
  std::vector<idx_t> parts(n_tiles, 0);
  const HeldSignals held;
  const int status = metis(&n_tiles, &n_constraints, copy.row_begin.data(), copy.neighbors.data(),
                           vertex_weights.data(), nullptr, copy.cut_cells.data(), &n, nullptr,
                           nullptr, options, &cut, parts.data());
  check_input(status == METIS_OK,
              "METIS could not divide {} grid tiles among {} ranks (status {}); use fewer ranks or "
              "a coarser grid.",
              n_tiles, n_parts, status);
  return {parts.begin(), parts.end()};
}

double cost_of(const TileGraph& graph, const TileWork& work, const std::vector<int>& parts,
               int n_parts) {
  std::vector<GlobalIndex> cut(parts.size(), 0);
  for (std::size_t i = 0; i < parts.size(); ++i)
    for (idx_t k = graph.row_begin[i]; k < graph.row_begin[i + 1]; ++k)
      if (parts[graph.neighbors[k]] != parts[i])
        cut[i] += graph.cut_cells[k];
  return largest_sum(work.everywhere, parts, n_parts) +
         largest_sum(work.at_surfaces, parts, n_parts) + largest_sum(cut, parts, n_parts);
}

void check_number(std::size_t n_tiles, int n_links) {
  check_input(n_tiles < std::size_t{std::numeric_limits<idx_t>::max()} / n_links,
              "The grid has {} tiles, more than METIS can number; use a coarser grid.", n_tiles);
}

}  // namespace

template <int dim>
double partition_cost(const TileLattice<dim>& lattice, const std::vector<GlobalIndex>& tile_numbers,
                      const TileWork& work, const std::vector<int>& parts, int n_parts) {
  check_number(tile_numbers.size(), 2 * dim);
  return cost_of(tile_graph(lattice, tile_numbers), work, parts, n_parts);
}

template <int dim>
std::vector<int> partition_tiles(const TileLattice<dim>& lattice,
                                 const std::vector<GlobalIndex>& tile_numbers,
                                 const TileWork& given, int n_parts) {
  const std::size_t n_tiles = tile_numbers.size();
  LOCKSTEP_ASSERT(given.everywhere.size() == n_tiles && n_parts >= 1);
  if (n_parts == 1)
    return std::vector<int>(n_tiles, 0);
  if (n_tiles <= static_cast<std::size_t>(n_parts)) {
    std::vector<int> parts(n_tiles);
    std::iota(parts.begin(), parts.end(), 0);
    return parts;
  }
  check_number(n_tiles, 2 * dim);
  TileWork work = given;
  for (GlobalIndex& w : work.everywhere)
    w = std::max<GlobalIndex>(1, w);
  const TileGraph graph = tile_graph(lattice, tile_numbers);
  StraightCuts<dim> cuts(lattice, tile_numbers, work.everywhere);
  std::vector<int> best = cuts.parts(n_parts, dim - 1);
  double least = cost_of(graph, work, best, n_parts);
  const auto propose = [&](std::vector<int> parts) {
    const double cost = cost_of(graph, work, parts, n_parts);
    if (cost < least) {
      least = cost;
      best = std::move(parts);
    }
  };
  for (int axis = dim - 2; axis >= 0; --axis)
    propose(cuts.parts(n_parts, axis));
  propose(partition_by_metis(graph, {&work.everywhere}, n_parts));
  propose(cut_morton_curve(lattice, tile_numbers, work.everywhere, n_parts));
  if (std::any_of(work.at_surfaces.begin(), work.at_surfaces.end(),
                  [](GlobalIndex w) { return w > 0; }))
    propose(partition_by_metis(graph, {&work.everywhere, &work.at_surfaces}, n_parts));
  return best;
}

template double partition_cost(const TileLattice<2>&, const std::vector<GlobalIndex>&,
                               const TileWork&, const std::vector<int>&, int);
template double partition_cost(const TileLattice<3>&, const std::vector<GlobalIndex>&,
                               const TileWork&, const std::vector<int>&, int);
template std::vector<int> partition_tiles(const TileLattice<2>&, const std::vector<GlobalIndex>&,
                                          const TileWork&, int);
template std::vector<int> partition_tiles(const TileLattice<3>&, const std::vector<GlobalIndex>&,
                                          const TileWork&, int);

}  // namespace lockstep
