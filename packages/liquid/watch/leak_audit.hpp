#pragma once
#include <functional>
#include <optional>

#include "interfaces/liquid.hpp"
#include "liquid/common/interface_model.hpp"
#include "liquid/watch/watch.hpp"
#include "staggered/state/stored_fields.hpp"

namespace lockstep {

/// Checks that liquid comes to watched places on open ways only. In each step
/// - every cell there that holds liquid, or is in sight of a drop of it, must be in reach of one
///   that did so before the step, from cell to cell without crossing a surface of solids. A cell
///   whose centre a surface has passed over is none of these: its liquid went ahead of the surface;
/// - a place without a way out must keep the volume that it should have;
/// - no two neighbours that a surface without rim parted may see each other after the step, unless
///   the surface passed over one of them.
/// It uses nothing that moves the liquid but phi and particles as they are before and after. A
/// place whose point sees the centre of no cell, as in a solid or in a gap, is what is left of it
/// as it was; once nothing is, it is not watched until its point sees a cell again.
template <int dim>
class LeakAudit {
 public:
  using Surface = std::shared_ptr<const SurfaceSnapshot<dim>>;

  /// `domain` must outlive this.
  LeakAudit(const MacDomain<dim>& domain, std::vector<Watch<dim>> watches);

  /// Finds the watched places at the start of a run. Throws InputError for a point outside of the
  /// domain, in a solid or in sight of no cell's centre. Collective.
  void begin(const Surface& surface);
  /// Looks at the liquid before the interface moves. Collective.
  void open(const InterfaceStep<dim>& step, InterfaceModel<dim>& interface);
  /// Audits the liquid after the interface has moved over no more than `displacement` cells. Throws
  /// SolveError for a leak. Collective.
  void close(const InterfaceStep<dim>& step, InterfaceModel<dim>& interface, double displacement);

  /// Forgets the last step: tiles or the liquid have changed since. Local.
  void forget() { last_ = {}; }

  const std::vector<Watch<dim>>& watches() const { return watches_; }
  /// All is nan of a place that is not watched.
  const std::vector<WatchedLiquid>& report() const { return report_; }
  std::vector<StoredField> fields() { return {{"watched_places", {&places_}}}; }

 private:
  /// Liquid and solids at one instant, on stored cells.
  struct Look {
    Surface surface;               ///< null: none; the same is not looked at twice
    std::vector<CellState> cells;  ///< `fluid` outside solids
    std::vector<char> occluded;    ///< as in SurfaceMarks; empty without a surface
    std::vector<char> liquid;      ///< holds liquid or sees some
    std::vector<char> hidden;      ///< see LiquidCells
    std::vector<int> watched;      ///< a bit for each watch
  };
  using Near = NearbySurface<dim>;
  using StaysInPlace = std::function<bool(int cell)>;

  /// `stays`: whether an owned cell is still on its side of surfaces since the places were found.
  Look look(const Surface& surface, InterfaceModel<dim>& interface, KeptSurface<dim>& kept,
            const StaysInPlace& stays);
  /// Marks the cells of a place (1). Collective.
  std::vector<char> find_place(std::size_t watch, const Look& now, const Near& near,
                               const StaysInPlace& stays) const;
  bool sees(const Look& look, int cell, int axis, int side) const;
  std::vector<int> seeds(const Point<dim>& point, const std::vector<CellState>& cells,
                         const Near& near) const;
  /// Returns the watched and owned cells that hold liquid from nowhere.
  std::vector<int> find_from_nowhere(const InterfaceStep<dim>& step, const Look& now,
                                     double displacement);
  /// Spreads marks over visible neighbours until all of these cells are marked, or over `reach`
  /// cells.
  void explain(const Look& now, int reach, std::vector<char>& marked,
               std::vector<int>& cells) const;
  /// Spreads marks on over cells that surfaces have passed over, from their visible neighbours.
  void explain_swept(const InterfaceStep<dim>& step, const Look& now, std::vector<char>& marked,
                     std::vector<int>& cells) const;
  /// Removes the cells that a way narrower than cells leads to: from a marked centre, or a drop
  /// that was hidden before.
  void explain_by_gaps(const InterfaceStep<dim>& step, std::vector<char> marked, int reach,
                       std::vector<int>& cells) const;
  bool gap_leads_to(int cell, const std::vector<char>& marked, const Near& near, int reach) const;
  void add_sources(const InterfaceStep<dim>& step, std::vector<char>& marked) const;
  /// Marks the cells to which surfaces have pushed the liquid of cells that they passed over.
  void add_pushed(const InterfaceStep<dim>& step, const std::vector<int>& swept, const Look& now,
                  std::vector<char>& marked) const;
  std::optional<SurfacePoint<dim>> swept(const InterfaceStep<dim>& step, int cell) const;
  void check_sides(const InterfaceStep<dim>& step, const Look& now) const;
  /// True if the place reaches to volumes of solids: the liquid of cells that these cut, and their
  /// volume defects, belong to no place, so that targets change a little. Collective.
  bool holds_solids(const Look& now, const std::vector<char>& cells) const;
  /// True if nothing has come or gone between the place and the rest of the domain.
  bool stayed_closed(const InterfaceStep<dim>& step, const Look& now, std::size_t watch) const;
  /// Checks that the target of a place that stayed closed has not changed.
  void check_target(const InterfaceStep<dim>& step, std::size_t watch, double target,
                    double lost) const;
  int parting_solid(const SurfaceSnapshot<dim>& surface, int axis, int cell) const;
  [[noreturn]] void complain(const InterfaceStep<dim>& step, const Look& now,
                             std::vector<int> cells) const;

  const MacDomain<dim>& domain_;
  std::vector<Watch<dim>> watches_;
  std::vector<Anchor<dim>> anchors_;
  std::vector<char> without_boundary_;  ///< by solid
  Look before_;
  std::optional<Look> last_;  ///< after the last step
  CellField places_;          ///< the bits of `Look::watched` as they were last found
  double lost_ = 0;           ///< `lost` of the ledger before the step [m^dim]
  bool has_drops_ = false;
  std::shared_ptr<const Near> near_before_;  ///< the surface before the step; null between steps
  double motion_ = 0;                        ///< largest motion of surfaces in this step [m]
  std::vector<WatchedLiquid> report_;
  std::vector<char> holds_solids_;  ///< by watch, after the last step
  bool has_report_ =
      false;  ///< true with a report of the step before; not at the start or after a restart
};

}  // namespace lockstep
