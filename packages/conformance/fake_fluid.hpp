#pragma once
#include <functional>
#include <vector>

#include "interfaces/fluid_sides.hpp"
#include "interfaces/viscosity.hpp"

namespace lockstep {

enum class FakeFaceKind { inactive, wall, free, coupled };

/// A fluid in a box of a few cells between walls.
template <int dim>
struct FakeBox {
  Index<dim> n_cells{};
  double spacing = 1;                       ///< h [m]
  Point<dim> lower = Point<dim>::Zero();    ///< corner [m]
  double density = 1;                       ///< [kg/m^dim]
  double viscosity = 0;                     ///< dynamic [Pa s]; walls are slip walls
  Point<dim> gravity = Point<dim>::Zero();  ///< [m/s^2]
  int open_axis = -1;                       ///< p = 0 at the upper side of this axis; -1: closed
};

template <int dim>
class FakeFluid;

/// Its viscosity: the 5-point (7-point) formula of every velocity component.
template <int dim>
class FakeViscosity : public ViscousFluid<dim> {
 public:
  explicit FakeViscosity(FakeFluid<dim>& fluid) : fluid_(fluid) {}
  std::unique_ptr<ViscousSystem<dim>> viscous_system() const override;
  Momentum<dim> accept_viscous(const Vector& solution, const Vector& velocity, double dt) override;

 private:
  using FaceKind = FakeFaceKind;

  /// Coefficient of a viscous coupling [kg/s].
  double bond() const;
  /// Calls `visit(neighbour, axis of the coupling)` for the faces of the same axis beside it.
  template <typename Face, typename Visit>
  void for_each_neighbour(const Face& face, Visit visit) const;

  FakeFluid<dim>& fluid_;
};

/// The fluid partner in tests of solids, couplings and solvers: staggered velocities on FakeBox.
/// Cells, faces and velocities are replicated on every rank, so that a reader can follow each
/// number; only the pressure unknowns (active cells in lexicographic order, in equal shares) and
/// the lists an interface calls local are distributed. Nothing is transported: u* = u^n.
template <int dim>
class FakeFluid : public FluidDiscretization<dim>, public AuditedFluid<dim> {
  friend class FakeViscosity<dim>;

 public:
  using typename FluidDiscretization<dim>::Surface;
  using FaceKind = FakeFaceKind;
  struct Face {
    FaceKind kind = FaceKind::inactive;
    int owner = 0;       ///< rank of its first active cell
    bool open = false;   ///< on the open side
    Index<dim> index{};  ///< index of the cell above it
    ControlVolume<dim> volume;
  };

  FakeFluid(const FakeBox<dim>& box, const Communicator& comm);

  /// Sets u^n = u* on every face, walls included. Local.
  void set_velocity(const std::function<double(int axis, const Point<dim>& x)>& velocity);
  /// All faces, axis by axis, in lexicographic order; `volume.id` is the place in this list.
  const std::vector<Face>& faces() const { return faces_; }
  const std::vector<double>& predicted() const { return predicted_; }  ///< u* of all faces

  std::string name() const override { return "fake fluid"; }
  const AuditedFluid<dim>* audit() const override { return this; }
  ViscousFluid<dim>* viscosity() override { return box_.viscosity > 0 ? &viscosity_ : nullptr; }
  void save(CheckpointWriter& checkpoint) const override;
  void load(const CheckpointReader& checkpoint) override;
  void divergence(Vector& rhs) const override;
  void project(const Vector& scaled_pressure) override;
  std::vector<double> coupled_velocity() const override;
  void set_coupled_velocity(const std::vector<double>& velocity) override;

  void begin_prediction() override { predicted_ = velocity_; }
  ForceImpulse<dim> add_forces(double time, double dt) override;
  void advect(double, double, const MovingSurface<dim>&) override { predicted_ = velocity_; }
  void accept() override { velocity_ = predicted_; }

  double smallest_length() const override { return box_.spacing; }
  double largest_speed() const override;
  double density(const Point<dim>&) const override { return box_.density; }
  Box<dim> bounds() const override {
    Point<dim> upper = box_.lower;
    for (int a = 0; a < dim; ++a)
      upper[a] += box_.n_cells[a] * box_.spacing;
    return Box<dim>(box_.lower, upper);
  }
  Point<dim> gravity() const override { return box_.gravity; }
  Momentum<dim> momentum() const override;
  double kinetic_energy() const override;
  Momentum<dim> boundary_pressure_impulse(const Vector& scaled_pressure) const override;

 protected:
  const FluidGeometry<dim>& freeze(const Surface& surface,
                                   const OpenFractionRule<dim>& rule) override;

 private:
  void make_faces();
  int cell_at(const Index<dim>& index) const;  ///< -1 outside the box
  int face_at(int axis, const Index<dim>& index) const;
  void number_cells(const SurfaceSnapshot<dim>& surface);
  void classify(Face& face, const SurfaceSnapshot<dim>& surface, const OpenFractionRule<dim>& rule);
  void find_cut_cells(const SurfaceSnapshot<dim>& surface);
  void find_regions();
  void assemble_pressure_block();
  double mass(const Face& face) const;
  bool owned(const Face& face) const { return face.owner == comm_->getRank(); }
  /// Every rank's values for its faces of this kind, into u* of all ranks. Collective.
  void replicate(FaceKind kind, const std::vector<double>& mine);
  std::vector<double> everywhere(const Vector& pressure) const;

  FakeBox<dim> box_;
  Communicator comm_;
  std::vector<Face> faces_;
  std::array<int, dim + 1> first_face_{};
  std::vector<double> velocity_, predicted_;
  Surface surface_;
  std::vector<GlobalIndex> unknown_;  ///< unknown of each cell, no_index inside solids
  std::vector<int> solid_;            ///< solid of each cell, -1 in the fluid
  std::vector<int> rank_of_unknown_;
  FluidGeometry<dim> frozen_;
  FakeViscosity<dim> viscosity_{*this};
};

}  // namespace lockstep
