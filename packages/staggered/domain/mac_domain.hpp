#pragma once
#include "grid/halo_exchange.hpp"
#include "grid/tiled_grid.hpp"
#include "staggered/domain/boundary.hpp"
#include "transport/grid_state.hpp"

namespace lockstep {

/// The grid of a fluid, its boundary conditions and its exchanges, which all parts of the fluid
/// share.
template <int dim>
struct MacDomain {
  MacDomain(const DomainDescription<dim>& description, const Communicator& comm)
      : grid(description.grid, comm),
        boundary(description.boundary),
        halo(grid, 1),
        full_halo(grid, grid.ghost_width()) {}

  /// Only these tiles are there.
  MacDomain(const DomainDescription<dim>& description, const TileOwners& owners,
            const Communicator& comm)
      : grid(description.grid, comm, owners),
        boundary(description.boundary),
        halo(grid, 1),
        full_halo(grid, grid.ghost_width()) {}

  /// Replaces the tiles; cell ids change, so all that was made of the grid must be made anew.
  /// Collective.
  void set_grid(TiledGrid<dim> other) {
    grid = std::move(other);
    halo = HaloExchange<dim>(grid, 1);
    full_halo = HaloExchange<dim>(grid, grid.ghost_width());
  }

  TiledGrid<dim> grid;
  Boundary<dim> boundary;
  HaloExchange<dim> halo;       ///< neighbours of owned cells, for stencils
  HaloExchange<dim> full_halo;  ///< all ghost cells

  double spacing() const { return grid.spacing(); }
  double cell_volume() const { return dim == 2 ? spacing() * spacing() : cube(spacing()); }
  double face_area() const { return cell_volume() / spacing(); }
  Box<dim> bounds() const {
    Point<dim> upper = grid.lower();
    for (int a = 0; a < dim; ++a)
      upper[a] += grid.n_cells()[a] * spacing();
    return Box<dim>(grid.lower(), upper);
  }
  /// The lower face of a cell, flat along its axis.
  Box<dim> face_box(int axis, int cell) const {
    const Point<dim> center = grid.face_center(axis, cell);
    Point<dim> across = Point<dim>::Constant(0.5 * spacing());
    across[axis] = 0;
    return Box<dim>(center - across, center + across);
  }

 private:
  static double cube(double h) { return h * h * h; }
};

/// A staggered velocity: the lower face, normal to `axis`, of a stored cell.
struct FaceId {
  int axis = 0;
  int cell = 0;
};

/// The domain cells on both sides of a face; -1 beyond the domain.
struct FaceCells {
  int lower = -1, upper = -1;
  bool at_side() const { return lower < 0 || upper < 0; }
};

template <int dim>
FaceCells cells_of_face(const TiledGrid<dim>& grid, const std::vector<CellState>& cells, int axis,
                        int cell) {
  FaceCells result;
  const int lower = grid.neighbor(cell, axis, 0);
  if (lower >= 0 && cells[lower] != CellState::outside)
    result.lower = lower;
  if (cells[cell] != CellState::outside)
    result.upper = cell;
  return result;
}

/// Sets the halo of flags that are not of a type the exchange knows.
template <int dim, typename Flag>
void fill_flags(const HaloExchange<dim>& halo, std::vector<Flag>& flags) {
  static_assert(sizeof(Flag) == sizeof(char));
  std::vector<char> copy(flags.size());
  for (std::size_t i = 0; i < flags.size(); ++i)
    copy[i] = static_cast<char>(flags[i]);
  halo.fill(copy);
  for (std::size_t i = 0; i < flags.size(); ++i)
    flags[i] = static_cast<Flag>(copy[i]);
}

}  // namespace lockstep
