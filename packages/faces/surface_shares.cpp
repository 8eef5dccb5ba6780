#include "faces/surface_shares.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "geometry/clipping.hpp"

namespace lockstep {
namespace {

template <int dim>
Box<dim> thickened(const Box<dim>& box, double tolerance) {
  const Point<dim> margin = tolerance * box.sizes();
  return Box<dim>(box.min() - margin, box.max() + margin);
}

/// Adds a share; those of one rigid solid are merged.
template <int dim>
void add_share(std::vector<SurfaceShare<dim>>& shares, const SurfaceShare<dim>& share, bool rigid) {
  if (rigid) {
    for (SurfaceShare<dim>& other : shares) {
      if (other.solid != share.solid)
        continue;
      other.weight += share.weight;
      return;
    }
  }
  shares.push_back(share);
}

template <int dim>
SurfaceShare<dim> closest_share(const ControlVolume<dim>& volume,
                                const SurfaceSnapshot<dim>& surface, int own) {
  if (own >= 0)
    return {1, surface.closest_on_solid(volume.center, own), own};
  double radius = volume.box.diagonal().norm();
  auto closest = surface.closest(volume.center, radius);
  while (!closest)
    closest = surface.closest(volume.center, radius *= 2);
  return {1, *closest, surface.solid_of(closest->simplex)};
}

}  // namespace

template <int dim>
int solid_beside(const ControlVolume<dim>& volume) {
  const auto& sides = volume.sides;
  const int lower = sides[0].kind == SideKind::solid ? sides[0].solid : -1;
  const int upper = sides[1].kind == SideKind::solid ? sides[1].solid : -1;
  return lower >= 0 && upper >= 0 && lower != upper ? -1 : std::max(lower, upper);
}

template <int dim>
std::vector<std::vector<SurfaceShare<dim>>> surface_shares(
    const std::vector<ControlVolume<dim>>& volumes, const SurfaceSnapshot<dim>& surface,
    double tolerance) {
  std::vector<std::vector<SurfaceShare<dim>>> all(volumes.size());
  std::vector<int> touching;
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    const Box<dim> box = thickened<dim>(volumes[f].box, tolerance);
    surface.touching(box, touching);
    const int own = solid_beside(volumes[f]);
    double total = 0;
    for (int simplex : touching) {
      const int solid = surface.solid_of(simplex);
      if (own >= 0 && solid != own &&
          (surface.solids()[solid].closed || volumes[f].touches_patch()))
        continue;
      const ClippedSimplex<dim> part = clip_to_box<dim>(surface.corners(simplex), box);
      if (part.measure <= 0)
        continue;
      total += part.measure;
      const SurfacePoint<dim> point{simplex, part.barycentric, part.centroid, 0};
      add_share<dim>(all[f], {part.measure, point, solid}, surface.solids()[solid].rigid);
    }
    if (all[f].empty()) {
      all[f].push_back(closest_share<dim>(volumes[f], surface, own));
    } else {
      for (SurfaceShare<dim>& share : all[f])
        share.weight /= total;
    }
  }
  return all;
}

template <int dim>
void weigh_nodes_alike(const SurfaceSnapshot<dim>& surface,
                       std::vector<std::vector<SurfaceShare<dim>>>& shares) {
  for (auto& of_face : shares) {
    for (SurfaceShare<dim>& share : of_face) {
      if (surface.solids()[share.solid].rigid)
        continue;
      const auto corners = surface.corners(share.point.simplex);
      share.point.position.setZero();
      for (int k = 0; k < dim; ++k) {
        share.point.barycentric[k] = 1. / dim;
        share.point.position += corners[k] / dim;
      }
    }
  }
}

template <int dim>
void add_local_rotations(const std::vector<ControlVolume<dim>>& volumes,
                         const SurfaceSnapshot<dim>& surface,
                         std::vector<std::vector<SurfaceShare<dim>>>& shares) {
  struct Part {
    double arm = 0;
    std::vector<int> simplices;
    std::shared_ptr<const LocalRotation<dim>> rotation;
  };
  for (std::size_t f = 0; f < shares.size(); ++f) {
    std::map<int, Part> of_solid;
    for (const SurfaceShare<dim>& share : shares[f]) {
      if (surface.solids()[share.solid].rigid)
        continue;
      Part& part = of_solid[share.solid];
      part.simplices.push_back(share.point.simplex);
      part.arm = std::max(part.arm, (volumes[f].center - share.point.position).norm());
    }
    for (auto& [solid, part] : of_solid)
      part.rotation = std::make_shared<LocalRotation<dim>>(volumes[f].box, part.arm, part.simplices,
                                                           solid, surface);
    for (SurfaceShare<dim>& share : shares[f]) {
      if (!surface.solids()[share.solid].rigid)
        share.rotation = of_solid[share.solid].rotation;
    }
  }
}

template <int dim>
void directed_row(const SolidSystem<dim>& solids, const SurfacePoint<dim>& point,
                  const Point<dim>& x, int direction, DirectedRow<dim>& row) {
  VelocityRow<dim>& all = row.all_components;
  solids.velocity_row(point, x, all);
  row.dofs.clear();
  row.values.clear();
  for (std::size_t k = 0; k < all.dofs.size(); ++k) {
    const double value = all.coefficients[k][direction];
    if (value == 0)
      continue;
    row.dofs.push_back(all.dofs[k]);
    row.values.push_back(value);
  }
}

namespace {

/// Returns for each local rotation among the shares the arm at which it acts: the sum of x less
/// their points, by weights.
template <int dim>
std::vector<std::pair<const LocalRotation<dim>*, Point<dim>>> arms_of_rotations(
    const std::vector<SurfaceShare<dim>>& shares, const Point<dim>& x) {
  std::vector<std::pair<const LocalRotation<dim>*, Point<dim>>> arms;
  for (const SurfaceShare<dim>& share : shares) {
    if (!share.rotation)
      continue;
    const Point<dim> arm = share.weight * (x - share.point.position);
    const auto same = std::find_if(arms.begin(), arms.end(), [&](const auto& other) {
      return other.first == share.rotation.get();
    });
    if (same == arms.end())
      arms.emplace_back(share.rotation.get(), arm);
    else
      same->second += arm;
  }
  return arms;
}

}  // namespace

template <int dim>
void add_carried_row(const SolidSystem<dim>& solids, const std::vector<SurfaceShare<dim>>& shares,
                     const Point<dim>& x, int direction, VelocityRow<dim>& scratch,
                     RowEntries& row) {
  for (const SurfaceShare<dim>& share : shares) {
    solids.velocity_row(share.point, x, scratch);
    for (std::size_t k = 0; k < scratch.dofs.size(); ++k) {
      const double value = scratch.coefficients[k][direction];
      if (value != 0)
        row.emplace_back(scratch.dofs[k], share.weight * value);
    }
  }
  const auto add = [&](const SurfacePoint<dim>& vertex, const Point<dim>& coefficient) {
    solids.velocity_row(vertex, x, scratch);
    for (std::size_t k = 0; k < scratch.dofs.size(); ++k)
      row.emplace_back(scratch.dofs[k], coefficient.dot(scratch.coefficients[k]));
  };
  for (const auto& [rotation, arm] : arms_of_rotations<dim>(shares, x))
    rotation->row(arm, direction, add);
}

template <int dim>
double carried_effective_velocity(const SolidSystem<dim>& solids,
                                  const std::vector<SurfaceShare<dim>>& shares, const Point<dim>& x,
                                  int direction) {
  double velocity = 0;
  for (const SurfaceShare<dim>& share : shares)
    velocity += share.weight * solids.effective_velocity(share.point, x)[direction];
  const auto of_vertex = [&](const SurfacePoint<dim>& vertex) {
    return solids.effective_velocity(vertex, x);
  };
  for (const auto& [rotation, arm] : arms_of_rotations<dim>(shares, x))
    velocity += rotation->velocity_at(arm, of_vertex)[direction];
  return velocity;
}

CouplingWeights weights_of_rows(int n_rows, const std::function<void(int, RowEntries&)>& entries) {
  CouplingWeights weights;
  std::vector<GlobalIndex> ids;  // column of each entry, global
  RowEntries row;
  weights.row_begin.push_back(0);
  for (int f = 0; f < n_rows; ++f) {
    row.clear();
    entries(f, row);
    std::stable_sort(row.begin(), row.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    for (const auto& [id, value] : row) {
      const bool same = static_cast<int>(ids.size()) > weights.row_begin.back() && ids.back() == id;
      if (same) {
        weights.values.back() += value;
      } else {
        ids.push_back(id);
        weights.values.push_back(value);
      }
    }
    weights.row_begin.push_back(static_cast<int>(ids.size()));
  }
  weights.dofs = ids;
  std::sort(weights.dofs.begin(), weights.dofs.end());
  weights.dofs.erase(std::unique(weights.dofs.begin(), weights.dofs.end()), weights.dofs.end());
  for (GlobalIndex id : ids) {
    weights.columns.push_back(static_cast<int>(
        std::lower_bound(weights.dofs.begin(), weights.dofs.end(), id) - weights.dofs.begin()));
  }
  return weights;
}

template <int dim>
CouplingWeights coupling_weights(const std::vector<ControlVolume<dim>>& volumes,
                                 const std::vector<std::vector<SurfaceShare<dim>>>& shares,
                                 const SolidSystem<dim>& solids, bool carried) {
  VelocityRow<dim> scratch;
  std::vector<SurfaceShare<dim>> plain;
  return weights_of_rows(static_cast<int>(volumes.size()), [&](int f, RowEntries& row) {
    plain.clear();
    if (!carried) {
      plain = shares[f];
      for (SurfaceShare<dim>& share : plain)
        share.rotation.reset();
    }
    add_carried_row<dim>(solids, carried ? shares[f] : plain, volumes[f].center,
                         volumes[f].direction, scratch, row);
  });
}

bool any_prescribed(const std::vector<SolidDescription>& solids) {
  return std::any_of(solids.begin(), solids.end(),
                     [](const SolidDescription& solid) { return solid.prescribed; });
}

template int solid_beside<2>(const ControlVolume<2>&);
template int solid_beside<3>(const ControlVolume<3>&);
template std::vector<std::vector<SurfaceShare<2>>> surface_shares<2>(
    const std::vector<ControlVolume<2>>&, const SurfaceSnapshot<2>&, double);
template void weigh_nodes_alike<2>(const SurfaceSnapshot<2>&,
                                   std::vector<std::vector<SurfaceShare<2>>>&);
template void weigh_nodes_alike<3>(const SurfaceSnapshot<3>&,
                                   std::vector<std::vector<SurfaceShare<3>>>&);
template void directed_row<2>(const SolidSystem<2>&, const SurfacePoint<2>&, const Point<2>&, int,
                              DirectedRow<2>&);
template void add_local_rotations<2>(const std::vector<ControlVolume<2>>&,
                                     const SurfaceSnapshot<2>&,
                                     std::vector<std::vector<SurfaceShare<2>>>&);
template void add_carried_row<2>(const SolidSystem<2>&, const std::vector<SurfaceShare<2>>&,
                                 const Point<2>&, int, VelocityRow<2>&, RowEntries&);
template double carried_effective_velocity<2>(const SolidSystem<2>&,
                                              const std::vector<SurfaceShare<2>>&, const Point<2>&,
                                              int);
template CouplingWeights coupling_weights<2>(const std::vector<ControlVolume<2>>&,
                                             const std::vector<std::vector<SurfaceShare<2>>>&,
                                             const SolidSystem<2>&, bool);
template std::vector<std::vector<SurfaceShare<3>>> surface_shares<3>(
    const std::vector<ControlVolume<3>>&, const SurfaceSnapshot<3>&, double);
template void directed_row<3>(const SolidSystem<3>&, const SurfacePoint<3>&, const Point<3>&, int,
                              DirectedRow<3>&);
template void add_local_rotations<3>(const std::vector<ControlVolume<3>>&,
                                     const SurfaceSnapshot<3>&,
                                     std::vector<std::vector<SurfaceShare<3>>>&);
template void add_carried_row<3>(const SolidSystem<3>&, const std::vector<SurfaceShare<3>>&,
                                 const Point<3>&, int, VelocityRow<3>&, RowEntries&);
template double carried_effective_velocity<3>(const SolidSystem<3>&,
                                              const std::vector<SurfaceShare<3>>&, const Point<3>&,
                                              int);
template CouplingWeights coupling_weights<3>(const std::vector<ControlVolume<3>>&,
                                             const std::vector<std::vector<SurfaceShare<3>>>&,
                                             const SolidSystem<3>&, bool);

}  // namespace lockstep
