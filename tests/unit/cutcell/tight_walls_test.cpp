// Walls of closed solids are tight under flux, at any angle and thickness. The leaks are counted
// with formulas of the walls: no region of pressures may have cells on both sides of one.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Tpetra_Vector.hpp>

#include "cutcell/flux_coupling.hpp"
#include "unit/mac/mac_cases.hpp"

namespace lockstep::test {
namespace {

template <int dim>
using Turn = Eigen::Matrix<double, dim, dim>;

/// A rotation by this many whole and broken turns, in space about all axes.
template <int dim>
Turn<dim> turn_of(double part) {
  const double angle = 2 * M_PI * part;
  if constexpr (dim == 2) {
    return Eigen::Rotation2Dd(angle).toRotationMatrix();
  } else {
    return (Eigen::AngleAxisd(angle, Point<3>::UnitX()) *
            Eigen::AngleAxisd(1.7 * angle, Point<3>::UnitY()) *
            Eigen::AngleAxisd(2.3 * angle, Point<3>::UnitZ()))
        .toRotationMatrix();
  }
}

template <int dim>
struct Walls {
  Solids<dim> solids;
  void add(const Point<dim>& size, const Turn<dim>& turn, const Point<dim>& center) {
    SurfaceMesh<dim> mesh = box_surface<dim>(size, size.maxCoeff());
    for (Point<dim>& x : mesh.vertices)
      x = turn * x;
    solids.add(mesh, center, true);
  }
};

/// A tank of cells of width one.
template <int dim>
std::unique_ptr<MacFluid<dim>> tank_with(const Walls<dim>& walls, int n_cells,
                                         const FluxCoupling<dim>& coupling) {
  Index<dim> n;
  n.fill(n_cells);
  auto fluid = Case<dim>(n, 1.0).make();
  fluid->set_geometry(walls.solids.snapshot(), coupling);
  return fluid;
}

/// The number of regions with cells where `side` is negative and others where it is positive; zero:
/// in a wall.
template <int dim>
int n_leaks(const MacFluid<dim>& fluid, const std::function<double(const Point<dim>&)>& side) {
  const auto sides = pressure_vector<dim>(fluid, side);
  const auto values = sides->getData();
  const PressureRegions& regions = fluid.regions();
  std::vector<double> reaches(2 * regions.n_regions, 0);
  for (std::size_t i = 0; i < regions.of_unknown.size(); ++i) {
    if (values[i] != 0)
      reaches[2 * regions.of_unknown[i] + (values[i] > 0 ? 1 : 0)] = 1;
  }
  sum_all(world(), reaches.data(), static_cast<int>(reaches.size()));
  int n = 0;
  for (int r = 0; r < regions.n_regions; ++r)
    n += reaches[2 * r] > 0 && reaches[2 * r + 1] > 0 ? 1 : 0;
  return n;
}

const std::vector<double> thicknesses{1e-9, 1e-3, 0.1, 0.3, 0.5, 0.7, 0.9, 1, 1.2, 1.5, 2};

/// A wall from side to side, in turned and shifted places.
template <int dim>
void expect_tight_wall(int n_cells, int n_places) {
  for (const double thickness : thicknesses)
    for (int k = 0; k < n_places; ++k) {
      const Turn<dim> turn = turn_of<dim>(k % 4 == 0 ? k / 32. : 0.618034 * k);
      Point<dim> center = Point<dim>::Constant(n_cells / 2);
      center[0] += k % 3 == 0 ? 0.5 * (k % 5) : 0.37 * k - std::floor(0.37 * k);
      Walls<dim> walls;
      Point<dim> size = Point<dim>::Constant(4 * n_cells);
      size[0] = thickness;
      walls.add(size, turn, center);
      const FluxCoupling<dim> coupling{FluxOptions()};
      const auto fluid = tank_with<dim>(walls, n_cells, coupling);
      const auto side = [&](const Point<dim>& x) {
        const double distance = turn.col(0).dot(x - center);
        return std::abs(distance) <= 0.5 * thickness ? 0 : distance;
      };
      EXPECT_EQ(n_leaks<dim>(*fluid, side), 0) << dim << "D " << thickness << " place " << k;
    }
}

/// A closed container of plates that overlap at its edges.
template <int dim>
void expect_tight_container(int n_cells, int n_places) {
  for (const double thickness : thicknesses)
    for (int k = 0; k < n_places; ++k) {
      const Turn<dim> turn = turn_of<dim>(k % 4 == 0 ? k / 32. : 0.618034 * k);
      const Point<dim> center =
          Point<dim>::Constant(n_cells / 2) + 0.4 * turn_of<dim>(0.11 * k) * Point<dim>::Unit(0);
      const double half = 0.29 * n_cells;
      Walls<dim> walls;
      for (int axis = 0; axis < dim; ++axis)
        for (const int end : {-1, 1}) {
          Point<dim> size = Point<dim>::Constant(2 * half + 2 * thickness);
          size[axis] = thickness;
          walls.add(size, turn, center + end * half * turn.col(axis));
        }
      const FluxCoupling<dim> coupling{FluxOptions()};
      const auto fluid = tank_with<dim>(walls, n_cells, coupling);
      const auto side = [&](const Point<dim>& x) {
        const double distance = (turn.transpose() * (x - center)).cwiseAbs().maxCoeff() - half;
        return std::abs(distance) <= 0.5 * thickness ? 0 : distance;
      };
      EXPECT_EQ(n_leaks<dim>(*fluid, side), 0) << dim << "D " << thickness << " place " << k;
      EXPECT_GT(fluid->regions().n_regions, 1);
    }
}

}  // namespace

TEST(TightWalls, FromSideToSide) {
  expect_tight_wall<2>(12, 40);
  expect_tight_wall<3>(8, 16);
}

TEST(TightWalls, OfContainers) {
  expect_tight_container<2>(14, 24);
  expect_tight_container<3>(10, 8);
}

// Walls that end at the sides of the tank, and plates end to end, also on the lattice.
TEST(TightWalls, ThatEndAtSidesAndAtEachOther) {
  for (const double thickness : thicknesses)
    for (const double x : {5., 5.25, 5.5, 5.9})
      for (const double joint : {4., 4.5, 4.8}) {
        Walls<2> walls;
        const Turn<2> none = Turn<2>::Identity();
        walls.add({thickness, joint}, none, {x, 0.5 * joint});
        walls.add({thickness, 10 - joint}, none, {x, 0.5 * (10 + joint)});
        const auto fluid = tank_with<2>(walls, 10, FluxCoupling<2>(FluxOptions()));
        const auto side = [&](const Point<2>& p) {
          return std::abs(p[0] - x) <= 0.5 * thickness ? 0 : p[0] - x;
        };
        EXPECT_EQ(n_leaks<2>(*fluid, side), 0) << thickness << " at " << x << " joint " << joint;
      }
}

// A slot that is wider than a cell is open, and one in which no line of corners or centres runs is
// closed.
TEST(TightWalls, HaveSlotsThatAreWiderThanCells) {
  for (const double thickness : {0.1, 0.5, 0.9})
    for (const auto& [width, is_open] : {std::pair{1.3, true}, std::pair{0.3, false}}) {
      Walls<2> walls;
      const double lower = 5.6, upper = lower + width;
      walls.add({thickness, lower}, Turn<2>::Identity(), {5.5, 0.5 * lower});
      walls.add({thickness, 12 - upper}, Turn<2>::Identity(), {5.5, 0.5 * (12 + upper)});
      const auto fluid = tank_with<2>(walls, 12, FluxCoupling<2>(FluxOptions()));
      EXPECT_EQ(fluid->regions().n_regions, is_open ? 1 : 2) << thickness << ", " << width;
    }
}

/// Checks that faces are as open as their area where solids are thicker than cells.
template <int dim>
void expect_areas(const SurfaceMesh<dim>& mesh, const Point<dim>& center) {
  Solids<dim> solids;
  solids.add(mesh, center, true);
  Index<dim> n;
  n.fill(12);
  auto fluid = Case<dim>(n, 1.0).make();
  const FluxCoupling<dim> coupling{FluxOptions()};
  const auto surface = solids.snapshot();
  fluid->set_geometry(surface, coupling);
  for (const ControlVolume<dim>& volume : fluid->coupled_volumes()) {
    if (!volume.touches_patch() && !volume.at_prescribed_side) {
      EXPECT_EQ(volume.open_fraction, coupling.open_fraction(volume, false, *surface));
    }
  }
}

TEST(TightWalls, LeaveTheFacesOfThickSolidsAlone) {
  for (int k = 0; k < 24; ++k) {
    const auto turned = [k](auto mesh, const auto& turn) {
      for (auto& x : mesh.vertices)
        x = turn * x;
      return mesh;
    };
    const double part = 0.0618 * k;
    const Point<2> center(5 + part, 6 + 0.37 * k - std::floor(0.37 * k));
    expect_areas<2>(ball_surface<2>(1.3 + 0.1 * k, 0.1), center);
    expect_areas<2>(turned(box_surface<2>({2.5, 3}, 1), turn_of<2>(part)), center);
    const Point<3> in_space(5.5, 5 + part, 5.7);
    expect_areas<3>(ball_surface<3>(1.3 + 0.1 * k, 0.4), in_space);
    expect_areas<3>(turned(box_surface<3>({3, 2.5, 4}, 1), turn_of<3>(part)), in_space);
  }
}

}  // namespace lockstep::test
