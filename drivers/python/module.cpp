// The compiled part of the Python package `lockstep`: what its class Run (lockstep/run.py) is made
// on. Names, paths and numbers come in as that class has checked them.
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
#include "parameters/suggestion.hpp"

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
  void reset() {
    try {
      (**this).reset();
    } catch (...) {
      run_.reset();  // it may have stopped half-way
      throw;
    }
  }
  void let_go() { run_.reset(); }
  static std::set<Run*>& open_runs() {
    static std::set<Run*> runs;
    return runs;
  }

 private:
  std::unique_ptr<AnyRun> run_;
};

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
    one["orientation"] = body.orientation.size() == 0 ? py::none() : py::cast(body.orientation);
    one["angular_velocity"] = body.angular_velocity;
    one["force"] = body.force;
    one["torque"] = body.torque;
    one["contact_force"] = body.contact_force;
    one["contact_torque"] = body.contact_torque;
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

void define_request(py::module_& module) {
  py::class_<OpenRequest>(module, "OpenRequest")
      .def(py::init<>())
      .def_readwrite("scene", &OpenRequest::scene)
      .def_readwrite("text", &OpenRequest::text)
      .def_readwrite("from_dictionary", &OpenRequest::from_dictionary)
      .def_readwrite("output", &OpenRequest::output)
      .def_readwrite("restart", &OpenRequest::restart)
      .def_readwrite("settings", &OpenRequest::settings)
      .def_readwrite("plug_ins", &OpenRequest::plug_ins)
      .def_readwrite("quiet", &OpenRequest::quiet);
}

/// Columns are names with their units.
bool add_table(const Run& run, const std::string& name,
               const std::vector<std::pair<std::string, std::string>>& columns) {
  std::vector<HistoryColumn> described;
  for (const auto& [column, unit] : columns)
    described.push_back({column, unit, ""});
  return run->add_table(name, described);
}

void define_actions(py::class_<Run>& run) {
  run.def("step", [](const Run& self) { return self->step(); });
  run.def("close", &Run::close);
  run.def("stop", &Run::stop);
  run.def("reset", &Run::reset);
  run.def("add_table", &add_table);
  run.def("append_row", [](const Run& self, const std::string& table,
                           const std::vector<double>& row) { self->append_row(table, row); });
  run.def("set_force",
          [](const Run& self, const std::string& body, const std::vector<double>& force,
             const std::vector<double>& torque) { self->set_force(body, force, torque); });
  run.def("set_target", [](const Run& self, const std::string& joint, const std::vector<double>& q,
                           const std::vector<double>& rate) { self->set_target(joint, q, rate); });
}

void define_views(py::class_<Run>& run) {
  run.def_property_readonly("dimension", [](const Run& self) { return self->dimension(); });
  run.def_property_readonly("time", [](const Run& self) { return self->time(); });
  run.def_property_readonly("time_step", [](const Run& self) { return self->time_step(); });
  run.def_property_readonly("n_steps", [](const Run& self) { return self->n_steps(); });
  run.def("history", [](const Run& self) { return py::dict(py::cast(self->history())); });
  run.def("bodies", &bodies);
  run.def("joints", &joints);
  run.def("grid", [](const Run& self) {
    const GridNumbers grid = self->grid();
    return py::make_tuple(grid.cells, grid.spacing, grid.origin);
  });
  run.def("sample", [](const Run& self, const Eigen::MatrixXd& points) {
    const Samples found = self->sample(points);
    return py::make_tuple(found.in_fluid, found.pressure, found.velocity);
  });
  run.def("fields", &fields);
  run.def("surfaces", &surfaces);
}

}  // namespace

PYBIND11_MODULE(_core, module) {
  module.attr("__version__") = build_information().version;
  begin_and_end_with_python();
  define_errors(module);
  define_request(module);
  module.def("nearest_name", &nearest_name);
  py::class_<Run> run(module, "Run");
  run.def(py::init<const OpenRequest&>());
  define_actions(run);
  define_views(run);
}
