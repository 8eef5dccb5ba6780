#pragma once
#include <Teuchos_ParameterList.hpp>

#include "interfaces/strategy.hpp"
#include "multigrid/multigrid.hpp"

namespace lockstep {

/// Declares "Pressure Inverse", the list that names the approximate inverse of A. Its "Type" is
///   "Automatic"   the default of most strategies: Multigrid where the fluid's A is a stencil that
///                 it can halve, else MueLu
///   "Multigrid"   the matrix-free geometric multigrid ("Sweeps", 2; "Cycle", "V")
/// or one of solve/preconditioner.hpp, which need an assembled A.
void declare_pressure_inverse(Teuchos::ParameterList& list, const std::string& doc);
/// The list given, checked, or `standard` if there is none. Throws InputError.
Teuchos::ParameterList pressure_inverse_list(const Teuchos::ParameterList& list,
                                             const std::string& standard_type);
/// Returns the list for a strategy whose standard is incomplete Cholesky.
Teuchos::ParameterList incomplete_cholesky_list(const Teuchos::ParameterList& list);

/// True if the list asks for the multigrid of this system.
bool is_multigrid(const Teuchos::ParameterList& list, const BlockSystem& system);
/// Returns the type of the inverse that a list leads to, what "Automatic" chooses included.
std::string inverse_type(const Teuchos::ParameterList& list, bool is_multigrid);
MultigridOptions multigrid_options(const Teuchos::ParameterList& list);
/// The multigrid's cycle on pressures in the fluid's own order. Collective.
RCP<const LinearOperator> multigrid_in_fluid_order(const BlockSystem& system,
                                                   const MultigridOptions& options);

/// True if some cell's row of A is empty, all of its faces being mixed: then the inverse of A
/// depends on C. Collective.
bool leaves_rows_empty(const RCP<const LinearOperator>& pressure_block);

/// A with the diagonal of B diag(C)^-1 B^T, or its own largest, in the rows that it leaves empty,
/// and the first cell of each of its null vectors pinned: for preconditioners that divide by its
/// diagonal or factor it. `a` itself where there are neither. Collective.
RCP<const CrsMatrix> regular_pressure_block(const BlockSystem& system,
                                            const RCP<const CrsMatrix>& a);

/// Any other inverse that a list names, made positive definite where A is not:
/// - a cell all of whose faces are mixed has an empty row in A; its diagonal becomes that of
///   B diag(C)^-1 B^T;
/// - with "Incomplete Cholesky", "Ifpack2" and "Direct", which factor, the first cell of each null
/// vector of A alone is
///   pinned by adding its diagonal once more; with "MueLu" too if a solid closes regions. Multigrid
///   and Jacobi take a singular A.
/// Throws InputError for a bad list, SolveError if the set-up fails. Collective.
RCP<const LinearOperator> pressure_inverse(const BlockSystem& system,
                                           const Teuchos::ParameterList& list);

}  // namespace lockstep
