#pragma once
#include <vector>

#include "grid/needed_tiles.hpp"
#include "liquid/liquid_parameters.hpp"
#include "staggered/domain/mac_domain.hpp"
#include "staggered/domain/region_shape.hpp"
#include "transport/grid_state.hpp"

namespace lockstep {

/// Choice of the tiles that a fluid needs: those where it moves or carries something, or that a
/// liquid with a free surface fills, those near solids, and those where something enters or was
/// asked for. Read once from the fluid's list.
template <int dim>
class MovingTiles {
 public:
  MovingTiles(const ParameterList& fluid, const DomainDescription<dim>& domain);

  /// Returns the tiles that are asked for at the start. Collective.
  TileOwners first(const Communicator& comm) const;

  /// An advected scalar, and its value in fluid at rest.
  struct Carried {
    const CellField& values;
    double ambient;
  };
  /// State at the beginning of a step.
  struct Present {
    const TiledGrid<dim>& grid;
    const TileOwners& owners;  ///< owners of its tiles
    const GridState<dim>& state;
    const FaceField<dim>& velocity;
    double largest_speed;  ///< [m/s]
    std::vector<Carried> scalars;
    double time, dt;     ///< [s]
    double solid_speed;  ///< speed of the fastest solid [m/s]
    /// phi of a liquid, else null: tiles are needed where it is less than `band` [m].
    const CellField* distance = nullptr;
    double band = 0;
    bool is_start = false;  ///< before the first step: what is asked for at the start counts
  };
  /// Collective: other tiles, if they are needed.
  std::optional<TileOwners> change(const Present& present) const;
  /// Throws SolveError if a surface is where no tile is. Collective.
  void check_room(const SurfaceSnapshot<dim>& surface, const TileOwners& owners,
                  const Communicator& comm) const;

 private:
  /// A region that is stored until a time.
  struct Asked {
    Box<dim> region;
    double until;
  };
  void ask_for(const ParameterList& regions, double until);
  void ask_for_sides(const DomainDescription<dim>& domain);
  void add_regions(double time, NeededTiles<dim>& needed) const;
  void add_liquid(const Communicator& comm, NeededTiles<dim>& needed) const;
  void add_moving(const Present& present, NeededTiles<dim>& needed) const;
  static void add_surface(const SurfaceSnapshot<dim>& surface, const Communicator& comm,
                          NeededTiles<dim>& needed);

  TileLattice<dim> lattice_;
  int margin_;
  double threshold_;
  std::vector<Asked> asked_;
  SignedDistance<dim> liquid_;  ///< at the start; empty without a free surface
};

/// Declares "Moving Tiles" in the fluid's list.
template <int dim>
void declare_moving_tiles(ParameterList& fluid);

/// The domain of a fluid with the tiles that it has at the start: all, or those it needs.
/// Throws InputError. Collective.
template <int dim>
MacDomain<dim> make_domain(const ParameterList& fluid, const ParameterList& domain,
                           const Communicator& comm);

/// Marks the domain's cells beside tiles that do not exist, among all stored cells: the fluid is at
/// rest there. Empty if all tiles exist. Collective.
template <int dim>
std::vector<char> find_band_edge(const MacDomain<dim>& domain);
/// Makes the fluid cells of the rim empty. Collective.
template <int dim>
void clear_band_edge(const MacDomain<dim>& domain, std::vector<CellState>& cells);

}  // namespace lockstep
