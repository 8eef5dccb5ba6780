#pragma once
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "interfaces/energy.hpp"
#include "interfaces/solid_sides.hpp"
#include "lines/line_law.hpp"

namespace lockstep {

/// A line between points of two rigid bodies, or of one and space.
template <int dim>
struct Line {
  std::string name;
  std::array<std::string, 2> solids;  ///< names of those at its ends; empty: space
  std::array<Point<dim>, 2> ends;     ///< present places of its ends [m]
  std::shared_ptr<const LineLaw<dim>> law;
};

/// All lines of one type: solids without surface and mass, whose forces act on nodes at their ends.
/// Rigid bodies carry these nodes (SolidModel::attachments), space holds them, so that what one
/// end takes the other gives, to the bodies and to the ledger.
///
/// Forces are implicit in the velocity, in S1 as F(x^n) - dt/2 K V - B V, in S2 as F(x^{n+1/2}) -
/// dt/2 K (V - (x^{n+1} - x^n) / dt) - B (V^n + V) / 2 with K and B at the middle of the way, which
/// is of second order and stable at any step. Nodes live on rank 0; values are replicated.
template <int dim>
class Lines : public SolidModel<dim>, public AuditedSolids<dim>, public SolidOutput<dim> {
 public:
  /// `type`: the name under which the model is registered. Collective.
  Lines(std::string type, std::vector<Line<dim>> lines, const Communicator& comm);

  std::string name() const override { return type_; }
  const AuditedSolids<dim>* audit() const override { return this; }
  const SolidOutput<dim>* output() const override { return this; }
  const std::vector<Line<dim>>& lines() const { return lines_; }

  const std::vector<SolidDescription>& solids() const override { return solids_; }
  const SurfaceMesh<dim>& surface() const override { return surface_; }
  void velocity_row(const SurfacePoint<dim>&, const Point<dim>&,
                    VelocityRow<dim>& row) const override {
    row.clear();
  }
  Point<dim> effective_velocity(const SurfacePoint<dim>&, const Point<dim>&) const override {
    return Point<dim>::Zero();
  }

  RCP<const Map> dof_map() const override { return map_; }
  RCP<const LinearOperator> mass() const override { return mass_; }
  RCP<const LinearOperator> implicit_force(double dt) const override;
  void explicit_momentum(double time, double dt, Vector& momentum) const override;
  void set_gravity(const Point<dim>& gravity) override;
  void begin_step(double time, double dt) override;
  std::vector<GlobalIndex> locked_dofs() const override;
  std::vector<NodeAttachment<dim>> attachments() const override;
  Momentum<dim> external_impulse(double time, double dt) const override;
  std::vector<Momentum<dim>> momentum_of_each(const Vector& generalized_momentum) const override;
  std::optional<SolidWork> solid_work(double time, double dt, const Vector& velocity,
                                      const Vector& mean) const override;

  RCP<const Vector> velocity() const override;
  void set_velocity(const Vector& velocity) override;
  void move(const Vector& velocity, double time, double dt) override;
  std::vector<SolidState<dim>> states() const override;
  std::vector<LineState> line_states() const override;
  void add_frames(std::vector<SurfaceFrame>& frames) const override;

  /// Bit for bit. Throws InputError if the checkpoint holds other lines.
  void save(CheckpointWriter& writer) const override;
  void load(const CheckpointReader& reader) override;

 private:
  using Ends = std::array<Point<dim>, 2>;
  /// The law of a line in the present stage: constant force, less slope times the difference of its
  /// ends' velocities on the second end, plus that on the first.
  struct Law {
    Ends spring, damper;                                         ///< constant forces [N]
    Eigen::Matrix<double, dim, dim> spring_slope, damper_slope;  ///< [N s/m]
  };
  Law law(int line) const;
  LineResponse<dim> present(const Line<dim>& line) const {
    return line.law->response(line.ends[1] - line.ends[0]);
  }
  /// Values by line and end, of all ranks. Collective.
  std::vector<Ends> gather(const Vector& values) const;
  /// Calls f(vectors) with a pointer to every number of the state, in a fixed order.
  template <typename Function>
  void for_each_value(const Function& f);
  std::vector<double> state() const;

  std::string type_;
  std::vector<Line<dim>> lines_;
  std::vector<Ends> before_;           ///< places before the last `move`
  std::vector<Ends> velocity_;         ///< velocities of the ends [m/s]
  std::optional<Point<dim>> gravity_;  ///< none before the first step [m/s^2]
  Communicator comm_;
  std::vector<SolidDescription> solids_;
  SurfaceMesh<dim> surface_;  ///< none
  RCP<const Map> map_;
  RCP<const LinearOperator> mass_;  ///< zero
  double step_dt_ = 0;              ///< length of the present step [s]
  bool has_moved_ = false;          ///< in the present step
};

}  // namespace lockstep
