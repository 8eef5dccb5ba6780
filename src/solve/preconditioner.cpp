#include "solve/preconditioner.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <algorithm>
#include <limits>
#include <vector>

#include "base/errors.hpp"
#include "linear/action_operator.hpp"
#include "linear/block_diagonal.hpp"
#include "linear/matrix_rows.hpp"
#include "parameters/suggestion.hpp"
#include "solve/gathered_direct.hpp"
#include "solve/incomplete_cholesky.hpp"
#include "solve/soft/additive_multilevel.hpp"
#include "solve/soft/exact_inverse.hpp"
#include "solve/soft/inverse_by_cost.hpp"
#include "solve/soft/rigid_motion_multigrid.hpp"
#include "solve/solver_list.hpp"
#include "solve/stratimikos.hpp"

namespace lockstep {

namespace {

using Teuchos::ParameterList;

const std::vector<std::string> types = {"Ifpack2",
                                        "MueLu",
                                        "Incomplete Cholesky",
                                        "Direct",
                                        "Block Diagonal",
                                        "Block Diagonal Mass",
                                        "Jacobi",
                                        "Additive Multilevel",
                                        "Conjugate Gradients",
                                        "Exact"};

/// Beyond it a dense block takes 800 MB.
constexpr int most_dense_rows = 10000;
constexpr double least_tolerance = 1e-15, largest_tolerance = 0.5;

bool is_package(const std::string& type) {
  return type == "Ifpack2" || type == "MueLu";
}

std::string type_of(const ParameterList& list, const std::string& where,
                    const std::vector<std::string>& offered = types) {
  check_input(list.isType<std::string>("Type"),
              "{}: the parameter \"Type\" (string) is missing; it is one of {}.", where,
              fmt::join(offered, ", "));
  return list.get<std::string>("Type");
}

ParameterList default_muelu() {
  ParameterList list;
  list.set("verbosity", "none");
  list.set("multigrid algorithm", "sa");
  list.set("smoother: type", "CHEBYSHEV");
  ParameterList& smoother = list.sublist("smoother: params");
  smoother.set("chebyshev: degree", 2);
  // A largest eigenvalue that the power method has not reached yet makes the smoother indefinite:
  // on 7 x 16 x 9 periodic cells Ifpack2's 10 iterations do not suffice, nor do 20; 30 do.
  smoother.set("chebyshev: eigenvalue max iterations", 50);
  list.set("coarse: max size", 100);
  list.set("coarse: type", "RELAXATION");
  ParameterList& coarse = list.sublist("coarse: params");
  coarse.set("relaxation: type", "Symmetric Gauss-Seidel");
  coarse.set("relaxation: sweeps", 8);
  return list;
}

ParameterList without_type(const ParameterList& list) {
  ParameterList rest(list);
  rest.remove("Type");
  return rest;
}

/// The value of an optional parameter of our own lists, which the caller has checked.
template <typename T>
T value_or(const ParameterList& list, const std::string& name, T standard) {
  return list.isParameter(name) ? list.get<T>(name) : standard;
}

RCP<const LinearOperator> inner_iteration(const RCP<const LinearOperator>& op,
                                          const ParameterList& list, const std::string& name,
                                          const NearNullSpace& near_null_space) {
  const double tolerance = value_or(list, "Tolerance", 1e-10);
  const int most = value_or(list, "Maximum Iterations", 1000);
  if (!list.isSublist("Preconditioner"))
    return conjugate_gradient_inverse(op, tolerance, most, name);
  const auto inner =
      preconditioner_from_list(op, list.sublist("Preconditioner"), name, near_null_space);
  return conjugate_gradient_inverse(op, {inner, Teuchos::null, tolerance, most, name, nullptr});
}

/// A parameter of our own lists: its type, and what it may be.
struct OwnParameter {
  std::string of, name;
  bool is_int;
  double lower, upper;
};

const std::vector<OwnParameter>& own_parameters() {
  static const std::vector<OwnParameter> all = {
      {"Block Diagonal", "Largest Block", true, 1, most_dense_rows},
      {"Conjugate Gradients", "Tolerance", false, least_tolerance, largest_tolerance},
      {"Conjugate Gradients", "Maximum Iterations", true, 1, std::numeric_limits<int>::max()}};
  return all;
}

void check_own(const ParameterList& list, const std::string& type, const std::string& where) {
  for (const auto& entry : list) {
    const std::string& name = entry.first;
    if (type == "Conjugate Gradients" && name == "Preconditioner" && entry.second.isList()) {
      check_preconditioner_list(list.sublist(name), where + ", \"Preconditioner\"");
      continue;
    }
    const auto own = std::find_if(
        own_parameters().begin(), own_parameters().end(), [&](const OwnParameter& one) {
          return one.of == type && one.name == name &&
                 (one.is_int ? entry.second.isType<int>() : entry.second.isType<double>());
        });
    const bool is_own = own != own_parameters().end();
    check_input(is_own || name == "Type",
                "{}: \"{}\" is not a parameter of type \"{}\", or not of the right type. {}", where,
                name, type,
                type == "Block Diagonal" ? "It takes \"Largest Block\" (int)."
                : type == "Conjugate Gradients"
                    ? "It takes \"Tolerance\" (double), \"Maximum Iterations\" (int) and the list "
                      "\"Preconditioner\"."
                    : "It takes none.");
    if (!is_own)
      continue;
    const double value = own->is_int ? list.get<int>(name) : list.get<double>(name);
    check_input(value >= own->lower && value <= own->upper,
                "{}: \"{}\" is {:g}, but must be between {:g} and {:g}.", where, name, value,
                own->lower, own->upper);
  }
}

}  // namespace

void check_preconditioner_list(const ParameterList& list, const std::string& where,
                               const std::vector<std::string>& others) {
  std::vector<std::string> offered = others;
  offered.insert(offered.end(), types.begin(), types.end());
  const std::string type = type_of(list, where, offered);
  const std::string nearest = nearest_name(type, offered);
  check_input(std::find(types.begin(), types.end(), type) != types.end(),
              "{}: there is no inverse of type \"{}\".{} There are: {}.", where, type,
              nearest.empty() ? "" : fmt::format(" Did you mean \"{}\"?", nearest),
              fmt::join(offered, ", "));
  check_input(type != "Ifpack2" || list.isType<std::string>("Prec Type"),
              "{}: type \"Ifpack2\" needs the parameter \"Prec Type\" (string), one of its "
              "preconditioners; \"Incomplete Cholesky\" needs none.",
              where);
  if (is_package(type) && list.numParams() > 1)
    check_package_list(type, without_type(list), where);
  else
    check_own(list, type, where);
}

RCP<const LinearOperator> preconditioner_from_list(const RCP<const LinearOperator>& op,
                                                   const ParameterList& list,
                                                   const std::string& name,
                                                   const NearNullSpace& near_null_space) {
  check_preconditioner_list(list, "the inverse of the " + name);
  const std::string type = type_of(list, name);
  if (type == "Exact")
    return exact_inverse(op, name);
  if (type == "Conjugate Gradients")
    return inner_iteration(op, list, name, near_null_space);
  const auto matrix = assembled(op);
  check_solve(
      !matrix.is_null(),
      "The inverse \"{}\" of the {} needs an assembled matrix, but the block is matrix-free. "
      "Use \"Conjugate Gradients\", or a discretization that assembles it.",
      type, name);
  if (type == "Direct")
    return gathered_direct(matrix, name);
  if (type == "Incomplete Cholesky")
    return incomplete_cholesky_inverse(matrix, name);
  if (type == "Jacobi")
    return as_operator(jacobi_inverse(*matrix, name));
  if (type == "Additive Multilevel")
    return additive_multilevel_inverse(matrix, near_null_space, name);
  if (type == "Block Diagonal")
    return as_operator(
        block_diagonal_inverse(matrix, value_or(list, "Largest Block", largest_dense_block), name)
            .inverse);
  if (type == "Block Diagonal Mass")
    return block_diagonal_mass_inverse(matrix, near_null_space, name);
  ParameterList package = without_type(list);
  if (type == "MueLu" && package.numParams() == 0)
    package = default_muelu();
  if (type == "MueLu" && !near_null_space.empty())
    return rigid_motion_multigrid(matrix, near_null_space, package, name);
  const auto inverse = stratimikos_preconditioner(as_operator(matrix), type, package, name);
  if (type != "MueLu")
    return inverse;
  // MueLu's operator ignores the factors of y = alpha M x + beta y.
  return action_operator(domain_map(*op),
                         [inverse](const Vector& x, Vector& y) { apply(*inverse, x, y); });
}

void declare_inverse(ParameterList& list, const std::string& name, const std::string& doc) {
  declare_free_sublist(
      list, name,
      doc +
          " \"Type\" is Ifpack2 or MueLu (the other parameters go to that package unchanged), "
          "Incomplete Cholesky, Direct, Block Diagonal, Block Diagonal Mass, Jacobi, Additive "
          "Multilevel, Conjugate Gradients or Exact.");
}

ParameterList inverse_list(const ParameterList& list, const std::string& name,
                           const ParameterList& standard, const std::vector<std::string>& others) {
  if (!list.isSublist(name) || list.sublist(name).numParams() == 0)
    return standard;
  check_preconditioner_list(list.sublist(name), "\"" + name + "\"", others);
  return list.sublist(name);
}

RCP<const LinearOperator> inverse_if_stiff(const RCP<const LinearOperator>& op,
                                           const NearNullSpace& near_null_space,
                                           const std::string& name) {
  const auto matrix = assembled(op);
  if (matrix.is_null() || !is_stiff(stiffness_number(*matrix, near_null_space)))
    return Teuchos::null;
  ParameterList list;
  list.set("Type", "MueLu");
  return InverseByCost(op, near_null_space, name).with([&](const InverseByCost::Rest& rest) {
    return preconditioner_from_list(rest.op, list, name, rest.motions);
  });
}

}  // namespace lockstep
