#include "stepping/report/run_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <sstream>

#include "base/errors.hpp"
#include "interfaces/constraint.hpp"
#include "interfaces/solid.hpp"
#include "interfaces/solid_sides.hpp"
#include "output/atomic_file.hpp"
#include "output/csv_line.hpp"
#include "unit/output/test_folder.hpp"

namespace lockstep::test {
namespace {

using Texts = std::map<std::string, std::string>;  ///< texts of a row, by the name of its column

/// A liquid of which all is reported that there can be.
template <int dim>
struct FullLiquid : LiquidFluid<dim> {
  double surface_distance(const Point<dim>&) const override { return 0; }
  std::vector<WaterLevel> levels_at_solids() const override { return {}; }
  std::vector<double> surface_distances(const std::vector<Point<dim>>& points) const override {
    return std::vector<double>(points.size(), 0);
  }
  LiquidReport report() const override { return {}; }
  bool traps_gas() const override { return true; }
  bool has_drops() const override { return true; }
  std::vector<std::string> watch_names() const override { return {"Cup", "Bowl"}; }
};

/// 1, 2, 3, ... : no two fields get the same.
template <int n>
Eigen::Matrix<double, n, 1> next_vector(double& number) {
  Eigen::Matrix<double, n, 1> vector;
  for (int i = 0; i < n; ++i)
    vector[i] = ++number;
  return vector;
}

SolveReport next_solve(double& number) {
  SolveReport solve;
  solve.iterations = static_cast<int>(++number);
  solve.solid_iterations = static_cast<int>(++number);
  solve.pressure_residual = ++number;
  solve.solid_residual = ++number;
  return solve;
}

template <int dim>
Momentum<dim> next_momentum(double& number) {
  const Point<dim> linear = next_vector<dim>(number);
  return {linear, next_vector<n_rotations<dim>>(number)};
}

LiquidReport next_liquid(double& number) {
  LiquidReport liquid;
  liquid.volume = ++number;
  liquid.target = ++number;
  liquid.shift = ++number;
  liquid.lost = ++number;
  liquid.n_bodies = static_cast<long long>(++number);
  for (int w = 0; w < 2; ++w) {
    const double first = number;
    liquid.watches.push_back({first + 1, first + 2});
    number += 2;
  }
  const double first = number;
  liquid.gas = {static_cast<long long>(first + 1), first + 2, first + 3};
  liquid.drops = {static_cast<long long>(first + 4), first + 5};
  number += 5;
  return liquid;
}

template <int dim>
StepReport<dim> numbered_report() {
  StepReport<dim> report;
  double number = 100;
  for (double* value :
       {&report.time, &report.dt, &report.cfl, &report.viscous_dissipation, &report.viscous_number,
        &report.max_divergence, &report.incompatibility_s1, &report.incompatibility_f2,
        &report.incompatibility_s2, &report.momentum_error, &report.angular_momentum_error,
        &report.fluid_kinetic_energy, &report.solid_kinetic_energy, &report.elastic_energy,
        &report.fluid_volume, &report.stretch_beyond_limit,
        &report.contact_position.deepest_overlap, &report.contact_velocity.deepest_overlap})
    *value = ++number;
  report.viscous_iterations = static_cast<int>(++number);
  report.n_clamped_elements = static_cast<GlobalIndex>(++number);
  report.contact_position.n_contacts = static_cast<int>(++number);
  report.contact_velocity.n_contacts = static_cast<int>(++number);
  report.contact_position.n_solves = static_cast<int>(++number);
  report.contact_velocity.n_solves = static_cast<int>(++number);
  report.contact_position.residual = ++number;
  report.contact_velocity.residual = ++number;
  for (SolveReport* solve : {&report.s1, &report.f2, &report.s2})
    *solve = next_solve(number);
  std::swap(report.f2.pressure_residual, report.f2.solid_residual);  // the larger one counts
  for (Momentum<dim>* momentum : {&report.fluid_momentum, &report.solid_momentum,
                                  &report.boundary_impulse, &report.transport_change})
    *momentum = next_momentum<dim>(number);
  report.lumping_torque_error = next_vector<n_rotations<dim>>(number);
  report.linearisation_impulse = next_vector<n_rotations<dim>>(number);
  report.liquid = next_liquid(number);
  for (int s = 0; s < 2; ++s)
    report.hydrodynamic_impulse.push_back(next_momentum<dim>(number));
  return report;
}

std::string text_of(double value) {
  return fmt::format("{:.17g}", value);
}

template <typename Vector>
void expect_vector(Texts& texts, const std::string& name, const Vector& values) {
  for (int i = 0; i < values.size(); ++i)
    texts[name + axis_names[values.size() == 1 ? 2 : i]] = text_of(values[i]);
}

/// The rows of a table, and that each has all columns.
std::vector<Texts> rows_of(const std::string& path) {
  std::vector<Texts> rows;
  std::vector<std::string> names;
  std::istringstream file(read_whole_file(path));
  for (std::string line; std::getline(file, line);) {
    if (line.front() == '#')
      continue;
    const std::vector<std::string> fields = csv_fields(line);
    if (names.empty()) {
      names = fields;
      continue;
    }
    EXPECT_EQ(fields.size(), names.size());
    Texts row;
    for (std::size_t i = 0; i < names.size(); ++i)
      row[names[i]] = fields.at(i);
    EXPECT_EQ(row.size(), names.size()) << "two columns of one name";
    rows.push_back(row);
  }
  return rows;
}

template <int dim>
Texts expected_history(const StepReport<dim>& report) {
  Texts texts = {{"step", "7"}, {"wall_seconds", "0.5"}};
  const std::vector<std::pair<const char*, double>> numbers = {
      {"time", report.time},
      {"dt", report.dt},
      {"cfl", report.cfl},
      {"s1_iterations", report.s1.iterations},
      {"f2_iterations", report.f2.iterations},
      {"s2_iterations", report.s2.iterations},
      {"viscous_iterations", report.viscous_iterations},
      {"max_divergence", report.max_divergence},
      {"liquid_volume", report.fluid_volume},
      {"solid_iterations", report.s1.solid_iterations + report.s2.solid_iterations},
      {"momentum_error", report.momentum_error},
      {"angular_momentum_error", report.angular_momentum_error},
      {"fluid_kinetic_energy", report.fluid_kinetic_energy},
      {"solid_kinetic_energy", report.solid_kinetic_energy},
      {"elastic_energy", report.elastic_energy},
      {"viscous_dissipation", report.viscous_dissipation},
      {"s1_residual", report.s1.solid_residual},
      {"f2_residual", report.f2.pressure_residual},
      {"s2_residual", report.s2.solid_residual},
      {"incompatibility", report.incompatibility_s2},
      {"f2_incompatibility", report.incompatibility_f2},
      {"contacts", report.contact_position.n_contacts},
      {"deepest_overlap", report.contact_position.deepest_overlap},
      {"contact_solves", report.contact_position.n_solves + report.contact_velocity.n_solves},
      {"contacts_outside", report.contact_position.n_outside + report.contact_velocity.n_outside},
      {"contact_residual", report.contact_velocity.residual},  // the larger one
      {"clamped_elements", double(report.n_clamped_elements)}};
  for (const auto& [name, value] : numbers)
    texts[name] = text_of(value);
  expect_vector(texts, "fluid_momentum_", report.fluid_momentum.linear);
  expect_vector(texts, "solid_momentum_", report.solid_momentum.linear);
  expect_vector(texts, "boundary_impulse_", report.boundary_impulse.linear);
  expect_vector(texts, "transport_change_", report.transport_change.linear);
  expect_vector(texts, "lumping_torque_error_", report.lumping_torque_error);
  expect_vector(texts, "linearisation_impulse_", report.linearisation_impulse);
  return texts;
}

void expect_liquid(Texts& texts, const LiquidReport& liquid) {
  const std::vector<std::pair<const char*, double>> numbers = {
      {"liquid_volume_target", liquid.target},
      {"volume_shift", liquid.shift},
      {"lost_volume", liquid.lost},
      {"liquid_bodies", double(liquid.n_bodies)},
      {"watch_Cup_volume", liquid.watches[0].volume},
      {"watch_Cup_volume_target", liquid.watches[0].target},
      {"watch_Bowl_volume", liquid.watches[1].volume},
      {"watch_Bowl_volume_target", liquid.watches[1].target},
      {"gas_bubbles", double(liquid.gas->n_bubbles)},
      {"gas_volume", liquid.gas->volume},
      {"gas_pressure", liquid.gas->pressure},
      {"drops", double(liquid.drops->n)},
      {"drops_volume", liquid.drops->volume}};
  for (const auto& [name, value] : numbers)
    texts[name] = text_of(value);
}

template <typename Dimension>
struct RunTablesOf : ::testing::Test {
  static constexpr int dimension = Dimension::value;
  Communicator comm = Tpetra::getDefaultComm();
  std::string folder = fresh_folder("tables-" + std::to_string(dimension));
  FullLiquid<dimension> liquid;
  StepReport<dimension> report = numbered_report<dimension>();

  std::vector<Texts> rows(const std::string& name) const {
    comm->barrier();
    std::vector<Texts> rows = rows_of(folder + "/" + name);
    comm->barrier();  // the next test removes the folder
    return rows;
  }
};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(RunTablesOf, Dimensions);

TYPED_TEST(RunTablesOf, HistorySaysOfEachColumnWhatItsNameSays) {
  constexpr int dim = TestFixture::dimension;
  RunTables<dim> tables(this->comm, this->folder, &this->liquid, false, false);
  tables.start();
  tables.append(7, this->report, {}, 0.5);
  Texts expected = expected_history(this->report);
  expect_liquid(expected, *this->report.liquid);
  EXPECT_THAT(this->rows("history.csv"), ::testing::ElementsAre(expected));

  const auto row = tables.history_row(7, this->report, 0.5);
  ASSERT_EQ(row.size(), expected.size());
  EXPECT_EQ(row.front(), std::make_pair(std::string("step"), HistoryValue(7LL)));
  EXPECT_EQ(row.back(), std::make_pair(std::string("drops_volume"),
                                       HistoryValue(this->report.liquid->drops->volume)));
}

TYPED_TEST(RunTablesOf, AFullDomainHasNoColumnsOfALiquid) {
  constexpr int dim = TestFixture::dimension;
  RunTables<dim> tables(this->comm, this->folder, nullptr, false, false);
  tables.start();
  tables.append(7, this->report, {}, 0.5);
  EXPECT_THAT(this->rows("history.csv"), ::testing::ElementsAre(expected_history(this->report)));
}

TYPED_TEST(RunTablesOf, APlaceThatIsNotWatchedIsNan) {
  constexpr int dim = TestFixture::dimension;
  RunTables<dim> tables(this->comm, this->folder, &this->liquid, false, false);
  tables.start();
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  this->report.liquid->watches[1] = {unknown, unknown};
  tables.append(7, this->report, {}, 0.5);
  const std::vector<Texts> rows = this->rows("history.csv");
  for (const char* name : {"watch_Bowl_volume", "watch_Bowl_volume_target"})
    EXPECT_EQ(rows.at(0).at(name), "nan");
}

TYPED_TEST(RunTablesOf, AFluidThatTellsLessThanItSaidIsRefused) {
  constexpr int dim = TestFixture::dimension;
  RunTables<dim> tables(this->comm, this->folder, &this->liquid, false, false);
  tables.start();
  const LiquidReport whole = *this->report.liquid;
  this->report.liquid->watches.pop_back();
  EXPECT_THROW(tables.append(7, this->report, {}, 0.5), OutputError);
  this->report.liquid = whole;
  this->report.liquid->gas.reset();
  EXPECT_THROW(tables.append(7, this->report, {}, 0.5), OutputError);
  this->report.liquid.reset();
  EXPECT_THROW(tables.append(7, this->report, {}, 0.5), OutputError);
}

TYPED_TEST(RunTablesOf, BodiesHaveTheirOwnStatesAndImpulses) {
  constexpr int dim = TestFixture::dimension;
  this->report.dt = 0.5;
  double number = 0;
  std::vector<SolidState<dim>> states(2);
  for (SolidState<dim>& state : states) {
    state.center_of_mass = next_vector<dim>(number);
    state.velocity = next_vector<dim>(number);
    state.angular_velocity = next_vector<n_rotations<dim>>(number);
  }
  states[0].name = "Ball";
  states[1].name = "Disc";
  RunTables<dim> tables(this->comm, this->folder, nullptr, false, false);
  tables.start();
  const auto& of_fluid = this->report.hydrodynamic_impulse;
  this->report.contact_impulse = {of_fluid[1], of_fluid[0]};
  tables.append(7, this->report, states, 0.5);
  const std::vector<Texts> rows = this->rows("bodies.csv");
  ASSERT_EQ(rows.size(), 2u);
  for (int s = 0; s < 2; ++s) {
    Texts expected = {
        {"step", "7"}, {"time", text_of(this->report.time)}, {"name", states[s].name}};
    expect_vector(expected, "", states[s].center_of_mass);
    expect_vector(expected, "v", states[s].velocity);
    expect_vector(expected, "w", states[s].angular_velocity);
    const auto expect_impulse = [&](const std::string& prefix, const Momentum<dim>& impulse) {
      const auto about_origin = cross<dim>(states[s].center_of_mass, impulse.linear);
      expect_vector(expected, prefix + "f", Point<dim>(2 * impulse.linear));
      expect_vector(expected, prefix + "t",
                    AngularVector<dim>(2 * (impulse.angular - about_origin)));
    };
    expect_impulse("", this->report.hydrodynamic_impulse[s]);
    expect_impulse("contact_", this->report.contact_impulse[s]);
    EXPECT_EQ(rows[s], expected);
  }
}

TYPED_TEST(RunTablesOf, LinesSayOfEachColumnWhatItsNameSays) {
  RunTables<TestFixture::dimension> tables(this->comm, this->folder, nullptr, false, true);
  tables.start();
  tables.append_lines(7, this->report, {{"Rope", 1, {2, 3}}});
  EXPECT_THAT(this->rows("lines.csv"),
              ::testing::ElementsAre(Texts{{"step", "7"},
                                           {"time", text_of(this->report.time)},
                                           {"name", "Rope"},
                                           {"span", "1"},
                                           {"first_tension", "2"},
                                           {"second_tension", "3"}}));
}

TYPED_TEST(RunTablesOf, JointsSayOfEachColumnWhatItsNameSays) {
  constexpr int dim = TestFixture::dimension;
  JointState slide{"Sleeve", 2, 1, 2, 3, 4, 5, 6, 8, true, false, false};
  JointState hinge{"Hinge", 0, 11, 12, 13, 14, 15, 16, 18, false, true, true};
  RunTables<dim> tables(this->comm, this->folder, nullptr, true, false);
  tables.start();
  tables.append_joints(7, this->report, {slide, hinge});
  const std::string time = text_of(this->report.time);
  EXPECT_THAT(this->rows("joints.csv"), ::testing::ElementsAre(Texts{{"step", "7"},
                                                                     {"time", time},
                                                                     {"name", "Sleeve 2"},
                                                                     {"q", "1"},
                                                                     {"rate", "2"},
                                                                     {"target", "3"},
                                                                     {"torque", "4"},
                                                                     {"power", "5"},
                                                                     {"limit_torque", "6"},
                                                                     {"gap", "8"},
                                                                     {"two_halves", "1"},
                                                                     {"at_limit", "0"},
                                                                     {"limited", "0"}},
                                                               Texts{{"step", "7"},
                                                                     {"time", time},
                                                                     {"name", "Hinge"},
                                                                     {"q", "11"},
                                                                     {"rate", "12"},
                                                                     {"target", "13"},
                                                                     {"torque", "14"},
                                                                     {"power", "15"},
                                                                     {"limit_torque", "16"},
                                                                     {"gap", "18"},
                                                                     {"two_halves", "0"},
                                                                     {"at_limit", "1"},
                                                                     {"limited", "1"}}));
}

}  // namespace
}  // namespace lockstep::test
