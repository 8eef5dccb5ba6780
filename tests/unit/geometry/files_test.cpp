// Readers of surface files.
#include <gmock/gmock.h>

#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>

#include "base/errors.hpp"
#include "geometry/mesh_files.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

class SurfaceFiles : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = std::filesystem::temp_directory_path() /
              ("lockstep-surface-files-" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }

  std::string write(const std::string& name, const std::string& text) {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  template <int dim>
  std::string error_of(const std::string& name, const std::string& text) {
    try {
      read_surface<dim>(write(name, text));
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  std::filesystem::path folder_;
};

/// The tetrahedron with corners 0, e_x, e_y, e_z: volume 1/6.
void expect_tetrahedron(const SurfaceMesh<3>& mesh) {
  EXPECT_EQ(mesh.vertices.size(), 4u);
  EXPECT_EQ(mesh.simplices.size(), 4u);
  EXPECT_TRUE(is_closed(mesh));
  EXPECT_NEAR(volume_properties(mesh).measure, 1 / 6.0, 1e-15);
}

TEST_F(SurfaceFiles, Obj) {
  expect_tetrahedron(read_surface<3>(
      write("a.obj",
            "# tetrahedron\nmtllib none.mtl\no body\nv 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
            "f 2 4 3\nf 2//1 3//1 5//1\nf -4 -1 -2\nf 3 4 5\nvn 0 0 1\n")));
  const auto square =
      read_surface<3>(write("q.obj", "v 0 0 0.1\nv 1 0 .1\nv 1 1 .1\nv 0 1 .1\nf 1 2 3 4\n"));
  EXPECT_EQ(square.simplices.size(), 2u);
  EXPECT_EQ(square.vertices[0].z(), 0.1);  // read in double precision
  const auto line = read_surface<2>(write("l.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\nl 3 1\n"));
  EXPECT_NEAR(volume_properties(line).measure, 0.5, 1e-15);
}

TEST_F(SurfaceFiles, Off) {
  expect_tetrahedron(read_surface<3>(write("a.off",
                                           "OFF\n# comment\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 "
                                           "2 1\n3 0 1 3 255 0 0\n3 0 3 2\n3 1 2 3\n")));
  const auto line =
      read_surface<2>(write("l.off", "OFF 3 3 0\n0 0 0\n1 0 0\n1 1 0\n2 0 1\n2 1 2\n2 2 0\n"));
  EXPECT_NEAR(volume_properties(line).measure, 0.5, 1e-15);
}

const char* const ascii_tetrahedron =
    "solid t\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 1 0\nvertex 1 0 0\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 1\nvertex 0 1 0\nendloop\nendfacet\n"
    "facet normal 0 0 0\nouter loop\nvertex 1 0 -0\nvertex 0 1 0\nvertex 0 0 1\nendloop\nendfacet\n"
    "endsolid t\n";

TEST_F(SurfaceFiles, Stl) {
  const auto mesh = read_surface<3>(write("a.STL", ascii_tetrahedron));
  expect_tetrahedron(mesh);
  std::string binary(80, ' ');
  binary.replace(0, 5, "solid");
  const auto append = [&](const auto& value) {
    binary.append(reinterpret_cast<const char*>(&value), sizeof value);
  };
  append(std::uint32_t{4});
  for (const auto& triangle : mesh.simplices) {
    for (int a = 0; a < 3; ++a)
      append(0.0f);
    for (const int v : triangle)
      for (int a = 0; a < 3; ++a)
        append(static_cast<float>(mesh.vertices[v][a]));
    append(std::uint16_t{0});
  }
  expect_tetrahedron(read_surface<3>(write("b.stl", binary)));
  binary[0] = 'x';
  binary.resize(binary.size() - 10);
  EXPECT_THAT(error_of<3>("c.stl", binary), HasSubstr("truncated"));
}

TEST_F(SurfaceFiles, ErrorsNameFileAndLine) {
  EXPECT_THAT(error_of<3>("a.obj", "v 0 0 0\nv 1 0\n"), HasSubstr("a.obj, line 2"));
  EXPECT_THAT(error_of<3>("a.obj", "v 0 x 0\n"), AllOf(HasSubstr("line 1"), HasSubstr("'x'")));
  EXPECT_THAT(error_of<3>("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"),
              AllOf(HasSubstr("line 4"), HasSubstr("vertex 4")));
  EXPECT_THAT(error_of<3>("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"), HasSubstr("line 4"));
  EXPECT_THAT(error_of<3>("a.obj", "v 0 0 0\n"), HasSubstr("holds no triangles"));
  EXPECT_THAT(error_of<3>("a.obj", "v 0 " + std::string(10000, 'x') + " 0\n"),
              AllOf(HasSubstr("line 1"), HasSubstr("x...'"), testing::SizeIs(testing::Lt(300u))));
  EXPECT_THAT(error_of<3>("a.off", "OFT\n"), HasSubstr("word OFF"));
  EXPECT_THAT(error_of<3>("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 7\n"),
              AllOf(HasSubstr("line 6"), HasSubstr("vertex 7")));
  EXPECT_THAT(error_of<3>("a.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n"), HasSubstr("0 of 1 faces"));
  EXPECT_THAT(error_of<3>("a.stl", "solid\nfacet normal 0 0 1\nvertex 0 0 0\n"),
              AllOf(HasSubstr("line 3"), HasSubstr("outer loop")));
  EXPECT_THAT(error_of<2>("a.stl", "solid\n"), HasSubstr("segments"));
  EXPECT_THROW(read_surface<3>((folder_ / "missing.obj").string()), InputError);
}

TEST_F(SurfaceFiles, MessagesNameCommandsThatMakeStl) {
  for (const char* kind : {"ply", "gltf", "glb", "dae"}) {
    const std::string name = std::string("a.") + kind;
    EXPECT_THAT(error_of<3>(name, "\n"),
                AllOf(HasSubstr(std::string("'.") + kind + "'; use .obj, .off or .stl"),
                      HasSubstr("\"assimp export " + name + " a.stl\"")));
  }
  EXPECT_THAT(error_of<3>("a.STEP", "\n"), HasSubstr("\"gmsh -2 a.STEP -o a.stl\""));
  EXPECT_THAT(error_of<3>("a.msh", "\n"), HasSubstr("\"gmsh -0 a.msh -o a.stl\""));
  EXPECT_THAT(error_of<3>("a.txt", "\n"), testing::EndsWith("use .obj, .off or .stl."));
  EXPECT_THAT(error_of<2>("a.ply", "\n"), testing::EndsWith("use .obj, .off or (3D) .stl."));
}

TEST_F(SurfaceFiles, NumbersMustBeFiniteAndIndicesSmall) {
  const std::string face = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf ";
  for (const char* wrong : {"nan", "inf", "-inf", "NaN", "1e999", "0x10", "1,5", "1.5.", "e5"}) {
    const std::string found = std::string("'") + wrong + "'";
    for (const char* vertex : {"v W 0 0", "v 0 W 0", "v 0 0 W"}) {
      std::string text = vertex;
      text.replace(text.find('W'), 1, wrong);
      EXPECT_THAT(error_of<3>("n.obj", "# one\n" + text + "\n" + face + "1 2 3\n"),
                  AllOf(HasSubstr("n.obj, line 2"), HasSubstr(found)));
      EXPECT_THAT(error_of<2>("n.off", "OFF 3 1 0\n" + text.substr(2) + "\n"),
                  AllOf(HasSubstr("n.off, line 2"), HasSubstr(found)));
      EXPECT_THAT(error_of<3>("n.stl", "solid\nfacet normal 0 0 1\nouter loop\nvertex" +
                                           text.substr(1) + "\n"),
                  AllOf(HasSubstr("n.stl, line 4"), HasSubstr(found)));
    }
  }
  for (const char* wrong :
       {"99999999999999999999", "4294967297", "1.5", "/1", "1/x", "1//", "x", "0x1"})
    EXPECT_THAT(error_of<3>("n.obj", face + "2 3 " + wrong + "\n"),
                AllOf(HasSubstr("n.obj, line 4"), HasSubstr(std::string("'") + wrong + "'")))
        << wrong;
  EXPECT_THAT(error_of<3>("n.off", "OFF\n-3 1 0\n"), HasSubstr("line 2"));
  EXPECT_THAT(error_of<3>("n.off", "OFF\n99999999999999999999 1 0\n"), HasSubstr("line 2"));
  std::string binary(80, ' ');
  const std::uint32_t n_facets = 1;
  binary.append(reinterpret_cast<const char*>(&n_facets), 4);
  for (int k = 0; k < 12; ++k) {
    const float value = k == 7 ? NAN : static_cast<float>(k);
    binary.append(reinterpret_cast<const char*>(&value), 4);
  }
  EXPECT_THAT(error_of<3>("n.stl", binary + "  "), AllOf(HasSubstr("facet 1"), HasSubstr("nan")));
  std::filesystem::create_directories(folder_ / "folder.obj");
  EXPECT_THROW(read_surface<3>((folder_ / "folder.obj").string()), InputError);
}

}  // namespace
}  // namespace lockstep::test
