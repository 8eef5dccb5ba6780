#pragma once
#include <string>

#include "parameters/files/strict_xml.hpp"
#include "parameters/validate.hpp"
#include "support/world.hpp"

namespace lockstep::test {

/// <Parameter .../> of the type that the value has in a scene file.
inline std::string number(const std::string& name, const std::string& value) {
  return "<Parameter name=\"" + name + "\" type=\"double\" value=\"" + value + "\"/>";
}
inline std::string numbers(const std::string& name, const std::string& value) {
  return "<Parameter name=\"" + name + "\" type=\"Array(double)\" value=\"{" + value + "}\"/>";
}
inline std::string text(const std::string& name, const std::string& value) {
  return "<Parameter name=\"" + name + "\" type=\"string\" value=\"" + value + "\"/>";
}
inline std::string texts(const std::string& name, const std::string& value) {
  return "<Parameter name=\"" + name + "\" type=\"Array(string)\" value=\"{" + value + "}\"/>";
}
inline std::string list(const std::string& name, const std::string& content) {
  return "<ParameterList name=\"" + name + "\">" + content + "</ParameterList>";
}
inline std::string geometry(const std::string& shape, const std::string& content) {
  return list("Geometry", text("Shape", shape) + content);
}

/// The content of a list as a scene file has it, validated.
inline ParameterList scene_list(const std::string& content, const ParameterList& schema) {
  Document document =
      read_xml_string("<ParameterList>" + content + "</ParameterList>", "scene.xml");
  validate(document, schema);
  return document.list;
}

}  // namespace lockstep::test
