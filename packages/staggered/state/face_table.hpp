#pragma once
#include <array>
#include <vector>

#include "staggered/domain/mac_domain.hpp"

namespace lockstep {

/// What a face is worth to the fluid that flows through it: three numbers, and what follows.
struct FaceWorth {
  double open = 1;       ///< alpha: the part of its area that no solid covers
  double closeness = 1;  ///< w: h over the distance of the pressures at both sides
  double density = 0;    ///< of the fluid in its dual cell [kg/m^dim]

  double mass = 0;         ///< of that fluid, rho V alpha / w [kg]
  double coefficient = 1;  ///< of A, alpha w rho_0 / rho: in parts of that of a regular face
  double gradient = 0;     ///< what a unit of p̂ across it takes from its velocity, w / (rho h)
};

/// All that pressure, momentum, energy, viscosity and coupling must agree on about faces: made once
/// a geometry. Between two cells of plain fluid a face is regular: all of it is open and its
/// pressures lie h apart. Only tiles that hold another face store theirs. At an open side w is 2,
/// and the dual cell half as long.
template <int dim>
class FaceTable {
 public:
  FaceTable() = default;
  /// All faces regular. Local.
  FaceTable(const MacDomain<dim>& domain, double density);

  /// Of any stored face, whatever its state.
  const FaceWorth& operator()(int axis, int cell) const {
    const int block = block_of_tile_[axis][TiledGrid<dim>::tile_of(cell)];
    return block < 0 ? regular_ : special_[axis][place(block, cell)];
  }
  /// Whether all faces normal to `axis` of the tile of this cell are regular.
  bool is_regular_tile(int axis, int cell) const {
    return block_of_tile_[axis][TiledGrid<dim>::tile_of(cell)] < 0;
  }
  void set_open(int axis, int cell, double open);
  void set_closeness(int axis, int cell, double closeness);

  const FaceWorth& regular() const { return regular_; }
  double area() const { return area_; }  ///< of a whole face [m^(dim-1)]
  /// What a unit of `FaceWorth::coefficient` is in A: area / (rho_0 h).
  double unit_coefficient() const { return area_ * regular_.gradient; }
  std::size_t n_stored() const;  ///< faces that are not taken from the regular one

 private:
  static std::size_t place(int block, int cell) {
    return (static_cast<std::size_t>(block)
            << log_tile_volume<dim>)+(cell & (tile_volume<dim> - 1));
  }
  FaceWorth& own(int axis, int cell);
  void derive(FaceWorth& face) const;

  double area_ = 0, volume_ = 0, spacing_ = 0;
  FaceWorth regular_;
  std::array<std::vector<int>, dim> block_of_tile_;  ///< -1: all its faces are regular
  std::array<std::vector<FaceWorth>, dim> special_;  ///< block after block
};

}  // namespace lockstep
