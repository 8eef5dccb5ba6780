#include "conformance/fake_fluid.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>
#include <numeric>

#include "linear/triplet_matrix.hpp"
#include "output/checkpoint.hpp"

namespace lockstep {

template <int dim>
FakeFluid<dim>::FakeFluid(const FakeBox<dim>& box, const Communicator& comm)
    : box_(box), comm_(comm) {
  make_faces();
  velocity_.assign(faces_.size(), 0);
  predicted_ = velocity_;
}

template <int dim>
void FakeFluid<dim>::make_faces() {
  for (int axis = 0; axis < dim; ++axis) {
    first_face_[axis] = static_cast<int>(faces_.size());
    Index<dim> end = box_.n_cells;
    ++end[axis];
    int n = 1;
    for (int a = 0; a < dim; ++a)
      n *= end[a];
    for (int i = 0; i < n; ++i) {
      Face face;
      int rest = i;
      for (int a = 0; a < dim; ++a) {
        face.index[a] = rest % end[a];
        rest /= end[a];
      }
      face.volume.direction = axis;
      face.volume.id = static_cast<GlobalIndex>(faces_.size());
      faces_.push_back(face);
    }
  }
  first_face_[dim] = static_cast<int>(faces_.size());
}

template <int dim>
int FakeFluid<dim>::cell_at(const Index<dim>& index) const {
  int cell = 0;
  for (int a = dim - 1; a >= 0; --a) {
    if (index[a] < 0 || index[a] >= box_.n_cells[a])
      return -1;
    cell = cell * box_.n_cells[a] + index[a];
  }
  return cell;
}

template <int dim>
int FakeFluid<dim>::face_at(int axis, const Index<dim>& index) const {
  int face = 0;
  for (int a = dim - 1; a >= 0; --a) {
    const int end = box_.n_cells[a] + (a == axis ? 1 : 0);
    if (index[a] < 0 || index[a] >= end)
      return -1;
    face = face * end + index[a];
  }
  return first_face_[axis] + face;
}

template <int dim>
void FakeFluid<dim>::set_velocity(
    const std::function<double(int axis, const Point<dim>& x)>& velocity) {
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const int axis = faces_[f].volume.direction;
    Point<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = box_.lower[a] + box_.spacing * (faces_[f].index[a] + (a == axis ? 0 : 0.5));
    velocity_[f] = velocity(axis, x);
  }
  predicted_ = velocity_;
}

template <int dim>
const FluidGeometry<dim>& FakeFluid<dim>::freeze(const Surface& surface,
                                                 const OpenFractionRule<dim>& rule) {
  surface_ = surface;
  number_cells(*surface);
  frozen_.coupled_volumes.clear();
  for (Face& face : faces_) {
    classify(face, *surface, rule);
    if (face.kind == FaceKind::coupled && owned(face))
      frozen_.coupled_volumes.push_back(face.volume);
  }
  frozen_.cut_cells.clear();
  if (rule.cuts_cells())
    find_cut_cells(*surface);
  find_regions();
  assemble_pressure_block();
  frozen_.volume = static_cast<double>(rank_of_unknown_.size()) * std::pow(box_.spacing, dim);
  return frozen_;
}

template <int dim>
void FakeFluid<dim>::number_cells(const SurfaceSnapshot<dim>& surface) {
  const int n_cells =
      std::accumulate(box_.n_cells.begin(), box_.n_cells.end(), 1, std::multiplies<int>());
  const Lattice<dim> lattice{box_.lower, box_.spacing};
  unknown_.assign(n_cells, no_index);
  solid_.assign(n_cells, -1);
  GlobalIndex n_active = 0;
  for (int cell = 0; cell < n_cells; ++cell) {
    Index<dim> index;
    int rest = cell;
    for (int a = 0; a < dim; ++a) {
      index[a] = rest % box_.n_cells[a];
      rest /= box_.n_cells[a];
    }
    if (!surface.empty())
      solid_[cell] = surface.inside(lattice.center(index));
    if (solid_[cell] < 0)
      unknown_[cell] = n_active++;
  }
  rank_of_unknown_.resize(n_active);
  int n_local = 0;
  for (GlobalIndex i = 0; i < n_active; ++i) {
    rank_of_unknown_[i] = static_cast<int>(i * comm_->getSize() / n_active);
    n_local += rank_of_unknown_[i] == comm_->getRank() ? 1 : 0;
  }
  frozen_.pressure_map = make_map(n_local, comm_);
}

template <int dim>
void FakeFluid<dim>::classify(Face& face, const SurfaceSnapshot<dim>& surface,
                              const OpenFractionRule<dim>& rule) {
  const double h = box_.spacing;
  const int axis = face.volume.direction;
  ControlVolume<dim>& volume = face.volume;
  volume.density = box_.density;
  volume.area = std::pow(h, dim - 1);
  volume.open_fraction = 1;
  for (int a = 0; a < dim; ++a)
    volume.center[a] = box_.lower[a] + h * (face.index[a] + (a == axis ? 0 : 0.5));
  volume.open_center = volume.center;
  volume.box = Box<dim>(volume.center - Point<dim>::Constant(h / 2),
                        volume.center + Point<dim>::Constant(h / 2));
  Index<dim> below = face.index;
  --below[axis];
  const int cells[2] = {cell_at(below), cell_at(face.index)};
  for (int side = 0; side < 2; ++side) {
    PressureSide<dim>& pressure = volume.sides[side];
    pressure = PressureSide<dim>();
    pressure.center = volume.center + (side - 0.5) * h * Point<dim>::Unit(axis);
    pressure.kind = axis == box_.open_axis && side == 1 ? SideKind::open : SideKind::closed;
    if (cells[side] < 0)
      continue;
    pressure.unknown = unknown_[cells[side]];
    pressure.cell = cells[side];
    pressure.solid = solid_[cells[side]];
    pressure.kind = pressure.solid >= 0 ? SideKind::solid : SideKind::unknown;
  }
  face.kind = FaceKind::inactive;
  const GlobalIndex first =
      volume.sides[0].unknown != no_index ? volume.sides[0].unknown : volume.sides[1].unknown;
  if (first == no_index)
    return;
  face.owner = rank_of_unknown_[first];
  face.open = cells[1] < 0 && axis == box_.open_axis;
  if ((cells[0] < 0 || cells[1] < 0) && !face.open) {
    face.kind = FaceKind::wall;
    return;
  }
  if (face.open) {
    volume.box.max()[axis] = volume.center[axis];
    volume.sides[1].center = volume.center;
  }
  face.kind = FaceKind::free;
  if (surface.empty())
    return;
  const bool occluded =
      surface.first_hit(volume.sides[0].center, volume.sides[1].center).has_value();
  volume.open_fraction = rule.open_fraction(volume, occluded, surface);
  if (volume.open_fraction < 1)
    face.kind = FaceKind::coupled;
}

template <int dim>
void FakeFluid<dim>::find_cut_cells(const SurfaceSnapshot<dim>& surface) {
  for (int cell = 0; cell < static_cast<int>(unknown_.size()); ++cell) {
    CutCell<dim> cut;
    int rest = cell;
    for (int a = 0; a < dim; ++a) {
      const int place = rest % box_.n_cells[a];
      rest /= box_.n_cells[a];
      cut.box.min()[a] = box_.lower[a] + place * box_.spacing;
      cut.box.max()[a] = box_.lower[a] + (place + 1) * box_.spacing;
    }
    if (unknown_[cell] == no_index || !surface.touches(cut.box))
      continue;
    cut.pressure.kind = SideKind::unknown;
    cut.pressure.unknown = unknown_[cell];
    cut.pressure.center = cut.box.center();
    cut.pressure.cell = cell;
    cut.is_owned = rank_of_unknown_[unknown_[cell]] == comm_->getRank();
    frozen_.cut_cells.push_back(cut);
  }
}

template <int dim>
void FakeFluid<dim>::find_regions() {
  std::vector<int> region(rank_of_unknown_.size());
  std::iota(region.begin(), region.end(), 0);
  bool changed = true;
  while (changed) {
    changed = false;
    for (const Face& face : faces_) {
      if (face.kind != FaceKind::free || face.open)
        continue;
      int& a = region[face.volume.sides[0].unknown];
      int& b = region[face.volume.sides[1].unknown];
      changed = changed || a != b;
      a = b = std::min(a, b);
    }
  }
  frozen_.regions = PressureRegions();
  std::vector<int> number(region.size(), -1);
  for (std::size_t i = 0; i < region.size(); ++i) {
    if (region[i] == static_cast<int>(i))
      number[i] = frozen_.regions.n_regions++;
    if (rank_of_unknown_[i] == comm_->getRank())
      frozen_.regions.of_unknown.push_back(number[region[i]]);
  }
  frozen_.regions.has_dirichlet.assign(frozen_.regions.n_regions, 0);
  for (const Face& face : faces_) {
    if (face.kind == FaceKind::free && face.open)
      frozen_.regions.has_dirichlet[number[region[face.volume.sides[0].unknown]]] = 1;
  }
}

template <int dim>
double FakeFluid<dim>::mass(const Face& face) const {
  return face.volume.density * face.volume.box.volume();
}

template <int dim>
void FakeFluid<dim>::assemble_pressure_block() {
  std::vector<Triplet> triplets;
  for (const Face& face : faces_) {
    if (face.kind != FaceKind::free || !owned(face))
      continue;
    // Eq. 9: a unit of p̂ on one side changes the outflow by area^2 / mass.
    const double entry = face.volume.area * face.volume.area / mass(face);
    const GlobalIndex lower = face.volume.sides[0].unknown, upper = face.volume.sides[1].unknown;
    triplets.push_back({lower, lower, entry});
    if (face.open)
      continue;
    triplets.push_back({upper, upper, entry});
    triplets.push_back({lower, upper, -entry});
    triplets.push_back({upper, lower, -entry});
  }
  // A cell with coupled faces only keeps its (zero) row.
  for (GlobalIndex id : frozen_.pressure_map->getNodeElementList())
    triplets.push_back({id, id, 0});
  frozen_.pressure_block = as_operator(
      assemble_triplets(std::move(triplets), frozen_.pressure_map, frozen_.pressure_map));
}

template <int dim>
void FakeFluid<dim>::divergence(Vector& rhs) const {
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Face& face = faces_[f];
    if (face.kind != FaceKind::free && face.kind != FaceKind::wall)
      continue;
    for (int side = 0; side < 2; ++side) {
      const GlobalIndex unknown = face.volume.sides[side].unknown;
      if (unknown != no_index && frozen_.pressure_map->isNodeGlobalElement(unknown))
        rhs.sumIntoGlobalValue(unknown, (side == 0 ? -1 : 1) * face.volume.area * predicted_[f]);
    }
  }
}

template <int dim>
std::vector<double> FakeFluid<dim>::everywhere(const Vector& pressure) const {
  const auto mine = pressure.getData();
  return gather_all(comm_, std::vector<double>(mine.begin(), mine.end()));
}

template <int dim>
void FakeFluid<dim>::project(const Vector& scaled_pressure) {
  const std::vector<double> pressure = everywhere(scaled_pressure);
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (faces_[f].kind != FaceKind::free)
      continue;
    const auto& sides = faces_[f].volume.sides;
    const double jump =
        (faces_[f].open ? 0 : pressure[sides[1].unknown]) - pressure[sides[0].unknown];
    predicted_[f] -= faces_[f].volume.area * jump / mass(faces_[f]);
  }
}

template <int dim>
std::vector<double> FakeFluid<dim>::coupled_velocity() const {
  std::vector<double> result;
  for (const ControlVolume<dim>& volume : frozen_.coupled_volumes)
    result.push_back(predicted_[volume.id]);
  return result;
}

template <int dim>
void FakeFluid<dim>::replicate(FaceKind kind, const std::vector<double>& mine) {
  std::vector<GlobalIndex> ids;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (faces_[f].kind == kind && owned(faces_[f]))
      ids.push_back(static_cast<GlobalIndex>(f));
  }
  const auto all_ids = gather_all(comm_, ids);
  const auto all_values = gather_all(comm_, mine);
  for (std::size_t i = 0; i < all_ids.size(); ++i)
    predicted_[all_ids[i]] = all_values[i];
}

template <int dim>
void FakeFluid<dim>::set_coupled_velocity(const std::vector<double>& velocity) {
  replicate(FaceKind::coupled, velocity);
}

template <int dim>
ForceImpulse<dim> FakeFluid<dim>::add_forces(double, double dt) {
  ForceImpulse<dim> given;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    const Face& face = faces_[f];
    if (face.kind != FaceKind::free && face.kind != FaceKind::coupled)
      continue;
    const int axis = face.volume.direction;
    predicted_[f] += dt * box_.gravity[axis];
    if (face.kind == FaceKind::free)
      given.impulse.add(face.volume.center, axis, mass(face) * dt * box_.gravity[axis]);
  }
  for (const ControlVolume<dim>& volume : frozen_.coupled_volumes)
    given.coupled_change.push_back(dt * box_.gravity[volume.direction]);
  return given;
}

template <int dim>
double FakeFluid<dim>::largest_speed() const {
  double speed = 0;
  for (int axis = 0; axis < dim; ++axis) {
    double largest = 0;
    for (int f = first_face_[axis]; f < first_face_[axis + 1]; ++f)
      largest = std::max(largest, std::abs(velocity_[f]));
    speed += largest;
  }
  return speed;
}

template <int dim>
Momentum<dim> FakeFluid<dim>::momentum() const {
  Momentum<dim> total;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (faces_[f].kind == FaceKind::free)
      total.add(faces_[f].volume.center, faces_[f].volume.direction,
                mass(faces_[f]) * predicted_[f]);
  }
  return total;
}

template <int dim>
double FakeFluid<dim>::kinetic_energy() const {
  double energy = 0;
  for (std::size_t f = 0; f < faces_.size(); ++f) {
    if (faces_[f].kind == FaceKind::free)
      energy += 0.5 * mass(faces_[f]) * predicted_[f] * predicted_[f];
  }
  return energy;
}

template <int dim>
Momentum<dim> FakeFluid<dim>::boundary_pressure_impulse(const Vector& scaled_pressure) const {
  const std::vector<double> pressure = everywhere(scaled_pressure);
  Momentum<dim> impulse;
  for (const Face& face : faces_) {
    if (face.kind != FaceKind::wall)
      continue;
    const int inner = face.volume.sides[0].unknown == no_index ? 1 : 0;
    impulse.add(
        face.volume.center, face.volume.direction,
        (inner == 1 ? 1 : -1) * face.volume.area * pressure[face.volume.sides[inner].unknown]);
  }
  return impulse;
}

template <int dim>
void FakeFluid<dim>::save(CheckpointWriter& checkpoint) const {
  checkpoint.file().create_group("fluid");
  checkpoint.file().write_replicated("fluid/velocity", velocity_);
}

template <int dim>
void FakeFluid<dim>::load(const CheckpointReader& checkpoint) {
  velocity_ = checkpoint.file().template read_all<double>("fluid/velocity");
  predicted_ = velocity_;
}

template class FakeFluid<2>;
template class FakeFluid<3>;

}  // namespace lockstep
