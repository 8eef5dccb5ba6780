#pragma once
#include <string>

namespace lockstep {

/// Text for an XML attribute or element: markup and control blanks as references.
std::string xml_escaped(const std::string& text);

}  // namespace lockstep
