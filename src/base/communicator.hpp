#pragma once
#include <mpi.h>

#include <Teuchos_Comm.hpp>
#include <Teuchos_RCP.hpp>
#include <string>
#include <vector>

#include "base/types.hpp"

namespace lockstep {

/// The communicator of a run, in Teuchos' form because every Tpetra map wants it.
using Communicator = Teuchos::RCP<const Teuchos::Comm<int>>;

/// The MPI handle behind it; MPI_COMM_SELF for a serial communicator.
MPI_Comm raw_communicator(const Communicator& comm);
bool is_root(const Communicator& comm);

/// Collective reductions over all ranks; every rank gets the result.
double sum_all(const Communicator& comm, double value);
double max_all(const Communicator& comm, double value);
double min_all(const Communicator& comm, double value);
GlobalIndex sum_all(const Communicator& comm, GlobalIndex value);
GlobalIndex max_all(const Communicator& comm, GlobalIndex value);
/// Element by element, in place.
void sum_all(const Communicator& comm, double* values, int n);
/// Sum over the ranks below this one (0 on rank 0).
GlobalIndex exclusive_sum(const Communicator& comm, GlobalIndex value);
/// Collective: the elements of every rank's vector, in rank order, on every rank. For short lists
/// only.
std::vector<double> gather_all(const Communicator& comm, const std::vector<double>& values);
std::vector<GlobalIndex> gather_all(const Communicator& comm,
                                    const std::vector<GlobalIndex>& values);
/// Collective: throws on every rank, with the message of the lowest failing rank, if any rank
/// passes a non-empty message. Turns an error of one rank into an error of all, so that nobody
/// waits forever. The type thrown is the one `exit_code` belongs to (InputError for 2, and so on).
void throw_on_all(const Communicator& comm, const std::string& message, int exit_code);

}  // namespace lockstep
