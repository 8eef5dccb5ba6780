#include "strategies/common/solid_inverse.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>
#include <utility>

#include "solve/preconditioner.hpp"
#include "solve/soft/exact_inverse.hpp"
#include "solve/soft/single_precision.hpp"
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
    check_preconditioner_list(list_, "\"Solid Inverse\"", {"Automatic"});
  type_ = list_.get<std::string>("Type");
}

void SolidInverse::reset() {
  exact_ = approximate_ = Teuchos::null;
  approximate_types_.clear();
  iterated_.clear();
  split_.reset();
}

int SolidInverse::take_iterations() {
  return static_cast<int>(std::exchange(*iterations_, 0));
}

RCP<const LinearOperator> SolidInverse::iteration(const Iterated& iterated,
                                                  double tolerance) const {
  return conjugate_gradient_inverse(
      iterated.op, {iterated.preconditioner, iterated.rounded, std::max(tolerance, round_off),
                    most_iterations, name_, iterations_});
}

RCP<const LinearOperator> SolidInverse::to(double tolerance) const {
  if (!iterates())
    return exact_;
  if (!split_)
    return iteration(iterated_.front(), tolerance);
  auto next = iterated_.begin();
  return split_->with([&](const auto&) { return iteration(*next++, tolerance); });
}

void SolidInverse::build(const BlockSystem& system) {
  reset();
  name_ = "solid block of the " + system.name;
  if (type_ == "Automatic" || type_ == "Exact")
    build_automatic(system);
  else
    build_named(system);
  if (iterates())
    exact_ = to(round_off);
}

SolidInverse::Iterated SolidInverse::prepared(const InverseByCost::Rest& rest) const {
  Iterated result{rest.op, Teuchos::null, Teuchos::null, "", rest.motions, rest.stiffness};
  const auto matrix = assembled(rest.op);
  if (matrix.is_null())
    return result;
  result.preconditioner_type = inner_type(rest.stiffness);
  result.preconditioner =
      preconditioner_from_list(rest.op, list_of(result.preconditioner_type), name_, rest.motions);
  result.rounded = single_precision_copy(matrix, rest.motions);
  return result;
}

void SolidInverse::build_automatic(const BlockSystem& system) {
  split_.emplace(system.solid_block(), system.near_null_space, name_, &costly_);
  for (const InverseByCost::Rest& rest : split_->rests())
    iterated_.push_back(prepared(rest));
  if (!iterates())
    exact_ = split_->with({});
}

std::string SolidInverse::description() const {
  if (!iterates())
    return "exact";
  if (type_ != "Automatic" && type_ != "Exact")
    return type_;
  if (!approximate_types_.empty())
    return fmt::format("{}", fmt::join(approximate_types_, ", "));
  std::set<std::string> types;
  for (const Iterated& part : iterated_)
    types.insert(part.preconditioner_type);
  types.erase("");  // matrix-free: no preconditioner
  const std::string text = fmt::format("{}", fmt::join(types, ", "));
  return "conjugate gradients" + (text.empty() ? "" : " with " + text);
}

/// Close to C, because an outer iteration is preconditioned with it: factors of sheets at any
/// stiffness.
RCP<const LinearOperator> SolidInverse::approximation(const Iterated& iterated,
                                                      const InverseByCost::Rest& rest) const {
  const RCP<const LinearOperator> factors = split_->cheap_factors(rest);
  if (!factors.is_null()) {
    approximate_types_.insert("exact");
    return factors;
  }
  const std::string type = is_stiff(iterated.stiffness) ? "MueLu" : iterated.preconditioner_type;
  approximate_types_.insert(type);
  return type == iterated.preconditioner_type
             ? iterated.preconditioner
             : preconditioner_from_list(iterated.op, list_of(type), name_, iterated.motions);
}

const RCP<const LinearOperator>& SolidInverse::approximate() const {
  if (!approximate_.is_null() || exact_.is_null())
    return approximate_;
  const bool is_matrix_free = iterates() && iterated_.front().preconditioner_type.empty();
  if (type_ != "Automatic" || !iterates() || is_matrix_free) {
    approximate_ = exact_;
    return approximate_;
  }
  auto next = iterated_.begin();
  approximate_ =
      split_->with([&](const InverseByCost::Rest& rest) { return approximation(*next++, rest); });
  return approximate_;
}

void SolidInverse::build_named(const BlockSystem& system) {
  const RCP<const LinearOperator>& c = system.solid_block();
  approximate_ = preconditioner_from_list(c, list_, name_, system.near_null_space);
  if (type_ == "Direct") {
    exact_ = approximate_;
    return;
  }
  const auto preconditioner =
      type_ == "Conjugate Gradients"
          ? preconditioner_from_list(c, of_inner_iteration(list_), name_, system.near_null_space)
          : approximate_;
  iterated_.push_back({c, preconditioner, Teuchos::null, "", {}, 1});
}

}  // namespace lockstep
