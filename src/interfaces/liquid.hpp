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

namespace lockstep {

/// The liquid of a watched place. Global.
struct WatchedLiquid {
  double volume = 0;  ///< [m^dim]
  double target = 0;  ///< what it should be [m^dim]
  double leak = 0;    ///< of it what came through solids; with a leak a step fails [m^dim]
};

/// The gas that is trapped. Global.
struct GasReport {
  long long n_pockets = 0;
  double volume = 0;    ///< of all of them [m^dim]
  double pressure = 0;  ///< in the largest, above that of the void, in the last step [Pa]
};

/// The drops that fly beside the liquid. Global.
struct DropsReport {
  long long n = 0;
  double volume = 0;  ///< of all of them; no part of the liquid's, nor of its target [m^dim]
};

/// An impulse on a surface, that of a drop that hits it.
template <int dim>
struct SurfaceImpulse {
  SurfacePoint<dim> point;                  ///< of the snapshot at the end of the step
  Point<dim> place = Point<dim>::Zero();    ///< where it acts [m]
  Point<dim> impulse = Point<dim>::Zero();  ///< [kg m/s]
};

/// How much liquid there is, and what became of it. Global.
struct LiquidReport {
  double volume = 0;  ///< [m^dim]
  double target = 0;  ///< what it should be: of the start, with all that flowed in and out [m^dim]
  double shift = 0;   ///< volume that corrections have moved so far [m^dim]
  double lost = 0;    ///< that vanished with drops too small to see [m^dim]
  long long n_bodies = 0;              ///< connected bodies of liquid
  std::vector<WatchedLiquid> watches;  ///< in the order of their names
  std::optional<GasReport> gas;        ///< if any may be trapped
  std::optional<DropsReport> drops;    ///< if there may be any
};

/// What of a closed solid lies in a liquid, and what the grid takes that for: below the plane that
/// the free surface around it lies in most nearly. Global.
template <int dim>
struct WetBody {
  /// The free surface crosses it, or it is above. False: it is all in the liquid, and the rest is
  /// not set.
  bool partly = false;
  double volume = 0;                         ///< below the free surface [m^dim]
  Point<dim> centroid = Point<dim>::Zero();  ///< of that, about; zero without volume
  /// By axis: the wet parts of the dual cells that the solid blocks or fills, which the pressure
  /// lifts along that axis, and their first moment [m^dim, m^(dim+1)].
  std::array<double, dim> displaced{};
  std::array<Point<dim>, dim> moment{};
  /// By axis: a wet column of it ends at a side of the domain, where the pressure does not reach.
  std::array<bool, dim> at_side{};
  /// Of that plane: a point is slope * x less the level above it, along the vertical [m]. Zero
  /// slope: no free surface is around, as without gravity.
  Point<dim> slope = Point<dim>::Zero();
  double level = 0;

  double depth(const Point<dim>& x) const { return std::max(0.0, level - slope.dot(x)); }
};

/// A side of fluids: a liquid with a free surface, above which nothing pushes.
template <int dim>
class LiquidFluid {
 public:
  virtual ~LiquidFluid() = default;
  /// From x to the free surface, negative in the liquid [m]; linear between the centres of cells,
  /// carried on into solids, cut off a few cells away. Near cells that this rank owns. Local.
  virtual double surface_distance(const Point<dim>& x) const = 0;
  /// The same from each point to the surface at the end of the last step, 1e300 where nothing is
  /// stored. The same on all ranks. Collective; all ranks ask for the same points.
  virtual std::vector<double> surface_distances(const std::vector<Point<dim>>& points) const = 0;
  /// By solid of the frozen surface; those that are not closed have nothing. Collective.
  virtual std::vector<WetBody<dim>> wet_bodies() const = 0;
  virtual LiquidReport report() const = 0;
  virtual bool traps_gas() const { return false; }  ///< reports have `gas`. Local.
  virtual bool has_drops() const { return false; }  ///< reports have `drops`. Local.
  /// What drops gave to solids in the last `advect`, on every rank; the forces after it take it
  /// from the drops. Collective.
  virtual std::vector<SurfaceImpulse<dim>> impulses_on_solids() const { return {}; }
  /// What surface tension gave in the last `add_forces`, as part of its impulse, and in a viscous
  /// solve since then, as part of what `accept_viscous` returned. Global. Local.
  virtual Momentum<dim> surface_impulse() const { return {}; }
  /// Of the watched places, as columns have them. Local.
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
