#pragma once
#include <vector>

#include "mac/viscosity/viscosity_field.hpp"
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// Terms that make the viscous form that of the symmetric stress beside air or gas, where the
/// surface is free of traction: the form is the sum over the cells of 2 mu (d_a u_a)^2, and over
/// the edges all of whose faces have fluid of mu (d_b u_a + d_a u_b)^2. The viscous couplings of
/// the Laplacian have half of the first, and the squares of the second. In the middle of the fluid,
/// and beside a side whose velocity is known, the rest cancels, pair by pair of faces at right
/// angles to each other, each of which shares a cell and an edge; in 3D but for mu (div u)^2,
/// without which the form would not be positive.
///
/// Two phases have the same form with a mu for each cell and edge, that of air without mass being
/// 0.
///
/// The form is that of the couplings alone where solids are near. The terms that cancel in the
/// middle leave one of either sign where that ends: they may be used only where `is_definite` says
/// so.
template <int dim>
class StressAtAir {
 public:
  /// A part of the form: 2 coefficient u_own u_other, in units of that of a coupling.
  struct Partner {
    FaceId face;  ///< free, or prescribed at an inflow
    double coefficient = 0;
    /// Part of the coefficient from outside of the fluid: all but mu (div u)^2, and that too where
    /// the cell's other face, which gives as much back, is a side's.
    double from_outside = 0;
  };

  /// Makes the terms of a fluid with a free surface. References must outlive this. Collective.
  StressAtAir(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
              const ViscosityField<dim>& viscosity);

  /// True if the form is positive. It might not be if fluid beside the air has a solid near it, or
  /// fluid stands at an open side, on any rank: then the form is to be that of the couplings
  /// everywhere. Collective.
  bool is_definite() const;

  /// True if a face and its neighbour across have air beside them: they are not coupled.
  bool parts(const FaceId& face, int across, int end) const;
  /// Extra weight of couplings along a velocity's own axis, through this cell: mu or 0.
  double extra_weight(int cell) const {
    return dim == 3 && is_far_from_solids_[cell] ? viscosity_.of_cell(cell) : 0;
  }
  /// Calls f(partner) for the faces with a velocity at right angles to this one.
  template <typename Function>
  void for_each_partner(const FaceId& face, const Function& f) const {
    for (int across = 0; across < dim; ++across)
      for (int end = 0; end < 2 && across != face.axis; ++end)
        add_partners(face, across, end, f);
  }

 private:
  enum class Edge { other, whole, parted };
  Edge edge(const FaceId& face, int across, int end) const;
  bool is_fluid(int cell) const { return geometry_.state.cells[cell] == CellState::fluid; }
  bool is_regular(int cell) const {
    const CellState state = geometry_.state.cells[cell];
    return (state == CellState::fluid || state == CellState::air) && !geometry_.near_surface(cell);
  }
  /// Stored cells all of whose neighbours in the domain, those at edges and corners too, are
  /// marked, as they are.
  std::vector<char> with_marked_surroundings(std::vector<char> marked) const;
  bool fluid_at_open_side() const;
  /// True if this one of a cell's two faces normal to that axis can move freely. None is stored at
  /// an upper wall.
  bool is_free(int axis, int cell, int end) const {
    const int face = end == 0 ? cell : domain_.grid.neighbor(cell, axis, 1);
    return face >= 0 && geometry_.state.faces[axis][face] == FaceState::free;
  }
  bool has_velocity(int axis, int face) const;

  /// The two cells of the face, each with the face across at that end.
  template <typename Function>
  void add_partners(const FaceId& face, int across, int end, const Function& f) const {
    const Edge kind = edge(face, across, end);
    if (kind == Edge::other)
      return;
    const double of_edge = kind == Edge::whole ? viscosity_.of_edge(face, across, end) : 0;
    for (int side = 0; side < 2; ++side) {
      const int cell = side == 0 ? domain_.grid.neighbor(face.cell, face.axis, 0) : face.cell;
      const int other = end == 0 ? cell : domain_.grid.neighbor(cell, across, 1);
      if (other < 0 || !has_velocity(across, other))
        continue;
      const double beside_air = of_edge - viscosity_.of_cell(cell);
      const double weight = beside_air + extra_weight(cell);
      // The face is the cell's upper one if the cell is on its lower side.
      const double sign = (side == 0) == (end == 1) ? 1 : -1;
      const double from_outside = is_free(face.axis, cell, side) ? beside_air : weight;
      if (weight != 0 || from_outside != 0)
        f(Partner{{across, other}, sign * weight, sign * from_outside});
    }
  }

  const MacDomain<dim>& domain_;
  const MacGeometry<dim>& geometry_;
  const ViscosityField<dim>& viscosity_;
  std::vector<char> is_far_from_solids_;  ///< stored cells: all around them is plain
};

}  // namespace lockstep
