#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Teuchos_DefaultComm.hpp>
#include <string>

#include "base/communicator.hpp"
#include "base/errors.hpp"

namespace lockstep::test {

inline Communicator world() {
  return Teuchos::DefaultComm<int>::getComm();
}

/// The message of the InputError that `action` throws, or "".
template <typename Action>
std::string error(const Action& action) {
  try {
    action();
  } catch (const InputError& failure) {
    return failure.what();
  }
  return "";
}

}  // namespace lockstep::test
