#pragma once
#include <array>
#include <vector>

#include "staggered/domain/mac_domain.hpp"

namespace lockstep {

/// Coefficients of a face: three given ones, and those that follow from them.
struct FaceProperties {
  double open = 1;  ///< aperture alpha: the part of its area that no solid covers [1]
  double distance_factor =
      1;  ///< distance factor w = 1/theta: h over the distance of the pressures at both sides [1]
  double density = 0;  ///< density of the fluid in its dual cell [kg/m^dim]

  double mass = 0;  ///< mass of that fluid, rho V alpha / w [kg]
  double coefficient =
      1;                ///< coefficient in A, alpha w rho_0 / rho, relative to a regular face [1]
  double gradient = 0;  ///< change of its velocity by a unit of p̂ across it, w / (rho h)
};

/// Coefficients of all faces, on which pressure, momentum, energy, viscosity and coupling must
/// agree: made once a geometry. Between two cells of fluid without a surface a face is regular: all
/// of it is open and its pressures lie h apart. Only tiles that hold another face store theirs. At
/// an open side w is 2, and the dual cell half as long.
template <int dim>
class FaceTable {
 public:
  FaceTable() = default;
  /// All faces regular. Local.
  FaceTable(const MacDomain<dim>& domain, double density);

  /// Coefficients of any stored face, whatever its state.
  const FaceProperties& operator()(int axis, int cell) const {
    const int block = block_of_tile_[axis][TiledGrid<dim>::tile_of(cell)];
    return block < 0 ? regular_ : special_[axis][place(block, cell)];
  }
  /// True if all faces normal to `axis` of the tile of this cell are regular.
  bool is_regular_tile(int axis, int cell) const {
    return block_of_tile_[axis][TiledGrid<dim>::tile_of(cell)] < 0;
  }
  void set_open(int axis, int cell, double open);
  void set_distance_factor(int axis, int cell, double distance_factor);
  /// Sets the density of a face whose fluid is not the regular one. Rounds it by 6e-8, so that the
  /// coefficient is exact in single precision, as A has it.
  void set_density(int axis, int cell, double density);

  const FaceProperties& regular() const { return regular_; }
  double area() const { return area_; }  ///< area of a whole face [m^(dim-1)]
  /// Entry of A for a unit of `FaceProperties::coefficient`: area / (rho_0 h).
  double unit_coefficient() const { return area_ * regular_.gradient; }
  std::size_t n_stored() const;  ///< faces that are not taken from the regular one

 private:
  static std::size_t place(int block, int cell) {
    return (static_cast<std::size_t>(block)
            << log_tile_volume<dim>)+(cell & (tile_volume<dim> - 1));
  }
  FaceProperties& own(int axis, int cell);
  void derive(FaceProperties& face) const;

  double area_ = 0, volume_ = 0, spacing_ = 0;
  FaceProperties regular_;
  std::array<std::vector<int>, dim> block_of_tile_;       ///< -1: all its faces are regular
  std::array<std::vector<FaceProperties>, dim> special_;  ///< block after block
};

}  // namespace lockstep
