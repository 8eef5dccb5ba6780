#pragma once
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "parameters/parameter_list.hpp"
#include "staggered/domain/region_shape.hpp"
#include "staggered/state/mac_geometry.hpp"

namespace lockstep {

/// Feeds scalars, and pushes fluid, inside a part of space.
template <int dim>
struct ScalarSource {
  struct Feed {
    std::string scalar;
    double value = 0;  ///< value of the scalar inside
  };
  RegionShape<dim> shape;
  std::vector<Feed> feeds;
  bool liquid = false;                      ///< fills its shape with liquid
  std::optional<Point<dim>> velocity;       ///< set inside [m/s]
  double begin_time = 0, end_time = 1e300;  ///< [s]

  bool active(double time) const { return time >= begin_time && time < end_time; }
};

/// A quantity that the fluid carries, at cell centres. Not diffused.
struct Scalar {
  std::string name;  ///< "smoke", "temperature"
  std::string unit;
  double ambient = 0;  ///< where nothing else is known
  CellField values{};
};

/// The scalars of a scene; those it does not name do not exist.
template <int dim>
class Scalars {
 public:
  Scalars(const MacDomain<dim>& domain, const ParameterList& fluid);

  bool empty() const { return scalars_.empty(); }
  std::vector<Scalar>& all() { return scalars_; }
  const std::vector<Scalar>& all() const { return scalars_; }
  /// A scalar, or null if the scene has none of that name.
  const Scalar* find(const std::string& name) const;
  /// Feeds the fluid cells inside the sources that are active at `time`. Sets owned cells. Local.
  void feed(const MacGeometry<dim>& geometry, double time);
  /// Distance functions [m] of the shapes that are filled with liquid at `time`.
  std::vector<std::function<double(const Point<dim>&)>> liquid_sources(double time) const;
  /// True if a source that is active at `time` sets the velocity.
  bool sources_push(double time) const;
  /// True if a source sets the velocity at `now` that did not yet `earlier`.
  bool begin_to_push(double earlier, double now) const;
  /// Sets the velocity of owned free faces inside sources that do so. Local.
  void push(const MacGeometry<dim>& geometry, double time, FaceField<dim>& velocity) const;

 private:
  const MacDomain<dim>& domain_;
  std::vector<Scalar> scalars_;
  std::vector<ScalarSource<dim>> sources_;
};

/// Declares "Smoke", "Temperature" and "Sources" in the fluid's list.
template <int dim>
void declare_scalars(ParameterList& fluid);

}  // namespace lockstep
