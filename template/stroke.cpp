#include "stroke.hpp"

#include "base/errors.hpp"
#include "output/checkpoint.hpp"

namespace lockstep {

std::vector<std::vector<double>> Stroke::observe(const RunView<2>& run) {
  check_input(!run.solids.empty(), "The observer \"stroke\" needs a solid.");
  const SolidState<2>& solid = run.solids.front();
  if (!started_)
    start_ = solid.center_of_mass[0];
  started_ = true;
  return {{solid.center_of_mass[0] - start_, solid.kinetic_energy}};
}

void Stroke::save(CheckpointWriter& checkpoint) const {
  checkpoint.file().write_attribute("/", "stroke start", start_);
}

void Stroke::load(const CheckpointReader& checkpoint) {
  start_ = checkpoint.file().read_attribute<double>("/", "stroke start");
  started_ = true;
}

}  // namespace lockstep
