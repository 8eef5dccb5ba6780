#pragma once
#include <fmt/format.h>

#include <string>
#include <vector>

namespace lockstep {

/// Promises of an interface that a plug-in broke, one sentence each; empty if it kept all.
using Violations = std::vector<std::string>;

/// Notes the promise as broken unless |value| <= bound.
inline void expect_small(Violations& found, double value, double bound,
                         const std::string& promise) {
  if (!(std::abs(value) <= bound))
    found.push_back(fmt::format("{}: {:.3g}, at most {:.3g}", promise, value, bound));
}
inline void expect_true(Violations& found, bool holds, const std::string& promise) {
  if (!holds)
    found.push_back(promise);
}

}  // namespace lockstep
