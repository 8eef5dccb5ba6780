#include "staggered/domain/fitting_domain.hpp"

#include "base/errors.hpp"
#include "base/memory.hpp"

namespace lockstep {

template <int dim>
DomainDescription<dim> fitting_domain(const ParameterList& list, const Communicator& comm) {
  constexpr double least_bytes_per_cell = 150;  // three velocities, pressures, A and its multigrid
  const DomainDescription<dim> domain = read_domain<dim>(list);
  double n_cells = 1;
  for (const int n : domain.grid.n_cells)
    n_cells *= n;
  const double needed = least_bytes_per_cell * n_cells, there_are = memory_of_machines(comm);
  check_input(needed <= there_are,
              "In \"Domain\", \"Cells\" asks for {} = {:.3g} cells, which need more than {:.3g} GB "
              "of memory, but there are {:.3g} GB; give fewer cells, or more machines.",
              fmt::join(domain.grid.n_cells, " x "), n_cells, 1e-9 * needed, 1e-9 * there_are);
  return domain;
}

template DomainDescription<2> fitting_domain<2>(const ParameterList&, const Communicator&);
template DomainDescription<3> fitting_domain<3>(const ParameterList&, const Communicator&);

}  // namespace lockstep
