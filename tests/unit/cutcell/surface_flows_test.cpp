// Flows of soft bodies into cut cells: B_cj is the integral of N_j n over the surface in the cell.
#include <gtest/gtest.h>

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "cutcell/flux_coupling.hpp"
#include "linear/symmetry_check.hpp"
#include "support/dense.hpp"
#include "unit/cutcell/bodies_in_tank.hpp"

namespace lockstep::test {
namespace {

template <int dim>
FakeBody<dim> soft(SurfaceMesh<dim> surface, const Point<dim>& center) {
  FakeBody<dim> body;
  body.kind = FakeBody<dim>::Kind::nodal;
  body.surface = std::move(surface);
  for (Point<dim>& x : body.surface.vertices)
    x += center;
  body.center = center;
  return body;
}

template <int dim>
FakeBody<dim> rigid(FakeBody<dim> body) {
  body.kind = FakeBody<dim>::Kind::rigid;
  return body;
}

template <int dim>
struct SoftCase : BodiesInTank<dim, FluxCoupling<dim>> {
  SoftCase(int n_cells, std::vector<FakeBody<dim>> bodies, const FluxOptions& options = {},
           bool periodic = false)
      : BodiesInTank<dim, FluxCoupling<dim>>(tank(n_cells, periodic), std::move(bodies), options) {}
  static std::unique_ptr<MacFluid<dim>> tank(int n_cells, bool periodic) {
    test::Case<dim> scene(cube<dim>(n_cells), 1. / n_cells);
    if (periodic)
      scene.all_periodic();
    return scene.make();
  }
  /// Flow into each cell that nodes of these velocities make.
  Eigen::VectorXd pushed(const std::function<Point<dim>(const Point<dim>&)>& velocity) const {
    Eigen::VectorXd dofs = Eigen::VectorXd::Zero(this->solids->map()->getGlobalNumElements());
    const auto& vertices = this->surface->mesh().vertices;
    for (std::size_t v = 0; v < vertices.size(); ++v)
      dofs.segment(dim * v, dim) = velocity(vertices[v]);
    return pushed(dofs);
  }
  Eigen::VectorXd pushed(const Eigen::VectorXd& dofs) const {
    Vector rates(this->fluid->pressure_map());
    this->coupling.coupling_transposed()->apply(*distributed(dofs, this->solids->map()), rates,
                                                Teuchos::TRANS);
    return dense(rates);
  }
};

/// A drop of random shape, whose surface crosses cells as it likes.
template <int dim>
FakeBody<dim> lump(const Point<dim>& center, double radius = 0.23) {
  FakeBody<dim> body = soft<dim>(ball_surface<dim>(radius, dim == 2 ? 0.03 : 0.09), center);
  for (Point<dim>& x : body.surface.vertices) {
    const Point<dim> r = x - center;
    x = center + (1 + 0.3 * std::sin(9 * r[0] + 5 * r[dim - 1])) * r;
  }
  return body;
}

/// Rigid motions of a soft body push what they do of the same body if it is rigid.
template <int dim>
void check_rigid_motions(int n_cells, const FakeBody<dim>& body, bool periodic = false) {
  const SoftCase<dim> of_soft(n_cells, {body}, {}, periodic),
      of_rigid(n_cells, {rigid(body)}, {}, periodic);
  const double area = std::pow(1. / n_cells, dim - 1);
  for (int k = 0; k < dim + n_rotations<dim>; ++k) {
    Eigen::VectorXd dofs = Eigen::VectorXd::Zero(of_rigid.solids->map()->getGlobalNumElements());
    dofs[k] = 1;
    AngularVector<dim> spin = AngularVector<dim>::Zero();
    if (k >= dim)
      spin[k - dim] = 1;
    const Eigen::VectorXd pushed = of_soft.pushed([&](const Point<dim>& x) -> Point<dim> {
      return k < dim ? Point<dim>(Point<dim>::Unit(k)) : rotate<dim>(spin, x - body.center);
    });
    // Open parts of faces are rounded to 2^-20: what a turn pushes through them is misplaced.
    EXPECT_LT((pushed - of_rigid.pushed(dofs)).template lpNorm<Eigen::Infinity>(),
              (k < dim ? 1e-14 : 3e-6) * area)
        << k;
    EXPECT_GT(pushed.norm(), 0.1 * area);
  }
}

}  // namespace

TEST(SurfaceFlows, OfRigidMotionsAreThoseOfClosedFaces) {
  check_rigid_motions<2>(16, lump<2>({0.52, 0.47}));
  check_rigid_motions<3>(12, lump<3>({0.52, 0.47, 0.51}));
}

TEST(SurfaceFlows, OfBodiesThroughSidesAreThoseOfClosedFaces) {
  check_rigid_motions<2>(24, lump<2>({0.93, 0.06}));
  check_rigid_motions<3>(12, lump<3>({0.07, 0.91, 0.51}));
}

// Uniform motions: no closed face is lost, wherever the body is cut off.
TEST(SurfaceFlows, OfBodiesThroughPeriodicSidesHaveNoSum) {
  const SoftCase<2> c(16, {lump<2>({0.93, 0.52})}, {}, true);
  for (int k = 0; k < 2; ++k)
    EXPECT_LT(
        std::abs(c.pushed([&](const Point<2>&) { return Point<2>(Point<2>::Unit(k)); }).sum()),
        1e-14);
}

// A box is stretched along x: v = (x - 0.5, 0). Only its right and left sides push, each by 0.5
// times half its width, spread over the cells that the side passes through.
void check_stretched_box(int n_cells, const Point<2>& size, double side_in_cell) {
  const SoftCase<2> c(n_cells, {soft<2>(box_surface<2>(size, 0.05), {0.5, 0.5})});
  const Eigen::VectorXd pushed =
      c.pushed([](const Point<2>& x) { return Point<2>(x[0] - 0.5, 0); });
  const double whole = size[0] / 2 * side_in_cell;  // a cell beside the middle of a side
  const double rest = std::fmod(size[1] / 2, side_in_cell) / side_in_cell;  // part of the last cell
  double sum = 0;
  for (Eigen::Index cell = 0; cell < pushed.size(); ++cell) {
    const double part = pushed[cell] / whole;
    EXPECT_LT(std::min({std::abs(part), std::abs(part - 1), std::abs(part - rest)}), 1e-5);
    sum += part;
  }
  EXPECT_NEAR(sum, 2 * size[1] / side_in_cell, 1e-5);
}

TEST(SurfaceFlows, OfAStretchedBoxByHand) {
  check_stretched_box(10, {0.3, 0.3}, 0.1);   // its sides in the middle of cells
  check_stretched_box(8, {0.5, 0.5}, 0.125);  // its sides between cells
  check_stretched_box(8, {0.56, 0.31}, 0.125);
}

/// Rate of the volume that a mesh encloses: sum over simplices of area vector times mean velocity,
/// exact for velocities that are linear on each.
template <int dim>
double volume_rate(const SurfaceSnapshot<dim>& surface, const Eigen::VectorXd& dofs) {
  double rate = 0;
  for (int s = 0; s < surface.n_simplices(); ++s) {
    Point<dim> mean = Point<dim>::Zero();
    for (const int vertex : surface.mesh().simplices[s])
      mean += dofs.segment(dim * vertex, dim) / dim;
    rate += area_vector<dim>(surface.corners(s)).dot(mean);
  }
  return rate;
}

template <int dim>
void check_volume_rate(int n_cells, const std::vector<FakeBody<dim>>& bodies) {
  const SoftCase<dim> c(n_cells, bodies);
  for (const int seed : {1, 2, 3}) {
    const auto velocity = make_vector(c.solids->map());
    pseudo_random(*velocity, seed);
    const Eigen::VectorXd dofs = dense(*velocity);
    const double area = std::pow(1. / n_cells, dim - 1);
    EXPECT_NEAR(c.pushed(dofs).sum(), volume_rate<dim>(*c.surface, dofs), 1e-4 * area);
  }
}

TEST(SurfaceFlows, OfAnyMotionPushOutTheVolume) {
  check_volume_rate<2>(16, {lump<2>({0.52, 0.47})});
  check_volume_rate<3>(12, {lump<3>({0.52, 0.47, 0.51})});
  check_volume_rate<2>(8, {lump<2>({0.31, 0.33}, 0.01)});  // all of it in one cell
}

// Two soft bodies overlap, a third hangs in a wall thinner than a cell: each face is closed once.
TEST(SurfaceFlows, CloseEachFaceOnce) {
  FakeBody<2> wall = soft<2>(box_surface<2>({0.02, 1.4}, 0.1), {0.787, 0.5});
  const SoftCase<2> c(16, {lump<2>({0.33, 0.47}), lump<2>({0.53, 0.41}, 0.15), wall});
  std::map<GlobalIndex, Point<2>> closed;
  for (const ControlVolume<2>& volume : c.fluid->coupled_volumes())
    for (int side = 0; side < 2; ++side)
      if (volume.sides[side].unknown != no_index)
        closed.emplace(volume.sides[side].unknown, Point<2>::Zero())
            .first->second[volume.direction] +=
            (side == 0 ? -1 : 1) * (1 - volume.open_fraction) * volume.area;
  for (int k = 0; k < 2; ++k) {
    Eigen::VectorXd expected =
        Eigen::VectorXd::Zero(c.fluid->pressure_map()->getGlobalNumElements());
    for (const auto& [unknown, areas] : closed)
      expected[static_cast<Eigen::Index>(unknown)] = areas[k];
    for (Eigen::Index i = 0; i < expected.size(); ++i)
      expected[i] = sum_all(c.solids->comm(), expected[i]);
    const Eigen::VectorXd pushed =
        c.pushed([&](const Point<2>&) { return Point<2>(Point<2>::Unit(k)); });
    EXPECT_LT((pushed - expected).lpNorm<Eigen::Infinity>(), 1e-15);
    EXPECT_GT(expected.norm(), 0.1);
  }
}

// A soft box on the floor and one on top of it. Where the motion lifts them off, the fluid flows
// in around the patch between: each body's rows sum to zero.
TEST(SurfaceFlows, OfBodiesThatTouchHaveNoSum) {
  const FakeBody<2> below = soft<2>(box_surface<2>({0.4, 0.25}, 0.05), {0.5, 0.125}),
                    above = soft<2>(box_surface<2>({0.27, 0.2}, 0.05), {0.47, 0.35});
  const SoftCase<2> c(16, {below, above});
  const Eigen::Index n_below = 2 * static_cast<Eigen::Index>(below.surface.vertices.size());
  EXPECT_TRUE(c.fluid->contact_patches());
  const Eigen::Index n_dofs = c.solids->map()->getGlobalNumElements();
  for (int k = 0; k < 2; ++k)
    for (const bool of_below : {true, false}) {
      Eigen::VectorXd dofs = Eigen::VectorXd::Zero(n_dofs);
      for (Eigen::Index i = k; i < n_dofs; i += 2)
        dofs[i] = (i < n_below) == of_below ? 1 : 0;
      const Eigen::VectorXd pushed = c.pushed(dofs);
      EXPECT_LT(std::abs(pushed.sum()), 1e-14);
      EXPECT_GT(pushed.norm(), 0.1);
    }
}

// Pressure turns a body by its nodes as the fluid does, but for rounded open parts: those of
// faces that moved by the surface in their dual cell were off by 1e-2 of this impulse.
TEST(SurfaceFlows, TurnABodyAsTheFluidDoes) {
  const SoftCase<2> c(16, {lump<2>({0.52, 0.47})});
  BlockVector solution{make_vector(c.fluid->pressure_map()), make_vector(c.solids->map())};
  pseudo_random(*solution.pressure, 7);
  const std::vector<double> still(c.fluid->coupled_volumes().size(), 0);
  const AngularVector<2> error =
      c.coupling.lumping_torque_error(*c.solids, still, still, solution, {});
  EXPECT_LT(error.norm(), 1e-6);
  EXPECT_TRUE(c.coupling.added_mass().is_null());
}

}  // namespace lockstep::test
