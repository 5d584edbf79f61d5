// Nodes of Gauss-Legendre quadrature.
#ifndef MICROLANE_SRC_LEGENDRE_H_
#define MICROLANE_SRC_LEGENDRE_H_

#include <array>
#include <cmath>
#include <cstddef>

namespace microlane {

struct LegendrePoint {
  double t, weight;
};

// The k-th node of `count` of Gauss-Legendre on [0, 1], for k up to the middle one; t = y/2 of the k-th root
// 1 - y of the Legendre polynomial. The recurrence of the differences P_j - P_(j-1) keeps the digits of a
// small y.
inline LegendrePoint LegendreNode(std::size_t count, std::size_t k) {
  constexpr double kPi = 3.14159265358979323846;
  const double n = static_cast<double>(count);
  const double angle = kPi * (static_cast<double>(k) + 0.75) / (n + 0.5), half_sine = std::sin(angle / 2);
  double y = 2 * half_sine * half_sine, last = 1;
  for (int step = 0; step < 6; ++step) {
    double p = 1, difference = 0;
    for (std::size_t j = 0; j < count; ++j) {
      const double i = static_cast<double>(j);
      last = p;
      difference = (i * difference - (2 * i + 1) * y * p) / (i + 1);
      p += difference;
    }
    y += p * y * (2 - y) / (n * (last - (1 - y) * p));
  }
  return {y / 2, y * (2 - y) / (n * n * last * last)};
}

template <std::size_t kCount>
struct LegendreRule {
  std::array<double, kCount> t, weight;  // on [0, 1]

  LegendreRule() {
    for (std::size_t k = 0; k < (kCount + 1) / 2; ++k) {
      const LegendrePoint point = LegendreNode(kCount, k);
      t[k] = point.t;
      t[kCount - 1 - k] = 1 - point.t;
      weight[k] = weight[kCount - 1 - k] = point.weight;
    }
  }
};

}  // namespace microlane

#endif  // MICROLANE_SRC_LEGENDRE_H_
