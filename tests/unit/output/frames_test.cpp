#include "output/frames.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <limits>

#include "base/errors.hpp"
#include "output/atomic_file.hpp"
#include "test_folder.hpp"

namespace lockstep::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// A 4 x 4 x 2 box (4 x 4 in 2D) in tiles of 2 x 2 x 2 (2 x 2), dealt to the ranks in turn; the
/// tile at the far corner does not exist. Pressure 1000 number + i + 10 j + 100 k, velocity (i, j,
/// k).
BoxFrame make_box(int dimension, int number) {
  const Communicator comm = Tpetra::getDefaultComm();
  BoxFrame box;
  box.dimension = dimension;
  box.origin = {-1, -2, -3};
  box.spacing = {0.5, 0.25, 0.125};
  const int depth = dimension == 2 ? 1 : 2;
  box.n_cells = {4, 4, depth};
  int tile = 0;
  for (const auto& [x, y] : {std::pair(2, 0), std::pair(0, 0), std::pair(0, 2)}) {
    if (tile++ % comm->getSize() == comm->getRank())
      box.blocks.push_back({{x, y, 0}, {2, 2, depth}});
  }
  const auto for_each_cell = [blocks = box.blocks](std::size_t b, auto&& visit) {
    const auto& [lower, size] = blocks[b];
    for (int k = lower[2]; k < lower[2] + size[2]; ++k) {
      for (int j = lower[1]; j < lower[1] + size[1]; ++j) {
        for (int i = lower[0]; i < lower[0] + size[0]; ++i) {
          visit(i, j, k);
        }
      }
    }
  };
  box.fields.push_back({"pressure", "Pa", 1, [=](std::size_t b, double* values) {
                          for_each_cell(b, [&](int i, int j, int k) {
                            *values++ = 1000.0 * number + i + 10 * j + 100 * k;
                          });
                        }});
  box.fields.push_back({"velocity", "m/s", dimension, [=](std::size_t b, double* values) {
                          for_each_cell(b, [&](int i, int j, int k) {
                            *values++ = i;
                            *values++ = j;
                            if (dimension == 3)
                              *values++ = k;
                          });
                        }});
  return box;
}

SurfaceFrame make_triangle(double height) {
  SurfaceFrame surface;
  surface.name = "ball & chain";
  surface.vertices = {0, 0, height, 1, 0, height, 0, 1, height};
  surface.simplices = {0, 1, 2};
  surface.fields.push_back({"speed", "m/s", 1, SurfaceField::Place::vertices, {1.5, 2.5, height}});
  surface.fields.push_back({"normal", "1", 3, SurfaceField::Place::simplices, {0, 0, 1}});
  return surface;
}

SurfaceFrame make_polyline() {
  SurfaceFrame surface;
  surface.name = "disc";
  surface.dimension = 2;
  surface.simplex_size = 2;
  surface.vertices = {0, 0, 1, 0, 1, 1};
  surface.simplices = {0, 1, 1, 2};
  surface.fields.push_back(
      {"velocity", "m/s", 2, SurfaceField::Place::vertices, {1, 2, 3, 4, 5, 6}});
  return surface;
}

double last_stored_time(const std::string& folder) {
  return Hdf5File::open(Tpetra::getDefaultComm(), folder + "/frames.h5")
      .read_all<double>("times")
      .back();
}

// read_frames.py opens what this leaves behind.
TEST(FrameWriter, LeavesASeriesForAnIndependentReader) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("series");
  FrameWriter solid(comm, folder + "/3d");
  solid.set_origin({"0123abc", "scène.xml", std::string(100000, 'p')});  // over 64 kB
  solid.start();
  solid.write(0, 0.0, {make_box(3, 0)}, {make_triangle(0.25)});
  solid.write(10, 0.1, {make_box(3, 1)}, {make_triangle(0.5)});
  EXPECT_EQ(solid.n_frames(), 2);

  FrameWriter plane(comm, folder + "/2d", {Precision::double_precision, 6});
  plane.start();
  plane.write(0, 0.0, {make_box(2, 0)}, {make_polyline()});
  EXPECT_EQ(plane.last_time(), 0.0);
}

TEST(FrameWriter, ResumesAKilledSeries) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("resume");
  const std::string frames = folder + "/frames/";
  {
    FrameWriter writer(comm, folder);
    writer.start();
    for (int step = 0; step < 4; ++step) {
      writer.write(step, 0.1 * step, {make_box(3, step)}, {});
    }
  }
  if (is_root(comm))
    std::ofstream(frames + "frame-000004.h5.part") << "cut short";
  comm->barrier();

  FrameWriter writer(comm, folder);
  writer.resume(0.1);
  EXPECT_EQ(writer.n_frames(), 2);
  EXPECT_EQ(writer.last_time(), 0.1);
  EXPECT_EQ(last_stored_time(folder), 0.1);
  EXPECT_TRUE(std::filesystem::exists(frames + "frame-000001.h5"));
  EXPECT_FALSE(std::filesystem::exists(frames + "frame-000002.h5"));
  EXPECT_FALSE(std::filesystem::exists(frames + "frame-000004.h5.part"));
  EXPECT_THROW(writer.write(1, 0.1, {}, {}), OutputError);
  writer.write(2, 0.15, {make_box(3, 7)}, {});
  EXPECT_EQ(last_stored_time(folder), 0.15);
  EXPECT_THAT(read_whole_file(folder + "/frames.xmf"), HasSubstr("frame-000002.h5"));
  comm->barrier();

  writer.start();
  EXPECT_FALSE(std::filesystem::exists(frames + "frame-000000.h5"));
  EXPECT_EQ(writer.n_frames(), 0);
}

TEST(FrameWriter, LeavesNoTraceOfAFrameThatFails) {
  const Communicator comm = Tpetra::getDefaultComm();
  const std::string folder = fresh_folder("failed-frame");
  FrameWriter writer(comm, folder);
  writer.start();
  writer.write(0, 0.0, {make_box(2, 0)}, {});
  SurfaceFrame broken = make_polyline();
  broken.fields.front().values[3] = std::numeric_limits<double>::infinity();
  EXPECT_THROW(writer.write(1, 0.1, {make_box(2, 1)}, {broken}), OutputError);
  broken.fields.front().values.pop_back();
  EXPECT_THAT(message_of<OutputError>([&] { writer.write(1, 0.1, {}, {broken}); }),
              HasSubstr("5 values"));
  comm->barrier();
  int n_files = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder + "/frames")) {
    n_files += file.path().filename() == "frame-000000.h5" ? 1 : 100;
  }
  EXPECT_EQ(n_files, 1);
  EXPECT_EQ(last_stored_time(folder), 0.0);
}

}  // namespace
}  // namespace lockstep::test
