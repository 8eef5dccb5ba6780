#include "any_run.hpp"

#include <Tpetra_Core.hpp>
#include <algorithm>
#include <cmath>
#include <iostream>

#include "base/errors.hpp"
#include "interfaces/fluid_sides.hpp"
#include "output/progress.hpp"
#include "parameters/files/parameter_file.hpp"
#include "parameters/files/strict_xml.hpp"
#include "parameters/files/strict_yaml.hpp"
#include "parameters/strict_values.hpp"
#include "parameters/suggestion.hpp"
#include "programs/open_scene.hpp"
#include "scenes/expand_scene.hpp"
#include "shipped/shipped_plug_ins.hpp"
#include "stepping/report/observer_tables.hpp"
#include "stepping/report/run_columns.hpp"
#include "stepping/scene_file.hpp"
#include "stepping/simulation.hpp"

namespace lockstep {
namespace {

/// A script's division by zero is told where it was, not steps later by a solve.
void check_finite(const std::vector<double>& values, const char* what, const std::string& name) {
  for (const double value : values)
    check_input(std::isfinite(value), "The {} of \"{}\" holds {}, but must be finite.", what, name,
                value);
}

template <typename Vector>
Vector vector_of(const std::vector<double>& values, const char* what, const std::string& name) {
  check_input(static_cast<Eigen::Index>(values.size()) == Vector::SizeAtCompileTime,
              "The {} on \"{}\" has {} components; it takes {}.", what, name, values.size(),
              int(Vector::SizeAtCompileTime));
  check_finite(values, what, name);
  return Eigen::Map<const Vector>(values.data());
}

/// The cells of all ranks, x fastest.
WholeField whole(const BoxFrame& box, const BoxField& field, const Communicator& comm) {
  WholeField result;
  result.unit = field.unit;
  for (int a = box.dimension - 1; a >= 0; --a)
    result.shape.push_back(box.n_cells[a]);
  if (field.n_components > 1)
    result.shape.push_back(field.n_components);
  const std::size_t n = field.n_components;
  const auto row_begin = [&](int y, int z) {
    return n * box.n_cells[0] * (y + std::size_t(box.n_cells[1]) * z);
  };
  result.values.assign(row_begin(0, box.n_cells[2]), 0.0);
  std::vector<double> values;
  for (std::size_t b = 0; b < box.blocks.size(); ++b) {
    const CellBlock& block = box.blocks[b];
    const std::size_t row = n * block.size[0];
    values.resize(row * block.size[1] * block.size[2]);
    field.fill(b, values.data());
    auto from = values.begin();
    for (int z = 0; z < block.size[2]; ++z) {
      for (int y = 0; y < block.size[1]; ++y, from += row) {
        std::copy_n(from, row,
                    result.values.begin() + n * block.lower[0] +
                        row_begin(block.lower[1] + y, block.lower[2] + z));
      }
    }
  }
  constexpr std::size_t at_once = std::size_t{1} << 28;  // MPI counts by int
  for (std::size_t first = 0; first < result.values.size(); first += at_once) {
    const std::size_t n_values = std::min(at_once, result.values.size() - first);
    sum_all(comm, result.values.data() + first, static_cast<int>(n_values));
  }
  return result;
}

/// Returns the sentence about a name that is not among those that there are.
std::string unknown(const char* kind, const std::string& name,
                    const std::vector<std::string>& names) {
  const std::string nearest = nearest_name(name, names);
  return fmt::format("There is no {} \"{}\".{} There are: {}.", kind, name,
                     nearest.empty() ? "" : fmt::format(" Did you mean \"{}\"?", nearest),
                     names.empty() ? "none" : quoted_list(names));
}

Document read_parameters_of(const OpenRequest& request, const Communicator& comm) {
  if (request.text.empty())
    return read_parameters(request.scene, comm, FormulaPolicy::kept);
  if (!request.from_dictionary)
    return read_xml_string(request.text, request.scene, FormulaPolicy::kept);
  Document document = read_yaml_string(request.text, request.scene);
  document.source.places.clear();  // a dictionary has no lines
  return document;
}

Document read_scene(const OpenRequest& request, const Communicator& comm) {
  Document document = read_parameters_of(request, comm);
  document.source.setting = "the setting";
  return document;
}

template <int dim>
class SteppedRun : public AnyRun {
 public:
  SteppedRun(Document document, PlugIns plug_ins, const OpenRequest& request,
             const Communicator& comm)
      : comm_(comm),
        log_(comm, std::cout, request.quiet ? LogLevel::quiet : LogLevel::normal),
        plug_ins_(std::move(plug_ins)) {
    const ParameterList valid =
        scene_parameters<dim>(plug_ins_.of<dim>(), scene_fluid(document, request.settings));
    complete_scene(document, request.settings, valid, comm);
    scene_ = document.list;
    options_.scene_file = request.text.empty() ? request.scene : "";
    options_.output_directory = request.output;
    options_.restart_file = request.restart;
    options_.command_line = "Python";
    reset();
  }

  void reset() override {
    tables_.clear();
    simulation_.reset();  // lets go of the folder
    simulation_ =
        std::make_unique<Simulation<dim>>(plug_ins_.of<dim>(), scene_, options_, comm_, log_);
    simulation_->begin();
  }
  bool step() override { return simulation_->step(); }
  void end() override { simulation_->end(); }
  void stop(const std::string& message) override { simulation_->stop(message); }
  int dimension() const override { return dim; }
  double time() const override { return simulation_->time(); }
  double time_step() const override {
    return simulation_->report() ? simulation_->report()->dt : 0;
  }
  long long n_steps() const override { return simulation_->n_steps(); }
  std::vector<std::pair<std::string, HistoryValue>> history() const override {
    return simulation_->history_row();
  }

  std::vector<BodyNumbers> bodies() const override {
    std::vector<BodyNumbers> all;
    for (const SolidState<dim>& state : solids().states()) {
      BodyNumbers& body = all.emplace_back();
      body.name = state.name;
      body.position = state.center_of_mass;
      body.velocity = state.velocity;
      body.angular_velocity = state.angular_velocity;
      body.mass = state.mass;
      body.volume = state.volume;
      body.kinetic_energy = state.kinetic_energy;
      body.elastic_energy = state.elastic_energy;
      add_forces(all.size() - 1, state.center_of_mass, body);
    }
    for (int m = 0; m < solids().n_models(); ++m)
      add_orientations(solids().model(m), all);
    return all;
  }

  std::vector<JointState> joints() const override {
    const ConstraintModel* joints = solids().joints();
    return joints ? joints->states(time()) : std::vector<JointState>();
  }

  void set_force(const std::string& body, const std::vector<double>& force,
                 const std::vector<double>& torque) override {
    const auto total = vector_of<Point<dim>>(force, "force", body);
    const auto turning = vector_of<AngularVector<dim>>(torque, "torque", body);
    for (int m = 0; m < solids().n_models(); ++m) {
      const auto& described = solids().model(m).solids();
      for (std::size_t s = 0; s < described.size(); ++s) {
        if (described[s].name != body)
          continue;
        const bool is_pushed = solids().model(m).set_load(static_cast<int>(s), total, turning);
        return check_input(is_pushed, "\"{}\" is no rigid body; only those take forces here.",
                           body);
      }
    }
    std::vector<std::string> names;
    for (const SolidState<dim>& state : solids().states())
      names.push_back(state.name);
    throw InputError(unknown("solid", body, names));
  }

  void set_target(const std::string& joint, const std::vector<double>& q,
                  const std::vector<double>& rate) override {
    ConstraintModel* joints = solids().joints();
    check_input(joints != nullptr, "The scene has no joints, so none that is called \"{}\".",
                joint);
    check_finite(q, "target", joint);
    check_finite(rate, "rate", joint);
    joints->set_target(joint, time(), q, rate);
  }

  bool add_table(const std::string& name, const std::vector<HistoryColumn>& columns) override {
    check_observer_name(name);
    check_input(tables_.count(name) == 0 && !scene_.sublist("Observers").isParameter(name),
                "There is an observer \"{}\" already; give this one another name.", name);
    std::vector<HistoryColumn> all = {{"step", "1", "number of the step"},
                                      {"time", "s", "at the end of the step"}};
    all.insert(all.end(), columns.begin(), columns.end());
    auto table =
        std::make_unique<HistoryTable>(comm_, options_.output_directory + "/" + name + ".csv", all);
    const bool goes_on = !options_.restart_file.empty() && !simulation_->report();
    if (goes_on)
      table->resume(n_steps());
    else
      table->start();
    tables_[name] = std::move(table);
    return !goes_on;
  }
  void append_row(const std::string& table, const std::vector<double>& values) override {
    std::vector<HistoryValue> row = {n_steps(), time()};
    row.insert(row.end(), values.begin(), values.end());
    tables_.at(table)->append_row(row);
  }

  GridNumbers grid() const override {
    std::vector<BoxFrame> boxes;
    if (const auto* output = simulation_->components().fluid->output())
      output->add_frame(boxes);
    check_input(!boxes.empty(), "This fluid has no box of cells.");
    const BoxFrame& box = boxes.front();
    return {{box.n_cells.begin(), box.n_cells.begin() + dim},
            {box.spacing.begin(), box.spacing.begin() + dim},
            {box.origin.begin(), box.origin.begin() + dim}};
  }

  Samples sample(const Eigen::MatrixXd& points) const override {
    check_input(points.cols() == dim, "Points have {} coordinates; the scene has {} dimensions.",
                points.cols(), dim);
    const auto* output = simulation_->components().fluid->output();
    check_input(output != nullptr, "This fluid cannot be asked at points.");
    std::vector<Point<dim>> places(points.rows());
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      places[i] = points.row(i);
      check_in_domain(places[i]);
    }
    const std::vector<FluidSample<dim>> found = output->sample(places);
    Samples samples;
    samples.in_fluid.resize(points.rows());
    samples.pressure.resize(points.rows());
    samples.velocity.resize(points.rows(), dim);
    for (Eigen::Index i = 0; i < points.rows(); ++i) {
      samples.in_fluid[i] = found[i].in_fluid;
      samples.pressure[i] = found[i].pressure;
      samples.velocity.row(i) = found[i].velocity;
    }
    return samples;
  }

  std::map<std::string, WholeField> fields() const override {
    std::map<std::string, WholeField> all;
    for (const BoxFrame& box : simulation_->frame().boxes)
      for (const BoxField& field : box.fields)
        all[field.name] = whole(box, field, comm_);
    return all;
  }
  std::vector<SurfaceFrame> surfaces() const override { return simulation_->frame().meshes; }

 private:
  /// Points beyond periodic sides are those that they repeat.
  void check_in_domain(const Point<dim>& x) const {
    constexpr double round_off = 1e-9;  // part of the domain
    const FluidDiscretization<dim>& fluid = *simulation_->components().fluid;
    const Box<dim> domain = fluid.bounds();
    const std::array<bool, dim> periodic = fluid.periodic_axes();
    for (int a = 0; a < dim; ++a) {
      const double beyond = std::max(x[a] - domain.max()[a], domain.min()[a] - x[a]);
      check_input(periodic[a] || beyond <= round_off * domain.sizes()[a],
                  "The point ({}) is outside of the domain, which goes from ({}) to ({}) m.",
                  fmt::join(x.begin(), x.end(), ", "),
                  fmt::join(domain.min().begin(), domain.min().end(), ", "),
                  fmt::join(domain.max().begin(), domain.max().end(), ", "));
    }
  }

  SolidSystem<dim>& solids() const { return *simulation_->components().solids; }

  /// Zero before the first step. `number`: in the order of the states.
  void add_forces(std::size_t number, const Point<dim>& center, BodyNumbers& body) const {
    MeanForce<dim> fluid, contact;
    if (const StepReport<dim>* report = simulation_->report()) {
      fluid = mean_force<dim>(report->hydrodynamic_impulse[number], center, report->dt);
      if (!report->contact_impulse.empty())
        contact = mean_force<dim>(report->contact_impulse[number], center, report->dt);
    }
    body.force = fluid.force;
    body.torque = fluid.torque;
    body.contact_force = contact.force;
    body.contact_torque = contact.torque;
  }

  static void add_orientations(const SolidModel<dim>& model, std::vector<BodyNumbers>& bodies) {
    const JointableSolids<dim>* rigid = model.jointable();
    for (std::size_t s = 0; rigid && s < model.solids().size(); ++s) {
      for (BodyNumbers& body : bodies) {
        if (body.name == model.solids()[s].name)
          body.orientation = rigid->rigid_frame(static_cast<int>(s)).orientation.toRotationMatrix();
      }
    }
  }

  Communicator comm_;
  Log log_;
  PlugIns plug_ins_;
  ParameterList scene_;  ///< complete and checked
  RunOptions options_;
  std::unique_ptr<Simulation<dim>> simulation_;
  std::map<std::string, std::unique_ptr<HistoryTable>> tables_;
};

}  // namespace

std::unique_ptr<AnyRun> open_run(OpenRequest request) {
  const Communicator comm = Tpetra::getDefaultComm();
  PlugIns plug_ins = shipped_plug_ins();
  Document document =
      open_scene(read_scene(request, comm), request.plug_ins, request.settings, plug_ins, comm);
  if (scene_dimension(document) == 2)
    return std::make_unique<SteppedRun<2>>(std::move(document), std::move(plug_ins), request, comm);
  return std::make_unique<SteppedRun<3>>(std::move(document), std::move(plug_ins), request, comm);
}

}  // namespace lockstep
