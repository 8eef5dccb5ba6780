#include "cutcell/surface_flows.hpp"

#include <map>

#include "geometry/clipping.hpp"

namespace lockstep {
namespace {

/// The part of one simplex in a cell.
template <int dim>
struct SurfacePiece {
  SurfacePoint<dim> point;
  double size = 0;  ///< [m^(dim-1)]
  Point<dim> normal = Point<dim>::Zero();
};

/// The surface of one body in one cell.
template <int dim>
struct SurfaceInCell {
  const CutCell<dim>* cell = nullptr;
  std::vector<SurfacePiece<dim>> pieces;
  Point<dim> closed = Point<dim>::Zero();  ///< area that this rank's faces close of the cell
};

/// By the fluid's number of the cell, and the solid.
template <int dim>
using SurfacesInCells = std::map<std::pair<GlobalIndex, int>, SurfaceInCell<dim>>;

/// True if a simplex lies in a side of the box and faces outwards: it counts in the next cell.
template <int dim>
bool belongs_to_next(const std::array<Point<dim>, dim>& corners, const Point<dim>& normal,
                     const Box<dim>& box) {
  const auto lies_at = [&](int axis, double x) {
    return std::all_of(corners.begin(), corners.end(),
                       [&](const Point<dim>& corner) { return corner[axis] == x; });
  };
  for (int a = 0; a < dim; ++a)
    if ((lies_at(a, box.min()[a]) && normal[a] < 0) || (lies_at(a, box.max()[a]) && normal[a] > 0))
      return true;
  return false;
}

template <int dim>
void add_pieces(const CutCell<dim>& cell, const SurfaceSnapshot<dim>& surface,
                SurfacesInCells<dim>& surfaces) {
  std::vector<int> touching;
  surface.touching(cell.box, touching);
  for (const int simplex : touching) {
    const int solid = surface.solid_of(simplex);
    if (!surface.solids()[solid].is_soft_body())
      continue;
    const auto corners = surface.corners(simplex);
    const ClippedSimplex<dim> part = clip_to_box<dim>(corners, cell.box);
    const Point<dim> normal = area_vector<dim>(corners).normalized();
    if (part.measure <= 0 || belongs_to_next<dim>(corners, normal, cell.box))
      continue;
    SurfaceInCell<dim>& here = surfaces[{cell.pressure.cell, solid}];
    here.cell = &cell;
    here.pieces.push_back({{simplex, part.barycentric, part.centroid, 0}, part.measure, normal});
  }
}

/// Adds what a share closes of a face to the surface on either side, or, where there is none, the
/// flow at the share's own place.
template <int dim>
void add_closed(const ControlVolume<dim>& volume, const FluxShare<dim>& share,
                SurfacesInCells<dim>& surfaces, std::vector<SurfaceFlow<dim>>& flows) {
  for (int side = 0; side < 2; ++side) {
    const PressureSide<dim>& pressure = volume.sides[side];
    const double area = (side == 0 ? -1 : 1) * (1 - volume.open_fraction) * volume.area;
    const Point<dim> closed = share.weight * area * Point<dim>::Unit(volume.direction);
    const auto here = surfaces.find({pressure.cell, share.solid});
    if (here != surfaces.end())
      here->second.closed += closed;
    else if (RowPush::into(pressure, 0, 0).has_receiver())
      flows.push_back({share.point, closed, pressure});
  }
}

/// Turns the pieces of a body in a cell into flows whose areas add up to what faces close. The rank
/// that owns the cell has the pieces' own areas, each rank what its faces close.
template <int dim>
void add_flows(const SurfaceInCell<dim>& surface, std::vector<SurfaceFlow<dim>>& flows) {
  double size = 0;
  Point<dim> missing = surface.closed;
  for (const SurfacePiece<dim>& piece : surface.pieces) {
    size += piece.size;
    if (surface.cell->is_owned)
      missing -= piece.size * piece.normal;
  }
  for (const SurfacePiece<dim>& piece : surface.pieces) {
    Point<dim> area = piece.size / size * missing;
    if (surface.cell->is_owned)
      area += piece.size * piece.normal;
    if (!area.isZero(0))
      flows.push_back({piece.point, area, surface.cell->pressure});
  }
}

}  // namespace

template <int dim>
std::vector<SurfaceFlow<dim>> surface_flows(const FluidDiscretization<dim>& fluid,
                                            const SurfaceSnapshot<dim>& surface,
                                            const std::vector<FaceShares<dim>>& shares) {
  SurfacesInCells<dim> surfaces;
  for (const CutCell<dim>& cell : fluid.cut_cells())
    add_pieces<dim>(cell, surface, surfaces);
  std::vector<SurfaceFlow<dim>> flows;
  for (std::size_t f = 0; f < shares.size(); ++f)
    for (const FluxShare<dim>& share : shares[f].all)
      if (share.at_surface)
        add_closed<dim>(fluid.coupled_volumes()[f], share, surfaces, flows);
  for (const auto& entry : surfaces)
    add_flows<dim>(entry.second, flows);
  return flows;
}

template std::vector<SurfaceFlow<2>> surface_flows<2>(const FluidDiscretization<2>&,
                                                      const SurfaceSnapshot<2>&,
                                                      const std::vector<FaceShares<2>>&);
template std::vector<SurfaceFlow<3>> surface_flows<3>(const FluidDiscretization<3>&,
                                                      const SurfaceSnapshot<3>&,
                                                      const std::vector<FaceShares<3>>&);

}  // namespace lockstep
