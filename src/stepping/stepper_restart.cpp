// What checkpoints hold of the step itself.
#include "base/errors.hpp"
#include "output/checkpoint.hpp"
#include "stepping/stepper.hpp"

namespace lockstep {

template <int dim>
void Stepper<dim>::resume(const CheckpointReader& checkpoint, double last_dt) {
  time_ = checkpoint.header().time;
  n_steps_ = checkpoint.header().step;
  last_dt_ = last_dt;
  components_.solids->begin_step(time_, 0);
  freeze();
}

template void Stepper<2>::resume(const CheckpointReader&, double);
template void Stepper<3>::resume(const CheckpointReader&, double);

}  // namespace lockstep
