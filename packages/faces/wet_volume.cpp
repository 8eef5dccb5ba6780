#include "faces/wet_volume.hpp"

#include "geometry/clipping.hpp"
#include "geometry/solid_volume.hpp"

namespace lockstep {

namespace {
/// The part of a dual cell on one side of the shells that cross it, where each line along its axis
/// meets them once: what lies below them at their mean height, and half of what no shell covers.
template <int dim>
double part_beside_shells(const ControlVolume<dim>& volume, int side,
                          const SurfaceSnapshot<dim>& surface) {
  const int axis = volume.direction;
  std::vector<int> touching;
  surface.touching(volume.box, touching);
  double covered = 0, height = 0;
  for (const int simplex : touching) {
    const auto corners = surface.corners(simplex);
    const ClippedSimplex<dim> part = clip_to_box<dim>(corners, volume.box);
    if (part.measure <= 0)
      continue;
    const double projected =
        part.measure * std::abs(area_vector<dim>(corners).normalized()[axis]) / volume.area;
    covered += projected;
    height += projected * (part.centroid[axis] - volume.box.min()[axis]) / volume.box.sizes()[axis];
  }
  if (covered > 1) {
    height /= covered;
    covered = 1;
  }
  return (side == 0 ? height : covered - height) + 0.5 * (1 - covered);
}

}  // namespace

template <int dim>
double wet_volume(const ControlVolume<dim>& volume, const SurfaceSnapshot<dim>& surface,
                  bool whole_cell, const LiquidFluid<dim>& liquid) {
  const auto& sides = volume.sides;
  const bool beside_solid = sides[0].kind == SideKind::solid || sides[1].kind == SideKind::solid;
  if (beside_solid) {
    const Box<dim> wet = wet_part<dim>(liquid, volume.box);
    const double solid = whole_cell || wet.isEmpty() ? 0 : solid_volume_in_box<dim>(surface, wet);
    return wet.isEmpty() ? 0 : wet.volume() - solid;
  }
  // The surfaces on both sides of a shell are strangers: each is where its own cell says.
  double part = 0;
  for (int side = 0; side < 2; ++side) {
    if (sides[side].kind != SideKind::unknown)
      continue;
    const double height =
        liquid.surface_distance(sides[side].center) / volume.box.sizes().maxCoeff();
    const double own = sides[1 - side].kind == SideKind::air
                           ? part_beside_shells<dim>(volume, side, surface)
                           : 0.5;
    part += own * std::min(std::max(0.5 - height, 0.0), 1.0);
  }
  return part * volume.box.volume() -
         (whole_cell ? 0 : solid_volume_in_box<dim>(surface, volume.box));
}
template double wet_volume<2>(const ControlVolume<2>&, const SurfaceSnapshot<2>&, bool,
                              const LiquidFluid<2>&);
template double wet_volume<3>(const ControlVolume<3>&, const SurfaceSnapshot<3>&, bool,
                              const LiquidFluid<3>&);

}  // namespace lockstep
