// Trees of joints: what moves bodies, what loops make of it, and how joints are closed.
#include <gtest/gtest.h>

#include <Eigen/QR>

#include "articulated/closing.hpp"
#include "articulated/lone_mechanism.hpp"
#include "articulated/mechanism.hpp"
#include "joint_types.hpp"
#include "motion/rotation.hpp"

namespace lockstep::test {
namespace {

/// Bodies of which nobody asks more than their places; -1 of `dynamic`: prescribed.
template <int dim>
struct Linkage {
  std::vector<JointedBody<dim>> bodies;
  std::vector<BodyPose<dim>> poses;
  std::vector<Joint<dim>> joints;

  int add_body(const Point<dim>& position, const AngularVector<dim>& turn, bool dynamic = true) {
    JointedBody<dim> body;
    body.first_dof = dynamic ? n_twist<dim> * static_cast<GlobalIndex>(bodies.size()) : no_index;
    bodies.push_back(body);
    poses.push_back({position, rotation_of<dim>(turn).toRotationMatrix()});
    return static_cast<int>(bodies.size()) - 1;
  }
  void add_joint(const std::string& type, int first, int second, const Point<dim>& point) {
    Joint<dim> joint;
    joint.kind = joint_kind<dim>(type);
    joint.q = Eigen::VectorXd::Zero(joint.kind->n_rates());
    int side = 0;
    for (const int body : {first, second}) {
      const BodyPose<dim> pose = pose_of(poses, body);
      joint.sides[side++] = {body, pose.rotation.transpose() * (point - pose.position),
                             pose.rotation.transpose()};
    }
    joints.push_back(joint);
  }
  /// Rates' dofs follow those of all bodies, then those of prescribed ones.
  RateDofs dofs() const {
    RateDofs dofs;
    dofs.first_rate = 1000;
    for (std::size_t b = 0; b < bodies.size(); ++b)
      dofs.first_of_body.push_back(2000 + n_twist<dim> * static_cast<GlobalIndex>(b));
    return dofs;
  }
  int n_all_rates() const {
    int n = 0;
    for (const Joint<dim>& joint : joints)
      n += joint.first_rate >= 0 ? joint.kind->n_rates() : 0;
    return n;
  }
};

/// Largest velocity that joints should hold, read off the twists of the basis: zero, or they let go
/// too much.
template <int dim>
double largest_violation(const Linkage<dim>& linkage, const Mechanism& mechanism,
                         const MotionBasis<dim>& basis) {
  const auto twists = [&](int body) {
    Eigen::Matrix<double, n_twist<dim>, Eigen::Dynamic> none =
        Eigen::MatrixXd::Zero(n_twist<dim>, basis.columns.size());
    for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
      if (mechanism.bodies[b] == body)
        return basis.twists[b];
    }
    for (std::size_t c = 0; body != space && c < basis.columns.size(); ++c) {
      const GlobalIndex k = basis.columns[c] - linkage.dofs().first_of_body[body];
      if (k >= 0 && k < n_twist<dim>)
        none(k, static_cast<Eigen::Index>(c)) = 1;
    }
    return none;
  };
  double largest = 0;
  for (const Joint<dim>& joint : linkage.joints) {
    const JointPlace<dim> place = place_of(joint, linkage.poses);
    for (const Screw<dim>& held : joint.kind->held_rows(place.pose)) {
      Eigen::RowVectorXd sum = Eigen::RowVectorXd::Zero(basis.columns.size());
      for (int side = 0; side < 2; ++side) {
        const int body = joint.sides[side].body;
        sum += row_on_side(held, place, side, pose_of(linkage.poses, body).position).transpose() *
               twists(body);
      }
      largest = std::max(largest, sum.cwiseAbs().maxCoeff());
    }
  }
  return largest;
}

template <int dim>
MotionBasis<dim> basis_of(const Linkage<dim>& linkage, const Mechanism& mechanism) {
  return motion_basis(mechanism, linkage.bodies, linkage.joints, linkage.poses, linkage.dofs(),
                      std::vector<char>(linkage.n_all_rates(), 0));
}

/// Four links about a parallelogram.
Linkage<2> four_bars() {
  Linkage<2> linkage;
  const Point<2> corners[] = {{0, 0}, {2, 0}, {2.5, 1}, {0.5, 1}};
  for (int k = 0; k < 4; ++k)
    linkage.add_body(0.5 * (corners[k] + corners[(k + 1) % 4]), AngularVector<2>(0.3 * k));
  for (int k = 0; k < 4; ++k)
    linkage.add_joint("hinge", k, (k + 1) % 4, corners[(k + 1) % 4]);
  return linkage;
}

}  // namespace

TEST(Mechanism, TreesMoveAsAllTheirJointsLet) {
  Linkage<3> linkage;
  linkage.add_body({0, 0, 0}, {0.1, 0.2, 0.3});
  linkage.add_body({1, 0.2, 0}, {-0.4, 0.2, 0});
  linkage.add_body({2, -0.3, 0.5}, {0, 0, 1});
  linkage.add_body({1, 1, 1}, {0.5, 0.5, 0});
  linkage.add_joint("ball", 1, 0, {0.5, 0, 0});
  linkage.add_joint("universal", 1, 2, {1.5, 0, 0.2});
  linkage.add_joint("cylinder", 3, 1, {1, 0.5, 0.5});
  const auto mechanisms = find_mechanisms(linkage.bodies, linkage.joints);
  ASSERT_EQ(mechanisms.size(), 1u);
  EXPECT_EQ(mechanisms[0].root, 0);
  EXPECT_TRUE(mechanisms[0].loops.empty());
  const MotionBasis<3> basis = basis_of(linkage, mechanisms[0]);
  EXPECT_EQ(basis.columns.size(), 6u + 3 + 2 + 2);
  EXPECT_LT(largest_violation(linkage, mechanisms[0], basis), 1e-14);
}

TEST(Mechanism, LoopsMakeRatesCombinations) {
  Linkage<2> linkage = four_bars();
  const auto mechanisms = find_mechanisms(linkage.bodies, linkage.joints);
  ASSERT_EQ(mechanisms.size(), 1u);
  ASSERT_EQ(mechanisms[0].loops.size(), 1u);
  const MotionBasis<2> basis = basis_of(linkage, mechanisms[0]);
  EXPECT_EQ(basis.columns.size(), 3u + 3);
  EXPECT_EQ(basis.dependent.size(), 2u);  // a four-bar linkage has one freedom of its own
  EXPECT_LT(largest_violation(linkage, mechanisms[0], basis), 1e-13);
}

TEST(Mechanism, ASecondHingeOfADoorSaysNothingNew) {
  for (const double turn : {0.1, 0.7, 2.3}) {
    Linkage<3> linkage;
    linkage.add_body({0.3, -0.2, 0.1}, {turn, 0.2, 0.3});
    linkage.add_body({0.1, 0.7, -0.3}, {-0.4, turn, 0.1});
    linkage.add_joint("hinge", 0, 1, {0, 0, 0});
    linkage.add_joint("hinge", 0, 1, {1. / 3, 0, 0});
    const auto mechanisms = find_mechanisms(linkage.bodies, linkage.joints);
    ASSERT_EQ(mechanisms[0].loops.size(), 1u);
    const MotionBasis<3> basis = basis_of(linkage, mechanisms[0]);
    EXPECT_TRUE(basis.dependent.empty());
    EXPECT_LT(largest_violation(linkage, mechanisms[0], basis), 1e-13);
  }
}

TEST(Mechanism, TheHeaviestBodyIsTheRootWhicheverAJointNamesFirst) {
  for (const bool swapped : {false, true}) {
    Linkage<2> linkage = four_bars();
    for (Joint<2>& joint : linkage.joints) {
      if (swapped)
        std::swap(joint.sides[0], joint.sides[1]);
    }
    const auto root = [&] { return find_mechanisms(linkage.bodies, linkage.joints)[0].root; };
    for (JointedBody<2>& body : linkage.bodies)
      body.mass = 1;
    EXPECT_EQ(root(), 0);
    linkage.bodies[2].mass = 2;
    const auto mechanisms = find_mechanisms(linkage.bodies, linkage.joints);
    ASSERT_EQ(mechanisms.size(), 1u);
    EXPECT_EQ(mechanisms[0].root, 2);
    EXPECT_EQ(mechanisms[0].bodies.size(), 4u);
    EXPECT_LT(largest_violation(linkage, mechanisms[0], basis_of(linkage, mechanisms[0])), 1e-13);
    linkage.bodies[1].mass = 2 + 1e-9;  // alike: the first of the scene
    EXPECT_EQ(root(), 1);
    linkage.bodies[3].mass = 1e-6;
    linkage.bodies[3].fluid_mass = 3;
    EXPECT_EQ(root(), 3);
  }
}

TEST(Mechanism, GroundsAreRootsAndTheirMotionIsHandedOn) {
  Linkage<2> linkage;
  const int cart = linkage.add_body({0, 0}, AngularVector<2>(0), false);
  const int bob = linkage.add_body({0, -1}, AngularVector<2>(0.3));
  const int tail = linkage.add_body({0, -2}, AngularVector<2>(0.1));
  linkage.add_joint("hinge", bob, cart, {0, -0.2});
  linkage.add_joint("slider", bob, tail, {0, -1.5});
  linkage.add_joint("hinge", space, tail, {0.5, -2.5});
  const auto mechanisms = find_mechanisms(linkage.bodies, linkage.joints);
  ASSERT_EQ(mechanisms.size(), 1u);
  EXPECT_EQ(mechanisms[0].root, space);
  EXPECT_EQ(mechanisms[0].loops.size(), 1u);
  const MotionBasis<2> basis = basis_of(linkage, mechanisms[0]);
  EXPECT_EQ(basis.dependent.size(), 2u);
  EXPECT_LT(largest_violation(linkage, mechanisms[0], basis), 1e-13);
}

/// Bodies that move as anything but the joints let end where they fit, with impulses of joints
/// only: these change neither the momentum nor the moment of momentum.
TEST(Closing, FitsAllJointsAndKeepsMomentum) {
  for (const Answer answer : {Answer::free, Answer::straight}) {
    Linkage<2> linkage = four_bars();
    const auto mechanisms = find_mechanisms(linkage.bodies, linkage.joints);
    std::vector<BodyMass<2>> masses(4);
    std::vector<BodyMotion<2>> motions(4);
    const auto total = [&] {
      Eigen::Vector3d sum = Eigen::Vector3d::Zero();
      for (int b = 0; b < 4; ++b) {
        const Eigen::Vector3d p = masses[b].matrix * motions[b].twist;
        EXPECT_LT((p - motions[b].momentum).norm(), 1e-12);
        sum += p;
        sum[2] += cross<2>(linkage.poses[b].position, Point<2>(p.head<2>()))[0];
      }
      return sum;
    };
    for (int b = 0; b < 4; ++b) {
      masses[b] = mass_of<2>(Eigen::Vector3d(b + 1, b + 1, 0.1).asDiagonal());
      motions[b].twist << 0.3 * b, 1 - 0.2 * b, 1.5 - b;
      motions[b].momentum = masses[b].matrix * motions[b].twist;
    }
    const Eigen::Vector3d momentum = total();
    const ClosingProblem<2> problem{mechanisms[0], linkage.joints, linkage.poses,
                                    linkage.poses, masses,         0.1};
    ASSERT_TRUE(close_joints(problem, answer, motions));
    for (const Joint<2>& joint : linkage.joints)
      EXPECT_LT(largest_gap(joint, poses_after(problem, motions)), 1e-12);
    EXPECT_LT((total() - momentum).norm(), 1e-12);
  }
}

/// Two mechanisms whose bodies and joints alternate, a loop and a chain on a prescribed body, move
/// each under its own numbers as they do among all.
TEST(Closing, AMechanismAloneIsTheSameBitForBit) {
  Linkage<2> linkage;
  const Point<2> corners[] = {{0, 0}, {2, 0}, {2.5, 1}, {0.5, 1}};
  for (int k = 0; k < 4; ++k) {
    linkage.add_body({3. + k, 0}, AngularVector<2>(0.2), k > 0);
    linkage.add_body(0.5 * (corners[k] + corners[(k + 1) % 4]), AngularVector<2>(0.3 * k));
  }
  for (int k = 0; k < 4; ++k) {
    if (k > 0)
      linkage.add_joint("hinge", 2 * k - 2, 2 * k, {2.5 + k, 0});
    linkage.add_joint("hinge", 2 * k + 1, 2 * ((k + 1) % 4) + 1, corners[(k + 1) % 4]);
  }
  const auto mechanisms = find_mechanisms(linkage.bodies, linkage.joints);
  ASSERT_EQ(mechanisms.size(), 2u);
  std::vector<BodyMass<2>> masses;
  std::vector<BodyMotion<2>> among_all(8);
  for (int b = 0; b < 8; ++b) {
    masses.push_back(mass_of<2>(Eigen::Vector3d(b + 1, b + 1, 0.1).asDiagonal()));
    among_all[b].twist << 0.1 * b, 1 - 0.2 * b, 1.5 - 0.3 * b;
    among_all[b].momentum = masses[b].matrix * among_all[b].twist;
  }
  for (const Mechanism& mechanism : mechanisms) {
    const LoneMechanism<2> lone = alone(mechanism, linkage.joints);
    EXPECT_EQ(lone.bodies.size(), 4u);
    const auto poses = lone.of_bodies(linkage.poses);
    const auto own_masses = lone.of_bodies(masses);
    auto by_itself = lone.of_bodies(among_all);
    ASSERT_TRUE(close_joints({mechanism, linkage.joints, linkage.poses, linkage.poses, masses, 0.1},
                             Answer::free, among_all));
    ASSERT_TRUE(close_joints({lone.mechanism, lone.joints, poses, poses, own_masses, 0.1},
                             Answer::free, by_itself));
    for (std::size_t b = 0; b < mechanism.bodies.size(); ++b) {
      EXPECT_EQ(by_itself[b].twist, among_all[mechanism.bodies[b]].twist);
      EXPECT_EQ(by_itself[b].momentum, among_all[mechanism.bodies[b]].momentum);
    }
  }
}

TEST(Closing, RatesTakeTreesToTheirCoordinates) {
  Linkage<3> linkage;
  linkage.add_body({0, 0, 0}, {0.1, 0.2, 0.3});
  linkage.add_body({1, 0.2, 0}, {-0.4, 0.2, 0});
  linkage.add_body({2, -0.3, 0.5}, {0, 0, 1});
  linkage.add_joint("ball", 1, 0, {0.5, 0, 0});
  linkage.add_joint("cylinder", 1, 2, {1.5, 0, 0.2});
  const auto mechanisms = find_mechanisms(linkage.bodies, linkage.joints);
  const std::vector<BodyMass<3>> masses(3);
  const ClosingProblem<3> problem{mechanisms[0], linkage.joints, linkage.poses,
                                  linkage.poses, masses,         0.5};
  const TwistVector<3> some = TwistVector<3>::Constant(0.7);
  std::vector<BodyMotion<3>> motions(3, {some, some});
  Eigen::VectorXd change(5);
  change << 0.5, -1, 2, 0.3, -2;
  follow_rates(problem, change, motions);
  const std::vector<BodyPose<3>> after = poses_after(problem, motions);
  int first = 0;
  for (const Joint<3>& joint : linkage.joints) {
    EXPECT_LT(largest_gap(joint, after), 1e-13);
    const Eigen::VectorXd q = change.segment(first, joint.q.size());
    EXPECT_LT(joint.kind->distance_to(place_of(joint, after).pose, q).norm(), 1e-13);
    first += static_cast<int>(joint.q.size());
  }
}

}  // namespace lockstep::test
