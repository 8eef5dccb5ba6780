#include "cutcell/flux_coupling.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <optional>

#include "faces/added_mass.hpp"
#include "faces/coupling_end.hpp"
#include "faces/share_velocities.hpp"
#include "faces/solid_fluxes.hpp"
#include "faces/wet_volume.hpp"
#include "interfaces/fluid_sides.hpp"
#include "linear/overlap.hpp"

namespace lockstep {

template <int dim>
double FluxCoupling<dim>::open_fraction(const ControlVolume<dim>& volume, bool parted,
                                        const SurfaceSnapshot<dim>& surface) const {
  return open_fraction_of<dim>(volume, parted, surface, options_);
}

template <int dim>
Point<dim> FluxCoupling<dim>::open_center(const ControlVolume<dim>& volume,
                                          const SurfaceSnapshot<dim>& surface) const {
  return open_center_of<dim>(volume, face_shares<dim>(volume, surface, options_).all);
}

namespace {
/// In a contact patch the solid whose cell is beside it has the whole face.
template <int dim>
FaceShares<dim> shares_at_patch(const ControlVolume<dim>& volume,
                                const SurfaceSnapshot<dim>& surface) {
  FaceShares<dim> shares;
  const int solid = std::max(volume.sides[0].solid, volume.sides[1].solid);
  shares.all.push_back({1, surface.closest_on_solid(volume.center, solid), solid, volume.center,
                        surface.solids()[solid].is_soft_body()});
  return shares;
}
}  // namespace

template <int dim>
void FluxCoupling<dim>::assemble(const FluidDiscretization<dim>& fluid,
                                 const SolidSystem<dim>& solids,
                                 const SurfaceSnapshot<dim>& surface) {
  shares_.clear();
  for (const ControlVolume<dim>& volume : fluid.coupled_volumes())
    shares_.push_back(volume.touches_patch() ? shares_at_patch<dim>(volume, surface)
                                             : face_shares<dim>(volume, surface, options_));
  flows_ = surface_flows<dim>(fluid, surface, shares_);
  std::vector<RowPush> pushes;
  for (const SurfaceFlow<dim>& flow : flows_)
    pushes.push_back(
        RowPush::into(flow.pressure, static_cast<int>(shares_.size() + pushes.size()), 1));
  this->take_volumes(fluid, surface, pushes);
  find_masses(fluid.liquid());
  find_prescribed_velocity(solids);
  if (options_.correct_buoyancy)
    this->find_hydrostatic_loads(fluid, solids, [this](auto& loads) { add_rest(loads); });
  if (solids.has_unknowns())
    assemble_blocks(solids);
}

template <int dim>
void FluxCoupling<dim>::find_masses(const LiquidFluid<dim>* liquid) {
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    const ControlVolume<dim>& volume = volumes_[f];
    masses_[f] = volume.density * volume.box.volume() * shares_[f].thin_part;
    if (volume.only_gas())
      masses_[f] = 0;
    if (liquid && masses_[f] > 0) {
      const double wet = std::max(0.0, wet_volume<dim>(volume, *surface_, true, *liquid));
      const double dry = std::max(0.0, volume.box.volume() - wet);
      masses_[f] = shares_[f].thin_part * (volume.density * wet + liquid->gas_density() * dry);
    }
  }
}

template <int dim>
void FluxCoupling<dim>::add_rest(HydrostaticLoads<dim>& loads) const {
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    const ControlVolume<dim>& volume = volumes_[f];
    for (const FluxShare<dim>& share : shares_[f].all)
      loads.add_closed(volume, share.solid, share.weight * closed_area(volume), share.center);
    for (const SurfaceShare<dim>& share : shares_[f].of_thin)
      loads.add_lumped(volume.direction, share.solid, share.weight * masses_[f], volume.center);
  }
}

template <int dim>
bool FluxCoupling<dim>::moves_otherwise(std::size_t f) const {
  const std::vector<FluxShare<dim>>& all = shares_[f].all;
  return !shares_[f].of_thin.empty() ||
         std::any_of(all.begin(), all.end(), [](const auto& share) { return share.at_surface; });
}

template <int dim>
void FluxCoupling<dim>::add_share(const FluxShare<dim>& share, int direction,
                                  const SolidSystem<dim>& solids, RowEntries& row) const {
  DirectedRow<dim> of_share;
  directed_row<dim>(solids, share.point, share.center, direction, of_share);
  for (std::size_t k = 0; k < of_share.dofs.size(); ++k)
    row.emplace_back(of_share.dofs[k], share.weight * of_share.values[k]);
}

template <int dim>
void FluxCoupling<dim>::add_flow(const SurfaceFlow<dim>& flow, const SolidSystem<dim>& solids,
                                 RowEntries& row) const {
  VelocityRow<dim> of_point;
  solids.velocity_row(flow.point, flow.point.position, of_point);
  for (std::size_t k = 0; k < of_point.dofs.size(); ++k)
    if (const double value = flow.area.dot(of_point.coefficients[k]); value != 0)
      row.emplace_back(of_point.dofs[k], value);
}

template <int dim>
void FluxCoupling<dim>::assemble_blocks(const SolidSystem<dim>& solids) {
  const int n_faces = static_cast<int>(volumes_.size());
  const int n_rows = n_faces + static_cast<int>(flows_.size());
  weights_ = weights_of_rows(n_rows, [&](int i, RowEntries& row) {
    if (i >= n_faces)
      return add_flow(flows_[i - n_faces], solids, row);
    for (const FluxShare<dim>& share : shares_[i].all)
      if (!share.at_surface)
        add_share(share, volumes_[i].direction, solids, row);
  });
  this->assemble_coupling(solids);

  VelocityRow<dim> scratch;
  face_weights_ = weights_of_rows(n_faces, [&](int f, RowEntries& row) {
    const int direction = volumes_[f].direction;
    if (!shares_[f].of_thin.empty())
      add_carried_row<dim>(solids, shares_[f].of_thin, volumes_[f].center, direction, scratch, row);
    else if (moves_otherwise(f))
      for (const FluxShare<dim>& share : shares_[f].all)
        add_share(share, direction, solids, row);
  });
  face_solid_import_ = import_of(face_weights_.dofs, solids.map());
  std::vector<std::vector<SurfaceShare<dim>>> thin;
  for (const FaceShares<dim>& shares : shares_)
    thin.push_back(shares.of_thin);
  const bool lumps = std::any_of(masses_.begin(), masses_.end(), [](double m) { return m > 0; });
  if (max_all(solids.comm(), lumps ? 1. : 0.) > 0)
    added_mass_ = assemble_triplets(
        added_mass_triplets<dim>(volumes_, thin, solids, masses_, Lumping::diagonal), solids.map(),
        solids.map());
}

template <int dim>
void FluxCoupling<dim>::find_prescribed_velocity(const SolidSystem<dim>& solids) {
  prescribed_thin_velocity_.assign(volumes_.size(), 0);
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    const auto velocity = [&](const SurfacePoint<dim>& point, const Point<dim>& x) {
      return solids.prescribed_velocity(point, x)[volumes_[f].direction];
    };
    for (const FluxShare<dim>& share : shares_[f].all)
      if (solids.solids()[share.solid].prescribed)
        prescribed_velocity_[f] += share.weight * velocity(share.point, share.center);
    for (const SurfaceShare<dim>& share : shares_[f].of_thin)
      if (solids.solids()[share.solid].prescribed)
        prescribed_thin_velocity_[f] += share.weight * velocity(share.point, volumes_[f].center);
  }
}

template <int dim>
std::vector<PrescribedFlux> FluxCoupling<dim>::solid_fluxes(const SolidSystem<dim>& solids) const {
  FluxesOfSolids fluxes(solids.solids());
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    for (const FluxShare<dim>& share : shares_[f].all) {
      if (!solids.solids()[share.solid].prescribed)
        continue;
      const Point<dim> v = solids.prescribed_velocity(share.point, share.center);
      fluxes.add(share.solid, volumes_[f],
                 share.weight * this->push(f, 1) * v[volumes_[f].direction]);
    }
  }
  return fluxes.take();
}

template <int dim>
void FluxCoupling<dim>::add_lumped_momentum(const std::vector<double>& coupled_velocity,
                                            Vector& rhs) const {
  if (added_mass_.is_null())
    return;
  std::vector<double> momentum(volumes_.size());
  for (std::size_t f = 0; f < volumes_.size(); ++f)
    momentum[f] = masses_[f] * coupled_velocity[f];
  add_transposed(face_weights_, *face_solid_import_, momentum, rhs);
}

/// Fluid lumped on thin parts moves with them alone, so that its momentum is what the solve
/// balanced.
template <int dim>
std::vector<double> FluxCoupling<dim>::velocity(const Vector& solid_velocity) const {
  std::vector<double> result = prescribed_velocity_, of_faces(volumes_.size(), 0);
  if (!coupling_transposed_.is_null()) {
    add_product(weights_, *solid_import_, solid_velocity, result);
    add_product(face_weights_, *face_solid_import_, solid_velocity, of_faces);
  }
  result.resize(volumes_.size());
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    if (!shares_[f].of_thin.empty())
      result[f] = of_faces[f] + prescribed_thin_velocity_[f];
    else if (moves_otherwise(f))
      result[f] = of_faces[f] + prescribed_velocity_[f];
  }
  return result;
}

template <int dim>
std::vector<double> FluxCoupling<dim>::effective_velocity(const SolidSystem<dim>& solids) const {
  std::vector<double> result(volumes_.size(), 0);
  for (std::size_t f = 0; f < volumes_.size(); ++f)
    for (const FluxShare<dim>& share : shares_[f].all)
      result[f] += share.weight *
                   solids.effective_velocity(share.point, share.center)[volumes_[f].direction];
  return result;
}

template <int dim>
std::vector<double> FluxCoupling<dim>::effective_rows(const SolidSystem<dim>& solids) const {
  std::vector<double> rows(volumes_.size(), 0);
  for (std::size_t f = 0; f < volumes_.size(); ++f)
    for (const FluxShare<dim>& share : shares_[f].all)
      if (!share.at_surface)
        rows[f] += share.weight *
                   solids.effective_velocity(share.point, share.center)[volumes_[f].direction];
  for (const SurfaceFlow<dim>& flow : flows_)
    rows.push_back(flow.area.dot(solids.effective_velocity(flow.point, flow.point.position)));
  return rows;
}

template <int dim>
std::vector<Momentum<dim>> FluxCoupling<dim>::prescribed_impulses(
    const std::vector<double>& velocity_before, const std::vector<double>&,
    const Vector& scaled_pressure, const std::vector<double>& gas_pressure) const {
  std::vector<Momentum<dim>> impulses(surface_->solids().size());
  if (!any_prescribed(surface_->solids()))
    return impulses;
  const std::vector<double> of_fluid = this->pushes(scaled_pressure, gas_pressure);
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    for (const FluxShare<dim>& share : shares_[f].all)
      if (surface_->solids()[share.solid].prescribed)
        impulses[share.solid].add(share.center, volumes_[f].direction, share.weight * of_fluid[f]);
    prescribed_thin_impulses(
        f, velocity_before[f], [&](const SurfaceShare<dim>& share, double impulse) {
          impulses[share.solid].add(volumes_[f].center, volumes_[f].direction, impulse);
        });
  }
  sum_over_ranks(impulses, pressure_import_->getSourceMap()->getComm());
  return impulses;
}

/// The impulses of prescribed thin parts on the fluid lumped on them; where several solids share
/// it, by their shares.
template <int dim>
template <typename Add>
void FluxCoupling<dim>::prescribed_thin_impulses(std::size_t f, double velocity_before,
                                                 const Add& add) const {
  double prescribed_share = 0;
  for (const SurfaceShare<dim>& share : shares_[f].of_thin)
    prescribed_share += surface_->solids()[share.solid].prescribed ? share.weight : 0;
  for (const SurfaceShare<dim>& share : shares_[f].of_thin) {
    if (!surface_->solids()[share.solid].prescribed)
      continue;
    const double gained = prescribed_thin_velocity_[f] - prescribed_share * velocity_before;
    add(share, share.weight / prescribed_share * masses_[f] * gained);
  }
}

// The surface in the cells pushes soft bodies, faces push the others; thin parts carry fluid, too.
// Closed parts of faces along a surface make its cells' pressures: what those push on one face to
// either side nearly cancels, and counts in the part that each cell is beside.
template <int dim>
std::vector<SurfaceImpulse<dim>> FluxCoupling<dim>::impulses_on_solids(
    const SolidSystem<dim>& solids, const std::vector<double>& velocity_before,
    const BlockVector& solution, const std::vector<double>& gas_pressure) const {
  const auto of_sides = this->pushes_of_sides(*solution.pressure, gas_pressure);
  std::optional<ShareVelocities<dim>> velocities;
  if (!coupling_transposed_.is_null())
    velocities.emplace(solids, *face_solid_import_, *solution.solid);
  std::vector<SurfaceImpulse<dim>> impulses;
  const auto add = [&](const auto& share, const Point<dim>& near, const Point<dim>& place,
                       const Point<dim>& impulse) {
    if (velocities || surface_->solids()[share.solid].prescribed)
      impulses.push_back({this->point_near(share.point, share.solid, near), place, impulse});
  };
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    const ControlVolume<dim>& volume = volumes_[f];
    const Point<dim> axis = Point<dim>::Unit(volume.direction);
    for (const FluxShare<dim>& share : shares_[f].all)
      for (int side = 0; side < 2 && !share.at_surface; ++side)
        add(share, volume.sides[side].center, share.center,
            -share.weight * of_sides[f][side] * axis);
    prescribed_thin_impulses(f, velocity_before[f],
                             [&](const SurfaceShare<dim>& share, double impulse) {
                               add(share, volume.center, volume.center, -impulse * axis);
                             });
    for (const SurfaceShare<dim>& share : shares_[f].of_thin)
      if (velocities && !surface_->solids()[share.solid].prescribed)
        add(share, volume.center, volume.center,
            share.weight * masses_[f] *
                (velocity_before[f] -
                 velocities->along(volume.direction, share.point, volume.center)) *
                axis);
  }
  const std::vector<double> of_fluid = this->pushes(*solution.pressure, gas_pressure);
  for (std::size_t i = 0; velocities && i < flows_.size(); ++i)
    impulses.push_back({flows_[i].point, flows_[i].point.position,
                        -of_fluid[volumes_.size() + i] * flows_[i].area});
  return impulses;
}

// The fluid gives to the closed part of a face at its centroid, and what is lumped on thin parts at
// the centre; nodes take both where the surface is.
template <int dim>
AngularVector<dim> FluxCoupling<dim>::lumping_torque_error(
    const SolidSystem<dim>& solids, const std::vector<double>& velocity_before,
    const std::vector<double>& velocity_after, const BlockVector& solution,
    const std::vector<double>& gas_pressure) const {
  const auto is_soft = [](const SolidDescription& solid) {
    return !solid.rigid && !solid.prescribed;
  };
  if (coupling_transposed_.is_null() ||
      std::none_of(solids.solids().begin(), solids.solids().end(), is_soft))
    return AngularVector<dim>::Zero();
  const std::vector<double> of_fluid = this->pushes(*solution.pressure, gas_pressure);
  Momentum<dim> given;
  for (std::size_t f = 0; f < volumes_.size(); ++f) {
    const int axis = volumes_[f].direction;
    for (const FluxShare<dim>& share : shares_[f].all)
      if (!surface_->solids()[share.solid].prescribed)
        given.add(share.center, axis, -share.weight * of_fluid[f]);
    if (shares_[f].of_thin.empty())
      continue;
    double share = 0;
    for (const SurfaceShare<dim>& thin : shares_[f].of_thin)
      share += surface_->solids()[thin.solid].prescribed ? 0 : thin.weight;
    given.add(volumes_[f].center, axis,
              masses_[f] * (share * velocity_before[f] -
                            (velocity_after[f] - prescribed_thin_velocity_[f])));
  }
  return this->taken_by_solids(solids, velocity_before, solution, gas_pressure).angular -
         sum_over_ranks<dim>(given, solids.comm()).angular;
}

template <int dim>
void FluxCoupling<dim>::add_to_row(const std::vector<FluxShare<dim>>& shares, int direction,
                                   const SolidSystem<dim>& solids, EndVelocity<dim>& row) const {
  DirectedRow<dim> of_share;
  CouplingEnd<dim> end(solids, direction, row);
  for (const FluxShare<dim>& share : shares) {
    const bool rigid = solids.solids()[share.solid].rigid;
    if (!end.add(share.weight, share.point, share.solid, share.center,
                 rigid ? share.center : share.point.position))
      continue;
    directed_row<dim>(solids, share.point, share.center, direction, of_share);
    for (std::size_t k = 0; k < of_share.dofs.size(); ++k)
      end.add_entry(of_share.dofs[k], share.weight * of_share.values[k]);
  }
  end.finish();
}

template <int dim>
void FluxCoupling<dim>::link_row(const ViscousCouplingTerm<dim>& link,
                                 const SolidSystem<dim>& solids, EndVelocity<dim>& row) const {
  row = {};
  if (link.coupled_volume >= 0) {
    row.position = volumes_[link.coupled_volume].center;
    add_to_row(shares_[link.coupled_volume].all, link.direction, solids, row);
  } else if (link.remote_volume) {
    ControlVolume<dim> volume = *link.remote_volume;
    volume.open_fraction = 0;
    row.position = volume.center;
    add_to_row(face_shares<dim>(volume, *surface_, options_).all, link.direction, solids, row);
  } else {
    row.position = link.end;
    add_to_row({{1, link.point, surface_->solid_of(link.point.simplex), link.end}}, link.direction,
               solids, row);
  }
}

template class FluxCoupling<2>;
template class FluxCoupling<3>;

}  // namespace lockstep
