#pragma once
#include <algorithm>
#include <array>
#include <vector>

#include "multigrid/aligned_array.hpp"
#include "multigrid/lattice_layout.hpp"

namespace lockstep {

/// The stencil of one level in natural arrays, ghosts included, on which set-up works. `lower[a]`
/// couples a cell to its lower neighbour along a; 0 where there is no coupling.
struct NaturalStencil {
  std::array<std::vector<float>, 3> lower;
  std::vector<float> dirichlet;
  std::vector<float> reaction;  ///< empty: none, on any rank
  /// Coupling through a whole face in the fluid of a cell; empty: the level's regular one.
  std::vector<float> regular;
  std::vector<float> diagonal;  ///< sum of the cell's faces and those two, as its owner has it
  std::vector<char> active;     ///< the cell is an unknown, here or, of ghosts, on its own rank

  void resize(const LevelGrid& grid, bool has_reaction, bool has_phases);
  /// Fills `diagonal`, `active` and the ghosts of `lower` from the owned values, as deep as the
  /// level's ghosts go. Collective.
  void complete(const LayoutLevel& level);
};

/// One level of the stencil in the form that sweeps read: the diagonal and its inverse by colour,
/// and face coefficients for those rows only in which some coupling between unknowns is not the
/// level's regular one (`unit`): elsewhere the sweeps need no coefficients at all, for values that
/// are no unknowns are zero. Nor do they read the diagonal where it is the same along a row but for
/// its ends.
template <int dim>
class StencilLevel {
 public:
  /// `level` must outlive it.
  explicit StencilLevel(const LayoutLevel& level);

  void set(const NaturalStencil& stencil, float unit);

  const LevelGrid& grid() const { return grid_; }
  const AlignedArray<float>& diagonal(int colour) const { return diagonal_[colour]; }
  /// Slots [first, last) of row (j, k) hold all its unknowns, ghosts too; empty rows are (0, 0).
  struct Range {
    int first = 0, last = 0;
  };
  const Range& range(int j, int k) const { return ranges_[row_index(j, k)]; }
  /// True if no unknown of a row is this rank's.
  bool is_foreign(int j, int k) const { return level_.parts(j, k).empty(); }
  /// Calls f(first, last) for the slots in `range` of cells that are this rank's.
  template <typename Function>
  void for_each_own_range(int j, int k, const Function& f) const {
    const Range& row = range(j, k);
    for (const LayoutLevel::Part& part : level_.parts(j, k)) {
      const int first = std::max(part.begin / 2, row.first);
      const int last = std::min((part.end + 1) / 2, row.last);
      if (first < last)
        f(first, last);
    }
  }
  /// True if all slots of a row's range are known to be unknowns of that colour.
  bool is_full(int colour, int j, int k) const {
    const EvenRow& row = even_rows_[2 * row_index(j, k) + colour];
    return row.inner > 0 && row.begin > 0 && row.end > 0;
  }
  std::size_t bytes() const;

  /// Cells of one colour in row (j, k).
  struct Row {
    int colour, j, k;
  };
  /// x := D^-1 (b + N x_other) on one colour of a slab: a Gauss-Seidel half sweep.
  void relax(int colour, int slab, const float* b, const float* other, float* x) const;
  /// x := D^-1 b on one colour of a slab.
  void relax_from_zero(int colour, int slab, const float* b, float* x) const;
  /// x += correction where there is an unknown in slots [first, last) of a row, which must be in
  /// its range; both begin with slot 0.
  void add(int colour, int j, int k, const Range& slots, const float* correction, float* x) const;
  /// residual := b - (A x) of one row, 0 where there is no unknown, in slots [first, last).
  void residual(const Row& row, const float* b, const float* x, const float* other,
                float* residual) const;
  /// Returns the residual of one cell, in slot m of the row.
  float residual_at(const Row& row, int m, const float* b, const float* x,
                    const float* other) const;
  /// result := unit A p of one row in double precision, in slots [first, last).
  void multiply(const Row& row, double unit, const double* p, const double* other,
                double* result) const;

  /// The first and one beyond the last row (j) and plane (k) of a slab.
  struct Rows {
    int j_begin, j_end, k;
  };
  Rows rows_of(int slab) const {
    return dim == 3 ? Rows{0, grid_.n[1], slab} : Rows{slab, slab + 1, 0};
  }

 private:
  int row_index(int j, int k) const { return j + (grid_.n[1] + 1) * k; }
  void set_diagonal(const NaturalStencil& stencil);
  void find_irregular_rows(const NaturalStencil& stencil);
  bool is_irregular(const NaturalStencil& stencil, int j, int k) const;
  void copy_faces(const NaturalStencil& stencil);
  void find_even_rows();
  /// Calls kernel(first, last, sum, diagonal) so that sum(m) is the sum over the cell's neighbours,
  /// each times its coefficient, and diagonal(m) its diagonal; some slots may be visited twice
  /// (then with the right ones last).
  template <typename Value, typename Kernel>
  void with_sums(const Row& cells, const Value* other, const Kernel& kernel) const;

  const LayoutLevel& level_;
  const LevelGrid& grid_;
  bool rows_touch_;  ///< the last slot of a row is a cell, and the first of the next follows it
  float unit_ = 1;
  std::array<AlignedArray<float>, 2> diagonal_, inverse_;
  std::vector<Range> ranges_;
  std::vector<std::ptrdiff_t> faces_at_;  ///< by row: where its faces begin, or -1
  std::vector<char> irregular_;           ///< by row
  /// The diagonal of a row of one colour, if it is the same but for the first and last slot.
  struct EvenRow {
    float inner = 0;  ///< 0: it is not
    float begin = 0, end = 0;
    bool ends_differ() const { return begin != inner || end != inner; }
  };
  std::vector<EvenRow> even_rows_;                            ///< by row and colour
  std::array<std::array<std::vector<float>, 2>, dim> faces_;  ///< [axis][colour]
};

extern template class StencilLevel<2>;
extern template class StencilLevel<3>;

}  // namespace lockstep
