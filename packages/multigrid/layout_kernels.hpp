#pragma once
// Conjugate gradients in a PressureLayout; for pressure_layout.cpp alone.
#include <array>
#include <numeric>
#include <vector>

#include "linear/conjugate_gradients.hpp"
#include "multigrid/layout_operators.hpp"

namespace lockstep {

/// A and one cycle, in two passes over memory an iteration beside the cycle's: A d is worked out in
/// both, which takes less time than to store it. Ghosts of z are exchanged, as single precision has
/// them, and those of d follow as d does.
template <int dim>
class LayoutKernels final : public ConjugateGradientKernels {
 public:
  LayoutKernels(RCP<const LayoutStencil<dim>> stencil, RCP<const LayoutInverse<dim>> inverse,
                const LevelHalo& halo, RCP<Vector> direction, Communicator comm)
      : stencil_(std::move(stencil)),
        inverse_(std::move(inverse)),
        halo_(halo),
        direction_(std::move(direction)),
        comm_(std::move(comm)) {
    in_empty_rows_.resize(inverse_->empty_rows().size());
  }

  const Vector& direction() const override { return *direction_; }

  double precondition(const Vector& r, double r_norm) override {
    return sum_all(comm_, inverse_->cycle(r.getData().getRawPtr(), r_norm));
  }

  double advance_direction(double beta) override {
    const std::ptrdiff_t n_slots = inverse_->n_slots();
    const auto values = direction_->getDataNonConst();
    double* d = values.getRawPtr();
    const std::vector<EmptyRow>& empty_rows = inverse_->empty_rows();
    for (std::size_t i = 0; i < empty_rows.size(); ++i) {
      double& entry = d[empty_rows[i].entry];
      in_empty_rows_[i] = empty_rows[i].z + (beta == 0 ? 0 : beta * entry);
      entry = 0;
    }
    const double back = inverse_->back();
    const auto turn = [&](int colour, std::ptrdiff_t at, int n) {
      const float* z = inverse_->solution(colour) + at;
      double* to = d + colour * n_slots + at;
      if (beta == 0) {
        for (int m = 0; m < n; ++m)
          to[m] = back * z[m];
      } else {
#pragma GCC ivdep
        for (int m = 0; m < n; ++m)
          to[m] = back * z[m] + beta * to[m];
      }
    };
    inverse_->fill_ghosts(halo_);
    for (int colour = 0; colour < 2; ++colour)
      halo_.for_each_ghost(colour, [&](std::ptrdiff_t slot) { turn(colour, slot, 1); });
    const auto turn_slab = [&](int slab) { inverse_->for_each_strip(slab, turn); };
    double sum = 0;
    stencil_->for_each_product(
        d, turn_slab,
        [&](int colour, std::ptrdiff_t at, int n, const double* product, const float*) {
          sum += sum_of_products(d + colour * n_slots + at, product, n);
        });
    restore_empty_rows(d);
    return sum_all(comm_, sum);
  }

  double advance(double step, Vector& x, Vector& r) override {
    const std::ptrdiff_t n_slots = inverse_->n_slots();
    const auto d_values = direction_->getDataNonConst(), x_values = x.getDataNonConst(),
               r_values = r.getDataNonConst();
    double* d = d_values.getRawPtr();
    double sum = 0;
    for (std::size_t i = 0; i < in_empty_rows_.size(); ++i) {
      const int entry = inverse_->empty_rows()[i].entry;
      d[entry] = 0;
      x_values[entry] += step * in_empty_rows_[i];
      sum += r_values[entry] * r_values[entry];
    }
    stencil_->for_each_product(
        d, [](int) {},
        [&](int colour, std::ptrdiff_t at, int n, const double* product, const float* diagonal) {
          const std::ptrdiff_t first = colour * n_slots + at;
          const auto advance_where = [&](const auto& has_row) {
            return advance_row(step, has_row, {d + first, product, n}, x_values.getRawPtr() + first,
                               r_values.getRawPtr() + first);
          };
          sum += diagonal == nullptr
                     ? advance_where([](int) { return 1.0; })
                     : advance_where([diagonal](int m) { return diagonal[m] > 0 ? 1.0 : 0.0; });
        });
    restore_empty_rows(d);
    return sum_all(comm_, sum);
  }

 private:
  /// This rank's part of a row: d and A d in n slots.
  struct DirectionRow {
    const double *d, *product;
    int n;
  };
  /// x += step d and r -= step A d along this rank's part of a row; returns r.r. Rows that A leaves
  /// empty have no diagonal: what d was there is added apart.
  template <typename HasRow>
  static double advance_row(double step, const HasRow& has_row, const DirectionRow& row, double* x,
                            double* r) {
    const double *d = row.d, *product = row.product;
    constexpr int n_lanes = 16;  // as in sum_of_products
    std::array<double, n_lanes> sums{};
    const auto at = [&](int m, double& sum) {
      x[m] += has_row(m) * step * d[m];
      const double value = r[m] - step * product[m];
      r[m] = value;
      sum += has_row(m) * value * value;
    };
    int m = 0;
    for (; m + n_lanes <= row.n; m += n_lanes) {
#pragma GCC ivdep
      for (int lane = 0; lane < n_lanes; ++lane)
        at(m + lane, sums[lane]);
    }
    for (; m < row.n; ++m)
      at(m, sums[0]);
    return std::accumulate(sums.begin(), sums.end(), 0.0);
  }

  void restore_empty_rows(double* d) const {
    for (std::size_t i = 0; i < in_empty_rows_.size(); ++i)
      d[inverse_->empty_rows()[i].entry] = in_empty_rows_[i];
  }

  RCP<const LayoutStencil<dim>> stencil_;
  RCP<const LayoutInverse<dim>> inverse_;
  const LevelHalo& halo_;
  RCP<Vector> direction_;
  Communicator comm_;
  std::vector<double> in_empty_rows_;  ///< d there
};

}  // namespace lockstep
