// Gauss-Legendre quadrature.
#ifndef MICROLANE_SCALAR_LEGENDRE_H_
#define MICROLANE_SCALAR_LEGENDRE_H_

#include <cmath>
#include <cstddef>
#include <vector>

#include "microlane/scalar/math.h"

namespace microlane::scalar {

// A node t of Gauss-Legendre on [0, 1], 1 - t with its own digits, and the weight.
struct LegendreNode {
  double t, rest, weight;
};

// The nodes in rising order. Newton's method on 1 - 2 t, of whose distance y from 1 the recurrence keeps the
// digits.
inline std::vector<LegendreNode> LegendreNodes(int order) {
  std::vector<LegendreNode> nodes(static_cast<std::size_t>(order));
  const double n = order;
  for (int k = 0; k < (order + 1) / 2; ++k) {
    double y = 2 * std::pow(std::sin(kPi<double> * (k + 0.75) / (2 * n + 1)), 2), before = 1;
    for (int step = 0; step < 6; ++step) {
      double p = 1, step_of_p = 0;
      for (int j = 0; j < order; ++j) {
        before = p;
        step_of_p = (j * step_of_p - (2 * j + 1) * y * p) / (j + 1);
        p += step_of_p;
      }
      y += p * y * (2 - y) / (n * (before - (1 - y) * p));
    }
    const double weight = y * (2 - y) / std::pow(n * before, 2);
    if (2 * k + 1 == order) y = 1;
    nodes[static_cast<std::size_t>(k)] = {y / 2, 1 - y / 2, weight};
    nodes[static_cast<std::size_t>(order - 1 - k)] = {1 - y / 2, y / 2, weight};
  }
  return nodes;
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_LEGENDRE_H_
