#pragma once
#include <vector>

#include "mac/liquid/solid_cells.hpp"

namespace lockstep {

/// What is done with phi beside the surface.
enum class NearCells {
  scale,  ///< it becomes a distance, as the slope there has it
  keep    ///< it is one already
};

/// Makes phi a distance again without moving its zero: cells with a seen neighbour of the other
/// sign keep their share, |phi| / |grad phi| (after Russo & Smereka 2000), the others are reached
/// from those in the order of their distance, first order, across ranks until nothing changes.
/// Nothing is looked at across a surface of solids.
template <int dim>
class Redistancer {
 public:
  explicit Redistancer(const MacDomain<dim>& domain);

  /// Changes the fluid cells of the flagged owned tiles, which hold all |phi| < cut_off there can
  /// be; the farther ones become +-cut_off [m]. Sets the halo of width 1, which must be set
  /// before. Collective.
  void apply(const SolidCells<dim>& solids, const std::vector<char>& tiles, double cut_off,
             CellField& phi, NearCells near_cells = NearCells::scale);

 private:
  bool is_near(const SolidCells<dim>& solids, const CellField& phi, int cell) const;
  double scaled(const SolidCells<dim>& solids, const CellField& phi, int cell) const;
  /// The smallest distance that the cell's neighbours allow.
  double arrival(const SolidCells<dim>& solids, const CellField& phi, int cell) const;
  void set_near_cells(const SolidCells<dim>& solids, const std::vector<char>& tiles,
                      const CellField& phi, NearCells near_cells);
  void wait(int cell);
  void update_around(const SolidCells<dim>& solids, const CellField& phi, int cell);
  void march(const SolidCells<dim>& solids, const CellField& phi);
  /// Takes over what other ranks have found; true if any rank has something to do.
  bool take_from_others(const SolidCells<dim>& solids, const CellField& phi);

  const MacDomain<dim>& domain_;
  double cut_off_ = 0;
  CellField distance_;        ///< |phi| as known so far
  std::vector<char> is_set_;  ///< cells near the interface, which stay
  /// Cells waiting by their distance; each is an eighth of a cell wide.
  std::vector<std::vector<int>> waiting_;
  std::size_t first_waiting_ = 0;
};

}  // namespace lockstep
