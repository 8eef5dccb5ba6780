#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "parameters/expression.hpp"

namespace lockstep {

/// Formulas of place and time, one for each component of a field: expressions in x, y, z [m] (2D:
/// x, y) and t [s] (see `Expression`). Copies share what was parsed; calls from several threads at
/// once are not safe.
template <int dim>
class FieldFormula {
 public:
  /// `where` names the formulas in messages. Throws InputError for bad syntax and unknown names.
  FieldFormula(const std::vector<std::string>& formulas, const std::string& where);

  int n_components() const;
  /// The value of a component at a place and time. Throws InputError if it is not finite. Local.
  double operator()(int component, const Point<dim>& x, double time) const;

 private:
  struct Parsed;
  std::shared_ptr<Parsed> parsed_;
};

}  // namespace lockstep
