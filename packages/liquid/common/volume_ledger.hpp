#pragma once
#include <vector>

#include "liquid/common/interface_model.hpp"
#include "liquid/common/liquid_volume.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

enum class VolumeCorrection {
  component,  ///< each liquid component keeps its own volume
  global,     ///< all of them together
  none
};

/// Parameters of volume conservation.
struct VolumeParameters {
  VolumeCorrection correction = VolumeCorrection::component;
  /// Most that the surface shifts in a step that carries it over no more than a cell; in longer
  /// steps as many times as much [cells]. Chosen small beside a cell, not varied by a page.
  static constexpr double largest_shift = 0.2;
};

/// Declares "Volume Correction".
void declare_volume_correction(ParameterList& list);
VolumeParameters read_volume_correction(const ParameterList& list);

/// State that the ledger keeps from step to step.
struct VolumeTargets {
  std::vector<double> of_group;  ///< target volume of each liquid component [m^dim]
  double loose = 0;  ///< liquid that is beside no liquid cell, as in slots of solids [m^dim]
  double lost = 0, shift = 0;  ///< [m^dim]
};

/// Decrease of phi in owned cells on and beside liquid components [m]; empty: nowhere.
using VolumeShift = CellField;

/// Conserves the volume of each liquid component. The target of a component changes by known fluxes
/// only; where components merge the targets add up, where one breaks up its target is shared in
/// proportion to the volumes.
template <int dim>
class VolumeLedger {
 public:
  VolumeLedger(const MacDomain<dim>& domain, const VolumeParameters& parameters);

  /// Takes the present volumes as targets. Collective.
  void begin(const SolidCells<dim>& solids, const CellField& phi);
  /// Subtracts the outflow through the sides of the domain in a step; through open sides no liquid
  /// comes in. Called before phi is advected. A component that flows out where its surface meets an
  /// open side has an open balance: of a film of two cells its outflow is known to a tenth, and
  /// what is wrong in each step would drain the liquid upstream, or fill it. Collective.
  void flow_out(const SolidCells<dim>& solids, const CellField& phi,
                const InterfaceStep<dim>& step);
  /// Hands the targets on to the components of the advected phi; of those with an open balance the
  /// volume becomes the target. `swept` (may be empty): cells that
  /// have changed sides of a surface since `before`; `reach`: more than the displacement of any
  /// cell's content [cells]. Collective.
  void inherit(const SolidCells<dim>& before, const SolidCells<dim>& solids, const CellField& phi,
               const std::vector<char>& swept, int reach);
  /// Takes the change by a sink into the targets. Collective.
  void remove(const SolidCells<dim>& solids, const CellField& phi);
  /// Takes the change by a source since `before` into the targets. Collective.
  void create(const SolidCells<dim>& solids, const CellField& before, const CellField& phi);
  /// Takes a volume [m^dim] for a drop at each of these owned cells from the nearest component, or,
  /// where none is within a few cells, from all in the same closed space. Returns the parts of
  /// these volumes that were available. Collective.
  std::vector<double> take_drops(const SolidCells<dim>& solids, const CellField& phi,
                                 const std::vector<int>& cells, double volume);
  /// Gives the volumes of drops to the components that these owned cells belong to. Collective.
  void give_drops(const std::vector<int>& cells, const std::vector<double>& volumes);
  /// Books a volume of this rank as lost for good. Collective.
  void lose(double volume) { targets_.lost += sum_all(domain_.grid.comm(), volume); }
  /// Shifts phi until liquid components have their target volumes, by at most `largest_shift`
  /// max(1, cfl) cells. `phi`, known up to `cut_off`, on the halo of width 1, which is set on
  /// return. `settle()` sets its ghosts and extrapolates it into solids, as is needed before all
  /// calls: boxes that solids cut are measured with it. Returns the shift, empty: none. Collective.
  VolumeShift correct(const SolidCells<dim>& solids, double cfl, double cut_off,
                      const std::function<void()>& settle, CellField& phi);

  LiquidLedger state() const;
  /// Measures the part of the liquid components in some cells (1) and that part of their targets.
  /// Collective.
  WatchedLiquid in_cells(const CellField& phi, const std::vector<char>& cells) const;
  const CellGroups& groups() const { return groups_; }
  const VolumeTargets& targets() const { return targets_; }
  /// Restores the targets at a restart; groups are found anew. Collective.
  void restore(const SolidCells<dim>& solids, const CellField& phi, const VolumeTargets& targets);

 private:
  CellGroups find(const SolidCells<dim>& solids, const CellField& phi) const;
  /// Gives a volume without a component in its closed space, as that of water between bodies, to
  /// all components by their volumes, and takes from them what has come to be loose, so that the
  /// sum of all targets stays. With shells, through which nothing may go, it is lost.
  void share_unassigned(const SolidCells<dim>& solids, double unassigned);
  /// `inherit` where the list of boxes is still good.
  void regroup(const SolidCells<dim>& before, const SolidCells<dim>& solids, const CellField& phi,
               const std::vector<char>& swept, int reach);
  /// `places`: old bodies that have vanished. Returns what `share_out` does.
  double give_to_nearest(const SolidCells<dim>& solids, const CellField& phi,
                         const CellGroups& groups, const std::vector<int>& places,
                         std::vector<char> unassigned, std::vector<double>& target);
  /// Gives the targets of vanished components without another one near to all components in the
  /// same closed space. Returns the rest that finds none [m^dim].
  double share_out(const SolidCells<dim>& solids, const CellGroups& groups,
                   const std::vector<int>& places, const std::vector<char>& unassigned,
                   std::vector<double>& target);
  std::vector<double> limited_shifts(const SolidCells<dim>& solids,
                                     const std::vector<double>& left) const;

  const MacDomain<dim>& domain_;
  VolumeParameters parameters_;
  LiquidVolume<dim> measure_;
  CellGroups groups_;
  VolumeTargets targets_;
  GroupVolumes volumes_;
  /// Components with an open balance in this step, more than 0: their targets become the volumes
  /// that `inherit` finds. Empty: none.
  std::vector<double> is_open_;
};

/// Returns the group that each component is in: a closed space, or an earlier component.
/// Collective.
template <int dim>
std::vector<int> places_among(const MacDomain<dim>& domain, const CellGroups& spaces,
                              const CellGroups& bodies);

}  // namespace lockstep
