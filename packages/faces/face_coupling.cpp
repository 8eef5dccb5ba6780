#include "faces/face_coupling.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>
#include <map>

#include "linear/overlap.hpp"
#include "linear/triplet_matrix.hpp"

namespace lockstep {

template <int dim>
void FaceCoupling<dim>::take_volumes(const FluidDiscretization<dim>& fluid,
                                     const SurfaceSnapshot<dim>& surface,
                                     const std::vector<RowPush>& further) {
  surface_ = &surface;
  volumes_ = fluid.coupled_volumes();
  patches_ = fluid.contact_patches();
  masses_.assign(volumes_.size(), 0);
  prescribed_velocity_.assign(volumes_.size() + further.size(), 0);
  coupling_transposed_ = Teuchos::null;
  added_mass_ = Teuchos::null;
  closed_area_.clear();
  hydrostatics_.reset(surface);
  pushes_.clear();
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    closed_area_.push_back(closed_area(volumes_[f]));
    for (int side = 0; side < 2; ++side) {
      const RowPush one =
          RowPush::into(volumes_[f].sides[side], static_cast<int>(f), push(f, side));
      if (one.has_receiver())
        pushes_.push_back(one);
    }
  }
  pushes_.insert(pushes_.end(), further.begin(), further.end());
  std::vector<GlobalIndex> unknowns;
  for (const RowPush& one : pushes_)
    if (one.unknown != no_index)
      unknowns.push_back(one.unknown);
  pressure_import_ = import_of(std::move(unknowns), fluid.pressure_map());
}

template <int dim>
void FaceCoupling<dim>::assemble_coupling(const SolidSystem<dim>& solids) {
  solid_import_ = import_of(weights_.dofs, solids.map());
  std::vector<Triplet> coupling;
  std::vector<GlobalIndex> dofs_at_patches;
  std::vector<double> rows_of_patches;  // a node and a value for each of these dofs
  for (const RowPush& one : pushes_) {
    for (int k = weights_.row_begin[one.row]; k < weights_.row_begin[one.row + 1]; ++k) {
      const GlobalIndex dof = weights_.dofs[weights_.columns[k]];
      const double value = one.area * weights_.values[k];
      if (one.unknown != no_index)
        coupling.push_back({dof, one.unknown, value});
      if (one.patch >= 0) {
        dofs_at_patches.push_back(dof);
        rows_of_patches.insert(rows_of_patches.end(), {static_cast<double>(one.patch), value});
      }
    }
  }
  if (patches_)
    add_drained_rows(gather_all(solids.comm(), dofs_at_patches),
                     gather_all(solids.comm(), rows_of_patches), coupling);
  coupling_transposed_ =
      assemble_triplets(std::move(coupling), solids.map(), pressure_import_->getSourceMap());
}

/// Adds what each dof pushes out of patches to its row of B^T: once, not on every rank.
template <int dim>
void FaceCoupling<dim>::add_drained_rows(const std::vector<GlobalIndex>& dofs,
                                         const std::vector<double>& nodes_and_values,
                                         std::vector<Triplet>& coupling) const {
  std::map<GlobalIndex, std::vector<double>> pushed;
  for (std::size_t k = 0; k < dofs.size(); ++k) {
    std::vector<double>& at_nodes = pushed[dofs[k]];
    at_nodes.resize(patches_->n_nodes(), 0);
    at_nodes[static_cast<std::size_t>(nodes_and_values[2 * k])] += nodes_and_values[2 * k + 1];
  }
  const Map& unknowns = *pressure_import_->getSourceMap();
  for (const auto& [dof, at_nodes] : pushed)
    for (const auto& [unknown, value] : patches_->drained(at_nodes))
      if (unknowns.isNodeGlobalElement(unknown))
        coupling.push_back({dof, unknown, value});
}

template <int dim>
void FaceCoupling<dim>::add_pushed(const std::vector<double>& row_velocity, Vector& rhs) const {
  Vector overlap(pressure_import_->getTargetMap());
  std::vector<double> at_nodes(patches_ ? patches_->n_nodes() : 0, 0);
  for (const RowPush& one : pushes_) {
    const double flux = one.area * row_velocity[one.row];
    if (one.unknown != no_index)
      overlap.sumIntoGlobalValue(one.unknown, flux);
    if (one.patch >= 0)
      at_nodes[one.patch] += flux;
  }
  add_overlap(overlap, *pressure_import_, rhs);
  if (patches_)
    patches_->add_drained(std::move(at_nodes), rhs);
}

template <int dim>
void FaceCoupling<dim>::add_prescribed_divergence(Vector& rhs) const {
  add_pushed(prescribed_velocity_, rhs);
}

template <int dim>
void FaceCoupling<dim>::add_effective_divergence(const SolidSystem<dim>& solids,
                                                 Vector& rhs) const {
  add_pushed(effective_rows(solids), rhs);
}

template <int dim>
std::vector<double> FaceCoupling<dim>::sizes_of_pushes(
    const Vector& scaled_pressure, const std::vector<double>& gas_pressure) const {
  Vector beside(pressure_import_->getTargetMap());
  beside.doImport(scaled_pressure, *pressure_import_, Tpetra::INSERT);
  const auto pressure = beside.getData();
  const std::vector<double> at_nodes =
      patches_ ? patches_->extended(scaled_pressure) : std::vector<double>();
  std::vector<double> sizes;
  for (const RowPush& one : pushes_) {
    double pushing = 0;
    if (one.unknown != no_index)
      pushing += pressure[beside.getMap()->getLocalElement(one.unknown)];
    if (one.patch >= 0)
      pushing += at_nodes[one.patch];
    if (one.bubble >= 0 && !gas_pressure.empty())
      pushing += gas_pressure[one.bubble];
    sizes.push_back(one.area * pushing);
  }
  return sizes;
}

template <int dim>
std::vector<double> FaceCoupling<dim>::pushes(const Vector& scaled_pressure,
                                              const std::vector<double>& gas_pressure) const {
  const std::vector<double> sizes = sizes_of_pushes(scaled_pressure, gas_pressure);
  std::vector<double> result(prescribed_velocity_.size(), 0);
  for (std::size_t i = 0; i < sizes.size(); ++i)
    result[pushes_[i].row] += sizes[i];
  return result;
}

template <int dim>
std::vector<std::array<double, 2>> FaceCoupling<dim>::pushes_of_sides(
    const Vector& scaled_pressure, const std::vector<double>& gas_pressure) const {
  const std::vector<double> sizes = sizes_of_pushes(scaled_pressure, gas_pressure);
  std::vector<std::array<double, 2>> result(volumes_.size(), {0, 0});
  for (std::size_t i = 0; i < sizes.size(); ++i)
    if (pushes_[i].row < static_cast<int>(volumes_.size()))
      result[pushes_[i].row][pushes_[i].area > 0 ? 1 : 0] += sizes[i];
  return result;
}

template <int dim>
void FaceCoupling<dim>::add_pushes_of_gas(const std::vector<double>& scaled_pressure,
                                          std::vector<double>& result) const {
  if (scaled_pressure.empty())
    return;
  for (const RowPush& one : pushes_)
    if (one.bubble >= 0)
      result[one.row] += one.area * scaled_pressure[one.bubble];
}

template <int dim>
void FaceCoupling<dim>::add_gas_push(const std::vector<double>& scaled_pressure,
                                     Vector& momentum) const {
  if (coupling_transposed_.is_null())
    return;
  std::vector<double> given(weights_.n_rows(), 0);
  add_pushes_of_gas(scaled_pressure, given);
  for (double& value : given)
    value = -value;
  add_transposed(weights_, *solid_import_, given, momentum);
}

template <int dim>
std::vector<double> FaceCoupling<dim>::gas_push_size(int n_bubbles) const {
  std::vector<double> size(n_bubbles, 0);
  for (const RowPush& one : pushes_) {
    if (one.bubble < 0 || coupling_transposed_.is_null())
      continue;
    double weight = 0;
    for (int k = weights_.row_begin[one.row]; k < weights_.row_begin[one.row + 1]; ++k)
      weight += std::abs(weights_.values[k]);
    size[one.bubble] += std::abs(one.area) * weight;
  }
  sum_all(pressure_import_->getSourceMap()->getComm(), size.data(), n_bubbles);
  return size;
}

template <int dim>
std::vector<double> FaceCoupling<dim>::gas_rates_of_rows(const std::vector<double>& row_velocity,
                                                         int n_bubbles) const {
  std::vector<double> rates(n_bubbles, 0);
  for (const RowPush& one : pushes_)
    if (one.bubble >= 0)
      rates[one.bubble] -= one.area * row_velocity[one.row];
  sum_all(pressure_import_->getSourceMap()->getComm(), rates.data(), n_bubbles);
  return rates;
}

template <int dim>
std::vector<double> FaceCoupling<dim>::gas_rates(const Vector& solid_velocity, bool with_prescribed,
                                                 int n_bubbles) const {
  std::vector<double> rows =
      with_prescribed ? prescribed_velocity_ : std::vector<double>(prescribed_velocity_.size(), 0);
  if (!coupling_transposed_.is_null())
    add_product(weights_, *solid_import_, solid_velocity, rows);
  return gas_rates_of_rows(rows, n_bubbles);
}

template <int dim>
std::vector<double> FaceCoupling<dim>::effective_gas_rates(const SolidSystem<dim>& solids,
                                                           int n_bubbles) const {
  return gas_rates_of_rows(effective_rows(solids), n_bubbles);
}

template <int dim>
void FaceCoupling<dim>::find_hydrostatic_loads(
    const FluidDiscretization<dim>& fluid, const SolidSystem<dim>& solids,
    const std::function<void(HydrostaticLoads<dim>&)>& add) {
  if (surface_->empty() || fluid.gravity().isZero(0))
    return;
  // No rank has a face if solids are smaller than cells.
  const double at_faces = max_all(solids.comm(), volumes_.empty() ? 0 : volumes_.front().density);
  const double density =
      at_faces > 0 ? at_faces : fluid.density(surface_->bounds_of_solid(0).center());
  HydrostaticLoads<dim> loads(fluid, *surface_, density);
  add(loads);
  loads.sum(solids.comm());
  hydrostatics_.take(loads, solids);
}

template <int dim>
Momentum<dim> FaceCoupling<dim>::taken_by_solids(const SolidSystem<dim>& solids,
                                                 const std::vector<double>& velocity_before,
                                                 const BlockVector& solution,
                                                 const std::vector<double>& gas_pressure) const {
  Vector taken(solids.map());
  this->add_lumped_momentum(velocity_before, taken);
  coupling_transposed_->apply(*solution.pressure, taken, Teuchos::NO_TRANS, -1, 1);
  if (!added_mass_.is_null())
    added_mass_->apply(*solution.solid, taken, Teuchos::NO_TRANS, -1, 1);
  if (!gas_pressure.empty())
    add_gas_push(gas_pressure, taken);
  return solids.momentum(taken);
}

void add_transposed(const CouplingWeights& weights, const Import& import,
                    const std::vector<double>& momentum, Vector& rhs) {
  Vector overlap(import.getTargetMap());
  {
    const auto values = overlap.getDataNonConst();
    for (int f = 0; f < weights.n_rows(); ++f) {
      for (int k = weights.row_begin[f]; k < weights.row_begin[f + 1]; ++k)
        values[weights.columns[k]] += weights.values[k] * momentum[f];
    }
  }
  add_overlap(overlap, import, rhs);
}

void add_product(const CouplingWeights& weights, const Import& import, const Vector& dofs,
                 std::vector<double>& result) {
  Vector overlap(import.getTargetMap());
  overlap.doImport(dofs, import, Tpetra::INSERT);
  const auto values = overlap.getData();
  for (int f = 0; f < weights.n_rows(); ++f) {
    for (int k = weights.row_begin[f]; k < weights.row_begin[f + 1]; ++k)
      result[f] += weights.values[k] * values[weights.columns[k]];
  }
}

template class FaceCoupling<2>;
template class FaceCoupling<3>;

}  // namespace lockstep
