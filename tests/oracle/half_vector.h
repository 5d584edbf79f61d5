// Half vectors, their Jacobians, and ideal directions: Walter 2007, Eqs. 13-17, 39, 40, with
// eta = eta_o / eta_i as in Marschner 2012.
#ifndef MICROLANE_TESTS_ORACLE_HALF_VECTOR_H_
#define MICROLANE_TESTS_ORACLE_HALF_VECTOR_H_

#include "oracle/real.h"

namespace microlane::oracle {

// Walter 2007, Eq. 13, not normalised.
inline Vec ReflectionHalfVector(const Vec& wi, const Vec& wo) { return Real(Sign(wi.z)) * (wi + wo); }

// Walter 2007, Eq. 16 over eta_i, not normalised.
inline Vec RefractionHalfVector(const Vec& wi, const Vec& wo, const Real& eta) { return -(wi + eta * wo); }

// |o.h| / |H|^2, the first forms of Walter 2007, Eqs. 14 and 17 (there times eta^2); 0 for H = 0.
inline Real HalfVectorJacobian(const Vec& wo, const Vec& half_vector) {
  if (IsZero(half_vector)) return 0;
  return abs(Dot(wo, Normalized(half_vector))) / Dot(half_vector, half_vector);
}

// Walter 2007, Eq. 14, second form; infinite at 0.
inline Real ReflectionJacobian(const Real& cos_o) { return 1 / (4 * abs(cos_o)); }

// Walter 2007, Eq. 17, second form; infinite where the denominator is 0, but 0 where cos_o is 0.
inline Real RefractionJacobian(const Real& cos_i, const Real& cos_o, const Real& eta) {
  if (cos_o == 0) return 0;
  return eta * eta * abs(cos_o) / Square(cos_i + eta * cos_o);
}

// Walter 2007, Eq. 39 with i.m signed, where |i.m| is printed.
inline Vec Reflect(const Vec& wi, const Vec& m) { return (2 * Dot(wi, m)) * m - wi; }

// 1 + (c^2 - 1) / eta^2, the radicand of Walter 2007, Eq. 40: cos^2 of the refracted ray's angle to m.
inline Real RefractionRadicand(const Real& c, const Real& eta) { return 1 + (c * c - 1) / (eta * eta); }

// Walter 2007, Eq. 40, given c = i.m, sign(i.n) and the radicand.
inline Vec Refract(const Vec& wi, const Vec& m, const Real& eta, const Real& c, int sign,
                   const Real& radicand) {
  return (c / eta - sign * sqrt(radicand)) * m - (1 / eta) * wi;
}

// Walter 2007, Eq. 40; 0 under total internal reflection.
inline Vec Refract(const Vec& wi, const Vec& m, const Real& eta) {
  const Real c = Dot(wi, m);
  const Real radicand = RefractionRadicand(c, eta);
  if (radicand < 0) return {0, 0, 0};
  return Refract(wi, m, eta, c, Sign(wi.z), radicand);
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_HALF_VECTOR_H_
