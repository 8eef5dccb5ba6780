#pragma once
#include <memory>
#include <string>
#include <vector>

#include "base/types.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Numbers or formulas of place and time, one for each component of a field: a formula is an
/// expression in x, y, z [m] (2D: x, y) and t [s] (see `Expression`). Copies share what was parsed;
/// calls from several threads at once are not safe.
template <int dim>
class FieldFormula {
 public:
  /// A field without components.
  FieldFormula() = default;
  /// The parameter `name` of a validated list: a number, an array of them, or strings in their
  /// place (`set_variables`). `where` names the list in messages. Throws InputError for bad syntax
  /// and unknown names.
  FieldFormula(const ParameterList& list, const std::string& name, const std::string& where);
  /// Numbers.
  explicit FieldFormula(const std::vector<double>& numbers);

  int n_components() const { return static_cast<int>(components_.size()); }
  /// True if a component is a number, the same everywhere and always.
  bool is_number(int component) const { return !components_[component].formula; }
  bool are_numbers() const;
  /// True if all components are the number 0.
  bool vanishes() const;
  /// The value of a component at a place and time. Throws InputError, which tells of them, if it is
  /// not finite. Local.
  double operator()(int component, const Point<dim>& x, double time) const;
  /// All components of a vector field.
  Point<dim> vector(const Point<dim>& x, double time) const;
  /// Mean over a box, of no width along some axes, by three Gauss points along each other axis:
  /// exact for what is of degree 5 there. Local.
  double mean(int component, const Box<dim>& box, double time) const;

 private:
  struct Parsed;
  struct Component {
    double number = 0;
    std::shared_ptr<Parsed> formula;
  };
  std::vector<Component> components_;
};

}  // namespace lockstep
