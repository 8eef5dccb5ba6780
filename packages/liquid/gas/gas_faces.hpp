#pragma once
#include <vector>

#include "liquid/surface/free_surface.hpp"
#include "staggered/state/surface_marks.hpp"

namespace lockstep {

/// A free face between a cell that carries a pressure and a gas bubble.
struct GasFace {
  int bubble = 0;
  int row = 0;  ///< row of the pressure, among this rank's
  FaceId face;
  double outward = 1;      ///< 1: the bubble is above the face, -1: below
  double coefficient = 0;  ///< flow through it by a unit of p̂ between them, as in A
  double area = 0;         ///< open [m^(dim-1)]
};

/// Finds the faces between pressure unknowns and gas, by the cells that this rank owns. Local.
template <int dim>
std::vector<GasFace> find_gas_faces(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry);

/// True if a gas bubble is on one side of a face, and neither fluid nor the same bubble on the
/// other. `bubble` may be empty.
bool only_gas_beside(const std::vector<CellState>& cells, const std::vector<int>& bubble,
                     const FaceCells& face);

/// Finds the gas bubbles among the air cells. `fractions`: apertures of owned faces and the upper
/// ones of owned cells, closed ones being no connection; without cut cells empty. Collective.
template <int dim>
void find_bubbles(const FreeSurface<dim>& free_surface, const SurfaceMarks<dim>& marks,
                  const std::array<CellField, dim>& fractions, MacGeometry<dim>& geometry);

/// Impulse of the sides of the domain on the bubbles of these p̂, on this rank.
template <int dim>
Momentum<dim> push_of_sides(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                            const std::vector<double>& scaled_pressure);

}  // namespace lockstep
