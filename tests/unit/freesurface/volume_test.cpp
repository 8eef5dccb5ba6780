#include <gtest/gtest.h>

#include "mac/liquid/liquid_volume.hpp"

#include <random>

#include "bath.hpp"
#include "freesurface/voids.hpp"
#include "geometry/generators.hpp"
#include "mac/liquid/wet_fraction.hpp"

namespace lockstep::test {
namespace {

/// The same by samples, from the values on the simplex that holds each.
template <int dim>
double sampled_fraction(const std::array<double, 1 << dim>& phi, std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const int n = 40000;
  int n_wet = 0;
  for (int i = 0; i < n; ++i) {
    std::array<std::pair<double, int>, dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = {uniform(random), a};
    std::sort(x.rbegin(), x.rend());
    double value = phi[0], at = phi[0];
    for (int a = 0, corner = 0; a < dim; ++a) {
      corner |= 1 << x[a].second;
      value += x[a].first * (phi[corner] - at);
      at = phi[corner];
    }
    n_wet += value < 0;
  }
  return static_cast<double>(n_wet) / n;
}

template <int dim>
void expect_fractions() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int i = 0; i < 40; ++i) {
    std::array<double, 1 << dim> phi;
    for (double& value : phi)
      value = uniform(random) + 0.5 * uniform(random);
    EXPECT_NEAR(wet_fraction<dim>(phi), sampled_fraction<dim>(phi, random), 0.012);
  }
}

TEST(WetFraction, AgreesWithSamples) {
  expect_fractions<2>();
  expect_fractions<3>();
}

template <int dim>
GroupVolumes volumes(const Bath<dim>& bath, const SolidCells<dim>& solids,
                     const SignedDistance<dim>& distance) {
  const auto& grid = bath.domain.grid;
  CellField phi(grid.n_stored_cells(), 1);
  grid.for_each_stored_cell([&](int c) { phi[c] = distance(grid.center(c)); });
  std::vector<char> wet(phi.size());
  for (std::size_t c = 0; c < phi.size(); ++c)
    wet[c] = phi[c] < 0;
  LiquidVolume<dim> measure(bath.domain);
  measure.prepare(solids, phi);
  return measure.measure(phi, find_groups(bath.domain, solids, wet));
}

/// A plane that cuts the sides of the domain: exact where it is not parallel to them too.
TEST(LiquidVolume, OfATiltedPlaneIsExact) {
  Bath<2> bath(open_cube<2>(20));
  const auto solids = find_solid_cells<2>(bath.domain, nullptr);
  const auto result = volumes<2>(bath, solids, [](const Point<2>& x) { return x[1] - 0.437; });
  EXPECT_NEAR(result.total(), 0.437, 1e-14);
  ASSERT_EQ(result.area.size(), 1U);
  EXPECT_NEAR(result.area[0], 1, 1e-9);
}

template <int dim>
double error_of_ball(int n) {
  Bath<dim> bath(open_cube<dim>(n));
  const auto solids = find_solid_cells<dim>(bath.domain, nullptr);
  const double r = 0.31;
  const auto result = volumes<dim>(bath, solids, ball<dim>(Point<dim>::Constant(0.487), r));
  const double exact = dim == 2 ? pi * r * r : 4 * pi * r * r * r / 3;
  EXPECT_NEAR(result.area[0], dim * exact / r, 0.01 * dim * exact / r);
  return std::abs(result.total() - exact) / exact;
}

TEST(LiquidVolume, OfABallIsOfSecondOrder) {
  EXPECT_LT(error_of_ball<2>(32), 2e-3);
  EXPECT_LT(error_of_ball<2>(64), 0.3 * error_of_ball<2>(32));
  EXPECT_LT(error_of_ball<3>(24), 0.01);
  EXPECT_LT(error_of_ball<3>(48), 0.3 * error_of_ball<3>(24));
}

/// Between thin walls that stand on faces of cells the volume of the body grows steadily with its
/// level.
template <int dim>
void expect_no_leaps_between_shells() {
  constexpr int n = 16;
  const double h = 1.0 / n, width = 4 * h;
  Bath<dim> bath(open_cube<dim>(n));
  Point<dim> size = Point<dim>::Constant(1.5);
  SurfaceMesh<dim> walls;
  for (const double x : {6 * h, 6 * h + width}) {
    const SurfaceMesh<dim> wall = plate_surface<dim>(size, 0, h);
    const int begin = static_cast<int>(walls.vertices.size());
    for (Point<dim> v : wall.vertices) {
      v += Point<dim>::Constant(0.5);
      v[0] = x;
      walls.vertices.push_back(v);
    }
    for (auto simplex : wall.simplices) {
      for (int& v : simplex)
        v += begin;
      walls.simplices.push_back(simplex);
    }
  }
  const auto shell = snapshot<dim>(walls, Point<dim>::Zero(), false);
  const auto solids = find_solid_cells<dim>(bath.domain, shell);
  for (int i = 0; i <= 10; ++i) {
    const double level = 0.5 + (0.1 * i + 0.03) * h;
    const auto result = volumes<dim>(bath, solids, [&](const Point<dim>& x) {
      return x[0] > 6 * h && x[0] < 10 * h ? x[dim - 1] - level : 1;
    });
    ASSERT_EQ(result.volume.size(), 1U);
    EXPECT_NEAR(result.volume[0], width * level, 1e-12) << i;
    EXPECT_NEAR(result.area[0], width, 0.25 * width) << i;
  }
}

TEST(LiquidVolume, DoesNotLeapBetweenShells) {
  expect_no_leaps_between_shells<2>();
  expect_no_leaps_between_shells<3>();
}

/// A ball of liquid half full of a solid ball; the volume hardly depends on where the grid is.
template <int dim>
void expect_solid_is_taken_off() {
  Bath<dim> bath(open_cube<dim>(32));
  const double level = 0.52, r = 0.2, h = 1.0 / 32;
  for (int i = 0; i < 4; ++i) {
    const Point<dim> place = Point<dim>::Constant(0.5 + 0.23 * i * h);
    const auto solid = snapshot<dim>(ball_surface<dim>(r, 0.3 * h), place, true);
    const auto solids = find_solid_cells<dim>(bath.domain, solid);
    const auto result =
        volumes<dim>(bath, solids, [&](const Point<dim>& x) { return x[dim - 1] - level; });
    const double d = place[dim - 1] - level;  // of the centre above the level
    const double wet = dim == 2 ? r * r * std::acos(d / r) - d * std::sqrt(r * r - d * d)
                                : pi * (r - d) * (r - d) * (2 * r + d) / 3;
    EXPECT_NEAR(result.total(), level - wet, 2e-3 * wet) << i;
  }
}

TEST(LiquidVolume, LeavesOutSolids) {
  expect_solid_is_taken_off<2>();
  expect_solid_is_taken_off<3>();
}

/// What a closed shell holds, air around it, wherever its cells' centres are; beside it what whole
/// cells would hold, which changes as the shell goes over the grid. Mean squares.
template <int dim>
void expect_volume_in_shell(int n, double part) {
  Bath<dim> bath(open_cube<dim>(n));
  const double radius = 0.3;
  const double full = dim == 2 ? pi * radius * radius : 4 * pi / 3 * radius * radius * radius;
  double squares = 0, squares_of_cells = 0;
  for (int i = 0; i < 9; ++i) {
    Point<dim> center = Point<dim>::Constant(0.5);
    for (int a = 0; a < dim; ++a)
      center[a] += i * (0.37 - 0.14 * a) / n;
    const auto shell = snapshot<dim>(ball_surface<dim>(radius, 0.25 / n), center, false);
    const auto solids = find_solid_cells<dim>(bath.domain, shell);
    double cells = 0;
    const SignedDistance<dim> distance = [&](const Point<dim>& x) {
      return (x - center).norm() < radius ? -1 : 1;
    };
    bath.domain.grid.for_each_owned_cell(
        [&](int c) { cells += distance(bath.domain.grid.center(c)) < 0; });
    cells = sum_all(world(), cells) * bath.domain.cell_volume();
    const double found = volumes<dim>(bath, solids, distance).total();
    squares += (found / full - 1) * (found / full - 1);
    squares_of_cells += (cells / full - 1) * (cells / full - 1);
  }
  EXPECT_LT(squares, part * part * squares_of_cells);
}

TEST(LiquidVolume, OfAFullShellGoesWithIt) {
  expect_volume_in_shell<2>(20, 0.01);
  expect_volume_in_shell<2>(40, 0.01);
  expect_volume_in_shell<3>(20, 0.1);
}

/// Plane sides count in full; of the cells at the corners up to a half may be on the wrong side.
TEST(LiquidVolume, OfAFullChestGoesWithIt) {
  Bath<2> bath(open_cube<2>(20));
  for (int i = 0; i < 9; ++i) {
    const Point<2> center(0.5 + 0.05 * 0.11 * i, 0.5 + 0.05 * 0.07 * i), half(0.237, 0.311);
    const auto shell = snapshot<2>(box_surface<2>(2 * half, 0.02), center, false);
    const auto result =
        volumes<2>(bath, find_solid_cells<2>(bath.domain, shell), [&](const Point<2>& x) {
          return ((x - center).cwiseAbs().array() < half.array()).all() ? -1 : 1;
        });
    EXPECT_NEAR(result.total(), 4 * half[0] * half[1], 4 * 0.5 * 0.05 * 0.05) << i;
  }
}

/// Letters that touch by corners only, one of them cut by a plate.
TEST(CellGroups, HangTogetherByOpenFaces) {
  const std::vector<std::string> rows = {"##...#....", "#..##.....", "#..##..###", "####...#.#",
                                         ".......#.#", "..#....###", "..#.......", "..#.####..",
                                         "..#....#..", "..######.."};
  for (const bool has_plate : {false, true}) {
    DomainDescription<2> description = open_cube<2>(10, 10);
    Bath<2> bath(description);
    std::shared_ptr<const SurfaceSnapshot<2>> plate;
    if (has_plate)  // between the rows 6 and 7 from above
      plate = snapshot<2>(plate_surface<2>(Point<2>(3, 3), 1, 0.5), Point<2>(2.5, 3), false);
    const auto solids = find_solid_cells<2>(bath.domain, plate);
    const auto& grid = bath.domain.grid;
    std::vector<char> member(grid.n_stored_cells(), 0);
    grid.for_each_stored_cell([&](int c) {
      const Index<2> at = grid.coordinates(c);
      member[c] = rows[9 - at[1]][at[0]] == '#';
    });
    const CellGroups groups = find_groups(bath.domain, solids, member);
    EXPECT_EQ(groups.n, has_plate ? 5 : 4);
    const auto of = [&](int x, int row) {
      const int c = grid.cell({x, 9 - row});
      return groups.of_cell[c];
    };
    if (bath.domain.grid.comm()->getSize() > 1)
      continue;
    EXPECT_EQ(of(0, 0), of(4, 1));
    EXPECT_NE(of(0, 0), of(5, 0));
    EXPECT_EQ(of(7, 2), of(9, 5));
    EXPECT_EQ(of(2, 5) == of(2, 9), !has_plate);
    EXPECT_EQ(of(4, 7), of(2, 9));
    EXPECT_EQ(of(0, 2), of(0, 0));
  }
}

/// A dry cell between two bodies goes to the nearer one, wherever it lies.
TEST(CellGroups, LabelsSpreadFromTheNearestBody) {
  Bath<2> bath(open_cube<2>(20, 20));
  const auto solids = find_solid_cells<2>(bath.domain, nullptr);
  const auto& grid = bath.domain.grid;
  const Index<2> middle{9, 9};
  for (int nearer = 0; nearer < 4; ++nearer) {
    CellField phi(grid.n_stored_cells(), 0.5);
    std::vector<int> label(grid.n_stored_cells(), -1);
    const auto at = [&](int side) {
      Index<2> place = middle;
      place[side / 2] += side % 2 == 0 ? -1 : 1;
      return place;
    };
    grid.for_each_stored_cell([&](int cell) {
      for (int side = 0; side < 4; ++side)
        if (grid.coordinates(cell) == at(side)) {
          label[cell] = side;
          phi[cell] = side == nearer ? -0.2 : -0.4;
        }
    });
    bath.domain.halo.fill(label);
    bath.domain.halo.fill(phi);
    spread_labels(bath.domain, solids, phi, 1, label);
    const int cell = grid.cell(middle);
    if (cell >= 0 && grid.owned(cell)) {
      EXPECT_EQ(label[cell], nearer);
    }
  }
}

TEST(Voids, SmallOnesUnderWaterAreFilled) {
  Bath<2> bath(open_cube<2>(32, 32));
  const auto solids = find_solid_cells<2>(bath.domain, nullptr);
  const auto& grid = bath.domain.grid;
  CellField phi(grid.n_stored_cells(), -6);
  grid.for_each_stored_cell([&](int c) {
    const Index<2> at = grid.coordinates(c);
    if ((at[0] == 7 && at[1] > 3 && at[1] < 12) || (at[0] == 20 && at[1] > 3 && at[1] < 13) ||
        (at[0] == 0 && at[1] == 5))
      phi[c] = 0.5;
  });
  const auto filled = close_voids(bath.domain, solids, 8, phi);
  EXPECT_EQ(sum_all(world(), static_cast<double>(filled.size())), 8);
  const double n_left = [&] {
    double n = 0;
    grid.for_each_owned_cell([&](int c) { n += phi[c] >= 0; });
    return sum_all(world(), n);
  }();
  EXPECT_EQ(n_left, 10);  // the longer one and the one at the open side
}

/// Of a closed tank: without them nothing could take back what the correction of the volume owes.
TEST(Voids, TheLastOfAClosedTankStay) {
  Bath<2> bath(closed_cube<2>(32));
  const auto solids = find_solid_cells<2>(bath.domain, nullptr);
  const auto& grid = bath.domain.grid;
  for (const bool has_more : {false, true}) {
    CellField phi(grid.n_stored_cells(), -6 * bath.domain.spacing());
    grid.for_each_stored_cell([&](int c) {
      const Index<2> at = grid.coordinates(c);
      const bool is_small = at[0] == 7 && at[1] > 3 && at[1] < 12;
      if (is_small || (has_more && at[0] == 20 && at[1] > 3 && at[1] < 13))
        phi[c] = 0.5 * bath.domain.spacing();
    });
    const auto filled = close_voids(bath.domain, solids, 8, phi);
    EXPECT_EQ(sum_all(world(), static_cast<double>(filled.size())), has_more ? 8 : 0);
  }
}

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

/// Of faces at a side that are open in part so much flows out.
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

/// Void comes in through an open side as fast as the flow, from the first step on.
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

/// A domain that liquid fills drains below, and void comes in above.
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
