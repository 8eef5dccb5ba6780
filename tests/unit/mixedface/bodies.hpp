#pragma once
#include "geometry/generators.hpp"
#include "support/weights_of.hpp"

namespace lockstep::test {

template <int dim>
FakeBox<dim> unit_tank(int n_cells) {
  FakeBox<dim> box;
  box.n_cells.fill(n_cells);
  box.spacing = 1. / n_cells;
  box.density = 2;
  return box;
}

/// A rigid or nodal ball.
template <int dim>
FakeBody<dim> ball(double radius, const Point<dim>& center,
                   typename FakeBody<dim>::Kind kind = FakeBody<dim>::Kind::rigid) {
  FakeBody<dim> body;
  body.kind = kind;
  body.surface = ball_surface<dim>(radius, dim == 2 ? radius / 4 : radius);
  for (auto& x : body.surface.vertices)
    x += center;
  body.center = center;
  body.mass = 2;
  body.inertia = 0.3;
  return body;
}

/// Sub-cell offsets of a body, away from symmetry.
inline const std::vector<double>& offsets() {
  static const std::vector<double> values = {0, 0.13, 0.27, 0.38, 0.5, 0.64, 0.79, 0.91};
  return values;
}

template <int dim>
Point<dim> shifted_center(int k, double spacing) {
  Point<dim> x;
  for (int a = 0; a < dim; ++a)
    x[a] = 0.5 + spacing * offsets()[(k * (2 * a + 1) + a) % offsets().size()];
  return x;
}

}  // namespace lockstep::test
