#pragma once

namespace lockstep {

/// Number and length [s] of the sub-steps that average the elastic forces of a step.
struct SubSteps {
  int n = 1;
  double length = 0;

  /// Weight of the forces at the k-th place of the path [1]; all weights add up to one.
  double weight(int k) const;
};

/// The longest step [s] that up to `most` sub-steps make stable where one alone is stable up to
/// `stable` [s].
double longest_sub_stepped(double stable, int most);

/// The fewest for a step of `dt`, at most `most`: stable ones that cover 2 dt. See
/// `DeformableSolids::average_forces`.
SubSteps sub_steps_for(double dt, double stable, int most);

}  // namespace lockstep
