#include "staggered/domain/boundary.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "base/errors.hpp"
#include "parameters/formula.hpp"
#include "parameters/mistakes.hpp"
#include "staggered/domain/inflow_scalars.hpp"
#include "staggered/domain/parameter_values.hpp"

namespace lockstep {

std::string side_name(int axis, int end) {
  return std::string(axis_names[axis]) + (end == 0 ? " lower" : " upper");
}

namespace {
const std::vector<std::string> side_types = {"wall", "slip wall", "open", "inflow", "periodic"};

constexpr double right_angle = 90;          // [degrees]
constexpr double least_contact_angle = 20;  // [degrees]

SideType side_type(const std::string& name) {
  for (std::size_t i = 0; i < side_types.size(); ++i)
    if (side_types[i] == name)
      return static_cast<SideType>(i);
  throw InputError(fmt::format("There is no side of type \"{}\".", name));
}

template <int dim>
BoundarySide<dim> read_side(const ParameterList& list, const Box<dim>& domain, int axis, int end) {
  BoundarySide<dim> side;
  side.type = side_type(list.get<std::string>("Type"));
  const std::string where = "Domain/Sides/" + side_name(axis, end);
  side.velocity = FieldFormula<dim>(list, "Velocity", where);
  side.pressure = FieldFormula<dim>(list, "Pressure", where);
  side.opening = read_inflow_opening<dim>(list, domain, axis, where);
  check_input(
      !side.closed() ||
          (side.velocity.is_number(axis) && side.velocity(axis, domain.min(), 0) == 0),
      "In \"{}\", a wall cannot move along {}: it would leave the domain. Make it an inflow, or "
      "set that component of \"Velocity\" to 0.",
      where, axis_names[axis]);
  const auto check_meaning = [&](const char* parameter, bool given) {
    check_input(!given || side.type == SideType::wall || side.type == SideType::inflow,
                "In \"Domain/Sides/{}\", \"{}\" has no meaning on a side of type \"{}\"; it is "
                "for walls and inflows.",
                side_name(axis, end), parameter, list.get<std::string>("Type"));
  };
  check_meaning("Velocity", !side.velocity.vanishes());
  check_input(side.type == SideType::open || side.pressure.vanishes(),
              "In \"{}\", \"Pressure\" has no meaning on a side of type \"{}\"; it is for open "
              "sides.",
              where, list.get<std::string>("Type"));
  const auto angle = list.get<double>("Contact Angle");
  check_input(side.closed() || angle == right_angle,
              "In \"{}\", \"Contact Angle\" has no meaning on a side of type \"{}\"; it is for "
              "walls.",
              where, list.get<std::string>("Type"));
  side.contact_cotangent = angle == right_angle ? 0 : 1 / std::tan(angle * pi / 180);
  return side;
}

/// Places within a cell must be numbers of their own.
template <int dim>
void check_resolution(const Point<dim>& lower, const Point<dim>& upper, double spacing) {
  constexpr double finest = 1e-6;  // part of a cell
  const double farthest = std::max(lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff());
  check_input(!(farthest * std::numeric_limits<double>::epsilon() > finest * spacing),
              "In \"Domain\", a corner lies {:g} m from the origin, where the numbers of a "
              "computer cannot tell places in a cell of {:g} m apart; move the domain to the "
              "origin.",
              farthest, spacing);
}
}  // namespace

template <int dim>
ParameterList domain_parameters() {
  ParameterList list("Domain");
  declare_vector(list, "Lower", filled_array(dim, 0.0), dim, "Lower corner [m].");
  declare_vector(list, "Upper", filled_array(dim, 1.0), dim, "Upper corner [m].");
  declare_vector(list, "Cells", filled_array(dim, 32), dim,
                 "Cells along each axis. The cells must come out as squares or cubes.");
  set_at_least(list, "Cells", 1);
  ParameterList& sides =
      declare_list(list, "Sides", "Boundary conditions on the sides of the domain.");
  for (int a = 0; a < dim; ++a)
    for (int end = 0; end < 2; ++end) {
      ParameterList& side =
          declare_list(sides, side_name(a, end), "The side at the end of this axis.");
      declare_choice(side, "Type", "wall", side_types,
                     "wall: closed, the fluid sticks to it; slip wall: closed, no friction; open: "
                     "given pressure; inflow: given velocity; periodic: joined to the opposite "
                     "side (both must be periodic).");
      declare_vector(side, "Velocity", filled_array(dim, 0.0), dim,
                     "Velocity of the inflow, or of a wall along itself [m/s]; formulas of place "
                     "[m] and time [s]: a ramp \"[min(t, 1)]\", a parabola \"[6*y*(1 - y)]\", a "
                     "pulse \"[t < 1 ? 2 : 0]\".");
      declare(side, "Pressure", 0.0,
              "Pressure at an open side [Pa], or a formula of place [m] and time [s], such as that "
              "of still water 2 m high, \"[1000*9.81*max(2 - y, 0)]\". Where it is not left at 0 "
              "what comes in is like what is there, liquid beside liquid, and comes as from a "
              "lake: the side holds less by rho u^2/2 there.");
      for (const char* name : {"Velocity", "Pressure"})
        set_variables(side, name, place_and_time(dim));
      declare_between(side, "Contact Angle", right_angle, least_contact_angle,
                      180 - least_contact_angle,
                      "Angle at which a free surface with \"Surface Tension\" comes to meet this "
                      "wall, measured in the liquid [degrees]: less than 90 where the liquid wets "
                      "it.");
      declare_inflow_opening<dim>(side);
      declare_inflow_wave(side);
      declare_inflow_scalars<dim>(side);
    }
  return list;
}

template <int dim>
Point<dim> BoundarySide<dim>::velocity_at(int axis, const Point<dim>& x, double time) const {
  if (wave)
    return wave->velocity_at(x, time);
  if (type == SideType::inflow && !opening.contains(axis, x))
    return Point<dim>::Zero();
  return velocity.vector(x, time);
}

template <int dim>
Point<dim> BoundarySide<dim>::mean_velocity(int axis, const Box<dim>& face, double time) const {
  if (wave)
    return wave->mean_velocity(face, time);
  Box<dim> open = face;
  double share = 1;
  if (type == SideType::inflow)
    share = opening.share(axis, face, open);
  open.min()[axis] = open.max()[axis] = face.center()[axis];
  Point<dim> mean = Point<dim>::Zero();
  for (int a = 0; share > 0 && a < dim; ++a)
    mean[a] = share * velocity.mean(a, open, time);
  return mean;
}

template <int dim>
bool BoundarySide<dim>::jumps(double begin, double end) const {
  if (velocity.are_numbers())
    return false;
  constexpr int n_halves = 40;
  const auto jumps_at = [&](const Point<dim>& x) {
    double from = begin, to = end;
    Point<dim> before = velocity.vector(x, from), after = velocity.vector(x, to);
    const double change = (after - before).norm();
    for (int i = 0; change > 0 && i < n_halves; ++i) {
      const double middle = 0.5 * (from + to);
      const Point<dim> between = velocity.vector(x, middle);
      const bool is_first = (between - before).norm() > (after - between).norm();
      (is_first ? to : from) = middle;
      (is_first ? after : before) = between;
    }
    return change > 0 && (after - before).norm() > 0.5 * change;
  };
  // Points across the side tell: nobody knows where a formula is not zero.
  bool jumps = false;
  for (const double share : {0.21, 0.5, 0.83}) {
    const Point<dim> x = opening.box.min() + share * opening.box.sizes();
    jumps = jumps || jumps_at(x);
  }
  return jumps;
}

template struct BoundarySide<2>;
template struct BoundarySide<3>;

template <int dim>
void set_grid_flags(const Boundary<dim>& boundary, GridDescription<dim>& grid) {
  for (int a = 0; a < dim; ++a) {
    const SideType upper = boundary.side(a, 1).type;
    grid.periodic[a] = boundary.periodic(a);
    grid.store_upper_face[a] = upper == SideType::open || upper == SideType::inflow;
  }
}

namespace {
/// Corners and cells; throws InputError if these are no cubes.
template <int dim>
GridDescription<dim> read_grid(const ParameterList& list) {
  const Point<dim> lower = point_value<dim>(list, "Lower");
  const Point<dim> upper = point_value<dim>(list, "Upper");
  const auto& cells = list.get<ParameterArray<int>>("Cells");
  GridDescription<dim> grid;
  grid.lower = lower;
  grid.spacing = (upper[0] - lower[0]) / cells[0];
  for (int a = 0; a < dim; ++a)
    check_input(
        upper[a] > lower[a],
        "In \"Domain\", the upper corner must be above the lower one, but along {} they are "
        "{} and {} m.",
        axis_names[a], upper[a], lower[a]);
  check_resolution<dim>(lower, upper, grid.spacing);
  for (int a = 0; a < dim; ++a) {
    grid.n_cells[a] = cells[a];
    const double h = (upper[a] - lower[a]) / cells[a];
    check_input(
        std::abs(h - grid.spacing) <= 1e-9 * grid.spacing,
        "In \"Domain\", the cells must be as long along every axis, but they are {} m along x "
        "and {} m along {}; change \"Cells\" or the corners.",
        grid.spacing, h, axis_names[a]);
  }
  return grid;
}

/// Joined sides.
template <int dim>
void check_periodic(const Boundary<dim>& boundary, const GridDescription<dim>& grid, int axis) {
  check_input((boundary.side(axis, 0).type == SideType::periodic) ==
                  (boundary.side(axis, 1).type == SideType::periodic),
              "In \"Domain/Sides\", only one of \"{}\" and \"{}\" is periodic; either both are or "
              "none.",
              side_name(axis, 0), side_name(axis, 1));
  check_input(!boundary.periodic(axis) || grid.n_cells[axis] >= 3,
              "In \"Domain\", the periodic axis {} has {} cells, but needs 3 or more.",
              axis_names[axis], grid.n_cells[axis]);
}
}  // namespace

template <int dim>
DomainDescription<dim> read_domain(const ParameterList& list) {
  DomainDescription<dim> result;
  Mistakes mistakes;
  mistakes.collect([&] { result.grid = read_grid<dim>(list); });
  const bool has_grid = mistakes.empty();
  const Box<dim> box(point_value<dim>(list, "Lower"), point_value<dim>(list, "Upper"));
  for (int a = 0; a < dim && !box.isEmpty(); ++a) {
    const std::size_t n_before = mistakes.messages().size();
    for (int end = 0; end < 2; ++end)
      mistakes.collect([&] {
        result.boundary.sides[a][end] =
            read_side<dim>(list.sublist("Sides").sublist(side_name(a, end)), box, a, end);
      });
    if (has_grid && mistakes.messages().size() == n_before)
      mistakes.collect([&] { check_periodic(result.boundary, result.grid, a); });
  }
  mistakes.throw_all();
  set_grid_flags(result.boundary, result.grid);
  return result;
}

template <int dim>
void read_waves(const ParameterList& fluid, const ParameterList& domain,
                DomainDescription<dim>& description) {
  const Box<dim> box(point_value<dim>(domain, "Lower"), point_value<dim>(domain, "Upper"));
  Mistakes mistakes;
  for (int axis = 0; axis < dim; ++axis)
    for (int end = 0; end < 2; ++end)
      mistakes.collect([&] {
        const std::string name = side_name(axis, end);
        description.boundary.sides[axis][end].wave = read_inflow_wave<dim>(
            domain.sublist("Sides").sublist(name), fluid, box, axis, end, "Domain/Sides/" + name);
      });
  mistakes.throw_all();
}

template void read_waves<2>(const ParameterList&, const ParameterList&, DomainDescription<2>&);
template void read_waves<3>(const ParameterList&, const ParameterList&, DomainDescription<3>&);
template ParameterList domain_parameters<2>();
template ParameterList domain_parameters<3>();
template DomainDescription<2> read_domain<2>(const ParameterList&);
template DomainDescription<3> read_domain<3>(const ParameterList&);
template void set_grid_flags<2>(const Boundary<2>&, GridDescription<2>&);
template void set_grid_flags<3>(const Boundary<3>&, GridDescription<3>&);

}  // namespace lockstep
