#include "mixedface/weights.hpp"

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
                                const SurfaceSnapshot<dim>& surface) {
  double radius = volume.box.diagonal().norm();
  auto closest = surface.closest(volume.center, radius);
  while (!closest)
    closest = surface.closest(volume.center, radius *= 2);
  return {1, *closest, surface.solid_of(closest->simplex)};
}

}  // namespace

template <int dim>
std::vector<std::vector<SurfaceShare<dim>>> surface_shares(
    const std::vector<ControlVolume<dim>>& volumes, const SurfaceSnapshot<dim>& surface,
    double tolerance) {
  std::vector<std::vector<SurfaceShare<dim>>> all(volumes.size());
  std::vector<int> touching;
  for (std::size_t f = 0; f < volumes.size(); ++f) {
    const Box<dim> box = thickened<dim>(volumes[f].box, tolerance);
    surface.touching(box, touching);
    double total = 0;
    for (int simplex : touching) {
      const ClippedSimplex<dim> part = clip_to_box<dim>(surface.corners(simplex), box);
      if (part.measure <= 0)
        continue;
      total += part.measure;
      const int solid = surface.solid_of(simplex);
      const SurfacePoint<dim> point{simplex, part.barycentric, part.centroid, 0};
      add_share<dim>(all[f], {part.measure, point, solid}, surface.solids()[solid].rigid);
    }
    if (all[f].empty()) {
      all[f].push_back(closest_share<dim>(volumes[f], surface));
    } else {
      for (SurfaceShare<dim>& share : all[f])
        share.weight /= total;
    }
  }
  return all;
}

template <int dim>
void add_local_rotations(const std::vector<ControlVolume<dim>>& volumes,
                         const SurfaceSnapshot<dim>& surface,
                         std::vector<std::vector<SurfaceShare<dim>>>& shares) {
  for (std::size_t f = 0; f < shares.size(); ++f) {
    std::map<int, std::shared_ptr<const LocalRotation<dim>>> of_solid;
    for (SurfaceShare<dim>& share : shares[f]) {
      if (surface.solids()[share.solid].rigid)
        continue;
      auto& rotation = of_solid[share.solid];
      if (!rotation)
        rotation = std::make_shared<LocalRotation<dim>>(volumes[f].box, share.solid, surface);
      share.rotation = rotation;
    }
  }
}

template <int dim>
void directed_row(const SolidSystem<dim>& solids, const SurfacePoint<dim>& point,
                  const Point<dim>& x, int direction, VelocityRow<dim>& scratch,
                  std::vector<GlobalIndex>& dofs, std::vector<double>& values) {
  solids.velocity_row(point, x, scratch);
  dofs.clear();
  values.clear();
  for (std::size_t k = 0; k < scratch.dofs.size(); ++k) {
    const double value = scratch.coefficients[k][direction];
    if (value == 0)
      continue;
    dofs.push_back(scratch.dofs[k]);
    values.push_back(value);
  }
}

template <int dim>
void carried_row(const SolidSystem<dim>& solids, const SurfaceShare<dim>& share,
                 const Point<dim>& x, int direction, VelocityRow<dim>& scratch,
                 std::vector<GlobalIndex>& dofs, std::vector<double>& values) {
  directed_row<dim>(solids, share.point, x, direction, scratch, dofs, values);
  if (!share.rotation)
    return;
  const auto add = [&](const SurfacePoint<dim>& vertex, const Point<dim>& coefficient) {
    solids.velocity_row(vertex, x, scratch);
    for (std::size_t k = 0; k < scratch.dofs.size(); ++k) {
      dofs.push_back(scratch.dofs[k]);
      values.push_back(coefficient.dot(scratch.coefficients[k]));
    }
  };
  share.rotation->row(x - share.point.position, direction, add);
}

template <int dim>
Point<dim> carried_effective_velocity(const SolidSystem<dim>& solids,
                                      const SurfaceShare<dim>& share, const Point<dim>& x) {
  Point<dim> velocity = solids.effective_velocity(share.point, x);
  if (share.rotation) {
    const auto of_vertex = [&](const SurfacePoint<dim>& vertex) {
      return solids.effective_velocity(vertex, x);
    };
    velocity += share.rotation->velocity_at(x - share.point.position, of_vertex);
  }
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
                                 const SolidSystem<dim>& solids) {
  VelocityRow<dim> scratch;
  std::vector<GlobalIndex> dofs;
  std::vector<double> values;
  return weights_of_rows(static_cast<int>(volumes.size()), [&](int f, RowEntries& row) {
    for (const SurfaceShare<dim>& share : shares[f]) {
      carried_row<dim>(solids, share, volumes[f].center, volumes[f].direction, scratch, dofs,
                       values);
      for (std::size_t k = 0; k < dofs.size(); ++k) {
        row.emplace_back(dofs[k], share.weight * values[k]);
      }
    }
  });
}

bool any_prescribed(const std::vector<SolidDescription>& solids) {
  return std::any_of(solids.begin(), solids.end(),
                     [](const SolidDescription& solid) { return solid.prescribed; });
}

template std::vector<std::vector<SurfaceShare<2>>> surface_shares<2>(
    const std::vector<ControlVolume<2>>&, const SurfaceSnapshot<2>&, double);
template void directed_row<2>(const SolidSystem<2>&, const SurfacePoint<2>&, const Point<2>&, int,
                              VelocityRow<2>&, std::vector<GlobalIndex>&, std::vector<double>&);
template void add_local_rotations<2>(const std::vector<ControlVolume<2>>&,
                                     const SurfaceSnapshot<2>&,
                                     std::vector<std::vector<SurfaceShare<2>>>&);
template void carried_row<2>(const SolidSystem<2>&, const SurfaceShare<2>&, const Point<2>&, int,
                             VelocityRow<2>&, std::vector<GlobalIndex>&, std::vector<double>&);
template Point<2> carried_effective_velocity<2>(const SolidSystem<2>&, const SurfaceShare<2>&,
                                                const Point<2>&);
template CouplingWeights coupling_weights<2>(const std::vector<ControlVolume<2>>&,
                                             const std::vector<std::vector<SurfaceShare<2>>>&,
                                             const SolidSystem<2>&);
template std::vector<std::vector<SurfaceShare<3>>> surface_shares<3>(
    const std::vector<ControlVolume<3>>&, const SurfaceSnapshot<3>&, double);
template void directed_row<3>(const SolidSystem<3>&, const SurfacePoint<3>&, const Point<3>&, int,
                              VelocityRow<3>&, std::vector<GlobalIndex>&, std::vector<double>&);
template void add_local_rotations<3>(const std::vector<ControlVolume<3>>&,
                                     const SurfaceSnapshot<3>&,
                                     std::vector<std::vector<SurfaceShare<3>>>&);
template void carried_row<3>(const SolidSystem<3>&, const SurfaceShare<3>&, const Point<3>&, int,
                             VelocityRow<3>&, std::vector<GlobalIndex>&, std::vector<double>&);
template Point<3> carried_effective_velocity<3>(const SolidSystem<3>&, const SurfaceShare<3>&,
                                                const Point<3>&);
template CouplingWeights coupling_weights<3>(const std::vector<ControlVolume<3>>&,
                                             const std::vector<std::vector<SurfaceShare<3>>>&,
                                             const SolidSystem<3>&);

}  // namespace lockstep
