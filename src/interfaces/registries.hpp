#pragma once
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/constraint.hpp"
#include "interfaces/contact.hpp"
#include "interfaces/coupling.hpp"
#include "interfaces/observer.hpp"
#include "interfaces/strategy.hpp"
#include "parameters/registry.hpp"

namespace lockstep {

/// The solids of one type as a scene names them, in the order of the file.
using NamedLists = std::vector<std::pair<std::string, ParameterList>>;

/// Properties of the scene that a solid model may know.
template <int dim>
struct SolidSetting {
  double smallest_length = 1;               ///< h, the shortest length that the fluid resolves [m]
  Point<dim> gravity = Point<dim>::Zero();  ///< [m/s^2]
  double start_time = 0;                    ///< [s]
  Communicator comm;
  double fluid_density = 0;  ///< in the middle of the domain [kg/m^dim]
};

/// Properties of the scene that a contact model may know.
template <int dim>
struct ContactSetting {
  Box<dim> domain;  ///< [m]
  std::array<std::array<bool, 2>, dim>
      closed_sides{};               ///< [axis][lower, upper] is a wall for solids
  WallVelocity<dim> wall_velocity;  ///< velocity of these walls; empty: they are at rest
  double smallest_length = 1;       ///< h, the shortest length that the fluid resolves [m]
  Communicator comm;
  std::vector<std::string> solids;  ///< their names
  /// Pairs of solids that joints connect, by name.
  std::vector<std::pair<std::string, std::string>> jointed;
};

/// Properties of the scene that joints may know.
template <int dim>
struct JointSetting {
  const std::vector<std::unique_ptr<SolidModel<dim>>>& models;  ///< in the order of their stack
  double start_time = 0;                                        ///< [s]
  double largest_turn = 0;  ///< largest turn of a body in a step [rad]
  Communicator comm;
  double fluid_density = 0;  ///< [kg/m^dim]
};

/// The joints of a scene: ties between solids, and a model of their own unknowns, to follow the
/// others in the stack.
template <int dim>
struct JointSystem {
  std::unique_ptr<ConstraintModel> constraints;
  std::unique_ptr<SolidModel<dim>> rates;
};

template <int dim>
using FluidRegistry = Registry<FluidDiscretization<dim>, const ParameterList&, const Communicator&>;
/// One model holds all solids of its type; the list given to `create` is empty.
template <int dim>
using SolidRegistry = Registry<SolidModel<dim>, const NamedLists&, const SolidSetting<dim>&>;
template <int dim>
using CouplingRegistry = Registry<Coupling<dim>>;
using StrategyRegistry = Registry<SolverStrategy>;
template <int dim>
using ContactRegistry = Registry<ContactModel<dim>, const ContactSetting<dim>&>;

/// The lists are those of all joints.
template <int dim>
using ArticulationRegistry =
    Registry<JointSystem<dim>, const NamedLists&, const JointSetting<dim>&>;

template <int dim>
using ObserverRegistry = Registry<Observer<dim>>;

/// All plug-ins a program offers. Fill it (shipped/shipped_plug_ins.hpp has the shipped ones, a
/// driver adds its own), then hand it to `Simulation`.
template <int dim>
struct Registries {
  FluidRegistry<dim> fluids{"fluid"};
  SolidRegistry<dim> solids{"solid"};
  CouplingRegistry<dim> couplings{"coupling"};
  StrategyRegistry strategies{"solver strategy"};
  ContactRegistry<dim> contacts{"contact model"};
  ObserverRegistry<dim> observers{"observer"};
  ArticulationRegistry<dim> articulations{"articulation"};
  /// Schemas of the kinds of joints, by the name of the articulation.
  std::map<std::string, std::function<std::vector<TypedSchema>()>> joints;
  /// Schema of the "Domain" list, by the name of the fluid whose domain it is.
  std::map<std::string, std::function<ParameterList()>> domains;
  /// Registries of what plug-ins are put together from, of types that their packages define:
  /// materials, interface models of a liquid, joints, targets. Copies of this object share them.
  std::vector<std::shared_ptr<NamedPlugIns>> parts;

  /// Adds an empty registry of parts.
  template <typename Part>
  std::shared_ptr<Part> add_part(const std::string& kind) {
    auto part = std::make_shared<Part>(kind);
    parts.push_back(part);
    return part;
  }
  /// The registry of parts of this type. Throws InputError if the program has none.
  template <typename Part>
  Part& part() const {
    for (const auto& candidate : parts) {
      if (auto* const found = dynamic_cast<Part*>(candidate.get()))
        return *found;
    }
    throw InputError("This program has no plug-ins of the kind that is to be added to.");
  }
  /// All registries, of plug-ins and of their parts.
  std::vector<const NamedPlugIns*> all() const {
    std::vector<const NamedPlugIns*> every{&fluids,   &solids,     &articulations, &couplings,
                                           &contacts, &strategies, &observers};
    for (const auto& one : parts)
      every.push_back(one.get());
    return every;
  }
};

}  // namespace lockstep
