#pragma once
#include <string>

#include "interfaces/block_system.hpp"
#include "interfaces/plug_in.hpp"

namespace lockstep {

/// Accuracy that a solve has to reach: the residual of each block is at most `tolerance` times the
/// norm of that block's right-hand side (or the largest term of its rows, if that is larger).
struct SolveRequest {
  std::string name;  ///< "S1", "F2", "S2": for messages
  double tolerance = 1e-8;
  /// A 2-norm of the pressure rows' residual that is round-off of the velocities [m^dim/s]:
  /// reached, the solve is done, even where every term of these rows vanishes and `tolerance` has
  /// nothing to scale with.
  double negligible_pressure_residual = 0;
  long long step = 0;  ///< number of the step, counted as in history.csv; 0: outside of steps
};

struct SolveReport {
  int iterations = 0;
  int solid_iterations = 0;      ///< inner ones, on C
  double pressure_residual = 0;  ///< ||r_1|| / scale_1, recomputed from the solution
  double solid_residual = 0;     ///< ||r_2|| / scale_2
  double setup_seconds = 0, solve_seconds = 0;
  int preconditioner_builds = 0, preconditioner_reuses = 0;
  long stored_nonzeros =
      0;  ///< nonzeros of matrices that the strategy assembled; 0 if it does not count

  /// Adds the cost of another solve whose solution this one replaces.
  void add_work(const SolveReport& other) {
    iterations += other.iterations;
    solid_iterations += other.solid_iterations;
    setup_seconds += other.setup_seconds;
    solve_seconds += other.solve_seconds;
    preconditioner_builds += other.preconditioner_builds;
    preconditioner_reuses += other.preconditioner_reuses;
  }
};

/// A way to solve Eq. 16.
class SolverStrategy : public PlugIn {
 public:
  /// Builds or reuses what depends on the operators (preconditioners, factorisations), judged by
  /// the versions. Throws SolveError with a sentence if the system is outside the strategy's
  /// domain. Collective.
  virtual void prepare(const BlockSystem& system) = 0;
  /// Solves for `solution`, whose content is the initial guess (an exact one is fine). Throws
  /// SolveError with the numbers if the request is not reached. Systems without solid take a
  /// preconditioned CG. Right-hand sides must be compatible with the null space (the caller
  /// projects). Collective.
  virtual SolveReport solve(const BlockSystem& system, const BlockVector& rhs,
                            BlockVector& solution, const SolveRequest& request) = 0;
  /// Returns the inverses of blocks that the last `solve` has used, for tables: "A: Multigrid;
  /// C: exact". Default: nothing to tell. Local.
  virtual std::string inverses() const { return ""; }
};

}  // namespace lockstep
