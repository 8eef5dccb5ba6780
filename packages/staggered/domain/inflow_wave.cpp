#include "staggered/domain/inflow_wave.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "parameters/field_formula.hpp"
#include "staggered/domain/parameter_values.hpp"

namespace lockstep {

namespace {
/// Calls f(place, weight) for Gauss and Legendre's points of the interval from 0 to 1: exact for
/// polynomials of order 9.
template <typename Function>
void for_each_gauss_point(const Function& f) {
  constexpr double points[] = {-0.906179845938664, -0.538469310105683, 0, 0.538469310105683,
                               0.906179845938664};
  constexpr double weights[] = {0.236926885056189, 0.478628670499366, 0.568888888888889,
                                0.478628670499366, 0.236926885056189};
  for (int i = 0; i < 5; ++i)
    f(0.5 + 0.5 * points[i], 0.5 * weights[i]);
}
}  // namespace

template <int dim>
Point<dim> InflowWave<dim>::velocity_at(const Point<dim>& x, double time) const {
  const double top = theory->top(time, share(time));
  const double z = std::clamp(x.dot(up) - level, -depth, std::max(top, -depth));
  return velocity(theory->motion(z, time, share(time)));
}

template <int dim>
Point<dim> InflowWave<dim>::mean_velocity(const Box<dim>& box, double time) const {
  const double one = box.min().dot(up) - level, other = box.max().dot(up) - level;
  const double lower = std::min(one, other), upper = std::max(one, other);
  if (upper - lower <= 0)
    return velocity_at(box.min(), time);
  const double bottom = -depth, top = std::max(theory->top(time, share(time)), bottom);
  WaveMotion sum;
  const auto add = [&](double length, double z) {
    if (length <= 0)
      return;
    const WaveMotion motion = theory->motion(z, time, share(time));
    sum.along += length * motion.along;
    sum.upward += length * motion.upward;
  };
  const double begin = std::clamp(lower, bottom, top), end = std::clamp(upper, bottom, top);
  for_each_gauss_point([&](double place, double weight) {
    add(weight * (end - begin), begin + place * (end - begin));
  });
  add(std::max(upper, top) - std::max(lower, top), top);
  add(std::min(upper, bottom) - std::min(lower, bottom), bottom);
  sum.along /= upper - lower;
  sum.upward /= upper - lower;
  return velocity(sum);
}

template <int dim>
double InflowWave<dim>::flow_below_top(double time, double share) const {
  const double height = depth + std::max(theory->top(time, share), -depth);
  double sum = 0;
  for_each_gauss_point([&](double place, double weight) {
    sum += weight * theory->motion(height * place - depth, time, share).along;
  });
  return height * sum;
}

template <int dim>
double InflowWave<dim>::flow(double time) const {
  double mean = 0;
  constexpr int n_times = 16;
  for (int i = 0; period > 0 && i < n_times; ++i)
    mean += flow_below_top(time + period * i / n_times, share(time)) / n_times;
  return flow_below_top(time, share(time)) - mean;
}

void declare_inflow_wave(ParameterList& side) {
  ParameterList& wave = declare_optional_list(
      side, "Wave",
      "An inflow sends waves into a tank of liquid: at the side the water moves as below a wave "
      "that goes inwards, and as much comes in as that wave brings, on the mean nothing, "
      "whatever waves come back. The still water is the \"level\" in \"Liquid\", down to the "
      "side of the domain below it. They begin with a crest.");
  declare_choice(
      wave, "Type", wave_theories().front(), wave_theories(),
      "Airy: linear, for low waves; Stokes 2 and Stokes 5: to the second and fifth order "
      "of the steepness, with sharper crests that are faster in the fifth; solitary: one "
      "crest on shallow water, of third order, with the water that it brings.");
  declare_required_positive(wave, "Height",
                            "From trough to crest, of a solitary wave above the still water [m].");
  declare_optional<double>(wave, "Frequency",
                           "Crests per second [1/s]; for all but a solitary wave.");
  set_positive(wave, "Frequency");
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
  const auto theory = list.get<std::string>("Type");
  check_input(list.isParameter("Frequency") == (theory != "solitary"), "In \"{}\", {}", where,
              theory == "solitary" ? "a solitary wave has no \"Frequency\"; leave it out."
                                   : "a \"Wave\" needs a \"Frequency\", in crests per second.");
  InflowWave<dim> wave;
  wave.ramp_time = list.get<double>("Ramp Time");
  wave.level = still_level<dim>(fluid, where);
  wave.up = -gravity.normalized();
  wave.inward = Point<dim>::Unit(axis) * (end == 0 ? 1 : -1);
  const double one = domain.min().dot(wave.up), other = domain.max().dot(wave.up);
  const double bottom = std::min(one, other), top = std::max(one, other);
  check_input(wave.level > bottom && wave.level < top,
              "In \"{}\", the \"Height\" of the water is {:g} m, but the side reaches from {:g} to "
              "{:g} m, measured against gravity.",
              where, wave.level, bottom, top);
  wave.depth = wave.level - bottom;
  wave.period = list.isParameter("Frequency") ? 1 / list.get<double>("Frequency") : 0;
  wave.theory = make_wave(
      theory, {list.get<double>("Height"), wave.period, wave.depth, gravity.norm()}, where);
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
