#include "coupling/coupled_system.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "coupling/impossible_flow.hpp"
#include "coupling/null_space.hpp"
#include "coupling/solid_totals.hpp"
#include "interfaces/coupling_sides.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/matrix_sum.hpp"
#include "linear/null_space.hpp"

namespace lockstep {

template <int dim>
CoupledSystem<dim>::CoupledSystem(FluidDiscretization<dim>& fluid, SolidSystem<dim>& solids,
                                  Coupling<dim>& coupling)
    : fluid_(fluid), solids_(solids), coupling_(coupling) {
  for (int m = 0; m < solids.n_models(); ++m) {
    solid_depends_on_dt_ = solid_depends_on_dt_ || !solids.model(m).implicit_force(1).is_null();
  }
  for (const SolidDescription& solid : solids.solids())
    has_soft_bodies_ = has_soft_bodies_ || solid.is_soft_body();
}

template <int dim>
void CoupledSystem<dim>::freeze(const std::shared_ptr<const SurfaceSnapshot<dim>>& surface) {
  surface_ = surface;
  fluid_.set_geometry(surface, coupling_);
  coupling_.assemble(fluid_, solids_, *surface);
  coupling_transposed_ = coupling_.coupling_transposed();
  if (!coupling_transposed_.is_null())
    coupling_transposed_ = solids_.reduction().reduce_rows(coupling_transposed_);
  const NullSpaces null_spaces =
      find_null_spaces(fluid_.regions(), fluid_.pressure_map(), coupling_transposed_);

  held_stiffness_ = Teuchos::null;
  locked_directions_.clear();
  ++blocks_.geometry_version;
  ++blocks_.solids.version;
  blocks_.set_blocks(fluid_.pressure_block());
  blocks_.solids.blocks = solids_.blocks();
  blocks_.near_null_space = near_null_space(solids_, coupling_.added_mass());
  blocks_.null_space = null_spaces.coupled;
  blocks_.pressure_null_space = null_spaces.pressure;

  pressure_only_ = blocks_;
  pressure_only_.null_space = null_spaces.pressure;
}

namespace {
/// The sum of two matrices of the stack, either of which may be null.
RCP<const CrsMatrix> sum_of_both(const RCP<const CrsMatrix>& one,
                                 const RCP<const CrsMatrix>& other) {
  if (one.is_null() || other.is_null())
    return one.is_null() ? other : one;
  return sum_of({{one}, {other}}, one->getRowMap());
}
}  // namespace

template <int dim>
void CoupledSystem<dim>::hold(const RCP<const CrsMatrix>& stiffness) {
  is_held_anew_ = is_held_anew_ || !stiffness.is_null() || !held_stiffness_.is_null();
  held_stiffness_ = stiffness;
}

template <int dim>
const BlockSystem& CoupledSystem<dim>::blocks(double dt, bool with_solid) {
  if (!with_solid || !solids_.has_unknowns())
    return pressure_only_;
  const unsigned linearisation = solids_.linearisation_number();
  const bool is_present = dt == block_dt_ && linearisation == block_linearisation_;
  if (!blocks_.has_solid() || (solid_depends_on_dt_ && !is_present) || is_held_anew_) {
    blocks_.set_blocks(
        blocks_.pressure_block(), coupling_transposed_,
        solids_.solid_block(sum_of_both(coupling_.added_mass(), held_stiffness_), dt));
    ++blocks_.solids.version;
    is_held_anew_ = false;
    block_dt_ = dt;
    block_linearisation_ = linearisation;
  }
  return blocks_;
}

template <int dim>
RCP<Vector> CoupledSystem<dim>::lumped_momentum(const Vector& momentum) const {
  const auto rhs = rcp(new Vector(momentum, Teuchos::Copy));
  coupling_.add_lumped_momentum(fluid_.coupled_velocity(), *rhs);
  return rhs;
}

template <int dim>
void CoupledSystem<dim>::subtract_given(double dt, const Reduction& constraints,
                                        Vector& row) const {
  if (!constraints.offset().is_null())
    apply(*solids_.full_block(sum_of_both(coupling_.added_mass(), held_stiffness_), dt),
          *constraints.offset(), row, -1, 1);
}

/// Row 1 of the right-hand side, incompatible parts included.
template <int dim>
RCP<Vector> CoupledSystem<dim>::pressure_row(const Reduction& constraints) const {
  const RCP<Vector> row = make_vector(fluid_.pressure_map());
  fluid_.divergence(*row);
  coupling_.add_prescribed_divergence(*row);
  if (!constraints.offset().is_null())
    coupling_.coupling_transposed()->apply(*constraints.offset(), *row, Teuchos::TRANS, 1, 1);
  return row;
}

template <int dim>
BlockVector CoupledSystem<dim>::right_hand_side(const Vector& momentum, double dt,
                                                const Reduction& constraints,
                                                double& incompatibility) const {
  BlockVector rhs;
  rhs.pressure = pressure_row(constraints);
  const bool with_solid = solids_.has_unknowns();
  incompatibility = relative_part_removed(
      with_solid ? blocks_.null_space : pressure_only_.null_space, *rhs.pressure);
  if (with_solid) {
    rhs.solid = lumped_momentum(momentum);
    subtract_given(dt, constraints, *rhs.solid);
    constraints.restrict(*rhs.solid);
  }
  return rhs;
}

namespace {

/// Returns the flux that given dofs drive into the pressure unknowns.
PrescribedFlux flux_of_given(const std::string& name, const CrsMatrix& coupling_transposed,
                             const Vector& velocity) {
  PrescribedFlux flux{name, {}};
  const auto speed = velocity.getData();
  for_each_entry(coupling_transposed, [&](int row, GlobalIndex unknown, double area) {
    if (speed[row] != 0)
      flux.into.emplace_back(unknown, area * speed[row]);
  });
  return flux;
}

}  // namespace

/// Adds the fluxes of given dofs: one for each motor and for each prescribed solid with joints, and
/// one for all other given dofs.
template <int dim>
void CoupledSystem<dim>::add_given_fluxes(const Reduction& constraints,
                                          std::vector<PrescribedFlux>& fluxes) const {
  const CrsMatrix& transposed = *coupling_.coupling_transposed();
  Vector rest(*constraints.offset(), Teuchos::Copy);
  if (const auto* joints = std::as_const(solids_).joints()) {
    for (const auto& [name, dofs] : joints->given_motions()) {
      const RCP<Vector> own = make_vector(solids_.map());
      for (const GlobalIndex dof : dofs) {
        const int row = solids_.map()->getLocalElement(dof);
        if (row >= 0)
          own->replaceLocalValue(row, constraints.offset()->getData()[row]);
      }
      const RCP<const Vector> moved = constraints.with_velocity(own).offset();
      if (moved.is_null())
        continue;
      fluxes.push_back(flux_of_given(name, transposed, *moved));
      rest.update(-1, *moved, 1);
    }
  }
  constexpr double round_off = 1e-12;
  if (rest.normInf() > round_off * constraints.offset()->normInf())
    fluxes.push_back(flux_of_given("what pins move of soft solids", transposed, rest));
}

namespace {
template <int dim>
constexpr GlobalIndex smallest_region = dim == 2 ? 9 : 27;  // three cells across
template <int dim>
constexpr const char* rate_unit = dim == 2 ? "m^2/s" : "m^3/s";
}  // namespace

template <int dim>
std::string CoupledSystem<dim>::impossible_flow(double time, const Reduction& constraints,
                                                double negligible) const {
  const bool with_solid = solids_.has_unknowns();
  const auto& null_space = with_solid ? blocks_.null_space : pressure_only_.null_space;
  if (null_space.empty())
    return "";
  PrescribedFluxes fluxes;
  fluxes.sides = fluid_.side_fluxes(time);
  if (const auto* pushed = coupling_.audit())
    fluxes.solids = pushed->solid_fluxes(solids_);
  if (with_solid && !constraints.offset().is_null())
    add_given_fluxes(constraints, fluxes.solids);
  return lockstep::impossible_flow(null_space, fluxes, smallest_region<dim>, negligible,
                                   rate_unit<dim>);
}

template <int dim>
std::string CoupledSystem<dim>::squeezing_flow(double time, double negligible) const {
  if (!solids_.has_unknowns() || !locks_solids() || !has_soft_bodies_)
    return "";
  const PrescribedFluxes fluxes{fluid_.side_fluxes(time), {}};
  if (fluxes.sides.empty())
    return "";
  const NullSpace closed =
      fluid_that_squeezes_solids(blocks_.pressure_null_space, *coupling_transposed_, solids_,
                                 *surface_, fluid_.bounds(), fluid_.smallest_length());
  const std::string sentence =
      lockstep::impossible_flow(closed, fluxes, smallest_region<dim>, negligible, rate_unit<dim>);
  return sentence.empty() ? "" : sentence + " Soft bodies in it could only be squeezed.";
}

template <int dim>
const std::vector<RCP<const Vector>>& CoupledSystem<dim>::locked_directions() const {
  if (locks_solids() && locked_directions_.empty())
    locked_directions_ = pushes_of(blocks_.pressure_null_space, *coupling_transposed_);
  return locked_directions_;
}

/// Row 1, A p - B P y = r, along a null vector n of A: -n.B P y = n.r.
template <int dim>
std::vector<double> CoupledSystem<dim>::locked_rates(const Reduction& constraints) const {
  if (!locks_solids())
    return {};
  std::vector<double> rates = components(blocks_.pressure_null_space, *pressure_row(constraints));
  for (double& rate : rates)
    rate = -rate;
  return rates;
}

template <int dim>
RCP<Vector> CoupledSystem<dim>::reactions(double dt, const Reduction& constraints,
                                          const Vector& momentum,
                                          const BlockVector& solution) const {
  if (constraints.is_identity())
    return make_vector(solids_.map());
  const RCP<Vector> reactions = lumped_momentum(momentum);
  apply(*solids_.full_block(coupling_.added_mass(), dt), *solution.solid, *reactions, 1, -1);
  coupling_.coupling_transposed()->apply(*solution.pressure, *reactions, Teuchos::NO_TRANS, 1, 1);
  constraints.keep_reactions(*reactions);
  return reactions;
}

template <int dim>
Momentum<dim> CoupledSystem<dim>::lumped_fluid_momentum(
    const std::vector<double>& coupled_velocity) const {
  const auto& volumes = fluid_.coupled_volumes();
  Momentum<dim> momentum;
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    momentum.add(volumes[f].center, volumes[f].direction,
                 coupling_.fluid_mass()[f] * coupled_velocity[f]);
  }
  return sum_over_ranks<dim>(momentum, solids_.comm());
}

template <int dim>
double CoupledSystem<dim>::lumped_fluid_energy(const std::vector<double>& coupled_velocity) const {
  double energy = 0;
  for (std::size_t f = 0; f < coupled_velocity.size(); ++f) {
    energy += 0.5 * coupling_.fluid_mass()[f] * coupled_velocity[f] * coupled_velocity[f];
  }
  return sum_all(solids_.comm(), energy);
}

template class CoupledSystem<2>;
template class CoupledSystem<3>;

}  // namespace lockstep
