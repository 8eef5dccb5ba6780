#include "transport/ray_halo.hpp"

#include <algorithm>

namespace lockstep {

template <int dim>
void RayHalo<dim>::require(int reach) {
  if (grid_.comm()->getSize() == 1)
    return;
  const int longest = *std::max_element(grid_.n_cells().begin(), grid_.n_cells().end());
  reach = std::clamp(reach, 1, longest + 1);
  if (reach <= grid_.ghost_width()) {
    wide_halo_.reset();
    wide_.reset();
    // A halo up to three times too wide costs less than building another.
    if (exchange_ && exchange_->width() >= reach && exchange_->width() <= 3 * reach)
      return;
    exchange_.emplace(grid_, std::min(reach + 1, grid_.ghost_width()));
    return;
  }
  const int n_tiles = (reach + tile_width<dim> - 1) / tile_width<dim>;
  if (wide_ && wide_tiles_ >= n_tiles && wide_tiles_ <= 2 * n_tiles)
    return;
  wide_halo_.reset();
  wide_ = std::make_unique<TiledGrid<dim>>(grid_.with_reach(n_tiles));
  wide_halo_ = std::make_unique<WideHalo<dim>>(grid_, *wide_);
  wide_tiles_ = n_tiles;
}

template <int dim>
template <typename Value>
const std::vector<Value>& RayHalo<dim>::fetch(const std::vector<Value>& field,
                                              std::vector<Value>& storage, Value beyond) const {
  const bool alone = grid_.comm()->getSize() == 1;
  if (alone && grid_.is_complete())
    return field;
  if (wide_) {
    wide_halo_->fill(field, storage);
  } else {
    storage = field;
    if (!alone)
      exchange_->fill(storage);
  }
  if (!grid_.is_complete())
    storage.insert(storage.end(), tile_volume<dim>, beyond);
  return storage;
}

template <int dim>
void RayHalo<dim>::forget() {
  exchange_.reset();
  wide_halo_.reset();
  wide_.reset();
}

template class RayHalo<2>;
template class RayHalo<3>;
template const std::vector<double>& RayHalo<2>::fetch(const std::vector<double>&,
                                                      std::vector<double>&, double) const;
template const std::vector<double>& RayHalo<3>::fetch(const std::vector<double>&,
                                                      std::vector<double>&, double) const;
template const std::vector<char>& RayHalo<2>::fetch(const std::vector<char>&, std::vector<char>&,
                                                    char) const;
template const std::vector<char>& RayHalo<3>::fetch(const std::vector<char>&, std::vector<char>&,
                                                    char) const;

}  // namespace lockstep
