#include "linear/vector_sums.hpp"

#include <Tpetra_Vector.hpp>
#include <cmath>

namespace lockstep {

double norm(const Vector& x) {
  const auto values = x.getData();
  const double* data = values.getRawPtr();
  return std::sqrt(sum_all(x.getMap()->getComm(), sum_of_products(data, data, values.size())));
}

}  // namespace lockstep
