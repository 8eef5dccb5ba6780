#include "support/weights_of.hpp"

#include <Tpetra_Vector.hpp>

#include "support/dense.hpp"

namespace lockstep::test {

template <int dim>
GatheredFaces<dim> gathered_faces(CoupledCase<dim>& c) {
  GatheredFaces<dim> result;
  std::vector<int> row_of_face(c.fluid.faces().size(), -1);
  for (const auto& face : c.fluid.faces()) {
    if (face.kind != FakeFluid<dim>::FaceKind::coupled)
      continue;
    row_of_face[face.volume.id] = static_cast<int>(result.volumes.size());
    result.volumes.push_back(face.volume);
  }
  const int n_rows = static_cast<int>(result.volumes.size());
  const auto in_rows = [&](const std::vector<double>& mine) {
    Eigen::VectorXd all = Eigen::VectorXd::Zero(n_rows);
    for (std::size_t f = 0; f < mine.size(); ++f)
      all[row_of_face[c.fluid.coupled_volumes()[f].id]] = mine[f];
    return all;
  };
  result.masses = in_rows(c.coupling.fluid_mass());
  sum_over_ranks(c.solids.comm(), result.masses);
  const int n_dofs = static_cast<int>(c.solids.n_unknowns());
  const int n_all = static_cast<int>(c.solids.map()->getGlobalNumElements());
  const Eigen::VectorXd prescribed = in_rows(c.coupling.velocity(*make_vector(c.solids.map())));
  result.weights.resize(n_rows, n_dofs);
  for (int k = 0; k < n_dofs; ++k) {
    const auto unit = distributed(Eigen::VectorXd::Unit(n_all, k), c.solids.map());
    result.weights.col(k) = in_rows(c.coupling.velocity(*unit)) - prescribed;
  }
  sum_over_ranks(c.solids.comm(), result.weights);
  return result;
}

template GatheredFaces<2> gathered_faces<2>(CoupledCase<2>&);
template GatheredFaces<3> gathered_faces<3>(CoupledCase<3>&);

}  // namespace lockstep::test
