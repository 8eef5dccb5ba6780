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

/// C on every rank, and its solids.
struct SmallSolids {
  Eigen::MatrixXd c;
  std::vector<std::vector<int>> dofs;  ///< of each solid, ascending
};

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
  const auto n_dofs = static_cast<int>(c.rows());
  const Columns columns = columns_of(coupling, n_dofs);
  const PressureLayout::FaceScale scale = layout_.face_scale();

  // Which motions are light: the added mass of a body of radius R is about that of its first layer
  // of cells, sum b^2 / a, times 2 R / h.
  std::vector<std::vector<int>> chosen;  // by solid: its light dofs
  int n_layers = shortest_reach;
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
    n_layers = std::max(n_layers, static_cast<int>(std::lround(reach * radius)));
    chosen.push_back(std::move(light));
  }
  if (chosen.empty())
    return false;
  n_layers = std::min(n_layers, longest_reach);

  // The supports: unknowns near the cells that each solid touches.
  std::vector<int> solid_of_dof(n_dofs, -1);
  for (std::size_t solid = 0; solid < chosen.size(); ++solid) {
    for (const int dof : chosen[solid])
      solid_of_dof[dof] = static_cast<int>(solid);
  }
  Vector column_labels(coupling.getColMap()), seeds(layout_.map());
  {
    const auto values = column_labels.getDataNonConst();
    for_each_entry(coupling, [&](int row, GlobalIndex column, double value) {
      const int solid = solid_of_dof[coupling.getRowMap()->getGlobalElement(row)];
      double& label = values[coupling.getColMap()->getLocalElement(column)];
      if (solid >= 0 && value != 0)
        label = std::max<double>(label, solid + 1);
    });
  }
  if (const auto importer = coupling.getGraph()->getImporter(); importer.is_null())
    seeds.update(1, column_labels, 0);
  else
    seeds.doExport(column_labels, *importer, Tpetra::ABSMAX);
  {
    const auto values = seeds.getData();
    for (int entry = 0; entry < static_cast<int>(values.size()); ++entry) {
      if (values[entry] != 0)
        touched_.push_back(entry);
    }
  }
  const auto grown = layout_.grow(seeds, n_layers);
  std::vector<int> first(chosen.size() + 1, 0);
  for (std::size_t solid = 0; solid < chosen.size(); ++solid)
    first[solid + 1] = first[solid] + static_cast<int>(chosen[solid].size());
  const int n_functions = first.back();
  for (const auto& cell : grown)
    cells_.push_back({cell.entry, first[cell.label], first[cell.label + 1] - first[cell.label]});

  // The functions: one cycle for the j-th of all solids at once.
  Vector label_of_entry(layout_.map());
  {
    const auto values = label_of_entry.getDataNonConst();
    for (const auto& cell : grown)
      values[cell.entry] = cell.label + 1;
  }
  const Vector labels = on_columns(coupling, label_of_entry);
  Eigen::MatrixXd g = Eigen::MatrixXd::Zero(n_dofs, n_functions);  // B^T W
  Vector ones(coupling.getRangeMap()), column_sum(layout_.map()), w(layout_.map()),
      aw(layout_.map());
  for (int j = 0; j < most_dofs_of_a_solid; ++j) {
    bool any = false;
    ones.putScalar(0);
    for (const auto& dofs : chosen) {
      if (j >= static_cast<int>(dofs.size()))
        continue;
      any = true;
      if (ones.getMap()->isNodeGlobalElement(dofs[j]))
        ones.replaceGlobalValue(dofs[j], 1.0);
    }
    if (!any)
      break;
    coupling.apply(ones, column_sum, Teuchos::TRANS);
    apply(*layout_.inverse(), column_sum, w);
    {
      const auto values = w.getDataNonConst();
      std::vector<double> kept(grown.size());
      for (std::size_t i = 0; i < grown.size(); ++i) {
        const bool has_function = j < cells_[i].n && !grown[i].at_border;
        kept[i] = has_function ? values[grown[i].entry] * cut_off(grown[i].layer, n_layers) : 0;
      }
      std::fill(values.begin(), values.end(), 0.0);
      for (std::size_t i = 0; i < grown.size(); ++i) {
        cells_[i].w[j] = static_cast<float>(kept[i]);
        values[grown[i].entry] = cells_[i].w[j];
      }
    }
    apply(*layout_.pressure_block(), w, aw);
    {
      const auto values = aw.getData();
      for (Cell& cell : cells_)
        cell.aw[j] = values[cell.entry];
    }
    const Vector values = on_columns(coupling, w);
    const auto w_values = values.getData(), label_values = labels.getData();
    for_each_entry(coupling, [&](int row, GlobalIndex column, double value) {
      const int local = coupling.getColMap()->getLocalElement(column);
      const int solid = static_cast<int>(label_values[local]) - 1;
      if (solid >= 0 && j < static_cast<int>(chosen[solid].size()))
        g(coupling.getRowMap()->getGlobalElement(row), first[solid] + j) += value * w_values[local];
    });
  }
  sum_all(comm, g.data(), static_cast<int>(g.size()));

  Eigen::MatrixXd energy = Eigen::MatrixXd::Zero(n_functions, n_functions);  // W^T A W
  for (const Cell& cell : cells_) {
    for (int a = 0; a < cell.n; ++a) {
      for (int b = 0; b < cell.n; ++b)
        energy(cell.first + a, cell.first + b) += static_cast<double>(cell.w[a]) * cell.aw[b];
    }
  }
  sum_all(comm, energy.data(), static_cast<int>(energy.size()));
  motion_ = c.llt().solve(g);
  const Eigen::MatrixXd e = 0.5 * (energy + energy.transpose()) + g.transpose() * motion_;
  // A solid whose cells all lie at borders has no function; its row and column are zero.
  const Eigen::VectorXd scaling =
      e.diagonal().unaryExpr([](double d) { return d > 0 ? 1 / std::sqrt(d) : 0.0; });
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaling.asDiagonal() * e *
                                                             scaling.asDiagonal());
  const Eigen::VectorXd inverse =
      eigen.eigenvalues().unaryExpr([](double value) { return value > 1e-12 ? 1 / value : 0.0; });
  coarse_inverse_ = scaling.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() *
                    eigen.eigenvectors().transpose() * scaling.asDiagonal();
  return true;
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
