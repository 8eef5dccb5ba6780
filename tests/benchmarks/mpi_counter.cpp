// Counts what a program sends through MPI, without touching it: preload this library.
//
//   MPI_COUNTER_FILE=counts mpirun -n 2 -x LD_PRELOAD=libmpi_counter.so program ...
//
// At MPI_Finalize rank 0 writes one line: messages and bytes of point-to-point sends, calls and
// bytes of collectives, sums over ranks.
#include <mpi.h>

#include <array>
#include <cstdio>
#include <cstdlib>

namespace {

enum Count { messages, bytes, collectives, collective_bytes };
std::array<long long, 4> counts{};

long long size_of(int count, MPI_Datatype type) {
  int size = 0;
  PMPI_Type_size(type, &size);
  return static_cast<long long>(count) * size;
}

void sent(int count, MPI_Datatype type, int destination) {
  if (destination == MPI_PROC_NULL)
    return;
  ++counts[messages];
  counts[bytes] += size_of(count, type);
}

void collective(int count, MPI_Datatype type) {
  ++counts[collectives];
  counts[collective_bytes] += size_of(count, type);
}

}  // namespace

extern "C" {

int MPI_Send(const void* buffer, int count, MPI_Datatype type, int destination, int tag,
             MPI_Comm comm) {
  sent(count, type, destination);
  return PMPI_Send(buffer, count, type, destination, tag, comm);
}
int MPI_Rsend(const void* buffer, int count, MPI_Datatype type, int destination, int tag,
              MPI_Comm comm) {
  sent(count, type, destination);
  return PMPI_Rsend(buffer, count, type, destination, tag, comm);
}
int MPI_Isend(const void* buffer, int count, MPI_Datatype type, int destination, int tag,
              MPI_Comm comm, MPI_Request* request) {
  sent(count, type, destination);
  return PMPI_Isend(buffer, count, type, destination, tag, comm, request);
}
int MPI_Irsend(const void* buffer, int count, MPI_Datatype type, int destination, int tag,
               MPI_Comm comm, MPI_Request* request) {
  sent(count, type, destination);
  return PMPI_Irsend(buffer, count, type, destination, tag, comm, request);
}
int MPI_Start(MPI_Request* request) {
  ++counts[messages];
  return PMPI_Start(request);
}
int MPI_Allreduce(const void* from, void* to, int count, MPI_Datatype type, MPI_Op op,
                  MPI_Comm comm) {
  collective(count, type);
  return PMPI_Allreduce(from, to, count, type, op, comm);
}
int MPI_Reduce(const void* from, void* to, int count, MPI_Datatype type, MPI_Op op, int root,
               MPI_Comm comm) {
  collective(count, type);
  return PMPI_Reduce(from, to, count, type, op, root, comm);
}
int MPI_Bcast(void* buffer, int count, MPI_Datatype type, int root, MPI_Comm comm) {
  collective(count, type);
  return PMPI_Bcast(buffer, count, type, root, comm);
}
int MPI_Allgather(const void* from, int n_from, MPI_Datatype from_type, void* to, int n_to,
                  MPI_Datatype to_type, MPI_Comm comm) {
  collective(n_from, from_type);
  return PMPI_Allgather(from, n_from, from_type, to, n_to, to_type, comm);
}
int MPI_Allgatherv(const void* from, int n_from, MPI_Datatype from_type, void* to, const int* n_to,
                   const int* offsets, MPI_Datatype to_type, MPI_Comm comm) {
  collective(n_from, from_type);
  return PMPI_Allgatherv(from, n_from, from_type, to, n_to, offsets, to_type, comm);
}
int MPI_Barrier(MPI_Comm comm) {
  ++counts[collectives];
  return PMPI_Barrier(comm);
}

int MPI_Finalize() {
  std::array<long long, 4> sums{};
  PMPI_Reduce(counts.data(), sums.data(), 4, MPI_LONG_LONG, MPI_SUM, 0, MPI_COMM_WORLD);
  int rank = 0;
  PMPI_Comm_rank(MPI_COMM_WORLD, &rank);
  const char* name = std::getenv("MPI_COUNTER_FILE");
  if (rank == 0 && name != nullptr) {
    if (std::FILE* file = std::fopen(name, "w")) {
      std::fprintf(file, "%lld %lld %lld %lld\n", sums[messages], sums[bytes], sums[collectives],
                   sums[collective_bytes]);
      std::fclose(file);
    }
  }
  return PMPI_Finalize();
}
}
