#include <tiny_obj_loader.h>

#include "geometry/file_formats.hpp"
#include "geometry/text_lines.hpp"

namespace lockstep {

namespace {

/// The numbers of a corner: "vertex", "vertex/texture", "vertex//normal" or all three. Gives the
/// vertex.
long vertex_of(const std::string& word, const TextLines& lines) {
  const std::size_t slash = word.find('/');
  for (std::size_t begin = slash; begin != std::string::npos;) {
    const std::size_t end = word.find('/', begin + 1);
    const std::string part = word.substr(begin + 1, end - begin - 1);
    if (!part.empty() || end == std::string::npos)
      lines.integer(part, word);
    begin = end;
  }
  return lines.integer(word.substr(0, slash), word);
}

/// Lines of the simplices that records 'f' (3D) or 'l' (2D) are split into.
template <int dim>
void add_lines(const std::string& record, std::size_t n_vertices, int line,
               std::vector<long>& lines) {
  if (record == (dim == 2 ? "l" : "f"))
    lines.insert(lines.end(), n_vertices - dim + 1, line);
}

/// Refuses what tinyobjloader lets pass: coordinates that are no numbers, which it reads as 0, and
/// indices of no vertex.
template <int dim>
void check_records(const std::string& file, MeshNames& names) {
  TextLines lines(file);
  std::vector<std::string> words;
  long n_vertices = 0;
  std::vector<std::pair<long, std::string>> references;  // vertices may follow the faces
  while (lines.next(words)) {
    if (words[0] == "v") {
      check_input(words.size() >= 4, "{}: a vertex needs three coordinates.", lines.where());
      for (std::size_t k = 1; k < words.size(); ++k)
        lines.number(words[k]);
      names.vertices.push_back(++n_vertices);
      check_mesh_entries(lines.where(), names.vertices.size());
    } else if (words[0] == "f" || words[0] == "l") {
      const std::size_t n_needed = words[0] == "f" ? 3 : 2;
      check_input(words.size() > n_needed, "{}: a record '{}' needs at least {} vertices.",
                  lines.where(), words[0], n_needed);
      add_lines<dim>(words[0], words.size() - 1, lines.line(), names.simplex_lines);
      check_mesh_entries(lines.where(), names.simplex_lines.size());
      for (std::size_t k = 1; k < words.size(); ++k) {
        const long v = vertex_of(words[k], lines);
        check_input(v > 0 || (v < 0 && v >= -n_vertices),
                    "{}: vertex {} does not exist (vertices count from 1, or from -1 backwards).",
                    lines.where(), v);
        references.emplace_back(v, lines.where());
      }
    }
  }
  for (const auto& [v, where] : references)
    check_input(v <= n_vertices, "{}: vertex {} does not exist; the file has {} vertices.", where,
                v, n_vertices);
}

}  // namespace

template <int dim>
SurfaceMesh<dim> read_obj(const std::string& file, MeshNames& names) {
  check_records<dim>(file, names);
  tinyobj::attrib_t attributes;
  std::vector<tinyobj::shape_t> shapes;
  std::vector<tinyobj::material_t> materials;
  std::string warning, error;
  std::ifstream stream(file);
  const bool done = tinyobj::LoadObj(&attributes, &shapes, &materials, &warning, &error, &stream,
                                     nullptr, true, false);
  check_input(done && error.empty(), "{}: not a valid OBJ file: {}", file, error);

  SurfaceMesh<dim> mesh;
  for (std::size_t v = 0; 3 * v < attributes.vertices.size(); ++v) {
    Point<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = attributes.vertices[3 * v + a];
    mesh.vertices.push_back(x);
  }
  for (const tinyobj::shape_t& shape : shapes) {
    if constexpr (dim == 2) {
      std::size_t begin = 0;
      for (const int n : shape.lines.num_line_vertices) {
        for (int k = 0; k + 1 < n; ++k)
          mesh.simplices.push_back({shape.lines.indices[begin + k].vertex_index,
                                    shape.lines.indices[begin + k + 1].vertex_index});
        begin += n;
      }
    } else {
      const auto& indices = shape.mesh.indices;
      for (std::size_t k = 0; k + 2 < indices.size(); k += 3)
        mesh.simplices.push_back(
            {indices[k].vertex_index, indices[k + 1].vertex_index, indices[k + 2].vertex_index});
    }
  }
  // A polygon that is no proper one may give fewer triangles.
  if (names.simplex_lines.size() != mesh.simplices.size())
    names.simplex_lines.clear();
  return mesh;
}

template SurfaceMesh<2> read_obj<2>(const std::string&, MeshNames&);
template SurfaceMesh<3> read_obj<3>(const std::string&, MeshNames&);

}  // namespace lockstep
