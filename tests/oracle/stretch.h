// Anisotropic roughness as a stretch of directions, Heitz 2014, section 5.
#ifndef MICROLANE_TESTS_ORACLE_STRETCH_H_
#define MICROLANE_TESTS_ORACLE_STRETCH_H_

#include "oracle/math.h"
#include "oracle/real.h"

namespace microlane::oracle {

struct Roughness {
  Real alpha_x, alpha_y;
  Real r_xy = 0, mean_x = 0, mean_y = 0;

  // The determinant's root of Q^-1, Heitz 2014, Eq. 88: what D is normalised by.
  Real Area() const { return alpha_x * alpha_y * sqrt(1 - r_xy * r_xy); }
  // The projected area of the mesosurface, which stands for vz.
  Real Cosine(const Vec& v) const { return v.z - mean_x * v.x - mean_y * v.y; }
};

// Heitz 2014, Eq. 95; Eqs. 92, 82 and 85 where its means and correlation are 0.
inline Real StretchedTan2(const Vec& m, const Roughness& alpha) {
  const Real x = m.x / m.z + alpha.mean_x, y = m.y / m.z + alpha.mean_y;
  const Real ax2 = Square(alpha.alpha_x), ay2 = Square(alpha.alpha_y);
  return (x * x * ay2 + y * y * ax2 - 2 * x * y * alpha.r_xy * alpha.alpha_x * alpha.alpha_y) /
         (ax2 * ay2 - Square(alpha.r_xy) * ax2 * ay2);
}

// alpha_o^2 sin^2(theta_o) of Heitz 2014, Eq. 97; Eqs. 93 and 80.
inline Real ProjectedRoughness2(const Vec& v, const Roughness& alpha) {
  return Square(alpha.alpha_x * v.x) + Square(alpha.alpha_y * v.y) +
         2 * v.x * v.y * alpha.r_xy * alpha.alpha_x * alpha.alpha_y;
}

// 1/a^2, with a of Heitz 2014, Eq. 96; 0 for the zero vector.
inline Real InverseA2(const Vec& v, const Roughness& alpha) {
  const Real projected = ProjectedRoughness2(v, alpha);
  return projected == 0 ? projected : projected / Square(alpha.Cosine(v));
}

// Normals and views of the surface of unit roughness: their slopes by a root of Q^-1 (Heitz 2014, Eq. 88),
// the mean off; and the inverse transpose.
inline Vec FromUnit(const Vec& m, const Roughness& alpha) {
  const Real y = alpha.r_xy * m.x + sqrt(1 - alpha.r_xy * alpha.r_xy) * m.y;
  return Normalized({alpha.alpha_x * m.x - alpha.mean_x * m.z, alpha.alpha_y * y - alpha.mean_y * m.z, m.z});
}
inline Vec UnitView(const Vec& v, const Roughness& alpha) {
  return {alpha.alpha_x * v.x + alpha.r_xy * alpha.alpha_y * v.y,
          sqrt(1 - alpha.r_xy * alpha.r_xy) * alpha.alpha_y * v.y, alpha.Cosine(v)};
}

// The normal whose slope is r (cos(2 pi u2), sin(2 pi u2)), stretched by alpha; Walter 2007, Eqs. 29 and 36.
inline Vec StretchedNormal(const Real& r, const Real& u2, const Roughness& alpha) {
  const SinCos phi = SinCos2Pi(u2);
  return FromUnit({r * phi.cos, r * phi.sin, 1}, alpha);
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
  const Vec view = Normalized(UnitView(alpha.Cosine(v) < 0 ? -v : v, alpha));
  const Real z = (1 - u1) * (1 + k * view.z) - k * view.z;
  const SinCos phi = SinCos2Pi(u2);
  const Real sine = sqrt(1 - z * z);
  const Vec cap{sine * phi.cos, sine * phi.sin, z};
  const Vec h = cap + view;
  return {FromUnit(h, alpha), cap, view};
}

// What stretching does to roundings of the parts of a normal h at unit roughness, of which `sizes` are the
// sums without signs: Metric::kDirection.
inline Real Cancellation(const Vec& sizes, const Vec& h, const Roughness& alpha) {
  const Real r = alpha.r_xy, uncorrelated = sqrt(1 - r * r);
  const auto length = [&](const Vec& m, const Real& signed_r, const Real& mean_x, const Real& mean_y) {
    const Real across = signed_r * m.x + uncorrelated * m.y;
    return sqrt(Square(alpha.alpha_x * m.x - mean_x * m.z) + Square(alpha.alpha_y * across - mean_y * m.z) +
                Square(m.z));
  };
  return length(sizes, abs(r), -abs(alpha.mean_x), -abs(alpha.mean_y)) /
         length(h, r, alpha.mean_x, alpha.mean_y);
}

// What it does where the sum of cap and view cancels.
inline Real CapCancellation(const CapNormal& normal, const Roughness& alpha) {
  const Vec& c = normal.cap;
  const Vec& s = normal.view;
  return Cancellation({abs(c.x) + abs(s.x), abs(c.y) + abs(s.y),
                       alpha.mean_x == 0 && alpha.mean_y == 0 ? Real(c.z + s.z) : Real(abs(c.z) + abs(s.z))},
                      c + s, alpha);
}

// chi+((v.m) / (v.n)), the sidedness of Walter 2007, Eq. 7.
inline bool SameSide(const Vec& v, const Vec& m, const Roughness& alpha = {1, 1}) {
  return Dot(v, m) * alpha.Cosine(v) > 0;
}

// Heitz 2014, Eq. 16; where the mesosurface is seen edge-on the limit from above.
template <class Distribution>
Real VisibleDensity(const Distribution& distribution, const Vec& v, const Vec& m) {
  const Real cosine = distribution.alpha.Cosine(v);
  const Real v_m = cosine < 0 ? Real(-Dot(v, m)) : Dot(v, m);
  if (v_m <= 0) return 0;
  if (cosine == 0) return v_m * distribution.D(m) / distribution.GrazingArea(v);
  return distribution.G1(v, m) * v_m * distribution.D(m) / abs(cosine);
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_STRETCH_H_
