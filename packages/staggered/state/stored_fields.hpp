#pragma once
#include <string>
#include <vector>

#include "interfaces/plug_in.hpp"
#include "staggered/domain/mac_domain.hpp"

namespace lockstep {

/// A field that a fluid keeps from one step to the next, on the stored cells of its grid. All of
/// them are listed in one place, the constructor of MacFluid, so that whoever saves, loads or moves
/// the state of a fluid cannot forget one.
struct StoredField {
  std::string name;                    ///< in checkpoints
  std::vector<CellField*> components;  ///< fields, one an axis for a velocity on faces, else one
  double at_rest = 0;                  ///< value in tiles that are new
};

template <int dim>
StoredField stored_faces(const std::string& name, FaceField<dim>& field) {
  StoredField result{name, {}};
  for (CellField& component : field)
    result.components.push_back(&component);
  return result;
}

/// The values in the lattice, under fluid/NAME; the same file on any number of ranks. Collective.
template <int dim>
void save_fields(const MacDomain<dim>& domain, const std::vector<StoredField>& fields,
                 CheckpointWriter& checkpoint);
/// Sets the halo too. Collective.
template <int dim>
void load_fields(const MacDomain<dim>& domain, const std::vector<StoredField>& fields,
                 const CheckpointReader& checkpoint);

}  // namespace lockstep
