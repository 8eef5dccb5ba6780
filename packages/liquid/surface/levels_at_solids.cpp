#include "liquid/surface/levels_at_solids.hpp"

#include <algorithm>
#include <cmath>

namespace lockstep {

namespace {
/// Distance from solids in which the free surface around them is searched [cells].
constexpr int reach_of_levels = 2;

/// Heights of the places where liquid meets air, around one solid or all of them.
struct Heights {
  double sum = 0, n = 0;
  double n_air = 0;  ///< cells of air near the solid
  double n_wet = 0;  ///< ranks that have a cell of liquid at it
};

template <int dim>
class LevelFinder {
 public:
  LevelFinder(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
              const FreeSurface<dim>& free_surface, const Point<dim>& gravity)
      : grid_(domain.grid),
        geometry_(geometry),
        cells_(geometry.state.cells),
        distance_(*free_surface.distance),
        has_gas_(free_surface.has_gas()),
        up_(-gravity.normalized()),
        surface_(*geometry.state.surface) {}

  std::vector<WaterLevel> find() {
    const int n_solids = static_cast<int>(surface_.solids().size());
    std::vector<Heights> heights(n_solids);
    for (int s = 0; s < n_solids; ++s)
      if (surface_.solids()[s].simplex_begin < surface_.solids()[s].simplex_end)
        look_around(s, heights[s]);
    sum(heights);
    // Below the surface, or parted from it, that of all the water is the best there is.
    std::vector<Heights> all(1);
    if (std::any_of(heights.begin(), heights.end(), [](const Heights& h) { return h.n == 0; })) {
      look_everywhere(all[0]);
      sum(all);
    }
    std::vector<WaterLevel> levels(n_solids);
    for (int s = 0; s < n_solids; ++s) {
      levels[s].pierces = heights[s].n_air > 0;
      levels[s].is_wet = heights[s].n_wet > 0;
      const Heights& known = heights[s].n > 0 ? heights[s] : all[0];
      levels[s].known = known.n > 0;
      levels[s].height = known.n > 0 ? known.sum / known.n : 0;
    }
    return levels;
  }

 private:
  void add(const Point<dim>& x, Heights& heights) const {
    heights.sum += up_.dot(x);
    ++heights.n;
  }

  void look_around(int solid, Heights& heights) {
    for (const Box<dim>& bounds : surface_.bounds_of_images(solid))
      look_around(solid, bounds, heights);
  }

  /// Cells count, and not phi, which deep in solids is that of an earlier place of the solid.
  void look_around(int solid, const Box<dim>& bounds, Heights& heights) {
    const Point<dim> margin = Point<dim>::Constant(reach_of_levels * grid_.spacing());
    const Box<dim> around(bounds.min() - margin, bounds.max() + margin);
    surface_.solids_touching(around, candidates_);
    const bool is_alone = candidates_.size() == 1;
    const Point<dim> one_cell = Point<dim>::Constant(grid_.spacing());
    const Box<dim> beside(bounds.min() - one_cell, bounds.max() + one_cell);
    for_each_cell_in(around, [&](int cell) {
      const Point<dim> center = grid_.center(cell);
      heights.n_air += is_air(cell) ? 1 : 0;
      if (heights.n_wet == 0 && is_liquid(cell) && beside.contains(center) &&
          (is_alone || is_in_sight(solid, center)))
        heights.n_wet = 1;
      for_each_place(cell, [&](const Point<dim>& x) {
        if (is_alone || is_in_sight(solid, x))
          add(x, heights);
      });
    });
  }

  void look_everywhere(Heights& heights) const {
    for_each_cell_in(
        Box<dim>(Point<dim>::Constant(-1e300), Point<dim>::Constant(1e300)),
        [&](int cell) { for_each_place(cell, [&](const Point<dim>& x) { add(x, heights); }); });
  }

  /// Calls f(cell) for the owned cells of the domain that a box touches.
  template <typename Function>
  void for_each_cell_in(const Box<dim>& box, const Function& f) const {
    for (int tile = 0; tile < grid_.n_owned_tiles(); ++tile) {
      Index<dim> begin, end;
      bool any = true;
      for (int a = 0; a < dim; ++a) {
        const auto place = [&](double x) {
          return static_cast<int>(
              std::floor(std::min(std::max((x - grid_.lower()[a]) / grid_.spacing(), -1.0), 1e9)));
        };
        begin[a] = std::max(place(box.min()[a]), grid_.tile_begin(tile)[a]);
        end[a] = std::min(place(box.max()[a]) + 1,
                          grid_.tile_begin(tile)[a] + grid_.tile_domain_extent(tile)[a]);
        any = any && begin[a] < end[a];
      }
      Index<dim> cell = begin;
      while (any) {
        f(grid_.cell(cell));
        int a = 0;
        while (a < dim && ++cell[a] == end[a])
          cell[a] = begin[a], ++a;
        any = a < dim;
      }
    }
  }

  /// Calls f(x) for the places where liquid meets air between a cell and those below it.
  template <typename Function>
  void for_each_place(int cell, const Function& f) const {
    for (int axis = 0; axis < dim; ++axis) {
      const int lower = grid_.neighbor(cell, axis, 0);
      if (lower < 0)
        continue;
      if ((is_liquid(cell) && is_air(lower)) || (is_air(cell) && is_liquid(lower))) {
        const double part = distance_[cell] / (distance_[cell] - distance_[lower]);
        if (!geometry_.near_surface(cell) || !parted(cell, axis))
          f(grid_.center(cell) - part * grid_.spacing() * Point<dim>::Unit(axis));
      }
    }
  }

  bool is_air(int cell) const {
    return has_gas_ ? cells_[cell] == CellState::fluid && distance_[cell] >= 0
                    : cells_[cell] == CellState::air;
  }
  bool is_liquid(int cell) const { return cells_[cell] == CellState::fluid && !is_air(cell); }
  /// True if a solid parts a cell from the one below it: then no free surface is between them.
  bool parted(int cell, int axis) const {
    const Point<dim> x = grid_.center(cell);
    return surface_.first_hit(x, x - grid_.spacing() * Point<dim>::Unit(axis)).has_value();
  }
  /// The free surface beyond a hull is none to what lies in it.
  bool is_in_sight(int solid, const Point<dim>& place) const {
    const auto hit = surface_.first_hit(place, surface_.closest_on_solid(place, solid).position);
    return !hit || surface_.solid_of(hit->simplex) == solid;
  }

  void sum(std::vector<Heights>& heights) const {
    std::vector<double> values;
    for (const Heights& one : heights)
      values.insert(values.end(), {one.sum, one.n, one.n_air, one.n_wet});
    sum_all(grid_.comm(), values.data(), static_cast<int>(values.size()));
    auto value = values.cbegin();
    for (Heights& one : heights) {
      one.sum = *value++;
      one.n = *value++;
      one.n_air = *value++;
      one.n_wet = *value++;
    }
  }

  const TiledGrid<dim>& grid_;
  const MacGeometry<dim>& geometry_;
  const std::vector<CellState>& cells_;
  const CellField& distance_;
  bool has_gas_;
  Point<dim> up_;
  const SurfaceSnapshot<dim>& surface_;
  std::vector<int> candidates_;
};
}  // namespace

template <int dim>
std::vector<WaterLevel> find_levels_at_solids(const MacDomain<dim>& domain,
                                              const MacGeometry<dim>& geometry,
                                              const FreeSurface<dim>& free_surface,
                                              const Point<dim>& gravity) {
  if (!geometry.state.surface)
    return {};
  if (gravity.isZero(0))
    return std::vector<WaterLevel>(geometry.state.surface->solids().size());
  return LevelFinder<dim>(domain, geometry, free_surface, gravity).find();
}

template std::vector<WaterLevel> find_levels_at_solids<2>(const MacDomain<2>&,
                                                          const MacGeometry<2>&,
                                                          const FreeSurface<2>&, const Point<2>&);
template std::vector<WaterLevel> find_levels_at_solids<3>(const MacDomain<3>&,
                                                          const MacGeometry<3>&,
                                                          const FreeSurface<3>&, const Point<3>&);

}  // namespace lockstep
