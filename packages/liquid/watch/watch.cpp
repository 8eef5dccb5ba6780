#include "liquid/watch/watch.hpp"

#include <Eigen/Geometry>
#include <algorithm>

#include "base/errors.hpp"
#include "parameters/expression.hpp"
#include "staggered/domain/parameter_values.hpp"

namespace lockstep {

template <int dim>
void declare_watches(ParameterList& free_surface) {
  ParameterList watch;
  declare_required_vector<double>(
      watch, "Point", dim,
      "A point in the watched place, as the inside of a hull, at the start [m].");
  declare(watch, "Solid", "",
          "The solid that the point moves with, with all of it, if it is soft. Empty: it "
          "stays.");
  declare_optional<double>(
      watch, "Radius",
      "Distance from the point beyond which nothing is watched, as above the rim of a hull [m].");
  set_positive(watch, "Radius");
  declare_named_sublists(
      free_surface, "Watch",
      "Places whose liquid history.csv shows: all that can be reached from a point, through liquid "
      "and air but not through solids.",
      watch);
}

template <int dim>
std::vector<Watch<dim>> read_watches(const ParameterList& free_surface) {
  const ParameterList& list = free_surface.sublist("Watch");
  std::vector<Watch<dim>> watches;
  for (auto it = list.begin(); it != list.end(); ++it) {
    const ParameterList& one = list.sublist(list.name(it));
    Watch<dim> watch;
    watch.name = variable_name(list.name(it));
    watch.point = point_value<dim>(one, "Point");
    watch.solid = one.get<std::string>("Solid");
    if (one.isParameter("Radius"))
      watch.radius = one.get<double>("Radius");
    const auto is_same = [&](const Watch<dim>& other) { return other.name == watch.name; };
    check_input(std::none_of(watches.begin(), watches.end(), is_same),
                "In \"Watch\", two names give the same columns \"watch_{}_volume\"; change one.",
                watch.name);
    watches.push_back(std::move(watch));
  }
  return watches;
}

template <int dim>
Anchor<dim>::Anchor(const Watch<dim>& watch,
                    const std::shared_ptr<const SurfaceSnapshot<dim>>& surface)
    : point_(watch.point) {
  if (watch.solid.empty())
    return;
  const std::vector<SolidDescription> none;
  const auto& solids = surface ? surface->solids() : none;
  const auto named = std::find_if(solids.begin(), solids.end(), [&](const SolidDescription& solid) {
    return solid.name == watch.solid;
  });
  check_input(named != solids.end(),
              "The watch \"{}\" moves with \"{}\", but no solid has this name.", watch.name,
              watch.solid);
  solid_ = static_cast<int>(named - solids.begin());
  start_ = vertices(*surface);
}

template <int dim>
typename Anchor<dim>::Places Anchor<dim>::vertices(const SurfaceSnapshot<dim>& surface) const {
  const SolidDescription& solid = surface.solids()[solid_];
  Places places(dim, solid.vertex_end - solid.vertex_begin);
  for (int v = solid.vertex_begin; v < solid.vertex_end; ++v)
    places.col(v - solid.vertex_begin) = surface.mesh().vertices[v];
  return places;
}

template <int dim>
Point<dim> Anchor<dim>::place(const std::shared_ptr<const SurfaceSnapshot<dim>>& surface) const {
  if (solid_ < 0 || start_.cols() == 0)
    return point_;
  const auto motion = Eigen::umeyama(start_, vertices(*surface), false);
  return motion.template topLeftCorner<dim, dim>() * point_ +
         motion.template topRightCorner<dim, 1>();
}

template void declare_watches<2>(ParameterList&);
template void declare_watches<3>(ParameterList&);
template std::vector<Watch<2>> read_watches<2>(const ParameterList&);
template std::vector<Watch<3>> read_watches<3>(const ParameterList&);
template class Anchor<2>;
template class Anchor<3>;

}  // namespace lockstep
