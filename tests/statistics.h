// Tallies of checked points, random numbers with fixed seeds, and the chi-square test.
#ifndef MICROLANE_TESTS_STATISTICS_H_
#define MICROLANE_TESTS_STATISTICS_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <numeric>
#include <random>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include "columns.h"

namespace microlane {

// Collects |error| against a tolerance over many points. Says at the end how many there were and which came
// closest to its tolerance; fails the test if any exceeded it.
class Tally {
 public:
  explicit Tally(std::string property) : property_(std::move(property)) {}
  Tally(const Tally&) = delete;
  Tally& operator=(const Tally&) = delete;
  ~Tally() {
    std::printf("  %-58s %9zu points%s", property_.c_str(), points_, points_ == 0 ? "" : ", worst ");
    if (points_ != 0) std::printf("%.3g of %.3g at %s", error_, tolerance_, where_.c_str());
    std::printf("%s\n", note_.c_str());
    if (points_ == 0) ADD_FAILURE() << property_ << ": no points";
    if (failures_ == 0) return;
    ADD_FAILURE() << property_ << ": " << failures_ << " points fail, worst " << error_
                  << " for a tolerance of " << tolerance_ << " at " << where_;
  }

  // `where` is called for the text that identifies the point.
  template <class Where>
  void Add(double error, double tolerance, const Where& where) {
    ++points_;
    error = std::abs(error);
    const bool failed = !(error <= tolerance);
    failures_ += failed;
    const double ratio = !failed && tolerance == 0 ? 0 : error / tolerance;
    const double badness = std::isfinite(ratio) ? ratio : 1e300;
    if (badness <= worst_) return;
    worst_ = badness;
    error_ = error;
    tolerance_ = tolerance;
    where_ = where();
  }
  template <class Where>
  void AddRelative(double got, double expected, double tolerance, const Where& where) {
    Add(expected == got ? 0 : (got - expected) / std::abs(expected), tolerance, where);
  }
  void Note(const std::string& note) { note_ += note; }

 private:
  std::string property_, where_, note_;
  std::size_t points_ = 0, failures_ = 0;
  double worst_ = -1, error_ = 0, tolerance_ = 0;
};

// printf into a string.
template <class... V>
std::string Text(const char* format, V... values) {
  char text[512];
  std::snprintf(text, sizeof text, format, values...);
  return text;
}

inline std::string Text(const Direction& v) { return Text("(%a, %a, %a)", v.x, v.y, v.z); }

// n numbers, uniform in [0, 1): multiples of 2^-24 in float, of 2^-53 in double.
template <class T>
Column<T> UniformNumbers(std::size_t n, std::mt19937_64& random) {
  constexpr int kBits = std::is_same_v<T, float> ? 24 : 53;
  Column<T> u(n);
  for (T& x : u) x = static_cast<T>(std::ldexp(static_cast<double>(random() >> (64 - kBits)), -kBits));
  return u;
}

// Q(s, x), the regularised upper incomplete gamma function, to about 1e-12: by the series of P below s + 1,
// by Lentz's continued fraction above.
inline double UpperGamma(double s, double x) {
  if (x <= 0) return 1;
  const double scale = std::exp(s * std::log(x) - x - std::lgamma(s));
  if (x < s + 1) {
    double term = 1 / s, sum = term;
    for (double k = s + 1; term > sum * 1e-16; ++k) {
      term *= x / k;
      sum += term;
    }
    return 1 - scale * sum;
  }
  double b = x + 1 - s, c = 1e300, d = 1 / b, h = d;
  for (int k = 1; k < 100000; ++k) {
    const double a = -k * (k - s);
    b += 2;
    d = 1 / (a * d + b);
    c = b + a / c;
    h *= d * c;
    if (std::abs(d * c - 1) < 1e-15) break;
  }
  return scale * h;
}

// The probability that a chi-square variable exceeds x.
inline double ChiSquareTail(double x, int degrees_of_freedom) {
  return UpperGamma(0.5 * degrees_of_freedom, 0.5 * x);
}

// |z| that a normal variable exceeds with probability `p`.
inline double NormalBound(double p) {
  double low = 0, high = 40;
  for (int k = 0; k < 200; ++k) {
    const double mid = 0.5 * (low + high);
    (std::erfc(mid / std::sqrt(2.0)) > p ? low : high) = mid;
  }
  return high;
}

// Sidak: the significance of each of `num_tests` independent tests whose overall significance is `overall`.
inline double SidakSignificance(double overall, std::size_t num_tests) {
  return -std::expm1(std::log1p(-overall) / static_cast<double>(num_tests));
}

struct ChiSquareResult {
  double statistic = 0, p_value = 1;
  int degrees_of_freedom = 0;
};

// Pearson's test of counts against expected counts that add up to the same. Bins are pooled, smallest first,
// until each expects at least 5.
inline ChiSquareResult ChiSquareTest(const std::vector<double>& observed,
                                     const std::vector<double>& expected) {
  std::vector<std::size_t> order(expected.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t a, std::size_t b) { return expected[a] < expected[b]; });
  constexpr double kLeast = 5;
  std::vector<std::pair<double, double>> bins;  // observed, expected
  double pooled_observed = 0, pooled_expected = 0;
  for (const std::size_t k : order) {
    pooled_observed += observed[k];
    pooled_expected += expected[k];
    if (pooled_expected < kLeast) continue;
    bins.emplace_back(pooled_observed, pooled_expected);
    pooled_observed = pooled_expected = 0;
  }
  if (bins.empty()) return {0, pooled_observed == pooled_expected ? 1.0 : 0.0, 0};
  bins.back().first += pooled_observed;
  bins.back().second += pooled_expected;
  ChiSquareResult result;
  for (const auto& [o, e] : bins) result.statistic += (o - e) * (o - e) / e;
  result.degrees_of_freedom = static_cast<int>(bins.size()) - 1;
  if (result.degrees_of_freedom > 0) {
    result.p_value = ChiSquareTail(result.statistic, result.degrees_of_freedom);
  }
  return result;
}

}  // namespace microlane

#endif  // MICROLANE_TESTS_STATISTICS_H_
