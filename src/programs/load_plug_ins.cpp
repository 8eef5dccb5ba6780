#include "programs/load_plug_ins.hpp"

#include <cxxabi.h>
#include <dlfcn.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

#include "base/errors.hpp"
#include "programs/plug_in_build.hpp"

namespace lockstep {
namespace {

namespace fs = std::filesystem;

/// Lets libraries see what a program offers that is itself a library, as Python's module is: Python
/// keeps what it loads to itself.
void offer_own_functions() {
  Dl_info self;
  if (dladdr(reinterpret_cast<void*>(&offer_own_functions), &self) != 0)
    dlopen(self.dli_fname, RTLD_LAZY | RTLD_NOLOAD | RTLD_GLOBAL);
  dlerror();  // a program itself cannot be loaded, and need not be
}

/// The name of a function as one writes it.
std::string readable(const std::string& symbol) {
  int status = 0;
  char* const text = abi::__cxa_demangle(symbol.c_str(), nullptr, nullptr, &status);
  const std::string name = status == 0 ? text : symbol;
  std::free(text);
  return name;
}

/// The reason for which the system could not load a file, without its path.
std::string reason_of(const std::string& error, const std::string& path) {
  const std::string undefined = "undefined symbol: ";
  const std::size_t at = error.find(undefined);
  if (at != std::string::npos) {
    const std::string symbol = error.substr(at + undefined.size());
    return fmt::format("this program has no {}",
                       readable(symbol.substr(0, symbol.find_first_of(" ,("))));
  }
  const std::string begin = path + ": ";
  return error.rfind(begin, 0) == 0 ? error.substr(begin.size()) : error;
}

void* open_library(const std::string& file) {
  check_input(fs::exists(file), "There is no plug-in '{}'.", file);
  check_input(!fs::is_directory(file), "The plug-in '{}' is a folder; name the library in it.",
              file);
  const std::string path = fs::absolute(file);  // else the system looks among its own libraries
  void* const library = dlopen(path.c_str(), RTLD_NOW | RTLD_LOCAL);
  const char* const error = library ? nullptr : dlerror();
  check_input(library != nullptr, "The plug-in '{}' cannot be loaded: {}.", file,
              error ? reason_of(error, path) : "the system does not say why");
  return library;
}

std::string text_of(const PlugInBuild& build) {
  return fmt::format("Lockstep {}, compiler {}, vectors aligned to {} bytes", build.headers,
                     build.compiler, build.alignment);
}

void check_build(const std::string& file, void* library) {
  const auto* build = static_cast<const PlugInBuild*>(dlsym(library, "lockstep_plug_in_build"));
  check_input(build != nullptr,
              "'{}' is no library of plug-ins: it has no \"lockstep_plug_in_build\"; let "
              "lockstep_add_plug_in of find_package(Lockstep) make it.",
              file);
  const std::string theirs = text_of(*build), ours = text_of(this_build);
  check_input(
      theirs == ours,
      "The plug-in '{}' was built for {}, but this program is {}: build it anew against the "
      "Lockstep that this program comes from.",
      file, theirs, ours);
}

void register_library(const std::string& file, void* library, PlugIns& plug_ins) {
  using Register = decltype(&lockstep_register_plug_ins);
  const auto add = reinterpret_cast<Register>(dlsym(library, "lockstep_register_plug_ins"));
  check_input(add != nullptr,
              "The plug-in '{}' registers nothing: it defines no function extern \"C\" void "
              "lockstep_register_plug_ins(lockstep::PlugIns&).",
              file);
  try {
    add(plug_ins);
  } catch (const std::exception& error) {
    throw InputError(fmt::format("The plug-in '{}' cannot be registered: {}", file, error.what()));
  }
}

void load(const std::string& file, std::vector<void*>& loaded, PlugIns& plug_ins) {
  void* const library = open_library(file);
  if (std::find(loaded.begin(), loaded.end(), library) != loaded.end())
    return;
  loaded.push_back(library);
  check_build(file, library);
  register_library(file, library, plug_ins);
}

}  // namespace

void load_plug_ins(const std::vector<std::string>& files, PlugIns& plug_ins,
                   const Communicator& comm) {
  if (files.empty())
    return;
  std::string failure;
  try {
    offer_own_functions();
    std::vector<void*> loaded;
    for (const std::string& file : files)
      load(file, loaded, plug_ins);
  } catch (const std::exception& error) {
    failure = error.what();
  }
  throw_on_all(comm, failure, static_cast<int>(ExitCode::bad_input));
}

}  // namespace lockstep
