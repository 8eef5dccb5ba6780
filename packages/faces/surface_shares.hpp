#pragma once
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "coupling/solid_system.hpp"
#include "faces/local_rotation.hpp"
#include "interfaces/fluid.hpp"

namespace lockstep {

/// Share of a mixed face that follows one surface point; the shares of a face sum to one.
template <int dim>
struct SurfaceShare {
  double weight = 0;
  SurfacePoint<dim> point;
  int solid = -1;
  /// Carries the velocity of a soft solid from `point` to the face's centre; null: taken as it is.
  std::shared_ptr<const LocalRotation<dim>> rotation{};
};

/// The closed solid whose cell is beside the volume, and which alone of closed ones moves it; or
/// -1: there is none, or one on each side.
template <int dim>
int solid_beside(const ControlVolume<dim>& volume);

/// The shares of every coupled control volume (Section 5): each simplex is clipped to the dual
/// cell, thickened by `tolerance` (relative to its width), and weighs by its clipped area; a volume
/// that clips nothing takes the closest simplex. Beside the inside of a closed solid other closed
/// solids have no share, and in a contact patch no other solid: each closed solid moves the whole
/// boundary of its cells, so that its rows of B sum to zero. The simplices of one rigid solid are
/// merged to one share, because their rows are the same.
template <int dim>
std::vector<std::vector<SurfaceShare<dim>>> surface_shares(
    const std::vector<ControlVolume<dim>>& volumes, const SurfaceSnapshot<dim>& surface,
    double tolerance = 0.01);

/// Moves every share of a soft solid to the centroid of its simplex, whose nodes then have equal
/// parts of it: the weights of Section 5, which know the clipped area and not where it lies.
template <int dim>
void weigh_nodes_alike(const SurfaceSnapshot<dim>& surface,
                       std::vector<std::vector<SurfaceShare<dim>>>& shares);

/// Gives every share of a soft solid its local rotation: the option of W that reproduces rigid
/// motions at the faces' centres.
template <int dim>
void add_local_rotations(const std::vector<ControlVolume<dim>>& volumes,
                         const SurfaceSnapshot<dim>& surface,
                         std::vector<std::vector<SurfaceShare<dim>>>& shares);

/// W restricted to dynamic solids, by rows of coupled control volumes: row f holds
/// sum_s w_s (velocity row of s at R_f) . e_direction. Columns are local indices into `dofs`.
struct CouplingWeights {
  std::vector<GlobalIndex> dofs;  ///< ids of the solid map that this rank's rows touch, ascending
  std::vector<int> row_begin;     ///< size n_rows + 1
  std::vector<int> columns;
  std::vector<double> values;
  int n_rows() const { return static_cast<int>(row_begin.size()) - 1; }
};

/// The row of one velocity component over the solid map, without zeros.
template <int dim>
struct DirectedRow {
  std::vector<GlobalIndex> dofs;
  std::vector<double> values;
  VelocityRow<dim> all_components;  ///< scratch, kept for its memory
};
/// Finds the entries of one share of one row, before weighting: for lumping share by share.
template <int dim>
void directed_row(const SolidSystem<dim>& solids, const SurfacePoint<dim>& point,
                  const Point<dim>& x, int direction, DirectedRow<dim>& row);

/// The velocity along `direction` at x that the shares of a face make, as entries of the solid map:
/// the entries of each share by its weight, and once the contribution of each local rotation.
using RowEntries = std::vector<std::pair<GlobalIndex, double>>;
template <int dim>
void add_carried_row(const SolidSystem<dim>& solids, const std::vector<SurfaceShare<dim>>& shares,
                     const Point<dim>& x, int direction, VelocityRow<dim>& scratch,
                     RowEntries& row);
/// The velocity along `direction` at x that the shares of a face make of the effective velocities
/// [m/s].
template <int dim>
double carried_effective_velocity(const SolidSystem<dim>& solids,
                                  const std::vector<SurfaceShare<dim>>& shares, const Point<dim>& x,
                                  int direction);

/// Rows from their entries (id of the solid map, value), in any order: equal ids are added.
/// `entries(f, row)` appends those of row f.
CouplingWeights weights_of_rows(int n_rows, const std::function<void(int, RowEntries&)>& entries);

/// `carried`: with the shares' local rotations, else each share as it is.
template <int dim>
CouplingWeights coupling_weights(const std::vector<ControlVolume<dim>>& volumes,
                                 const std::vector<std::vector<SurfaceShare<dim>>>& shares,
                                 const SolidSystem<dim>& solids, bool carried = true);

/// Is any solid held or scripted? The same on every rank.
bool any_prescribed(const std::vector<SolidDescription>& solids);

}  // namespace lockstep
