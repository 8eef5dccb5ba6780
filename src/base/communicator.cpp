#include "base/communicator.hpp"

#include <Teuchos_DefaultMpiComm.hpp>
#include <algorithm>
#include <limits>
#include <numeric>

#include "base/errors.hpp"

namespace lockstep {

MPI_Comm raw_communicator(const Communicator& comm) {
  const auto mpi = Teuchos::rcp_dynamic_cast<const Teuchos::MpiComm<int>>(comm);
  return mpi.is_null() ? MPI_COMM_SELF : static_cast<MPI_Comm>(*mpi->getRawMpiComm());
}

bool is_root(const Communicator& comm) {
  return comm->getRank() == 0;
}

namespace {
template <typename T>
T reduce(const Communicator& comm, T value, MPI_Datatype type, MPI_Op op) {
  T result{};
  MPI_Allreduce(&value, &result, 1, type, op, raw_communicator(comm));
  return result;
}

template <typename T>
std::vector<T> gather(const Communicator& comm, const std::vector<T>& values, MPI_Datatype type) {
  const MPI_Comm mpi = raw_communicator(comm);
  const int most = std::numeric_limits<int>::max();
  // A list that is too long on one rank stays too long in the sum over ranks.
  const int n = static_cast<int>(std::min<std::size_t>(values.size(), most));
  std::vector<int> counts(comm->getSize()), starts(comm->getSize(), 0);
  MPI_Allgather(&n, 1, MPI_INT, counts.data(), 1, MPI_INT, mpi);
  const GlobalIndex n_all = std::accumulate(counts.begin(), counts.end(), GlobalIndex{0});
  check_solve(n_all < most,
              "A list of {} numbers or more is wanted on every rank, more than MPI can send; the "
              "scene is too large.",
              n_all);
  std::partial_sum(counts.begin(), counts.end() - 1, starts.begin() + 1);
  std::vector<T> all(starts.back() + counts.back());
  MPI_Allgatherv(values.data(), n, type, all.data(), counts.data(), starts.data(), type, mpi);
  return all;
}
}  // namespace

double sum_all(const Communicator& comm, double value) {
  return reduce(comm, value, MPI_DOUBLE, MPI_SUM);
}
double max_all(const Communicator& comm, double value) {
  return reduce(comm, value, MPI_DOUBLE, MPI_MAX);
}
double min_all(const Communicator& comm, double value) {
  return reduce(comm, value, MPI_DOUBLE, MPI_MIN);
}
GlobalIndex sum_all(const Communicator& comm, GlobalIndex value) {
  return reduce(comm, value, MPI_LONG_LONG, MPI_SUM);
}
GlobalIndex max_all(const Communicator& comm, GlobalIndex value) {
  return reduce(comm, value, MPI_LONG_LONG, MPI_MAX);
}
void sum_all(const Communicator& comm, double* values, int n) {
  if (n == 0)
    return;
  MPI_Allreduce(MPI_IN_PLACE, values, n, MPI_DOUBLE, MPI_SUM, raw_communicator(comm));
}
GlobalIndex exclusive_sum(const Communicator& comm, GlobalIndex value) {
  GlobalIndex result = 0;
  MPI_Exscan(&value, &result, 1, MPI_LONG_LONG, MPI_SUM, raw_communicator(comm));
  return comm->getRank() == 0 ? 0 : result;
}
std::vector<double> gather_all(const Communicator& comm, const std::vector<double>& values) {
  return gather(comm, values, MPI_DOUBLE);
}
std::vector<GlobalIndex> gather_all(const Communicator& comm,
                                    const std::vector<GlobalIndex>& values) {
  return gather(comm, values, MPI_LONG_LONG);
}

void throw_on_all(const Communicator& comm, const std::string& message, int exit_code) {
  const MPI_Comm mpi = raw_communicator(comm);
  const int mine = message.empty() ? comm->getSize() : comm->getRank();
  int first = mine;
  MPI_Allreduce(&mine, &first, 1, MPI_INT, MPI_MIN, mpi);
  if (first == comm->getSize())
    return;
  int header[2] = {static_cast<int>(message.size()), exit_code};
  MPI_Bcast(header, 2, MPI_INT, first, mpi);
  std::string text = message;
  text.resize(header[0]);
  MPI_Bcast(text.data(), header[0], MPI_CHAR, first, mpi);
  switch (static_cast<ExitCode>(header[1])) {
    case ExitCode::bad_input:
      throw InputError(text);
    case ExitCode::solve_failed:
      throw SolveError(text);
    case ExitCode::output_failed:
      throw OutputError(text);
    case ExitCode::done:
      break;
  }
  throw Failure(static_cast<ExitCode>(header[1]), text);
}

}  // namespace lockstep
