#include "contact/impact_zones.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "base/disjoint_sets.hpp"
#include "base/interruption.hpp"

namespace lockstep {

namespace {

constexpr int most_rounds = 100;

template <int dim>
Eigen::Matrix<double, dim, dim> rotation_by(const AngularVector<dim>& turn) {
  if constexpr (dim == 2) {
    return Eigen::Rotation2Dd(turn[0]).toRotationMatrix();
  } else {
    const double angle = turn.norm();
    return angle == 0 ? Eigen::Matrix3d(Eigen::Matrix3d::Identity())
                      : Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
  }
}

/// A node of a surface with its dofs.
template <int dim>
struct Node {
  int vertex = -1, solid = -1;
  double mass = 0;  ///< [kg]
  VelocityRow<dim> row;
};

template <int dim>
struct Zone {
  std::vector<Node<dim>> nodes;
  std::set<int> rigid;                          ///< solids
  std::array<std::optional<double>, dim> held;  ///< velocities of locked nodes, by axis [m/s]
  bool disagrees = false;                       ///< they differ

  bool is_held() const {
    return std::any_of(held.begin(), held.end(), [](const auto& v) { return v.has_value(); });
  }
  void hold(int axis, double velocity) {
    disagrees = disagrees || held[axis].value_or(velocity) != velocity;
    held[axis] = velocity;
  }
};

template <int dim>
class ImpactZones {
 public:
  ImpactZones(const SolidSystem<dim>& system, const ContactShapes<dim>& shapes,
              const InverseMass& inverse_mass, double dt, std::vector<double>& velocity)
      : system_(system),
        shapes_(shapes),
        inverse_mass_(inverse_mass),
        dt_(dt),
        velocity_(velocity),
        sets_(static_cast<int>(shapes.mesh().vertices.size())),
        solid_of_(shapes.mesh().vertices.size(), -1) {
    for (int i = 0; i < shapes.n_solids(); ++i) {
      const SolidDescription& solid = shapes.solids()[i];
      for (int v = solid.vertex_begin; v < solid.vertex_end; ++v) {
        solid_of_[v] = i;
        if (solid.rigid)
          sets_.join(v, solid.vertex_begin);
      }
    }
  }

  void join(const std::vector<FoundImpact<dim>>& impacts) {
    for (const FoundImpact<dim>& found : impacts) {
      for (const int v : found.pair.vertices) {
        members_.insert(v);
        sets_.join(v, found.pair.vertices[0]);
      }
    }
    std::map<int, Zone<dim>> zones;
    for (const int v : members_)
      add_to(zones[sets_.root(v)], v);
    const SolidMotion<dim> motion(system_, shapes_, velocity_);
    for (const auto& [root, zone] : zones)
      move(zone, motion);
  }

 private:
  const Point<dim>& x(int vertex) const { return shapes_.mesh().vertices[vertex]; }

  void add_to(Zone<dim>& zone, int vertex) const {
    const int solid = solid_of_[vertex];
    const int rigid = shapes_.solids()[solid].rigid ? solid : shapes_.carrier(vertex);
    if (rigid >= 0) {
      zone.rigid.insert(rigid);
      return;
    }
    Node<dim> node;
    node.vertex = vertex;
    node.solid = solid;
    const SurfacePoint<dim> point = shapes_.at_vertex(vertex);
    shapes_.velocity_row(point, point.position, node.row);
    for (std::size_t k = 0; k < node.row.dofs.size(); ++k) {
      const GlobalIndex dof = node.row.dofs[k];
      int axis = 0;
      node.row.coefficients[k].cwiseAbs().maxCoeff(&axis);
      const auto& inverse = inverse_mass_.rows[dof];
      const auto own = std::find_if(inverse.begin(), inverse.end(),
                                    [dof](const auto& entry) { return entry.first == dof; });
      if (own == inverse.end())
        zone.hold(axis, velocity_[dof]);
      else
        node.mass = 1 / own->second;
    }
    zone.nodes.push_back(node);
  }

  void set_velocity(const Node<dim>& node, const Point<dim>& velocity) {
    for (std::size_t k = 0; k < node.row.dofs.size(); ++k) {
      if (!inverse_mass_.rows[node.row.dofs[k]].empty())
        velocity_[node.row.dofs[k]] = node.row.coefficients[k].dot(velocity);
    }
  }

  void move(const Zone<dim>& zone, const SolidMotion<dim>& motion) {
    if (zone.rigid.empty() && !zone.is_held()) {
      move_rigidly(zone, motion);
    } else if (zone.rigid.empty() && !zone.disagrees) {
      move_along(zone, motion);
    } else if (zone.rigid.size() == 1 && !zone.is_held()) {
      for (const Node<dim>& node : zone.nodes) {
        const Point<dim> end = motion.end_of_point(*zone.rigid.begin(), x(node.vertex), dt_);
        set_velocity(node, (end - x(node.vertex)) / dt_);
      }
    } else {
      stop(zone);
    }
  }

  void move_rigidly(const Zone<dim>& zone, const SolidMotion<dim>& motion) {
    constexpr int n_turns = n_rotations<dim>;
    double mass = 0;
    Point<dim> center = Point<dim>::Zero(), momentum = Point<dim>::Zero();
    for (const Node<dim>& node : zone.nodes) {
      mass += node.mass;
      center += node.mass * x(node.vertex);
      momentum += node.mass * motion.of_vertex(node.solid, node.vertex);
    }
    center /= mass;
    AngularVector<dim> angular = AngularVector<dim>::Zero();
    Eigen::Matrix<double, n_turns, n_turns> inertia;
    inertia.setZero();
    for (const Node<dim>& node : zone.nodes) {
      const Point<dim> arm = x(node.vertex) - center;
      angular += node.mass * cross<dim>(arm, motion.of_vertex(node.solid, node.vertex));
      inertia.diagonal().array() += node.mass * arm.squaredNorm();
      if constexpr (dim == 3)
        inertia -= node.mass * arm * arm.transpose();
    }
    const AngularVector<dim> spin = inertia.fullPivLu().solve(angular);
    const Eigen::Matrix<double, dim, dim> rotation = rotation_by<dim>(dt_ * spin);
    for (const Node<dim>& node : zone.nodes) {
      const Point<dim> arm = x(node.vertex) - center;
      set_velocity(node, momentum / mass + (rotation * arm - arm) / dt_);
    }
  }

  /// Without turning: at the velocity of the locked nodes along their axes, at the mean of all
  /// along the others.
  void move_along(const Zone<dim>& zone, const SolidMotion<dim>& motion) {
    double mass = 0;
    Point<dim> velocity = Point<dim>::Zero();
    for (const Node<dim>& node : zone.nodes) {
      mass += node.mass;
      velocity += node.mass * motion.of_vertex(node.solid, node.vertex);
    }
    if (mass > 0)
      velocity /= mass;
    for (int a = 0; a < dim; ++a)
      velocity[a] = zone.held[a].value_or(velocity[a]);
    for (const Node<dim>& node : zone.nodes)
      set_velocity(node, velocity);
  }

  void stop(const Zone<dim>& zone) {
    for (const Node<dim>& node : zone.nodes)
      set_velocity(node, Point<dim>::Zero());
    for (const int solid : zone.rigid) {
      if (shapes_.solids()[solid].prescribed)
        continue;
      for (const GlobalIndex dof : shapes_.rigid_dofs(solid))
        velocity_[dof] = 0;
    }
  }

  const SolidSystem<dim>& system_;
  const ContactShapes<dim>& shapes_;
  const InverseMass& inverse_mass_;
  double dt_;
  std::vector<double>& velocity_;
  DisjointSets sets_;  ///< of vertices that move together
  std::vector<int> solid_of_;
  std::set<int> members_;
};

}  // namespace

template <int dim>
int join_impact_zones(const SolidSystem<dim>& system, const ContactShapes<dim>& shapes,
                      const InverseMass& inverse_mass, bool self, double dt,
                      std::vector<double>& velocity) {
  ImpactZones<dim> zones(system, shapes, inverse_mass, dt, velocity);
  int n_left = 0;
  for (int round = 0; round < most_rounds; ++round) {
    poll_interruption(system.comm());
    const SolidMotion<dim> motion(system, shapes, velocity);
    const auto impacts = find_impacts(shapes, SurfacePath<dim>(shapes, motion, dt), self);
    n_left = static_cast<int>(impacts.size());
    if (n_left == 0)
      break;
    zones.join(impacts);
  }
  return n_left;
}

template int join_impact_zones<2>(const SolidSystem<2>&, const ContactShapes<2>&,
                                  const InverseMass&, bool, double, std::vector<double>&);
template int join_impact_zones<3>(const SolidSystem<3>&, const ContactShapes<3>&,
                                  const InverseMass&, bool, double, std::vector<double>&);

}  // namespace lockstep
