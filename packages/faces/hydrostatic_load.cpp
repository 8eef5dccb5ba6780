#include "faces/hydrostatic_load.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/solid_volume.hpp"

namespace lockstep {

namespace {
/// Layers of cells below a solid, and above it, whose faces may be beside it.
constexpr int layers_below = 2;
}  // namespace

template <int dim>
HydrostaticLoads<dim>::HydrostaticLoads(const FluidDiscretization<dim>& fluid,
                                        const SurfaceSnapshot<dim>& surface, double density)
    : surface_(surface),
      gravity_(fluid.gravity()),
      density_(density),
      gas_density_(fluid.liquid() ? fluid.liquid()->gas_density() : 0),
      spacing_(fluid.smallest_length()),
      is_below_air_(fluid.liquid() && gas_density_ == 0),
      pressures_(surface.solids().size()),
      centers_(pressures_.size(), Point<dim>::Zero()),
      masses_(pressures_.size(), 0),
      sums_(pressures_.size()),
      layers_(pressures_.size()) {
  constexpr double round_off = 1e-9;
  int steepest = 0;
  const double steep = gravity_.cwiseAbs().maxCoeff(&steepest);
  if (steep > 0 &&
      (gravity_ - gravity_[steepest] * Point<dim>::Unit(steepest)).norm() <= round_off * steep)
    vertical_ = steepest;
  const auto levels =
      fluid.liquid() ? fluid.liquid()->levels_at_solids() : std::vector<WaterLevel>();
  for (int s = 0; s < static_cast<int>(pressures_.size()); ++s) {
    const SolidDescription& solid = surface.solids()[s];
    if (solid.simplex_begin == solid.simplex_end || (!solid.closed && !solid.rigid))
      continue;
    const WaterLevel* level = levels.empty() ? nullptr : &levels[s];
    const bool in_air = is_below_air_ && (!level->known || (solid.closed && !level->is_wet));
    if (in_air)
      continue;
    set_rest(s, fluid.bounds(), level);
    if (vertical_ >= 0 && solid.closed && solid.rigid)
      layers_[s].resize(2 * layers_below + 1 +
                        std::lround(surface.own_bounds(s).sizes()[vertical_] / spacing_));
  }
}

/// `level`: null in a fluid without a surface.
template <int dim>
void HydrostaticLoads<dim>::set_rest(int solid, const Box<dim>& bounds, const WaterLevel* level) {
  const Point<dim> up = -gravity_.normalized();
  PartOfSolid<dim> whole{0, surface_.own_bounds(solid).center()};
  const Box<dim> room = surface_.room_of(solid, bounds);
  if (surface_.solids()[solid].closed)
    whole = part_of_solid<dim>(surface_, solid, room);
  RestPressure<dim>& pressure = pressures_[solid];
  if (!level || !level->known) {  // one fluid fills the domain
    const double density = level && !level->is_wet ? gas_density_ : density_;
    pressure.gradient = density * gravity_;
    pressure.origin = centers_[solid] = whole.centroid;
    masses_[solid] = density * whole.volume;
    return;
  }
  const bool is_below = level->is_wet && !level->pierces;
  const bool is_parted = surface_.solids()[solid].closed && !is_below;
  const PartOfSolid<dim> below =
      is_parted ? part_below<dim>(surface_, solid, room, up, level->height) : whole;
  pressure.gradient = density_ * gravity_;
  pressure.origin = level->height * up;
  if (level->pierces || gas_density_ > 0)
    pressure.above = gas_density_ / density_;
  const double liquid = density_ * below.volume, gas = gas_density_ * (whole.volume - below.volume);
  masses_[solid] = liquid + gas;
  centers_[solid] = below.centroid;
  if (gas > 0)
    centers_[solid] = (gas_density_ * whole.volume * whole.centroid +
                       (density_ - gas_density_) * below.volume * below.centroid) /
                      masses_[solid];
}

/// The layer of cells that a point is in; null: the solid has none.
template <int dim>
typename HydrostaticLoads<dim>::Layer* HydrostaticLoads<dim>::layer_at(int solid,
                                                                       const Point<dim>& x) {
  std::vector<Layer>& layers = layers_[solid];
  if (layers.empty())
    return nullptr;
  const double lowest = surface_.own_bounds(solid).min()[vertical_];
  const double place = std::floor((x[vertical_] - lowest) / spacing_) + layers_below;
  return &layers[static_cast<int>(std::min(std::max(place, 0.0), layers.size() - 1.0))];
}

template <int dim>
void HydrostaticLoads<dim>::add_closed(const ControlVolume<dim>& volume, int solid, double area,
                                       const Point<dim>& center) {
  const int axis = volume.direction;
  const RestPressure<dim>& pressure = pressures_[solid];
  Sum& sum = sums_[solid][axis];
  sum.area += area;
  const Point<dim> shift = surface_.beside(solid, center) - center;
  Point<dim> arm = center + shift - centers_[solid];
  arm[axis] = 0;
  for (int side = 0; side < 2; ++side) {
    const PressureSide<dim>& of = volume.sides[side];
    if (of.unknown == no_index && of.patch < 0)
      continue;
    const double push = (side == 0 ? area : -area) * of.weight;
    const double force = push * pressure(of.center + shift);
    sum.force += force;
    sum.moment += force * arm;
    sum.open_area += push;
    if (Layer* layer = layer_at(solid, of.center + shift)) {
      layer->open_area[axis] += push;
      if (axis == vertical_)
        layer->moment += force * arm;
    }
  }
}

template <int dim>
void HydrostaticLoads<dim>::add_lumped(int axis, int solid, double mass, const Point<dim>& center) {
  Point<dim> arm = surface_.beside(solid, center) - centers_[solid];
  arm[axis] = 0;
  Sum& sum = sums_[solid][axis];
  sum.force += mass * gravity_[axis];
  sum.moment += mass * gravity_[axis] * arm;
  const Point<dim> lower = surface_.beside(solid, center) - 0.5 * spacing_ * Point<dim>::Unit(axis);
  if (Layer* layer = axis == vertical_ ? layer_at(solid, lower) : nullptr)
    layer->moment += mass * gravity_[axis] * arm;
}

template <int dim>
void HydrostaticLoads<dim>::sum(const Communicator& comm) {
  constexpr int n_values = dim + 3;
  std::vector<double> values;
  values.reserve(sums_.size() * dim * n_values);
  for (const auto& solid : sums_)
    for (const Sum& sum : solid) {
      values.insert(values.end(), {sum.force, sum.open_area, sum.area});
      values.insert(values.end(), sum.moment.begin(), sum.moment.end());
    }
  for (const std::vector<Layer>& layers : layers_)
    for (const Layer& layer : layers) {
      values.insert(values.end(), layer.open_area.begin(), layer.open_area.end());
      values.insert(values.end(), layer.moment.begin(), layer.moment.end());
    }
  if (values.empty())
    return;
  sum_all(comm, values.data(), static_cast<int>(values.size()));
  auto value = values.cbegin();
  for (auto& solid : sums_)
    for (Sum& sum : solid) {
      sum.force = *value++;
      sum.open_area = *value++;
      sum.area = *value++;
      for (double& moment : sum.moment)
        moment = *value++;
    }
  for (std::vector<Layer>& layers : layers_)
    for (Layer& layer : layers) {
      for (double& area : layer.open_area)
        area = *value++;
      for (double& moment : layer.moment)
        moment = *value++;
    }
}

template <int dim>
AxisLoad<dim> HydrostaticLoads<dim>::exact(int solid, int axis) const {
  return {solid, axis, centers_[solid], -masses_[solid] * gravity_[axis], Point<dim>::Zero()};
}

/// True if the grid has the force along an axis but for what it misplaces: the pressure on a face
/// is that of a point at most a cell away from the surface. More is missing where a wall or another
/// solid hides an end of the solid, and where the water around it has no one level.
template <int dim>
bool HydrostaticLoads<dim>::is_covered(int solid, int axis, const Sum& sum) const {
  constexpr double round_off = 1e-9;
  const RestPressure<dim>& pressure = pressures_[solid];
  // Along a level axis water at rest wets both ends of a solid alike, a wave does not.
  const bool is_level = std::abs(gravity_[axis]) <= round_off * gravity_.norm();
  if ((pressure.above > 0 || is_level) && std::abs(sum.open_area) > round_off * sum.area)
    return false;
  double area = 2;  // two ends
  for (int a = 0; a < dim; ++a)
    if (a != axis)
      area *= surface_.own_bounds(solid).sizes()[a] + spacing_;
  const double misplaced = pressure.gradient.norm() * spacing_ * area;
  return std::abs(exact(solid, axis).force - sum.force) <= misplaced;
}

template <int dim>
std::vector<AxisLoad<dim>> HydrostaticLoads<dim>::on_grid() const {
  std::vector<AxisLoad<dim>> loads;
  for (int s = 0; s < static_cast<int>(sums_.size()); ++s)
    for (int axis = 0; axis < dim && !pressures_[s].gradient.isZero(0); ++axis) {
      const Sum& sum = sums_[s][axis];
      // The pressure of closed fluid has no level, so that nothing can be said of a hidden end.
      const bool is_hidden =
          !is_below_air_ && surface_.solids()[s].closed && !is_covered(s, axis, sum);
      loads.push_back(is_hidden ? exact(s, axis)
                                : AxisLoad<dim>{s, axis, centers_[s], sum.force, sum.moment});
    }
  return loads;
}

/// The moment about `lever` of forces along the vertical, of the layers in which as much of the
/// solid is wet at one end of the lever as at the other.
template <int dim>
double HydrostaticLoads<dim>::moment_of_even_layers(int solid, int lever) const {
  constexpr double round_off = 1e-9;
  double moment = 0;
  for (const Layer& layer : layers_[solid])
    if (std::abs(layer.open_area[lever]) <= round_off * sums_[solid][lever].area)
      moment += layer.moment[lever];
  return moment;
}

/// A torque is a matter of two axes. On a round solid the pressure of each cell has moments along
/// both, which cancel, so that the moment along one alone may not be taken off: beside a wall, and
/// where the water is uneven, that gave a disc of 1e-3 of the fluid's density 20 rad/s in a step
/// of 20 ms, and the water kilojoules.
template <int dim>
std::vector<AxisLoad<dim>> HydrostaticLoads<dim>::corrections() const {
  std::vector<AxisLoad<dim>> loads;
  for (int s = 0; s < static_cast<int>(sums_.size()); ++s) {
    if (!surface_.solids()[s].closed || pressures_[s].gradient.isZero(0))
      continue;
    std::array<bool, dim> covered;
    for (int axis = 0; axis < dim; ++axis)
      covered[axis] = is_covered(s, axis, sums_[s][axis]);
    for (int axis = 0; axis < dim; ++axis) {
      if (!covered[axis])
        continue;
      AxisLoad<dim> load = exact(s, axis);
      load.force -= sums_[s][axis].force;
      for (int lever = 0; lever < dim; ++lever)
        if (covered[lever])
          load.moment[lever] -= sums_[s][axis].moment[lever];
        else if (axis == vertical_)
          load.moment[lever] -= moment_of_even_layers(s, lever);
      loads.push_back(load);
    }
  }
  return loads;
}

template <int dim>
std::vector<DisplacedMass<dim>> HydrostaticLoads<dim>::displaced_masses() const {
  std::vector<DisplacedMass<dim>> masses;
  for (int s = 0; s < static_cast<int>(masses_.size()); ++s)
    if (masses_[s] > 0)
      masses.push_back({s, masses_[s], centers_[s]});
  return masses;
}

template <int dim>
std::vector<Triplet> added_mass_of_balls(const std::vector<DisplacedMass<dim>>& displaced,
                                         const SolidSystem<dim>& solids,
                                         const SurfaceSnapshot<dim>& surface) {
  constexpr double of_displaced = dim == 2 ? 1 : 0.5;  // potential flow
  std::vector<Triplet> triplets;
  VelocityRow<dim> row;
  for (const DisplacedMass<dim>& one : displaced) {
    const SolidDescription& solid = surface.solids()[one.solid];
    if (solid.prescribed || !solid.rigid)
      continue;
    SurfacePoint<dim> point;
    point.simplex = solid.simplex_begin;
    solids.velocity_row(point, one.center, row);
    for (std::size_t i = 0; i < row.dofs.size(); ++i)
      for (std::size_t j = 0; j < row.dofs.size() && solids.map()->isNodeGlobalElement(row.dofs[i]);
           ++j)
        triplets.push_back(
            {row.dofs[i], row.dofs[j],
             of_displaced * one.mass * row.coefficients[i].dot(row.coefficients[j])});
  }
  return triplets;
}

template std::vector<Triplet> added_mass_of_balls<2>(const std::vector<DisplacedMass<2>>&,
                                                     const SolidSystem<2>&,
                                                     const SurfaceSnapshot<2>&);
template std::vector<Triplet> added_mass_of_balls<3>(const std::vector<DisplacedMass<3>>&,
                                                     const SolidSystem<3>&,
                                                     const SurfaceSnapshot<3>&);
template class HydrostaticLoads<2>;
template class HydrostaticLoads<3>;

}  // namespace lockstep
