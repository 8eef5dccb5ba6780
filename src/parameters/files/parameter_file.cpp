#include "parameters/files/parameter_file.hpp"

#include <filesystem>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "parameters/files/strict_xml.hpp"
#include "parameters/files/strict_yaml.hpp"

namespace lockstep {

namespace {

/// Reads all bytes of the file; `failure` gets the reason if it cannot be read.
std::string read_bytes(const std::string& file, std::string& failure) {
  std::string why;
  std::string text = read_regular_file(file, why);
  if (text.size() >= (std::size_t{1} << 30))
    why = "it is larger than a parameter file can be";
  if (why.empty())
    return text;
  failure = fmt::format("Cannot read \"{}\": {}. Give the path of {} parameter file.", file, why,
                        parameter_format(file) == "xml" ? "an XML" : "a YAML");
  return "";
}

}  // namespace

std::string parameter_format(const std::string& file) {
  const std::string extension = std::filesystem::path(file).extension().string();
  return extension == ".yaml" || extension == ".yml" ? "yaml" : "xml";
}

Document read_parameters_text(const std::string& text, const std::string& file,
                              FormulaPolicy formulas) {
  return parameter_format(file) == "yaml" ? read_yaml_string(text, file)
                                          : read_xml_string(text, file, formulas);
}

Document read_parameters(const std::string& file, const Communicator& comm,
                         FormulaPolicy formulas) {
  std::string text, failure;
  if (is_root(comm))
    text = read_bytes(file, failure);
  try {
    throw_on_all(comm, failure, static_cast<int>(ExitCode::bad_input));
  } catch (const Failure& error) {
    throw InputError(error.what());
  }
  const MPI_Comm mpi = raw_communicator(comm);
  int size = static_cast<int>(text.size());
  MPI_Bcast(&size, 1, MPI_INT, 0, mpi);
  text.resize(size);
  MPI_Bcast(text.data(), size, MPI_CHAR, 0, mpi);
  return read_parameters_text(text, file, formulas);
}

}  // namespace lockstep
