#include "coupling/solid_totals.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

namespace lockstep {

template <int dim>
double largest_surface_speed(const SolidSystem<dim>& solids) {
  double largest = 0;
  for (int m = 0; m < solids.n_models(); ++m) {
    const std::vector<SolidState<dim>> states = solids.model(m).states();
    const SurfaceMesh<dim>& surface = solids.model(m).surface();
    for (std::size_t s = 0; s < states.size(); ++s) {
      const SolidDescription& solid = solids.model(m).solids()[s];
      for (int v = solid.vertex_begin; v < solid.vertex_end; ++v) {
        const Point<dim> arm = surface.vertices[v] - states[s].center_of_mass;
        const Point<dim> velocity =
            states[s].velocity + rotate<dim>(states[s].angular_velocity, arm);
        largest = std::max(largest, velocity.template lpNorm<1>());
      }
    }
  }
  return largest;
}

template <int dim>
Momentum<dim> external_impulse(const SolidSystem<dim>& solids, double time, double dt) {
  Momentum<dim> total;
  for (int m = 0; m < solids.n_models(); ++m) {
    if (const auto* audited = solids.model(m).audit())
      total += audited->external_impulse(time, dt);
  }
  return total;
}

template <int dim>
AngularVector<dim> inner_angular_impulse(const SolidSystem<dim>& solids, double dt) {
  AngularVector<dim> total = AngularVector<dim>::Zero();
  for (int m = 0; m < solids.n_models(); ++m) {
    if (const auto* audited = solids.model(m).audit())
      total += audited->inner_angular_impulse(dt);
  }
  return total;
}

template <int dim>
bool is_audited(const SolidSystem<dim>& solids) {
  bool all = true;
  for (int m = 0; m < solids.n_models(); ++m)
    all = all && solids.model(m).audit();
  return all;
}

template <int dim>
bool has_soft_solids(const SolidSystem<dim>& solids) {
  const std::vector<SolidDescription>& all = solids.solids();
  return std::any_of(all.begin(), all.end(), [](const SolidDescription& solid) {
    return !solid.rigid && !solid.prescribed;
  });
}

template <int dim>
bool has_implicit_forces(const SolidSystem<dim>& solids) {
  bool any = false;
  for (int m = 0; m < solids.n_models(); ++m)
    any = any || solids.nonlinear(m);
  return any;
}

template <int dim>
RCP<const Vector> linearisation(const SolidSystem<dim>& solids) {
  RCP<Vector> all;
  for (int m = 0; m < solids.n_models(); ++m) {
    const auto* forces = solids.nonlinear(m);
    const RCP<const Vector> velocity = forces ? forces->linearisation() : Teuchos::null;
    if (velocity.is_null())
      continue;
    if (all.is_null())
      all = make_vector(solids.map());
    solids.part(*all, m)->update(1, *velocity, 0);
  }
  return all;
}

template <int dim>
std::vector<ComputedEnergy> nonlinear_energies(const SolidSystem<dim>& solids, double dt,
                                               const Vector& velocity) {
  std::vector<ComputedEnergy> all;
  for (int m = 0; m < solids.n_models(); ++m) {
    const auto* forces = solids.nonlinear(m);
    const std::size_t end = all.size() + solids.model(m).solids().size();
    if (forces) {
      for (const ComputedEnergy& energy : forces->nonlinear_energies(dt, *solids.part(velocity, m)))
        all.push_back(energy);
    }
    all.resize(end);
  }
  return all;
}

template <int dim>
StepBound largest_stable_step(const SolidSystem<dim>& solids) {
  StepBound bound;
  for (int m = 0; m < solids.n_models(); ++m)
    bound = shorter(bound, solids.model(m).largest_stable_step());
  return bound;
}

template <int dim>
GlobalIndex n_clamped_elements(const SolidSystem<dim>& solids) {
  GlobalIndex n = 0;
  for (int m = 0; m < solids.n_models(); ++m) {
    if (const auto* output = solids.model(m).output())
      n += output->n_clamped_elements();
  }
  return n;
}

template <int dim>
double stretch_beyond_limit(const SolidSystem<dim>& solids) {
  double worst = 0;
  for (int m = 0; m < solids.n_models(); ++m) {
    if (const auto* output = solids.model(m).output())
      worst = std::max(worst, output->stretch_beyond_limit());
  }
  return worst;
}

template <int dim>
bool is_where(const SolidSystem<dim>& solids, const SurfaceSnapshot<dim>& snapshot) {
  if (!solids.repeated().empty()) {
    SurfaceMesh<dim> shown = solids.surface();
    for (std::size_t i = 0; i < solids.solids().size(); ++i)
      for (int v = solids.solids()[i].vertex_begin; v < solids.solids()[i].vertex_end; ++v)
        shown.vertices[v] += snapshot.images().shifts[i];
    return std::equal(shown.vertices.begin(), shown.vertices.end(),
                      snapshot.mesh().vertices.begin());
  }
  auto there = snapshot.mesh().vertices.begin();
  for (int m = 0; m < solids.n_models(); ++m) {
    const auto& here = solids.model(m).surface().vertices;
    if (!std::equal(here.begin(), here.end(), there))
      return false;
    there += static_cast<std::ptrdiff_t>(here.size());
  }
  return true;
}

template <int dim>
std::shared_ptr<const SurfaceSnapshot<dim>> with_images_of(
    const SolidSystem<dim>& solids, const SurfaceSnapshot<dim>& other,
    const std::shared_ptr<const SurfaceSnapshot<dim>>& earlier) {
  if (earlier->images() == other.images())
    return earlier;
  SurfaceMesh<dim> mesh = earlier->mesh();  // first images, then further ones
  mesh.vertices.resize(solids.solids().back().vertex_end);
  mesh.simplices.resize(solids.solids().back().simplex_end);
  for (std::size_t i = 0; i < solids.solids().size(); ++i)
    for (int v = solids.solids()[i].vertex_begin; v < solids.solids()[i].vertex_end; ++v)
      mesh.vertices[v] += other.images().shifts[i] - earlier->images().shifts[i];
  return std::make_shared<const SurfaceSnapshot<dim>>(std::move(mesh), solids.solids(),
                                                      other.order(), other.images());
}

template <int dim>
NearNullSpace near_null_space(const SolidSystem<dim>& solids, const RCP<const CrsMatrix>& added) {
  constexpr int n_motions = dim + n_rotations<dim>;
  NearNullSpace all;
  const RCP<const Map> map = solids.map();
  const std::vector<Block> blocks = solids.blocks();
  RCP<MultiVector> motions;
  for (int m = 0; m < solids.n_models(); ++m) {
    const RigidMotions part = solids.model(m).near_null_space();
    if (part.empty())
      continue;
    if (motions.is_null()) {
      motions = rcp(new MultiVector(map, n_motions));
      all.body_of_row.assign(map->getNodeNumElements(), -1);
    }
    motions->offsetViewNonConst(solids.model(m).dof_map(), blocks[m].begin)
        ->update(1, *part.motions, 0);
    for (std::size_t row = 0; row < part.body_of_row.size(); ++row)
      all.body_of_row[blocks[m].begin + row] = all.n_bodies + part.body_of_row[row];
    all.n_bodies += part.n_bodies;
  }
  all.motions = motions;
  if (all.empty())
    return all;
  const auto mass = lumped_mass(*solids.full_block(added, 0), all);
  if (!solids.reduction().is_identity()) {
    const auto values = mass->getDataNonConst();
    const auto is_unknown = solids.reduction().unknowns()->getData();
    for (std::size_t row = 0; row < all.body_of_row.size(); ++row) {
      if (all.body_of_row[row] >= 0 && is_unknown[row] == 0)
        values[row] = 1;
    }
  }
  all.mass = mass;
  return all;
}

template <int dim>
RCP<Vector> implicit_impulse(const SolidSystem<dim>& solids, double dt, const Vector& velocity) {
  const auto stacked = make_vector(solids.map());
  for (int m = 0; m < solids.n_models(); ++m) {
    const RCP<const LinearOperator> force = solids.model(m).implicit_force(dt);
    if (!force.is_null())
      apply(*force, *solids.part(velocity, m), *solids.part(*stacked, m), dt);
  }
  return stacked;
}

template double largest_surface_speed<2>(const SolidSystem<2>&);
template Momentum<2> external_impulse<2>(const SolidSystem<2>&, double, double);
template AngularVector<2> inner_angular_impulse<2>(const SolidSystem<2>&, double);
template bool is_audited<2>(const SolidSystem<2>&);
template bool has_soft_solids<2>(const SolidSystem<2>&);
template bool has_implicit_forces<2>(const SolidSystem<2>&);
template RCP<const Vector> linearisation<2>(const SolidSystem<2>&);
template std::vector<ComputedEnergy> nonlinear_energies<2>(const SolidSystem<2>&, double,
                                                           const Vector&);
template StepBound largest_stable_step<2>(const SolidSystem<2>&);
template GlobalIndex n_clamped_elements<2>(const SolidSystem<2>&);
template double stretch_beyond_limit<2>(const SolidSystem<2>&);
template NearNullSpace near_null_space<2>(const SolidSystem<2>&, const RCP<const CrsMatrix>&);
template RCP<Vector> implicit_impulse<2>(const SolidSystem<2>&, double, const Vector&);
template double largest_surface_speed<3>(const SolidSystem<3>&);
template Momentum<3> external_impulse<3>(const SolidSystem<3>&, double, double);
template AngularVector<3> inner_angular_impulse<3>(const SolidSystem<3>&, double);
template bool is_audited<3>(const SolidSystem<3>&);
template bool has_soft_solids<3>(const SolidSystem<3>&);
template bool has_implicit_forces<3>(const SolidSystem<3>&);
template RCP<const Vector> linearisation<3>(const SolidSystem<3>&);
template std::vector<ComputedEnergy> nonlinear_energies<3>(const SolidSystem<3>&, double,
                                                           const Vector&);
template StepBound largest_stable_step<3>(const SolidSystem<3>&);
template GlobalIndex n_clamped_elements<3>(const SolidSystem<3>&);
template double stretch_beyond_limit<3>(const SolidSystem<3>&);
template NearNullSpace near_null_space<3>(const SolidSystem<3>&, const RCP<const CrsMatrix>&);
template RCP<Vector> implicit_impulse<3>(const SolidSystem<3>&, double, const Vector&);
template bool is_where<2>(const SolidSystem<2>&, const SurfaceSnapshot<2>&);
template std::shared_ptr<const SurfaceSnapshot<2>> with_images_of<2>(
    const SolidSystem<2>&, const SurfaceSnapshot<2>&,
    const std::shared_ptr<const SurfaceSnapshot<2>>&);
template bool is_where<3>(const SolidSystem<3>&, const SurfaceSnapshot<3>&);
template std::shared_ptr<const SurfaceSnapshot<3>> with_images_of<3>(
    const SolidSystem<3>&, const SurfaceSnapshot<3>&,
    const std::shared_ptr<const SurfaceSnapshot<3>>&);

}  // namespace lockstep
