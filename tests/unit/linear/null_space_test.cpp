// Vectors that are constant on regions project as the long vectors do.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "linear/null_space.hpp"

namespace lockstep::test {

namespace {

constexpr int n_local = 40, n_regions = 3;

/// Regions 0 to 2 and none, in runs that go over the ends of ranks; two vectors, one on regions 0
/// and 1.
struct Regions {
  Communicator comm = Tpetra::getDefaultComm();
  RCP<const Map> map = make_map(n_local, comm);
  std::vector<int> region_of_row;
  NullSpace space;

  Regions() {
    for (int row = 0; row < n_local; ++row)
      region_of_row.push_back(static_cast<int>(map->getGlobalElement(row) / 7 % 4) - 1);
    const auto rows = RowRegions::from(map, n_regions, region_of_row);
    const std::vector<double> n = rows->n_rows();
    // (3, -1) on regions 0 and 1, orthonormal with 1 on region 2
    const double size = std::sqrt(9 * n[0] + n[1]);
    space = NullSpace(rows, {{{0, 3 / size}, {1, -1 / size}}, {{2, 1 / std::sqrt(n[2])}}});
  }
  RCP<Vector> wavy() const {
    const auto x = make_vector(map);
    for (int row = 0; row < n_local; ++row)
      x->replaceLocalValue(row, std::sin(3. * map->getGlobalElement(row)) + 0.2);
    return x;
  }
};

}  // namespace

TEST(RegionNullSpace, ProjectsAsItsVectorsDo) {
  const Regions r;
  ASSERT_EQ(r.space.size(), 2u);
  const RCP<Vector> x = r.wavy(), expected = r.wavy();
  double removed = 0;
  for (std::size_t k = 0; k < 2; ++k) {
    const RCP<Vector> direction = r.space.vector(k);
    EXPECT_NEAR(direction->norm2(), 1, 1e-14);
    const double component = direction->dot(*expected);
    expected->update(-component, *direction, 1);
    removed += component * component;
  }
  EXPECT_NEAR(project_out(r.space, *x), std::sqrt(removed), 1e-13);
  expected->update(-1, *x, 1);
  EXPECT_LT(expected->normInf(), 1e-14);
  EXPECT_LT(project_out(r.space, *x), 1e-13);
  EXPECT_EQ(project_out(NullSpace(), *x), 0);
}

TEST(RegionNullSpace, IsFoundFromItsVectors) {
  const Regions r;
  const NullSpace found = null_space_of({r.space.vector(0), r.space.vector(1)});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found.regions().n_regions, 4);  // one of them where both are zero
  for (std::size_t k = 0; k < 2; ++k) {
    const RCP<Vector> difference = found.vector(k);
    difference->update(-1, *r.space.vector(k), 1);
    EXPECT_EQ(difference->normInf(), 0);
  }
}

TEST(RegionNullSpace, MovesToOtherRows) {
  const Regions r;
  const auto map = make_map(2 * n_local, r.comm);
  std::vector<int> place;
  for (int row = 0; row < n_local; ++row)
    place.push_back(2 * (n_local - 1 - row));
  const NullSpace moved = r.space.moved_to(map, place);
  for (std::size_t k = 0; k < 2; ++k) {
    const RCP<Vector> before = r.space.vector(k), after = moved.vector(k);
    EXPECT_NEAR(after->norm2(), 1, 1e-14);
    for (int row = 0; row < n_local; ++row)
      EXPECT_EQ(after->getData()[place[row]], before->getData()[row]);
  }
}

}  // namespace lockstep::test
