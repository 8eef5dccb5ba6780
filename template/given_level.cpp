#include "given_level.hpp"

#include <algorithm>
#include <cmath>

#include "output/checkpoint.hpp"

namespace lockstep {

namespace {
/// Cells around the surface in which phi is known; farther ones have the sign alone.
constexpr int known = 6;
}  // namespace

GivenLevel::GivenLevel(const Options& options, const MacDomain<2>& domain)
    : options_(options), domain_(domain), phi_(domain.grid.n_stored_cells(), 0) {}

void GivenLevel::draw(double time) {
  time_ = time;
  const double level = options_.height + options_.speed * time;
  const double cut_off = known * domain_.spacing();
  // Ghosts too: every rank knows all of it, so that nothing has to be exchanged.
  domain_.grid.for_each_stored_cell([&](int cell) {
    phi_[cell] = std::clamp(domain_.grid.center(cell)[1] - level, -cut_off, cut_off);
  });
}

void GivenLevel::initialise(const SignedDistance<2>&, const Surface&) {
  draw(0);
}

void GivenLevel::advance(const InterfaceStep<2>& step) {
  draw(step.time + step.dt);
}

int GivenLevel::band(double largest_displacement) const {
  return std::max(known, static_cast<int>(std::ceil(largest_displacement)) + 4);
}

LiquidLedger GivenLevel::ledger() const {
  LiquidLedger ledger;
  const double level = options_.height + options_.speed * time_;
  ledger.volume = domain_.grid.n_cells()[0] * domain_.spacing() * (level - domain_.grid.lower()[1]);
  ledger.target = ledger.volume;
  ledger.n_components = 1;
  return ledger;
}

void GivenLevel::save(CheckpointWriter& checkpoint) const {
  checkpoint.file().write_attribute("fluid", "given_level_time", time_);
}

void GivenLevel::load(const CheckpointReader& checkpoint) {
  draw(checkpoint.file().read_attribute<double>("fluid", "given_level_time"));
}

std::function<void()> GivenLevel::undo() {
  return [this, time = time_] { draw(time); };
}

}  // namespace lockstep
