#pragma once
#include <functional>
#include <vector>

#include "interfaces/fluid.hpp"
#include "interfaces/liquid.hpp"
#include "output/checkpoint.hpp"
#include "staggered/domain/mac_domain.hpp"

namespace lockstep {

/// Liquid that the grid is too coarse to show.
template <int dim>
struct Drop {
  Point<dim> position = Point<dim>::Zero();  ///< [m]
  Point<dim> velocity = Point<dim>::Zero();  ///< [m/s]
  Point<dim> next = Point<dim>::Zero();      ///< its velocity from the step's forces on [m/s]
  double volume = 0;                         ///< [m^dim]
};

/// Drops that fall through the air without drag, each on the rank whose tile it is in; where no
/// tile is, on any. They know no density: momenta are volume times velocity.
template <int dim>
class Drops {
 public:
  using Condition = std::function<bool(const Drop<dim>&)>;

  explicit Drops(const MacDomain<dim>& domain) : domain_(domain) {}

  /// Moves all drops over a step, to the ranks where they are then. At closed sides and solids they
  /// lose their normal velocity, and stay a tenth of a cell before solids; drops that leave through
  /// an open side are gone. Velocities change with `speed_up`. Returns the volume on this rank that
  /// solids left no room for. Collective.
  double fly(const MovingSurface<dim>& surface, const Point<dim>& gravity, double dt);
  /// Adds a drop on a tile of this rank.
  void add(const Drop<dim>& drop) { state_.drops.push_back(drop); }
  /// Takes out the drops for which `has_fallen` is true; they wait in `fallen`, with the velocity
  /// that solids left them, before gravity has changed it. Local.
  void take(const Condition& has_fallen);
  void remove(const Condition& goes);  ///< for good; local
  /// Drops of this rank that have fallen in this step.
  const std::vector<Drop<dim>>& fallen() const { return state_.fallen; }
  /// Gives drops that have flown their new velocities; returns the change of momentum [m^dim m/s],
  /// on this rank. Local.
  Momentum<dim> speed_up();
  /// Impulses of this rank's drops on solids in this step, as volume times velocity.
  const std::vector<SurfaceImpulse<dim>>& pushes() const { return state_.pushes; }

  Momentum<dim> momentum() const;  ///< on this rank [m^dim m/s]
  double kinetic_energy() const;   ///< on this rank, over the density [m^(dim+2) / s^2]
  const std::vector<Drop<dim>>& mine() const { return state_.drops; }
  /// Over all ranks, after `count`.
  const DropsReport& report() const { return state_.report; }
  void count();  ///< collective
  /// Sends drops to the ranks whose tiles they are on, after these have changed. Collective.
  void redistribute();
  void clear() { state_ = {}; }

  void save(CheckpointWriter& checkpoint) const;  ///< under fluid/drops
  void load(const CheckpointReader& checkpoint);

 private:
  struct State {
    std::vector<Drop<dim>> drops, fallen;
    std::vector<SurfaceImpulse<dim>> pushes;
    bool is_due = false;  ///< `next` waits
    Point<dim> by_gravity =
        Point<dim>::Zero();  ///< the part of the step's change of velocity [m/s]
    DropsReport report;
  };
  /// Moves a place back to closed sides that it is beyond, and sets its normal velocity to zero;
  /// returns false if it has left through another side.
  bool stop_at_sides(Point<dim>& place, Point<dim>& velocity) const;
  enum class Fate { stays, leaves, has_no_room };
  /// Stops a drop at solids on the way `to` a place, maybe before a side; returns `fate` where
  /// there is none.
  Fate stop_at_solids(const MovingSurface<dim>& surface, double reach, Fate fate, Drop<dim>& drop,
                      Point<dim>& to);
  /// Keeps those of `drops` that are on this rank's tiles, or on no rank's if `holder` names this
  /// one.
  void hand_out(const std::vector<Drop<dim>>& drops, const std::vector<int>& holder);

  const MacDomain<dim>& domain_;
  State state_;
};

}  // namespace lockstep
