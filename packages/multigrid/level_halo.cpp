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
/// ghosts, or back (then they are added). All fields go in one message to each peer.
template <typename Value>
void LevelHalo::transfer(const Fields<Value>& fields, bool to_owner) const {
  if (empty_)
    return;
  const int me = comm_->getRank();
  const MPI_Comm mpi = raw_communicator(comm_);
  const auto source = [&](const Part& part) -> const auto& {
    return to_owner ? part.ghosts : part.owned;
  };
  const auto target = [&](const Part& part) -> const auto& {
    return to_owner ? part.owned : part.ghosts;
  };
  std::size_t n_out = 0, n_in = 0;
  for (const Field<Value>& field : fields) {
    for (const Part& part : *field.parts) {
      n_out += source(part).size();
      n_in += target(part).size();
    }
  }
  outgoing_.resize(std::max(outgoing_.size(), n_out * sizeof(Value)));
  incoming_.resize(std::max(incoming_.size(), n_in * sizeof(Value)));
  auto* const out = reinterpret_cast<Value*>(outgoing_.data());
  auto* const in = reinterpret_cast<Value*>(incoming_.data());
  requests_.clear();
  Value* next = in;
  for (std::size_t peer = 0; peer < natural_.size(); ++peer) {
    std::size_t n = 0;
    for (const Field<Value>& field : fields)
      n += target((*field.parts)[peer]).size();
    if (natural_[peer].rank != me && n > 0)
      MPI_Irecv(next, static_cast<int>(n * sizeof(Value)), MPI_BYTE, natural_[peer].rank, tag, mpi,
                &requests_.emplace_back());
    next += n;
  }
  next = out;
  for (std::size_t peer = 0; peer < natural_.size(); ++peer) {
    Value* const begin = next;
    for (const Field<Value>& field : fields) {
      for (const std::ptrdiff_t i : source((*field.parts)[peer]))
        *next++ = field.values[i];
    }
    const auto n_bytes = static_cast<long long>((next - begin) * sizeof(Value));
    if (natural_[peer].rank != me && n_bytes > 0) {
      MPI_Isend(begin, static_cast<int>(n_bytes), MPI_BYTE, natural_[peer].rank, tag, mpi,
                &requests_.emplace_back());
      ++sent_.messages;
      sent_.bytes += n_bytes;
    }
  }
  if (to_owner) {
    for (const Field<Value>& field : fields)
      for (const Part& part : *field.parts)
        for (const std::ptrdiff_t ghost : part.ghosts)
          field.values[ghost] = 0;
  }
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  const Value* mine = out;
  const Value* theirs = in;
  for (std::size_t peer = 0; peer < natural_.size(); ++peer) {
    for (const Field<Value>& field : fields) {
      const Part& part = (*field.parts)[peer];
      const Value* from = part.rank == me ? mine : theirs;
      for (const std::ptrdiff_t i : target(part)) {
        if (to_owner)
          field.values[i] += *from++;
        else
          field.values[i] = *from++;
      }
      mine += source(part).size();
      theirs += target(part).size();
    }
  }
}

template void LevelHalo::transfer<float>(const Fields<float>&, bool) const;
template void LevelHalo::transfer<double>(const Fields<double>&, bool) const;
template void LevelHalo::transfer<char>(const Fields<char>&, bool) const;

}  // namespace lockstep
