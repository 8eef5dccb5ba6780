#include "lines/catenary.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "base/errors.hpp"

namespace lockstep {

namespace {

/// The way that a line spans under tensions (H, V), which is the gradient of its complementary
/// energy W = int T + T^2 / (2 EA) ds, a convex function.
struct SpannedWay {
  double energy = 0;       ///< W [J]
  Eigen::Vector2d way;     ///< l, h [m]
  Eigen::Matrix2d matrix;  ///< second derivatives of W [m/N]
};

/// int sqrt(H^2 + u^2) du from 0 to u.
double integral_of_tension(double horizontal, double u) {
  const double squared = horizontal * horizontal;
  return 0.5 * (u * std::hypot(horizontal, u) + squared * std::asinh(u / horizontal));
}

SpannedWay spanned(const CatenaryParameters& line, const Eigen::Vector2d& tension) {
  const double h = tension[0], w = line.weight, ea = line.stiffness;
  const double upper = tension[1];
  const bool rests = line.on_floor && upper < w * line.length;
  const double lower = rests ? 0 : upper - w * line.length;  // vertical tension of the lower end
  const double on_ground = rests ? line.length - upper / w : 0;
  const double t1 = std::hypot(h, upper), t0 = std::hypot(h, lower);
  const double turn = std::asinh(upper / h) - std::asinh(lower / h);
  const double sines = upper / t1 - lower / t0, lifted = upper - lower;
  SpannedWay all;
  all.way << on_ground + h / w * turn + h * line.length / ea,
      lifted * (upper + lower) / w * (1 / (t1 + t0) + 1 / (2 * ea));
  all.matrix(0, 0) = (turn - sines) / w + line.length / ea;
  all.matrix(0, 1) = all.matrix(1, 0) = h / w * (1 / t1 - 1 / t0);
  all.matrix(1, 1) = sines / w + lifted / (ea * w);
  const double cubes = upper * upper * upper - lower * lower * lower;
  all.energy = (integral_of_tension(h, upper) - integral_of_tension(h, lower)) / w + on_ground * h +
               (h * h * line.length + cubes / (3 * w)) / (2 * ea);
  return all;
}

/// Tensions from which Newton's method sets out (Jonkman 2007).
Eigen::Vector2d first_guess(const CatenaryParameters& line, double l, double h) {
  const double all = line.length * line.length, straight = l * l + h * h;
  const double slack = all > straight ? std::sqrt(3 * ((all - h * h) / (l * l) - 1)) : 0.2;
  return {line.weight * l / (2 * slack), line.weight / 2 * (h / std::tanh(slack) + line.length)};
}

/// A line that hangs straight down from its second end, the rest loose on the ground.
CatenaryTension hanging(const CatenaryParameters& line, double h) {
  CatenaryTension result;
  const double ea = line.stiffness;
  result.vertical = ea * (std::sqrt(1 + 2 * line.weight * h / ea) - 1);
  result.stiffness(1, 1) = line.weight / (1 + result.vertical / ea);
  const double v = result.vertical;
  result.energy = v * h - (v * v / 2 + v * v * v / (6 * ea)) / line.weight;
  return result;
}

/// The largest step, at most 1, that keeps a tension above a tenth of itself.
double part_of_step(double tension, double step) {
  return step < 0 ? std::min(1., -0.9 * tension / step) : 1;
}

}  // namespace

CatenaryTension solve_catenary(const CatenaryParameters& line, double l, double h) {
  constexpr int most_iterations = 200, most_halvings = 40;
  constexpr double tolerance = 1e-12, smallest_way = 1e-9;
  const Eigen::Vector2d wanted(std::max(l, smallest_way * line.length),
                               line.on_floor ? std::max(h, smallest_way * line.length) : h);
  if (line.on_floor) {
    const CatenaryTension loose = hanging(line, wanted[1]);
    if (wanted[0] + loose.vertical / line.weight <= line.length)
      return loose;
  }
  Eigen::Vector2d tension = first_guess(line, wanted[0], wanted[1]);
  SpannedWay at = spanned(line, tension);
  for (int k = 0; k < most_iterations; ++k) {
    const Eigen::Vector2d missing = wanted - at.way;
    const Eigen::Matrix2d stiffness = at.matrix.inverse();
    if (missing.norm() <= tolerance * line.length)
      return {tension[0], tension[1], stiffness, tension.dot(at.way) - at.energy};
    const Eigen::Vector2d step = stiffness * missing;
    double part = part_of_step(tension[0], step[0]);
    if (line.on_floor)
      part = std::min(part, part_of_step(tension[1], step[1]));
    const double before = missing.dot(step);  // the descent, which must not turn around
    for (int halving = 0;; ++halving, part /= 2) {
      at = spanned(line, tension + part * step);
      if (std::abs((wanted - at.way).dot(step)) <= 0.9999 * before || halving == most_halvings)
        break;
    }
    tension += part * step;
  }
  throw SolveError(fmt::format(
      "The catenary of a line {:g} m long, whose ends are {:g} m beside and {:g} m above each "
      "other, was not found; tensions of {:g} and {:g} N span {:g} and {:g} m.",
      line.length, l, h, tension[0], tension[1], at.way[0], at.way[1]));
}

namespace {

template <int dim>
class CatenaryLaw : public LineLaw<dim> {
 public:
  CatenaryLaw(const CatenaryParameters& line, const Point<dim>& up) : line_(line), up_(up) {}

  LineResponse<dim> response(const Point<dim>& way) const override {
    using Matrix = Eigen::Matrix<double, dim, dim>;
    const auto [along, l, h] = split(way);
    const CatenaryTension tension = solve_catenary(line_, l, h);
    const double horizontal = tension.horizontal, vertical = tension.vertical;
    const double whole = line_.weight * line_.length;
    const double lower = line_.on_floor ? std::max(0., vertical - whole) : vertical - whole;
    LineResponse<dim> response;
    response.energy = tension.energy;
    response.force = {Point<dim>(horizontal * along + lower * up_),
                      Point<dim>(-horizontal * along - vertical * up_)};
    response.tension = {std::hypot(horizontal, lower), std::hypot(horizontal, vertical)};
    const Matrix level = Matrix::Identity() - up_ * up_.transpose();
    const Matrix forward = along * along.transpose();
    const double across =
        l > 0 ? std::min(horizontal / l, tension.stiffness(0, 0)) : tension.stiffness(0, 0);
    response.stiffness =
        tension.stiffness(0, 0) * forward + across * (level - forward) +
        tension.stiffness(0, 1) * (along * up_.transpose() + up_ * along.transpose()) +
        tension.stiffness(1, 1) * up_ * up_.transpose();
    return response;
  }

  Point<dim> weight() const override {
    return line_.on_floor ? Point<dim>(Point<dim>::Zero())
                          : Point<dim>(-line_.weight * line_.length * up_);
  }

  std::vector<Point<dim>> shape(const Point<dim>& way) const override {
    constexpr int n_pieces = 32;
    const auto [along, l, h] = split(way);
    const CatenaryTension tension = solve_catenary(line_, l, h);
    std::vector<Point<dim>> points;
    for (int k = 0; k <= n_pieces; ++k) {
      // The piece from the second end down to here, by itself.
      CatenaryParameters piece = line_;
      piece.length = line_.length * (n_pieces - k) / n_pieces;
      if (k == n_pieces) {
        points.push_back(way);
        continue;
      }
      const double smallest = 1e-9 * line_.weight * line_.length;
      const Eigen::Vector2d spans =
          spanned(piece, {std::max(tension.horizontal, smallest), tension.vertical}).way;
      points.push_back(way - spans[0] * along - spans[1] * up_);
    }
    points.front().setZero();
    return points;
  }

 private:
  struct Split {
    Point<dim> along;  ///< level, of length 1; zero for ends above each other
    double l, h;       ///< [m]
  };
  Split split(const Point<dim>& way) const {
    const double h = way.dot(up_);
    const Point<dim> level = way - h * up_;
    const double l = level.norm();
    return {l > 0 ? Point<dim>(level / l) : Point<dim>(Point<dim>::Zero()), l, h};
  }

  CatenaryParameters line_;
  Point<dim> up_;
};

}  // namespace

template <int dim>
std::shared_ptr<const LineLaw<dim>> catenary_law(const CatenaryParameters& line,
                                                 const Point<dim>& up) {
  return std::make_shared<CatenaryLaw<dim>>(line, up);
}

template std::shared_ptr<const LineLaw<2>> catenary_law<2>(const CatenaryParameters&,
                                                           const Point<2>&);
template std::shared_ptr<const LineLaw<3>> catenary_law<3>(const CatenaryParameters&,
                                                           const Point<3>&);

}  // namespace lockstep
