#pragma once
#include <functional>
#include <vector>

#include "interfaces/gas.hpp"
#include "interfaces/liquid.hpp"
#include "liquid/common/liquid_volume.hpp"
#include "staggered/state/stored_fields.hpp"

namespace lockstep {

/// Model of trapped gas.
enum class TrappedAir { none, ideal_gas, constant_volume };

template <int dim>
struct GasParameters {
  TrappedAir kind = TrappedAir::none;
  double atmospheric_pressure = 101325;  ///< [Pa]
  double exponent = 1.4;                 ///< gamma
  double pressure_at_start = 0;          ///< above the atmosphere's [Pa]
  std::vector<Point<dim>>
      atmosphere;  ///< points of the atmosphere: air connected to one of them is not trapped
};

/// Gas bubbles: components of the air that nothing joins to the atmosphere, which is the air that
/// open sides and the given points reach, and without such points the air at the side of the domain
/// against gravity. Of more than `most` components the largest are bubbles. An ideal gas has p +
/// p_atm = p_atm (V_0 / V)^gamma, V_0 its volume at the pressure of the atmosphere. V_0 is
/// inherited by the bubble with the same cells a step later: a merger adds, a split shares, an
/// opening loses.
template <int dim>
class GasBubbles {
 public:
  static constexpr int most = 8;

  /// `domain` must outlive this. Throws InputError for points that are nowhere. Collective.
  GasBubbles(const MacDomain<dim>& domain, GasParameters<dim> parameters,
             const Point<dim>& gravity);

  /// Finds the bubbles of an instant. `cavities`: the cells that are not solid, and the surfaces
  /// between them; `phi` on the halo of width 1. Collective.
  void find(const SolidCells<dim>& voids, const CellField& phi);
  /// Computes the volumes and pressures of the bubbles. A second call at the same instant changes
  /// nothing. Collective.
  void settle(const CellField& phi);
  /// Leaves out the cells that surfaces pass over as they move, which do not tell which bubble
  /// follows which. Called before `find`. Local.
  void pass_over(const MovingSurface<dim>& surface);
  const std::vector<int>& of_cell() const {
    return of_cell_;
  }  ///< bubble of stored cells; -1: none
  const std::vector<GasBubble>& all() const { return bubbles_; }

  /// Gives the cells of the bubbles these pressures p̂; empty: zero. Local.
  void fill(const std::vector<double>& of_bubbles, CellField& scaled_pressure);
  void accept(double dt);  ///< keeps the pressures last given, in a step of dt. Local.
  GasReport report() const;
  std::vector<StoredField> fields();

 private:
  std::vector<char> open_groups(const CellGroups& groups, const CellField& phi) const;
  /// The groups that become bubbles, by their volumes.
  std::vector<int> choose(const std::vector<char>& is_open,
                          const std::vector<double>& volumes) const;
  void inherit(const CellField& phi);
  GasBubble bubble_of(double volume, double amount, double last_pressure) const;

  const MacDomain<dim>& domain_;
  GasParameters<dim> parameters_;
  Point<dim> gravity_;
  LiquidVolume<dim> measure_;
  std::vector<char> is_air_;  ///< stored cells that are air and not solid
  std::vector<int> of_cell_;
  std::vector<GasBubble> bubbles_;
  std::vector<double> amounts_;  ///< V_0 by bubble [m^dim]
  std::vector<double> scaled_pressure_, accepted_pressure_;
  /// Number of each cell's bubble, from 1; -1 in the atmosphere, 0 elsewhere; V_0 and last pressure
  /// of that bubble.
  CellField number_, amount_, last_pressure_;
};

}  // namespace lockstep
