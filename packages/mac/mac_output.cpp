#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "grid/flagged_tiles.hpp"
#include "liquid/surface/liquid_mesh.hpp"
#include "mac/mac_fluid.hpp"
#include "output/checkpoint.hpp"
#include "output/frames.hpp"

namespace lockstep {

namespace {
/// One block for the cells of each owned tile that lie in the domain.
template <int dim>
std::vector<CellBlock> tile_blocks(const TiledGrid<dim>& grid, std::vector<int>& tiles) {
  std::vector<CellBlock> blocks;
  for (int tile = 0; tile < grid.n_owned_tiles(); ++tile) {
    CellBlock block{{0, 0, 0}, {1, 1, 1}};
    bool empty = false;
    for (int a = 0; a < dim; ++a) {
      block.lower[a] = grid.tile_begin(tile)[a];
      block.size[a] = grid.tile_domain_extent(tile)[a];
      empty = empty || block.size[a] <= 0;
    }
    if (empty)
      continue;
    blocks.push_back(block);
    tiles.push_back(tile);
  }
  return blocks;
}

template <int dim>
BoxField scalar_field(const TiledGrid<dim>& grid, const std::vector<int>& tiles, std::string name,
                      std::string unit, std::function<double(int)> value) {
  return {std::move(name), std::move(unit), 1,
          [&grid, tiles, value = std::move(value)](std::size_t block, double* values) {
            for_each_cell_of_tile(grid, tiles[block], [&](int cell) { *values++ = value(cell); });
          }};
}

}  // namespace

template <int dim>
void MacFluid<dim>::add_frame(std::vector<BoxFrame>& boxes) const {
  const TiledGrid<dim>& grid = domain_.grid;
  BoxFrame box;
  box.dimension = dim;
  for (int a = 0; a < dim; ++a) {
    box.origin[a] = grid.lower()[a];
    box.spacing[a] = grid.spacing();
    box.n_cells[a] = grid.n_cells()[a];
  }
  std::vector<int> tiles;
  box.blocks = tile_blocks(grid, tiles);
  const auto& cells = geometry_.state.cells;
  box.fields.push_back(
      {"velocity", "m/s", dim, [this, &grid, &cells, tiles](std::size_t block, double* values) {
         for_each_cell_of_tile(grid, tiles[block], [&](int cell) {
           for (int axis = 0; axis < dim; ++axis) {
             const int above = grid.neighbor(cell, axis, 1);
             const double upper = above < 0 ? 0 : prediction_[axis][above];
             const bool fluid = cells[cell] == CellState::fluid;
             *values++ = fluid ? 0.5 * (prediction_[axis][cell] + upper) : 0;
           }
         });
       }});
  const double per_step = last_step_ > 0 ? 1 / last_step_ : 0;
  box.fields.push_back(
      scalar_field(grid, tiles, "pressure", "Pa", [this, &cells, per_step](int cell) {
        return cells[cell] == CellState::fluid ? scaled_pressure_[cell] * per_step : 0;
      }));
  for (const Scalar& scalar : scalars_.all())
    box.fields.push_back(
        scalar_field(grid, tiles, scalar.name, scalar.unit, [&scalar, &cells](int cell) {
          return cells[cell] == CellState::fluid ? scalar.values[cell] : 0;
        }));
  box.fields.push_back(scalar_field(grid, tiles, "fluid", "1", [&cells](int cell) {
    return cells[cell] == CellState::fluid ? 1.0 : 0.0;
  }));
  if (liquid_)
    box.fields.push_back(scalar_field(grid, tiles, "phi", "m", [this](int cell) {
      return liquid_->interface().distance()[cell];
    }));
  boxes.push_back(std::move(box));
}

template <int dim>
void MacFluid<dim>::add_surfaces(std::vector<SurfaceFrame>& surfaces) const {
  if (!liquid_)
    return;
  const SurfaceMesh<dim> mine = liquid_mesh(domain_, liquid_->interface().distance());
  std::vector<double> vertices;
  for (const Point<dim>& vertex : mine.vertices)
    vertices.insert(vertices.end(), vertex.data(), vertex.data() + dim);
  const Communicator& comm = domain_.grid.comm();
  const GlobalIndex n_before = exclusive_sum(comm, static_cast<GlobalIndex>(mine.vertices.size()));
  std::vector<GlobalIndex> simplices;
  for (const auto& simplex : mine.simplices)
    for (const int vertex : simplex)
      simplices.push_back(n_before + vertex);
  SurfaceFrame frame;
  frame.name = "water";
  frame.dimension = dim;
  frame.simplex_size = dim;
  frame.vertices = gather_all(comm, vertices);
  const std::vector<GlobalIndex> all = gather_all(comm, simplices);
  frame.simplices.assign(all.begin(), all.end());
  surfaces.push_back(std::move(frame));
  if (has_drops())
    surfaces.push_back(frame_of_drops());
}

template <int dim>
void MacFluid<dim>::save(CheckpointWriter& checkpoint) const {
  save_fields(domain_, fields_, checkpoint);
  save_tiles(checkpoint);
  CellField cells(domain_.grid.n_stored_cells(), static_cast<double>(CellState::outside));
  std::transform(accepted_cells_.begin(), accepted_cells_.end(), cells.begin(),
                 [](CellState state) { return static_cast<double>(state); });
  save_fields(domain_, {{"cells_with_pressure", {&cells}}}, checkpoint);
  checkpoint.file().write_attribute("fluid", "boundary_time", time_);
  checkpoint.file().write_attribute("fluid", "last_step", last_step_);
  if (liquid_)
    liquid_->interface().save(checkpoint);
}

template <int dim>
void MacFluid<dim>::load(const CheckpointReader& checkpoint) {
  load_tiles(checkpoint);
  load_fields(domain_, fields_, checkpoint);
  prediction_ = velocity_;
  scaled_pressure_ = accepted_pressure_;
  CellField cells(domain_.grid.n_stored_cells(), static_cast<double>(CellState::outside));
  load_fields(domain_, {{"cells_with_pressure", {&cells}}}, checkpoint);
  accepted_cells_.resize(cells.size());
  for (std::size_t cell = 0; cell < cells.size(); ++cell)
    accepted_cells_[cell] = static_cast<CellState>(static_cast<int>(cells[cell]));
  time_ = checkpoint.file().read_attribute<double>("fluid", "boundary_time");
  last_step_ = checkpoint.file().read_attribute<double>("fluid", "last_step");
  accepted_step_ = last_step_;
  if (liquid_)
    liquid_->load(checkpoint);
  largest_speed_.reset();
}

template void MacFluid<2>::add_frame(std::vector<BoxFrame>&) const;
template void MacFluid<3>::add_frame(std::vector<BoxFrame>&) const;
template void MacFluid<2>::add_surfaces(std::vector<SurfaceFrame>&) const;
template void MacFluid<3>::add_surfaces(std::vector<SurfaceFrame>&) const;
template void MacFluid<2>::save(CheckpointWriter&) const;
template void MacFluid<3>::save(CheckpointWriter&) const;
template void MacFluid<2>::load(const CheckpointReader&);
template void MacFluid<3>::load(const CheckpointReader&);

}  // namespace lockstep
