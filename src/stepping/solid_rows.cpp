#include "stepping/solid_rows.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "base/shortened.hpp"
#include "coupling/automatic_coupling.hpp"
#include "interfaces/liquid.hpp"

namespace lockstep {
namespace {

constexpr int most_rows = 20;  // a scene of many bodies must not scroll away all else

std::string and_more(int n_all) {
  return n_all > most_rows ? fmt::format("{:<22} and {} more\n", "", n_all - most_rows) : "";
}

template <int dim>
std::string size_text(const Point<dim>& size) {
  std::string text = fmt::format("{:.3g}", size[0]);
  for (int a = 1; a < dim; ++a)
    text += fmt::format(" x {:.3g}", size[a]);
  return text;
}

/// Part of the box that is outside of the domain [1]; flat ones are widened by a little.
template <int dim>
double part_outside(Box<dim> box, const Box<dim>& domain) {
  const Point<dim> little = Point<dim>::Constant(1e-9 * domain.sizes().maxCoeff());
  box.min() -= little;
  box.max() += little;
  const Box<dim> inside = box.intersection(domain);
  const double part = inside.isEmpty() ? 0 : inside.volume() / box.volume();
  return part > 1 - 1e-6 ? 0 : 1 - part;
}

/// Names what is unlikely to be meant; empty: nothing.
template <int dim>
std::string doubt(const Box<dim>& box, const SolidDescription& solid,
                  const FluidDiscretization<dim>& fluid) {
  constexpr double fewest_cells = 2;
  const double h = fluid.smallest_length();
  const double size = solid.closed ? box.sizes().minCoeff() : box.sizes().maxCoeff();
  constexpr double most_outside = 0.01;  // part of its box
  const double outside = fluid.is_periodic() ? 0 : part_outside<dim>(box, fluid.bounds());
  if (outside > 1 - 1e-6)
    return "lies outside of the domain, where there is no fluid";
  if (outside > most_outside && solid.closed && solid.rigid && !solid.prescribed)
    return fmt::format("is free to move, but {:.2g} % of its box lie outside of the domain",
                       100 * outside);
  if (size < fewest_cells * h)
    return fmt::format("is {:.3g} cells across; the fluid sees bodies of two and more", size / h);
  return "";
}

/// Names a soft body that bends and has too few elements across, as far as its surface tells how
/// large they are; empty: it has enough.
template <int dim>
std::string coarse_mesh(const SurfaceSnapshot<dim>& surface, int solid) {
  if (!surface.solids()[solid].is_soft_body() || surface.own_bounds(solid).isEmpty())
    return "";
  constexpr double slender = 3;   // longest extent over thickness, from which a body bends
  constexpr double enough = 3.5;  // elements, which surfaces tell of four at least
  const SurfaceMesh<dim> mesh = surface.mesh_of_solid(solid);
  const double area =
      shell_properties<dim>(mesh).measure / static_cast<double>(mesh.simplices.size());
  const double edge = dim == 2 ? area : std::sqrt(2 * area);  // legs of right triangles
  const double across = thickness<dim>(surface, solid) / edge;
  const double extent = surface.own_bounds(solid).sizes().maxCoeff();
  if (extent < slender * across * edge || across >= enough)
    return "";
  return fmt::format(
      "has about {:.0f} of its elements across; linear ones are too stiff in bending, 1 across by "
      "a factor of 4, 2 by 75 %, 4 by 19 %, 8 by 5 %",
      std::max(across, 1.0));
}

/// Solids that are lighter than the liquid and have all corners of their boxes under its surface.
template <int dim>
std::vector<char> sunk_solids(const Components<dim>& components,
                              const SurfaceSnapshot<dim>& surface) {
  const FluidDiscretization<dim>& fluid = *components.fluid;
  const std::vector<SolidDescription>& solids = surface.solids();
  std::vector<char> sunk(solids.size(), 0);
  const auto* liquid = fluid.liquid();
  if (!liquid)
    return sunk;
  constexpr int n_corners = 1 << dim;
  const std::vector<SolidState<dim>> states = components.solids->states();
  std::vector<Point<dim>> corners;
  for (std::size_t i = 0; i < solids.size(); ++i)
    for (int k = 0; k < n_corners; ++k) {
      const Box<dim>& box = surface.own_bounds(static_cast<int>(i));
      corners.push_back(box.isEmpty() ? states[i].center_of_mass
                                      : box.corner(static_cast<typename Box<dim>::CornerType>(k)));
    }
  const std::vector<double> distances = liquid->surface_distances(corners);
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const double density = fluid.density(states[i].center_of_mass);
    const bool floats = solids[i].closed && !solids[i].prescribed && states[i].volume > 0 &&
                        states[i].mass < density * states[i].volume;
    const auto begin = distances.begin() + n_corners * static_cast<std::ptrdiff_t>(i);
    sunk[i] = floats && std::all_of(begin, begin + n_corners, [](double d) { return d < 0; });
  }
  return sunk;
}

/// A warning where solids may leave a periodic domain for good; empty: none can.
template <int dim>
std::string periodic_warning(const SolidSystem<dim>& system,
                             const FluidDiscretization<dim>& fluid) {
  const std::vector<SolidDescription>& solids = system.solids();
  const auto is_free = [&](const SolidDescription& solid) {
    const int i = static_cast<int>(&solid - solids.data());
    return !solid.prescribed && solid.simplex_end > solid.simplex_begin &&
           !system.repeated().includes(i);
  };
  const auto first = std::find_if(solids.begin(), solids.end(), is_free);
  if (first == solids.end() || !fluid.is_periodic())
    return "";
  const std::array<bool, dim> periodic = fluid.periodic_axes();
  std::vector<char> axes;
  for (int a = 0; a < dim; ++a)
    if (periodic[a])
      axes.push_back("xyz"[a]);
  return fmt::format(
      "{:<22} the domain is periodic along {} for fluid and closed solids whose radius and 8 cells "
      "fit into half of it: what of \"{}\"{} goes through such a side meets neither fluid nor "
      "solids beyond it\n",
      "warning", fmt::join(axes, " and "), shortened(first->name),
      std::count_if(first, solids.end(), is_free) > 1 ? " and other free solids" : "");
}

template <int dim>
std::string row(const Components<dim>& components, const SolidDescription& solid,
                const SolidState<dim>& state, const Box<dim>& box) {
  const FluidDiscretization<dim>& fluid = *components.fluid;
  const char* power = dim == 2 ? "m^2" : "m^3";
  if (is_line(solid))
    return "a line, which acts on its solids alone";
  std::string text = solid.prescribed ? "prescribed" : fmt::format("{:.3g} kg", state.mass);
  if (solid.closed)
    text += fmt::format(", {:.3g} {}", state.volume, power);
  if (box.isEmpty())
    return text + ", below the grid: the fluid does not see it";
  text += fmt::format(", {} m ({} cells), {} {}, {} inside", size_text<dim>(box.sizes()),
                      size_text<dim>(box.sizes() / fluid.smallest_length()),
                      solid.simplex_end - solid.simplex_begin, dim == 2 ? "segments" : "triangles",
                      solid.closed ? "dry" : "wet");
  const double outside = fluid.is_periodic() ? 0 : part_outside<dim>(box, fluid.bounds());
  if (outside > 0)
    text += fmt::format(", {:.2g} % of its box outside of the domain", 100 * outside);
  const StepBound bound =
      std::as_const(*components.solids).model(solid.model).largest_stable_step();
  if (bound.dt < StepBound{}.dt && !solid.prescribed)
    text += fmt::format(", steps of at most {:.3g} s ({})", bound.dt, bound.reason);
  return text;
}

/// Distance of the farthest node or end of a line that each solid carries from the solid's box [m].
/// Collective.
template <int dim>
std::vector<double> attachment_distances(const SolidSystem<dim>& system,
                                         const SurfaceSnapshot<dim>& surface) {
  std::vector<double> distances(surface.solids().size(), 0);
  for (const AttachedNode<dim>& node : system.attached()) {
    const Box<dim>& box = surface.own_bounds(node.solid);
    if (!box.isEmpty())
      distances[node.solid] = std::max(distances[node.solid], box.exteriorDistance(node.position));
  }
  for (double& distance : distances)
    distance = max_all(system.comm(), distance);
  return distances;
}

}  // namespace

bool is_line(const SolidDescription& solid) {
  return !solid.closed && solid.simplex_begin == solid.simplex_end;
}

template <int dim>
std::string solid_rows(const Components<dim>& components, const SurfaceSnapshot<dim>& surface) {
  const std::vector<SolidDescription>& solids = surface.solids();
  const std::vector<SolidState<dim>> states = components.solids->states();
  const int n = static_cast<int>(solids.size());
  std::string text;
  for (int i = 0; i < std::min(n, most_rows); ++i)
    text += fmt::format("  {:<20} {}\n", shortened(solids[i].name),
                        row(components, solids[i], states[i], surface.own_bounds(i)));
  return text + and_more(n);
}

template <int dim>
std::string solid_warnings(const Components<dim>& components, const SurfaceSnapshot<dim>& surface) {
  const std::vector<SolidDescription>& solids = surface.solids();
  const std::vector<char> sunk = sunk_solids(components, surface);
  const std::vector<double> distances = attachment_distances(*components.solids, surface);
  constexpr double far_cells = 2;
  std::string text;
  int n = 0;
  for (std::size_t i = 0; i < solids.size(); ++i) {
    const Box<dim> box = surface.own_bounds(static_cast<int>(i));
    std::string what = box.isEmpty() ? "" : doubt<dim>(box, solids[i], *components.fluid);
    if (what.empty() && sunk[i])
      what = "floats in the liquid, but is all under its surface at the start";
    if (what.empty() && distances[i] > far_cells * components.fluid->smallest_length())
      what = fmt::format("carries what is attached to it up to {:.2g} m away from its box",
                         distances[i]);
    for (const std::string& row : {what, coarse_mesh<dim>(surface, static_cast<int>(i))})
      if (!row.empty() && n++ < most_rows)
        text += fmt::format("{:<22} \"{}\" {}\n", "warning", shortened(solids[i].name), row);
  }
  return text + and_more(n) + periodic_warning<dim>(*components.solids, *components.fluid);
}

template std::string solid_rows(const Components<2>&, const SurfaceSnapshot<2>&);
template std::string solid_rows(const Components<3>&, const SurfaceSnapshot<3>&);
template std::string solid_warnings(const Components<2>&, const SurfaceSnapshot<2>&);
template std::string solid_warnings(const Components<3>&, const SurfaceSnapshot<3>&);

}  // namespace lockstep
