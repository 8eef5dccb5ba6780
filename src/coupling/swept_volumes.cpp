#include "coupling/swept_volumes.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Import.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "interfaces/fluid_sides.hpp"
#include "interfaces/volume_sweeper.hpp"

namespace lockstep {
namespace {

constexpr double as_they_like = std::numeric_limits<double>::quiet_NaN();

/// Volume that the dofs of a soft solid push out of a region's cells.
struct Push {
  int solid = 0, region = 0;
  double along = 0;  ///< product with the surface's swept volume, per velocity squared
  double size = 0;   ///< sum of the absolute values of the terms of `along`
  double rate = 0;   ///< at the given velocity [m^dim/s]
};

/// All soft solids whose swept volume can be given, and the volumes that they and others push out
/// of the regions.
struct Pushes {
  int n_regions = 0, n_solids = 0;
  std::vector<Push> of;            ///< pushes of solids with regions that they meet, in this order
  std::vector<std::size_t> begin;  ///< [solid], in `of`; then its size
  std::vector<double> others;      ///< [region], rate of all other solids [m^dim/s]
  std::vector<double> norm;        ///< [solid], of what the surface sweeps, squared
  std::vector<double> swept;       ///< [solid], by its surface at the given velocity [m^dim/s]
};

/// The local rows of the stack by soft solid: the solid's number among those whose swept volume can
/// be given (-1: none of them), and the swept volume per velocity.
struct SoftRows {
  std::vector<int> solid;
  std::vector<double> swept;
  std::vector<std::pair<int, int>> names;  ///< model and solid in it, by number: ascending
  std::vector<char> is_closed;             ///< by number
};

/// The domain without the sides that a solid, by its number in the stack, goes through and comes
/// back.
template <int dim>
Box<dim> room_of(const SolidSystem<dim>& solids, int solid, Box<dim> domain) {
  constexpr double far = std::numeric_limits<double>::infinity();
  for (int a = 0; a < dim && solids.repeated().includes(solid); ++a)
    if (solids.repeated().images().period[a] > 0) {
      domain.min()[a] = -far;
      domain.max()[a] = far;
    }
  return domain;
}

/// `VolumeSweeper::can_sweep` of the solids of a model, the first of which has a number in the
/// stack. Collective.
template <int dim>
std::vector<char> can_sweep(const VolumeSweeper<dim>& sweeper, const SolidSystem<dim>& solids,
                            int first, const Box<dim>& domain) {
  std::vector<char> can = sweeper.can_sweep(domain);
  std::vector<char> anywhere;
  for (std::size_t s = 0; s < can.size(); ++s) {
    const int solid = first + static_cast<int>(s);
    if (!solids.repeated().includes(solid))
      continue;
    if (anywhere.empty())
      anywhere = sweeper.can_sweep(room_of<dim>(solids, solid, domain));
    can[s] = anywhere[s];
  }
  return can;
}

template <int dim>
SoftRows soft_rows(const SolidSystem<dim>& solids, const Box<dim>& domain) {
  SoftRows rows;
  int first = 0;
  for (int m = 0; m < solids.n_models(); ++m) {
    const int here = first;
    first += static_cast<int>(solids.model(m).solids().size());
    const auto* sweeper = solids.model(m).sweeper();
    const std::size_t begin = rows.solid.size();
    rows.solid.resize(begin + solids.model(m).dof_map()->getNodeNumElements(), -1);
    rows.swept.resize(rows.solid.size(), 0);
    if (!sweeper)
      continue;
    const std::vector<char> can = can_sweep<dim>(*sweeper, solids, here, domain);
    std::vector<int> number(can.size(), -1);
    for (std::size_t s = 0; s < can.size(); ++s) {
      if (!can[s])
        continue;
      number[s] = static_cast<int>(rows.names.size());
      rows.names.emplace_back(m, static_cast<int>(s));
      rows.is_closed.push_back(solids.model(m).solids()[s].closed);
    }
    const RCP<const Vector> swept = sweeper->swept_per_velocity();
    const auto values = swept->getData();
    const std::vector<int> solid_of_row = solids.model(m).solid_of_row();
    for (std::size_t i = 0; i < solid_of_row.size(); ++i) {
      rows.solid[begin + i] = number[solid_of_row[i]];
      rows.swept[begin + i] = values[i];
    }
  }
  rows.solid.resize(solids.map()->getNodeNumElements(), -1);  // padding
  rows.swept.resize(rows.solid.size(), 0);
  return rows;
}

/// The region of each column of B^T on this rank. Collective.
std::vector<int> regions_of_columns(const CrsMatrix& coupling_transposed,
                                    const PressureRegions& regions) {
  Vector mine(coupling_transposed.getDomainMap());
  {
    const auto values = mine.getDataNonConst();
    for (std::size_t i = 0; i < regions.of_unknown.size(); ++i)
      values[i] = regions.of_unknown[i];
  }
  Vector columns(coupling_transposed.getColMap());
  const auto import = coupling_transposed.getGraph()->getImporter();
  if (import.is_null())
    columns.update(1, mine, 0);
  else
    columns.doImport(mine, *import, Tpetra::INSERT);
  const auto values = columns.getData();
  std::vector<int> result(values.size());
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = static_cast<int>(std::lround(values[i]));
  return result;
}

/// Sums pushes of the same solid and region, in the order in which they come.
void merge(std::vector<Push>& pushes) {
  std::stable_sort(pushes.begin(), pushes.end(), [](const Push& a, const Push& b) {
    return std::pair(a.solid, a.region) < std::pair(b.solid, b.region);
  });
  std::size_t n = 0;
  for (const Push& push : pushes) {
    if (n == 0 || pushes[n - 1].solid != push.solid || pushes[n - 1].region != push.region) {
      pushes[n++] = push;
      continue;
    }
    pushes[n - 1].along += push.along;
    pushes[n - 1].size += push.size;
    pushes[n - 1].rate += push.rate;
  }
  pushes.resize(n);
}

/// A solid meets few of many regions, and few ranks meet it. Collective.
void gather(std::vector<Push>& pushes, const Communicator& comm) {
  std::vector<double> mine;
  for (const Push& push : pushes)
    mine.insert(mine.end(),
                {double(push.solid), double(push.region), push.along, push.size, push.rate});
  const std::vector<double> all = gather_all(comm, mine);
  pushes.clear();
  for (std::size_t k = 0; k < all.size(); k += 5)
    pushes.push_back({static_cast<int>(all[k]), static_cast<int>(all[k + 1]), all[k + 2],
                      all[k + 3], all[k + 4]});
  merge(pushes);
}

void find_begins(Pushes& pushes) {
  pushes.begin.assign(pushes.n_solids + 1, 0);
  for (const Push& push : pushes.of)
    ++pushes.begin[push.solid + 1];
  std::partial_sum(pushes.begin.begin(), pushes.begin.end(), pushes.begin.begin());
}

/// Returns the push of a solid on a region, which is made if there is none; a solid has few.
Push& push_on(std::vector<Push>& of_solid, int solid, int region) {
  const auto found = std::find_if(of_solid.begin(), of_solid.end(),
                                  [region](const Push& push) { return push.region == region; });
  if (found != of_solid.end())
    return *found;
  of_solid.push_back({solid, region, 0, 0, 0});
  return of_solid.back();
}

Pushes pushes_of(const CrsMatrix& coupling_transposed, const PressureRegions& regions,
                 const SoftRows& soft, const Vector& velocity, const Vector& prescribed) {
  Pushes pushes;
  pushes.n_regions = regions.n_regions;
  pushes.n_solids = static_cast<int>(soft.names.size());
  pushes.others.assign(pushes.n_regions, 0);
  pushes.norm.assign(pushes.n_solids, 0);
  pushes.swept.assign(pushes.n_solids, 0);
  std::vector<std::vector<Push>> of_solid(pushes.n_solids);
  const std::vector<int> region = regions_of_columns(coupling_transposed, regions);
  const auto v = velocity.getData();
  Teuchos::ArrayView<const int> columns;
  Teuchos::ArrayView<const double> values;
  for (std::size_t row = 0; row < soft.solid.size(); ++row) {
    const int s = soft.solid[row];
    coupling_transposed.getLocalRowView(static_cast<int>(row), columns, values);
    if (s >= 0) {
      pushes.norm[s] += soft.swept[row] * soft.swept[row];
      pushes.swept[s] += soft.swept[row] * v[row];
    }
    for (int k = 0; k < columns.size(); ++k) {
      const double rate = values[k] * v[row];
      if (s < 0) {
        pushes.others[region[columns[k]]] += rate;
        continue;
      }
      Push& push = push_on(of_solid[s], s, region[columns[k]]);
      push.along += values[k] * soft.swept[row];
      push.size += std::abs(values[k] * soft.swept[row]);
      push.rate += rate;
    }
  }
  for (const std::vector<Push>& some : of_solid)
    pushes.of.insert(pushes.of.end(), some.begin(), some.end());
  merge(pushes.of);
  const auto of_prescribed = prescribed.getData();
  for (std::size_t i = 0; i < regions.of_unknown.size(); ++i)
    pushes.others[regions.of_unknown[i]] += of_prescribed[i];
  const Communicator comm = velocity.getMap()->getComm();
  sum_over_ranks(comm, pushes.others, pushes.norm, pushes.swept);
  if (comm->getSize() > 1)
    gather(pushes.of, comm);
  find_begins(pushes);
  return pushes;
}

/// Gives the volume of rigid and prescribed bodies to the soft solids that they share faces with:
/// inside the domain such bodies displace no net volume, so that any sum over their part of the
/// faces belongs to the others.
void share_others(Pushes& pushes) {
  std::vector<double> total(pushes.n_regions, 0);
  for (const Push& push : pushes.of)
    total[push.region] += std::abs(push.along);
  for (Push& push : pushes.of) {
    if (total[push.region] > 0)
      push.rate += pushes.others[push.region] * std::abs(push.along) / total[push.region];
  }
}

/// True if all solids but those whose swept volume can be given are rigid or prescribed bodies
/// inside the domain.
template <int dim>
bool others_keep_volume(const SolidSystem<dim>& solids, const SoftRows& soft,
                        const Box<dim>& domain) {
  int number = 0;
  for (int m = 0; m < solids.n_models(); ++m) {
    const SurfaceMesh<dim>& surface = solids.model(m).surface();
    for (std::size_t s = 0; s < solids.model(m).solids().size(); ++s) {
      const Box<dim> room = room_of<dim>(solids, number++, domain);
      if (std::binary_search(soft.names.begin(), soft.names.end(),
                             std::make_pair(m, static_cast<int>(s))))
        continue;
      const SolidDescription& solid = solids.model(m).solids()[s];
      if (solid.simplex_begin == solid.simplex_end)
        continue;  // the fluid sees nothing of it
      if (!solid.closed || !(solid.rigid || solid.prescribed))
        return false;
      for (int v = solid.vertex_begin; v < solid.vertex_end; ++v) {
        if (!room.contains(surface.vertices[v]))
          return false;
      }
    }
  }
  return true;
}

/// Returns the volume rate that solid s must sweep. For a body between closed regions it is that of
/// its own velocities, without what its straight steps add; its elasticity answers for the rest, as
/// the grid sees its shape only roughly. A shell has no volume of its own to answer with: its rate
/// is what it pushes out of the regions on one of its sides, if these are all closed and it is all
/// of that side.
double rate_of(const Pushes& pushes, const PressureRegions& regions, int s, bool is_closed) {
  constexpr double least_part = 0.5;   // part of a shell's side [1]: 1 on a fine grid
  constexpr double round_off = 1e-12;  // round-off of terms that cancel [1]
  for (const int sign : {1, -1}) {
    bool all_closed = true;
    double along = 0, size = 0, rate = 0;
    for (std::size_t k = pushes.begin[s]; k < pushes.begin[s + 1]; ++k) {
      const Push& push = pushes.of[k];
      if (push.size == 0 || (!is_closed && sign * push.along <= 0))
        continue;
      all_closed = all_closed && !regions.has_dirichlet[push.region];
      along += sign * push.along;
      size += push.size;
      rate += sign * push.rate;
    }
    if (is_closed)
      return all_closed && std::abs(along) > round_off * size ? pushes.swept[s] : as_they_like;
    if (all_closed && along > least_part * pushes.norm[s])
      return rate;
  }
  return as_they_like;
}

}  // namespace

template <int dim>
SweptRates swept_rates(const FluidDiscretization<dim>& fluid, const SolidSystem<dim>& solids,
                       const Coupling<dim>& coupling, const Vector& velocity) {
  const PressureRegions& regions = fluid.regions();
  const RCP<const CrsMatrix> coupling_transposed = coupling.coupling_transposed();
  if (coupling_transposed.is_null() ||
      std::all_of(regions.has_dirichlet.begin(), regions.has_dirichlet.end(),
                  [](char has) { return has != 0; }))
    return {};
  const Box<dim> domain = fluid.bounds();
  const SoftRows soft = soft_rows<dim>(solids, domain);
  if (soft.names.empty())
    return {};
  Vector prescribed(fluid.pressure_map());
  coupling.add_prescribed_divergence(prescribed);
  Pushes pushes = pushes_of(*coupling_transposed, regions, soft, velocity, prescribed);
  if (others_keep_volume<dim>(solids, soft, domain))
    share_others(pushes);
  SweptRates rates(solids.n_models());
  for (int m = 0; m < solids.n_models(); ++m)
    rates[m].assign(solids.model(m).solids().size(), as_they_like);
  for (std::size_t s = 0; s < soft.names.size(); ++s)
    rates[soft.names[s].first][soft.names[s].second] =
        rate_of(pushes, regions, static_cast<int>(s), soft.is_closed[s] != 0);
  return rates;
}

template <int dim>
SweptRates rates_of_kind(const SweptRates& rates, const SolidSystem<dim>& solids, bool closed) {
  SweptRates some = rates;
  for (std::size_t m = 0; m < rates.size(); ++m) {
    for (std::size_t s = 0; s < rates[m].size(); ++s) {
      if (solids.model(static_cast<int>(m)).solids()[s].closed != closed)
        some[m][s] = as_they_like;
    }
  }
  return some;
}

template <int dim>
void sweep_volumes(const SweptRates& rates, const SolidSystem<dim>& solids, double dt,
                   Vector& velocity) {
  std::size_t begin = 0;
  for (std::size_t m = 0; m < rates.size(); ++m) {
    const SolidModel<dim>& model = solids.model(static_cast<int>(m));
    if (const auto* sweeper = model.sweeper()) {
      std::vector<double> volumes = rates[m];
      for (double& volume : volumes)
        volume *= dt;
      sweeper->sweep(dt, volumes,
                     *velocity.offsetViewNonConst(model.dof_map(), begin)->getVectorNonConst(0));
    }
    begin += model.dof_map()->getNodeNumElements();
  }
}

template SweptRates swept_rates(const FluidDiscretization<2>&, const SolidSystem<2>&,
                                const Coupling<2>&, const Vector&);
template SweptRates rates_of_kind(const SweptRates&, const SolidSystem<2>&, bool);
template void sweep_volumes(const SweptRates&, const SolidSystem<2>&, double, Vector&);
template SweptRates swept_rates(const FluidDiscretization<3>&, const SolidSystem<3>&,
                                const Coupling<3>&, const Vector&);
template SweptRates rates_of_kind(const SweptRates&, const SolidSystem<3>&, bool);
template void sweep_volumes(const SweptRates&, const SolidSystem<3>&, double, Vector&);

}  // namespace lockstep
