// Velocities that are carried on into the air above a free surface.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "liquid/surface/velocity_extension.hpp"
#include "liquid/surface/wave_damping.hpp"
#include "liquid_cases.hpp"

namespace lockstep::test {
namespace {

/// Extends what is `velocity` in the liquid and 1e3 elsewhere; the state it was done in.
template <int dim>
struct Extended {
  FaceField<dim> velocity;
  GridState<dim> state;
};
template <int dim>
Extended<dim> extended(const MacFluid<dim>& fluid, const CellField& distance, double band,
                       const std::function<Point<dim>(const Point<dim>&)>& inside,
                       double known = 1e300) {
  const MacDomain<dim>& domain = fluid.domain();
  Extended<dim> result{{}, fluid.geometry().state};
  for (int axis = 0; axis < dim; ++axis) {
    result.velocity[axis].assign(domain.grid.n_stored_cells(), 1e3);
    domain.grid.for_each_owned_face(axis, [&](int cell) {
      if (is_wet(result.state.faces[axis][cell]))
        result.velocity[axis][cell] = inside(domain.grid.face_center(axis, cell))[axis];
    });
  }
  domain.halo.fill(result.velocity);
  KeptSurface<dim> kept;
  const auto nearby = kept.of(result.state.surface, domain.grid, 2);
  const VelocityExtension<dim> extension(domain, {distance, known, band}, fluid.geometry().near,
                                         *nearby, result.state);
  extension.extend(
      0, [](const SurfacePoint<dim>&) { return Point<dim>(Point<dim>::Constant(7)); },
      result.velocity);
  return result;
}

template <int dim>
void expect_constants_go_on() {
  const double h = 0.05;
  Case<dim> scene(cube<dim>(20), h);
  add_ball<dim>(scene, Point<dim>::Constant(0.48), 0.2);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  CellField distance(fluid->domain().grid.n_stored_cells());
  fluid->domain().grid.for_each_stored_cell([&](int cell) {
    distance[cell] = (fluid->domain().grid.center(cell) - Point<dim>::Constant(0.48)).norm() - 0.2;
  });
  const Point<dim> constant = Point<dim>::Constant(-2.5);
  const auto result = extended<dim>(*fluid, distance, 4 * h, [&](const auto&) { return constant; });
  GlobalIndex n = 0;
  for (int axis = 0; axis < dim; ++axis)
    fluid->domain().grid.for_each_owned_face(axis, [&](int cell) {
      if (result.state.faces[axis][cell] != FaceState::extended)
        return;
      ++n;
      EXPECT_EQ(result.velocity[axis][cell], -2.5);
    });
  EXPECT_GT(sum_all(world(), n), dim == 2 ? 200 : 2000);
}
TEST(VelocityExtension, ConstantVelocitiesAreCarriedOnExactly) {
  expect_constants_go_on<2>();
  expect_constants_go_on<3>();
}

/// In long steps, which need them far beyond where the distance is known: on all sides of a ball.
template <int dim>
void expect_constants_go_far() {
  constexpr int n = dim == 2 ? 40 : 28;
  const double h = 1.0 / n, radius = (dim == 2 ? 7 : 3) * h;
  const Point<dim> center = Point<dim>::Constant(0.5);
  Case<dim> scene(cube<dim>(n), h);
  add_ball<dim>(scene, center, radius);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  const TiledGrid<dim>& grid = fluid->domain().grid;
  const auto distance_at = [&](const Point<dim>& x) { return (x - center).norm() - radius; };
  CellField distance(grid.n_stored_cells());
  grid.for_each_stored_cell(
      [&](int cell) { distance[cell] = std::min(distance_at(grid.center(cell)), 4 * h); });
  const Point<dim> constant = Point<dim>::Constant(-2.5);
  const auto result = extended<dim>(
      *fluid, distance, 11 * h, [&](const auto&) { return constant; }, 4 * h);
  GlobalIndex n_far = 0;
  for (int axis = 0; axis < dim; ++axis)
    grid.for_each_owned_face(axis, [&](int cell) {
      const FaceState state = result.state.faces[axis][cell];
      const double far = distance_at(grid.face_center(axis, cell));
      if (cells_of_face(grid, result.state.cells, axis, cell).at_side())
        return;
      if (is_wet(state) || state == FaceState::extended) {
        ASSERT_EQ(result.velocity[axis][cell], -2.5) << far / h;
        n_far += far > 5 * h;
      } else {
        EXPECT_GT(far, 10 * h);
      }
    });
  EXPECT_GT(sum_all(world(), n_far), dim == 2 ? 1000 : 10000);
}
TEST(VelocityExtension, ConstantVelocitiesAreCarriedOnBeyondTheKnownDistance) {
  expect_constants_go_far<2>();
  expect_constants_go_far<3>();
}

/// A band that is wider than anything costs no more than the domain has cells.
TEST(VelocityExtension, EndsWhereNothingIsLeft) {
  constexpr int n = 20;
  const double h = 1.0 / n;
  Case<2> scene({n, n}, h);
  add_ball<2>(scene, {0.5, 0.5}, 3 * h);
  const auto fluid = make_liquid<2>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<2>());
  const TiledGrid<2>& grid = fluid->domain().grid;
  CellField start(grid.n_stored_cells());
  grid.for_each_stored_cell([&](int cell) {
    start[cell] = std::min((grid.center(cell) - Point<2>(0.5, 0.5)).norm() - 3 * h, 4 * h);
  });
  const auto result = [&](double band) {
    CellField distance = start;
    return extended<2>(
        *fluid, distance, band * h, [](const Point<2>& x) { return wavy_velocity<2>(x); }, 4 * h);
  };
  const auto wide = result(100), endless = result(1e10);
  for (int axis = 0; axis < 2; ++axis)
    grid.for_each_owned_face(axis, [&](int cell) {
      EXPECT_EQ(wide.velocity[axis][cell], endless.velocity[axis][cell]);
      EXPECT_NE(endless.state.faces[axis][cell], FaceState::inactive);
    });
}

/// Above level water, what varies along the surface alone goes straight up, whatever is beside it.
template <int dim>
void expect_columns_go_on() {
  constexpr int n = 20;
  const double h = 1.0 / n, height = 0.5 + 0.37 * h;
  const Point<dim> up = Point<dim>::Unit(dim - 1);
  Case<dim> scene(cube<dim>(n), h);
  scene.fluid.set("Gravity", components<dim>(-9.81 * up));
  add_level<dim>(scene, height);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  const TiledGrid<dim>& grid = fluid->domain().grid;
  CellField distance(grid.n_stored_cells());
  grid.for_each_stored_cell([&](int cell) { distance[cell] = grid.center(cell).dot(up) - height; });
  const auto inside = [&](const Point<dim>& x) {
    return Point<dim>(Point<dim>::Constant(std::cos(37 * x[0])));
  };
  const auto result = extended<dim>(*fluid, distance, 4 * h, inside);
  GlobalIndex n_faces = 0;
  for (int axis = 0; axis < dim; ++axis)
    grid.for_each_owned_face(axis, [&](int cell) {
      const FaceCells cells = cells_of_face(grid, result.state.cells, axis, cell);
      if (cells.at_side() || result.state.faces[axis][cell] != FaceState::extended)
        return;
      ++n_faces;
      EXPECT_NEAR(result.velocity[axis][cell], inside(grid.face_center(axis, cell))[axis], 1e-9);
    });
  EXPECT_GT(sum_all(world(), n_faces), 100);
}
TEST(VelocityExtension, VelocitiesGoOnAtRightAnglesToTheSurface) {
  expect_columns_go_on<2>();
  expect_columns_go_on<3>();
}

/// Waves of four cells on level water, and tilted water that moves as one.
TEST(VelocityExtension, ShortWavesAloneAreDamped) {
  constexpr int n = 32;
  const double h = 1.0 / n, g = 9.81, dt = 0.001;
  const auto lead = [&](const Point<2>& gravity, double height,
                        const std::function<Point<2>(const Point<2>&)>& velocity, auto check) {
    Case<2> scene({n, n}, h);
    scene.fluid.set("Gravity", components<2>(gravity));
    add_level<2>(scene, height);
    const auto fluid = make_liquid<2>(scene);
    fluid->set_geometry(nullptr, BlockedFaces<2>());
    const TiledGrid<2>& grid = fluid->domain().grid;
    const Point<2> up = -gravity.normalized();
    CellField distance(grid.n_stored_cells());
    grid.for_each_stored_cell(
        [&](int cell) { distance[cell] = grid.center(cell).dot(up) - height; });
    const auto result = extended<2>(*fluid, distance, 6 * h, velocity);
    MacGeometry<2> geometry = fluid->geometry();
    geometry.state = result.state;
    const CellField found = short_wave_filter<2>(fluid->domain(), geometry, distance,
                                                 result.velocity, gravity.norm(), dt);
    grid.for_each_owned_cell([&](int cell) {
      const Point<2> x = grid.center(cell);
      if ((x.array() > 0.2).all() && (x.array() < 0.8).all() && std::abs(distance[cell]) < 1.5 * h)
        check(x, found[cell]);
    });
  };
  const double k = 2 * std::acos(-1.0) / (4 * h), ahead = 2 * std::sqrt(h / g);
  lead(
      {0, -g}, 0.5 + 0.37 * h,
      [&](const Point<2>& x) { return Point<2>(0, 1e-3 * std::cos(k * x[0])); },
      [&](const Point<2>& x, double found) {
        EXPECT_NEAR(found, -ahead * 0.25 * 1e-3 * std::cos(k * x[0]), 1e-12);
      });
  lead(
      {3, -9}, 0.31, [](const Point<2>&) { return Point<2>(0.3, -0.2); },
      [&](const Point<2>&, double found) { EXPECT_NEAR(found, 0, 1e-15); });
}

/// A thin shell between liquid and air: beyond it nothing is known of the liquid.
TEST(VelocityExtension, VelocitiesAreNotCarriedThroughAShell) {
  const double h = 0.05;
  Case<2> scene({20, 20}, h);
  scene.fluid.set("Gravity", numbers({0.0, -1.0}));
  add_level<2>(scene, 0.512);
  const auto fluid = make_liquid<2>(scene);
  Solids<2> solids;
  solids.add(plate_surface<2>({1.2, 0}, 1, h), Point<2>(0.5, 0.522), false);
  fluid->set_geometry(solids.snapshot(), BlockedFaces<2>());
  const auto& grid = fluid->domain().grid;
  CellField distance(grid.n_stored_cells());
  grid.for_each_stored_cell([&](int cell) { distance[cell] = grid.center(cell)[1] - 0.512; });
  const auto result =
      extended<2>(*fluid, distance, 4 * h, [](const Point<2>&) { return Point<2>(1, 1); });
  // Faces along the plate beyond it see no fluid; the shut ones move with it.
  for (const ControlVolume<2>& volume : fluid->coupled_volumes()) {
    EXPECT_EQ(volume.sides[0].kind, SideKind::unknown);
    EXPECT_EQ(volume.sides[1].kind, SideKind::air);
  }
  EXPECT_EQ(sum_all(world(), static_cast<GlobalIndex>(fluid->coupled_volumes().size())), 20);
  grid.for_each_owned_face(0, [&](int cell) {
    if (result.state.faces[0][cell] == FaceState::extended) {
      EXPECT_NE(result.velocity[0][cell], 1);
    }
  });
}

/// A ball, from which all that is far is told to be equally far, so that many faces have no nearer
/// neighbours: by how much round-off of the distances changes what is carried on.
template <int dim>
double largest_change_by_round_off() {
  constexpr int n = 20;
  const double h = 1.0 / n, radius = 0.25;
  const Point<dim> center = Point<dim>::Constant(0.5 + 0.5 * h);
  Case<dim> scene(cube<dim>(n), h);
  add_ball<dim>(scene, center, radius);
  const auto fluid = make_liquid<dim>(scene);
  fluid->set_geometry(nullptr, BlockedFaces<dim>());
  const TiledGrid<dim>& grid = fluid->domain().grid;
  CellField distance(grid.n_stored_cells()), disturbed;
  grid.for_each_stored_cell([&](int cell) {
    distance[cell] = std::min((grid.center(cell) - center).norm() - radius, 1.7 * h);
  });
  disturbed = distance;
  std::mt19937 random(1);
  std::uniform_real_distribution<double> by(-1e-14, 1e-14);
  grid.for_each_owned_cell([&](int cell) { disturbed[cell] += by(random); });
  fluid->domain().halo.fill(disturbed);
  const auto inside = [](const Point<dim>& x) {
    return Point<dim>(Point<dim>::Constant(std::sin(9 * x[0] + 7 * x[dim - 1])));
  };
  const auto one = extended<dim>(*fluid, distance, 4 * h, inside),
             other = extended<dim>(*fluid, disturbed, 4 * h, inside);
  double apart = 0;  // the band's own edge may be on either side of a face
  for (int axis = 0; axis < dim; ++axis)
    grid.for_each_owned_face(axis, [&](int cell) {
      if (one.state.faces[axis][cell] == other.state.faces[axis][cell])
        apart = std::max(apart, std::abs(one.velocity[axis][cell] - other.velocity[axis][cell]));
    });
  return max_all(world(), apart);
}
TEST(VelocityExtension, RoundOffOfDistancesDoesNotMatter) {
  EXPECT_LT(largest_change_by_round_off<2>(), 1e-9);
  EXPECT_LT(largest_change_by_round_off<3>(), 1e-9);
}

}  // namespace
}  // namespace lockstep::test
