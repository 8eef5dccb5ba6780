// Contacts of solids that closed fluid locks along some motions: by hand.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "linear/triplet_matrix.hpp"
#include "stepping/step/locked_motions.hpp"

namespace lockstep::test {
namespace {

/// A vector with these values by id, wherever its rows are.
RCP<Vector> filled(const RCP<const Map>& map, const std::vector<double>& values) {
  const auto result = make_vector(map);
  for (const GlobalIndex id : map->getNodeElementList())
    result->replaceGlobalValue(id, values[id]);
  return result;
}

/// Three pistons of 1, 2 and 4 kg in one closed tank, with areas 1, 1 and -2 m^2, into which 5
/// m^2/s flow besides; the first touches a stop. Of its row J = (1, 0, 0) the part along C^-1 D =
/// (1, .5,
/// -.5) is J C^-1 D / (D^T C^-1 D) = 1 / 2.5.
TEST(LockedMotions, LeaveAContactTheMotionsThatFluidDoesNotHold) {
  const auto comm = Tpetra::getDefaultComm();
  const auto map = make_map(comm->getRank() == 0 ? 3 : 0, comm);
  const std::vector<double> mass{1, 2, 4}, area{1, 1, -2};
  std::vector<Triplet> inverse;
  for (const GlobalIndex id : map->getNodeElementList())
    inverse.push_back({id, id, 1 / mass[id]});
  const auto answers = as_operator(assemble_triplets(std::move(inverse), map, map));
  const NullSpace pressures = null_space_of({filled(map, {std::sqrt(0.5), std::sqrt(0.5), 0})});
  const LockedMotions locked(pressures, {filled(map, area)}, {5}, answers);
  ASSERT_FALSE(locked.empty());

  std::vector<HeldRow> rows(1);
  rows[0].weights = {{0, 1}};
  rows[0].velocity = 3;
  const Eigen::MatrixXd levels = locked.take_out(rows);
  EXPECT_NEAR(levels(0, 0), 0.4, 1e-15);
  EXPECT_NEAR(rows[0].velocity, 3 - 0.4 * 5, 1e-15);
  const std::vector<double> expected{0.6, -0.4, 0.8};
  ASSERT_EQ(rows[0].weights.size(), 3U);
  double along = 0;
  for (const auto& [dof, weight] : rows[0].weights) {
    EXPECT_NEAR(weight, expected[dof], 1e-15);
    along += weight * area[dof] / mass[dof];
  }
  EXPECT_NEAR(along, 0, 1e-15);

  // Its push along D is a pressure: of an impulse of 10, 4 times the null vector.
  const RCP<Vector> pressure = filled(map, {7, 7, 7});
  locked.add_pressure(levels, {10}, *pressure);
  pressure->update(-1, *filled(map, {7, 7, 7}), 1);
  pressure->update(-4, *pressures.vector(0), 1);
  EXPECT_LT(pressure->normInf(), 1e-14);
}

/// A piston alone in a closed tank cannot move: nothing of a stop's row is left to hold, and what
/// the stop pushes is a pressure of a third of it.
TEST(LockedMotions, LeaveNothingOfAContactThatFluidBears) {
  const auto comm = Tpetra::getDefaultComm();
  const auto map = make_map(comm->getRank() == 0 ? 1 : 0, comm);
  std::vector<Triplet> inverse;
  if (map->getNodeNumElements() > 0)
    inverse.push_back({0, 0, 0.5});
  const auto answers = as_operator(assemble_triplets(std::move(inverse), map, map));
  const LockedMotions locked(null_space_of({filled(map, {1})}), {filled(map, {3})}, {0}, answers);
  std::vector<HeldRow> rows(1);
  rows[0].weights = {{0, 1}};
  EXPECT_NEAR(locked.take_out(rows)(0, 0), 1. / 3, 1e-15);
  EXPECT_NEAR(rows[0].weights[0].second, 0, 1e-15);
}

TEST(LockedMotions, OfNothingChangeNothing) {
  std::vector<HeldRow> rows(1);
  rows[0].weights = {{0, 1}};
  EXPECT_EQ(LockedMotions().take_out(rows).size(), 0);
  EXPECT_EQ(rows[0].weights.size(), 1U);
}

}  // namespace
}  // namespace lockstep::test
