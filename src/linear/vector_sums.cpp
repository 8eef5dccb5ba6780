#include "linear/vector_sums.hpp"

#include <Tpetra_Vector.hpp>
#include <cmath>

namespace lockstep {

double sum(const double* values, std::ptrdiff_t n) {
  constexpr std::ptrdiff_t n_lanes = 16;  // as in sum_of_products
  std::array<double, n_lanes> sums{};
  std::ptrdiff_t i = 0;
  for (; i + n_lanes <= n; i += n_lanes) {
#pragma GCC ivdep
    for (std::ptrdiff_t lane = 0; lane < n_lanes; ++lane)
      sums[lane] += values[i + lane];
  }
  for (; i < n; ++i)
    sums[0] += values[i];
  return std::accumulate(sums.begin(), sums.end(), 0.0);
}

double dot(const Vector& x, const Vector& y) {
  const auto x_values = x.getData(), y_values = y.getData();
  return sum_all(x.getMap()->getComm(),
                 sum_of_products(x_values.getRawPtr(), y_values.getRawPtr(), x_values.size()));
}

double norm(const Vector& x) {
  return std::sqrt(dot(x, x));
}

double add_and_measure(double factor, const Vector& x, Vector& y) {
  const auto x_values = x.getData();
  const auto y_values = y.getDataNonConst();
  const double* from = x_values.getRawPtr();
  double* to = y_values.getRawPtr();
  constexpr std::ptrdiff_t n_lanes = 16;  // as in sum_of_products
  std::array<double, n_lanes> squares{};
  const std::ptrdiff_t n = x_values.size();
  std::ptrdiff_t i = 0;
  for (; i + n_lanes <= n; i += n_lanes) {
#pragma GCC ivdep
    for (std::ptrdiff_t lane = 0; lane < n_lanes; ++lane) {
      const double value = from[i + lane];
      to[i + lane] += factor * value;
      squares[lane] += value * value;
    }
  }
  for (; i < n; ++i) {
    to[i] += factor * from[i];
    squares[0] += from[i] * from[i];
  }
  const double sum = std::accumulate(squares.begin(), squares.end(), 0.0);
  return std::sqrt(sum_all(x.getMap()->getComm(), sum));
}

}  // namespace lockstep
