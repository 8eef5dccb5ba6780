#include "lines/line_law.hpp"

#include <algorithm>

namespace lockstep {

template <int dim>
std::vector<Point<dim>> LineLaw<dim>::shape(const Point<dim>& way) const {
  return {Point<dim>::Zero(), way};
}

namespace {

template <int dim>
class SpringLaw : public LineLaw<dim> {
 public:
  explicit SpringLaw(const SpringParameters& parameters) : of_(parameters) {}

  LineResponse<dim> response(const Point<dim>& way) const override {
    using Matrix = Eigen::Matrix<double, dim, dim>;
    LineResponse<dim> response;
    const double length = way.norm(), stretch = length - of_.length;
    if (of_.tension_only && stretch <= 0)
      return response;
    const double tension = of_.stiffness * stretch;
    const Point<dim> along = length > 0 ? Point<dim>(way / length) : Point<dim>::Zero();
    response.energy = 0.5 * tension * stretch;
    response.force = {Point<dim>(tension * along), Point<dim>(-tension * along)};
    response.tension = {tension, tension};
    // Compressed springs give way to the side, which no implicit force may do.
    const double across = length > 0 ? std::max(0., tension / length) : of_.stiffness;
    const Matrix projection = along * along.transpose();
    response.stiffness = of_.stiffness * projection + across * (Matrix::Identity() - projection);
    response.damping = of_.damping * projection;
    return response;
  }

 private:
  SpringParameters of_;
};

}  // namespace

template <int dim>
std::shared_ptr<const LineLaw<dim>> spring_law(const SpringParameters& parameters) {
  return std::make_shared<SpringLaw<dim>>(parameters);
}

template class LineLaw<2>;
template class LineLaw<3>;
template std::shared_ptr<const LineLaw<2>> spring_law<2>(const SpringParameters&);
template std::shared_ptr<const LineLaw<3>> spring_law<3>(const SpringParameters&);

}  // namespace lockstep
