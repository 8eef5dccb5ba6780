#include "output/run_record.hpp"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <nlohmann/json.hpp>

#include "base/errors.hpp"
#include "output/on_root.hpp"

namespace lockstep {

namespace fs = std::filesystem;

void create_output_directory(const Communicator& comm, const std::string& directory) {
  on_root(comm, [&] {
    check_input(!directory.empty(), "The output folder has no name: give one with --output.");
    std::error_code error;
    check_input(!fs::exists(directory, error) || fs::is_directory(directory, error),
                "The output folder '{}' is a file: choose another --output.", directory);
    fs::create_directories(directory, error);
    check_input(!error, "The output folder '{}' cannot be created: {}. Choose another --output.",
                directory, error.message());
    const int reason = access(directory.c_str(), W_OK | X_OK) == 0 ? 0 : errno;
    check_input(reason == 0,
                "The output folder '{}' cannot be written to: {}. Choose another --output.",
                directory, std::strerror(reason));
    const fs::file_status frames = fs::symlink_status(directory + "/frames", error);
    check_input(
        !fs::exists(frames) || fs::is_directory(frames),
        "'{}/frames' is a link or a file, but frames go to a folder of that name, and those of "
        "an earlier run are removed from it: remove it or choose another --output.",
        directory);
  });
}

void record_input(const Communicator& comm, const std::string& directory,
                  const std::string& input_path, const std::string& used_parameters) {
  on_root(comm, [&] {
    const std::string extension = fs::path(input_path).extension().string();
    const bool is_yaml = extension == ".yaml" || extension == ".yml";
    write_file_atomically(directory + (is_yaml ? "/input.yaml" : "/input.xml"),
                          input_path.empty() ? used_parameters : read_whole_file(input_path));
    std::error_code error;  // no earlier run may have written it
    fs::remove(directory + (is_yaml ? "/input.xml" : "/input.yaml"), error);
    write_file_atomically(directory + "/used-parameters.xml", used_parameters);
  });
}

std::string summary_text(const nlohmann::ordered_json& summary) {
  using ErrorHandler = nlohmann::ordered_json::error_handler_t;
  return summary.dump(2, ' ', false, ErrorHandler::replace) + "\n";
}

void write_summary(const Communicator& comm, const std::string& directory,
                   const nlohmann::ordered_json& summary) {
  on_root(comm, [&] { write_file_atomically(directory + "/summary.json", summary_text(summary)); });
}

}  // namespace lockstep
