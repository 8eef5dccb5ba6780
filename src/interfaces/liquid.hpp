#pragma once
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "geometry/surface_snapshot.hpp"
#include "interfaces/momentum.hpp"
#include "interfaces/surface_forces.hpp"

namespace lockstep {

/// The liquid of a watched place. Global.
struct WatchedLiquid {
  double volume = 0;  ///< [m^dim]
  double target = 0;  ///< target volume [m^dim]
};

/// The gas that is trapped. Global.
struct GasReport {
  long long n_bubbles = 0;
  double volume = 0;  ///< volume of all bubbles [m^dim]
  double pressure =
      0;  ///< in the largest bubble, above the pressure of the air, in the last step [Pa]
};

/// The drops that fly beside the liquid. Global.
struct DropsReport {
  long long n = 0;
  double volume = 0;  ///< volume of all drops; no part of the liquid's, nor of its target [m^dim]
};

/// Volume balance of the liquid. Global.
struct LiquidReport {
  double volume = 0;       ///< [m^dim]
  double target = 0;       ///< initial volume plus net inflow [m^dim]
  double shift = 0;        ///< volume that corrections have moved so far [m^dim]
  double lost = 0;         ///< volume that vanished with drops below the grid's resolution [m^dim]
  long long n_bodies = 0;  ///< connected liquid components
  std::vector<WatchedLiquid> watches;  ///< in the order of their names
  std::optional<GasReport> gas;        ///< if any may be trapped
  std::optional<DropsReport> drops;    ///< if there may be any
};

/// Height of the free surface around a solid, along the vertical -g/|g|. Global.
struct WaterLevel {
  bool known = false;   ///< false: there is no free surface, or no gravity
  bool is_wet = false;  ///< liquid is at the solid, in its sight
  bool pierces =
      false;  ///< air or gas comes near the solid: it pierces the surface, or is above it
  /// Mean of the places where liquid meets air: of those near the solid that it sees, if there are
  /// any, else of all [m].
  double height = 0;
};

/// Side interface of fluids: a liquid with a surface, above which is a gas, or air that exerts no
/// pressure (p = 0).
template <int dim>
class LiquidFluid {
 public:
  virtual ~LiquidFluid() = default;
  /// From x to the free surface, negative in the liquid [m]; linear between the centres of cells,
  /// carried on into solids, cut off a few cells away. Near cells that this rank owns. Local.
  virtual double surface_distance(const Point<dim>& x) const = 0;
  /// Distance from each point to the surface at the end of the last step [m], 1e300 where nothing
  /// is stored. The same on all ranks. Collective; all ranks ask for the same points.
  virtual std::vector<double> surface_distances(const std::vector<Point<dim>>& points) const = 0;
  /// True if x is in a closed solid, where the distance goes on but no liquid is. Local, the same
  /// on all ranks. Default: nowhere.
  virtual bool in_solid(const Point<dim>&) const { return false; }
  /// By solid of the frozen surface. Collective.
  virtual std::vector<WaterLevel> levels_at_solids() const = 0;
  /// Density of the gas above [kg/m^dim]; 0: air has no mass. Local.
  virtual double gas_density() const { return 0; }
  virtual LiquidReport report() const = 0;
  virtual bool traps_gas() const { return false; }  ///< reports have `gas`. Local.
  virtual bool has_drops() const { return false; }  ///< reports have `drops`. Local.
  /// Returns the impulses of drops on solids in the last `advect`, the same on every rank; the next
  /// `add_forces` takes them from the drops. Collective.
  virtual std::vector<SurfaceImpulse<dim>> impulses_on_solids() const { return {}; }
  /// Returns the impulse of surface tension in the last `add_forces`, as part of its result, and in
  /// a viscous solve since then, as part of the result of `accept_viscous`. Global. Local.
  virtual Momentum<dim> surface_impulse() const { return {}; }
  /// Returns the names of the watched places, as the columns of tables have them. Local.
  virtual std::vector<std::string> watch_names() const { return {}; }
};

/// The part of a box of the size of a cell in which `distance` of a point is negative, as a box:
/// the surface there is taken to be across the axis that it is most nearly normal to, which keeps
/// the volume. May be empty. Local.
template <int dim, typename Distance>
Box<dim> part_below(const Distance& distance, Box<dim> box) {
  const Point<dim> center = box.center(), size = box.sizes();
  const double middle = distance(center);
  if (std::abs(middle) > size.norm())
    return middle < 0 ? box : Box<dim>();
  Point<dim> slope;
  for (int a = 0; a < dim; ++a) {
    const Point<dim> half = 0.5 * size[a] * Point<dim>::Unit(a);
    slope[a] = (distance(center + half) - distance(center - half)) / size[a];
  }
  int axis = 0;
  if (slope.cwiseAbs().maxCoeff(&axis) == 0)
    return middle < 0 ? box : Box<dim>();
  const double place = center[axis] - middle / slope[axis];
  double& end = slope[axis] > 0 ? box.max()[axis] : box.min()[axis];
  end = std::min(std::max(place, box.min()[axis]), box.max()[axis]);
  return box;
}

/// The part of a box that is in the liquid. Local.
template <int dim>
Box<dim> wet_part(const LiquidFluid<dim>& liquid, const Box<dim>& box) {
  return part_below<dim>([&](const Point<dim>& x) { return liquid.surface_distance(x); }, box);
}

}  // namespace lockstep
