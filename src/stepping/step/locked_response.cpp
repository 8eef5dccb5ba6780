#include "stepping/step/locked_response.hpp"

#include <Tpetra_Vector.hpp>

#include "linear/action_operator.hpp"
#include "linear/least_squares.hpp"

namespace lockstep {

RCP<const LinearOperator> locked_response(const RCP<const LinearOperator>& response,
                                          const std::vector<RCP<const Vector>>& directions) {
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
  for (Eigen::Index i = 0; i < n; ++i)
    for (Eigen::Index j = 0; j < n; ++j)
      products(i, j) = directions[i]->dot(*answers[j]);
  const Eigen::MatrixXd inverse = pseudo_inverse(0.5 * (products + products.transpose()));
  return action_operator(directions.front()->getMap(),
                         [=](const Vector& impulse, Vector& velocity) {
                           apply(*response, impulse, velocity);
                           Eigen::VectorXd along(n);
                           for (Eigen::Index i = 0; i < n; ++i)
                             along[i] = answers[i]->dot(impulse);
                           const Eigen::VectorXd factors = inverse * along;
                           for (Eigen::Index i = 0; i < n; ++i)
                             velocity.update(-factors[i], *answers[i], 1);
                         });
}

}  // namespace lockstep
