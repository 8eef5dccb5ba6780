// Inverses of C = M - dt D of a soft solid, from a solid of mass to one that is nearly rigid.
#include <gtest/gtest.h>

#include <Tpetra_Core.hpp>
#include <Tpetra_CrsMatrix.hpp>
#include <Tpetra_Vector.hpp>
#include <algorithm>

#include "base/errors.hpp"
#include "linear/action_operator.hpp"
#include "linear/matrix_part.hpp"
#include "linear/matrix_rows.hpp"
#include "linear/matrix_sum.hpp"
#include "linear/symmetry_check.hpp"
#include "solve/block_residual.hpp"
#include "solve/preconditioner.hpp"
#include "solve/soft/additive_multilevel.hpp"
#include "solve/soft/aggregation.hpp"
#include "solve/soft/component_cholesky.hpp"
#include "solve/soft/exact_inverse.hpp"
#include "solve/soft/inverse_by_cost.hpp"
#include "solve/soft/multifrontal_cholesky.hpp"
#include "solve/soft/single_precision.hpp"
#include "unit/solve/spring_lattice.hpp"

namespace lockstep::test {

TEST(SoftSolid, StiffnessNumberComparesTheTraces) {
  // Two nodes by two: each has springs along x and y (k e e^T: trace k each) and one diagonal.
  const Lattice solid(2, 5);
  EXPECT_NEAR(stiffness_number(*solid.c, solid.space), 1 + 0.5 * 3 * 5, 1e-12);
  EXPECT_EQ(stiffness_number(*solid.c, {}), 1);
  EXPECT_NEAR(stiffness_number(*Lattice(3, 0).c, Lattice(3, 0).space), 1, 1e-12);
}

TEST(SoftSolid, MassIsFoundInC) {
  const Lattice solid(5, 1e3);
  const auto inverse = block_diagonal_mass_inverse(solid.c, solid.space, "solid");
  Vector ones(solid.c->getRowMap()), x(solid.c->getRowMap());
  ones.putScalar(1);
  apply(*inverse, ones, x);
  const auto values = x.getData();
  for (int row = 0; row < static_cast<int>(values.size()); ++row)
    EXPECT_NEAR(values[row], solid.space.body_of_row[row] == 0 ? 1 : 1. / 3, 1e-10);
}

TEST(SoftSolid, MultigridIsFlatInStiffnessAndSize) {
  const long soft = iterations(Lattice(24, 1), "MueLu");
  for (const double k : {1e2, 1e4, 1e8})
    EXPECT_LE(iterations(Lattice(24, k), "MueLu"), soft + 12) << k;
  EXPECT_LE(iterations(Lattice(48, 1e4), "MueLu"), soft + 14);
  EXPECT_GT(iterations(Lattice(48, 1e4), "Jacobi"), 8 * soft);
}

TEST(SoftSolid, ComponentsAreFoundAcrossRanks) {
  const Lattice solid(12, 1);
  const auto components = components_of_rows(*solid.c);
  const GlobalIndex n_rows = 2 * 12 * 12;
  for (std::size_t row = 0; row < components.size(); ++row) {
    const bool is_node = solid.space.body_of_row[row] == 0;
    EXPECT_EQ(components[row].id, is_node ? 0 : n_rows);
    EXPECT_EQ(components[row].n_rows, is_node ? n_rows : 1);
  }
  // Without springs every dof is alone.
  const Lattice loose(3, 0);
  for (const RowComponent& component : components_of_rows(*loose.c))
    EXPECT_EQ(component.n_rows, 1);
}

TEST(SoftSolid, FactorsByFronts) {
  // Two grids that do not touch and a lone row, three rows a vertex; a far pair of vertices.
  constexpr int width = 9, n_vertices = 2 * width * width + 1, n = 3 * n_vertices;
  std::vector<Eigen::Triplet<double>> entries;
  const auto couple = [&](int p, int q) {
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        if (3 * p + a > 3 * q + b)
          entries.emplace_back(3 * p + a, 3 * q + b, std::sin(1.0 + 7 * p + 5 * q + 3 * a + b));
  };
  for (int grid = 0; grid < 2; ++grid)
    for (int p = 0; p < width * width; ++p) {
      const int vertex = grid * width * width + p;
      couple(vertex, vertex);
      if (p % width > 0)
        couple(vertex, vertex - 1);
      if (p >= width)
        couple(vertex, vertex - width);
    }
  couple(width * width - 1, 0);
  for (int row = 0; row < n; ++row)
    entries.emplace_back(row, row, 20);
  MultifrontalCholesky::Matrix lower(n, n);
  lower.setFromTriplets(entries.begin(), entries.end());
  MultifrontalCholesky cholesky;
  cholesky.analyze(lower);
  EXPECT_LT(cholesky.n_stored(), 0.3 * n * n);
  const Eigen::VectorXd rhs = Eigen::VectorXd::LinSpaced(n, -1, 2);
  for (const double factor : {1.0, 3.0}) {
    const MultifrontalCholesky::Matrix scaled = factor * lower;
    ASSERT_TRUE(cholesky.factorize(scaled));
    Eigen::VectorXd x = rhs;
    cholesky.solve(x);
    EXPECT_LT((rhs - scaled.selfadjointView<Eigen::Lower>() * x).norm(), 1e-13 * rhs.norm());
  }
  lower.coeffRef(n / 2, n / 2) = -20;
  EXPECT_FALSE(cholesky.factorize(lower));
}

TEST(SoftSolid, CholeskyOfCheapComponentsOnly) {
  const Lattice solid(12, 1e4);
  const auto components = components_of_rows(*solid.c);
  const auto all = cheap_component_cholesky(solid.c, components, 1e9, "solid");
  EXPECT_EQ(std::count(all.is_factored.begin(), all.is_factored.end(), false), 0);
  EXPECT_LT(error_of(*all.inverse, *solid.c), 1e-9);
  // The lone dof takes one multiplication, the lattice thousands.
  const auto one = cheap_component_cholesky(solid.c, components, 10, "solid");
  for (std::size_t row = 0; row < components.size(); ++row)
    EXPECT_EQ(one.is_factored[row], solid.space.body_of_row[row] < 0);
  Vector rhs(solid.c->getRowMap()), x(solid.c->getRowMap());
  rhs.putScalar(6);
  apply(*one.inverse, rhs, x);
  const auto values = x.getData();
  for (std::size_t row = 0; row < components.size(); ++row)
    EXPECT_NEAR(values[row], one.is_factored[row] ? 2 : 0, 1e-14);
}

TEST(SoftSolid, StoredZerosTieNoComponents) {
  // Two chains whose rows take turns; every row of one has a zero in every column of the other.
  const Communicator comm = Tpetra::getDefaultComm();
  constexpr int n = 400;
  const auto map = make_map(comm->getRank() == 0 ? n : 0, comm);
  std::vector<std::vector<Entry>> rows(map->getNodeNumElements());
  for (int i = 0; i < static_cast<int>(rows.size()); ++i) {
    for (int j = 0; j < n; ++j) {
      const int apart = std::abs(i - j);
      if (apart % 2 == 1 || apart <= 2)
        rows[i].push_back({j, apart == 0 ? 3.0 : apart == 2 ? -1.0 : 0.0});
    }
  }
  const auto matrix = matrix_from_rows(map, rows);
  const auto components = components_of_rows(*matrix);
  for (std::size_t row = 0; row < components.size(); ++row) {
    EXPECT_EQ(components[row].id, static_cast<GlobalIndex>(row % 2));
    EXPECT_EQ(components[row].n_rows, n / 2);
  }
  // Factors of a chain are cheap; those of a full matrix of n / 2 rows take 1.3e6 operations.
  const auto cholesky = cheap_component_cholesky(matrix, components, 1e5, "solid");
  EXPECT_EQ(std::count(cholesky.is_factored.begin(), cholesky.is_factored.end(), false), 0);
  EXPECT_LT(error_of(*cholesky.inverse, *matrix), 1e-13);
}

TEST(SoftSolid, IndefiniteMatricesHaveNoCholeskyFactors) {
  const Lattice solid(6, -1);
  const auto components = components_of_rows(*solid.c);
  EXPECT_THROW(cheap_component_cholesky(solid.c, components, 1e9, "solid"), SolveError);
}

TEST(SoftSolid, InverseByCostIteratesOnWhatIsLeft) {
  const Lattice small(20, 1e3);
  EXPECT_TRUE(InverseByCost(as_operator(small.c), small.space, "solid").is_complete());
  // 5 000 rows: factored where an iteration would be slow, or no motions tell.
  const Lattice soft(50, 10), stiff(50, 1e4);
  EXPECT_FALSE(InverseByCost(as_operator(soft.c), soft.space, "solid").is_complete());
  EXPECT_TRUE(InverseByCost(as_operator(stiff.c), stiff.space, "solid").is_complete());
  EXPECT_TRUE(InverseByCost(as_operator(soft.c), {}, "solid").is_complete());

  // A preconditioner takes factors of a sheet at any stiffness, unless it is made of too many
  // nodes.
  const InverseByCost sheet(as_operator(soft.c), soft.space, "solid");
  const auto factors = sheet.cheap_factors(sheet.rests()[0]);
  ASSERT_FALSE(factors.is_null());
  EXPECT_LT(error_of(*factors, *assembled(sheet.rests()[0].op)), 1e-11);

  const Lattice solid(160, 10);  // 51 200 rows and one
  const InverseByCost split(as_operator(solid.c), solid.space, "solid");
  ASSERT_EQ(split.rests().size(), 1u);
  const auto rest = assembled(split.rests()[0].op);
  EXPECT_EQ(rest->getGlobalNumRows(), 2 * 160 * 160);
  const NearNullSpace& motions = split.rests()[0].motions;
  EXPECT_EQ(std::count(motions.body_of_row.begin(), motions.body_of_row.end(), -1), 0);
  EXPECT_NEAR(motions.mass->norm1(), 2 * 160 * 160, 1e-6);
  const auto inverse = split.with([](const InverseByCost::Rest& one) {
    return conjugate_gradient_inverse(one.op, 1e-12, 5000, "rest");
  });
  EXPECT_LT(error_of(*inverse, *solid.c), 1e-11);
}

/// Motions in the plane of a flat cloth and out of it are coupled only by their nodes.
TEST(SoftSolid, NodesAreNotTornApart) {
  const Lattice solid(40, 10);
  const Map& map = *solid.c->getRowMap();
  std::vector<std::vector<Entry>> rows(map.getNodeNumElements());
  for_each_entry(*solid.c, [&](int row, GlobalIndex column, double value) {
    const GlobalIndex id = map.getGlobalElement(row);
    if (id % 2 == column % 2 || solid.space.body_of_row[row] < 0)
      rows[row].push_back({column, value});
  });
  const auto flat = matrix_from_rows(solid.c->getRowMap(), rows);
  EXPECT_EQ(components_of_rows(*flat)[0].n_rows, 40 * 40);
  const InverseByCost split(as_operator(RCP<const CrsMatrix>(flat)), solid.space, "cloth");
  ASSERT_EQ(split.rests().size(), 1u);
  const InverseByCost::Rest& rest = split.rests()[0];
  EXPECT_EQ(assembled(rest.op)->getGlobalNumRows(), 2 * 40 * 40);
  const auto levels = additive_multilevel_inverse(assembled(rest.op), rest.motions, "cloth");
  EXPECT_NO_THROW(check_symmetric_positive(*levels, "levels", 1e-10));
}

TEST(SoftSolid, LargePartsAreIteratedOnOneByOne) {
  const Lattice one(40, 10), other(40, 50);
  const Map& part = *one.c->getRowMap();
  const auto n = static_cast<GlobalIndex>(part.getGlobalNumElements());
  std::vector<GlobalIndex> ids;
  for (const GlobalIndex shift : {GlobalIndex(0), n}) {
    for (const GlobalIndex id : part.getNodeElementList())
      ids.push_back(id + shift);
  }
  const RCP<const Map> map =
      rcp(new Map(Teuchos::OrdinalTraits<Tpetra::global_size_t>::invalid(),
                  Teuchos::arrayViewFromVector(ids), 0, Tpetra::getDefaultComm()));
  const RCP<const CrsMatrix> both = sum_of({{one.c, 0, 1}, {other.c, n, 1}}, map);
  NearNullSpace space;
  space.n_bodies = 2;
  const auto motions = rcp(new MultiVector(map, 3));
  const auto mass = make_vector(map);
  for (const auto* solid : {&one, &other}) {
    const std::size_t begin = space.body_of_row.size();
    for (const int body : solid->space.body_of_row)
      space.body_of_row.push_back(body < 0 ? -1 : solid == &other);
    motions->offsetViewNonConst(one.c->getRowMap(), begin)->update(1, *solid->space.motions, 0);
    mass->offsetViewNonConst(one.c->getRowMap(), begin)->update(1, *solid->space.mass, 0);
  }
  space.motions = motions;
  space.mass = mass;

  const InverseByCost split(as_operator(both), space, "solids");
  ASSERT_EQ(split.rests().size(), 2u);
  EXPECT_NEAR((split.rests()[1].stiffness - 1) / (split.rests()[0].stiffness - 1), 5, 1e-9);
  const auto inverse = split.with([](const InverseByCost::Rest& rest) {
    return conjugate_gradient_inverse(rest.op, 1e-12, 5000, "rest");
  });
  EXPECT_LT(error_of(*inverse, *both), 1e-11);
}

/// Elastic forces that cancel leave round-off, and no strategy can do better.
TEST(SoftSolid, ResidualsAreNotMeasuredBelowRoundOff) {
  for (const double k : {1e2, 1e10}) {
    const Lattice solid(12, k);
    BlockSystem system;
    const auto pressures = make_map(1, Tpetra::getDefaultComm());
    const auto nothing = [&](const RCP<const Map>& rows) {
      return matrix_from_rows(rows, std::vector<std::vector<Entry>>(rows->getNodeNumElements()),
                              pressures);
    };
    system.set_blocks(as_operator(RCP<const CrsMatrix>(nothing(pressures))),
                      nothing(solid.c->getRowMap()), as_operator(solid.c));
    const auto velocity = make_vector(solid.c->getRowMap()),
               momentum = make_vector(velocity->getMap());
    velocity->update(1, *solid.space.motions->getVector(0), 3, *solid.space.motions->getVector(1),
                     0);
    momentum->elementWiseMultiply(1, *solid.space.mass, *velocity, 0);
    const BlockResidual residual = block_residual(system, {make_vector(pressures), momentum},
                                                  {make_vector(pressures), velocity});
    EXPECT_LT(residual.relative_solid(), 1e-9);
    if (k < 1e6) {
      EXPECT_NEAR(residual.solid_scale, momentum->norm2(), 1e-8 * momentum->norm2());
    }
  }
}

}  // namespace lockstep::test
