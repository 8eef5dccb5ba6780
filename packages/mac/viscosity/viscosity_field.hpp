#pragma once
#include <vector>

#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// Viscosities on both sides of a surface, relative to the larger one: those of air without mass
/// are 1 and 0, and then the cells' states say what is where.
struct PhaseViscosities {
  double liquid = 1, gas = 0;
  const CellField* distance = nullptr;  ///< phi on all stored cells [m]; null: no gas
};

/// The viscosity of each cell and edge, relative to the larger one. Where a surface passes, its
/// parts resist one after the other: 1 / mu = f / mu_liquid + (1 - f) / mu_gas for the liquid part
/// f, that of a surface across an axis.
template <int dim>
class ViscosityField {
 public:
  ViscosityField(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                 const PhaseViscosities& phases)
      : domain_(domain), cells_(geometry.state.cells), phases_(phases) {}

  /// The viscosities that occur far from the surface.
  std::vector<double> of_phases() const {
    return phases_.distance ? std::vector<double>{phases_.liquid, phases_.gas}
                            : std::vector<double>{1};
  }
  /// In a cell; 0 outside of the fluid.
  double of_cell(int cell) const;
  /// For a link between a face and its neighbour across: about the edge between them.
  double of_edge(const FaceId& face, int across, int end) const;

 private:
  double at(double distance) const;

  const MacDomain<dim>& domain_;
  const std::vector<CellState>& cells_;
  PhaseViscosities phases_;
};

}  // namespace lockstep
