// `simulate` with the plug-ins of this project built in: it needs no --plug-in.
#include "interfaces/plug_ins.hpp"
#include "programs/simulate_main.hpp"
#include "shipped/shipped_plug_ins.hpp"
using namespace lockstep;

int main(int argc, char** argv) {
  return simulate_main(argc, argv, [] {
    PlugIns plug_ins = shipped_plug_ins();
    lockstep_register_plug_ins(plug_ins);
    return plug_ins;
  });
}
