#pragma once
#include "interfaces/step_bound.hpp"

namespace lockstep {

/// Settings of the list "Time".
struct TimeOptions {
  double start = 0, end = 1;         ///< [s]
  double fixed_step = 0;             ///< [s]; 0: from the CFL number
  double cfl = 1, largest_step = 1;  ///< [1], [s]
  long long most_steps = 0;          ///< 0: no limit
};

/// Part of the run that `time` [s] is of its time, or `steps` of its steps, whichever is more [1].
double part_of_run(const TimeOptions& options, double time, long long steps);

/// The fixed step, made a little shorter so that steps of one length end at the end, if they get
/// there: the forces of a last one that is much shorter would be those of another step's errors.
/// 0 without a fixed step.
double even_step(const TimeOptions& time);

/// The fixed step; without one that in which nothing passes more than "CFL" cells, as the fluid
/// suggests (no reason is given then), at most the largest one.
StepBound wanted_step(const TimeOptions& time, double suggested);

/// The step to take at `now`, at most `wanted`, so that the last one ends at the end. Where steps
/// of that length do not, the last two share what is left: also fixed ones, of a run that went on
/// after it had been stopped, or some of which had to be shorter.
double step_to_end(const TimeOptions& time, double now, double wanted);

}  // namespace lockstep
