#pragma once
#include <memory>
#include <optional>

#include "interfaces/energy.hpp"
#include "interfaces/field_sampler.hpp"
#include "interfaces/fluid_sides.hpp"
#include "interfaces/gas.hpp"
#include "interfaces/liquid.hpp"
#include "interfaces/prescribed_flux.hpp"
#include "interfaces/surface_sampler.hpp"
#include "mac/liquid/gas_faces.hpp"
#include "mac/liquid/liquid.hpp"
#include "mac/moving_tiles.hpp"
#include "mac/pressure/forces.hpp"
#include "mac/pressure/pressure_operator.hpp"
#include "mac/pressure/pressure_system.hpp"
#include "mac/state/stored_fields.hpp"
#include "mac/state/velocity_history.hpp"
#include "mac/transport/ray_halo.hpp"
#include "mac/transport/revalidation.hpp"
#include "mac/transport/scalars.hpp"
#include "mac/transport/transport.hpp"
#include "mac/viscosity/viscosity.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// The numbers of a fluid, read once.
template <int dim>
struct MacParameters {
  double density = 1000;  ///< [kg/m^3]
  ViscosityParameters viscosity;
  ForceParameters<dim> forces;
  AdvectionScheme advection = AdvectionScheme::semi_lagrangian;
  int order_in_time = 1;  ///< of the splitting of advection from all else
};

/// Schema of the "Fluid" list, without "Type"; without interface models it knows no free surface.
template <int dim>
ParameterList mac_parameters(const InterfaceRegistry<dim>* interfaces = nullptr);
template <int dim>
MacParameters<dim> read_mac_parameters(const ParameterList& fluid);

/// A single-phase fluid on a staggered Cartesian grid of tiles. Every cell whose centre is not
/// inside a closed solid is fluid, or void where it is above a free surface. Momentum of free faces
/// counts M = rho V alpha, half of it at open sides. With periodic sides, angular momentum is not
/// conserved: a torque has no common origin there.
///
/// The time of walls and inflows that ramp up is that of the last `add_forces`, time + dt.
template <int dim>
class MacFluid : public FluidDiscretization<dim>,
                 public AuditedFluid<dim>,
                 public BoundedFluid<dim>,
                 public EnergyFluid<dim>,
                 public FieldSampler<dim>,
                 public FluidOutput<dim>,
                 public GasFluid<dim>,
                 public LiquidFluid<dim>,
                 public PressureMemory<dim>,
                 public SideFluxes,
                 public SurfaceSampler<dim>,
                 public ViscousFluid<dim> {
 public:
  using typename FluidDiscretization<dim>::Surface;

  /// Collective. Validated lists "Fluid" and "Domain" of a scene.
  MacFluid(const ParameterList& fluid, const ParameterList& domain, const Communicator& comm,
           const InterfaceRegistry<dim>* interfaces = nullptr);

  std::string name() const override { return "mac"; }
  void save(CheckpointWriter& checkpoint) const override;
  void load(const CheckpointReader& checkpoint) override;

  void divergence(Vector& rhs) const override;
  void project(const Vector& scaled_pressure) override { project(scaled_pressure, {}); }
  void project(const Vector& scaled_pressure, const std::vector<double>& gas_pressure) override;
  std::vector<double> coupled_velocity() const override;
  /// Partly open volumes keep their own velocity.
  void set_coupled_velocity(const std::vector<double>& velocity) override;

  bool begin_step(double time, double dt, const std::function<double()>& solid_speed) override;
  void begin_prediction() override;
  bool begin_advection_velocity(double dt) override;
  ForceImpulse<dim> add_forces(double time, double dt) override;
  /// Implicit surface tension wants the viscous solve, too.
  bool is_viscous() const override {
    return parameters_.viscosity.viscosity > 0 || tension_is_implicit();
  }
  bool wants_present_pressure() const override { return tension_is_implicit(); }
  std::unique_ptr<ViscousSystem<dim>> viscous_system() const override;
  Momentum<dim> accept_viscous(const Vector& solution, const Vector& velocity, double dt) override;
  void advect(double time, double dt, const MovingSurface<dim>& surface) override;
  void revalidate(const MovingSurface<dim>& surface) override;
  void correct_pressure(const Vector& inflow) override;
  void accept() override;

  double smallest_length() const override { return domain_.spacing(); }
  double largest_speed() const override;
  double largest_stable_step() const override;
  bool geometry_changes() const override { return liquid_ != nullptr; }
  bool has_surface() const override { return liquid_ != nullptr; }
  double surface_distance(const Point<dim>& x) const override { return liquid_->distance(x); }
  std::vector<WetBody<dim>> wet_bodies() const override;
  LiquidReport liquid() const override { return liquid_->report(); }
  bool traps_gas() const override { return holds_gas(); }
  bool has_drops() const override { return liquid_ && liquid_->drops(); }
  std::vector<SurfaceImpulse<dim>> impulses_on_solids() const override;
  Momentum<dim> surface_impulse() const override { return surface_impulse_; }
  std::vector<std::string> watch_names() const override { return liquid_->watch_names(); }
  Box<dim> bounds() const override;
  std::array<std::array<bool, 2>, dim> closed_sides() const override;
  Point<dim> wall_velocity(int axis, int end, double time) const override;
  bool is_periodic() const override;
  double density(const Point<dim>&) const override { return parameters_.density; }
  RCP<Vector> last_scaled_pressure() const override;
  Point<dim> gravity() const override { return parameters_.forces.gravity; }
  bool holds_gas() const override { return liquid_ && liquid_->gas(); }
  const std::vector<GasPocket>& gas_pockets() const override { return liquid_->gas()->all(); }
  void add_gas_push(const std::vector<double>& scaled_pressure, Vector& rhs) const override;
  std::vector<double> gas_conductance() const override;
  std::vector<double> gas_rates() const override;
  std::vector<double> gas_answer(const Vector& scaled_pressure) const override;
  Momentum<dim> gas_side_impulse(const std::vector<double>& scaled_pressure) const override;
  Momentum<dim> momentum() const override;
  double kinetic_energy() const override;
  void begin_works() override { stages_ = {prediction_}; }
  void end_work() override { stages_.push_back(prediction_); }
  std::vector<double> works() override;
  Momentum<dim> boundary_pressure_impulse(const Vector& scaled_pressure) const override;
  void add_frame(std::vector<BoxFrame>& boxes) const override;
  std::vector<std::string> surface_names() const override {
    if (has_drops())
      return {"water", "drops"};
    return liquid_ ? std::vector<std::string>{"water"} : std::vector<std::string>();
  }
  /// "water", "drops"; gathered, since frames are few and a surface small.
  void add_surfaces(std::vector<SurfaceFrame>& surfaces) const override;
  /// Multilinear from the samples around a point that have a value, those beyond a thin shell
  /// included.
  std::vector<FluidSample<dim>> sample(const std::vector<Point<dim>>& points) const override;
  /// Of faces, multilinear between them.
  std::vector<FlowSample> flow_across(int axis,
                                      const std::vector<Point<dim>>& points) const override;
  std::vector<double> surface_distances(const std::vector<Point<dim>>& points) const override;
  std::vector<PrescribedFlux> side_fluxes(double time) const override;
  std::vector<std::pair<std::string, std::string>> notes() const override;

  const MacDomain<dim>& domain() const { return domain_; }
  const MacGeometry<dim>& geometry() const { return geometry_; }
  /// u* on stored faces.
  const FaceField<dim>& prediction() const { return prediction_; }
  const Scalars<dim>& scalars() const { return scalars_; }
  /// Sets u* on owned faces that are free to f(face centre). Collective.
  void set_prediction(const std::function<Point<dim>(const Point<dim>&)>& velocity);

 private:
  const FluidGeometry<dim>& freeze(const Surface& surface,
                                   const OpenFractionRule<dim>& rule) override;
  bool moves(int axis, int cell) const {
    const FaceState state = geometry_.state.faces[axis][cell];
    return state == FaceState::free || state == FaceState::coupled;
  }
  void set_prescribed(double time, FaceField<dim>& velocity) const;
  /// What is prescribed jumped in the step that ends now.
  bool jumped() const;
  /// Other tiles: all fields move; what else was made of the grid waits for `freeze`.
  void regrid(const TileOwners& owners);
  void rest_at_rim();
  typename MovingTiles<dim>::Present present(const MacState<dim>& state, double time,
                                             double dt) const;
  /// What the pressure beyond the stored tiles does to the faces there in dt: that of fluid at rest
  /// under this acceleration. Of this rank.
  Momentum<dim> push_at_rim(const Point<dim>& force, double dt);
  /// Tiles for the first surface, before any step.
  void make_room_for(const Surface& surface);
  bool share_work();
  /// Of the liquid; null: its interface cannot live on other tiles.
  MigratingInterface<dim>* migrating_interface();
  void save_tiles(CheckpointWriter& checkpoint) const;
  void load_tiles(const CheckpointReader& checkpoint);
  /// What partly open faces of this rank add to an angular momentum, because their fluid moves
  /// beside their centres; velocity(axis, cell).
  using FaceFunction = std::function<double(int axis, int cell)>;
  AngularVector<dim> moment_of_shifts(const FaceFunction& velocity) const;
  Momentum<dim> push_sources(double time);
  bool tension_is_implicit() const { return liquid_ && liquid_->tension_is_implicit(); }
  Momentum<dim> speed_up_drops();  ///< of this rank
  Momentum<dim> momentum_of_drops() const;
  double energy_of_drops() const;
  void give_back_momentum();  ///< of drops that have fallen into the liquid
  SurfaceFrame frame_of_drops() const;
  void push_surface(double dt);                    ///< by surface tension
  void settle_gas();                               ///< for the frozen geometry
  void bound_pressure(CellField& pressure) const;  ///< of the last step, beside the void
  /// Over the faces of the pockets of gas, the sum of value(face) for each pocket. Collective.
  template <typename Value>
  std::vector<double> sum_of_pockets(const Value& value) const;
  void move_liquid(double time, double dt, const MovingSurface<dim>& surface,
                   FaceField<dim>& advection);

  MacDomain<dim> domain_;
  std::optional<MovingTiles<dim>> moving_tiles_;  ///< none: all tiles exist, always
  TileOwners owners_;                             ///< of the tiles; empty: as at the start
  int steps_since_regrid_ = 2;                    ///< accepted; 2: or more
  int steps_to_sharing_ = 0;                      ///< before work is next compared between ranks
  TileWork compared_work_;                        ///< of this rank's tiles, then
  bool has_room_ = false;                         ///< for the first surface
  bool has_begun_ = false;                        ///< with a geometry: sinks may empty it later
  MacParameters<dim> parameters_;
  Scalars<dim> scalars_;
  RayHalo<dim> ray_halo_;
  KeptSurface<dim> nearby_;
  std::shared_ptr<const LatticeBlocks> lattice_blocks_;
  std::unique_ptr<Liquid<dim>> liquid_;  ///< null: no free surface

  MacGeometry<dim> geometry_;
  std::vector<GasFace> gas_faces_;
  std::unique_ptr<Viscosity<dim>> viscosity_;

  FaceField<dim> velocity_, prediction_;         ///< u^n, u*
  std::vector<FaceField<dim>> stages_;           ///< u* between what acts on it; of `works` only
  mutable std::optional<double> largest_speed_;  ///< of this velocity and geometry, once asked for
  std::optional<VelocityHistory<dim>> history_;  ///< none: first order in time
  CellField scaled_pressure_;                    ///< of the last projection
  CellField accepted_pressure_;                  ///< of the last accepted step
  std::vector<CellState> accepted_cells_;        ///< which cells had one
  double accepted_step_ = 0;                     ///< its dt
  std::vector<StoredField> fields_;              ///< all that are kept from step to step
  InvalidSamples<dim> invalid_;
  double time_ = 0;                ///< of walls and inflows
  Momentum<dim> surface_impulse_;  ///< of surface tension in the last forces and viscous solve
  double last_step_ = 0;           ///< dt of the last forces, for p = p̂ / dt in pictures
};

}  // namespace lockstep
