#include "stepping/step/implicit_motion.hpp"

#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "coupling/nonlinear_bodies.hpp"
#include "coupling/solid_totals.hpp"
#include "solve/soft/exact_inverse.hpp"

namespace lockstep {

namespace {
/// Largest excess of the potential over the model, relative to the change of the model [1]: in a
/// step that ends the search, and in one that goes on.
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

/// Phi along a line from the velocity about which forces are linearised, solid by solid.
template <int dim>
class Descent {
 public:
  /// `gradient`: of the model at `from`.
  Descent(const SolidSystem<dim>& solids, double dt, const LinearOperator& block,
          const Vector& from, const Vector& gradient, const Vector& to)
      : solids_(solids), dt_(dt), from_(from, Teuchos::Copy), change_(to, Teuchos::Copy) {
    change_.update(-1, from, 1);
    const NonlinearBodies<dim> bodies(solids);
    // A translation strains nothing, and how large it is depends on the frame.
    const RCP<const Vector> strains = bodies.without_translations(change_);
    slopes_ = bodies.dot(gradient, *strains);
    Vector product(solids.map());
    apply(block, *strains, product);
    curvatures_ = bodies.dot(product, *strains);
    apply(block, change_, product);
    whole_slopes_ = bodies.dot(gradient, change_);
    whole_curvatures_ = bodies.dot(product, change_);
    start_ = nonlinear_energies(solids, dt, from);
  }

  RCP<Vector> at(double part) const {
    const auto velocity = rcp(new Vector(from_, Teuchos::Copy));
    velocity->update(part, change_, 1);
    return velocity;
  }
  /// Excess of the potential over the model, relative to the change of the model [1]: that of the
  /// worst solid.
  double excess(double part) const {
    const std::vector<ComputedEnergy> end = nonlinear_energies(solids_, dt_, *at(part));
    constexpr double unseen = 1e-12;  // strain by round-off in free rigid motion, relative [1]
    const auto change = [part](double slope, double curvature) {
      return std::abs(part * slope + 0.5 * part * part * curvature);
    };
    double worst = 0;
    for (std::size_t s = 0; s < end.size(); ++s) {
      const double whole = change(whole_slopes_[s], whole_curvatures_[s]);
      const double above =
          end[s].value - start_[s].value - end[s].round_off - start_[s].round_off - unseen * whole;
      if (std::isnan(above))
        return above;
      worst = std::max(worst, above / std::max(change(slopes_[s], curvatures_[s]), 1e-300));
    }
    return worst;
  }

 private:
  const SolidSystem<dim>& solids_;
  double dt_;
  Vector from_;
  Vector change_;
  std::vector<double> slopes_, curvatures_;  ///< model's derivatives without translations [J]
  std::vector<double> whole_slopes_, whole_curvatures_;
  std::vector<ComputedEnergy> start_;
};

template <int dim>
RCP<Vector> linearisation_of(const SolidSystem<dim>& solids) {
  const RCP<const Vector> known = linearisation(solids);
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
ContactResponse joint_response(const SolidSystem<dim>& solids, double dt) {
  if (!solids.joints() || !solids.joints()->has_implicit_forces())
    return {};
  return [&solids, dt, inverse = RCP<const LinearOperator>()]() mutable {
    if (inverse.is_null())
      inverse = exact_inverse(solids.solid_block(Teuchos::null, dt), "implicit forces of joints");
    return inverse;
  };
}

template <int dim>
SettledMotion<dim> settle_motion(SolidSystem<dim>& solids, ContactModel<dim>* contact,
                                 const StepContext<dim>& context, const MotionSearch& search,
                                 Vector& momentum) {
  const double dt = context.dt;
  const ContactPhase phase =
      context.moves_positions ? ContactPhase::position : ContactPhase::velocity;
  SettledMotion<dim> settled;
  Response<dim> response(solids, dt, search.known_response);
  RCP<const LinearOperator> block = solids.full_block(Teuchos::null, dt);
  RCP<Vector> at = linearisation_of(solids);
  RCP<Vector> goal = rcp(new Vector(search.first, Teuchos::Copy));
  Vector impulse(solids.map());
  apply(*block, search.predicted, impulse);
  for (int k = 1;; ++k) {
    if (contact) {
      settled.contact = contact->resolve(solids, phase, context.step.dt, *goal,
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
    const RCP<const Vector> before = solids.explicit_momentum(context.begin, dt);
    solids.linearise(dt, *at);
    Vector change(*solids.explicit_momentum(context.begin, dt), Teuchos::Copy);
    change.update(-1, *before, 1);
    momentum.update(1, change, 1);
    impulse.update(1, change, 1);
    block = solids.full_block(Teuchos::null, dt);
    response.forget();
    goal = solids.velocity_of(impulse, dt, context.constraints, *response.inverse());
    if (search.adjust)
      search.adjust(*goal);
  }
}

/// `before` is where the model is least, so Phi rises by 1/2 d.C d and what the model does not
/// know. Solid by solid. Closed regions have walls, whose frame is the one that counts.
template <int dim>
void bound_sweep(const SolidSystem<dim>& solids, double dt, const Vector& before,
                 Vector& velocity) {
  // Rise over the energy of the motion in the model [1]. Flesh that turns by a tenth in a step
  // wants 0.02, and what it was refused it took as energy; a stiff ball in steps of a second wants
  // 1e6.
  constexpr double largest = 0.05;
  const RCP<const LinearOperator> block = solids.full_block(Teuchos::null, dt);
  Vector change(velocity, Teuchos::Copy), product(solids.map());
  change.update(-1, before, 1);
  const NonlinearBodies<dim> bodies(solids);
  apply(*block, before, product);
  const std::vector<double> energy = bodies.dot(product, before);
  apply(*block, change, product);
  const std::vector<double> cost = bodies.dot(product, change);
  if (std::all_of(cost.begin(), cost.end(), [](double one) { return one == 0; }))
    return;
  if (!is_settled(solids, dt, before)) {  // nor is the motion itself what it should be
    velocity.update(1, before, 0);
    return;
  }
  const std::vector<ComputedEnergy> start = nonlinear_energies(solids, dt, before);
  std::vector<double> parts(cost.size(), 1);
  for (int k = 0; k <= most_halvings; ++k) {
    Vector changed(change, Teuchos::Copy);
    bodies.scale(parts, changed);
    velocity.update(1, before, 1, changed, 0);
    const std::vector<ComputedEnergy> end = nonlinear_energies(solids, dt, velocity);
    bool all = true;
    for (std::size_t s = 0; s < parts.size(); ++s) {
      const double rise = 0.5 * parts[s] * parts[s] * cost[s] + end[s].value - start[s].value;
      if (rise <= 0.5 * largest * energy[s] + start[s].round_off + end[s].round_off)
        continue;
      all = false;
      parts[s] = k + 1 < most_halvings ? parts[s] / 2 : 0;
    }
    if (all)
      return;
  }
}

namespace {
/// The way from the velocity about which forces are linearised to `velocity`, where the model of
/// Phi is least.
template <int dim>
Descent<dim> way_to(const SolidSystem<dim>& solids, double dt, const Vector& velocity) {
  const RCP<const LinearOperator> block = solids.full_block(Teuchos::null, dt);
  const RCP<Vector> at = linearisation_of(solids);
  Vector gradient(*at, Teuchos::Copy), product(solids.map());
  gradient.update(-1, velocity, 1);
  apply(*block, gradient, product);
  return Descent<dim>(solids, dt, *block, *at, product, velocity);
}
}  // namespace

template <int dim>
bool is_settled(const SolidSystem<dim>& solids, double dt, const Vector& velocity) {
  return way_to(solids, dt, velocity).excess(1) <= good;
}

template <int dim>
RCP<const Vector> tolerable_velocity(const SolidSystem<dim>& solids, double dt,
                                     const Vector& velocity) {
  const Descent<dim> way = way_to(solids, dt, velocity);
  return way.at(tolerable_part(way));
}

template SettledMotion<2> settle_motion<2>(SolidSystem<2>&, ContactModel<2>*, const StepContext<2>&,
                                           const MotionSearch&, Vector&);
template RCP<const LinearOperator> implicit_response(const SolidSystem<2>&, double);
template ContactResponse joint_response(const SolidSystem<2>&, double);
template ContactResponse joint_response(const SolidSystem<3>&, double);
template SettledMotion<3> settle_motion<3>(SolidSystem<3>&, ContactModel<3>*, const StepContext<3>&,
                                           const MotionSearch&, Vector&);
template RCP<const LinearOperator> implicit_response(const SolidSystem<3>&, double);
template void bound_sweep<2>(const SolidSystem<2>&, double, const Vector&, Vector&);
template void bound_sweep<3>(const SolidSystem<3>&, double, const Vector&, Vector&);
template RCP<const Vector> tolerable_velocity(const SolidSystem<2>&, double, const Vector&);
template RCP<const Vector> tolerable_velocity(const SolidSystem<3>&, double, const Vector&);
template bool is_settled<2>(const SolidSystem<2>&, double, const Vector&);
template bool is_settled<3>(const SolidSystem<3>&, double, const Vector&);

}  // namespace lockstep
