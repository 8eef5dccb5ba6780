#include "cutcell/closed_parts.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "geometry/solid_volume.hpp"

namespace lockstep {
namespace {

/// A place in the plane of a face, relative to its centre: along the column and across (3D).
struct InPlane {
  double along = 0, across = 0;
};

/// Area and first moments of a part of the face, relative to its centre.
struct Area {
  double area = 0, along = 0, across = 0;
  Area& operator+=(const Area& other) {
    area += other.area;
    along += other.along;
    across += other.across;
    return *this;
  }
};

/// Half the extents of a face in its plane, and the side where its column leaves the solid.
template <int dim>
struct FaceColumn {
  int axis = 0;  ///< normal to the face
  int along = 1, across = 1;
  int side = 1;  ///< the column leads this way along `along`
  Point<dim> center = Point<dim>::Zero();
  double half_along = 0, half_across = 0;
};

/// (F, its first moments) at a place: the divergence of F(along) e_along is one within the face and
/// zero beside it, and F vanishes where the column does not lead.
template <int dim>
Area column_field(const FaceColumn<dim>& column, const InPlane& x) {
  const double inside = std::clamp(x.along, -column.half_along, column.half_along);
  const double base = -column.side * column.half_along;
  return {inside - base, 0.5 * (inside * inside - base * base), (inside - base) * x.across};
}

/// Flux of the field through a directed segment of the section: exact, piece by piece.
void add_segment_flux(const FaceColumn<3>& column, const InPlane& from, const InPlane& to,
                      Area& sum) {
  std::array<double, 6> cuts{0, 1};  // sorted
  int n = 2;
  const auto cut = [&](double a, double b, double bound) {
    if (!(a < bound && b > bound) && !(a > bound && b < bound))
      return;
    const double t = (bound - a) / (b - a);
    int i = n++;
    for (; i > 0 && cuts[i - 1] > t; --i)
      cuts[i] = cuts[i - 1];
    cuts[i] = t;
  };
  for (const double end : {-1., 1.}) {
    cut(from.along, to.along, end * column.half_along);
    cut(from.across, to.across, end * column.half_across);
  }
  const auto at = [&](double t) {
    return InPlane{(1 - t) * from.along + t * to.along, (1 - t) * from.across + t * to.across};
  };
  const double sign = column.along == (column.axis + 1) % 3 ? 1 : -1;
  for (int i = 0; i + 1 < n; ++i) {
    const InPlane middle = at(0.5 * (cuts[i] + cuts[i + 1]));
    if (std::abs(middle.across) > column.half_across)
      continue;
    const double weight = sign * (cuts[i + 1] - cuts[i]) * (to.across - from.across) / 6;
    const Area low = column_field(column, at(cuts[i])), mid = column_field(column, middle),
               high = column_field(column, at(cuts[i + 1]));  // Simpson: exact for quadratics
    sum += {weight * (low.area + 4 * mid.area + high.area),
            weight * (low.along + 4 * mid.along + high.along),
            weight * (low.across + 4 * mid.across + high.across)};
  }
}

/// Crossing of an edge with the plane of the face; both simplices at the edge get the same numbers.
template <int dim>
InPlane crossing(const FaceColumn<dim>& column, const Point<dim>& below, const Point<dim>& above) {
  const double t =
      (column.center[column.axis] - below[column.axis]) / (above[column.axis] - below[column.axis]);
  const auto between = [&](int a) {
    return below[a] + t * (above[a] - below[a]) - column.center[a];
  };
  return {between(column.along), dim == 3 ? between(column.across) : 0};
}

/// Adds the flux through the section of one simplex with the plane. `is_above` is decided for
/// vertices, so that sections of closed surfaces are closed.
template <int dim>
void add_section(const FaceColumn<dim>& column, const std::array<Point<dim>, dim>& corners,
                 const std::array<bool, dim>& is_above, Area& sum) {
  InPlane entry, exit;
  bool is_cut = false;
  for (int k = 0; k < dim; ++k) {
    const int next = (k + 1) % dim;
    if (is_above[k] == is_above[next])
      continue;
    is_cut = true;
    const InPlane x = is_above[next] ? crossing<dim>(column, corners[k], corners[next])
                                     : crossing<dim>(column, corners[next], corners[k]);
    (is_above[next] ? entry : exit) = x;
  }
  if (!is_cut)
    return;
  if constexpr (dim == 3) {
    add_segment_flux(column, exit, entry, sum);
  } else {
    // For a segment that runs up, the normal (dy, -dx) points to -y of axis 0, to +x of axis 1.
    const double sign = is_above[1] == (column.axis == 1) ? 1 : -1;
    const Area value = column_field(column, entry);
    sum += {sign * value.area, sign * value.along, 0};
  }
}

/// The shortest of the columns from the face that leave the bounds of a solid.
template <int dim>
FaceColumn<dim> shortest_column(const Box<dim>& face, int axis, const Box<dim>& bounds) {
  FaceColumn<dim> best;
  double shortest = std::numeric_limits<double>::infinity();
  for (int k = 1; k < dim; ++k) {
    const int a = (axis + k) % dim;
    for (const int side : {1, -1}) {
      const double length =
          side > 0 ? bounds.max()[a] - face.min()[a] : face.max()[a] - bounds.min()[a];
      if (length >= shortest)
        continue;
      shortest = length;
      best.along = a;
      best.side = side;
    }
  }
  best.axis = axis;
  best.across = dim == 3 ? 3 - axis - best.along : best.along;
  best.center = face.center();
  best.half_along = 0.5 * face.sizes()[best.along];
  best.half_across = 0.5 * face.sizes()[best.across];
  return best;
}

/// The part of the face inside one solid, the plane taken just above or just below its own place.
template <int dim>
Area area_inside(const SurfaceSnapshot<dim>& surface, int solid, const std::vector<int>& simplices,
                 const FaceColumn<dim>& column, bool on_plane_is_above, bool& touches_plane) {
  Area sum;
  const double height = column.center[column.axis];
  for (const int s : simplices) {
    if (surface.solid_of(s) != solid)
      continue;
    const auto corners = surface.corners(s);
    std::array<bool, dim> is_above;
    for (int k = 0; k < dim; ++k) {
      const double x = corners[k][column.axis];
      is_above[k] = x > height || (on_plane_is_above && x == height);
      touches_plane = touches_plane || x == height;
    }
    add_section<dim>(column, corners, is_above, sum);
  }
  return sum;
}

}  // namespace

// The divergence theorem in the plane of the face, as for volumes in geometry/solid_volume: the
// section of the surface with the plane is cut to the column between the face and the nearest side
// of the solid's bounds; the sides of the face never enter.
template <int dim>
std::vector<ClosedPart<dim>> closed_parts(const SurfaceSnapshot<dim>& surface, const Box<dim>& face,
                                          int axis) {
  std::vector<ClosedPart<dim>> parts;
  std::vector<int> solids, simplices;
  double full = 1;
  for (int k = 1; k < dim; ++k)
    full *= face.sizes()[(axis + k) % dim];
  surface.solids_touching(face, solids);
  for (const int solid : solids) {
    if (!surface.solids()[solid].closed)
      continue;
    const Box<dim> bounds = surface.bounds_of_solid(solid);
    const FaceColumn<dim> column = shortest_column<dim>(face, axis, bounds);
    Box<dim> reach = face;
    (column.side > 0 ? reach.max() : reach.min())[column.along] =
        (column.side > 0 ? bounds.max() : bounds.min())[column.along];
    surface.touching(reach, simplices);
    bool touches_plane = false;
    Area inside = area_inside<dim>(surface, solid, simplices, column, false, touches_plane);
    if (touches_plane) {
      const Area below = area_inside<dim>(surface, solid, simplices, column, true, touches_plane);
      if (below.area > inside.area)
        inside = below;
    }
    constexpr double round_off = 1e-10;
    if (inside.area <= round_off * full)
      continue;
    ClosedPart<dim> part{solid, full, column.center};
    if (inside.area < (1 - round_off) * full) {
      part.area = inside.area;
      part.center[column.along] += inside.along / inside.area;
      if (dim == 3)
        part.center[column.across] += inside.across / inside.area;
      part.center = part.center.cwiseMax(face.min()).cwiseMin(face.max());
    }
    parts.push_back(part);
  }
  return parts;
}

template <int dim>
std::vector<ClosedPart<dim>> closed_volumes(const SurfaceSnapshot<dim>& surface,
                                            const Box<dim>& box, int axis) {
  constexpr std::array<std::pair<double, double>, 4> gauss{
      {{-0.86113631159405258, 0.34785484513745386},
       {-0.33998104358485626, 0.65214515486254614},
       {0.33998104358485626, 0.65214515486254614},
       {0.86113631159405258, 0.34785484513745386}}};
  const double length = box.sizes()[axis];
  std::vector<ClosedPart<dim>> parts, sections;
  for (const auto& [place, weight] : gauss) {
    Box<dim> section = box;
    section.min()[axis] = section.max()[axis] = box.center()[axis] + 0.5 * place * length;
    for (ClosedPart<dim> part : closed_parts<dim>(surface, section, axis)) {
      part.area *= weight;
      sections.push_back(part);
    }
  }
  std::vector<int> solids;
  surface.solids_touching(box, solids);
  constexpr double round_off = 1e-10;
  for (const int solid : solids) {
    if (!surface.solids()[solid].closed)
      continue;
    const double volume = solid_volume_in_box<dim>(surface, box, solid);
    if (volume <= round_off * box.volume())
      continue;
    ClosedPart<dim> part{solid, volume / length, Point<dim>::Zero()};
    double total = 0;
    for (const ClosedPart<dim>& section : sections)
      if (section.solid == solid) {
        part.center += section.area * section.center;
        total += section.area;
      }
    part.center = total > 0 ? Point<dim>(part.center / total) : Point<dim>(box.center());
    parts.push_back(part);
  }
  return parts;
}

template std::vector<ClosedPart<2>> closed_volumes<2>(const SurfaceSnapshot<2>&, const Box<2>&,
                                                      int);
template std::vector<ClosedPart<3>> closed_volumes<3>(const SurfaceSnapshot<3>&, const Box<3>&,
                                                      int);
template std::vector<ClosedPart<2>> closed_parts<2>(const SurfaceSnapshot<2>&, const Box<2>&, int);
template std::vector<ClosedPart<3>> closed_parts<3>(const SurfaceSnapshot<3>&, const Box<3>&, int);

}  // namespace lockstep
