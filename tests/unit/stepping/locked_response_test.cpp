// Solids that closed fluid locks along some impulses: by hand, and with a direction given twice.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/triplet_matrix.hpp"
#include "stepping/step/locked_response.hpp"

namespace lockstep::test {
namespace {

/// The value of each row, wherever it is.
template <typename Function>
RCP<Vector> vector_of(const RCP<const Map>& map, const Function& f) {
  const auto result = make_vector(map);
  for (const GlobalIndex id : map->getNodeElementList())
    result->replaceGlobalValue(id, f(id));
  return result;
}

/// Three pistons of 1, 2 and 4 kg in one closed tank, with areas 1, 1 and -2 m^2: pushed by a Pa s
/// they would move at a / m and change its volume by a^2 / m.
TEST(LockedResponse, PistonsOfOneTankKeepItsVolume) {
  const auto comm = Tpetra::getDefaultComm();
  const auto map = make_map(3, comm);
  const std::array<double, 3> mass{1, 2, 4}, area{1, 1, -2};
  std::vector<Triplet> inverse;
  for (const GlobalIndex id : map->getNodeElementList())
    inverse.push_back({id, id, id < 3 ? 1 / mass[id] : 1});
  const auto response = as_operator(assemble_triplets(std::move(inverse), map, map));
  const RCP<const Vector> areas =
      vector_of(map, [&](GlobalIndex id) { return id < 3 ? area[id] : 0; });
  EXPECT_EQ(locked_response(response, {}), response);
  const RCP<Vector> twice =
      vector_of(map, [&](GlobalIndex id) { return id < 3 ? 2 * area[id] : 0; });
  for (const bool also_twice : {false, true}) {
    std::vector<RCP<const Vector>> directions{areas};
    if (also_twice)
      directions.push_back(twice);
    const auto locked = locked_response(response, directions);
    const auto push = vector_of(map, [](GlobalIndex id) { return id == 0 ? 1 : 0; });
    Vector velocity(map);
    apply(*locked, *push, velocity);
    // V = (f - a p) / m with the pressure p for which a.V = 0: p = (a.f / m) / (a.a / m) = 1 / 2.5.
    const RCP<Vector> expected = vector_of(
        map, [&](GlobalIndex id) { return id < 3 ? ((id == 0) - 0.4 * area[id]) / mass[id] : 0; });
    EXPECT_NEAR(velocity.dot(*areas), 0, 1e-15);
    expected->update(-1, velocity, 1);
    EXPECT_LT(expected->normInf(), 1e-15) << also_twice;
    apply(*locked, *areas, velocity);
    EXPECT_LT(velocity.normInf(), 1e-15) << also_twice;
    apply(*locked_response(response, directions, 0.25), *push, velocity);
    EXPECT_NEAR(velocity.dot(*areas), 0.25, 1e-15);  // a quarter of the 1 m^3/s without the lock
  }
}

}  // namespace
}  // namespace lockstep::test
