#pragma once
#include <optional>

#include "leaks/liquid_cells.hpp"
#include "liquid/watch/swept_cells.hpp"

namespace lockstep::test {

/// Checks that liquid goes on open ways only. In each step
/// - every cell that holds liquid, or is in sight of a drop of it, must be in reach of one that did
///   so before the step, from cell to cell without crossing a surface of solids. A cell whose
///   centre a surface has passed over is none of these: its liquid went ahead of the surface;
/// - no two neighbours that a surface without rim parted may see each other after the step, unless
///   the surface passed over one of them.
/// It uses nothing that moves the liquid but phi and particles as they are before and after.
template <int dim>
class LeakAudit {
 public:
  using Surface = std::shared_ptr<const SurfaceSnapshot<dim>>;

  /// `domain` must outlive this.
  explicit LeakAudit(const MacDomain<dim>& domain) : domain_(domain) {}

  /// `liquid` tells what cells hold liquid among solids. Before the interface moves. Collective.
  template <typename Liquid>
  void open(const InterfaceStep<dim>& step, const Liquid& liquid) {
    before_ = look(step.surface.before, liquid);
  }
  /// After the interface has moved. Throws SolveError for a leak. Collective.
  template <typename Liquid>
  void close(const InterfaceStep<dim>& step, const Liquid& liquid) {
    judge(step, look(step.surface.after, liquid));
  }

 private:
  /// Liquid and solids at one instant, on stored cells.
  struct Look {
    SolidCells<dim> solids;
    LiquidCells liquid;
  };
  using Near = NearbySurface<dim>;

  template <typename Liquid>
  Look look(const Surface& surface, const Liquid& liquid) const {
    SolidCells<dim> solids = find_solid_cells<dim>(domain_, surface);
    LiquidCells cells = liquid(solids);
    return {std::move(solids), std::move(cells)};
  }
  void judge(const InterfaceStep<dim>& step, const Look& now);
  /// Returns the owned cells that hold liquid from nowhere.
  std::vector<int> find_from_nowhere(const InterfaceStep<dim>& step, const SweptCells<dim>& swept,
                                     const Look& now) const;
  /// Over how many cells liquid or solids may have gone along an axis.
  int largest_displacement(const InterfaceStep<dim>& step, const SweptCells<dim>& swept) const;
  bool sees_marked(const Look& now, const std::vector<char>& marked, int cell) const;
  /// Spreads marks over visible neighbours until all of these cells are marked, or over `reach`
  /// cells.
  void explain(const Look& now, int reach, std::vector<char>& marked,
               std::vector<int>& cells) const;
  /// Spreads marks on over cells that surfaces have passed over, from their visible neighbours.
  void explain_swept(const SweptCells<dim>& swept, const Look& now, std::vector<char>& marked,
                     std::vector<int>& cells) const;
  /// Removes the cells that a way narrower than cells leads to: from a marked centre, or a drop
  /// that was hidden before.
  void explain_by_gaps(const InterfaceStep<dim>& step, std::vector<char> marked, int reach,
                       std::vector<int>& cells) const;
  bool gap_leads_to(int cell, const std::vector<char>& marked, const Near& near, int reach) const;
  void add_sources(const InterfaceStep<dim>& step, std::vector<char>& marked) const;
  /// Marks the cells to which surfaces have pushed the liquid of cells that they passed over.
  void add_pushed(const InterfaceStep<dim>& step, const SweptCells<dim>& swept,
                  const std::vector<int>& passed_over, const Look& now,
                  std::vector<char>& marked) const;
  /// Returns the owned cells that see a neighbour from which a surface should part them.
  std::vector<int> find_parted(const InterfaceStep<dim>& step, const SweptCells<dim>& swept,
                               const Look& now) const;
  int parting_solid(const SurfaceSnapshot<dim>& surface, int axis, int cell) const;
  /// Throws SolveError if there are any cells. Collective.
  void complain(const InterfaceStep<dim>& step, const std::vector<int>& cells) const;

  const MacDomain<dim>& domain_;
  Look before_;
  std::vector<char> without_boundary_;  ///< by solid
};

}  // namespace lockstep::test
