#include "deformable/element_forces.hpp"

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

}  // namespace

template <int dim>
ElementForces<dim>::ElementForces(const std::vector<DeformableBody<dim>>& bodies,
                                  const BodyNodes<dim>& of_nodes)
    : nodes(of_nodes),
      elements(bodies.size()),
      softening(bodies.size(), 1),
      energy(bodies.size(), 0) {
  const auto& numbers = nodes.space.numbers();
  std::vector<ElementCorners> corners;
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    const int begin = nodes.bodies[b].node_begin, end = nodes.bodies[b].node_end;
    const std::vector<int> local(numbers.local.begin() + begin, numbers.local.begin() + end);
    for (const auto& group : bodies[b].elements) {
      const auto kept =
          elements_seen(shifted(group->corners(), begin), numbers.rank, nodes.comm->getRank());
      elements[b].push_back(group->restricted(kept, local));
      if (const int n = group->n_state(); n > 0) {
        ElementGroup<dim>& own = *elements[b].back();
        own.states()->assign(kept.size() * n, 0);
        remembering.push_back({static_cast<int>(b), &own, kept});
      }
      corners.push_back(elements[b].back()->corners());
    }
  }
  stiffness = NodeMatrix<dim>(nodes.n_owned(), corners);
  damping = stiffness;
}

template <int dim>
bool ElementForces<dim>::end_step(const Nodes& x, double dt) {
  for (const Remembering& one : remembering)
    one.group->end_step(x, dt);
  return !remembering.empty();
}

template <int dim>
void ElementForces<dim>::assemble(const Nodes& x) {
  elastic.assign(nodes.space.n_local(), Point<dim>::Zero());
  stiffness.set_zero();
  damping.set_zero();
  n_clamped = 0;
  ++number;
  energy.assign(elements.size(), 0);
  for (std::size_t b = 0; b < elements.size(); ++b) {
    for (const auto& group : elements[b]) {
      energy[b] += group->add_elastic_forces(x, nodes.n_owned(), elastic);
      n_clamped += group->add_stiffness(x, stiffness);
      group->add_damping(x, damping);
    }
  }
  elastic.resize(nodes.n_owned());
  for (int i = 0; i < nodes.n_owned(); ++i) {
    const double factor = softening[nodes.body_of[i]];
    if (factor == 1)
      continue;
    elastic[i] *= factor;
    stiffness.scale_row(i, factor);
  }
  n_clamped = sum_all(nodes.comm, n_clamped);
  sum_all(nodes.comm, energy.data(), static_cast<int>(energy.size()));
  for (std::size_t b = 0; b < energy.size(); ++b)
    energy[b] *= softening[b];
}

template struct ElementForces<2>;
template struct ElementForces<3>;

}  // namespace lockstep
