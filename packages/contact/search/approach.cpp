#include "contact/search/approach.hpp"

#include <cmath>

#include "contact/bodies/carried_point.hpp"

namespace lockstep {

namespace {

/// A bound on the norm of (v(x) - v(p)) / |x - p| for a point x that a point p of a simplex
/// carries: that of the linear motion, of which `carried_point` takes a part.
template <int dim>
double turn_of(const std::array<Point<dim>, dim>& corners,
               const std::array<Point<dim>, dim>& moves) {
  SurfacePoint<dim> point;
  point.position = corners[0];
  point.barycentric.fill(0);
  point.barycentric[0] = 1;
  double square = 0;
  for (int axis = 0; axis < dim; ++axis) {
    const auto factors = linear_motion<dim>(corners, point, corners[0] + Point<dim>::Unit(axis));
    Point<dim> move = -moves[0];
    for (int i = 0; i < dim; ++i)
      move += factors[i] * moves[i];
    square += move.squaredNorm();
  }
  return std::sqrt(square);
}

}  // namespace

template <int dim>
bool may_close(const PrimitiveMotion<dim>& one, const PrimitiveMotion<dim>& other, double apart,
               double thickness) {
  // The impulse of a contact acts half way between its two points.
  const double turn = 0.5 * (one.turn + other.turn);
  if (turn >= 1)
    return true;
  const double relative = (other.moves.max() - one.moves.min())
                              .cwiseAbs()
                              .cwiseMax((one.moves.max() - other.moves.min()).cwiseAbs())
                              .norm();
  constexpr double certain = 1e-6;
  return !((1 - turn) * apart > (1 + certain) * (thickness + relative));
}

template <int dim>
Approach<dim>::Approach(const ContactShapes<dim>& shapes, const SolidMotion<dim>& motion, int solid,
                        double dt) {
  const SolidDescription& description = shapes.solids()[solid];
  first_vertex_ = description.vertex_begin;
  first_simplex_ = description.simplex_begin;
  for (int v = first_vertex_; v < description.vertex_end; ++v)
    moves_.push_back(dt * motion.of_vertex(solid, v));
  for (int s = first_simplex_; s < description.simplex_end; ++s) {
    std::array<Point<dim>, dim> moves;
    for (int k = 0; k < dim; ++k)
      moves[k] = moves_[shapes.mesh().simplices[s][k] - first_vertex_];
    turns_.push_back(turn_of<dim>(shapes.corners(s), moves));
  }
}

template <int dim>
PrimitiveMotion<dim> Approach<dim>::of(const int* begin, const int* end, int simplex) const {
  PrimitiveMotion<dim> motion;
  for (const int* vertex = begin; vertex != end; ++vertex)
    motion.moves.extend(moves_[*vertex - first_vertex_]);
  motion.turn = turns_[simplex - first_simplex_];
  return motion;
}

template <int dim>
bool Approach<dim>::may_close(const PrimitivePair<dim>& pair, double apart,
                              double thickness) const {
  const int *begin = pair.vertices.data(), *end = begin + pair.vertices.size();
  const int* second = begin + (pair.kind == PrimitiveKind::edge_edge ? 2 : 1);
  return lockstep::may_close(of(begin, second, pair.simplex), of(second, end, pair.other_simplex),
                             apart, thickness);
}

template bool may_close<2>(const PrimitiveMotion<2>&, const PrimitiveMotion<2>&, double, double);
template bool may_close<3>(const PrimitiveMotion<3>&, const PrimitiveMotion<3>&, double, double);
template class Approach<2>;
template class Approach<3>;

}  // namespace lockstep
