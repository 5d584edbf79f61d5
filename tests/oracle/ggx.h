// GGX: Walter 2007, Eqs. 33-36; anisotropic, Heitz 2014, Eqs. 85, 86.
#ifndef MICROLANE_TESTS_ORACLE_GGX_H_
#define MICROLANE_TESTS_ORACLE_GGX_H_

#include "oracle/stretch.h"

namespace microlane::oracle {

struct Ggx {
  Roughness alpha;

  // Heitz 2014, Eq. 85.
  Real D(const Vec& m) const {
    if (m.z <= 0) return 0;
    const Real cos4 = Square(Square(m.z));
    return 1 / (Pi() * alpha.alpha_x * alpha.alpha_y * cos4 * Square(1 + StretchedTan2(m, alpha)));
  }

  // Heitz 2014, Eq. 86; infinite at vz = 0.
  Real Lambda(const Vec& v) const { return (-1 + sqrt(1 + InverseA2(v, alpha))) / 2; }

  // Walter 2007, Eq. 34, which is 1 / (1 + Lambda).
  Real G1(const Vec& v, const Vec& m) const {
    if (!SameSide(v, m)) return 0;
    return 2 / (1 + sqrt(1 + InverseA2(v, alpha)));
  }

  // Heitz 2014, Eq. 16; at vz = 0 the limit from above.
  Real DVisible(const Vec& v, const Vec& m) const {
    const Real v_m = v.z < 0 ? Real(-Dot(v, m)) : Dot(v, m);
    if (v_m <= 0) return 0;
    if (v.z == 0) return 2 * v_m * D(m) / sqrt(Square(alpha.alpha_x * v.x) + Square(alpha.alpha_y * v.y));
    return G1(v, m) * v_m * D(m) / abs(v.z);
  }

  // Walter 2007, Eqs. 35 and 36, stretched.
  Vec SampleNormal(const Real& u1, const Real& u2) const {
    return StretchedNormal(sqrt(u1 / (1 - u1)), u2, alpha);
  }
};

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_GGX_H_
