#pragma once
#include <memory>

#include "conformance/violations.hpp"
#include "interfaces/fluid.hpp"

namespace lockstep {

/// Holds a fluid against what FluidDiscretization promises, at the geometry that it is given here:
/// run it without surfaces and with one that cuts the domain. The fluid should be in motion; its
/// velocity is another one afterwards. Collective; every rank gets the same sentences.
template <int dim>
Violations check_fluid(FluidDiscretization<dim>& fluid,
                       const std::shared_ptr<const SurfaceSnapshot<dim>>& surface,
                       const OpenFractionRule<dim>& rule);

}  // namespace lockstep
