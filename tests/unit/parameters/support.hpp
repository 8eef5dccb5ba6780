#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

#include "base/errors.hpp"
#include "parameters/files/strict_xml.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep::test {

/// The message of the InputError that `work` throws; empty if it throws none.
template <typename Work>
std::string input_error(Work work) {
  try {
    work();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// A file whose only parameter stands in line 3, in the list "Fluid".
inline std::string file_with(const std::string& attributes) {
  return "<ParameterList>\n <ParameterList name=\"Fluid\">\n  <Parameter " + attributes +
         "/>\n </ParameterList>\n</ParameterList>\n";
}

inline std::string reading(const std::string& text) {
  return input_error([&] { read_xml_string(text, "case.xml"); });
}

/// A small schema with every kind of entry.
inline ParameterList scene_schema() {
  ParameterList valid;
  declare_choice(valid, "Scheme", "maccormack", {"maccormack", "semi-lagrangian"}, "Advection.");
  auto& fluid = declare_list(valid, "Fluid", "The fluid.");
  declare_positive(fluid, "Density", 1000.0, "Mass density [kg/m^3].");
  declare_at_least(fluid, "Viscosity", 0.0, 0.0, "Dynamic viscosity [Pa s].");
  declare_vector(fluid, "Gravity", {0.0, -9.81}, 2, "Acceleration [m/s^2].");
  declare_at_least(fluid, "Steps", 10, 1, "Number of steps.");
  declare_optional<double>(fluid, "Fixed step", "Step size [s].");
  ParameterList ball, box;
  declare_required_positive(ball, "Radius", "Radius [m].");
  declare(ball, "Locked", false, "Does not move.");
  declare_required_vector<double>(box, "Size", 2, "Edge lengths [m].");
  declare_named_sublists(valid, "Solids", "The bodies.",
                         {{"ball", "A ball.", ball}, {"box", "A box.", box}});
  declare_typed_sublist(valid, "Weights", "Coupling weights.",
                        {{"area", "By area.", {}}, {"closest", "By distance.", {}}}, "area");
  declare_free_sublist(valid, "Solver", "For Stratimikos.");
  return valid;
}

}  // namespace lockstep::test
