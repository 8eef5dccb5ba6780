#include "stepping/step/secant_response.hpp"

#include <Tpetra_Map.hpp>
#include <Tpetra_Vector.hpp>

#include "base/communicator.hpp"
#include "linear/matrix_sum.hpp"
#include "linear/triplet_matrix.hpp"

namespace lockstep {

namespace {
/// The dofs that take part, the same on all ranks.
struct Support {
  std::vector<GlobalIndex> dofs;
  std::vector<double> change, answer;  ///< by the solves, by the present response [m/s]
};

Support gathered_support(const Vector& impulse, const Vector& change, const Vector& answer) {
  const auto map = change.getMap();
  const auto of_impulse = impulse.getData(), of_change = change.getData(),
             of_answer = answer.getData();
  Support mine;
  for (int i = 0; i < static_cast<int>(map->getNodeNumElements()); ++i) {
    if (of_impulse[i] == 0 && of_answer[i] == 0)
      continue;
    mine.dofs.push_back(map->getGlobalElement(i));
    mine.change.push_back(of_change[i]);
    mine.answer.push_back(of_answer[i]);
  }
  const auto& comm = map->getComm();
  return {gather_all(comm, mine.dofs), gather_all(comm, mine.change),
          gather_all(comm, mine.answer)};
}
}  // namespace

// BFGS on the inverse B: with the answer By, s the change restricted to the support, and s.y > 0,
//   B + (s.y + y.By) / (s.y)^2 s s^T - (By s^T + s By^T) / s.y .
void SecantResponse::learn(const Vector& impulse, const Vector& change) {
  constexpr std::size_t most_dofs = 96;
  constexpr double round_off = 1e-12;
  if (assembled(current_).is_null())
    return;
  Vector answer(change.getMap());
  apply(*current_, impulse, answer);
  const Support support = gathered_support(impulse, change, answer);
  const std::size_t n = support.dofs.size();
  const double product = impulse.dot(change);
  if (n == 0 || n > most_dofs || product <= round_off * impulse.norm2() * change.norm2())
    return;
  const double of_answer = impulse.dot(answer);
  const double square = (product + of_answer) / (product * product);
  const std::vector<double>&s = support.change, &b = support.answer;
  std::vector<Triplet> update;
  for (std::size_t i = 0; i < n; ++i)
    for (std::size_t j = 0; j < n && change.getMap()->isNodeGlobalElement(support.dofs[i]); ++j)
      update.push_back({support.dofs[i], support.dofs[j],
                        square * s[i] * s[j] - (b[i] * s[j] + s[i] * b[j]) / product});
  current_ =
      as_operator(sum_of({{assembled(current_)},
                          {assemble_triplets(std::move(update), change.getMap(), change.getMap())}},
                         change.getMap()));
}

}  // namespace lockstep
