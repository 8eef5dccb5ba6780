#include "stepping/view.hpp"

#include <algorithm>

#include "base/errors.hpp"

namespace lockstep {

void declare_view(ParameterList& scene, int dim) {
  ParameterList& view =
      declare_list(scene, "View",
                   "View of the scene in tools/render, tools/report and tools/plot-frame; the run "
                   "ignores it. Up is against gravity, or y.");
  declare_optional<double>(view, "Time", "Time of the picture [s]; default the last frame.");
  declare_optional<std::string>(
      view, "Field",
      "A field of the fluid, such as smoke, velocity or pressure; default "
      "the first of those, in three dimensions with water none.");
  if (dim == 2)
    return;
  declare_optional<ParameterArray<double>>(
      view, "Direction",
      "Direction from the scene to the eye [1]; default from the front, the right and above.");
  declare_optional<ParameterArray<double>>(
      view, "Center", "Middle of the picture [m]; default that of the domain.");
  set_length(view, "Direction", dim);
  set_length(view, "Center", dim);
  declare_positive(view, "Zoom", 1., "1: all of the domain is in the picture; 2: half of it [1].");
  declare_choice(view, "Style", "slice", {"slice", "volume"},
                 "Style of the field: across a plane, or as a cloud.");
}

void check_view(const ParameterList& scene) {
  const ParameterList& view = scene.sublist("View");
  if (view.isParameter("Direction")) {
    const auto& direction = view.get<ParameterArray<double>>("Direction");
    check_input(std::any_of(direction.begin(), direction.end(), [](double d) { return d != 0; }),
                "In \"View\", \"Direction\" is zero: say where the eye is, seen from the scene.");
  }
}

}  // namespace lockstep
