#pragma once

namespace lockstep {

/// Forgets the peak of this process' resident memory; returns what is resident now [MB of 10^6
/// bytes].
double restart_peak_memory();

/// The peak since then [MB]; where the system cannot forget, the peak since the start.
double peak_memory_since_restart();

}  // namespace lockstep
