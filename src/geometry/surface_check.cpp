#include "geometry/surface_check.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "geometry/self_crossing.hpp"
#include "geometry/surface_parts.hpp"

namespace lockstep {

namespace {

/// "3 triangles", "1 triangle".
std::string count_text(int n, const std::string& word, const std::string& plural) {
  return fmt::format("{} {}", n, n == 1 ? word : plural);
}

/// Facets of one kind of defect: how many places, and the first of them.
struct Places {
  int n = 0;
  Facet first;
  void add(const Facet& facet) {
    if (n++ == 0)
      first = facet;
  }
};

/// Facets at which the surface is not closed.
struct OpenFacets {
  Places lone, crowded, opposed;  ///< edges of one simplex, of more than two, of two that disagree
  int n_holes = 0;                ///< connected runs of lone facets (3D)
  bool none() const { return lone.n + crowded.n + opposed.n == 0; }
};

int count_runs(const std::vector<Facet>& facets, std::size_t n_vertices) {
  std::vector<int> parent(n_vertices);
  std::iota(parent.begin(), parent.end(), 0);
  const auto root = [&](int v) {
    while (parent[v] != v)
      v = parent[v] = parent[parent[v]];
    return v;
  };
  std::vector<int> roots;
  for (const Facet& facet : facets)
    parent[root(facet.first)] = root(facet.second);
  for (const Facet& facet : facets)
    roots.push_back(root(facet.first));
  std::sort(roots.begin(), roots.end());
  return static_cast<int>(std::unique(roots.begin(), roots.end()) - roots.begin());
}

template <int dim>
OpenFacets find_open_facets(const SurfaceMesh<dim>& mesh) {
  const std::vector<Facet> facets = sorted_facets(mesh);
  OpenFacets open;
  std::vector<Facet> lone;
  for_each_place(facets, [&](int i, int n) {
    if (n == 1) {
      lone.push_back(facets[i]);
      open.lone.add(facets[i]);
    } else if (n > 2) {
      open.crowded.add(facets[i]);
    } else if (facets[i].direction == facets[i + 1].direction) {
      open.opposed.add(facets[i]);
    }
  });
  open.n_holes = lone.empty() ? 0 : count_runs(lone, mesh.vertices.size());
  return open;
}

template <int dim>
class SurfaceChecker {
 public:
  SurfaceChecker(SurfaceMesh<dim>& mesh, const SurfaceDemand& demand, const MeshNames& names)
      : mesh_(mesh),
        demand_(demand),
        names_(names),
        heading_(heading_text("Surface", demand.name, names)),
        word_(simplex_word(dim)),
        words_(word_ + "s") {}

  void check() {
    check_input(!mesh_.simplices.empty(), "{} has no {}.", heading_, words_);
    check_vertices();
    check_shapes();
    if (!demand_.closed) {
      check_orientation();
      return;
    }
    check_closure();
    if (from_file())
      check_crossing();
    check_volume();
    check_senses();
  }

 private:
  bool from_file() const { return !names_.file.empty(); }
  std::string simplex(int s) const {
    return simplex_text(names_, s, dim) +
           fmt::format(" with its first corner at {}",
                       point_text<dim>(mesh_.vertices[mesh_.simplices[s][0]]));
  }
  std::string vertex(int v) const { return vertex_text<dim>(names_, v, mesh_.vertices[v]); }
  std::string facet(const Facet& r) const {
    const std::string of = simplex_text(names_, r.simplex, dim);
    if (dim == 2)
      return fmt::format("{} of {}", vertex(r.first), of);
    return fmt::format("from {} to {}, of {}", vertex(r.first), vertex(r.second), of);
  }

  void check_vertices() const {
    const int n_vertices = static_cast<int>(mesh_.vertices.size());
    for (int v = 0; v < n_vertices; ++v)
      if (!mesh_.vertices[v].allFinite())
        throw InputError(fmt::format("{}: {} is not a finite point.", heading_, vertex(v)));
    for (std::size_t s = 0; s < mesh_.simplices.size(); ++s)
      for (const int v : mesh_.simplices[s])
        if (v < 0 || v >= n_vertices)
          throw InputError(fmt::format("{}: {} refers to vertex {}, but the vertices are 0 to {}.",
                                       heading_, simplex_text(names_, static_cast<int>(s), dim), v,
                                       n_vertices - 1));
  }

  bool is_degenerate(int s) const {
    std::array<Point<dim>, dim> corners;
    for (int k = 0; k < dim; ++k)
      corners[k] = mesh_.vertices[mesh_.simplices[s][k]];
    double longest = 0;
    for (int k = 0; k < dim; ++k)
      longest = std::max(longest, (corners[(k + 1) % dim] - corners[k]).norm());
    const double smallest_measure = dim == 2 ? 0 : 1e-12 * longest * longest;
    return !(area_vector<dim>(corners).norm() > smallest_measure);
  }
  void check_shapes() const {
    int n = 0, first = -1;
    for (int s = static_cast<int>(mesh_.simplices.size()) - 1; s >= 0; --s) {
      if (is_degenerate(s)) {
        ++n;
        first = s;
      }
    }
    if (n == 0)
      return;
    throw InputError(fmt::format(
        "{}: {} degenerate (corners coincide or lie on one line), the first is {}; remove {}{}.",
        heading_, count_text(n, word_ + " is", words_ + " are"), simplex(first),
        n == 1 ? "it" : "them", from_file() ? ", or merge coinciding vertices with \"Weld\"" : ""));
  }

  /// Returns the faults of the surface, one clause a kind.
  std::vector<std::string> clauses(const OpenFacets& open) const {
    std::vector<std::string> list;
    const auto add = [&](const Places& places, const std::string& what) {
      if (places.n > 0)
        list.push_back(fmt::format("{}, the first {}", what, facet(places.first)));
    };
    const int n = open.lone.n, m = open.crowded.n, o = open.opposed.n;
    if (dim == 2) {
      add(open.lone, count_text(n, "loose end", "loose ends"));
      add(open.crowded, count_text(m, "vertex", "vertices") + " of more than two segments");
      add(open.opposed, count_text(o, "vertex", "vertices") +
                            " whose two segments are oriented against each other");
    } else {
      add(open.lone,
          fmt::format("{}, with {} of one triangle only", count_text(open.n_holes, "hole", "holes"),
                      count_text(n, "edge", "edges")));
      add(open.crowded, count_text(m, "edge", "edges") + " of more than two triangles");
      add(open.opposed,
          count_text(o, "edge", "edges") + " whose two triangles are oriented against each other");
    }
    return list;
  }
  void check_closure() const {
    const OpenFacets open = find_open_facets(mesh_);
    if (open.none())
      return;
    std::vector<std::string> remedies;
    if (open.lone.n + open.crowded.n > 0) {
      remedies.emplace_back("Repair the mesh");
      if (from_file())
        remedies.emplace_back("merge vertices that are meant to be one with \"Weld\"");
      if (demand_.can_be_shell)
        remedies.emplace_back("take it as a thin shell with \"Thin Shell\"");
    } else {
      remedies.emplace_back("\"Orient\" turns them");
    }
    throw InputError(fmt::format("{} should enclose a volume, but has {}. {}.", heading_,
                                 fmt::join(clauses(open), "; "), fmt::join(remedies, ", or ")));
  }

  /// The bending stiffness of a shell, its area and what it sweeps go by its sides.
  void check_orientation() const {
    OpenFacets open = find_open_facets(mesh_);
    open.lone = open.crowded = {};
    check_input(open.none(), "{} is a shell of two sides, but has {}. \"Orient\" turns them.",
                heading_, fmt::join(clauses(open), "; "));
  }

  void check_volume() const {
    double volume = 0;
    for (const SurfacePart<dim>& part : surface_parts(mesh_))
      volume += std::abs(part.volume);
    Box<dim> box;
    for (const Point<dim>& vertex : mesh_.vertices)
      box.extend(vertex);
    const double size = box.diagonal().norm();
    check_input(
        volume > 1e-10 * std::pow(size, dim),
        "{} is closed but flat: {:g} m across, it encloses {:g} m^{}. Give it a thickness{}.",
        heading_, size, volume, dim,
        demand_.can_be_shell ? ", or take it as a thin shell with \"Thin Shell\"" : "");
  }

  void check_crossing() const {
    const SelfCrossing<dim> crossing = find_self_crossing(mesh_);
    if (crossing.n_pairs == 0)
      return;
    throw InputError(fmt::format(
        "{} should enclose a volume, but crosses itself in {}: first {} and {}, at {}. Repair the "
        "mesh{}.",
        heading_, count_text(crossing.n_pairs, "pair of " + words_, "pairs of " + words_),
        simplex_text(names_, crossing.first, dim), simplex_text(names_, crossing.second, dim),
        point_text<dim>(crossing.place),
        demand_.can_be_shell ? ", or take it as a thin shell with \"Thin Shell\"" : ""));
  }

  void check_senses() {
    const std::vector<SurfacePart<dim>> parts = surface_parts(mesh_);
    const auto n = static_cast<int>(parts.size());
    const SurfacePart<dim>* wrong = nullptr;
    int n_wrong = 0;
    for (const SurfacePart<dim>& part : parts) {
      if (part.faces_right())
        continue;
      wrong = n_wrong++ == 0 ? &part : wrong;
    }
    if (n_wrong == n) {
      for (auto& simplex : mesh_.simplices)
        std::swap(simplex[0], simplex[1]);
      return;
    }
    if (n_wrong == 0 || !from_file())
      return;
    throw InputError(fmt::format(
        "{}: {} of its {} closed parts {} the wrong way; the first, of {}, holds {}. It {}. Turn "
        "its {} around; \"Orient\" does so.",
        heading_, n_wrong, n, n_wrong == 1 ? "faces" : "face",
        count_text(static_cast<int>(wrong->simplices.size()), word_, words_),
        simplex(wrong->simplices.front()),
        wrong->depth % 2 == 1
            ? "lies inside another part, so it bounds a hole and must face into it"
            : "must face outwards, but faces inwards",
        words_));
  }

  SurfaceMesh<dim>& mesh_;
  const SurfaceDemand& demand_;
  const MeshNames& names_;
  std::string heading_, word_, words_;
};

}  // namespace

template <int dim>
bool is_closed(const SurfaceMesh<dim>& mesh) {
  return find_open_facets(mesh).none();
}

template <int dim>
void check_surface(SurfaceMesh<dim>& mesh, const SurfaceDemand& demand, const MeshNames& names) {
  SurfaceChecker<dim>(mesh, demand, names).check();
}

template <int dim>
void check_surface(SurfaceMesh<dim>& mesh, bool closed, const std::string& name) {
  check_surface(mesh, {name, closed, true}, {});
}

template bool is_closed<2>(const SurfaceMesh<2>&);
template bool is_closed<3>(const SurfaceMesh<3>&);
template void check_surface<2>(SurfaceMesh<2>&, const SurfaceDemand&, const MeshNames&);
template void check_surface<3>(SurfaceMesh<3>&, const SurfaceDemand&, const MeshNames&);
template void check_surface<2>(SurfaceMesh<2>&, bool, const std::string&);
template void check_surface<3>(SurfaceMesh<3>&, bool, const std::string&);

}  // namespace lockstep
