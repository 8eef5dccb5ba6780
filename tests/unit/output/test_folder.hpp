#pragma once
#include <Tpetra_Core.hpp>
#include <filesystem>
#include <string>

#include "base/communicator.hpp"

namespace lockstep::test {

/// An empty folder of this test and rank count, below the build folder. Collective.
inline std::string fresh_folder(const std::string& name) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string path =
      std::string(OUTPUT_TEST_FOLDER) + "/" + name + "-" + std::to_string(comm->getSize());
  if (is_root(comm)) {
    std::filesystem::remove_all(path);
    std::filesystem::create_directories(path);
  }
  comm->barrier();
  return path;
}

/// Message of `action` when it throws a Failure of this type; "" if it throws nothing.
template <typename Kind, typename Action>
std::string message_of(const Action& action) {
  try {
    action();
  } catch (const Kind& failure) {
    return failure.what();
  }
  return "";
}

}  // namespace lockstep::test
