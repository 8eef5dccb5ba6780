#include "stepping/step/locked_response.hpp"

#include <Tpetra_Vector.hpp>

#include "base/communicator.hpp"
#include "linear/action_operator.hpp"
#include "linear/least_squares.hpp"

namespace lockstep {

namespace {
/// The products of vectors with x, by one sum over ranks. Collective.
Eigen::VectorXd dots(const std::vector<RCP<const Vector>>& vectors, const Vector& x) {
  const auto values = x.getData();
  Eigen::VectorXd products = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(vectors.size()));
  for (std::size_t k = 0; k < vectors.size(); ++k) {
    const auto other = vectors[k]->getData();
    for (int row = 0; row < values.size(); ++row)
      products[static_cast<Eigen::Index>(k)] += other[row] * values[row];
  }
  sum_all(x.getMap()->getComm(), products.data(), static_cast<int>(products.size()));
  return products;
}
}  // namespace

RCP<const LinearOperator> locked_response(const RCP<const LinearOperator>& response,
                                          const std::vector<RCP<const Vector>>& directions,
                                          double yield) {
  if (directions.empty())
    return response;
  const auto n = static_cast<Eigen::Index>(directions.size());
  std::vector<RCP<const Vector>> answers;
  Eigen::MatrixXd products(n, n);
  for (const RCP<const Vector>& direction : directions) {
    const auto answer = make_vector(direction->getMap());
    apply(*response, *direction, *answer);
    answers.push_back(answer);
  }
  for (Eigen::Index j = 0; j < n; ++j)
    products.col(j) = dots(directions, *answers[j]);
  const Eigen::MatrixXd inverse =
      (1 - yield) * pseudo_inverse(0.5 * (products + products.transpose()));
  return action_operator(directions.front()->getMap(),
                         [=](const Vector& impulse, Vector& velocity) {
                           apply(*response, impulse, velocity);
                           const Eigen::VectorXd factors = inverse * dots(answers, impulse);
                           for (Eigen::Index i = 0; i < n; ++i)
                             velocity.update(-factors[i], *answers[i], 1);
                         });
}

}  // namespace lockstep
