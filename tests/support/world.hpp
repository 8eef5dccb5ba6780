#pragma once
#include <Teuchos_DefaultComm.hpp>

#include "base/communicator.hpp"

namespace lockstep::test {

/// All ranks of the test.
inline Communicator world() {
  return Teuchos::DefaultComm<int>::getComm();
}

}  // namespace lockstep::test
