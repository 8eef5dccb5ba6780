#include "staggered/domain/inflow_wave.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "parameters/field_formula.hpp"
#include "staggered/domain/parameter_values.hpp"

namespace lockstep {

namespace {
/// cosh(k (z + d)) / sinh(k d) and sinh(k (z + d)) / sinh(k d), which stay finite in deep water.
struct Profile {
  double k, depth;

  double cosh_part(double z) const { return part(z, 1); }
  double sinh_part(double z) const { return part(z, -1); }

 private:
  double part(double z, double sign) const {
    z = std::clamp(z, -depth, 0.0);
    return (std::exp(k * z) + sign * std::exp(-k * (z + 2 * depth))) /
           (1 - std::exp(-2 * k * depth));
  }
};

/// Integral from `lower` to `upper` of a part that is as at 0 above 0 and as at -depth below that;
/// `primitive` is its integral in between.
template <typename Part, typename Primitive>
double integral(const Part& part, const Primitive& primitive, double depth, double lower,
                double upper) {
  const double begin = std::clamp(lower, -depth, 0.0), end = std::clamp(upper, -depth, 0.0);
  const double above = std::max(upper, 0.0) - std::max(lower, 0.0);
  const double below = std::min(upper, -depth) - std::min(lower, -depth);
  return primitive(end) - primitive(begin) + above * part(0) + below * part(-depth);
}
}  // namespace

double wave_number(double frequency, double gravity, double depth) {
  const double deep = frequency * frequency / gravity;
  // Newton's method from a start of the right size (Eckart 1952, off by 5 % at most).
  double k = deep / std::sqrt(std::tanh(deep * depth));
  for (int i = 0; i < 20; ++i) {
    const double t = std::tanh(k * depth);
    const double change = (k * t - deep) / (t + k * depth * (1 - t * t));
    k -= change;
    if (std::abs(change) < 1e-15 * k)
      break;
  }
  return k;
}

template <int dim>
Point<dim> InflowWave<dim>::velocity(double along, double up_part, double time) const {
  const double a = share(time) * height / 2, omega = frequency();
  const double mean_flow =
      a * a * gravity / (2 * speed());  // a wave's own, between crest and bottom
  const double inwards = a * omega * along * std::sin(omega * time) - mean_flow / depth;
  return inwards * inward + a * omega * up_part * std::cos(omega * time) * up;
}

template <int dim>
Point<dim> InflowWave<dim>::velocity_at(const Point<dim>& x, double time) const {
  const Profile profile{number, depth};
  const double z = x.dot(up) - level;
  return velocity(profile.cosh_part(z), profile.sinh_part(z), time);
}

template <int dim>
Point<dim> InflowWave<dim>::mean_velocity(const Box<dim>& box, double time) const {
  const Profile profile{number, depth};
  const double one = box.min().dot(up) - level, other = box.max().dot(up) - level;
  const double lower = std::min(one, other), upper = std::max(one, other);
  if (upper - lower <= 0)
    return velocity_at(box.min(), time);
  const auto c = [&](double z) { return profile.cosh_part(z); };
  const auto s = [&](double z) { return profile.sinh_part(z); };
  const auto integral_of_c = [&](double z) { return profile.sinh_part(z) / number; };
  const auto integral_of_s = [&](double z) { return profile.cosh_part(z) / number; };
  const double along = integral(c, integral_of_c, depth, lower, upper);
  const double up_part = integral(s, integral_of_s, depth, lower, upper);
  return velocity(along / (upper - lower), up_part / (upper - lower), time);
}

void declare_inflow_wave(ParameterList& side) {
  ParameterList& wave = declare_optional_list(
      side, "Wave",
      "An inflow sends a regular wave into a tank of liquid: at the side the water moves as below "
      "a wave of linear theory that goes inwards, less that wave's mean flow. The still water is "
      "the \"level\" in \"Liquid\", down to the side of the domain below it. It begins with a "
      "crest.");
  declare_required_positive(wave, "Height", "From trough to crest [m].");
  declare_required_positive(wave, "Frequency", "Crests per second [1/s].");
  declare_at_least(wave, "Ramp Time", 0.0, 0.0,
                   "Time during which the height grows linearly from 0 [s].");
}

namespace {
/// The axis that `gravity` is along; -1: none, or several.
template <int dim>
int axis_along(const Point<dim>& gravity) {
  int axis = -1;
  for (int a = 0; a < dim; ++a) {
    if (gravity[a] == 0)
      continue;
    if (axis >= 0)
      return -1;
    axis = a;
  }
  return axis;
}

/// Height of the still water: that of the one level among the fluid's liquids [m].
template <int dim>
double still_level(const ParameterList& fluid, const std::string& where) {
  const ParameterList& liquids = fluid.sublist("Free Surface").sublist("Liquid");
  std::optional<double> height;
  int n_levels = 0;
  for (auto it = liquids.begin(); it != liquids.end(); ++it) {
    const ParameterList& liquid = liquids.sublist(liquids.name(it));
    if (liquid.get<std::string>("Type") != "level")
      continue;
    const FieldFormula<dim> formula(liquid, "Height", "Fluid/Free Surface/Liquid");
    check_input(formula.are_numbers(),
                "In \"{}\", a \"Wave\" runs on still water, but the \"Height\" of \"{}\" in "
                "\"Fluid/Free Surface/Liquid\" depends on the place; make it a number.",
                where, liquids.name(it));
    height = formula(0, Point<dim>::Zero(), 0);
    ++n_levels;
  }
  check_input(
      n_levels == 1,
      "In \"{}\", a \"Wave\" runs on the one \"level\" of \"Fluid/Free Surface/Liquid\", but "
      "there are {}.",
      where, n_levels);
  return *height;
}

/// Waves that are steeper or higher break (Miche 1944).
template <int dim>
void check_height(const InflowWave<dim>& wave, const std::string& where) {
  const double length = 2 * M_PI / wave.number;
  const double highest = 0.142 * length * std::tanh(wave.number * wave.depth);
  check_input(wave.height < highest,
              "In \"{}\", a wave of a period of {:g} s on water {:g} m deep is {:.3g} m long and "
              "breaks where it is {:.3g} m high, but its \"Height\" is {:g} m; make it lower or "
              "longer.",
              where, wave.period, wave.depth, length, highest, wave.height);
}
}  // namespace

template <int dim>
std::optional<InflowWave<dim>> read_inflow_wave(const ParameterList& side,
                                                const ParameterList& fluid, const Box<dim>& domain,
                                                int axis, int end, const std::string& where) {
  if (!side.isSublist("Wave"))
    return {};
  check_input(side.get<std::string>("Type") == "inflow",
              "In \"{}\", \"Wave\" is for inflows, but the type of the side is \"{}\".", where,
              side.get<std::string>("Type"));
  check_input(fluid.isSublist("Free Surface"),
              "In \"{}\", there is a \"Wave\", but the fluid has no surface; give \"Fluid\" the "
              "list \"Free Surface\", or leave the wave out.",
              where);
  check_input(!side.isSublist("Opening") && FieldFormula<dim>(side, "Velocity", where).vanishes(),
              "In \"{}\", the \"Wave\" says how the water moves, at all of the side; leave "
              "\"Velocity\" and \"Opening\" out.",
              where);
  const bool is_steady = FieldFormula<dim>(fluid, "Gravity", where).are_numbers();
  const Point<dim> gravity = gravity_at_start<dim>(fluid);
  const int vertical = axis_along<dim>(gravity);
  check_input(is_steady && vertical >= 0 && vertical != axis,
              "In \"{}\", a \"Wave\" wants gravity along the side and along an axis, the same "
              "always, to know where up is.",
              where);
  const ParameterList& list = side.sublist("Wave");
  InflowWave<dim> wave;
  wave.height = list.get<double>("Height");
  wave.period = 1 / list.get<double>("Frequency");
  wave.ramp_time = list.get<double>("Ramp Time");
  wave.level = still_level<dim>(fluid, where);
  wave.gravity = gravity.norm();
  wave.up = -gravity.normalized();
  wave.inward = Point<dim>::Unit(axis) * (end == 0 ? 1 : -1);
  const double one = domain.min().dot(wave.up), other = domain.max().dot(wave.up);
  const double bottom = std::min(one, other), top = std::max(one, other);
  check_input(wave.level > bottom && wave.level < top,
              "In \"{}\", the \"Height\" of the water is {:g} m, but the side reaches from {:g} to "
              "{:g} m, measured against gravity.",
              where, wave.level, bottom, top);
  wave.depth = wave.level - bottom;
  wave.number = wave_number(wave.frequency(), wave.gravity, wave.depth);
  check_height(wave, where);
  return wave;
}

template struct InflowWave<2>;
template struct InflowWave<3>;
template std::optional<InflowWave<2>> read_inflow_wave<2>(const ParameterList&,
                                                          const ParameterList&, const Box<2>&, int,
                                                          int, const std::string&);
template std::optional<InflowWave<3>> read_inflow_wave<3>(const ParameterList&,
                                                          const ParameterList&, const Box<3>&, int,
                                                          int, const std::string&);

}  // namespace lockstep
