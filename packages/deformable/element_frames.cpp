#include "deformable/element_frames.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "output/frames.hpp"

namespace lockstep {

namespace {

/// sqrt(3/2) times the norm of the deviator.
double von_mises(const Eigen::Matrix3d& stress) {
  const Eigen::Matrix3d deviator = stress - stress.trace() / 3 * Eigen::Matrix3d::Identity();
  return std::sqrt(1.5) * deviator.norm();
}

void append_symmetric(std::vector<double>& values, const Eigen::Matrix3d& tensor) {
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j)
      values.push_back(0.5 * (tensor(i, j) + tensor(j, i)));
  }
}

/// Numbers of one element in a message: its corners, energy density, stress and strain.
constexpr int n_tensor = 6, n_numbers = 1 + 2 * n_tensor;

std::vector<double> packed(const ElementStates& states, int n_corners,
                           const std::vector<int>& number) {
  std::vector<double> values;
  for (std::size_t e = 0; e < states.stress.size(); ++e) {
    for (int k = 0; k < n_corners; ++k)
      values.push_back(number[states.corners[e * n_corners + k]]);
    values.push_back(states.energy_density[e]);
    append_symmetric(values, states.stress[e]);
    append_symmetric(values, states.strain[e]);
  }
  return values;
}

Eigen::Matrix3d unpacked(const double* values) {
  Eigen::Matrix3d tensor;
  for (int i = 0; i < 3; ++i) {
    for (int j = i; j < 3; ++j)
      tensor(i, j) = tensor(j, i) = *values++;
  }
  return tensor;
}

/// In the order of their corners, so that it is the same on any number of ranks.
void append_elements(const std::vector<double>& values, int n_corners, SurfaceFrame& frame) {
  const int stride = n_corners + n_numbers;
  std::vector<const double*> elements;
  for (std::size_t begin = 0; begin < values.size(); begin += stride)
    elements.push_back(&values[begin]);
  std::sort(elements.begin(), elements.end(), [=](const double* a, const double* b) {
    return std::lexicographical_compare(a, a + n_corners, b, b + n_corners);
  });
  const auto place = SurfaceField::Place::simplices;
  SurfaceField mises{"von Mises stress", "Pa", 1, place, {}};
  SurfaceField stress{"stress", "Pa", n_tensor, place, {}};
  SurfaceField strain{"strain", "1", n_tensor, place, {}};
  SurfaceField energy{"energy density", "J/m^3", 1, place, {}};
  for (const double* element : elements) {
    for (int k = 0; k < n_corners; ++k)
      frame.simplices.push_back(static_cast<int>(element[k]));
    const double* numbers = element + n_corners;
    energy.values.push_back(numbers[0]);
    mises.values.push_back(von_mises(unpacked(numbers + 1)));
    stress.values.insert(stress.values.end(), numbers + 1, numbers + 1 + n_tensor);
    strain.values.insert(strain.values.end(), numbers + 1 + n_tensor, numbers + n_numbers);
  }
  frame.fields = {mises, stress, strain, energy};
}

}  // namespace

template <int dim>
void add_element_frames(const ElementForces<dim>& forces, std::vector<SurfaceFrame>& frames) {
  const BodyNodes<dim>& nodes = forces.nodes;
  for (int b = 0; b < nodes.n_bodies(); ++b) {
    const SoftBody& body = nodes.bodies[b];
    const int n_corners = body.closed ? dim + 1 : dim, n_nodes = body.node_end - body.node_begin;
    ElementStates states;
    for (const auto& group : forces.elements[b]) {
      if (group->corners().n_corners == n_corners)
        group->add_states(nodes.x, nodes.n_owned(), states);
    }
    std::vector<int> number;
    for (int i = 0; i < nodes.space.n_local(); ++i)
      number.push_back(nodes.space.original(i) - body.node_begin);
    const std::vector<double> elements = gather_all(nodes.comm, packed(states, n_corners, number));
    if (elements.empty())
      continue;
    std::vector<double> mine;
    for (int i = 0; i < nodes.n_owned(); ++i) {
      if (nodes.body_of[i] != b)
        continue;
      mine.push_back(number[i]);
      mine.insert(mine.end(), nodes.x[i].data(), nodes.x[i].data() + dim);
    }
    const std::vector<double> places = gather_all(nodes.comm, mine);
    SurfaceFrame frame;
    frame.name = body.name + " elements";
    frame.dimension = dim;
    frame.simplex_size = n_corners;
    frame.vertices.resize(std::size_t(n_nodes) * dim);
    for (std::size_t k = 0; k < places.size(); k += dim + 1) {
      std::copy_n(&places[k + 1], dim,
                  frame.vertices.begin() + static_cast<std::ptrdiff_t>(places[k]) * dim);
    }
    append_elements(elements, n_corners, frame);
    frames.push_back(std::move(frame));
  }
}

template void add_element_frames(const ElementForces<2>&, std::vector<SurfaceFrame>&);
template void add_element_frames(const ElementForces<3>&, std::vector<SurfaceFrame>&);

}  // namespace lockstep
