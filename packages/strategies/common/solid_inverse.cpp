#include "strategies/common/solid_inverse.hpp"

#include <algorithm>
#include <utility>

#include "linear/exact_inverse.hpp"
#include "linear/preconditioner.hpp"
#include "linear/single_precision.hpp"
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
  iterated_ = exact_ = approximate_ = preconditioner_ = rounded_ = Teuchos::null;
  split_.reset();
}

int SolidInverse::take_iterations() {
  return static_cast<int>(std::exchange(*iterations_, 0));
}

RCP<const LinearOperator> SolidInverse::to(double tolerance) const {
  if (!iterates_)
    return exact_;
  const auto iteration = conjugate_gradient_inverse(
      iterated_, {preconditioner_, rounded_, std::max(tolerance, round_off), most_iterations, name_,
                  iterations_});
  return split_ ? split_->with(iteration) : iteration;
}

void SolidInverse::build(const BlockSystem& system) {
  name_ = "solid block of the " + system.name;
  if (type_ == "Automatic" || type_ == "Exact")
    build_automatic(system);
  else
    build_named(system);
  if (iterates_)
    exact_ = to(round_off);
  if (approximate_.is_null())
    approximate_ = exact_;
}

void SolidInverse::build_automatic(const BlockSystem& system) {
  split_.emplace(system.solid_block, name_);
  iterates_ = !split_->is_complete();
  if (!iterates_) {
    exact_ = split_->with(Teuchos::null);
    return;
  }
  iterated_ = split_->rest();
  const auto matrix = assembled(iterated_);
  if (matrix.is_null())
    return;
  const NearNullSpace motions = split_->of_rest(system.near_null_space);
  ParameterList chosen;
  chosen.set("Type", is_stiff(*matrix, motions) ? "MueLu" : "Jacobi");
  preconditioner_ = preconditioner_from_list(iterated_, chosen, name_, motions);
  if (!motions.empty())
    rounded_ = single_precision_copy(matrix, motions.n_axes());
  if (type_ == "Automatic")
    approximate_ = split_->with(preconditioner_);
}

void SolidInverse::build_named(const BlockSystem& system) {
  iterated_ = system.solid_block;
  approximate_ = preconditioner_from_list(iterated_, list_, name_, system.near_null_space);
  iterates_ = type_ != "Direct";
  if (!iterates_)
    exact_ = approximate_;
  else
    preconditioner_ = type_ == "Conjugate Gradients"
                          ? preconditioner_from_list(iterated_, of_inner_iteration(list_), name_,
                                                     system.near_null_space)
                          : approximate_;
}

}  // namespace lockstep
