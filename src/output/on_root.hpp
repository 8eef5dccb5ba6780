#pragma once
#include <exception>
#include <string>

#include "base/communicator.hpp"
#include "base/errors.hpp"
#include "base/library_message.hpp"

namespace lockstep {

/// Collective: runs `action` on rank 0. If it throws there, every rank throws the same Failure;
/// what the standard library throws (file system errors) becomes an OutputError.
template <typename Action>
void on_root(const Communicator& comm, const Action& action) {
  std::string message;
  ExitCode code = ExitCode::output_failed;
  if (is_root(comm)) {
    try {
      action();
    } catch (const Failure& failure) {
      message = failure.what();
      code = failure.exit_code();
    } catch (const std::exception& error) {
      message = library_message(error);
    }
  }
  throw_on_all(comm, message, static_cast<int>(code));
}

}  // namespace lockstep
