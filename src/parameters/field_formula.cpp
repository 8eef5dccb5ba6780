#include "parameters/field_formula.hpp"

namespace lockstep {

template <int dim>
struct FieldFormula<dim>::Parsed {
  Variables variables;
  std::vector<double*> place;  ///< addresses of x, y, z
  double* time = nullptr;
  std::vector<Expression> expressions;
};

template <int dim>
FieldFormula<dim>::FieldFormula(const std::vector<std::string>& formulas, const std::string& where)
    : parsed_(std::make_shared<Parsed>()) {
  for (const char* name : {"x", "y", "z"}) {
    if (static_cast<int>(parsed_->place.size()) < dim)
      parsed_->place.push_back(&parsed_->variables[name]);
  }
  parsed_->time = &parsed_->variables["t"];
  for (const std::string& formula : formulas)
    parsed_->expressions.emplace_back(formula, parsed_->variables, where);
}

template <int dim>
int FieldFormula<dim>::n_components() const {
  return static_cast<int>(parsed_->expressions.size());
}

template <int dim>
double FieldFormula<dim>::operator()(int component, const Point<dim>& x, double time) const {
  for (int a = 0; a < dim; ++a)
    *parsed_->place[a] = x[a];
  *parsed_->time = time;
  return parsed_->expressions[component].value();
}

template class FieldFormula<2>;
template class FieldFormula<3>;

}  // namespace lockstep
