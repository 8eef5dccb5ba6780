// The Python module `lockstep`: a run of a scene that a script steps, reads and steers.
#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <Tpetra_Core.hpp>
#include <set>

#include "any_run.hpp"
#include "base/errors.hpp"
#include "base/lone_process.hpp"
#include "base/memory.hpp"
#include "output/provenance/build_information.hpp"

namespace py = pybind11;
using namespace lockstep;

namespace {

/// A run that a script holds; those that are open when Python ends are let go before MPI ends.
class Run {
 public:
  explicit Run(const OpenRequest& request) : run_(open_run(request)) { open_runs().insert(this); }
  ~Run() { open_runs().erase(this); }
  Run(const Run&) = delete;
  Run& operator=(const Run&) = delete;

  AnyRun& operator*() const {
    check_input(run_ != nullptr, "This run is closed.");
    return *run_;
  }
  AnyRun* operator->() const { return &**this; }
  void close() {
    if (run_)
      run_->end();
    run_.reset();
  }
  void stop(const std::string& message) {
    const std::unique_ptr<AnyRun> run = std::move(run_);  // let go whatever happens
    if (run)
      run->stop(message);
  }
  void let_go() { run_.reset(); }
  static std::set<Run*>& open_runs() {
    static std::set<Run*> runs;
    return runs;
  }

 private:
  std::unique_ptr<AnyRun> run_;
};

std::string text_of(const py::object& text) {
  return text.cast<std::string>();
}

/// Returns the path in a str, bytes, or object that the standard library takes for a path.
std::string path_text(const py::object& path) {
  return text_of(py::module_::import("os").attr("fsdecode")(path));
}

/// Numpy's numbers and arrays without an axis as Python's; anything else as it is.
py::object plain(const py::handle& value) {
  if (py::hasattr(value, "ndim") && py::object(value.attr("ndim")).equal(py::int_(0)))
    return value.attr("item")();
  return py::reinterpret_borrow<py::object>(value);
}

/// Returns the value as `--set` would write it.
std::string setting_text(const py::handle& given) {
  const py::object value = plain(given);
  if (py::isinstance<py::bool_>(value))
    return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::str>(value) || !py::isinstance<py::sequence>(value))
    return text_of(py::str(value));
  std::string text = "{";
  for (const py::handle& entry : value)
    text += (text.size() > 1 ? ", " : "") + setting_text(entry);
  return text + "}";
}

std::unique_ptr<Run> open(const py::object& scene, const py::object& output,
                          const py::dict& settings, const py::object& restart, bool quiet,
                          const py::list& plug_ins) {
  OpenRequest request{path_text(scene), path_text(output), path_text(restart), {}, {}, quiet};
  for (const py::handle& library : plug_ins)
    request.plug_ins.push_back(path_text(py::reinterpret_borrow<py::object>(library)));
  for (const auto& [name, value] : settings)
    request.settings.push_back(text_of(py::str(name)) + "=" + setting_text(value));
  return std::make_unique<Run>(request);
}

/// One number or several, of Python's kinds or of numpy's.
std::vector<double> numbers(const py::object& given) {
  const py::object value = plain(given);
  try {
    if (PyNumber_Check(value.ptr()) != 0 && !py::isinstance<py::sequence>(value) &&
        !py::isinstance<py::array>(value))
      return {py::float_(value).cast<double>()};
    return value.cast<std::vector<double>>();
  } catch (const std::exception&) {
    throw InputError(text_of(py::str(value)) + " is neither a number nor a list of numbers.");
  }
}

template <typename Vector>
py::array array_of(std::vector<py::ssize_t> shape, const Vector& values) {
  return py::array_t<typename Vector::value_type>(std::move(shape), values.data());
}

py::dict bodies(const Run& run) {
  py::dict all;
  for (const BodyNumbers& body : run->bodies()) {
    py::dict one;
    one["position"] = body.position;
    one["velocity"] = body.velocity;
    one["angular_velocity"] = body.angular_velocity;
    one["mass"] = body.mass;
    one["volume"] = body.volume;
    one["kinetic_energy"] = body.kinetic_energy;
    one["elastic_energy"] = body.elastic_energy;
    all[py::str(body.name)] = one;
  }
  return all;
}

py::dict joints(const Run& run) {
  py::dict all;
  for (const JointState& joint : run->joints()) {
    if (!all.contains(joint.name))
      all[py::str(joint.name)] = py::list();
    py::dict one;
    one["q"] = joint.q;
    one["rate"] = joint.rate;
    one["target"] = joint.target;
    one["torque"] = joint.torque;
    one["power"] = joint.power;
    one["limit_torque"] = joint.limit_torque;
    one["gap"] = joint.gap;
    one["at_limit"] = joint.at_limit;
    all[py::str(joint.name)].cast<py::list>().append(one);
  }
  return all;
}

py::dict fields(const Run& run) {
  py::dict all;
  for (const auto& [name, field] : run->fields())
    all[py::str(name)] = array_of({field.shape.begin(), field.shape.end()}, field.values);
  return all;
}

py::dict surfaces(const Run& run) {
  py::dict all;
  for (const SurfaceFrame& surface : run->surfaces()) {
    const py::ssize_t dimension = surface.dimension, size = surface.simplex_size;
    const auto n_vertices = static_cast<py::ssize_t>(surface.vertices.size()) / dimension;
    const auto n_simplices = static_cast<py::ssize_t>(surface.simplices.size()) / size;
    all[py::str(surface.name)] = py::make_tuple(array_of({n_vertices, dimension}, surface.vertices),
                                                array_of({n_simplices, size}, surface.simplices));
  }
  return all;
}

/// MPI and Kokkos live from here to the end of Python; if mpi4py began MPI, it ends it.
void begin_and_end_with_python() {
  keep_freed_memory();
  expect_no_other_ranks();
  try {
    py::module_::import("mpi4py.MPI");
  } catch (const py::error_already_set& error) {
    if (!error.matches(PyExc_ImportError))
      throw;
  }
  static int argc = 0;
  static char** argv = nullptr;
  Tpetra::initialize(&argc, &argv);
  py::module_::import("atexit").attr("register")(py::cpp_function([] {
    for (Run* run : Run::open_runs())
      run->let_go();
    Tpetra::finalize();
  }));
}

void define_errors(py::module_& module) {
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError);
  py::register_exception<SolveError>(module, "SolveError", PyExc_ArithmeticError);
  py::register_exception<OutputError>(module, "OutputError", PyExc_OSError);
}

void define_run(py::module_& module) {
  using py::arg;
  py::class_<Run> run(module, "Run", R"(A run of a scene file, to be stepped.

All members are collective on several ranks: every rank calls them with the same arguments.)");
  run.def(py::init(&open), arg("scene"), arg("output") = "output", arg("settings") = py::dict(),
          arg("restart") = "", arg("quiet") = true, arg("plug_ins") = py::list(),
          R"(Opens a scene and writes its start.

scene: the file, a text or a pathlib.Path, as the other two. output: the folder for frames, tables and checkpoints. settings: what `simulate --set`
takes, as {"Time/End": 2.0, "Domain/Cells": (64, 64)}. restart: a checkpoint to go on from; forces and
targets set from here are not in it. quiet: no line a step. plug_ins: libraries of plug-ins to load,
beside those that the scene names. Raises InputError, a ValueError.)");
  run.def(
      "step", [](const Run& self) { return self->step(); },
      "Takes one step. False, and no step, at the end of the scene. Raises SolveError, an "
      "ArithmeticError, and OutputError, an OSError.");
  run.def(
      "close", [](Run& self) { self.close(); },
      "Writes the last checkpoint and summary.json. `with Run(...) as run:` does so by itself; "
      "after an exception it does so on one rank, and on several writes summary.json alone.");
  run.def(
      "__enter__", [](Run& self) -> Run& { return self; }, py::return_value_policy::reference);
  run.def("__exit__",
          [](Run& self, const py::object& type, const py::object& value, const py::object&) {
            if (type.is_none())
              return self.close();
            self.stop(text_of(type.attr("__name__")) + ": " + text_of(py::str(value)));
          });
  run.def_property_readonly(
      "dimension", [](const Run& self) { return self->dimension(); }, "2 or 3.");
  run.def_property_readonly(
      "time", [](const Run& self) { return self->time(); }, "Time of the present state [s].");
  run.def_property_readonly(
      "n_steps", [](const Run& self) { return self->n_steps(); },
      "Steps taken, those before a restart too.");
  run.def_property_readonly(
      "history", [](const Run& self) { return py::dict(py::cast(self->history())); },
      "The last step's row of history.csv by column: momentum_error, s2_iterations, ... Empty "
      "before the first step.");
  run.def("bodies", &bodies,
          "By name: position (centre of mass) [m], velocity [m/s], angular_velocity [rad/s], mass "
          "[kg] (0: prescribed), volume [m^d], kinetic_energy and elastic_energy [J].");
  run.def("joints", &joints,
          "By name a list of coordinates: q [rad, m], rate, target (at the present time), torque "
          "[N m, N], power [W], limit_torque, gap, at_limit; see joints.csv. Torques and power are "
          "those of the last step, 0 before the first one.");
  run.def(
      "set_force",
      [](const Run& self, const std::string& body, const py::object& force,
         const py::object& torque) {
        std::vector<double> turning = numbers(torque);
        if (turning.size() == 1 && self->dimension() == 3 && turning[0] == 0)
          turning.assign(3, 0.0);
        self->set_force(body, numbers(force), turning);
      },
      arg("body"), arg("force"), arg("torque") = 0.,
      "From the next step on, until set again: a force [N] at the centre of mass of a rigid body "
      "and a torque [N m] about it, instead of the scene's. The ledger counts both.");
  run.def(
      "set_target",
      [](const Run& self, const std::string& joint, const py::object& q, const py::object& rate) {
        const std::vector<double> place = numbers(q);
        std::vector<double> speed = numbers(rate);
        if (speed.size() == 1 && speed[0] == 0)
          speed.assign(place.size(), 0.0);
        self->set_target(joint, place, speed);
      },
      arg("joint"), arg("q"), arg("rate") = 0.,
      "From the next step on, until set again: the target of a joint under control, q [rad, m] now "
      "and moving with `rate`; a number, or one for each coordinate. \"NAME 2\" is the second "
      "coordinate of the joint NAME alone, if it is not that of a ball.");
  run.def(
      "sample",
      [](const Run& self, const Eigen::MatrixXd& points) {
        const Samples found = self->sample(points);
        return py::make_tuple(found.in_fluid, found.pressure, found.velocity);
      },
      arg("points"),
      "The fluid at points, an array of a row each [m]: whether it is there, its pressure [Pa] and "
      "its velocity [m/s].");
  run.def("fields", &fields,
          "All fields of a frame by name, on the cells of the whole box: arrays [z][y][x] (2D: "
          "[y][x]), vectors with their components last.");
  run.def("surfaces", &surfaces,
          "Solids and water by name: vertices [m], a row each, and simplices, rows of numbers of "
          "vertices. Those of rank 0 are whole.");
}

}  // namespace

PYBIND11_MODULE(lockstep, module) {
  module.doc() = "Monolithic two-way coupling of incompressible fluids to solids and shells.";
  module.attr("__version__") = build_information().version;
  begin_and_end_with_python();
  define_errors(module);
  define_run(module);
}
