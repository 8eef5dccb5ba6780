#include "multigrid/level_grid.hpp"

namespace lockstep {

namespace {
/// Rows begin at multiples of a cache line of floats.
constexpr std::ptrdiff_t line = 16;
}  // namespace

void LevelGrid::set_strides(bool ghosts_in_x) {
  margin = ghosts_in_x ? 1 : 0;
  const std::ptrdiff_t used = (n[0] + 1) / 2 + 2 * margin;
  row_stride = (used + line - 1) / line * line;
  const int ghost_planes = dimension == 3 ? 1 : 0;
  plane_stride = row_stride * (n[1] + 2);
  n_slots = plane_stride * (n[2] + 2 * ghost_planes) + 2 * line;
  first = line + ghost_planes * plane_stride + row_stride + margin;

  natural_stride = {1, n[0] + 2, (n[0] + 2) * static_cast<std::ptrdiff_t>(n[1] + 2)};
  natural_first = 1 + natural_stride[1] + ghost_planes * natural_stride[2];
  n_natural = natural_stride[2] * (n[2] + 2 * ghost_planes);
}

}  // namespace lockstep
