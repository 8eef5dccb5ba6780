// Do the two plug-ins keep what their interfaces promise? Prints a sentence for each broken
// promise.
#include "conformance/coupling_conformance.hpp"

#include <Tpetra_Core.hpp>
#include <iostream>

#include "column_fluid.hpp"
#include "conformance/fluid_conformance.hpp"
#include "conformance/solid_conformance.hpp"
#include "mixedface/mixed_face_coupling.hpp"
#include "piston.hpp"
#include "stepping/scene_file.hpp"
using namespace lockstep;

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  const Communicator comm = Tpetra::getDefaultComm();
  return run_and_report(comm, [&] {
    ColumnFluid fluid(ColumnFluid::Options{}, comm);
    MixedFaceCoupling<2> coupling(MixedFaceOptions{});
    std::vector<std::unique_ptr<SolidModel<2>>> models;
    models.push_back(std::make_unique<Piston>(Piston::Options{}, comm));
    Violations found = check_solid<2>(*models.front());
    SolidSystem<2> solids(std::move(models), comm);
    for (const Violations& more : {check_fluid<2>(fluid, solids.snapshot(), coupling),
                                   check_coupling<2>(coupling, fluid, solids)})
      found.insert(found.end(), more.begin(), more.end());
    if (comm->getRank() == 0)
      for (const std::string& violation : found)
        std::cout << violation << '\n';
    return found.empty() ? 0 : 1;
  });
}
