// Volume meshes: generators, surfaces, checks, Gmsh and VTK files.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "base/errors.hpp"
#include "deformable/mesh/hollow_generators.hpp"
#include "deformable/mesh/mesh_file.hpp"
#include "deformable/mesh/volume_generators.hpp"
#include "support.hpp"

namespace lockstep::test {
namespace {

using ::testing::HasSubstr;

template <int dim>
double worst_quality(const VolumeMesh<dim>& mesh) {
  double worst = 1;
  for (std::size_t e = 0; e < mesh.elements.size(); ++e)
    worst = std::min(worst, element_quality(mesh, static_cast<int>(e)));
  return worst;
}

/// The mesh passes its checks, and its surface is closed and encloses the volume of the elements.
template <int dim>
void expect_sound(VolumeMesh<dim> mesh, double volume, double quality) {
  check_volume_mesh(mesh, "mesh");
  EXPECT_NEAR(mesh_volume(mesh), volume, 1e-12 * volume);
  EXPECT_GE(worst_quality(mesh), quality);
  auto boundary = extract_surface(mesh, "mesh");
  EXPECT_TRUE(is_closed(boundary.surface));
  EXPECT_NEAR(volume_properties(boundary.surface).measure, volume, 1e-12 * volume);
  for (std::size_t v = 0; v < boundary.vertices.size(); ++v)
    EXPECT_EQ(boundary.surface.vertices[v], mesh.vertices[boundary.vertices[v]]);
}

TEST(VolumeMesh, OneTetrahedron) {
  VolumeMesh<3> mesh{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 1, 2, 3}}};
  EXPECT_DOUBLE_EQ(element_volume(mesh, 0), 1. / 6);
  const auto boundary = extract_surface(mesh, "one");
  ASSERT_EQ(boundary.surface.simplices.size(), 4u);
  EXPECT_NEAR(volume_properties(boundary.surface).measure, 1. / 6, 1e-15);
}

TEST(VolumeMesh, RegularSimplicesHaveQualityOne) {
  const VolumeMesh<2> triangle{{{0, 0}, {1, 0}, {0.5, std::sqrt(0.75)}}, {{0, 1, 2}}};
  EXPECT_NEAR(element_quality(triangle, 0), 1, 1e-14);
  const VolumeMesh<3> tetrahedron{{{1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1}},
                                  {{0, 1, 2, 3}}};
  EXPECT_NEAR(std::abs(element_quality(tetrahedron, 0)), 1, 1e-14);
}

TEST(VolumeMesh, GeneratorsFillTheirShapes) {
  expect_sound(box_volume<2>({3, 1}, 0.25), 3, 0.8);
  expect_sound(box_volume<3>({2, 1, 0.5}, 0.25), 1, 0.5);
  expect_sound(ball_volume<2>(0.5, 0.1), pi / 4, 0.7);
  expect_sound(ball_volume<3>(0.5, 0.15), pi / 6, 0.35);
  expect_sound(cylinder_volume<2>(0.5, 2, 0.2), 2, 0.8);
  expect_sound(torus_volume<3>(1, 0.3, 0.15), 2 * pi * pi * 0.09, 0.2);
  expect_sound(hollow_ball_volume<2>(0.5, 0.1, 0.1), pi * 0.09, 0.6);
  expect_sound(hollow_ball_volume<3>(0.5, 0.2, 0.15), 4 * pi / 3 * (0.125 - 0.027), 0.2);
  expect_sound(tube_volume<3>(0.5, 0.2, 1, 0.15), pi * 0.16, 0.2);
  auto cylinder = cylinder_volume<3>(0.5, 2, 0.2);
  expect_sound(cylinder, pi / 2, 0.2);
}

/// Half a wedge and a box; a cone that begins and ends with an ellipse.
TEST(VolumeMesh, Spindles) {
  expect_sound(spindle_volume<2>({{-1, 0, 2}, {0.25, 0.75, 0.75}, {}}, 0.25), 4, 0.4);
  auto cone = spindle_volume<3>({{1, 2}, {0.4, 0.4}, {0.1, 0.2}}, 0.1);
  check_volume_mesh(cone, "cone");
  EXPECT_NEAR(mesh_volume(cone), pi * 0.4 * 0.15, 1e-3 * pi * 0.4 * 0.15);
  EXPECT_GE(worst_quality(cone), 0.05);
  Box<3> bounds;
  for (const auto& x : cone.vertices)
    bounds.extend(x);
  EXPECT_DOUBLE_EQ(bounds.min().x(), 1);
  EXPECT_DOUBLE_EQ(bounds.max().x(), 2);
  EXPECT_GT(bounds.sizes().y(), 3 * bounds.sizes().z() / 2);
  EXPECT_THAT(error([] {
                spindle_volume<2>({{0, 0}, {1, 1}, {}}, 0.1);
              }),
              HasSubstr("must ascend"));
  EXPECT_THAT(error([] { spindle_volume<3>({{0, 1}, {1, 1}, {1}}, 0.1); }), HasSubstr("as many"));
}

TEST(VolumeMesh, BadElementsAreNamed) {
  auto mesh = box_volume<2>({1, 1}, 0.5);
  const auto sound = mesh;
  std::swap(mesh.elements[3][0], mesh.elements[3][1]);
  EXPECT_THAT(test::error([&] { check_volume_mesh(mesh, "plate"); }),
              AllOf(HasSubstr("'plate'"), HasSubstr("element 3 about"), HasSubstr("is inverted"),
                    HasSubstr("one of 1 of"), HasSubstr("\"Orient\"")));
  mesh = sound;
  for (auto& element : mesh.elements)
    std::swap(element[0], element[1]);
  check_volume_mesh(mesh, "plate");  // all of them: turned around
  EXPECT_NEAR(mesh_volume(mesh), 1, 1e-14);
  mesh.vertices[mesh.elements[5][2]] =
      0.5 * (mesh.vertices[mesh.elements[5][0]] + mesh.vertices[mesh.elements[5][1]]) +
      1e-6 * (mesh.vertices[mesh.elements[5][2]] - mesh.vertices[mesh.elements[5][0]]);
  EXPECT_THAT(test::error([&] { check_volume_mesh(mesh, "plate"); }), HasSubstr("element"));
  mesh = sound;
  mesh.vertices.push_back({9, 9});
  EXPECT_THAT(test::error([&] { check_volume_mesh(mesh, "plate"); }),
              HasSubstr("belongs to no element"));
  mesh = sound;
  mesh.elements[2][1] = 77;
  EXPECT_THAT(test::error([&] { check_volume_mesh(mesh, "plate"); }),
              HasSubstr("element 2 refers to vertex 77"));
  mesh = sound;
  mesh.elements.push_back(mesh.elements[0]);
  mesh.elements.push_back(mesh.elements[0]);
  EXPECT_THAT(test::error([&] { extract_surface(mesh, "plate"); }), HasSubstr("share one side"));
}

template <int dim>
VolumeMesh<dim> read_volume(const std::string& file) {
  MeshNames names;
  return read_volume_mesh<dim>(file, names);
}
template <int dim>
SurfaceMesh<dim> read_shell(const std::string& file) {
  MeshNames names;
  return read_shell_mesh<dim>(file, names);
}

class MeshFile : public ::testing::Test {
 protected:
  explicit MeshFile(const std::string& extension)
      : path_(::testing::TempDir() + "mesh" + std::to_string(test::world()->getRank()) +
              extension) {}
  std::string write(const std::string& text) {
    std::ofstream(path_) << text;
    return path_;
  }
  ~MeshFile() override { std::filesystem::remove(path_); }
  std::string path_;
};
struct GmshFile : MeshFile {
  GmshFile() : MeshFile(".msh") {}
};
struct VtkFile : MeshFile {
  VtkFile() : MeshFile(".vtk") {}
};

TEST_F(GmshFile, Version2) {
  const auto mesh = read_volume<3>(
      write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames\n1\n3 1 \"body\"\n"
            "$EndPhysicalNames\n$Nodes\n5\n7 0 0 0\n2 1 0 0\n3 0 1 0\n4 0 0 1\n9 5 5 5\n$EndNodes\n"
            "$Elements\n2\n1 2 2 1 1 7 2 3\n2 4 2 1 1 7 2 3 4\n$EndElements\n"));
  ASSERT_EQ(mesh.elements.size(), 1u);
  ASSERT_EQ(mesh.vertices.size(), 4u);  // node 9 is used by nobody
  EXPECT_NEAR(mesh_volume(mesh), 1. / 6, 1e-15);
  EXPECT_EQ(read_shell<3>(path_).simplices.size(), 1u);
}

const char* const square_of_version_4 =
    "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$Entities\n0 0 1 0\n1 0 0 0 1 1 0 0 0\n$EndEntities\n"
    "$Nodes\n2 4 1 4\n2 1 0 2\n1\n2\n0 0 0\n1 0 0\n2 1 0 2\n3\n4\n1 1 0\n0 1 0\n$EndNodes\n"
    "$Elements\n2 3 1 3\n1 1 1 1\n1 1 2\n2 1 2 2\n2 1 2 3\n3 1 3 4\n$EndElements\n";

TEST_F(GmshFile, Version4) {
  const auto mesh = read_volume<2>(write(square_of_version_4));
  ASSERT_EQ(mesh.elements.size(), 2u);
  EXPECT_NEAR(mesh_volume(mesh), 1, 1e-15);
  EXPECT_EQ(read_shell<2>(path_).simplices.size(), 1u);
}

TEST_F(GmshFile, DefectsAreNamedAsInTheFile) {
  MeshNames names;
  auto mesh = read_volume_mesh<2>(
      write("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n5\n99 8 8 0\n11 0 0 0\n12 1 0 0\n13 1 "
            "1 0\n14 0 1 0\n$EndNodes\n$Elements\n2\n21 2 0 11 12 13\n25 2 0 11 14 13\n"
            "$EndElements\n"),
      names);
  EXPECT_EQ(names.vertices, (std::vector<long>{11, 12, 13, 14}));
  EXPECT_THAT(test::error([&] { check_volume_mesh(mesh, "plate", 1e-4, names); }),
              AllOf(HasSubstr(path_), HasSubstr("element 25 (line 15) about (0.333333, 0.666667)"),
                    HasSubstr("one of 1 of 2")));
}

TEST_F(GmshFile, ErrorsNameTheLine) {
  EXPECT_THAT(test::error([&] { read_volume<2>("no/such.msh"); }), HasSubstr("cannot open"));
  EXPECT_THAT(test::error([&] { read_volume<2>(write("$MeshFormat\n2.2 1 8\n$EndMeshFormat\n")); }),
              AllOf(HasSubstr("line 2"), HasSubstr("binary")));
  EXPECT_THAT(test::error([&] { read_volume<3>(write(square_of_version_4)); }),
              HasSubstr("no tetrahedra"));
  std::string broken = square_of_version_4;
  broken.replace(broken.find("3 1 3 4"), 7, "3 1 3 8");
  EXPECT_THAT(test::error([&] { read_volume<2>(write(broken)); }),
              AllOf(HasSubstr("element 3"), HasSubstr("node 8")));
  broken.resize(broken.size() - 20);
  EXPECT_THAT(test::error([&] { read_volume<2>(write(broken)); }), HasSubstr("line 27"));
}

TEST(MeshFiles, MessagesNameCommandsOfGmsh) {
  const auto refusal = [](const std::string& file) {
    return test::error([&] { read_volume<3>(file); });
  };
  EXPECT_THAT(refusal("parts/hull.STEP"), AllOf(HasSubstr("parts/hull.STEP: unknown kind"),
                                                HasSubstr("\"gmsh -3 hull.STEP -o hull.msh\"")));
  EXPECT_THAT(test::error([&] { read_volume<2>("disc.geo"); }),
              HasSubstr("\"gmsh -2 disc.geo -o disc.msh\""));
  EXPECT_THAT(refusal("hull.stl"),
              AllOf(HasSubstr("\"gmsh -3 hull.geo -o hull.msh\" makes of a file hull.geo"),
                    HasSubstr("'Merge \"hull.stl\"; Surface Loop(1) = {1}; Volume(1) = {1};'"),
                    Not(HasSubstr("assimp"))));
  EXPECT_THAT(refusal("hull.obj"),
              AllOf(HasSubstr("after \"assimp export hull.obj hull.stl\""), HasSubstr("hull.geo")));
  EXPECT_THAT(refusal("hull.txt"), testing::EndsWith("'.txt'; use .vtk or .msh."));
}

const std::string vtk_header = "# vtk DataFile Version 3.0\na title\nASCII\n";
const std::string vtk_points =
    "DATASET UNSTRUCTURED_GRID\nPOINTS 5 double\n0 0 0 1 0 0\n1 1 0 0 1 0 9 9 0\n";

TEST_F(VtkFile, CountsBeforeCells) {
  const auto mesh = read_volume<2>(
      write(vtk_header + vtk_points +
            "CELLS 3 11\n2 0 1\n3 0 1 2\n3 0 2 3\nCELL_TYPES 3\n3\n5 5\nPOINT_DATA 5\n"));
  ASSERT_EQ(mesh.elements.size(), 2u);
  ASSERT_EQ(mesh.vertices.size(), 4u);  // the fifth is used by nobody
  EXPECT_NEAR(mesh_volume(mesh), 1, 1e-15);
  EXPECT_EQ(read_shell<2>(path_).simplices.size(), 1u);
}

TEST_F(VtkFile, OffsetsOfVersion5) {
  const auto mesh = read_volume<3>(
      write("# vtk DataFile Version 5.1\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 4 float\n"
            "0 0 0 1 0 0 0 1 0 0 0 1\nMETADATA\nINFORMATION 0\n\nCELLS 3 7\n"
            "OFFSETS vtktypeint64\n0 3 7\nCONNECTIVITY vtktypeint64\n0 1 2 0 1 2 3\n"
            "CELL_TYPES 2\n5\n10\n"));
  ASSERT_EQ(mesh.elements.size(), 1u);
  EXPECT_NEAR(mesh_volume(mesh), 1. / 6, 1e-15);
  EXPECT_EQ(read_shell<3>(path_).simplices.size(), 1u);
}

TEST_F(VtkFile, ErrorsNameTheLine) {
  const auto error_of = [&](const std::string& content) {
    return test::error([&] { read_volume<2>(write(content)); });
  };
  EXPECT_THAT(error_of("<?xml version=\"1.0\"?>\n"), HasSubstr("no legacy VTK file"));
  EXPECT_THAT(error_of("# vtk DataFile Version 3.0\nx\nBINARY\n"), HasSubstr("is binary"));
  const std::string start = vtk_header + vtk_points;
  EXPECT_THAT(error_of(start + "CELLS 1 4\n3 0 1 7\nCELL_TYPES 1\n5\n"),
              HasSubstr("point 7, which is not there"));
  EXPECT_THAT(error_of(start + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n9\n"),
              AllOf(HasSubstr("line 11"), HasSubstr("VTK type 9"), HasSubstr("triangles")));
  EXPECT_THAT(error_of(start + "CELLS 2 8\n3 0 1 2\n3 0 2 3\nCELL_TYPES 1\n5\n"),
              HasSubstr("2 cells, but 1 types"));
  EXPECT_THAT(error_of(start + "CELLS 1 4\n3 0 one 2\n"),
              AllOf(HasSubstr("line 9"), HasSubstr("'one'")));
  EXPECT_THAT(error_of(start + "CELLS 1 4\n3 0"), HasSubstr("ends too early"));
}

}  // namespace
}  // namespace lockstep::test
