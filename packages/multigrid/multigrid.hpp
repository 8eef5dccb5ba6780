#pragma once
#include <Eigen/Dense>
#include <functional>
#include <memory>
#include <vector>

#include "multigrid/coarsening.hpp"
#include "multigrid/lattice_layout.hpp"
#include "multigrid/stencil_level.hpp"

namespace lockstep {

struct MultigridOptions {
  int n_sweeps = 2;  ///< red-black Gauss-Seidel sweeps before and after the coarse correction
  /// Visit each coarse level twice: an iteration or two less at the same cost, but not definite
  /// where the V-cycle overshoots by more than 2, as behind the narrow mouth of a thin bag.
  bool is_w_cycle = false;

  /// See LayoutOptions.
  int most_replicated_cells = LayoutOptions().most_replicated_cells;
  int gathered_ranks = LayoutOptions().gathered_ranks;

  /// Depth of the ghosts on distributed levels: the farthest cell that half sweeps between two
  /// exchanges, from zero or not, carry into a rank's own.
  int ghost_depth() const { return 2 * n_sweeps + (is_w_cycle ? 1 : 0); }
  LayoutOptions layout() const { return {ghost_depth(), most_replicated_cells, gathered_ranks}; }
};

/// One multigrid cycle for a stencil (coefficients over its unit) as an approximate inverse:
/// symmetric positive definite up to round-off of single precision, in which it works.
///
/// Red-black Gauss-Seidel, red first before the coarse correction and last after it; piecewise
/// constant transfer; coarse faces half the sum of their fine ones; a dense inverse on the coarsest
/// level, slightly shifted, so that closed regions need no care. The half sweeps of a level follow
/// each other through the slabs in one pass over memory. With several ranks each does those of its
/// neighbours' cells as well that its own will see, so that ghosts are exchanged once before a
/// pass; only through periodic sides of levels that a rank holds whole they are after each half
/// sweep.
template <int dim>
class Multigrid {
 public:
  Multigrid(std::shared_ptr<const LatticeLayout> layout, const MultigridOptions& options);

  /// Takes the coefficients of a geometry, whose blocks must be the layout's. Collective.
  void set(const FaceCoefficients& coefficients);

  /// Called with a slab of the finest level.
  using SlabFunction = std::function<void(int slab)>;
  /// solution := M rhs on the finest level, in single precision; `rhs` must be zero where there is
  /// no unknown. `set_rhs` is asked for it slab by slab, and `take` is given the finished slabs, in
  /// the same passes over memory. Collective.
  void cycle(const SlabFunction& set_rhs, const SlabFunction& take);
  float* rhs(int colour) { return work_.front().b[colour].data(); }
  float* solution(int colour) { return work_.front().x[colour].data(); }

  const StencilLevel<dim>& finest() const { return stencils_.front(); }
  int n_levels() const { return static_cast<int>(stencils_.size()); }
  std::size_t bytes() const;

 private:
  struct Work {
    Work() = default;
    explicit Work(const LevelGrid& grid);
    std::array<AlignedArray<float>, 2> x, b;
  };
  /// Vectors of a level, as the next finer level's ranks see it.
  Work& as_landed(int level) {
    return layout_->levels()[level].landing ? landed_[level] : work_[level];
  }

  void copy_to_natural(const FaceCoefficients& coefficients, NaturalStencil& natural) const;
  void invert_coarsest(const NaturalStencil& stencil);
  void solve_coarsest();
  void cycle(int level, bool from_zero);
  void cycle_below(int level);
  /// `before` a slab is looked at, and `after` it has its final values; for empty ones nothing.
  void smooth_and_restrict(int level, bool from_zero, const SlabFunction& before = {});
  void prolong_and_smooth(int level, const SlabFunction& after = {});
  void add_over_ranks(int level);
  void restrict_slab(int level, int slab);
  void flush_coarse_rows(int level, int fine_slab);
  void restrict_moved(int level);
  void prolong_slab(int level, int slab);
  /// Calls stage(s, slab) for s < n_stages, each stage one slab behind the one before it.
  template <typename Stage>
  void in_one_pass(int level, int n_stages, const Stage& stage) const;
  bool is_deep(int level) const { return !layout_->levels()[level].deep_halo.empty(); }
  /// Ghosts are exchanged after each half sweep.
  bool exchanges(int level) const {
    return !is_deep(level) && !layout_->levels()[level].halo.empty();
  }

  std::shared_ptr<const LatticeLayout> layout_;
  MultigridOptions options_;
  std::vector<StencilLevel<dim>> stencils_;
  std::vector<Transfer> transfers_;
  std::vector<Work> work_, landed_;             ///< `landed_` of gathered levels only
  std::vector<std::ptrdiff_t> coarsest_slots_;  ///< slots of its unknowns: colour * n_slots + slot
  Eigen::MatrixXd coarsest_inverse_;
  Eigen::VectorXd coarsest_rhs_, coarsest_solution_;
  std::vector<float> row_, coarse_rows_;  ///< residual of a row; sums of a coarse slab, naturally
  std::vector<float> gathered_;           ///< the cells of a level that every rank holds whole
};

extern template class Multigrid<2>;
extern template class Multigrid<3>;

}  // namespace lockstep
