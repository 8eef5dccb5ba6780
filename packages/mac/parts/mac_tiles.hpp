#pragma once
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "mac/state/mac_flow.hpp"
#include "mac/tiles/moving_tiles.hpp"

namespace lockstep {

/// Has the grid of a fluid follow what happens in it: tiles come and go, and ranks share the work.
template <int dim>
class MacTiles {
 public:
  using Surface = std::shared_ptr<const SurfaceSnapshot<dim>>;

  /// Throws InputError for a liquid that cannot follow moving tiles. Collective.
  MacTiles(const ParameterList& fluid, MacFlow<dim>& flow);

  bool move() const { return moving_.has_value(); }  ///< false: all tiles exist, always
  /// See FluidDiscretization::begin_step. Collective.
  bool begin_step(double time, double dt, const std::function<double()>& solid_speed);
  /// Before the geometry is frozen: tiles for the first surface, before any step. Throws SolveError
  /// if a surface is where no tile is. Collective.
  void make_room(const Surface& surface);
  /// Rates of cells that were made one step ago are not those of a flow.
  bool are_new() const { return steps_since_regrid_ <= 1; }
  /// Counts the step, once however many of its solves are accepted.
  void accept();
  /// Applies the pressure beyond the stored tiles to the faces at the band edge over dt, that of
  /// fluid at rest under this acceleration; returns this rank's impulse.
  Momentum<dim> push_at_band_edge(const Point<dim>& force, double dt);

  void save(CheckpointWriter& checkpoint) const;
  void load(const CheckpointReader& checkpoint);
  std::vector<std::pair<std::string, std::string>> notes() const;  ///< for `--explain`

 private:
  typename MovingTiles<dim>::Present present(const GridState<dim>& state, double time,
                                             double dt) const;
  void make_first_room(const Surface& surface);
  void check_owners(const CheckpointReader& checkpoint, const TileOwners& owners,
                    long long n_ranks) const;
  bool share_work();
  /// Other tiles: all fields move; what else was made of the grid waits until geometry is frozen.
  void regrid(const TileOwners& owners);
  void rest_at_band_edge();
  /// Interface of the liquid; null: it cannot live on other tiles.

  MacFlow<dim>& flow_;
  std::optional<MovingTiles<dim>> moving_;  ///< none: all tiles exist, always
  TileOwners owners_;                       ///< owners of the tiles; empty: as at the start
  int steps_since_regrid_ = 2;              ///< accepted; 2: or more
  bool step_is_counted_ = false;            ///< since it began
  int steps_to_sharing_ = 0;                ///< before work is next compared between ranks
  TileWork compared_work_;                  ///< work of this rank's tiles, then
  bool has_room_ = false;                   ///< for the first surface
};

}  // namespace lockstep
