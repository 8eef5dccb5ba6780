#pragma once
#include "interfaces/observer.hpp"

namespace lockstep {

/// An observer of your own: how far the first solid has come since the start, and what its motion
/// was worth. It keeps its start in checkpoints, so that a restarted run goes on counting.
class Stroke : public Observer<2> {
 public:
  std::string name() const override { return "stroke"; }
  std::vector<ObservedColumn> columns() const override {
    return {{"stroke", "m", "way of the first solid along x"},
            {"energy", "J/m", "kinetic energy of that solid"}};
  }
  std::vector<std::vector<double>> observe(const RunView<2>& run) override;
  void save(CheckpointWriter& checkpoint) const override;
  void load(const CheckpointReader& checkpoint) override;

 private:
  bool started_ = false;
  double start_ = 0;  ///< [m]
};

}  // namespace lockstep
