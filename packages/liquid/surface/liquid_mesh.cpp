#include "liquid/surface/liquid_mesh.hpp"

#include <cmath>
#include <map>

namespace lockstep {

namespace {
template <int dim>
class MeshBuilder {
 public:
  MeshBuilder(const MacDomain<dim>& domain, const CellField& distance)
      : grid_(domain.grid), distance_(distance) {}

  SurfaceMesh<dim> build() {
    grid_.for_each_owned_cell([&](int cell) {
      const Index<dim> upper = grid_.coordinates(cell);
      for (int axis = 0; axis < dim; ++axis) {
        Index<dim> lower = upper;
        --lower[axis];
        add_link(lower, upper, axis);
        if (upper[axis] + 1 == grid_.n_cells()[axis] && !grid_.description().periodic[axis]) {
          Index<dim> beyond = upper;
          ++beyond[axis];
          add_link(upper, beyond, axis);
        }
      }
    });
    return std::move(mesh_);
  }

 private:
  /// phi of a cell; beyond the domain its magnitude, as if a wall that the liquid touches were the
  /// surface.
  double value(Index<dim> c) const {
    bool beyond = false;
    for (int a = 0; a < dim; ++a) {
      if (grid_.description().periodic[a])
        continue;
      const int inside = std::min(std::max(c[a], 0), grid_.n_cells()[a] - 1);
      beyond = beyond || inside != c[a];
      c[a] = inside;
    }
    const int cell = grid_.cell(c);
    const double inside = cell < 0 ? grid_.spacing() : distance_[cell];
    return beyond ? std::abs(inside) : inside;
  }

  /// A wet cell and a dry one: a facet between the dual cubes around the link.
  void add_link(const Index<dim>& lower, const Index<dim>& upper, int axis) {
    const bool wet_below = value(lower) < 0;
    if (wet_below == (value(upper) < 0))
      return;
    const auto cube = [&](int i, int j) {
      Index<dim> base = lower;
      base[(axis + 1) % dim] -= i;
      if (dim == 3)
        base[(axis + 2) % dim] -= j;
      return vertex(base);
    };
    if constexpr (dim == 2) {
      // The normal of a -> b is b - a turned clockwise.
      const bool turned = (axis == 0) != wet_below;
      mesh_.simplices.push_back(turned ? std::array<int, 2>{cube(0, 0), cube(1, 0)}
                                       : std::array<int, 2>{cube(1, 0), cube(0, 0)});
    } else {
      const std::array<int, 4> around{cube(1, 1), cube(0, 1), cube(0, 0), cube(1, 0)};
      for (const auto& [b, c] : {std::pair{1, 2}, std::pair{2, 3}})
        mesh_.simplices.push_back(wet_below ? std::array<int, 3>{around[0], around[b], around[c]}
                                            : std::array<int, 3>{around[0], around[c], around[b]});
    }
  }

  /// Number of the vertex in the dual cube whose lowest corner is the centre of that cell.
  int vertex(const Index<dim>& base) {
    const auto [place, is_new] = number_.emplace(base, static_cast<int>(mesh_.vertices.size()));
    if (is_new)
      mesh_.vertices.push_back(mean_crossing(base));
    return place->second;
  }

  Point<dim> mean_crossing(const Index<dim>& base) const {
    std::array<double, 1 << dim> values;
    const auto corner = [&](int k) {
      Index<dim> c = base;
      for (int a = 0; a < dim; ++a)
        c[a] += k >> a & 1;
      return c;
    };
    for (int k = 0; k < 1 << dim; ++k)
      values[k] = value(corner(k));
    Point<dim> sum = Point<dim>::Zero();
    int n = 0;
    for (int k = 0; k < 1 << dim; ++k) {
      for (int a = 0; a < dim; ++a) {
        const int other = k | 1 << a;
        if (other == k || (values[k] < 0) == (values[other] < 0))
          continue;
        sum += grid_.lattice().center(corner(k)) +
               values[k] / (values[k] - values[other]) * grid_.spacing() * Point<dim>::Unit(a);
        ++n;
      }
    }
    return sum / n;
  }

  const TiledGrid<dim>& grid_;
  const CellField& distance_;
  SurfaceMesh<dim> mesh_;
  std::map<Index<dim>, int> number_;  ///< number of the vertex by dual cube
};
}  // namespace

template <int dim>
SurfaceMesh<dim> liquid_mesh(const MacDomain<dim>& domain, const CellField& distance) {
  return MeshBuilder<dim>(domain, distance).build();
}

template SurfaceMesh<2> liquid_mesh<2>(const MacDomain<2>&, const CellField&);
template SurfaceMesh<3> liquid_mesh<3>(const MacDomain<3>&, const CellField&);

}  // namespace lockstep
