#include "multigrid/stencil_level.hpp"

#include <algorithm>

namespace lockstep {

namespace {

/// Rows of the other colour around a row, at the slots of the six (four) neighbours.
template <typename Value>
struct Neighbors {
  const Value *left, *right, *front, *back, *below, *above;
};

template <int dim, typename Value>
inline Value sum_across(const Neighbors<Value>& x, int m) {
  Value sum = x.front[m] + x.back[m];
  if constexpr (dim == 3)
    sum += x.below[m] + x.above[m];
  return sum;
}

template <int dim, typename Value>
inline Value weighted_sum(const Neighbors<float>& face, const Neighbors<Value>& x, int m) {
  Value sum = face.left[m] * x.left[m] + face.right[m] * x.right[m] + face.front[m] * x.front[m] +
              face.back[m] * x.back[m];
  if constexpr (dim == 3)
    sum += face.below[m] * x.below[m] + face.above[m] * x.above[m];
  return sum;
}

/// Diagonal that varies along a strip of cells.
struct DiagonalOfRow {
  const float *values, *inverses;
  float operator()(int m) const { return values[m]; }
  float inverse(int m) const { return inverses[m]; }
};
/// Diagonal that is the same along a strip of cells.
struct EvenDiagonal {
  explicit EvenDiagonal(float of_all) : value(of_all), inverse_value(of_all > 0 ? 1 / of_all : 0) {}
  float value, inverse_value;
  float operator()(int) const { return value; }
  float inverse(int) const { return inverse_value; }
};

}  // namespace

void NaturalStencil::resize(const LevelGrid& grid, bool has_reaction, bool has_phases) {
  for (int axis = 0; axis < grid.dimension; ++axis)
    lower[axis].assign(grid.n_natural, 0);
  dirichlet.assign(grid.n_natural, 0);
  reaction.assign(has_reaction ? grid.n_natural : 0, 0);
  regular.assign(has_phases ? grid.n_natural : 0, 0);
  diagonal.assign(grid.n_natural, 0);
  active.assign(grid.n_natural, 0);
}

void NaturalStencil::complete(const LayoutLevel& level) {
  const LevelGrid& grid = level.grid;
  const LevelHalo& halo = grid.is_distributed ? level.deep_halo : level.halo;
  std::vector<float*> faces;
  for (int axis = 0; axis < grid.dimension; ++axis)
    faces.push_back(lower[axis].data());
  if (!regular.empty())
    faces.push_back(regular.data());
  halo.fill_natural(faces);
  for (int k = 0; k < grid.n[2]; ++k) {
    for (int j = 0; j < grid.n[1]; ++j) {
      for (const LayoutLevel::Part& part : level.parts(j, k)) {
        const std::ptrdiff_t row = grid.natural(part.begin, j, k);
        const int n = part.end - part.begin;
        float* d = diagonal.data() + row;
        const float* e = dirichlet.data() + row;
        for (int i = 0; i < n; ++i)
          d[i] = e[i];
        if (!reaction.empty()) {
          for (int i = 0; i < n; ++i)
            d[i] += reaction[row + i];
        }
        for (int axis = 0; axis < grid.dimension; ++axis) {
          const float* f = lower[axis].data() + row;
          const std::ptrdiff_t next = grid.natural_stride[axis];
          for (int i = 0; i < n; ++i)
            d[i] += f[i] + f[i + next];
        }
      }
    }
  }
  halo.fill_natural<float>({diagonal.data()});
  for (std::size_t i = 0; i < active.size(); ++i)
    active[i] = diagonal[i] != 0;
}

template <int dim>
StencilLevel<dim>::StencilLevel(const LayoutLevel& level)
    : level_(level),
      grid_(level.grid),
      rows_touch_(grid_.margin == 0 && grid_.row_stride * 2 <= grid_.n[0] + 1) {
  for (int colour = 0; colour < 2; ++colour) {
    diagonal_[colour] = AlignedArray<float>(grid_.n_slots);
    inverse_[colour] = AlignedArray<float>(grid_.n_slots);
  }
  ranges_.resize((grid_.n[1] + 1) * static_cast<std::size_t>(grid_.n[2] + 1));
}

template <int dim>
std::size_t StencilLevel<dim>::bytes() const {
  std::size_t n = 4 * grid_.n_slots;
  for (const auto& by_colour : faces_)
    n += by_colour[0].size() + by_colour[1].size();
  return n * sizeof(float);
}

template <int dim>
void StencilLevel<dim>::set(const NaturalStencil& stencil, float unit) {
  unit_ = unit;
  set_diagonal(stencil);
  find_irregular_rows(stencil);
  find_even_rows();
  copy_faces(stencil);
}

template <int dim>
void StencilLevel<dim>::find_even_rows() {
  even_rows_.assign(2 * ranges_.size(), {});
  for (int k = 0; k < grid_.n[2]; ++k) {
    for (int j = 0; j < grid_.n[1]; ++j) {
      const Range& row = range(j, k);
      if (irregular_[row_index(j, k)] || row.last - row.first < 3)
        continue;
      for (int colour = 0; colour < 2; ++colour) {
        const float* d = diagonal_[colour].data() + grid_.slot(0, j, k);
        const float inner = d[row.first + 1];
        bool even = inner > 0;
        for (int m = row.first + 2; m < row.last - 1; ++m)
          even &= d[m] == inner;
        if (even)
          even_rows_[2 * row_index(j, k) + colour] = {inner, d[row.first], d[row.last - 1]};
      }
    }
  }
}

template <int dim>
void StencilLevel<dim>::set_diagonal(const NaturalStencil& stencil) {
  for (int k = 0; k < grid_.n[2]; ++k) {
    for (int j = 0; j < grid_.n[1]; ++j) {
      const float* d = stencil.diagonal.data() + grid_.natural(0, j, k);
      Range& range = ranges_[row_index(j, k)];
      int first = 0, last = grid_.n[0];
      while (first < last && d[first] == 0)
        ++first;
      while (last > first && d[last - 1] == 0)
        --last;
      range = last > first ? Range{first / 2, (last + 1) / 2} : Range{};
      for (int colour = 0; colour < 2; ++colour) {
        const int shift = (j + k + colour) & 1;
        const int n = (grid_.n[0] - shift + 1) / 2;
        float* diagonal = diagonal_[colour].data() + grid_.slot(0, j, k);
        float* inverse = inverse_[colour].data() + grid_.slot(0, j, k);
        for (int m = 0; m < n; ++m) {
          const float value = d[2 * m + shift];
          diagonal[m] = value;
          inverse[m] = value > 0 ? 1 / value : 0;
        }
      }
    }
  }
}

template <int dim>
void StencilLevel<dim>::find_irregular_rows(const NaturalStencil& stencil) {
  irregular_.assign(ranges_.size(), 0);
  faces_at_.assign(ranges_.size(), -1);
  std::ptrdiff_t size = 0;
  const auto need = [&](int j, int k) {
    std::ptrdiff_t& at = faces_at_[row_index(j, k)];
    if (at < 0) {
      at = size;
      size += grid_.row_stride + 1;  // the slot after a full row stays zero
    }
  };
  for (int k = 0; k < grid_.n[2]; ++k) {
    for (int j = 0; j < grid_.n[1]; ++j) {
      const Range& row = range(j, k);
      if (row.last == 0 || !is_irregular(stencil, j, k))
        continue;
      irregular_[row_index(j, k)] = 1;
      need(j, k);
      need(j + 1, k);
      if (dim == 3)
        need(j, k + 1);
    }
  }
  for (auto& by_colour : faces_) {
    for (auto& values : by_colour)
      values.assign(size == 0 ? 0 : size + 2 * grid_.row_stride, 0);
  }
}

template <int dim>
bool StencilLevel<dim>::is_irregular(const NaturalStencil& stencil, int j, int k) const {
  const std::ptrdiff_t row = grid_.natural(0, j, k);
  const float* d = stencil.diagonal.data() + row;
  const char* active = stencil.active.data() + row;
  int n_irregular = 0;
  for (int axis = 0; axis < dim; ++axis) {
    const float* face = stencil.lower[axis].data() + row;
    const std::ptrdiff_t next = grid_.natural_stride[axis];
    for (int i = 0; i < grid_.n[0]; ++i) {
      const int below = (active[i - next] != 0) & (face[i] != unit_);
      const int above = (active[i + next] != 0) & (face[i + next] != unit_);
      n_irregular += (d[i] != 0) & (below | above);
    }
  }
  return n_irregular > 0;
}

template <int dim>
void StencilLevel<dim>::copy_faces(const NaturalStencil& stencil) {
  const int k_end = dim == 3 ? grid_.n[2] + 1 : 1;
  for (int k = 0; k < k_end; ++k) {
    for (int j = 0; j <= grid_.n[1]; ++j) {
      const std::ptrdiff_t at = faces_at_[row_index(j, k)];
      if (at < 0)
        continue;
      for (int axis = 0; axis < dim; ++axis) {
        const float* face = stencil.lower[axis].data() + grid_.natural(0, j, k);
        for (int i = -grid_.margin; i < grid_.n[0] + grid_.margin; ++i) {
          faces_[axis][LevelGrid::colour(i, j, k)][at + grid_.margin + (i >> 1)] = face[i];
        }
      }
    }
  }
}

template <int dim>
template <typename Value, typename Kernel>
inline void StencilLevel<dim>::with_sums(const Row& cells, const Value* other,
                                         const Kernel& kernel) const {
  const auto [colour, j, k] = cells;
  const int row = row_index(j, k);
  const Range range = ranges_[row];
  const int shift = (j + k + colour) & 1;
  const Value* o = other + grid_.slot(0, j, k);
  const Neighbors<Value> x{o - 1 + shift,          o + shift,
                           o - grid_.row_stride,   o + grid_.row_stride,
                           o - grid_.plane_stride, o + grid_.plane_stride};
  const DiagonalOfRow diagonal{diagonal_[colour].data() + grid_.slot(0, j, k),
                               inverse_[colour].data() + grid_.slot(0, j, k)};
  if (irregular_[row]) {
    const auto faces = [&](int axis, int of, int at_row) {
      return faces_[axis][of].data() + faces_at_[at_row] + grid_.margin;
    };
    const Neighbors<float> f{faces(0, colour, row),
                             faces(0, 1 - colour, row) + shift,
                             faces(1, colour, row),
                             faces(1, 1 - colour, row_index(j + 1, k)),
                             dim == 3 ? faces(dim - 1, colour, row) : nullptr,
                             dim == 3 ? faces(dim - 1, 1 - colour, row_index(j, k + 1)) : nullptr};
    kernel(
        range.first, range.last, [f, x](int m) { return weighted_sum<dim>(f, x, m); }, diagonal);
    return;
  }
  const float unit = unit_;
  const auto sum = [x, unit](int m) {
    return unit * (x.left[m] + x.right[m] + sum_across<dim>(x, m));
  };
  const auto without_left = [x, unit](int m) {
    return unit * (x.right[m] + sum_across<dim>(x, m));
  };
  const auto without_right = [x, unit](int m) {
    return unit * (x.left[m] + sum_across<dim>(x, m));
  };
  const bool at_lower_end = rows_touch_ && shift == 0 && range.first == 0;
  const bool at_upper_end = rows_touch_ && shift == 1 && 2 * range.last == grid_.n[0];
  const auto visit = [&](const auto& inner, const auto& begin, const auto& end, bool ends_differ) {
    kernel(range.first, range.last, sum, inner);
    if (at_lower_end)
      kernel(0, 1, without_left, begin);
    else if (ends_differ)
      kernel(range.first, range.first + 1, sum, begin);
    if (at_upper_end)
      kernel(range.last - 1, range.last, without_right, end);
    else if (ends_differ)
      kernel(range.last - 1, range.last, sum, end);
  };
  const EvenRow& even = even_rows_[2 * row + colour];
  if (even.inner > 0)
    visit(EvenDiagonal(even.inner), EvenDiagonal(even.begin), EvenDiagonal(even.end),
          even.ends_differ());
  else
    visit(diagonal, diagonal, diagonal, false);
}

template <int dim>
void StencilLevel<dim>::relax(int colour, int slab, const float* b, const float* other,
                              float* x) const {
  const Rows rows = rows_of(slab);
  for (int j = rows.j_begin; j < rows.j_end; ++j) {
    const std::ptrdiff_t at = grid_.slot(0, j, rows.k);
    const float* b_row = b + at;
    float* x_row = x + at;
    const auto relax_row = [=](int first, int last, const auto& sum, const auto& diagonal) {
#pragma GCC ivdep
      for (int m = first; m < last; ++m)
        x_row[m] = diagonal.inverse(m) * (b_row[m] + sum(m));
    };
    with_sums({colour, j, rows.k}, other, relax_row);
  }
}

template <int dim>
void StencilLevel<dim>::relax_from_zero(int colour, int slab, const float* b, float* x) const {
  const Rows rows = rows_of(slab);
  for (int j = rows.j_begin; j < rows.j_end; ++j) {
    const std::ptrdiff_t at = grid_.slot(0, j, rows.k);
    const float* b_row = b + at;
    const float* inverse = inverse_[colour].data() + at;
    float* x_row = x + at;
    const Range r = range(j, rows.k);
    const EvenRow& even = even_rows_[2 * row_index(j, rows.k) + colour];
    if (even.inner > 0) {
      const float inverse_of_all = EvenDiagonal(even.inner).inverse_value;
      for (int m = r.first; m < r.last; ++m)
        x_row[m] = inverse_of_all * b_row[m];
      x_row[r.first] = EvenDiagonal(even.begin).inverse_value * b_row[r.first];
      x_row[r.last - 1] = EvenDiagonal(even.end).inverse_value * b_row[r.last - 1];
      continue;
    }
#pragma GCC ivdep
    for (int m = r.first; m < r.last; ++m)
      x_row[m] = inverse[m] * b_row[m];
  }
}

template <int dim>
void StencilLevel<dim>::add(int colour, int j, int k, const Range& slots, const float* correction,
                            float* x) const {
  const Range r = slots;
  if (is_full(colour, j, k)) {
#pragma GCC ivdep
    for (int m = r.first; m < r.last; ++m)
      x[m] += correction[m];
    return;
  }
  const float* diagonal = diagonal_[colour].data() + grid_.slot(0, j, k);
#pragma GCC ivdep
  for (int m = r.first; m < r.last; ++m)
    x[m] += diagonal[m] > 0 ? correction[m] : 0;
}

template <int dim>
void StencilLevel<dim>::residual(const Row& row, const float* b, const float* x, const float* other,
                                 float* residual) const {
  const std::ptrdiff_t at = grid_.slot(0, row.j, row.k);
  const float* b_row = b + at;
  const float* x_row = x + at;
  const auto subtract = [=](int first, int last, const auto& sum, const auto& diagonal) {
#pragma GCC ivdep
    for (int m = first; m < last; ++m) {
      const float value = b_row[m] + sum(m) - diagonal(m) * x_row[m];
      residual[m] = diagonal(m) > 0 ? value : 0;
    }
  };
  with_sums(row, other, subtract);
}

template <int dim>
float StencilLevel<dim>::residual_at(const Row& row, int m, const float* b, const float* x,
                                     const float* other) const {
  const std::ptrdiff_t at = grid_.slot(m, row.j, row.k);
  float result = 0;
  with_sums(row, other, [&](int first, int last, const auto& sum, const auto& diagonal) {
    if (first <= m && m < last)
      result = b[at] + sum(m) - diagonal(m) * x[at];
  });
  return result;
}

template <int dim>
void StencilLevel<dim>::multiply(const Row& row, double unit, const double* p, const double* other,
                                 double* result) const {
  const std::ptrdiff_t at = grid_.slot(0, row.j, row.k);
  const double* p_row = p + at;
  const auto multiply_row = [=](int first, int last, const auto& sum, const auto& diagonal) {
#pragma GCC ivdep
    for (int m = first; m < last; ++m) {
      const double value = unit * (diagonal(m) * p_row[m] - sum(m));
      result[m] = diagonal(m) > 0 ? value : 0;
    }
  };
  with_sums(row, other, multiply_row);
}

template class StencilLevel<2>;
template class StencilLevel<3>;

}  // namespace lockstep
