#include "coupling/viscous_couplings.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/triplet_matrix.hpp"

namespace lockstep {

template <int dim>
std::vector<EndVelocity<dim>> ViscousCouplings<dim>::ends_of(const ViscousSystem<dim>& system,
                                                             const SolidSystem<dim>& solids,
                                                             const ViscousCoupling<dim>& coupling) {
  std::vector<EndVelocity<dim>> ends(system.links.size());
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    coupling.link_row(system.links[l], solids, ends[l]);
    if (ends[l].solid >= 0)
      ends[l].position = solids.own_place(ends[l].solid, ends[l].position);
  }
  return ends;
}

template <int dim>
ViscousCouplings<dim>::ViscousCouplings(const ViscousSystem<dim>& system,
                                        const SolidSystem<dim>& solids,
                                        const ViscousCoupling<dim>& coupling, bool with_places)
    : list_(system.links),
      ends_(ends_of(system, solids, coupling)),
      couples_(system.links, ends_, solids.solids(), solids.comm()),
      map_(make_map(static_cast<int>(system.links.size()), solids.comm())) {
  std::vector<Triplet> rows, squares;
  for (std::size_t l = 0; l < list_.size(); ++l) {
    EndVelocity<dim>& end = ends_[l];
    const GlobalIndex id = map_->getGlobalElement(static_cast<int>(l));
    for (std::size_t i = 0; i < end.dofs.size(); ++i) {
      rows.push_back({id, end.dofs[i], end.weights[i]});
      squares.push_back({id, end.dofs[i], end.weights[i] * end.weights[i]});
    }
    end.dofs.clear();
    end.weights.clear();
    if (!with_places)
      end.shares.clear();
  }
  if (solids.has_unknowns()) {
    rows_ = assemble_triplets(std::move(rows), map_, solids.map());
    squares_ = assemble_triplets(std::move(squares), map_, solids.map());
  }
}

template <int dim>
RCP<Vector> ViscousCouplings<dim>::end_velocity(const RCP<const Vector>& solid,
                                                bool prescribed) const {
  const auto result = make_vector(map_);
  if (!rows_.is_null() && !solid.is_null())
    rows_->apply(*solid, *result);
  if (prescribed) {
    const auto values = result->getDataNonConst();
    for (std::size_t l = 0; l < list_.size(); ++l)
      values[l] += ends_[l].prescribed;
  }
  return result;
}

template <int dim>
RCP<Vector> ViscousCouplings<dim>::pull(const Vector& u, const Vector& end_velocity) const {
  const auto result = make_vector(map_);
  const auto values = result->getDataNonConst();
  const auto velocity = u.getData(), end = end_velocity.getData();
  for (std::size_t l = 0; l < list_.size(); ++l)
    values[l] = list_[l].coefficient * (velocity[list_[l].row] - end[l]);
  return result;
}

template <int dim>
RCP<Vector> ViscousCouplings<dim>::couple_pull(const Vector& end_velocity) const {
  const auto result = make_vector(map_);
  add_couples(end_velocity, *result);
  return result;
}

template <int dim>
void ViscousCouplings<dim>::add_couples(const Vector& end_velocity, Vector& pull) const {
  couples_.add_pull(end_velocity.getData().getRawPtr(), pull.getDataNonConst().getRawPtr());
}

template <int dim>
void ViscousCouplings<dim>::take_from_fluid(double dt, const Vector& values, bool weighted,
                                            Vector& fluid) const {
  const auto value = values.getData();
  const auto result = fluid.getDataNonConst();
  for (std::size_t l = 0; l < list_.size(); ++l)
    result[list_[l].row] -= dt * (weighted ? list_[l].coefficient : 1) * value[l];
}

template <int dim>
void ViscousCouplings<dim>::pull_on_solids(double alpha, const Vector& pull, double beta,
                                           Vector& drag) const {
  rows_->apply(pull, drag, Teuchos::TRANS, alpha, beta);
}

template <int dim>
double ViscousCouplings<dim>::dissipation(const Vector& u, const Vector& end_velocity,
                                          const Vector& couple_pull) const {
  double power = 0;
  const auto velocity = u.getData(), end = end_velocity.getData(), couples = couple_pull.getData();
  for (std::size_t l = 0; l < list_.size(); ++l) {
    const double v = end[l];
    power += list_[l].coefficient * v * (v - 2 * velocity[list_[l].row]) - v * couples[l];
  }
  return power;
}

template <int dim>
RCP<Vector> ViscousCouplings<dim>::strength_on_solids() const {
  Vector strength(map_);
  for (std::size_t l = 0; l < list_.size(); ++l)
    strength.replaceLocalValue(static_cast<int>(l), list_[l].coefficient);
  const auto result = make_vector(squares_->getDomainMap());
  squares_->apply(strength, *result, Teuchos::TRANS);
  return result;
}

template <int dim>
Momentum<dim> ViscousCouplings<dim>::impulse(const Vector& pull, const Vector& couple_pull,
                                             double dt,
                                             std::vector<Momentum<dim>>& of_prescribed) const {
  Momentum<dim> couple;
  const auto values = pull.getData(), couples = couple_pull.getData();
  for (std::size_t l = 0; l < list_.size(); ++l) {
    const ViscousCouplingTerm<dim>& link = list_[l];
    const EndVelocity<dim>& end = ends_[l];
    const Point<dim> axis = Point<dim>::Unit(link.direction);
    if (end.prescribed_share > 0)
      of_prescribed[end.prescribed_solid].add(
          end.position, -dt * end.prescribed_share * (values[l] + couples[l]) * axis);
    couple.angular += cross<dim>(link.position - end.position, -dt * values[l] * axis);
    couple.add(end.position, dt * couples[l] * axis);
  }
  return couple;
}

template <int dim>
std::vector<SurfaceImpulse<dim>> ViscousCouplings<dim>::impulses_on_solids(
    const Vector& pull, const Vector& couple_pull, double dt) const {
  std::vector<SurfaceImpulse<dim>> impulses;
  const auto values = pull.getData(), couples = couple_pull.getData();
  for (std::size_t l = 0; l < list_.size(); ++l) {
    const EndVelocity<dim>& end = ends_[l];
    const Point<dim> whole = dt * (values[l] + couples[l]) * Point<dim>::Unit(list_[l].direction);
    const EndShare<dim>* prescribed = nullptr;
    for (const EndShare<dim>& share : end.shares)
      if (share.prescribed)
        prescribed = &share;
      else
        impulses.push_back({share.point, share.pulled, share.weight * whole});
    if (prescribed)
      impulses.push_back({prescribed->point, end.position, end.prescribed_share * whole});
  }
  return impulses;
}

template class ViscousCouplings<2>;
template class ViscousCouplings<3>;

}  // namespace lockstep
