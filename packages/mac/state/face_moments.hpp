#pragma once
#include "interfaces/momentum.hpp"
#include "mac/domain/mac_domain.hpp"

namespace lockstep {

/// Adds up impulses along one axis that act at the owned faces of a grid, in the order of the
/// tiles. The first moments are taken within each row, and within each tile, so that a face costs
/// next to nothing.
template <int dim>
class FaceMoments {
 public:
  FaceMoments(const TiledGrid<dim>& grid, int axis) : grid_(grid), axis_(axis) {}

  void add(int cell, double impulse) {
    if (row_of(cell) != row_)
      next_row(row_of(cell));
    in_row_[cell & (tile_width<dim> - 1)] += impulse;
  }
  Momentum<dim> total() {
    next_row(-1);
    next_tile(-1);
    return total_;
  }

 private:
  using Row = Eigen::Array<double, tile_width<dim>, 1>;
  static int row_of(int cell) { return cell >> log_tile_width<dim>; }
  void next_row(int row) {
    if (row_ >= 0) {
      const int first = row_ << log_tile_width<dim>;
      if (TiledGrid<dim>::tile_of(first) != tile_)
        next_tile(TiledGrid<dim>::tile_of(first));
      const double row_sum = in_row_.sum();
      sum_ += row_sum;
      moment_[0] += (in_row_ * Row::LinSpaced(0, tile_width<dim> - 1)).sum();
      for (int b = 1; b < dim; ++b)
        moment_[b] += row_sum * ((first >> (b * log_tile_width<dim>)) & (tile_width<dim> - 1));
    }
    row_ = row;
    in_row_.setZero();
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
  Row in_row_ = Row::Zero();
  double sum_ = 0;
  Point<dim> moment_ = Point<dim>::Zero();
  Momentum<dim> total_;
};

}  // namespace lockstep
