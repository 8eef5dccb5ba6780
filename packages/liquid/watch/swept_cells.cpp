#include "liquid/watch/swept_cells.hpp"

#include "transport/largest_move.hpp"

namespace lockstep {

template <int dim>
SweptCells<dim>::SweptCells(const MacDomain<dim>& domain, const InterfaceStep<dim>& step)
    : grid_(domain.grid), step_(step), motion_(largest_move(step.surface)) {
  const auto& before = step.surface.before;
  const double reach =
      std::min<double>(motion_ / grid_.spacing() + 2, NearbySurface<dim>::longest_reach);
  near_ =
      step.kept.of(before && !before->empty() ? before : nullptr, grid_, static_cast<int>(reach));
}

template <int dim>
std::optional<SurfacePoint<dim>> SweptCells<dim>::operator()(int cell) const {
  if (near_->empty() ||
      near_->cells_to(grid_.coordinates(cell)) * grid_.spacing() > motion_ + grid_.spacing())
    return {};
  const Point<dim> x = grid_.center(cell);
  const auto& before = *step_.surface.before;
  const auto& after = step_.surface.after ? *step_.surface.after : before;
  for (const SurfaceSnapshot<dim>* surface : {&before, &after})
    if (auto touched = surface->closest(x, 2 * near_->tolerance()))
      return touched;
  if (motion_ == 0)
    return {};
  std::vector<int> candidates;
  const Point<dim> reach = Point<dim>::Constant(motion_);
  before.touching(Box<dim>(x - reach, x + reach), candidates);
  return swept_over<dim>(before, after, x, candidates);
}

template class SweptCells<2>;
template class SweptCells<3>;

}  // namespace lockstep
