#include "linear/system_file.hpp"

#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/errors.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/triplet_matrix.hpp"
#include "output/hdf5_file.hpp"

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

void write_vectors(Hdf5File& file, const std::string& group,
                   const std::vector<RCP<const Vector>>& vectors) {
  file.create_group(group);
  file.write_attribute<long long>(group, "size", static_cast<long long>(vectors.size()));
  for (std::size_t i = 0; i < vectors.size(); ++i)
    write_vector(file, fmt::format("{}/{}", group, i), *vectors[i]);
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

std::vector<Triplet> read_entries(const Hdf5File& file, const std::string& group) {
  const auto [begin, end] = share(file.shape(group + "/values").at(0), file.communicator());
  const auto places = file.read_rows<long long>(group + "/places", begin, end - begin);
  const auto values = file.read_rows<double>(group + "/values", begin, end - begin);
  std::vector<Triplet> entries(values.size());
  for (std::size_t i = 0; i < values.size(); ++i)
    entries[i] = {places[2 * i], places[2 * i + 1], values[i]};
  return entries;
}

RCP<Vector> read_vector(const Hdf5File& file, const std::string& group, const RCP<const Map>& map) {
  // A vector is short beside the matrices: each rank reads all and keeps its own.
  const auto places = file.read_all<long long>(group + "/places");
  const auto values = file.read_all<double>(group + "/values");
  const auto vector = make_vector(map);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (map->isNodeGlobalElement(places[i]))
      vector->replaceGlobalValue(places[i], values[i]);
  }
  return vector;
}

std::vector<RCP<const Vector>> read_vectors(const Hdf5File& file, const std::string& group,
                                            const RCP<const Map>& map) {
  std::vector<RCP<const Vector>> vectors;
  for (long long i = 0; i < file.read_attribute<long long>(group, "size"); ++i)
    vectors.push_back(read_vector(file, fmt::format("{}/{}", group, i), map));
  return vectors;
}

/// Reads C, and gives each unknown that is added the largest entry found, so that scales stay.
RCP<const CrsMatrix> read_solid_block(const Hdf5File& file, GlobalIndex n_stored,
                                      const RCP<const Map>& map) {
  std::vector<Triplet> entries = read_entries(file, "/C");
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

}  // namespace

void write_system(const std::string& path, const BlockSystem& system, const BlockVector& rhs) {
  const auto pressure = assembled_block(system.pressure_block, "pressure block");
  const auto solid =
      system.has_solid() ? assembled_block(system.solid_block, "solid block") : Teuchos::null;
  Hdf5File file = Hdf5File::create(pressure->getRowMap()->getComm(), path);
  file.write_attribute<std::string>("/", "kind", file_kind);
  file.write_attribute<std::string>("/", "name", system.name);
  file.write_attribute<long long>("/", "pressure unknowns", pressure->getGlobalNumRows());
  file.write_attribute<long long>("/", "solid unknowns",
                                  solid.is_null() ? 0 : solid->getGlobalNumRows());
  write_matrix(file, "/A", *pressure);
  write_vector(file, "/pressure rhs", *rhs.pressure);
  write_vectors(file, "/null space", system.null_space);
  write_vectors(file, "/pressure null space", system.pressure_null_space);
  if (!solid.is_null()) {
    write_matrix(file, "/B transposed", *system.coupling_transposed);
    write_matrix(file, "/C", *solid);
    write_vector(file, "/solid rhs", *rhs.solid);
  }
  file.close();
}

StoredSystem read_system(const std::string& path, const Communicator& comm) {
  const Hdf5File file = Hdf5File::open(comm, path);
  check_output(
      file.has_attribute("/", "kind") && file.read_attribute<std::string>("/", "kind") == file_kind,
      "'{}' holds no block system; write one with simulate --dump-system.", path);
  StoredSystem stored;
  BlockSystem& system = stored.system;
  system.name = file.read_attribute<std::string>("/", "name");
  system.geometry_stamp = system.solid_stamp = 1;
  const auto pressures = even_map(file.read_attribute<long long>("/", "pressure unknowns"), comm);
  system.pressure_block =
      as_operator(assemble_triplets(read_entries(file, "/A"), pressures, pressures));
  system.null_space = read_vectors(file, "/null space", pressures);
  system.pressure_null_space = read_vectors(file, "/pressure null space", pressures);
  stored.rhs.pressure = read_vector(file, "/pressure rhs", pressures);
  const GlobalIndex n_solid = file.read_attribute<long long>("/", "solid unknowns");
  if (n_solid == 0)
    return stored;
  const auto solids = even_map(std::max<GlobalIndex>(n_solid, comm->getSize()), comm);
  system.coupling_transposed =
      assemble_triplets(read_entries(file, "/B transposed"), solids, pressures);
  system.solid_block = as_operator(read_solid_block(file, n_solid, solids));
  stored.rhs.solid = read_vector(file, "/solid rhs", solids);
  return stored;
}

}  // namespace lockstep
