#pragma once
#include "liquid/common/solid_cells.hpp"
#include "liquid/fractions/cell_plane.hpp"

namespace lockstep {

/// Fractions nearer than this to 0 or 1 count as 0 or 1.
constexpr double negligible_fraction = 1e-10;

inline bool is_mixed(double fraction) {
  return fraction > negligible_fraction && fraction < 1 - negligible_fraction;
}

/// The liquid's surface in mixed cells: a plane in each, with the normal of Aulisa et al. (2007),
/// which is the better of columns' differences and Youngs' gradient. A neighbour that a surface
/// hides counts as the nearest one in sight, so that the liquid meets solids and sides at 90
/// degrees.
template <int dim>
class FractionPlanes {
 public:
  explicit FractionPlanes(const MacDomain<dim>& domain) : domain_(domain) {}

  /// Finds the planes of the mixed cells of the flagged owned tiles, and on the halo of width 1;
  /// `fraction` is known there. Collective.
  void find(const SolidCells<dim>& solids, const std::vector<char>& tiles,
            const CellField& fraction);
  /// Plane of a mixed cell.
  CellPlane<dim> operator()(int cell) const {
    CellPlane<dim> plane;
    for (int a = 0; a < dim; ++a)
      plane.normal[a] = numbers_[a][cell];
    plane.constant = numbers_[dim][cell];
    return plane;
  }
  /// Sets phi on the flagged tiles and its halo of width 1 from the planes of a cell and its
  /// visible neighbours: a distance where one of these has a plane, else +-cut_off. Negative where
  /// the fraction is above 1/2. Collective.
  void set_distance(const SolidCells<dim>& solids, const std::vector<char>& tiles,
                    const CellField& fraction, double cut_off, CellField& phi) const;

 private:
  Point<dim> normal(const SolidCells<dim>& solids, const CellField& fraction, int cell) const;
  /// Distance from the point at `offset` cells from the lower corner of a mixed cell to its
  /// liquid's surface [cells].
  double distance_to(int cell, const Point<dim>& offset) const;

  const MacDomain<dim>& domain_;
  std::array<CellField, dim + 1> numbers_;  ///< normals, and constants
};

}  // namespace lockstep
