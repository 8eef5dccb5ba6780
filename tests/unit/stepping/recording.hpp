#pragma once
#include <fmt/format.h>

#include <string>
#include <utility>
#include <vector>

#include "conformance/fake_fluid.hpp"
#include "conformance/fake_solid.hpp"
#include "interfaces/contact.hpp"
#include "strategies/direct/direct.hpp"

namespace lockstep::test {

/// Calls of the step to its partners, in order: "who: what", with the time it is over where that
/// matters.
using Calls = std::vector<std::string>;

/// FakeFluid that writes down what a step does to it.
class RecordingFluid : public FakeFluid<2> {
 public:
  RecordingFluid(const FakeBox<2>& box, const Communicator& comm, Calls& calls)
      : FakeFluid<2>(box, comm), calls_(calls) {}

  void begin_prediction() override {
    calls_.push_back("fluid: u* = u");
    FakeFluid<2>::begin_prediction();
  }
  bool begin_advection_velocity(double dt) override {
    calls_.push_back(fmt::format("fluid: u* to advect over {}", dt));
    FakeFluid<2>::begin_prediction();
    return true;
  }
  ForceImpulse<2> add_forces(double time, double dt) override {
    calls_.push_back(fmt::format("fluid: forces over {}", dt));
    return FakeFluid<2>::add_forces(time, dt);
  }
  ViscousFluid<2>* viscosity() override {
    return FakeFluid<2>::viscosity() ? &viscosity_ : nullptr;
  }
  void project(const Vector& scaled_pressure) override {
    calls_.push_back("fluid: project");
    FakeFluid<2>::project(scaled_pressure);
  }
  void advect(double time, double dt, const MovingSurface<2>& surface) override {
    calls_.push_back(fmt::format("fluid: advect over {}", dt));
    FakeFluid<2>::advect(time, dt, surface);
  }
  void populate_uncovered(const MovingSurface<2>&) override {
    calls_.push_back("fluid: populate_uncovered");
  }
  void accept() override {
    calls_.push_back("fluid: u = u*");
    FakeFluid<2>::accept();
  }

 protected:
  const FluidGeometry<2>& freeze(const Surface& surface, const OpenFractionRule<2>& rule) override {
    calls_.push_back("fluid: geometry");
    return FakeFluid<2>::freeze(surface, rule);
  }

 private:
  /// Its viscosity, whose system is written down.
  struct RecordingViscosity : ViscousFluid<2> {
    explicit RecordingViscosity(RecordingFluid& owner) : fluid(owner) {}
    std::unique_ptr<ViscousSystem<2>> viscous_system() const override {
      fluid.calls_.push_back("fluid: viscosity");
      return fluid.FakeFluid<2>::viscosity()->viscous_system();
    }
    Momentum<2> accept_viscous(const Vector& solution, const Vector& velocity, double dt) override {
      return fluid.FakeFluid<2>::viscosity()->accept_viscous(solution, velocity, dt);
    }
    RecordingFluid& fluid;
  };

  Calls& calls_;
  RecordingViscosity viscosity_{*this};
};

/// FakeSolid that does the same.
class RecordingSolid : public FakeSolid<2> {
 public:
  RecordingSolid(std::vector<FakeBody<2>> bodies, const Communicator& comm, Calls& calls)
      : FakeSolid<2>(std::move(bodies), {}, comm), calls_(calls) {}

  void begin_step(double time, double dt) override {
    calls_.push_back(fmt::format("solids: step from {} over {}", time, dt));
  }
  std::vector<double> locked_velocities(double begin, double end) const override {
    calls_.push_back(fmt::format("solids: held from {} to {}", begin, end));
    return FakeSolid<2>::locked_velocities(begin, end);
  }
  void explicit_momentum(double time, double dt, Vector& momentum) const override {
    if (dt > 0)  // else it is asked for the ledger
      calls_.push_back(fmt::format("solids: forces over {}", dt));
    FakeSolid<2>::explicit_momentum(time, dt, momentum);
  }
  void add_midpoint_correction(double dt, Vector&) const override {
    calls_.push_back(fmt::format("solids: midpoint of {}", dt));
  }
  void limit_motion(double dt, Vector&) override {
    calls_.push_back(fmt::format("solids: limit over {}", dt));
  }
  void move(const Vector& velocity, double time, double dt) override {
    calls_.push_back(fmt::format("solids: move over {}", dt));
    FakeSolid<2>::move(velocity, time, dt);
  }
  void set_velocity(const Vector& velocity) override {
    calls_.push_back("solids: V");
    FakeSolid<2>::set_velocity(velocity);
  }

 private:
  Calls& calls_;
};

/// Joints that tie nothing.
class RecordingJoints : public ConstraintModel {
 public:
  explicit RecordingJoints(Calls& calls) : calls_(calls) {}
  std::string name() const override { return "recording"; }
  std::vector<Combination> combinations() const override { return {}; }
  ClosedMotion close(double, double, const Vector&, const Vector&, Vector&) override { return {}; }
  std::vector<JointLimit> limits(double, const std::vector<double>&) const override { return {}; }
  std::vector<GivenMotion> given_motions() const override { return {}; }
  std::string limited() const override { return ""; }
  bool has_implicit_forces() const override { return false; }
  int largest_block() const override { return 0; }
  void take_note(const JointImpulses&, double, double) override {}
  std::vector<JointState> states(double) const override { return {}; }
  std::string note() const override { return ""; }

 private:
  Calls& calls_;
};

/// Contact that only writes down when it was asked.
class RecordingContact : public ContactModel<2> {
 public:
  explicit RecordingContact(Calls& calls) : calls_(calls) {}
  std::string name() const override { return "recording"; }
  void begin_step(double time) override {
    calls_.push_back(fmt::format("contact: step from {}", time));
  }
  ContactReport<2> resolve(const SolidSystem<2>&, ContactPhase phase, double dt, Vector&,
                           const ContactResponse&) override {
    const char* what = phase == ContactPhase::position ? "positions" : "velocities";
    calls_.push_back(fmt::format("contact: {} over {}", what, dt));
    return {};
  }

 private:
  Calls& calls_;
};

/// Contact that stops all solids and does not tell the coupled solve of it.
class SilentContact : public ContactModel<2> {
 public:
  std::string name() const override { return "silent"; }
  ContactReport<2> resolve(const SolidSystem<2>&, ContactPhase, double, Vector& velocity,
                           const ContactResponse&) override {
    ContactReport<2> report;
    report.n_contacts = 1;
    velocity.putScalar(0);
    return report;
  }
};

/// The direct strategy, which writes down what is solved.
class RecordingStrategy : public SolverStrategy {
 public:
  explicit RecordingStrategy(Calls& calls) : direct_(Direct::valid_parameters()), calls_(calls) {}
  std::string name() const override { return "recording"; }
  void prepare(const BlockSystem& system) override { direct_.prepare(system); }
  SolveReport solve(const BlockSystem& system, const BlockVector& rhs, BlockVector& solution,
                    const SolveRequest& request) override {
    calls_.push_back("solve: " + request.name);
    return direct_.solve(system, rhs, solution, request);
  }

 private:
  Direct direct_;
  Calls& calls_;
};

}  // namespace lockstep::test
