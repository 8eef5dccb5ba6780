#pragma once
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "base/errors.hpp"
#include "parameters/parameter_list.hpp"
#include "parameters/suggestion.hpp"

namespace lockstep {

/// Sentence about a plug-in that is none of those that there are, nor misspelt, with a blank before
/// it.
inline const std::string hint_at_libraries =
    " If a library of plug-ins has it, name that by --plug-in FILE (in Python plug_ins), or in a "
    "scene's \"Plug-ins\".";

/// A registry of any kind, for lists of what there is.
class NamedPlugIns {
 public:
  virtual ~NamedPlugIns() = default;
  /// The kind as it appears in messages: "fluid", "solid".
  virtual const std::string& kind() const = 0;
  /// Names and docstrings in order of registration.
  virtual std::vector<std::pair<std::string, std::string>> documented() const = 0;

 protected:
  NamedPlugIns() = default;
  NamedPlugIns(const NamedPlugIns&) = default;
  NamedPlugIns& operator=(const NamedPlugIns&) = default;
};

/// The plug-ins of one kind, chosen by name. Filled by explicit calls of `add` from the program
/// that wants them; nothing registers itself. `Schema` and `Make` are the signatures of the
/// functions that give a plug-in's valid list, and that make it from a list and further arguments.
template <typename Schema, typename Make>
class RegistryOf : public NamedPlugIns {
 public:
  using ValidParameters = std::function<Schema>;
  using Factory = std::function<Make>;
  struct Plugin {
    std::string name;
    std::string documentation;
    ValidParameters valid_parameters;
    Factory factory;
  };

  explicit RegistryOf(std::string kind) : kind_(std::move(kind)) {}

  /// Throws InputError if the name is taken.
  void add(const std::string& name, const std::string& documentation,
           ValidParameters valid_parameters, Factory factory) {
    check_input(!find(name), "The {} \"{}\" is registered twice; give one of the two another name.",
                kind_, name);
    plugins_.push_back({name, documentation, std::move(valid_parameters), std::move(factory)});
  }

  /// Builds the plug-in from its (validated) list. Throws InputError for an unknown name.
  template <typename... Args>
  auto create(const std::string& name, const ParameterList& list, Args&&... args) const {
    return get(name).factory(list, std::forward<Args>(args)...);
  }

  /// The valid list of one plug-in. Throws InputError for an unknown name.
  template <typename... Args>
  ParameterList valid_parameters(const std::string& name, const Args&... args) const {
    return get(name).valid_parameters(args...);
  }

  /// For declare_typed_sublist and declare_named_sublists, whose "Type" is then the plug-in's name.
  template <typename... Args>
  std::vector<TypedSchema> schemas(const Args&... args) const {
    std::vector<TypedSchema> result;
    for (const Plugin& plugin : plugins_)
      result.push_back({plugin.name, plugin.documentation, plugin.valid_parameters(args...), true});
    return result;
  }

  bool contains(const std::string& name) const { return find(name) != nullptr; }
  const std::string& kind() const override { return kind_; }
  std::vector<std::pair<std::string, std::string>> documented() const override {
    std::vector<std::pair<std::string, std::string>> all;
    for (const Plugin& plugin : plugins_)
      all.emplace_back(plugin.name, plugin.documentation);
    return all;
  }
  /// Iterates in order of registration.
  auto begin() const { return plugins_.begin(); }
  auto end() const { return plugins_.end(); }

 private:
  const Plugin* find(const std::string& name) const {
    for (const Plugin& plugin : plugins_) {
      if (plugin.name == name)
        return &plugin;
    }
    return nullptr;
  }

  const Plugin& get(const std::string& name) const {
    if (const Plugin* plugin = find(name))
      return *plugin;
    throw InputError(unknown(name));
  }

  std::string unknown(const std::string& name) const {
    std::vector<std::string> names;
    std::string table;
    for (const Plugin& plugin : plugins_) {
      names.push_back(plugin.name);
      table += fmt::format("\n  {}: {}", plugin.name, plugin.documentation);
    }
    const std::string nearest = nearest_name(name, names);
    return fmt::format(
        "There is no {} \"{}\".{}\nRegistered:{}", kind_, name,
        nearest.empty() ? hint_at_libraries : fmt::format(" Did you mean \"{}\"?", nearest),
        plugins_.empty() ? " none" : table);
  }

  std::string kind_;
  std::vector<Plugin> plugins_;
};

/// A registry of objects whose valid lists depend on nothing. `Args` after the parameters are
/// passed to every factory.
template <typename Base, typename... Args>
using Registry = RegistryOf<ParameterList(), std::unique_ptr<Base>(const ParameterList&, Args...)>;

}  // namespace lockstep
