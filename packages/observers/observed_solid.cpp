#include "observers/observed_solid.hpp"

#include "base/errors.hpp"
#include "parameters/suggestion.hpp"

namespace lockstep {

template <int dim>
ObservedSolid<dim> observed_solid(const RunView<dim>& run, const std::string& name,
                                  const std::string& observer) {
  std::vector<std::string> names;
  int index = 0, n_simplices = 0;
  for (const SolidModel<dim>* model : run.models) {
    int number = 0;
    for (const SolidDescription& solid : model->solids()) {
      if (solid.name == name)
        return {model, &solid, number, index, n_simplices + solid.simplex_begin};
      names.push_back(solid.name);
      ++number;
      ++index;
    }
    n_simplices += static_cast<int>(model->surface().simplices.size());
  }
  const std::string nearest = nearest_name(name, names);
  throw InputError(fmt::format(
      "\"{}\" follows the solid \"{}\", but there is none; {}", observer, name,
      nearest.empty() ? "name one of \"Solids\"." : "did you mean \"" + nearest + "\"?"));
}

template ObservedSolid<2> observed_solid(const RunView<2>&, const std::string&, const std::string&);
template ObservedSolid<3> observed_solid(const RunView<3>&, const std::string&, const std::string&);

}  // namespace lockstep
