#include "parameters/field_formula.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/errors.hpp"
#include "parameters/expression.hpp"
#include "parameters/formula.hpp"

namespace lockstep {

template <int dim>
struct FieldFormula<dim>::Parsed {
  Variables variables;
  std::vector<double*> values;  ///< addresses of x, y, z and t
  std::unique_ptr<Expression> expression;

  Parsed(const std::string& formula, const std::string& where) {
    for (const std::string& name : place_and_time(dim))
      values.push_back(&variables[name]);
    expression = std::make_unique<Expression>(formula, variables, where);
  }
};

template <int dim>
FieldFormula<dim>::FieldFormula(const ParameterList& list, const std::string& name,
                                const std::string& where) {
  std::vector<std::string> formulas;
  if (list.isType<double>(name))
    *this = FieldFormula({list.get<double>(name)});
  else if (list.isType<ParameterArray<double>>(name))
    *this = FieldFormula(list.get<ParameterArray<double>>(name).toVector());
  else if (list.isType<std::string>(name))
    formulas = {list.get<std::string>(name)};
  else
    formulas = list.get<ParameterArray<std::string>>(name).toVector();
  const std::string subject = fmt::format("In \"{}\", \"{}\"", where, name);
  for (const std::string& formula : formulas) {
    // Without x, y, z and t it is a number, of which much is simpler.
    const std::vector<std::string> used = names_in(formula), variables = place_and_time(dim);
    const bool varies = std::find_first_of(used.begin(), used.end(), variables.begin(),
                                           variables.end()) != used.end();
    if (varies)
      components_.push_back({0, std::make_shared<Parsed>(formula, subject)});
    else
      components_.push_back({evaluate(formula, {}, subject), nullptr});
  }
}

template <int dim>
FieldFormula<dim>::FieldFormula(const std::vector<double>& numbers) {
  for (const double number : numbers)
    components_.push_back({number, nullptr});
}

template <int dim>
bool FieldFormula<dim>::are_numbers() const {
  return std::none_of(components_.begin(), components_.end(),
                      [](const Component& c) { return c.formula != nullptr; });
}

template <int dim>
bool FieldFormula<dim>::vanishes() const {
  return std::none_of(components_.begin(), components_.end(),
                      [](const Component& c) { return c.formula || c.number != 0; });
}

template <int dim>
double FieldFormula<dim>::operator()(int component, const Point<dim>& x, double time) const {
  const Component& own = components_[component];
  if (!own.formula)
    return own.number;
  for (int a = 0; a < dim; ++a)
    *own.formula->values[a] = x[a];
  *own.formula->values[dim] = time;
  try {
    return own.formula->expression->value();
  } catch (const InputError& error) {
    throw InputError(fmt::format("{} It is so at x = {} m, t = {:g} s.", error.what(),
                                 fmt::join(x.begin(), x.end(), ", "), time));
  }
}

template <int dim>
Point<dim> FieldFormula<dim>::vector(const Point<dim>& x, double time) const {
  Point<dim> result;
  for (int a = 0; a < dim; ++a)
    result[a] = (*this)(a, x, time);
  return result;
}

template <int dim>
double FieldFormula<dim>::mean(int component, const Box<dim>& box, double time) const {
  if (is_number(component))
    return components_[component].number;
  static const std::array<double, 3> nodes = {-std::sqrt(0.6), 0, std::sqrt(0.6)};
  static const std::array<double, 3> weights = {5. / 18, 8. / 18, 5. / 18};
  double sum = 0;
  const int n_points = dim == 2 ? 9 : 27;
  for (int point = 0; point < n_points; ++point) {
    Point<dim> x = box.center();
    double weight = 1;
    bool is_needed = true;
    for (int a = 0, rest = point; a < dim; ++a, rest /= 3) {
      const double width = box.sizes()[a];
      is_needed = is_needed && (width > 0 || rest % 3 == 1);
      x[a] += 0.5 * width * nodes[rest % 3];
      weight *= width > 0 ? weights[rest % 3] : 1;
    }
    if (is_needed)
      sum += weight * (*this)(component, x, time);
  }
  return sum;
}

template class FieldFormula<2>;
template class FieldFormula<3>;

}  // namespace lockstep
