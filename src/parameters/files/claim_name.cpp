#include "parameters/files/claim_name.hpp"

#include "base/errors.hpp"
#include "base/shortened.hpp"

namespace lockstep {

std::string claim_name(Document& document, const ParameterList& list, const std::string& list_path,
                       const std::string& name, const std::string& place) {
  constexpr std::size_t longest_name = 1000;
  check_input(name.size() <= longest_name,
              "{}, the name \"{}\" has {} characters; at most {} are accepted: shorten it.",
              in_list(list_path), shortened(name), name.size(), longest_name);
  const std::string path = join_path(list_path, name);
  check_input(!list.isParameter(name),
              "{}, \"{}\" is given twice, first in {}. Remove one of the two.", in_list(list_path),
              name, document.source.place(path));
  document.source.places[path] = place;
  return path;
}

}  // namespace lockstep
