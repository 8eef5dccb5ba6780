#include "solve/belos_solvers.hpp"

#include <BelosCustomSolverFactory.hpp>
#include <BelosSolverFactory.hpp>
#include <BelosSolverFactory_Generic.hpp>
#include <BelosSolverManager.hpp>
#include <BelosThyraAdapter.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "base/errors.hpp"
#include "base/library_message.hpp"
#include "solve/minres.hpp"
#include "solve/thyra_vectors.hpp"

// Stratimikos' library holds these for the same types: to make them once more takes most of a
// minute of a build.
namespace Belos {
using ThyraVectors = Thyra::MultiVectorBase<double>;
using ThyraOperator = Thyra::LinearOpBase<double>;
extern template class BiCGStabSolMgr<double, ThyraVectors, ThyraOperator>;
extern template class BlockCGSolMgr<double, ThyraVectors, ThyraOperator>;
extern template class BlockGmresSolMgr<double, ThyraVectors, ThyraOperator>;
extern template class FixedPointSolMgr<double, ThyraVectors, ThyraOperator>;
extern template class GCRODRSolMgr<double, ThyraVectors, ThyraOperator>;
extern template class MinresSolMgr<double, ThyraVectors, ThyraOperator>;
extern template class PseudoBlockCGSolMgr<double, ThyraVectors, ThyraOperator>;
extern template class PseudoBlockGmresSolMgr<double, ThyraVectors, ThyraOperator>;
extern template class RCGSolMgr<double, ThyraVectors, ThyraOperator>;
extern template class TFQMRSolMgr<double, ThyraVectors, ThyraOperator>;
}  // namespace Belos

namespace lockstep {

namespace {

using Vectors = Thyra::MultiVectorBase<double>;
using Problem = Belos::LinearProblem<double, Vectors, LinearOperator>;

class MinresManager : public BelosSolver {
 public:
  explicit MinresManager(const Teuchos::RCP<Teuchos::ParameterList>& list) {
    setParameters(list.is_null() ? Teuchos::parameterList() : list);
  }

  Teuchos::RCP<BelosSolver> clone() const override {
    return Teuchos::rcp(new MinresManager(Teuchos::parameterList(*list_)));
  }
  const Problem& getProblem() const override { return *problem_; }
  Teuchos::RCP<const Teuchos::ParameterList> getValidParameters() const override {
    const auto valid = Teuchos::parameterList("Lockstep MINRES");
    valid->set("Convergence Tolerance", 1e-8,
               "True residual of each block over the norm of the initial residual [1]");
    valid->set("Maximum Iterations", 1000, "Iterations of one solve");
    valid->set("Transition Condition", 1e7,
               "Estimate of the condition number above which updates go by MINRES-QLP");
    return valid;
  }
  Teuchos::RCP<const Teuchos::ParameterList> getCurrentParameters() const override { return list_; }
  int getNumIters() const override { return report_.n_iterations; }
  bool isLOADetected() const override { return report_.is_least_squares; }
  double achievedTol() const override { return achieved_; }
  void setProblem(const Teuchos::RCP<Problem>& problem) override { problem_ = problem; }
  void setParameters(const Teuchos::RCP<Teuchos::ParameterList>& list) override {
    try {
      list->validateParametersAndSetDefaults(*getValidParameters());
    } catch (const std::exception& error) {
      throw InputError(fmt::format("\"Lockstep MINRES\": {}", library_message(error)));
    }
    list_ = list;
  }
  void reset(Belos::ResetType) override { report_ = {}; }
  Belos::ReturnType solve() override;

 private:
  BlockAction action(const RCP<const LinearOperator>& op) const {
    return [op, this](const Blocks& x, Blocks& y) {
      copy(x, blocks_of(in_));
      Thyra::apply<double>(*op, Thyra::NOTRANS, *in_, out_.ptr());
      copy(blocks_of(out_), y);
    };
  }
  static void copy(const Blocks& from, const Blocks& to) {
    for (std::size_t block = 0; block < from.size(); ++block)
      to[block]->update(1, *from[block], 0);
  }

  Teuchos::RCP<Teuchos::ParameterList> list_;
  Teuchos::RCP<Problem> problem_;
  RCP<Vectors> in_, out_;
  MinresReport report_;
  double achieved_ = 0;
};

Belos::ReturnType MinresManager::solve() {
  check_solve(
      !problem_.is_null() && problem_->isProblemSet(),
      "\"Lockstep MINRES\" has no linear problem: call setProblem() on the problem and on the "
      "manager first.");
  in_ = problem_->getLHS()->clone_mv();
  out_ = problem_->getLHS()->clone_mv();
  const Blocks rhs = blocks_of(problem_->getRHS()->clone_mv());
  Blocks x = blocks_of(problem_->getLHS());
  // r_0 = b - A x_0 sets the scale.
  const auto residual = problem_->getRHS()->clone_mv();
  Thyra::apply<double>(*problem_->getOperator(), Thyra::NOTRANS, *problem_->getLHS(),
                       residual.ptr(), -1.0, 1.0);
  double scale = 0;
  for (const auto& block : blocks_of(residual))
    scale = std::hypot(scale, block->norm2());
  MinresRequest request;
  request.name = "Lockstep MINRES";
  request.targets.assign(rhs.size(), list_->get<double>("Convergence Tolerance") * scale);
  request.maximum_iterations = list_->get<int>("Maximum Iterations");
  request.transition_condition = list_->get<double>("Transition Condition");
  const auto left = problem_->getLeftPrec();
  const BlockAction nothing = [](const Blocks& r, Blocks& z) { copy(r, z); };
  report_ = minres(action(problem_->getOperator()), left.is_null() ? nothing : action(left), rhs, x,
                   request);
  achieved_ = 0;
  for (const double norm : report_.residuals)
    achieved_ = std::hypot(achieved_, norm);
  achieved_ = scale > 0 ? achieved_ / scale : 0;
  return report_.converged ? Belos::Converged : Belos::Unconverged;
}

class MinresFactory : public Belos::CustomSolverFactory<double, Vectors, LinearOperator> {
 public:
  Teuchos::RCP<BelosSolver> getSolver(const std::string& name,
                                      const Teuchos::RCP<Teuchos::ParameterList>& list) override {
    return name == supported() ? Teuchos::rcp(new MinresManager(list)) : Teuchos::null;
  }
  int numSupportedSolvers() const override { return 1; }
  std::vector<std::string> supportedSolverNames() const override { return {supported()}; }
  bool isSupported(const std::string& name) const override { return name == supported(); }

 private:
  static std::string supported() { return "Lockstep MINRES"; }
};

}  // namespace

RCP<BelosSolver> belos_solver(const std::string& name,
                              const Teuchos::RCP<Teuchos::ParameterList>& list) {
  Belos::GenericSolverFactory<double, Vectors, LinearOperator> factory;
  factory.addFactory(Teuchos::rcp(new MinresFactory));
  try {
    return factory.create(name, list.is_null() ? Teuchos::parameterList() : list);
  } catch (const std::invalid_argument& error) {
    throw InputError(
        fmt::format("There is no Belos solver \"{}\": {}", name, library_message(error)));
  }
}

}  // namespace lockstep
