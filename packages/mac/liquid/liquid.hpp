#pragma once
#include <memory>
#include <optional>

#include "interfaces/liquid.hpp"
#include "mac/liquid/free_surface.hpp"
#include "mac/liquid/gas_pockets.hpp"
#include "mac/liquid/interface_model.hpp"
#include "mac/liquid/leak_audit.hpp"
#include "mac/liquid/liquid_parameters.hpp"
#include "mac/liquid/velocity_extension.hpp"
#include "mac/pressure/forces.hpp"
#include "mac/transport/sample_lattice.hpp"

namespace lockstep {

/// The liquid of a fluid that has a free surface: its interface, and what a step does with it.
template <int dim>
class Liquid {
 public:
  using Surface = std::shared_ptr<const SurfaceSnapshot<dim>>;

  /// Validated list "Fluid" with a list "Free Surface". `domain` must outlive this. Collective.
  Liquid(const ParameterList& fluid, const ForceParameters<dim>& forces,
         const InterfaceRegistry<dim>& interfaces, const MacDomain<dim>& domain);

  /// Before all else on the present tiles. The first call fills the liquid in, outside of the
  /// solids. Collective.
  void begin(const Surface& surface);
  /// At the present time; valid while this is.
  FreeSurface<dim> surface();
  /// Carries u_ADV and u^n on into the void, marks those faces in `geometry`, and moves the
  /// interface. Halos must be valid, and are so afterwards. Collective.
  void advance(const InterfaceStep<dim>& step, MacGeometry<dim>& geometry,
               FaceField<dim>& advection_velocity, FaceField<dim>& velocity);

  double tension() const { return parameters_.tension; }  ///< of the surface [N/m]
  bool tension_is_implicit() const {
    return parameters_.tension > 0 && parameters_.tension_is_implicit;
  }
  const std::vector<SignedDistance<dim>>& sinks() const { return sinks_; }
  /// All but the interface's.
  std::vector<StoredField> fields();
  /// The interface's; the fields are set. Collective.
  void load(const CheckpointReader& checkpoint);
  /// What was found out about the liquid on other tiles, or of another instant. Local.
  void forget();
  /// No liquid is given: sources are to bring it.
  bool starts_empty() const { return starts_empty_; }
  GasPockets<dim>* gas() { return gas_.get(); }  ///< null: none is trapped
  const GasPockets<dim>* gas() const { return gas_.get(); }
  Drops<dim>* drops() const { return interface_->drops(); }  ///< null: there are never any
  InterfaceModel<dim>& interface() { return *interface_; }
  const InterfaceModel<dim>& interface() const { return *interface_; }
  /// Linear between the centres of cells; near cells that this rank owns. After `begin`. Local.
  double distance(const Point<dim>& x) const;
  LiquidReport report() const;
  std::vector<std::string> watch_names() const;
  /// Takes back what `advance` does.

 private:
  const MacDomain<dim>& domain_;
  FreeSurfaceParameters parameters_;
  double acceleration_ = 0;  ///< by gravity and body force [m/s^2]
  bool starts_empty_ = false;
  CellField lead_;  ///< by how much the pressure's phi is ahead of the interface's [m]
  std::optional<SampleLattice<dim>> lattice_;  ///< of the tiles since the last `begin`
  std::vector<SignedDistance<dim>> sinks_;
  std::vector<Point<dim>> dry_points_;
  SignedDistance<dim> initial_distance_;  ///< empty once the liquid is filled in
  std::unique_ptr<InterfaceModel<dim>> interface_;
  std::unique_ptr<LeakAudit<dim>> audit_;  ///< null: nothing is watched
  std::unique_ptr<GasPockets<dim>> gas_;
};

}  // namespace lockstep
