#include "multigrid/thin_walls.hpp"

#include <algorithm>

namespace lockstep {

namespace {

using Cell = std::array<int, 3>;

/// The children of one coarse cell, by number: bit a of a child is its position along axis a.
struct Family {
  Cell first{};  ///< child 0, even local coordinates
  /// By child: the lowest child of its part, or -1 where there is no unknown.
  std::array<int, 8> part{};
  int main = -1;  ///< the part that keeps the coarse cell
};

class ThinWalls {
 public:
  ThinWalls(const LayoutLevel& level, const NaturalStencil& stencil)
      : grid_(level.grid),
        stencil_(stencil),
        owned_(level.owned),
        n_children_(1 << level.grid.dimension) {}

  std::vector<Family> divided_families() const;
  Cell child(const Family& family, int number) const {
    Cell cell = family.first;
    for (int axis = 0; axis < grid_.dimension; ++axis)
      cell[axis] += number >> axis & 1;
    return cell;
  }
  std::ptrdiff_t natural(const Cell& cell) const {
    return grid_.natural(cell[0], cell[1], cell[2]);
  }
  char destination_of(const Family& family, int part, const std::vector<char>& is_orphan) const;
  int n_children() const { return n_children_; }

 private:
  bool row_is_cut(int j, int k) const;
  void collect_in_row(int j, int k, std::vector<Cell>& found) const;
  bool is_cut(int i, int j, int k) const;
  Family family_of(const Cell& first) const;

  const LevelGrid& grid_;
  const NaturalStencil& stencil_;
  const std::vector<char>& owned_;
  int n_children_;
};

/// True if some face inside a coarse cell, between two unknowns of this row or of it and the row
/// below, is closed.
bool ThinWalls::row_is_cut(int j, int k) const {
  const std::ptrdiff_t row = grid_.natural(0, j, k);
  const char* active = stencil_.active.data() + row;
  const float* x = stencil_.lower[0].data() + row;
  int n_cut = 0;
  for (int i = 1; i < grid_.n[0]; i += 2)
    n_cut += active[i] & active[i - 1] & (x[i] == 0);
  for (int axis = 1; axis < grid_.dimension; ++axis) {
    if (((axis == 1 ? j : k) & 1) == 0)
      continue;
    const float* face = stencil_.lower[axis].data() + row;
    const char* below = active - grid_.natural_stride[axis];
    for (int i = 0; i < grid_.n[0]; ++i)
      n_cut += active[i] & below[i] & (face[i] == 0);
  }
  return n_cut > 0;
}

bool ThinWalls::is_cut(int i, int j, int k) const {
  const Cell cell{i, j, k};
  const std::ptrdiff_t at = natural(cell);
  if (!stencil_.active[at])
    return false;
  for (int axis = 0; axis < grid_.dimension; ++axis) {
    if ((cell[axis] & 1) != 0 && stencil_.active[at - grid_.natural_stride[axis]] &&
        stencil_.lower[axis][at] == 0)
      return true;
  }
  return false;
}

void ThinWalls::collect_in_row(int j, int k, std::vector<Cell>& found) const {
  for (int i = 0; i < grid_.n[0]; ++i) {
    if (is_cut(i, j, k) && (owned_.empty() || owned_[grid_.natural(i, j, k)]))
      found.push_back({k & ~1, j & ~1, i & ~1});
  }
}

Family ThinWalls::family_of(const Cell& first) const {
  Family family;
  family.first = first;
  for (int c = 0; c < n_children_; ++c) {
    const Cell cell = child(family, c);
    bool inside = true;
    for (int axis = 0; axis < grid_.dimension; ++axis)
      inside = inside && cell[axis] < grid_.n[axis];
    family.part[c] = inside && stencil_.active[natural(cell)] ? c : -1;
  }
  for (bool changed = true; changed;) {
    changed = false;
    for (int c = 0; c < n_children_; ++c) {
      for (int axis = 0; axis < grid_.dimension; ++axis) {
        const int below = c & ~(1 << axis);
        if (below == c || family.part[c] < 0 || family.part[below] < 0 ||
            family.part[c] == family.part[below] ||
            stencil_.lower[axis][natural(child(family, c))] == 0)
          continue;
        family.part[c] = family.part[below] = std::min(family.part[c], family.part[below]);
        changed = true;
      }
    }
  }
  std::array<int, 8> size{};
  for (int c = 0; c < n_children_; ++c) {
    if (family.part[c] >= 0)
      ++size[family.part[c]];
  }
  family.main = static_cast<int>(std::max_element(size.begin(), size.end()) - size.begin());
  return family;
}

std::vector<Family> ThinWalls::divided_families() const {
  std::vector<Cell> found;  // z, y, x, for sorting
  for (int k = 0; k < grid_.n[2]; ++k) {
    for (int j = 0; j < grid_.n[1]; ++j) {
      if (row_is_cut(j, k))
        collect_in_row(j, k, found);
    }
  }
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  std::vector<Family> families;
  for (const Cell& cell : found) {
    const Family family = family_of({cell[2], cell[1], cell[0]});
    const bool is_divided = std::any_of(family.part.begin(), family.part.begin() + n_children_,
                                        [&](int part) { return part >= 0 && part != family.main; });
    if (is_divided)
      families.push_back(family);
  }
  return families;
}

char ThinWalls::destination_of(const Family& family, int part,
                               const std::vector<char>& is_orphan) const {
  std::array<int, 6> votes{};
  for (int c = 0; c < n_children_; ++c) {
    if (family.part[c] != part)
      continue;
    const std::ptrdiff_t at = natural(child(family, c));
    for (int axis = 0; axis < grid_.dimension; ++axis) {
      const int side = c >> axis & 1;
      const std::ptrdiff_t stride = grid_.natural_stride[axis];
      const std::ptrdiff_t outside = side == 0 ? at - stride : at + stride;
      const float face = stencil_.lower[axis][side == 0 ? at : outside];
      if (face > 0 && stencil_.active[outside] && !is_orphan[outside])
        ++votes[2 * axis + side];
    }
  }
  const auto best = std::max_element(votes.begin(), votes.end());
  if (*best == 0)
    return destination::none;
  const int direction = static_cast<int>(best - votes.begin());
  return destination::neighbor(direction / 2, direction % 2);
}

}  // namespace

std::array<int, 3> destination::step(char destination) {
  std::array<int, 3> step{};
  if (destination != own && destination != none)
    step[(destination - 1) / 2] = (destination - 1) % 2 == 0 ? -1 : 1;
  return step;
}

std::vector<char> destinations_behind_thin_walls(const LayoutLevel& level,
                                                 const NaturalStencil& stencil,
                                                 const Communicator& comm) {
  const ThinWalls walls(level, stencil);
  const std::vector<Family> families = walls.divided_families();
  if (sum_all(comm, static_cast<GlobalIndex>(families.size())) == 0)
    return {};
  std::vector<char> is_orphan(level.grid.n_natural, 0), result(level.grid.n_natural, 0);
  for (const Family& family : families) {
    for (int c = 0; c < walls.n_children(); ++c) {
      if (family.part[c] >= 0 && family.part[c] != family.main)
        is_orphan[walls.natural(walls.child(family, c))] = 1;
    }
  }
  level.halo.fill_natural<char>({is_orphan.data()});
  for (const Family& family : families) {
    for (int part = 0; part < walls.n_children(); ++part) {
      if (part == family.main || family.part[part] != part)
        continue;
      const char destination = walls.destination_of(family, part, is_orphan);
      for (int c = 0; c < walls.n_children(); ++c) {
        if (family.part[c] == part)
          result[walls.natural(walls.child(family, c))] = destination;
      }
    }
  }
  level.halo.fill_natural<char>({result.data()});
  return result;
}

}  // namespace lockstep
