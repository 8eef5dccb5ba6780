#pragma once
#include <functional>
#include <memory>
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

/// Where the liquid's volume has gone [m^dim], over all ranks.
struct LiquidLedger {
  double volume = 0;  ///< of the liquid outside solids
  double target = 0;  ///< what known fluxes have left of the initial volume
  double shift = 0;   ///< what corrections have added and taken away since the start, both positive
  double lost = 0;    ///< of bodies that vanished and left no other in their closed space
  int n_components = 0;  ///< bodies of liquid
};

/// Stored cells (1) with liquid, owned and of the halo of width 1.
struct LiquidCells {
  std::vector<char> seen;    ///< not solid; wet, or a drop that the grid does not show is in sight
  std::vector<char> hidden;  ///< owned: such a drop is in a gap that no centre of a cell sees
};

/// What moves an interface over one step.
template <int dim>
struct InterfaceStep {
  /// u_ADV [m/s] on all owned faces that are not inside solids, extended from the liquid over
  /// `band()` cells; what it is beyond does not matter.
  const FaceField<dim>& advection_velocity;
  const MovingSurface<dim>& surface;
  RayHalo<dim>& ray_halo;  ///< of the domain's grid
  KeptSurface<dim>& kept;
  double time = 0;  ///< t^n [s]
  double dt = 0;    ///< [s]
  /// Liquid is created inside these and removed inside those, at the end of the step.
  std::vector<SignedDistance<dim>> sources, sinks;
  Point<dim> gravity = Point<dim>::Zero();  ///< with any body force [m/s^2]; drops fall with it
  /// The part of a face at a side of the domain, the lower one of this cell normal to an axis,
  /// through which fluid flows; null: all of it. Local.
  std::function<double(int axis, int cell)> open = nullptr;
  double open_part(int axis, int cell) const { return open ? open(axis, cell) : 1; }
};

/// The surface of a liquid: where it is, how it moves. A plug-in kind; a model knows no pressure.
/// The liquid is where `distance` is negative. Nothing of it passes through a surface of solids.
template <int dim>
class InterfaceModel : public PlugIn {
 public:
  using Surface = std::shared_ptr<const SurfaceSnapshot<dim>>;

  /// Takes the liquid to be where `distance` is negative and outside the solids; near its surface
  /// it should be a distance. The volume found becomes the target. Collective.
  virtual void initialise(const SignedDistance<dim>& distance, const Surface& surface) = 0;
  /// Moves the interface from t^n to t^{n+1}, final for the surfaces at t^{n+1}. Throws SolveError
  /// if the velocity is not finite. Collective.
  virtual void advance(const InterfaceStep<dim>& step) = 0;
  /// phi [m] on all stored cells, ghosts included, continued into solids; cut off at +- `band()` h.
  virtual const CellField& distance() const = 0;
  /// The part of the way from the centre of a wet cell to that of its dry neighbour that is under
  /// water, in (0, 1]. Default: phi is linear between them.
  virtual double crossing(int wet_cell, int dry_cell) const {
    const CellField& phi = distance();
    return phi[wet_cell] / (phi[wet_cell] - phi[dry_cell]);
  }
  /// Cells around the liquid's surface over which phi is known and a velocity is wanted, for a step
  /// in which nothing moves over more than so many cells. Local.
  virtual int band(double largest_displacement) const = 0;
  /// At the present time. Local.
  virtual LiquidLedger ledger() const = 0;
  /// Liquid that has left the interface for the time being; null: none ever does. Local.
  virtual Drops<dim>* drops() const { return nullptr; }
  /// Where there is liquid among the present solids. Collective. Default: the wet cells.
  virtual LiquidCells cells_with_liquid(const Surface&, KeptSurface<dim>&) {
    const CellField& phi = distance();
    LiquidCells cells{std::vector<char>(phi.size()), std::vector<char>(phi.size(), 0)};
    for (std::size_t cell = 0; cell < phi.size(); ++cell)
      cells.seen[cell] = phi[cell] < 0;
    return cells;
  }
  /// What of the liquid is in some stored cells (1), and should be; after a step. Collective.
  /// Default: throws InputError.
  virtual WatchedLiquid liquid_in(const std::vector<char>& /*cells*/) const {
    throw InputError(fmt::format(
        "The interface \"{}\" cannot tell how much is where; leave out \"Watch\".", this->name()));
  }
};

/// A side interface of models that can live on other tiles. With one that does without, tiles stay
/// as they are: there can be no "Moving Tiles", and ranks keep those that they have, however uneven
/// the work at solids becomes.
template <int dim>
class MigratingInterface {
 public:
  virtual ~MigratingInterface() = default;
  /// The tiles of the domain are about to change, between two steps; new ones are dry. Carries over
  /// what lives on them, and returns what is to be done once the domain has its new grid.
  /// Collective.
  virtual std::function<void()> migrate(const TileMigration<dim>&) = 0;
};

/// Interface models by name. They are built for a domain, which must outlive them.
template <int dim>
using InterfaceRegistry = Registry<InterfaceModel<dim>, const MacDomain<dim>&>;

}  // namespace lockstep
