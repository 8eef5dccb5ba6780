#include "mac/parts/mac_output.hpp"

#include <algorithm>

#include "grid/flagged_tiles.hpp"
#include "liquid/surface/liquid_mesh.hpp"
#include "mac/parts/mac_drops.hpp"
#include "mac/parts/prescribed_sides.hpp"
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
void MacOutput<dim>::add_frame(std::vector<BoxFrame>& boxes) const {
  const TiledGrid<dim>& grid = flow_.domain.grid;
  BoxFrame box;
  box.dimension = dim;
  for (int a = 0; a < dim; ++a) {
    box.origin[a] = grid.lower()[a];
    box.spacing[a] = grid.spacing();
    box.n_cells[a] = grid.n_cells()[a];
  }
  std::vector<int> tiles;
  box.blocks = tile_blocks(grid, tiles);
  const auto& cells = flow_.geometry.state.cells;
  box.fields.push_back(
      {"velocity", "m/s", dim, [this, &grid, &cells, tiles](std::size_t block, double* values) {
         for_each_cell_of_tile(grid, tiles[block], [&](int cell) {
           for (int axis = 0; axis < dim; ++axis) {
             const int above = grid.neighbor(cell, axis, 1);
             const double upper = above < 0 ? 0 : flow_.prediction[axis][above];
             const bool fluid = cells[cell] == CellState::fluid;
             *values++ = fluid ? 0.5 * (flow_.prediction[axis][cell] + upper) : 0;
           }
         });
       }});
  const double per_step = flow_.last_step > 0 ? 1 / flow_.last_step : 0;
  box.fields.push_back(
      scalar_field(grid, tiles, "pressure", "Pa", [this, &cells, per_step](int cell) {
        return cells[cell] == CellState::fluid ? flow_.scaled_pressure[cell] * per_step : 0;
      }));
  for (const Scalar& scalar : flow_.scalars.all())
    box.fields.push_back(
        scalar_field(grid, tiles, scalar.name, scalar.unit, [&scalar, &cells](int cell) {
          return cells[cell] == CellState::fluid ? scalar.values[cell] : 0;
        }));
  box.fields.push_back(scalar_field(grid, tiles, "fluid", "1", [&cells](int cell) {
    return cells[cell] == CellState::fluid ? 1.0 : 0.0;
  }));
  if (flow_.liquid)
    box.fields.push_back(scalar_field(grid, tiles, "phi", "m", [this](int cell) {
      return flow_.liquid->interface().distance()[cell];
    }));
  boxes.push_back(std::move(box));
}

template <int dim>
void MacOutput<dim>::add_surfaces(std::vector<SurfaceFrame>& surfaces) const {
  if (!flow_.liquid)
    return;
  const SurfaceMesh<dim> mine = liquid_mesh(flow_.domain, flow_.liquid->interface().distance());
  std::vector<double> vertices;
  for (const Point<dim>& vertex : mine.vertices)
    vertices.insert(vertices.end(), vertex.data(), vertex.data() + dim);
  const Communicator& comm = flow_.domain.grid.comm();
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
  if (flow_.has_drops())
    surfaces.push_back(frame_of_drops(flow_));
}

template <int dim>
std::vector<std::string> MacOutput<dim>::surface_names() const {
  if (flow_.has_drops())
    return {"water", "drops"};
  return flow_.liquid ? std::vector<std::string>{"water"} : std::vector<std::string>();
}

template <int dim>
std::vector<std::pair<std::string, std::string>> MacOutput<dim>::notes() const {
  auto notes = tiles_.notes();
  for (auto& note : notes_of_inflows(flow_.domain, flow_.geometry))
    notes.push_back(std::move(note));
  return notes;
}

template void MacOutput<2>::add_frame(std::vector<BoxFrame>&) const;
template void MacOutput<3>::add_frame(std::vector<BoxFrame>&) const;
template void MacOutput<2>::add_surfaces(std::vector<SurfaceFrame>&) const;
template void MacOutput<3>::add_surfaces(std::vector<SurfaceFrame>&) const;
template std::vector<std::string> MacOutput<2>::surface_names() const;
template std::vector<std::string> MacOutput<3>::surface_names() const;
template std::vector<std::pair<std::string, std::string>> MacOutput<2>::notes() const;
template std::vector<std::pair<std::string, std::string>> MacOutput<3>::notes() const;

}  // namespace lockstep
