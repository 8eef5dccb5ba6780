#include "multigrid/multigrid.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace lockstep {

namespace {

constexpr int red = 0, black = 1;

LevelHalo::Colours colours(std::array<AlignedArray<float>, 2>& values) {
  return {values[0].data(), values[1].data()};
}
/// A fixed-pressure point stays where it is while cells grow: delta_{l+1} = delta_l + h_l / 2, in
/// units of the finest h, is its distance from the centre of the first cell on level l + 1.
float dirichlet_factor(int level) {
  double distance = 1;
  for (int l = 0; l < level; ++l)
    distance += 0.5 * (1 << l);
  return static_cast<float>(distance / (distance + 0.5 * (1 << level)));
}

}  // namespace

template <int dim>
Multigrid<dim>::Multigrid(std::shared_ptr<const LatticeLayout> layout,
                          const MultigridOptions& options)
    : layout_(std::move(layout)), options_(options) {
  std::size_t longest_row = 0, largest_coarse_slab = 0;
  for (const LayoutLevel& level : layout_->levels()) {
    stencils_.emplace_back(level);
    work_.emplace_back(level.grid);
    landed_.push_back(level.landing ? Work(level.landing->grid) : Work());
    longest_row = std::max<std::size_t>(longest_row, level.grid.row_stride);
    const std::size_t slab = (level.grid.n[0] + 1) / 2 * (dim == 3 ? (level.grid.n[1] + 1) / 2 : 1);
    largest_coarse_slab = std::max(largest_coarse_slab, slab);
  }
  row_.resize(longest_row + 16);
  coarse_rows_.resize(largest_coarse_slab);
}

template <int dim>
Multigrid<dim>::Work::Work(const LevelGrid& grid) {
  for (int colour = 0; colour < 2; ++colour) {
    x[colour] = AlignedArray<float>(grid.n_slots);
    b[colour] = AlignedArray<float>(grid.n_slots);
  }
}

template <int dim>
std::size_t Multigrid<dim>::bytes() const {
  std::size_t n = 0;
  for (std::size_t level = 0; level < stencils_.size(); ++level)
    n += stencils_[level].bytes() + 2 * sizeof(float) *
                                        (work_[level].x[0].size() + work_[level].x[1].size() +
                                         landed_[level].x[0].size() + landed_[level].x[1].size());
  return n;
}

template <int dim>
void Multigrid<dim>::copy_to_natural(const FaceCoefficients& coefficients,
                                     NaturalStencil& natural) const {
  const LevelGrid& grid = layout_->finest();
  const LatticeBlocks& blocks = layout_->blocks();
  natural.resize(grid, coefficients.reaction.has_value(), coefficients.regular.has_value());
  const int width = blocks.width;
  for (std::size_t block = 0; block < blocks.begins.size(); ++block) {
    std::array<int, 3> n{1, 1, 1}, low{};
    for (int axis = 0; axis < dim; ++axis) {
      n[axis] = std::min(width, blocks.n_cells[axis] - blocks.begins[block][axis]);
      low[axis] = blocks.begins[block][axis] - grid.begin[axis];
    }
    for (int k = 0; k < n[2]; ++k) {
      for (int j = 0; j < n[1]; ++j) {
        const std::size_t from =
            block * blocks.block_volume() + static_cast<std::size_t>(width) * (j + width * k);
        const std::ptrdiff_t to = grid.natural(low[0], low[1] + j, low[2] + k);
        for (int axis = 0; axis < dim; ++axis)
          std::copy_n(coefficients.lower[axis].data() + from, std::max(n[0], 0),
                      natural.lower[axis].data() + to);
        std::copy_n(coefficients.dirichlet.data() + from, std::max(n[0], 0),
                    natural.dirichlet.data() + to);
        if (coefficients.reaction)
          std::copy_n(coefficients.reaction->data() + from, std::max(n[0], 0),
                      natural.reaction.data() + to);
        if (coefficients.regular)
          std::copy_n(coefficients.regular->data() + from, std::max(n[0], 0),
                      natural.regular.data() + to);
      }
    }
  }
  natural.complete(layout_->levels().front());
}

template <int dim>
void Multigrid<dim>::set(const FaceCoefficients& coefficients) {
  LOCKSTEP_ASSERT(coefficients.blocks.get() == &layout_->blocks());
  NaturalStencil fine, coarse;
  copy_to_natural(coefficients, fine);
  transfers_.clear();
  float unit = 1;
  for (int level = 0; level < n_levels(); ++level) {
    stencils_[level].set(fine, unit);
    for (AlignedArray<float>& x : work_[level].x)
      std::fill_n(x.data(), x.size(), 0.0F);
    for (AlignedArray<float>& b : landed_[level].b)
      std::fill_n(b.data(), b.size(), 0.0F);
    if (level + 1 == n_levels())
      break;
    transfers_.push_back(coarsen(layout_->levels()[level], fine, layout_->levels()[level + 1],
                                 layout_->blocks(), {unit, dirichlet_factor(level)}, coarse));
    std::swap(fine, coarse);
    unit *= dim == 3 ? 2 : 1;
  }
  invert_coarsest(fine);
}

template <int dim>
template <typename Stage>
void Multigrid<dim>::in_one_pass(int level, int n_stages, const Stage& stage) const {
  const int n_slabs = stencils_[level].grid().n_slabs();
  for (int front = 0; front < n_slabs + n_stages - 1; ++front) {
    for (int s = 0; s < n_stages; ++s) {
      const int slab = front - s;
      if (slab >= 0 && slab < n_slabs)
        stage(s, slab);
    }
  }
}

/// Sums the right-hand sides of a level that every rank holds whole.
template <int dim>
void Multigrid<dim>::add_over_ranks(int level) {
  Work& work = work_[level];
  const LevelGrid& grid = stencils_[level].grid();
  gathered_.resize(static_cast<std::size_t>(grid.n[0]) * grid.n_rows());
  const auto for_each_cell = [&](const auto& f) {
    float* next = gathered_.data();
    for (int k = 0; k < grid.n[2]; ++k)
      for (int j = 0; j < grid.n[1]; ++j)
        for (int i = 0; i < grid.n[0]; ++i)
          f(*next++, work.b[LevelGrid::colour(i, j, k)][grid.slot_of_cell(i, j, k)]);
  };
  for_each_cell([](float& copy, float value) { copy = value; });
  sum_over_ranks(layout_->blocks().comm, gathered_);
  for_each_cell([](float copy, float& value) { value = copy; });
}

template <int dim>
void Multigrid<dim>::smooth_and_restrict(int level, bool from_zero, const SlabFunction& before) {
  Work& work = work_[level];
  const StencilLevel<dim>& stencil = stencils_[level];
  const LevelGrid& coarse = stencils_[level + 1].grid();
  const LayoutLevel& coarse_level = layout_->levels()[level + 1];
  const bool gathers = stencil.grid().is_distributed && !coarse.is_distributed;
  if (gathers || transfers_[level].leaves_rank || coarse_level.landing) {
    for (AlignedArray<float>& b : work_[level + 1].b)
      std::fill_n(b.data(), b.size(), 0.0F);
  }
  const int n_half_sweeps = 2 * options_.n_sweeps;
  const auto smooth = [&](int s, int slab) {
    const int colour = s % 2;
    if (s == 0 && before && !is_deep(level))
      before(slab);
    if (s == 0 && from_zero)
      stencil.relax_from_zero(red, slab, work.b[red].data(), work.x[red].data());
    else
      stencil.relax(colour, slab, work.b[colour].data(), work.x[1 - colour].data(),
                    work.x[colour].data());
  };
  if (is_deep(level)) {
    const int n_slabs = stencil.grid().n_slabs();
    for (int slab = 0; before && slab < n_slabs; ++slab)
      before(slab);
    const LevelHalo& halo = layout_->levels()[level].deep_halo;
    if (from_zero)
      halo.fill(work.b[red].data(), work.b[black].data());
    else
      halo.fill(black, work.x[black].data());
  }
  if (!exchanges(level)) {
    in_one_pass(level, n_half_sweeps + 1, [&](int s, int slab) {
      if (s < n_half_sweeps)
        smooth(s, slab);
      else
        restrict_slab(level, slab);
    });
  } else {
    for (int s = 0; s < n_half_sweeps; ++s) {
      for (int slab = 0; slab < stencil.grid().n_slabs(); ++slab)
        smooth(s, slab);
      layout_->levels()[level].halo.fill(s % 2, work.x[s % 2].data());
    }
    for (int slab = 0; slab < stencil.grid().n_slabs(); ++slab)
      restrict_slab(level, slab);
  }
  restrict_moved(level);
  if (gathers)
    add_over_ranks(level + 1);
  if (coarse_level.landing)
    coarse_level.landing->halo.sum_to_owner(colours(landed_[level + 1].b),
                                            colours(work_[level + 1].b));
  else if (transfers_[level].leaves_rank)
    coarse_level.halo.sum_to_owner(colours(work_[level + 1].b), colours(work_[level + 1].b));
}

/// Adds the red residual of a fine slab to the sums of the coarse slab; black ones are zero after
/// the last half sweep. The last fine slab of a coarse one stores the sums of this rank's cells.
template <int dim>
void Multigrid<dim>::restrict_slab(int level, int slab) {
  Work& work = work_[level];
  const StencilLevel<dim>& stencil = stencils_[level];
  const LevelGrid& grid = stencil.grid();
  const int n_coarse = (grid.n[0] + 1) / 2;
  if (slab % 2 == 0)
    std::fill(coarse_rows_.begin(), coarse_rows_.end(), 0.0F);
  const auto rows = stencil.rows_of(slab);
  for (int j = rows.j_begin; j < rows.j_end; ++j) {
    if (stencil.is_foreign(j, rows.k))
      continue;
    stencil.residual({red, j, rows.k}, work.b[red].data(), work.x[red].data(), work.x[black].data(),
                     row_.data());
    const auto range = stencil.range(j, rows.k);
    float* sums = coarse_rows_.data() + (dim == 3 ? (j >> 1) * n_coarse : 0);
    for (int m = range.first; m < range.last; ++m)
      sums[m] += row_[m];
  }
  if (slab % 2 == 1 || slab + 1 == grid.n_slabs())
    flush_coarse_rows(level, slab);
}

template <int dim>
void Multigrid<dim>::flush_coarse_rows(int level, int fine_slab) {
  const LevelGrid& fine = stencils_[level].grid();
  const LevelGrid& coarse = layout_->levels()[level + 1].as_landed().grid;
  const auto& offset = transfers_[level].offset;
  const int n_coarse = (fine.n[0] + 1) / 2;
  const int n_rows = dim == 3 ? (fine.n[1] + 1) / 2 : 1;
  for (int r = 0; r < n_rows; ++r) {
    const int j = offset[1] + (dim == 3 ? r : fine_slab >> 1);
    const int k = dim == 3 ? offset[2] + (fine_slab >> 1) : 0;
    const float* sums = coarse_rows_.data() + r * n_coarse;
    const auto parts =
        layout_->levels()[level].parts(dim == 3 ? 2 * r : fine_slab, dim == 3 ? fine_slab : 0);
    for (const LayoutLevel::Part& part : parts) {
      const int begin = part.begin / 2, end = (part.end + 1) / 2;
      for (int first = begin; first < std::min(begin + 2, end); ++first) {
        const int i = offset[0] + first;
        float* b = as_landed(level + 1).b[LevelGrid::colour(i, j, k)].data() +
                   coarse.slot_of_cell(i, j, k);
        const int n = (end - first + 1) / 2;
        for (int m = 0; m < n; ++m)
          b[m] = sums[2 * m + first];
      }
    }
  }
}

template <int dim>
void Multigrid<dim>::restrict_moved(int level) {
  Work& work = work_[level];
  Work& coarse = as_landed(level + 1);
  for (const MovedCell& cell : transfers_[level].moved) {
    const float residual =
        stencils_[level].residual_at({red, cell.j, cell.k}, cell.m, work.b[red].data(),
                                     work.x[red].data(), work.x[black].data());
    coarse.b[cell.colour_from][cell.from] -= residual;
    if (cell.to >= 0)
      coarse.b[cell.colour_to][cell.to] += residual;
  }
}

/// Adds the coarse correction to this rank's red cells of a slab; black ones are about to be
/// overwritten.
template <int dim>
void Multigrid<dim>::prolong_slab(int level, int slab) {
  const StencilLevel<dim>& stencil = stencils_[level];
  const LevelGrid& fine = stencil.grid();
  const LevelGrid& coarse = layout_->levels()[level + 1].as_landed().grid;
  const Transfer& transfer = transfers_[level];
  const auto& offset = transfer.offset;
  const Work& from = as_landed(level + 1);
  float* x = work_[level].x[red].data();
  const auto rows = stencil.rows_of(slab);
  for (int j = rows.j_begin; j < rows.j_end; ++j) {
    const int coarse_j = (j >> 1) + offset[1];
    const int coarse_k = dim == 3 ? (rows.k >> 1) + offset[2] : 0;
    stencil.for_each_own_range(j, rows.k, [&](int begin, int end) {
      for (int first = begin; first < std::min(begin + 2, end); ++first) {
        const int i = offset[0] + first;
        const float* source = from.x[LevelGrid::colour(i, coarse_j, coarse_k)].data() +
                              coarse.slot_of_cell(i, coarse_j, coarse_k);
        const int n = (end - first + 1) / 2;
        for (int m = 0; m < n; ++m)
          row_[2 * m + first] = source[m];
      }
      stencil.add(red, j, rows.k, {begin, end}, row_.data(), x + fine.slot(0, j, rows.k));
    });
  }
  for (std::size_t i = transfer.in_slab[slab]; i < transfer.in_slab[slab + 1]; ++i) {
    const MovedCell& cell = transfer.moved[i];
    float correction = -from.x[cell.colour_from][cell.from];
    if (cell.to >= 0)
      correction += from.x[cell.colour_to][cell.to];
    x[fine.slot(cell.m, cell.j, cell.k)] += correction;
  }
}

template <int dim>
void Multigrid<dim>::prolong_and_smooth(int level, const SlabFunction& after) {
  Work& work = work_[level];
  const StencilLevel<dim>& stencil = stencils_[level];
  const int n_half_sweeps = 2 * options_.n_sweeps;
  const auto relax = [&](int s, int slab) {
    const int colour = s % 2 == 0 ? black : red;
    stencil.relax(colour, slab, work.b[colour].data(), work.x[1 - colour].data(),
                  work.x[colour].data());
  };
  const auto relax_and_show = [&](int s, int slab) {
    relax(s, slab);
    if (s + 1 == n_half_sweeps && after)
      after(slab);
  };
  const LayoutLevel& layout = layout_->levels()[level];
  const int n_slabs = stencil.grid().n_slabs();
  if (const auto& landing = layout_->levels()[level + 1].landing)
    landing->halo.fill(colours(work_[level + 1].x), colours(landed_[level + 1].x));
  if (!exchanges(level) && !is_deep(level)) {
    in_one_pass(level, n_half_sweeps + 1, [&](int s, int slab) {
      if (s == 0)
        prolong_slab(level, slab);
      else
        relax_and_show(s - 1, slab);
    });
    return;
  }
  for (int slab = 0; slab < n_slabs; ++slab)
    prolong_slab(level, slab);
  if (is_deep(level)) {
    layout.deep_halo.fill(red, work.x[red].data());
    in_one_pass(level, n_half_sweeps, relax_and_show);
    if (level > 0 && transfers_[level - 1].leaves_rank && !layout.landing)
      layout.halo.fill(work.x[red].data(), work.x[black].data());
    return;
  }
  layout.halo.fill(red, work.x[red].data());
  for (int s = 0; s < n_half_sweeps; ++s) {
    for (int slab = 0; slab < n_slabs; ++slab)
      relax_and_show(s, slab);
    const int colour = s % 2 == 0 ? black : red;
    layout.halo.fill(colour, work.x[colour].data());
  }
}

template <int dim>
void Multigrid<dim>::cycle(int level, bool from_zero) {
  if (level + 1 == n_levels()) {
    solve_coarsest();
    return;
  }
  smooth_and_restrict(level, from_zero);
  cycle_below(level);
  prolong_and_smooth(level);
}

template <int dim>
void Multigrid<dim>::cycle_below(int level) {
  cycle(level + 1, true);
  if (options_.is_w_cycle && level + 2 < n_levels())
    cycle(level + 1, false);
}

template <int dim>
void Multigrid<dim>::cycle(const SlabFunction& set_rhs, const SlabFunction& take) {
  if (n_levels() > 1) {
    smooth_and_restrict(0, true, set_rhs);
    cycle_below(0);
    prolong_and_smooth(0, take);
    return;
  }
  const int n_slabs = finest().grid().n_slabs();
  for (int slab = 0; slab < n_slabs; ++slab)
    set_rhs(slab);
  solve_coarsest();
  for (int slab = 0; slab < n_slabs; ++slab)
    take(slab);
}

template class Multigrid<2>;
template class Multigrid<3>;

}  // namespace lockstep
