#pragma once
#include <vector>

#include "coupling/solid_system.hpp"
#include "interfaces/fluid.hpp"

namespace lockstep {

/// The angular velocity of the part of a soft solid's surface near a mixed face, by least squares:
/// Omega = J^-1 sum_k r_k x v_k over the vertices k around, r_k their arms about the mean and
/// J = sum_k (|r_k|^2 - r_k r_k^T). With it the velocity of a surface point p is carried to the
/// face's centre x as v(x) = v(p) + Omega x (x - p). Of a rigid motion that is the motion itself,
/// so that a turning body stays discretely free of divergence, and the transposed map hands on a
/// force at x with its torque about any point.
template <int dim>
class LocalRotation {
 public:
  /// From the vertices of `simplices`, those of `solid` in the dual cell `box`, so that rows take
  /// no nodes beyond their own. Where those lie on a point or a line, or too close together to tell
  /// a rotation at `arm` [m], the longest arm, from simplices in a box around it that is widened.
  /// Local.
  LocalRotation(const Box<dim>& box, double arm, std::vector<int> simplices, int solid,
                const SurfaceSnapshot<dim>& surface);

  /// Omega x arm for given vertex velocities: `velocity_of(SurfacePoint)` [m/s].
  template <typename VelocityOf>
  Point<dim> velocity_at(const Point<dim>& arm, const VelocityOf& velocity_of) const {
    AngularVector<dim> spin = AngularVector<dim>::Zero();
    for (std::size_t k = 0; k < vertices_.size(); ++k)
      spin += cross<dim>(arms_[k], velocity_of(vertices_[k]));
    return rotate<dim>(inverse_ * spin, arm);
  }
  /// Calls `add(vertex, coefficient)`: e . (Omega x arm) = sum of coefficient . velocity of vertex,
  /// for e along the axis `direction`.
  template <typename Add>
  void row(const Point<dim>& arm, int direction, const Add& add) const {
    const AngularVector<dim> turn = inverse_ * cross<dim>(arm, Point<dim>::Unit(direction));
    for (std::size_t k = 0; k < vertices_.size(); ++k)
      add(vertices_[k], rotate<dim>(turn, arms_[k]));
  }

 private:
  using Inertia = Eigen::Matrix<double, n_rotations<dim>, n_rotations<dim>>;
  void collect(const std::vector<int>& simplices, int solid, const SurfaceSnapshot<dim>& surface);
  Inertia inertia() const;
  /// Takes the inverse of the inertia; false if the vertices are too few or too close.
  bool invert(double arm);

  std::vector<SurfacePoint<dim>> vertices_;
  std::vector<Point<dim>> arms_;
  Inertia inverse_ = Inertia::Zero();
};

}  // namespace lockstep
