#include "mixedface/mixed_face_coupling.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <map>
#include <optional>

#include "base/errors.hpp"
#include "faces/coupling_end.hpp"
#include "faces/share_velocities.hpp"
#include "faces/solid_fluxes.hpp"
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
double MixedFaceCoupling<dim>::open_fraction(const ControlVolume<dim>& volume, bool occluded,
                                             const SurfaceSnapshot<dim>& surface) const {
  const bool below = volume.sides[0].kind == SideKind::solid;
  if (occluded || below != (volume.sides[1].kind == SideKind::solid))
    return 0;
  if (options_.rule == MixedRule::every_cut_cell && cuts<dim>(surface, volume.box))
    return 0;
  return 1;
}

template <int dim>
std::vector<std::vector<SurfaceShare<dim>>> MixedFaceCoupling<dim>::shares_of(
    const std::vector<ControlVolume<dim>>& volumes, const SurfaceSnapshot<dim>& surface) const {
  auto shares = surface_shares<dim>(volumes, surface);
  if (options_.soft_weights == SoftWeights::area)
    weigh_nodes_alike<dim>(surface, shares);
  else if (options_.soft_weights == SoftWeights::rigid_motions)
    add_local_rotations<dim>(volumes, surface, shares);
  return shares;
}

template <int dim>
void MixedFaceCoupling<dim>::assemble(const FluidDiscretization<dim>& fluid,
                                      const SolidSystem<dim>& solids,
                                      const SurfaceSnapshot<dim>& surface) {
  check_input(!solids.joints() || options_.lumping != Lumping::paper_diagonal,
              "Lumping \"paper diagonal\" keeps a centre of mass for each axis and cannot be "
              "combined with joints; take \"diagonal\".");
  this->take_volumes(fluid, surface);
  shares_ = shares_of(volumes_, surface);
  const LiquidFluid<dim>* liquid = fluid.liquid();
  masses_ = fluid_masses<dim>(volumes_, surface, options_.whole_cell_mass, liquid);
  find_prescribed(solids);
  if (options_.correct_buoyancy)
    this->find_hydrostatic_loads(fluid, solids, [this](auto& loads) { add_rest(loads); });
  if (!solids.has_unknowns())
    return;
  assemble_weights(solids);
  this->assemble_coupling(solids);
  added_mass_ = assemble_triplets(
      options_.lumping == Lumping::consistent
          ? consistent_mass_triplets(weights_, masses_)
          : added_mass_triplets<dim>(volumes_, shares_, solids, masses_, options_.lumping),
      solids.map(), solids.map());
}

template <int dim>
void MixedFaceCoupling<dim>::add_rest(HydrostaticLoads<dim>& loads) const {
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    const ControlVolume<dim>& volume = volumes_[f];
    for (const SurfaceShare<dim>& share : shares_[f]) {
      loads.add_closed(volume, share.solid, share.weight * volume.area, volume.center);
      loads.add_lumped(volume.direction, share.solid, share.weight * masses_[f], volume.center);
    }
  }
}

template <int dim>
void MixedFaceCoupling<dim>::assemble_weights(const SolidSystem<dim>& solids) {
  weights_ = coupling_weights<dim>(volumes_, shares_, solids);
  weights_without_rotations_ = {};
  if (!masses_without_rotations())
    return;
  weights_without_rotations_ = coupling_weights<dim>(volumes_, shares_, solids, false);
  for (int& column : weights_without_rotations_.columns) {
    const auto place = std::lower_bound(weights_.dofs.begin(), weights_.dofs.end(),
                                        weights_without_rotations_.dofs[column]);
    column = static_cast<int>(place - weights_.dofs.begin());
  }
  weights_without_rotations_.dofs = weights_.dofs;
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
std::vector<PrescribedFlux> MixedFaceCoupling<dim>::solid_fluxes(
    const SolidSystem<dim>& solids) const {
  FluxesOfSolids fluxes(solids.solids());
  std::map<int, std::vector<double>> into_patches;  // by solid and node
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    const ControlVolume<dim>& volume = volumes_[f];
    for (const SurfaceShare<dim>& share : shares_[f]) {
      if (!solids.solids()[share.solid].prescribed)
        continue;
      const Point<dim> v = solids.prescribed_velocity(share.point, volume.center);
      const double flux = share.weight * volume.area * v[volume.direction];
      fluxes.add(share.solid, volume, flux);
      for (int side = 0; side < 2; ++side)
        if (const int node = volume.sides[side].patch; node >= 0) {
          std::vector<double>& at_nodes = into_patches[share.solid];
          at_nodes.resize(patches_->n_nodes(), 0);
          at_nodes[node] += side == 0 ? -flux : flux;
        }
    }
  }
  for (const auto& [solid, at_nodes] : into_patches)
    fluxes.add(solid, patches_->drained(at_nodes));
  return fluxes.take();
}

template <int dim>
void MixedFaceCoupling<dim>::add_lumped_momentum(const std::vector<double>& coupled_velocity,
                                                 Vector& rhs) const {
  // Diagonally lumped fluid moves with its own solid; consistently lumped fluid with the mixed
  // velocity.
  const double mixed = options_.lumping == Lumping::consistent ? 1 : 0;
  std::vector<double> momentum(volumes_.size());
  for (std::size_t f = 0; f < volumes_.size(); ++f)
    momentum[f] = masses_[f] * (coupled_velocity[f] - mixed * prescribed_velocity_[f]);
  add_transposed(mass_weights(), *solid_import_, momentum, rhs);
}

template <int dim>
std::vector<double> MixedFaceCoupling<dim>::velocity(const Vector& solid_velocity) const {
  std::vector<double> result = prescribed_velocity_;
  if (!coupling_transposed_.is_null())
    add_product(mass_weights(), *solid_import_, solid_velocity, result);
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

/// Impulse of all prescribed solids that share a volume on the fluid, for its velocity before, and
/// that of the whole volume after, a solve.
template <int dim>
double MixedFaceCoupling<dim>::impulse_of_prescribed(std::size_t face, double before, double after,
                                                     double push) const {
  const double share = prescribed_share_[face];
  const double moved =
      options_.lumping == Lumping::consistent ? share * after : prescribed_velocity_[face];
  return masses_[face] * (moved - share * before) + share * push;
}

// Where several prescribed solids share a volume, by their shares.
template <int dim>
std::vector<Momentum<dim>> MixedFaceCoupling<dim>::prescribed_impulses(
    const std::vector<double>& velocity_before, const std::vector<double>& velocity_after,
    const Vector& scaled_pressure, const std::vector<double>& gas_pressure) const {
  std::vector<Momentum<dim>> impulses(surface_->solids().size());
  if (!any_prescribed(surface_->solids()))
    return impulses;
  const std::vector<double> of_fluid = this->pushes(scaled_pressure, gas_pressure);
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    if (prescribed_share_[f] == 0)
      continue;
    const double impulse =
        impulse_of_prescribed(f, velocity_before[f], velocity_after[f], of_fluid[f]);
    for (const SurfaceShare<dim>& share : shares_[f]) {
      if (surface_->solids()[share.solid].prescribed)
        impulses[share.solid].add(volumes_[f].center, volumes_[f].direction,
                                  share.weight / prescribed_share_[f] * impulse);
    }
  }
  sum_over_ranks(impulses, pressure_import_->getSourceMap()->getComm());
  return impulses;
}

template <int dim>
std::vector<SurfaceImpulse<dim>> MixedFaceCoupling<dim>::impulses_on_solids(
    const SolidSystem<dim>& solids, const std::vector<double>& velocity_before,
    const BlockVector& solution, const std::vector<double>& gas_pressure) const {
  check_input(options_.lumping != Lumping::paper_diagonal,
              "Lumping \"paper diagonal\" loses momentum and does not tell where; an observer that "
              "asks for the force on a part of a surface needs \"diagonal\" or \"consistent\".");
  const auto of_sides = this->pushes_of_sides(*solution.pressure, gas_pressure);
  const std::vector<double> after = velocity(*solution.solid);
  std::optional<ShareVelocities<dim>> velocities;
  if (!coupling_transposed_.is_null())
    velocities.emplace(solids, *solid_import_, *solution.solid);
  std::vector<SurfaceImpulse<dim>> impulses;
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    const ControlVolume<dim>& volume = volumes_[f];
    const double of_prescribed = impulse_of_prescribed(f, velocity_before[f], after[f], 0);
    for (const SurfaceShare<dim>& share : shares_[f]) {
      const bool prescribed = surface_->solids()[share.solid].prescribed;
      if (!prescribed && !velocities)
        continue;
      const auto add = [&](const Point<dim>& x, double impulse) {
        impulses.push_back({this->point_near(share.point, share.solid, x), volume.center,
                            share.weight * impulse * Point<dim>::Unit(volume.direction)});
      };
      for (int side = 0; side < 2; ++side)
        add(volume.sides[side].center, -of_sides[f][side]);
      if (prescribed)
        add(volume.center, -of_prescribed / prescribed_share_[f]);
      else if (options_.lumping == Lumping::consistent)
        add(volume.center, masses_[f] * (velocity_before[f] - after[f]));
      else
        add(volume.center,
            masses_[f] * (velocity_before[f] -
                          velocities->along(volume.direction, share.point, volume.center)));
    }
  }
  return impulses;
}

template <int dim>
AngularVector<dim> MixedFaceCoupling<dim>::lumping_torque_error(
    const SolidSystem<dim>& solids, const std::vector<double>& velocity_before,
    const std::vector<double>& velocity_after, const BlockVector& solution,
    const std::vector<double>& gas_pressure) const {
  if (coupling_transposed_.is_null())
    return AngularVector<dim>::Zero();
  const std::vector<double> of_fluid = this->pushes(*solution.pressure, gas_pressure);
  Momentum<dim> given;
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    const double share = 1 - prescribed_share_[f];
    const double after = options_.lumping == Lumping::consistent
                             ? share * velocity_after[f]
                             : velocity_after[f] - prescribed_velocity_[f];
    given.add(volumes_[f].center, volumes_[f].direction,
              masses_[f] * (share * velocity_before[f] - after) - share * of_fluid[f]);
  }
  return this->taken_by_solids(solids, velocity_before, solution, gas_pressure).angular -
         sum_over_ranks<dim>(given, solids.comm()).angular;
}

template <int dim>
void MixedFaceCoupling<dim>::share_row(const std::vector<SurfaceShare<dim>>& shares,
                                       const Point<dim>& x, int direction,
                                       const SolidSystem<dim>& solids,
                                       EndVelocity<dim>& row) const {
  CouplingEnd<dim> end(solids, direction, row);
  for (const SurfaceShare<dim>& share : shares) {
    const bool at_x = solids.solids()[share.solid].rigid || share.rotation;
    end.add(share.weight, share.point, share.solid, x, at_x ? x : share.point.position);
  }
  VelocityRow<dim> scratch;
  RowEntries entries;
  add_carried_row<dim>(solids, shares, x, direction, scratch,
                       entries);  // entries of dynamic solids
  for (const auto& [dof, value] : entries)
    end.add_entry(dof, value);
  end.finish();
}

template <int dim>
void MixedFaceCoupling<dim>::link_row(const ViscousCouplingTerm<dim>& link,
                                      const SolidSystem<dim>& solids, EndVelocity<dim>& row) const {
  row = {};
  if (link.coupled_volume >= 0) {
    row.position = volumes_[link.coupled_volume].center;
    share_row(shares_[link.coupled_volume], row.position, link.direction, solids, row);
  } else if (link.remote_volume) {
    row.position = link.remote_volume->center;
    const std::vector<ControlVolume<dim>> remote{*link.remote_volume};
    share_row(shares_of(remote, *surface_).front(), row.position, link.direction, solids, row);
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
