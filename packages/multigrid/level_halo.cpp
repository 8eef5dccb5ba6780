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

template <typename Value>
void LevelHalo::receive(const Fields<Value>& fields, bool to_owner) const {
  std::size_t n_all = 0;
  for (const Field<Value>& field : fields)
    for (const Part& part : *field.parts)
      n_all += part.target(to_owner).size();
  incoming_.resize(std::max(incoming_.size(), n_all * sizeof(Value)));
  char* next = incoming_.data();
  for (std::size_t peer = 0; peer < natural_.size(); ++peer) {
    std::size_t n = 0;
    for (const Field<Value>& field : fields)
      n += (*field.parts)[peer].target(to_owner).size();
    if (natural_[peer].rank != comm_->getRank() && n > 0)
      MPI_Irecv(next, static_cast<int>(n * sizeof(Value)), MPI_BYTE, natural_[peer].rank, tag,
                raw_communicator(comm_), &requests_.emplace_back());
    next += n * sizeof(Value);
  }
}

template <typename Value>
void LevelHalo::send(const Fields<Value>& fields, bool to_owner) const {
  std::size_t n_all = 0;
  for (const Field<Value>& field : fields)
    for (const Part& part : *field.parts)
      n_all += part.source(to_owner).size();
  outgoing_.resize(std::max(outgoing_.size(), n_all * sizeof(Value)));
  auto* next = reinterpret_cast<Value*>(outgoing_.data());
  for (std::size_t peer = 0; peer < natural_.size(); ++peer) {
    Value* const begin = next;
    for (const Field<Value>& field : fields)
      for (const std::ptrdiff_t i : (*field.parts)[peer].source(to_owner))
        *next++ = field.source(to_owner)[i];
    const auto n_bytes = static_cast<long long>((next - begin) * sizeof(Value));
    if (natural_[peer].rank == comm_->getRank() || n_bytes == 0)
      continue;
    MPI_Isend(begin, static_cast<int>(n_bytes), MPI_BYTE, natural_[peer].rank, tag,
              raw_communicator(comm_), &requests_.emplace_back());
    ++sent_.messages;
    sent_.bytes += n_bytes;
  }
}

/// Takes in the values that the peers have sent, and those that this rank has sent to itself.
template <typename Value>
void LevelHalo::take_in(const Fields<Value>& fields, bool to_owner) const {
  const auto* mine = reinterpret_cast<const Value*>(outgoing_.data());
  const auto* theirs = reinterpret_cast<const Value*>(incoming_.data());
  for (std::size_t peer = 0; peer < natural_.size(); ++peer) {
    for (const Field<Value>& field : fields) {
      const Part& part = (*field.parts)[peer];
      const Value* from = part.rank == comm_->getRank() ? mine : theirs;
      for (const std::ptrdiff_t i : part.target(to_owner)) {
        if (to_owner)
          field.target(to_owner)[i] += *from++;
        else
          field.target(to_owner)[i] = *from++;
      }
      mine += part.source(to_owner).size();
      theirs += part.target(to_owner).size();
    }
  }
}

template <typename Value>
void LevelHalo::transfer(const Fields<Value>& fields, bool to_owner) const {
  if (empty_)
    return;
  requests_.clear();
  receive(fields, to_owner);
  send(fields, to_owner);
  if (to_owner) {
    for (const Field<Value>& field : fields)
      for (const Part& part : *field.parts)
        for (const std::ptrdiff_t ghost : part.ghosts)
          field.ghosts[ghost] = 0;
  }
  MPI_Waitall(static_cast<int>(requests_.size()), requests_.data(), MPI_STATUSES_IGNORE);
  take_in(fields, to_owner);
}

template void LevelHalo::transfer<float>(const Fields<float>&, bool) const;
template void LevelHalo::transfer<double>(const Fields<double>&, bool) const;
template void LevelHalo::transfer<char>(const Fields<char>&, bool) const;

}  // namespace lockstep
