// The plug-ins of this project, under names of their own in scene files.
#include "interfaces/plug_ins.hpp"
#include "column_fluid.hpp"
#include "given_level.hpp"
#include "piston.hpp"
#include "steepest_descent.hpp"
#include "strategies/register_strategies.hpp"
#include "stroke.hpp"
using namespace lockstep;

namespace {

ParameterList column_parameters() {
  ParameterList list;
  declare_positive(list, "Density", 1000., "Of the fluid [kg/m^3].");
  declare(list, "Gravity", 0., "Along the channel [m/s^2].");
  return list;
}

ParameterList channel_parameters() {
  ParameterList list;
  declare_positive(list, "Length", 2., "Along x, from 0 [m].");
  declare_positive(list, "Width", 0.5, "Across, from y = 0 [m].");
  declare_positive(list, "Cells", 20, "Along the channel.");
  return list;
}

std::unique_ptr<ColumnFluid> make_column(const ParameterList& list, const ParameterList& domain,
                                         const Communicator& comm) {
  return std::make_unique<ColumnFluid>(
      ColumnFluid::Options{domain.get<int>("Cells"), domain.get<double>("Length"),
                           domain.get<double>("Width"), list.get<double>("Density"),
                           list.get<double>("Gravity")},
      comm);
}

ParameterList piston_parameters() {
  ParameterList list;
  declare(list, "Position", 0.7, "Along the channel [m].");
  declare_positive(list, "Width", 0.5, "Of the channel [m].");
  declare_positive(list, "Mass", 100., "[kg/m].");
  declare(list, "Force", 50., "Along the channel [N/m].");
  return list;
}

std::unique_ptr<Piston> make_piston(const ParameterList&, const NamedLists& pistons,
                                    const SolidSetting<2>& setting) {
  check_input(pistons.size() == 1, "A channel takes one piston, not {}.", pistons.size());
  const ParameterList& list = pistons[0].second;
  return std::make_unique<Piston>(
      Piston::Options{list.get<double>("Position"), list.get<double>("Width"),
                      list.get<double>("Mass"), list.get<double>("Force")},
      setting.comm);
}

ParameterList level_parameters() {
  ParameterList list;
  declare(list, "Height", 0., "Of the surface at the start [m].");
  declare(list, "Speed", 0., "At which it rises [m/s].");
  return list;
}

std::unique_ptr<GivenLevel> make_level(const ParameterList& list, const MacDomain<2>& domain) {
  return std::make_unique<GivenLevel>(
      GivenLevel::Options{list.get<double>("Height"), list.get<double>("Speed")}, domain);
}

}  // namespace

void lockstep_register_plug_ins(PlugIns& plug_ins) {
  Registries<2>& registries = plug_ins.plane;
  registries.fluids.add("column", "A straight channel.", column_parameters, make_column);
  registries.domains["column"] = channel_parameters;
  registries.solids.add("piston", "A plate across a channel.", piston_parameters, make_piston);
  registries.observers.add(
      "stroke", "How far the first solid has come.", [] { return ParameterList(); },
      [](const ParameterList&) { return std::make_unique<Stroke>(); });
  registries.part<InterfaceRegistry<2>>().add("given level", "A flat surface at a given height.",
                                              level_parameters, make_level);
  for (StrategyRegistry* strategies : {&plug_ins.plane.strategies, &plug_ins.space.strategies})
    add_strategy<SteepestDescent>(*strategies, "steepest-descent",
                                  "Steepest descent on the Schur complement.");
}
