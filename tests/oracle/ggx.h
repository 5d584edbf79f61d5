// GGX: Walter 2007, Eqs. 33-36; anisotropic, Heitz 2014, Eqs. 85, 86.
#ifndef MICROLANE_TESTS_ORACLE_GGX_H_
#define MICROLANE_TESTS_ORACLE_GGX_H_

#include "oracle/stretch.h"

namespace microlane::oracle {

struct Ggx {
  Roughness alpha;

  Real Alphas() const { return alpha.alpha_x + alpha.alpha_y; }

  // Heitz 2014, Eq. 85.
  Real D(const Vec& m) const {
    if (m.z <= 0) return 0;
    const Real cos4 = Square(Square(m.z));
    return 1 / (Pi() * alpha.Area() * cos4 * Square(1 + StretchedTan2(m, alpha)));
  }

  // Heitz 2014, Eq. 86; infinite at vz = 0.
  Real Lambda(const Vec& v) const { return (-1 + sqrt(1 + InverseA2(v, alpha))) / 2; }

  // Walter 2007, Eq. 34, which is 1 / (1 + Lambda).
  Real G1(const Vec& v, const Vec& m) const {
    if (!SameSide(v, m, alpha)) return 0;
    return 2 / (1 + sqrt(1 + InverseA2(v, alpha)));
  }

  Real DVisible(const Vec& v, const Vec& m) const { return VisibleDensity(*this, v, m); }

  // (1 + Lambda(v)) |v.n| at v.n = 0: a Lambda tends to 1/2.
  Real GrazingArea(const Vec& v) const { return sqrt(ProjectedRoughness2(v, alpha)) / 2; }

  // |dLambda/dv.x| + |dLambda/dv.y| + |dLambda/dv.z| at most: by 1/|v.n| and by the length |(alpha_x v.x,
  // alpha_y v.y, v.z)| = |v.n| (1 + 2 Lambda), along x and y by the alphas.
  Real LambdaSlope(const Vec& v) const {
    const Real z = abs(v.z), lambda = Lambda(v);
    return lambda * (1 / z + 1 / (z * (1 + 2 * lambda))) + Alphas() / (2 * z);
  }

  // Walter 2007, Eqs. 35 and 36, stretched.
  Vec SampleNormal(const Real& u1, const Real& u2) const {
    return StretchedNormal(sqrt(u1 / (1 - u1)), u2, alpha);
  }
};

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_GGX_H_
