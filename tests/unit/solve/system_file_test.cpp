// A system written and read again is the same operator, however its rows are spread.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <cstdio>

#include "base/errors.hpp"
#include "conformance/saddle_problem.hpp"
#include "output/hdf5_file.hpp"
#include "solve/block_residual.hpp"
#include "solve/dumping_strategy.hpp"
#include "solve/system_file.hpp"

namespace lockstep::test {

namespace {

/// Norms that identify A, B and C together: residuals of an exact guess for all-ones.
struct Fingerprint {
  double pressure, solid, rhs;
};

Fingerprint fingerprint(const BlockSystem& system, const BlockVector& rhs) {
  BlockVector ones{make_vector(rhs.pressure->getMap()), Teuchos::null};
  for (int i = 0; i < static_cast<int>(ones.pressure->getLocalLength()); ++i) {
    const double id = static_cast<double>(ones.pressure->getMap()->getGlobalElement(i));
    ones.pressure->replaceLocalValue(i, std::sin(id));
  }
  if (!rhs.solid.is_null()) {
    ones.solid = make_vector(rhs.solid->getMap());
    for (int i = 0; i < static_cast<int>(ones.solid->getLocalLength()); ++i) {
      const GlobalIndex id = ones.solid->getMap()->getGlobalElement(i);
      ones.solid->replaceLocalValue(i, id < 6 ? std::cos(static_cast<double>(id)) : 0.0);
    }
  }
  const BlockResidual residual = block_residual(system, rhs, ones);
  return {residual.pressure, residual.solid, rhs.pressure->norm2()};
}

}  // namespace

TEST(SystemFile, ReadsBackTheSameSystem) {
  const Communicator comm = Tpetra::getDefaultComm();
  for (const bool with_solid : {true, false}) {
    SaddleOptions options;
    options.open_top = false;
    options.with_solid = with_solid;
    const SaddleProblem problem(comm, options);
    const BlockVector rhs = problem.random_rhs();
    const std::string file = "system-file-test.h5";
    write_system(file, problem.system, rhs);
    const StoredSystem stored = read_system(file, comm);
    const Fingerprint before = fingerprint(problem.system, rhs);
    const Fingerprint after = fingerprint(stored.system, stored.rhs);
    EXPECT_NEAR(after.pressure, before.pressure, 1e-12 * before.pressure);
    EXPECT_NEAR(after.solid, before.solid, 1e-12 * before.solid);
    EXPECT_NEAR(after.rhs, before.rhs, 1e-14 * before.rhs);
    EXPECT_EQ(stored.system.null_space.size(), problem.system.null_space.size());
    EXPECT_NEAR(stored.system.null_space.vector(0)->norm2(), 1, 1e-12);
    EXPECT_EQ(stored.system.name, problem.system.name);
    EXPECT_EQ(stored.system.has_solid(), with_solid);
    comm->barrier();
    if (is_root(comm))
      std::remove(file.c_str());
    comm->barrier();
  }
}

namespace {

struct NoStrategy : SolverStrategy {
  std::string name() const override { return "none"; }
  void prepare(const BlockSystem&) override {}
  SolveReport solve(const BlockSystem&, const BlockVector&, BlockVector&,
                    const SolveRequest&) override {
    return {};
  }
};

}  // namespace

TEST(SystemFile, OneSolveOfOneStepIsWritten) {
  const Communicator comm = Tpetra::getDefaultComm();
  const SaddleProblem problem(comm, {});
  const std::string file = "system-file-dump.h5";
  DumpingStrategy strategy(std::make_unique<NoStrategy>(), parse_dump_request("2:S2", file));
  double norm = 0;
  for (int step = 1; step <= 3; ++step) {
    for (const char* name : {"S1", "S2"}) {
      BlockVector rhs = problem.random_rhs(), solution = problem.zero();
      rhs.pressure->scale(step + (name[1] == '2' ? 10 : 0));
      if (step == 2 && name[1] == '2')
        norm = rhs.pressure->norm2();
      SolveRequest request{name, 1e-8};
      request.step = step;
      strategy.solve(problem.system, rhs, solution, request);
    }
  }
  EXPECT_NEAR(read_system(file, comm).rhs.pressure->norm2(), norm, 1e-12 * norm);
  for (const char* wrong : {"", "S2", "0:S2", "1:S3", "x:S1", "2 :S2"})
    EXPECT_THROW(parse_dump_request(wrong, file), InputError) << wrong;
  comm->barrier();
  if (is_root(comm))
    std::remove(file.c_str());
  comm->barrier();
}

TEST(SystemFile, RefusesOtherFiles) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string file = "system-file-other.h5";
  Hdf5File other = Hdf5File::create(comm, file);
  other.write_attribute<long long>("/", "number", 1);
  other.close();
  EXPECT_THROW(read_system(file, comm), InputError);
  EXPECT_THROW(read_system("no-such-file.h5", comm), InputError);
  comm->barrier();
  if (is_root(comm))
    std::remove(file.c_str());
}

}  // namespace lockstep::test
