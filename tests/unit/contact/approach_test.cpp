#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "cloth_world.hpp"
#include "contact/bodies/inverse_mass.hpp"
#include "contact/search/contact_search.hpp"

namespace lockstep::test {
namespace {

template <typename T>
class Approaches : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Approaches, Dimensions);

constexpr double dt = 0.01;

/// A sheet of many simplices an h, whose own parts are all that it can touch.
template <int dim>
struct Sheet {
  std::unique_ptr<SolidSystem<dim>> solids;
  ContactTopology<dim> topology;

  /// Nodes off their places by up to so many spacings; `squeezed` along its first axis.
  Sheet(double roughness, double squeezed) {
    std::mt19937 generator(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    constexpr double spacing = 0.3 * h;
    SurfaceMesh<dim> mesh = plate_surface<dim>(Point<dim>::Constant(2 * h), dim - 1, spacing);
    for (Point<dim>& x : mesh.vertices) {
      for (int a = 0; a < dim; ++a)
        x[a] += roughness * spacing * uniform(generator);
      x[0] *= squeezed;
    }
    *this = Sheet(cloth<dim>(mesh));
  }

  explicit Sheet(DeformableBody<dim> body) {
    std::vector<DeformableBody<dim>> bodies;
    bodies.push_back(std::move(body));
    std::vector<std::unique_ptr<SolidModel<dim>>> models;
    models.push_back(std::make_unique<DeformableSolids<dim>>(
        "cloth", std::move(bodies), Point<dim>::Zero(), world_communicator()));
    solids = std::make_unique<SolidSystem<dim>>(std::move(models), world_communicator());
  }
};

template <int dim>
struct Search {
  std::vector<Contact<dim>> all, violated_only;
  std::vector<double> normal_velocity;  ///< normal velocities of all contacts

  Search(Sheet<dim>& sheet, const std::vector<double>& velocity) {
    const ContactShapes<dim> shapes(*sheet.solids, sheet.topology);
    const SolidMotion<dim> motion(*sheet.solids, shapes, velocity);
    ContactReach reach;
    reach.near = 0.5 * h;
    reach.half_thickness = {0.05 * h};
    reach.dt = dt;
    all = find_contacts(shapes, motion, {}, reach);
    reach.violated_only = true;
    violated_only = find_contacts(shapes, motion, {}, reach);
    for (const Contact<dim>& contact : all)
      normal_velocity.push_back(
          contact.normal.dot(motion.at(0, contact.point, contact.place()) -
                             motion.at(0, contact.other_point, contact.other_place())));
  }
};

template <int dim>
bool is_among(const Contact<dim>& contact, const std::vector<Contact<dim>>& others) {
  return std::any_of(others.begin(), others.end(), [&](const Contact<dim>& other) {
    return other.point.position == contact.point.position && other.gap == contact.gap &&
           other.other_point.position == contact.other_point.position;
  });
}

/// Two plates in one mesh, the second so far from the first; its vertices are the last half.
template <int dim>
SurfaceMesh<dim> layers_of(double size, const Point<dim>& apart) {
  SurfaceMesh<dim> mesh = plate_surface<dim>(Point<dim>::Constant(size), dim - 1, 0.3 * h);
  const SurfaceMesh<dim> lower = mesh;
  const int n = static_cast<int>(lower.vertices.size());
  for (const Point<dim>& x : lower.vertices)
    mesh.vertices.push_back(x + apart);
  for (auto simplex : lower.simplices) {
    for (int& vertex : simplex)
      vertex += n;
    mesh.simplices.push_back(simplex);
  }
  return mesh;
}

TYPED_TEST(Approaches, LeaveOutNothingThatOverlapsOrIsViolated) {
  constexpr int dim = TypeParam::value;
  std::mt19937 generator(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int n_violated = 0, n_overlaps = 0;
  for (const double squeezed : {1.0, 0.2}) {
    for (const double roughness : {0.0, 0.4}) {
      Sheet<dim> sheet(roughness, squeezed);
      for (const double cells_a_step : {0.03, 0.1, 0.4}) {
        std::vector<double> velocity(sheet.solids->map()->getGlobalNumElements());
        for (double& v : velocity)
          v = cells_a_step * h / dt * uniform(generator);
        const Search<dim> search(sheet, velocity);
        EXPECT_LE(search.violated_only.size(), search.all.size());
        for (std::size_t i = 0; i < search.all.size(); ++i) {
          const Contact<dim>& contact = search.all[i];
          const bool overlaps = contact.gap < 0;
          const bool is_violated = search.normal_velocity[i] < -std::max(contact.gap, 0.0) / dt;
          n_overlaps += overlaps ? 1 : 0;
          n_violated += is_violated ? 1 : 0;
          if (overlaps || is_violated) {
            ASSERT_TRUE(is_among(contact, search.violated_only)) << contact.gap / h;
          }
        }
        for (const Contact<dim>& contact : search.violated_only)
          ASSERT_TRUE(is_among(contact, search.all));
      }
    }
  }
  EXPECT_GT(n_violated, 10);
  if (dim == 3) {
    EXPECT_GT(n_overlaps, 10);
  }
}

TYPED_TEST(Approaches, AFlatSheetThatMovesAsAWholeHasNone) {
  constexpr int dim = TypeParam::value;
  Sheet<dim> sheet(0, 1);
  std::vector<double> velocity(sheet.solids->map()->getGlobalNumElements());
  for (std::size_t dof = 0; dof < velocity.size(); ++dof)
    velocity[dof] = 0.2 * h / dt * static_cast<double>(1 + dof % dim);
  const Search<dim> search(sheet, velocity);
  EXPECT_GT(search.all.size(), 3U);
  EXPECT_TRUE(search.violated_only.empty());
}

TYPED_TEST(Approaches, LayersThatMeetAreFoundAndOthersAreNot) {
  constexpr int dim = TypeParam::value;
  constexpr double gap = 0.3 * h, thickness = 0.1 * h;  // thickness of Search
  for (const double part_of_gap : {0.99, 1.01}) {
    const SurfaceMesh<dim> mesh = layers_of<dim>(h, (gap + thickness) * Point<dim>::Unit(dim - 1));
    const int n = static_cast<int>(mesh.vertices.size()) / 2;
    DeformableBody<dim> body = cloth<dim>(mesh);
    for (int v = n; v < 2 * n; ++v)
      body.velocity[v] = -part_of_gap * gap / dt * Point<dim>::Unit(dim - 1);
    Sheet<dim> layers(std::move(body));
    const Search<dim> search(layers, replicated(*layers.solids, *layers.solids->velocity()));
    const auto is_violated = [](double v) { return v < -gap / dt; };
    EXPECT_EQ(
        std::any_of(search.normal_velocity.begin(), search.normal_velocity.end(), is_violated),
        part_of_gap > 1);
    EXPECT_EQ(search.violated_only.empty(), part_of_gap < 1);
  }
}

// One simplex of many moves, so that few of the boxes that hold it move as a whole.
TYPED_TEST(Approaches, OneSimplexThatMovesIsFoundWhereverItIs) {
  constexpr int dim = TypeParam::value;
  constexpr double gap = 0.3 * h, thickness = 0.1 * h;  // thickness of Search
  Point<dim> apart = Point<dim>::Constant(0.1 * h);     // no vertex below another
  apart[dim - 1] = gap + thickness;
  const SurfaceMesh<dim> mesh = layers_of<dim>(1.5 * h, apart);
  const std::size_t n_simplices = mesh.simplices.size();
  for (std::size_t s = n_simplices / 2; s < n_simplices; ++s) {
    DeformableBody<dim> body = cloth<dim>(mesh);
    for (const int v : mesh.simplices[s])
      body.velocity[v] = -1.05 * gap / dt * Point<dim>::Unit(dim - 1);
    Sheet<dim> layers(std::move(body));
    const Search<dim> search(layers, replicated(*layers.solids, *layers.solids->velocity()));
    int n_violated = 0;
    for (std::size_t i = 0; i < search.all.size(); ++i) {
      if (search.normal_velocity[i] >= -search.all[i].gap / dt)
        continue;
      ++n_violated;
      EXPECT_TRUE(is_among(search.all[i], search.violated_only)) << s;
    }
    EXPECT_GT(n_violated, 0) << s;
    EXPECT_LT(search.violated_only.size(), search.all.size());
  }
}

}  // namespace
}  // namespace lockstep::test
