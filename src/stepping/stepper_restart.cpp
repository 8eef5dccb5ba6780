// What checkpoints hold of the step itself.
#include "base/errors.hpp"
#include "output/checkpoint.hpp"
#include "stepping/stepper.hpp"

namespace lockstep {

namespace {
const std::string momentum_path = "momentum of the last step";
}  // namespace

/// The momentum at the end of the last step is found anew in a restart, unless cells are gone since
/// that held some of it.
template <int dim>
void Stepper<dim>::save(CheckpointWriter& checkpoint) const {
  if (!cells_are_gone_)
    return;
  std::vector<double> values(last_momentum_.linear.data(), last_momentum_.linear.data() + dim);
  values.insert(values.end(), last_momentum_.angular.data(),
                last_momentum_.angular.data() + n_rotations<dim>);
  checkpoint.file().write_replicated(momentum_path, values);
}

template <int dim>
void Stepper<dim>::resume(const CheckpointReader& checkpoint, double last_dt) {
  time_ = checkpoint.header().time;
  n_steps_ = checkpoint.header().step;
  last_dt_ = last_dt;
  components_.solids->begin_step(time_, 0);
  freeze();
  const Hdf5File& file = checkpoint.file();
  cells_are_gone_ = file.exists(momentum_path);
  if (!cells_are_gone_)
    return;
  const std::vector<double> values = file.read_all<double>(momentum_path);
  check_input(values.size() == dim + n_rotations<dim>,
              "{}: the checkpoint's \"{}\" is incomplete; restart from another one.", file.path(),
              momentum_path);
  last_momentum_.linear = Eigen::Map<const Point<dim>>(values.data());
  last_momentum_.angular = Eigen::Map<const AngularVector<dim>>(values.data() + dim);
}

template void Stepper<2>::save(CheckpointWriter&) const;
template void Stepper<3>::save(CheckpointWriter&) const;
template void Stepper<2>::resume(const CheckpointReader&, double);
template void Stepper<3>::resume(const CheckpointReader&, double);

}  // namespace lockstep
