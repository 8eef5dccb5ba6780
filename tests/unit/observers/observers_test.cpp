#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <map>

#include "base/errors.hpp"
#include "conformance/fake_fluid.hpp"
#include "interfaces/energy.hpp"
#include "interfaces/liquid.hpp"
#include "observers/energy.hpp"
#include "observers/flow.hpp"
#include "observers/gauge.hpp"
#include "observers/probes.hpp"

namespace lockstep::test {
namespace {

using ::testing::DoubleNear;
using ::testing::ElementsAre;

/// Fluid right of x = 1 with the pressure 10 x and the velocity (y, 2).
class HalfPlane : public FakeFluid<2>, public FluidOutput<2> {
 public:
  const FluidOutput<2>* output() const override { return this; }
  HalfPlane() : FakeFluid<2>({{4, 4}, 0.5}, Tpetra::getDefaultComm()) {}
  std::vector<FluidSample<2>> sample(const std::vector<Point<2>>& points) const override {
    std::vector<FluidSample<2>> samples(points.size());
    for (std::size_t p = 0; p < points.size(); ++p)
      if (points[p][0] > 1)
        samples[p] = {true, 10 * points[p][0], Point<2>(points[p][1], 2)};
    return samples;
  }
};

/// Liquid below y = 1 + x / 4, and from y = 3 to y = 3.3.
class Pool : public FakeFluid<2>, public LiquidFluid<2> {
 public:
  explicit Pool(bool has_surface = true)
      : FakeFluid<2>({{4, 4}, 0.5}, Tpetra::getDefaultComm()), has_surface_(has_surface) {}
  std::vector<double> surface_distances(const std::vector<Point<2>>& points) const override {
    std::vector<double> distances;
    for (const Point<2>& x : points)
      distances.push_back(surface_distance(x));
    return distances;
  }
  double surface_distance(const Point<2>& x) const override {
    return std::min(x[1] - 1 - x[0] / 4, std::abs(x[1] - 3.15) - 0.15);
  }
  const LiquidFluid<2>* liquid() const override { return has_surface_ ? this : nullptr; }
  std::vector<WaterLevel> levels_at_solids() const override { return {}; }
  LiquidReport report() const override { return {}; }

 private:
  bool has_surface_;
};

struct NoWorks : EnergyFluid<2> {
  void begin_works() override {}
  void end_work() override {}
  std::vector<double> works() override { return {}; }
};

/// Nothing works on it.
class EnergyTeller : public FakeFluid<2> {
 public:
  EnergyTeller() : FakeFluid<2>({{4, 4}, 0.5}, Tpetra::getDefaultComm()) {}
  EnergyFluid<2>* energy() const override { return works_.get(); }

 private:
  std::unique_ptr<NoWorks> works_ = std::make_unique<NoWorks>();
};

ParameterList box(double x0, double y0, double x1, double y1) {
  ParameterList list;
  list.set("Lower", make_array<double>({x0, y0}));
  list.set("Upper", make_array<double>({x1, y1}));
  return list;
}

const std::vector<SolidState<2>> no_solids;

TEST(Probes, ARowAPoint) {
  const HalfPlane fluid;
  Probes<2> probes("points", {Point<2>(0.5, 1), Point<2>(1.5, 0.25)});
  EXPECT_EQ(probes.columns().size(), 7u);
  EXPECT_THAT(
      probes.observe({1, 0.1, fluid, no_solids}),
      ElementsAre(ElementsAre(1, 0.5, 1, 0, 0, 0, 0), ElementsAre(2, 1.5, 0.25, 1, 15, 0.25, 2)));
}

TEST(Probes, ALineEndsAtTheCorners) {
  ParameterList list = box(0, 3, 2, 5);
  list.set("Count", make_array<int>({3, 1}));
  EXPECT_THAT(box_points<2>(list), ElementsAre(Point<2>(0, 4), Point<2>(1, 4), Point<2>(2, 4)));
  list.set("Count", make_array<int>({2000, 2000}));
  EXPECT_THROW(box_points<2>(list), InputError);
}

TEST(Probes, HalfAPointIsRefused) {
  ParameterList list;
  list.set("Points", make_array<double>({1, 2, 3}));
  EXPECT_THROW(listed_points<2>(list), InputError);
}

TEST(Probes, AFluidThatCannotBeAskedIsNamed) {
  const FakeFluid<2> fluid({{4, 4}, 0.5}, Tpetra::getDefaultComm());
  Probes<2> probes("points", {Point<2>(1, 1)});
  EXPECT_THROW(probes.observe({1, 0.1, fluid, no_solids}), InputError);
}

TEST(Flow, ThroughTheOpenPartOfAWindow) {
  const HalfPlane fluid;
  // At y = 1, x from 0 to 2: squares of 0.5 in the middle of which half lie in the fluid.
  Flow<2> upwards(box(0, 1, 2, 1));
  EXPECT_THAT(upwards.observe({1, 0.1, fluid, no_solids}), ElementsAre(ElementsAre(2, 1, 15)));
  // At x = 1.5 the flow is the integral of y over 0..2, which the midpoint rule has exactly.
  Flow<2> right(box(1.5, 0, 1.5, 2));
  EXPECT_THAT(right.observe({1, 0.1, fluid, no_solids}), ElementsAre(ElementsAre(2, 2, 15)));
  EXPECT_THROW(Flow<2>(box(0, 0, 1, 1)), InputError);
}

TEST(Flow, OfAWindowThatSticksOutOnlyThePartInTheDomainIsSampled) {
  const HalfPlane fluid;  // from 0 to 2
  EXPECT_THAT(Flow<2>(box(1.5, -1e12, 1.5, 2)).observe({1, 0.1, fluid, no_solids}),
              ElementsAre(ElementsAre(2, 2, 15)));
  EXPECT_THROW(Flow<2>(box(1, 2.5, 1, 3)).observe({1, 0.1, fluid, no_solids}), InputError);
  EXPECT_THROW(Flow<2>(box(-1, 0, -1, 2)).observe({1, 0.1, fluid, no_solids}), InputError);
  EXPECT_THROW(Flow<2>(box(1, 2, 1, 3)).observe({1, 0.1, fluid, no_solids}), InputError);
}

/// Left and right of it the same fluid again.
class PeriodicHalfPlane : public HalfPlane {
 public:
  std::array<bool, 2> periodic_axes() const override { return {true, false}; }
};

TEST(Flow, TooManySquaresAreRefused) {
  const PeriodicHalfPlane fluid;
  EXPECT_THAT(Flow<2>(box(1.5, 0, 1.5, 4)).observe({1, 0.1, fluid, no_solids}),
              ElementsAre(ElementsAre(8, 4, 15)));
  EXPECT_THROW(Flow<2>(box(1.5, 0, 1.5, 1e12)).observe({1, 0.1, fluid, no_solids}), InputError);
}

ParameterList line(double x0, double y0, double x1, double y1) {
  ParameterList list;
  list.set("Points", make_array<double>({x0, y0, x1, y1}));
  return list;
}

TEST(Flow, ThroughALineInAnyDirection) {
  const HalfPlane fluid;
  const auto reading = [&](const ParameterList& list) {
    return Flow<2>(list).observe({1, 0.1, fluid, no_solids}).at(0);
  };
  EXPECT_THAT(reading(line(1.5, 0, 1.5, 2)), ElementsAre(2, 2, 15));
  EXPECT_THAT(reading(line(1.5, 2, 1.5, 0)), ElementsAre(-2, 2, 15));
  // The integral of y dy - 2 dx, both linear.
  EXPECT_THAT(reading(line(1.2, 0, 1.8, 1.5)),
              ElementsAre(DoubleNear(1.125 - 1.2, 1e-12), DoubleNear(std::hypot(0.6, 1.5), 1e-12),
                          DoubleNear(15, 1e-12)));
  EXPECT_THROW(reading(line(1.2, 0, 1.8, 2.5)), InputError);
  EXPECT_THROW(Flow<2>(line(1, 1, 1, 1)), InputError);
}

TEST(Flow, AWindowIsGivenInOneWay) {
  ParameterList both = box(1.5, 0, 1.5, 2);
  both.set("Points", make_array<double>({1, 0, 1, 1}));
  EXPECT_THROW(Flow<2>{both}, InputError);
  EXPECT_THROW(Flow<2>{ParameterList()}, InputError);
}

TEST(Gauge, MeasuresWhatIsWet) {
  const Pool pool;
  const auto reading = [&](const ParameterList& list) {
    return Gauge<2>(list).observe({1, 0.1, pool, no_solids}).at(0);
  };
  EXPECT_EQ(Gauge<2>(line(0, 0, 0, 1)).columns().size(), 2u);
  EXPECT_THAT(reading(line(1, 0, 1, 2)),
              ElementsAre(DoubleNear(1.25, 1e-12), DoubleNear(1.25, 1e-12)));
  EXPECT_THAT(reading(line(1, 2, 1, 0)),
              ElementsAre(DoubleNear(1.25, 1e-12), DoubleNear(2, 1e-12)));
  EXPECT_THAT(reading(line(0, 0, 0, 4)), ElementsAre(DoubleNear(1.3, 0.2), DoubleNear(3.3, 0.1)));
  EXPECT_THAT(reading(line(0, 0.5, 4, 0.5)), ElementsAre(4, 4));
  EXPECT_THAT(reading(line(0, 2, 0, 2.5)), ElementsAre(0, 0));
}

TEST(Gauge, WhatHasNoSurfaceOrNoLengthIsRefused) {
  const Pool full(false);
  const HalfPlane other;
  Gauge<2> gauge(line(0, 0, 0, 1));
  EXPECT_THROW(gauge.observe({1, 0.1, full, no_solids}), InputError);
  EXPECT_THROW(gauge.observe({1, 0.1, other, no_solids}), InputError);
  EXPECT_THROW(Gauge<2>(line(1, 1, 1, 1)), InputError);
  EXPECT_THROW(Gauge<2>(line(0, 0, 1e9, 0)).observe({1, 0.1, Pool(), no_solids}), InputError);
}

TEST(Energy, SaysOfEachColumnWhatItsNameSays) {
  const EnergyTeller fluid;
  EnergyBudget book;
  book.joints = 1000;
  book.loads = 2000;
  book.kinetic_change = 1;
  book.elastic_change = 2;
  book.fluid_friction = 4;
  book.solid_friction = 8;
  book.transport = 16;
  book.pressure = 32;
  book.lumping = 64;
  book.elasticity = 128;
  book.ties = 256;
  Energy<2> energy;
  const RunView<2> run{1, 0.1, fluid, no_solids, &book};
  energy.follow(run);
  const std::vector<ObservedColumn> columns = energy.columns();
  const std::vector<double> row = energy.observe(run).at(0);
  ASSERT_EQ(row.size(), columns.size());
  std::map<std::string, double> values;
  for (std::size_t c = 0; c < columns.size(); ++c)
    values[columns[c].name] = row[c];
  EXPECT_EQ(values, (std::map<std::string, double>{{"joints", 1000},
                                                   {"loads", 2000},
                                                   {"kinetic_change", 1},
                                                   {"elastic_change", 2},
                                                   {"fluid_friction", 4},
                                                   {"solid_friction", 8},
                                                   {"transport", 16},
                                                   {"pressure", 32},
                                                   {"lumping", 64},
                                                   {"elasticity", 128},
                                                   {"ties", 256},
                                                   {"left", 3000 - 511}}));
}

}  // namespace
}  // namespace lockstep::test
