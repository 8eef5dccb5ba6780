#include "solve/solver_list.hpp"

#include <Ifpack2_Factory.hpp>
#include <Ifpack2_Parameters.hpp>
#include <Stratimikos_DefaultLinearSolverBuilder.hpp>
#include <Tpetra_Core.hpp>
#include <vector>

#include "base/errors.hpp"
#include "parameters/suggestion.hpp"
#include "parameters/teko_library.hpp"
#include "solve/stratimikos_registration.hpp"

namespace lockstep {

namespace {

using Teuchos::ParameterList;

std::vector<std::string> names_in(const ParameterList& list) {
  std::vector<std::string> names;
  for (const auto& entry : list) {
    names.push_back(entry.first);
  }
  return names;
}

[[noreturn]] void refuse(const std::string& name, const std::string& where,
                         const std::vector<std::string>& known) {
  const std::string nearest = nearest_name(name, known);
  throw InputError(fmt::format("\"{}\" is not a parameter of {}.{}", name, where,
                               nearest.empty()
                                   ? " Known are: " + fmt::format("{}", fmt::join(known, ", "))
                                   : fmt::format(" Did you mean \"{}\"?", nearest)));
}

void check_names(const ParameterList& list, const std::vector<std::string>& known,
                 const std::string& where) {
  for (const auto& entry : list) {
    if (std::find(known.begin(), known.end(), entry.first) == known.end())
      refuse(entry.first, where, known);
  }
}

void check_muelu(const ParameterList& list, const std::string& where) {
  if (list.isSublist("Factories") || list.isSublist("Hierarchy"))
    return;  // the factory interface, whose lists may have any name
  std::vector<std::string> known = names_in(*muelu_parameters());
  known.insert(known.end(), {"Type", "coarse: type", "coarse: params", "smoother: params"});
  for (const auto& entry : list) {
    if (entry.first.rfind("level ", 0) == 0)
      known.push_back(entry.first);
  }
  check_names(list, known, where);
  const std::string coarse =
      list.isType<std::string>("coarse: type") ? list.get<std::string>("coarse: type") : "KLU2";
  check_input(coarse.rfind("RELAX", 0) == 0 || coarse.rfind("CHEB", 0) == 0 ||
                  Tpetra::getDefaultComm()->getSize() == 1,
              "{}: the coarse solver {} of MueLu is wrong on several ranks with this Trilinos. Set "
              "\"coarse: type\" to RELAXATION with symmetric Gauss-Seidel sweeps.",
              where, coarse);
}

void check_ifpack2(const ParameterList& list, const std::string& where) {
  check_names(list, {"Type", "Prec Type", "Overlap", "Ifpack2 Settings", "VerboseObject"}, where);
  if (list.isParameter("Prec Type")) {
    const bool is_text = list.isType<std::string>("Prec Type");
    const std::string type = is_text ? list.get<std::string>("Prec Type") : "";
    check_input(
        is_text && Ifpack2::Factory::isSupported<Tpetra::RowMatrix<double, int, GlobalIndex>>(type),
        "{}: \"Prec Type\" is {}, which is no preconditioner of this Ifpack2; RELAXATION, "
        "CHEBYSHEV, RILUK, ILUT and BLOCK_RELAXATION are.",
        where, is_text ? "\"" + type + "\"" : "no string");
  }
  if (!list.isSublist("Ifpack2 Settings"))
    return;
  ParameterList known;
  Ifpack2::getValidParameters(known);
  check_names(list.sublist("Ifpack2 Settings"), names_in(known), where + ", \"Ifpack2 Settings\"");
}

/// Level by level, as deep as the packages declare their parameters.
void check_against(const ParameterList& list, const ParameterList& valid,
                   const std::string& where) {
  if (valid.numParams() == 0)
    return;
  check_names(list, names_in(valid), where);
  for (const auto& entry : list) {
    if (entry.second.isList() && valid.isSublist(entry.first) && entry.first != "Teko" &&
        entry.first != "MueLu" && entry.first != "Ifpack2")
      check_against(list.sublist(entry.first), valid.sublist(entry.first),
                    fmt::format("{}, \"{}\"", where, entry.first));
  }
}

constexpr const char* place = "Teko's \"Inverse Factory Library\"";

/// Other types of Stratimikos, "Belos" as inner solver.
void check_stratimikos_type(const ParameterList& list, const std::string& type,
                            const ParameterList& valid, const std::string& where) {
  for (const char* types : {"Linear Solver Types", "Preconditioner Types"}) {
    if (!valid.sublist(types).isSublist(type))
      continue;
    ParameterList without_type(list);
    without_type.remove("Type");
    without_type.remove("Preconditioner Type", false);
    check_against(without_type, valid.sublist(types).sublist(type), where);
  }
}

/// The factories' own parameters and references, then the lists of the packages that they name.
void check_library(const ParameterList& library, const ParameterList& valid) {
  check_teko_library(library, Source{place, {}}, "Inverse Factory Library",
                     {{"SPD Block Diagonal", {"Fluid Inverse Type", "Solid Inverse Type"}},
                      {"Lockstep Multigrid", {"Sweeps", "Cycle"}},
                      {"Lockstep Solid", {"Exact", "Inverse"}},
                      {"Lockstep Schur", {"Inverse Type", "Largest Solid", "Least Added Mass"}},
                      {"Incomplete Cholesky", {}}});
  for (const auto& entry : library) {
    const ParameterList& list = library.sublist(entry.first);
    const auto& type = list.get<std::string>("Type");
    const std::string where = fmt::format("{}, \"{}\"", place, entry.first);
    if (type == "MueLu" || type == "Ifpack2") {
      check_package_list(type, list, where);
      continue;
    }
    check_input(type.rfind("Amesos", 0) != 0 || Tpetra::getDefaultComm()->getSize() == 1,
                "{}: {} is wrong on several ranks with this Trilinos.", where, type);
    check_input(type != "NS LSC" || Tpetra::getDefaultComm()->getSize() == 1,
                "{}: {} ends the program on several ranks with this Trilinos. Use one rank, or "
                "\"NS SIMPLE\".",
                where, type);
    check_stratimikos_type(list, type, valid, where);
  }
}

}  // namespace

void check_package_list(const std::string& package, const ParameterList& list,
                        const std::string& where) {
  if (package == "MueLu")
    check_muelu(list, where);
  else
    check_ifpack2(list, where);
}

void check_solver_list(const ParameterList& list) {
  const auto valid = make_solver_builder()->getValidParameters();
  check_against(list, *valid, fmt::format("the solver list \"{}\"", list.name()));
  if (!list.isSublist("Preconditioner Types"))
    return;
  const ParameterList& types = list.sublist("Preconditioner Types");
  for (const char* package : {"MueLu", "Ifpack2"}) {
    if (types.isSublist(package))
      check_package_list(package, types.sublist(package), package);
  }
  if (!types.isSublist("Teko"))
    return;
  const ParameterList& teko = types.sublist("Teko");
  const ParameterList& valid_teko = valid->sublist("Preconditioner Types").sublist("Teko");
  check_names(teko, names_in(valid_teko), "the list \"Teko\"");
  if (!teko.isSublist("Inverse Factory Library"))
    return;
  const ParameterList& library = teko.sublist("Inverse Factory Library");
  check_library(library, *valid);
  if (!teko.isType<std::string>("Inverse Type"))
    return;
  const auto& name = teko.get<std::string>("Inverse Type");
  const auto known = names_in(library);
  const std::string nearest = nearest_name(name, known);
  check_input(std::find(known.begin(), known.end(), name) != known.end(),
              "The list \"Teko\": there is no inverse \"{}\" in the library.{}", name,
              nearest.empty() ? "" : fmt::format(" Did you mean \"{}\"?", nearest));
}

}  // namespace lockstep
