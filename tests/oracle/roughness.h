// Roughness from the moments of slopes, and back: Olano and Baker 2010, Dupuy et al. 2013.
#ifndef MICROLANE_TESTS_ORACLE_ROUGHNESS_H_
#define MICROLANE_TESTS_ORACLE_ROUGHNESS_H_

#include "oracle/real.h"

namespace microlane::oracle {

inline Real Clamped(const Real& x, const Real& low, const Real& high) {
  return x < low ? low : x > high ? high : x;
}

// alpha, of a variance alpha^2/2 within those of 1e-5 and 100.
inline Real AlphaOfMoments(const Real& mean, const Real& moment) {
  return sqrt(Clamped(2 * (moment - mean * mean), Real("1e-10"), Real(10000)));
}

inline Real CorrelationOfMoments(const Real& mean_x, const Real& mean_y, const Real& xx, const Real& yy,
                                 const Real& xy) {
  const Real scale = AlphaOfMoments(mean_x, xx) * AlphaOfMoments(mean_y, yy) / 2, limit = Real("0.9999");
  return Clamped((xy - mean_x * mean_y) / scale, -limit, limit);
}

// E[x y] of slopes of correlation r; E[x^2] where both are one and r = 1.
inline Real MixedMoment(const Real& mean_x, const Real& mean_y, const Real& alpha_x, const Real& alpha_y,
                        const Real& r) {
  return mean_x * mean_y + r * alpha_x * alpha_y / 2;
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_ROUGHNESS_H_
