#include "deformable/mesh/vtk_file.hpp"

#include <algorithm>
#include <fstream>

#include "base/regular_file.hpp"
#include "geometry/text_lines.hpp"
#include "geometry/unused_vertices.hpp"

namespace lockstep {

namespace {

/// Corners of VTK's linear cells by their type; 0 for what is no linear cell.
int corners_of_type(long type) {
  switch (type) {
    case 1:
      return 1;  // vertex
    case 3:
      return 2;  // line
    case 5:
      return 3;  // triangle
    case 10:
      return 4;  // tetrahedron
    default:
      return 0;
  }
}

/// The first three lines: what it is, a title, how it is written.
void check_header(const std::string& file) {
  const std::string refusal = refusal_to_read(file);
  check_input(refusal.empty(),
              "{}: cannot open this mesh file ({}); check its path and permissions.", file,
              refusal);
  std::ifstream stream(file);
  std::string signature, title, format;
  std::getline(stream, signature);
  std::getline(stream, title);
  std::getline(stream, format);
  check_input(signature.rfind("# vtk DataFile Version", 0) == 0,
              "{}: this is no legacy VTK file; save the mesh as .vtk (not .vtu), in ASCII.", file);
  check_input(format.rfind("ASCII", 0) == 0, "{}: the file is binary; save it as ASCII.", file);
}

/// Cells as lists of corners, one after another.
struct Cells {
  std::vector<long> begin{0}, corners;
};

template <int dim, int n_corners>
class VtkReader {
 public:
  explicit VtkReader(const std::string& file) : file_(file), lines_(file) {
    mesh_.names.file = file;
    mesh_.names.simplex_word = "cell";
    mesh_.names.vertex_word = "point";
  }

  Simplices<dim, n_corners> read() {
    while (next() != "ASCII") {
    }
    expect("DATASET");
    expect("UNSTRUCTURED_GRID");
    bool types = false;
    while (!types) {
      const std::string section = next();
      if (section == "POINTS")
        read_points();
      else if (section == "CELLS")
        read_cells();
      else if (section == "CELL_TYPES")
        types = true;  // after CELLS, as VTK demands; what else there is are data
    }
    take_simplices();
    check_input(!mesh_.simplices.empty(), "{}: the file holds no {}.", file_,
                simplex_name(n_corners));
    drop_unused_vertices(mesh_.vertices, mesh_.simplices, mesh_.names.vertices);
    return std::move(mesh_);
  }

 private:
  std::string next() {
    if (word_ == words_.size()) {
      check_input(lines_.next(words_), "{}: the file ends too early.", file_);
      word_ = 0;
    }
    return words_[word_++];
  }
  void expect(const std::string& word) {
    const std::string found = next();
    check_input(found == word, "{}: expected {}, but found '{}'.", lines_.where(), word, found);
  }
  long integer() { return lines_.integer(next()); }
  long count() {
    const long n = integer();
    check_input(n >= 0, "{}: a count is negative: {}.", lines_.where(), n);
    return n;
  }

  void read_points() {
    const long n = count();
    lines_.check_count(n);
    next();  // float or double
    for (long i = 0; i < n; ++i) {
      Point<3> x;
      for (int a = 0; a < 3; ++a)
        x[a] = lines_.number(next());
      check_input(dim == 3 || x[2] == 0,
                  "{}: a mesh of a 2D scene must lie in z = 0, but point {} has z = {}.",
                  lines_.where(), i, x[2]);
      mesh_.vertices.push_back(x.head<dim>());
      mesh_.names.vertices.push_back(i);
    }
  }

  /// Versions up to 4 give the number of corners before each cell, version 5 offsets of all cells.
  void read_cells() {
    const long first = count(), second = count();
    lines_.check_count(first);
    const std::string word = next();
    if (word == "OFFSETS") {
      next();  // type
      cells_.begin.clear();
      for (long i = 0; i < first; ++i)
        cells_.begin.push_back(count());
      expect("CONNECTIVITY");
      next();
      for (long i = 0; i < second; ++i)
        cells_.corners.push_back(count());
      const auto& begin = cells_.begin;
      check_input(!begin.empty() && std::is_sorted(begin.begin(), begin.end()) &&
                      begin.front() == 0 && begin.back() == second,
                  "{}: the offsets of the cells do not fit their corners.", lines_.where());
      return;
    }
    for (long i = 0; i < first; ++i) {
      const long n = i == 0 ? lines_.integer(word) : count();
      for (long k = 0; k < n; ++k)
        cells_.corners.push_back(count());
      cells_.begin.push_back(static_cast<long>(cells_.corners.size()));
    }
  }

  void take_simplices() {
    const long n = count(), n_cells = static_cast<long>(cells_.begin.size()) - 1;
    check_input(n == n_cells, "{}: the file has {} cells, but {} types of cells.", lines_.where(),
                n_cells, n);
    for (long cell = 0; cell < n; ++cell) {
      const long type = integer();
      const int n_own = corners_of_type(type);
      check_input(n_own > 0, "{}: cell {} is of VTK type {}; make a mesh of linear {} only.",
                  lines_.where(), cell, type, simplex_name(n_corners));
      if (n_own == n_corners)
        add_simplex(cell);
    }
  }
  void add_simplex(long cell) {
    check_input(cells_.begin[cell + 1] - cells_.begin[cell] == n_corners,
                "{}: cell {} has {} corners, not {}.", lines_.where(), cell,
                cells_.begin[cell + 1] - cells_.begin[cell], n_corners);
    std::array<int, n_corners> corners;
    for (int k = 0; k < n_corners; ++k) {
      const long point = cells_.corners[cells_.begin[cell] + k];
      check_input(point < static_cast<long>(mesh_.vertices.size()),
                  "{}: cell {} refers to point {}, which is not there.", file_, cell, point);
      corners[k] = static_cast<int>(point);
    }
    mesh_.simplices.push_back(corners);
    mesh_.names.simplices.push_back(cell);
  }

  std::string file_;
  TextLines lines_;
  std::vector<std::string> words_;
  std::size_t word_ = 0;  ///< the next of `words_`
  Cells cells_;
  Simplices<dim, n_corners> mesh_;
};

}  // namespace

template <int dim, int n_corners>
Simplices<dim, n_corners> read_vtk(const std::string& file) {
  check_header(file);
  return VtkReader<dim, n_corners>(file).read();
}

template Simplices<2, 2> read_vtk<2, 2>(const std::string&);
template Simplices<2, 3> read_vtk<2, 3>(const std::string&);
template Simplices<3, 3> read_vtk<3, 3>(const std::string&);
template Simplices<3, 4> read_vtk<3, 4>(const std::string&);

}  // namespace lockstep
