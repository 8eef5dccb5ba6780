// Surfaces with flat sides: box, open box, plate. The round ones are in round_generators.cpp.
#include "geometry/generators.hpp"

#include <map>

#include "geometry/surface_builder.hpp"

namespace lockstep {

namespace {

/// Assembles faces of a regular lattice over a box centred at the origin; equal lattice points
/// become one vertex.
template <int dim>
class LatticeBox {
 public:
  LatticeBox(const Point<dim>& size, double step) : size_(size) {
    for (int a = 0; a < dim; ++a)
      n_[a] = n_steps(size[a], step);
  }

  /// Adds the side normal to `axis`, facing up (side +1) or down (-1), at the upper, lower or, for
  /// level 0, the middle plane.
  void add_side(int axis, int side, int level) {
    if constexpr (dim == 2) {
      const int along = 1 - axis;
      for (int i = 0; i < n_[along]; ++i) {
        // The segment along +y faces +x, the one along +x faces -y.
        const bool forward = (side > 0) == (axis == 0);
        Index<2> from{}, to{};
        from[along] = i;
        to[along] = i + 1;
        const int p = vertex(from, axis, level), q = vertex(to, axis, level);
        mesh_.simplices.push_back(forward ? Index<2>{p, q} : Index<2>{q, p});
      }
    } else {
      const int u = (axis + 1) % 3, v = (axis + 2) % 3;
      for (int j = 0; j < n_[v]; ++j)
        for (int i = 0; i < n_[u]; ++i) {
          Index<3> corner[4] = {};
          for (int k = 0; k < 4; ++k) {
            corner[k][u] = i + (k == 1 || k == 2);
            corner[k][v] = j + (k >= 2);
          }
          int p[4];
          for (int k = 0; k < 4; ++k)
            p[k] = vertex(corner[k], axis, level);
          if (side < 0)
            std::swap(p[1], p[3]);
          mesh_.simplices.push_back({p[0], p[1], p[2]});
          mesh_.simplices.push_back({p[0], p[2], p[3]});
        }
    }
  }

  SurfaceMesh<dim> take() { return std::move(mesh_); }

 private:
  int vertex(Index<dim> lattice, int axis, int level) {
    // A middle plane has no lattice number of its own; it is only used for plates, alone.
    lattice[axis] = level > 0 ? n_[axis] : 0;
    const auto [entry, is_new] =
        vertices_.emplace(lattice, static_cast<int>(mesh_.vertices.size()));
    if (is_new) {
      Point<dim> x;
      for (int a = 0; a < dim; ++a)
        x[a] = (static_cast<double>(lattice[a]) / n_[a] - 0.5) * size_[a];
      if (level == 0)
        x[axis] = 0;
      mesh_.vertices.push_back(x);
    }
    return entry->second;
  }

  Point<dim> size_;
  Index<dim> n_{};
  std::map<Index<dim>, int> vertices_;
  SurfaceMesh<dim> mesh_;
};

/// Sides of squares whose diagonal is the wanted edge length.
template <int dim>
double lattice_step(double spacing) {
  return dim == 2 ? spacing : spacing / std::sqrt(2.0);
}

}  // namespace

template <int dim>
SurfaceMesh<dim> box_surface(const Point<dim>& size, double spacing) {
  check_shape("Box", size.minCoeff(), size.maxCoeff(), spacing);
  LatticeBox<dim> box(size, lattice_step<dim>(spacing));
  for (int a = 0; a < dim; ++a)
    for (const int side : {-1, 1})
      box.add_side(a, side, side);
  return box.take();
}

template <int dim>
SurfaceMesh<dim> open_box_surface(const Point<dim>& size, double spacing) {
  check_shape("Open box", size.minCoeff(), size.maxCoeff(), spacing);
  LatticeBox<dim> box(size, lattice_step<dim>(spacing));
  for (int a = 0; a < dim; ++a)
    for (const int side : {-1, 1})
      if (a != 1 || side < 0)
        box.add_side(a, side, side);
  return box.take();
}

template <int dim>
SurfaceMesh<dim> plate_surface(const Point<dim>& size, int axis, double spacing) {
  check_input(axis >= 0 && axis < dim, "Plate: the normal axis must be 0 to {}, but is {}.",
              dim - 1, axis);
  Point<dim> extent = size;
  extent[axis] = size[axis == 0 ? 1 : 0];
  check_shape("Plate", extent.minCoeff(), extent.maxCoeff(), spacing);
  LatticeBox<dim> box(extent, lattice_step<dim>(spacing));
  box.add_side(axis, 1, 0);
  return box.take();
}

template SurfaceMesh<2> box_surface<2>(const Point<2>&, double);
template SurfaceMesh<3> box_surface<3>(const Point<3>&, double);
template SurfaceMesh<2> open_box_surface<2>(const Point<2>&, double);
template SurfaceMesh<3> open_box_surface<3>(const Point<3>&, double);
template SurfaceMesh<2> plate_surface<2>(const Point<2>&, int, double);
template SurfaceMesh<3> plate_surface<3>(const Point<3>&, int, double);

}  // namespace lockstep
