#include "conformance/fake_solid.hpp"

#include <Thyra_TpetraThyraWrappers.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Operator.hpp>
#include <Tpetra_Vector.hpp>

#include "linear/triplet_matrix.hpp"
#include "output/checkpoint.hpp"

namespace lockstep {
namespace {

/// A diagonal that no one can take apart.
class MatrixFreeDiagonal : public Tpetra::Operator<double, int, GlobalIndex> {
 public:
  explicit MatrixFreeDiagonal(const RCP<const Vector>& entries) : entries_(entries) {}
  RCP<const Map> getDomainMap() const override { return entries_->getMap(); }
  RCP<const Map> getRangeMap() const override { return entries_->getMap(); }
  bool hasTransposeApply() const override { return true; }
  void apply(const MultiVector& x, MultiVector& y, Teuchos::ETransp, double alpha,
             double beta) const override {
    y.elementWiseMultiply(alpha, *entries_, x, beta);
  }

 private:
  RCP<const Vector> entries_;
};

}  // namespace

template <int dim>
FakeSolid<dim>::FakeSolid(std::vector<FakeBody<dim>> bodies, const FakeSolidOptions<dim>& options,
                          const Communicator& comm)
    : bodies_(std::move(bodies)), options_(options), comm_(comm) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const FakeBody<dim>& body = bodies_[b];
    SolidDescription solid;
    solid.name = body.name;
    solid.closed = body.closed;
    solid.prescribed = body.kind == Kind::prescribed;
    solid.rigid = body.kind != Kind::nodal;
    solid.index_in_model = static_cast<int>(b);
    solid.simplex_begin = static_cast<int>(surface_.simplices.size());
    solid.vertex_begin = static_cast<int>(surface_.vertices.size());
    for (auto simplex : body.surface.simplices) {
      for (int& vertex : simplex)
        vertex += solid.vertex_begin;
      surface_.simplices.push_back(simplex);
    }
    const auto& vertices = body.surface.vertices;
    surface_.vertices.insert(surface_.vertices.end(), vertices.begin(), vertices.end());
    solid.simplex_end = static_cast<int>(surface_.simplices.size());
    solid.vertex_end = static_cast<int>(surface_.vertices.size());
    solids_.push_back(solid);

    first_dof_.push_back(static_cast<int>(masses_.size()));
    if (body.kind == Kind::rigid) {
      masses_.insert(masses_.end(), dim, body.mass);
      masses_.insert(masses_.end(), n_rotations<dim>, body.inertia);
      velocity_.insert(velocity_.end(), body.velocity.data(), body.velocity.data() + dim);
      velocity_.insert(velocity_.end(), body.angular_velocity.data(),
                       body.angular_velocity.data() + n_rotations<dim>);
    } else if (body.kind == Kind::nodal) {
      masses_.insert(masses_.end(), dim * vertices.size(),
                     body.mass / static_cast<double>(vertices.size()));
      for (std::size_t v = 0; v < vertices.size(); ++v)
        velocity_.insert(velocity_.end(), body.velocity.data(), body.velocity.data() + dim);
    }
  }
  last_velocity_.assign(velocity_.size(), 0);
  const int n = static_cast<int>(masses_.size()), rank = comm->getRank(), size = comm->getSize();
  map_ = make_map((rank + 1) * n / size - rank * n / size, comm);
  mass_ = diagonal(masses_);
}

template <int dim>
RCP<const LinearOperator> FakeSolid<dim>::diagonal(const std::vector<double>& entries) const {
  if (options_.matrix_free) {
    const auto mine = make_vector(map_);
    for (GlobalIndex id : map_->getNodeElementList())
      mine->replaceGlobalValue(id, entries[id]);
    const RCP<const Tpetra::Operator<double, int, GlobalIndex>> op =
        rcp(new MatrixFreeDiagonal(mine));
    const auto space = Thyra::createVectorSpace<double, int, GlobalIndex>(map_);
    return Thyra::createConstLinearOp<double, int, GlobalIndex>(op, space, space);
  }
  std::vector<Triplet> triplets;
  for (GlobalIndex id : map_->getNodeElementList())
    triplets.push_back({id, id, entries[id]});
  return as_operator(assemble_triplets(std::move(triplets), map_, map_));
}

template <int dim>
RCP<const LinearOperator> FakeSolid<dim>::implicit_force(double) const {
  if (options_.damping == 0)
    return Teuchos::null;
  return diagonal(std::vector<double>(masses_.size(), -options_.damping));
}

template <int dim>
int FakeSolid<dim>::body_of(int simplex) const {
  int body = 0;
  while (simplex >= solids_[body].simplex_end)
    ++body;
  return body;
}

template <int dim>
void FakeSolid<dim>::velocity_row(const SurfacePoint<dim>& point, const Point<dim>& x,
                                  VelocityRow<dim>& row) const {
  row.clear();
  const int b = body_of(point.simplex);
  const FakeBody<dim>& body = bodies_[b];
  if (body.kind == Kind::rigid) {
    for (int k = 0; k < dim + n_rotations<dim>; ++k)
      row.dofs.push_back(first_dof_[b] + k);
    for (int a = 0; a < dim; ++a)
      row.coefficients.push_back(Point<dim>::Unit(a));
    for (int r = 0; r < n_rotations<dim>; ++r)
      row.coefficients.push_back(rotate<dim>(AngularVector<dim>::Unit(r), x - body.center));
  } else if (body.kind == Kind::nodal) {
    for (int k = 0; k < dim; ++k) {
      const int vertex = surface_.simplices[point.simplex][k] - solids_[b].vertex_begin;
      for (int a = 0; a < dim; ++a) {
        row.dofs.push_back(first_dof_[b] + dim * vertex + a);
        row.coefficients.push_back(point.barycentric[k] * Point<dim>::Unit(a));
      }
    }
  }
}

template <int dim>
Point<dim> FakeSolid<dim>::velocity_at(const std::vector<double>& dofs,
                                       const SurfacePoint<dim>& point, const Point<dim>& x) const {
  const FakeBody<dim>& body = bodies_[body_of(point.simplex)];
  if (body.kind == Kind::prescribed)
    return body.velocity + rotate<dim>(body.angular_velocity, x - body.center);
  VelocityRow<dim> row;
  velocity_row(point, x, row);
  Point<dim> velocity = Point<dim>::Zero();
  for (std::size_t k = 0; k < row.dofs.size(); ++k)
    velocity += dofs[row.dofs[k]] * row.coefficients[k];
  return velocity;
}

template <int dim>
Point<dim> FakeSolid<dim>::prescribed_velocity(const SurfacePoint<dim>& point,
                                               const Point<dim>& x) const {
  return velocity_at(std::vector<double>(velocity_.size(), 0), point, x);
}

template <int dim>
Point<dim> FakeSolid<dim>::effective_velocity(const SurfacePoint<dim>& point,
                                              const Point<dim>& x) const {
  return velocity_at(last_velocity_, point, x);
}

template <int dim>
void FakeSolid<dim>::explicit_momentum(double, double dt, Vector& momentum) const {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const int end = b + 1 < bodies_.size() ? first_dof_[b + 1] : static_cast<int>(masses_.size());
    for (int dof = first_dof_[b]; dof < end; ++dof) {
      const int k = dof - first_dof_[b];
      const bool rotation = bodies_[b].kind == Kind::rigid && k >= dim;
      const double gravity = rotation ? 0 : options_.gravity[k % dim];
      if (map_->isNodeGlobalElement(dof))
        momentum.replaceGlobalValue(dof, masses_[dof] * (velocity_[dof] + dt * gravity));
    }
  }
}

template <int dim>
Momentum<dim> FakeSolid<dim>::external_impulse(double, double dt) const {
  Momentum<dim> total;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const FakeBody<dim>& body = bodies_[b];
    if (body.kind == Kind::rigid)
      total.add(body.center, dt * body.mass * options_.gravity);
    for (int v = solids_[b].vertex_begin; body.kind == Kind::nodal && v < solids_[b].vertex_end;
         ++v)
      total.add(surface_.vertices[v], dt * masses_[first_dof_[b]] * options_.gravity);
  }
  return total;
}

template <int dim>
std::vector<GlobalIndex> FakeSolid<dim>::locked_dofs() const {
  std::vector<GlobalIndex> dofs;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    for (int k : bodies_[b].locked) {
      if (map_->isNodeGlobalElement(first_dof_[b] + k))
        dofs.push_back(first_dof_[b] + k);
    }
  }
  return dofs;
}

template <int dim>
std::vector<double> FakeSolid<dim>::everywhere(const Vector& values) const {
  const auto mine = values.getData();
  return gather_all(comm_, std::vector<double>(mine.begin(), mine.end()));
}

template <int dim>
std::vector<Momentum<dim>> FakeSolid<dim>::momentum_of_each(
    const Vector& generalized_momentum) const {
  const std::vector<double> all = everywhere(generalized_momentum);
  std::vector<Momentum<dim>> result(bodies_.size());
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const double* q = all.data() + first_dof_[b];
    if (bodies_[b].kind == Kind::rigid) {
      result[b].add(bodies_[b].center, Eigen::Map<const Point<dim>>(q));
      result[b].angular += Eigen::Map<const AngularVector<dim>>(q + dim);
    } else if (bodies_[b].kind == Kind::nodal) {
      for (int v = solids_[b].vertex_begin; v < solids_[b].vertex_end; ++v, q += dim)
        result[b].add(surface_.vertices[v], Eigen::Map<const Point<dim>>(q));
    }
  }
  return result;
}

template <int dim>
RCP<const Vector> FakeSolid<dim>::velocity() const {
  const auto result = make_vector(map_);
  for (GlobalIndex id : map_->getNodeElementList())
    result->replaceGlobalValue(id, velocity_[id]);
  return result;
}

template <int dim>
void FakeSolid<dim>::set_velocity(const Vector& velocity) {
  velocity_ = everywhere(velocity);
}

template <int dim>
void FakeSolid<dim>::move(const Vector& velocity, double, double dt) {
  last_velocity_ = everywhere(velocity);
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    FakeBody<dim>& body = bodies_[b];
    const double* q = last_velocity_.data() + first_dof_[b];
    Point<dim> linear = body.velocity;
    AngularVector<dim> angular = body.angular_velocity;
    if (body.kind == Kind::rigid) {
      linear = Eigen::Map<const Point<dim>>(q);
      angular = Eigen::Map<const AngularVector<dim>>(q + dim);
    }
    // Small moves only: the turn is taken to first order.
    for (int v = solids_[b].vertex_begin; v < solids_[b].vertex_end; ++v) {
      Point<dim>& x = surface_.vertices[v];
      if (body.kind == Kind::nodal) {
        x += dt * Eigen::Map<const Point<dim>>(q + dim * (v - solids_[b].vertex_begin));
      } else {
        x += dt * (linear + rotate<dim>(angular, x - body.center));
      }
    }
    if (body.kind != Kind::nodal)
      body.center += dt * linear;
  }
}

template <int dim>
std::vector<SolidState<dim>> FakeSolid<dim>::states() const {
  std::vector<SolidState<dim>> all;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    SolidState<dim> state;
    state.name = bodies_[b].name;
    state.center_of_mass = bodies_[b].center;
    state.mass = bodies_[b].kind == Kind::prescribed ? 0 : bodies_[b].mass;
    state.velocity = bodies_[b].velocity;
    if (bodies_[b].kind == Kind::rigid)
      state.velocity = Eigen::Map<const Point<dim>>(velocity_.data() + first_dof_[b]);
    const int end = b + 1 < bodies_.size() ? first_dof_[b + 1] : static_cast<int>(velocity_.size());
    for (int dof = first_dof_[b]; dof < end; ++dof)
      state.kinetic_energy += masses_[dof] * velocity_[dof] * velocity_[dof] / 2;
    all.push_back(state);
  }
  return all;
}

template <int dim>
std::vector<double> FakeSolid<dim>::state() const {
  std::vector<double> values = velocity_;
  values.insert(values.end(), last_velocity_.begin(), last_velocity_.end());
  for (const FakeBody<dim>& body : bodies_)
    values.insert(values.end(), body.center.data(), body.center.data() + dim);
  for (const Point<dim>& x : surface_.vertices)
    values.insert(values.end(), x.data(), x.data() + dim);
  return values;
}

template <int dim>
void FakeSolid<dim>::set_state(const std::vector<double>& values) {
  const double* next = values.data();
  for (std::vector<double>* all : {&velocity_, &last_velocity_}) {
    std::copy_n(next, all->size(), all->begin());
    next += all->size();
  }
  for (FakeBody<dim>& body : bodies_) {
    body.center = Eigen::Map<const Point<dim>>(next);
    next += dim;
  }
  for (Point<dim>& x : surface_.vertices) {
    x = Eigen::Map<const Point<dim>>(next);
    next += dim;
  }
}

template <int dim>
void FakeSolid<dim>::save(CheckpointWriter& checkpoint) const {
  checkpoint.file().create_group("solids");
  checkpoint.file().write_replicated("solids/state", state());
}

template <int dim>
void FakeSolid<dim>::load(const CheckpointReader& checkpoint) {
  set_state(checkpoint.file().template read_all<double>("solids/state"));
}

template class FakeSolid<2>;
template class FakeSolid<3>;

}  // namespace lockstep
