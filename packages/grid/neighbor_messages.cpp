#include "grid/neighbor_messages.hpp"

#include "grid/message_tag.hpp"

namespace lockstep {

template <int dim>
NeighborMessages<dim>::NeighborMessages(const TiledGrid<dim>& grid) : comm_(grid.comm()) {
  // Reach is mutual, so the owners of this rank's ghost tiles are just those that hold its tiles.
  for (int tile = grid.n_owned_tiles(); tile < grid.n_tiles(); ++tile)
    outgoing_[grid.owner(tile)];
}

template <int dim>
std::vector<double> NeighborMessages<dim>::exchange() {
  const MPI_Comm mpi = raw_communicator(comm_);
  std::vector<MPI_Request> requests;
  for (auto& [rank, values] : outgoing_)
    MPI_Isend(values.data(), static_cast<int>(values.size()), MPI_DOUBLE, rank,
              MessageTag::neighbors, mpi, &requests.emplace_back());
  std::vector<double> arrived;
  for (const auto& [rank, values] : outgoing_) {
    MPI_Status status;
    MPI_Probe(rank, MessageTag::neighbors, mpi, &status);
    int n = 0;
    MPI_Get_count(&status, MPI_DOUBLE, &n);
    const std::size_t begin = arrived.size();
    arrived.resize(begin + n);
    MPI_Recv(arrived.data() + begin, n, MPI_DOUBLE, rank, MessageTag::neighbors, mpi,
             MPI_STATUS_IGNORE);
  }
  MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
  for (auto& [rank, values] : outgoing_)
    values.clear();
  return arrived;
}

template class NeighborMessages<2>;
template class NeighborMessages<3>;

}  // namespace lockstep
