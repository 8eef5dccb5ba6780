#pragma once
#include <optional>

#include "liquid/common/continuation.hpp"
#include "liquid/common/interface_model.hpp"
#include "liquid/common/volume_ledger.hpp"
#include "liquid/particles/particles.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

template <int dim>
struct TransportFrame;

/// The numbers of a level set.
struct LevelSetParameters {
  /// Cells around the surface in which phi is known. Chosen, not varied by a page; the particles
  /// ask for two more than their own band.
  static constexpr int band = 6;
  static_assert(band >= ParticleParameters::band + 2);
  int smallest_cavity = 0;  ///< cells of the largest cavity that is filled
  VolumeParameters volume;
  std::optional<ParticleParameters> particles;  ///< none: phi alone
};

/// Schema of the interfaces "level set" and "particle level set".
template <int dim>
ParameterList level_set_parameters();
template <int dim>
ParameterList particle_level_set_parameters();
/// Reads the parameters of either kind.
LevelSetParameters read_level_set_parameters(const ParameterList& list);

/// Level set: phi is a signed distance at cell centres, advected along rays and redistanced;
/// particles, if there are any, correct it (Enright et al. 2002).
template <int dim>
class LevelSet : public InterfaceModel<dim> {
 public:
  using typename InterfaceModel<dim>::Surface;

  LevelSet(const MacDomain<dim>& domain, const LevelSetParameters& parameters);

  std::string name() const override {
    return parameters_.particles ? "particle level set" : "level set";
  }
  void save(CheckpointWriter& checkpoint) const override;
  void load(const CheckpointReader& checkpoint) override;
  bool migrates() const override { return true; }
  std::function<void()> migrate(const TileMigration<dim>& migration) override;

  void initialise(const SignedDistance<dim>& distance, const Surface& surface) override;
  void advance(const InterfaceStep<dim>& step) override;
  const CellField& distance() const override { return phi_; }
  int band(double largest_displacement) const override;
  LiquidLedger ledger() const override { return volume_.state(); }
  Drops<dim>* drops() const override { return drops_.get(); }
  WatchedLiquid liquid_in(const std::vector<char>& cells) const override {
    return volume_.in_cells(phi_, cells);
  }

  const ParticleTiles<dim>& particles() const { return particles_; }
  /// Number of particles that surfaces have removed so far, on this rank.
  GlobalIndex n_particles_lost() const { return n_lost_; }

 private:
  double cut_off() const { return parameters_.band * domain_.spacing(); }
  /// Classifies cells for a surface; returns the solids before, if they have changed.
  std::optional<SolidCells<dim>> find_solids(const Surface& surface);
  /// Returns how far the fastest fluid goes [cells].
  double advect(const InterfaceStep<dim>& step);
  /// Redistances phi and corrects it by the particles. Sets the halo of width 1.
  void restore(const InterfaceStep<dim>& step, const std::vector<char>& tiles);
  /// Fills small air components and takes their particles out of them.
  void fill_small_cavities();
  void seed(KeptSurface<dim>& kept, bool all);
  void add_sources(const InterfaceStep<dim>& step);
  /// Makes drops of particles that no cell shows.
  void release_drops(const InterfaceStep<dim>& step, const TransportFrame<dim>& frame);
  void collect_drops(const InterfaceStep<dim>& step);
  /// Sets all ghosts of phi, and extrapolates it into solids.
  void settle();

  const MacDomain<dim>& domain_;
  LevelSetParameters parameters_;
  CellField phi_;
  SolidCells<dim> solids_;  ///< at the present time
  Continuation<dim> continuation_;
  double moved_ = 0;  ///< since phi was made a distance, at most [cells]
  VolumeLedger<dim> volume_;
  ParticleTiles<dim> particles_;
  std::vector<char> in_band_;          ///< owned cells that have been given particles
  std::unique_ptr<Drops<dim>> drops_;  ///< null: there are never any
  long long n_restored_ = 0;           ///< number of redistancings of phi
  GlobalIndex n_lost_ = 0;
  std::optional<VolumeTargets> loaded_;  ///< targets of a checkpoint, until the solids are known
};

}  // namespace lockstep
