#include "stepping/settle.hpp"

#include <Eigen/Eigenvalues>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "stepping/still_water.hpp"

namespace lockstep {

namespace {

using Eigen::VectorXd;

constexpr int most_free = 60;
constexpr double at_rest = 1e-8, good_enough = 1e-4;  // parts of gravity

/// A coordinate of what moves rigidly: a dof of a free body, or the rate of a joint.
struct Coordinate {
  GlobalIndex id = no_index;
  double scale = 1;  ///< way of what goes farthest for a unit of it [m]
};

/// True if nodes of a model move by themselves.
template <int dim>
bool is_soft(const SolidModel<dim>& model) {
  const auto& solids = model.solids();
  return std::any_of(solids.begin(), solids.end(), [](const SolidDescription& solid) {
    return !solid.rigid && !solid.prescribed;
  });
}

template <int dim>
bool has_soft(const SolidSystem<dim>& solids) {
  for (int m = 0; m < solids.n_models(); ++m)
    if (is_soft(solids.model(m)))
      return true;
  return false;
}

/// The way [m] that a unit of each dof moves a body of this radius, or a node; zero for rates of
/// joints, which move nothing by themselves. Local.
template <int dim>
RCP<Vector> lengths_of_dofs(const SolidSystem<dim>& solids, double radius) {
  constexpr int n_coordinates = dim + n_rotations<dim>;
  const RCP<Vector> lengths = make_vector(solids.map());
  const auto values = lengths->getDataNonConst();
  const std::vector<Block> blocks = solids.blocks();
  for (int m = 0; m < solids.n_models(); ++m)
    for (int row = blocks[m].begin; row < blocks[m].end; ++row) {
      const bool turns = (row - blocks[m].begin) % n_coordinates >= dim;
      if (is_soft(solids.model(m)))
        values[row] = 1;
      else if (solids.model(m).jointable())
        values[row] = turns ? radius : 1;
    }
  return lengths;
}

/// Size of a way [m]. Collective.
double size_of(const Vector& way, const Vector& lengths) {
  Vector sizes(way.getMap());
  sizes.elementWiseMultiply(1, lengths, way, 0);
  return sizes.normInf();
}

/// Collective.
double dot_of_ways(const Vector& one, const Vector& other, const Vector& lengths) {
  Vector sizes(one.getMap());
  sizes.elementWiseMultiply(1, lengths, one, 0);
  sizes.elementWiseMultiply(1, lengths, sizes, 0);
  return sizes.dot(other);
}

/// The coordinates of all ranks. Collective.
template <int dim>
std::vector<Coordinate> coordinates_of(const SolidSystem<dim>& solids, const Vector& lengths) {
  const std::vector<Block> blocks = solids.blocks();
  const RCP<const Vector> unknowns = solids.reduction().unknowns();
  std::vector<GlobalIndex> ids;
  for (int m = 0; m < solids.n_models(); ++m)
    for (int row = blocks[m].begin; row < blocks[m].end && !is_soft(solids.model(m)); ++row)
      if (unknowns.is_null() || unknowns->getData()[row] != 0)
        ids.push_back(solids.map()->getGlobalElement(row));
  std::vector<Coordinate> coordinates;
  for (const GlobalIndex id : gather_all(solids.comm(), ids)) {
    Vector motion(solids.map());
    if (solids.map()->isNodeGlobalElement(id))
      motion.replaceGlobalValue(id, 1);
    solids.reduction().expand_change(motion);
    const double scale = size_of(motion, lengths);
    coordinates.push_back({id, scale > 0 ? scale : 1});
  }
  return coordinates;
}

/// Values of coordinates, as dofs. Local.
RCP<Vector> as_dofs(const std::vector<Coordinate>& coordinates, const VectorXd& values,
                    const RCP<const Map>& map) {
  const RCP<Vector> dofs = make_vector(map);
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (map->isNodeGlobalElement(coordinates[i].id))
      dofs->replaceGlobalValue(coordinates[i].id, values[static_cast<Eigen::Index>(i)]);
  return dofs;
}

/// The dofs of coordinates. Collective.
VectorXd values_of(const std::vector<Coordinate>& coordinates, const Vector& dofs,
                   const Communicator& comm) {
  std::vector<double> values(coordinates.size(), 0.0);
  for (std::size_t i = 0; i < coordinates.size(); ++i)
    if (const int row = dofs.getMap()->getLocalElement(coordinates[i].id); row >= 0)
      values[i] = dofs.getData()[row];
  sum_over_ranks(comm, values);
  return Eigen::Map<const VectorXd>(values.data(), values.size());
}

/// Newton's step where all comes back, but along the acceleration where something falls: each
/// eigenvector of the derivative by the size of its eigenvalue. Nothing along what meets no force.
/// What is held by less than a twentieth of the firmest may be held by errors of the grid alone,
/// which come again with every cell. There the next place of rest lies within one, and a whole step
/// would go past many of them to the side of the tank: it takes a quarter of a cell.
VectorXd step_down(const Eigen::MatrixXd& derivative, const VectorXd& acceleration,
                   const VectorXd& scale, double cell) {
  constexpr double none = 1e-6, weak = 0.05;
  const Eigen::EigenSolver<Eigen::MatrixXd> modes(derivative);
  const Eigen::MatrixXcd vectors = modes.eigenvectors();
  Eigen::VectorXcd parts = vectors.fullPivLu().solve(acceleration.cast<std::complex<double>>());
  const double largest = modes.eigenvalues().cwiseAbs().maxCoeff();
  for (int i = 0; i < parts.size(); ++i) {
    const double size = std::abs(modes.eigenvalues()[i]);
    parts[i] = size > none * largest ? parts[i] / size : 0;
    const double length =
        std::abs(parts[i]) * vectors.col(i).cwiseAbs().cwiseProduct(scale).maxCoeff();
    if (size < weak * largest && length > 0.25 * cell)
      parts[i] *= 0.25 * cell / length;
  }
  return (vectors * parts).real();
}

/// Half the length of the edge of a cube of the largest body's volume; at least five cells.
template <int dim>
double radius_of_bodies(const Components<dim>& components) {
  double largest = 0;
  for (const SolidState<dim>& state : components.solids->states())
    if (state.mass > 0)
      largest = std::max(largest, state.volume);
  return std::max(0.5 * std::pow(largest, 1. / dim), 5 * components.fluid->smallest_length());
}

/// The ways to a place of rest, and how far from rest it is.
struct Found {
  Ways ways;
  double least = 1e300;  ///< largest acceleration there [parts of gravity]
  int n_tries = 0;
};

/// Newton's method on the accelerations of what moves rigidly.
template <int dim>
class RestOfBodies {
 public:
  RestOfBodies(const StillWater<dim>& water, const Components<dim>& components, double radius,
               std::vector<Coordinate> coordinates)
      : water_(water),
        coordinates_(std::move(coordinates)),
        scale_(coordinates_.size()),
        gravity_(components.fluid->gravity().norm()),
        cell_(components.fluid->smallest_length()),
        radius_(radius) {
    for (std::size_t i = 0; i < coordinates_.size(); ++i)
      scale_[static_cast<Eigen::Index>(i)] = coordinates_[i].scale;
  }

  /// Collective.
  Found find() const {
    constexpr int most_tries = 100, most_vain = 8;
    Found found;
    Ways ways;
    VectorXd here = acceleration(ways, {});
    Eigen::MatrixXd derivative;
    for (int n_vain = 0; found.n_tries < most_tries && n_vain < most_vain; ++found.n_tries) {
      const double now = here.cwiseProduct(scale_).cwiseAbs().maxCoeff() / gravity_;
      n_vain = now < found.least ? 0 : n_vain + 1;
      if (now < found.least) {
        found.least = now;
        found.ways = ways;
      }
      if (now < at_rest)
        break;
      if (derivative.size() == 0)
        derivative = derivative_at(ways, here);
      VectorXd step = step_down(derivative, here, scale_, cell_);
      const double length = step.cwiseProduct(scale_).cwiseAbs().maxCoeff(), most = 0.25 * radius_;
      step *= std::min(1., most / length);
      const VectorXd next = acceleration(ways, step, &ways);
      const bool is_good = length < most && next.cwiseProduct(scale_).norm() <
                                                0.2 * here.cwiseProduct(scale_).norm();
      if (!is_good)
        derivative.resize(0, 0);
      here = next;
    }
    return found;
  }

 private:
  /// Accelerations from rest, one a coordinate [m/s^2, rad/s^2], a step (empty: none) behind ways.
  /// `longer`: gets the way of the step.
  VectorXd acceleration(const Ways& ways, const VectorXd& step, Ways* longer = nullptr) const {
    Components<dim> components = water_.with(ways);
    SolidSystem<dim>& solids = *components.solids;
    if (step.size() > 0) {
      const RCP<const Vector> way =
          water_.way_of(*as_dofs(coordinates_, step, solids.map()), solids);
      water_.displace(*way, solids);
      if (longer)
        longer->push_back(way);
    }
    return values_of(coordinates_, *water_.acceleration(components), solids.comm());
  }

  /// Differences of the accelerations by each coordinate. Collective.
  Eigen::MatrixXd derivative_at(const Ways& ways, const VectorXd& here) const {
    const Eigen::Index n = here.size();
    Eigen::MatrixXd result(n, n);
    for (Eigen::Index j = 0; j < n; ++j) {
      const double difference = 1e-3 * cell_ / scale_[j];
      result.col(j) = (acceleration(ways, difference * VectorXd::Unit(n, j)) - here) / difference;
    }
    return result;
  }

  const StillWater<dim>& water_;
  std::vector<Coordinate> coordinates_;
  VectorXd scale_;  ///< [m]
  double gravity_, cell_, radius_;
};

/// Goes down in energy with all solids at once. Each way is that of a step from rest, longer and
/// longer ones. Where forces are not implicit, as those of water are not, too long a step goes too
/// far: the next way goes back, and steps get shorter. Collective.
template <int dim>
Found relax(const StillWater<dim>& water, const Components<dim>& components,
            const Vector& lengths) {
  constexpr int most_tries = 600;
  const double gravity = components.fluid->gravity().norm();
  const double cell = components.fluid->smallest_length();
  const double usual = std::sqrt(cell / gravity), most = 0.5 * cell;
  double dt = usual;
  Found found;
  for (; found.n_tries < most_tries; ++found.n_tries) {
    Components<dim> here = water.with(found.ways);
    const RCP<Vector> way = water.way_down(here, dt);
    const double length = size_of(*way, lengths);
    const bool goes_back =
        !found.ways.empty() && dot_of_ways(*way, *found.ways.back(), lengths) < 0;
    if (length > most)
      way->scale(most / length);
    found.ways.push_back(way);
    if (length < at_rest * cell)
      break;
    dt =
        goes_back || length > most ? std::max(dt / 2, usual / 16) : std::min(1.5 * dt, 100 * usual);
  }
  Components<dim> there = water.with(found.ways);
  found.least = size_of(*water.acceleration(there), lengths) / gravity;
  return found;
}

template <int dim>
void check_can_settle(const Components<dim>& components, std::size_t n_free) {
  check_input(components.fluid->gravity().norm() > 0,
              "\"Time/Settle\" brings bodies to rest in water, but there is no gravity; leave it "
              "out, or give \"Fluid\" its \"Gravity\".");
  check_input(n_free <= most_free || has_soft(*components.solids),
              "\"Time/Settle\" has to try all {} coordinates of the free bodies and joints, more "
              "than {}; leave it out.",
              n_free, most_free);
}

/// Tells where the bodies went.
template <int dim>
void report(const std::vector<SolidState<dim>>& before, const std::vector<SolidState<dim>>& after,
            int n_tries, const Log& log) {
  for (std::size_t i = 0; i < after.size(); ++i)
    if (after[i].mass > 0) {
      const Point<dim> way = after[i].center_of_mass - before[i].center_of_mass;
      log.normal("Settle: \"{}\" rests ({}) m from where the scene has it, after {} tries.",
                 after[i].name, fmt::format("{:.4g}", fmt::join(way.begin(), way.end(), ", ")),
                 n_tries);
    }
}

}  // namespace

template <int dim>
void settle(const std::function<Components<dim>(const ParameterList&)>& build,
            const ParameterList& scene, const SceneOptions& options, Components<dim>& components,
            const Log& log) {
  SolidSystem<dim>& solids = *components.solids;
  const double radius = radius_of_bodies(components);
  const RCP<const Vector> lengths = lengths_of_dofs(solids, radius);
  const std::vector<Coordinate> coordinates = coordinates_of(solids, *lengths);
  check_can_settle(components, coordinates.size());
  if (!solids.has_unknowns())
    return;
  const StillWater<dim> water(build, scene, options);
  const Found found = has_soft(solids)
                          ? relax(water, components, *lengths)
                          : RestOfBodies<dim>(water, components, radius, coordinates).find();
  check_solve(found.least < good_enough,
              "\"Time/Settle\" finds no rest: after {} tries a body still sets out with {:.3g} "
              "times gravity. Begin nearer to rest, {}or leave it out.",
              found.n_tries, found.least,
              has_soft(solids) ? "take the coupling \"flux\", under which forces on soft solids "
                                 "jump less between cells, "
                               : "");
  if (found.least > at_rest)
    log.warning("Settle: after {} tries bodies still set out with {:.2g} times gravity.",
                found.n_tries, found.least);
  const std::vector<SolidState<dim>> before = solids.states();
  const RCP<const Vector> velocity = solids.velocity();
  for (const RCP<const Vector>& way : found.ways)
    water.displace(*way, solids);
  solids.set_velocity(*velocity);  // the momenta of turned bodies follow
  report(before, solids.states(), found.n_tries, log);
}

template void settle<2>(const std::function<Components<2>(const ParameterList&)>&,
                        const ParameterList&, const SceneOptions&, Components<2>&, const Log&);
template void settle<3>(const std::function<Components<3>(const ParameterList&)>&,
                        const ParameterList&, const SceneOptions&, Components<3>&, const Log&);

}  // namespace lockstep
