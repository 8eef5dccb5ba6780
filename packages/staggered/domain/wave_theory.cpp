#include "staggered/domain/wave_theory.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "base/errors.hpp"

namespace lockstep {

double wave_number(double frequency, double gravity, double depth) {
  const double deep = frequency * frequency / gravity;
  // Newton's method from a start of the right size (Eckart 1952, off by 5 % at most).
  double k = deep / std::sqrt(std::tanh(deep * depth));
  for (int i = 0; i < 20; ++i) {
    const double t = std::tanh(k * depth);
    const double change = (k * t - deep) / (t + k * depth * (1 - t * t));
    k -= change;
    if (std::abs(change) < 1e-15 * k)
      break;
  }
  return k;
}

namespace {

/// Value of a polynomial, from its coefficients, lowest order first.
template <std::size_t n>
double polynomial(const std::array<double, n>& coefficients, double x) {
  double value = 0;
  for (std::size_t i = n; i-- > 0;)
    value = value * x + coefficients[i];
  return value;
}

constexpr int n_harmonics = 5;
using Harmonics = std::array<double, n_harmonics>;

/// Fenton's coefficients (1985, Table 1) for a wave of the steepness e = k H / 2. A_ij is times
/// sinh(j k d) here, so that nothing overflows in deep water.
struct StokesCoefficients {
  Harmonics potential{}, surface{};  ///< sum over i of e^i j A_ij sinh(j k d) and of e^i B_ij [1]
  double frame = 0;      ///< mean velocity below the wave that stands still, over sqrt(g / k) [1]
  double transport = 0;  ///< speed of the mass beyond it: negative [1]

  StokesCoefficients(double kd, double e, int order);
};

StokesCoefficients::StokesCoefficients(double kd, double e, int order) {
  const double s = 1 / std::cosh(2 * kd), tanh_2 = std::tanh(2 * kd);
  const double coth = 1 / std::tanh(kd), root = std::sqrt(std::tanh(kd));
  const double p = 1 - s, p2 = p * p, p3 = p2 * p, p4 = p2 * p2, p5 = p3 * p2, p6 = p3 * p3;
  const double q = 3 + 2 * s, r = 4 + s, e2 = e * e;
  potential[0] = surface[0] = e;
  frame = root;
  transport = -e2 / (2 * root * kd);
  if (order >= 2) {
    potential[1] = 2 * e2 * 1.5 * s * tanh_2 / p2;
    surface[1] = e2 * coth * (1 + 2 * s) / (2 * p);
  }
  if (order < 5)
    return;
  const double e3 = e2 * e, e4 = e2 * e2, e5 = e4 * e;
  const double a51 = polynomial<9>({-1184, 32, 13232, 21712, 20940, 12554, -500, -3341, -670}, s);
  potential[0] +=
      e3 * polynomial<4>({-4, -20, 10, -13}, s) / (8 * p3) + e5 * a51 / (64 * q * r * p6);
  potential[1] += 2 * e4 * polynomial<5>({12, -14, -264, -45, -13}, s) * tanh_2 / (24 * p5);
  potential[2] =
      3 * e3 * (11 * s - 2) * s * (s + 2) / (8 * p3) +
      3 * e5 * polynomial<7>({4, 105, 198, -1376, -1302, -117, 58}, s) * (s + 2) / (32 * q * p6);
  potential[3] = 4 * e4 * 2 * tanh_2 * s * polynomial<4>({10, -174, 291, 278}, s) / (48 * q * p5);
  potential[4] = 5 * e5 * polynomial<6>({-6, 272, -1552, 852, 2029, 430}, s) * s *
                 (4 + 2 * s - s * s) / (64 * q * r * p6);
  const double b31 = -3 * polynomial<4>({1, 3, 3, 2}, s) / (8 * p3);
  const double b53 = 9 * polynomial<9>({132, 17, -2216, -5897, -6292, -2687, 194, 467, 82}, s) /
                     (128 * q * r * p6);
  const double b55 =
      5 * polynomial<9>({300, 1579, 3176, 2949, 1188, 675, 1326, 827, 130}, s) / (384 * q * r * p6);
  surface[0] += e3 * b31 - e5 * (b53 + b55);
  surface[1] += e4 * coth * polynomial<6>({6, -26, -182, -204, -25, 26}, s) / (6 * q * p4);
  surface[2] = -e3 * b31 + e5 * b53;
  surface[3] = e4 * coth * polynomial<6>({24, 92, 122, 66, 67, 34}, s) / (24 * q * p4);
  surface[4] = e5 * b55;
  frame += root * (e2 * (2 + 7 * s * s) / (4 * p2) +
                   e4 * polynomial<6>({4, 32, -116, -400, -71, 146}, s) / (32 * p5));
  transport += e4 * polynomial<4>({2, 4, 1, 2}, s) / (8 * root * p3 * kd);
}

/// Stokes' waves, as harmonics of their frequency.
class StokesWave : public WaveTheory {
 public:
  StokesWave(const WaterWave& wave, int order) : order_(order), depth_(wave.depth) {
    omega_ = 2 * M_PI / wave.period;
    number_ = number(wave);
    const StokesCoefficients c(number_ * depth_, number_ * wave.height / 2, order);
    const double unit = std::sqrt(wave.gravity / number_);
    for (int j = 0; j < n_harmonics; ++j) {
      potential_[j] = c.potential[j] * unit * std::sqrt(std::tanh(number_ * depth_));
      surface_[j] = c.surface[j] / number_;
    }
    // A_11 is 1 / sinh(k d), so that these are velocities times sinh(j k d).
    return_flow_ = c.transport * unit;
  }

  WaveMotion motion(double z, double time, double share) const override {
    const double phase = omega_ * time - M_PI / 2;
    WaveMotion sum{share * share * return_flow_, 0};
    double grown = share;
    for (int j = 1; j <= n_harmonics; ++j, grown *= share) {
      const double k = j * number_;
      const double up = std::exp(k * z), down = std::exp(-k * (z + 2 * depth_));
      const double amplitude = grown * potential_[j - 1] / (1 - std::exp(-2 * k * depth_));
      sum.along += amplitude * (up + down) * std::cos(j * phase);
      sum.upward -= amplitude * (up - down) * std::sin(j * phase);
    }
    return sum;
  }
  double top(double time, double share) const override {
    const double phase = omega_ * time - M_PI / 2;
    double sum = 0, grown = share;
    for (int j = 1; j <= n_harmonics && order_ > 1; ++j, grown *= share)
      sum += grown * surface_[j - 1] * std::cos(j * phase);
    return sum;
  }
  double speed() const override { return omega_ / number_; }
  double length() const override { return 2 * M_PI / number_; }

 private:
  /// The number of a wave of this frequency that carries no mass: from the third order on the
  /// height is in it.
  double number(const WaterWave& wave) const {
    double k = wave_number(omega_, wave.gravity, depth_);
    if (order_ < 3)
      return k;
    const auto excess = [&](double trial) {
      const StokesCoefficients c(trial * depth_, trial * wave.height / 2, order_);
      return std::sqrt(wave.gravity * trial) * (c.frame + c.transport) / omega_ - 1;
    };
    double before = 0.99 * k, error_before = excess(before);
    for (int i = 0; i < 50; ++i) {  // secants
      const double error = excess(k);
      if (std::abs(error) < 1e-14 || error == error_before)
        break;
      const double next = k - error * (k - before) / (error - error_before);
      before = k;
      error_before = error;
      k = next;
    }
    return k;
  }

  int order_;
  double depth_, omega_ = 0, number_ = 0, return_flow_ = 0;
  Harmonics potential_{}, surface_{};  ///< [m/s], [m]
};

/// Grimshaw's solitary wave of the third order, whose crest comes `delay` after the start.
class SolitaryWave : public WaveTheory {
 public:
  explicit SolitaryWave(const WaterWave& wave)
      : e_(wave.height / wave.depth), depth_(wave.depth), unit_(std::sqrt(wave.gravity * depth_)) {
    decay_ = std::sqrt(0.75 * e_) * polynomial<3>({1, -5. / 8, 71. / 128}, e_) / depth_;
    speed_ = unit_ * std::sqrt(polynomial<4>({1, 1, -1. / 20, -3. / 70}, e_));
    delay_ = before_crest / (decay_ * speed_);
  }

  WaveMotion motion(double z, double time, double share) const override {
    const auto [s, q] = shape(time);
    const double s2 = s * s, y = (z + depth_) / depth_, y2 = y * y;
    // From the bottom, in powers of y^2.
    const double along_2 = polynomial<2>({-0.25 + s2, 1.5 - 2.25 * s2}, y2);
    const double along_3 =
        polynomial<3>({19. / 40 + s2 / 5 - 1.2 * s2 * s2, -1.5 - 3.75 * s2 + 7.5 * s2 * s2,
                       -3. / 8 + 45. / 16 * s2 - 45. / 16 * s2 * s2},
                      y2);
    const double up_2 = polynomial<2>({3. / 8 + 2 * s2, 0.5 - 1.5 * s2}, y2);
    const double up_3 = polynomial<3>(
        {49. / 640 - 17. / 20 * s2 - 18. / 5 * s2 * s2, -13. / 16 - 25. / 16 * s2 + 7.5 * s2 * s2,
         -3. / 40 + 9. / 8 * s2 - 27. / 16 * s2 * s2},
        y2);
    const double scale = share * unit_ * e_ * s2;
    return {scale * polynomial<3>({1, -along_2, -along_3}, e_),
            scale * std::sqrt(3 * e_) * y * q * polynomial<3>({1, -up_2, -up_3}, e_)};
  }
  double top(double time, double share) const override {
    const auto [s, q] = shape(time);
    const double s2 = s * s, q2 = q * q;
    return share * depth_ * e_ * s2 *
           polynomial<3>({1, -0.75 * q2, (0.625 - 101. / 80 * s2) * q2}, e_);
  }
  double speed() const override { return speed_; }
  double length() const override { return 6 / decay_; }  // sech^2 3 = 0.0099

 private:
  static constexpr double before_crest = 4.6;  ///< sech^2 of it is 4e-4

  /// sech and tanh of the distance ahead of the crest.
  std::pair<double, double> shape(double time) const {
    const double ahead = decay_ * speed_ * (delay_ - time);
    return {1 / std::cosh(ahead), std::tanh(ahead)};
  }

  double e_, depth_, unit_, decay_ = 0, speed_ = 0, delay_ = 0;
};

/// Periodic waves that are steeper or higher break (Miche 1944); those that are longer than
/// Ursell's number 40 are no sum of few harmonics (Hedges 1995).
void check_periodic(const WaterWave& wave, double length, bool is_airy, const std::string& where) {
  const double highest = 0.142 * length * std::tanh(2 * M_PI * wave.depth / length);
  check_input(wave.height < highest,
              "In \"{}\", a wave of a period of {:g} s on water {:g} m deep is {:.3g} m long and "
              "breaks where it is {:.3g} m high, but its \"Height\" is {:g} m; make it lower or "
              "longer.",
              where, wave.period, wave.depth, length, highest, wave.height);
  constexpr double largest_ursell = 40;
  const double ursell = wave.height * length * length / std::pow(wave.depth, 3);
  check_input(
      is_airy || ursell < largest_ursell,
      "In \"{}\", Ursell's number H L^2/d^3 of a wave {:g} m high and {:.3g} m long on "
      "water {:g} m deep is {:.3g}; beyond {:g} the theory of Stokes does not hold. Make it "
      "lower or shorter.",
      where, wave.height, length, wave.depth, ursell, largest_ursell);
}

}  // namespace

const std::vector<std::string>& wave_theories() {
  static const std::vector<std::string> names = {"Airy", "Stokes 2", "Stokes 5", "solitary"};
  return names;
}

std::unique_ptr<WaveTheory> make_wave(const std::string& theory, const WaterWave& wave,
                                      const std::string& where) {
  if (theory == "solitary") {
    constexpr double highest =
        0.7;  // part of the depth; beyond, the third order is off by percents
    check_input(wave.height < highest * wave.depth,
                "In \"{}\", a solitary wave on water {:g} m deep breaks where it is about {:.3g} m "
                "high, but its \"Height\" is {:g} m; make it lower.",
                where, wave.depth, highest * wave.depth, wave.height);
    return std::make_unique<SolitaryWave>(wave);
  }
  const bool is_airy = theory == "Airy";
  const double number = wave_number(2 * M_PI / wave.period, wave.gravity, wave.depth);
  check_periodic(wave, 2 * M_PI / number, is_airy, where);
  return std::make_unique<StokesWave>(wave, is_airy ? 1 : theory == "Stokes 2" ? 2 : 5);
}

}  // namespace lockstep
