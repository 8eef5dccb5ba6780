#include "liquid/fractions/fraction_transport.hpp"

#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "grid/flagged_tiles.hpp"

namespace lockstep {

namespace {
template <int dim, typename Function>
void for_each_fluid_cell(const TiledGrid<dim>& grid, const SolidCells<dim>& solids,
                         const std::vector<char>& tiles, const Function& f) {
  for_each_owned_cell_of(grid, tiles, [&](int cell) {
    if (solids.is_fluid(cell))
      f(cell);
  });
}

/// The face of a cell, -1 if it is not stored: then it is shut.
template <int dim>
int face_of(const TiledGrid<dim>& grid, int cell, int axis, int side) {
  return side == 0 ? cell : grid.neighbor(cell, axis, 1);
}
}  // namespace

template <int dim>
double FractionTransport<dim>::courant_number(const SolidCells<dim>& solids,
                                              const std::vector<char>& tiles, const CellField& phi,
                                              double cut_off, const FaceField<dim>& velocity,
                                              double dt) const {
  double largest = 0;
  for_each_fluid_cell(domain_.grid, solids, tiles, [&](int cell) {
    if (std::abs(phi[cell]) >= cut_off)
      return;
    double sum = 0;
    for (int axis = 0; axis < dim; ++axis) {
      const int upper = face_of(domain_.grid, cell, axis, 1);
      sum += std::max(std::abs(velocity[axis][cell]),
                      upper < 0 ? 0.0 : std::abs(velocity[axis][upper]));
    }
    largest = sum <= largest ? largest : sum;  // takes what is not a number
  });
  if (!std::isfinite(largest))
    largest = 1e300;
  largest = max_all(domain_.grid.comm(), largest);
  check_solve(largest * dt < 1e6 * domain_.spacing(),
              "The velocity at the liquid's surface is not finite, or carries it over more than a "
              "million cells in a step.");
  return largest * dt / domain_.spacing();
}

template <int dim>
double FractionTransport<dim>::in_slab(const CellField& liquid, int cell, int axis, int side,
                                       double width) const {
  return is_mixed(liquid[cell]) ? liquid_in_slab(planes_(cell), axis, side, width)
                                : width * liquid[cell];
}

/// `passed`: how far the velocity carries through the face in this step, inwards [cells].
template <int dim>
typename FractionTransport<dim>::Inflow FractionTransport<dim>::through(
    const SolidCells<dim>& solids, const CellField& liquid, int cell, int axis, int side,
    double passed) const {
  const TiledGrid<dim>& grid = domain_.grid;
  const double width = std::abs(passed), sign = passed < 0 ? -1 : 1;
  const int seen = solids.seen_neighbor(grid, cell, axis, side);
  if (seen >= 0)
    return {passed > 0 ? in_slab(liquid, seen, axis, 1 - side, width)
                       : -in_slab(liquid, cell, axis, side, width)};
  const int beyond = grid.neighbor(cell, axis, side);
  const double like_here = sign * in_slab(liquid, cell, axis, side, width);
  if (beyond >= 0 && grid.in_domain(beyond))
    return {like_here, false, false};  // as the surface moves, so does what is beside it
  const Index<dim> place = grid.coordinates(cell);
  const bool at_side = place[axis] == (side == 0 ? 0 : grid.n_cells()[axis] - 1);
  if (!at_side)
    return {0, false, false};  // at the rim of the stored tiles liquid waits for others
  const bool takes_air = domain_.boundary.side(axis, side).lets_in_air();
  // air comes in from outside, unless the side gives a velocity or a pressure
  return {takes_air && passed > 0 ? 0 : like_here, true, true};
}

template <int dim>
void FractionTransport<dim>::sweep(const SolidCells<dim>& solids, const FractionFlow<dim>& flow,
                                   int axis, CellField& liquid) {
  const TiledGrid<dim>& grid = domain_.grid;
  const std::vector<char>& tiles = flow.tiles;
  const CellField& velocity = flow.velocity[axis];
  const double per_speed = flow.dt / grid.spacing();
  planes_.find(solids, tiles, liquid);
  for_each_fluid_cell(domain_.grid, solids, tiles, [&](int cell) {
    double change = 0, growth = 0;
    for (int side = 0; side < 2; ++side) {
      const int face = face_of(grid, cell, axis, side);
      const double passed = face < 0 ? 0 : (side == 0 ? 1 : -1) * velocity[face] * per_speed;
      if (passed == 0)
        continue;
      const Inflow inflow = through(solids, liquid, cell, axis, side, passed);
      change += inflow.liquid;
      growth -= passed;
      const double real = inflow.is_at_side ? open_part(axis, face) * inflow.liquid : inflow.liquid;
      if (inflow.is_real)
        arrived_[cell] += real;
      if (inflow.is_at_side)
        left_ -= real;
    }
    swept_[cell] = liquid[cell] + (change + (grows_[cell] ? growth : 0));
  });
  for_each_fluid_cell(domain_.grid, solids, tiles, [&](int cell) { liquid[cell] = swept_[cell]; });
  domain_.halo.fill(liquid);
}

template <int dim>
void FractionTransport<dim>::leave_covered_cells(const SolidCells<dim>& solids,
                                                 const FractionFlow<dim>& flow,
                                                 Fractions& fractions) {
  const TiledGrid<dim>& grid = domain_.grid;
  for_each_owned_cell_of(grid, flow.tiles, [&](int cell) {
    if (solids.is_fluid(cell) || !grid.in_domain(cell) || fractions.liquid[cell] == 0)
      return;
    const Index<dim> place = grid.coordinates(cell);
    for (int i = 0; i < 2 * dim; ++i) {
      const int axis = i / 2, side = i % 2, face = face_of(grid, cell, axis, side);
      if (face < 0 || domain_.boundary.periodic(axis) ||
          place[axis] != (side == 0 ? 0 : grid.n_cells()[axis] - 1))
        continue;
      double inwards = (side == 0 ? 1 : -1) * flow.velocity[axis][face] * flow.dt / grid.spacing();
      if (domain_.boundary.side(axis, side).lets_in_air())
        inwards = std::min(inwards, 0.0);
      const double real = open_part(axis, face) * inwards * fractions.liquid[cell];
      fractions.defect[cell] += real;
      left_ -= real;
    }
  });
}

template <int dim>
double FractionTransport<dim>::advance(const SolidCells<dim>& solids, const FractionFlow<dim>& flow,
                                       int first_axis, Fractions& fractions) {
  open_ = flow.open;
  before_ = fractions.liquid;
  swept_.resize(before_.size());
  arrived_.assign(before_.size(), 0);
  grows_.assign(before_.size(), 0);
  left_ = 0;
  if (open_ && solids.state.surface)
    leave_covered_cells(solids, flow, fractions);
  for_each_fluid_cell(domain_.grid, solids, flow.tiles, [&](int cell) {
    grows_[cell] = flow.is_solved[cell] && before_[cell] > 0.5;
  });
  for (int i = 0; i < dim; ++i)
    sweep(solids, flow, (first_axis + i) % dim, fractions.liquid);
  for_each_fluid_cell(domain_.grid, solids, flow.tiles, [&](int cell) {
    double& liquid = fractions.liquid[cell];
    if (liquid < negligible_fraction)
      liquid = 0;
    if (liquid > 1 - negligible_fraction)
      liquid = 1;
    fractions.defect[cell] += arrived_[cell] - (liquid - before_[cell]) * fractions.open_part(cell);
  });
  domain_.halo.fill(fractions.liquid);
  return left_;
}

template class FractionTransport<2>;
template class FractionTransport<3>;

}  // namespace lockstep
