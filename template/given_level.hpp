#pragma once
#include "liquid/common/interface_model.hpp"

namespace lockstep {

/// An interface of your own: the surface of the liquid is flat and at a height that is given, for
/// whoever wants the pressure under a surface that something else has found.
class GivenLevel : public InterfaceModel<2> {
 public:
  struct Options {
    double height = 0;  ///< at the start of the run [m]
    double speed = 0;   ///< at which it rises [m/s]
  };

  GivenLevel(const Options& options, const MacDomain<2>& domain);

  std::string name() const override { return "given level"; }
  void save(CheckpointWriter& checkpoint) const override;
  void load(const CheckpointReader& checkpoint) override;

  void initialise(const SignedDistance<2>& distance, const Surface& surface) override;
  void advance(const InterfaceStep<2>& step) override;
  const CellField& distance() const override { return phi_; }
  int band(double largest_displacement) const override;
  LiquidLedger ledger() const override;

 private:
  /// phi, known everywhere, so that nothing of it is cut off beyond the band.
  void draw(double level);

  Options options_;
  const MacDomain<2>& domain_;
  double level_;  ///< level of the surface at present [m]
  CellField phi_;
};

}  // namespace lockstep
