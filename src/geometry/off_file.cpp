#include "geometry/file_formats.hpp"
#include "geometry/text_lines.hpp"

namespace lockstep {

namespace {

template <int dim>
void add_face(const std::vector<std::string>& words, const TextLines& lines, SurfaceMesh<dim>& mesh,
              MeshNames& names) {
  const long n = lines.integer(words[0]);
  check_input(n >= dim && (dim == 3 || n == 2), "{}: a face of {} vertices cannot be used in {}D.",
              lines.where(), n, dim);
  check_input(static_cast<long>(words.size()) > n,
              "{}: the face announces {} vertices but lists {}.", lines.where(), n,
              words.size() - 1);
  std::vector<int> corners;
  for (long k = 1; k <= n; ++k) {
    const long v = lines.integer(words[k]);
    check_input(v >= 0 && v < static_cast<long>(mesh.vertices.size()),
                "{}: vertex {} does not exist; the file has {} vertices, counted from 0.",
                lines.where(), v, mesh.vertices.size());
    corners.push_back(static_cast<int>(v));
  }
  for (long k = dim - 1; k < n; ++k) {
    names.simplex_lines.push_back(lines.line());
    if constexpr (dim == 2) {
      mesh.simplices.push_back({corners[0], corners[1]});
    } else {
      mesh.simplices.push_back({corners[0], corners[k - 1], corners[k]});
    }
  }
}

}  // namespace

template <int dim>
SurfaceMesh<dim> read_off(const std::string& file, MeshNames& names) {
  TextLines lines(file);
  std::vector<std::string> words;
  check_input(lines.next(words) && words[0] == "OFF",
              "{}: an OFF file must begin with the word OFF.", file);
  words.erase(words.begin());
  check_input(!words.empty() || lines.next(words), "{}: the file ends after its first line.", file);
  check_input(words.size() >= 2, "{}: expected the numbers of vertices, faces and edges.",
              lines.where());
  const long n_vertices = lines.integer(words[0]), n_faces = lines.integer(words[1]);
  check_input(n_vertices >= 0 && n_faces >= 0, "{}: {} vertices and {} faces cannot be.",
              lines.where(), n_vertices, n_faces);
  lines.check_count(n_vertices);
  lines.check_count(n_faces);

  SurfaceMesh<dim> mesh;
  for (long v = 0; v < n_vertices; ++v) {
    check_input(lines.next(words), "{}: the file ends after {} of {} vertices.", file, v,
                n_vertices);
    check_input(words.size() >= 3, "{}: a vertex needs three coordinates.", lines.where());
    Point<3> x;
    for (int a = 0; a < 3; ++a)
      x[a] = lines.number(words[a]);
    mesh.vertices.push_back(x.template head<dim>());
    names.vertices.push_back(v);
  }
  for (long f = 0; f < n_faces; ++f) {
    check_input(lines.next(words), "{}: the file ends after {} of {} faces.", file, f, n_faces);
    add_face<dim>(words, lines, mesh, names);
  }
  return mesh;
}

template SurfaceMesh<2> read_off<2>(const std::string&, MeshNames&);
template SurfaceMesh<3> read_off<3>(const std::string&, MeshNames&);

}  // namespace lockstep
