// Fresnel reflectance of a dielectric: Walter 2007, Eq. 22. eta is the index of the transmitted over the
// incident side.
#ifndef MICROLANE_TESTS_ORACLE_FRESNEL_H_
#define MICROLANE_TESTS_ORACLE_FRESNEL_H_

#include "oracle/real.h"

namespace microlane::oracle {

// g^2 of Walter 2007, Eq. 22; negative under total internal reflection.
inline Real FresnelG2(const Real& c, const Real& eta) { return eta * eta - 1 + c * c; }

// Walter 2007, Eq. 22.
inline Real FresnelDielectric(const Real& cos_i, const Real& eta) {
  if (eta == 1) return 0;
  const Real c = abs(cos_i);
  const Real g2 = FresnelG2(c, eta);
  if (g2 < 0) return 1;
  const Real g = sqrt(g2);
  return Square((g - c) / (g + c)) / 2 * (1 + Square((c * (g + c) - 1) / (c * (g - c) + 1)));
}

// The part polarised across the plane of incidence: the first factor of Walter 2007, Eq. 22.
inline Real FresnelDielectricS(const Real& cos_i, const Real& eta) {
  if (eta == 1) return 0;
  const Real c = abs(cos_i);
  const Real g2 = FresnelG2(c, eta);
  if (g2 < 0) return 1;
  const Real g = sqrt(g2);
  return Square((g - c) / (g + c));
}

// The part polarised in the plane of incidence: both factors of Walter 2007, Eq. 22.
inline Real FresnelDielectricP(const Real& cos_i, const Real& eta) {
  if (eta == 1) return 0;
  const Real c = abs(cos_i);
  const Real g2 = FresnelG2(c, eta);
  if (g2 < 0) return 1;
  const Real g = sqrt(g2);
  return Square((eta * eta * c - g) / (eta * eta * c + g));
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_FRESNEL_H_
