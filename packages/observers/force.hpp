#pragma once
#include <optional>
#include <string>
#include <vector>

#include "observers/observed_solid.hpp"
#include "parameters/field_formula.hpp"
#include "parameters/parameter_list.hpp"

namespace lockstep {

/// Schema of the observer "force".
template <int dim>
ParameterList force_parameters();

/// The fluid's force and torque on a part of a solid's surface, which is told by where its points
/// are at the first look. Parts that together are the surface, and do not overlap, have the force
/// and the torque of the solid in bodies.csv (docs/output.md, "Forces on parts of a surface").
template <int dim>
class Force : public Observer<dim> {
 public:
  explicit Force(const ParameterList& list);
  std::string name() const override { return "force"; }
  std::vector<ObservedColumn> columns() const override;
  bool wants_forces() const override { return true; }
  std::vector<std::vector<double>> observe(const RunView<dim>& run) override;
  void save(CheckpointWriter& writer) const override;
  void load(const CheckpointReader& reader) override;

 private:
  /// True if a point that was at x at the start is of the part. Local.
  bool includes(const Point<dim>& x) const;
  /// Takes the surface as it is now for that of the start, and measures the part.
  void begin(const ObservedSolid<dim>& observed, double spacing);
  void measure(double spacing);
  Momentum<dim> impulse_on_part(const ObservedSolid<dim>& observed,
                                const SurfaceForces<dim>& forces) const;

  std::string path_;  ///< for messages
  std::string solid_;
  Box<dim> box_;                                       ///< upper sides are not of the part [m]
  std::optional<FieldFormula<dim>> where_;             ///< positive in the part; none: everywhere
  std::vector<std::array<Point<dim>, dim>> at_start_;  ///< corners of its simplices [m]
  double area_ = 0, whole_area_ = 0;                   ///< area of the part, and of all [m^(dim-1)]
};

}  // namespace lockstep
