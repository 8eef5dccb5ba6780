#pragma once
#include <optional>

#include "freesurface/redistance.hpp"
#include "freesurface/solid_cells.hpp"
#include "freesurface/volume_ledger.hpp"
#include "mac/liquid/interface_model.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// The numbers of a level set.
struct LevelSetParameters {
  int band = 6;           ///< cells around the surface in which phi is known
  int smallest_void = 0;  ///< cells of the largest void that is closed
  VolumeParameters volume;
};

/// Schema of the interface "level set".
template <int dim>
ParameterList level_set_parameters();
LevelSetParameters read_level_set_parameters(const ParameterList& list);

/// phi as a signed distance at cell centres, carried along rays and made a distance again.
template <int dim>
class LevelSet : public InterfaceModel<dim> {
 public:
  using typename InterfaceModel<dim>::Surface;

  LevelSet(const MacDomain<dim>& domain, const LevelSetParameters& parameters);

  std::string name() const override { return "level set"; }
  void save(CheckpointWriter& checkpoint) const override;
  void load(const CheckpointReader& checkpoint) override;
  std::function<void()> undo() override;

  void initialise(const SignedDistance<dim>& distance, const Surface& surface) override;
  void advance(const InterfaceStep<dim>& step) override;
  const CellField& distance() const override { return phi_; }
  int band(double largest_displacement) const override;
  LiquidLedger ledger() const override { return volume_.state(); }

 private:
  double cut_off() const { return parameters_.band * domain_.spacing(); }
  void find_solids(const Surface& surface);
  /// Returns how far the fastest fluid goes [cells].
  double carry(const InterfaceStep<dim>& step);
  void add_sources(const InterfaceStep<dim>& step);
  void finish();

  const MacDomain<dim>& domain_;
  LevelSetParameters parameters_;
  CellField phi_;
  SolidCells<dim> solids_;  ///< at the present time
  Redistancer<dim> redistancer_;
  double moved_ = 0;  ///< since phi was made a distance, at most [cells]
  VolumeLedger<dim> volume_;
  std::optional<VolumeTargets> loaded_;  ///< of a checkpoint, until the solids are known
};

}  // namespace lockstep
