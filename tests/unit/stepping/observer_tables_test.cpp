#include "stepping/report/observer_tables.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "base/errors.hpp"
#include "output/checkpoint.hpp"
#include "support/coupled_case.hpp"
#include "unit/output/test_folder.hpp"

namespace lockstep::test {
namespace {

using ::testing::ElementsAre;

std::vector<double> seen;

/// Counts its looks, from a number of its own on; none before the time 1 s.
class Counter : public Observer<2> {
 public:
  explicit Counter(double first) : count_(first) {}
  std::string name() const override { return "counter"; }
  std::vector<ObservedColumn> columns() const override { return {{"count", "1", "of looks"}}; }
  std::vector<std::vector<double>> observe(const RunView<2>& run) override {
    check_input(run.time >= 1, "Too early.");
    seen.push_back(++count_);
    return {{count_}};
  }
  void save(CheckpointWriter& checkpoint) const override {
    checkpoint.file().write_attribute("/", "count", count_);
    checkpoint.file().write_replicated<double>("counts", {count_, -count_});
    checkpoint.write_distributed<long long>("numbers", {}, {});
  }
  void load(const CheckpointReader& checkpoint) override {
    count_ = checkpoint.file().read_attribute<double>("/", "count");
    EXPECT_THAT(checkpoint.file().read_all<double>("/counts"), ElementsAre(count_, -count_));
    EXPECT_TRUE(checkpoint.file().exists("numbers/ids"));
    EXPECT_EQ(checkpoint.file().names("/").size(), 2u);
  }

 private:
  double count_;
};

ObserverRegistry<2> registry() {
  ObserverRegistry<2> observers("observer");
  observers.add(
      "counter", "Counts.", [] { return ParameterList(); },
      [](const ParameterList& list) {
        return std::make_unique<Counter>(list.get<double>("First"));
      });
  return observers;
}

/// Two of one type.
ParameterList counters() {
  ParameterList lists;
  for (const auto& [name, first] : {std::pair("low", 10.), std::pair("high", 20.)}) {
    ParameterList& list = lists.sublist(name);
    list.set("Type", std::string("counter"));
    list.set("Interval", 0.);
    list.set("First", first);
  }
  return lists;
}

TEST(ObserverTables, TwoOfOneTypeKeepTheirOwnState) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("observers");
  const FakeFluid<2> fluid({{2, 2}, 0.5}, comm);
  const std::vector<SolidState<2>> solids;
  ObserverTables<2> tables(registry(), counters(), comm, folder, 1);
  tables.start(0, {1, 0, fluid, solids});
  seen.clear();
  tables.observe(1, {2, 1, fluid, solids}, false);
  EXPECT_THAT(seen, ElementsAre(12, 22));
  CheckpointWriter writer(comm, folder, {1, 2, "<ParameterList/>"});
  tables.save(writer);
  writer.file().write_attribute("/", "count", -1.);  // at its top, as a run does
  writer.finish(1);

  ObserverTables<2> resumed(registry(), counters(), comm, folder, 1);
  CheckpointReader reader(comm, folder + "/checkpoint-000001.h5");
  resumed.load(reader);
  EXPECT_EQ(reader.file().read_attribute<double>("/", "count"), -1);
  resumed.resume(1, 2, 1, false);
  seen.clear();
  resumed.observe(2, {3, 1, fluid, solids}, false);
  EXPECT_THAT(seen, ElementsAre(13, 23));
}

TEST(ObserverTables, ATrialLookTellsWhatCannotBeSeen) {
  const FakeFluid<2> fluid({{2, 2}, 0.5}, Tpetra::getDefaultComm());
  const std::vector<SolidState<2>> solids;
  ObserverTables<2>::try_out(registry(), counters(), {1, 0, fluid, solids});
  EXPECT_THROW(ObserverTables<2>::try_out(registry(), counters(), {0, 0, fluid, solids}),
               InputError);
}

}  // namespace
}  // namespace lockstep::test
