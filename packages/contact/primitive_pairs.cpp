#include "contact/primitive_pairs.hpp"

#include <algorithm>

#include "geometry/box_tree.hpp"

namespace lockstep {

namespace {

/// Vertices with the simplex that holds them: a vertex, an edge or a simplex.
template <int n>
struct Primitive {
  std::array<int, n> vertices{};
  int simplex = -1;
};

template <int dim>
class PairFinder {
 public:
  PairFinder(const ContactShapes<dim>& shapes, const std::vector<Box<dim>>& vertex_boxes,
             double margin, int solid, int other, const UsePrimitivePairs<dim>& use)
      : shapes_(shapes),
        vertex_boxes_(vertex_boxes),
        margin_(margin),
        self_(solid == other),
        use_(use) {
    region_ = inflated(extent(solid)).intersection(inflated(extent(other)));
  }

  /// Vertices of `solid` against simplices of `other`.
  void add_vertices(int solid, int other) {
    add(PrimitiveKind::vertex_simplex, solid, vertices_of(solid), other, simplices_of(other));
  }
  void add_edges(int solid, int other) {
    add(PrimitiveKind::edge_edge, solid, edges_of(solid), other, edges_of(other));
  }

 private:
  Box<dim> inflated(const Box<dim>& box) const {
    return Box<dim>(box.min().array() - margin_, box.max().array() + margin_);
  }
  template <int n>
  Box<dim> box_of(const std::array<int, n>& vertices) const {
    Box<dim> box;
    for (const int v : vertices)
      box.extend(vertex_boxes_[v]);
    return box;
  }
  Box<dim> extent(int solid) const {
    Box<dim> box;
    const SolidDescription& description = shapes_.solids()[solid];
    for (int v = description.vertex_begin; v < description.vertex_end; ++v)
      box.extend(vertex_boxes_[v]);
    return box;
  }
  template <int n>
  void keep(std::vector<Primitive<n>>& primitives, const Primitive<n>& primitive) const {
    if (primitive.simplex >= 0 && region_.intersects(box_of<n>(primitive.vertices)))
      primitives.push_back(primitive);
  }

  std::vector<Primitive<1>> vertices_of(int solid) const {
    std::vector<Primitive<1>> found;
    const SolidDescription& description = shapes_.solids()[solid];
    for (int v = description.vertex_begin; v < description.vertex_end; ++v)
      keep<1>(found, {{v}, shapes_.at_vertex(v).simplex});
    return found;
  }
  std::vector<Primitive<dim>> simplices_of(int solid) const {
    std::vector<Primitive<dim>> found;
    const SolidDescription& description = shapes_.solids()[solid];
    for (int s = description.simplex_begin; s < description.simplex_end; ++s)
      keep<dim>(found, {shapes_.mesh().simplices[s], s});
    return found;
  }
  std::vector<Primitive<2>> edges_of(int solid) const {
    std::vector<Primitive<2>> found;
    for (const SurfaceEdge& edge : shapes_.topology().edges(solid))
      keep<2>(found, {edge.vertices, edge.simplices[0]});
    return found;
  }

  template <int n, int m>
  void add(PrimitiveKind kind, int solid, const std::vector<Primitive<n>>& first, int other,
           const std::vector<Primitive<m>>& second) {
    std::vector<Box<dim>> boxes;
    for (const Primitive<m>& primitive : second)
      boxes.push_back(box_of<m>(primitive.vertices));
    const BoxTree<dim> tree(std::move(boxes));
    std::vector<int> found;
    for (int i = 0; i < static_cast<int>(first.size()); ++i) {
      tree.touching(inflated(box_of<n>(first[i].vertices)), found);
      pairs_.clear();
      for (const int j : found) {
        if (kind == PrimitiveKind::vertex_simplex || !self_ || i < j)
          add_pair(kind, solid, first[i], other, second[j]);
      }
      if (!pairs_.empty())
        use_(pairs_);
    }
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
  const std::vector<Box<dim>>& vertex_boxes_;
  double margin_;
  bool self_;
  Box<dim> region_;
  const UsePrimitivePairs<dim>& use_;
  std::vector<PrimitivePair<dim>> pairs_;  ///< of one first primitive
};

}  // namespace

template <int dim>
void for_each_primitive(const ContactShapes<dim>& shapes, const std::vector<Box<dim>>& vertex_boxes,
                        double margin, int solid, int other, const UsePrimitivePairs<dim>& use) {
  PairFinder<dim> finder(shapes, vertex_boxes, margin, solid, other, use);
  finder.add_vertices(solid, other);
  if (solid != other)
    finder.add_vertices(other, solid);
  if constexpr (dim == 3)
    finder.add_edges(solid, other);
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

template void for_each_primitive<2>(const ContactShapes<2>&, const std::vector<Box<2>>&, double,
                                    int, int, const UsePrimitivePairs<2>&);
template void for_each_primitive<3>(const ContactShapes<3>&, const std::vector<Box<3>>&, double,
                                    int, int, const UsePrimitivePairs<3>&);
template std::array<SurfacePoint<2>, 2> surface_points<2>(const ContactShapes<2>&,
                                                          const PrimitivePair<2>&,
                                                          const PrimitiveWeights<2>&);
template std::array<SurfacePoint<3>, 2> surface_points<3>(const ContactShapes<3>&,
                                                          const PrimitivePair<3>&,
                                                          const PrimitiveWeights<3>&);

}  // namespace lockstep
