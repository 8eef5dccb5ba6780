#pragma once
#include <algorithm>
#include <map>

#include "interfaces/registries.hpp"
#include "parameters/mistakes.hpp"

namespace lockstep {

/// Mistakes of lists that plug-ins make one thing of: all solids of a type, all joints.
class ListMistakes {
 public:
  void add(const std::string& name, const std::vector<std::string>& messages);
  bool empty() const { return found_.empty(); }
  /// Hands them on. Those that differ by the name of their list alone, as of copies, are told once.
  void tell(Mistakes& mistakes) const;

 private:
  struct Found {
    std::string key, message;         ///< without the name of its list, and with it
    std::vector<std::string> others;  ///< names of lists that have it, too
  };
  std::vector<Found> found_;
};

/// Calls build(sound). Where that throws InputError it builds each list alone, notes the mistakes
/// of each, and returns build() of those without; `sound` becomes these. `all_are_here`: false if
/// other ranks have not failed alike, so that nothing more can be built.
template <typename Build, typename AllAreHere>
auto build_sound(NamedLists& sound, const Build& build, const AllAreHere& all_are_here,
                 Mistakes& mistakes) -> decltype(build(sound)) {
  decltype(build(sound)) built{};
  Mistakes together;
  together.collect([&] { built = build(sound); });
  if (together.empty())
    return built;
  if (!all_are_here())
    together.throw_all();
  ListMistakes found;
  const auto is_wrong = [&](const NamedLists::value_type& one) {
    Mistakes alone;
    alone.collect([&] { build(NamedLists{one}); });
    found.add(one.first, alone.messages());
    return !alone.empty();
  };
  sound.erase(std::remove_if(sound.begin(), sound.end(), is_wrong), sound.end());
  if (found.empty()) {
    for (const std::string& message : together.messages())
      mistakes.add(message);
    sound.clear();
  }
  found.tell(mistakes);
  if (!sound.empty())
    mistakes.collect([&] { built = build(sound); });
  return built;
}

}  // namespace lockstep
