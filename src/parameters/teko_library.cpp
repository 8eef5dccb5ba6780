#include "parameters/teko_library.hpp"

#include <algorithm>

#include "base/errors.hpp"
#include "parameters/parameter_rule.hpp"
#include "parameters/strict_values.hpp"
#include "parameters/suggestion.hpp"

namespace lockstep {

namespace {

/// The factories of Teko 13.2 that suit a coupled system or one of its blocks.
const std::vector<TekoFactory>& known_factories() {
  static const std::vector<TekoFactory> factories = {
      {"Block Jacobi", {"Inverse Type", "Inverse Type #"}},
      {"Block Gauss-Seidel", {"Inverse Type", "Inverse Type #", "Use Upper Triangle"}},
      {"NS SIMPLE",
       {"Inverse Type", "Inverse Velocity Type", "Inverse Pressure Type",
        "Explicit Velocity Inverse Type", "Alpha", "Use Mass Scaling", "H options"}},
      {"Block LU2x2",
       {"Strategy Name", "Strategy Settings", "Use LDU", "Inverse Type", "Inverse A00 Type",
        "Inverse Schur Type", "Diagonal Type"}},
      {"NS LSC",
       {"Strategy Name", "Strategy Settings", "Is Symmetric", "Inverse Type",
        "Inverse Velocity Type", "Inverse Pressure Type", "Ignore Boundary Rows", "Use LDU",
        "Use Mass Scaling", "Use W-Scaling", "Eigen Solver Iterations", "Scaling Type",
        "Assume Stable Discretization"}},
      {"Diagonal Scaling", {"Inverse Factory", "Scaling Type", "Diagonal Type"}},
      {"Explicit Diagonal Preconditioner", {"Diagonal Type"}},
      {"Iterative Preconditioner", {"Preconditioner Type", "Iteration Count"}},
      {"Neumann Series", {"Number of Terms", "Scaling Type"}}};
  return factories;
}

/// Types whose parameters are checked by their owners or not at all.
const std::vector<std::string>& unchecked_types() {
  static const std::vector<std::string> types = {"Amesos",
                                                 "Amesos2",
                                                 "AztecOO",
                                                 "Belos",
                                                 "ML",
                                                 "Ifpack",
                                                 "Ifpack2",
                                                 "MueLu",
                                                 "Block Add",
                                                 "Block Multiply",
                                                 "Diagnostic Inverse",
                                                 "Identity",
                                                 "NS SIMPLE-Timed"};
  return types;
}

/// Values of "Explicit Velocity Inverse Type" besides the names of inverses.
const std::vector<std::string> diagonal_types = {"Diagonal", "Lumped", "AbsRowSum", "BlkDiag"};

/// "Inverse Type 3" -> "Inverse Type #".
std::string without_number(const std::string& name) {
  const std::size_t digits = name.find_last_not_of("0123456789");
  if (digits == std::string::npos || digits + 1 == name.size() || name[digits] != ' ')
    return name;
  return name.substr(0, digits + 1) + "#";
}

class LibraryCheck {
 public:
  LibraryCheck(const ParameterList& library, const Source& source, const std::string& path,
               const std::vector<TekoFactory>& own)
      : library_(library), source_(source), path_(path), factories_(known_factories()) {
    factories_.insert(factories_.end(), own.begin(), own.end());
    types_ = unchecked_types();
    for (const TekoFactory& factory : factories_)
      types_.push_back(factory.type);
    inverses_ = types_;
    for (const auto& [name, entry] : entries(library))
      inverses_.push_back(name);
  }

  void run() const {
    for (const auto& [name, entry] : entries(library_)) {
      if (!entry.isList())
        fail(path_, name, "is a parameter, but a factory is a list", {});
      check_factory(library_.sublist(name), join_path(path_, name));
    }
  }

 private:
  [[noreturn]] void fail(const std::string& list, const std::string& name, const std::string& what,
                         const std::vector<std::string>& valid,
                         const std::string& word = "") const {
    const std::string nearest = nearest_name(word.empty() ? name : word, valid);
    throw InputError(fmt::format(
        "{}: {}, \"{}\" {}.{}{}", source_.place(join_path(list, name)), in_list(list), name, what,
        nearest.empty() ? "" : fmt::format(" Did you mean \"{}\"?", nearest),
        valid.empty() ? "" : fmt::format("\nValid here: {}.", quoted_list(valid))));
  }

  void check_factory(const ParameterList& list, const std::string& path) const {
    check_input(list.isType<std::string>("Type"),
                "{}: {}, the parameter \"Type\" (string) is required; it names the factory.",
                source_.place(path), in_list(path));
    const std::string type = list.get<std::string>("Type");
    if (!contains(types_, type)) {
      fail(path, "Type", fmt::format("is \"{}\", which is no factory", type), types_, type);
    }
    for (const TekoFactory& factory : factories_) {
      if (factory.type == type)
        check_parameters(list, path, factory);
    }
  }

  void check_parameters(const ParameterList& list, const std::string& path,
                        const TekoFactory& factory) const {
    for (const auto& [name, entry] : entries(list)) {
      if (name == "Type")
        continue;
      const bool known =
          contains(factory.parameters, name) || contains(factory.parameters, without_number(name));
      if (!known) {
        fail(path, name, fmt::format("is not a parameter of \"{}\"", factory.type),
             factory.parameters);
      }
      if (entry.isType<std::string>())
        check_inverse(path, name, Teuchos::getValue<std::string>(entry));
      if (name == "Strategy Settings" && entry.isList())
        check_parameters(list.sublist(name), join_path(path, name), factory);
    }
  }

  void check_inverse(const std::string& path, const std::string& name,
                     const std::string& value) const {
    const bool names_inverse =
        name == "Inverse Factory" || name == "Preconditioner Type" ||
        (name.find("Inverse") != std::string::npos && name.find("Type") != std::string::npos);
    const bool diagonal =
        name == "Explicit Velocity Inverse Type" && contains(diagonal_types, value);
    if (!names_inverse || diagonal || contains(inverses_, value))
      return;
    fail(path, name, fmt::format("is \"{}\", which is neither in the library nor a type", value),
         inverses_, value);
  }

  const ParameterList& library_;
  const Source& source_;
  std::string path_;
  std::vector<TekoFactory> factories_;
  std::vector<std::string> types_, inverses_;
};

}  // namespace

void check_teko_library(const ParameterList& library, const Source& source, const std::string& path,
                        const std::vector<TekoFactory>& own) {
  LibraryCheck(library, source, path, own).run();
}

}  // namespace lockstep
