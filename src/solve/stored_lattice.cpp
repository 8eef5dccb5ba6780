#include "solve/stored_lattice.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>

#include "base/errors.hpp"
#include "output/hdf5_file.hpp"

namespace lockstep {

namespace {

const char* const lattice_group = "/lattice";
constexpr int n_axes = 3;

std::string axis_name(const char* what, int axis) {
  return std::string(what) + " " + "xyz"[axis];
}

class StoredStencil final : public StencilOperator {
 public:
  StoredStencil(RCP<const CrsMatrix> matrix, FaceCoefficients coefficients)
      : matrix_(std::move(matrix)), coefficients_(std::move(coefficients)) {}
  RCP<const Map> getDomainMap() const override { return matrix_->getDomainMap(); }
  RCP<const Map> getRangeMap() const override { return matrix_->getRangeMap(); }
  bool hasTransposeApply() const override { return true; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, double alpha,
             double beta) const override {
    matrix_->apply(x, y, Teuchos::NO_TRANS, alpha, beta);
  }
  const FaceCoefficients& coefficients() const override { return coefficients_; }
  RCP<const CrsMatrix> assembled() const override { return matrix_; }

 private:
  RCP<const CrsMatrix> matrix_;
  FaceCoefficients coefficients_;
};

/// Contents of the lattice_group for all unknowns, in the order of the file.
struct Stored {
  std::vector<long long> places, cells;            ///< unknown; its cell, three numbers each
  std::vector<double> lower, dirichlet, diagonal;  ///< three each; one; one, 0 where not stiff
};

/// Positive or zero, and no more than single precision holds.
bool is_coefficient(double value) {
  return value >= 0 && value <= std::numeric_limits<float>::max();
}

[[noreturn]] void refuse_lattice(const Hdf5File& file, const std::string& reason) {
  throw InputError(fmt::format(
      "'{}' holds no proper block system: its lattice {}. Write one with simulate --dump-system.",
      file.path(), reason));
}

Stored read_all(const Hdf5File& file, GlobalIndex n) {
  const auto name = [](const char* what) { return fmt::format("{}/{}", lattice_group, what); };
  const auto check = [&](const char* what, std::vector<GlobalIndex> shape) {
    if (!file.exists(name(what)) || file.shape(name(what)) != shape)
      refuse_lattice(file, fmt::format("has no table '{}' of {} unknowns", what, n));
  };
  check("places", {n});
  check("cells", {n, n_axes});
  check("lower", {n, n_axes});
  check("dirichlet", {n});
  check("diagonal", {n});
  return {file.read_all<long long>(name("places")), file.read_all<long long>(name("cells")),
          file.read_all<double>(name("lower")), file.read_all<double>(name("dirichlet")),
          file.read_all<double>(name("diagonal"))};
}

std::shared_ptr<LatticeBlocks> read_blocks(const Hdf5File& file) {
  constexpr long long most = 1 << 20;
  const auto blocks = std::make_shared<LatticeBlocks>();
  blocks->comm = file.communicator();
  blocks->dimension = static_cast<int>(file.read_attribute<long long>(lattice_group, "dimension"));
  blocks->width = static_cast<int>(file.read_attribute<long long>(lattice_group, "width"));
  if (blocks->dimension < 2 || blocks->dimension > n_axes || blocks->width < 1 ||
      blocks->width > 64 || (blocks->width & (blocks->width - 1)) != 0)
    refuse_lattice(file, fmt::format("has {} dimensions and blocks of {} cells", blocks->dimension,
                                     blocks->width));
  for (int axis = 0; axis < n_axes; ++axis) {
    const auto cells = file.read_attribute<long long>(lattice_group, axis_name("cells", axis));
    if (cells < 1 || cells > most)
      refuse_lattice(file, fmt::format("has {} cells along an axis", cells));
    blocks->n_cells[axis] = static_cast<int>(cells);
    blocks->periodic[axis] =
        file.read_attribute<long long>(lattice_group, axis_name("periodic", axis)) != 0;
  }
  return blocks;
}

/// Blocks in lexicographic order, x fastest.
using BlockBegin = std::array<int, n_axes>;
struct LastAxisFirst {
  bool operator()(const BlockBegin& a, const BlockBegin& b) const {
    return std::lexicographical_compare(a.rbegin(), a.rend(), b.rbegin(), b.rend());
  }
};

class LatticeReader {
 public:
  LatticeReader(const Hdf5File& file, GlobalIndex n)
      : file_(file), stored_(read_all(file, n)), blocks_(read_blocks(file)) {}

  FaceCoefficients coefficients() {
    check_tables();
    check_cells();
    deal_out();
    FaceCoefficients result;
    result.blocks = blocks_;
    result.unit = file_.read_attribute<double>(lattice_group, "unit");
    if (!(result.unit > 0) || !std::isfinite(result.unit))
      refuse_lattice(file_, fmt::format("has the unit {}", result.unit));
    const std::size_t n_cells = blocks_->begins.size() * blocks_->block_volume();
    result.row.assign(n_cells, -1);
    result.dirichlet.assign(n_cells, 0);
    for (auto& lower : result.lower)
      lower.assign(n_cells, 0);
    std::vector<long long> entry_of_cell(n_cells, -1);
    for (std::size_t i = 0; i < stored_.places.size(); ++i) {
      const long long cell = own_cell(i);
      if (cell >= 0)
        entry_of_cell[cell] = static_cast<long long>(i);
    }
    std::vector<GlobalIndex> ids;
    for (std::size_t cell = 0; cell < n_cells; ++cell) {
      if (entry_of_cell[cell] < 0)
        continue;
      result.row[cell] = static_cast<int>(ids.size());
      set_cell(cell, static_cast<std::size_t>(entry_of_cell[cell]), result);
      ids.push_back(stored_.places[entry_of_cell[cell]]);
    }
    result.map = rcp(new Map(static_cast<GlobalIndex>(stored_.places.size()),
                             Teuchos::arrayViewFromVector(ids), 0, blocks_->comm));
    return result;
  }

 private:
  BlockBegin block_of(std::size_t i) const {
    BlockBegin begin{};
    for (int axis = 0; axis < blocks_->dimension; ++axis)
      begin[axis] =
          static_cast<int>(stored_.cells[n_axes * i + axis]) / blocks_->width * blocks_->width;
    return begin;
  }

  /// True if no two unknowns are in one cell; on all ranks, so that all of them refuse the file.
  void check_cells() const {
    std::vector<std::array<long long, n_axes>> cells(stored_.places.size());
    for (std::size_t i = 0; i < cells.size(); ++i)
      std::copy_n(stored_.cells.begin() + static_cast<std::ptrdiff_t>(n_axes * i), n_axes,
                  cells[i].begin());
    std::sort(cells.begin(), cells.end());
    if (std::adjacent_find(cells.begin(), cells.end()) != cells.end())
      refuse_lattice(file_, "has two unknowns in one cell");
  }

  void check_tables() const {
    const auto n = static_cast<long long>(stored_.places.size());
    std::vector<bool> seen(stored_.places.size(), false);
    for (std::size_t i = 0; i < stored_.places.size(); ++i) {
      const long long place = stored_.places[i];
      if (place < 0 || place >= n || seen[static_cast<std::size_t>(place)])
        refuse_lattice(file_,
                       fmt::format("names the unknown {} outside or for the second time", place));
      seen[static_cast<std::size_t>(place)] = true;
      for (int axis = 0; axis < n_axes; ++axis) {
        const long long at = stored_.cells[n_axes * i + axis];
        if (at < 0 || at >= blocks_->n_cells[axis])
          refuse_lattice(file_, fmt::format("has a cell at {} of {} along an axis", at,
                                            blocks_->n_cells[axis]));
        if (!is_coefficient(stored_.lower[n_axes * i + axis]))
          refuse_lattice(file_, "has a face with a coefficient that none can be");
      }
      if (!is_coefficient(stored_.dirichlet[i]) || !is_coefficient(stored_.diagonal[i]))
        refuse_lattice(file_, "has a coefficient that none can be");
    }
  }

  void deal_out() {
    std::map<BlockBegin, int, LastAxisFirst> all;
    for (std::size_t i = 0; i < stored_.places.size(); ++i)
      all.emplace(block_of(i), -1);
    const auto n = static_cast<GlobalIndex>(all.size());
    const GlobalIndex size = blocks_->comm->getSize(), rank = blocks_->comm->getRank();
    GlobalIndex number = 0;
    for (const auto& [begin, unused] : all) {
      if (number >= n * rank / size && number < n * (rank + 1) / size) {
        local_[begin] = static_cast<int>(blocks_->begins.size());
        blocks_->begins.push_back(begin);
      }
      ++number;
    }
  }

  /// Number of the unknown's cell among this rank's cells; -1 if the cell is another rank's.
  long long own_cell(std::size_t i) const {
    const auto block = local_.find(block_of(i));
    if (block == local_.end())
      return -1;
    long long in_block = 0;
    for (int axis = blocks_->dimension - 1; axis >= 0; --axis)
      in_block = in_block * blocks_->width + stored_.cells[n_axes * i + axis] - block->first[axis];
    return static_cast<long long>(block->second) * blocks_->block_volume() + in_block;
  }

  void set_cell(std::size_t cell, std::size_t i, FaceCoefficients& result) const {
    for (int axis = 0; axis < n_axes; ++axis)
      result.lower[axis][cell] = static_cast<float>(stored_.lower[n_axes * i + axis]);
    result.dirichlet[cell] = static_cast<float>(stored_.dirichlet[i]);
    if (stored_.diagonal[i] > 0)
      result.stiff.push_back({static_cast<int>(cell), stored_.dirichlet[i], stored_.diagonal[i]});
  }

  const Hdf5File& file_;
  Stored stored_;
  std::shared_ptr<LatticeBlocks> blocks_;
  std::map<BlockBegin, int, LastAxisFirst> local_;  ///< this rank's blocks, numbered
};

}  // namespace

void write_lattice(Hdf5File& file, const FaceCoefficients& stencil) {
  const LatticeBlocks& blocks = *stencil.blocks;
  Stored stored;
  auto stiff = stencil.stiff.begin();
  for (std::size_t cell = 0; cell < blocks.begins.size() * blocks.block_volume(); ++cell) {
    const bool is_stiff =
        stiff != stencil.stiff.end() && static_cast<std::size_t>(stiff->cell) == cell;
    const double full = is_stiff ? stiff->dirichlet : stencil.dirichlet[cell];
    const double diagonal = is_stiff ? stiff->diagonal : 0;
    if (is_stiff)
      ++stiff;
    if (stencil.row[cell] < 0)
      continue;
    stored.places.push_back(stencil.map->getGlobalElement(stencil.row[cell]));
    const auto& begin = blocks.begins[cell / blocks.block_volume()];
    auto in_block = static_cast<int>(cell % blocks.block_volume());
    for (int axis = 0; axis < n_axes; ++axis, in_block /= blocks.width) {
      stored.cells.push_back(begin[axis] + in_block % blocks.width);
      stored.lower.push_back(axis < blocks.dimension ? stencil.lower[axis][cell] : 0);
    }
    stored.dirichlet.push_back(full);
    stored.diagonal.push_back(diagonal);
  }
  file.create_group(lattice_group);
  file.write_attribute<long long>(lattice_group, "dimension", blocks.dimension);
  file.write_attribute<long long>(lattice_group, "width", blocks.width);
  file.write_attribute<double>(lattice_group, "unit", stencil.unit);
  for (int axis = 0; axis < n_axes; ++axis) {
    file.write_attribute<long long>(lattice_group, axis_name("cells", axis), blocks.n_cells[axis]);
    file.write_attribute<long long>(lattice_group, axis_name("periodic", axis),
                                    blocks.periodic[axis] ? 1 : 0);
  }
  const std::string path = lattice_group;
  file.write_slices(path + "/places", stored.places);
  file.write_slices(path + "/cells", stored.cells, n_axes);
  file.write_slices(path + "/lower", stored.lower, n_axes);
  file.write_slices(path + "/dirichlet", stored.dirichlet);
  file.write_slices(path + "/diagonal", stored.diagonal);
}

std::optional<FaceCoefficients> read_lattice(const Hdf5File& file, GlobalIndex n) {
  if (!file.exists(lattice_group) || !file.exists(std::string(lattice_group) + "/lower"))
    return std::nullopt;
  return LatticeReader(file, n).coefficients();
}

RCP<const StencilOperator> stored_stencil(const RCP<const CrsMatrix>& matrix,
                                          const FaceCoefficients& coefficients) {
  return rcp(new StoredStencil(matrix, coefficients));
}

}  // namespace lockstep
