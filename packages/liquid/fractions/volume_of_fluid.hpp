#pragma once
#include "liquid/common/continuation.hpp"
#include "liquid/common/interface_model.hpp"
#include "liquid/common/redistance.hpp"
#include "liquid/fractions/fraction_transport.hpp"
#include "parameters/parameter_list.hpp"
#include "transport/transport.hpp"

namespace lockstep {

/// The numbers of a volume of fluid.
struct VolumeOfFluidParameters {
  /// Cells around the surface in which phi is known: as many as a level set has.
  static constexpr int band = 6;
  bool removes_fragments = true;  ///< liquid too thin for the grid goes back to its component
  /// Most that the surface shifts in a step, to take up what fragments and moving solids have
  /// displaced: half of VolumeParameters::largest_shift [cells]. Chosen, not varied by a page.
  static constexpr double largest_shift = 0.1;
};

/// Schema of the interface "volume of fluid".
ParameterList volume_of_fluid_parameters();
VolumeOfFluidParameters read_volume_of_fluid_parameters(const ParameterList& list);

/// The part of each cell that is liquid, advected without loss; phi is made of the planes that
/// these fractions stand for. The volume defects of moving solids and removed fragments are kept
/// where they arise, and the liquid components there take them back.
template <int dim>
class VolumeOfFluid : public InterfaceModel<dim> {
 public:
  using typename InterfaceModel<dim>::Surface;

  VolumeOfFluid(const MacDomain<dim>& domain, const VolumeOfFluidParameters& parameters);

  std::string name() const override { return "volume of fluid"; }
  void save(CheckpointWriter& checkpoint) const override;
  void load(const CheckpointReader& checkpoint) override;
  bool migrates() const override { return true; }
  std::function<void()> migrate(const TileMigration<dim>& migration) override;

  void initialise(const SignedDistance<dim>& distance, const Surface& surface) override;
  void meet_solids(const Surface& surface) override { find_solids(surface); }
  void advance(const InterfaceStep<dim>& step) override;
  const CellField& distance() const override { return phi_; }
  /// By heights.
  std::optional<double> curvature(int wet, int axis, int side, double place,
                                  const CellField& lead) const override;
  int band(double largest_displacement) const override;
  bool moves_by_fluxes() const override { return true; }
  LiquidLedger ledger() const override;
  WatchedLiquid liquid_in(const std::vector<char>& cells) const override;

  const Fractions& fractions() const { return fractions_; }

 private:
  double cut_off() const { return parameters_.band * domain_.spacing(); }
  void find_solids(const Surface& surface);
  /// Flags the tiles near the surface; `arrived`: also cells that have become wet or dry since phi
  /// was made.
  std::vector<char> tiles_within(int reach, bool arrived = false) const;
  /// Returns the flags of the tiles in which anything may have changed.
  std::vector<char> advect(const InterfaceStep<dim>& step);
  /// Moves solids to the end of the step; cells that change sides do so without their liquid.
  /// Returns true if surfaces have taken liquid along, on any rank.
  bool move_solids(const InterfaceStep<dim>& step, const std::vector<char>& tiles);
  /// Marks owned fluid cells: 1 where no ray could be followed, or no fluid was.
  InvalidSamples<dim> find_swept(const InterfaceStep<dim>& step,
                                 const std::vector<char>& tiles) const;
  void add_sources(const InterfaceStep<dim>& step);
  void make_distance(const std::vector<char>& tiles);
  /// The part of a cell inside a shape.
  double part_inside(const SignedDistance<dim>& shape, int cell) const;
  double sum_of_liquid() const;

  const MacDomain<dim>& domain_;
  VolumeOfFluidParameters parameters_;
  CellField phi_;
  Fractions fractions_;
  SolidCells<dim> solids_;  ///< at the present time
  Continuation<dim> continuation_;
  FractionTransport<dim> transport_;
  FractionPlanes<dim> planes_;
  double courant_ = 0;      ///< Courant number of the last step
  long long n_sweeps_ = 0;  ///< sweeps so far: they decide which axis comes first
  int n_bodies_ = 0;
  double volume_ = 0, target_ = 0, paid_ = 0, lost_ = 0;  ///< sums over all ranks [cells]
};

}  // namespace lockstep
