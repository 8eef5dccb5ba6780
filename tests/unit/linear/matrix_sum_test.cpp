// Sums of matrices on parts of the rows, against the same sum from triplets.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <random>

#include "linear/matrix_sum.hpp"
#include "linear/symmetry_check.hpp"
#include "linear/triplet_matrix.hpp"

namespace lockstep::test {

namespace {

/// Entries anywhere in the rows of this rank, some of them twice.
std::vector<Triplet> random_entries(const Map& map, int n_per_row, int seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<GlobalIndex> column(
      0, static_cast<GlobalIndex>(map.getGlobalNumElements()) - 1);
  std::vector<Triplet> triplets;
  for (const GlobalIndex row : map.getNodeElementList()) {
    for (int k = 0; k < n_per_row; ++k)
      triplets.push_back({row, column(random), 1.0 / (1 + triplets.size())});
  }
  return triplets;
}

void add(const std::vector<Triplet>& from, GlobalIndex shift, double factor,
         std::vector<Triplet>& to) {
  for (const Triplet& t : from)
    to.push_back({t.row + shift, t.column + shift, factor * t.value});
}

/// Two models' unknowns, one after the other on every rank, as solids are stacked; a row without
/// any entry but its unit at the end.
struct Stacked {
  RCP<const Map> first, second, all;

  explicit Stacked(const Communicator& comm) {
    first = make_map(5 + comm->getRank(), comm);
    second = make_map(comm->getRank() == 1 ? 0 : 4, comm);
    const auto n_first = static_cast<GlobalIndex>(first->getGlobalNumElements());
    const auto n_second = static_cast<GlobalIndex>(second->getGlobalNumElements());
    std::vector<GlobalIndex> ids;
    for (const GlobalIndex id : first->getNodeElementList())
      ids.push_back(id);
    for (const GlobalIndex id : second->getNodeElementList())
      ids.push_back(n_first + id);
    ids.push_back(n_first + n_second + comm->getRank());
    all = rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                      Teuchos::arrayViewFromVector(ids), 0, comm));
  }
};

}  // namespace

TEST(MatrixSum, IsTheSumOfItsTriplets) {
  const Communicator comm = Tpetra::getDefaultComm();
  const Stacked maps(comm);
  const auto shift = static_cast<GlobalIndex>(maps.first->getGlobalNumElements());
  const auto a = random_entries(*maps.first, 3, 1), b = random_entries(*maps.second, 2, 2);
  std::vector<Triplet> c = random_entries(*maps.all, 2, 3), all;
  const int unit = static_cast<int>(maps.all->getNodeNumElements()) - 1;
  const GlobalIndex unit_id = maps.all->getGlobalElement(unit);
  add(a, 0, 1, all);
  add(b, shift, -0.5, all);
  add(c, 0, 2, all);
  all.push_back({unit_id, unit_id, 1});

  const auto sum = sum_of({{assemble_triplets(a, maps.first, maps.first), 0, 1},
                           {assemble_triplets(b, maps.second, maps.second), shift, -0.5},
                           {assemble_triplets(c, maps.all, maps.all), 0, 2}},
                          maps.all, {unit});
  const auto expected = assemble_triplets(all, maps.all, maps.all);
  EXPECT_EQ(sum->getGlobalNumEntries(), expected->getGlobalNumEntries());
  Vector x(maps.all), y(maps.all), difference(maps.all);
  pseudo_random(x, 4);
  sum->apply(x, y);
  expected->apply(x, difference);
  difference.update(-1, y, 1);
  EXPECT_LT(difference.normInf(), 1e-14);
  EXPECT_GT(y.normInf(), 0.1);
  sum->apply(x, y, Teuchos::TRANS);
  expected->apply(x, difference, Teuchos::TRANS);
  difference.update(-1, y, 1);
  EXPECT_LT(difference.normInf(), 1e-14);
}

TEST(MatrixSum, OfNothingHasItsUnitRowsOnly) {
  const auto map = make_map(3, Tpetra::getDefaultComm());
  const auto sum = sum_of({}, map, {1});
  EXPECT_EQ(sum->getNodeNumEntries(), 1U);
  Vector x(map), y(map);
  x.putScalar(2);
  sum->apply(x, y);
  EXPECT_EQ(y.getData()[0], 0);
  EXPECT_EQ(y.getData()[1], 2);
}

}  // namespace lockstep::test
