#include "coupling/null_space.hpp"

#include <Eigen/Dense>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "base/disjoint_sets.hpp"
#include "base/errors.hpp"
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

/// Largest number of regions that solids may tie to one another in one triangle, since the work
/// grows with its cube. A larger triangle keeps only its columns, for the message.
constexpr std::size_t most_tied_regions = 5000;

bool is_too_large(const std::vector<int>& columns) {
  return columns.size() > most_tied_regions;
}

Triangle empty_triangle(std::vector<int> columns) {
  Eigen::MatrixXd no_rows(0, is_too_large(columns) ? 0 : columns.size());
  return {std::move(columns), std::move(no_rows)};
}

Triangle joined(const Triangle& a, const Triangle& b) {
  std::vector<int> columns;
  std::set_union(a.columns.begin(), a.columns.end(), b.columns.begin(), b.columns.end(),
                 std::back_inserter(columns));
  if (is_too_large(columns))
    return empty_triangle(std::move(columns));
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

/// Triangles that share no column, one for each group of regions that solids tie together.
using Triangles = std::vector<Triangle>;

/// Returns the reason why there are too many triangles to treat; empty: there are not.
std::string too_many(const Triangles& triangles) {
  std::size_t most = 0;
  for (const Triangle& triangle : triangles)
    most = std::max(most, triangle.columns.size());
  if (most <= most_tied_regions)
    return "";
  return fmt::format(
      "Solids tie {} closed regions of fluid to one another, more than the {} whose pressures can "
      "be compared; are solids so close that the cells between them are cut off one by one? Take "
      "finer cells, or fewer solids.",
      most, most_tied_regions);
}

/// Number and weight of the region at each column of B^T on this rank; -1: the region is not
/// singular.
struct ColumnRegions {
  std::vector<int> column_of;  ///< by column of B^T
  std::vector<double> weight;  ///< by column of the result
};

/// Calls f(local row, regions, values) for the rows of B^T chi of this rank that see a singular
/// region: a region as often as a row has entries in it.
template <typename Function>
void for_each_row(const CrsMatrix& coupling_transposed, const ColumnRegions& regions,
                  const Function& f) {
  std::vector<int> columns;
  std::vector<double> entries;
  for (int row = 0; row < static_cast<int>(coupling_transposed.getNodeNumRows()); ++row) {
    typename CrsMatrix::local_inds_host_view_type indices;
    typename CrsMatrix::values_host_view_type values;
    coupling_transposed.getLocalRowView(row, indices, values);
    columns.clear();
    entries.clear();
    for (std::size_t k = 0; k < indices.extent(0); ++k) {
      const int column = regions.column_of[indices(k)];
      if (column < 0)
        continue;
      columns.push_back(column);
      entries.push_back(values(k) * regions.weight[column]);
    }
    if (!columns.empty())
      f(row, columns, entries);
  }
}

/// R of some columns, to which rows are given one by one.
class GrowingTriangle {
 public:
  GrowingTriangle(std::vector<int> columns, Eigen::Index n_rows)
      : columns_(std::move(columns)),
        most_(std::min<Eigen::Index>(n_rows, std::max<Eigen::Index>(256, 2 * n_columns()))),
        result_(empty_triangle(columns_)) {}

  void add(const std::vector<int>& columns, const std::vector<double>& values) {
    if (is_too_large(columns_))
      return;
    if (rows_.size() == 0)
      rows_ = Eigen::MatrixXd::Zero(most_, n_columns());
    for (std::size_t k = 0; k < columns.size(); ++k)
      rows_(n_rows_, std::lower_bound(columns_.begin(), columns_.end(), columns[k]) -
                         columns_.begin()) += values[k];
    if (++n_rows_ == most_)
      take();
  }
  Triangle finished() {
    if (n_rows_ > 0)
      take();
    return std::move(result_);
  }

 private:
  Eigen::Index n_columns() const { return static_cast<Eigen::Index>(columns_.size()); }
  void take() {
    result_ = joined(result_, triangle_of(columns_, rows_.topRows(n_rows_)));
    rows_.setZero();
    n_rows_ = 0;
  }

  std::vector<int> columns_;
  Eigen::Index most_, n_rows_ = 0;
  Triangle result_;
  Eigen::MatrixXd rows_;
};

/// R of this rank's rows of B^T chi, by groups of regions that have no row in common.
Triangles local_triangles(const CrsMatrix& coupling_transposed, const ColumnRegions& regions) {
  const int n = static_cast<int>(regions.weight.size());
  DisjointSets tied(n);
  std::vector<Eigen::Index> n_rows(n, 0);
  std::vector<char> is_seen(n, 0);
  for (const int column : regions.column_of) {
    if (column >= 0)
      is_seen[column] = 1;
  }
  for_each_row(coupling_transposed, regions, [&](int, const auto& columns, const auto&) {
    for (const int column : columns)
      tied.join(columns.front(), column);
    ++n_rows[columns.front()];
  });
  std::vector<int> group_of(n, -1);
  std::vector<std::vector<int>> groups;
  std::vector<Eigen::Index> rows_of_group;
  for (int column = 0; column < n; ++column) {
    if (!is_seen[column])
      continue;
    int& group = group_of[tied.root(column)];
    if (group < 0) {
      group = static_cast<int>(groups.size());
      groups.emplace_back();
      rows_of_group.push_back(0);
    }
    groups[group].push_back(column);
    rows_of_group[group] += n_rows[column];
  }
  std::vector<GrowingTriangle> growing;
  for (std::size_t group = 0; group < groups.size(); ++group)
    growing.emplace_back(groups[group], rows_of_group[group]);
  for_each_row(coupling_transposed, regions, [&](int, const auto& columns, const auto& values) {
    growing[group_of[tied.root(columns.front())]].add(columns, values);
  });
  Triangles result;
  for (GrowingTriangle& triangle : growing)
    result.push_back(triangle.finished());
  return result;
}

/// Joins all triangles that share columns.
Triangles joined(Triangles all, int n_columns) {
  DisjointSets tied(n_columns);
  for (const Triangle& triangle : all) {
    for (const int column : triangle.columns)
      tied.join(triangle.columns.front(), column);
  }
  std::vector<int> place(n_columns, -1);
  Triangles result;
  for (Triangle& triangle : all) {
    int& mine = place[tied.root(triangle.columns.front())];
    if (mine < 0) {
      mine = static_cast<int>(result.size());
      result.push_back(std::move(triangle));
    } else {
      result[mine] = joined(result[mine], triangle);
    }
  }
  return result;
}

void send(const Triangles& triangles, int rank, MPI_Comm mpi) {
  const int n = static_cast<int>(triangles.size());
  MPI_Send(&n, 1, MPI_INT, rank, 0, mpi);
  for (const Triangle& triangle : triangles) {
    const int shape[3] = {static_cast<int>(triangle.columns.size()),
                          static_cast<int>(triangle.r.rows()), static_cast<int>(triangle.r.cols())};
    MPI_Send(shape, 3, MPI_INT, rank, 0, mpi);
    MPI_Send(triangle.columns.data(), shape[0], MPI_INT, rank, 0, mpi);
    MPI_Send(triangle.r.data(), shape[1] * shape[2], MPI_DOUBLE, rank, 0, mpi);
  }
}

void receive(int rank, MPI_Comm mpi, Triangles& triangles) {
  int n = 0;
  MPI_Recv(&n, 1, MPI_INT, rank, 0, mpi, MPI_STATUS_IGNORE);
  for (int k = 0; k < n; ++k) {
    int shape[3];
    MPI_Recv(shape, 3, MPI_INT, rank, 0, mpi, MPI_STATUS_IGNORE);
    Triangle other{std::vector<int>(shape[0]), Eigen::MatrixXd(shape[1], shape[2])};
    MPI_Recv(other.columns.data(), shape[0], MPI_INT, rank, 0, mpi, MPI_STATUS_IGNORE);
    MPI_Recv(other.r.data(), shape[1] * shape[2], MPI_DOUBLE, rank, 0, mpi, MPI_STATUS_IGNORE);
    triangles.push_back(std::move(other));
  }
}

/// The triangles of all ranks' rows, on rank 0: ranks hand theirs to one below them, log2(ranks)
/// times.
Triangles brought_together(Triangles mine, int n_columns, const Communicator& comm) {
  const MPI_Comm mpi = raw_communicator(comm);
  const int rank = comm->getRank(), n_ranks = comm->getSize();
  for (int step = 1; step < n_ranks; step *= 2) {
    if (rank % (2 * step) == step) {
      send(mine, rank - step, mpi);
      break;
    }
    if (rank + step >= n_ranks)
      continue;
    receive(rank + step, mpi, mine);
    mine = joined(std::move(mine), n_columns);
  }
  return mine;
}

/// Orthonormal columns that the square matrix takes to zero, to within `threshold`.
Eigen::MatrixXd kernel_of(const Eigen::MatrixXd& square, double threshold) {
  constexpr Eigen::Index most_for_svd = 64;  // beyond, it takes fifty times as long as a QR
  const Eigen::Index n = square.cols();
  if (n <= most_for_svd) {
    const Eigen::JacobiSVD<Eigen::MatrixXd> svd(square, Eigen::ComputeFullV);
    const Eigen::Index rank = (svd.singularValues().array() > threshold).count();
    return svd.matrixV().rightCols(n - rank);
  }
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(square);
  const auto& r = qr.matrixQR();
  const Eigen::Index rank = (r.diagonal().array().abs() > threshold).count();
  Eigen::MatrixXd basis(n, n - rank);
  basis.topRows(rank) = -r.topLeftCorner(rank, rank)
                             .triangularView<Eigen::Upper>()
                             .solve(r.topRightCorner(rank, n - rank));
  basis.bottomRows(n - rank).setIdentity();
  const Eigen::MatrixXd in_place = qr.colsPermutation() * basis;
  const Eigen::HouseholderQR<Eigen::MatrixXd> orthogonal(in_place);
  return orthogonal.householderQ() * Eigen::MatrixXd::Identity(n, n - rank);
}

/// Combinations of columns that the matrix of these triangles takes to zero, to within `threshold`,
/// and the columns in none of them alone. On rank 0.
std::vector<std::vector<NullSpace::Part>> kernel_of(const Triangles& triangles, int n_columns,
                                                    double threshold) {
  std::vector<std::vector<NullSpace::Part>> kernel;
  std::vector<char> is_tied(n_columns, 0);
  for (const Triangle& triangle : triangles) {
    for (const int column : triangle.columns)
      is_tied[column] = 1;
  }
  for (int column = 0; column < n_columns; ++column) {
    if (!is_tied[column])
      kernel.push_back({{column, 1}});
  }
  for (const Triangle& triangle : triangles) {
    const auto n = static_cast<Eigen::Index>(triangle.columns.size());
    Eigen::MatrixXd square = Eigen::MatrixXd::Zero(n, n);
    square.topRows(triangle.r.rows()) = triangle.r;
    const Eigen::MatrixXd basis = kernel_of(square, threshold);
    for (Eigen::Index k = 0; k < basis.cols(); ++k) {
      std::vector<NullSpace::Part> vector;
      for (Eigen::Index c = 0; c < n; ++c)
        vector.push_back({triangle.columns[c], basis(c, k)});
      kernel.push_back(std::move(vector));
    }
  }
  return kernel;
}

/// Sends the vectors from rank 0 to all.
void broadcast(std::vector<std::vector<NullSpace::Part>>& vectors, const Communicator& comm) {
  const MPI_Comm mpi = raw_communicator(comm);
  std::vector<double> flat;  // each vector as its length, then regions and values
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
  const int n_columns = static_cast<int>(pressure.size());
  const Triangles all =
      brought_together(local_triangles(*coupling_transposed, columns), n_columns, comm);
  throw_on_all(comm, is_root(comm) ? too_many(all) : "", static_cast<int>(ExitCode::solve_failed));
  const double threshold = round_off_of_sums(*coupling_transposed);
  std::vector<std::vector<NullSpace::Part>> coupled;
  if (is_root(comm))
    coupled = kernel_of(all, n_columns, threshold);
  broadcast(coupled, comm);
  for (auto& parts : coupled) {
    for (NullSpace::Part& part : parts)
      part.value *= columns.weight[part.region];
  }
  return {pressure.with(std::move(coupled)), pressure};
}

std::vector<RCP<const Vector>> pushes_of(const NullSpace& pressure,
                                         const CrsMatrix& coupling_transposed) {
  std::vector<RCP<Vector>> pushes;
  for (std::size_t k = 0; k < pressure.size(); ++k)
    pushes.push_back(make_vector(coupling_transposed.getRowMap()));
  if (pushes.empty())
    return {};
  const ColumnRegions regions = regions_of_columns(coupling_transposed, pressure);
  for_each_row(coupling_transposed, regions,
               [&](int row, const std::vector<int>& columns, const std::vector<double>& values) {
                 for (std::size_t k = 0; k < columns.size(); ++k)
                   pushes[columns[k]]->sumIntoLocalValue(row, values[k]);
               });
  return {pushes.begin(), pushes.end()};
}

}  // namespace lockstep
