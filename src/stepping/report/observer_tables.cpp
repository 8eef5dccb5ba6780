#include "stepping/report/observer_tables.hpp"

#include <algorithm>
#include <cctype>

#include "base/errors.hpp"
#include "output/checkpoint.hpp"
#include "parameters/mistakes.hpp"
#include "parameters/parameter_rule.hpp"

namespace lockstep {
namespace {

std::vector<HistoryColumn> table_columns(const std::vector<ObservedColumn>& observed) {
  std::vector<HistoryColumn> columns = {{"step", "1", "number of the step"},
                                        {"time", "s", "at the end of the step"}};
  for (const ObservedColumn& column : observed)
    columns.push_back({column.name, column.unit, column.description});
  return columns;
}

/// Key of one observer in a checkpoint: two of one type would take the same names, and one of
/// another type is another one.
std::string key_of(const std::string& name, const std::string& type) {
  return type + " " + name;
}
std::string attribute_of(const std::string& key) {
  return "last look of " + key;
}
std::string group_of(const std::string& key) {
  return "observers/" + key;
}

}  // namespace

void check_observer_name(const std::string& name) {
  const auto allowed = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == ' ' || c == '-' || c == '_';
  };
  check_input(std::all_of(name.begin(), name.end(), allowed) && name.size() <= 100,
              "In \"Observers\", \"{}\" cannot be the name of a file; use letters, digits, blanks, "
              "- and _.",
              name.substr(0, 100));
  check_input(name != "history" && name != "bodies" && name != "joints" && name != "lines",
              "In \"Observers\", \"{}\" is the name of a table that runs have; take another.",
              name);
}

template <int dim>
ObserverTables<dim>::ObserverTables(const ObserverRegistry<dim>& registry,
                                    const ParameterList& observers, const Communicator& comm,
                                    const std::string& directory, double start_time) {
  for (const auto& [name, entry] : entries(observers)) {
    const ParameterList& list = observers.sublist(name);
    Watch watch{name, list.get<std::string>("Type"), {start_time, list.get<double>("Interval")}};
    watch.observer = registry.create(watch.type, list);
    watch.table = std::make_unique<HistoryTable>(comm, directory + "/" + name + ".csv",
                                                 table_columns(watch.observer->columns()));
    watches_.push_back(std::move(watch));
  }
}

template <int dim>
void ObserverTables<dim>::check(const ObserverRegistry<dim>& registry,
                                const ParameterList& observers) {
  Mistakes mistakes;
  for (const auto& [name, entry] : entries(observers)) {
    const ParameterList& list = observers.sublist(name);
    mistakes.collect([&, &name = name] { check_observer_name(name); });
    mistakes.collect([&] { registry.create(list.get<std::string>("Type"), list); });
  }
  mistakes.throw_all();
}

template <int dim>
bool ObserverTables<dim>::want_energy() const {
  return std::any_of(watches_.begin(), watches_.end(),
                     [](const Watch& watch) { return watch.observer->wants_energy(); });
}

template <int dim>
bool ObserverTables<dim>::want_forces() const {
  return std::any_of(watches_.begin(), watches_.end(),
                     [](const Watch& watch) { return watch.observer->wants_forces(); });
}

template <int dim>
void ObserverTables<dim>::try_out(const ObserverRegistry<dim>& registry,
                                  const ParameterList& observers, const RunView<dim>& run) {
  Mistakes mistakes;
  for (const auto& [name, entry] : entries(observers)) {
    const ParameterList& list = observers.sublist(name);
    mistakes.collect([&] { registry.create(list.get<std::string>("Type"), list)->observe(run); });
  }
  mistakes.throw_all();
}

template <int dim>
void ObserverTables<dim>::look(Watch& watch, long long step, const RunView<dim>& run) {
  std::vector<std::vector<HistoryValue>> rows;
  for (const std::vector<double>& values : watch.observer->observe(run)) {
    std::vector<HistoryValue> row;
    row.emplace_back(step);
    row.emplace_back(run.time);
    for (const double value : values)
      row.emplace_back(value);
    rows.push_back(std::move(row));
  }
  watch.table->append_rows(rows);
}

template <int dim>
void ObserverTables<dim>::start(long long step, const RunView<dim>& run) {
  for (Watch& watch : watches_) {
    watch.table->start();
    watch.last_time = run.time;
    look(watch, step, run);
  }
}

template <int dim>
void ObserverTables<dim>::check_columns() const {
  for (const Watch& watch : watches_)
    watch.table->check_columns();
}

template <int dim>
void ObserverTables<dim>::resume(long long step, double time, double dt, bool at_end) {
  for (Watch& watch : watches_) {
    const bool was_due = watch.last_time == never || watch.last_time >= time;
    watch.table->resume(was_due || at_end ? step : step - 1);
    watch.times.reach(time, dt);
  }
}

template <int dim>
void ObserverTables<dim>::observe(long long step, const RunView<dim>& run, bool at_end) {
  for (Watch& watch : watches_) {
    watch.observer->follow(run);
    const bool is_due = watch.times.reach(run.time, run.dt) || watch.last_time == never;
    if (is_due)
      watch.last_time = run.time;
    if (is_due || at_end)
      look(watch, step, run);
  }
}

template <int dim>
void ObserverTables<dim>::save(CheckpointWriter& checkpoint) const {
  for (const Watch& watch : watches_) {
    const std::string key = key_of(watch.name, watch.type);
    checkpoint.file().create_group(group_of(key));
    checkpoint.file().enter(group_of(key));
    watch.observer->save(checkpoint);
    checkpoint.file().enter("");
    checkpoint.file().write_attribute("/", attribute_of(key), watch.last_time);
  }
}

template <int dim>
void ObserverTables<dim>::load(CheckpointReader& checkpoint) {
  for (Watch& watch : watches_) {
    const std::string key = key_of(watch.name, watch.type);
    // One that is new looks after the next step.
    if (!checkpoint.file().has_attribute("/", attribute_of(key)))
      continue;
    checkpoint.file().enter(group_of(key));
    watch.observer->load(checkpoint);
    checkpoint.file().enter("");
    watch.last_time = checkpoint.file().read_attribute<double>("/", attribute_of(key));
  }
}

template class ObserverTables<2>;
template class ObserverTables<3>;

}  // namespace lockstep
