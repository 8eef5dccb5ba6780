#pragma once
#include <functional>

#include "liquid/fractions/fraction_planes.hpp"

namespace lockstep {

/// What a cell keeps of the liquid.
struct Fractions {
  CellField liquid;  ///< the part of a cell that is liquid, on stored cells; goes on into solids
  /// Liquid that a cell should have beside that: what has come to it but finds no room in it, less
  /// what is in it but has come from nowhere [cells]. Of stored cells.
  CellField owed;
  CellField open;  ///< the part of a cell that closed solids leave; empty: 1 everywhere

  double open_part(int cell) const { return open.empty() ? 1 : open[cell]; }
  /// Changes the liquid of a cell; the difference is owed.
  void set(int cell, double fraction) {
    owed[cell] += (liquid[cell] - fraction) * open_part(cell);
    liquid[cell] = fraction;
  }
};

/// Moves fractions axis after axis, each by what is in the slabs that pass its faces (Weymouth &
/// Yue 2010): no liquid is made or lost, and where the velocity has no divergence no fraction
/// leaves [0, 1]. Nothing passes what a surface of solids blocks; along with it liquid moves as it
/// does.
template <int dim>
class FractionTransport {
 public:
  explicit FractionTransport(const MacDomain<dim>& domain) : domain_(domain), planes_(domain) {}

  /// The sum of |u| dt / h over the axes, at most, over the flagged owned tiles within `cut_off` of
  /// the surface, over all ranks. Throws SolveError if a velocity is not finite. Collective.
  double courant_number(const SolidCells<dim>& solids, const std::vector<char>& tiles,
                        const CellField& phi, double cut_off, const FaceField<dim>& velocity,
                        double dt) const;
  /// One step with a Courant number of at most 1/2 on the flagged owned tiles, `first_axis` first.
  /// `is_solved`: cells in which the velocity has no divergence. Sets the halo of width 1 of the
  /// fractions, which must be set. `open`: as in InterfaceStep. Returns what has left the domain
  /// less what has come in [cells], on this rank. Collective.
  double advance(const SolidCells<dim>& solids, const std::vector<char>& tiles,
                 const std::vector<char>& is_solved, const FaceField<dim>& velocity, double dt,
                 int first_axis, const std::function<double(int axis, int cell)>& open,
                 Fractions& fractions);

 private:
  /// What passes one face of a cell into it, and whether it has come from other liquid.
  struct Inflow {
    double liquid = 0;
    bool is_real = true, is_at_side = false;
  };
  Inflow through(const SolidCells<dim>& solids, const CellField& liquid, int cell, int axis,
                 int side, double passed) const;
  double in_slab(const CellField& liquid, int cell, int axis, int side, double width) const;
  void sweep(const SolidCells<dim>& solids, const std::vector<char>& tiles,
             const FaceField<dim>& velocity, double dt, int axis, CellField& liquid);
  /// What flows out of cells whose centres a solid holds, where it leaves their faces open in part:
  /// they owe it.
  void leave_covered_cells(const SolidCells<dim>& solids, const std::vector<char>& tiles,
                           const FaceField<dim>& velocity, double dt, Fractions& fractions);
  double open_part(int axis, int face) const { return open_ ? open_(axis, face) : 1; }

  const MacDomain<dim>& domain_;
  FractionPlanes<dim> planes_;
  std::vector<char> grows_;  ///< cells that swell where the velocity does, along one axis
  CellField before_, swept_, arrived_;  ///< at the start; after an axis; real inflow so far
  std::function<double(int axis, int cell)> open_;  ///< of faces at sides; null: all of them
  double left_ = 0;
};

}  // namespace lockstep
