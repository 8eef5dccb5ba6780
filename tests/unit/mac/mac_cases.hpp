#pragma once
#include <Tpetra_Vector.hpp>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "geometry/generators.hpp"
#include "mac/mac_fluid.hpp"
#include "parameters/validate.hpp"
#include "staggered/domain/parameter_values.hpp"
#include "support/world.hpp"

namespace lockstep::test {

/// Formulas in place of the numbers of a vector.
inline ParameterArray<std::string> formulas(std::initializer_list<std::string> values) {
  return std::vector<std::string>(values);
}
inline ParameterArray<double> numbers(std::initializer_list<double> values) {
  return ParameterArray<double>(values.begin(), values.end());
}

/// Index with the same number of cells along every axis.
template <int dim>
Index<dim> cube(int n) {
  Index<dim> cells;
  cells.fill(n);
  return cells;
}

/// The voxel rule: a face is closed where the surface blocks it.
template <int dim>
struct BlockedFaces : OpenFractionRule<dim> {
  double open_fraction(const ControlVolume<dim>&, bool occluded,
                       const SurfaceSnapshot<dim>&) const override {
    return occluded ? 0 : 1;
  }
};

/// Lists of a small scene, to be changed before `make`.
template <int dim>
struct Case {
  ParameterList fluid{"Fluid"}, domain{"Domain"};

  Case(const Index<dim>& cells, double spacing) {
    ParameterArray<double> lower(dim, 0.0), upper(dim, 0.0);
    for (int a = 0; a < dim; ++a)
      upper[a] = cells[a] * spacing;
    domain.set("Lower", lower);
    domain.set("Upper", upper);
    domain.set("Cells", ParameterArray<int>(cells.begin(), cells.end()));
    fluid.set("Order in Time", 1);  // parts of a step by themselves know no step before
  }
  Case& side(const std::string& name, const std::string& type,
             const Point<dim>& velocity = Point<dim>::Zero()) {
    ParameterList& list = domain.sublist("Sides").sublist(name);
    list.set("Type", type);
    list.set("Velocity", ParameterArray<double>(velocity.data(), velocity.data() + dim));
    return *this;
  }
  Case& all_periodic() {
    for (const char* const axis : {"x", "y", "z"})
      if (dim == 3 || axis[0] != 'z')
        side(std::string(axis) + " lower", "periodic")
            .side(std::string(axis) + " upper", "periodic");
    return *this;
  }
  std::unique_ptr<MacFluid<dim>> make() {
    validate(fluid, mac_parameters<dim>(), Source{"test", {}}, "Fluid");
    validate(domain, domain_parameters<dim>(), Source{"test", {}}, "Domain");
    return std::make_unique<MacFluid<dim>>(fluid, domain, world());
  }
};

/// One solid after the other, each moved to its place.
template <int dim>
class Solids {
 public:
  Solids& add(const SurfaceMesh<dim>& part, const Point<dim>& center, bool closed) {
    SolidDescription solid;
    solid.closed = closed;
    solid.vertex_begin = static_cast<int>(mesh_.vertices.size());
    solid.simplex_begin = static_cast<int>(mesh_.simplices.size());
    for (const Point<dim>& x : part.vertices)
      mesh_.vertices.push_back(x + center);
    for (auto simplex : part.simplices) {
      for (int& v : simplex)
        v += solid.vertex_begin;
      mesh_.simplices.push_back(simplex);
    }
    solid.vertex_end = static_cast<int>(mesh_.vertices.size());
    solid.simplex_end = static_cast<int>(mesh_.simplices.size());
    solids_.push_back(solid);
    return *this;
  }
  std::shared_ptr<const SurfaceSnapshot<dim>> snapshot() const {
    return std::make_shared<SurfaceSnapshot<dim>>(mesh_, solids_);
  }

 private:
  SurfaceMesh<dim> mesh_;
  std::vector<SolidDescription> solids_;
};

/// f at the centres of the pressure unknowns.
template <int dim>
RCP<Vector> pressure_vector(const MacFluid<dim>& fluid,
                            const std::function<double(const Point<dim>&)>& f) {
  const auto result = make_vector(fluid.pressure_map());
  const auto values = result->getDataNonConst();
  int row = 0;
  fluid.domain().grid.for_each_owned_cell([&](int cell) {
    if (fluid.geometry().state.cells[cell] == CellState::fluid)
      values[row++] = f(fluid.domain().grid.center(cell));
  });
  return result;
}

/// Plain conjugate gradients; of a singular system the solution of mean zero if `b` has mean zero.
template <typename Apply>
int conjugate_gradients(const Apply& multiply, const Vector& b, Vector& x, double tolerance) {
  Vector r(b, Teuchos::Copy), p(b, Teuchos::Copy), q(b.getMap());
  x.putScalar(0);
  double rr = r.dot(r);
  const double goal = tolerance * tolerance * rr;
  int n = 0;
  for (; rr > goal && n < 2000; ++n) {
    multiply(p, q);
    const double step = rr / p.dot(q);
    x.update(step, p, 1);
    r.update(-step, q, 1);
    const double next = r.dot(r);
    p.update(1, r, next / rr);
    rr = next;
  }
  return n;
}

/// A smooth field without symmetry.
template <int dim>
double wavy(const Point<dim>& x) {
  double value = 0.3;
  for (int a = 0; a < dim; ++a)
    value += std::sin((2.1 + a) * x[a] + 0.4 * a) * (1 + 0.5 * x[(a + 1) % dim]);
  return value;
}
template <int dim>
Point<dim> wavy_velocity(const Point<dim>& x) {
  Point<dim> u;
  for (int a = 0; a < dim; ++a)
    u[a] = wavy<dim>(Point<dim>(x * (1 + 0.3 * a) + Point<dim>::Constant(a)));
  return u;
}

}  // namespace lockstep::test
