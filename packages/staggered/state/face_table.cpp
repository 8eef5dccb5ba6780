#include "staggered/state/face_table.hpp"

namespace lockstep {

template <int dim>
FaceTable<dim>::FaceTable(const MacDomain<dim>& domain, double density)
    : area_(domain.face_area()), volume_(domain.cell_volume()), spacing_(domain.spacing()) {
  regular_.density = density;
  derive(regular_);
  for (auto& blocks : block_of_tile_)
    blocks.assign(domain.grid.n_tiles(), -1);
}

template <int dim>
void FaceTable<dim>::derive(FaceProperties& face) const {
  face.coefficient = face.open * face.distance_factor * (regular_.density / face.density);
  if (face.density != regular_.density && face.open > 0) {
    const double rounded = static_cast<float>(face.coefficient);
    face.density *= face.coefficient / rounded;
    face.coefficient = rounded;
  }
  face.mass = face.density * volume_ * face.open / face.distance_factor;
  face.gradient = face.distance_factor / (face.density * spacing_);
}

template <int dim>
FaceProperties& FaceTable<dim>::own(int axis, int cell) {
  int& block = block_of_tile_[axis][TiledGrid<dim>::tile_of(cell)];
  auto& faces = special_[axis];
  if (block < 0) {
    block = static_cast<int>(faces.size() >> log_tile_volume<dim>);
    faces.resize(faces.size() + tile_volume<dim>, regular_);
  }
  return faces[place(block, cell)];
}

template <int dim>
void FaceTable<dim>::set_open(int axis, int cell, double open) {
  FaceProperties& face = own(axis, cell);
  face.open = open;
  derive(face);
}

template <int dim>
void FaceTable<dim>::set_distance_factor(int axis, int cell, double distance_factor) {
  FaceProperties& face = own(axis, cell);
  face.distance_factor = distance_factor;
  derive(face);
}

template <int dim>
void FaceTable<dim>::set_density(int axis, int cell, double density) {
  FaceProperties& face = own(axis, cell);
  face.density = density;
  derive(face);
}

template <int dim>
std::size_t FaceTable<dim>::n_stored() const {
  std::size_t n = 0;
  for (const auto& faces : special_)
    n += faces.size();
  return n;
}

template class FaceTable<2>;
template class FaceTable<3>;

}  // namespace lockstep
