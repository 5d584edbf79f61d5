// Roughness from the moments of slopes, and back: Olano and Baker 2010, Dupuy et al. 2013.
#ifndef MICROLANE_SCALAR_ROUGHNESS_H_
#define MICROLANE_SCALAR_ROUGHNESS_H_

#include <algorithm>
#include <cmath>

#include "microlane/scalar/direction.h"

namespace microlane::scalar {

template <class Real>
struct SlopeMoments {
  Real xx, yy, xy;
};
template <class Real>
struct Correlation {
  Real alpha_x, alpha_y, r_xy;
};

// alpha^2/2 are the variances, within those of 1e-5 and 100; |r_xy| is at most 0.9999. Wide, because
// differences cancel.
template <class Real>
Correlation<Real> FromMoments(Real mean_x, Real mean_y, const SlopeMoments<Real>& moments) {
  using W = Wide<Real>;
  if (AnyNan(mean_x, mean_y) || AnyNan(moments.xx, moments.yy, moments.xy)) {
    return {kNan<Real>, kNan<Real>, kNan<Real>};
  }
  const auto covariance = [](Real moment, Real a, Real b) { return Narrow<double>(W(moment) - W(a) * W(b)); };
  const double alpha_x = std::sqrt(std::clamp(2 * covariance(moments.xx, mean_x, mean_x), 1e-10, 1e4));
  const double alpha_y = std::sqrt(std::clamp(2 * covariance(moments.yy, mean_y, mean_y), 1e-10, 1e4));
  const double r = 2 * covariance(moments.xy, mean_x, mean_y) / (alpha_x * alpha_y);
  return {static_cast<Real>(alpha_x), static_cast<Real>(alpha_y),
          static_cast<Real>(std::clamp(r, -0.9999, 0.9999))};
}

template <class Real>
SlopeMoments<Real> ToMoments(const Correlation<Real>& c, Real mean_x, Real mean_y) {
  using W = Wide<Real>;
  if (AnyNan(mean_x, mean_y) || AnyNan(c.alpha_x, c.alpha_y, c.r_xy)) {
    return {kNan<Real>, kNan<Real>, kNan<Real>};
  }
  const W ax = W(c.alpha_x), ay = W(c.alpha_y), half = W(Real(0.5));
  return {Narrow<Real>(W(mean_x) * W(mean_x) + half * ax * ax),
          Narrow<Real>(W(mean_y) * W(mean_y) + half * ay * ay),
          Narrow<Real>(W(mean_x) * W(mean_y) + half * W(c.r_xy) * ax * ay)};
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_ROUGHNESS_H_
