#include "contact/impulses/coulomb.hpp"

#include <cmath>
#include <limits>

namespace lockstep {

namespace {

template <int dim>
using Tangent = Eigen::Matrix<double, dim - 1, 1>;

/// The contact slips along the unit vector t: its normal impulse is -v_n / d.
template <int dim>
struct Slip {
  double d = 0;
  Tangent<dim> velocity = Tangent<dim>::Zero();  ///< d w_t, which is to point along t
};

template <int dim>
Slip<dim> slip_along(const Tangent<dim>& t, const CoulombContact<dim>& contact,
                     const Point<dim>& v) {
  const auto& w = contact.mobility;
  const double mu = contact.friction;
  Slip<dim> slip;
  slip.d = w(0, 0) - mu * w.row(0).template tail<dim - 1>().dot(t);
  slip.velocity = slip.d * v.template tail<dim - 1>() -
                  v[0] * (w.col(0).template tail<dim - 1>() -
                          mu * w.template bottomRightCorner<dim - 1, dim - 1>() * t);
  return slip;
}

/// True if friction acts against the slip and the contact pushes.
template <int dim>
bool is_valid(const Tangent<dim>& t, const Slip<dim>& slip) {
  return slip.d > 0 && slip.velocity.dot(t) >= 0;
}

template <int dim>
Point<dim> impulse_along(const Tangent<dim>& t, double d, double friction, double v_n) {
  Point<dim> impulse;
  impulse[0] = -v_n / d;
  impulse.template tail<dim - 1>() = -friction * impulse[0] * t;
  return impulse;
}

/// For contacts whose slip is hidden by round-off.
template <int dim>
Point<dim> without_friction(const CoulombContact<dim>& contact, const Point<dim>& v) {
  return -v[0] / contact.mobility(0, 0) * Point<dim>::Unit(0);
}

Point<2> slipping(const CoulombContact<2>& contact, const Point<2>& v, const Point<2>& last) {
  Tangent<2> t(last[1] > 0 || (last[1] == 0 && v[1] < 0) ? -1.0 : 1.0);
  Slip<2> slip = slip_along<2>(t, contact, v);
  if (!is_valid<2>(t, slip)) {
    t = -t;
    slip = slip_along<2>(t, contact, v);
  }
  if (!is_valid<2>(t, slip))
    return without_friction<2>(contact, v);
  return impulse_along<2>(t, slip.d, contact.friction, v[0]);
}

Tangent<3> at_angle(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

double cross(const Tangent<3>& a, const Tangent<3>& b) {
  return a[0] * b[1] - a[1] * b[0];
}

/// Part of d w_t across its direction: zero at the angle of the slip [m/s 1/kg].
double across(double angle, const CoulombContact<3>& contact, const Point<3>& v) {
  const Tangent<3> t = at_angle(angle);
  return cross(slip_along<3>(t, contact, v).velocity, t);
}

/// Newton's change of the angle of t towards the zero of `across`.
double change_of_angle(const Tangent<3>& t, const CoulombContact<3>& contact, const Point<3>& v) {
  const Tangent<3> turned(-t[1], t[0]);
  const Tangent<3> row = contact.mobility.row(0).tail<2>(), v_t = v.tail<2>();
  const Tangent<3> velocity = slip_along<3>(t, contact, v).velocity;
  const Tangent<3> slope =
      -contact.friction *
      (row.dot(turned) * v_t - v[0] * (contact.mobility.bottomRightCorner<2, 2>() * turned));
  return -cross(velocity, t) / (cross(slope, t) + cross(velocity, turned));
}

/// Returns the direction of slip to which Newton's method goes from an angle, if it comes so far
/// within `width` of it; else zero. Most sweeps turn a slip by less.
Tangent<3> slip_beside(double begin, double width, const CoulombContact<3>& contact,
                       const Point<3>& v) {
  constexpr int most_steps = 8;
  constexpr double is_exact_after = 1e-8;  // a change whose square is round-off
  double angle = begin, change = 1;
  for (int step = 0; step < most_steps && std::abs(change) > is_exact_after; ++step) {
    change = change_of_angle(at_angle(angle), contact, v);
    angle += change;
    if (!(std::abs(angle - begin) <= width))
      return Tangent<3>::Zero();
  }
  const Tangent<3> t = at_angle(angle);
  const bool is_slip =
      std::abs(change) <= is_exact_after && is_valid<3>(t, slip_along<3>(t, contact, v));
  return is_slip ? t : Tangent<3>::Zero();
}

/// Returns the zero of `across` between two angles at which it has these values of opposite signs,
/// by regula falsi, Illinois variant.
double zero_between(double a, double of_a, double b, double of_b, const CoulombContact<3>& contact,
                    const Point<3>& v) {
  constexpr int most_steps = 60;
  const double negligible =
      4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(of_a), std::abs(of_b));
  for (int step = 0; step < most_steps; ++step) {
    const double middle = (a * of_b - b * of_a) / (of_b - of_a);
    const double of_middle = across(middle, contact, v);
    if (std::abs(of_middle) <= negligible)
      return middle;
    if ((of_middle > 0) == (of_b > 0)) {
      of_a *= 0.5;
    } else {
      a = b;
      of_a = of_b;
    }
    b = middle;
    of_b = of_middle;
  }
  return b;
}

/// Returns the direction of slip that is nearest to the angle `begin`, of those with a change of
/// sign of `across` between two of `n_brackets` angles around the circle; zero if there is none.
Tangent<3> slip_near(double begin, int n_brackets, const CoulombContact<3>& contact,
                     const Point<3>& v) {
  const double width = 2 * M_PI / n_brackets;
  std::array<double, 2> ends{begin, begin};
  const double at_begin = across(begin, contact, v);
  std::array<double, 2> values{at_begin, at_begin};
  for (int k = 0; k < n_brackets; ++k) {
    const int side = k % 2;  // forth and back in turn
    const double angle = begin + (side == 0 ? 1 : -1) * (k / 2 + 1) * width;
    const double value = across(angle, contact, v);
    if (values[side] == 0 || (values[side] > 0) != (value > 0)) {
      const Tangent<3> t = at_angle(
          values[side] == 0 ? begin
                            : zero_between(ends[side], values[side], angle, value, contact, v));
      if (is_valid<3>(t, slip_along<3>(t, contact, v)))
        return t;
    }
    ends[side] = angle;
    values[side] = value;
  }
  return Tangent<3>::Zero();
}

Point<3> slipping(const CoulombContact<3>& contact, const Point<3>& v, const Point<3>& last) {
  const bool has_slipped = !last.tail<2>().isZero(0);
  const double begin = has_slipped ? std::atan2(-last[2], -last[1]) : std::atan2(v[2], v[1]);
  // Two zeros in one of 36 brackets are seen in one of random mobilities in a thousand.
  Tangent<3> t = slip_beside(begin, 2 * M_PI / 36, contact, v);
  for (const int n_brackets : {36, 1440})
    if (t.isZero(0))
      t = slip_near(begin, n_brackets, contact, v);
  if (t.isZero(0))
    return without_friction<3>(contact, v);
  return impulse_along<3>(t, slip_along<3>(t, contact, v).d, contact.friction, v[0]);
}

}  // namespace

template <int dim>
Point<dim> coulomb_impulse(const CoulombContact<dim>& contact, const Point<dim>& v,
                           const Point<dim>& last) {
  if (v[0] >= 0)
    return Point<dim>::Zero();
  const Point<dim> sticking = -contact.inverse * v;
  if (sticking.template tail<dim - 1>().norm() <= contact.friction * sticking[0])
    return sticking;
  return slipping(contact, v, last);
}

template Point<2> coulomb_impulse<2>(const CoulombContact<2>&, const Point<2>&, const Point<2>&);
template Point<3> coulomb_impulse<3>(const CoulombContact<3>&, const Point<3>&, const Point<3>&);

}  // namespace lockstep
