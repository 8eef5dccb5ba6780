#include "deformable/body_nodes.hpp"

#include <algorithm>
#include <numeric>

#include "linear/matrix_rows.hpp"

namespace lockstep {

ElementCorners shifted(ElementCorners corners, int node_begin) {
  for (int& node : corners.nodes)
    node += node_begin;
  return corners;
}

namespace {

template <int dim>
SoftBody soft_body(const DeformableBody<dim>& body, int node_begin) {
  SoftBody part;
  part.name = body.name;
  part.closed = body.closed;
  part.consistent_mass = body.consistent_mass;
  part.integration = body.integration;
  part.most_sub_steps = body.most_sub_steps;
  part.measure = std::accumulate(body.element_measure.begin(), body.element_measure.end(), 0.0);
  part.mass = body.density * part.measure;
  part.fluid_mass = body.fluid_density * part.measure;
  part.node_begin = node_begin;
  part.node_end = node_begin + body.n_nodes();
  return part;
}

/// Fills `space`, and what the bodies say of each of its nodes.
template <int dim>
void distribute(const std::vector<DeformableBody<dim>>& bodies, BodyNodes<dim>& nodes) {
  std::vector<ElementCorners> corners;
  int n_nodes = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (const auto& group : bodies[b].elements)
      corners.push_back(shifted(group->corners(), n_nodes));
    corners.push_back(shifted(bodies[b].mass_elements, n_nodes));
    n_nodes += bodies[b].n_nodes();
  }
  nodes.space = NodeSpace<dim>(n_nodes, corners, nodes.comm);
  std::vector<Point<dim>> velocity(nodes.n_owned());
  nodes.x.resize(nodes.space.n_local());
  for (int i = 0; i < nodes.space.n_local(); ++i) {
    const int original = nodes.space.original(i);
    const auto body =
        std::upper_bound(nodes.bodies.begin(), nodes.bodies.end(), original,
                         [](int node, const auto& other) { return node < other.node_end; });
    const auto b = static_cast<std::size_t>(body - nodes.bodies.begin());
    const int n = original - body->node_begin;
    nodes.x[i] = bodies[b].position[n];
    nodes.body_of.push_back(static_cast<int>(b));
    if (i >= nodes.n_owned())
      continue;
    nodes.load.push_back(bodies[b].force[n]);
    velocity[i] = bodies[b].velocity[n];
  }
  nodes.velocity = nodes.space.vector(velocity);
}

template <int dim>
void hold_nodes(const std::vector<DeformableBody<dim>>& bodies, BodyNodes<dim>& nodes) {
  HeldNodes<dim>& held = nodes.held;
  std::vector<std::vector<std::array<int, dim>>> number(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::array<int, dim> none;
    none.fill(-1);
    number[b].assign(bodies[b].locked.size(), none);
    for (const NodeHold<dim>& hold : bodies[b].holds) {
      const int h = held.add(hold);
      for (const int n : hold.nodes) {
        for (int a = 0; a < dim; ++a)
          number[b][n][a] = hold.axes[a] ? h : number[b][n][a];
      }
    }
  }
  for (int i = 0; i < nodes.n_owned(); ++i) {
    const int b = nodes.body_of[i], n = nodes.space.original(i) - nodes.bodies[b].node_begin;
    for (int a = 0; a < dim; ++a) {
      if (bodies[b].locked[n][a])
        held.hold(i, a, nodes.x[i], number[b][n][a]);
    }
  }
  std::vector<Point<dim>> velocity = nodes.space.owned(*nodes.velocity);
  const std::vector<int> dofs = held.dofs();
  const std::vector<double> velocities = held.velocities(held.start_time(), held.start_time());
  for (std::size_t k = 0; k < dofs.size(); ++k)
    velocity[dofs[k] / dim][dofs[k] % dim] = velocities[k];
  nodes.velocity = nodes.space.vector(velocity);
  held.begin_step(held.start_time());
}

template <int dim>
void assemble_mass(const std::vector<DeformableBody<dim>>& bodies, BodyNodes<dim>& nodes) {
  const auto& numbers = nodes.space.numbers();
  const int n_owned = nodes.n_owned();
  nodes.mass.assign(n_owned, 0);
  nodes.share.assign(n_owned, 0);
  std::vector<std::vector<Entry>> rows(dim * n_owned);
  const auto add = [&](int row_node, int column_original, double mass) {
    for (int a = 0; a < dim; ++a) {
      const GlobalIndex column = GlobalIndex(dim) * numbers.global[column_original] + a;
      rows[dim * row_node + a].push_back({column, mass});
    }
  };
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const ElementCorners& corners = bodies[b].mass_elements;
    const int n = corners.n_corners, begin = nodes.bodies[b].node_begin;
    for (std::size_t e = 0; e < bodies[b].element_measure.size(); ++e) {
      const double mass = bodies[b].density * bodies[b].element_measure[e];
      for (int i = 0; i < n; ++i) {
        const int node = begin + corners.nodes[n * e + i], row = numbers.local[node];
        if (row < 0 || row >= n_owned)
          continue;
        nodes.mass[row] += mass / n;
        nodes.share[row] += bodies[b].element_measure[e] / (n * nodes.bodies[b].measure);
        if (!bodies[b].consistent_mass) {
          add(row, node, mass / n);
          continue;
        }
        for (int j = 0; j < n; ++j) {
          add(row, begin + corners.nodes[n * e + j], (i == j ? 2 : 1) * mass / (n * (n + 1)));
        }
      }
    }
  }
  for (int i = 0; i < n_owned; ++i) {
    // Anchors of tethers belong to no element and never move; nodes of a massless body take the
    // fluid's mass.
    add(i, nodes.space.original(i), nodes.share[i] == 0 ? 1 : 0);
  }
  nodes.mass_matrix = as_operator(matrix_from_rows(nodes.space.dof_map(), rows));
}

}  // namespace

template <int dim>
BodyNodes<dim>::BodyNodes(const std::vector<DeformableBody<dim>>& at_start,
                          const Point<dim>& acceleration, const Communicator& ranks,
                          double start_time)
    : comm(ranks), gravity(acceleration), held(start_time) {
  for (const auto& one : at_start)
    bodies.push_back(soft_body(one, bodies.empty() ? 0 : bodies.back().node_end));
  distribute(at_start, *this);
  hold_nodes(at_start, *this);
  assemble_mass(at_start, *this);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (const auto& [node, solid] : at_start[b].attached) {
      const int local = space.numbers().local[bodies[b].node_begin + node];
      if (local >= 0 && local < n_owned())
        attached.emplace_back(local, solid);
    }
  }
}

template <int dim>
void BodyNodes<dim>::hold(Nodes& values) const {
  for (const int dof : held.dofs())
    values[dof / dim][dof % dim] = 0;
  for (const auto& [node, carrier] : attached)
    values[node].setZero();
}

template <int dim>
std::vector<char> BodyNodes<dim>::free_bodies() const {
  std::vector<double> n_held(bodies.size(), 0);
  for (const int dof : held.dofs())
    ++n_held[body_of[dof / dim]];
  for (const auto& [node, carrier] : attached)
    ++n_held[body_of[node]];
  sum_all(comm, n_held.data(), static_cast<int>(n_held.size()));
  std::vector<char> is_free(bodies.size());
  for (std::size_t b = 0; b < is_free.size(); ++b)
    is_free[b] = n_held[b] == 0;
  return is_free;
}

template struct BodyNodes<2>;
template struct BodyNodes<3>;

}  // namespace lockstep
