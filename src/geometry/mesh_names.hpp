#pragma once
#include <string>
#include <vector>

#include "base/errors.hpp"
#include "base/types.hpp"

namespace lockstep {

/// Names of a mesh file's vertices and simplices, for messages. A generated mesh has no file and
/// counts from 0.
struct MeshNames {
  std::string file;                       ///< empty: generated
  std::string simplex_word;               ///< "facet", "cell"; empty: "triangle" and the like
  std::string vertex_word = "vertex";     ///< "node", "point"
  std::vector<long> vertices, simplices;  ///< numbers in the file; empty: it does not number them
  std::vector<long> simplex_lines;        ///< line numbers in the file, from 1; empty: not known
};

/// "segment", "triangle" or "tetrahedron".
constexpr const char* simplex_word(int n_corners) {
  return n_corners == 2 ? "segment" : n_corners == 3 ? "triangle" : "tetrahedron";
}

/// "(0.5, 0, 1)" [m].
template <int dim>
std::string point_text(const Point<dim>& x) {
  return fmt::format("({:.6g})", fmt::join(x.data(), x.data() + dim, ", "));
}

/// "vertex 7 at (0.5, 0, 1)", or without a number where the file has none.
template <int dim>
std::string vertex_text(const MeshNames& names, int v, const Point<dim>& x) {
  if (!names.file.empty() && names.vertices.empty())
    return fmt::format("the {} at {}", names.vertex_word, point_text<dim>(x));
  return fmt::format("{} {} at {}", names.vertex_word,
                     names.vertices.empty() ? v : names.vertices[v], point_text<dim>(x));
}

/// "facet 7 (line 12)", "the triangle of line 12", "element 7".
inline std::string simplex_text(const MeshNames& names, int s, int n_corners) {
  const std::string word =
      names.simplex_word.empty() ? simplex_word(n_corners) : names.simplex_word;
  const bool has_line = !names.simplex_lines.empty(), has_number = !names.simplices.empty();
  if (has_line && !has_number)
    return fmt::format("the {} of line {}", word, names.simplex_lines[s]);
  const std::string line = has_line ? fmt::format(" (line {})", names.simplex_lines[s]) : "";
  return fmt::format("{} {}{}", word, has_number ? names.simplices[s] : s, line);
}

/// "Surface 'hull' (hull.obj)": `what` is 'Surface' or 'Mesh'.
inline std::string heading_text(const char* what, const std::string& name, const MeshNames& names) {
  return fmt::format("{} '{}'{}", what, name,
                     names.file.empty() ? "" : fmt::format(" ({})", names.file));
}

}  // namespace lockstep
