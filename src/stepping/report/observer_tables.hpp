#pragma once
#include <memory>
#include <string>
#include <vector>

#include "interfaces/registries.hpp"
#include "output/history.hpp"
#include "output/schedule.hpp"

namespace lockstep {

/// Throws InputError for a name of an observer that cannot be that of a file, or is that of another
/// table.
void check_observer_name(const std::string& name);

/// The observers of a scene and their tables, one NAME.csv each in the output folder.
template <int dim>
class ObserverTables {
 public:
  /// `observers`: the validated list "Observers" of a scene. Intervals count from `start_time` [s].
  ObserverTables(const ObserverRegistry<dim>& registry, const ParameterList& observers,
                 const Communicator& comm, const std::string& directory, double start_time);

  /// Throws InputError with all mistakes that observers show when they are made, names that cannot
  /// be those of files and names of other tables among them.
  static void check(const ObserverRegistry<dim>& registry, const ParameterList& observers);

  bool empty() const { return watches_.empty(); }
  bool want_energy() const;  ///< any of them. Local.
  bool want_forces() const;  ///< any of them. Local.
  /// Begins the tables with what is seen before the first step. Collective, like all below.
  void start(long long step, const RunView<dim>& run);
  /// Throws InputError if tables that are there have other columns.
  void check_columns() const;
  /// Continues them after `step`, of dt up to `time` [s]. A run that is not at its end drops looks
  /// that came only because the earlier one ended there.
  void resume(long long step, double time, double dt, bool at_end);
  /// After a step; observers whose interval has not passed yet look away, but at the end.
  void observe(long long step, const RunView<dim>& run, bool at_end);
  void save(CheckpointWriter& checkpoint) const;
  void load(CheckpointReader& checkpoint);
  /// Lets other observers, made from the same lists, look once, so that all that cannot be seen is
  /// told before a run writes anything. Throws InputError.
  static void try_out(const ObserverRegistry<dim>& registry, const ParameterList& observers,
                      const RunView<dim>& run);

 private:
  static constexpr double never = -1e300;
  struct Watch {
    std::string name, type;
    Schedule times;
    double last_time = never;  ///< time of its last look that was due [s]
    std::unique_ptr<Observer<dim>> observer{};
    std::unique_ptr<HistoryTable> table{};
  };
  void look(Watch& watch, long long step, const RunView<dim>& run);

  std::vector<Watch> watches_;
};

}  // namespace lockstep
