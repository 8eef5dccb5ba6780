#include "mac/tile_block.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace lockstep {

namespace {

double blend(double a, double b, double weight) {
  return a + weight * (b - a);
}

/// The 2^dim samples around each point of a row, in a form that compilers turn into vector code:
/// calls f(i, first sample, strides, weights).
template <int dim, typename Function>
void for_each_stencil(const double* block, int width, SampleKind kind, const RowPoints<dim>& points,
                      const Function& f) {
  std::array<double, dim> offset;
  offset.fill(0.5);
  if (kind != cell_centers)
    offset[kind] = 0;
  for (int i = 0; i < tile_width<dim>; ++i) {
    const double t0 = points[0][i] - offset[0], t1 = points[1][i] - offset[1];
    const double f0 = std::floor(t0), f1 = std::floor(t1);
    if constexpr (dim == 2) {
      f(i, block + static_cast<int>(f0) + width * static_cast<int>(f1), t0 - f0, t1 - f1, 0.0);
    } else {
      const double t2 = points[2][i] - offset[2];
      const double f2 = std::floor(t2);
      const int first =
          static_cast<int>(f0) + width * (static_cast<int>(f1) + width * static_cast<int>(f2));
      f(i, block + first, t0 - f0, t1 - f1, t2 - f2);
    }
  }
}

template <int dim>
void interpolate_row(const double* block, int width, SampleKind kind, const RowPoints<dim>& points,
                     RowValues<dim>& values) {
  const int up = width * width;
  for_each_stencil<dim>(
      block, width, kind, points, [&](int i, const double* c, double w0, double w1, double w2) {
        const double lower = blend(blend(c[0], c[1], w0), blend(c[width], c[width + 1], w0), w1);
        if constexpr (dim == 2) {
          static_cast<void>(w2);
          values[i] = lower;
        } else {
          const double* d = c + up;
          const double upper = blend(blend(d[0], d[1], w0), blend(d[width], d[width + 1], w0), w1);
          values[i] = blend(lower, upper, w2);
        }
      });
}

}  // namespace

template <int dim>
TileBlock<dim>::TileBlock(const SampleLattice<dim>& lattice, const RayTracer<dim>& tracer,
                          int reach)
    : lattice_(lattice), tracer_(tracer), reach_(reach), width_(tile_width<dim> + 2 * reach + 2) {
  int size = 1;
  for (int a = 0; a < dim; ++a)
    size *= width_;
  for (auto& ids : ids_)
    ids.resize(size);
  for (auto& component : velocity_)
    component.resize(size);
  field_.resize(size);
}

template <int dim>
void TileBlock<dim>::copy(const std::vector<int>& ids, const double* field,
                          std::vector<double>& block) {
  for (std::size_t k = 0; k < ids.size(); ++k)
    block[k] = ids[k] < 0 ? 0 : field[ids[k]];
}

template <int dim>
bool TileBlock<dim>::enter(const Index<dim>& tile_begin) {
  Index<dim> begin = tile_begin;
  for (int a = 0; a < dim; ++a) {
    begin[a] -= reach_ + 1;
    const bool periodic = lattice_.periodic(a);
    constexpr double infinity = std::numeric_limits<double>::infinity();
    lower_[a] = periodic ? -infinity : -begin[a];
    upper_[a] = periodic ? infinity : lattice_.n_cells()[a] - begin[a];
  }
  for (SampleKind kind = cell_centers; kind < dim; ++kind)
    if (!lattice_.find_block(kind, begin, width_, ids(kind)))
      return false;
  for (int a = 0; a < dim; ++a)
    copy(ids_[a], tracer_.velocity()[a], velocity_[a]);
  return true;
}

template <int dim>
void TileBlock<dim>::load(SampleKind kind, const double* field) {
  kind_ = kind;
  copy(ids(kind), field, field_);
}

template <int dim>
RowPoints<dim> TileBlock<dim>::row(SampleKind kind, const Index<dim>& in_tile) const {
  const Point<dim> offset = sample_offset<dim>(kind);
  RowPoints<dim> row;
  for (int i = 0; i < tile_width<dim>; ++i)
    row[0][i] = reach_ + 1 + i + offset[0];
  for (int a = 1; a < dim; ++a)
    row[a].fill(reach_ + 1 + in_tile[a] + offset[a]);
  // A tile may reach beyond the domain: what is there has no result, but must stay in the block.
  for (int a = 0; a < dim; ++a)
    for (double& x : row[a])
      clamp(x, a);
  return row;
}

template <int dim>
bool TileBlock<dim>::clamp(double& x, int axis) const {
  const double inside = x < lower_[axis] ? lower_[axis] : x > upper_[axis] ? upper_[axis] : x;
  const bool moved = inside != x;
  x = inside;
  return moved;
}

template <int dim>
RowPoints<dim> TileBlock<dim>::displaced(const RowPoints<dim>& start, const RowPoints<dim>& at,
                                         double factor) const {
  RowPoints<dim> end;
  for (int a = 0; a < dim; ++a) {
    interpolate_row<dim>(velocity_[a].data(), width_, a, at, end[a]);
    for (int i = 0; i < tile_width<dim>; ++i)
      end[a][i] = start[a][i] + factor * end[a][i];
  }
  return end;
}

template <int dim>
RowRays<dim> TileBlock<dim>::trace(const RowPoints<dim>& start, double direction) const {
  const double factor = direction * tracer_.cells_per_velocity();
  RowPoints<dim> middle = displaced(start, start, 0.5 * factor);
  for (int a = 0; a < dim; ++a)
    for (double& x : middle[a])
      clamp(x, a);
  RowRays<dim> rays;
  rays.end = displaced(start, middle, factor);
  rays.clipped.fill(false);
  for (int a = 0; a < dim; ++a)
    for (int i = 0; i < tile_width<dim>; ++i)
      rays.clipped[i] |= clamp(rays.end[a][i], a);
  return rays;
}

template <int dim>
void TileBlock<dim>::look_up(const RowPoints<dim>& points, RowValues<dim>& values) const {
  interpolate_row<dim>(field_.data(), width_, kind_, points, values);
}

template <int dim>
void TileBlock<dim>::look_up_range(const RowPoints<dim>& points, RowValues<dim>& low,
                                   RowValues<dim>& high) const {
  const int row_step = width_, up = width_ * width_;
  for_each_stencil<dim>(field_.data(), width_, kind_, points,
                        [&](int i, const double* c, double, double, double) {
                          const auto least = [](double a, double b) { return b < a ? b : a; };
                          const auto most = [](double a, double b) { return a < b ? b : a; };
                          const double* r = c + row_step;
                          double lowest = least(least(c[0], c[1]), least(r[0], r[1]));
                          double highest = most(most(c[0], c[1]), most(r[0], r[1]));
                          if constexpr (dim == 3) {
                            const double *d = c + up, *e = r + up;
                            lowest = least(lowest, least(least(d[0], d[1]), least(e[0], e[1])));
                            highest = most(highest, most(most(d[0], d[1]), most(e[0], e[1])));
                          }
                          low[i] = lowest;
                          high[i] = highest;
                        });
}

template class TileBlock<2>;
template class TileBlock<3>;

}  // namespace lockstep
