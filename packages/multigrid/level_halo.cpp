#include "multigrid/level_halo.hpp"

#include <Teuchos_CommHelpers.hpp>
#include <cstring>

namespace lockstep {

namespace {
constexpr int tag = 4711;
}

LevelHalo::LevelHalo(const Communicator& comm, const std::vector<Peer>& peers) : comm_(comm) {
  GlobalIndex n = 0;
  for (const Peer& peer : peers) {
    Part all{peer.rank, {}, {}};
    std::array<Part, 2> split{all, all};
    for (const Cell& cell : peer.owned) {
      all.owned.push_back(cell.natural);
      split[cell.colour].owned.push_back(cell.slot);
    }
    for (const Cell& cell : peer.ghosts) {
      all.ghosts.push_back(cell.natural);
      split[cell.colour].ghosts.push_back(cell.slot);
    }
    natural_.push_back(std::move(all));
    for (int colour = 0; colour < 2; ++colour)
      by_colour_[colour].push_back(std::move(split[colour]));
    n += static_cast<GlobalIndex>(peer.ghosts.size());
  }
  empty_ = sum_all(comm, n) == 0;
}

/// Moves the values of one list of each part to the other list's place on the peer: owned to
/// ghosts, or back (then they are added).
template <typename Value>
void LevelHalo::transfer(const Parts& parts, bool to_owner, Value* values) const {
  const int me = comm_->getRank();
  std::size_t n_out = 0, n_in = 0;
  for (const Part& part : parts) {
    n_out += (to_owner ? part.ghosts : part.owned).size();
    n_in += (to_owner ? part.owned : part.ghosts).size();
  }
  outgoing_.resize(std::max(outgoing_.size(), n_out * sizeof(Value)));
  incoming_.resize(std::max(incoming_.size(), n_in * sizeof(Value)));
  auto* out = reinterpret_cast<Value*>(outgoing_.data());
  auto* in = reinterpret_cast<Value*>(incoming_.data());
  const MPI_Comm mpi = raw_communicator(comm_);
  requests_.clear();
  Value* next = in;
  for (const Part& part : parts) {
    const std::size_t n = (to_owner ? part.owned : part.ghosts).size();
    if (part.rank != me && n > 0) {
      requests_.emplace_back();
      MPI_Irecv(next, static_cast<int>(n * sizeof(Value)), MPI_BYTE, part.rank, tag, mpi,
                &requests_.back());
    }
    next += n;
  }
  next = out;
  for (const Part& part : parts) {
    const auto& source = to_owner ? part.ghosts : part.owned;
    for (std::size_t i = 0; i < source.size(); ++i)
      next[i] = values[source[i]];
    if (part.rank != me && !source.empty()) {
      requests_.emplace_back();
      MPI_Isend(next, static_cast<int>(source.size() * sizeof(Value)), MPI_BYTE, part.rank, tag,
                mpi, &requests_.back());
      ++sent_.messages;
      sent_.bytes += static_cast<long long>(source.size() * sizeof(Value));
    }
    next += source.size();
  }
  if (to_owner) {
    for (const Part& part : parts)
      for (const std::ptrdiff_t ghost : part.ghosts)
        values[ghost] = 0;
  }
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  const Value* mine = out;
  next = in;
  for (const Part& part : parts) {
    const auto& target = to_owner ? part.owned : part.ghosts;
    const Value* source = part.rank == me ? mine : next;
    for (std::size_t i = 0; i < target.size(); ++i) {
      if (to_owner)
        values[target[i]] += source[i];
      else
        values[target[i]] = source[i];
    }
    mine += (to_owner ? part.ghosts : part.owned).size();
    next += target.size();
  }
}

template <typename Value>
void LevelHalo::exchange(const Parts& parts, Value* values) const {
  if (!empty_)
    transfer(parts, false, values);
}

void LevelHalo::exchange_back(const Parts& parts, float* values) const {
  if (!empty_)
    transfer(parts, true, values);
}

template void LevelHalo::exchange<float>(const Parts&, float*) const;
template void LevelHalo::exchange<double>(const Parts&, double*) const;
template void LevelHalo::exchange<char>(const Parts&, char*) const;

}  // namespace lockstep
