// A contact model: a floor at a height stops the first solid, a disc in the plane.
#include <Tpetra_Vector.hpp>

#include <algorithm>

#include "coupling/solid_system.hpp"
#include "interfaces/plug_ins.hpp"
using namespace lockstep;

class Floor : public ContactModel<2> {
 public:
  explicit Floor(double height) : height_(height) {}
  std::string name() const override { return "floor"; }
  ContactReport<2> resolve(const SolidSystem<2>& solids, ContactPhase phase, double dt,
                           Vector& velocity, const ContactResponse& response) override {
    double lowest = solids.surface().vertices[0][1];
    for (const Point<2>& x : solids.surface().vertices)
      lowest = std::min(lowest, x[1]);
    const double gap = lowest - height_;
    // In S1 the disc may come as far as the floor. In S2 it is stopped where it touches.
    const bool is_near = phase == ContactPhase::position || gap <= touching_;
    const double least = phase == ContactPhase::position ? -gap / dt : 0;
    const double speed = value_of(velocity);
    ContactReport<2> report;
    if (!is_near || speed >= least)
      return report;
    const SolidState<2> disc = solids.states()[0];
    const RCP<Vector> unit = make_vector(velocity.getMap()), change = make_vector(unit->getMap());
    set(*unit, 1);
    if (response)
      apply(*response(), *unit, *change);
    else
      set(*change, 1 / disc.mass);
    const double yields = value_of(*change), impulse = (least - speed) / yields;
    velocity.update(impulse, *change, 1);
    report.n_contacts = 1;
    report.external_impulse.add(disc.center_of_mass, 1, impulse);
    unit->scale(impulse);
    report.impulse = unit;
    // The coupled solve holds this row: the disc's velocity along y is `least`.
    HeldRow row;
    row.weights = {{vertical_, 1.0}};
    row.velocity = least;
    row.impulse = impulse;
    row.response = yields;
    report.held = {row};
    return report;
  }

 private:
  static constexpr GlobalIndex vertical_ = 1;  ///< dofs of a disc: along x, along y, rotation
  static constexpr double touching_ = 1e-5;    ///< [m]

  static void set(Vector& x, double value) {
    if (x.getMap()->isNodeGlobalElement(vertical_))
      x.replaceGlobalValue(vertical_, value);
  }
  /// On all ranks, of which one has the disc.
  static double value_of(const Vector& x) {
    const int local = x.getMap()->getLocalElement(vertical_);
    return sum_all(x.getMap()->getComm(), local >= 0 ? x.getData()[local] : 0.0);
  }

  double height_;  ///< [m]
};

void lockstep_register_plug_ins(PlugIns& plug_ins) {
  plug_ins.plane.contacts.add(
      "floor", "A floor below the first solid, a disc.",
      [] {
        ParameterList list;
        declare(list, "Height", 0.2, "Of the floor [m].");
        return list;
      },
      [](const ParameterList& list, const ContactSetting<2>&) {
        return std::make_unique<Floor>(list.get<double>("Height"));
      });
}
