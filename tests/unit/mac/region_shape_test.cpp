#include "staggered/domain/region_shape.hpp"

#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "mac_cases.hpp"
#include "parameters/validate.hpp"

namespace lockstep::test {
namespace {

RegionShape<3> shape_of(ParameterList list) {
  ParameterList declared;
  declare_shape<3>(declared);
  validate(list, declared, Source{"test", {}}, "Region");
  return read_shape<3>(list);
}

/// A cylinder of radius 1, 4 long, about (1, 2, 3), along the diagonal of x and y.
ParameterList oblique_cylinder() {
  ParameterList list("Region");
  list.set("Shape", "cylinder").set("Radius", 1.0).set("Length", 4.0);
  list.set("Center", numbers({1.0, 2.0, 3.0})).set("Axis", numbers({3.0, 3.0, 0.0}));
  return list;
}

TEST(RegionShape, ACylinderIsWhereItsAxisSays) {
  const RegionShape<3> shape = shape_of(oblique_cylinder());
  const Point<3> center(1, 2, 3), along = Point<3>(1, 1, 0) / std::sqrt(2.0);
  EXPECT_NEAR(shape.distance(center), -1, 1e-14);
  EXPECT_NEAR(shape.distance(center + 1.5 * along), -0.5, 1e-14);
  EXPECT_NEAR(shape.distance(center + 3 * Point<3>::Unit(2)), 2, 1e-14);
  EXPECT_NEAR(shape.distance(center + 5 * along + 5 * Point<3>::Unit(2)), 5, 1e-14);  // 3, 4, 5
  EXPECT_TRUE(shape.contains(center - 1.99 * along + 0.99 * Point<3>::Unit(2)));
  EXPECT_FALSE(shape.contains(center - 2.01 * along));
}

TEST(RegionShape, BoundsJustHoldACylinder) {
  const RegionShape<3> shape = shape_of(oblique_cylinder());
  const double reach =
      3 / std::sqrt(2.0);  // half of the length and the radius, both in the oblique
  EXPECT_LE((shape.bounds().max() - Point<3>(1 + reach, 2 + reach, 4)).norm(), 1e-14);
  EXPECT_LE((shape.bounds().min() - Point<3>(1 - reach, 2 - reach, 2)).norm(), 1e-14);
}

TEST(RegionShape, SizesOfOtherShapesAreRefused) {
  EXPECT_THROW(shape_of(oblique_cylinder().set("Lower", numbers({0.0, 0.0, 0.0}))), InputError);
  EXPECT_THROW(shape_of(oblique_cylinder().set("Axis", numbers({0.0, 0.0, 0.0}))), InputError);
  EXPECT_THROW(shape_of(oblique_cylinder().set("Shape", "ball")), InputError);
}

}  // namespace
}  // namespace lockstep::test
