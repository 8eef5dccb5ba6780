// Flow through planes that solids cover in part.
#include <gtest/gtest.h>

#include "cutcell/flux_coupling.hpp"
#include "unit/mac/mac_cases.hpp"

namespace lockstep::test {
namespace {

/// A channel from y = 2.6 to y = 10.4 between two boxes, which cover a part of the outermost faces.
std::unique_ptr<MacFluid<2>> channel(const FluxCoupling<2>& coupling) {
  Case<2> scene({8, 13}, 1.0);
  scene.side("x lower", "periodic").side("x upper", "periodic");
  auto fluid = scene.make();
  Solids<2> solids;
  solids.add(box_surface<2>(Point<2>(20, 4.6), 1.0), Point<2>(4, 0.3), true);
  solids.add(box_surface<2>(Point<2>(20, 4.6), 1.0), Point<2>(4, 12.7), true);
  fluid->set_geometry(solids.snapshot(), coupling);
  fluid->begin_prediction();
  fluid->set_prediction([](const Point<2>&) { return Point<2>(2, 0); });
  return fluid;
}

}  // namespace

TEST(FlowAcross, FacesCountByTheirOpenPart) {
  const FluxCoupling<2> coupling{FluxOptions()};
  const auto fluid = channel(coupling);
  for (const double x : {3.0, 3.3, 8.0}) {
    double open = 0, rate = 0;
    std::vector<Point<2>> points;
    for (int j = 0; j < 13; ++j)
      points.emplace_back(x, j + 0.5);
    for (const FlowSample& sample : fluid->output()->flow_across(0, points)) {
      open += sample.open;
      rate += sample.rate;
    }
    EXPECT_NEAR(open, 7.8, 1e-5) << x;  // faces are open in steps of 2^-20
    EXPECT_NEAR(rate, 15.6, 1e-5) << x;
  }
}

// A plate in the last half cell before the seam of a periodic axis.
TEST(FlowAcross, AShellBesideASeamIsTight) {
  for (const double x : {7.8, 8.0, 0.0, 0.2}) {
    Case<2> scene({8, 8}, 1.0);
    scene.side("x lower", "periodic").side("x upper", "periodic");
    const auto fluid = scene.make();
    Solids<2> solids;
    solids.add(plate_surface<2>(Point<2>(0, 20), 0, 1.0), Point<2>(x, 4), false);
    fluid->set_geometry(solids.snapshot(), FluxCoupling<2>(FluxOptions()));
    EXPECT_EQ(sum_all(world(), static_cast<GlobalIndex>(fluid->coupled_volumes().size())), 8) << x;
  }
}

}  // namespace lockstep::test
