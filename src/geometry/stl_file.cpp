#include <cstdint>
#include <cstring>
#include <filesystem>
#include <map>

#include "geometry/file_formats.hpp"
#include "geometry/text_lines.hpp"

namespace lockstep {

namespace {

/// Gives corners at the very same place one vertex.
class CornerMerger {
 public:
  void add_triangle(const std::array<std::array<double, 3>, 3>& corners) {
    std::array<int, 3> triangle;
    for (int k = 0; k < 3; ++k) {
      const std::array<double, 3>& x = corners[k];
      const auto [entry, is_new] = known_.emplace(x, static_cast<int>(mesh_.vertices.size()));
      if (is_new)
        mesh_.vertices.emplace_back(x[0], x[1], x[2]);
      triangle[k] = entry->second;
    }
    mesh_.simplices.push_back(triangle);
  }
  SurfaceMesh<3> take() { return std::move(mesh_); }

 private:
  std::map<std::array<double, 3>, int> known_;
  SurfaceMesh<3> mesh_;
};

constexpr std::size_t header_size = 80, count_size = 4, facet_size = 50;

/// 80 bytes of anything, the count, then 50 bytes a facet (normal, three corners, attributes).
SurfaceMesh<3> read_binary(const std::string& file, std::uint32_t n_facets, MeshNames& names) {
  std::ifstream stream(file, std::ios::binary);
  stream.seekg(header_size + count_size);
  CornerMerger merger;
  for (std::uint32_t f = 0; f < n_facets; ++f) {
    char record[facet_size];
    check_input(static_cast<bool>(stream.read(record, facet_size)),
                "{}: the file ends in facet {} of {}.", file, f + 1, n_facets);
    float values[12];
    std::memcpy(values, record, sizeof values);
    std::array<std::array<double, 3>, 3> corners;
    for (int k = 0; k < 3; ++k)
      for (int a = 0; a < 3; ++a) {
        corners[k][a] = values[3 + 3 * k + a];
        check_input(std::isfinite(corners[k][a]),
                    "{}: facet {} of {} has the coordinate {}, which is not a finite number.", file,
                    f + 1, n_facets, corners[k][a]);
      }
    merger.add_triangle(corners);
    names.simplices.push_back(f + 1);
  }
  return merger.take();
}

class AsciiReader {
 public:
  AsciiReader(const std::string& file, MeshNames& names)
      : file_(file), lines_(file), names_(names) {}

  SurfaceMesh<3> read() {
    CornerMerger merger;
    expect({"solid"});
    while (true) {
      next("'facet' or 'endsolid'");
      if (words_[0] == "endsolid") {
        // Several solids may follow each other in one file.
        if (!lines_.next(words_))
          return merger.take();
        require({"solid"});
        continue;
      }
      require({"facet", "normal"});
      names_.simplex_lines.push_back(lines_.line());
      expect({"outer", "loop"});
      std::array<std::array<double, 3>, 3> corners;
      for (auto& corner : corners) {
        expect({"vertex"});
        check_input(words_.size() == 4, "{}: a vertex needs three coordinates.", lines_.where());
        for (int a = 0; a < 3; ++a)
          corner[a] = lines_.number(words_[a + 1]);
      }
      expect({"endloop"});
      expect({"endfacet"});
      merger.add_triangle(corners);
      check_mesh_entries(lines_.where(), names_.simplex_lines.size());
    }
  }

 private:
  void next(const std::string& expected) {
    check_input(lines_.next(words_), "{}: the file ends where {} is expected.", file_, expected);
  }
  void expect(const std::vector<std::string>& expected) {
    next(fmt::format("'{}'", fmt::join(expected, " ")));
    require(expected);
  }
  void require(const std::vector<std::string>& expected) const {
    bool same = words_.size() >= expected.size();
    for (std::size_t k = 0; same && k < expected.size(); ++k)
      same = words_[k] == expected[k];
    check_input(same, "{}: expected '{}', but found '{}'.", lines_.where(),
                fmt::join(expected, " "), shortened(words_[0]));
  }

  std::string file_;
  TextLines lines_;
  MeshNames& names_;
  std::vector<std::string> words_;
};

}  // namespace

SurfaceMesh<3> read_stl(const std::string& file, MeshNames& names) {
  names.simplex_word = "facet";
  const std::uintmax_t size = std::filesystem::file_size(file);
  std::ifstream stream(file, std::ios::binary);
  char start[header_size + count_size] = {};
  stream.read(start, sizeof start);
  std::uint32_t n_facets = 0;
  std::memcpy(&n_facets, start + header_size, sizeof n_facets);
  // Binary files may begin with "solid" too, so the size decides first.
  if (size == header_size + count_size + facet_size * std::uintmax_t{n_facets}) {
    check_mesh_entries(file, n_facets);
    return read_binary(file, n_facets, names);
  }
  if (std::strncmp(start, "solid", 5) == 0)
    return AsciiReader(file, names).read();
  check_input(
      size > sizeof start,
      "{}: neither an ASCII STL file (no 'solid' at its start) nor a binary one (shorter than "
      "its header).",
      file);
  throw InputError(fmt::format(
      "{}: a binary STL file of {} facets must have {} bytes, but this one "
      "has {}; it is truncated or not an STL file.",
      file, n_facets, header_size + count_size + facet_size * std::uintmax_t{n_facets}, size));
}

}  // namespace lockstep
