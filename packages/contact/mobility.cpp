#include "contact/mobility.hpp"

#include <Tpetra_Vector.hpp>
#include <cmath>
#include <set>

namespace lockstep {

namespace {
/// Velocities far from an impulse, over that at its place, that are not worth keeping.
constexpr double negligible = 1e-14;
}  // namespace

template <int dim>
Mobility<dim>::Mobility(const InverseMass& inverse_mass, const SolidSystem<dim>& system,
                        const ContactShapes<dim>& shapes, RCP<const LinearOperator> response)
    : inverse_mass_(inverse_mass),
      system_(&system),
      response_(std::move(response)),
      rows_(inverse_mass.rows.size()) {
  std::set<int> dofs;
  VelocityRow<dim> row;
  for (int i = 0; i < shapes.n_solids(); ++i) {
    const SolidDescription& solid = shapes.solids()[i];
    for (int v = solid.vertex_begin; v < solid.vertex_end && !solid.prescribed; ++v) {
      const SurfacePoint<dim> point = shapes.at_vertex(v);
      if (point.simplex < 0)
        continue;
      shapes.velocity_row(point, point.position, row);
      dofs.insert(row.dofs.begin(), row.dofs.end());
    }
  }
  if (system.joints()) {
    for (const GlobalIndex dof : shapes.leading_dofs())
      dofs.insert(static_cast<int>(dof));
  }
  surface_dofs_.assign(dofs.begin(), dofs.end());
}

template <int dim>
const typename Mobility<dim>::Row& Mobility<dim>::row(int dof) {
  if (response_.is_null() || inverse_mass_.rows[dof].empty())
    return inverse_mass_.rows[dof];
  std::optional<Row>& row = rows_[dof];
  if (row)
    return *row;
  std::vector<double> unit(rows_.size(), 0);
  unit[dof] = 1;
  const RCP<Vector> velocity = make_vector(system_->map());
  apply(*response_, *distributed(*system_, unit), *velocity);
  const std::vector<double> values = replicated(*system_, *velocity);
  row.emplace();
  for (const int k : surface_dofs_) {
    if (std::abs(values[k]) > negligible * values[dof] && !inverse_mass_.rows[k].empty())
      row->push_back({k, values[k]});
  }
  return *row;
}

template class Mobility<2>;
template class Mobility<3>;

}  // namespace lockstep
