#include "coupling/null_space.hpp"

#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

namespace lockstep {
namespace {

/// Sum of |B^T| chi over all entries: the magnitude that cancellation is judged against.
Eigen::MatrixXd local_product(const CrsMatrix& coupling_transposed, const MultiVector& indicators,
                              double& magnitude) {
  const int n_columns = static_cast<int>(indicators.getNumVectors());
  MultiVector product(coupling_transposed.getRangeMap(), n_columns);
  coupling_transposed.apply(indicators, product);
  Eigen::MatrixXd local(coupling_transposed.getNodeNumRows(), n_columns);
  for (int k = 0; k < n_columns; ++k) {
    const auto values = product.getVector(k)->getData();
    for (int i = 0; i < values.size(); ++i)
      local(i, k) = values[i];
  }
  double sum = 0;
  Teuchos::ArrayView<const int> columns;
  Teuchos::ArrayView<const double> values;
  for (int row = 0; row < local.rows(); ++row) {
    coupling_transposed.getLocalRowView(row, columns, values);
    for (double value : values)
      sum += value * value;
  }
  const Communicator comm = coupling_transposed.getRowMap()->getComm();
  magnitude = std::sqrt(sum_all(comm, sum));
  return local;
}

/// Right singular vectors of the distributed matrix whose singular value is below `threshold`: a
/// small QR on each rank, then an SVD of the stacked triangles.
Eigen::MatrixXd null_vectors(const Eigen::MatrixXd& local, double threshold,
                             const Communicator& comm) {
  const int n = static_cast<int>(local.cols());
  Eigen::MatrixXd triangle = Eigen::MatrixXd::Zero(n, n);
  if (local.rows() > 0) {
    const Eigen::HouseholderQR<Eigen::MatrixXd> qr(local);
    const int k = static_cast<int>(std::min<Eigen::Index>(local.rows(), n));
    triangle.topRows(k) = qr.matrixQR().topRows(k).triangularView<Eigen::Upper>();
  }
  const std::vector<double> mine(triangle.data(), triangle.data() + triangle.size());
  const std::vector<double> all = gather_all(comm, mine);
  Eigen::MatrixXd stacked(n * comm->getSize(), n);
  for (int rank = 0; rank < comm->getSize(); ++rank) {
    stacked.middleRows(rank * n, n) =
        Eigen::Map<const Eigen::MatrixXd>(all.data() + std::size_t(rank) * n * n, n, n);
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(stacked, Eigen::ComputeThinV);
  int n_null = 0;
  for (int k = 0; k < n; ++k)
    n_null += svd.singularValues()[k] <= threshold ? 1 : 0;
  return svd.matrixV().rightCols(n_null);
}

}  // namespace

NullSpace find_null_space(const PressureRegions& regions, const RCP<const Map>& pressure_map,
                          const RCP<const CrsMatrix>& coupling_transposed) {
  NullSpace null_space;
  std::vector<int> singular(regions.n_regions, -1);  // region -> column
  int n_singular = 0;
  for (int r = 0; r < regions.n_regions; ++r) {
    if (!regions.has_dirichlet[r])
      singular[r] = n_singular++;
  }
  if (n_singular == 0)
    return null_space;

  const Communicator comm = pressure_map->getComm();
  std::vector<double> sizes(n_singular, 0);
  for (int region : regions.of_unknown) {
    if (singular[region] >= 0)
      sizes[singular[region]] += 1;
  }
  sum_all(comm, sizes.data(), n_singular);
  const auto indicators = rcp(new MultiVector(pressure_map, n_singular));
  for (std::size_t i = 0; i < regions.of_unknown.size(); ++i) {
    const int column = singular[regions.of_unknown[i]];
    if (column >= 0) {
      indicators->replaceLocalValue(static_cast<int>(i), column, 1 / std::sqrt(sizes[column]));
    }
  }
  for (int k = 0; k < n_singular; ++k)
    null_space.pressure.push_back(indicators->getVector(k));
  if (coupling_transposed.is_null()) {
    null_space.coupled = null_space.pressure;
    return null_space;
  }
  double magnitude = 0;
  const Eigen::MatrixXd product = local_product(*coupling_transposed, *indicators, magnitude);
  const Eigen::MatrixXd combinations = null_vectors(product, 1e-11 * magnitude, comm);
  for (int k = 0; k < combinations.cols(); ++k) {
    const auto vector = rcp(new Vector(pressure_map));
    for (int c = 0; c < n_singular; ++c) {
      vector->update(combinations(c, k), *null_space.pressure[c], 1);
    }
    null_space.coupled.push_back(vector);
  }
  return null_space;
}

}  // namespace lockstep
