// Triplets of all ranks become one matrix.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <map>
#include <random>

#include "linear/matrix_rows.hpp"
#include "linear/triplet_matrix.hpp"

namespace lockstep::test {

namespace {

/// Contribution of rank `rank`: unsorted, to rows of every rank, to some places twice.
std::vector<Triplet> triplets_of(int rank, int n_triplets, GlobalIndex n_rows) {
  std::mt19937 random(7 + rank);
  std::uniform_int_distribution<GlobalIndex> id(0, n_rows - 1);
  std::vector<Triplet> triplets;
  for (int i = 0; i < n_triplets; ++i)
    triplets.push_back({id(random), id(random), 1.0 / (i + 1)});
  triplets.insert(triplets.end(), triplets.begin(), triplets.begin() + n_triplets / 3);
  return triplets;
}

void expect_sums(int n_triplets, int n_local_rows) {
  const Communicator comm = Tpetra::getDefaultComm();
  const auto map = make_map(n_local_rows, comm);
  const auto n_rows = static_cast<GlobalIndex>(map->getGlobalNumElements());
  const auto matrix = assemble_triplets(triplets_of(comm->getRank(), n_triplets, n_rows), map, map);
  std::map<std::pair<GlobalIndex, GlobalIndex>, double> expected;
  for (int rank = 0; rank < comm->getSize(); ++rank) {
    for (const Triplet& t : triplets_of(rank, n_triplets, n_rows)) {
      if (map->isNodeGlobalElement(t.row))
        expected[{t.row, t.column}] += t.value;
    }
  }
  std::size_t n_found = 0;
  for_each_entry(*matrix, [&](int row, GlobalIndex column, double value) {
    const auto place = expected.find({map->getGlobalElement(row), column});
    ASSERT_TRUE(place != expected.end());
    EXPECT_NEAR(value, place->second, 1e-14);
    ++n_found;
  });
  EXPECT_EQ(n_found, expected.size());
}

}  // namespace

TEST(TripletMatrix, ManyInFewRowsAreSummed) {
  expect_sums(400, 7);
}
TEST(TripletMatrix, FewInManyRowsAreSummed) {
  expect_sums(20, 3000);
}
TEST(TripletMatrix, NoneIsTheZeroMatrix) {
  expect_sums(0, 3);
}

}  // namespace lockstep::test
