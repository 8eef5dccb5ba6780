#include "deformable/mesh/gmsh_file.hpp"

#include <array>
#include <filesystem>
#include <fstream>
#include <unordered_map>

#include "geometry/text_lines.hpp"
#include "geometry/unused_vertices.hpp"

namespace lockstep {

namespace {

/// Gmsh's number of the linear simplex with so many corners.
constexpr int simplex_type(int n_corners) {
  return n_corners == 2 ? 1 : n_corners == 3 ? 2 : 4;
}

/// Corners of Gmsh's elements of first order; 0: no such type.
int corners_of(long type) {
  constexpr std::array<int, 8> corners = {0, 2, 3, 4, 4, 8, 6, 5};
  return type == 15 ? 1 : type > 0 && type < 8 ? corners[type] : 0;
}

/// Reads one file; `tags` are Gmsh's node numbers, which need not be consecutive.
template <int dim, int n_corners>
class GmshReader {
 public:
  explicit GmshReader(const std::string& file) : file_(file), lines_(file) {
    mesh_.names.file = file;
    mesh_.names.simplex_word = "element";
    mesh_.names.vertex_word = "node";
    check_input(std::filesystem::is_regular_file(file) && std::ifstream(file).good(),
                "{}: cannot open this mesh file; check its path and permissions.", file);
  }

  Simplices<dim, n_corners> read() {
    expect("$MeshFormat");
    next(2);
    const std::string version = words_[0];
    check_input(version == "2.2" || version == "4.1",
                "{}: Gmsh version {} is not known; save the mesh as version 2.2 or 4.1.",
                lines_.where(), version);
    check_input(words_[1] == "0",
                "{}: the file is binary; save it as ASCII (Mesh.Binary = 0 in Gmsh).",
                lines_.where());
    expect("$EndMeshFormat");
    bool nodes = false, elements = false;
    while (lines_.next(words_)) {
      const std::string section = words_[0];
      check_input(section.size() > 1 && section[0] == '$',
                  "{}: expected the start of a section ($...), but found '{}'.", lines_.where(),
                  section);
      const std::string end = "$End" + section.substr(1);
      if (section == "$Nodes") {
        version == "2.2" ? read_nodes_2() : read_nodes_4();
        nodes = true;
        expect(end);
      } else if (section == "$Elements") {
        check_input(nodes, "{}: $Elements comes before $Nodes.", lines_.where());
        version == "2.2" ? read_elements_2() : read_elements_4();
        elements = true;
        expect(end);
      } else {
        skip_to(end);
      }
    }
    check_input(nodes && elements, "{}: the file has no {} section.", file_,
                nodes ? "$Elements" : "$Nodes");
    check_input(!mesh_.simplices.empty(), "{}: the file holds no {}.", file_,
                simplex_name(n_corners));
    drop_unused_vertices(mesh_.vertices, mesh_.simplices, mesh_.names.vertices);
    return std::move(mesh_);
  }

 private:
  void next(std::size_t n_words) {
    check_input(lines_.next(words_), "{}: the file ends too early.", file_);
    check_input(words_.size() >= n_words, "{}: expected at least {} numbers, but found {}.",
                lines_.where(), n_words, words_.size());
  }
  void expect(const std::string& word) {
    next(1);
    check_input(words_[0] == word, "{}: expected {}, but found '{}'.", lines_.where(), word,
                words_[0]);
  }
  void skip_to(const std::string& end) {
    do {
      next(1);
    } while (words_[0] != end);
  }
  long count(std::size_t word) const {
    const long n = lines_.integer(words_[word]);
    lines_.check_count(n);
    return n;
  }

  void add_node(long tag, std::size_t first_word) {
    Point<dim> x;
    for (int a = 0; a < dim; ++a)
      x[a] = lines_.number(words_[first_word + a]);
    if (dim == 2) {
      const double z = lines_.number(words_[first_word + 2]);
      check_input(z == 0, "{}: a mesh of a 2D scene must lie in z = 0, but node {} has z = {}.",
                  lines_.where(), tag, z);
    }
    const bool is_new = numbers_.emplace(tag, static_cast<int>(mesh_.vertices.size())).second;
    check_input(is_new, "{}: node {} occurs twice.", lines_.where(), tag);
    mesh_.vertices.push_back(x);
    mesh_.names.vertices.push_back(tag);
  }
  void read_nodes_2() {
    next(1);
    const long n = count(0);
    for (long i = 0; i < n; ++i) {
      next(4);
      add_node(lines_.integer(words_[0]), 1);
    }
  }
  void read_nodes_4() {
    next(4);
    const long n_blocks = count(0);
    for (long block = 0; block < n_blocks; ++block) {
      next(4);
      const long n = count(3);
      std::vector<long> tags(n);
      for (long& tag : tags) {
        next(1);
        tag = lines_.integer(words_[0]);
      }
      for (const long tag : tags) {
        next(3);
        add_node(tag, 0);
      }
    }
  }

  void add_element(long tag, long type, std::size_t first_word) {
    check_input(corners_of(type) > 0,
                "{}: element {} is of Gmsh type {}, not of first order; save a mesh of order 1.",
                lines_.where(), tag, type);
    const long n_found = static_cast<long>(words_.size()) - static_cast<long>(first_word);
    check_input(n_found == corners_of(type),
                "{}: element {} of Gmsh type {} has {} corners, but must have {}.", lines_.where(),
                tag, type, n_found, corners_of(type));
    const bool too_rich =
        (n_corners >= 3 && type == 3) || (n_corners == 4 && type >= 5 && type < 8);
    check_input(!too_rich, "{}: element {} is no simplex (Gmsh type {}); make a mesh of {} only.",
                lines_.where(), tag, type, n_corners == 4 ? "tetrahedra" : "triangles");
    if (type != simplex_type(n_corners))
      return;
    std::array<int, n_corners> corners;
    for (int k = 0; k < n_corners; ++k) {
      const long node = lines_.integer(words_[first_word + k]);
      const auto found = numbers_.find(node);
      check_input(found != numbers_.end(), "{}: element {} refers to node {}, which is not there.",
                  lines_.where(), tag, node);
      corners[k] = found->second;
    }
    mesh_.simplices.push_back(corners);
    mesh_.names.simplices.push_back(tag);
    mesh_.names.simplex_lines.push_back(lines_.line());
  }
  void read_elements_2() {
    next(1);
    const long n = count(0);
    for (long i = 0; i < n; ++i) {
      next(3);
      add_element(lines_.integer(words_[0]), lines_.integer(words_[1]), 3 + count(2));
    }
  }
  void read_elements_4() {
    next(4);
    const long n_blocks = count(0);
    for (long block = 0; block < n_blocks; ++block) {
      next(4);
      const long type = count(2), n = count(3);
      for (long i = 0; i < n; ++i) {
        next(2);
        add_element(lines_.integer(words_[0]), type, 1);
      }
    }
  }

  std::string file_;
  TextLines lines_;
  std::vector<std::string> words_;
  std::unordered_map<long, int> numbers_;
  Simplices<dim, n_corners> mesh_;
};

}  // namespace

template <int dim, int n_corners>
Simplices<dim, n_corners> read_gmsh(const std::string& file) {
  return GmshReader<dim, n_corners>(file).read();
}

template Simplices<2, 2> read_gmsh<2, 2>(const std::string&);
template Simplices<2, 3> read_gmsh<2, 3>(const std::string&);
template Simplices<3, 3> read_gmsh<3, 3>(const std::string&);
template Simplices<3, 4> read_gmsh<3, 4>(const std::string&);

}  // namespace lockstep
