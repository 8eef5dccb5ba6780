#include "grid/wide_halo.hpp"

namespace lockstep {
namespace {

template <typename Value>
void copy_owned(const std::vector<Value>& from, int n_owned, int n_stored, std::vector<Value>& to) {
  LOCKSTEP_ASSERT(static_cast<int>(from.size()) >= n_owned);
  to.resize(n_stored);
  std::copy(from.begin(), from.begin() + n_owned, to.begin());
}

}  // namespace

template <int dim>
WideHalo<dim>::WideHalo(const TiledGrid<dim>& base, const TiledGrid<dim>& wide)
    : n_owned_cells_(base.n_owned_cells()),
      n_stored_cells_(wide.n_stored_cells()),
      exchange_(wide, wide.ghost_width()) {
  LOCKSTEP_ASSERT(base.n_owned_cells() == wide.n_owned_cells());
}

template <int dim>
template <typename Value>
void WideHalo<dim>::fill(const std::vector<Value>& base_field,
                         std::vector<Value>& wide_field) const {
  copy_owned(base_field, n_owned_cells_, n_stored_cells_, wide_field);
  exchange_.fill(wide_field);
}

template <int dim>
void WideHalo<dim>::fill(const FaceField<dim>& base_field, FaceField<dim>& wide_field) const {
  for (int a = 0; a < dim; ++a)
    copy_owned(base_field[a], n_owned_cells_, n_stored_cells_, wide_field[a]);
  exchange_.fill(wide_field);
}

template class WideHalo<2>;
template class WideHalo<3>;
template void WideHalo<2>::fill(const std::vector<double>&, std::vector<double>&) const;
template void WideHalo<2>::fill(const std::vector<int>&, std::vector<int>&) const;
template void WideHalo<2>::fill(const std::vector<char>&, std::vector<char>&) const;
template void WideHalo<2>::fill(const std::vector<GlobalIndex>&, std::vector<GlobalIndex>&) const;
template void WideHalo<3>::fill(const std::vector<double>&, std::vector<double>&) const;
template void WideHalo<3>::fill(const std::vector<int>&, std::vector<int>&) const;
template void WideHalo<3>::fill(const std::vector<char>&, std::vector<char>&) const;
template void WideHalo<3>::fill(const std::vector<GlobalIndex>&, std::vector<GlobalIndex>&) const;

}  // namespace lockstep
