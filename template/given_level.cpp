#include "given_level.hpp"

#include <cmath>

#include "output/checkpoint.hpp"

namespace lockstep {

GivenLevel::GivenLevel(const Options& options, const MacDomain<2>& domain)
    : options_(options),
      domain_(domain),
      level_(options.height),
      phi_(domain.grid.n_stored_cells(), 0) {}

void GivenLevel::draw(double level) {
  level_ = level;
  // Ghosts too: every rank knows all of it, so that nothing has to be exchanged.
  domain_.grid.for_each_stored_cell(
      [&](int cell) { phi_[cell] = domain_.grid.center(cell)[1] - level; });
}

void GivenLevel::initialise(const SignedDistance<2>&, const Surface&) {
  draw(options_.height);
}

void GivenLevel::advance(const InterfaceStep<2>& step) {
  draw(level_ + step.dt * options_.speed);
}

int GivenLevel::band(double largest_displacement) const {
  return static_cast<int>(std::ceil(largest_displacement)) + 4;
}

LiquidLedger GivenLevel::ledger() const {
  LiquidLedger ledger;
  ledger.volume =
      domain_.grid.n_cells()[0] * domain_.spacing() * (level_ - domain_.grid.lower()[1]);
  ledger.target = ledger.volume;
  ledger.n_components = 1;
  return ledger;
}

void GivenLevel::save(CheckpointWriter& checkpoint) const {
  checkpoint.file().write_attribute("fluid", "given_level", level_);
}

void GivenLevel::load(const CheckpointReader& checkpoint) {
  draw(checkpoint.file().read_attribute<double>("fluid", "given_level"));
}

}  // namespace lockstep
