#pragma once
#include <string>

namespace lockstep {

class CheckpointWriter;
class CheckpointReader;

/// The base of all plug-ins. Parameters are declared where the plug-in is registered (see
/// parameters/registry.hpp); state that must survive a restart goes through `save` and `load`,
/// which a run calls for every one of its plug-ins.
class PlugIn {
 public:
  virtual ~PlugIn() = default;
  /// The name under which it is registered.
  virtual std::string name() const = 0;
  /// Collective. Default: no state.
  virtual void save(CheckpointWriter&) const {}
  virtual void load(const CheckpointReader&) {}

 protected:
  PlugIn() = default;
  PlugIn(const PlugIn&) = default;
  PlugIn& operator=(const PlugIn&) = default;
};

}  // namespace lockstep
