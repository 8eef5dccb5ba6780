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
  std::string scene;             ///< path, or what stands for it in messages where `text` is given
  std::string text;              ///< XML, or JSON of a dictionary; empty: there is a file
  bool from_dictionary = false;  ///< `text` was made from one: it has no lines to name
  std::string output, restart;
  std::vector<std::string> settings;  ///< "List/Name=value"
  std::vector<std::string> plug_ins;  ///< libraries to load, beside those that the scene names
  bool quiet = true;
};

/// A solid in numbers; angular velocities and torques have one entry in 2D. [SI]
struct BodyNumbers {
  std::string name;
  Eigen::VectorXd position, velocity, angular_velocity;
  Eigen::MatrixXd orientation;  ///< rotation matrix; empty if the solid is not rigid
  Eigen::VectorXd force, torque, contact_force, contact_torque;  ///< as in bodies.csv
  double mass = 0, volume = 0, kinetic_energy = 0, elastic_energy = 0;
};

/// The box of cells that `AnyRun::fields` are on.
struct GridNumbers {
  std::vector<int> cells;               ///< number along x, y(, z)
  std::vector<double> spacing, origin;  ///< size of a cell and lower corner [m]
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
  /// Back to where the run was opened; the files that it wrote are those of the new run from then
  /// on. Tables of `add_table` are gone.
  virtual void reset() = 0;

  virtual int dimension() const = 0;      ///< Local.
  virtual double time() const = 0;        ///< Local.
  virtual double time_step() const = 0;   ///< length of the last step [s]; 0 before it. Local.
  virtual long long n_steps() const = 0;  ///< Local.
  virtual std::vector<std::pair<std::string, HistoryValue>> history() const = 0;  ///< Local.
  virtual std::vector<BodyNumbers> bodies() const = 0;
  virtual std::vector<JointState> joints() const = 0;  ///< Local.

  /// See SolidModel::set_load and ConstraintModel::set_target. Local, to be called alike on all
  /// ranks.
  virtual void set_force(const std::string& body, const std::vector<double>& force,
                         const std::vector<double>& torque) = 0;
  virtual void set_target(const std::string& joint, const std::vector<double>& q,
                          const std::vector<double>& rate) = 0;

  /// Begins OUTPUT/NAME.csv behind the columns `step` and `time`, or goes on with it in a run that
  /// was opened from a checkpoint. True if it is a new one, which wants a row of the present.
  virtual bool add_table(const std::string& name, const std::vector<HistoryColumn>& columns) = 0;
  virtual void append_row(const std::string& table, const std::vector<double>& values) = 0;

  virtual GridNumbers grid() const = 0;
  virtual Samples sample(const Eigen::MatrixXd& points) const = 0;
  virtual std::map<std::string, WholeField> fields() const = 0;
  virtual std::vector<SurfaceFrame> surfaces() const = 0;
};

/// Reads, checks and builds a scene and writes its start. Collective.
std::unique_ptr<AnyRun> open_run(OpenRequest request);

}  // namespace lockstep
