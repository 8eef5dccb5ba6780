// A coupling: the mixed faces of the paper, but those normal to x do not feel solids.
#include "interfaces/plug_ins.hpp"
#include "mixedface/mixed_face_coupling.hpp"
using namespace lockstep;

class Blind : public MixedFaceCoupling<2> {
 public:
  Blind() : MixedFaceCoupling<2>(MixedFaceOptions{}) {}
  std::string name() const override { return "blind"; }
  double open_fraction(const ControlVolume<2>& volume, bool occluded,
                       const SurfaceSnapshot<2>& surface) const override {
    return volume.direction == 0 ? 1
                                 : MixedFaceCoupling<2>::open_fraction(volume, occluded, surface);
  }
};

void lockstep_register_plug_ins(PlugIns& plug_ins) {
  plug_ins.plane.couplings.add(
      "blind", "Mixed faces that do not see solids along x.", [] { return ParameterList(); },
      [](const ParameterList&) { return std::make_unique<Blind>(); });
}
