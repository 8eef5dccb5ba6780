#pragma once
#include "interfaces/momentum.hpp"
#include "mac/domain/mac_domain.hpp"

namespace lockstep {

/// Adds up impulses along one axis that act at the owned faces of a grid, in the order of the
/// tiles. The first moments are taken within each row, and within each tile, so that a face costs
/// two additions.
template <int dim>
class FaceMoments {
 public:
  FaceMoments(const TiledGrid<dim>& grid, int axis) : grid_(grid), axis_(axis) {}

  void add(int cell, double impulse) {
    if (row_of(cell) != row_)
      next_row(row_of(cell));
    row_sum_ += impulse;
    row_moment_ += impulse * (cell & (tile_width<dim> - 1));
  }
  Momentum<dim> total() {
    next_row(-1);
    next_tile(-1);
    return total_;
  }

 private:
  static int row_of(int cell) { return cell >> log_tile_width<dim>; }
  void next_row(int row) {
    if (row_ >= 0) {
      const int first = row_ << log_tile_width<dim>;
      if (TiledGrid<dim>::tile_of(first) != tile_)
        next_tile(TiledGrid<dim>::tile_of(first));
      sum_ += row_sum_;
      moment_[0] += row_moment_;
      for (int b = 1; b < dim; ++b)
        moment_[b] += row_sum_ * ((first >> (b * log_tile_width<dim>)) & (tile_width<dim> - 1));
    }
    row_ = row;
    row_sum_ = row_moment_ = 0;
  }
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
  int row_ = -1, tile_ = -1;
  double row_sum_ = 0, row_moment_ = 0;
  double sum_ = 0;
  Point<dim> moment_ = Point<dim>::Zero();
  Momentum<dim> total_;
};

}  // namespace lockstep
