#include "stepping/implicit_motion.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "solve/soft/exact_inverse.hpp"

namespace lockstep {

namespace {
/// Of the change of the model, that the potential may exceed it by: in a step that ends the search,
/// and in one that goes on.
constexpr double good = 0.1, tolerable = 0.5;
constexpr int most_iterations = 40, most_halvings = 40;

/// (M_S - dt D)^-1 with locked rows of the identity, factored when it is asked for.
template <int dim>
class Response {
 public:
  /// `known`: may be null.
  Response(const SolidSystem<dim>& solids, double dt, const RCP<const LinearOperator>& known)
      : solids_(solids), dt_(dt), inverse_(known) {}
  void forget() { inverse_ = Teuchos::null; }
  RCP<const LinearOperator> inverse() {
    if (inverse_.is_null())
      inverse_ = implicit_response(solids_, dt_);
    return inverse_;
  }

 private:
  const SolidSystem<dim>& solids_;
  double dt_;
  RCP<const LinearOperator> inverse_;
};

/// Phi along a line from the velocity about which forces are linearised.
template <int dim>
class Descent {
 public:
  /// `gradient`: of the model at `from`.
  Descent(const SolidSystem<dim>& solids, double dt, const LinearOperator& block,
          const Vector& from, const Vector& gradient, const Vector& to)
      : solids_(solids), dt_(dt), from_(from), change_(to, Teuchos::Copy) {
    change_.update(-1, from, 1);
    slope_ = gradient.dot(change_);
    Vector product(solids.map());
    apply(block, change_, product);
    curvature_ = product.dot(change_);
    start_ = solids.unlinear_energy(dt, from);
  }

  RCP<Vector> at(double part) const {
    const auto velocity = rcp(new Vector(from_, Teuchos::Copy));
    velocity->update(part, change_, 1);
    return velocity;
  }
  /// What the potential exceeds the model by, over the change of the model.
  double excess(double part) const {
    const ComputedEnergy end = solids_.unlinear_energy(dt_, *at(part));
    const double model = std::abs(part * slope_ + 0.5 * part * part * curvature_);
    const double above = end.value - start_.value - end.round_off - start_.round_off;
    return above <= 0 ? 0 : above / std::max(model, 1e-300);
  }

 private:
  const SolidSystem<dim>& solids_;
  double dt_;
  const Vector& from_;
  Vector change_;
  double slope_ = 0, curvature_ = 0;
  ComputedEnergy start_;
};

template <int dim>
RCP<Vector> linearisation_of(const SolidSystem<dim>& solids) {
  const RCP<const Vector> known = solids.linearisation();
  return known.is_null() ? make_vector(solids.map()) : rcp(new Vector(*known, Teuchos::Copy));
}

/// The largest of 1, 1/2, 1/4, ... that lowers Phi enough; zero if none does.
template <int dim>
double tolerable_part(const Descent<dim>& descent) {
  double part = 1;
  for (int k = 0; k < most_halvings; ++k) {
    if (descent.excess(part) <= tolerable)
      return part;
    part /= 2;
  }
  return 0;
}

}  // namespace

template <int dim>
RCP<const LinearOperator> implicit_response(const SolidSystem<dim>& solids, double dt) {
  return exact_inverse(solids.solid_block(Teuchos::null, dt), "implicit forces of solids");
}

template <int dim>
SettledMotion<dim> settle_motion(SolidSystem<dim>& solids, ContactModel<dim>* contact,
                                 const StepContext<dim>& context,
                                 const std::function<void(Vector&)>& adjust,
                                 const Vector& predicted, const Vector& first, Vector& momentum,
                                 const RCP<const LinearOperator>& known_response) {
  const double dt = context.dt;
  const ContactPhase phase =
      context.phase == Phase::S1 ? ContactPhase::position : ContactPhase::velocity;
  SettledMotion<dim> settled;
  Response<dim> response(solids, dt, known_response);
  RCP<const LinearOperator> block = solids.full_block(Teuchos::null, dt);
  RCP<Vector> at = linearisation_of(solids);
  RCP<Vector> goal = rcp(new Vector(first, Teuchos::Copy));
  Vector impulse(solids.map());
  apply(*block, predicted, impulse);
  for (int k = 1;; ++k) {
    if (contact) {
      settled.contact = contact->resolve(solids, phase, context.step_dt, *goal,
                                         [&response] { return response.inverse(); });
    }
    Vector gradient(impulse, Teuchos::Copy);
    apply(*block, *at, gradient, 1, -1);
    const Descent<dim> descent(solids, dt, *block, *at, gradient, *goal);
    if (descent.excess(1) <= good) {
      settled.velocity = goal;
      return settled;
    }
    at = descent.at(tolerable_part(descent));
    if (k == most_iterations) {
      settled.velocity = at;
      settled.is_settled = false;
      return settled;
    }
    const RCP<const Vector> before = solids.explicit_momentum(context.time, dt);
    solids.linearise(dt, *at);
    settled.linearised_anew = true;
    Vector change(*solids.explicit_momentum(context.time, dt), Teuchos::Copy);
    change.update(-1, *before, 1);
    momentum.update(1, change, 1);
    impulse.update(1, change, 1);
    block = solids.full_block(Teuchos::null, dt);
    response.forget();
    goal = solids.velocity_of(impulse, dt, context.constraints, *response.inverse());
    if (adjust)
      adjust(*goal);
  }
}

/// `before` is where the model is least, so Phi rises by 1/2 d.C d and what the model does not
/// know.
template <int dim>
void bound_sweep(const SolidSystem<dim>& solids, double dt, const Vector& before,
                 Vector& velocity) {
  constexpr double largest = 0.01;  // of the energy that the motion has in the model
  const RCP<const LinearOperator> block = solids.full_block(Teuchos::null, dt);
  Vector change(velocity, Teuchos::Copy), product(solids.map());
  change.update(-1, before, 1);
  apply(*block, before, product);
  const double allowed = largest * 0.5 * product.dot(before);
  apply(*block, change, product);
  const double cost = 0.5 * product.dot(change);
  if (cost == 0)
    return;
  if (!is_settled(solids, dt, before)) {  // nor is the motion itself what it should be
    velocity.update(1, before, 0);
    return;
  }
  const ComputedEnergy start = solids.unlinear_energy(dt, before);
  double part = 1;
  for (int k = 0; k < most_halvings; ++k) {
    velocity.update(1, before, part, change, 0);
    const ComputedEnergy end = solids.unlinear_energy(dt, velocity);
    const double rise = part * part * cost + end.value - start.value;
    if (rise <= allowed + start.round_off + end.round_off)
      return;
    part /= 2;
  }
  velocity.update(1, before, 0);
}

template <int dim>
bool is_settled(const SolidSystem<dim>& solids, double dt, const Vector& velocity) {
  const RCP<const LinearOperator> block = solids.full_block(Teuchos::null, dt);
  const RCP<Vector> at = linearisation_of(solids);
  Vector gradient(*at, Teuchos::Copy), product(solids.map());
  gradient.update(-1, velocity, 1);
  apply(*block, gradient, product);
  return Descent<dim>(solids, dt, *block, *at, product, velocity).excess(1) <= good;
}

template SettledMotion<2> settle_motion<2>(SolidSystem<2>&, ContactModel<2>*, const StepContext<2>&,
                                           const std::function<void(Vector&)>&, const Vector&,
                                           const Vector&, Vector&,
                                           const RCP<const LinearOperator>&);
template RCP<const LinearOperator> implicit_response(const SolidSystem<2>&, double);
template SettledMotion<3> settle_motion<3>(SolidSystem<3>&, ContactModel<3>*, const StepContext<3>&,
                                           const std::function<void(Vector&)>&, const Vector&,
                                           const Vector&, Vector&,
                                           const RCP<const LinearOperator>&);
template RCP<const LinearOperator> implicit_response(const SolidSystem<3>&, double);
template void bound_sweep<2>(const SolidSystem<2>&, double, const Vector&, Vector&);
template void bound_sweep<3>(const SolidSystem<3>&, double, const Vector&, Vector&);
template bool is_settled<2>(const SolidSystem<2>&, double, const Vector&);
template bool is_settled<3>(const SolidSystem<3>&, double, const Vector&);

}  // namespace lockstep
