#include "column_fluid.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "linear/triplet_matrix.hpp"
#include "output/checkpoint.hpp"

using namespace lockstep;

ColumnFluid::ColumnFluid(const Options& options, const Communicator& comm)
    : options_(options), h_(options.length / options.n_cells), comm_(comm) {
  const int rank = comm->getRank(), size = comm->getSize(), n = options.n_cells;
  frozen_.pressure_map = make_map((rank + 1) * n / size - rank * n / size, comm);
  velocity_.assign(n + 1, 0);
  predicted_ = velocity_;
  coupled_at_.assign(n + 1, 0);
}

/// Face f lies between the cells f - 1 and f; at the open ends p = 0 on the face itself.
ControlVolume<2> ColumnFluid::control_volume(int face) const {
  ControlVolume<2> volume;
  volume.direction = 0;
  volume.center = {face * h_, options_.width / 2};
  volume.density = options_.density;
  volume.area = options_.width;
  volume.id = face;
  for (int side = 0; side < 2; ++side) {
    const int cell = face - 1 + side;
    const bool inside = cell >= 0 && cell < options_.n_cells;
    volume.sides[side].center = volume.center;
    if (inside) {
      volume.sides[side].kind = SideKind::unknown;
      volume.sides[side].unknown = cell;
      volume.sides[side].center.x() += (side - 0.5) * h_;
    }
  }
  volume.box = Box<2>(Point<2>(volume.sides[0].center.x(), 0),
                      Point<2>(volume.sides[1].center.x(), options_.width));
  return volume;
}

double ColumnFluid::mass(int face) const {
  return options_.density * control_volume(face).box.volume();
}

const FluidGeometry<2>& ColumnFluid::freeze(const Surface& surface,
                                            const OpenFractionRule<2>& rule) {
  const int n = options_.n_cells;
  PressureRegions& regions = frozen_.regions;
  std::vector<Triplet> triplets;
  std::vector<int> region_of_cell(n, 0);
  frozen_.coupled_volumes.clear();
  regions = PressureRegions();
  regions.n_regions = 1;
  for (int face = 0; face <= n; ++face) {
    // 1. Does the coupling take this control volume?
    ControlVolume<2> volume = control_volume(face);
    const auto hit = surface->first_hit(volume.sides[0].center, volume.sides[1].center);
    volume.open_fraction = rule.open_fraction(volume, hit.has_value(), *surface);
    coupled_at_[face] = volume.open_fraction < 1;
    const bool mine = frozen_.pressure_map->isNodeGlobalElement(std::max(0, face - 1));
    if (coupled_at_[face] && mine)
      frozen_.coupled_volumes.push_back(volume);
    // 2. Cells beyond it belong to another region.
    if (coupled_at_[face] && face > 0 && face < n)
      ++regions.n_regions;
    if (face < n)
      region_of_cell[face] = regions.n_regions - 1;
    // 3. Otherwise it adds area^2 / mass to A.
    if (coupled_at_[face] || !mine)
      continue;
    const double entry = volume.area * volume.area / mass(face);
    for (const auto& row : volume.sides) {
      for (const auto& column : volume.sides) {
        if (row.unknown != no_index && column.unknown != no_index)
          triplets.push_back(
              {row.unknown, column.unknown, row.unknown == column.unknown ? entry : -entry});
      }
    }
  }
  for (GlobalIndex cell : frozen_.pressure_map->getNodeElementList()) {
    triplets.push_back({cell, cell, 0});  // a cell between two coupled faces keeps its row
    regions.of_unknown.push_back(region_of_cell[cell]);
  }
  regions.has_dirichlet.assign(regions.n_regions, 0);
  if (is_free(0))
    regions.has_dirichlet.front() = 1;
  if (is_free(n))
    regions.has_dirichlet.back() = 1;
  const RCP<const Map> map = frozen_.pressure_map;
  frozen_.pressure_block = as_operator(assemble_triplets(std::move(triplets), map, map));
  frozen_.volume = options_.length * options_.width;
  return frozen_;
}

void ColumnFluid::divergence(Vector& rhs) const {
  for (GlobalIndex cell : frozen_.pressure_map->getNodeElementList()) {
    const double inflow = is_free(cell) ? predicted_[cell] : 0;
    const double outflow = is_free(cell + 1) ? predicted_[cell + 1] : 0;
    rhs.sumIntoGlobalValue(cell, options_.width * (inflow - outflow));
  }
}

void ColumnFluid::project(const Vector& scaled_pressure) {
  const auto mine = scaled_pressure.getData();
  const auto all = gather_all(comm_, std::vector<double>(mine.begin(), mine.end()));
  for (int face = 0; face <= options_.n_cells; ++face) {
    if (!is_free(face))
      continue;
    const double below = face > 0 ? all[face - 1] : 0;
    const double above = face < options_.n_cells ? all[face] : 0;
    predicted_[face] -= options_.width * (above - below) / mass(face);
  }
}

std::vector<double> ColumnFluid::coupled_velocity() const {
  std::vector<double> result;
  for (const auto& volume : frozen_.coupled_volumes)
    result.push_back(predicted_[volume.id]);
  return result;
}

void ColumnFluid::set_coupled_velocity(const std::vector<double>& velocity) {
  std::vector<GlobalIndex> faces;
  for (const auto& volume : frozen_.coupled_volumes)
    faces.push_back(volume.id);
  const auto all_faces = gather_all(comm_, faces);
  const auto all_values = gather_all(comm_, velocity);
  for (std::size_t i = 0; i < all_faces.size(); ++i)
    predicted_[all_faces[i]] = all_values[i];
}

ForceImpulse<2> ColumnFluid::add_forces(double, double dt) {
  ForceImpulse<2> given;
  for (int face = 0; face <= options_.n_cells; ++face) {
    predicted_[face] += dt * options_.gravity;
    if (is_free(face))
      given.impulse.add(control_volume(face).center, 0, mass(face) * dt * options_.gravity);
  }
  given.coupled_change.assign(frozen_.coupled_volumes.size(), dt * options_.gravity);
  return given;
}

double ColumnFluid::largest_speed() const {
  double largest = 0;
  for (double u : velocity_)
    largest = std::max(largest, std::abs(u));
  return largest;
}

Momentum<2> ColumnFluid::momentum() const {
  Momentum<2> total;
  for (int face = 0; face <= options_.n_cells; ++face) {
    if (is_free(face))
      total.add(control_volume(face).center, 0, mass(face) * predicted_[face]);
  }
  return total;
}

double ColumnFluid::kinetic_energy() const {
  double energy = 0;
  for (int face = 0; face <= options_.n_cells; ++face) {
    if (is_free(face))
      energy += 0.5 * mass(face) * predicted_[face] * predicted_[face];
  }
  return energy;
}

void ColumnFluid::save(CheckpointWriter& checkpoint) const {
  checkpoint.file().create_group("column");
  checkpoint.file().write_replicated("column/velocity", velocity_);
}

void ColumnFluid::load(const CheckpointReader& checkpoint) {
  const auto values = checkpoint.file().read_all<double>("column/velocity");
  check_input(values.size() == velocity_.size(),
              "{}: the checkpoint's channel has {} faces, that of the scene {}.",
              checkpoint.file().path(), values.size(), velocity_.size());
  velocity_ = values;
}
