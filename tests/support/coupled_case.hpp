#pragma once
#include <Tpetra_Core.hpp>
#include <utility>

#include "conformance/fake_fluid.hpp"
#include "conformance/fake_solid.hpp"
#include "coupling/coupled_system.hpp"
#include "mixedface/mixed_face_coupling.hpp"

namespace lockstep::test {

template <int dim>
using Models = std::vector<std::unique_ptr<SolidModel<dim>>>;

/// Models of the fakes, one per list of bodies.
template <int dim>
Models<dim> fake_solids(std::vector<std::vector<FakeBody<dim>>> bodies,
                        const FakeSolidOptions<dim>& options = {}) {
  Models<dim> models;
  for (auto& list : bodies) {
    models.push_back(
        std::make_unique<FakeSolid<dim>>(std::move(list), options, Tpetra::getDefaultComm()));
  }
  return models;
}

/// Fake fluid and solids through mixed faces, frozen at their first positions.
template <int dim>
struct CoupledCase {
  CoupledCase(const FakeBox<dim>& box, Models<dim> models, const MixedFaceOptions& options = {})
      : fluid(box, Tpetra::getDefaultComm()),
        solids(std::move(models), Tpetra::getDefaultComm()),
        coupling(options),
        system(fluid, solids, coupling) {
    system.freeze(solids.snapshot());
  }
  FakeFluid<dim> fluid;
  SolidSystem<dim> solids;
  MixedFaceCoupling<dim> coupling;
  CoupledSystem<dim> system;
};

/// A chain of segments; closed ones run counterclockwise around their solid.
inline SurfaceMesh<2> polyline(const std::vector<Point<2>>& vertices, bool closed) {
  SurfaceMesh<2> mesh;
  mesh.vertices = vertices;
  const int n = static_cast<int>(vertices.size());
  for (int v = 0; v + 1 < n; ++v)
    mesh.simplices.push_back({v, v + 1});
  if (closed)
    mesh.simplices.push_back({n - 1, 0});
  return mesh;
}

inline SurfaceMesh<2> rectangle(const Point<2>& lower, const Point<2>& upper) {
  return polyline({lower, {upper.x(), lower.y()}, upper, {lower.x(), upper.y()}}, true);
}

}  // namespace lockstep::test
