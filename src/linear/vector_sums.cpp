#include "linear/vector_sums.hpp"

#include <Tpetra_Vector.hpp>
#include <cmath>

namespace lockstep {

double dot(const Vector& x, const Vector& y) {
  const auto x_values = x.getData(), y_values = y.getData();
  return sum_all(x.getMap()->getComm(),
                 sum_of_products(x_values.getRawPtr(), y_values.getRawPtr(), x_values.size()));
}

double norm(const Vector& x) {
  return std::sqrt(dot(x, x));
}

}  // namespace lockstep
