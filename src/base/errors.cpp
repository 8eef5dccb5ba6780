#include "base/errors.hpp"

#include <cstdio>
#include <cstdlib>

namespace lockstep {

void invariant_failed(const char* expression, const char* file, int line) {
  std::fprintf(stderr,
               "lockstep: invariant violated: %s (%s:%d). This is a defect of the program.\n",
               expression, file, line);
  std::abort();
}

}  // namespace lockstep
