#pragma once

namespace lockstep {

/// How many sub-steps of which length [s] average the elastic forces of a step.
struct SubSteps {
  int n = 1;
  double length = 0;
};

/// The longest step [s] that up to `most` sub-steps make stable where one alone is stable up to
/// `stable` [s].
double longest_sub_stepped(double stable, int most);

/// The fewest for a step of `dt`, at most `most`. See `DeformableSolids::averaged_forces`: the
/// average divides a stiffness m omega^2 until m (omega dt)^2 <= 2, if n sub-steps of length d have
/// n (n + 1) d^2 >= 2.5 dt^2 (2.5 instead of 2 for what the sub-steps' own errors add) and d is
/// stable.
SubSteps sub_steps_for(double dt, double stable, int most);

}  // namespace lockstep
