#pragma once
#include "grid/strips.hpp"
#include "interfaces/momentum.hpp"
#include "staggered/domain/mac_domain.hpp"

namespace lockstep {

/// Adds up impulses along one axis that act at the owned faces of a grid, in the order of the
/// tiles. The first moments are taken within each row, and within each tile, so that a face costs
/// next to nothing.
template <int dim>
class FaceMoments {
 public:
  FaceMoments(const TiledGrid<dim>& grid, int axis) : grid_(grid), axis_(axis) {}

  /// The impulses of a whole row, from this face on.
  void add_row(int first, const StripValues<dim>& impulses) {
    if (TiledGrid<dim>::tile_of(first) != tile_of_rows_)
      next_tile_of_rows(TiledGrid<dim>::tile_of(first));
    rows_[0] += impulses;
    for (int b = 1; b < dim; ++b)
      rows_[b] += place_in_tile(first, b) * impulses;
  }
  void add(int cell, double impulse) {
    if (row_number(cell) != row_)
      next_row(row_number(cell));
    in_row_[cell & (tile_width<dim> - 1)] += impulse;
  }
  Momentum<dim> total() {
    next_row(-1);
    next_tile(-1);
    next_tile_of_rows(-1);
    return total_;
  }

 private:
  using Row = StripValues<dim>;
  static int place_in_tile(int cell, int axis) {
    return (cell >> (axis * log_tile_width<dim>)) & (tile_width<dim> - 1);
  }
  static int row_number(int cell) { return cell >> log_tile_width<dim>; }
  void next_row(int row) {
    if (row_ >= 0) {
      const int first = row_ << log_tile_width<dim>;
      if (TiledGrid<dim>::tile_of(first) != tile_)
        next_tile(TiledGrid<dim>::tile_of(first));
      const double row_sum = in_row_.sum();
      sum_ += row_sum;
      moment_[0] += (in_row_ * Row::LinSpaced(0, tile_width<dim> - 1)).sum();
      for (int b = 1; b < dim; ++b)
        moment_[b] += row_sum * place_in_tile(first, b);
    }
    row_ = row;
    in_row_.setZero();
  }
  /// The sum of a tile's impulses and their first moment about its first face, in cells.
  void add_tile(int tile, double sum, const Point<dim>& moment) {
    const Point<dim> origin = grid_.face_center(axis_, tile << log_tile_volume<dim>);
    const Point<dim> direction = Point<dim>::Unit(axis_);
    total_.add(origin, axis_, sum);
    total_.angular += cross<dim>(moment * grid_.spacing(), direction);
  }
  void next_tile_of_rows(int tile) {
    if (tile_of_rows_ >= 0) {
      Point<dim> moment;
      moment[0] = (rows_[0] * Row::LinSpaced(0, tile_width<dim> - 1)).sum();
      for (int b = 1; b < dim; ++b)
        moment[b] = rows_[b].sum();
      add_tile(tile_of_rows_, rows_[0].sum(), moment);
    }
    tile_of_rows_ = tile;
    rows_.fill(Row::Zero());
  }
  void next_tile(int tile) {
    if (tile_ >= 0 && (sum_ != 0 || !moment_.isZero(0)))
      add_tile(tile_, sum_, moment_);
    tile_ = tile;
    sum_ = 0;
    moment_.setZero();
  }

  const TiledGrid<dim>& grid_;
  int axis_;
  int row_ = -1, tile_ = -1;
  Row in_row_ = Row::Zero();
  /// Sums over whole strips, and along the other axes these weighted with their place.
  int tile_of_rows_ = -1;
  std::array<Row, dim> rows_;
  double sum_ = 0;
  Point<dim> moment_ = Point<dim>::Zero();
  Momentum<dim> total_;
};

}  // namespace lockstep
