#pragma once
#include <string>
#include <utility>
#include <vector>

#include "interfaces/fluid_sides.hpp"
#include "mac/parts/mac_tiles.hpp"

namespace lockstep {

/// Samples, fields and notes of the fluid.
template <int dim>
class MacOutput : public FluidOutput<dim> {
 public:
  MacOutput(const MacFlow<dim>& flow, const MacTiles<dim>& tiles) : flow_(flow), tiles_(tiles) {}

  /// Multilinear from the samples around a point that have a value, those beyond a thin shell
  /// included.
  std::vector<FluidSample<dim>> sample(const std::vector<Point<dim>>& points) const override;
  /// Returns the flow of faces, multilinear between them.
  std::vector<FlowSample> flow_across(int axis,
                                      const std::vector<Point<dim>>& points) const override;
  void add_frame(std::vector<BoxFrame>& boxes) const override;
  /// "water", "drops"; gathered, since frames are few and a surface small.
  void add_surfaces(std::vector<SurfaceFrame>& surfaces) const override;
  std::vector<std::string> surface_names() const override;
  std::vector<std::pair<std::string, std::string>> notes() const override;

 private:
  const MacFlow<dim>& flow_;
  const MacTiles<dim>& tiles_;
};

}  // namespace lockstep
