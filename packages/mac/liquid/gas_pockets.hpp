#pragma once
#include <functional>
#include <vector>

#include "interfaces/gas.hpp"
#include "interfaces/liquid.hpp"
#include "mac/liquid/liquid_volume.hpp"
#include "mac/state/stored_fields.hpp"

namespace lockstep {

/// What gas does that is trapped.
enum class TrappedAir { none, ideal_gas, constant_volume };

template <int dim>
struct GasParameters {
  TrappedAir kind = TrappedAir::none;
  double atmospheric_pressure = 101325;  ///< [Pa]
  double exponent = 1.4;                 ///< gamma
  double pressure_at_start = 0;          ///< above the atmosphere's [Pa]
  std::vector<Point<dim>> atmosphere;    ///< what can be reached from here is not trapped
};

/// The pockets of void that nothing joins to the atmosphere: what open sides and the points given
/// reach, and without such points what touches the side of the domain against gravity. Of more than
/// `most` the largest are pockets. An ideal gas has p + p_atm = p_atm (V_0 / V)^gamma, V_0 its
/// volume at the pressure of the atmosphere. V_0 is handed on to what has the same cells a step
/// later: a merger adds, a split shares, an opening loses.
template <int dim>
class GasPockets {
 public:
  static constexpr int most = 8;

  /// `domain` must outlive this. Throws InputError for points that are nowhere. Collective.
  GasPockets(const MacDomain<dim>& domain, GasParameters<dim> parameters,
             const Point<dim>& gravity);

  /// The pockets of an instant. `voids`: which cells are not solid, and what comes between them;
  /// `phi` on the halo of width 1. Collective.
  void find(const SolidCells<dim>& voids, const CellField& phi);
  /// What is in them and how they push. Again at the same instant it changes nothing. Collective.
  void settle(const CellField& phi);
  /// What surfaces pass over as they move says nothing of who follows whom. Before `find`. Local.
  void pass_over(const MovingSurface<dim>& surface);
  const std::vector<int>& of_cell() const { return of_cell_; }  ///< of stored cells; -1: none
  const std::vector<GasPocket>& all() const { return pockets_; }

  /// Gives the cells of the pockets these pressures p̂; empty: zero. Local.
  void fill(const std::vector<double>& of_pockets, CellField& scaled_pressure);
  void accept(double dt);  ///< keeps the pressures last given, in a step of dt. Local.
  GasReport report() const;
  std::vector<StoredField> fields();

 private:
  std::vector<char> open_groups(const CellGroups& groups, const CellField& phi) const;
  /// The groups that become pockets, by their volumes.
  std::vector<int> choose(const std::vector<char>& is_open,
                          const std::vector<double>& volumes) const;
  void inherit(const CellField& phi);
  GasPocket pocket_of(double volume, double amount, double last_pressure) const;

  const MacDomain<dim>& domain_;
  GasParameters<dim> parameters_;
  Point<dim> gravity_;
  LiquidVolume<dim> measure_;
  std::vector<char> is_void_;  ///< and not solid, of stored cells
  std::vector<int> of_cell_;
  std::vector<GasPocket> pockets_;
  std::vector<double> amounts_;  ///< V_0 by pocket [m^dim]
  std::vector<double> scaled_pressure_, accepted_pressure_;
  /// Of each cell: the number of its pocket from 1, -1 in the atmosphere, 0 elsewhere; V_0 and the
  /// last pressure of that.
  CellField number_, amount_, last_pressure_;
};

}  // namespace lockstep
