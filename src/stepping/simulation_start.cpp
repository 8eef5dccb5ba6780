// Start of a run, before its first step: looks at the checkpoint, then takes its folder over.
#include <cmath>

#include "base/errors.hpp"
#include "output/checkpoint.hpp"
#include "output/on_root.hpp"
#include "output/run_record.hpp"
#include "parameters/write.hpp"
#include "stepping/report/earlier_tables.hpp"
#include "stepping/restart_check.hpp"
#include "stepping/simulation.hpp"

namespace lockstep {

template <int dim>
void Simulation<dim>::begin_outputs() {
  files_ = checksums_of_files(scene_, options_.scene_file, comm_);
  // A checkpoint that does not fit must not leave anything behind, nor take anything away.
  if (!options_.restart_file.empty()) {
    load_checkpoint();
    tables_.check_columns();
    observers_.check_columns();
  }
  fraction_at_begin_ = fraction_done();
  create_output_directory(comm_, options_.output_directory);
  lock_folder();
  if (options_.restart_file.empty())
    remove_earlier_tables(comm_, options_.output_directory, scene_);
  origin_ = run_origin(options_.scene_file, to_xml(scene_));
  frames_.set_origin(origin_);
  record_input(comm_, options_.output_directory, options_.scene_file, origin_.parameters);
  header_ = run_header(comm_, options_.command_line);
  write_summary(comm_, options_.output_directory, unfinished_summary("running", "", header_));
  first_step_ = step_;
}

template <int dim>
void Simulation<dim>::lock_folder() {
  constexpr double seconds_to_wait = 2;  // for ranks of an mpirun that was killed just now
  on_root(comm_, [&] {
    folder_lock_ = FolderLock::take(options_.output_directory, seconds_to_wait);
    check_input(folder_lock_ != nullptr,
                "Another run writes to '{}': wait for it, end it or choose another --output.",
                options_.output_directory);
  });
}

template <int dim>
void Simulation<dim>::begin_tables() {
  if (options_.restart_file.empty()) {
    discard_checkpoints_after(comm_, options_.output_directory, -1);
    tables_.start();
    if (!observers_.empty())
      observers_.start(step_, view(components_.solids->states()));
    frames_.start();
    if (scene_options_.output.frames) {
      last_frame_ = scheme_->time();
      write_frame();
    }
  } else {
    discard_checkpoints_after(comm_, options_.output_directory, step_);
    tables_.resume(step_);
    observers_.resume(step_, scheme_->time(), last_dt_, finished());
    resume_frames();
    checkpoint_times_.reach(scheme_->time(), last_dt_);
  }
}

/// A frame that came only because the earlier run ended here is none of a run that goes on.
template <int dim>
void Simulation<dim>::resume_frames() {
  const double now = scheme_->time();
  const bool was_due = last_frame_ == never_ || last_frame_ >= now;
  frames_.resume(was_due || finished() ? now : std::nextafter(now, never_));
  reach_frame();
}

template <int dim>
void Simulation<dim>::load_checkpoint() {
  CheckpointReader checkpoint(comm_, options_.restart_file);
  check_same_scene(scene_, files_, checkpoint.header(), options_.restart_file);
  for_each_plug_in(components_, [&](PlugIn& plug_in) { plug_in.load(checkpoint); });
  observers_.load(checkpoint);
  step_ = checkpoint.header().step;
  last_dt_ = checkpoint.file().read_attribute<double>("/", "last dt");
  checkpoint.check(last_dt_ >= 0, fmt::format("its last step is {} s long", last_dt_));
  if (checkpoint.file().has_attribute("/", "last frame"))  // older ones say nothing of it
    last_frame_ = checkpoint.file().read_attribute<double>("/", "last frame");
  checkpoint.check(last_frame_ <= checkpoint.header().time,
                   fmt::format("its last frame is of {} s, after its own time", last_frame_));
  scheme_->resume(checkpoint.header().time, step_, last_dt_);
}

template void Simulation<2>::begin_outputs();
template void Simulation<3>::begin_outputs();
template void Simulation<2>::begin_tables();
template void Simulation<3>::begin_tables();

}  // namespace lockstep
