#include <algorithm>
#include <cmath>
#include <map>

#include "base/round_off.hpp"
#include "deformable/elements/element_list.hpp"
#include "deformable/elements/shell_elements.hpp"

namespace lockstep {

namespace {

template <int dim>
class SpringElements : public ElementList<dim, Spring, SpringElements<dim>> {
 public:
  using Nodes = typename ElementGroup<dim>::Nodes;
  using Square = Eigen::Matrix<double, dim, dim>;

  SpringElements(std::vector<Spring> springs, double damping) : damping_(damping) {
    elements_ = std::move(springs);
  }

  double add_elastic_forces(const Nodes& x, int n_owned, Nodes& force) const override {
    double energy = 0;
    for (const Spring& spring : elements_) {
      const Point<dim> edge = x[spring.corners[1]] - x[spring.corners[0]];
      const double length = edge.norm(), elongation = length - spring.length;
      if (spring.corners[0] < n_owned)
        energy += 0.5 * spring.stiffness * elongation * elongation;
      if (length == 0)
        continue;
      const Point<dim> pull = spring.stiffness * elongation / length * edge;
      force[spring.corners[0]] += pull;
      force[spring.corners[1]] -= pull;
    }
    return energy;
  }
  /// A compressed spring would push its ends sideways: that part is left out.
  int add_stiffness(const Nodes& x, NodeMatrix<dim>& stiffness) const override {
    int n_clamped = 0;
    for (const Spring& spring : elements_) {
      const Point<dim> edge = x[spring.corners[1]] - x[spring.corners[0]];
      if (spring.length == 0) {
        add(spring, spring.stiffness * Square::Identity(), stiffness);
        continue;
      }
      const double length = edge.norm();
      const Square along = along_edge(edge);
      double across = length > 0 ? 1 - spring.length / length : -1;
      if (across < -rounding::sums && spring.corners[0] < stiffness.n_rows())
        ++n_clamped;
      across = std::max(0.0, across);
      add(spring, spring.stiffness * (along + across * (Square::Identity() - along)), stiffness);
    }
    return n_clamped;
  }
  void add_damping(const Nodes& x, NodeMatrix<dim>& damping) const override {
    for (const Spring& spring : elements_) {
      const Point<dim> edge = x[spring.corners[1]] - x[spring.corners[0]];
      add(spring, damping_ * spring.stiffness * along_edge(edge), damping);
    }
  }

 private:
  using ElementList<dim, Spring, SpringElements<dim>>::elements_;

  static Square along_edge(const Point<dim>& edge) {
    const double squared = edge.squaredNorm();
    if (squared == 0)
      return Square::Zero();
    return edge * edge.transpose() / squared;
  }
  static void add(const Spring& spring, const Square& block, NodeMatrix<dim>& matrix) {
    const auto [a, b] = spring.corners;
    matrix.add(a, a, block);
    matrix.add(b, b, block);
    matrix.add(a, b, -block);
    matrix.add(b, a, -block);
  }

  double damping_;
};

}  // namespace

template <int dim>
std::unique_ptr<ElementGroup<dim>> springs(const std::vector<Spring>& all, double damping) {
  return std::make_unique<SpringElements<dim>>(all, damping);
}

template <int dim>
std::unique_ptr<ElementGroup<dim>> membrane_springs(const SurfaceMesh<dim>& mesh,
                                                    const SheetMaterial& sheet, double stretch,
                                                    double shear_ratio) {
  std::vector<Spring> all;
  const auto length = [&](int a, int b) { return (mesh.vertices[b] - mesh.vertices[a]).norm(); };
  if constexpr (dim == 2) {
    const double tension =
        sheet.youngs_modulus * sheet.thickness / (1 - sheet.poisson_ratio * sheet.poisson_ratio);
    for (const auto& s : mesh.simplices) {
      const double rest = length(s[0], s[1]) / stretch;
      all.push_back({s, tension / rest, rest});
    }
  } else {
    struct Edge {
      double area = 0;  ///< area of its triangles, as the mesh has it
      std::vector<int> opposite;
    };
    std::map<std::array<int, 2>, Edge> edges;
    for (const auto& t : mesh.simplices) {
      const double area =
          area_vector<3>({mesh.vertices[t[0]], mesh.vertices[t[1]], mesh.vertices[t[2]]}).norm();
      for (int k = 0; k < 3; ++k) {
        const int a = t[(k + 1) % 3], b = t[(k + 2) % 3];
        Edge& edge = edges[{std::min(a, b), std::max(a, b)}];
        edge.area += area;
        edge.opposite.push_back(t[k]);
      }
    }
    const double tension = sheet.youngs_modulus * sheet.thickness;
    for (const auto& [ends, edge] : edges) {
      const double along = length(ends[0], ends[1]);
      // Areas and squared lengths shrink alike when the stretch is taken out.
      const double stiffness = tension * edge.area / (along * along);
      all.push_back({ends, stiffness, along / stretch});
      if (edge.opposite.size() == 2 && shear_ratio > 0) {
        all.push_back({{edge.opposite[0], edge.opposite[1]},
                       shear_ratio * stiffness,
                       length(edge.opposite[0], edge.opposite[1]) / stretch});
      }
    }
  }
  return springs<dim>(all, sheet.damping);
}

template std::unique_ptr<ElementGroup<2>> springs<2>(const std::vector<Spring>&, double);
template std::unique_ptr<ElementGroup<3>> springs<3>(const std::vector<Spring>&, double);
template std::unique_ptr<ElementGroup<2>> membrane_springs<2>(const SurfaceMesh<2>&,
                                                              const SheetMaterial&, double, double);
template std::unique_ptr<ElementGroup<3>> membrane_springs<3>(const SurfaceMesh<3>&,
                                                              const SheetMaterial&, double, double);

}  // namespace lockstep
