#pragma once
#include <Eigen/Core>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "interfaces/constraint.hpp"
#include "output/frames.hpp"
#include "output/history.hpp"

namespace lockstep {

/// Arguments with which Python opens a run; see `simulate --help`.
struct OpenRequest {
  std::string scene, output, restart;
  std::vector<std::string> settings;  ///< "List/Name=value"
  std::vector<std::string> plug_ins;  ///< libraries to load, beside those that the scene names
  bool quiet = true;
};

/// A solid in numbers; angular velocities have one entry in 2D. [SI]
struct BodyNumbers {
  std::string name;
  Eigen::VectorXd position, velocity, angular_velocity;
  double mass = 0, volume = 0, kinetic_energy = 0, elastic_energy = 0;
};

/// The fluid at points, one row each.
struct Samples {
  Eigen::Array<bool, Eigen::Dynamic, 1> in_fluid;
  Eigen::VectorXd pressure;  ///< [Pa]
  Eigen::MatrixXd velocity;  ///< [m/s]
};

/// A field on the cells of the whole box; see BoxField.
struct WholeField {
  std::string unit;
  std::vector<int> shape;  ///< z (in 3D), y, x, and the components of a vector
  std::vector<double> values;
};

/// A run of a scene in two or three dimensions, stepped from outside. Members are collective unless
/// they say otherwise; they throw InputError, SolveError and OutputError.
class AnyRun {
 public:
  virtual ~AnyRun() = default;
  virtual bool step() = 0;
  /// The last checkpoint and the summary.
  virtual void end() = 0;
  /// Ends the run in place of `end` after an exception of the script; see Simulation::stop. Not
  /// collective.
  virtual void stop(const std::string& message) = 0;

  virtual int dimension() const = 0;                                              ///< Local.
  virtual double time() const = 0;                                                ///< Local.
  virtual long long n_steps() const = 0;                                          ///< Local.
  virtual std::vector<std::pair<std::string, HistoryValue>> history() const = 0;  ///< Local.
  virtual std::vector<BodyNumbers> bodies() const = 0;
  virtual std::vector<JointState> joints() const = 0;  ///< Local.

  /// See SolidModel::set_load and interfaces/steering.hpp. Local, to be called alike on all ranks.
  virtual void set_force(const std::string& body, const std::vector<double>& force,
                         const std::vector<double>& torque) = 0;
  virtual void set_target(const std::string& joint, const std::vector<double>& q,
                          const std::vector<double>& rate) = 0;

  virtual Samples sample(const Eigen::MatrixXd& points) const = 0;
  virtual std::map<std::string, WholeField> fields() const = 0;
  virtual std::vector<SurfaceFrame> surfaces() const = 0;
};

/// Reads, checks and builds a scene and writes its start. Collective.
std::unique_ptr<AnyRun> open_run(OpenRequest request);

}  // namespace lockstep
