#include <gtest/gtest.h>

#include "liquid/common/volume_ledger.hpp"

#include "bath.hpp"
#include "geometry/generators.hpp"
#include "liquid/common/liquid_volume.hpp"

namespace lockstep::test {
namespace {

template <int dim>
double volume_of_ball(double r) {
  return dim == 2 ? pi * r * r : 4 * pi * r * r * r / 3;
}

/// Two balls swirl; each keeps its own volume. Without correction they do not.
template <int dim>
void expect_bodies_keep_volume() {
  const int n = dim == 2 ? 64 : 32;
  for (const std::string correction : {"component", "global", "none"}) {
    Bath<dim> bath(open_cube<dim>(n));
    ParameterList list;
    list.set("Volume Correction", correction);
    auto model = bath.make("level set", list);
    Point<dim> a = Point<dim>::Constant(0.5), b = a;
    a[0] = 0.25;
    b[0] = 0.7;
    model->initialise(
        [&](const Point<dim>& x) { return std::min((x - a).norm() - 0.13, (x - b).norm() - 0.19); },
        nullptr);
    const double start = model->ledger().volume;
    EXPECT_NEAR(start, volume_of_ball<dim>(0.13) + volume_of_ball<dim>(0.19), 0.02 * start);
    bath.set_velocity(swirl<dim>);
    for (int i = 0; i < 40; ++i)
      bath.step(*model, 0, 0.05);
    const LiquidLedger ledger = model->ledger();
    EXPECT_EQ(ledger.n_components, 2);
    EXPECT_NEAR(ledger.target, start, 1e-12 * start);
    if (correction == "none") {
      EXPECT_GT(std::abs(ledger.volume - start), 0.02 * start);
      continue;
    }
    EXPECT_NEAR(ledger.volume, start, 1e-3 * start);
    // By samples: the smaller one alone.
    const double angle = 2;
    Point<dim> turned = a;
    turned[0] = 0.5 - 0.25 * std::cos(angle);
    turned[1] = 0.5 - 0.25 * std::sin(angle);
    double small = 0;
    bath.domain.grid.for_each_owned_cell([&](int c) {
      const Point<dim> x = bath.domain.grid.center(c);
      if ((x - turned).norm() < 0.2 && model->distance()[c] < 1.0 / n)
        small += std::clamp(0.5 - model->distance()[c] * n, 0.0, 1.0);
    });
    small = sum_all(world(), small) * std::pow(1.0 / n, dim);
    if (correction == "component") {
      EXPECT_NEAR(small, volume_of_ball<dim>(0.13), 0.05 * small);
    }
  }
}

TEST(VolumeLedger, EachBodyKeepsItsVolume) {
  expect_bodies_keep_volume<2>();
  expect_bodies_keep_volume<3>();
}

void expect_known_fluxes(const std::string& name) {
  Bath<2> bath(open_cube<2>(40));
  auto model = bath.make(name);
  model->initialise([](const Point<2>& x) { return x[1] - 0.3; }, nullptr);
  // Water leaves through the lower side at 0.1 m/s.
  bath.set_velocity([](const Point<2>&) { return Point<2>(0, -0.1); });
  for (int i = 0; i < 10; ++i)
    bath.step(*model, 0.1 * i, 0.1);
  EXPECT_NEAR(model->ledger().target, 0.2, 1e-12);
  EXPECT_NEAR(model->ledger().volume, 0.2, 1e-4);
  bath.set_velocity([](const Point<2>&) { return Point<2>(0, 0); });
  bath.sources = {ball<2>(Point<2>(0.3, 0.7), 0.1)};
  bath.step(*model, 1, 0.1);
  EXPECT_NEAR(model->ledger().target, 0.2 + pi * 0.01, 5e-4);
  EXPECT_NEAR(model->ledger().volume, model->ledger().target, 1e-9);
  EXPECT_EQ(model->ledger().n_components, 2);
  bath.sources = {};
  bath.sinks = {ball<2>(Point<2>(0.3, 0.7), 0.12), ball<2>(Point<2>(0.7, 0.2), 0.1)};
  bath.step(*model, 1.1, 0.1);
  EXPECT_NEAR(model->ledger().target, 0.2 - pi * 0.005, 5e-4);
  EXPECT_EQ(model->ledger().n_components, 1);
  EXPECT_NEAR(model->ledger().lost, 0, 1e-14);
}

TEST(VolumeLedger, KnowsWhatSourcesSinksAndSidesDo) {
  expect_known_fluxes("level set");
  expect_known_fluxes("volume of fluid");
}

/// A face at a side that is partly open lets out in proportion to its aperture.
TEST(VolumeLedger, LosesWhatOpenPartsOfFacesLetThrough) {
  for (const char* const name : {"level set", "volume of fluid"}) {
    Bath<2> bath(open_cube<2>(40));
    auto model = bath.make(name);
    model->initialise([](const Point<2>& x) { return x[1] - 0.3; }, nullptr);
    bath.set_velocity([](const Point<2>&) { return Point<2>(0, -0.1); });
    bath.open = [&](int, int cell) { return bath.domain.grid.center(cell)[0] < 0.5 ? 0.25 : 1; };
    for (int i = 0; i < 5; ++i)
      bath.step(*model, 0.1 * i, 0.1);
    EXPECT_NEAR(model->ledger().target, 0.3 - 0.05 * 0.625, 1e-12) << name;
  }
}

/// A box and the level that it stands in rise together: what the ledger tells is the volume of the
/// phi that is there after the step, the part of it in the box included.
template <int dim>
void expect_ledger_of_final_distance(const std::string& correction) {
  const int n = dim == 2 ? 32 : 16;
  const double h = 1.0 / n, dt = 0.1, rise = 0.5 * h;
  Bath<dim> bath(closed_cube<dim>(n));
  ParameterList list;
  list.set("Volume Correction", correction);
  auto model = bath.make("level set", list);
  const SurfaceMesh<dim> box = box_surface<dim>(Point<dim>::Constant(0.33), h);
  const auto at = [&](int i) {
    return snapshot<dim>(box, Point<dim>::Constant(0.47) + i * rise * Point<dim>::Unit(dim - 1),
                         true);
  };
  model->initialise([&](const Point<dim>& x) { return x[dim - 1] - 0.45; }, at(0));
  bath.set_velocity(
      [&](const Point<dim>&) { return Point<dim>(rise / dt * Point<dim>::Unit(dim - 1)); });
  for (int i = 0; i < 6; ++i) {
    bath.move(at(i), at(i + 1), dt);
    bath.step(*model, i * dt, dt);
    const CellField& phi = model->distance();
    const auto solids = find_solid_cells<dim>(bath.domain, bath.surface.after);
    std::vector<char> wet(phi.size());
    for (std::size_t cell = 0; cell < phi.size(); ++cell)
      wet[cell] = phi[cell] < 0;
    LiquidVolume<dim> measure(bath.domain);
    measure.prepare(solids, phi);
    const double found = measure.measure(phi, find_groups(bath.domain, solids, wet)).total();
    EXPECT_NEAR(model->ledger().volume, found, 1e-12) << correction << " " << i;
  }
}

TEST(VolumeLedger, TellsTheVolumeBesideSolidsThatRise) {
  for (const std::string correction : {"component", "none"}) {
    expect_ledger_of_final_distance<2>(correction);
    expect_ledger_of_final_distance<3>(correction);
  }
}

/// A film 0.3 h thick on a plate 0.1 h above the lower faces of cells, across all 8 of the domain:
/// it does not reach to their centres, so that it is of no body. Of each cell 1/2 - 0.1 is beside
/// the plate and above it, and 1/2 - phi/h = 0.4 of that is liquid.
struct Film {
  static constexpr int n = 8;
  static constexpr double h = 1.0 / n;
  Film() : bath(closed_cube<2>(n)), ledger(bath.domain, VolumeParameters()) {
    const auto plate =
        snapshot<2>(plate_surface<2>(Point<2>(3, 3), 1, h), Point<2>(0.5, 4.1 * h), false);
    solids = find_solid_cells<2>(bath.domain, plate);
    ledger.begin(
        solids, field([](const Point<2>& x) { return x[1] < 4.1 * h ? 0.6 * h : x[1] - 4.4 * h; }));
  }
  CellField field(const SignedDistance<2>& distance) const {
    const TiledGrid<2>& grid = bath.domain.grid;
    CellField phi(grid.n_stored_cells(), 1);
    grid.for_each_stored_cell([&](int cell) { phi[cell] = distance(grid.center(cell)); });
    return phi;
  }
  CellField nothing() const {
    return field([](const Point<2>&) { return h; });
  }

  static constexpr double volume = 8 * 0.4 * 0.4 * h * h;
  Bath<2> bath;
  SolidCells<2> solids;
  VolumeLedger<2> ledger;
};

TEST(VolumeLedger, WhatNoCellShowsIsLostWhenItGoes) {
  Film film;
  EXPECT_EQ(film.ledger.state().n_components, 0);
  EXPECT_NEAR(film.ledger.state().volume, Film::volume, 1e-12);
  EXPECT_NEAR(film.ledger.state().target, Film::volume, 1e-12);
  film.ledger.inherit(film.solids, film.solids, film.nothing(), {}, 1);
  EXPECT_EQ(film.ledger.state().volume, 0);
  EXPECT_EQ(film.ledger.state().target, 0);
  EXPECT_NEAR(film.ledger.state().lost, Film::volume, 1e-12);
}

TEST(VolumeLedger, ASinkTakesWhatNoCellShows) {
  Film film;
  film.ledger.remove(film.solids, film.nothing());
  EXPECT_EQ(film.ledger.state().volume, 0);
  EXPECT_EQ(film.ledger.state().target, 0);
  EXPECT_EQ(film.ledger.state().lost, 0);
}

/// Air comes in through an open side as fast as the flow, from the first step on.
template <int dim>
void expect_void_comes_in(const std::string& name, double per_step, int axis, int side) {
  const int n = dim == 2 ? 40 : 20, n_steps = 10;
  const double h = 1.0 / n, dt = 0.1;
  Bath<dim> bath(open_cube<dim>(n));
  ParameterList list;
  list.set("Volume Correction", "none");
  auto model = bath.make(name, list);
  model->initialise([](const Point<dim>&) { return -1; }, nullptr);
  const double inward = side == 0 ? 1 : -1;
  bath.set_velocity([&](const Point<dim>&) {
    return Point<dim>(inward * per_step * h / dt * Point<dim>::Unit(axis));
  });
  double error = 0;
  for (int i = 1; i <= n_steps; ++i) {
    bath.step(*model, i * dt, dt);
    const double front = i * per_step * h;
    bath.domain.grid.for_each_owned_cell([&](int cell) {
      const Point<dim> x = bath.domain.grid.center(cell);
      const double exact = front - (side == 0 ? x[axis] : 1 - x[axis]);
      if (std::abs(exact) < 1.01 * h)
        error = std::max(error, std::abs(model->distance()[cell] - exact));
    });
  }
  EXPECT_LT(max_all(world(), error), 0.1 * h) << name << " " << per_step;
}

TEST(VolumeLedger, VoidComesInThroughAnOpenSideWithTheFlow) {
  for (const char* const name : {"level set", "particle level set"})
    for (const double per_step : {0.05, 0.2, 0.3, 0.7}) {
      expect_void_comes_in<2>(name, per_step, 0, 0);
      expect_void_comes_in<2>(name, per_step, 1, 1);
      expect_void_comes_in<3>(name, per_step, 2, 1);
    }
}

/// A domain that liquid fills drains below, and air comes in above.
TEST(VolumeLedger, AFullDomainDrains) {
  for (const char* const name : {"level set", "particle level set", "volume of fluid"}) {
    Bath<2> bath(open_cube<2>(40));
    auto model = bath.make(name);
    model->initialise([](const Point<2>&) { return -1; }, nullptr);
    EXPECT_NEAR(model->ledger().volume, 1, 1e-12);
    bath.set_velocity([](const Point<2>&) { return Point<2>(0, -0.1); });
    for (int i = 0; i < 10; ++i)
      bath.step(*model, 0.1 * i, 0.1);
    EXPECT_NEAR(model->ledger().target, 0.9, 1e-12) << name;
    EXPECT_NEAR(model->ledger().volume, 0.9, 1e-3) << name;
  }
}

/// Liquid goes out through a side and does not come back in.
TEST(VolumeLedger, NothingWetComesInThroughAnOpenSide) {
  for (const char* const name : {"level set", "particle level set", "volume of fluid"}) {
    Bath<2> bath(open_cube<2>(40));
    auto model = bath.make(name);
    model->initialise([](const Point<2>& x) { return x[0] - 0.3; }, nullptr);
    for (int i = 0; i < 20; ++i) {
      const double u = i < 10 ? -0.1 : 0.1;
      bath.set_velocity([u](const Point<2>&) { return Point<2>(u, 0); });
      bath.step(*model, 0.1 * i, 0.1);
    }
    EXPECT_NEAR(model->ledger().target, 0.2, 1e-12);
    EXPECT_NEAR(model->ledger().volume, 0.2, 2e-3);
    bath.domain.grid.for_each_owned_cell([&](int c) {
      const double x = bath.domain.grid.center(c)[0];
      if (x < 0.07 || x > 0.33) {
        EXPECT_GT(model->distance()[c], 0) << x;
      } else if (x > 0.13 && x < 0.27) {
        EXPECT_LT(model->distance()[c], 0) << x;
      }
    });
  }
}

}  // namespace
}  // namespace lockstep::test
