// The search for pairs against all pairs there are.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>

#include "cloth_world.hpp"
#include "contact/impacts/impacts.hpp"
#include "contact/search/contact_search.hpp"
#include "contact/search/meeting_pairs.hpp"

namespace lockstep::test {
namespace {

template <typename T>
class Searches : public ::testing::Test {};
using Dimensions = ::testing::Types<std::integral_constant<int, 2>, std::integral_constant<int, 3>>;
TYPED_TEST_SUITE(Searches, Dimensions);

TYPED_TEST(Searches, MeetingPairsAreAllThatMeet) {
  constexpr int dim = TypeParam::value;
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Box<dim>> boxes;
  for (int i = 0; i < 60; ++i) {
    boxes.emplace_back();
    for (int corner = 0; corner < 2 && i % 7 != 3; ++corner) {
      Point<dim> x;
      for (int a = 0; a < dim; ++a)
        x[a] = std::round(20 * uniform(generator) / (corner + 1));  // some touch exactly
      boxes.back().extend(x);
    }
  }
  const auto is_wanted = [](int i, int j) { return (i + j) % 5 != 0; };
  std::vector<std::array<int, 2>> expected;
  for (int i = 0; i < 60; ++i) {
    for (int j = i + 1; j < 60; ++j) {
      if (boxes[i].intersects(boxes[j]) && is_wanted(i, j))
        expected.push_back({i, j});
    }
  }
  EXPECT_GT(expected.size(), 20U);
  EXPECT_EQ(meeting_pairs<dim>(boxes, is_wanted), expected);
}

/// The vertices of either primitive.
template <int dim>
std::vector<int> key_of(const PrimitivePair<dim>& pair) {
  std::vector<int> key(pair.vertices.begin(), pair.vertices.end());
  const int n_first = pair.kind == PrimitiveKind::edge_edge ? 2 : 1;
  std::sort(key.begin(), key.begin() + n_first);
  std::sort(key.begin() + n_first, key.end());
  if (n_first == 2 && key[2] < key[0])
    std::swap_ranges(key.begin(), key.begin() + 2, key.begin() + 2);
  return key;
}

/// Impacts of all vertices with all simplices, and of all edges, but where both are rigid.
template <int dim>
std::vector<std::vector<int>> all_impacts(const ContactShapes<dim>& shapes,
                                          const SurfacePath<dim>& path) {
  const auto& mesh = shapes.mesh();
  std::vector<int> solid_of(mesh.vertices.size(), 0);
  for (int i = 0; i < shapes.n_solids(); ++i)
    for (int v = shapes.solids()[i].vertex_begin; v < shapes.solids()[i].vertex_end; ++v)
      solid_of[v] = i;
  std::vector<std::vector<int>> found;
  const auto look = [&](PrimitiveKind kind, const std::vector<int>& first,
                        const std::vector<int>& second) {
    const bool share =
        std::find_first_of(first.begin(), first.end(), second.begin(), second.end()) != first.end();
    const auto& solids = shapes.solids();
    const bool both_rigid = solids[solid_of[first[0]]].rigid && solids[solid_of[second[0]]].rigid;
    if (share || both_rigid)
      return;
    PrimitivePair<dim> pair;
    pair.kind = kind;
    std::copy(first.begin(), first.end(), pair.vertices.begin());
    std::copy(second.begin(), second.end(), pair.vertices.begin() + first.size());
    if (first_impact<dim>(kind, points_of(pair, path.before), points_of(pair, path.after)))
      found.push_back(key_of(pair));
  };
  for (const auto& simplex : mesh.simplices)
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v)
      look(PrimitiveKind::vertex_simplex, {static_cast<int>(v)},
           std::vector<int>(simplex.begin(), simplex.end()));
  std::vector<std::vector<int>> edges;
  for (int i = 0; i < shapes.n_solids(); ++i)
    for (const SurfaceEdge& edge : shapes.topology().edges(i))
      edges.push_back({edge.vertices[0], edge.vertices[1]});
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t j = i + 1; j < edges.size(); ++j)
      look(PrimitiveKind::edge_edge, edges[i], edges[j]);
  std::sort(found.begin(), found.end());
  return found;
}

TYPED_TEST(Searches, ImpactsAreThoseOfAllPairs) {
  constexpr int dim = TypeParam::value;
  std::vector<DeformableBody<dim>> cloths;
  for (const double height : {0.5, 0.0, -0.6})
    cloths.push_back(sheet<dim>(4 * h, up<dim>(height * h), h));
  std::vector<RigidBody<dim>> bodies;
  for (const double place : {-1.0, 1.0})
    bodies.push_back(ball<dim>(0.6 * h, up<dim>(-1.2 * h) + place * h * Point<dim>::Unit(0)));
  bodies.push_back(ball<dim>(0.6 * h, Point<dim>::Constant(30 * h)));
  ClothWorld<dim> world(std::move(cloths), std::move(bodies), Point<dim>::Zero());
  ContactTopology<dim> topology;
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  std::size_t n_found = 0;
  for (int repeat = 0; repeat < 8; ++repeat) {  // with trees in order, too
    const ContactShapes<dim> shapes(*world.solids, topology);
    std::vector<double> velocity(world.solids->n_unknowns());
    for (double& v : velocity)
      v = 0.5 * h * uniform(generator);
    const SurfacePath<dim> path(shapes, SolidMotion<dim>(*world.solids, shapes, velocity), 1);
    std::vector<std::vector<int>> found;
    for (const auto& impact : find_impacts(shapes, path))
      found.push_back(key_of(impact.pair));
    std::sort(found.begin(), found.end());
    EXPECT_EQ(found, all_impacts(shapes, path));
    n_found += found.size();
  }
  EXPECT_GT(n_found, 20U);
}

/// The simplices of all contacts of a sheet over another whose nodes are straight below its own,
/// each of the upper ones moved by so much at most along any axis.
template <int dim>
std::vector<std::array<int, 2>> simplices_in_contact(double moved) {
  std::vector<DeformableBody<dim>> cloths;
  for (const double height : {0., 0.05 * h})
    cloths.push_back(sheet<dim>(4 * h, up<dim>(height), h));
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-moved, moved);
  for (Point<dim>& x : cloths.back().position)
    x += Point<dim>::NullaryExpr([&] { return uniform(generator); });
  const ClothWorld<dim> world(std::move(cloths), {}, Point<dim>::Zero());
  ContactTopology<dim> topology;
  const ContactShapes<dim> shapes(*world.solids, topology);
  ContactReach reach;
  reach.near = 0.1 * h;
  reach.half_thickness.assign(2, 0);
  const std::vector<double> velocity(world.solids->n_unknowns(), 0);
  std::vector<std::array<int, 2>> found;
  for (const Contact<dim>& contact :
       find_contacts(shapes, SolidMotion<dim>(*world.solids, shapes, velocity), {}, reach))
    found.push_back({contact.point.simplex, contact.other_point.simplex});
  return found;
}

TYPED_TEST(Searches, RoundOffDoesNotChooseAmongSimplicesThatAreEquallyNear) {
  constexpr int dim = TypeParam::value;
  const auto expected = simplices_in_contact<dim>(0);
  EXPECT_EQ(expected.size(), dim == 2 ? 2 * 5U : 2 * 7 * 7U);  // all nodes
  for (const double moved : {1e-15, 1e-14, 1e-13})
    EXPECT_EQ(simplices_in_contact<dim>(moved * h), expected) << moved;
}

}  // namespace
}  // namespace lockstep::test
