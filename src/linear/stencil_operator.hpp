#pragma once
#include <Tpetra_Operator.hpp>
#include <array>
#include <memory>
#include <optional>
#include <vector>

#include "linear/types.hpp"

namespace lockstep {

/// Where a rank's cells lie in a Cartesian lattice: in blocks of `width` cells along each axis,
/// whose cells are numbered block after block, x fastest. Fixed as long as the grid has the same
/// blocks.
struct LatticeBlocks {
  int dimension = 3;
  std::array<int, 3> n_cells{1, 1, 1};  ///< cells of the lattice; 1 beyond `dimension`
  std::array<bool, 3> periodic{};
  int width = 8;                           ///< a power of two
  std::vector<std::array<int, 3>> begins;  ///< lattice coordinates, multiples of `width`
  Communicator comm;

  int block_volume() const { return dimension == 3 ? width * width * width : width * width; }
};

/// A pressure block as a stencil: on the row of cell c
///   (A p)_c = unit * [ sum over faces a (p_c - p_neighbour) + (dirichlet_c + reaction_c) p_c ].
/// The coefficients of faces are exact in single precision: what cannot be, belongs rounded into
/// `unit` or into the fluid's own open fractions, so that the fluid and its solver see the same
/// operator.
struct FaceCoefficients {
  std::shared_ptr<const LatticeBlocks> blocks;
  RCP<const Map> map;  ///< map of the rows
  double unit = 1;
  std::vector<int> row;  ///< by cell: its local row, or -1
  /// By cell: coefficient of the face to its lower neighbour along each axis, 0 without coupling.
  std::array<std::vector<float>, 3> lower;
  std::vector<float> dirichlet;  ///< by cell: what fixed pressures beside it add to the diagonal
  /// A cell whose diagonal single precision does not hold: beside fixed pressures, or where two
  /// phases meet.
  struct StiffCell {
    int cell = 0;
    double dirichlet = 0;  ///< in full
    double diagonal = 0;   ///< with that
  };
  std::vector<StiffCell> stiff;  ///< in rising order
  /// By cell: the coefficient of a whole face in its fluid; null, on all ranks: 1, that of one
  /// fluid.
  std::optional<std::vector<float>> regular;
  /// By cell: what gives way to the pressure in it. Null on all ranks or on none: a rank without
  /// cells has an empty one. A fluid has none.
  std::optional<std::vector<float>> reaction;
};

/// A pressure block that can be applied without a matrix, seen as a stencil, and assembled when
/// somebody must have the matrix.
class StencilOperator : public Tpetra::Operator<double, int, GlobalIndex> {
 public:
  virtual const FaceCoefficients& coefficients() const = 0;
  /// Built at the first call and kept. Collective.
  virtual RCP<const CrsMatrix> assembled() const = 0;
};

RCP<const LinearOperator> as_operator(const RCP<const StencilOperator>& op);
/// The stencil behind a Thyra operator, or null if there is none.
const FaceCoefficients* stencil_of(const RCP<const LinearOperator>& op);

}  // namespace lockstep
