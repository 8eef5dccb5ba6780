#include <algorithm>

#include "geometry/generators.hpp"
#include "transport/visible_interpolation.hpp"
#include "transport_cases.hpp"

namespace lockstep::test {
namespace {

template <int dim>
std::shared_ptr<const SurfaceSnapshot<dim>> snapshot(SurfaceMesh<dim> mesh, bool closed) {
  SolidDescription solid;
  solid.closed = closed;
  solid.simplex_end = static_cast<int>(mesh.simplices.size());
  solid.vertex_end = static_cast<int>(mesh.vertices.size());
  return std::make_shared<const SurfaceSnapshot<dim>>(std::move(mesh),
                                                      std::vector<SolidDescription>{solid});
}

/// A rigid motion of a mesh: turned by `angle` about the last axis, then moved.
template <int dim>
SurfaceMesh<dim> placed(SurfaceMesh<dim> mesh, double angle, const Point<dim>& position) {
  for (Point<dim>& x : mesh.vertices) {
    const double c = std::cos(angle), s = std::sin(angle), p = x[0], q = x[1];
    x[0] = c * p - s * q;
    x[1] = s * p + c * q;
    x += position;
  }
  return mesh;
}

/// Sets the surface's motion over one step and its velocity.
template <int dim>
void move(FullTank<dim>& tank, std::shared_ptr<const SurfaceSnapshot<dim>> before,
          std::shared_ptr<const SurfaceSnapshot<dim>> after, double dt) {
  tank.surface.before = before;
  tank.surface.after = after;
  tank.state.surface = before;
  tank.surface.velocity = [before, after, dt](const SurfacePoint<dim>& point) {
    const auto from = before->corners(point.simplex), to = after->corners(point.simplex);
    Point<dim> velocity = Point<dim>::Zero();
    for (int k = 0; k < dim; ++k)
      velocity += point.barycentric[k] * (to[k] - from[k]) / dt;
    return velocity;
  };
}

/// One step of a scalar: carried, then populated in the geometry after it.
template <int dim>
UncoveredReport step(FullTank<dim>& tank, AdvectionScheme scheme, double dt, CellField& s) {
  Transport<dim> transport(tank.setting(dt));
  CellField next;
  transport.advect_scalar(scheme, s, {}, next);
  s.swap(next);
  GridState<dim> after = tank.state;
  after.surface = tank.surface.after;
  return populate_uncovered_scalar<dim>(
      {tank.grid, tank.halo, after, tank.surface, tank.kept, transport.invalid()}, 0, s);
}

/// Rough flow that crosses every surface: the solids do not impose themselves on it.
template <int dim>
Point<dim> rough(const Point<dim>& x) {
  Point<dim> u;
  for (int a = 0; a < dim; ++a)
    u[a] = std::sin(31 * x[a] + 17 * x[(a + 1) % dim] + a);
  return u;
}

/// Smoke fills the space behind a tilted plate that swings to and fro through the box. Not a trace
/// of it may come through, and it may not thin out.
template <int dim>
void expect_plate_keeps_sides_apart(AdvectionScheme scheme, double cfl) {
  const int n = dim == 2 ? 32 : 12, n_steps = 50;
  FullTank<dim> tank(cube<dim>(n, false), world());
  tank.set_velocity(rough<dim>);
  const double dt = cfl / n, amplitude = std::min(0.3, 2 * cfl / n * n_steps / 20);
  const SurfaceMesh<dim> plate = plate_surface<dim>(Point<dim>::Constant(3), 0, 0.3);
  const auto place = [&](int i) {
    // As fast as the fluid: `cfl` cells a step in the middle of the swing.
    return 0.5 + amplitude * std::sin(i * std::min(dt / amplitude, 1.0));
  };
  const auto at = [&](int i) {
    return snapshot<dim>(
        placed<dim>(plate, 0.3 * std::sin(0.2 * i), place(i) * Point<dim>::Constant(1)), false);
  };
  const auto ahead = [&](int i, const Point<dim>& x) {
    const double angle = 0.3 * std::sin(0.2 * i);
    return std::cos(angle) * (x[0] - place(i)) + std::sin(angle) * (x[1] - place(i));
  };
  CellField smoke = tank.cells([&](const Point<dim>& x) { return ahead(0, x) < 0 ? 1.0 : 0.0; });
  auto before = at(0);
  GlobalIndex n_invalid = 0;
  for (int i = 0; i < n_steps; ++i) {
    auto after = at(i + 1);
    move<dim>(tank, before, after, dt);
    n_invalid += step<dim>(tank, scheme, dt, smoke).n_invalid;
    before = after;
    tank.grid.for_each_owned_cell([&](int c) {
      const double distance = ahead(i + 1, tank.grid.center(c));
      if (std::abs(distance) < 1e-5)
        return;
      ASSERT_EQ(smoke[c], distance < 0 ? 1.0 : 0.0)
          << "step " << i << " cell " << tank.grid.center(c).transpose();
    });
  }
  EXPECT_GT(n_invalid, n_steps);
}

TEST(TransportNearSurfaces, NothingPassesAMovingPlate) {
  for (const AdvectionScheme scheme : all_schemes)
    for (const double cfl : {0.5, 5.0}) {
      expect_plate_keeps_sides_apart<2>(scheme, cfl);
      expect_plate_keeps_sides_apart<3>(scheme, cfl);
    }
}

/// A closed shell, turning and travelling two cells a step, takes its smoke along.
template <int dim>
void expect_balloon_holds(AdvectionScheme scheme) {
  const int n = dim == 2 ? 48 : 24;
  FullTank<dim> tank(cube<dim>(n, true), world());
  tank.set_velocity(rough<dim>);
  const double dt = 2.0 / n, radius = 0.21;
  const SurfaceMesh<dim> ball = ball_surface<dim>(radius, 1.5 / n);
  const auto center = [&](int i) {
    return Point<dim>(Point<dim>::Constant(0.5) + 0.1 * std::sin(0.8 * i) * Point<dim>::Unit(0) +
                      0.1 * std::sin(0.5 * i) * Point<dim>::Unit(1));
  };
  const auto at = [&](int i) {
    return snapshot<dim>(placed<dim>(ball, 0.15 * i, center(i)), false);
  };
  CellField smoke =
      tank.cells([&](const Point<dim>& x) { return (x - center(0)).norm() < radius ? 1.0 : 0.0; });
  auto before = at(0);
  for (int i = 0; i < 12; ++i) {
    auto after = at(i + 1);
    move<dim>(tank, before, after, dt);
    step<dim>(tank, scheme, dt, smoke);
    before = after;
    tank.grid.for_each_owned_cell([&](int c) {
      const double distance = (tank.grid.center(c) - center(i + 1)).norm() - radius;
      if (std::abs(distance) > 0.2 / n) {  // the polygon is not quite round
        ASSERT_EQ(smoke[c], distance < 0 ? 1.0 : 0.0) << "step " << i;
      }
    });
  }
}

TEST(TransportNearSurfaces, AClosedShellHoldsItsSmoke) {
  for (const AdvectionScheme scheme : all_schemes) {
    expect_balloon_holds<2>(scheme);
    expect_balloon_holds<3>(scheme);
  }
}

/// A solid that travels with a uniform stream does not disturb it.
template <int dim>
void expect_stream_undisturbed(double cfl) {
  const int n = dim == 2 ? 48 : 16;
  FullTank<dim> tank(cube<dim>(n, true), world());
  Point<dim> stream;
  for (int a = 0; a < dim; ++a)
    stream[a] = 1 - 0.3 * a;
  const double dt = cfl / n;
  const SurfaceMesh<dim> ball = ball_surface<dim>(0.2, 0.1);
  tank.set_velocity([&](const Point<dim>&) { return stream; });
  const auto after =
      snapshot<dim>(placed<dim>(ball, 0, Point<dim>::Constant(0.5) + dt * stream), true);
  move<dim>(tank, snapshot<dim>(placed<dim>(ball, 0, Point<dim>::Constant(0.5)), true), after, dt);
  for (int c = 0; c < tank.grid.n_stored_cells(); ++c) {
    if (!tank.grid.in_domain(c))
      continue;
    const auto inside = [&](int cell) {
      return tank.surface.before->inside(tank.grid.wrap(tank.grid.center(cell))) >= 0;
    };
    if (inside(c))
      tank.state.cells[c] = CellState::solid;
    for (int a = 0; a < dim; ++a) {
      const Point<dim> below = tank.grid.center(c) - tank.grid.spacing() * Point<dim>::Unit(a);
      const bool inside_below = tank.surface.before->inside(tank.grid.wrap(below)) >= 0;
      if (inside(c) && inside_below) {
        tank.state.faces[a][c] = FaceState::inactive;
        tank.velocity[a][c] = 1e3;  // must never be read
      } else if (inside(c) != inside_below) {
        tank.state.faces[a][c] = FaceState::coupled;
      }
    }
  }
  Transport<dim> transport(tank.setting(dt));
  EXPECT_NEAR(transport.largest_displacement(), cfl, 1e-12);
  FaceField<dim> u;
  transport.advect_faces(AdvectionScheme::semi_lagrangian, tank.velocity, u);
  GridState<dim> state_after = tank.state;
  state_after.surface = after;
  for (int a = 0; a < dim; ++a)
    std::fill(state_after.faces[a].begin(), state_after.faces[a].end(), FaceState::free);
  const auto report = populate_uncovered_faces<dim>(
      {tank.grid, tank.halo, state_after, tank.surface, tank.kept, transport.invalid()}, u);
  EXPECT_GT(report.n_invalid, 10);
  for (int a = 0; a < dim; ++a)
    tank.grid.for_each_owned_face(a, [&](int c) {
      if (after->inside(tank.grid.face_center(a, c)) < 0) {
        ASSERT_NEAR(u[a][c], stream[a], 1e-13) << tank.grid.face_center(a, c).transpose();
      }
    });
}

TEST(TransportNearSurfaces, ASolidThatTravelsWithTheStreamLeavesNoTrace) {
  for (const double cfl : {0.4, 3.0}) {
    expect_stream_undisturbed<2>(cfl);
    expect_stream_undisturbed<3>(cfl);
  }
}

/// A plate across x = 4.3 h that has the velocity (0.5, 2). Fluid moves to the right by h/2; behind
/// the plate u = (0.7, 1), before it (0.7, 5): it slips along the plate, or is slowed down along it
/// by up to 4 nu/h.
TEST(TransportNearSurfaces, RaysStopAndFluidSlips) {
  GridDescription<2> description = cube<2>(16, false);
  description.spacing = 1;
  FullTank<2> tank(description, world());
  const SurfaceMesh<2> plate = plate_surface<2>(Point<2>(0, 100), 0, 1);
  const auto surface = snapshot<2>(placed<2>(plate, 0, Point<2>(4.3, 8)), false);
  move<2>(tank, surface, surface, 1);
  tank.surface.velocity = [](const SurfacePoint<2>&) { return Point<2>(0.5, 2); };
  tank.set_velocity([](const Point<2>&) { return Point<2>(0.5, 0); });
  FaceField<2> u, moved;
  u[0] = tank.faces(0, [](const Point<2>&) { return 0.7; });
  u[1] = tank.faces(1, [](const Point<2>& x) { return x[0] < 4.3 ? 1.0 : 5.0; });
  CellField s = tank.cells([](const Point<2>&x) { return x[0] < 4.3 ? x[0] : 100; }), s_moved;
  for (const auto& [viscosity, hidden] :
       {std::pair(0.0, 5.0), std::pair(0.25, 4.0), std::pair(9.0, 2.0)}) {
    TransportSetting<2> setting = tank.setting(1);
    setting.kinematic_viscosity = viscosity;
    Transport<2> transport(setting);
    transport.advect_faces(AdvectionScheme::maccormack, u, moved);
    transport.advect_scalar(AdvectionScheme::semi_lagrangian, s, {}, s_moved);
    tank.grid.for_each_owned_cell([&](int c) {
      const int i = tank.grid.coordinates(c)[0];
      // The ray from 5 ends at 4.5, where samples at 4 (hidden: 0.5, the plate's) and 5 meet.
      EXPECT_NEAR(moved[0][c], i == 5 ? 0.6 : 0.7, 1e-12);
      if (i == 4) {
        // The ray from 4.5 stops at 4.301, where samples at 4.5 (5) and 3.5 (hidden) meet.
        EXPECT_NEAR(moved[1][c], 0.801 * 5 + 0.199 * hidden, 1e-12);
      } else {
        EXPECT_NEAR(moved[1][c], i < 4 ? 1 : 5, 1e-12);
      }
      // Half a cell downstream: 3.5 takes the mean of 2.5 and 3.5.
      EXPECT_NEAR(s_moved[c], i >= 4 ? 100 : i == 0 ? 0.5 : i, 1e-12);
      EXPECT_EQ(transport.invalid().cells[c], 0);
    });
  }
}

/// The plate moves from 4.3 h to 6.3 h: the centres at 4.5 h and 5.5 h are swept over, and filled
/// from behind, front after front.
TEST(TransportNearSurfaces, SweptSamplesAreFilledFromTheirNewSide) {
  GridDescription<2> description = cube<2>(16, false);
  description.spacing = 1;
  FullTank<2> tank(description, world());
  const SurfaceMesh<2> plate = plate_surface<2>(Point<2>(0, 100), 0, 1);
  move<2>(tank, snapshot<2>(placed<2>(plate, 0, Point<2>(4.3, 8)), false),
          snapshot<2>(placed<2>(plate, 0, Point<2>(6.3, 8)), false), 1);
  CellField s = tank.cells([](const Point<2>& x) { return x[0] < 4.3 ? 7.0 : 3.0; });
  const auto report = step<2>(tank, AdvectionScheme::semi_lagrangian, 1, s);
  EXPECT_EQ(report.n_invalid, 2 * 16);
  EXPECT_EQ(report.n_fronts, 2);
  EXPECT_EQ(report.n_left_over, 0);
  tank.grid.for_each_owned_cell(
      [&](int c) { EXPECT_EQ(s[c], tank.grid.coordinates(c)[0] < 6 ? 7 : 3); });
}

/// A box of half a cell moves one cell to the right in resting fluid: a face within it sees nobody
/// and takes the box's velocity, the one it has left that of the fluid around.
TEST(TransportNearSurfaces, LeftOverFacesTakeTheSurfaceVelocity) {
  GridDescription<2> description = cube<2>(16, false);
  description.spacing = 1;
  FullTank<2> tank(description, world());
  const SurfaceMesh<2> box = box_surface<2>(Point<2>(0.5, 0.5), 1);
  move<2>(tank, snapshot<2>(placed<2>(box, 0, Point<2>(8.5, 8)), false),
          snapshot<2>(placed<2>(box, 0, Point<2>(9.5, 8)), false), 1);
  tank.surface.velocity = [](const SurfacePoint<2>&) { return Point<2>(1, 2); };
  FaceField<2> u = tank.velocity, moved;
  Transport<2> transport(tank.setting(1));
  transport.advect_faces(AdvectionScheme::semi_lagrangian, u, moved);
  GridState<2> after = tank.state;
  after.surface = tank.surface.after;
  const auto report = populate_uncovered_faces<2>(
      {tank.grid, tank.halo, after, tank.surface, tank.kept, transport.invalid()}, moved);
  EXPECT_EQ(report.n_left_over, 1);
  EXPECT_EQ(report.n_invalid, 2);
  tank.grid.for_each_owned_face(1, [&](int c) {
    const Point<2> x = tank.grid.face_center(1, c);
    EXPECT_NEAR(moved[1][c], x == Point<2>(9.5, 8) ? 2 : 0, 1e-12) << x.transpose();
  });
}

/// Far from the plate values are interpolated plainly, but for those that do not count: a sample
/// that has none, and the face on a closed lower side, whose velocity is zero whatever is stored.
TEST(TransportNearSurfaces, WhatDoesNotCountIsLeftOutFarFromThem) {
  FullTank<2> tank(cube<2>(16, false), alone());
  const auto plate = snapshot<2>(
      placed<2>(plate_surface<2>(Point<2>(0, .2), 0, 1. / 16), 0, Point<2>(.8, .5)), false);
  move<2>(tank, plate, plate, 1);
  const SampleLattice<2> lattice(tank.grid);
  const int n = tank.grid.n_stored_cells();
  std::vector<char> all(n, 1), some(n, 1);
  std::vector<double> field(n, 1);
  const auto id_at = [&](SampleKind kind, const Point<2>& x) {
    return lattice.locate(kind, x).id[0];
  };
  const Point<2> bad_center(4.5, 4.5), bad_face(6, 4.5), on_side(0, 4.5);
  for (const int id : {id_at(cell_centers, bad_center), id_at(0, bad_face)}) {
    some[id] = 0;
    field[id] = 1e9;
  }
  UsableSamples<2> usable{{some.data(), all.data()}, some.data(), {true, false}};
  VisibleInterpolation<2> interpolation(tank.grid, lattice, usable, tank.surface, 0,
                                        tank.kept.of(plate, tank.grid, 4));
  EXPECT_EQ(interpolation.scalar(Point<2>(4.7, 4.8), field.data()), 1);
  const std::array<const double*, 2> velocity{field.data(), field.data()};
  EXPECT_EQ(interpolation.velocity(0, Point<2>(6.2, 4.7), velocity), 1);
  field[id_at(0, on_side)] = 1e9;
  EXPECT_DOUBLE_EQ(*interpolation.velocity(0, Point<2>(.25, 4.5), velocity), .25);
}

}  // namespace
}  // namespace lockstep::test
