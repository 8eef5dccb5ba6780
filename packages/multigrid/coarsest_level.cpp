// The dense inverse at the end of a Multigrid's cycle.
#include "multigrid/multigrid.hpp"

namespace lockstep {

namespace {

/// Relative shift of the coarsest diagonal: makes the inverse of a closed region finite. Large
/// enough that single precision carries the constant, and that where a light solid closes the
/// region, whose system is regular, the constant is not overweighted (1e-5: 60 iterations in a
/// stirred tank; 1e-3: 27; 1e-2: 20); small beside the other eigenvalues of the coarsest level.
constexpr double coarsest_shift = 1e-2;

}  // namespace

template <int dim>
void Multigrid<dim>::invert_coarsest(const NaturalStencil& stencil) {
  const LevelGrid& grid = stencils_.back().grid();
  std::vector<int> number(grid.n_natural, -1);
  coarsest_slots_.clear();
  std::vector<std::ptrdiff_t> at;
  for (int k = 0; k < grid.n[2]; ++k) {
    for (int j = 0; j < grid.n[1]; ++j) {
      for (int i = 0; i < grid.n[0]; ++i) {
        const std::ptrdiff_t cell = grid.natural(i, j, k);
        if (!stencil.active[cell])
          continue;
        number[cell] = static_cast<int>(at.size());
        at.push_back(cell);
        coarsest_slots_.push_back(LevelGrid::colour(i, j, k) * grid.n_slots +
                                  grid.slot_of_cell(i, j, k));
      }
    }
  }
  const auto n = static_cast<Eigen::Index>(at.size());
  // Through periodic sides the lower neighbour is a ghost: the cell at the other end.
  std::vector<float> ids(grid.n_natural, -1);
  for (Eigen::Index r = 0; r < n; ++r)
    ids[at[r]] = static_cast<float>(r);
  layout_->levels().back().halo.fill_natural<float>({ids.data()});
  Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(n, n);
  for (Eigen::Index r = 0; r < n; ++r) {
    matrix(r, r) += stencil.diagonal[at[r]] * (1 + coarsest_shift);
    for (int axis = 0; axis < dim; ++axis) {
      const float face = stencil.lower[axis][at[r]];
      const auto other = static_cast<Eigen::Index>(ids[at[r] - grid.natural_stride[axis]]);
      if (face == 0 || other < 0)
        continue;
      matrix(r, other) -= face;
      matrix(other, r) -= face;
    }
  }
  if (n == 0)
    return;
  coarsest_inverse_ = matrix.llt().solve(Eigen::MatrixXd::Identity(n, n));
  coarsest_inverse_ = 0.5 * (coarsest_inverse_ + coarsest_inverse_.transpose()).eval();
  coarsest_rhs_.resize(n);
  coarsest_solution_.resize(n);
}

template <int dim>
void Multigrid<dim>::solve_coarsest() {
  Work& work = work_.back();
  const std::ptrdiff_t n_slots = stencils_.back().grid().n_slots;
  const auto n = static_cast<Eigen::Index>(coarsest_slots_.size());
  if (n == 0)
    return;
  for (Eigen::Index r = 0; r < n; ++r)
    coarsest_rhs_[r] = work.b[coarsest_slots_[r] / n_slots][coarsest_slots_[r] % n_slots];
  coarsest_solution_.noalias() = coarsest_inverse_ * coarsest_rhs_;
  for (Eigen::Index r = 0; r < n; ++r)
    work.x[coarsest_slots_[r] / n_slots][coarsest_slots_[r] % n_slots] =
        static_cast<float>(coarsest_solution_[r]);
}

template void Multigrid<2>::invert_coarsest(const NaturalStencil&);
template void Multigrid<3>::invert_coarsest(const NaturalStencil&);
template void Multigrid<2>::solve_coarsest();
template void Multigrid<3>::solve_coarsest();

}  // namespace lockstep
