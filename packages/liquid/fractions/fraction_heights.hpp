#pragma once
#include <array>
#include <optional>

#include "liquid/common/solid_cells.hpp"

namespace lockstep {

/// The surface of fractions by heights: the liquid in columns of cells along an axis, whose
/// differences give its curvature to second order (Cummins, Francois and Kothe 2005). Refers to
/// what it is made of, all of it on stored cells.
template <int dim>
class FractionHeights {
 public:
  /// `lead`: how deep in the liquid the surface that is bent lies, which the fractions do not say,
  /// near their own [m].
  FractionHeights(const MacDomain<dim>& domain, const SolidCells<dim>& solids,
                  const CellField& fraction, const CellField& phi, const CellField& lead)
      : domain_(domain), solids_(solids), fraction_(fraction), phi_(phi), lead_(lead) {}

  /// Curvature of the surface where it crosses the line from the centre of a wet cell to that of
  /// the dry one beside it, at the part `place` of the way; positive where the liquid is convex, at
  /// most (dim - 1) / h in size [1/m]. Of columns along the axis that is nearest to the normal;
  /// nothing where these do not go from full to empty cells, or come near a solid or beyond a side
  /// that has a contact angle. Local.
  std::optional<double> curvature(int wet, int axis, int side, double place) const;

 private:
  /// Columns around one, along each axis across them, whose curvatures a mean takes, and whose
  /// heights these need.
  static constexpr int reach_of_mean = dim == 2 ? 2 : 1, reach_across = reach_of_mean + 1;
  static constexpr int width = 2 * reach_across + 1;
  /// Cells of a column that are looked at on either side of the middle: less than there are ghosts.
  static constexpr int reach_along = 6;
  /// Columns along an axis.
  struct Direction {
    int axis = 0, outward = 1;  ///< 1: the gas is above, -1: below
    Point<dim> slope;           ///< gradient of heights, as phi tells
  };
  struct Column {
    bool is_known = false;
    double height = 0;  ///< thickness of liquid above the inner end of the middle cell [cells]
    int row = 0;        ///< in which the surface is, from that cell outwards
  };
  static constexpr int n_columns = dim == 2 ? width : width * width;
  using Columns = std::array<Column, n_columns>;
  static int index(int a, int b) {
    return a + reach_across + (dim == 2 ? 0 : width * (b + reach_across));
  }

  Point<dim> slope(int cell) const;
  /// The cell in a row of the column at `place`, or -1 where heights know nothing.
  int cell_of(Index<dim> place, int row, const Direction& direction) const;
  /// Follows a column from a row.
  Column follow(const Index<dim>& place, int row, const Direction& direction) const;
  /// Mean of `lead` where a column has its surface [cells].
  double lead_of(const Index<dim>& place, const Column& column, const Direction& direction) const;
  Column column_beside(Index<dim> middle, const std::array<int, 2>& offset, int row,
                       const Direction& direction) const;
  Columns columns_around(int cell, const Direction& direction) const;
  /// Curvature at one of the columns [1/cells]; nothing where the surface is too steep for them.
  std::optional<double> bend(const Columns& columns, int a, int b) const;
  /// Curvature at the column through a cell: a mean, to which short waves are next to nothing. As
  /// they are, waves of two to four cells would grow (docs/method.md) [1/cells].
  std::optional<double> mean_bend(int cell, const Direction& direction) const;

  const MacDomain<dim>& domain_;
  const SolidCells<dim>& solids_;
  const CellField& fraction_;
  const CellField& phi_;
  const CellField& lead_;
};

}  // namespace lockstep
