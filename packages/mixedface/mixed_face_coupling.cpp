#include "mixedface/mixed_face_coupling.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "geometry/clipping.hpp"
#include "interfaces/fluid_sides.hpp"
#include "linear/overlap.hpp"

namespace lockstep {
namespace {

template <int dim>
bool cuts(const SurfaceSnapshot<dim>& surface, const Box<dim>& box) {
  std::vector<int> touching;
  surface.touching(box, touching);
  return std::any_of(touching.begin(), touching.end(), [&](int simplex) {
    return clip_to_box<dim>(surface.corners(simplex), box).measure > 0;
  });
}

}  // namespace

template <int dim>
double MixedFaceCoupling<dim>::open_fraction(const ControlVolume<dim>& volume, bool blocked,
                                             const SurfaceSnapshot<dim>& surface) const {
  const bool below = volume.sides[0].kind == SideKind::solid;
  if (blocked || below != (volume.sides[1].kind == SideKind::solid))
    return 0;
  if (options_.rule == MixedRule::every_cut_cell && cuts<dim>(surface, volume.box))
    return 0;
  return 1;
}

template <int dim>
void MixedFaceCoupling<dim>::assemble(const FluidDiscretization<dim>& fluid,
                                      const SolidSystem<dim>& solids,
                                      const SurfaceSnapshot<dim>& surface) {
  surface_ = &surface;
  volumes_ = fluid.coupled_volumes();
  shares_ = surface_shares<dim>(volumes_, surface);
  if (options_.carry_rotations)
    add_local_rotations<dim>(volumes_, surface, shares_);
  masses_ = fluid_masses<dim>(volumes_, surface, options_.whole_cell_mass);
  find_prescribed(solids);
  std::vector<GlobalIndex> unknowns;
  for (const ControlVolume<dim>& volume : volumes_) {
    for (const auto& side : volume.sides) {
      if (side.unknown != no_index)
        unknowns.push_back(side.unknown);
    }
  }
  pressure_import_ = import_of(std::move(unknowns), fluid.pressure_map());

  unseen_.clear();
  if (!solids.has_unknowns()) {
    coupling_transposed_ = Teuchos::null;
    added_mass_ = Teuchos::null;
    return;
  }
  if (options_.balance) {
    double density = volumes_.empty() ? 0 : volumes_.front().density;
    density = max_all(solids.comm(), density);
    if (density == 0)
      density = fluid.density(surface.bounds_of_solid(0).center());
    unseen_ = balance_masses<dim>(volumes_, shares_, surface, density, bounds_of(fluid),
                                  solids.comm(), masses_);
  }
  assemble_weights(solids);
  assemble_unseen(solids, surface);
  assemble_blocks(solids);
}

template <int dim>
void MixedFaceCoupling<dim>::assemble_weights(const SolidSystem<dim>& solids) {
  weights_ = coupling_weights<dim>(volumes_, shares_, solids);
  solid_import_ = import_of(weights_.dofs, solids.map());
  plain_weights_ = {};
  if (!masses_are_plain())
    return;
  plain_weights_ = coupling_weights<dim>(volumes_, shares_, solids, false);
  for (int& column : plain_weights_.columns) {
    const auto place =
        std::lower_bound(weights_.dofs.begin(), weights_.dofs.end(), plain_weights_.dofs[column]);
    column = static_cast<int>(place - weights_.dofs.begin());
  }
  plain_weights_.dofs = weights_.dofs;
}

template <int dim>
void MixedFaceCoupling<dim>::assemble_blocks(const SolidSystem<dim>& solids) {
  std::vector<Triplet> coupling;
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    for (int k = weights_.row_begin[f]; k < weights_.row_begin[f + 1]; ++k) {
      const GlobalIndex dof = weights_.dofs[weights_.columns[k]];
      for (int side = 0; side < 2; ++side) {
        // B = V G_c^T W with G^T = -div: outflow counts negative on the lower cell, positive above.
        const double area = side == 0 ? -volumes_[f].area : volumes_[f].area;
        const GlobalIndex unknown = volumes_[f].sides[side].unknown;
        if (unknown != no_index)
          coupling.push_back({dof, unknown, area * weights_.values[k]});
      }
    }
  }
  coupling_transposed_ =
      assemble_triplets(std::move(coupling), solids.map(), pressure_import_->getSourceMap());
  added_mass_ = assemble_triplets(
      options_.lumping == Lumping::consistent
          ? consistent_mass_triplets(weights_, masses_)
          : added_mass_triplets<dim>(volumes_, shares_, solids, masses_, options_.lumping),
      solids.map(), solids.map());
}

namespace {

/// Where the force acts on a rigid solid so that its torque is right; a vanishing one has no such
/// place.
template <int dim>
VelocityRow<dim> rigid_row(const SolidSystem<dim>& solids, const SolidDescription& solid,
                           const UnseenMass<dim>& left, int axis) {
  Point<dim> x = left.center;
  if (left.mass[axis] != 0)
    x += left.moment.row(axis).transpose() / left.mass[axis];
  SurfacePoint<dim> point;
  point.simplex = solid.simplex_begin;
  point.barycentric.setConstant(1. / dim);
  point.position = left.center;
  VelocityRow<dim> row;
  solids.velocity_row(point, x, row);
  return row;
}

/// The mean over the surface of a solid that is not rigid.
template <int dim>
VelocityRow<dim> mean_row(const SolidSystem<dim>& solids, const SolidDescription& solid,
                          const SurfaceSnapshot<dim>& surface) {
  VelocityRow<dim> sum, row;
  double total = 0;
  for (int s = solid.simplex_begin; s < solid.simplex_end; ++s) {
    SurfacePoint<dim> point;
    point.simplex = s;
    point.barycentric.setConstant(1. / dim);
    const double area = area_vector<dim>(surface.corners(s)).norm();
    total += area;
    solids.velocity_row(point, point.position, row);
    for (std::size_t k = 0; k < row.dofs.size(); ++k) {
      sum.dofs.push_back(row.dofs[k]);
      sum.coefficients.push_back(area * row.coefficients[k]);
    }
  }
  for (auto& coefficient : sum.coefficients)
    coefficient /= total;
  return sum;
}

}  // namespace

template <int dim>
void MixedFaceCoupling<dim>::assemble_unseen(const SolidSystem<dim>& solids,
                                             const SurfaceSnapshot<dim>& surface) {
  unseen_rows_.clear();
  for (const UnseenMass<dim>& left : unseen_) {
    const SolidDescription& solid = surface.solids()[left.solid];
    for (int a = 0; a < dim; ++a) {
      VelocityRow<dim> row;
      if (left.mass[a] != 0 || left.moment.row(a).norm() != 0) {
        row = solid.rigid ? rigid_row<dim>(solids, solid, left, a)
                          : mean_row<dim>(solids, solid, surface);
      }
      unseen_rows_.push_back(std::move(row));
    }
  }
}

template <int dim>
std::vector<Momentum<dim>> MixedFaceCoupling<dim>::add_unseen_buoyancy(const Point<dim>& gravity,
                                                                       double dt,
                                                                       Vector& rhs) const {
  const RCP<const Map> map = rhs.getMap();
  for (std::size_t s = 0; s < unseen_.size(); ++s) {
    for (int a = 0; a < dim; ++a) {
      const double impulse = -gravity[a] * dt * unseen_[s].mass[a];
      const VelocityRow<dim>& row = unseen_rows_[s * dim + a];
      for (std::size_t k = 0; k < row.dofs.size(); ++k) {
        if (map->isNodeGlobalElement(row.dofs[k])) {
          rhs.sumIntoGlobalValue(row.dofs[k], impulse * row.coefficients[k][a]);
        }
      }
    }
  }
  return std::vector<Momentum<dim>>(surface_->solids().size());
}

template <int dim>
void MixedFaceCoupling<dim>::find_prescribed(const SolidSystem<dim>& solids) {
  prescribed_share_.assign(volumes_.size(), 0);
  prescribed_velocity_.assign(volumes_.size(), 0);
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    for (const SurfaceShare<dim>& share : shares_[f]) {
      if (!solids.solids()[share.solid].prescribed)
        continue;
      const Point<dim> v = solids.prescribed_velocity(share.point, volumes_[f].center);
      prescribed_share_[f] += share.weight;
      prescribed_velocity_[f] += share.weight * v[volumes_[f].direction];
    }
  }
}

template <int dim>
void MixedFaceCoupling<dim>::add_divergence(const std::vector<double>& coupled_velocity,
                                            Vector& rhs) const {
  Vector overlap(pressure_import_->getTargetMap());
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    for (int side = 0; side < 2; ++side) {
      if (volumes_[f].sides[side].unknown == no_index)
        continue;
      const double area = side == 0 ? -volumes_[f].area : volumes_[f].area;
      overlap.sumIntoGlobalValue(volumes_[f].sides[side].unknown, area * coupled_velocity[f]);
    }
  }
  add_overlap(overlap, *pressure_import_, rhs);
}

template <int dim>
void MixedFaceCoupling<dim>::add_prescribed_divergence(Vector& rhs) const {
  add_divergence(prescribed_velocity_, rhs);
}

template <int dim>
void MixedFaceCoupling<dim>::add_lumped_momentum(const std::vector<double>& coupled_velocity,
                                                 Vector& rhs) const {
  // Diagonally lumped fluid moves with its own solid; consistently lumped fluid with the mixed
  // velocity.
  const double mixed = options_.lumping == Lumping::consistent ? 1 : 0;
  const CouplingWeights& weights = mass_weights();
  Vector overlap(solid_import_->getTargetMap());
  {
    const auto values = overlap.getDataNonConst();
    for (std::size_t f = 0; f < volumes_.size(); ++f) {
      const double momentum = masses_[f] * (coupled_velocity[f] - mixed * prescribed_velocity_[f]);
      for (int k = weights.row_begin[f]; k < weights.row_begin[f + 1]; ++k) {
        values[weights.columns[k]] += weights.values[k] * momentum;
      }
    }
  }
  add_overlap(overlap, *solid_import_, rhs);
}

template <int dim>
std::vector<double> MixedFaceCoupling<dim>::velocity(const Vector& solid_velocity) const {
  std::vector<double> result = prescribed_velocity_;
  if (coupling_transposed_.is_null())
    return result;
  const CouplingWeights& weights = mass_weights();
  Vector overlap(solid_import_->getTargetMap());
  overlap.doImport(solid_velocity, *solid_import_, Tpetra::INSERT);
  const auto values = overlap.getData();
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    for (int k = weights.row_begin[f]; k < weights.row_begin[f + 1]; ++k) {
      result[f] += weights.values[k] * values[weights.columns[k]];
    }
  }
  return result;
}

template <int dim>
std::vector<double> MixedFaceCoupling<dim>::effective_velocity(
    const SolidSystem<dim>& solids) const {
  std::vector<double> result(volumes_.size(), 0);
  for (std::size_t f = 0; f < volumes_.size(); ++f)
    result[f] = carried_effective_velocity<dim>(solids, shares_[f], volumes_[f].center,
                                                volumes_[f].direction);
  return result;
}

template <int dim>
std::vector<double> MixedFaceCoupling<dim>::pressure_jumps(const Vector& scaled_pressure) const {
  Vector beside(pressure_import_->getTargetMap());
  beside.doImport(scaled_pressure, *pressure_import_, Tpetra::INSERT);
  const auto pressure = beside.getData();
  std::vector<double> jumps(volumes_.size(), 0);
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    for (int side = 0; side < 2; ++side) {
      const GlobalIndex unknown = volumes_[f].sides[side].unknown;
      if (unknown != no_index)
        jumps[f] += (side == 0 ? -1 : 1) * pressure[beside.getMap()->getLocalElement(unknown)];
    }
  }
  return jumps;
}

// Where several prescribed solids share a volume, by their shares.
template <int dim>
std::vector<Momentum<dim>> MixedFaceCoupling<dim>::prescribed_impulses(
    const std::vector<double>& velocity_before, const std::vector<double>& velocity_after,
    const Vector& scaled_pressure) const {
  std::vector<Momentum<dim>> impulses(surface_->solids().size());
  if (!any_prescribed(surface_->solids()))
    return impulses;
  const std::vector<double> jumps = pressure_jumps(scaled_pressure);
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    if (prescribed_share_[f] == 0)
      continue;
    const double share_of_all = prescribed_share_[f];
    const double after = options_.lumping == Lumping::consistent ? share_of_all * velocity_after[f]
                                                                 : prescribed_velocity_[f];
    const double impulse = masses_[f] * (after - share_of_all * velocity_before[f]) +
                           share_of_all * volumes_[f].area * jumps[f];
    for (const SurfaceShare<dim>& share : shares_[f]) {
      if (surface_->solids()[share.solid].prescribed)
        impulses[share.solid].add(volumes_[f].center, volumes_[f].direction,
                                  share.weight / share_of_all * impulse);
    }
  }
  sum_over_ranks(impulses, pressure_import_->getSourceMap()->getComm());
  return impulses;
}

template <int dim>
AngularVector<dim> MixedFaceCoupling<dim>::lever_impulse(const SolidSystem<dim>& solids,
                                                         const std::vector<double>& velocity_before,
                                                         const std::vector<double>& velocity_after,
                                                         const BlockVector& solution) const {
  if (coupling_transposed_.is_null())
    return AngularVector<dim>::Zero();
  Vector taken(solids.map());
  add_lumped_momentum(velocity_before, taken);
  coupling_transposed_->apply(*solution.pressure, taken, Teuchos::NO_TRANS, -1, 1);
  added_mass_->apply(*solution.solid, taken, Teuchos::NO_TRANS, -1, 1);
  const std::vector<double> jumps = pressure_jumps(*solution.pressure);
  Momentum<dim> given;
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    const double share = 1 - prescribed_share_[f];
    const double after = options_.lumping == Lumping::consistent
                             ? share * velocity_after[f]
                             : velocity_after[f] - prescribed_velocity_[f];
    given.add(
        volumes_[f].center, volumes_[f].direction,
        masses_[f] * (share * velocity_before[f] - after) - share * volumes_[f].area * jumps[f]);
  }
  return solids.momentum(taken).angular - sum_over_ranks<dim>(given, solids.comm()).angular;
}

template <int dim>
void MixedFaceCoupling<dim>::share_row(const std::vector<SurfaceShare<dim>>& shares,
                                       const Point<dim>& x, int direction,
                                       const SolidSystem<dim>& solids, LinkRow<dim>& row) const {
  Point<dim> pulled = Point<dim>::Zero();  // nodes are pulled where the surface is, not at x
  double dynamic_share = 0, largest_share = 0;
  for (const SurfaceShare<dim>& share : shares) {
    if (share.weight > largest_share) {
      largest_share = share.weight;
      row.solid = share.solid;
    }
    if (solids.solids()[share.solid].prescribed) {
      row.prescribed += share.weight * solids.prescribed_velocity(share.point, x)[direction];
      row.prescribed_share += share.weight;
      row.prescribed_solid = share.solid;
      continue;
    }
    dynamic_share += share.weight;
    const bool at_x = solids.solids()[share.solid].rigid || share.rotation;
    pulled += share.weight * (at_x ? x : share.point.position);
  }
  VelocityRow<dim> scratch;
  RowEntries entries;
  add_carried_row<dim>(solids, shares, x, direction, scratch, entries);  // of dynamic solids
  for (const auto& [dof, value] : entries) {
    row.dofs.push_back(dof);
    row.weights.push_back(value);
  }
  if (dynamic_share > 0)
    row.position = pulled / dynamic_share;
}

template <int dim>
void MixedFaceCoupling<dim>::link_row(const ViscousLink<dim>& link, const SolidSystem<dim>& solids,
                                      LinkRow<dim>& row) const {
  row = {};
  if (link.coupled_volume >= 0) {
    row.position = volumes_[link.coupled_volume].center;
    share_row(shares_[link.coupled_volume], row.position, link.direction, solids, row);
  } else if (link.remote_volume) {
    row.position = link.remote_volume->center;
    const std::vector<ControlVolume<dim>> remote{*link.remote_volume};
    auto shares = surface_shares<dim>(remote, *surface_);
    if (options_.carry_rotations)
      add_local_rotations<dim>(remote, *surface_, shares);
    share_row(shares.front(), row.position, link.direction, solids, row);
  } else {
    row.position = link.end;
    SurfaceShare<dim> whole;
    whole.weight = 1;
    whole.point = link.point;
    whole.solid = surface_->solid_of(link.point.simplex);
    share_row({whole}, row.position, link.direction, solids, row);
  }
}

template class MixedFaceCoupling<2>;
template class MixedFaceCoupling<3>;

}  // namespace lockstep
