#pragma once
#include <Thyra_LinearOpBase.hpp>
#include <Tpetra_CrsMatrix_decl.hpp>
#include <Tpetra_Import_decl.hpp>
#include <Tpetra_Map_decl.hpp>
#include <Tpetra_MultiVector_decl.hpp>
#include <Tpetra_Vector_decl.hpp>

#include "base/communicator.hpp"

/// The names under which Lockstep uses Tpetra and Thyra. Nothing here is heavy to compile.
namespace lockstep {

using Teuchos::RCP;
using Teuchos::rcp;

using Map = Tpetra::Map<int, GlobalIndex>;
using Vector = Tpetra::Vector<double, int, GlobalIndex>;
using MultiVector = Tpetra::MultiVector<double, int, GlobalIndex>;
using CrsMatrix = Tpetra::CrsMatrix<double, int, GlobalIndex>;
using Import = Tpetra::Import<int, GlobalIndex>;

/// An operator between Thyra spaces with Tpetra vectors underneath: assembled or matrix-free.
using LinearOperator = Thyra::LinearOpBase<double>;

/// Map with `n_local` consecutive ids on this rank, following those of the ranks below. Collective.
RCP<const Map> make_map(int n_local, const Communicator& comm);
RCP<Vector> make_vector(const RCP<const Map>& map);  ///< zero

/// Thyra view of an assembled matrix (shared, not copied).
RCP<const LinearOperator> as_operator(const RCP<const CrsMatrix>& matrix);
/// The assembled matrix behind a Thyra operator, or null if there is none. A StencilOperator is
/// assembled by this call (then collective).
RCP<const CrsMatrix> assembled(const RCP<const LinearOperator>& op);

/// y = alpha op x + beta y for vectors that live on the operator's range and domain. Collective.
void apply(const LinearOperator& op, const Vector& x, Vector& y, double alpha = 1, double beta = 0);
/// y = alpha op^T x + beta y. Collective.
void apply_transposed(const LinearOperator& op, const Vector& x, Vector& y, double alpha = 1,
                      double beta = 0);

}  // namespace lockstep
