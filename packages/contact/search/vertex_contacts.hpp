#pragma once
#include <optional>
#include <vector>

#include "contact/search/contact_search.hpp"

namespace lockstep {

/// Vertices of one solid against the surface of another.
template <int dim>
class VertexContacts {
 public:
  VertexContacts(const ContactShapes<dim>& shapes, const SolidMotion<dim>& motion,
                 const ContactReach& reach, int solid, int other);
  void find(std::vector<Contact<dim>>& contacts);

 private:
  struct Hit {
    SurfacePoint<dim> point;
    Point<dim> normal = Point<dim>::Zero();  ///< normal of the surface, towards the vertex
    double distance = 0;                     ///< signed [m]
  };

  void collect_simplices();
  void against_surface(int vertex, const Point<dim>& x, const Point<dim>& normal,
                       std::vector<Contact<dim>>& contacts);
  /// Fills `inner_` with hits inside simplices, for corners that touch several sides.
  std::optional<Hit> closest(const Point<dim>& x, const Point<dim>& normal);
  std::optional<Hit> crossed_shell(const Hit& hit, const Point<dim>& normal) const;
  std::optional<Hit> swept(const Point<dim>& x, const Point<dim>& displacement) const;
  bool faces(const Point<dim>& vertex_normal, const Point<dim>& normal) const;
  void add(int vertex, const Hit& hit, const Point<dim>& x,
           std::vector<Contact<dim>>& contacts) const;

  const ContactShapes<dim>& shapes_;
  const SolidMotion<dim>& motion_;
  const ContactReach& reach_;
  int solid_, other_;
  bool solid_closed_, other_closed_;
  double thickness_;  ///< half thicknesses of both
  double near_;       ///< including the thickness
  double farthest_;   ///< largest distance of a simplex, on either side of it
  std::vector<int> simplices_;
  Box<dim> simplices_box_;
  std::vector<Hit> inner_;
};

}  // namespace lockstep
