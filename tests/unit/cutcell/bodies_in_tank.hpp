#pragma once
#include <Tpetra_Core.hpp>
#include <memory>
#include <vector>

#include "conformance/fake_solid.hpp"
#include "coupling/coupled_system.hpp"
#include "unit/mac/mac_cases.hpp"

namespace lockstep::test {

/// Bodies in a tank of water, frozen at their places, with a coupling of that type.
template <int dim, typename TankCoupling>
struct BodiesInTank {
  template <typename Options>
  BodiesInTank(std::unique_ptr<MacFluid<dim>> water, std::vector<FakeBody<dim>> bodies,
               const Options& options)
      : fluid(std::move(water)), coupling(options) {
    std::vector<std::unique_ptr<SolidModel<dim>>> models;
    models.push_back(std::make_unique<FakeSolid<dim>>(std::move(bodies), FakeSolidOptions<dim>(),
                                                      Tpetra::getDefaultComm()));
    solids = std::make_unique<SolidSystem<dim>>(std::move(models), Tpetra::getDefaultComm());
    system = std::make_unique<CoupledSystem<dim>>(*fluid, *solids, coupling);
    surface = solids->snapshot();
    system->freeze(surface);
    fluid->begin_prediction();
  }

  std::unique_ptr<MacFluid<dim>> fluid;
  std::unique_ptr<SolidSystem<dim>> solids;
  TankCoupling coupling;
  std::unique_ptr<CoupledSystem<dim>> system;
  std::shared_ptr<const SurfaceSnapshot<dim>> surface;
};

}  // namespace lockstep::test
