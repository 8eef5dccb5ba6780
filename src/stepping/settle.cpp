#include "stepping/settle.hpp"

#include <Eigen/Eigenvalues>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"
#include "stepping/step/time_scheme.hpp"

namespace lockstep {

namespace {

using Eigen::VectorXd;

constexpr int most_free = 60;

/// A coordinate of a free rigid body, by its row in the vectors of all solids.
struct FreeRow {
  GlobalIndex id = no_index;
  bool turns = false;
};

/// The coordinates of all ranks. Collective.
template <int dim>
std::vector<FreeRow> free_rows(const SolidSystem<dim>& solids) {
  constexpr int n_coordinates = dim + n_rotations<dim>;
  const std::vector<Block> blocks = solids.blocks();
  std::vector<GlobalIndex> ids, turns;
  for (int m = 0; m < solids.n_models(); ++m) {
    const SolidModel<dim>& model = solids.model(m);
    if (!model.jointable())
      continue;
    const std::vector<GlobalIndex> locked = model.locked_dofs();
    const auto map = model.dof_map();
    for (int row = 0; row < static_cast<int>(map->getNodeNumElements()); ++row) {
      if (std::find(locked.begin(), locked.end(), map->getGlobalElement(row)) != locked.end())
        continue;
      ids.push_back(solids.map()->getGlobalElement(blocks[m].begin + row));
      turns.push_back(row % n_coordinates >= dim);
    }
  }
  ids = gather_all(solids.comm(), ids);
  turns = gather_all(solids.comm(), turns);
  std::vector<FreeRow> rows;
  for (std::size_t i = 0; i < ids.size(); ++i)
    rows.push_back({ids[i], turns[i] != 0});
  return rows;
}

/// Moves the solids from where they are, prescribed ones by nothing. Collective.
template <int dim>
void displace(const std::vector<FreeRow>& rows, const VectorXd& by, double time,
              SolidSystem<dim>& solids) {
  const RCP<Vector> way = make_vector(solids.map());
  for (std::size_t i = 0; i < rows.size(); ++i)
    if (solids.map()->isNodeGlobalElement(rows[i].id))
      way->replaceGlobalValue(rows[i].id, by[i]);
  solids.move(*way, time - 1, 1);
}

/// The scene without what would stir the water.
ParameterList still(ParameterList scene, int dim) {
  const ParameterArray<double> at_rest(dim, 0.0);
  ParameterList& fluid = scene.sublist("Fluid");
  if (fluid.isParameter("Velocity"))
    fluid.set("Velocity", at_rest);
  fluid.remove("Sources", false);
  fluid.sublist("Sources");
  ParameterList& sides = scene.sublist("Domain").sublist("Sides");
  for (auto it = sides.begin(); it != sides.end(); ++it) {
    ParameterList& side = sides.sublist(sides.name(it));
    side.set("Velocity", at_rest);
    if (side.get<std::string>("Type") != "inflow")
      continue;
    side.set("Type", std::string("slip wall"));
    for (const char* of_inflow : {"Wave", "Opening", "Smoke", "Temperature"})
      side.remove(of_inflow, false);
  }
  return scene;
}

/// Accelerations of the free coordinates from rest, with the bodies displaced from the start.
template <int dim>
class AtRest {
 public:
  using Build = std::function<Components<dim>(const ParameterList&)>;

  AtRest(const Build& build, const ParameterList& scene, const SceneOptions& options,
         std::vector<FreeRow> rows)
      : build_(build), scene_(still(scene, dim)), options_(options), rows_(std::move(rows)) {
    constexpr double tolerance = 1e-11;
    options_.step.solve.tolerance = std::min(options_.step.solve.tolerance, tolerance);
    options_.step.energy_budget = false;
  }

  /// One component a row [m/s^2, rad/s^2]. Collective.
  VectorXd acceleration(const VectorXd& displacement) const {
    Components<dim> components = build_(scene_);
    SolidSystem<dim>& solids = *components.solids;
    displace(rows_, displacement, options_.time.start, solids);
    solids.set_velocity(*make_vector(solids.map()));
    StageTimers timers;
    TimeScheme<dim> scheme(components, options_.step, options_.time.start, timers);
    const FluidDiscretization<dim>& fluid = *components.fluid;
    const double dt = 0.1 * std::sqrt(fluid.smallest_length() / fluid.gravity().norm());
    scheme.advance(dt);
    const RCP<const Vector> velocity = solids.velocity();
    std::vector<double> values(rows_.size(), 0.0);
    for (std::size_t i = 0; i < rows_.size(); ++i)
      if (velocity->getMap()->isNodeGlobalElement(rows_[i].id))
        values[i] = velocity->getData()[velocity->getMap()->getLocalElement(rows_[i].id)] / dt;
    sum_over_ranks(solids.comm(), values);
    return Eigen::Map<const VectorXd>(values.data(), values.size());
  }

  /// Differences of the accelerations by each displacement. Collective.
  Eigen::MatrixXd derivative(const VectorXd& at, const VectorXd& here,
                             const VectorXd& difference) const {
    Eigen::MatrixXd result(at.size(), at.size());
    for (int j = 0; j < at.size(); ++j) {
      VectorXd beside = at;
      beside[j] += difference[j];
      result.col(j) = (acceleration(beside) - here) / difference[j];
    }
    return result;
  }

 private:
  const Build& build_;
  ParameterList scene_;
  SceneOptions options_;
  std::vector<FreeRow> rows_;
};

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

template <int dim>
void check_can_settle(const Components<dim>& components, int n_free) {
  check_input(components.fluid->gravity().norm() > 0,
              "\"Time/Settle\" brings bodies to rest in water, but there is no gravity; leave it "
              "out, or give \"Fluid\" its \"Gravity\".");
  check_input(components.solids->joints() == nullptr,
              "\"Time/Settle\" does not know joints: bodies of a mechanism cannot be moved one by "
              "one. Leave it out.");
  check_input(n_free <= most_free,
              "\"Time/Settle\" has to try all {} coordinates of the free bodies, more than {}; "
              "leave it out.",
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
  const std::vector<FreeRow> rows = free_rows(*components.solids);
  const int n = static_cast<int>(rows.size());
  check_can_settle(components, n);
  if (n == 0)
    return;
  const AtRest<dim> water(build, scene, options, rows);
  const double gravity = components.fluid->gravity().norm();
  const double cell = components.fluid->smallest_length(), radius = radius_of_bodies(components);
  VectorXd scale(n);  // unit of each coordinate [m]
  for (int i = 0; i < n; ++i)
    scale[i] = rows[i].turns ? radius : 1;
  constexpr double at_rest = 1e-8, good_enough = 1e-4;  // parts of gravity
  constexpr int most_tries = 100, most_vain = 8;
  VectorXd at = VectorXd::Zero(n), here = water.acceleration(at), best = at;
  double least = 1e300;
  Eigen::MatrixXd derivative;
  int n_tries = 0;
  for (int n_vain = 0; n_tries < most_tries && n_vain < most_vain; ++n_tries) {
    const double now = here.cwiseProduct(scale).cwiseAbs().maxCoeff() / gravity;
    n_vain = now < least ? 0 : n_vain + 1;
    if (now < least) {
      least = now;
      best = at;
    }
    if (now < at_rest)
      break;
    if (derivative.size() == 0)
      derivative = water.derivative(at, here, 1e-3 * cell * scale.cwiseInverse());
    VectorXd step = step_down(derivative, here, scale, cell);
    const double length = step.cwiseProduct(scale).cwiseAbs().maxCoeff(), most = 0.25 * radius;
    step *= std::min(1., most / length);
    at += step;
    const VectorXd next = water.acceleration(at);
    const bool is_good =
        length < most && next.cwiseProduct(scale).norm() < 0.2 * here.cwiseProduct(scale).norm();
    if (!is_good)
      derivative.resize(0, 0);
    here = next;
  }
  check_solve(least < good_enough,
              "\"Time/Settle\" finds no rest: after {} tries a body still sets out with {:.3g} "
              "times gravity. Begin nearer to rest, or leave it out.",
              n_tries, least);
  if (least > at_rest)
    log.warning("Settle: after {} tries bodies still set out with {:.2g} times gravity.", n_tries,
                least);
  const std::vector<SolidState<dim>> before = components.solids->states();
  displace(rows, best, options.time.start, *components.solids);
  components.solids->set_velocity(
      *components.solids->velocity());  // the momenta of turned bodies follow
  report(before, components.solids->states(), n_tries, log);
}

template void settle<2>(const std::function<Components<2>(const ParameterList&)>&,
                        const ParameterList&, const SceneOptions&, Components<2>&, const Log&);
template void settle<3>(const std::function<Components<3>(const ParameterList&)>&,
                        const ParameterList&, const SceneOptions&, Components<3>&, const Log&);

}  // namespace lockstep
