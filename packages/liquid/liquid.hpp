#pragma once
#include <memory>
#include <optional>

#include "interfaces/liquid.hpp"
#include "liquid/common/interface_model.hpp"
#include "liquid/gas/gas_bubbles.hpp"
#include "liquid/liquid_parameters.hpp"
#include "liquid/surface/free_surface.hpp"
#include "liquid/surface/velocity_extension.hpp"
#include "liquid/watch/watched_places.hpp"
#include "transport/sample_lattice.hpp"

namespace lockstep {

/// The liquid of a fluid that has a free surface: its interface and the stages of its step.
template <int dim>
class Liquid {
 public:
  using Surface = std::shared_ptr<const SurfaceSnapshot<dim>>;

  /// Validated list "Fluid" with a list "Free Surface". `acceleration`: by gravity and any body
  /// force [m/s^2]. `domain` must outlive this. Collective.
  Liquid(const ParameterList& fluid, const Point<dim>& gravity, const Point<dim>& acceleration,
         const InterfaceRegistry<dim>& interfaces, const MacDomain<dim>& domain);

  /// Prepares the liquid, before all else on the present tiles. The first call fills the liquid
  /// in, outside of the solids. Collective.
  void begin(const Surface& surface);
  /// Returns the free surface at the present time; valid while this object is.
  FreeSurface<dim> surface();
  /// Extends u_ADV and u^n into air without mass, marks those faces in `geometry`, and moves the
  /// interface.
  /// Halos must be valid, and are so afterwards. Collective.
  void advance(const InterfaceStep<dim>& step, MacGeometry<dim>& geometry,
               FaceField<dim>& advection_velocity, FaceField<dim>& velocity);

  bool has_gas() const { return gas_density_ > 0; }  ///< above the surface is a fluid, too
  double gas_density() const { return gas_density_; }
  double tension() const { return parameters_.tension; }  ///< surface tension [N/m]
  bool tension_is_implicit() const {
    return parameters_.tension > 0 && parameters_.tension_is_implicit;
  }
  const std::vector<SignedDistance<dim>>& sinks() const { return sinks_; }
  /// All but the interface's.
  std::vector<StoredField> fields();
  /// The interface's; the fields are set. Collective.
  void load(const CheckpointReader& checkpoint) { interface_->load(checkpoint); }
  /// True if no liquid is given: sources are to bring it.
  bool starts_empty() const { return starts_empty_; }
  GasBubbles<dim>* gas() { return gas_.get(); }  ///< null: none is trapped
  const GasBubbles<dim>* gas() const { return gas_.get(); }
  Drops<dim>* drops() const { return interface_->drops(); }  ///< null: there are never any
  InterfaceModel<dim>& interface() { return *interface_; }
  const InterfaceModel<dim>& interface() const { return *interface_; }
  /// phi at a point near cells that this rank owns, linear between the centres of cells [m]. Valid
  /// after `begin`. Local.
  double distance(const Point<dim>& x) const;
  LiquidReport report() const;
  std::vector<std::string> watch_names() const;

 private:
  /// Extends velocities from the liquid into what `state` marks as air. Collective.
  void extend(const InterfaceStep<dim>& step, const std::vector<char>& near, GridState<dim>& state,
              FaceField<dim>& advection_velocity, FaceField<dim>& velocity) const;

  const MacDomain<dim>& domain_;
  FreeSurfaceParameters parameters_;
  /// Restoring acceleration of waves of number 1/h: by gravity, body force and tension [m/s^2].
  double short_wave_acceleration_ = 0;
  double gas_density_ = 0;  ///< density of the fluid above [kg/m^dim]; 0: air without mass
  bool starts_empty_ = false;
  CellField filter_shift_;      ///< interface filter: distance of the pressure's phi ahead of the
                                ///< interface's [m]
  CellField leading_distance_;  ///< phi of the pressure, with tension [m]
  std::optional<SampleLattice<dim>> lattice_;  ///< lattice of the tiles since the last `begin`
  std::vector<SignedDistance<dim>> sinks_;
  std::vector<Point<dim>> dry_points_;
  SignedDistance<dim> initial_distance_;  ///< empty once the liquid is filled in
  std::unique_ptr<InterfaceModel<dim>> interface_;
  std::unique_ptr<WatchedPlaces<dim>> watched_;  ///< null: nothing is watched
  std::unique_ptr<GasBubbles<dim>> gas_;
};

}  // namespace lockstep
