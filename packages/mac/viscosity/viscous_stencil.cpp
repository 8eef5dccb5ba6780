#include "mac/viscosity/viscous_stencil.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <optional>

#include "linear/row_builder.hpp"
#include "mac/viscosity/stress_at_air.hpp"
#include "mac/viscosity/surface_laplacian.hpp"

namespace lockstep {

namespace {
/// Where the link to the neighbour meets a surface first, if it does. Both ends ask about the same
/// segment, so that they agree whether it is occluded. Links along the velocity's own axis run
/// inside two unoccluded segments, or end on a coupled face.
template <int dim>
std::optional<SurfacePoint<dim>> surface_on_link(const MacDomain<dim>& domain,
                                                 const MacGeometry<dim>& geometry,
                                                 const FaceId& face, int across, int end,
                                                 int other) {
  const int lower_cell = end == 0 ? other : face.cell;
  if (across == face.axis || !geometry.near_surface(lower_cell))
    return std::nullopt;
  const SurfaceSnapshot<dim>& surface = *geometry.state.surface;
  Point<dim> lower = domain.grid.face_center(face.axis, lower_cell);
  const Point<dim> step = Point<dim>::Unit(across) * domain.spacing();
  const auto find_hit = [&] {
    auto hit = surface.first_hit(lower, lower + step);
    if (hit && end == 0) {
      if (const auto reverse = surface.first_hit(lower + step, lower))
        return reverse;
      hit->fraction = 1 - hit->fraction;
    }
    return hit;
  };
  auto hit = find_hit();
  const int n = domain.grid.n_cells()[across];
  if (domain.grid.description().periodic[across] &&
      domain.grid.coordinates(lower_cell)[across] == n - 1) {
    // A link across the seam meets solids at both ends of the axis.
    lower[across] -= n * domain.spacing();
    const auto at_lower_end = find_hit();
    if (at_lower_end && (!hit || at_lower_end->fraction < hit->fraction))
      hit = at_lower_end;
  }
  return hit;
}

template <int dim>
class Builder {
 public:
  Builder(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
          const ViscosityParameters& parameters, const ImplicitTension& tension)
      : domain_(domain),
        geometry_(geometry),
        grid_(domain.grid),
        parameters_(parameters),
        viscosity_(domain, geometry, parameters.phases),
        tension_(tension.strength) {
    if (parameters.viscosity > 0 && parameters.has_air) {
      at_air_.emplace(domain, geometry, viscosity_);
      if (!at_air_->is_definite())
        at_air_.reset();
    }
    if (tension.strength > 0)
      along_surface_.emplace(domain, geometry, *tension.distance);
  }

  ViscousStencil<dim> build() {
    number_faces();
    index_coupled_volumes();
    const int n_partners = at_air_ && dim == 3 ? 4 * (dim - 1) : 0;
    RowBuilder rows(result_.map, 2 * dim + 1 + n_partners);
    const int n = static_cast<int>(result_.faces.size());
    for (row_ = 0; row_ < n; ++row_) {
      start_row(result_.faces[row_]);
      // in the order of the ids within a tile
      for (int across = dim - 1; across >= 0 && is_viscous(); --across)
        add_link(across, 0, rows);
      const std::size_t middle = rows.add(ids_[face_.axis][face_.cell], 0);
      for (int across = 0; across < dim && is_viscous(); ++across)
        add_link(across, 1, rows);
      rows.set(middle, diagonal_);
      if (along_surface_)
        add_tension(rows);
      if (at_air_)
        add_partners(rows);
      rows.end_row();
      for (int across = 0; across < dim; ++across)
        if (balance_[across] != 0)
          result_.couples.push_back({row_, across, balance_[across]});
    }
    result_.stiffness = rows.finish();
    result_.viscosity = parameters_.viscosity;
    return std::move(result_);
  }

 private:
  void number_faces() {
    for (int axis = 0; axis < dim; ++axis)
      grid_.for_each_owned_face(axis, [&](int cell) {
        if (geometry_.state.faces[axis][cell] == FaceState::free)
          result_.faces.push_back({axis, cell});
      });
    result_.map = make_map(static_cast<int>(result_.faces.size()), grid_.comm());
    result_.mass = make_vector(result_.map);
    const auto mass = result_.mass->getDataNonConst();
    for (int axis = 0; axis < dim; ++axis)
      ids_[axis].assign(grid_.n_stored_cells(), no_index);
    for (std::size_t row = 0; row < result_.faces.size(); ++row) {
      const auto [axis, cell] = result_.faces[row];
      ids_[axis][cell] = result_.map->getMinGlobalIndex() + static_cast<GlobalIndex>(row);
      mass[row] = geometry_.mass(axis, cell);
    }
    for (int axis = 0; axis < dim; ++axis)
      domain_.halo.fill(ids_[axis]);
  }

  void index_coupled_volumes() {
    for (std::size_t i = 0; i < geometry_.coupled.size(); ++i)
      coupled_.push_back({geometry_.coupled[i], static_cast<int>(i)});
    std::sort(coupled_.begin(), coupled_.end(), before);
  }
  struct Coupled {
    FaceId face;
    int index;
  };
  static bool before(const Coupled& a, const Coupled& b) {
    return std::make_pair(a.face.axis, a.face.cell) < std::make_pair(b.face.axis, b.face.cell);
  }

  void start_row(const FaceId& face) {
    face_ = face;
    cells_ = cells_of_face(grid_, geometry_.state.cells, face.axis, face.cell);
    diagonal_ = 0;
    balance_.fill(0);
  }

  /// mu area / h to the neighbour [kg/s], mu being the larger one of two phases; the dual cell at
  /// an open side is only half as long, so it has half the area across.
  double full_coefficient(int across) const {
    const double unit = parameters_.viscosity * geometry_.face_table.area() / domain_.spacing();
    return across != face_.axis && cells_.at_side() ? 0.5 * unit : unit;
  }

  bool is_viscous() const { return parameters_.viscosity > 0; }

  void add_tension(RowBuilder& rows) {
    along_surface_->for_each_entry(face_, [&](const FaceId& other, double value) {
      rows.add(ids_[other.axis][other.cell], tension_ * value);
      result_.tension_pulls.push_back({row_, other, tension_ * value});
    });
  }

  void add_partners(RowBuilder& rows) {
    const double unit = parameters_.viscosity * geometry_.face_table.area() / domain_.spacing();
    at_air_->for_each_partner(face_, [&](const auto& partner) {
      const double coefficient = unit * partner.coefficient;
      const double from_outside = unit * partner.from_outside;
      const GlobalIndex id = ids_[partner.face.axis][partner.face.cell];
      if (id == no_index) {
        result_.inflow_pulls.push_back({{row_, partner.face, coefficient}, from_outside});
        return;
      }
      if (coefficient != 0)
        rows.add(id, coefficient);
      if (from_outside != 0)
        result_.cross_pulls.push_back({row_, partner.face, from_outside});
    });
  }

  void add_link(int across, int end, RowBuilder& rows) {
    double coefficient = full_coefficient(across);
    if (across != face_.axis) {
      coefficient *= viscosity_.of_edge(face_, across, end);
    } else {
      const int between = end == 0 ? cells_.lower : cells_.upper;
      // Beyond an open side, and in air, nothing pulls.
      if (between < 0 || geometry_.state.cells[between] != CellState::fluid)
        return;
      coefficient *= viscosity_.of_cell(between) + (at_air_ ? at_air_->extra_weight(between) : 0);
    }
    const int other = grid_.neighbor(face_.cell, across, end);
    const FaceState state =
        other < 0 ? FaceState::inactive : geometry_.state.faces[face_.axis][other];
    if (other < 0 && grid_.ends_at(grid_.tile_of(face_.cell), across, end))
      return;  // beyond the rim of moving tiles, where nothing moves as yet
    if (state == FaceState::inactive && beyond_domain(other)) {
      add_side_link(across, end, across == face_.axis ? coefficient : 2 * coefficient);
      return;
    }
    if (const auto hit = surface_on_link(domain_, geometry_, face_, across, end, other)) {
      add_surface_link(face_, across, end, *hit, coefficient);
      return;
    }
    switch (state) {
      case FaceState::free:
        if (at_air_ && across != face_.axis && at_air_->parts(face_, across, end))
          return;
        rows.add(ids_[face_.axis][other], -coefficient);
        diagonal_ += coefficient;
        if (across != face_.axis)
          balance_[across] += end == 0 ? coefficient : -coefficient;
        break;
      case FaceState::coupled:
        add_coupled_link(face_, across, end, other, coefficient);
        break;
      case FaceState::prescribed:  // only along the velocity's own axis
        add_side_link(face_.axis, end, coefficient);
        break;
      case FaceState::inactive:
      case FaceState::extended:
        add_hidden_link(face_, across, end, other, coefficient);
        break;
    }
  }

  /// True for no face, as above a closed side, and for a face between two cells of the layer above
  /// another side.
  bool beyond_domain(int face) const {
    if (face < 0)
      return true;
    const FaceCells cells = cells_of_face(grid_, geometry_.state.cells, face_.axis, face);
    return cells.lower < 0 && cells.upper < 0;
  }

  void add_side_link(int axis, int end, double coefficient) {
    const SideType type = domain_.boundary.side(axis, end).type;
    const bool normal = axis == result_.faces[row_].axis;
    if (type == SideType::open || (type == SideType::slip_wall && !normal))
      return;
    diagonal_ += coefficient;
    result_.sides.push_back({row_, axis, end, coefficient});
  }

  /// `coefficient` is that of a neighbour, which the link is to reach by `fraction`.
  ViscousCouplingTerm<dim> new_link(const FaceId& face, int across, int end, double coefficient,
                                    double fraction) {
    coefficient /= fraction;
    diagonal_ += coefficient;
    ViscousCouplingTerm<dim> link;
    link.row = row_;
    link.position = grid_.face_center(face.axis, face.cell);
    link.direction = face.axis;
    link.coefficient = coefficient;
    link.reach[across] = (end == 0 ? -fraction : fraction) * grid_.spacing();
    link.end = link.position + link.reach;
    return link;
  }

  void add_surface_link(const FaceId& face, int across, int end, const SurfacePoint<dim>& point,
                        double coefficient) {
    const double fraction = std::max(point.fraction, parameters_.smallest_coupling_fraction);
    ViscousCouplingTerm<dim> link = new_link(face, across, end, coefficient, fraction);
    link.point = point;
    link.end = image_near(point.position, link.end);
    result_.links.push_back(link);
  }

  void add_coupled_link(const FaceId& face, int across, int end, int other, double coefficient) {
    ViscousCouplingTerm<dim> link = new_link(face, across, end, coefficient, 1);
    if (grid_.owned(other)) {
      const Coupled key{{face.axis, other}, 0};
      const auto found = std::lower_bound(coupled_.begin(), coupled_.end(), key, before);
      LOCKSTEP_ASSERT(found != coupled_.end() && found->face.cell == other);
      link.coupled_volume = found->index;
    } else {
      link.remote_volume = std::make_shared<ControlVolume<dim>>(
          control_volume(domain_, geometry_, face.axis, other));
    }
    result_.links.push_back(link);
  }

  /// The neighbour has no fluid, yet no surface was met on the way: the link ends on the nearest
  /// one if the neighbour is inside a solid; air does not pull.
  void add_hidden_link(const FaceId& face, int across, int end, int other, double coefficient) {
    const FaceCells cells = cells_of_face(grid_, geometry_.state.cells, face.axis, other);
    const auto solid = [&](int cell) {
      return cell >= 0 && geometry_.state.cells[cell] == CellState::solid;
    };
    if (!solid(cells.lower) && !solid(cells.upper))
      return;
    Point<dim> x = grid_.face_center(face.axis, face.cell);
    x[across] += end == 0 ? -grid_.spacing() : grid_.spacing();
    x = image_near(grid_.center(solid(cells.lower) ? cells.lower : cells.upper), x);
    auto point = geometry_.state.surface->closest(x, 2 * grid_.spacing());
    if (!point)
      return;
    point->fraction = 1;
    add_surface_link(face, across, end, *point, coefficient);
  }

  /// Solids are not repeated beyond periodic sides: of all images of x that nearest to a place.
  Point<dim> image_near(const Point<dim>& place, Point<dim> x) const {
    for (int a = 0; a < dim; ++a) {
      const double period = grid_.n_cells()[a] * grid_.spacing();
      if (grid_.description().periodic[a])
        x[a] += period * std::round((place[a] - x[a]) / period);
    }
    return x;
  }

  const MacDomain<dim>& domain_;
  const MacGeometry<dim>& geometry_;
  const TiledGrid<dim>& grid_;
  ViscosityParameters parameters_;
  ViscosityField<dim> viscosity_;
  std::optional<StressAtAir<dim>> at_air_;
  double tension_ = 0;  ///< sigma dt
  std::optional<SurfaceLaplacian<dim>> along_surface_;
  ViscousStencil<dim> result_;
  std::array<std::vector<GlobalIndex>, dim> ids_;
  std::vector<Coupled> coupled_;
  // the present row
  int row_ = 0;
  FaceId face_;
  FaceCells cells_;
  double diagonal_ = 0;
  std::array<double, dim>
      balance_{};  ///< coefficients of lower minus upper joined neighbours across
};
}  // namespace

template <int dim>
ViscousStencil<dim> find_viscous_stencil(const MacDomain<dim>& domain,
                                         const MacGeometry<dim>& geometry,
                                         const ViscosityParameters& parameters,
                                         const ImplicitTension& tension) {
  return Builder<dim>(domain, geometry, parameters, tension).build();
}

template ViscousStencil<2> find_viscous_stencil<2>(const MacDomain<2>&, const MacGeometry<2>&,
                                                   const ViscosityParameters&,
                                                   const ImplicitTension&);
template ViscousStencil<3> find_viscous_stencil<3>(const MacDomain<3>&, const MacGeometry<3>&,
                                                   const ViscosityParameters&,
                                                   const ImplicitTension&);

}  // namespace lockstep
