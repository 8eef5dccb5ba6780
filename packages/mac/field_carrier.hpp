#pragma once
#include <vector>

#include "mac/transport_frame.hpp"

namespace lockstep {

/// One field being carried, and what MacCormack remembers of the way there.
template <int dim>
struct Passenger {
  AdvectionScheme scheme = AdvectionScheme::semi_lagrangian;
  const CellField* start = nullptr;  ///< the field at t^n
  CarriedField<dim> field;           ///< kind and inflow set by the caller
  CellField* result = nullptr;
  std::vector<char>* invalid = nullptr;
  CellField storage;    ///< of field.values
  CellField low, high;  ///< range of the samples used; empty (low > high): not to be corrected

  bool corrects() const { return scheme == AdvectionScheme::maccormack; }
};

/// Carries fields along the rays of one frame.
template <int dim>
class FieldCarrier {
 public:
  explicit FieldCarrier(TransportFrame<dim>& frame) : frame_(frame) {}
  /// Collective.
  void carry(std::vector<Passenger<dim>>& passengers);

 private:
  void begin(Passenger<dim>& passenger);
  bool carry_rows(std::vector<Passenger<dim>>& passengers, int tile);
  void carry_singles(Passenger<dim>& passenger, int tile);
  void carry_surface_tile(Passenger<dim>& passenger, int tile);
  void carry_single(Passenger<dim>& passenger, int id, const Point<dim>& x);
  void carry_with_care(Passenger<dim>& passenger, int id, const Point<dim>& x);
  void carry_seeing(Passenger<dim>& passenger, int id, const Point<dim>& x);
  /// A partly open face whose centre a solid holds or passes keeps its own value and takes the
  /// change where its fluid is; false: it is no such face.
  bool carry_open_part(Passenger<dim>& passenger, int id, const Point<dim>& x);
  /// Semi-Lagrangian there and back again shows the error, half of which is taken off.
  void correct(Passenger<dim>& passenger);
  bool correct_rows(Passenger<dim>& passenger, const double* carried, int tile,
                    CellField& corrected);
  void correct_single(const Passenger<dim>& passenger, const double* carried, int id,
                      const Point<dim>& x, CellField& corrected) const;

  /// Whether a sample is moved by transport; if not, whether it has a value nevertheless.
  bool is_carried(SampleKind kind, int id, bool& has_value) const;

  TransportFrame<dim>& frame_;
};

}  // namespace lockstep
