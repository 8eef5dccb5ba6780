#pragma once
#include <array>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "grid/tile_lattice.hpp"
#include "parameters/field_formula.hpp"
#include "staggered/domain/inflow_opening.hpp"
#include "staggered/domain/inflow_wave.hpp"

namespace lockstep {

enum class SideType {
  wall,       ///< closed, the fluid sticks to it
  slip_wall,  ///< closed, without friction
  open,       ///< given pressure at the face
  inflow,     ///< prescribed velocity
  periodic
};

/// One side of the domain.
template <int dim>
struct BoundarySide {
  SideType type = SideType::wall;
  /// Velocity of the wall (tangential only) or the inflow [m/s].
  FieldFormula<dim> velocity = FieldFormula<dim>(std::vector<double>(dim, 0.));
  FieldFormula<dim> pressure =
      FieldFormula<dim>(std::vector<double>{0.});  ///< given at an open side [Pa]
  InflowOpening<dim> opening;
  std::optional<InflowWave<dim>> wave;  ///< instead of `velocity`
  FieldFormula<dim> smoke =
      FieldFormula<dim>(std::vector<double>{0.});  ///< carried by the inflow [1]
  FieldFormula<dim> temperature =
      FieldFormula<dim>(std::vector<double>{0.});  ///< carried by the inflow [K]
  /// Cotangent of the angle, in the liquid, at which a free surface meets a closed side [1].
  double contact_cotangent = 0;

  bool closed() const { return type == SideType::wall || type == SideType::slip_wall; }
  /// True if fluid may come in or leave at a given velocity, or a wall move.
  bool moves() const { return wave || !velocity.vanishes(); }
  bool prescribed() const { return closed() || type == SideType::inflow; }
  /// True if what comes in is air: liquid comes in where the side has a pressure.
  bool lets_in_air() const { return type == SideType::open && pressure.vanishes(); }
  /// True if the velocity jumps between two times: of halves of the time, one after the other, one
  /// has most of the change. Local.
  bool jumps(double begin, double end) const;
  /// At `x` on this side, which is normal to `axis`.
  Point<dim> velocity_at(int axis, const Point<dim>& x, double time) const;
  /// The mean over a face of this side, or over a box at it.
  Point<dim> mean_velocity(int axis, const Box<dim>& face, double time) const;
};

/// The sides of the domain: [axis][0 lower, 1 upper].
template <int dim>
struct Boundary {
  std::array<std::array<BoundarySide<dim>, 2>, dim> sides;

  const BoundarySide<dim>& side(int axis, int end) const { return sides[axis][end]; }
  bool periodic(int axis) const { return sides[axis][0].type == SideType::periodic; }
};

/// "x lower", as the scene names it.
std::string side_name(int axis, int end);

/// The cells and sides of a scene's "Domain" list.
template <int dim>
struct DomainDescription {
  GridDescription<dim> grid;
  Boundary<dim> boundary;
};

/// Adds the waves of a validated list "Domain" to its boundary; `fluid` is the list "Fluid". Throws
/// InputError.
template <int dim>
void read_waves(const ParameterList& fluid, const ParameterList& domain,
                DomainDescription<dim>& description);

/// Schema of the "Domain" list.
template <int dim>
ParameterList domain_parameters();
/// Throws InputError if the cells are not cubes, or too small to be told apart so far from the
/// origin, if only one side of an axis is periodic, or if a
/// wall moves through itself.
template <int dim>
DomainDescription<dim> read_domain(const ParameterList& list);

/// Sets the storage that the sides need: faces at the upper end of open and inflow sides.
template <int dim>
void set_grid_flags(const Boundary<dim>& boundary, GridDescription<dim>& grid);

}  // namespace lockstep
