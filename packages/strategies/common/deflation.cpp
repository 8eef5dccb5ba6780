#include "strategies/common/deflation.hpp"

#include <Thyra_VectorSpaceBase.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "linear/matrix_rows.hpp"
#include "strategies/common/small_dense.hpp"

namespace lockstep {

namespace {

/// Solids of more degrees of freedom are no rigid bodies; more of them than this stay as they are.
constexpr int most_dofs_of_a_solid = 6;
constexpr int most_solid_dofs = 3000;
/// A motion whose added mass is at least this many times its own mass is projected out.
constexpr double light_ratio = 1.5;
/// How far the functions reach, in radii of the solid, and within which cells.
constexpr double reach = 1.5;
constexpr int shortest_reach = 4, longest_reach = 32;

/// The solids: the connected components of C, each as its dofs, ascending.
std::vector<std::vector<int>> components(const Eigen::MatrixXd& c) {
  const auto n = static_cast<int>(c.rows());
  std::vector<int> root(n);
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[i] != i)
      i = root[i] = root[root[i]];
    return i;
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < i; ++j) {
      if (c(i, j) != 0)
        root[std::max(find(i), find(j))] = std::min(find(i), find(j));
    }
  }
  std::map<int, std::vector<int>> by_root;
  for (int i = 0; i < n; ++i)
    by_root[find(i)].push_back(i);
  std::vector<std::vector<int>> result;
  for (auto& [first, dofs] : by_root)
    result.push_back(std::move(dofs));
  return result;
}

/// For each solid dof: how many cells it touches, and the sum of the squares of its column of B.
struct Columns {
  std::vector<double> n_cells, squares;
};

Columns columns_of(const CrsMatrix& coupling, int n_dofs) {
  Columns columns{std::vector<double>(n_dofs, 0), std::vector<double>(n_dofs, 0)};
  for_each_entry(coupling, [&](int row, GlobalIndex, double value) {
    const auto dof = coupling.getRowMap()->getGlobalElement(row);
    columns.n_cells[dof] += 1;
    columns.squares[dof] += value * value;
  });
  const Communicator comm = coupling.getRowMap()->getComm();
  sum_all(comm, columns.n_cells.data(), n_dofs);
  sum_all(comm, columns.squares.data(), n_dofs);
  return columns;
}

/// The solids that have light motions.
struct LightSolids {
  std::vector<std::vector<int>> dofs;  ///< by solid: its light ones
  std::vector<int> first{0};      ///< by solid: number of its first function; one more at the end
  int n_layers = shortest_reach;  ///< of cells that the functions reach

  int n_functions() const { return first.back(); }
};

/// The added mass of a body of radius R is about that of its first layer of cells, sum b^2 / a,
/// times 2 R / h.
LightSolids find_light_solids(const Eigen::MatrixXd& c, const CrsMatrix& coupling,
                              const PressureLayout::FaceScale& scale) {
  const Columns columns = columns_of(coupling, static_cast<int>(c.rows()));
  LightSolids result;
  for (const auto& dofs : components(c)) {
    if (static_cast<int>(dofs.size()) > most_dofs_of_a_solid)
      continue;
    double n_cells = 0;
    for (const int dof : dofs)
      n_cells = std::max(n_cells, columns.n_cells[dof]);
    const double radius = scale.dimension == 3 ? std::sqrt(n_cells / 12.6) : n_cells / 8;
    std::vector<int> light;
    for (const int dof : dofs) {
      const double added = 2 * radius * columns.squares[dof] / (2 * scale.dimension * scale.unit);
      if (added > light_ratio * c(dof, dof))
        light.push_back(dof);
    }
    if (light.empty())
      continue;
    result.n_layers = std::max(result.n_layers, static_cast<int>(std::lround(reach * radius)));
    result.first.push_back(result.first.back() + static_cast<int>(light.size()));
    result.dofs.push_back(std::move(light));
  }
  result.n_layers = std::min(result.n_layers, longest_reach);
  return result;
}

/// Values of `vector` on the columns of B^T.
Vector on_columns(const CrsMatrix& coupling, const Vector& vector) {
  Vector result(coupling.getColMap());
  const auto importer = coupling.getGraph()->getImporter();
  if (importer.is_null())
    result.update(1, vector, 0);
  else
    result.doImport(vector, *importer, Tpetra::INSERT);
  return result;
}

/// The unknowns that each light solid touches, by its number + 1; 0 elsewhere.
Vector seeds_of(const LightSolids& light, const CrsMatrix& coupling, const RCP<const Map>& map) {
  std::vector<int> label_of_dof(coupling.getGlobalNumRows(), 0);
  for (std::size_t solid = 0; solid < light.dofs.size(); ++solid) {
    for (const int dof : light.dofs[solid])
      label_of_dof[dof] = static_cast<int>(solid) + 1;
  }
  Vector column_labels(coupling.getColMap()), seeds(map);
  {
    const auto values = column_labels.getDataNonConst();
    for_each_entry(coupling, [&](int row, GlobalIndex column, double value) {
      double& label = values[coupling.getColMap()->getLocalElement(column)];
      if (value != 0)
        label = std::max<double>(label, label_of_dof[coupling.getRowMap()->getGlobalElement(row)]);
    });
  }
  if (const auto importer = coupling.getGraph()->getImporter(); importer.is_null())
    seeds.update(1, column_labels, 0);
  else
    seeds.doExport(column_labels, *importer, Tpetra::ABSMAX);
  return seeds;
}

/// B times the sum of the j-th light motions of all solids; false if no solid has so many.
bool sum_of_columns(const LightSolids& light, int j, const CrsMatrix& coupling, Vector& sum) {
  Vector ones(coupling.getRangeMap());
  bool any = false;
  for (const auto& dofs : light.dofs) {
    if (j >= static_cast<int>(dofs.size()))
      continue;
    any = true;
    if (ones.getMap()->isNodeGlobalElement(dofs[j]))
      ones.replaceGlobalValue(dofs[j], 1.0);
  }
  coupling.apply(ones, sum, Teuchos::TRANS);
  return any;
}

/// g += B^T w_j of this rank, split into the functions of the solids by the labels of the columns.
void add_forces(const LightSolids& light, int j, const CrsMatrix& coupling, const Vector& labels,
                const Vector& w, Eigen::MatrixXd& g) {
  const Vector on_column = on_columns(coupling, w);
  const auto values = on_column.getData(), label_values = labels.getData();
  for_each_entry(coupling, [&](int row, GlobalIndex column, double value) {
    const int local = coupling.getColMap()->getLocalElement(column);
    const int solid = static_cast<int>(label_values[local]) - 1;
    if (solid >= 0 && j < static_cast<int>(light.dofs[solid].size()))
      g(coupling.getRowMap()->getGlobalElement(row), light.first[solid] + j) +=
          value * values[local];
  });
}

/// The pseudo-inverse of a symmetric positive semidefinite matrix, scaled to a unit diagonal first:
/// a solid whose cells all lie at borders has no function, and its row and column are zero.
Eigen::MatrixXd pseudo_inverse(const Eigen::MatrixXd& e) {
  const Eigen::VectorXd scaling =
      e.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaling.asDiagonal() * e *
                                                             scaling.asDiagonal());
  const Eigen::VectorXd inverse =
      eigen.eigenvalues().unaryExpr([](double value) { return value > 1e-12 ? 1 / value : 0.0; });
  return scaling.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() *
         eigen.eigenvectors().transpose() * scaling.asDiagonal();
}

/// 1 within half the reach, falling to 0 at its end.
double cut_off(int layer, int n_layers) {
  return std::min(1.0, 2.0 * (1 - static_cast<double>(layer) / n_layers));
}

}  // namespace

std::unique_ptr<Deflation> Deflation::make(const BlockSystem& system, PressureLayout& layout) {
  if (!system.has_solid() || system.solid_block->domain()->dim() > most_solid_dofs ||
      assembled(system.solid_block).is_null())
    return nullptr;
  // Where a solid closes a region, only its motion lets the region's pressure level matter: without
  // that motion the rest would be singular.
  if (system.pressure_null_space.size() > system.null_space.size())
    return nullptr;
  std::unique_ptr<Deflation> deflation(new Deflation(system, layout));
  if (!deflation->build())
    return nullptr;
  return deflation;
}

bool Deflation::build() {
  const CrsMatrix& coupling = *system_.coupling_transposed;
  const Communicator comm = coupling.getRowMap()->getComm();
  const Eigen::MatrixXd c = replicated(*assembled(system_.solid_block));
  const LightSolids light = find_light_solids(c, coupling, layout_.face_scale());
  if (light.dofs.empty())
    return false;

  const Vector seeds = seeds_of(light, coupling, layout_.map());
  const auto seed_values = seeds.getData();
  for (int entry = 0; entry < static_cast<int>(seed_values.size()); ++entry) {
    if (seed_values[entry] != 0)
      touched_.push_back(entry);
  }
  const auto grown = layout_.grow(seeds, light.n_layers);
  Vector label_of_entry(layout_.map());
  {
    const auto values = label_of_entry.getDataNonConst();
    for (const auto& cell : grown) {
      values[cell.entry] = cell.label + 1;
      cells_.push_back(
          {cell.entry, light.first[cell.label], static_cast<int>(light.dofs[cell.label].size())});
    }
  }
  const Vector labels = on_columns(coupling, label_of_entry);

  // One cycle makes the j-th function of all solids.
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(c.rows(), light.n_functions());  // B^T W
  Vector column_sum(layout_.map()), w(layout_.map()), aw(layout_.map());
  for (int j = 0; j < most_dofs_of_a_solid; ++j) {
    if (!sum_of_columns(light, j, coupling, column_sum))
      break;
    apply(*layout_.inverse(), column_sum, w);
    keep_functions(j, grown, light.n_layers, w);
    apply(*layout_.pressure_block(), w, aw);
    const auto values = aw.getData();
    for (Cell& cell : cells_)
      cell.aw[j] = values[cell.entry];
    add_forces(light, j, coupling, labels, w, g);
  }
  sum_all(comm, g.data(), static_cast<int>(g.size()));
  motion_ = c.llt().solve(g);
  coarse_inverse_ = pseudo_inverse(energy(light.n_functions()) + g.transpose() * motion_);
  return true;
}

/// Cuts off the j-th functions in w, and stores them.
void Deflation::keep_functions(int j, const std::vector<PressureLayout::Grown>& grown, int n_layers,
                               Vector& w) {
  const auto values = w.getDataNonConst();
  for (std::size_t i = 0; i < grown.size(); ++i) {
    const bool has_function = j < cells_[i].n && !grown[i].at_border;
    cells_[i].w[j] = static_cast<float>(
        has_function ? values[grown[i].entry] * cut_off(grown[i].layer, n_layers) : 0.0);
  }
  std::fill(values.begin(), values.end(), 0.0);
  for (const Cell& cell : cells_)
    values[cell.entry] = cell.w[j];
}

/// W^T A W, on every rank; symmetric.
Eigen::MatrixXd Deflation::energy(int n_functions) const {
  Eigen::MatrixXd result = Eigen::MatrixXd::Zero(n_functions, n_functions);
  for (const Cell& cell : cells_) {
    for (int a = 0; a < cell.n; ++a) {
      for (int b = 0; b < cell.n; ++b)
        result(cell.first + a, cell.first + b) += static_cast<double>(cell.w[a]) * cell.aw[b];
    }
  }
  sum_all(layout_.map()->getComm(), result.data(), static_cast<int>(result.size()));
  return 0.5 * (result + result.transpose());
}

/// W^T x, or (A W)^T x, of x given by its entries; on every rank.
template <typename Get>
Eigen::VectorXd Deflation::restrict(const Get& get, bool with_operator) const {
  Eigen::VectorXd sums = Eigen::VectorXd::Zero(size());
  for (const Cell& cell : cells_) {
    const double value = get(cell.entry);
    for (int a = 0; a < cell.n; ++a)
      sums[cell.first + a] += (with_operator ? cell.aw[a] : cell.w[a]) * value;
  }
  sum_all(layout_.map()->getComm(), sums.data(), size());
  return sums;
}

/// W^T S z.
Eigen::VectorXd Deflation::restricted_operator(const Vector& z) const {
  const auto values = z.getData();
  Vector force(system_.coupling_transposed->getRangeMap());
  system_.coupling_transposed->apply(z, force);
  return restrict([&](int entry) { return values[entry]; }, true) +
         motion_.transpose() * replicated(force);
}

/// x += W coarse.
void Deflation::add(const Eigen::VectorXd& coarse, Vector& x) const {
  const auto values = x.getDataNonConst();
  for (const Cell& cell : cells_) {
    for (int a = 0; a < cell.n; ++a)
      values[cell.entry] += cell.w[a] * coarse[cell.first + a];
  }
}

/// r += factor S W coarse.
void Deflation::add_operator(const Eigen::VectorXd& coarse, double factor, Vector& r) const {
  {
    const auto values = r.getDataNonConst();
    for (const Cell& cell : cells_) {
      for (int a = 0; a < cell.n; ++a)
        values[cell.entry] += factor * cell.aw[a] * coarse[cell.first + a];
    }
  }
  const Eigen::VectorXd velocity = motion_ * coarse;
  Vector solid(system_.coupling_transposed->getRangeMap());
  distribute(velocity, solid);
  system_.coupling_transposed->apply(solid, r, Teuchos::TRANS, factor, 1);
}

void Deflation::start(Vector& r, Vector& x) const {
  Eigen::VectorXd coarse;
  {
    const auto values = r.getData();
    coarse = coarse_inverse_* restrict([&](int entry) { return values[entry]; }, false);
  }
  x.putScalar(0);
  add(coarse, x);
  add_operator(coarse, -1, r);
}

double Deflation::correct(const Vector& r) {
  const auto r_values = r.getData();
  const auto z = layout_.preconditioned_residual();
  Vector touched(layout_.map());
  {
    const auto values = touched.getDataNonConst();
    for (const int entry : touched_)
      values[entry] = z.get(entry);
  }
  Vector force(system_.coupling_transposed->getRangeMap());
  system_.coupling_transposed->apply(touched, force);
  const Eigen::VectorXd of_r = restrict([&](int entry) { return r_values[entry]; }, false);
  const Eigen::VectorXd of_z = restrict([&](int entry) { return z.get(entry); }, true) +
                               motion_.transpose() * replicated(force);
  const Eigen::VectorXd coarse = coarse_inverse_ * (of_r - of_z);
  for (const Cell& cell : cells_) {
    double value = 0;
    for (int a = 0; a < cell.n; ++a)
      value += cell.w[a] * coarse[cell.first + a];
    z.add(cell.entry, value);
  }
  return of_r.dot(coarse);
}

void Deflation::apply_balanced(const LinearOperator& pressure_inverse, const Vector& r,
                               Vector& z) const {
  Vector projected(r, Teuchos::Copy), start_part(r.getMap());
  start(projected, start_part);
  apply(pressure_inverse, projected, z);
  add(-coarse_inverse_ * restricted_operator(z), z);
  z.update(1, start_part, 1);
}

}  // namespace lockstep
