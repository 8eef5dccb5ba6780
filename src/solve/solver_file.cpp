#include "solve/solver_file.hpp"

#include "parameters/strict_xml.hpp"

namespace lockstep {

Document read_solver_file(const std::string& path, const Communicator& comm) {
  Document document = read_xml(path, comm);
  ParameterList& list = document.list;
  if (!list.isParameter("Type") && list.isParameter("Linear Solver Type"))
    list.set("Type", std::string("stratimikos"));
  return document;
}

}  // namespace lockstep
