#include "liquid/common/phi_lookup.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
/// Distance from owned cells that sight lines reach [cells].
constexpr int sight = 6;
/// To both sides, for gradients [cells].
constexpr double difference_step = 0.5;
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
bool PhiLookup<dim>::approach(int tile) {
  for (int a = 0; a < dim; ++a)
    begin_[a] = grid_.tile_begin(tile)[a];
  Box<dim> reach(begin_, Point<dim>(begin_ + Point<dim>::Constant(tile_width<dim>)));
  reach.min() = grid_.lower() + grid_.spacing() * (reach.min().array() - margin_ - 3).matrix();
  reach.max() = grid_.lower() + grid_.spacing() * (reach.max().array() + margin_ + 3).matrix();
  is_near_surface_ = !nearby_->empty() && nearby_->touches(reach);
  return is_near_surface_;
}

template <int dim>
void PhiLookup<dim>::enter(int tile) {
  approach(tile);
  std::array<std::vector<typename SampleLattice<dim>::Run>, dim> runs;
  std::array<const std::vector<typename SampleLattice<dim>::Run>*, dim> all;
  std::array<int, dim> strides;
  for (int a = 0; a < dim; ++a) {
    runs[a] = lattice_.find_runs(a, false, grid_.tile_begin(tile)[a] - margin_, width_);
    all[a] = &runs[a];
    strides[a] = stride(a);
  }
  is_complete_ = lattice_.copy_block(all, strides, phi_.data(), block_.data());
}

template <int dim>
Point<dim> PhiLookup<dim>::gradient(const Point<dim>& x) const {
  Point<dim> result = Point<dim>::Zero();
  for (int a = 0; a < dim && is_complete_; ++a) {
    Point<dim> ahead = x, behind = x;
    const double beyond = margin_ - 1;
    ahead[a] = std::min(x[a] + difference_step, tile_width<dim> + beyond);
    behind[a] = std::max(x[a] - difference_step, -beyond);
    result[a] = (unchecked_value(ahead) - unchecked_value(behind)) / (ahead[a] - behind[a]);
  }
  return result;
}

template <int dim>
StripValues<dim> PhiLookup<dim>::values(const StripPoints<dim>& x) const {
  constexpr int n = tile_width<dim>;
  Eigen::Array<int, n, 1> place = Eigen::Array<int, n, 1>::Zero();
  StripPoints<dim> weight;
  for (int a = 0; a < dim; ++a) {
    const StripValues<dim> t = x[a] + (margin_ - 0.5);
    const Eigen::Array<int, n, 1> below = t.template cast<int>();
    weight[a] = t - below.template cast<double>();
    place += below * stride(a);
  }
  std::array<StripValues<dim>, (1 << dim)> samples;
  for (int k = 0; k < 1 << dim; ++k) {
    int offset = 0;
    for (int a = 0; a < dim; ++a)
      offset += (k >> a & 1) * stride(a);
    samples[k] = gathered<n>(block_.data() + offset, place);
  }
  for (int a = 0; a < dim; ++a)
    for (int k = 0; k < 1 << (dim - 1 - a); ++k)
      samples[k] = blend<StripValues<dim>>(samples[2 * k], samples[2 * k + 1], weight[a]);
  return samples[0];
}

template <int dim>
StripPoints<dim> PhiLookup<dim>::gradients(const StripPoints<dim>& x) const {
  const double beyond = margin_ - 1;
  StripPoints<dim> result, ahead = x, behind = x;
  result.fill(StripValues<dim>::Zero());
  for (int a = 0; a < dim && is_complete_; ++a) {
    ahead[a] = (x[a] + difference_step).min(tile_width<dim> + beyond);
    behind[a] = (x[a] - difference_step).max(-beyond);
    result[a] = (values(ahead) - values(behind)) / (ahead[a] - behind[a]);
    ahead[a] = behind[a] = x[a];
  }
  return result;
}

template <int dim>
bool PhiLookup<dim>::is_within_two_cells(const Point<dim>& x) const {
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
