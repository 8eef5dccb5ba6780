// Runs one scene.
//
//   simulate xml-params/scenes/buoyant-spheres.xml --output run
//   mpirun -n 2 simulate scene.xml --set "Time/End=0.5" --set "Fluid/Density=1000"
//   simulate scene.xml --restart run/checkpoint-000120.h5 --output run
//   simulate scene.xml --validate | --explain        simulate --parameters | --list-plugins
//
// Exit codes: 0 done, 2 bad input, 3 a solve failed, 4 input or output failed, 128 + its number
// stopped by a signal after a step and its checkpoint.
#include "programs/simulate_main.hpp"
#include "shipped/shipped_plug_ins.hpp"

int main(int argc, char** argv) {
  return lockstep::simulate_main(argc, argv, lockstep::shipped_plug_ins);
}
