#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include "base/errors.hpp"
#include "grid/tile_migration.hpp"
#include "interfaces/fluid.hpp"
#include "interfaces/liquid.hpp"
#include "interfaces/plug_in.hpp"
#include "liquid/drops/drops.hpp"
#include "parameters/registry.hpp"
#include "staggered/domain/mac_domain.hpp"
#include "transport/nearby_surface.hpp"
#include "transport/ray_halo.hpp"

namespace lockstep {

/// Distance of a point to the surface of a liquid, negative inside it [m].
template <int dim>
using SignedDistance = std::function<double(const Point<dim>&)>;

/// Volume balance of the liquid [m^dim], over all ranks.
struct LiquidLedger {
  double volume = 0;  ///< volume of the liquid outside solids
  double target = 0;  ///< initial volume plus known fluxes
  double shift = 0;   ///< sum of the magnitudes of all corrections since the start
  double lost = 0;  ///< volume of components that vanished and left no other in their closed space
  int n_components = 0;  ///< connected liquid components
};

/// Input of an interface's motion over one step.
template <int dim>
struct InterfaceStep {
  /// u_ADV [m/s] on all owned faces that are not inside solids, extended from the liquid over
  /// `band()` cells; values beyond are not used.
  const FaceField<dim>& advection_velocity;
  const MovingSurface<dim>& surface;
  RayHalo<dim>& ray_halo;  ///< ray halo of the domain's grid
  KeptSurface<dim>& kept;
  double time = 0;  ///< t^n [s]
  double dt = 0;    ///< [s]
  /// Shapes inside which liquid is created and removed, at the end of the step.
  std::vector<SignedDistance<dim>> sources, sinks;
  Point<dim> gravity = Point<dim>::Zero();  ///< with any body force [m/s^2]; drops fall with it
  /// The part of a face at a side of the domain, the lower one of this cell normal to an axis,
  /// through which fluid flows; null: all of it. Local.
  std::function<double(int axis, int cell)> open = nullptr;
  double open_part(int axis, int cell) const { return open ? open(axis, cell) : 1; }
};

/// The interface of a liquid and its motion. A plug-in kind; a model knows no pressure. The liquid
/// is where `distance` is negative. Nothing of it passes through a surface of solids.
template <int dim>
class InterfaceModel : public PlugIn {
 public:
  using Surface = std::shared_ptr<const SurfaceSnapshot<dim>>;

  /// Initialises the liquid where `distance` is negative and outside the solids; near its surface
  /// it should be a distance. The volume found becomes the target. Collective.
  virtual void initialise(const SignedDistance<dim>& distance, const Surface& surface) = 0;
  /// Tells the surfaces of solids at the present time, which after a restart no step has shown yet.
  /// Default: they matter to nothing but `advance`. Local.
  virtual void meet_solids(const Surface& /*surface*/) {}
  /// Moves the interface from t^n to t^{n+1}, final for the surfaces at t^{n+1}. Throws SolveError
  /// if the velocity is not finite. Collective.
  virtual void advance(const InterfaceStep<dim>& step) = 0;
  /// phi [m] on all stored cells, ghosts included, extrapolated into solids; cut off at the edges
  /// of the narrow band, +- `band()` h.
  virtual const CellField& distance() const = 0;
  /// True if the interface moves by what flows through faces, for which a velocity without
  /// divergence on both sides is best; false: with the velocity of the liquid. Local.
  virtual bool moves_by_fluxes() const { return false; }
  /// The part of the way from the centre of a wet cell to that of its dry neighbour that is under
  /// water, in (0, 1]. Default: phi is linear between them.
  virtual double crossing(int wet_cell, int dry_cell) const {
    const CellField& phi = distance();
    return phi[wet_cell] / (phi[wet_cell] - phi[dry_cell]);
  }
  /// Curvature of the surface where it crosses the line from the centre of a wet cell to that of
  /// the dry one beside it, at the part `place` of the way, of the surface that lies `lead` [m]
  /// within this one, a field of small values near it; positive where the liquid is convex [1/m].
  /// Nothing where phi knows as much, as by default. Local.
  virtual std::optional<double> curvature(int /*wet*/, int /*axis*/, int /*side*/, double /*place*/,
                                          const CellField& /*lead*/) const {
    return {};
  }
  /// Half width of the narrow band: cells around the liquid's surface over which phi is known and a
  /// velocity is needed, for a step in which nothing moves over more than so many cells. Local.
  virtual int band(double largest_displacement) const = 0;
  /// Volumes at the present time. Local.
  virtual LiquidLedger ledger() const = 0;
  /// Drops that have left the interface; null: none ever does. Local.
  virtual Drops<dim>* drops() const { return nullptr; }
  /// True if it can live on other tiles. Default: it cannot; then tiles stay as they are: there can
  /// be no "Moving Tiles", and ranks keep those that they have, however uneven the work at solids
  /// becomes. Local.
  virtual bool migrates() const { return false; }
  /// Moves the fields on the tiles of the domain, which are about to change between two steps; new
  /// tiles are dry. Returns the action that is due once the domain has its new grid. Collective.
  virtual std::function<void()> migrate(const TileMigration<dim>&) { return {}; }
  /// Measures the volume and target of the liquid in some stored cells (1); after a step.
  /// Collective. Default: throws InputError.
  virtual WatchedLiquid liquid_in(const std::vector<char>& /*cells*/) const {
    throw InputError(fmt::format(
        "The interface \"{}\" cannot tell how much is where; leave out \"Watch\".", this->name()));
  }
};

/// Interface models by name. They are built for a domain, which must outlive them.
template <int dim>
using InterfaceRegistry = Registry<InterfaceModel<dim>, const MacDomain<dim>&>;

}  // namespace lockstep
