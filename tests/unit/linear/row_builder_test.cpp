// Rows in any order of their columns, over any maps, become the matrix that they say.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <map>
#include <random>

#include "linear/matrix_rows.hpp"
#include "linear/row_builder.hpp"

namespace lockstep::test {

namespace {

/// Ids that no rank has in a row: rank r of P owns r, r + P, ..., the last one first.
RCP<const Map> scattered_map(int n_local, const Communicator& comm) {
  std::vector<GlobalIndex> ids;
  for (int i = n_local; i-- > 0;)
    ids.push_back(comm->getRank() + static_cast<GlobalIndex>(i) * comm->getSize());
  return rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                     Teuchos::arrayViewFromVector(ids), 0, comm));
}

/// Builds n_entries a row, many columns named twice, and compares entries and products.
void expect_rows(const RCP<const Map>& rows, const RCP<const Map>& domain, int n_entries) {
  std::mt19937 random(3 + rows->getComm()->getRank());
  std::uniform_int_distribution<GlobalIndex> column(0, domain->getGlobalNumElements() - 1);
  using Row = std::map<GlobalIndex, double>;
  std::vector<Row> expected(rows->getNodeNumElements());
  RowBuilder builder(rows, domain);
  int value = 0;
  for (Row& row : expected) {
    for (int k = 0; k < n_entries; ++k) {
      const GlobalIndex id = column(random);
      row[id] += ++value;
      builder.add(id, value);
    }
    const std::size_t place = builder.add(0, 1e9);
    builder.set(place, 0.5);
    row[0] += 0.5;
    builder.end_row();
  }
  const RCP<const CrsMatrix> matrix = builder.finish();
  std::size_t n_expected = 0;
  for (const Row& row : expected)
    n_expected += row.size();
  EXPECT_EQ(matrix->getNodeNumEntries(), n_expected);
  for_each_entry(*matrix, [&](int row, GlobalIndex id, double found) {
    ASSERT_EQ(expected[row].count(id), 1u);
    EXPECT_EQ(found, expected[row][id]);
  });

  Vector x(domain), y(rows);
  for (int i = 0; i < static_cast<int>(domain->getNodeNumElements()); ++i)
    x.replaceLocalValue(i, std::sin(static_cast<double>(domain->getGlobalElement(i))));
  matrix->apply(x, y);
  const auto product = y.getData();
  for (std::size_t row = 0; row < expected.size(); ++row) {
    double sum = 0;
    for (const auto& [id, entry] : expected[row])
      sum += entry * std::sin(static_cast<double>(id));
    EXPECT_NEAR(product[row], sum, 1e-12 * value * n_entries);
  }
  // x . A^T y = y . A x
  Vector back(domain);
  matrix->apply(y, back, Teuchos::TRANS);
  EXPECT_NEAR(back.dot(x), y.dot(y), 1e-12 * y.dot(y));
}

}  // namespace

TEST(RowBuilder, SquareMatricesOfContiguousMaps) {
  const auto map = make_map(6, Tpetra::getDefaultComm());
  expect_rows(map, map, 4);
  expect_rows(map, map, 100);  // long rows
}

TEST(RowBuilder, SquareMatricesOfScatteredMaps) {
  const auto map = scattered_map(5, Tpetra::getDefaultComm());
  expect_rows(map, map, 7);
  expect_rows(map, map, 60);
}

TEST(RowBuilder, OtherDomainsAndRanksWithoutRows) {
  const Communicator comm = Tpetra::getDefaultComm();
  const auto scattered = scattered_map(7, comm);
  const auto few = make_map(is_root(comm) ? 3 : 0, comm);
  expect_rows(make_map(4, comm), scattered, 6);
  expect_rows(scattered, make_map(9, comm), 40);
  expect_rows(few, scattered, 5);
  expect_rows(scattered, few, 5);
}

TEST(RowBuilder, NoEntriesIsTheZeroMatrix) {
  const auto map = make_map(3, Tpetra::getDefaultComm());
  RowBuilder builder(map);
  for (int row = 0; row < 3; ++row)
    builder.end_row();
  EXPECT_EQ(builder.finish()->getGlobalNumEntries(), 0u);
}

}  // namespace lockstep::test
