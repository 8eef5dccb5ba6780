#include "scenes/random_positions.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

#include "base/errors.hpp"

namespace lockstep {
namespace {

constexpr int most_draws = 10000;

bool is_free(const OccupiedPlace& place, const std::vector<OccupiedPlace>& occupied) {
  return std::none_of(occupied.begin(), occupied.end(), [&](const OccupiedPlace& other) {
    double squared = 0;
    for (std::size_t a = 0; a < place.position.size(); ++a) {
      const double apart = place.position[a] - other.position[a];
      squared += apart * apart;
    }
    const double least = place.radius + other.radius;
    return squared < least * least;
  });
}

/// Places in cubes as wide as the largest of them: those that touch stand in cubes side by side.
class Cubes {
 public:
  explicit Cubes(double width) : width_(width) {}

  void add(const OccupiedPlace& place) { cubes_[cube_of(place)].push_back(place); }

  bool has_room_for(const OccupiedPlace& place) const {
    const Cube middle = cube_of(place);
    int n_around = 1;
    for (std::size_t a = 0; a < middle.size(); ++a)
      n_around *= 3;
    for (int k = 0; k < n_around; ++k) {
      Cube cube = middle;
      int digits = k;
      for (double& coordinate : cube) {
        coordinate += digits % 3 - 1;
        digits /= 3;
      }
      const auto found = cubes_.find(cube);
      if (found != cubes_.end() && !is_free(place, found->second))
        return false;
    }
    return true;
  }

 private:
  using Cube = std::vector<double>;  ///< whole numbers
  Cube cube_of(const OccupiedPlace& place) const {
    Cube cube;
    for (const double coordinate : place.position)
      cube.push_back(std::floor(coordinate / width_));
    return cube;
  }

  double width_;
  std::map<Cube, std::vector<OccupiedPlace>> cubes_;
};

}  // namespace

std::vector<std::vector<double>> random_positions(const std::vector<double>& radii,
                                                  const std::vector<double>& lower,
                                                  const std::vector<double>& upper,
                                                  const std::vector<OccupiedPlace>& occupied,
                                                  int seed, const std::string& where) {
  // std::uniform_real_distribution differs between libraries; the engine does not.
  std::mt19937_64 engine(seed);
  const auto draw = [&engine] { return static_cast<double>(engine() >> 11) * 0x1p-53; };
  Cubes drawn(2 * *std::max_element(radii.begin(), radii.end()));
  std::vector<std::vector<double>> result;
  for (int draws = 0; result.size() < radii.size(); ++draws) {
    OccupiedPlace place{std::vector<double>(lower.size()), radii[result.size()]};
    check_input(draws < most_draws,
                "{}: only {} of {} places that are {:g} m apart were found in the box; make it "
                "larger, the number smaller, or the distance smaller.",
                where, result.size(), radii.size(), 2 * place.radius);
    for (std::size_t a = 0; a < lower.size(); ++a)
      place.position[a] = lower[a] + (upper[a] - lower[a]) * draw();
    if (!is_free(place, occupied) || !drawn.has_room_for(place))
      continue;
    drawn.add(place);
    result.push_back(place.position);
    draws = -1;
  }
  return result;
}

}  // namespace lockstep
