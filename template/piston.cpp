#include "piston.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "base/errors.hpp"
#include "linear/triplet_matrix.hpp"
#include "output/checkpoint.hpp"

using namespace lockstep;

Piston::Piston(const Options& options, const Communicator& comm)
    : options_(options), comm_(comm), position_(options.position) {
  SolidDescription plate;
  plate.name = "piston";
  plate.closed = false;  // a shell: fluid on both sides
  plate.simplex_end = 1;
  plate.vertex_end = 2;
  solids_ = {plate};
  surface_.simplices = {{0, 1}};
  place();
  map_ = make_map(is_root(comm) ? 1 : 0, comm);
  std::vector<Triplet> triplets;
  if (is_root(comm))
    triplets.push_back({0, 0, options.mass});
  mass_ = as_operator(assemble_triplets(std::move(triplets), map_, map_));
}

void Piston::place() {
  surface_.vertices = {{position_, 0}, {position_, options_.width}};
}

double Piston::only_entry(const Vector& vector) const {
  return sum_all(comm_, is_root(comm_) ? vector.getData()[0] : 0.);
}

void Piston::velocity_row(const SurfacePoint<2>&, const Point<2>&, VelocityRow<2>& row) const {
  row.dofs = {0};
  row.coefficients = {{1, 0}};
}

void Piston::explicit_momentum(double, double dt, Vector& momentum) const {
  if (is_root(comm_))
    momentum.replaceGlobalValue(0, options_.mass * velocity_ + dt * options_.force);
}

Momentum<2> Piston::external_impulse(double, double dt) const {
  Momentum<2> impulse;
  impulse.add(center(), 0, dt * options_.force);
  return impulse;
}

std::vector<Momentum<2>> Piston::momentum_of_each(const Vector& generalized_momentum) const {
  Momentum<2> momentum;
  momentum.add(center(), 0, only_entry(generalized_momentum));
  return {momentum};
}

RCP<const Vector> Piston::velocity() const {
  const auto result = make_vector(map_);
  result->putScalar(velocity_);
  return result;
}

void Piston::set_velocity(const Vector& velocity) {
  velocity_ = only_entry(velocity);
}

void Piston::move(const Vector& velocity, double, double dt) {
  last_velocity_ = only_entry(velocity);
  position_ += dt * last_velocity_;
  place();
}

std::vector<SolidState<2>> Piston::states() const {
  SolidState<2> state;
  state.name = solids_[0].name;
  state.center_of_mass = center();
  state.velocity = {velocity_, 0};
  state.mass = options_.mass;
  state.kinetic_energy = 0.5 * options_.mass * velocity_ * velocity_;
  return {state};
}

void Piston::set_state(const std::array<double, 3>& state) {
  position_ = state[0];
  velocity_ = state[1];
  last_velocity_ = state[2];
  place();
}

void Piston::save(CheckpointWriter& checkpoint) const {
  const auto now = state();
  checkpoint.file().create_group("piston");
  checkpoint.file().write_replicated("piston/state", std::vector<double>(now.begin(), now.end()));
}

void Piston::load(const CheckpointReader& checkpoint) {
  const auto values = checkpoint.file().read_all<double>("piston/state");
  check_input(values.size() == 3, "{}: the checkpoint's piston is incomplete; take another one.",
              checkpoint.file().path());
  set_state({values[0], values[1], values[2]});
}
