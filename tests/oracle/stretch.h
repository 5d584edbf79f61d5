// Anisotropic roughness as a stretch of directions, Heitz 2014, section 5.
#ifndef MICROLANE_TESTS_ORACLE_STRETCH_H_
#define MICROLANE_TESTS_ORACLE_STRETCH_H_

#include "oracle/math.h"
#include "oracle/real.h"

namespace microlane::oracle {

struct Roughness {
  Real alpha_x, alpha_y;
};

// tan^2(theta_m) (cos^2(phi_m) / alpha_x^2 + sin^2(phi_m) / alpha_y^2) of Heitz 2014, Eqs. 82 and 85.
inline Real StretchedTan2(const Vec& m, const Roughness& alpha) {
  return (Square(m.x / alpha.alpha_x) + Square(m.y / alpha.alpha_y)) / Square(m.z);
}

// 1/a^2 = alpha_o^2 tan^2(theta_o), with alpha_o of Heitz 2014, Eq. 80; 0 for the zero vector.
inline Real InverseA2(const Vec& v, const Roughness& alpha) {
  const Real projected = Square(alpha.alpha_x * v.x) + Square(alpha.alpha_y * v.y);
  return projected == 0 ? projected : projected / Square(v.z);
}

// The normal whose slope is r (cos(2 pi u2), sin(2 pi u2)), stretched by alpha; Walter 2007, Eqs. 29 and 36.
inline Vec StretchedNormal(const Real& r, const Real& u2, const Roughness& alpha) {
  const SinCos phi = SinCos2Pi(u2);
  return Normalized({alpha.alpha_x * r * phi.cos, alpha.alpha_y * r * phi.sin, 1});
}

// chi+((v.m) / (v.n)), the sidedness of Walter 2007, Eq. 7.
inline bool SameSide(const Vec& v, const Vec& m) { return Dot(v, m) * v.z > 0; }

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_STRETCH_H_
