// Spanning trees of the joints, and the joints that close loops in them.
#include "articulated/mechanism.hpp"

#include <algorithm>

#include "base/disjoint_sets.hpp"

namespace lockstep {

namespace {

template <int dim>
bool is_ground(const std::vector<JointedBody<dim>>& bodies, int body) {
  return body == space || bodies[body].prescribed();
}

/// Marks the joints that are in the trees.
template <int dim>
std::vector<char> tree_joints(const std::vector<JointedBody<dim>>& bodies,
                              const std::vector<Joint<dim>>& joints) {
  const int ground = static_cast<int>(bodies.size());
  DisjointSets groups(ground + 1);  // bodies joined so far; the ground is the last
  std::vector<char> in_tree(joints.size(), 0);
  for (const bool wanted : {true, false}) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      if (joints[j].wants_rates() != wanted)
        continue;
      std::array<int, 2> ends;
      for (int side = 0; side < 2; ++side) {
        const int body = joints[j].sides[side].body;
        ends[side] = is_ground(bodies, body) ? ground : body;
      }
      in_tree[j] = groups.join(ends[0], ends[1]) ? 1 : 0;
    }
  }
  return in_tree;
}

/// The joints of the tree, by body.
template <int dim>
std::vector<std::vector<int>> joints_by_body(const std::vector<JointedBody<dim>>& bodies,
                                             const std::vector<Joint<dim>>& joints,
                                             const std::vector<char>& in_tree) {
  std::vector<std::vector<int>> all(bodies.size());
  for (std::size_t j = 0; j < joints.size(); ++j) {
    for (const JointSide<dim>& side : joints[j].sides) {
      if (in_tree[j] && side.body != space)
        all[side.body].push_back(static_cast<int>(j));
    }
  }
  return all;
}

/// Follows the tree's joints outward from the bodies that the mechanism has.
template <int dim>
void grow(Mechanism& mechanism, const std::vector<JointedBody<dim>>& bodies,
          const std::vector<Joint<dim>>& joints, const std::vector<std::vector<int>>& of_body,
          std::vector<char>& reached) {
  for (std::size_t next = 0; next < mechanism.bodies.size(); ++next) {
    const int body = mechanism.bodies[next];
    for (const int j : of_body[body]) {
      const auto& sides = joints[j].sides;
      const int child = sides[sides[0].body == body ? 1 : 0].body;
      if (is_ground(bodies, child) || reached[child])
        continue;
      reached[child] = 1;
      mechanism.bodies.push_back(child);
      mechanism.carriers.push_back(j);
    }
  }
}

template <int dim>
Mechanism grown_from(int start, int carrier, const std::vector<JointedBody<dim>>& bodies,
                     const std::vector<Joint<dim>>& joints,
                     const std::vector<std::vector<int>>& of_body, std::vector<char>& reached) {
  Mechanism mechanism;
  mechanism.root = carrier >= 0 ? space : start;
  mechanism.bodies.push_back(start);
  mechanism.carriers.push_back(carrier);
  reached[start] = 1;
  grow(mechanism, bodies, joints, of_body, reached);
  return mechanism;
}

/// The heaviest: where it is the root no rate moves it, and what light ones have of inertia is not
/// lost in its. Of bodies alike the first of the scene, so that it matters to nothing which solid a
/// joint names first.
template <int dim>
int best_root(const std::vector<int>& members, const std::vector<JointedBody<dim>>& bodies) {
  constexpr double alike = 1e-6;
  double most = 0;
  for (const int body : members)
    most = std::max(most, bodies[body].weight());
  int best = -1;
  for (const int body : members) {
    if (bodies[body].weight() >= (1 - alike) * most &&
        (best < 0 || bodies[body].first_dof < bodies[best].first_dof))
      best = body;
  }
  return best;
}

/// Trees that hang on the ground by this joint (other joints to the ground close loops), or free
/// ones.
template <int dim>
Mechanism tree_with(int joint, const std::vector<JointedBody<dim>>& bodies,
                    const std::vector<Joint<dim>>& joints,
                    const std::vector<std::vector<int>>& of_body, std::vector<char>& reached) {
  const auto& sides = joints[joint].sides;
  const bool first_is_ground = is_ground(bodies, sides[0].body);
  const int start = sides[first_is_ground ? 1 : 0].body;
  if (first_is_ground || is_ground(bodies, sides[1].body))
    return grown_from(start, joint, bodies, joints, of_body, reached);
  const Mechanism mechanism = grown_from(start, -1, bodies, joints, of_body, reached);
  const int root = best_root(mechanism.bodies, bodies);
  if (root == start)
    return mechanism;
  for (const int body : mechanism.bodies)
    reached[body] = 0;
  return grown_from(root, -1, bodies, joints, of_body, reached);
}

}  // namespace

template <int dim>
std::vector<Mechanism> find_mechanisms(const std::vector<JointedBody<dim>>& bodies,
                                       std::vector<Joint<dim>>& joints) {
  const std::vector<char> in_tree = tree_joints(bodies, joints);
  const std::vector<std::vector<int>> of_body = joints_by_body(bodies, joints, in_tree);
  std::vector<char> reached(bodies.size(), 0);
  std::vector<Mechanism> mechanisms;
  // joints on the ground first, since a mechanism on it is not free
  for (const bool on_ground : {true, false}) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const int first = joints[j].sides[0].body, second = joints[j].sides[1].body;
      const bool touches = is_ground(bodies, first) || is_ground(bodies, second);
      const int start = is_ground(bodies, first) ? second : first;
      if (in_tree[j] && touches == on_ground && !reached[start])
        mechanisms.push_back(tree_with(static_cast<int>(j), bodies, joints, of_body, reached));
    }
  }
  int n_all = 0;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    if (!in_tree[j])
      continue;
    joints[j].first_rate = n_all;
    n_all += joints[j].kind->n_rates();
  }
  // Loops may tie two trees of the ground together: they are one mechanism then.
  const int n = static_cast<int>(mechanisms.size());
  std::vector<int> home(bodies.size(), -1);
  for (int m = 0; m < n; ++m) {
    for (const int body : mechanisms[m].bodies)
      home[body] = m;
  }
  DisjointSets together(n);
  const auto home_of = [&](int body) { return is_ground(bodies, body) ? -1 : home[body]; };
  for (const Joint<dim>& joint : joints) {
    const int a = home_of(joint.sides[0].body), b = home_of(joint.sides[1].body);
    if (a >= 0 && b >= 0)
      together.join(a, b);
  }
  std::vector<Mechanism> joined(n);
  for (int m = 0; m < n; ++m) {
    Mechanism& whole = joined[together.root(m)];
    if (whole.bodies.empty())
      whole.root = mechanisms[m].root;
    whole.bodies.insert(whole.bodies.end(), mechanisms[m].bodies.begin(),
                        mechanisms[m].bodies.end());
    whole.carriers.insert(whole.carriers.end(), mechanisms[m].carriers.begin(),
                          mechanisms[m].carriers.end());
  }
  for (std::size_t j = 0; j < joints.size(); ++j) {
    int m = -1;
    for (const JointSide<dim>& side : joints[j].sides)
      m = std::max(m, home_of(side.body));
    Mechanism& mechanism = joined[together.root(m)];
    mechanism.joints.push_back(static_cast<int>(j));
    if (!in_tree[j])
      mechanism.loops.push_back(static_cast<int>(j));
    for (const JointSide<dim>& side : joints[j].sides) {
      auto& grounds = mechanism.grounds;
      if (side.body != space && is_ground(bodies, side.body) &&
          std::find(grounds.begin(), grounds.end(), side.body) == grounds.end())
        grounds.push_back(side.body);
    }
  }
  joined.erase(std::remove_if(joined.begin(), joined.end(),
                              [](const Mechanism& one) { return one.bodies.empty(); }),
               joined.end());
  return joined;
}

template <int dim>
std::vector<int> loop_of(const Mechanism& mechanism, const std::vector<Joint<dim>>& joints,
                         int closing) {
  // The ways of both sides to the root; what they share is not in the loop.
  std::vector<int> loop;
  for (const JointSide<dim>& side : joints[closing].sides) {
    int body = side.body;
    while (true) {
      const auto place = std::find(mechanism.bodies.begin(), mechanism.bodies.end(), body);
      const int carrier = place == mechanism.bodies.end()
                              ? -1
                              : mechanism.carriers[place - mechanism.bodies.begin()];
      if (carrier < 0)
        break;
      const auto known = std::find(loop.begin(), loop.end(), carrier);
      if (known == loop.end())
        loop.push_back(carrier);
      else
        loop.erase(known);
      const auto& [first, second] = joints[carrier].sides;
      body = first.body == body ? second.body : first.body;
    }
  }
  loop.insert(loop.begin(), closing);
  return loop;
}

template std::vector<Mechanism> find_mechanisms(const std::vector<JointedBody<2>>&,
                                                std::vector<Joint<2>>&);
template std::vector<Mechanism> find_mechanisms(const std::vector<JointedBody<3>>&,
                                                std::vector<Joint<3>>&);
template std::vector<int> loop_of(const Mechanism&, const std::vector<Joint<2>>&, int);
template std::vector<int> loop_of(const Mechanism&, const std::vector<Joint<3>>&, int);

}  // namespace lockstep
