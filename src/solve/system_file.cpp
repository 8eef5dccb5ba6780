#include "solve/system_file.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_MultiVector.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>
#include <cmath>
#include <optional>

#include "base/errors.hpp"
#include "base/regular_file.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/stencil_operator.hpp"
#include "linear/triplet_matrix.hpp"
#include "output/checksum.hpp"
#include "output/hdf5_file.hpp"
#include "output/hdf5_probe.hpp"
#include "solve/stored_lattice.hpp"

namespace lockstep {

namespace {

const char* const file_kind = "lockstep block system";

void write_matrix(Hdf5File& file, const std::string& group, const CrsMatrix& matrix) {
  std::vector<long long> places;
  std::vector<double> values;
  for_each_entry(matrix, [&](int row, GlobalIndex column, double value) {
    places.insert(places.end(), {matrix.getRowMap()->getGlobalElement(row), column});
    values.push_back(value);
  });
  file.create_group(group);
  file.write_slices(group + "/places", places, 2);
  file.write_slices(group + "/values", values);
}

void write_vector(Hdf5File& file, const std::string& group, const Vector& vector) {
  std::vector<long long> places;
  const auto view = vector.getData();
  const std::vector<double> values(view.begin(), view.end());
  for (std::size_t i = 0; i < values.size(); ++i)
    places.push_back(vector.getMap()->getGlobalElement(static_cast<int>(i)));
  file.create_group(group);
  file.write_slices(group + "/places", places);
  file.write_slices(group + "/values", values);
}

void write_null_space(Hdf5File& file, const std::string& group, const NullSpace& space) {
  file.create_group(group);
  file.write_attribute<long long>(group, "size", static_cast<long long>(space.size()));
  for (std::size_t i = 0; i < space.size(); ++i)
    write_vector(file, fmt::format("{}/{}", group, i), *space.vector(i));
}

RCP<const CrsMatrix> assembled_block(const RCP<const LinearOperator>& block, const char* name) {
  const auto matrix = assembled(block);
  check_input(!matrix.is_null(),
              "The {} is applied without a matrix, so it cannot be written to a file.", name);
  const GlobalIndex n = matrix->getRowMap()->getGlobalNumElements();
  check_input(matrix->getRowMap()->getMinAllGlobalIndex() == 0 &&
                  matrix->getRowMap()->getMaxAllGlobalIndex() == n - 1,
              "The rows of the {} are not numbered 0 to {}, so it cannot be written.", name, n - 1);
  return matrix;
}

/// This rank's share of n things: the first, and the one after the last.
std::pair<GlobalIndex, GlobalIndex> share(GlobalIndex n, const Communicator& comm) {
  return {n * comm->getRank() / comm->getSize(), n * (comm->getRank() + 1) / comm->getSize()};
}

RCP<const Map> even_map(GlobalIndex n, const Communicator& comm) {
  const auto [begin, end] = share(n, comm);
  return make_map(static_cast<int>(end - begin), comm);
}

[[noreturn]] void refuse(const Hdf5File& file, const std::string& reason) {
  throw InputError(
      fmt::format("'{}' holds no proper block system: {}. Write one with simulate --dump-system.",
                  file.path(), reason));
}

/// Throws on all ranks if any of them found something wrong.
void agree(const Hdf5File& file, const std::string& failure) {
  throw_on_all(file.communicator(),
               failure.empty()
                   ? ""
                   : fmt::format("'{}' holds no proper block system: {}. Write one with simulate "
                                 "--dump-system.",
                                 file.path(), failure),
               static_cast<int>(ExitCode::bad_input));
}

/// Number of entries of a table of places and values, whose shapes must fit each other. A place has
/// n_columns numbers, one of them without an extent of its own.
GlobalIndex n_entries(const Hdf5File& file, const std::string& group, GlobalIndex n_columns) {
  for (const char* name : {"/places", "/values"}) {
    if (!file.exists(group + name))
      refuse(file, fmt::format("'{}{}' is missing", group, name));
  }
  const std::vector<GlobalIndex> values = file.shape(group + "/values");
  std::vector<GlobalIndex> expected = values;
  if (n_columns > 1)
    expected.push_back(n_columns);
  if (values.size() != 1 || file.shape(group + "/places") != expected)
    refuse(file, fmt::format("the shapes of places and values in '{}' do not fit", group));
  return values.front();
}

/// Numbers of rows, an attribute of the file.
GlobalIndex n_unknowns(const Hdf5File& file, const std::string& name, GlobalIndex least) {
  constexpr GlobalIndex most = GlobalIndex{1} << 40;
  const auto n = file.read_attribute<long long>("/", name);
  if (n < least || n > most)
    refuse(file, fmt::format("the number of {} is {}", name, n));
  return n;
}

std::vector<Triplet> read_entries(const Hdf5File& file, const std::string& group,
                                  GlobalIndex n_rows, GlobalIndex n_columns) {
  const auto [begin, end] = share(n_entries(file, group, 2), file.communicator());
  const auto places = file.read_rows<long long>(group + "/places", begin, end - begin);
  const auto values = file.read_rows<double>(group + "/values", begin, end - begin);
  std::vector<Triplet> entries(values.size());
  std::string failure;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const Triplet entry{places[2 * i], places[2 * i + 1], values[i]};
    if (entry.row < 0 || entry.row >= n_rows || entry.column < 0 || entry.column >= n_columns) {
      failure = fmt::format("'{}' has an entry in row {} and column {}, but {} rows and {} columns",
                            group, entry.row, entry.column, n_rows, n_columns);
    } else if (!std::isfinite(entry.value)) {
      failure = fmt::format("'{}' has the entry {} in row {} and column {}", group, entry.value,
                            entry.row, entry.column);
    }
    entries[i] = entry;
  }
  agree(file, failure);
  return entries;
}

/// A square block, at least so many of whose rows have a positive entry on the diagonal and none a
/// negative one.
std::vector<Triplet> read_square(const Hdf5File& file, const std::string& group, GlobalIndex n,
                                 GlobalIndex least_positive) {
  std::vector<Triplet> entries = read_entries(file, group, n, n);
  GlobalIndex n_positive = 0, n_negative = 0;
  for (const Triplet& entry : entries) {
    n_positive += entry.row == entry.column && entry.value > 0;
    n_negative += entry.row == entry.column && entry.value < 0;
  }
  n_positive = sum_all(file.communicator(), n_positive);
  n_negative = sum_all(file.communicator(), n_negative);
  if (n_negative > 0 || n_positive < least_positive)
    refuse(file, fmt::format("'{}' has {} positive and {} negative entries on a diagonal of {}",
                             group, n_positive, n_negative, n));
  return entries;
}

/// Throws unless a vector has as many values. Done for the right-hand sides before all else:
/// nothing is made of a size that the file does not have.
void check_size(const Hdf5File& file, const std::string& vector, GlobalIndex n) {
  if (n_entries(file, vector, 1) != n)
    refuse(file, fmt::format("'{}' does not have {} values", vector, n));
}

/// n values are stored, one for each place.
RCP<Vector> read_vector(const Hdf5File& file, const std::string& group, GlobalIndex n,
                        const RCP<const Map>& map) {
  check_size(file, group, n);
  // A vector is short beside the matrices: each rank reads all and keeps its own.
  const auto places = file.read_all<long long>(group + "/places");
  const auto values = file.read_all<double>(group + "/values");
  const auto vector = make_vector(map);
  std::vector<bool> set(places.size(), false);
  for (std::size_t i = 0; i < values.size(); ++i) {
    const bool inside = places[i] >= 0 && places[i] < n;
    if (!inside || set[static_cast<std::size_t>(places[i])])
      refuse(file, fmt::format("'{}' has a value at {}, outside or for the second time", group,
                               places[i]));
    if (!std::isfinite(values[i]))
      refuse(file, fmt::format("'{}' has the value {} at {}", group, values[i], places[i]));
    set[static_cast<std::size_t>(places[i])] = true;
    if (map->isNodeGlobalElement(places[i]))
      vector->replaceGlobalValue(places[i], values[i]);
  }
  return vector;
}

NullSpace read_null_space(const Hdf5File& file, const std::string& group, GlobalIndex n,
                          const RCP<const Map>& map) {
  if (!file.exists(group))
    refuse(file, fmt::format("'{}' is missing", group));
  const auto n_vectors = file.read_attribute<long long>(group, "size");
  if (n_vectors != static_cast<long long>(file.names(group).size()))
    refuse(file, fmt::format("'{}' does not hold {} vectors", group, n_vectors));
  std::vector<RCP<const Vector>> vectors;
  for (long long i = 0; i < n_vectors; ++i) {
    const std::string name = fmt::format("{}/{}", group, i);
    vectors.push_back(read_vector(file, name, n, map));
    if (!(vectors.back()->norm2() > 0))
      refuse(file, fmt::format("'{}' is zero", name));
  }
  return null_space_of(vectors);
}

/// Reads C, and gives each unknown that is added the largest entry found, so that scales stay.
RCP<const CrsMatrix> read_solid_block(const Hdf5File& file, GlobalIndex n_stored,
                                      const RCP<const Map>& map) {
  std::vector<Triplet> entries = read_square(file, "/C", n_stored, n_stored);
  double largest = 0;
  for (const Triplet& entry : entries)
    largest = std::max(largest, entry.value);
  largest = max_all(file.communicator(), largest);
  const GlobalIndex n = map->getGlobalNumElements();
  for (GlobalIndex row = n_stored; row < n; ++row) {
    if (map->isNodeGlobalElement(row))
      entries.push_back({row, row, largest});
  }
  return assemble_triplets(std::move(entries), map, map);
}

const char* const soft_group = "/soft nodes";

void write_near_null_space(Hdf5File& file, const NearNullSpace& nodes) {
  const MultiVector& motions = *nodes.motions;
  const int n_motions = static_cast<int>(motions.getNumVectors());
  const std::size_t n = motions.getLocalLength();
  std::vector<long long> bodies(n, -1);
  std::copy(nodes.body_of_row.begin(), nodes.body_of_row.end(), bodies.begin());
  std::vector<double> values(n * n_motions), masses(n);
  for (int motion = 0; motion < n_motions; ++motion) {
    const auto column = motions.getData(motion);
    for (std::size_t row = 0; row < n; ++row)
      values[n_motions * row + motion] = column[row];
  }
  const auto mass = nodes.mass->getData();
  std::copy(mass.begin(), mass.end(), masses.begin());
  file.create_group(soft_group);
  file.write_attribute<long long>(soft_group, "bodies", nodes.n_bodies);
  const std::string path = soft_group;
  file.write_slices(path + "/body", bodies);
  file.write_slices(path + "/motions", values, n_motions);
  file.write_slices(path + "/mass", masses);
}

/// Reads the body of each row of C; empty: the file knows of no soft solids. Throws InputError if
/// the tables of the group do not fit each other.
std::vector<long long> read_bodies(const Hdf5File& file, GlobalIndex n) {
  const std::string path = soft_group;
  if (!file.exists(soft_group))
    return {};
  for (const char* name : {"/body", "/mass", "/motions"}) {
    const bool fits = file.exists(path + name) && !file.shape(path + name).empty() &&
                      file.shape(path + name).front() == n;
    if (!fits)
      refuse(file, fmt::format("'{}{}' does not have {} rows", path, name, n));
  }
  const auto shape = file.shape(path + "/motions");
  if (shape.size() != 2 || (shape[1] != 3 && shape[1] != 6))
    refuse(file, fmt::format("'{}/motions' has neither 3 nor 6 columns", path));
  const auto n_bodies = file.read_attribute<long long>(soft_group, "bodies");
  auto bodies = file.read_all<long long>(path + "/body");
  for (const long long body : bodies) {
    if (body < -1 || body >= n_bodies)
      refuse(file, fmt::format("'{}' has a row of body {} of {}", path, body, n_bodies));
  }
  return bodies;
}

/// Rows spread evenly over the ranks, those of a node on one.
RCP<const Map> map_of_whole_nodes(const std::vector<long long>& bodies, int n_axes,
                                  const Communicator& comm) {
  const auto n = static_cast<GlobalIndex>(bodies.size());
  const auto [begin, end] = share(n, comm);
  int n_local = 0;
  for (GlobalIndex row = 0; row < n;) {
    const GlobalIndex length = bodies[static_cast<std::size_t>(row)] < 0 ? 1 : n_axes;
    n_local += row >= begin && row < end ? static_cast<int>(std::min(length, n - row)) : 0;
    row += length;
  }
  return make_map(n_local, comm);
}

NearNullSpace read_near_null_space(const Hdf5File& file, const std::vector<long long>& bodies,
                                   const RCP<const Map>& map) {
  NearNullSpace nodes;
  const std::string path = soft_group;
  const auto values = file.read_all<double>(path + "/motions");
  const auto masses = file.read_all<double>(path + "/mass");
  for (const std::vector<double>* numbers : {&values, &masses}) {
    for (const double number : *numbers) {
      if (!std::isfinite(number))
        refuse(file, fmt::format("'{}' has the value {}", path, number));
    }
  }
  const std::size_t n_motions = values.size() / std::max<std::size_t>(1, bodies.size());
  const auto motions = rcp(new MultiVector(map, n_motions));
  const auto mass = make_vector(map);
  nodes.n_bodies = static_cast<int>(file.read_attribute<long long>(soft_group, "bodies"));
  for (int row = 0; row < static_cast<int>(map->getNodeNumElements()); ++row) {
    const auto id = static_cast<std::size_t>(map->getGlobalElement(row));
    mass->replaceLocalValue(row, masses[id]);
    nodes.body_of_row.push_back(static_cast<int>(bodies[id]));
    for (std::size_t motion = 0; motion < n_motions; ++motion)
      motions->replaceLocalValue(row, motion, values[n_motions * id + motion]);
  }
  nodes.motions = motions;
  nodes.mass = mass;
  return nodes;
}

/// Damaged files are found before HDF5, which may crash on them, reads them.
void check_is_readable(const std::string& path, const Communicator& comm) {
  std::string failure;
  if (is_root(comm))
    failure = refusal_to_read(path);
  const auto fail_together = [&] {
    throw_on_all(
        comm, failure.empty() ? "" : fmt::format("Cannot read the system '{}': {}.", path, failure),
        static_cast<int>(ExitCode::bad_input));
  };
  fail_together();
  const ChecksumState state = check_checksum(comm, path);
  if (state == ChecksumState::broken)
    failure = "it is damaged, its bytes do not have the checksum that was written with them";
  if (state == ChecksumState::absent && is_root(comm))
    failure = refusal_of_hdf5(path);
  fail_together();
}

StoredSystem read_parts(const Hdf5File& file) {
  const Communicator comm = file.communicator();
  if (!file.has_attribute("/", "kind") ||
      file.read_attribute<std::string>("/", "kind") != file_kind)
    refuse(file, "it is of another kind");
  StoredSystem stored;
  BlockSystem& system = stored.system;
  system.name = file.read_attribute<std::string>("/", "name");
  system.geometry_version = system.solids.version = 1;
  const GlobalIndex n_pressure = n_unknowns(file, "pressure unknowns", 1);
  const GlobalIndex n_solid = n_unknowns(file, "solid unknowns", 0);
  check_size(file, "/pressure rhs", n_pressure);
  // Cells all of whose faces are mixed have an empty row.
  std::vector<Triplet> pressure_entries = read_square(file, "/A", n_pressure, 1);
  const std::optional<FaceCoefficients> lattice = read_lattice(file, n_pressure);
  const auto pressures = lattice ? lattice->map : even_map(n_pressure, comm);
  const RCP<const CrsMatrix> a =
      assemble_triplets(std::move(pressure_entries), pressures, pressures);
  const RCP<const LinearOperator> pressure_block =
      lattice ? as_operator(stored_stencil(a, *lattice)) : as_operator(a);
  system.null_space = read_null_space(file, "/null space", n_pressure, pressures);
  system.pressure_null_space = read_null_space(file, "/pressure null space", n_pressure, pressures);
  stored.rhs.pressure = read_vector(file, "/pressure rhs", n_pressure, pressures);
  if (n_solid == 0) {
    system.set_blocks(pressure_block);
    return stored;
  }
  check_size(file, "/solid rhs", n_solid);
  const std::vector<long long> bodies = read_bodies(file, n_solid);
  const auto solids =
      bodies.empty()
          ? even_map(std::max<GlobalIndex>(n_solid, comm->getSize()), comm)
          : map_of_whole_nodes(
                bodies, file.shape(std::string(soft_group) + "/motions")[1] == 3 ? 2 : 3, comm);
  if (!bodies.empty())
    system.near_null_space = read_near_null_space(file, bodies, solids);
  system.set_blocks(pressure_block,
                    assemble_triplets(read_entries(file, "/B transposed", n_solid, n_pressure),
                                      solids, pressures),
                    as_operator(read_solid_block(file, n_solid, solids)));
  stored.rhs.solid = read_vector(file, "/solid rhs", n_solid, solids);
  return stored;
}

}  // namespace

void write_system(const std::string& path, const BlockSystem& system, const BlockVector& rhs) {
  const auto pressure = assembled_block(system.pressure_block(), "pressure block");
  const auto solid =
      system.has_solid() ? assembled_block(system.solid_block(), "solid block") : Teuchos::null;
  Hdf5File file = Hdf5File::create(pressure->getRowMap()->getComm(), path);
  file.write_attribute<std::string>("/", "kind", file_kind);
  file.write_attribute<std::string>("/", "name", system.name);
  file.write_attribute<long long>("/", "pressure unknowns", pressure->getGlobalNumRows());
  file.write_attribute<long long>("/", "solid unknowns",
                                  solid.is_null() ? 0 : solid->getGlobalNumRows());
  write_matrix(file, "/A", *pressure);
  write_vector(file, "/pressure rhs", *rhs.pressure);
  write_null_space(file, "/null space", system.null_space);
  write_null_space(file, "/pressure null space", system.pressure_null_space);
  if (const FaceCoefficients* stencil = stencil_of(system.pressure_block()))
    write_lattice(file, *stencil);
  if (!solid.is_null()) {
    write_matrix(file, "/B transposed", *system.coupling_transposed());
    write_matrix(file, "/C", *solid);
    write_vector(file, "/solid rhs", *rhs.solid);
    if (!system.near_null_space.empty())
      write_near_null_space(file, system.near_null_space);
  }
  file.close_with_checksum();
}

StoredSystem read_system(const std::string& path, const Communicator& comm) {
  check_is_readable(path, comm);
  try {
    return read_parts(Hdf5File::open(comm, path));
  } catch (const OutputError& error) {
    throw InputError(
        fmt::format("'{}' holds no block system; write one with simulate --dump-system. ({})", path,
                    error.what()));
  }
}

}  // namespace lockstep
