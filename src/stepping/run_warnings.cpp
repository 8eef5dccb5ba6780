#include "stepping/run_warnings.hpp"

#include <algorithm>
#include <cmath>

#include "coupling/solid_totals.hpp"
#include "interfaces/liquid.hpp"

namespace lockstep {

template <int dim>
void RunWarnings<dim>::warn_of_watches(long long step, const std::vector<WatchedLiquid>& watches,
                                       const LiquidFluid<dim>& liquid, const Log& log) {
  of_watch_.resize(watches.size(), 0);
  for (std::size_t w = 0; w < watches.size(); ++w) {
    if (!std::isnan(watches[w].volume) || of_watch_[w])
      continue;
    of_watch_[w] = 1;
    log.warning(
        "Step {}: the point of the watch \"{}\" sees the centre of no cell, and no cell is left of "
        "the place that it was in. While that is so it is not watched, and its columns are nan. "
        "Later steps like this one are not reported.",
        step, liquid.watch_names()[w]);
  }
}

template <int dim>
void RunWarnings<dim>::warn_of_volume(long long step, const LiquidReport& liquid, const Log& log) {
  constexpr double most = 1e-3;  // part of the liquid
  const double all = liquid.target + liquid.lost, off = liquid.volume - liquid.target;
  if (of_volume_ || std::abs(off) + liquid.lost <= most * all)
    return;
  of_volume_ = true;
  log.warning(
      "Step {}: of the liquid {:.2g} is lost, and its volume is off the target by {:.2g} of it. "
      "What is thinner than a cell, as spray and what bodies press out between them, takes a finer "
      "grid. Later steps like this one are not reported.",
      step, liquid.lost / all, off / all);
}

namespace {
/// True if contact does not see across periodic sides: it does among rigid solids alone.
template <int dim>
bool is_contact_blind(const Components<dim>& components) {
  const std::vector<SolidDescription>& solids = components.solids->solids();
  return components.contact && solids.size() > 1 &&
         std::any_of(solids.begin(), solids.end(),
                     [](const SolidDescription& solid) { return !solid.rigid; });
}
}  // namespace

template <int dim>
void RunWarnings<dim>::warn_of_periodic_sides(long long step, const Components<dim>& components,
                                              const Log& log) {
  constexpr double round_off = 1e-6;  // part of the domain; a pile from side to side ends at both
  const FluidDiscretization<dim>& fluid = *components.fluid;
  if (of_periodic_sides_ || !fluid.is_periodic())
    return;
  const std::array<bool, dim> periodic = fluid.periodic_axes();
  const Box<dim> domain = fluid.bounds();
  const SolidSystem<dim>& all = *components.solids;
  const bool is_blind = is_contact_blind(components);
  int i = 0;
  for (int m = 0; m < all.n_models(); ++m)
    for (const SolidDescription& solid : all.model(m).solids()) {
      Box<dim> box;
      const bool comes_back = all.repeated().includes(i++);
      const bool may_be_lost = !solid.prescribed && (!comes_back || is_blind);
      for (int v = solid.vertex_begin; v < solid.vertex_end && may_be_lost; ++v)
        box.extend(all.model(m).surface().vertices[v]);
      for (int a = 0; a < dim && !box.isEmpty() && !of_periodic_sides_; ++a) {
        const double beyond =
            std::max(box.max()[a] - domain.max()[a], domain.min()[a] - box.min()[a]);
        if (!periodic[a] || beyond <= round_off * domain.sizes()[a])
          continue;
        of_periodic_sides_ = true;
        log.warning(
            "Step {}: \"{}\" goes through a periodic side along {}. {} Later ones are not "
            "reported.",
            step, solid.name, axis_names[a],
            comes_back
                ? "It comes in again at the other side, but beside solids that deform contact "
                  "does not see across such sides: what of it is beyond goes through others."
                : "Fluid and closed solids whose radius and 8 cells fit into half of the domain "
                  "come in again at the other side, this one does not: what of it is beyond "
                  "meets neither fluid nor solids.");
      }
    }
}

template <int dim>
void RunWarnings<dim>::before_step(long long step, const StepBound& bound, const StepBound& wanted,
                                   const Log& log) {
  constexpr int many = 20;
  n_short_ = bound.dt < 0.1 * wanted.dt ? n_short_ + 1 : 0;
  if (n_short_ != many || of_short_steps_)
    return;
  of_short_steps_ = true;
  log.warning(
      "Step {}: for {} steps the bound by the {} ({}) has been less than a tenth of the step by "
      "the {} ({}). {}{}Later steps like this one are not reported.",
      step, many, bound.reason, format_seconds(bound.dt),
      wanted.reason.empty() ? "CFL number" : wanted.reason, format_seconds(wanted.dt), bound.remedy,
      bound.remedy.empty() ? "" : " ");
}

template <int dim>
void RunWarnings<dim>::after_step(long long step, const StepReport<dim>& report,
                                  const Components<dim>& components, const Log& log) {
  if (report.liquid) {
    warn_of_watches(step, report.liquid->watches, *components.fluid->liquid(), log);
    warn_of_volume(step, *report.liquid, log);
  }
  warn_of_periodic_sides(step, components, log);
  if (report.contact_position.n_crossings > 0) {
    log.warning(
        "Step {}: prescribed solids or pinned nodes press surfaces through each other at {} "
        "places, which contact cannot prevent; let them move less, or less far in a step.",
        step, report.contact_position.n_crossings);
  }
  constexpr double most_left = 1e-3;   // times g dt
  constexpr double round_off = 1e-10;  // times a cell in a step
  const double left = std::max(report.contact_position.residual, report.contact_velocity.residual);
  const double least = std::max(most_left * report.dt * components.fluid->gravity().norm(),
                                round_off * components.fluid->smallest_length() / report.dt);
  if (left > least && !of_contact_) {
    of_contact_ = true;
    log.warning(
        "Step {}: solves and contacts still differ by {:.2g} m/s where solids touch; momentum is "
        "kept, rest may not be. Shorter steps help. Later steps like this one are not reported.",
        step, left);
  }
  constexpr double most_stretch = 0.01;
  if (report.stretch_beyond_limit > most_stretch && !of_stretch_) {
    of_stretch_ = true;
    log.warning(
        "Step {}: where cloth is to move next, it is {:.2g} times as long as its \"Stretch Limit\" "
        "allows; no more than that was reached by the sweeps over its edges. Shorter steps help, "
        "unless what holds it pulls it apart. Later steps like this one are not reported.",
        step, 1 + report.stretch_beyond_limit);
  }
  if (!report.is_settled && !of_unsettled_) {
    of_unsettled_ = true;
    log.warning(
        "Step {}: soft solids move so far that the search for where their implicit forces hold "
        "them ended before they agreed; momentum is kept, the shape is not that of these forces. "
        "Shorter steps help. Later steps like this one are not reported.",
        step);
  }
  // Up to here the drag of a disc two cells above a wall is right to 0.1 %.
  constexpr double most = 10;
  if (of_viscous_step_ || report.viscous_number <= most * (1 + 1e-9) ||
      largest_surface_speed(*components.solids) == 0)
    return;
  of_viscous_step_ = true;
  log.warning(
      "Step {}: nu dt/h^2 is {:.3g}. In gaps of a few cells around moving solids, pressure and "
      "drag then lag behind the motion by tens of steps (steady ones are right); with steps "
      "of at most {:.2g} s, where it is {:g}, they follow.",
      step, report.viscous_number, report.dt * most / report.viscous_number, most);
}

template class RunWarnings<2>;
template class RunWarnings<3>;

}  // namespace lockstep
