#pragma once
// The operators of a PressureLayout; for pressure_layout.cpp alone.
#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "linear/residual_operator.hpp"
#include "linear/vector_sums.hpp"
#include "multigrid/level_halo.hpp"
#include "multigrid/multigrid.hpp"

namespace lockstep {

using TpetraOperator = Tpetra::Operator<double, int, GlobalIndex>;

inline RCP<const LinearOperator> as_thyra_operator(const RCP<const TpetraOperator>& op) {
  return Thyra::createConstLinearOp<double, int, GlobalIndex>(op);
}

/// A symmetric operator on the layout's vectors that overwrites its result, with zeros where there
/// is no unknown: the vectors of Thyra's spaces begin with whatever was in their memory, and an
/// inner product of Belos sums all entries.
template <typename Base>
class LayoutOperator : public Base {
 public:
  explicit LayoutOperator(RCP<const Map> map) : map_(std::move(map)) {}
  RCP<const Map> getDomainMap() const override { return map_; }
  RCP<const Map> getRangeMap() const override { return map_; }
  bool hasTransposeApply() const override { return true; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, double alpha,
             double beta) const override {
    for (std::size_t column = 0; column < x.getNumVectors(); ++column) {
      const auto in = x.getData(column);
      if (alpha == 1 && beta == 0) {
        y.getVectorNonConst(column)->putScalar(0);
        apply_to(in.getRawPtr(), y.getDataNonConst(column).getRawPtr());
        continue;
      }
      Vector result(map_);
      apply_to(in.getRawPtr(), result.getDataNonConst().getRawPtr());
      y.getVectorNonConst(column)->update(alpha, result, beta);
    }
  }

 private:
  virtual void apply_to(const double* x, double* y) const = 0;
  RCP<const Map> map_;
};

/// A coefficient on the diagonal that A has besides those of the stencil.
struct DiagonalRest {
  int row = 0;  ///< row of cells along x, 2 * (j + n_y k) + colour
  std::ptrdiff_t slot = 0;
  double value = 0;
};

/// A in the layout. `empty` are the entries of unknowns whose row A leaves empty: the loops over
/// cells with faces may pass them by.
template <int dim>
class LayoutStencil final : public LayoutOperator<ResidualOperator> {
 public:
  LayoutStencil(const RCP<const Map>& map, const StencilLevel<dim>& level, const LevelHalo& halo,
                double unit, std::vector<int> empty, std::vector<DiagonalRest> rests)
      : LayoutOperator<ResidualOperator>(map),
        level_(level),
        halo_(halo),
        unit_(unit),
        empty_(std::move(empty)),
        rests_(std::move(rests)) {
    row_.resize(level.grid().row_stride + 16);
  }

  /// Calls use(colour, slot of the first, number of slots, their part of A x, their diagonal) for
  /// all rows, and before(slab) before x is read there; the diagonal is null where all are
  /// unknowns, else it is 0 where there is none. x must hold its ghosts, and zero in the empty
  /// rows: their neighbours do not know that no face lies between.
  template <typename Before, typename Use>
  void for_each_product(const double* x, const Before& before, const Use& use) const {
    const int n_slabs = level_.grid().n_slabs();
    for (int front = 0; front <= n_slabs; ++front) {
      if (front < n_slabs)
        before(front);
      if (front > 0)
        multiply_slab(front - 1, x, use);
    }
  }
  const float* diagonal(int colour) const { return level_.diagonal(colour).data(); }

  Norms residual(const Vector& rhs, const Vector& x, Vector& r) const override {
    const auto b = rhs.getData(), x_values = x.getData();
    const auto r_values = r.getDataNonConst();
    const std::ptrdiff_t n_slots = level_.grid().n_slots;
    std::array<double, 3> squares{};
    for (const int entry : empty_) {
      r_values[entry] = b[entry];
      squares[0] += b[entry] * b[entry];
      squares[2] += b[entry] * b[entry];
    }
    for_each_product(
        ready(x_values.getRawPtr()), [](int) {},
        [&](int colour, std::ptrdiff_t at, int n, const double* product, const float* diagonal) {
          const std::ptrdiff_t first = colour * n_slots + at;
          const auto subtract = [&](const auto& has_row) {
            subtract_row(b.getRawPtr() + first, product, has_row, n, r_values.getRawPtr() + first,
                         squares);
          };
          if (diagonal == nullptr)
            subtract([](int) { return true; });
          else
            subtract([diagonal](int m) { return diagonal[m] > 0; });
        });
    sum_over_ranks(r.getMap()->getComm(), squares);
    return {std::sqrt(squares[0]), std::sqrt(squares[1]), std::sqrt(squares[2])};
  }

 private:
  void apply_to(const double* x, double* y) const override {
    for (const int entry : empty_)
      y[entry] = 0;
    for_each_product(
        ready(x), [](int) {},
        [&](int colour, std::ptrdiff_t at, int n, const double* product, const float*) {
          std::copy_n(product, n, y + colour * level_.grid().n_slots + at);
        });
  }

  /// x, or a copy with what `for_each_product` wants of it.
  const double* ready(const double* x) const {
    if (halo_.empty() && empty_.empty())
      return x;
    const std::ptrdiff_t n_slots = level_.grid().n_slots;
    copy_.assign(x, x + 2 * n_slots);
    for (const int entry : empty_)
      copy_[entry] = 0;
    halo_.fill(copy_.data(), copy_.data() + n_slots);
    return copy_.data();
  }

  /// r = b - product; adds the squares of b, product and r, but those of rows that are empty.
  template <typename HasRow>
  static void subtract_row(const double* b, const double* product, const HasRow& has_row, int n,
                           double* r, std::array<double, 3>& squares) {
    constexpr int n_lanes = 8;
    std::array<std::array<double, n_lanes>, 3> sums{};
    const auto at = [&](int m, int lane) {
      const double known = has_row(m) ? b[m] : 0, value = b[m] - product[m];
      r[m] = value;
      const double left = has_row(m) ? value : 0;
      sums[0][lane] += known * known;
      sums[1][lane] += product[m] * product[m];
      sums[2][lane] += left * left;
    };
    int m = 0;
    for (; m + n_lanes <= n; m += n_lanes) {
#pragma GCC ivdep
      for (int lane = 0; lane < n_lanes; ++lane)
        at(m + lane, lane);
    }
    for (; m < n; ++m)
      at(m, 0);
    for (int k = 0; k < 3; ++k)
      squares[k] = std::accumulate(sums[k].begin(), sums[k].end(), squares[k]);
  }

  template <typename Use>
  void multiply_slab(int slab, const double* x, const Use& use) const {
    const LevelGrid& grid = level_.grid();
    const auto rows = level_.rows_of(slab);
    for (int j = rows.j_begin; j < rows.j_end; ++j) {
      if (level_.is_foreign(j, rows.k))
        continue;
      for (int colour = 0; colour < 2; ++colour) {
        level_.multiply({colour, j, rows.k}, unit_, x + colour * grid.n_slots,
                        x + (1 - colour) * grid.n_slots, row_.data());
        add_rests(colour, j, rows.k, x + colour * grid.n_slots);
        level_.for_each_own_range(j, rows.k, [&](int first, int last) {
          const std::ptrdiff_t at = grid.slot(first, j, rows.k);
          use(colour, at, last - first, row_.data() + first,
              level_.is_full(colour, j, rows.k) ? nullptr : diagonal(colour) + at);
        });
      }
    }
  }

  void add_rests(int colour, int j, int k, const double* x) const {
    if (rests_.empty())
      return;
    const LevelGrid& grid = level_.grid();
    const int row = 2 * (j + grid.n[1] * k) + colour;
    const std::ptrdiff_t first = grid.slot(0, j, k);
    for (auto rest = std::lower_bound(rests_.begin(), rests_.end(), row,
                                      [](const DiagonalRest&r, int of) { return r.row < of; });
         rest != rests_.end() && rest->row == row; ++rest)
      row_[rest->slot - first] += unit_ * rest->value * x[rest->slot];
  }

  const StencilLevel<dim>& level_;
  const LevelHalo& halo_;
  double unit_;
  std::vector<int> empty_;
  std::vector<DiagonalRest> rests_;  ///< sorted by row
  mutable std::vector<double> copy_, row_;
};

/// A row of the layout that A leaves empty, and the inverse of what stands in for its diagonal.
struct EmptyRow {
  int entry = 0;
  double inverse = 0;
  double z = 0;  ///< value of the last cycle
};

/// One cycle as an approximate inverse of A.
template <int dim>
class LayoutInverse final : public LayoutOperator<TpetraOperator> {
 public:
  LayoutInverse(const RCP<const Map>& map, Multigrid<dim>& multigrid, Communicator comm,
                double unit, std::vector<EmptyRow> empty_rows)
      : LayoutOperator<TpetraOperator>(map),
        multigrid_(multigrid),
        comm_(std::move(comm)),
        unit_(unit),
        empty_rows_(std::move(empty_rows)) {}

  /// Calls f(colour, slot of the first cell, number of slots) for this rank's rows of a slab.
  template <typename Function>
  void for_each_strip(int slab, const Function& f) const {
    const StencilLevel<dim>& level = multigrid_.finest();
    const auto rows = level.rows_of(slab);
    for (int j = rows.j_begin; j < rows.j_end; ++j) {
      level.for_each_own_range(j, rows.k, [&](int first, int last) {
        for (int colour = 0; colour < 2; ++colour)
          f(colour, level.grid().slot(first, j, rows.k), last - first);
      });
    }
  }
  template <typename Function>
  void for_each_strip(const Function& f) const {
    for (int slab = 0; slab < multigrid_.finest().grid().n_slabs(); ++slab)
      for_each_strip(slab, f);
  }

  /// Leaves z / `back()` in the multigrid's solution, z of the empty rows in `empty_rows()`;
  /// returns r.z of this rank.
  double cycle(const double* r, double r_norm) const {
    const std::ptrdiff_t n_slots = multigrid_.finest().grid().n_slots;
    // Single precision has a small range: r is taken in units of a power of 2 near its norm.
    const double scale = r_norm > 0 ? std::exp2(-std::round(std::log2(r_norm))) : 1;
    const auto take_over = [&](int colour, std::ptrdiff_t at, int n) {
      const double* from = r + colour * n_slots + at;
      float* to = multigrid_.rhs(colour) + at;
      for (int m = 0; m < n; ++m)
        to[m] = static_cast<float>(scale * from[m]);
    };
    // r as the cycle has seen it: what rounding takes from the step length does no harm.
    double sum = 0;
    const auto add_products = [&](int colour, std::ptrdiff_t at, int n) {
      sum += sum_of_products(multigrid_.rhs(colour) + at, multigrid_.solution(colour) + at, n);
    };
    multigrid_.cycle([&](int slab) { for_each_strip(slab, take_over); },
                     [&](int slab) { for_each_strip(slab, add_products); });
    back_ = 1 / (scale * unit_);
    sum *= back_ / scale;
    for (EmptyRow& row : empty_rows_) {
      row.z = row.inverse * r[row.entry];
      sum += row.z * r[row.entry];
    }
    return sum;
  }
  double back() const { return back_; }
  std::ptrdiff_t n_slots() const { return multigrid_.finest().grid().n_slots; }
  const float* solution(int colour) const { return multigrid_.solution(colour); }
  /// Sets the solution in the next cells beyond this rank's. Collective.
  void fill_ghosts(const LevelHalo& halo) const {
    halo.fill(multigrid_.solution(0), multigrid_.solution(1));
  }
  const std::vector<EmptyRow>& empty_rows() const { return empty_rows_; }

 private:
  void apply_to(const double* x, double* y) const override {
    const std::ptrdiff_t n_slots = multigrid_.finest().grid().n_slots;
    double sum = 0;
    for_each_strip([&](int colour, std::ptrdiff_t at, int n) {
      const double* row = x + colour * n_slots + at;
      sum += sum_of_products(row, row, n);
    });
    sum = sum_all(comm_, sum);
    check_solve(std::isfinite(sum), "The multigrid was given a residual that is not finite.");
    cycle(x, std::sqrt(sum));
    for_each_strip([&](int colour, std::ptrdiff_t at, int n) {
      const float* from = multigrid_.solution(colour) + at;
      double* to = y + colour * n_slots + at;
      for (int m = 0; m < n; ++m)
        to[m] = back_ * from[m];
    });
    for (const EmptyRow& row : empty_rows_)
      y[row.entry] = row.z;
  }

  Multigrid<dim>& multigrid_;
  Communicator comm_;
  double unit_;
  mutable double back_ = 1;
  mutable std::vector<EmptyRow> empty_rows_;
};

}  // namespace lockstep
