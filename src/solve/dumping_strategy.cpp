#include "solve/dumping_strategy.hpp"

#include <charconv>
#include <utility>

#include "base/errors.hpp"
#include "solve/system_file.hpp"

namespace lockstep {

DumpRequest parse_dump_request(const std::string& which, const std::string& file) {
  DumpRequest request;
  request.file = file;
  const std::size_t colon = std::min(which.find(':'), which.size());
  const auto [end, error] = std::from_chars(which.data(), which.data() + colon, request.step);
  request.solve = colon < which.size() ? which.substr(colon + 1) : "";
  const bool number = error == std::errc() && end == which.data() + colon && request.step > 0;
  const bool known = request.solve == "S1" || request.solve == "F2" || request.solve == "S2";
  check_input(number && known,
              "\"{}\" names no system; write STEP:S1, STEP:F2 or STEP:S2, as in 1:S2.", which);
  return request;
}

DumpingStrategy::DumpingStrategy(std::unique_ptr<SolverStrategy> strategy,
                                 const DumpRequest& request)
    : strategy_(std::move(strategy)), request_(request) {}

SolveReport DumpingStrategy::solve(const BlockSystem& system, const BlockVector& rhs,
                                   BlockVector& solution, const SolveRequest& request) {
  if (!has_written_ && request.name == request_.solve && request.step == request_.step) {
    write_system(request_.file, system, rhs);
    has_written_ = true;
  }
  return strategy_->solve(system, rhs, solution, request);
}

}  // namespace lockstep
