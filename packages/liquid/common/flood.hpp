#pragma once
#include <utility>
#include <vector>

#include "staggered/domain/mac_domain.hpp"

namespace lockstep {

/// Flood fill: marks with 1 the cells that can be reached from those of the front, which are
/// marked, neighbour by neighbour where may_pass(from, to) is true, both of them cells of the
/// domain. `marked`: of stored cells; its halo is set. Collective.
template <int dim, typename MayPass>
void flood(const MacDomain<dim>& domain, std::vector<int> front, const MayPass& may_pass,
           std::vector<char>& marked) {
  const TiledGrid<dim>& grid = domain.grid;
  GlobalIndex n_found = 1;
  while (n_found > 0) {
    while (!front.empty()) {
      const int cell = front.back();
      front.pop_back();
      for (int side = 0; side < 2 * dim; ++side) {
        const int other = grid.neighbor(cell, side / 2, side % 2);
        if (other < 0 || !grid.owned(other) || !grid.in_domain(other) || marked[other] ||
            !may_pass(cell, other))
          continue;
        marked[other] = 1;
        front.push_back(other);
      }
    }
    domain.halo.fill(marked);
    // goes on from cells that other ranks have marked
    grid.for_each_owned_cell([&](int cell) {
      for (int side = 0; side < 2 * dim && !marked[cell]; ++side) {
        const int other = grid.neighbor(cell, side / 2, side % 2);
        if (other < 0 || grid.owned(other) || !marked[other] || !may_pass(other, cell))
          continue;
        marked[cell] = 1;
        front.push_back(cell);
      }
    });
    n_found = sum_all(grid.comm(), static_cast<GlobalIndex>(front.size()));
  }
}

}  // namespace lockstep
