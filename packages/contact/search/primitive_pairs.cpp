#include "contact/search/primitive_pairs.hpp"

#include <algorithm>

namespace lockstep {

namespace {

/// The boxes of a tree with how they move: those that come near.
template <int dim>
class ClosingTree {
 public:
  /// `motion_of(i)`: of box i.
  template <typename MotionOf>
  ClosingTree(const BoxTree<dim>& tree, double margin, double thickness, const MotionOf& motion_of)
      : tree_(tree),
        margin_(margin),
        thickness_(thickness),
        of_nodes_(tree.template over_nodes<PrimitiveMotion<dim>>(
            [&](PrimitiveMotion<dim>& sum, int i) { sum = merged(sum, motion_of(i)); },
            [](const auto& one, const auto& other) { return merged(one, other); })) {
    for (int i = 0; i < tree.n_boxes(); ++i)
      motions_.push_back(motion_of(i));
  }

  /// Calls f(i) for those that may come to this box, which moves so, until f returns true.
  template <typename Function>
  bool any_closing(const Box<dim>& box, const PrimitiveMotion<dim>& motion,
                   const Function& f) const {
    const Box<dim> near = inflated<dim>(box, margin_);
    const auto closes = [&](const Box<dim>& other, const PrimitiveMotion<dim>& its_motion) {
      return other.intersects(near) &&
             may_close(motion, its_motion, box.exteriorDistance(other), thickness_);
    };
    return tree_.any([&](const Box<dim>& node, int at) { return closes(node, of_nodes_[at]); },
                     [&](int i) { return closes(tree_.box(i), motions_[i]) && f(i); });
  }

 private:
  const BoxTree<dim>& tree_;
  double margin_, thickness_;
  std::vector<PrimitiveMotion<dim>> of_nodes_, motions_;
};

/// Vertices with the simplex that holds them: a vertex, an edge or a simplex.
template <int n>
struct Primitive {
  std::array<int, n> vertices{};
  int simplex = -1;
};

/// The pairs of two solids, in boxes that are near both.
template <int dim>
class PairFinder {
 public:
  PairFinder(const ContactShapes<dim>& shapes, double margin, const Box<dim>& region, bool self,
             const UsePrimitivePairs<dim>& use)
      : shapes_(shapes), margin_(margin), region_(region), self_(self), use_(use) {}
  /// Leaves out pairs of the solid with itself from now on that `approach` rules out.
  void leave_out(const Approach<dim>& approach, double thickness) {
    approach_ = &approach;
    thickness_ = thickness;
  }

  /// Vertices of `solid` against simplices of `other`.
  void add_vertices(int solid, const BoxTree<dim>& vertices, int other,
                    const BoxTree<dim>& simplices) {
    const int first_vertex = shapes_.solids()[solid].vertex_begin;
    const int first_simplex = shapes_.solids()[other].simplex_begin;
    add<1, dim>(
        solid, vertices, other, simplices,
        [&](int i) {
          const int v = first_vertex + i;
          return Primitive<1>{{v}, shapes_.at_vertex(v).simplex};
        },
        [&](int j) {
          const int s = first_simplex + j;
          return Primitive<dim>{shapes_.mesh().simplices[s], s};
        });
  }
  void add_edges(int solid, const BoxTree<dim>& edges, int other, const BoxTree<dim>& others) {
    const auto edge_of = [this](int of, int i) {
      const SurfaceEdge& edge = shapes_.topology().edges(of)[i];
      return Primitive<2>{edge.vertices, edge.simplices[0]};
    };
    add<2, 2>(
        solid, edges, other, others, [&](int i) { return edge_of(solid, i); },
        [&](int j) { return edge_of(other, j); });
  }

 private:
  /// Vertices against simplices, or edges against edges. `first` and `second` make primitives of
  /// their numbers in the trees.
  template <int n, int m, typename First, typename Second>
  void add(int solid, const BoxTree<dim>& first_tree, int other, const BoxTree<dim>& second_tree,
           const First& first, const Second& second) {
    constexpr PrimitiveKind kind =
        n == 1 ? PrimitiveKind::vertex_simplex : PrimitiveKind::edge_edge;
    std::vector<int> near_both, found;
    first_tree.touching(region_, near_both);
    const auto is_second = [&](int i, int j) {
      return kind == PrimitiveKind::vertex_simplex || !self_ || i < j;
    };
    const auto use_pairs = [&](int i) {
      const Primitive<n> one = first(i);
      pairs_.clear();
      for (const int j : found)
        add_pair<n, m>(kind, solid, one, other, second(j));
      if (!pairs_.empty())
        use_(pairs_);
    };
    const auto find_touching = [&](int i) {
      second_tree.touching(inflated<dim>(first_tree.box(i), margin_), found,
                           [&](int j) { return is_second(i, j); });
    };
    if (approach_ == nullptr) {
      for (const int i : near_both) {
        find_touching(i);
        use_pairs(i);
      }
      return;
    }
    const auto motion_of = [&](const auto& primitive) {
      const auto& vertices = primitive.vertices;
      return approach_->of(vertices.data(), vertices.data() + vertices.size(), primitive.simplex);
    };
    const ClosingTree<dim> closing(second_tree, margin_, thickness_,
                                   [&](int j) { return motion_of(second(j)); });
    for (const int i : near_both) {
      const Primitive<n> one = first(i);
      found.clear();
      const bool any = closing.any_closing(first_tree.box(i), motion_of(one), [&](int j) {
        if (kind == PrimitiveKind::vertex_simplex)
          return !connected(one, second(j));
        if (is_second(i, j))
          found.push_back(j);
        return false;
      });
      if (any)  // all simplices are needed to find the nearest to a vertex
        find_touching(i);
      else
        std::sort(found.begin(), found.end());
      use_pairs(i);
    }
  }
  /// One vertex is common, or an edge leads from one to the other.
  template <int n, int m>
  bool connected(const Primitive<n>& one, const Primitive<m>& other) const {
    for (const int v : one.vertices)
      for (const int w : other.vertices)
        if (v == w || shapes_.topology().connected(v, w))
          return true;
    return false;
  }
  template <int n, int m>
  void add_pair(PrimitiveKind kind, int solid, const Primitive<n>& first, int other,
                const Primitive<m>& second) {
    if constexpr (n + m == dim + 1) {
      PrimitivePair<dim> pair;
      pair.kind = kind;
      pair.solid = solid;
      pair.other = other;
      pair.simplex = first.simplex;
      pair.other_simplex = second.simplex;
      std::copy(first.vertices.begin(), first.vertices.end(), pair.vertices.begin());
      std::copy(second.vertices.begin(), second.vertices.end(), pair.vertices.begin() + n);
      const auto is_held = [this](int v) { return shapes_.held(v); };
      if (std::all_of(pair.vertices.begin(), pair.vertices.end(), is_held))
        return;
      if (std::find_first_of(first.vertices.begin(), first.vertices.end(), second.vertices.begin(),
                             second.vertices.end()) == first.vertices.end())
        pairs_.push_back(pair);
    }
  }

  const ContactShapes<dim>& shapes_;
  double margin_;
  Box<dim> region_;
  bool self_;
  const UsePrimitivePairs<dim>& use_;
  const Approach<dim>* approach_ = nullptr;  ///< null: nothing is left out
  double thickness_ = 0;
  std::vector<PrimitivePair<dim>> pairs_;  ///< pairs of one first primitive
};

}  // namespace

template <int dim>
PrimitivePairs<dim>::PrimitivePairs(const ContactShapes<dim>& shapes,
                                    std::vector<Box<dim>> vertex_boxes)
    : shapes_(shapes), vertex_boxes_(std::move(vertex_boxes)), trees_(shapes.n_solids()) {}

template <int dim>
const typename PrimitivePairs<dim>::Trees& PrimitivePairs<dim>::trees_of(int solid) {
  if (!trees_[solid])
    trees_[solid] = std::make_unique<const Trees>(make_trees(solid));
  return *trees_[solid];
}

/// Vertices that no simplex has are empty boxes, which nothing finds.
template <int dim>
typename PrimitivePairs<dim>::Trees PrimitivePairs<dim>::make_trees(int solid) const {
  const SolidDescription& description = shapes_.solids()[solid];
  const auto box_of = [this](const auto& vertices) {
    Box<dim> box;
    for (const int v : vertices)
      box.extend(vertex_boxes_[v]);
    return box;
  };
  const auto make_tree = [](std::vector<Box<dim>> boxes, BoxOrder& order) {
    BoxTree<dim> tree(std::move(boxes), order);
    order = tree.order();
    return tree;
  };
  Trees trees;
  std::vector<Box<dim>> vertices, simplices, edges;
  for (int v = description.vertex_begin; v < description.vertex_end; ++v) {
    trees.extent.extend(vertex_boxes_[v]);
    vertices.push_back(shapes_.at_vertex(v).simplex >= 0 ? vertex_boxes_[v] : Box<dim>());
  }
  for (int s = description.simplex_begin; s < description.simplex_end; ++s)
    simplices.push_back(box_of(shapes_.mesh().simplices[s]));
  for (const SurfaceEdge& edge : shapes_.topology().edges(solid))
    edges.push_back(box_of(edge.vertices));
  auto& orders = shapes_.topology().orders(solid);
  trees.vertices = make_tree(std::move(vertices), orders[0]);
  trees.simplices = make_tree(std::move(simplices), orders[1]);
  trees.edges = make_tree(std::move(edges), orders[2]);
  return trees;
}

template <int dim>
void PrimitivePairs<dim>::for_each(double margin, int solid, int other,
                                   const UsePrimitivePairs<dim>& use) {
  const Trees &one = trees_of(solid), &two = trees_of(other);
  const Box<dim> region =
      inflated<dim>(one.extent, margin).intersection(inflated<dim>(two.extent, margin));
  PairFinder<dim> finder(shapes_, margin, region, solid == other, use);
  finder.add_vertices(solid, one.vertices, other, two.simplices);
  if (solid != other)
    finder.add_vertices(other, two.vertices, solid, one.simplices);
  if constexpr (dim == 3)
    finder.add_edges(solid, one.edges, other, two.edges);
}

template <int dim>
void PrimitivePairs<dim>::for_each_closing(double margin, int solid, const Approach<dim>& approach,
                                           double thickness, const UsePrimitivePairs<dim>& use) {
  const Trees& trees = trees_of(solid);
  PairFinder<dim> finder(shapes_, margin, inflated<dim>(trees.extent, margin), true, use);
  finder.leave_out(approach, thickness);
  finder.add_vertices(solid, trees.vertices, solid, trees.simplices);
  if constexpr (dim == 3)
    finder.add_edges(solid, trees.edges, solid, trees.edges);
}

template <int dim>
bool are_neighbours(const ContactTopology<dim>& topology, const PrimitivePair<dim>& pair) {
  const int n_first = pair.kind == PrimitiveKind::edge_edge ? 2 : 1;
  for (int i = 0; i < n_first; ++i) {
    for (int j = n_first; j <= dim; ++j) {
      if (topology.connected(pair.vertices[i], pair.vertices[j]))
        return true;
    }
  }
  return false;
}

template <int dim>
std::array<SurfacePoint<dim>, 2> surface_points(const ContactShapes<dim>& shapes,
                                                const PrimitivePair<dim>& pair,
                                                const PrimitiveWeights<dim>& weights) {
  std::array<SurfacePoint<dim>, 2> points;
  points[0].simplex = pair.simplex;
  points[1].simplex = pair.other_simplex;
  const int n_first = pair.kind == PrimitiveKind::edge_edge ? 2 : 1;
  for (int k = 0; k <= dim; ++k) {
    SurfacePoint<dim>& point = points[k < n_first ? 0 : 1];
    const double weight = k < n_first ? weights[k] : -weights[k];
    const auto& simplex = shapes.mesh().simplices[point.simplex];
    point.barycentric[std::find(simplex.begin(), simplex.end(), pair.vertices[k]) -
                      simplex.begin()] = weight;
    point.position += weight * shapes.mesh().vertices[pair.vertices[k]];
  }
  return points;
}

template class PrimitivePairs<2>;
template class PrimitivePairs<3>;
template bool are_neighbours<2>(const ContactTopology<2>&, const PrimitivePair<2>&);
template bool are_neighbours<3>(const ContactTopology<3>&, const PrimitivePair<3>&);
template std::array<SurfacePoint<2>, 2> surface_points<2>(const ContactShapes<2>&,
                                                          const PrimitivePair<2>&,
                                                          const PrimitiveWeights<2>&);
template std::array<SurfacePoint<3>, 2> surface_points<3>(const ContactShapes<3>&,
                                                          const PrimitivePair<3>&,
                                                          const PrimitiveWeights<3>&);

}  // namespace lockstep
