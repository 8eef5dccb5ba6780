#pragma once
#include <functional>

#include "liquid/fractions/fraction_planes.hpp"

namespace lockstep {

/// Liquid of the cells.
struct Fractions {
  CellField liquid;  ///< liquid part of each stored cell, extrapolated into solids [1]
  /// Volume defect of a stored cell [cells]: liquid that has come to it but finds no room in it,
  /// less liquid in it that has come from nowhere.
  CellField defect;
  CellField open;  ///< part of a cell outside closed solids; empty: 1 everywhere

  double open_part(int cell) const { return open.empty() ? 1 : open[cell]; }
  /// Changes the liquid of a cell; the difference goes to its defect.
  void set(int cell, double fraction) {
    defect[cell] += (liquid[cell] - fraction) * open_part(cell);
    liquid[cell] = fraction;
  }
};

/// The flow that carries fractions over one step.
template <int dim>
struct FractionFlow {
  const std::vector<char>& tiles;      ///< flags of the owned tiles on which fractions change
  const std::vector<char>& is_solved;  ///< cells in which the velocity has no divergence
  const FaceField<dim>& velocity;      ///< velocity of the faces [m/s]
  double dt = 0;                       ///< [s]
  /// Open part of faces at sides of the domain, as in InterfaceStep.
  const std::function<double(int axis, int cell)>& open;
};

/// Advects fractions axis by axis with the liquid in the slabs that pass the faces (Weymouth & Yue
/// 2010): volume is conserved, and where the velocity has no divergence no fraction leaves [0, 1].
/// Nothing passes a surface of solids; beside a moving one liquid moves with it.
template <int dim>
class FractionTransport {
 public:
  explicit FractionTransport(const MacDomain<dim>& domain) : domain_(domain), planes_(domain) {}

  /// Largest sum of |u| dt / h over the axes, on the flagged owned tiles within `cut_off` of the
  /// surface, over all ranks. Throws SolveError if a velocity is not finite. Collective.
  double courant_number(const SolidCells<dim>& solids, const std::vector<char>& tiles,
                        const CellField& phi, double cut_off, const FaceField<dim>& velocity,
                        double dt) const;
  /// Advances one step with a Courant number of at most 1/2, `first_axis` first. Sets the halo of
  /// width 1 of the fractions, which must be set. Returns the outflow from the domain less the
  /// inflow [cells], on this rank. Collective.
  double advance(const SolidCells<dim>& solids, const FractionFlow<dim>& flow, int first_axis,
                 Fractions& fractions);

 private:
  /// Volume that passes one face of a cell into it, and its origin.
  struct Inflow {
    double liquid = 0;
    bool is_real = true, is_at_side = false;
  };
  Inflow through(const SolidCells<dim>& solids, const CellField& liquid, int cell, int axis,
                 int side, double passed) const;
  double in_slab(const CellField& liquid, int cell, int axis, int side, double width) const;
  void sweep(const SolidCells<dim>& solids, const FractionFlow<dim>& flow, int axis,
             CellField& liquid);
  /// Counts the outflow of cells whose centres a solid holds, where it leaves their faces open in
  /// part, as a defect of these cells.
  void leave_covered_cells(const SolidCells<dim>& solids, const FractionFlow<dim>& flow,
                           Fractions& fractions);
  double open_part(int axis, int face) const { return open_ ? open_(axis, face) : 1; }

  const MacDomain<dim>& domain_;
  FractionPlanes<dim> planes_;
  std::vector<char> grows_;  ///< cells that swell where the velocity does, along one axis
  CellField before_, swept_, arrived_;  ///< at the start; after an axis; real inflow so far
  std::function<double(int axis, int cell)>
      open_;  ///< aperture of faces at sides; null: all are open
  double left_ = 0;
};

}  // namespace lockstep
