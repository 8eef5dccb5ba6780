#pragma once
#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstdint>

namespace lockstep {

inline constexpr double pi = 3.14159265358979323846;

/// A point or vector of physical space [m, m/s, N, ... by context].
template <int dim>
using Point = Eigen::Matrix<double, dim, 1>;

/// Integer coordinates of a cell or a tile.
template <int dim>
using Index = std::array<int, dim>;

/// Number of rotations of a rigid motion: 1 (about z) in 2D, 3 in 3D.
template <int dim>
constexpr int n_rotations = dim == 2 ? 1 : 3;

/// Angular velocity, torque or angular momentum: the z component alone in 2D.
template <int dim>
using AngularVector = Eigen::Matrix<double, n_rotations<dim>, 1>;

/// Barycentric coordinates on a surface simplex (segment in 2D, triangle in 3D); they sum to one.
template <int dim>
using Barycentric = Eigen::Matrix<double, dim, 1>;

/// Axis-parallel box.
template <int dim>
using Box = Eigen::AlignedBox<double, dim>;

/// The box and what is within `margin` of it along each axis.
template <int dim>
Box<dim> inflated(const Box<dim>& box, double margin) {
  return Box<dim>(box.min().array() - margin, box.max().array() + margin);
}

inline constexpr const char* axis_names[] = {"x", "y", "z"};

/// Identifier that is unique over all ranks (pressure unknowns, cells, solid dofs).
using GlobalIndex = long long;
constexpr GlobalIndex no_index = -1;

/// r x f: the torque about the origin of arm r.
template <int dim>
AngularVector<dim> cross(const Point<dim>& r, const Point<dim>& f) {
  if constexpr (dim == 2) {
    return AngularVector<2>(r.x() * f.y() - r.y() * f.x());
  } else {
    return r.cross(f);
  }
}

/// w x r: the velocity at arm r of a rotation with angular velocity w.
template <int dim>
Point<dim> rotate(const AngularVector<dim>& w, const Point<dim>& r) {
  if constexpr (dim == 2) {
    return Point<2>(-w(0) * r.y(), w(0) * r.x());
  } else {
    return w.cross(r);
  }
}

}  // namespace lockstep
