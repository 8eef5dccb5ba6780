#pragma once
#include "interfaces/momentum.hpp"
#include "mac/domain/mac_domain.hpp"

namespace lockstep {

/// Adds up impulses along one axis that act at the owned faces of a grid, in the order of the
/// tiles. The first moments are taken within each tile, so that a face costs a few operations.
template <int dim>
class FaceMoments {
 public:
  FaceMoments(const TiledGrid<dim>& grid, int axis) : grid_(grid), axis_(axis) {}

  void add(int cell, double impulse) {
    if (TiledGrid<dim>::tile_of(cell) != tile_)
      next_tile(TiledGrid<dim>::tile_of(cell));
    sum_ += impulse;
    for (int b = 0; b < dim; ++b)
      moment_[b] += impulse * ((cell >> (b * log_tile_width<dim>)) & (tile_width<dim> - 1));
  }
  Momentum<dim> total() {
    next_tile(-1);
    return total_;
  }

 private:
  void next_tile(int tile) {
    if (tile_ >= 0 && (sum_ != 0 || !moment_.isZero(0))) {
      const Point<dim> origin = grid_.face_center(axis_, tile_ << log_tile_volume<dim>);
      const Point<dim> direction = Point<dim>::Unit(axis_);
      total_.add(origin, axis_, sum_);
      total_.angular += cross<dim>(moment_ * grid_.spacing(), direction);
    }
    tile_ = tile;
    sum_ = 0;
    moment_.setZero();
  }

  const TiledGrid<dim>& grid_;
  int axis_;
  int tile_ = -1;
  double sum_ = 0;
  Point<dim> moment_ = Point<dim>::Zero();
  Momentum<dim> total_;
};

}  // namespace lockstep
