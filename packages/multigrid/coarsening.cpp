#include "multigrid/coarsening.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <algorithm>
#include <cmath>

#include "multigrid/thin_walls.hpp"

namespace lockstep {

namespace {

using Cell = std::array<int, 3>;

/// Contribution of the face of a fine cell to the coarse face it lies in: its coupling in series
/// with half a regular one on either side, as the centres of coarse cells are that much further
/// from it. Half of a regular face is left, but nearly all of a narrow gap: cells behind a gap
/// would be corrected too far otherwise, twice more on every level, and a W-cycle that overshoots
/// by more than two is not positive definite. Rounded, so that sums stay exact.
class FacePart {
 public:
  explicit FacePart(float unit) : unit_(unit) {}
  float operator()(float face) const { return (*this)(face, unit_); }
  /// `regular`: the coupling of a regular face in the fluid there.
  float operator()(float face, float regular) const {
    if (face == regular)
      return 0.5F * face;
    constexpr float steps = 1 << 20;
    return std::round(steps * face / (regular + face)) * (regular / steps);
  }

 private:
  float unit_;
};

/// Couplings below this part of a regular one are what differences of sums leave.
constexpr float round_off = 1e-5F;

/// Adds the parts of pairs of a fine row to a coarse one.
template <typename Part>
void add_pairs(const float* fine, int n, const Part& part, float* coarse) {
  const int n_pairs = n / 2;
  for (int i = 0; i < n_pairs; ++i)
    coarse[i] += part(fine[2 * i]) + part(fine[2 * i + 1]);
  if (n % 2 != 0)
    coarse[n_pairs] += part(fine[n - 1]);
}

void add_even(const float* fine, int n, const FacePart& part, float* coarse) {
  for (int i = 0; i < n; i += 2)
    coarse[i / 2] += part(fine[i]);
}

/// One coarsening step, with the names that all its parts share.
class Coarsening {
 public:
  Coarsening(const LayoutLevel& fine_level, const NaturalStencil& fine,
             const LayoutLevel& coarse_level, const LatticeBlocks& blocks,
             const CoarseningFactors& factors, NaturalStencil& coarse)
      : fine_level_(fine_level),
        f_(fine_level.grid),
        c_(coarse_level.grid),
        fine_(fine),
        coarse_owned_(coarse_level.owned),
        coarse_(coarse),
        dirichlet_factor_(factors.dirichlet),
        face_part_(factors.unit) {
    for (int axis = 0; axis < 3; ++axis) {
      transfer_.offset[axis] = (f_.begin[axis] >> 1) - c_.begin[axis];
      wraps_[axis] = blocks.periodic[axis] && !c_.is_distributed;
    }
  }

  void sum_rows();
  void sum_phases(std::ptrdiff_t row, int n, const std::array<bool, 3>& is_coarse_face,
                  std::ptrdiff_t to);
  void sum_part(const Cell& begin, int n);
  void move(const std::vector<char>& destinations);
  Transfer take_transfer() { return std::move(transfer_); }

 private:
  Cell parent(const Cell& cell) const {
    Cell result = cell;
    for (int axis = 0; axis < f_.dimension; ++axis)
      result[axis] = (cell[axis] >> 1) + transfer_.offset[axis];
    return result;
  }
  Cell new_parent(const Cell& cell, char destination) const {
    Cell result = parent(cell);
    const auto step = destination::step(destination);
    for (int axis = 0; axis < 3; ++axis)
      result[axis] += step[axis];
    return result;
  }
  /// On a level that every rank holds whole: the cell itself of a copy through periodic sides.
  Cell wrapped(Cell coarse_cell) const {
    for (int axis = 0; axis < f_.dimension; ++axis) {
      if (wraps_[axis])
        coarse_cell[axis] = (coarse_cell[axis] + c_.n[axis]) % c_.n[axis];
    }
    return coarse_cell;
  }
  bool is_stored(const Cell& coarse_cell) const {
    for (int axis = 0; axis < f_.dimension; ++axis) {
      if (coarse_cell[axis] < -1 || coarse_cell[axis] > c_.n[axis])
        return false;
    }
    return true;
  }
  /// Beyond the box, or inside it and another rank's.
  bool is_ghost(const Cell& coarse_cell) const {
    for (int axis = 0; axis < f_.dimension; ++axis) {
      if (coarse_cell[axis] < 0 || coarse_cell[axis] >= c_.n[axis])
        return true;
    }
    return !coarse_owned_.empty() && !coarse_owned_[natural(coarse_cell)];
  }
  std::ptrdiff_t natural(const Cell& coarse_cell) const {
    return c_.natural(coarse_cell[0], coarse_cell[1], coarse_cell[2]);
  }
  bool is_owned(std::ptrdiff_t at) const {
    return fine_level_.owned.empty() || fine_level_.owned[at];
  }
  bool in_box(const Cell& cell) const {
    for (int axis = 0; axis < f_.dimension; ++axis) {
      if (cell[axis] < 0 || cell[axis] >= f_.n[axis])
        return false;
    }
    return true;
  }
  /// Between two fluids a face is regular if it couples no less than one in the denser of them.
  float part_of_face(int axis, std::ptrdiff_t at) const {
    const float face = fine_.lower[axis][at];
    if (fine_.regular.empty())
      return face_part_(face);
    const float denser = std::min(fine_.regular[at], fine_.regular[at - f_.natural_stride[axis]]);
    return face_part_(face, std::max(face, denser));
  }
  void add_face(const Cell& a, const Cell& b, float value);
  void move_face(const Cell& upper, int axis, const std::vector<char>& destinations);
  void move_cell(const Cell& cell, char destination);

  const LayoutLevel& fine_level_;
  const LevelGrid& f_;
  const LevelGrid& c_;
  const NaturalStencil& fine_;
  const std::vector<char>& coarse_owned_;
  NaturalStencil& coarse_;
  float dirichlet_factor_;
  FacePart face_part_;
  std::array<bool, 3> wraps_{};  ///< by axis
  Transfer transfer_;
};

void Coarsening::sum_rows() {
  for (int k = 0; k < f_.n[2]; ++k) {
    for (int j = 0; j < f_.n[1]; ++j) {
      for (const LayoutLevel::Part& part : fine_level_.parts(j, k))
        sum_part({part.begin, j, k}, part.end - part.begin);
    }
  }
}

/// `n` cells of a row from `begin` on, the first of a pair.
void Coarsening::sum_part(const Cell& begin, int n) {
  const std::ptrdiff_t row = f_.natural(begin[0], begin[1], begin[2]);
  const std::ptrdiff_t to = natural(parent(begin));
  const float factor = dirichlet_factor_;
  add_pairs(
      fine_.dirichlet.data() + row, n, [factor](float value) { return factor * value; },
      coarse_.dirichlet.data() + to);
  if (!fine_.reaction.empty())
    add_pairs(
        fine_.reaction.data() + row, n, [](float value) { return value; },
        coarse_.reaction.data() + to);
  if (!fine_.regular.empty()) {
    sum_phases(row, n, {true, (begin[1] & 1) == 0, f_.dimension == 3 && (begin[2] & 1) == 0}, to);
    return;
  }
  add_even(fine_.lower[0].data() + row, n, face_part_, coarse_.lower[0].data() + to);
  if ((begin[1] & 1) == 0)
    add_pairs(fine_.lower[1].data() + row, n, face_part_, coarse_.lower[1].data() + to);
  if (f_.dimension == 3 && (begin[2] & 1) == 0)
    add_pairs(fine_.lower[2].data() + row, n, face_part_, coarse_.lower[2].data() + to);
}

/// The faces of a part of a row whose fluids differ, and what a regular face of the coarse cells
/// is: the mean of the fine ones, and twice that in 3D, where it has four times the area.
void Coarsening::sum_phases(std::ptrdiff_t row, int n, const std::array<bool, 3>& is_coarse_face,
                            std::ptrdiff_t to) {
  constexpr float part = 0.25F;
  add_pairs(
      fine_.regular.data() + row, n, [part](float value) { return part * value; },
      coarse_.regular.data() + to);
  for (int axis = 0; axis < f_.dimension; ++axis)
    for (int i = 0; is_coarse_face[axis] && i < n; i += axis == 0 ? 2 : 1)
      coarse_.lower[axis][to + i / 2] += part_of_face(axis, row + i);
}

/// Adds to the face between two coarse cells; cells that are not neighbours have none, and their
/// coupling is lost: the coarse problem may be too soft there, never too stiff.
void Coarsening::add_face(const Cell& a, const Cell& b, float value) {
  int axis = -1, distance = 0;
  for (int d = 0; d < f_.dimension; ++d) {
    distance += std::abs(a[d] - b[d]);
    if (a[d] != b[d])
      axis = d;
  }
  if (distance != 1)
    return;
  const Cell upper = wrapped(a[axis] > b[axis] ? a : b);
  if (is_stored(upper))
    coarse_.lower[axis][natural(upper)] += value;
}

/// Takes the lower face of `upper` from where `sum_rows` has put it to where its cells belong.
void Coarsening::move_face(const Cell& upper, int axis, const std::vector<char>& destinations) {
  Cell lower = upper;
  --lower[axis];
  const std::ptrdiff_t at = f_.natural(upper[0], upper[1], upper[2]);
  const float value = part_of_face(axis, at);
  if (value == 0)
    return;
  const char of_upper = destinations[at];
  const char of_lower = destinations[at - f_.natural_stride[axis]];
  add_face(parent(upper), parent(lower), -value);
  if (of_upper != destination::none && of_lower != destination::none)
    add_face(new_parent(upper, of_upper), new_parent(lower, of_lower), value);
}

void Coarsening::move_cell(const Cell& cell, char destination) {
  const std::ptrdiff_t at = f_.natural(cell[0], cell[1], cell[2]);
  const Cell from = parent(cell), to = wrapped(new_parent(cell, destination));
  const float dirichlet = dirichlet_factor_ * fine_.dirichlet[at];
  coarse_.dirichlet[natural(from)] -= dirichlet;
  const float reaction = fine_.reaction.empty() ? 0 : fine_.reaction[at];
  if (reaction != 0)
    coarse_.reaction[natural(from)] -= reaction;
  const bool stays = destination != destination::none && is_stored(to);
  if (stays) {
    coarse_.dirichlet[natural(to)] += dirichlet;
    if (reaction != 0)
      coarse_.reaction[natural(to)] += reaction;
  }
  if (LevelGrid::colour(cell[0], cell[1], cell[2]) != 0)
    return;
  MovedCell moved;
  moved.m = cell[0] >> 1;
  moved.j = cell[1];
  moved.k = cell[2];
  moved.colour_from = LevelGrid::colour(from[0], from[1], from[2]);
  moved.from = c_.slot_of_cell(from[0], from[1], from[2]);
  if (stays) {
    moved.colour_to = LevelGrid::colour(to[0], to[1], to[2]);
    moved.to = c_.slot_of_cell(to[0], to[1], to[2]);
    transfer_.leaves_rank = transfer_.leaves_rank || is_ghost(to);
  }
  transfer_.moved.push_back(moved);
}

void Coarsening::move(const std::vector<char>& destinations) {
  const int ghost_planes = f_.dimension == 3 ? 1 : 0;
  for (int k = -ghost_planes; k < f_.n[2] + ghost_planes; ++k) {
    for (int j = -1; j <= f_.n[1]; ++j) {
      for (int i = -1; i <= f_.n[0]; ++i) {
        const std::ptrdiff_t at = f_.natural(i, j, k);
        const char destination = destinations[at];
        if (destination == destination::own)
          continue;
        const Cell cell{i, j, k};
        const bool is_mine = in_box(cell) && is_owned(at);
        if (is_mine)
          move_cell(cell, destination);
        for (int axis = 0; axis < f_.dimension; ++axis) {
          if (is_mine)
            move_face(cell, axis, destinations);
          Cell upper = cell;
          ++upper[axis];
          const std::ptrdiff_t above = at + f_.natural_stride[axis];
          if (in_box(upper) && is_owned(above) && destinations[above] == destination::own)
            move_face(upper, axis, destinations);
        }
      }
    }
  }
}

void sort_by_slab(const LevelGrid& fine, Transfer& transfer) {
  const auto slab = [&](const MovedCell& cell) { return fine.dimension == 3 ? cell.k : cell.j; };
  std::stable_sort(transfer.moved.begin(), transfer.moved.end(),
                   [&](const MovedCell& a, const MovedCell& b) { return slab(a) < slab(b); });
  transfer.in_slab.assign(fine.n_slabs() + 1, transfer.moved.size());
  for (std::size_t i = transfer.moved.size(); i-- > 0;)
    transfer.in_slab[slab(transfer.moved[i])] = i;
  for (int s = fine.n_slabs() - 1; s >= 0; --s)
    transfer.in_slab[s] = std::min(transfer.in_slab[s], transfer.in_slab[s + 1]);
}

/// Sums arrays over the ranks, all of them in one message.
void sum_arrays(const std::vector<std::vector<float>*>& arrays, const Communicator& comm) {
  std::vector<float> all;
  for (const std::vector<float>* values : arrays)
    all.insert(all.end(), values->begin(), values->end());
  sum_over_ranks(comm, all);
  const float* next = all.data();
  for (std::vector<float>* values : arrays) {
    std::copy_n(next, values->size(), values->data());
    next += values->size();
  }
}

std::vector<std::vector<float>*> sums_of(NaturalStencil& stencil, int dimension) {
  std::vector<std::vector<float>*> arrays{&stencil.dirichlet};
  if (!stencil.reaction.empty())
    arrays.push_back(&stencil.reaction);
  if (!stencil.regular.empty())
    arrays.push_back(&stencil.regular);
  for (int axis = 0; axis < dimension; ++axis)
    arrays.push_back(&stencil.lower[axis]);
  return arrays;
}

std::vector<float*> data_of(const std::vector<std::vector<float>*>& arrays) {
  std::vector<float*> data;
  for (std::vector<float>* values : arrays)
    data.push_back(values->data());
  return data;
}

/// Sets values to zero that are only the round-off of differences of sums: they are no coupling.
/// `regular`: of each cell, where fluids differ; of a face's two cells that of the upper.
void clean_round_off(const std::vector<float>& regular, std::vector<float>& values) {
  float largest = 0;
  for (const float value : values)
    largest = std::max(largest, value);
  for (std::size_t i = 0; i < values.size(); ++i)
    if (values[i] < round_off * (regular.empty() ? largest : regular[i]))
      values[i] = 0;
}

/// Moves to `coarse` what ranks have added to each other's cells in `landed`, which is `coarse`
/// itself where the level's ranks are the finer one's.
void collect(const LayoutLevel& level, const LatticeBlocks& blocks, bool from_all_ranks, bool moved,
             NaturalStencil& landed, NaturalStencil& coarse) {
  const auto arrays = sums_of(coarse, level.grid.dimension);
  if (from_all_ranks)
    sum_arrays(arrays, blocks.comm);
  if (level.landing)
    level.landing->halo.sum_natural_to_owner(data_of(sums_of(landed, level.grid.dimension)),
                                             data_of(arrays));
  else if (moved && level.grid.is_distributed)
    level.halo.sum_natural_to_owner(data_of(arrays));
  for (std::vector<float>* values : arrays) {
    if (moved)
      clean_round_off(coarse.regular, *values);
  }
  for (int axis = 0; axis < level.grid.dimension; ++axis) {
    if (blocks.periodic[axis] && level.grid.n[axis] == 1)
      std::fill(coarse.lower[axis].begin(), coarse.lower[axis].end(), 0.0F);
  }
}

}  // namespace

Transfer coarsen(const LayoutLevel& fine_level, const NaturalStencil& fine,
                 const LayoutLevel& coarse_level, const LatticeBlocks& blocks,
                 const CoarseningFactors& factors, NaturalStencil& coarse) {
  const bool has_reaction = !fine.reaction.empty(), has_phases = !fine.regular.empty();
  coarse.resize(coarse_level.grid, has_reaction, has_phases);
  NaturalStencil elsewhere;
  if (coarse_level.landing)
    elsewhere.resize(coarse_level.landing->grid, has_reaction, has_phases);
  NaturalStencil& landed = coarse_level.landing ? elsewhere : coarse;
  Coarsening step(fine_level, fine, coarse_level.as_landed(), blocks, factors, landed);
  step.sum_rows();
  const auto destinations = destinations_behind_thin_walls(fine_level, fine, blocks.comm);
  if (!destinations.empty())
    step.move(destinations);
  const bool gathers = fine_level.grid.is_distributed && !coarse_level.grid.is_distributed;
  collect(coarse_level, blocks, gathers, !destinations.empty(), landed, coarse);
  coarse.complete(coarse_level);
  Transfer transfer = step.take_transfer();
  sort_by_slab(fine_level.grid, transfer);
  if (!destinations.empty())
    transfer.leaves_rank = max_all(blocks.comm, transfer.leaves_rank ? 1.0 : 0.0) > 0;
  return transfer;
}

}  // namespace lockstep
