#include "coupling/null_space.hpp"

#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "linear/matrix_rows.hpp"
#include "linear/overlap.hpp"

namespace lockstep {
namespace {

/// The triangle R of a QR factorisation, over those columns of the whole that its rows occupy.
struct Triangle {
  std::vector<int> columns;  ///< ascending
  Eigen::MatrixXd r;         ///< at most as many rows as columns
};

Triangle triangle_of(std::vector<int> columns, const Eigen::MatrixXd& rows) {
  if (rows.rows() == 0)
    return {std::move(columns), rows};
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(rows);
  const Eigen::Index n = std::min(rows.rows(), rows.cols());
  return {std::move(columns), qr.matrixQR().topRows(n).triangularView<Eigen::Upper>()};
}

Triangle joined(const Triangle& a, const Triangle& b) {
  std::vector<int> columns;
  std::set_union(a.columns.begin(), a.columns.end(), b.columns.begin(), b.columns.end(),
                 std::back_inserter(columns));
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(a.r.rows() + b.r.rows(), columns.size());
  Eigen::Index first = 0;
  for (const Triangle* part : {&a, &b}) {
    for (std::size_t k = 0; k < part->columns.size(); ++k) {
      const auto column = std::lower_bound(columns.begin(), columns.end(), part->columns[k]);
      rows.col(column - columns.begin()).segment(first, part->r.rows()) = part->r.col(k);
    }
    first += part->r.rows();
  }
  return triangle_of(std::move(columns), rows);
}

/// Numbers of a region and its weight at the columns of B^T on this rank; -1: not singular.
struct ColumnRegions {
  std::vector<int> column_of;  ///< by column of B^T
  std::vector<double> weight;  ///< by column of the result
};

/// R of this rank's rows of B^T chi, some rows at a time.
Triangle local_triangle(const CrsMatrix& coupling_transposed, const ColumnRegions& regions) {
  std::vector<int> columns;
  for (const int column : regions.column_of) {
    if (column >= 0)
      columns.push_back(column);
  }
  std::sort(columns.begin(), columns.end());
  columns.erase(std::unique(columns.begin(), columns.end()), columns.end());
  const auto n = static_cast<Eigen::Index>(columns.size());
  std::vector<Eigen::Index> place(regions.weight.size(), 0);
  for (Eigen::Index k = 0; k < n; ++k)
    place[columns[k]] = k;
  const Eigen::Index most = std::max<Eigen::Index>(256, 2 * n);
  const Triangle nothing{columns, Eigen::MatrixXd(0, n)};
  if (n == 0)
    return nothing;
  Triangle result = nothing;
  Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(most, n);
  Eigen::Index n_rows = 0;
  const auto take = [&] {
    result = joined(result, triangle_of(columns, rows.topRows(n_rows)));
    rows.setZero();
    n_rows = 0;
  };
  for (int row = 0; row < static_cast<int>(coupling_transposed.getNodeNumRows()); ++row) {
    typename CrsMatrix::local_inds_host_view_type indices;
    typename CrsMatrix::values_host_view_type values;
    coupling_transposed.getLocalRowView(row, indices, values);
    bool any = false;
    for (std::size_t k = 0; k < indices.extent(0); ++k) {
      const int column = regions.column_of[indices(k)];
      if (column < 0)
        continue;
      rows(n_rows, place[column]) += values(k) * regions.weight[column];
      any = true;
    }
    n_rows += any;
    if (n_rows == most)
      take();
  }
  take();
  return result;
}

/// The triangle of all ranks' rows, on rank 0: ranks hand theirs to one below them, log2(ranks)
/// times.
Triangle brought_together(Triangle mine, const Communicator& comm) {
  const MPI_Comm mpi = raw_communicator(comm);
  const int rank = comm->getRank(), n_ranks = comm->getSize();
  for (int step = 1; step < n_ranks; step *= 2) {
    if (rank % (2 * step) == step) {
      const int shape[2] = {static_cast<int>(mine.r.rows()), static_cast<int>(mine.r.cols())};
      MPI_Send(shape, 2, MPI_INT, rank - step, 0, mpi);
      MPI_Send(mine.columns.data(), shape[1], MPI_INT, rank - step, 0, mpi);
      MPI_Send(mine.r.data(), shape[0] * shape[1], MPI_DOUBLE, rank - step, 0, mpi);
      break;
    }
    if (rank + step >= n_ranks)
      continue;
    int shape[2];
    MPI_Recv(shape, 2, MPI_INT, rank + step, 0, mpi, MPI_STATUS_IGNORE);
    Triangle other{std::vector<int>(shape[1]), Eigen::MatrixXd(shape[0], shape[1])};
    MPI_Recv(other.columns.data(), shape[1], MPI_INT, rank + step, 0, mpi, MPI_STATUS_IGNORE);
    MPI_Recv(other.r.data(), shape[0] * shape[1], MPI_DOUBLE, rank + step, 0, mpi,
             MPI_STATUS_IGNORE);
    mine = joined(mine, other);
  }
  return mine;
}

/// Combinations of columns that the matrix of this triangle takes to zero, to within `threshold`:
/// the right singular vectors of those, and the other columns alone. On rank 0.
std::vector<std::vector<NullSpace::Part>> kernel_of(const Triangle& triangle, int n_columns,
                                                    double threshold) {
  std::vector<std::vector<NullSpace::Part>> kernel;
  for (int column = 0; column < n_columns; ++column) {
    if (!std::binary_search(triangle.columns.begin(), triangle.columns.end(), column))
      kernel.push_back({{column, 1}});
  }
  const auto n = static_cast<Eigen::Index>(triangle.columns.size());
  if (n == 0)
    return kernel;
  Eigen::MatrixXd square = Eigen::MatrixXd::Zero(n, n);
  square.topRows(triangle.r.rows()) = triangle.r;
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(square, Eigen::ComputeFullV);
  for (Eigen::Index k = 0; k < n; ++k) {
    if (svd.singularValues()[k] > threshold)
      continue;
    std::vector<NullSpace::Part> vector;
    for (Eigen::Index c = 0; c < n; ++c)
      vector.push_back({triangle.columns[c], svd.matrixV()(c, k)});
    kernel.push_back(std::move(vector));
  }
  return kernel;
}

/// From rank 0 to all.
void broadcast(std::vector<std::vector<NullSpace::Part>>& vectors, const Communicator& comm) {
  const MPI_Comm mpi = raw_communicator(comm);
  std::vector<double> flat;  // of each vector its length, then regions and values
  for (const auto& parts : vectors) {
    flat.push_back(static_cast<double>(parts.size()));
    for (const NullSpace::Part& part : parts)
      flat.insert(flat.end(), {static_cast<double>(part.region), part.value});
  }
  int size = static_cast<int>(flat.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, mpi);
  flat.resize(size);
  MPI_Bcast(flat.data(), size, MPI_DOUBLE, 0, mpi);
  vectors.clear();
  for (const double* value = flat.data(); value < flat.data() + size;) {
    vectors.emplace_back(static_cast<std::size_t>(*value++));
    for (NullSpace::Part& part : vectors.back()) {
      part = {static_cast<int>(value[0]), value[1]};
      value += 2;
    }
  }
}

/// The regions of columns of B^T, through the ranks that own them. Collective.
ColumnRegions regions_of_columns(const CrsMatrix& coupling_transposed, const NullSpace& pressure) {
  ColumnRegions result;
  const RCP<const Vector> numbers = on_columns(coupling_transposed, *pressure.regions().numbers());
  for (const double number : numbers->getData())
    result.column_of.push_back(static_cast<int>(number));
  for (const auto& parts : pressure.vectors())
    result.weight.push_back(parts.front().value);
  return result;
}

/// The indicators of the singular regions, which are counted anew.
NullSpace indicators(const PressureRegions& regions, const RCP<const Map>& pressure_map) {
  std::vector<int> singular(regions.n_regions, -1);
  int n_singular = 0;
  for (int r = 0; r < regions.n_regions; ++r) {
    if (!regions.has_dirichlet[r])
      singular[r] = n_singular++;
  }
  if (n_singular == 0)
    return {};
  std::vector<int> region_of_row(regions.of_unknown);
  for (int& region : region_of_row)
    region = singular[region];
  const auto rows = RowRegions::from(pressure_map, n_singular, region_of_row);
  std::vector<std::vector<NullSpace::Part>> vectors;
  int number = 0;
  for (const double size : rows->n_rows())
    vectors.push_back({{number++, 1 / std::sqrt(size)}});
  return {rows, std::move(vectors)};
}

}  // namespace

NullSpaces find_null_spaces(const PressureRegions& regions, const RCP<const Map>& pressure_map,
                            const RCP<const CrsMatrix>& coupling_transposed) {
  const NullSpace pressure = indicators(regions, pressure_map);
  if (pressure.empty() || coupling_transposed.is_null())
    return {pressure, pressure};
  const Communicator comm = pressure_map->getComm();
  const ColumnRegions columns = regions_of_columns(*coupling_transposed, pressure);
  const Triangle all = brought_together(local_triangle(*coupling_transposed, columns), comm);
  const double threshold = round_off_of_sums(*coupling_transposed);
  std::vector<std::vector<NullSpace::Part>> coupled;
  if (is_root(comm))
    coupled = kernel_of(all, static_cast<int>(pressure.size()), threshold);
  broadcast(coupled, comm);
  for (auto& parts : coupled) {
    for (NullSpace::Part& part : parts)
      part.value *= columns.weight[part.region];
  }
  return {pressure.with(std::move(coupled)), pressure};
}

}  // namespace lockstep
