#pragma once
#include <memory>
#include <vector>

#include "transport/transport_frame.hpp"

namespace lockstep {

/// One advected field, and the data of MacCormack's first half.
template <int dim>
struct AdvectedField {
  AdvectionScheme scheme = AdvectionScheme::semi_lagrangian;
  const CellField* start = nullptr;  ///< the field at t^n
  CarriedField<dim> field;           ///< kind and inflow set by the caller
  CellField* result = nullptr;
  std::vector<char>* invalid = nullptr;
  double beyond = 0;   ///< the field where no tile exists
  CellField storage;   ///< storage of field.values
  CellField half_way;  ///< MacCormack's first half: the result of semi-Lagrangian transport
  /// Range of the samples used, of owned cells; empty (low > high): no correction. `low` is kept
  /// where the result will be.
  double* low = nullptr;
  std::unique_ptr<double[]> high;
  CellField error;  ///< MacCormack's estimate of the error of `half_way`; 0 where there is none
  /// Rays of the strips of a tile near surfaces that is advected by strips.
  std::vector<StripRays<dim>> back, forth;

  bool cubic() const { return scheme == AdvectionScheme::cubic; }
  bool corrects() const { return scheme == AdvectionScheme::maccormack; }
  /// Target of the semi-Lagrangian values.
  CellField& carried() { return corrects() ? half_way : *result; }
  void forbid_correction(int id) {
    if (corrects()) {
      low[id] = 1;
      high[id] = 0;
    }
  }
  bool may_correct(int id) const { return corrects() && low[id] <= high[id]; }
};

/// Advects fields along the rays of one frame: whole tiles by strips; near surfaces and inflow
/// sides, and where rays are long, one sample at a time.
template <int dim>
class FieldAdvection {
 public:
  explicit FieldAdvection(TransportFrame<dim>& frame) : frame_(frame) {}
  /// Advects the fields. `tiles`: a flag for each owned tile, 0 where nothing is advected; null:
  /// all are. Collective.
  void advect(std::vector<AdvectedField<dim>>& fields, const std::vector<char>* tiles = nullptr);

 private:
  void begin(AdvectedField<dim>& advected);
  bool advect_strips(std::vector<AdvectedField<dim>>& fields, int tile);
  void advect_samples(AdvectedField<dim>& advected, int tile);
  /// Advects the samples near surfaces; `by_strips`: all have been advected as if there were none.
  void advect_near_surfaces(std::vector<AdvectedField<dim>>& fields, int tile, bool by_strips);
  /// Returns the ray from a sample; `by_strips`: the one that advection by strips used.
  Ray<dim> trace(const AdvectedField<dim>& advected, int id, const Point<dim>& x, double direction,
                 bool cubic, bool by_strips) const;
  /// True for samples of a tile advected by strips that are far from all surfaces.
  bool is_far(const AdvectedField<dim>& advected, int id, const Point<dim>& x) const;
  /// Advects one sample; `wide`: by cubics.
  void advect_sample(AdvectedField<dim>& advected, int id, const Point<dim>& x, bool wide);
  void advect_beside_solid(AdvectedField<dim>& advected, int id, const Point<dim>& x,
                           bool by_strips);
  void advect_near_solid(AdvectedField<dim>& advected, int id, const Point<dim>& x);
  /// Advects a partly open face whose centre a solid holds or passes: it keeps its own value and
  /// takes the change where its fluid is. Returns false if it is no such face.
  bool advect_open_part(AdvectedField<dim>& advected, int id, const Point<dim>& x);
  /// Corrects by half of the error that semi-Lagrangian advection there and back again shows
  /// (MacCormack), smoothed over the samples beside each. Central differences in the form u . grad
  /// u, which the plain correction comes to as the step falls, make kinetic energy of what the grid
  /// does not resolve, without end.
  void correct(std::vector<AdvectedField<dim>>& fields);
  bool estimate_rows(std::vector<AdvectedField<dim>>& fields,
                     const std::vector<const double*>& carried, int tile);
  void estimate_single(AdvectedField<dim>& advected, const double* carried, int id,
                       const Point<dim>& x) const;
  void apply_smoothed(AdvectedField<dim>& advected, const double* error, int tile) const;
  /// Returns the sums of the errors beside the samples of a row, 2 along each axis; `cell` is that
  /// of the first, with this id. Beyond the sides of the domain is the last sample; a wall has
  /// none.
  StripValues<dim> sum_beside(SampleKind kind, const double* error, const Index<dim>& cell,
                              int first) const;

  /// True if transport advects a sample; if not, `has_value` says whether it has a value
  /// nevertheless.
  bool is_carried(SampleKind kind, int id, bool& has_value) const;
  /// True if a solid may hold the place of a sample that is advected.
  bool may_hold_center(SampleKind kind, int id) const;
  /// True if these are free faces, all advected.
  bool all_free(SampleKind kind, int first, int n) const;
  /// Leaves a sample as it was.
  void keep(AdvectedField<dim>& advected, int id, bool has_value) const;

  TransportFrame<dim>& frame_;
};

}  // namespace lockstep
