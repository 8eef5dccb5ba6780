#pragma once
#include <array>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "base/communicator.hpp"
#include "output/hdf5_file.hpp"
#include "output/run_origin.hpp"

namespace lockstep {

/// A field on the cells of a box, given block by block.
struct BoxField {
  std::string name;
  std::string unit;
  int n_components;  ///< 1, or 2 or 3 for a vector (stored with three)
  /// Writes the values of one block: x fastest, then y, then z; the components of a cell together.
  std::function<void(std::size_t block, double* values)> fill;
};

/// Cell-centred fields on a uniform box. The blocks of all ranks must not overlap; cells in no
/// block become 0. In 2D the third entries are: n_cells 1, lower 0, size 1; origin and spacing are
/// ignored.
struct BoxFrame {
  std::string name = "fluid";
  int dimension = 3;
  std::array<double, 3> origin{};   ///< lower corner of the box [m]
  std::array<double, 3> spacing{};  ///< cell size [m]
  std::array<int, 3> n_cells{1, 1, 1};
  std::vector<CellBlock> blocks;  ///< blocks of this rank
  std::vector<BoxField> fields;   ///< fields; the same list on every rank
};

/// A field on the vertices or the simplices of a surface.
struct SurfaceField {
  enum class Place { vertices, simplices };
  std::string name;
  std::string unit;
  int n_components;  ///< 1, or 2 or 3 for a vector (stored with three), 6 for a symmetric tensor
                     ///< (xx, xy, xz, yy, yz, zz)
  Place place;
  std::vector<double> values;  ///< the components of an entity together
};

/// A mesh of surface or volume simplices with fields. Every rank passes the same names; the numbers
/// of rank 0 are written.
struct SurfaceFrame {
  std::string name;
  int dimension = 3;             ///< coordinates of a vertex
  std::vector<double> vertices;  ///< [m], the coordinates of a vertex together
  int simplex_size = 3;  ///< vertices of a simplex: 1 points, 2 segments, 3 triangles, 4 tetrahedra
  std::vector<int> simplices;  ///< vertex numbers, those of a simplex together
  std::vector<SurfaceField> fields;
};

/// Writes a time series of frames into a folder:
///   frames/frame-000012.h5  one frame: /fluid/FIELD [z][y][x] or [z][y][x][3], and for every
///   surface
///                           /solids/NAME/{vertices, simplices, FIELD}; attributes time [s], step
///                           and those of `write_origin`
///   frames.h5               all of them, as external links frame-000012, with /times and /steps
///   frames.xmf              XDMF 3: the series for ParaView
/// Each file appears under its name only when it is complete, so that whatever ends the run, every
/// finished frame can be read. All member functions are collective and throw OutputError.
class FrameWriter {
 public:
  FrameWriter(const Communicator& comm, const std::string& directory,
              const BoxStorage& storage = {});

  /// Says whose frames are written from now on.
  void set_origin(const RunOrigin& origin) { origin_ = origin; }
  /// Begins a new series: removes the frames of an earlier run in this folder.
  void start();
  /// Continues a series: drops the frames later than `time` [s].
  void resume(double time);
  /// Needs `start` or `resume` before. `time` [s] must be later than that of the last frame.
  void write(long long step, double time, const std::vector<BoxFrame>& boxes,
             const std::vector<SurfaceFrame>& surfaces);

  /// Frames in the series, and the time of the last [s] (-infinity if there is none); on all ranks.
  int n_frames() const { return n_frames_; }
  double last_time() const { return last_time_; }

 private:
  struct Entry {
    long long number;
    long long step;
    double time;
    std::string xdmf;
  };
  std::string frame_path(long long number) const;
  void write_box(Hdf5File& file, const BoxFrame& box) const;
  void write_surface(Hdf5File& file, const SurfaceFrame& surface) const;
  std::vector<std::filesystem::path> frame_files() const;
  std::vector<Entry> find_entries() const;
  void write_index() const;
  void share_state();

  Communicator comm_;
  std::string directory_;
  BoxStorage storage_;
  RunOrigin origin_;
  std::vector<Entry> entries_;  // rank 0 only
  int n_frames_ = 0;
  long long next_number_ = 0;
  double last_time_ = 0;
};

}  // namespace lockstep
