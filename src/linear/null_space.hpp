#pragma once
#include <memory>
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// Rows of a map by region: runs of local rows, in ascending order. Rows of no region are in none.
struct RowRegions {
  struct Run {
    int begin, end, region;
  };
  RCP<const Map> map;
  int n_regions = 0;  ///< over all ranks; all of them count regions alike
  std::vector<Run> runs;

  /// `region_of_row`: of each local row, -1 where it is in none.
  static std::shared_ptr<const RowRegions> from(const RCP<const Map>& map, int n_regions,
                                                const std::vector<int>& region_of_row);
  /// The sum of x over each region. Collective.
  std::vector<double> sums_of(const Vector& x) const;
  std::vector<double> n_rows() const;  ///< number of rows of each region. Collective.
  RCP<Vector> numbers() const;         ///< the region of each row, -1 where it is in none
};

/// Orthonormal vectors that are constant on regions: a few numbers each, instead of one a row.
class NullSpace {
 public:
  /// Value of a vector on all rows of a region; the vector is zero on the regions that it does not
  /// name.
  struct Part {
    int region;
    double value;
  };
  NullSpace() = default;
  /// The vectors are the same on all ranks.
  NullSpace(std::shared_ptr<const RowRegions> regions, std::vector<std::vector<Part>> vectors)
      : regions_(std::move(regions)), vectors_(std::move(vectors)) {}

  std::size_t size() const { return vectors_.size(); }
  bool empty() const { return vectors_.empty(); }
  const RowRegions& regions() const { return *regions_; }  ///< regions of a space that is not empty
  const std::vector<std::vector<Part>>& vectors() const { return vectors_; }
  /// Returns one vector, row by row. Local.
  RCP<Vector> vector(std::size_t k) const;
  /// Returns other vectors on the same regions.
  NullSpace with(std::vector<std::vector<Part>> vectors) const {
    return {regions_, std::move(vectors)};
  }
  /// Returns these vectors on other rows of this rank: row r stands in row `place[r]` of `map`.
  NullSpace moved_to(const RCP<const Map>& map, const std::vector<int>& place) const;

 private:
  std::shared_ptr<const RowRegions> regions_;
  std::vector<std::vector<Part>> vectors_;
};

/// The space of orthonormal vectors that are given row by row: rows in which all of them have the
/// same values are a region. For files and tests: as many numbers as regions are gathered.
/// Collective.
NullSpace null_space_of(const std::vector<RCP<const Vector>>& vectors);

/// x . n for each vector n. One sum over ranks, and one pass over x. Collective.
std::vector<double> components(const NullSpace& space, const Vector& x);

/// x += the sum of the vectors, each times its factor. One pass over x. Local.
void add_vectors(const NullSpace& space, const std::vector<double>& factors, Vector& x);

/// Removes from x its components along the vectors; returns the norm of what was removed. One sum
/// over ranks, and two passes over x. Collective.
double project_out(const NullSpace& space, Vector& x);

/// Removes from x its components along the vectors, and returns the norm of what was removed
/// relative to the norm of x before (0 for x = 0). Collective.
double relative_part_removed(const NullSpace& space, Vector& x);

}  // namespace lockstep
