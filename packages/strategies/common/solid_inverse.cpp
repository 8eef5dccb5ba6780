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

/// For inner iterations, where a cheap step counts: on a ball of 8 200 nodes "Additive Multilevel"
/// takes half the time of MueLu at a stiffness number of 800, and .8 of it at 8000; below 20 its
/// coarse levels save less than they cost.
std::string inner_type(double stiffness_number) {
  if (stiffness_number <= 20)
    return "Jacobi";
  return stiffness_number <= 5000 ? "Additive Multilevel" : "MueLu";
}

ParameterList list_of(const std::string& type) {
  ParameterList list;
  list.set("Type", type);
  return list;
}

/// The list that names the preconditioner of an inner iteration.
ParameterList of_inner_iteration(const ParameterList& list) {
  if (list.get<std::string>("Type") != "Conjugate Gradients")
    return list;
  if (list.isSublist("Preconditioner"))
    return list.sublist("Preconditioner");
  return list_of("Jacobi");
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
  preconditioner_type_.clear();
  motions_ = {};
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
  reset();
  name_ = "solid block of the " + system.name;
  if (type_ == "Automatic" || type_ == "Exact")
    build_automatic(system);
  else
    build_named(system);
  if (iterates_)
    exact_ = to(round_off);
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
  motions_ = split_->of_rest(system.near_null_space);
  preconditioner_type_ = inner_type(stiffness_number(*matrix, motions_));
  preconditioner_ =
      preconditioner_from_list(iterated_, list_of(preconditioner_type_), name_, motions_);
  rounded_ = single_precision_copy(matrix, motions_);
}

/// In a preconditioner of the outer iteration it counts to be close to C.
const RCP<const LinearOperator>& SolidInverse::approximate() const {
  if (!approximate_.is_null() || exact_.is_null())
    return approximate_;
  if (type_ != "Automatic" || preconditioner_type_.empty()) {
    approximate_ = exact_;
    return approximate_;
  }
  const bool is_close =
      preconditioner_type_ == "MueLu" || !is_stiff(*assembled(iterated_), motions_);
  approximate_ = split_->with(
      is_close ? preconditioner_
               : preconditioner_from_list(iterated_, list_of("MueLu"), name_, motions_));
  return approximate_;
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
