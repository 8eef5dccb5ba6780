#pragma once
#include <memory>
#include <vector>

#include "transport/transport_frame.hpp"

namespace lockstep {

/// One field being carried, and what MacCormack remembers of the way there.
template <int dim>
struct Passenger {
  AdvectionScheme scheme = AdvectionScheme::semi_lagrangian;
  const CellField* start = nullptr;  ///< the field at t^n
  CarriedField<dim> field;           ///< kind and inflow set by the caller
  CellField* result = nullptr;
  std::vector<char>* invalid = nullptr;
  double beyond = 0;   ///< the field where no tile exists
  CellField storage;   ///< of field.values
  CellField half_way;  ///< MacCormack's first half: the result of semi-Lagrangian transport
  /// Range of the samples used, of owned cells; empty (low > high): not to be corrected. The first
  /// is kept where the result will be.
  double* low = nullptr;
  std::unique_ptr<double[]> high;
  /// Of the rows of a tile near surfaces that is carried by rows.
  std::vector<RowRays<dim>> back, forth;

  bool cubic() const { return scheme == AdvectionScheme::cubic; }
  bool corrects() const { return scheme == AdvectionScheme::maccormack; }
  /// Where the semi-Lagrangian values go.
  CellField& carried() { return corrects() ? half_way : *result; }
  void forbid_correction(int id) {
    if (corrects()) {
      low[id] = 1;
      high[id] = 0;
    }
  }
  bool may_correct(int id) const { return corrects() && low[id] <= high[id]; }
};

/// Carries fields along the rays of one frame: whole tiles by rows, and what those cannot do, near
/// surfaces and inflow sides and where rays are long, one sample at a time.
template <int dim>
class FieldCarrier {
 public:
  explicit FieldCarrier(TransportFrame<dim>& frame) : frame_(frame) {}
  /// Collective. `tiles`: a flag for each owned tile, 0 where nothing is carried; null: all are.
  void carry(std::vector<Passenger<dim>>& passengers, const std::vector<char>* tiles = nullptr);

 private:
  void begin(Passenger<dim>& passenger);
  bool carry_rows(std::vector<Passenger<dim>>& passengers, int tile);
  void carry_singles(Passenger<dim>& passenger, int tile);
  /// The samples near surfaces; `by_rows`: all have been carried as if there were none.
  void carry_near_surfaces(std::vector<Passenger<dim>>& passengers, int tile, bool by_rows);
  /// The ray from a sample; `by_rows`: as carried by rows.
  Ray<dim> trace(const Passenger<dim>& passenger, int id, const Point<dim>& x, double direction,
                 bool cubic, bool by_rows) const;
  /// True of samples of a tile carried by rows that no surface concerns.
  bool is_far(const Passenger<dim>& passenger, int id, const Point<dim>& x) const;
  /// `wide`: by cubics.
  void carry_single(Passenger<dim>& passenger, int id, const Point<dim>& x, bool wide);
  void carry_with_care(Passenger<dim>& passenger, int id, const Point<dim>& x, bool by_rows);
  void carry_seeing(Passenger<dim>& passenger, int id, const Point<dim>& x);
  /// A partly open face whose centre a solid holds or passes keeps its own value and takes the
  /// change where its fluid is; false: it is no such face.
  bool carry_open_part(Passenger<dim>& passenger, int id, const Point<dim>& x);
  /// Semi-Lagrangian there and back again shows the error, half of which is taken off.
  void correct(std::vector<Passenger<dim>>& passengers);
  bool correct_rows(std::vector<Passenger<dim>>& passengers,
                    const std::vector<const double*>& carried, int tile);
  void correct_single(Passenger<dim>& passenger, const double* carried, int id,
                      const Point<dim>& x) const;

  /// Whether a sample is moved by transport; if not, whether it has a value nevertheless.
  bool is_carried(SampleKind kind, int id, bool& has_value) const;
  /// Whether a solid may hold the place of a sample that is carried.
  bool may_hold_center(SampleKind kind, int id) const;
  /// Whether these are free faces, all carried.
  bool all_free(SampleKind kind, int first, int n) const;
  /// Leaves a sample as it was.
  void keep(Passenger<dim>& passenger, int id, bool has_value) const;

  TransportFrame<dim>& frame_;
};

}  // namespace lockstep
