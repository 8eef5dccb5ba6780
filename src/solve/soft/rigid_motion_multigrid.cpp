#include "solve/soft/rigid_motion_multigrid.hpp"

#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <vector>

#include "linear/action_operator.hpp"
#include "linear/matrix_part.hpp"
#include "solve/soft/muelu_multigrid.hpp"

namespace lockstep {

namespace {

/// x -> sum_b R_b E_b^-1 R_b^T x with E_b = R_b^T C R_b, R_b the motions of body b.
class DeflatedMotions {
 public:
  DeflatedMotions(const CrsMatrix& c, const RCP<const MultiVector>& motions,
                  std::vector<int> bodies, int n_bodies)
      : motions_(motions),
        bodies_(std::move(bodies)),
        n_motions_(static_cast<int>(motions->getNumVectors())),
        n_bodies_(n_bodies) {
    MultiVector image(motions->getMap(), n_motions_);
    c.apply(*motions, image);
    // The diagonal blocks suffice: couplings between bodies are dropped.
    std::vector<double> energies(std::size_t(n_bodies) * n_motions_ * n_motions_, 0);
    for (int j = 0; j < n_motions_; ++j) {
      const std::vector<double> column = products(*image.getVector(j));
      for (int b = 0; b < n_bodies; ++b) {
        for (int i = 0; i < n_motions_; ++i)
          energies[(b * n_motions_ + j) * n_motions_ + i] = column[b * n_motions_ + i];
      }
    }
    for (int b = 0; b < n_bodies; ++b) {
      const Eigen::Map<const Eigen::MatrixXd> energy(&energies[b * n_motions_ * n_motions_],
                                                     n_motions_, n_motions_);
      inverses_.push_back(pseudo_inverse(0.5 * (energy + energy.transpose())));
    }
  }

  void add(const Vector& x, Vector& y) const {
    std::vector<double> amounts = products(x);
    for (int b = 0; b < n_bodies_; ++b) {
      Eigen::Map<Eigen::VectorXd> amount(&amounts[b * n_motions_], n_motions_);
      amount = (inverses_[b] * amount).eval();
    }
    const auto result = y.getDataNonConst();
    for (int j = 0; j < n_motions_; ++j) {
      const auto motion = motions_->getData(j);
      for (std::size_t row = 0; row < bodies_.size(); ++row)
        result[row] += motion[row] * amounts[bodies_[row] * n_motions_ + j];
    }
  }

 private:
  /// R_b^T x of all bodies.
  std::vector<double> products(const Vector& x) const {
    std::vector<double> sums(std::size_t(n_bodies_) * n_motions_, 0);
    const auto values = x.getData();
    for (int j = 0; j < n_motions_; ++j) {
      const auto motion = motions_->getData(j);
      for (std::size_t row = 0; row < bodies_.size(); ++row)
        sums[bodies_[row] * n_motions_ + j] += motion[row] * values[row];
    }
    sum_over_ranks(x.getMap()->getComm(), sums);
    return sums;
  }

  /// A body of a few nodes, or one held, may lack some motion.
  static Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& energy) {
    const Eigen::VectorXd scale =
        energy.diagonal().unaryExpr([](double e) { return e > 0 ? 1 / std::sqrt(e) : 0.0; });
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scale.asDiagonal() * energy *
                                                               scale.asDiagonal());
    const Eigen::VectorXd inverse =
        eigen.eigenvalues().unaryExpr([](double e) { return e > 1e-12 ? 1 / e : 0.0; });
    return scale.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() *
           eigen.eigenvectors().transpose() * scale.asDiagonal();
  }

  RCP<const MultiVector> motions_;
  std::vector<int> bodies_;
  int n_motions_, n_bodies_;
  std::vector<Eigen::MatrixXd> inverses_;
};

}  // namespace

RCP<const LinearOperator> rigid_motion_multigrid(const RCP<const CrsMatrix>& c,
                                                 const NearNullSpace& space,
                                                 const Teuchos::ParameterList& list,
                                                 const std::string& name) {
  std::vector<bool> is_node, is_other;
  std::vector<int> bodies;
  for (const int body : space.body_of_row) {
    is_node.push_back(body >= 0);
    is_other.push_back(body < 0);
    if (body >= 0)
      bodies.push_back(body);
  }
  const auto node_part = std::make_shared<const MatrixPart>(*c, is_node);
  const auto others = std::make_shared<const MatrixPart>(*c, is_other);
  const MatrixPart& nodes = *node_part;
  const auto motions = rcp(new MultiVector(nodes.map(), space.motions->getNumVectors()));
  for (std::size_t j = 0; j < motions->getNumVectors(); ++j)
    motions->getVectorNonConst(j)->update(1, *nodes.restricted(*space.motions->getVector(j)), 0);
  const auto rigid = std::make_shared<const DeflatedMotions>(*nodes.matrix(), motions,
                                                             std::move(bodies), space.n_bodies);
  const auto multigrid = muelu_multigrid(nodes.matrix(), space.n_axes(), motions, list, name);
  const auto of_nodes = action_operator(nodes.map(), [=](const Vector& x, Vector& y) {
    apply(*multigrid, x, y);
    rigid->add(x, y);
  });
  std::vector<PartInverse> parts{{node_part, of_nodes}};
  if (!others->empty())
    parts.push_back(part_of_blocks(others, name));
  return inverse_by_parts(c->getRowMap(), parts);
}

}  // namespace lockstep
