#pragma once
#include <mpi.h>

#include <Teuchos_Comm.hpp>
#include <Teuchos_RCP.hpp>
#include <string>
#include <type_traits>
#include <utility>
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
/// Sums values over all ranks, number by number, in place and in one message. Collective. A value
/// is a number, a list of values (with `data` and `size`, of one size on all ranks), or a struct
/// whose member template `for_each_part(f)` calls f with each member that is to be summed. Numbers
/// of several values, or in structs, are sent as double; a bool becomes true that is so on any
/// rank.
template <typename... Values>
void sum_over_ranks(const Communicator& comm, Values&... values);
/// Likewise, the largest of all ranks.
template <typename... Values>
void max_over_ranks(const Communicator& comm, Values&... values);
/// Likewise, the smallest of all ranks.
template <typename... Values>
void min_over_ranks(const Communicator& comm, Values&... values);
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

namespace over_ranks {
/// The types of numbers of which MPI takes a list as it is.
struct MpiType {
  static MPI_Datatype of(const double*) { return MPI_DOUBLE; }
  static MPI_Datatype of(const float*) { return MPI_FLOAT; }
  static MPI_Datatype of(const GlobalIndex*) { return MPI_LONG_LONG; }
  static MPI_Datatype of(const char*) { return MPI_SIGNED_CHAR; }
};

template <typename Value, typename = void>
constexpr bool is_list = false;
template <typename Value>
constexpr bool is_list<Value, std::void_t<decltype(std::declval<Value&>().data())>> = true;
template <typename Value, typename = void>
constexpr bool is_plain_list = false;
template <typename Value>
constexpr bool
    is_plain_list<Value, std::void_t<decltype(MpiType::of(std::declval<Value&>().data()))>> = true;

template <typename Value, typename F>
void for_each_number(Value& value, const F& f) {
  if constexpr (std::is_arithmetic_v<Value>)
    f(value);
  else if constexpr (is_list<Value>)
    for (auto part = value.data(), end = part + value.size(); part != end; ++part)
      for_each_number(*part, f);
  else
    value.for_each_part([&f](auto& part) { for_each_number(part, f); });
}

template <typename... Values>
void combine(const Communicator& comm, MPI_Op op, Values&... values) {
  const auto reduce = [&](auto& list) {
    if (list.size() > 0)
      MPI_Allreduce(MPI_IN_PLACE, list.data(), static_cast<int>(list.size()),
                    MpiType::of(list.data()), op, raw_communicator(comm));
  };
  if constexpr (sizeof...(Values) == 1 && (is_plain_list<Values> && ...)) {
    (reduce(values), ...);
  } else {
    std::vector<double> all;
    const auto pack = [&](auto& number) { all.push_back(static_cast<double>(number)); };
    (for_each_number(values, pack), ...);
    reduce(all);
    auto next = all.cbegin();
    const auto unpack = [&](auto& number) {
      number = static_cast<std::remove_reference_t<decltype(number)>>(*next++);
    };
    (for_each_number(values, unpack), ...);
  }
}
}  // namespace over_ranks

template <typename... Values>
void sum_over_ranks(const Communicator& comm, Values&... values) {
  over_ranks::combine(comm, MPI_SUM, values...);
}
template <typename... Values>
void max_over_ranks(const Communicator& comm, Values&... values) {
  over_ranks::combine(comm, MPI_MAX, values...);
}
template <typename... Values>
void min_over_ranks(const Communicator& comm, Values&... values) {
  over_ranks::combine(comm, MPI_MIN, values...);
}

}  // namespace lockstep
