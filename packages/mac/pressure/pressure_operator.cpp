#include "mac/pressure/pressure_operator.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <limits>

#include "linear/row_builder.hpp"

namespace lockstep {

namespace {

/// Sums of faces and of a dirichlet coefficient of at most so much are exact in single precision:
/// open fractions are multiples of 2^-20, and so is what this is rounded to.
constexpr double largest_exact = 8;
double rounded_for_sums(double value) {
  constexpr double steps = 1 << 20;
  return value > largest_exact ? value : std::round(value * steps) / steps;
}

/// True if single precision adds up these coefficients without rounding: all are multiples of the
/// last digit of their sum. Those of two phases need not be.
template <int dim>
bool add_up_exactly(const std::array<double, 2 * dim>& coefficients, double sum) {
  constexpr int digits = std::numeric_limits<float>::digits;
  int exponent = 0;
  std::frexp(sum, &exponent);
  return std::all_of(coefficients.begin(), coefficients.end(), [&](double coefficient) {
    const double in_last_digits = std::ldexp(coefficient, digits - exponent);
    return in_last_digits == std::floor(in_last_digits);
  });
}

/// True if all faces of a strip of cells are regular and lead to fluid.
template <int dim>
bool is_among_fluid(const MacGeometry<dim>& geometry, const CellStrip<dim>& row) {
  const auto& cells = geometry.state.cells;
  if (!geometry.has_regular_faces(row) || row.neighbors[0] < 0 ||
      cells[row.neighbors[0]] != CellState::fluid || cells[row.neighbors[1]] != CellState::fluid)
    return false;
  for (int side = 2; side < 2 * dim; ++side)
    if (row.neighbors[side] < 0 ||
        !is_row_of<dim>(CellState::fluid, cells.data() + row.neighbors[side]))
      return false;
  return true;
}

/// Coefficients of all faces of owned cells: the upper ones of the last cells belong to stored
/// ghost cells, whose geometry is known here too.
template <int dim>
FaceCoefficients face_coefficients(const MacDomain<dim>& domain, const MacGeometry<dim>& geometry,
                                   std::shared_ptr<const LatticeBlocks> blocks) {
  const auto& cells = geometry.state.cells;
  const std::size_t n = domain.grid.n_stored_cells();
  FaceCoefficients result;
  result.blocks = std::move(blocks);
  result.map = geometry.pressure_map;
  result.unit = geometry.face_table.unit_coefficient();
  result.row.assign(n, -1);
  result.dirichlet.assign(n, 0);
  for (int axis = 0; axis < dim; ++axis)
    result.lower[axis].assign(n, 0);
  if (!geometry.lightness.empty())
    result.regular = geometry.lightness;
  int row = 0;
  const auto add_cell = [&](int cell, const auto& neighbors) {
    if (cells[cell] != CellState::fluid)
      return;
    result.row[cell] = row++;
    double dirichlet = 0, faces = 0;
    std::array<double, 2 * dim> coefficients{};
    for (int axis = 0; axis < dim; ++axis) {
      for (int end = 0; end < 2; ++end) {
        const int other = neighbors[2 * axis + end];
        const int face = end == 0 ? cell : other;
        if (face < 0 || geometry.open_fraction(axis, face) == 0)
          continue;
        const double coefficient = geometry.face_table(axis, face).coefficient;
        if (other < 0 || cells[other] != CellState::fluid)
          dirichlet += coefficient;
        else
          faces += coefficients[2 * axis + end] = result.lower[axis][face] =
              static_cast<float>(coefficient);
      }
    }
    result.dirichlet[cell] = static_cast<float>(rounded_for_sums(dirichlet));
    if (dirichlet > largest_exact || result.dirichlet[cell] != dirichlet ||
        !add_up_exactly<dim>(coefficients, faces))
      result.stiff.push_back({cell, dirichlet, dirichlet + faces});
  };
  const auto regular = static_cast<float>(geometry.face_table.regular().coefficient);
  domain.grid.for_each_owned_strip([&](const CellStrip<dim>& fluid) {
    if (!is_among_fluid(geometry, fluid)) {
      fluid.for_each_cell(add_cell);
      return;
    }
    for (int x = 0; x < fluid.n; ++x)
      result.row[fluid.begin + x] = row++;
    for (int axis = 0; axis < dim; ++axis)
      std::fill_n(result.lower[axis].begin() + fluid.begin, fluid.n, regular);
    result.lower[0][fluid.neighbors[1]] = regular;
    for (int axis = 1; axis < dim; ++axis)
      std::fill_n(result.lower[axis].begin() + fluid.neighbors[2 * axis + 1], fluid.n, regular);
  });
  return result;
}

template <int dim>
class MacPressureOperator final : public StencilOperator {
 public:
  MacPressureOperator(const MacDomain<dim>& domain, FaceCoefficients coefficients)
      : domain_(domain), coefficients_(std::move(coefficients)) {}

  RCP<const Map> getDomainMap() const override { return coefficients_.map; }
  RCP<const Map> getRangeMap() const override { return coefficients_.map; }
  bool hasTransposeApply() const override { return true; }
  const FaceCoefficients& coefficients() const override { return coefficients_; }

  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, double alpha,
             double beta) const override {
    if (!matrix_.is_null()) {
      matrix_->apply(x, y, Teuchos::NO_TRANS, alpha, beta);
      return;
    }
    for (std::size_t column = 0; column < x.getNumVectors(); ++column)
      apply_to(*x.getVector(column), *y.getVectorNonConst(column), alpha, beta);
  }

  RCP<const CrsMatrix> assembled() const override;

 private:
  /// Calls f(row, neighbours, coefficients of the faces to them) for a cell.
  template <typename Function>
  void with_faces(int cell, const std::array<int, 2 * dim>& neighbors, const Function& f) const;
  /// True if a whole strip of cells are unknowns, with cells on all sides.
  bool is_whole(const CellStrip<dim>& cells) const;
  /// A x over the unit coefficient for such a row.
  StripValues<dim> product(const CellStrip<dim>& cells) const;
  void apply_to(const Vector& x, Vector& y, double alpha, double beta) const;

  const MacDomain<dim>& domain_;
  FaceCoefficients coefficients_;
  mutable CellField field_;
  mutable RCP<const CrsMatrix> matrix_;
};

template <int dim>
template <typename Function>
void MacPressureOperator<dim>::with_faces(int cell, const std::array<int, 2 * dim>& neighbors,
                                          const Function& f) const {
  const int row = coefficients_.row[cell];
  if (row < 0)
    return;
  std::array<double, 2 * dim> face;
  for (int axis = 0; axis < dim; ++axis) {
    const int upper = neighbors[2 * axis + 1];
    face[2 * axis] = coefficients_.lower[axis][cell];
    face[2 * axis + 1] = upper < 0 ? 0 : coefficients_.lower[axis][upper];
  }
  f(row, face);
}

template <int dim>
bool MacPressureOperator<dim>::is_whole(const CellStrip<dim>& cells) const {
  for (const int neighbor : cells.neighbors)
    if (neighbor < 0)
      return false;
  constexpr int last = tile_width<dim> - 1;
  const int* row = coefficients_.row.data() + cells.begin;
  return cells.n == tile_width<dim> && row[0] >= 0 && row[last] == row[0] + last;
}

template <int dim>
StripValues<dim> MacPressureOperator<dim>::product(const CellStrip<dim>& cells) const {
  constexpr int width = tile_width<dim>;
  using Faces = Eigen::Map<const Eigen::Array<float, width, 1>>;
  const double* x = field_.data();
  const StripValues<dim> own = row_of<dim>(x, cells.begin);
  StripValues<dim> sum =
      Faces(coefficients_.dirichlet.data() + cells.begin).template cast<double>();
  sum *= own;
  // Over the faces along the row, the two at its ends too.
  const float* along = coefficients_.lower[0].data() + cells.begin;
  std::array<double, width + 1> flux;
  flux[0] = along[0] * (own[0] - x[cells.neighbors[0]]);
  for (int i = 1; i < width; ++i)
    flux[i] = along[i] * (x[cells.begin + i] - x[cells.begin + i - 1]);
  flux[width] =
      coefficients_.lower[0][cells.neighbors[1]] * (x[cells.neighbors[1]] - own[width - 1]);
  for (int i = 0; i < width; ++i)
    sum[i] += flux[i] - flux[i + 1];
  for (int axis = 1; axis < dim; ++axis) {
    const float* lower = coefficients_.lower[axis].data();
    const int below = cells.neighbors[2 * axis], above = cells.neighbors[2 * axis + 1];
    sum += Faces(lower + cells.begin).template cast<double>() * (own - row_of<dim>(x, below)) +
           Faces(lower + above).template cast<double>() * (own - row_of<dim>(x, above));
  }
  return sum;
}

template <int dim>
void MacPressureOperator<dim>::apply_to(const Vector& x, Vector& y, double alpha,
                                        double beta) const {
  field_.assign(domain_.grid.n_stored_cells(), 0.0);
  const auto in = x.getData();
  domain_.grid.for_each_owned_cell([&](int cell) {
    if (coefficients_.row[cell] >= 0)
      field_[cell] = in[coefficients_.row[cell]];
  });
  domain_.halo.fill(field_);
  const auto out = y.getDataNonConst();
  const double scale = alpha * coefficients_.unit;
  const auto multiply_one = [&](int cell, const auto& neighbors) {
    with_faces(cell, neighbors, [&](int row, const auto& face) {
      double sum = coefficients_.dirichlet[cell] * field_[cell];
      for (int side = 0; side < 2 * dim; ++side) {
        if (face[side] != 0)
          sum += face[side] * (field_[cell] - field_[neighbors[side]]);
      }
      out[row] = scale * sum + (beta == 0 ? 0 : beta * out[row]);
    });
  };
  domain_.grid.for_each_owned_strip([&](const CellStrip<dim>& cells) {
    if (!is_whole(cells)) {
      cells.for_each_cell(multiply_one);
      return;
    }
    auto result = row_of<dim>(out.getRawPtr(), coefficients_.row[cells.begin]);
    const StripValues<dim> before = beta == 0 ? StripValues<dim>::Zero() : StripValues<dim>(result);
    result = scale * product(cells) + beta * before;
  });
  for (const auto& [cell, dirichlet, diagonal] : coefficients_.stiff)
    out[coefficients_.row[cell]] +=
        scale * (dirichlet - coefficients_.dirichlet[cell]) * field_[cell];
}

template <int dim>
RCP<const CrsMatrix> MacPressureOperator<dim>::assembled() const {
  if (!matrix_.is_null())
    return matrix_;
  std::vector<GlobalIndex> unknown(domain_.grid.n_stored_cells(), no_index);
  domain_.grid.for_each_owned_cell([&](int cell) {
    if (coefficients_.row[cell] >= 0)
      unknown[cell] = coefficients_.map->getGlobalElement(coefficients_.row[cell]);
  });
  domain_.halo.fill(unknown);
  RowBuilder rows(coefficients_.map, 2 * dim + 1);
  auto stiff = coefficients_.stiff.begin();
  const auto add_row = [&](int cell, const auto& neighbors, const auto& face) {
    double diagonal = coefficients_.dirichlet[cell];
    if (stiff != coefficients_.stiff.end() && stiff->cell == cell)
      diagonal = (stiff++)->dirichlet;
    const auto add = [&](int side) {
      if (face[side] == 0)
        return;
      diagonal += face[side];
      rows.add(unknown[neighbors[side]], -coefficients_.unit * face[side]);
    };
    // in the order of the ids within a tile
    for (int axis = dim - 1; axis >= 0; --axis)
      add(2 * axis);
    const std::size_t middle = rows.add(unknown[cell], 0);
    for (int axis = 0; axis < dim; ++axis)
      add(2 * axis + 1);
    rows.set(middle, coefficients_.unit * diagonal);
    rows.end_row();
  };
  domain_.grid.for_each_owned_cell_with_neighbors([&](int cell, const auto& neighbors) {
    with_faces(cell, neighbors, [&](int, const auto& face) { add_row(cell, neighbors, face); });
  });
  matrix_ = rows.finish();
  return matrix_;
}

}  // namespace

template <int dim>
std::shared_ptr<const LatticeBlocks> lattice_blocks(const TiledGrid<dim>& grid) {
  LatticeBlocks blocks;
  blocks.dimension = dim;
  blocks.width = tile_width<dim>;
  blocks.comm = grid.comm();
  Index<dim> begin{};
  for (int axis = 0; axis < dim; ++axis) {
    blocks.periodic[axis] = grid.description().periodic[axis];
    begin[axis] = blocks.periodic[axis] ? 0 : grid.extent()[0][axis];
    const int end = blocks.periodic[axis] ? grid.n_cells()[axis] : grid.extent()[1][axis];
    blocks.n_cells[axis] = end - begin[axis];
  }
  for (int tile = 0; tile < grid.n_owned_tiles(); ++tile) {
    std::array<int, 3>& block = blocks.begins.emplace_back();
    for (int axis = 0; axis < dim; ++axis)
      block[axis] = grid.tile_begin(tile)[axis] - begin[axis];
  }
  return std::make_shared<const LatticeBlocks>(std::move(blocks));
}

template <int dim>
RCP<const StencilOperator> pressure_operator(const MacDomain<dim>& domain,
                                             const MacGeometry<dim>& geometry,
                                             std::shared_ptr<const LatticeBlocks> blocks) {
  return rcp(
      new MacPressureOperator<dim>(domain, face_coefficients(domain, geometry, std::move(blocks))));
}

template std::shared_ptr<const LatticeBlocks> lattice_blocks<2>(const TiledGrid<2>&);
template std::shared_ptr<const LatticeBlocks> lattice_blocks<3>(const TiledGrid<3>&);
template RCP<const StencilOperator> pressure_operator<2>(const MacDomain<2>&, const MacGeometry<2>&,
                                                         std::shared_ptr<const LatticeBlocks>);
template RCP<const StencilOperator> pressure_operator<3>(const MacDomain<3>&, const MacGeometry<3>&,
                                                         std::shared_ptr<const LatticeBlocks>);

}  // namespace lockstep
