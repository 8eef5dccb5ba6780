#include "observers/carried_points.hpp"

#include <Tpetra_Vector.hpp>
#include <limits>

#include "base/errors.hpp"
#include "geometry/simplex_queries.hpp"
#include "interfaces/solid_sides.hpp"
#include "output/checkpoint.hpp"

namespace lockstep {

namespace {

template <int dim>
std::array<Point<dim>, dim> corners_of(const SurfaceMesh<dim>& surface, int simplex) {
  std::array<Point<dim>, dim> corners;
  for (int k = 0; k < dim; ++k)
    corners[k] = surface.vertices[surface.simplices[simplex][k]];
  return corners;
}

/// Axes that turn with a simplex, one a column, at right angles to each other.
Eigen::Matrix2d axes_of(const std::array<Point<2>, 2>& corners) {
  const Point<2> along = (corners[1] - corners[0]).normalized();
  Eigen::Matrix2d axes;
  axes << along, Point<2>(-along.y(), along.x());
  return axes;
}
Eigen::Matrix3d axes_of(const std::array<Point<3>, 3>& corners) {
  const Point<3> along = (corners[1] - corners[0]).normalized();
  const Point<3> normal = along.cross(Point<3>(corners[2] - corners[0])).normalized();
  Eigen::Matrix3d axes;
  axes << along, normal.cross(along), normal;
  return axes;
}

template <int dim>
Point<dim> point_of(const std::array<Point<dim>, dim>& corners,
                    const Barycentric<dim>& barycentric) {
  Point<dim> x = Point<dim>::Zero();
  for (int k = 0; k < dim; ++k)
    x += barycentric[k] * corners[k];
  return x;
}

/// Velocity of a surface point of a solid that is not prescribed. Collective.
template <int dim>
Point<dim> velocity_of(const SolidModel<dim>& model, const SurfacePoint<dim>& point) {
  VelocityRow<dim> row;
  model.velocity_row(point, point.position, row);
  const RCP<const Vector> velocity = model.velocity();
  const auto values = velocity->getData();
  Point<dim> sum = Point<dim>::Zero();
  for (std::size_t k = 0; k < row.dofs.size(); ++k)
    if (const int local = velocity->getMap()->getLocalElement(row.dofs[k]); local >= 0)
      sum += values[local] * row.coefficients[k];
  sum_all(velocity->getMap()->getComm(), sum.data(), dim);
  return sum;
}

constexpr const char* stored_holds = "carried points";

}  // namespace

std::string observer_path(const ParameterList& list) {
  const std::string& path = list.name();
  const std::size_t last = path.rfind("->");
  return "Observers/" + (last == std::string::npos ? path : path.substr(last + 2));
}

template <int dim>
CarriedPoints<dim>::CarriedPoints(std::string observer, std::string solid,
                                  std::vector<Point<dim>> at_start, double farthest)
    : observer_(std::move(observer)),
      solid_(std::move(solid)),
      at_start_(std::move(at_start)),
      farthest_(farthest) {}

template <int dim>
ObservedSolid<dim> CarriedPoints<dim>::find_carrier(const RunView<dim>& run) const {
  const ObservedSolid<dim> carrier = observed_solid(run, solid_, observer_);
  check_input(carrier.solid->simplex_end > carrier.solid->simplex_begin ||
                  (carrier.solid->rigid && carrier.model->jointable()),
              "\"{}\" follows the solid \"{}\", which has no surface; name a body or a shell.",
              observer_, solid_);
  return carrier;
}

template <int dim>
void CarriedPoints<dim>::attach(const RunView<dim>& run, const ObservedSolid<dim>& carrier) {
  const SolidModel<dim>* model = carrier.model;
  const SolidDescription* solid = carrier.solid;
  const double most = farthest_ * run.fluid.smallest_length();
  for (const Point<dim>& x : at_start_) {
    Hold hold;
    if (solid->rigid && model->jointable()) {
      const RigidFrame<dim> frame = model->jointable()->rigid_frame(carrier.number);
      hold.offset = frame.orientation.inverse() * (x - frame.position);
      holds_.push_back(hold);
      continue;
    }
    double distance = std::numeric_limits<double>::infinity();
    for (int s = solid->simplex_begin; s < solid->simplex_end; ++s) {
      const auto corners = corners_of<dim>(model->surface(), s);
      const ClosestOnSimplex<dim> closest = closest_on_simplex<dim>(corners, x);
      if (closest.distance >= distance)
        continue;
      distance = closest.distance;
      hold = {s, closest.barycentric, axes_of(corners).transpose() * (x - closest.position)};
    }
    check_input(
        distance <= most,
        "\"{}\" asks for the point {:.6g}, which is {:.3g} m from the surface of \"{}\"; of "
        "a solid that is not rigid a point must be within {:.3g} m of it.",
        observer_, fmt::join(x.data(), x.data() + dim, ", "), distance, solid_, most);
    holds_.push_back(hold);
  }
}

template <int dim>
CarriedPoint<dim> CarriedPoints<dim>::of_rigid(const ObservedSolid<dim>& carrier,
                                               const Hold& hold) const {
  const RigidFrame<dim> frame = carrier.model->jointable()->rigid_frame(carrier.number);
  const Point<dim> arm = frame.orientation * hold.offset;
  const AngularVector<dim> turning = frame.velocity.template tail<n_rotations<dim>>();
  return {frame.position + arm, frame.velocity.template head<dim>() + rotate<dim>(turning, arm)};
}

template <int dim>
CarriedPoint<dim> CarriedPoints<dim>::of_surface(const ObservedSolid<dim>& carrier,
                                                 const Hold& hold) const {
  const auto corners = corners_of<dim>(carrier.model->surface(), hold.simplex);
  SurfacePoint<dim> point;
  point.simplex = hold.simplex;
  point.barycentric = hold.barycentric;
  point.position = point_of<dim>(corners, hold.barycentric);
  return {point.position + axes_of(corners) * hold.offset,
          carrier.solid->prescribed ? carrier.model->prescribed_velocity(point, point.position)
                                    : velocity_of(*carrier.model, point)};
}

template <int dim>
std::vector<CarriedPoint<dim>> CarriedPoints<dim>::look(const RunView<dim>& run) {
  const ObservedSolid<dim> carrier = find_carrier(run);
  if (holds_.empty())
    attach(run, carrier);
  std::vector<CarriedPoint<dim>> points;
  for (const Hold& hold : holds_)
    points.push_back(hold.simplex < 0 ? of_rigid(carrier, hold) : of_surface(carrier, hold));
  return points;
}

template <int dim>
void CarriedPoints<dim>::save(CheckpointWriter& writer) const {
  std::vector<double> values;
  for (std::size_t p = 0; p < holds_.size(); ++p) {
    values.push_back(holds_[p].simplex);
    values.insert(values.end(), holds_[p].barycentric.data(), holds_[p].barycentric.data() + dim);
    values.insert(values.end(), holds_[p].offset.data(), holds_[p].offset.data() + dim);
  }
  writer.file().write_replicated(stored_holds, values, 2 * dim + 1);
}

template <int dim>
void CarriedPoints<dim>::load(const CheckpointReader& reader) {
  const auto values = reader.file().template read_all<double>(stored_holds);
  constexpr int n = 2 * dim + 1;
  reader.check(values.empty() || values.size() == n * at_start_.size(),
               "it has other points of \"" + observer_ + "\"");
  holds_.assign(values.size() / n, {});
  for (std::size_t p = 0; p < holds_.size(); ++p) {
    const double* const own = values.data() + n * p;
    holds_[p] = {static_cast<int>(own[0]), Eigen::Map<const Barycentric<dim>>(own + 1),
                 Eigen::Map<const Point<dim>>(own + 1 + dim)};
  }
}

template class CarriedPoints<2>;
template class CarriedPoints<3>;

}  // namespace lockstep
