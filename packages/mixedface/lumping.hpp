#pragma once
#include <vector>

#include "faces/axis_force.hpp"
#include "faces/surface_shares.hpp"
#include "interfaces/liquid.hpp"

namespace lockstep {

/// M_F [kg] of each coupled control volume: density times the dual cell minus the solids in it,
/// never negative; with `whole_cell` density times the dual cell. Of a `liquid` (or null) only what
/// is below its free surface, and where a shell parts it from the air, on its own side.
template <int dim>
std::vector<double> fluid_masses(const std::vector<ControlVolume<dim>>& volumes,
                                 const SurfaceSnapshot<dim>& surface, bool whole_cell,
                                 const LiquidFluid<dim>* liquid);

/// Corrects the masses of the mixed faces of every closed solid, axis by axis, by factors linear in
/// the transverse position, so that lumped fluid + solid displace exactly what the discrete
/// pressure lifts: sum m_f = rho (V_disc - V_solid), and its first moments across the axis. Then a
/// neutrally buoyant body rests (A1) and drifts (A9) exactly. V_solid is that of the part in
/// `domain`, where the fluid can be; of a body that is partly in a liquid (`wet`, by solid; empty
/// without one) all of that is of its wet part. Returns what is left of solids and axes where a
/// mass would have turned negative or that the grid does not see, and of prescribed solids; their
/// masses are left alone.
/// Collective.
template <int dim>
std::vector<DisplacedExcess<dim>> balance_masses(
    const std::vector<ControlVolume<dim>>& volumes,
    const std::vector<std::vector<SurfaceShare<dim>>>& shares, const SurfaceSnapshot<dim>& surface,
    double density, const Box<dim>& domain, const std::vector<WetBody<dim>>& wet,
    const Communicator& comm, std::vector<double>& masses);

}  // namespace lockstep
