// Set-up: makes the model of one rank from the bodies of a scene.
#include <algorithm>
#include <numeric>

#include "base/errors.hpp"
#include "deformable/deformable_solids.hpp"
#include "linear/matrix_rows.hpp"

namespace lockstep {

namespace {

/// Elements that touch a node of this rank.
std::vector<int> elements_seen(const ElementCorners& corners, const std::vector<int>& rank_of_node,
                               int rank) {
  std::vector<int> kept;
  const int n = static_cast<int>(corners.nodes.size()) / corners.n_corners;
  for (int e = 0; e < n; ++e) {
    for (int k = 0; k < corners.n_corners; ++k) {
      if (rank_of_node[corners.nodes[e * corners.n_corners + k]] == rank) {
        kept.push_back(e);
        break;
      }
    }
  }
  return kept;
}

ElementCorners shifted(ElementCorners corners, int shift) {
  for (int& node : corners.nodes)
    node += shift;
  return corners;
}

}  // namespace

template <int dim>
DeformableSolids<dim>::DeformableSolids(const std::string& type,
                                        std::vector<DeformableBody<dim>> bodies,
                                        const Point<dim>& gravity, const Communicator& comm,
                                        double start_time)
    : type_(type), comm_(comm), gravity_(gravity), held_(start_time) {
  int n_nodes = 0;
  for (auto& body : bodies) {
    add_body(body, n_nodes);
    n_nodes += body.n_nodes();
  }
  distribute(bodies, comm);
  hold_nodes(bodies);
  held_.begin_step(start_time);
  assemble_mass(bodies);
  distribute_surface(bodies);
  find_boundary_nodes();
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    for (const auto& [node, solid] : bodies[b].attached) {
      const int local = space_.numbers().local[bodies_[b].node_begin + node];
      if (local >= 0 && local < space_.n_owned())
        attached_.emplace_back(local, solid);
    }
  }
  make_strain_limit(bodies);
  space_.forget_numbers();
  update_geometry();
  bound_frequencies();
}

template <int dim>
void DeformableSolids<dim>::add_body(DeformableBody<dim>& body, int node_begin) {
  SolidDescription solid;
  solid.name = body.name;
  solid.closed = body.closed;
  solid.rigid = false;
  solid.density = body.density;
  solid.restitution = body.restitution;
  solid.friction = body.friction;
  solid.index_in_model = static_cast<int>(solids_.size());
  solid.simplex_begin = solids_.empty() ? 0 : solids_.back().simplex_end;
  solid.simplex_end = solid.simplex_begin + static_cast<int>(body.surface.size());
  solids_.push_back(solid);

  Body part;
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
  bodies_.push_back(std::move(part));
}

template <int dim>
void DeformableSolids<dim>::distribute(std::vector<DeformableBody<dim>>& bodies,
                                       const Communicator& comm) {
  std::vector<ElementCorners> corners;
  int n_nodes = 0;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const int shift = bodies_[b].node_begin;
    for (const auto& group : bodies[b].elements)
      corners.push_back(shifted(group->corners(), shift));
    corners.push_back(shifted(bodies[b].mass_elements, shift));
    n_nodes += bodies[b].n_nodes();
  }
  space_ = NodeSpace<dim>(n_nodes, corners, comm);
  const auto& numbers = space_.numbers();

  Nodes velocity(space_.n_owned());
  x_.resize(space_.n_local());
  for (int i = 0; i < space_.n_local(); ++i) {
    const int original = space_.original(i);
    const auto body =
        std::upper_bound(bodies_.begin(), bodies_.end(), original,
                         [](int node, const auto& other) { return node < other.node_end; });
    const auto b = static_cast<std::size_t>(body - bodies_.begin());
    const int n = original - bodies_[b].node_begin;
    x_[i] = bodies[b].position[n];
    body_of_node_.push_back(static_cast<int>(b));
    if (i >= space_.n_owned())
      continue;
    node_force_.push_back(bodies[b].force[n]);
    velocity[i] = bodies[b].velocity[n];
  }
  velocity_ = space_.vector(velocity);

  std::vector<ElementCorners> local_corners;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const int begin = bodies_[b].node_begin, end = bodies_[b].node_end;
    const std::vector<int> local(numbers.local.begin() + begin, numbers.local.begin() + end);
    for (const auto& group : bodies[b].elements) {
      const auto kept =
          elements_seen(shifted(group->corners(), begin), numbers.rank, comm->getRank());
      bodies_[b].elements.push_back(group->restricted(kept, local));
      local_corners.push_back(bodies_[b].elements.back()->corners());
    }
  }
  stiffness_ = NodeMatrix<dim>(space_.n_owned(), local_corners);
  damping_ = stiffness_;
}

template <int dim>
void DeformableSolids<dim>::hold_nodes(const std::vector<DeformableBody<dim>>& bodies) {
  std::vector<std::vector<std::array<int, dim>>> number(bodies.size());
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    std::array<int, dim> none;
    none.fill(-1);
    number[b].assign(bodies[b].locked.size(), none);
    for (const NodeHold<dim>& hold : bodies[b].holds) {
      const int h = held_.add(hold);
      for (const int n : hold.nodes) {
        for (int a = 0; a < dim; ++a)
          number[b][n][a] = hold.axes[a] ? h : number[b][n][a];
      }
    }
  }
  for (int i = 0; i < space_.n_owned(); ++i) {
    const int b = body_of_node_[i], n = space_.original(i) - bodies_[b].node_begin;
    for (int a = 0; a < dim; ++a) {
      if (bodies[b].locked[n][a])
        held_.hold(i, a, x_[i], number[b][n][a]);
    }
  }
  Nodes velocity = space_.owned(*velocity_);
  const std::vector<int> dofs = held_.dofs();
  const std::vector<double> velocities = held_.velocities(held_.start_time(), held_.start_time());
  for (std::size_t k = 0; k < dofs.size(); ++k)
    velocity[dofs[k] / dim][dofs[k] % dim] = velocities[k];
  velocity_ = space_.vector(velocity);
}

template <int dim>
void DeformableSolids<dim>::assemble_mass(const std::vector<DeformableBody<dim>>& bodies) {
  const auto& numbers = space_.numbers();
  node_mass_.assign(space_.n_owned(), 0);
  node_share_.assign(space_.n_owned(), 0);
  std::vector<std::vector<Entry>> rows(dim * space_.n_owned());
  const auto add = [&](int row_node, int column_original, double mass) {
    for (int a = 0; a < dim; ++a) {
      const GlobalIndex column = GlobalIndex(dim) * numbers.global[column_original] + a;
      rows[dim * row_node + a].push_back({column, mass});
    }
  };
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const ElementCorners& corners = bodies[b].mass_elements;
    const int n = corners.n_corners, begin = bodies_[b].node_begin;
    for (std::size_t e = 0; e < bodies[b].element_measure.size(); ++e) {
      const double mass = bodies[b].density * bodies[b].element_measure[e];
      for (int i = 0; i < n; ++i) {
        const int node = begin + corners.nodes[n * e + i], row = numbers.local[node];
        if (row < 0 || row >= space_.n_owned())
          continue;
        node_mass_[row] += mass / n;
        node_share_[row] += bodies[b].element_measure[e] / (n * bodies_[b].measure);
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
  for (int i = 0; i < space_.n_owned(); ++i) {
    // Anchors of tethers belong to no element and never move; nodes of a massless body take the
    // fluid's mass.
    add(i, space_.original(i), node_share_[i] == 0 ? 1 : 0);
  }
  mass_ = as_operator(matrix_from_rows(space_.dof_map(), rows));
}

template <int dim>
void DeformableSolids<dim>::distribute_surface(const std::vector<DeformableBody<dim>>& bodies) {
  const auto& numbers = space_.numbers();
  std::vector<int> rank_of_vertex, original_of_vertex;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    solids_[b].vertex_begin = static_cast<int>(surface_node_.size());
    std::vector<int> vertex(bodies[b].n_nodes(), -1);
    for (auto simplex : bodies[b].surface) {
      for (int& corner : simplex) {
        const int node = corner;
        if (vertex[node] < 0) {
          const int original = bodies_[b].node_begin + node;
          vertex[node] = static_cast<int>(surface_node_.size());
          surface_node_.push_back(numbers.global[original]);
          rank_of_vertex.push_back(numbers.rank[original]);
          original_of_vertex.push_back(original);
        }
        corner = vertex[node];
      }
      surface_.simplices.push_back(simplex);
    }
    solids_[b].vertex_end = static_cast<int>(surface_node_.size());
  }
  gathered_surface_vertices_.resize(surface_node_.size());
  std::iota(gathered_surface_vertices_.begin(), gathered_surface_vertices_.end(), 0);
  std::stable_sort(gathered_surface_vertices_.begin(), gathered_surface_vertices_.end(),
                   [&](int a, int b) { return rank_of_vertex[a] < rank_of_vertex[b]; });
  for (const int v : gathered_surface_vertices_) {
    if (rank_of_vertex[v] == comm_->getRank())
      own_surface_vertices_.push_back(numbers.local[original_of_vertex[v]]);
  }
  surface_velocity_.assign(surface_node_.size(), Point<dim>::Zero());
}

template DeformableSolids<2>::DeformableSolids(const std::string&, std::vector<DeformableBody<2>>,
                                               const Point<2>&, const Communicator&, double);
template DeformableSolids<3>::DeformableSolids(const std::string&, std::vector<DeformableBody<3>>,
                                               const Point<3>&, const Communicator&, double);

}  // namespace lockstep
