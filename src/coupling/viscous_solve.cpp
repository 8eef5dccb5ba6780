#include "coupling/viscous_solve.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <cmath>

#include "base/errors.hpp"
#include "coupling/spin_couples.hpp"
#include "linear/triplet_matrix.hpp"
#include "solve/preconditioner.hpp"

namespace lockstep {
namespace {

/// A pair of vectors: free velocities and solid dofs (null without unknowns).
struct Pair {
  RCP<Vector> fluid, solid;
  double dot(const Pair& other) const {
    return fluid->dot(*other.fluid) + (solid.is_null() ? 0 : solid->dot(*other.solid));
  }
  /// this = alpha x + beta this
  void update(double alpha, const Pair& x, double beta) {
    fluid->update(alpha, *x.fluid, beta);
    if (!solid.is_null())
      solid->update(alpha, *x.solid, beta);
  }
  Pair same_shape() const {
    return {rcp(new Vector(fluid->getMap())),
            solid.is_null() ? RCP<Vector>() : rcp(new Vector(solid->getMap()))};
  }
  Pair scaled_by(const Pair& weights) const {
    Pair result = same_shape();
    result.fluid->elementWiseMultiply(1, *weights.fluid, *fluid, 0);
    if (!solid.is_null())
      result.solid->elementWiseMultiply(1, *weights.solid, *solid, 0);
    return result;
  }
};

/// All links of this rank: link l pulls with c_l (u_row(l) - (L V)_l - prescribed_l) on fluid and
/// solid; the couples of the transposed gradient come to the solid's end.
template <int dim>
struct Links {
  const std::vector<ViscousLink<dim>>& list;
  RCP<const Map> map;              ///< links
  RCP<const CrsMatrix> rows;       ///< L: links x solid dofs; null without unknowns
  RCP<const CrsMatrix> squares;    ///< entries squared, for the diagonal
  std::vector<LinkRow<dim>> ends;  ///< dofs and weights emptied once assembled
  SpinCouples<dim> couples;

  /// Velocities of the ends [m/s] for solid velocities V (null: none), prescribed velocities in or
  /// out.
  RCP<Vector> end_velocity(const RCP<const Vector>& solid, bool prescribed) const {
    const auto result = rcp(new Vector(map));
    if (!rows.is_null() && !solid.is_null())
      rows->apply(*solid, *result);
    if (prescribed) {
      const auto values = result->getDataNonConst();
      for (std::size_t l = 0; l < list.size(); ++l)
        values[l] += ends[l].prescribed;
    }
    return result;
  }
  /// Pulls of the bonds [N] for fluid velocities u.
  RCP<Vector> pull(const Vector& u, const Vector& end_velocity) const {
    const auto result = rcp(new Vector(map));
    const auto values = result->getDataNonConst();
    const auto velocity = u.getData(), end = end_velocity.getData();
    for (std::size_t l = 0; l < list.size(); ++l)
      values[l] = list[l].coefficient * (velocity[list[l].row] - end[l]);
    return result;
  }
  /// The couples as forces on the solids [N]. Collective.
  RCP<Vector> couple_pull(const Vector& end_velocity) const {
    const auto result = rcp(new Vector(map));
    couples.add_pull(end_velocity.getData().getRawPtr(), result->getDataNonConst().getRawPtr());
    return result;
  }
};

template <int dim>
Links<dim> make_links(const ViscousSystem<dim>& system, const SolidSystem<dim>& solids,
                      const ViscousCoupling<dim>& coupling) {
  std::vector<LinkRow<dim>> ends(system.links.size());
  for (std::size_t l = 0; l < system.links.size(); ++l)
    coupling.link_row(system.links[l], solids, ends[l]);
  SpinCouples<dim> couples(system.links, ends, solids.solids(), solids.comm());
  Links<dim> links{system.links,    make_map(static_cast<int>(system.links.size()), solids.comm()),
                   Teuchos::null,   Teuchos::null,
                   std::move(ends), std::move(couples)};
  std::vector<Triplet> rows, squares;
  for (std::size_t l = 0; l < system.links.size(); ++l) {
    auto& end = links.ends[l];
    const GlobalIndex id = links.map->getGlobalElement(static_cast<int>(l));
    for (std::size_t i = 0; i < end.dofs.size(); ++i) {
      rows.push_back({id, end.dofs[i], end.weights[i]});
      squares.push_back({id, end.dofs[i], end.weights[i] * end.weights[i]});
    }
    end.dofs.clear();
    end.weights.clear();
  }
  if (solids.has_unknowns()) {
    links.rows = assemble_triplets(std::move(rows), links.map, solids.map());
    links.squares = assemble_triplets(std::move(squares), links.map, solids.map());
  }
  return links;
}

template <int dim>
struct ViscousOperator {
  const ViscousSystem<dim>& system;
  const Links<dim>& links;
  const RCP<const LinearOperator>& solid_block;
  const Reduction& constraints;
  double dt;

  /// P y, without a copy where it is y.
  RCP<const Vector> expanded(const RCP<const Vector>& unknowns) const {
    if (!constraints.has_combinations())
      return unknowns;
    const auto velocity = rcp(new Vector(*unknowns, Teuchos::Copy));
    constraints.expand_change(*velocity);
    return velocity;
  }
  /// y = operator x; rows of dofs that are no unknowns see only their own C, and are zero. K_ff
  /// holds the links' diagonal already.
  void apply_to(const Pair& x, Pair& y) const {
    y.fluid->elementWiseMultiply(1, *system.mass, *x.fluid, 0);
    system.stiffness->apply(*x.fluid, *y.fluid, Teuchos::NO_TRANS, dt, 1);
    if (x.solid.is_null())
      return;
    const RCP<const Vector> end_velocity = links.end_velocity(expanded(x.solid), false);
    {
      const auto values = end_velocity->getData();
      const auto result = y.fluid->getDataNonConst();
      for (std::size_t l = 0; l < links.list.size(); ++l) {
        result[links.list[l].row] -= dt * links.list[l].coefficient * values[l];
      }
    }
    Vector drag(x.solid->getMap());
    const RCP<Vector> pull = links.pull(*x.fluid, *end_velocity);
    links.couples.add_pull(end_velocity->getData().getRawPtr(),
                           pull->getDataNonConst().getRawPtr());
    links.rows->apply(*pull, drag, Teuchos::TRANS, -dt, 0);
    lockstep::apply(*solid_block, *x.solid, *y.solid);
    constraints.restrict(drag);
    y.solid->update(1, drag, 1);
  }
};

/// 1 / diagonal of the viscous operator (ones for a matrix-free C: few outliers, CG deals with
/// them).
template <int dim>
Pair inverse_diagonal(const ViscousOperator<dim>& op, const Pair& shape) {
  Pair inverse = shape.same_shape();
  Vector diagonal(op.system.map);
  op.system.stiffness->getLocalDiagCopy(diagonal);
  diagonal.update(1, *op.system.mass, op.dt);
  inverse.fluid->reciprocal(diagonal);
  if (inverse.solid.is_null())
    return inverse;
  inverse.solid->putScalar(1);
  const RCP<const CrsMatrix> matrix = assembled(op.solid_block);
  if (!matrix.is_null()) {
    Vector solid(inverse.solid->getMap()), drag(inverse.solid->getMap()), strength(op.links.map);
    for (std::size_t l = 0; l < op.links.list.size(); ++l) {
      strength.replaceLocalValue(static_cast<int>(l), op.links.list[l].coefficient);
    }
    op.links.squares->apply(strength, drag, Teuchos::TRANS);
    matrix->getLocalDiagCopy(solid);
    op.constraints.select(drag);
    solid.update(op.dt, drag, 1);
    inverse.solid->reciprocal(solid);
  }
  return inverse;
}

struct Preconditioner {
  Pair inverse_diagonal;
  RCP<const LinearOperator> stiff;  ///< an inverse of a stiff C; null: the diagonal will do

  Pair operator()(const Pair& residual) const {
    Pair result = residual.scaled_by(inverse_diagonal);
    if (!stiff.is_null())
      lockstep::apply(*stiff, *residual.solid, *result.solid);
    return result;
  }
};

template <int dim>
int conjugate_gradients(const ViscousOperator<dim>& op, const Preconditioner& precondition,
                        const Pair& rhs, Pair& x, double tolerance) {
  const int most = 2000;
  Pair residual = rhs.same_shape(), direction, image = rhs.same_shape();
  op.apply_to(x, residual);
  residual.update(1, rhs, -1);
  const double scale = std::sqrt(rhs.dot(precondition(rhs)));
  if (scale == 0)
    return 0;
  Pair z = precondition(residual);
  double rz = residual.dot(z);
  direction = z;
  direction.fluid = rcp(new Vector(*z.fluid, Teuchos::Copy));
  if (!z.solid.is_null())
    direction.solid = rcp(new Vector(*z.solid, Teuchos::Copy));
  for (int iteration = 0; iteration < most; ++iteration) {
    if (std::sqrt(rz) <= tolerance * scale)
      return iteration;
    op.apply_to(direction, image);
    const double step = rz / direction.dot(image);
    x.update(step, direction, 1);
    residual.update(-step, image, 1);
    z = precondition(residual);
    const double next = residual.dot(z);
    direction.update(1, z, next / rz);
    rz = next;
  }
  check_solve(
      false,
      "The viscous solve did not converge: {} CG iterations reached a relative residual of {:.2e}, "
      "asked was {:.1e}. Reduce the time step or the viscosity.",
      most, std::sqrt(rz) / scale, tolerance);
  return most;
}

/// The couple of links whose two ends lie apart across their direction, with that of the transposed
/// gradient, which cancels it and that of the fluid's own bonds; and what each prescribed solid
/// gives the fluid through its links. This rank's part.
template <int dim>
Momentum<dim> link_impulse(const Links<dim>& links, const Vector& pull, const Vector& couple_pull,
                           double dt, std::vector<Momentum<dim>>& of_prescribed) {
  Momentum<dim> couple;
  const auto values = pull.getData(), couples = couple_pull.getData();
  for (std::size_t l = 0; l < links.list.size(); ++l) {
    const auto& link = links.list[l];
    const auto& end = links.ends[l];
    const Point<dim> axis = Point<dim>::Unit(link.direction);
    if (end.prescribed_share > 0)
      of_prescribed[end.prescribed_solid].add(
          end.position, -dt * end.prescribed_share * (values[l] + couples[l]) * axis);
    couple.angular += cross<dim>(link.position - end.position, -dt * values[l] * axis);
    couple.add(end.position, dt * couples[l] * axis);
  }
  return couple;
}

}  // namespace

template <int dim>
ViscousResult<dim> solve_viscous(const ViscousSystem<dim>& system, ViscousFluid<dim>& fluid,
                                 const SolidSystem<dim>& solids,
                                 const ViscousCoupling<dim>& coupling,
                                 const RCP<const LinearOperator>& solid_block,
                                 const NearNullSpace& near_null_space,
                                 const RCP<const Vector>& lumped_momentum, double dt,
                                 const Reduction& constraints, double tolerance) {
  const Links<dim> links = make_links<dim>(system, solids, coupling);
  const ViscousOperator<dim> op{system, links, solid_block, constraints, dt};

  // The pull of prescribed solids and given dofs on resting fluid, on the right-hand side.
  const RCP<const Vector> given = links.end_velocity(constraints.offset(), true);
  const RCP<Vector> prescribed = links.pull(*rcp(new Vector(system.map)), *given);
  Pair rhs{rcp(new Vector(system.map)), RCP<Vector>()};
  rhs.fluid->elementWiseMultiply(1, *system.mass, *system.velocity, 0);
  rhs.fluid->update(dt, *system.wall_force, 1);
  {
    const auto values = prescribed->getData();
    const auto result = rhs.fluid->getDataNonConst();
    for (std::size_t l = 0; l < links.list.size(); ++l)
      result[links.list[l].row] -= dt * values[l];
  }
  Pair x{rcp(new Vector(*system.velocity, Teuchos::Copy)), RCP<Vector>()};
  if (solids.has_unknowns()) {
    rhs.solid = rcp(new Vector(*lumped_momentum, Teuchos::Copy));
    prescribed->update(1, *links.couple_pull(*given), 1);
    links.rows->apply(*prescribed, *rhs.solid, Teuchos::TRANS, dt, 1);
    constraints.restrict(*rhs.solid);
    x.solid = solids.velocity();
    constraints.select(*x.solid);
  }
  ViscousResult<dim> result;
  Preconditioner precondition{inverse_diagonal<dim>(op, rhs), Teuchos::null};
  if (solids.has_unknowns())
    precondition.stiff = inverse_if_stiff(solid_block, near_null_space, "solids, viscous solve");
  result.iterations = conjugate_gradients<dim>(op, precondition, rhs, x, tolerance);

  if (solids.has_unknowns()) {
    result.solid_velocity = rcp(new Vector(*x.solid, Teuchos::Copy));
    constraints.expand(*result.solid_velocity);
  }
  const RCP<const Vector> ends = links.end_velocity(result.solid_velocity, true);
  const RCP<const Vector> pull = links.pull(*x.fluid, *ends);
  const RCP<const Vector> couple_pull = links.couple_pull(*ends);
  if (solids.has_unknowns()) {
    result.solid_impulse = rcp(new Vector(solids.map()));
    links.rows->apply(*pull, *result.solid_impulse, Teuchos::TRANS, dt, 0);
    links.rows->apply(*couple_pull, *result.solid_impulse, Teuchos::TRANS, dt, 1);
  }
  // u = u* + M^-1 (impulses of the solution): momentum is exact, the residual of CG shows in u
  // alone.
  Pair residual = rhs.same_shape();
  op.apply_to(x, residual);
  residual.update(1, rhs, -1);
  Vector velocity(*x.fluid, Teuchos::Copy), mass_inverse(system.map);
  mass_inverse.reciprocal(*system.mass);
  velocity.elementWiseMultiply(1, mass_inverse, *residual.fluid, 1);
  result.boundary_impulse = fluid.accept_viscous(*x.fluid, velocity, dt);
  std::vector<Momentum<dim>> impulses(solids.solids().size());
  impulses.push_back(link_impulse<dim>(links, *pull, *couple_pull, dt, impulses));
  sum_over_ranks(impulses, solids.comm());
  result.boundary_impulse += total_of(impulses);
  impulses.pop_back();
  result.prescribed_impulses = std::move(impulses);
  return result;
}

template ViscousResult<2> solve_viscous<2>(const ViscousSystem<2>&, ViscousFluid<2>&,
                                           const SolidSystem<2>&, const ViscousCoupling<2>&,
                                           const RCP<const LinearOperator>&, const NearNullSpace&,
                                           const RCP<const Vector>&, double, const Reduction&,
                                           double);
template ViscousResult<3> solve_viscous<3>(const ViscousSystem<3>&, ViscousFluid<3>&,
                                           const SolidSystem<3>&, const ViscousCoupling<3>&,
                                           const RCP<const LinearOperator>&, const NearNullSpace&,
                                           const RCP<const Vector>&, double, const Reduction&,
                                           double);

}  // namespace lockstep
