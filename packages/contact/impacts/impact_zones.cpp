#include "contact/impacts/impact_zones.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>

#include "base/disjoint_sets.hpp"
#include "contact/impacts/rigid_member.hpp"
#include "linear/least_squares.hpp"

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
  std::set<int> rigid;  ///< solids
  /// Least and largest velocity of locked nodes, by axis [m/s].
  std::array<std::optional<std::array<double, 2>>, dim> held;

  bool is_held() const {
    return std::any_of(held.begin(), held.end(), [](const auto& v) { return v.has_value(); });
  }
  void hold(int axis, double velocity) {
    const auto [least, largest] = held[axis].value_or(std::array{velocity, velocity});
    held[axis] = {std::min(least, velocity), std::max(largest, velocity)};
  }
  /// Where nodes are locked, their velocity, the middle of those that differ; else this one.
  Point<dim> with_held(Point<dim> velocity) const {
    for (int a = 0; a < dim; ++a) {
      if (held[a])
        velocity[a] = 0.5 * ((*held[a])[0] + (*held[a])[1]);
    }
    return velocity;
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
    impacts_.insert(impacts_.end(), impacts.begin(), impacts.end());
    const SolidMotion<dim> motion(system_, shapes_, velocity_);
    for (const auto& [root, zone] : zones())
      move(zone, motion);
  }

  /// All impacts of zones with rigid solids or locked nodes.
  std::vector<FoundImpact<dim>> held_back() {
    const std::map<int, Zone<dim>> all = zones();
    std::vector<FoundImpact<dim>> held;
    for (const FoundImpact<dim>& found : impacts_) {
      const Zone<dim>& zone = all.at(sets_.root(found.pair.vertices[0]));
      if (!zone.rigid.empty() || zone.is_held())
        held.push_back(found);
    }
    return held;
  }

 private:
  const Point<dim>& x(int vertex) const { return shapes_.mesh().vertices[vertex]; }

  std::map<int, Zone<dim>> zones() {
    std::map<int, Zone<dim>> all;
    for (const int v : members_)
      add_to(all[sets_.root(v)], v);
    return all;
  }

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
    } else if (zone.rigid.empty()) {
      move_along(zone, motion);
    } else if (zone.rigid.size() == 1 && !zone.is_held()) {
      for (const Node<dim>& node : zone.nodes) {
        const Point<dim> end = motion.end_of_point(*zone.rigid.begin(), x(node.vertex), dt_);
        set_velocity(node, (end - x(node.vertex)) / dt_);
      }
    } else {
      move_with_bodies(zone, motion);
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
    const AngularVector<dim> spin = least_squares(inertia, angular);
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
    velocity = zone.with_held(velocity);
    for (const Node<dim>& node : zone.nodes)
      set_velocity(node, velocity);
  }

  /// Moves a zone as the solids do that nothing moves; else as locked nodes do, without turning;
  /// else with the momentum that all had.
  void move_with_bodies(const Zone<dim>& zone, const SolidMotion<dim>& motion) {
    std::vector<int> given;
    std::vector<RigidMember<dim>> bodies;
    for (const int solid : zone.rigid) {
      if (!shapes_.solids()[solid].prescribed)
        bodies.emplace_back(shapes_, inverse_mass_, solid, motion.center(solid));
      if (shapes_.solids()[solid].prescribed || bodies.back().dofs().empty())
        given.push_back(solid);
    }
    CommonMotion common;
    if (!given.empty()) {
      for (const int solid : given)
        common.center += motion.center(solid) / given.size();
      for (const int solid : given) {
        const Point<dim> end = motion.end_of_point(solid, common.center, dt_);
        common.velocity += (end - common.center) / (dt_ * given.size());
        common.spin += motion.spin(solid) / given.size();
      }
    } else {
      common = motion_of_momentum(zone, bodies, motion);
    }
    if (give(common, zone, bodies))
      return;
    common.spin.setZero();
    if (!give(common, zone, bodies))
      stop(zone);
  }

  struct CommonMotion {
    Point<dim> center = Point<dim>::Zero(), velocity = Point<dim>::Zero();
    AngularVector<dim> spin = AngularVector<dim>::Zero();
  };

  CommonMotion motion_of_momentum(const Zone<dim>& zone,
                                  const std::vector<RigidMember<dim>>& bodies,
                                  const SolidMotion<dim>& motion) const {
    CommonMotion common;
    double mass = 0;
    for (const Node<dim>& node : zone.nodes) {
      mass += node.mass;
      common.center += node.mass * x(node.vertex);
    }
    for (const RigidMember<dim>& body : bodies) {
      const double own = body.mass(body.center()).template topLeftCorner<dim, dim>().trace() / dim;
      mass += own;
      common.center += own * body.center();
    }
    common.center /= mass;
    MemberMass<dim> inertia = MemberMass<dim>::Zero();
    MemberMotion<dim> momentum = MemberMotion<dim>::Zero();
    for (const RigidMember<dim>& body : bodies) {
      inertia += body.mass(common.center);
      momentum += body.momentum(common.center, velocity_);
    }
    for (const Node<dim>& node : zone.nodes) {
      Eigen::Matrix<double, dim, dim + n_rotations<dim>> carries;
      for (int k = 0; k < carries.cols(); ++k) {
        const MemberMotion<dim> unit = MemberMotion<dim>::Unit(k);
        const AngularVector<dim> spin = unit.template tail<n_rotations<dim>>();
        carries.col(k) =
            unit.template head<dim>() + rotate<dim>(spin, x(node.vertex) - common.center);
      }
      inertia += node.mass * carries.transpose() * carries;
      momentum += node.mass * carries.transpose() * motion.of_vertex(node.solid, node.vertex);
    }
    const MemberMotion<dim> twist = least_squares(inertia, momentum);
    common.velocity = zone.with_held(twist.template head<dim>());
    if (!zone.is_held())
      common.spin = twist.template tail<n_rotations<dim>>();
    return common;
  }

  /// Gives the bodies a common motion; returns false if joints or locked dofs keep them from moving
  /// so.
  bool give(const CommonMotion& common, const Zone<dim>& zone,
            const std::vector<RigidMember<dim>>& bodies) {
    const Eigen::Matrix<double, dim, dim> rotation = rotation_by<dim>(dt_ * common.spin);
    const auto velocity_of = [&](const Point<dim>& place) {
      const Point<dim> arm = place - common.center;
      return Point<dim>(common.velocity + (rotation * arm - arm) / dt_);
    };
    for (const Node<dim>& node : zone.nodes)
      set_velocity(node, velocity_of(x(node.vertex)));
    std::set<GlobalIndex> taken;
    bool all = true;
    for (const RigidMember<dim>& body : bodies) {
      MemberMotion<dim> twist;
      twist << velocity_of(body.center()), common.spin;
      all = (body.dofs().empty() || body.move(twist, velocity_)) && all;
      for (const GlobalIndex dof : body.dofs())
        all = taken.insert(dof).second && all;
    }
    return all;
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
  DisjointSets sets_;  ///< vertices that move together
  std::vector<int> solid_of_;
  std::set<int> members_;
  std::vector<FoundImpact<dim>> impacts_;  ///< impacts that made the zones
};

}  // namespace

template <int dim>
ZonedMotion<dim> join_impact_zones(const SolidSystem<dim>& system, const ContactShapes<dim>& shapes,
                                   const InverseMass& inverse_mass, double dt,
                                   std::vector<double>& velocity,
                                   const std::vector<Point<dim>>& unheld) {
  ImpactZones<dim> zones(system, shapes, inverse_mass, dt, velocity);
  ZonedMotion<dim> zoned;
  for (int round = 0; round < most_rounds; ++round) {
    const SolidMotion<dim> motion(system, shapes, velocity);
    SurfacePath<dim> path(shapes, motion, dt);
    path.unheld = unheld;
    const auto impacts = find_impacts(shapes, path);
    zoned.n_left = static_cast<int>(impacts.size());
    if (zoned.n_left == 0)
      break;
    zones.join(impacts);
  }
  zoned.held_back = zones.held_back();
  return zoned;
}

template ZonedMotion<2> join_impact_zones<2>(const SolidSystem<2>&, const ContactShapes<2>&,
                                             const InverseMass&, double, std::vector<double>&,
                                             const std::vector<Point<2>>&);
template ZonedMotion<3> join_impact_zones<3>(const SolidSystem<3>&, const ContactShapes<3>&,
                                             const InverseMass&, double, std::vector<double>&,
                                             const std::vector<Point<3>>&);

}  // namespace lockstep
