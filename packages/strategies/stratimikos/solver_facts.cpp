#include "strategies/stratimikos/solver_facts.hpp"

#include <initializer_list>
#include <set>

#include "base/errors.hpp"

namespace lockstep {

namespace {

using Teuchos::ParameterList;

/// A sublist of sublists; an empty one where there is none.
ParameterList sublist_of(const ParameterList& list, std::initializer_list<const char*> path) {
  const ParameterList* at = &list;
  for (const char* name : path) {
    if (!at->isSublist(name))
      return ParameterList();
    at = &at->sublist(name);
  }
  return *at;
}

std::string text_of(const ParameterList& list, const std::string& name) {
  return list.isType<std::string>(name) ? list.get<std::string>(name) : "";
}

/// The factory of an inverse; a name that is not in the library is that of a type itself.
std::string type_of(const ParameterList& library, const std::string& name) {
  return library.isSublist(name) ? text_of(library.sublist(name), "Type") : name;
}

bool multiplies_blocks(const std::string& type) {
  return type.rfind("NS ", 0) == 0 || type == "Block LU2x2" || type == "Block Multiply";
}

/// The first of some parameters that a factory's list has, or the list of its strategy.
std::string first_of(const ParameterList& factory, std::initializer_list<const char*> names) {
  const ParameterList settings = sublist_of(factory, {"Strategy Settings"});
  for (const char* name : names) {
    for (const ParameterList* list : {&factory, &settings}) {
      if (const std::string text = text_of(*list, name); !text.empty())
        return text;
    }
  }
  return "";
}

/// The inverse of A that a block factory names; empty if it names none.
std::string next_towards_pressure(const std::string& type, const ParameterList& factory) {
  if (type == "SPD Block Diagonal")
    return text_of(factory, "Fluid Inverse Type");
  if (type == "Block Jacobi" || type == "Block Gauss-Seidel")
    return first_of(factory, {"Inverse Type 1", "Inverse Type"});
  if (type == "Block LU2x2")
    return first_of(factory, {"Inverse A00 Type", "Inverse Type"});
  if (type.rfind("NS ", 0) == 0)
    return first_of(factory, {"Inverse Velocity Type", "Inverse Type"});
  if (type == "Lockstep Schur")
    return text_of(factory, "Inverse Type");
  return "";
}

/// True if a type of Teko is an inverse of all blocks and not of one.
bool is_of_all_blocks(const std::string& type) {
  return type == "SPD Block Diagonal" || type.rfind("Block ", 0) == 0 || type.rfind("NS ", 0) == 0;
}

/// The inverse of A that the inverse of the whole leads to. Empty where that cannot be told: the
/// whole is no factory of blocks, or one that names no inverse of A.
std::string pressure_inverse_of(const ParameterList& library, const std::string& of_the_whole) {
  std::string name = of_the_whole;
  for (int depth = 0; depth <= library.numParams() + 1; ++depth) {
    const std::string type = type_of(library, name);
    const std::string next =
        library.isSublist(name) ? next_towards_pressure(type, library.sublist(name)) : "";
    if (next.empty())
      return depth == 0 || is_of_all_blocks(type) ? "" : name;
    name = next;
  }
  throw InputError(fmt::format(
      "Teko's \"Inverse Factory Library\": the inverse \"{}\" refers to itself.", of_the_whole));
}

/// The entries of the library that an inverse leads to.
void collect(const ParameterList& library, const std::string& name, std::set<std::string>& used) {
  if (!library.isSublist(name) || !used.insert(name).second)
    return;
  const auto collect_in = [&](const ParameterList& list) {
    for (const auto& entry : list) {
      if (entry.second.isType<std::string>() && entry.first != "Type")
        collect(library, Teuchos::getValue<std::string>(entry.second), used);
    }
  };
  collect_in(library.sublist(name));
  collect_in(sublist_of(library.sublist(name), {"Strategy Settings"}));
}

void read_library(const ParameterList& library, SolverFacts& facts) {
  std::set<std::string> used;
  collect(library, facts.inverse, used);
  facts.wants_explicit_blocks = multiplies_blocks(facts.inverse);
  for (const std::string& name : used) {
    const std::string type = type_of(library, name);
    facts.wants_explicit_blocks = facts.wants_explicit_blocks || multiplies_blocks(type);
    facts.wants_schur = facts.wants_schur || type == "Lockstep Schur";
    if (type != "Lockstep Multigrid")
      continue;
    check_input(!facts.multigrid,
                "Teko's \"Inverse Factory Library\" has two lists of type \"Lockstep Multigrid\", "
                "but A has one multigrid; name the same list in both places.");
    facts.multigrid = library.sublist(name);
  }
  facts.pressure_inverse = pressure_inverse_of(library, facts.inverse);
}

}  // namespace

SolverFacts solver_facts(const ParameterList& list) {
  SolverFacts facts;
  const std::string type = text_of(list, "Linear Solver Type");
  check_input(type == "Belos",
              "\"Linear Solver Type\" is \"{}\", but the strategy stratimikos takes \"Belos\"; a "
              "direct solve is the strategy direct.",
              type);
  const std::string preconditioner = text_of(list, "Preconditioner Type");
  if (preconditioner == "None" || preconditioner.empty())
    return facts;
  check_input(preconditioner == "Teko",
              "\"Preconditioner Type\" is \"{}\", but Eq. 16 consists of blocks: name \"Teko\", "
              "and \"{}\" in its \"Inverse Factory Library\", or \"None\".",
              preconditioner, preconditioner);
  const ParameterList teko = sublist_of(list, {"Preconditioner Types", "Teko"});
  facts.inverse = text_of(teko, "Inverse Type");
  check_input(!facts.inverse.empty(),
              "\"Preconditioner Types\", \"Teko\": the parameter \"Inverse Type\" (string) is "
              "missing; it names the inverse of the whole system.");
  read_library(sublist_of(teko, {"Inverse Factory Library"}), facts);
  return facts;
}

}  // namespace lockstep
