#include "multigrid/pressure_layout.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <tuple>

#include "base/errors.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/overlap.hpp"
#include "multigrid/layout_kernels.hpp"
#include "multigrid/layout_operators.hpp"
#include "multigrid/schur_stencil.hpp"
#include "solve/added_mass_diagonal.hpp"

namespace lockstep {

namespace {
template <int dim>
class PressureLayoutOf final : public PressureLayout {
 public:
  PressureLayoutOf(std::shared_ptr<const LatticeLayout> layout, const MultigridOptions& options)
      : options_(options), multigrid_(layout, options) {
    layout_ = std::move(layout);
    map_ = make_map(static_cast<int>(2 * layout_->finest().n_slots), layout_->blocks().comm);
  }

  void set(const BlockSystem& system) {
    const FaceCoefficients& coefficients = *stencil_of(system.pressure_block());
    multigrid_.set(coefficients);
    number_rows(coefficients);
    empty_rows_ = find_empty_rows();
    std::vector<int> entries;
    for (const int row : empty_rows_)
      entries.push_back(entry_of_row_[row]);
    stencil_ = rcp(new LayoutStencil<dim>(map_, multigrid_.finest(), layout_->levels().front().halo,
                                          coefficients.unit, std::move(entries),
                                          diagonal_rests(coefficients)));
    if (direction_.is_null())
      direction_ = make_vector(map_);
    direction_->putScalar(0);
    own_ = with_cycle_of(multigrid_, system);
    of_schur_ = {};
  }
  bool update_empty_rows(const BlockSystem& system) override {
    if (!some_row_is_empty())
      return false;
    own_ = with_cycle_of(multigrid_, system);
    if (has_schur_inverse())
      of_schur_ = schur_multigrid_ ? with_cycle_of(*schur_multigrid_, system) : own_;
    return true;
  }
  void build_schur_inverse(const BlockSystem& system,
                           const LinearOperator& solid_inverse) override {
    if (has_schur_inverse() && !schur_depends_on_solid_block_)
      return;
    const auto schur = schur_stencil(system, solid_inverse, empty_rows_);
    schur_depends_on_solid_block_ = !system.near_null_space.empty();
    if (!schur) {
      schur_multigrid_.reset();
      of_schur_ = own_;
      return;
    }
    if (!schur_multigrid_)
      schur_multigrid_ = std::make_unique<Multigrid<dim>>(layout_, options_);
    schur_multigrid_->set(*schur);
    of_schur_ = with_cycle_of(*schur_multigrid_, system);
  }
  bool has_schur_inverse() const override { return !of_schur_.inverse.is_null(); }
  const std::shared_ptr<const LatticeLayout>& layout() const { return layout_; }

  RCP<const LinearOperator> pressure_block() const override { return as_thyra_operator(stencil_); }
  RCP<const LinearOperator> inverse() const override { return as_thyra_operator(own_.inverse); }
  RCP<const LinearOperator> schur_inverse() const override {
    return as_thyra_operator(of_schur_.inverse);
  }
  ConjugateGradientKernels& kernels() override { return *own_.kernels; }
  ConjugateGradientKernels& schur_kernels() override { return *of_schur_.kernels; }
  std::size_t bytes() const override {
    return multigrid_.bytes() + (schur_multigrid_ ? schur_multigrid_->bytes() : 0);
  }
  MessageCount sent() const override {
    MessageCount total;
    const auto add = [&total](const LevelHalo& halo) {
      total.messages += halo.sent().messages;
      total.bytes += halo.sent().bytes;
    };
    for (const LayoutLevel& level : layout_->levels()) {
      add(level.halo);
      add(level.deep_halo);
      if (level.landing)
        add(level.landing->halo);
    }
    return total;
  }

 private:
  void number_rows(const FaceCoefficients& coefficients);
  std::vector<DiagonalRest> diagonal_rests(const FaceCoefficients& coefficients) const;
  std::vector<int> find_empty_rows() const;
  bool some_row_is_empty() const {
    return sum_all(layout_->blocks().comm, static_cast<GlobalIndex>(empty_rows_.size())) > 0;
  }
  std::vector<EmptyRow> with_values(const BlockSystem& system) const;

  /// A multigrid's cycle, and conjugate gradients on A with it.
  struct Preconditioned {
    RCP<const LayoutInverse<dim>> inverse;
    std::shared_ptr<LayoutKernels<dim>> kernels;
  };
  Preconditioned with_cycle_of(Multigrid<dim>& multigrid, const BlockSystem& system) const {
    const RCP<const LayoutInverse<dim>> inverse =
        rcp(new LayoutInverse<dim>(map_, multigrid, layout_->blocks().comm,
                                   stencil_of(system.pressure_block())->unit, with_values(system)));
    return {inverse,
            std::make_shared<LayoutKernels<dim>>(stencil_, inverse, layout_->levels().front().halo,
                                                 direction_, layout_->blocks().comm)};
  }

  MultigridOptions options_;
  Multigrid<dim> multigrid_;
  std::unique_ptr<Multigrid<dim>> schur_multigrid_;  ///< null: that of A serves
  bool schur_depends_on_solid_block_ = false;
  std::vector<int> empty_rows_;  ///< local rows that A leaves empty
  RCP<const LayoutStencil<dim>> stencil_;
  RCP<Vector> direction_;  ///< direction of both kernels; zero where neither has an unknown
  Preconditioned own_, of_schur_;
};

template <int dim>
void PressureLayoutOf<dim>::number_rows(const FaceCoefficients& coefficients) {
  const LevelGrid& grid = layout_->finest();
  entry_of_row_.resize(coefficients.map->getNodeNumElements());
  for_each_cell(layout_->blocks(), [&](std::size_t cell, const std::array<int, 3>& at) {
    const int row = coefficients.row[cell];
    if (row < 0)
      return;
    const int x = at[0] - grid.begin[0], y = at[1] - grid.begin[1], z = at[2] - grid.begin[2];
    entry_of_row_[row] =
        static_cast<int>(LevelGrid::colour(x, y, z) * grid.n_slots + grid.slot_of_cell(x, y, z));
  });
}

template <int dim>
std::vector<DiagonalRest> PressureLayoutOf<dim>::diagonal_rests(
    const FaceCoefficients& coefficients) const {
  const LevelGrid& grid = layout_->finest();
  const LatticeBlocks& blocks = layout_->blocks();
  std::vector<DiagonalRest> rests;
  for (const auto& [cell, dirichlet, diagonal] : coefficients.stiff) {
    std::array<int, 3> at = blocks.begins[cell / blocks.block_volume()];
    for (int axis = 0, in_block = cell % blocks.block_volume(); axis < dim;
         ++axis, in_block /= blocks.width)
      at[axis] += in_block % blocks.width - grid.begin[axis];
    const int x = at[0], y = at[1], z = dim == 3 ? at[2] : 0;
    const int colour = LevelGrid::colour(x, y, z);
    const std::ptrdiff_t slot = grid.slot_of_cell(x, y, z);
    const double rest = diagonal - multigrid_.finest().diagonal(colour)[slot];
    if (rest != 0)
      rests.push_back({2 * (y + grid.n[1] * z) + colour, slot, rest});
  }
  std::sort(rests.begin(), rests.end(), [](const DiagonalRest& a, const DiagonalRest& b) {
    return std::tie(a.row, a.slot) < std::tie(b.row, b.slot);
  });
  return rests;
}

template <int dim>
std::vector<int> PressureLayoutOf<dim>::find_empty_rows() const {
  const std::ptrdiff_t n_slots = layout_->finest().n_slots;
  std::vector<int> rows;
  for (int row = 0; row < static_cast<int>(entry_of_row_.size()); ++row) {
    const int entry = entry_of_row_[row];
    if (multigrid_.finest().diagonal(static_cast<int>(entry / n_slots))[entry % n_slots] == 0)
      rows.push_back(row);
  }
  return rows;
}

template <int dim>
std::vector<EmptyRow> PressureLayoutOf<dim>::with_values(const BlockSystem& system) const {
  std::vector<EmptyRow> result;
  if (!some_row_is_empty())
    return result;
  const auto added = added_mass_diagonal(system, domain_map(*system.pressure_block()));
  const auto values = added->getData();
  const double unit = stencil_of(system.pressure_block())->unit;
  for (const int row : empty_rows_)
    result.push_back({entry_of_row_[row], 1 / (values[row] > 0 ? values[row] : 2 * dim * unit)});
  return result;
}

template <int dim>
std::shared_ptr<PressureLayout> make_layout(const BlockSystem& system,
                                            const MultigridOptions& options,
                                            const std::shared_ptr<PressureLayout>& previous) {
  const FaceCoefficients& coefficients = *stencil_of(system.pressure_block());
  auto result = std::dynamic_pointer_cast<PressureLayoutOf<dim>>(previous);
  if (!result || &result->layout()->blocks() != coefficients.blocks.get())
    result = std::make_shared<PressureLayoutOf<dim>>(
        std::make_shared<const LatticeLayout>(coefficients.blocks, options.layout()), options);
  result->set(system);
  return result;
}

}  // namespace

std::shared_ptr<PressureLayout> PressureLayout::make(const BlockSystem& system,
                                                     const MultigridOptions& options,
                                                     std::shared_ptr<PressureLayout> previous) {
  const std::string reason = why_not(system);
  check_solve(reason.empty(), "{}", reason);
  const bool is_flat = stencil_of(system.pressure_block())->blocks->dimension == 2;
  return is_flat ? make_layout<2>(system, options, previous)
                 : make_layout<3>(system, options, previous);
}

std::string PressureLayout::why_not(const BlockSystem& system) {
  const FaceCoefficients* coefficients = stencil_of(system.pressure_block());
  if (coefficients == nullptr)
    return fmt::format(
        "The multigrid needs a pressure block that is a stencil on a lattice, and that of the {} "
        "is not. Choose another \"Pressure Inverse\".",
        system.name);
  return LatticeLayout::why_not(*coefficients->blocks);
}

void PressureLayout::to_layout(const Vector& rows, Vector& layout) const {
  layout.putScalar(0);
  const auto from = rows.getData();
  const auto to = layout.getDataNonConst();
  for (std::size_t row = 0; row < entry_of_row_.size(); ++row)
    to[entry_of_row_[row]] = from[row];
}

void PressureLayout::from_layout(const Vector& layout, Vector& rows) const {
  const auto from = layout.getData();
  const auto to = rows.getDataNonConst();
  for (std::size_t row = 0; row < entry_of_row_.size(); ++row)
    to[row] = from[entry_of_row_[row]];
}

BlockSystem PressureLayout::permuted(const BlockSystem& system) const {
  BlockSystem result = system;
  result.null_space = system.null_space.moved_to(map_, entry_of_row_);
  result.pressure_null_space = system.pressure_null_space.moved_to(map_, entry_of_row_);
  if (!system.has_solid()) {
    result.set_blocks(pressure_block());
    return result;
  }
  const CrsMatrix& coupling = *system.coupling_transposed();
  Vector ids(coupling.getDomainMap());
  {
    const auto values = ids.getDataNonConst();
    for (std::size_t row = 0; row < entry_of_row_.size(); ++row)
      values[row] = static_cast<double>(map_->getGlobalElement(entry_of_row_[row]));
  }
  const RCP<const Vector> column_ids = on_columns(coupling, ids);
  const auto new_ids = column_ids->getData();
  std::vector<std::vector<Entry>> rows(coupling.getNodeNumRows());
  for_each_entry(coupling, [&](int row, GlobalIndex column, double value) {
    const int local = coupling.getColMap()->getLocalElement(column);
    rows[row].push_back({static_cast<GlobalIndex>(new_ids[local]), value});
  });
  result.set_blocks(pressure_block(), matrix_from_rows(coupling.getRowMap(), rows, map_),
                    system.solid_block());
  return result;
}

}  // namespace lockstep
