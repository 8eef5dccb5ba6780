#include "staggered/state/stored_fields.hpp"

#include "output/checkpoint.hpp"

namespace lockstep {

namespace {
/// The owned lattice cells, in which all fields are saved, and their numbers.
template <int dim>
struct SavedCells {
  explicit SavedCells(const TiledGrid<dim>& grid) {
    cells.reserve(grid.n_owned_cells());
    ids.reserve(grid.n_owned_cells());
    for (int cell = 0; cell < grid.n_owned_cells(); ++cell) {
      if (!grid.in_lattice(cell))
        continue;
      cells.push_back(cell);
      ids.push_back(grid.global_id(cell));
    }
  }
  std::vector<int> cells;
  std::vector<GlobalIndex> ids;
};
}  // namespace

template <int dim>
void save_fields(const MacDomain<dim>& domain, const std::vector<StoredField>& fields,
                 CheckpointWriter& checkpoint) {
  const SavedCells<dim> saved(domain.grid);
  std::vector<double> values;
  for (const StoredField& field : fields) {
    values.clear();
    values.reserve(saved.cells.size() * field.components.size());
    for (const int cell : saved.cells)
      for (const CellField* component : field.components)
        values.push_back((*component)[cell]);
    checkpoint.write_distributed("fluid/" + field.name, saved.ids, values,
                                 static_cast<int>(field.components.size()));
  }
}

template <int dim>
void load_fields(const MacDomain<dim>& domain, const std::vector<StoredField>& fields,
                 const CheckpointReader& checkpoint) {
  const SavedCells<dim> saved(domain.grid);
  for (const StoredField& field : fields) {
    const auto values = checkpoint.read_distributed<double>(
        "fluid/" + field.name, saved.ids, static_cast<int>(field.components.size()));
    auto value = values.begin();
    for (const int cell : saved.cells)
      for (CellField* component : field.components)
        (*component)[cell] = *value++;
    domain.full_halo.fill(field.components);
  }
}

template void save_fields<2>(const MacDomain<2>&, const std::vector<StoredField>&,
                             CheckpointWriter&);
template void save_fields<3>(const MacDomain<3>&, const std::vector<StoredField>&,
                             CheckpointWriter&);
template void load_fields<2>(const MacDomain<2>&, const std::vector<StoredField>&,
                             const CheckpointReader&);
template void load_fields<3>(const MacDomain<3>&, const std::vector<StoredField>&,
                             const CheckpointReader&);

}  // namespace lockstep
