#pragma once
#include "interfaces/liquid.hpp"
#include "liquid/common/interface_model.hpp"
#include "liquid/common/solid_cells.hpp"
#include "liquid/watch/watch.hpp"
#include "staggered/state/stored_fields.hpp"

namespace lockstep {

/// Finds the cells of watched places after each step and measures the liquid there. A place is all
/// that can be reached from its point, from cell to cell without crossing a surface of solids. One
/// whose point sees the centre of no cell, as in a solid or in a gap, is what is left of it as it
/// was; once nothing is, it is not watched until its point sees a cell again.
template <int dim>
class WatchedPlaces {
 public:
  using Surface = std::shared_ptr<const SurfaceSnapshot<dim>>;

  /// `domain` must outlive this. Throws InputError for more places than a field can tell apart.
  WatchedPlaces(const MacDomain<dim>& domain, std::vector<Watch<dim>> watches);

  /// Finds the places at the start of a run. Throws InputError for a point outside of the domain,
  /// in a solid or in sight of no cell's centre. Collective.
  void begin(const Surface& surface);
  /// Finds the places, and the liquid there, after the interface has moved. Collective.
  void measure(const InterfaceStep<dim>& step, const InterfaceModel<dim>& interface);

  const std::vector<Watch<dim>>& watches() const { return watches_; }
  /// All is nan of a place that is not watched.
  const std::vector<WatchedLiquid>& report() const { return report_; }
  std::vector<StoredField> fields() { return {{"watched_places", {&places_}}}; }

 private:
  /// Owned cells of the fluid whose centres the point sees, of those around it.
  std::vector<int> seeds(const Point<dim>& point, const SolidCells<dim>& solids,
                         const NearbySurface<dim>& near) const;
  /// Marks the stored cells of a place (1). `step`: that after which it is looked for; null: none
  /// has been taken. Collective.
  std::vector<char> find_place(std::size_t watch, const SolidCells<dim>& solids,
                               const NearbySurface<dim>& near,
                               const InterfaceStep<dim>* step) const;

  const MacDomain<dim>& domain_;
  std::vector<Watch<dim>> watches_;
  std::vector<Anchor<dim>> anchors_;
  CellField places_;  ///< a bit for each watch: the cell was in its place when that was last found
  std::vector<WatchedLiquid> report_;
};

}  // namespace lockstep
