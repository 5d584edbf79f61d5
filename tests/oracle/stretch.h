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

// Eto and Tokuyoshi 2023: how much of the cap below the horizon reflection needs, from above the surface.
inline Real CapBound(const Vec& v, const Roughness& alpha) {
  const Real smaller = alpha.alpha_x < alpha.alpha_y ? alpha.alpha_x : alpha.alpha_y;
  const Real a2 = smaller < 1 ? Square(smaller) : Real(1);
  const Real s2 = Square(1 + sqrt(Square(v.x) + Square(v.y)));
  return (1 - a2) * s2 / (s2 + a2 * Square(v.z));
}

// A visible normal from spherical caps, with the point of the cap and the stretched view that it is made of.
struct CapNormal {
  Vec m, cap, view;
};

// Dupuy and Benyoub 2023, with the azimuth from u2: uniform on the cap above -k view.z, where the view
// is stretched (Heitz 2014, section 5); below the surface -v is seen.
inline CapNormal VisibleNormal(const Vec& v, const Real& u1, const Real& u2, const Roughness& alpha,
                               const Real& k = 1) {
  const Vec upper = v.z < 0 ? -v : v;
  const Vec view = Normalized({alpha.alpha_x * upper.x, alpha.alpha_y * upper.y, upper.z});
  const Real z = (1 - u1) * (1 + k * view.z) - k * view.z;
  const SinCos phi = SinCos2Pi(u2);
  const Real sine = sqrt(1 - z * z);
  const Vec cap{sine * phi.cos, sine * phi.sin, z};
  const Vec h = cap + view;
  return {Normalized({alpha.alpha_x * h.x, alpha.alpha_y * h.y, h.z}), cap, view};
}

// What stretching does to roundings of cap and view where their sum cancels: Metric::kDirection.
inline Real CapCancellation(const CapNormal& normal, const Roughness& alpha) {
  const Vec& c = normal.cap;
  const Vec& s = normal.view;
  const auto length2 = [&](const Real& x, const Real& y) {
    return Square(alpha.alpha_x * x) + Square(alpha.alpha_y * y) + Square(c.z + s.z);
  };
  return sqrt(length2(abs(c.x) + abs(s.x), abs(c.y) + abs(s.y)) / length2(c.x + s.x, c.y + s.y));
}

// chi+((v.m) / (v.n)), the sidedness of Walter 2007, Eq. 7.
inline bool SameSide(const Vec& v, const Vec& m) { return Dot(v, m) * v.z > 0; }

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_STRETCH_H_
