#include <algorithm>
#include <cmath>
#include <map>

#include "base/errors.hpp"
#include "deformable/elements/element_list.hpp"
#include "deformable/elements/shell_elements.hpp"

namespace lockstep {

namespace {

/// 2D: three vertices along a chain. 3D: the ends of an edge, then the corners opposite to it.
template <int dim>
struct Hinge {
  std::array<int, dim + 1> corners;
  double stiffness = 0;      ///< [N m]
  double angle_at_rest = 0;  ///< [rad]
  double flattest = 0;       ///< least size of a side in `SideSizes`; what is less pushes less
};

/// Squared length (2D) or doubled area (3D) of the two sides of a hinge [m^2, m^4].
using SideSizes = std::array<double, 2>;

/// The angle by which a hinge is bent, in (-pi, pi], and its derivatives with respect to the
/// corners.
template <int dim>
struct HingeAngle {
  double angle = 0;
  SideSizes sizes;
  std::array<Point<dim>, dim + 1> gradient;
};

HingeAngle<2> hinge_angle(const std::array<Point<2>, 3>& x) {
  const Point<2> u = x[1] - x[0], v = x[2] - x[1];
  const auto turned = [](const Point<2>& p) { return Point<2>(-p.y(), p.x()); };
  HingeAngle<2> result;
  result.angle = std::atan2(cross<2>(u, v)(0), u.dot(v));
  result.gradient[0] = turned(u) / u.squaredNorm();
  result.gradient[2] = turned(v) / v.squaredNorm();
  result.gradient[1] = -result.gradient[0] - result.gradient[2];
  result.sizes = {u.squaredNorm(), v.squaredNorm()};
  return result;
}

HingeAngle<3> hinge_angle(const std::array<Point<3>, 4>& x) {
  const Point<3> edge = x[1] - x[0];
  const double length = edge.norm();
  const Point<3> left = (x[0] - x[2]).cross(x[1] - x[2]), right = (x[1] - x[3]).cross(x[0] - x[3]);
  const Point<3> a = left / left.squaredNorm(), b = right / right.squaredNorm();
  HingeAngle<3> result;
  result.angle = std::atan2(right.cross(left).dot(edge) / length, left.dot(right));
  result.gradient[2] = length * a;
  result.gradient[3] = length * b;
  result.gradient[0] = (x[2] - x[1]).dot(edge) / length * a + (x[3] - x[1]).dot(edge) / length * b;
  result.gradient[1] = -result.gradient[0] - result.gradient[2] - result.gradient[3];
  result.sizes = {left.squaredNorm(), right.squaredNorm()};
  return result;
}

template <int dim>
std::array<Point<dim>, dim + 1> corner_positions(const Hinge<dim>& hinge,
                                                 const std::vector<Point<dim>>& x) {
  std::array<Point<dim>, dim + 1> corners;
  for (int k = 0; k <= dim; ++k)
    corners[k] = x[hinge.corners[k]];
  return corners;
}

/// Angle of the hinge at the positions x. Where a side has collapsed the angle turns at once when
/// a node moves by nothing: there its gradient is bounded, all of it by one factor, so that forces
/// still have neither sum nor torque.
template <int dim>
HingeAngle<dim> angle_of(const Hinge<dim>& hinge, const std::vector<Point<dim>>& x) {
  HingeAngle<dim> bent = hinge_angle(corner_positions(hinge, x));
  const double smallest = std::min(bent.sizes[0], bent.sizes[1]);
  if (smallest >= hinge.flattest)
    return bent;
  for (Point<dim>& gradient : bent.gradient)
    gradient *= smallest / hinge.flattest;
  if (smallest == 0)
    bent.gradient.fill(Point<dim>::Zero());
  return bent;
}

template <int dim>
class BendingElements : public ElementList<dim, Hinge<dim>, BendingElements<dim>> {
 public:
  using Nodes = typename ElementGroup<dim>::Nodes;

  BendingElements(std::vector<Hinge<dim>> hinges, double damping) : damping_(damping) {
    elements_ = std::move(hinges);
  }

  double add_elastic_forces(const Nodes& x, int n_owned, Nodes& force) const override {
    double energy = 0;
    for (const Hinge<dim>& hinge : elements_) {
      const HingeAngle<dim> bent = angle_of(hinge, x);
      const double change = std::remainder(bent.angle - hinge.angle_at_rest, two_pi);
      if (hinge.corners[0] < n_owned)
        energy += 0.5 * hinge.stiffness * change * change;
      Point<dim> rest = Point<dim>::Zero();
      for (int k = 0; k < dim; ++k) {
        const Point<dim> part = -hinge.stiffness * change * bent.gradient[k];
        force[hinge.corners[k]] += part;
        rest -= part;
      }
      force[hinge.corners[dim]] += rest;
    }
    return energy;
  }
  /// Gauss-Newton: without the curvature of the angle, so nothing is left to clamp.
  int add_stiffness(const Nodes& x, NodeMatrix<dim>& stiffness) const override {
    add(x, 1, stiffness);
    return 0;
  }
  void add_damping(const Nodes& x, NodeMatrix<dim>& damping) const override {
    add(x, damping_, damping);
  }

 private:
  using ElementList<dim, Hinge<dim>, BendingElements<dim>>::elements_;
  static constexpr double two_pi = 6.28318530717958648;

  void add(const Nodes& x, double factor, NodeMatrix<dim>& matrix) const {
    for (const Hinge<dim>& hinge : elements_) {
      const HingeAngle<dim> bent = angle_of(hinge, x);
      for (int i = 0; i <= dim; ++i) {
        for (int j = 0; j <= dim; ++j) {
          matrix.add(hinge.corners[i], hinge.corners[j],
                     factor * hinge.stiffness * bent.gradient[i] * bent.gradient[j].transpose());
        }
      }
    }
  }

  double damping_;
};

double rigidity(const SheetMaterial& sheet) {
  return sheet.youngs_modulus * std::pow(sheet.thickness, 3) /
         (12 * (1 - sheet.poisson_ratio * sheet.poisson_ratio));
}

std::vector<Hinge<2>> hinges_of(const SurfaceMesh<2>& mesh, double stiffness) {
  std::vector<std::array<int, 2>> ends(mesh.vertices.size(), {-1, -1});  // before, after
  for (const auto& s : mesh.simplices) {
    ends[s[0]][1] = s[1];
    ends[s[1]][0] = s[0];
  }
  std::vector<Hinge<2>> hinges;
  for (std::size_t v = 0; v < ends.size(); ++v) {
    const auto [before, after] = ends[v];
    if (before < 0 || after < 0)
      continue;
    const double length = 0.5 * ((mesh.vertices[v] - mesh.vertices[before]).norm() +
                                 (mesh.vertices[after] - mesh.vertices[v]).norm());
    hinges.push_back({{before, static_cast<int>(v), after}, stiffness / length});
  }
  return hinges;
}

std::vector<Hinge<3>> hinges_of(const SurfaceMesh<3>& mesh, double stiffness) {
  std::map<std::array<int, 2>, int> opposite;  // opposite corner of each directed edge
  for (const auto& t : mesh.simplices) {
    for (int k = 0; k < 3; ++k)
      opposite[{t[(k + 1) % 3], t[(k + 2) % 3]}] = t[k];
  }
  std::vector<Hinge<3>> hinges;
  for (const auto& [ends, left] : opposite) {
    const auto other = opposite.find({ends[1], ends[0]});
    if (ends[0] > ends[1] || other == opposite.end())
      continue;
    const Hinge<3> hinge{{ends[0], ends[1], left, other->second}};
    const auto x = corner_positions(hinge, mesh.vertices);
    const double areas =
        area_vector<3>({x[0], x[1], x[2]}).norm() + area_vector<3>({x[1], x[0], x[3]}).norm();
    hinges.push_back({hinge.corners, stiffness * (x[1] - x[0]).squaredNorm() / areas});
  }
  return hinges;
}

}  // namespace

template <int dim>
std::unique_ptr<ElementGroup<dim>> bending_elements(const SurfaceMesh<dim>& mesh,
                                                    const SheetMaterial& sheet, bool flat) {
  std::vector<Hinge<dim>> hinges = hinges_of(mesh, rigidity(sheet));
  constexpr double flattest = 1e-6;  // squared: a thousandth of the height as meshed
  for (Hinge<dim>& hinge : hinges) {
    const HingeAngle<dim> as_meshed = hinge_angle(corner_positions(hinge, mesh.vertices));
    hinge.flattest = flattest * std::min(as_meshed.sizes[0], as_meshed.sizes[1]);
    if (!flat)
      hinge.angle_at_rest = as_meshed.angle;
  }
  return std::make_unique<BendingElements<dim>>(std::move(hinges), sheet.damping);
}

template std::unique_ptr<ElementGroup<2>> bending_elements<2>(const SurfaceMesh<2>&,
                                                              const SheetMaterial&, bool);
template std::unique_ptr<ElementGroup<3>> bending_elements<3>(const SurfaceMesh<3>&,
                                                              const SheetMaterial&, bool);

}  // namespace lockstep
