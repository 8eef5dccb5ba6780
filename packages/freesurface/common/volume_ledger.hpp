#pragma once
#include <vector>

#include "mac/liquid/interface_model.hpp"
#include "mac/liquid/liquid_volume.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

enum class VolumeCorrection {
  component,  ///< each body of liquid keeps its own volume
  global,     ///< all of them together
  none
};

/// How the volume of a liquid is kept.
struct VolumeParameters {
  VolumeCorrection correction = VolumeCorrection::component;
  /// Most that the surface shifts in a step that carries it over no more than a cell; in longer
  /// steps as many times as much [cells]. Chosen small beside a cell, not varied by a page.
  static constexpr double largest_shift = 0.2;
};

/// Declares "Volume Correction".
void declare_volume_correction(ParameterList& list);
VolumeParameters read_volume_correction(const ParameterList& list);

/// What the ledger must keep from step to step.
struct VolumeTargets {
  std::vector<double> of_group;  ///< what each body of liquid should have [m^dim]
  double loose = 0;  ///< what is left of the start's liquid that is beside no liquid cell [m^dim]
  double lost = 0, shift = 0;  ///< [m^dim]
};

/// By how much phi has been lowered in owned cells on and beside bodies [m]; empty: nowhere.
using VolumeShift = CellField;

/// Keeps account of the volume of each body of liquid and sees to it that phi has it. A body's
/// target changes by known fluxes only; where bodies merge it is added, where one parts it is
/// shared in proportion to the volumes.
template <int dim>
class VolumeLedger {
 public:
  VolumeLedger(const MacDomain<dim>& domain, const VolumeParameters& parameters);

  /// Takes the present volumes as targets. Collective.
  void begin(const SolidCells<dim>& solids, const CellField& phi);
  /// Takes off what flows out through the sides of the domain in a step; through open sides no
  /// liquid comes in. Before phi is carried. Collective.
  void flow_out(const SolidCells<dim>& solids, const CellField& phi,
                const InterfaceStep<dim>& step);
  /// Hands the targets on to the bodies of the carried phi. `swept` (may be empty): cells that have
  /// changed sides of a surface since `before`; `reach`: farther than any cell's content has come
  /// from [cells]. Collective.
  void inherit(const SolidCells<dim>& before, const SolidCells<dim>& solids, const CellField& phi,
               const std::vector<char>& swept, int reach);
  /// Takes what a sink has left into the targets. Collective.
  void remove(const SolidCells<dim>& solids, const CellField& phi);
  /// Takes what a source has made of `before` into the targets. Collective.
  void create(const SolidCells<dim>& solids, const CellField& before, const CellField& phi);
  /// Takes a volume [m^dim] for a drop at each of these owned cells off the body nearest to it, or,
  /// where none is within a few cells, off all in the same closed space. Returns the parts of them
  /// that there were. Collective.
  std::vector<double> take_drops(const SolidCells<dim>& solids, const CellField& phi,
                                 const std::vector<int>& cells, double volume);
  /// Gives the volumes of drops to the bodies that these owned cells belong to. Collective.
  void give_drops(const std::vector<int>& cells, const std::vector<double>& volumes);
  /// Volume that is lost for good, on this rank. Collective.
  void lose(double volume) { targets_.lost += sum_all(domain_.grid.comm(), volume); }
  /// Shifts phi until bodies have their targets, over at most `largest_shift` max(1, cfl) cells.
  /// `phi`, known up to `cut_off`, on the halo of width 1, which is set on return. `settle()` sets
  /// its ghosts, and it goes on into solids then, as it must before all calls: boxes that solids
  /// cut are measured with it. Returns what it has done, empty: nothing. Collective.
  VolumeShift correct(const SolidCells<dim>& solids, double cfl, double cut_off,
                      const std::function<void()>& settle, CellField& phi);

  LiquidLedger state() const;
  /// What of the measured bodies is in some cells (1), and which part of their targets. Collective.
  WatchedLiquid in_cells(const CellField& phi, const std::vector<char>& cells) const;
  const CellGroups& groups() const { return groups_; }
  const VolumeTargets& targets() const { return targets_; }
  /// Of a restart: groups are found anew. Collective.
  void restore(const SolidCells<dim>& solids, const CellField& phi, const VolumeTargets& targets);

 private:
  CellGroups find(const SolidCells<dim>& solids, const CellField& phi) const;
  int body_at(const SolidCells<dim>& solids, const CellField& phi, int cell) const;
  /// `inherit` where the list of boxes is still good.
  void regroup(const SolidCells<dim>& before, const SolidCells<dim>& solids, const CellField& phi,
               const std::vector<char>& swept, int reach);
  /// Where the vanished bodies were; of those that surfaces passed over, what was around.
  std::vector<int> places_of(const std::vector<char>& vanished, const SolidCells<dim>& before,
                             const CellField& phi, const std::vector<char>& swept) const;
  /// `places`: old bodies that have vanished.
  void give_to_nearest(const SolidCells<dim>& solids, const CellField& phi,
                       const CellGroups& groups, const std::vector<int>& places,
                       std::vector<char> homeless, std::vector<double>& target);
  /// The targets of those that have no heir near go to all bodies in the same closed space.
  void share_out(const SolidCells<dim>& solids, const CellGroups& groups,
                 const std::vector<int>& places, const std::vector<char>& homeless,
                 std::vector<double>& target);
  /// The group that each body is in: a closed space, or what it was before.
  std::vector<int> places_among(const CellGroups& spaces, const CellGroups& bodies) const;
  std::vector<double> wanted_shifts(const GroupVolumes& now) const;
  std::vector<double> limited_shifts(const SolidCells<dim>& solids,
                                     const std::vector<double>& left) const;

  const MacDomain<dim>& domain_;
  VolumeParameters parameters_;
  LiquidVolume<dim> measure_;
  CellGroups groups_;
  VolumeTargets targets_;
  GroupVolumes volumes_;
};

}  // namespace lockstep
