#pragma once
// Conjugate gradients in a PressureLayout; for pressure_layout.cpp alone.
#include <vector>

#include "linear/conjugate_gradients.hpp"
#include "multigrid/layout_operators.hpp"

namespace lockstep {

/// A and one cycle, in two passes over memory an iteration.
template <int dim>
class LayoutKernels final : public ConjugateGradientKernels {
 public:
  LayoutKernels(RCP<const LayoutStencil<dim>> stencil, RCP<const LayoutInverse<dim>> inverse,
                Communicator comm)
      : stencil_(std::move(stencil)), inverse_(std::move(inverse)), comm_(std::move(comm)) {}

  double precondition(const Vector& r, double r_norm) override {
    return sum_all(comm_, inverse_->cycle(r.getData().getRawPtr(), r_norm));
  }

  double advance_direction(double beta, Vector& d, Vector& q) override {
    const std::ptrdiff_t n_slots = inverse_->n_slots();
    const auto d_values = d.getDataNonConst(), q_values = q.getDataNonConst();
    double* direction = d_values.getRawPtr();
    std::vector<double> in_empty_rows;
    for (const EmptyRow& row : inverse_->empty_rows()) {
      in_empty_rows.push_back(row.z + (beta == 0 ? 0 : beta * direction[row.entry]));
      direction[row.entry] = 0;
    }
    const double back = inverse_->back();
    const auto update_slab = [&](int slab) {
      inverse_->for_each_row(slab, [&](int colour, std::ptrdiff_t at, int n) {
        const float* z = inverse_->solution(colour) + at;
        double* to = direction + colour * n_slots + at;
        if (beta == 0) {
          for (int m = 0; m < n; ++m)
            to[m] = back * z[m];
        } else {
#pragma GCC ivdep
          for (int m = 0; m < n; ++m)
            to[m] = back * z[m] + beta * to[m];
        }
      });
    };
    const double sum = stencil_->multiply(direction, q_values.getRawPtr(), update_slab);
    for (std::size_t i = 0; i < in_empty_rows.size(); ++i)
      direction[inverse_->empty_rows()[i].entry] = in_empty_rows[i];
    return sum_all(comm_, sum);
  }

 private:
  RCP<const LayoutStencil<dim>> stencil_;
  RCP<const LayoutInverse<dim>> inverse_;
  Communicator comm_;
};

}  // namespace lockstep
