#include "freesurface/phi_lookup.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
/// How far from owned cells sight lines lead [cells].
constexpr int sight = 6;
}  // namespace

template <int dim>
PhiLookup<dim>::PhiLookup(const TiledGrid<dim>& grid, const SampleLattice<dim>& lattice,
                          const SolidCells<dim>& solids, KeptSurface<dim>& kept,
                          const CellField& phi, int margin)
    : grid_(grid),
      lattice_(lattice),
      phi_(phi),
      margin_(margin),
      width_(tile_width<dim> + 2 * margin),
      is_fluid_(phi.size()),
      nearby_(kept.of(solids.state.surface, grid, sight)),
      block_(static_cast<std::size_t>(stride(1)) * (dim == 2 ? width_ : width_ * width_) + 16) {
  for (std::size_t cell = 0; cell < phi.size(); ++cell)
    is_fluid_[cell] = solids.is_fluid(static_cast<int>(cell));
  usable_.cells = is_fluid_.data();
  surface_.before = solids.state.surface;
  visible_ =
      std::make_unique<VisibleInterpolation<dim>>(grid, lattice, usable_, surface_, 0.0, nearby_);
}

template <int dim>
void PhiLookup<dim>::enter(int tile) {
  std::array<std::vector<typename SampleLattice<dim>::Run>, dim> runs;
  std::array<const std::vector<typename SampleLattice<dim>::Run>*, dim> all;
  std::array<int, dim> strides;
  for (int a = 0; a < dim; ++a) {
    const int begin = grid_.tile_begin(tile)[a];
    begin_[a] = begin;
    runs[a] = lattice_.find_runs(a, false, begin - margin_, width_);
    all[a] = &runs[a];
    strides[a] = stride(a);
  }
  is_complete_ = lattice_.copy_block(all, strides, phi_.data(), block_.data());
}

template <int dim>
Point<dim> PhiLookup<dim>::gradient(const Point<dim>& x) const {
  constexpr double step = 0.5;
  Point<dim> result = Point<dim>::Zero();
  for (int a = 0; a < dim && is_complete_; ++a) {
    Point<dim> ahead = x, behind = x;
    const double beyond = margin_ - 1;
    ahead[a] = std::min(x[a] + step, tile_width<dim> + beyond);
    behind[a] = std::max(x[a] - step, -beyond);
    result[a] = (plain_value(ahead) - plain_value(behind)) / (ahead[a] - behind[a]);
  }
  return result;
}

template <int dim>
bool PhiLookup<dim>::may_be_hidden(const Point<dim>& x) const {
  if (nearby_->empty())
    return false;
  Index<dim> cell;
  for (int a = 0; a < dim; ++a)
    cell[a] = static_cast<int>(std::floor(x[a] + begin_[a]));
  return nearby_->cells_to(cell) <= 2;
}

template <int dim>
bool PhiLookup<dim>::hidden(const Point<dim>& a, const Point<dim>& b) const {
  return !nearby_->empty() &&
         nearby_->first_hit(visible_->physical(place(a)), visible_->physical(place(b)));
}

template class PhiLookup<2>;
template class PhiLookup<3>;

}  // namespace lockstep
