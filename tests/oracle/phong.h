// Phong: Walter 2007, Eqs. 30-32, with the masking of Eq. 27.
#ifndef MICROLANE_TESTS_ORACLE_PHONG_H_
#define MICROLANE_TESTS_ORACLE_PHONG_H_

#include "oracle/beckmann.h"

namespace microlane::oracle {

// Walter 2007, after Eq. 30: the exponent whose distribution resembles Beckmann's of that alpha.
inline Real PhongExponent(const Real& alpha) {
  if (alpha >= 1) return 0;
  return 2 / (alpha * alpha) - 2;
}

struct Phong {
  Real exponent;

  // Of RoughDielectric's weight_kappa: no more than 1/|wo.n| adds, as roughness is below 1 and isotropic.
  static Real Alphas() { return 0; }

  // Walter 2007, Eq. 30.
  Real D(const Vec& m) const {
    if (m.z <= 0) return 0;
    return (exponent + 2) / (2 * Pi()) * pow(m.z, exponent);
  }

  // Walter 2007, Eq. 27 with a = sqrt(0.5 alpha_p + 1) / tan(theta_v), without its sidedness.
  Real MaskingG1(const Vec& v) const {
    const Real sin2 = Square(v.x) + Square(v.y);
    if (sin2 == 0) return 1;
    return RationalG1(sqrt((exponent / 2 + 1) / sin2) * abs(v.z));
  }

  Real G1(const Vec& v, const Vec& m) const {
    if (!SameSide(v, m)) return 0;
    return MaskingG1(v);
  }

  // The Lambda for which G1 = 1 / (1 + Lambda); infinite at vz = 0.
  Real Lambda(const Vec& v) const { return 1 / MaskingG1(v) - 1; }

  // Walter 2007, Eqs. 31 and 32.
  Vec SampleNormal(const Real& u1, const Real& u2) const {
    const Real cos_theta = pow(u1, 1 / (exponent + 2));
    const Real sin_theta = sqrt(1 - cos_theta * cos_theta);
    const SinCos phi = SinCos2Pi(u2);
    return {sin_theta * phi.cos, sin_theta * phi.sin, cos_theta};
  }
};

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_PHONG_H_
