// The bandwidth that results are read against: McCalpin's STREAM triad a = b + s c on one core,
// best of ten passes, in GB/s of 10^9 bytes (three numbers a pass, as STREAM counts).
//
//   triad [MB an array]     arrays should be at least four times the cache; default 128 MB
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <vector>

int main(int argc, char** argv) {
  const double megabytes = argc > 1 ? std::atof(argv[1]) : 128;
  const auto n = static_cast<std::size_t>(std::max(1.0, megabytes) * 1e6 / sizeof(double));
  std::vector<double> a(n, 0.0), b(n, 1.0), c(n, 2.0);
  double best = 1e300;
  for (int pass = 0; pass < 10; ++pass) {
    const auto start = std::chrono::steady_clock::now();
    const double scale = 3 + pass;
    for (std::size_t i = 0; i < n; ++i)
      a[i] = b[i] + scale * c[i];
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    best = std::min(best, elapsed.count());
  }
  // The sum is printed so that the loop cannot be left out.
  fmt::print("{:.1f} GB/s (check {:g})\n", 3e-9 * sizeof(double) * static_cast<double>(n) / best,
             a[n / 2]);
  return 0;
}
