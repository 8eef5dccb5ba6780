#pragma once
#include <memory>
#include <string>
#include <vector>

#include "geometry/surface_snapshot.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// A place whose liquid is measured.
template <int dim>
struct Watch {
  std::string name;  ///< as columns have it
  Point<dim> point = Point<dim>::Zero();
  std::string solid;      ///< the point moves with it; empty: with none
  double radius = 1e300;  ///< distance from the point beyond which nothing is watched [m]
};

/// Declares the list "Watch".
template <int dim>
void declare_watches(ParameterList& free_surface);
/// Throws InputError if two have the same name in columns.
template <int dim>
std::vector<Watch<dim>> read_watches(const ParameterList& free_surface);

/// A point that moves with a solid: as its vertices do, taken together as a rigid body.
template <int dim>
class Anchor {
 public:
  /// Throws InputError if the solid that the watch names does not exist. `surface` may be null.
  Anchor(const Watch<dim>& watch, const std::shared_ptr<const SurfaceSnapshot<dim>>& surface);
  Point<dim> place(const std::shared_ptr<const SurfaceSnapshot<dim>>& surface) const;

 private:
  using Places = Eigen::Matrix<double, dim, Eigen::Dynamic>;
  Places vertices(const SurfaceSnapshot<dim>& surface) const;

  Point<dim> point_;  ///< at the start
  int solid_ = -1;    ///< none: the point does not move
  Places start_;      ///< places of the solid's vertices at the start
};

}  // namespace lockstep
