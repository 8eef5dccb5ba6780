#pragma once
#include <string>

#include "deformable/deformable_body.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Declares the named sublists "Pinned": regions that rest, follow a script, or are let go.
template <int dim>
void declare_pinned(ParameterList& body);

/// Sets `body.locked` and `body.holds` from its validated list, for nodes at these rest positions;
/// turns are about `origin` [m]. Throws InputError.
template <int dim>
void read_pinned(const ParameterList& list, const std::vector<Point<dim>>& rest,
                 const Point<dim>& origin, DeformableBody<dim>& body);

/// Declares the named sublists "Attachments": regions that rigid solids carry.
template <int dim>
void declare_attachments(ParameterList& body);

/// Sets `body.attached`; `body.locked` is set before. Throws InputError.
template <int dim>
void read_attachments(const ParameterList& list, const std::vector<Point<dim>>& rest,
                      DeformableBody<dim>& body);

}  // namespace lockstep
