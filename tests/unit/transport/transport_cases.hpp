#pragma once
#include <gtest/gtest.h>
#include <mpi.h>

#include <cmath>
#include <functional>

#include "support/world.hpp"
#include "transport/transport.hpp"
#include "transport/uncovered_samples.hpp"

namespace lockstep::test {

inline Communicator alone() {
  return Teuchos::rcp(new Teuchos::MpiComm<int>(MPI_COMM_SELF));
}

template <int dim>
GridDescription<dim> cube(int n, bool periodic) {
  GridDescription<dim> description;
  description.spacing = 1.0 / n;
  description.n_cells.fill(n);
  description.periodic.fill(periodic);
  description.store_upper_face.fill(!periodic);  // the sides are open
  return description;
}

/// A fluid that fills its grid, all of whose faces are carried.
template <int dim>
struct FullTank {
  FullTank(const GridDescription<dim>& description, const Communicator& comm)
      : grid(description, comm), ray_halo(grid), halo(grid, 1) {
    state.cells.assign(grid.n_stored_cells(), CellState::outside);
    for (int c = 0; c < grid.n_stored_cells(); ++c)
      if (grid.in_domain(c))
        state.cells[c] = CellState::fluid;
    for (int a = 0; a < dim; ++a) {
      state.faces[a].assign(grid.n_stored_cells(), FaceState::inactive);
      for (int c = 0; c < grid.n_stored_cells(); ++c)
        if (grid.in_lattice(c) && has_face(a, c))
          state.faces[a][c] = FaceState::free;
      velocity[a].assign(grid.n_stored_cells(), 0);
    }
    surface.velocity = [](const SurfacePoint<dim>&) { return Point<dim>(Point<dim>::Zero()); };
  }
  bool has_face(int axis, int cell) const {
    Index<dim> x = grid.coordinates(cell);
    if (x[axis] == grid.n_cells()[axis])
      x[axis] -= 1;
    return grid.in_domain(x);
  }

  using Function = std::function<double(const Point<dim>&)>;
  CellField cells(const Function& f) const {
    CellField field(grid.n_stored_cells(), 0);
    grid.for_each_owned_cell([&](int c) { field[c] = f(grid.center(c)); });
    return field;
  }
  CellField faces(int axis, const Function& f) const {
    CellField field(grid.n_stored_cells(), 0);
    grid.for_each_owned_face(axis, [&](int c) { field[c] = f(grid.face_center(axis, c)); });
    return field;
  }
  void set_velocity(const std::function<Point<dim>(const Point<dim>&)>& u) {
    for (int a = 0; a < dim; ++a)
      velocity[a] = faces(a, [&](const Point<dim>& x) { return u(x)[a]; });
  }
  TransportSetting<dim> setting(double dt) {
    return {grid, state, surface, velocity, ray_halo, kept, sides, dt, 0, 2};
  }

  TiledGrid<dim> grid;
  RayHalo<dim> ray_halo;
  KeptSurface<dim> kept;
  HaloExchange<dim> halo;
  GridState<dim> state;
  MovingSurface<dim> surface;
  FaceField<dim> velocity;  ///< u_ADV
  std::array<std::array<TransportSide<dim>, 2>, dim> sides;
};

constexpr AdvectionScheme all_schemes[] = {AdvectionScheme::semi_lagrangian,
                                           AdvectionScheme::maccormack, AdvectionScheme::cubic};

}  // namespace lockstep::test
