#pragma once
#include <memory>
#include <string>

#include "interfaces/strategy.hpp"

namespace lockstep {

/// System to write, and the file for it.
struct DumpRequest {
  long long step = 1;  ///< counted as in history.csv
  std::string solve;   ///< "S1", "F2" or "S2"
  std::string file;
};

/// Reads "12:S2". Throws InputError.
DumpRequest parse_dump_request(const std::string& which, const std::string& file);

/// Stands in front of another strategy, and writes one system with its right-hand side to a file
/// (see system_file.hpp) before handing it on.
class DumpingStrategy : public SolverStrategy {
 public:
  DumpingStrategy(std::unique_ptr<SolverStrategy> strategy, const DumpRequest& request);
  /// True from the solve that was asked for on.
  bool has_written() const { return has_written_; }
  std::string name() const override { return strategy_->name(); }
  void save(CheckpointWriter& checkpoint) const override { strategy_->save(checkpoint); }
  void load(const CheckpointReader& checkpoint) override { strategy_->load(checkpoint); }
  void prepare(const BlockSystem& system) override { strategy_->prepare(system); }
  SolveReport solve(const BlockSystem& system, const BlockVector& rhs, BlockVector& solution,
                    const SolveRequest& request) override;

 private:
  std::unique_ptr<SolverStrategy> strategy_;
  DumpRequest request_;
  bool has_written_ = false;  ///< a step may solve it again, about what it found
};

}  // namespace lockstep
