#include "coupling/spin_couples.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cmath>

namespace lockstep {
namespace {

template <int dim>
constexpr int n_motions = dim + n_rotations<dim>;
/// Velocity along a link's direction of the unit translations and rotations.
template <int dim>
using Motions = Eigen::Matrix<double, n_motions<dim>, 1>;

/// Rotations in units of 1 / `length`, so that all entries are of one size.
template <int dim>
Motions<dim> motions_at(const Point<dim>& arm, int direction, double length) {
  Motions<dim> motions = Motions<dim>::Zero();
  motions[direction] = 1;
  for (int k = 0; k < n_rotations<dim>; ++k)
    motions[dim + k] =
        rotate<dim>(AngularVector<dim>::Unit(k), Point<dim>(arm / length))[direction];
  return motions;
}

/// mu area [kg m/s] of the coupling: the weight of its end, as of a patch of surface.
template <int dim>
double weight_of(const ViscousCouplingTerm<dim>& link) {
  return link.coefficient * link.reach.norm();
}

}  // namespace

template <int dim>
struct SpinCouples<dim>::Fit {
  Eigen::Matrix<double, n_motions<dim>, n_motions<dim>> normal =
      Eigen::Matrix<double, n_motions<dim>, n_motions<dim>>::Zero();
  AngularVector<dim> strength = AngularVector<dim>::Zero();
  double length = 1;  ///< [m]

  template <typename F>
  void for_each_part(const F& f) {
    f(normal);
    f(strength);
  }
  /// True if the ends of the couplings determine all rigid motions.
  bool determined() const {
    const Eigen::SelfAdjointEigenSolver<decltype(normal)> solver(normal, Eigen::EigenvaluesOnly);
    return solver.eigenvalues()[0] > 1e-6 * solver.eigenvalues()[n_motions<dim> - 1];
  }
};

template <int dim>
void SpinCouples<dim>::place_centers(const std::vector<ViscousCouplingTerm<dim>>& links,
                                     const std::vector<EndVelocity<dim>>& ends) {
  center_.assign(center_.size(), Point<dim>::Zero());
  std::vector<double> weight(center_.size(), 0);
  for (std::size_t l = 0; l < links.size(); ++l) {
    if (solid_[l] < 0)
      continue;
    center_[solid_[l]] += weight_of<dim>(links[l]) * ends[l].position;
    weight[solid_[l]] += weight_of<dim>(links[l]);
  }
  sum_over_ranks(comm_, center_, weight);
  for (std::size_t s = 0; s < center_.size(); ++s)
    if (weight[s] > 0)
      center_[s] /= weight[s];
}

template <int dim>
std::vector<typename SpinCouples<dim>::Fit> SpinCouples<dim>::fit(
    const std::vector<ViscousCouplingTerm<dim>>& links,
    const std::vector<EndVelocity<dim>>& ends) const {
  std::vector<Fit> fits(center_.size());
  for (std::size_t l = 0; l < links.size(); ++l) {
    if (solid_[l] < 0)
      continue;
    Fit& fit = fits[solid_[l]];
    const int direction = links[l].direction;
    const Point<dim> arm = ends[l].position - center_[solid_[l]];
    const Motions<dim> motions = motions_at<dim>(arm, direction, 1);
    fit.normal += weight_of<dim>(links[l]) * motions * motions.transpose();
    const Point<dim> reach = links[l].coefficient * links[l].reach;
    for (int across = 0; across < dim; ++across)
      if (across != direction)  // the axis about which they turn
        fit.strength[dim == 2 ? 0 : 3 - across - direction] -= reach[across] * arm[across];
  }
  sum_over_ranks(comm_, fits);
  for (Fit& fit : fits) {
    const double translation = fit.normal(0, 0);
    const double rotation = fit.normal(n_motions<dim> - 1, n_motions<dim> - 1);
    if (translation <= 0 || rotation <= 0)
      continue;
    fit.length = std::sqrt(rotation / translation);
    fit.normal.template rightCols<n_rotations<dim>>() /= fit.length;
    fit.normal.template bottomRows<n_rotations<dim>>() /= fit.length;
  }
  return fits;
}

template <int dim>
SpinCouples<dim>::SpinCouples(const std::vector<ViscousCouplingTerm<dim>>& links,
                              const std::vector<EndVelocity<dim>>& ends,
                              const std::vector<SolidDescription>& solids, const Communicator& comm)
    : comm_(comm),
      solid_(links.size(), -1),
      spin_(links.size(), AngularVector<dim>::Zero()),
      center_(solids.size()) {
  for (std::size_t l = 0; l < links.size(); ++l)
    solid_[l] = ends[l].solid;
  place_centers(links, ends);
  std::vector<Fit> fits = fit(links, ends);
  std::vector<AngularVector<dim>> strength(solids.size(), AngularVector<dim>::Zero());
  for (std::size_t s = 0; s < solids.size(); ++s) {
    Fit& fit = fits[s];
    if (!fit.determined())
      continue;
    fit.normal = fit.normal.inverse().eval();
    // A soft container that deforms would gain energy from a negative one.
    strength[s] = solids[s].rigid ? fit.strength : AngularVector<dim>(fit.strength.cwiseMax(0));
  }
  keep_turning(fits, links, ends, strength);
}

/// Numbers those that turn anew: what is summed over ranks in every product should be theirs alone.
template <int dim>
void SpinCouples<dim>::keep_turning(const std::vector<Fit>& fits,
                                    const std::vector<ViscousCouplingTerm<dim>>& links,
                                    const std::vector<EndVelocity<dim>>& ends,
                                    const std::vector<AngularVector<dim>>& strength) {
  std::vector<int> number(strength.size(), -1);
  for (std::size_t s = 0; s < strength.size(); ++s) {
    if (strength[s].isZero(0))
      continue;
    number[s] = static_cast<int>(strength_.size());
    strength_.push_back(strength[s]);
  }
  empty_ = strength_.empty();
  rates_.resize(n_rotations<dim> * strength_.size());
  for (std::size_t l = 0; l < links.size(); ++l) {
    const int s = solid_[l];
    solid_[l] = s < 0 ? -1 : number[s];
    if (solid_[l] < 0)
      continue;
    const Motions<dim> motions =
        motions_at<dim>(ends[l].position - center_[s], links[l].direction, fits[s].length);
    spin_[l] = weight_of<dim>(links[l]) / fits[s].length *
               (fits[s].normal.template bottomRows<n_rotations<dim>>() * motions);
  }
}

template <int dim>
void SpinCouples<dim>::add_pull(const double* end_velocity, double* pull) const {
  if (empty_)
    return;
  std::fill(rates_.begin(), rates_.end(), 0);
  const auto rate = [this](int solid) {
    return Eigen::Map<AngularVector<dim>>(&rates_[n_rotations<dim> * solid]);
  };
  for (std::size_t l = 0; l < solid_.size(); ++l)
    if (solid_[l] >= 0)
      rate(solid_[l]) += end_velocity[l] * spin_[l];
  sum_over_ranks(comm_, rates_);
  for (std::size_t l = 0; l < solid_.size(); ++l)
    if (solid_[l] >= 0)
      pull[l] -= spin_[l].dot(strength_[solid_[l]].cwiseProduct(rate(solid_[l])));
}

template class SpinCouples<2>;
template class SpinCouples<3>;

}  // namespace lockstep
