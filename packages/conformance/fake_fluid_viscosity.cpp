#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "conformance/fake_fluid.hpp"
#include "linear/triplet_matrix.hpp"

namespace lockstep {

template <int dim>
double FakeViscosity<dim>::bond() const {
  return fluid_.box_.viscosity * std::pow(fluid_.box_.spacing, dim - 2);
}

template <int dim>
template <typename Face, typename Visit>
void FakeViscosity<dim>::for_each_neighbour(const Face& face, Visit visit) const {
  for (int a = 0; a < dim; ++a) {
    for (int step = -1; step <= 1; step += 2) {
      Index<dim> index = face.index;
      index[a] += step;
      const int neighbour = fluid_.face_at(face.volume.direction, index);
      if (neighbour >= 0)
        visit(neighbour, a);
    }
  }
}

template <int dim>
std::unique_ptr<ViscousSystem<dim>> FakeViscosity<dim>::viscous_system() const {
  std::vector<int> rows;  // faces of this rank
  for (std::size_t f = 0; f < fluid_.faces_.size(); ++f) {
    if (fluid_.faces_[f].kind == FaceKind::free && fluid_.owned(fluid_.faces_[f]))
      rows.push_back(static_cast<int>(f));
  }
  auto system = std::make_unique<ViscousSystem<dim>>();
  system->map = make_map(static_cast<int>(rows.size()), fluid_.comm_);
  std::vector<GlobalIndex> row_of_face(fluid_.faces_.size(), no_index);
  {
    std::vector<GlobalIndex> ids(rows.begin(), rows.end());
    const auto all = gather_all(fluid_.comm_, ids);
    for (std::size_t i = 0; i < all.size(); ++i)
      row_of_face[all[i]] = static_cast<GlobalIndex>(i);
  }
  system->mass = make_vector(system->map);
  system->velocity = make_vector(system->map);
  system->wall_force = make_vector(system->map);
  std::vector<Triplet> triplets;
  for (std::size_t r = 0; r < rows.size(); ++r) {
    const auto& face = fluid_.faces_[rows[r]];
    const int row = static_cast<int>(r);
    const GlobalIndex id = row_of_face[rows[r]];
    system->mass->replaceLocalValue(row, fluid_.mass(face));
    system->velocity->replaceLocalValue(row, fluid_.predicted_[rows[r]]);
    triplets.push_back({id, id, 0});
    for_each_neighbour(face, [&](int neighbour, int) {
      const auto& other = fluid_.faces_[neighbour];
      if (other.kind == FaceKind::free) {
        triplets.push_back({id, row_of_face[neighbour], -bond()});
      } else if (other.kind == FaceKind::wall) {
        system->wall_force->sumIntoLocalValue(row, bond() * fluid_.predicted_[neighbour]);
      } else {
        ViscousCouplingTerm<dim> link;
        link.row = row;
        link.direction = face.volume.direction;
        link.coefficient = bond();
        link.position = face.volume.center;
        link.end = other.volume.center;
        link.reach = link.end - link.position;
        if (other.kind == FaceKind::coupled && fluid_.owned(other)) {
          for (std::size_t c = 0; c < fluid_.frozen_.coupled_volumes.size(); ++c) {
            if (fluid_.frozen_.coupled_volumes[c].id == other.volume.id)
              link.coupled_volume = static_cast<int>(c);
          }
        } else if (other.kind == FaceKind::coupled) {
          link.remote_volume = std::make_shared<const ControlVolume<dim>>(other.volume);
        } else {
          const auto hit = fluid_.surface_->first_hit(face.volume.center, other.volume.center);
          if (!hit)
            return;
          link.point = *hit;
        }
        system->links.push_back(link);
      }
      triplets.push_back({id, id, bond()});
    });
  }
  system->stiffness = assemble_triplets(std::move(triplets), system->map, system->map);
  return system;
}

template <int dim>
Momentum<dim> FakeViscosity<dim>::accept_viscous(const Vector& solution, const Vector& velocity,
                                                 double dt) {
  const auto mine = solution.getData();
  fluid_.replicate(FaceKind::free, std::vector<double>(mine.begin(), mine.end()));
  Momentum<dim> impulse;
  for (std::size_t f = 0; f < fluid_.faces_.size(); ++f) {
    const auto& face = fluid_.faces_[f];
    if (face.kind != FaceKind::free)
      continue;
    const int axis = face.volume.direction;
    for_each_neighbour(face, [&](int neighbour, int) {
      const auto& other = fluid_.faces_[neighbour];
      const double pull = -dt * bond() * (fluid_.predicted_[f] - fluid_.predicted_[neighbour]);
      if (other.kind == FaceKind::wall) {
        impulse.add(face.volume.center, axis, pull);
      } else if (other.kind == FaceKind::free && neighbour > static_cast<int>(f)) {
        // The two ends of a coupling lie apart: equal and opposite forces, but a couple.
        impulse.angular +=
            cross<dim>(face.volume.center - other.volume.center, pull * Point<dim>::Unit(axis));
      }
    });
  }
  const auto accepted = velocity.getData();
  fluid_.replicate(FaceKind::free, std::vector<double>(accepted.begin(), accepted.end()));
  return impulse;
}

template class FakeViscosity<2>;
template class FakeViscosity<3>;

}  // namespace lockstep
