#pragma once
#include <vector>

#include "liquid/common/cell_groups.hpp"
#include "liquid/common/solid_cells.hpp"

namespace lockstep {

/// Volumes of the groups of liquid cells, over all ranks.
struct GroupVolumes {
  std::vector<double> volume;  ///< [m^dim]
  std::vector<double> area;  ///< area of its surface: volume gained per decrease of phi [m^(dim-1)]
  double loose = 0;          ///< liquid beside no liquid cell [m^dim]

  double total() const;
};

/// The volume of {phi < 0} outside solids: exact for phi linear on the simplices of the boxes
/// between cell centres (towards sides of the domain phi is constant, towards open ones it is
/// extrapolated where it rises); in boxes that closed solids reach into, the solids' volume is
/// subtracted in proportion; in boxes that a surface divides, each corner has its share, and the
/// part of a cell beyond a shell counts with the cell there. Of such a share 1/2 - phi/h is liquid;
/// that of a dry cell belongs to the deepest wet one that it sees beside it, so that volumes do not
/// jump where cells become wet.
template <int dim>
class LiquidVolume {
 public:
  explicit LiquidVolume(const MacDomain<dim>& domain) : domain_(domain) {}

  /// Lists the boxes that the liquid's surface or solids may cut. Then phi may change by 0.5 h
  /// before the list is made anew. `phi` on the halo of width 1. Collective.
  void prepare(const SolidCells<dim>& solids, const CellField& phi);
  /// Measures the groups; the listed liquid that is beside no cell of a group is loose. Collective.
  GroupVolumes measure(const CellField& phi, const CellGroups& groups) const;

 private:
  static constexpr int n_corners = 1 << dim;
  struct CutBox {
    std::array<int, n_corners> corners;
    double volume = 0;  ///< outside closed solids [m^dim]
    /// Bit 2 axis + side: half a box at that side, which is open. Its outer corners are those of
    /// the cells beside it.
    int open_sides = 0;
  };
  /// An owned cell that has shares of boxes that a surface divides.
  struct DividedCell {
    int cell = -1;
    double volume = 0;                ///< all of them [m^dim]
    std::array<int, 2 * dim> beside;  ///< the cells that it sees, or -1
  };
  void list_boxes(const SolidCells<dim>& solids, const CellField& phi, int cell);
  bool is_divided(const SolidCells<dim>& solids, const std::array<int, n_corners>& corners) const;
  double volume_of_cell(int cell) const;
  void list_full(int cell);
  void list_beyond_shells(const SolidCells<dim>& solids, const CellField& phi);
  /// Gives the part of a cell beyond the shell in it, taken as a plane, to the cell there.
  void list_beyond_shell(const SolidCells<dim>& solids, const CellField& phi, int cell,
                         std::vector<int>& touching);
  /// True if neither the cell nor one around it will have liquid before the list is made anew.
  bool stays_dry(const CellField& phi, int cell) const;
  void list_divided_cells(const SolidCells<dim>& solids);
  /// phi at a corner of a box.
  double at_corner(const CutBox& box, int corner, const CellField& phi) const;
  void add_cut(const CutBox& box, const CellField& phi, const CellGroups& groups,
               GroupVolumes& sums) const;
  void add_divided(const DividedCell& of, const CellField& phi, const CellGroups& groups,
                   GroupVolumes& sums) const;

  const MacDomain<dim>& domain_;
  std::vector<CutBox> cut_;
  /// Owned cells one behind the other whose boxes are all full.
  struct Run {
    int begin = 0, n = 0;
    double volume = 0;  ///< volume of each cell [m^dim]
  };
  std::vector<Run> full_;
  std::vector<DividedCell> divided_;
  CellField shares_;  ///< shares of stored cells [m^dim]
};

}  // namespace lockstep
