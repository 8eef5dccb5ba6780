#include "solve/solver_file.hpp"

#include <map>

#include "base/errors.hpp"
#include "parameters/files/parameter_file.hpp"
#include "parameters/untyped.hpp"

namespace lockstep {

Document read_solver_file(const std::string& path, const Communicator& comm) {
  Document document = read_parameters(path, comm);
  ParameterList& list = document.list;
  if (!list.isParameter("Type") && list.isParameter("Linear Solver Type"))
    list.set("Type", std::string("stratimikos"));
  assign_type(list, "Type", ValueType::text, document.source, "");
  assign_type(list, "Tolerance", ValueType::real, document.source, "");
  return document;
}

void check_strategy_is_not_gone(const ParameterList& list, const std::string& place) {
  static const std::map<std::string, std::string> instead = {
      {"block-lu", "block-lu.xml"},       {"gauss-seidel", "gauss-seidel.xml"},
      {"simple", "simple.xml"},           {"uzawa", "uzawa.xml"},
      {"solid-schur", "minres-teko.xml"}, {"bramble-pasciak", "minres-teko.xml"}};
  if (!list.isType<std::string>("Type"))
    return;
  const auto found = instead.find(list.get<std::string>("Type"));
  check_input(
      found == instead.end(),
      "{}: there is no strategy \"{}\" any more; a list of the strategy \"stratimikos\" does what "
      "it did. Name it by \"Solver/File\": xml-params/solvers/{}.",
      place, list.get<std::string>("Type"), found == instead.end() ? "" : found->second);
}

}  // namespace lockstep
