#pragma once
#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/momentum.hpp"

namespace lockstep {

/// The momentum audit of a step (docs/method.md): opened with the momentum of fluid, lumped fluid
/// and solids, it collects every impulse from where it acts, and at the end says how well they
/// balance. The masses of the step are frozen between `open` and `close`.
template <int dim>
class MomentumLedger {
 public:
  void open(const Momentum<dim>& total) {
    before_ = total;
    entries_.clear();
  }
  /// An external impulse (gravity, wall, prescribed solid, contact with a wall, ...).
  void add(const std::string& source, const Momentum<dim>& impulse) {
    entries_.emplace_back(source, impulse);
  }
  void close(const Momentum<dim>& total) { after_ = total; }

  Momentum<dim> total_impulse() const {
    Momentum<dim> total;
    for (const auto& entry : entries_)
      total += entry.second;
    return total;
  }
  Momentum<dim> impulse_of(const std::string& source) const {
    Momentum<dim> total;
    for (const auto& entry : entries_) {
      if (entry.first == source)
        total += entry.second;
    }
    return total;
  }
  /// By source, in the order in which they came.
  const std::vector<std::pair<std::string, Momentum<dim>>>& entries() const { return entries_; }
  const Momentum<dim>& before() const { return before_; }
  const Momentum<dim>& after() const { return after_; }

  /// |P_after - P_before - sum J| / max(sum |J|, |P|); 0 if nothing moves. Where all momentum
  /// cancels (a vortex, a spinning bar) neither is a scale: `momentum_scale` [kg m/s], a bound of
  /// what moves regardless of direction, is the least that the defect is measured against.
  double linear_error(double momentum_scale = 0) const {
    double scale = std::max({before_.linear.norm(), after_.linear.norm(), momentum_scale});
    double impulses = 0;
    for (const auto& entry : entries_)
      impulses += entry.second.linear.norm();
    scale = std::max(scale, impulses);
    const double defect = (after_.linear - before_.linear - total_impulse().linear).norm();
    return scale > 0 ? defect / scale : 0;
  }
  /// Relative defect of the angular momentum about the origin; `length` [m] turns linear into
  /// angular scales, so that a motion without rotation is judged against the size of the domain.
  double angular_error(double length, double momentum_scale = 0) const {
    double scale = length * std::max({before_.linear.norm(), after_.linear.norm(), momentum_scale});
    double impulses = 0;
    for (const auto& entry : entries_) {
      impulses += std::max(entry.second.angular.norm(), length * entry.second.linear.norm());
    }
    scale = std::max({scale, impulses, before_.angular.norm(), after_.angular.norm()});
    const double defect = (after_.angular - before_.angular - total_impulse().angular).norm();
    return scale > 0 ? defect / scale : 0;
  }

 private:
  Momentum<dim> before_, after_;
  std::vector<std::pair<std::string, Momentum<dim>>> entries_;
};

}  // namespace lockstep
