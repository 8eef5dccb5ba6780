#pragma once
#include <array>
#include <vector>

#include "faces/axis_load.hpp"
#include "interfaces/liquid.hpp"
#include "linear/triplet_matrix.hpp"

namespace lockstep {

/// Pressure of the fluid at rest around one solid: p_h = rho g.(x - x0), with the density of the
/// liquid below x0 and of the gas above; of air without mass zero.
template <int dim>
struct RestPressure {
  Point<dim> gradient = Point<dim>::Zero();  ///< rho g [Pa/m]
  Point<dim> origin = Point<dim>::Zero();    ///< x0: on the free surface, if there is one [m]
  double above = 1;  ///< factor above the surface: 1 for a solid that does not pierce it

  double operator()(const Point<dim>& x) const {
    const double pressure = gradient.dot(x - origin);
    return pressure < 0 ? above * pressure : pressure;
  }
};

/// The fluid that a closed solid displaces.
template <int dim>
struct DisplacedMass {
  int solid = -1;
  double mass = 0;                         ///< [kg]
  Point<dim> center = Point<dim>::Zero();  ///< [m]
};

/// The added mass of a disc (2D) or ball (3D) of each displaced volume, at its centre, on the dofs
/// of rigid solids that are not prescribed. Local.
template <int dim>
std::vector<Triplet> added_mass_of_balls(const std::vector<DisplacedMass<dim>>& displaced,
                                         const SolidSystem<dim>& solids,
                                         const SurfaceSnapshot<dim>& surface);

/// The force of the fluid at rest on closed solids, by axis: F_h, exact for their polyhedra up to
/// the level of the water around them, and what a solve on the grid makes of it, which is
/// W^T M_F g - B^T p_h for the weights W, the lumped fluid M_F and the closed faces B of a
/// coupling. The difference, added to the solids as an explicit force, leaves a body at rest that
/// is at rest, and changes nothing in the coupled solve (docs/method.md, "The hydrostatic force").
template <int dim>
class HydrostaticLoads {
 public:
  /// Takes the fluid's gravity, density and levels. Collective.
  HydrostaticLoads(const FluidDiscretization<dim>& fluid, const SurfaceSnapshot<dim>& surface,
                   double density);

  /// Adds the part of a face that moves with a solid: its area [m^(dim-1)] and centre. Local.
  void add_closed(const ControlVolume<dim>& volume, int solid, double area,
                  const Point<dim>& center);
  /// Adds fluid of a mass [kg] that is lumped on a solid along an axis, and its centre. Local.
  void add_lumped(int axis, int solid, double mass, const Point<dim>& center);
  /// To be called after all of these. Collective.
  void sum(const Communicator& comm);

  /// W^T M_F g - B^T p_h of closed solids and rigid shells along every axis. Local.
  std::vector<AxisLoad<dim>> on_grid() const;
  /// F_h + B^T p_h - W^T M_F g of closed solids, along the axes on which the grid sees both their
  /// ends. A moment is corrected where the grid sees both ends along its lever, too. Local.
  std::vector<AxisLoad<dim>> corrections() const;
  /// Masses of fluid that closed solids displace. Local.
  std::vector<DisplacedMass<dim>> displaced_masses() const;

 private:
  struct Sum {
    double force = 0;                        ///< [N]
    Point<dim> moment = Point<dim>::Zero();  ///< about the centre, across the axis [N m]
    double open_area = 0;  ///< signed area of the closed parts beside a pressure [m^(dim-1)]
    double area = 0;       ///< area of all closed parts [m^(dim-1)]
  };
  /// Cells at one height.
  struct Layer {
    std::array<double, dim> open_area{};     ///< by axis, as in `Sum` [m^(dim-1)]
    Point<dim> moment = Point<dim>::Zero();  ///< moment of vertical forces, as in `Sum` [N m]
  };
  void set_rest(int solid, const Box<dim>& bounds, const WaterLevel* level);
  Layer* layer_at(int solid, const Point<dim>& x);
  double moment_of_even_layers(int solid, int lever) const;
  bool is_covered(int solid, int axis, const Sum& sum) const;
  AxisLoad<dim> exact(int solid, int axis) const;

  const SurfaceSnapshot<dim>& surface_;
  Point<dim> gravity_;
  double density_, gas_density_, spacing_;
  bool is_below_air_;  ///< the fluid has a surface, above which is air without mass
  std::vector<RestPressure<dim>> pressures_;  ///< by solid; zero gradient where there is none
  std::vector<Point<dim>> centers_;           ///< centres of that mass [m]
  std::vector<double> masses_;                ///< masses of the displaced fluid [kg]
  std::vector<std::array<Sum, dim>> sums_;    ///< on the grid
  int vertical_ = -1;                         ///< axis of gravity; -1: it lies along none
  std::vector<std::vector<Layer>> layers_;    ///< by rigid solid, from below its lowest point on
};

}  // namespace lockstep
