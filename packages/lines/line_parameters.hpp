#pragma once
#include <string>

#include "lines/lines.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Everything that solids of the types "spring", "rope" and "mooring line" may say, without "Type".
template <int dim>
ParameterList spring_parameters();
template <int dim>
ParameterList rope_parameters();
template <int dim>
ParameterList mooring_line_parameters();

/// A spring from its validated list. Throws InputError.
template <int dim>
Line<dim> read_spring(const std::string& name, const ParameterList& list);
/// A rope likewise: a spring that does nothing while it is shorter than at rest.
template <int dim>
Line<dim> read_rope(const std::string& name, const ParameterList& list);
/// A mooring line likewise; `gravity` [m/s^2] must not be zero.
template <int dim>
Line<dim> read_mooring_line(const std::string& name, const ParameterList& list,
                            const Point<dim>& gravity);

}  // namespace lockstep
