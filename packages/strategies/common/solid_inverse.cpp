#include "strategies/common/solid_inverse.hpp"

#include <utility>

#include "linear/exact_inverse.hpp"
#include "linear/preconditioner.hpp"
#include "strategies/common/strategy_parameters.hpp"

namespace lockstep {

namespace {

constexpr double round_off = 1e-14;
constexpr int most_iterations = 20000;

bool is_own_type(const ParameterList& list) {
  return list.isType<std::string>("Type") && list.numParams() == 1 &&
         (list.get<std::string>("Type") == "Automatic" || list.get<std::string>("Type") == "Exact");
}

/// The list that names the preconditioner of an inner iteration.
ParameterList of_inner_iteration(const ParameterList& list) {
  if (list.get<std::string>("Type") != "Conjugate Gradients")
    return list;
  if (list.isSublist("Preconditioner"))
    return list.sublist("Preconditioner");
  ParameterList jacobi;
  jacobi.set("Type", "Jacobi");
  return jacobi;
}

}  // namespace

void declare_solid_inverse(ParameterList& list) {
  declare_inverse(list, "Solid Inverse",
                  "Approximate inverse of the solid block C. Default: Automatic, which is exact "
                  "where that is cheap, and else chosen by how far dt D outweighs the mass.");
}

SolidInverse::SolidInverse(const ParameterList& list) {
  if (!list.isSublist("Solid Inverse") || list.sublist("Solid Inverse").numParams() == 0)
    return;
  list_ = list.sublist("Solid Inverse");
  if (!is_own_type(list_))
    check_preconditioner_list(list_, "\"Solid Inverse\"");
  type_ = list_.get<std::string>("Type");
}

void SolidInverse::reset() {
  op_ = exact_ = approximate_ = preconditioner_ = Teuchos::null;
}

int SolidInverse::take_iterations() {
  return static_cast<int>(std::exchange(*iterations_, 0));
}

RCP<const LinearOperator> SolidInverse::iteration(double tolerance, int most) const {
  return conjugate_gradient_inverse(op_, {preconditioner_, tolerance, most, name_, iterations_});
}

RCP<const LinearOperator> SolidInverse::to(double tolerance) const {
  return iterates_ && tolerance > round_off ? iteration(tolerance, most_iterations) : exact_;
}

void SolidInverse::build(const BlockSystem& system) {
  op_ = system.solid_block;
  name_ = "solid block of the " + system.name;
  if (type_ == "Automatic" || type_ == "Exact")
    build_automatic(system, name_);
  else
    build_named(system, name_);
}

void SolidInverse::build_automatic(const BlockSystem& system, const std::string& name) {
  exact_ = cheap_exact_inverse(op_, name);
  iterates_ = exact_.is_null();
  if (iterates_) {
    ParameterList chosen;
    const auto matrix = assembled(op_);
    if (!matrix.is_null()) {
      chosen.set("Type", is_stiff(*matrix, system.near_null_space) ? "MueLu" : "Jacobi");
      preconditioner_ = preconditioner_from_list(op_, chosen, name, system.near_null_space);
    }
    exact_ = iteration(round_off, most_iterations);
  }
  const bool is_linear = type_ == "Automatic" && !preconditioner_.is_null();
  approximate_ = iterates_ && is_linear ? preconditioner_ : exact_;
}

void SolidInverse::build_named(const BlockSystem& system, const std::string& name) {
  approximate_ = preconditioner_from_list(op_, list_, name, system.near_null_space);
  iterates_ = type_ != "Direct";
  if (!iterates_) {
    exact_ = approximate_;
    return;
  }
  preconditioner_ =
      type_ == "Conjugate Gradients"
          ? preconditioner_from_list(op_, of_inner_iteration(list_), name, system.near_null_space)
          : approximate_;
  exact_ = iteration(round_off, most_iterations);
}

}  // namespace lockstep
