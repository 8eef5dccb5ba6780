// Measures the losses and costs of interface models in flows that should bring a liquid component
// back: one line a run, comma-separated. interfaces CASE..., with CASE one of zalesak, vortex-64,
// vortex-128, deformation-32, deformation-64.
#include <Tpetra_Core.hpp>
#include <cstdio>
#include <string>

#include "liquid/advection_cases.hpp"

using namespace lockstep;
using namespace lockstep::test;

namespace {
Return run(const std::string& name, const std::string& model, const ParameterList& list) {
  if (name == "zalesak")
    return zalesak(model, list);
  const int n = std::stoi(name.substr(name.find('-') + 1));
  if (name.rfind("vortex-", 0) == 0)
    return vortex(model, list, n);
  check_input(name.rfind("deformation-", 0) == 0, "There is no case \"{}\".", name);
  return deformation(model, list, n);
}
}  // namespace

int main(int argc, char** argv) {
  Tpetra::ScopeGuard scope(&argc, &argv);
  std::printf("case,model,correction,loss,shape,ledger,bodies,steps,ms_a_step,ns_a_band_cell\n");
  for (int i = 1; i < argc; ++i)
    for (const std::string model : {"level set", "particle level set", "volume of fluid"})
      for (const bool corrects : {false, true}) {
        ParameterList list;
        const std::string correction = corrects ? "component" : "none";
        list.set("Volume Correction", correction);
        const Return found = run(argv[i], model, list);
        std::printf("%s,%s,%s,%.5f,%.5f,%.2e,%d,%d,%.3f,%.0f\n", argv[i], model.c_str(),
                    correction.c_str(), found.loss, found.shape, found.ledger, found.n_components,
                    found.n_steps, 1e3 * found.seconds / found.n_steps,
                    1e9 * found.seconds / found.band_cells);
        std::fflush(stdout);
      }
  return 0;
}
