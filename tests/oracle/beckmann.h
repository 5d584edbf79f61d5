// Beckmann: Walter 2007, Eqs. 25-29; anisotropic, Heitz 2014, Eqs. 82, 83.
#ifndef MICROLANE_TESTS_ORACLE_BECKMANN_H_
#define MICROLANE_TESTS_ORACLE_BECKMANN_H_

#include "oracle/stretch.h"

namespace microlane::oracle {

// Walter 2007, Eq. 27, without its sidedness; clamped, because as printed it reaches 1.00006 near a = 1.6.
inline Real RationalG1(const Real& a) {
  static const Real kLimit("1.6"), kP1("3.535"), kP2("2.181"), kQ1("2.276"), kQ2("2.577");
  if (a >= kLimit) return 1;
  const Real g1 = (kP1 * a + kP2 * a * a) / (1 + kQ1 * a + kQ2 * a * a);
  return g1 < 1 ? g1 : Real(1);
}

struct Beckmann {
  Roughness alpha;

  Real Alphas() const { return alpha.alpha_x + alpha.alpha_y; }

  // Heitz 2014, Eq. 82; cos^4, where Eq. 68 prints cos^2.
  Real D(const Vec& m) const {
    if (m.z <= 0) return 0;
    const Real cos4 = Square(Square(m.z));
    return exp(-StretchedTan2(m, alpha)) / (Pi() * alpha.Area() * cos4);
  }

  // Heitz 2014, Eqs. 83 and 69: exp(-a^2) / (2 a sqrt(pi)) - erfc(a) / 2, with the first term taken out;
  // infinite at vz = 0.
  Real Lambda(const Vec& v) const {
    const Real inverse_a2 = InverseA2(v, alpha);
    if (inverse_a2 == 0) return 0;
    const Real a = 1 / sqrt(inverse_a2);
    if (a == 0) return 1 / a;
    return exp(-a * a) / (2 * a * SqrtPi()) * ErfcxDefect(a);
  }

  // Walter 2007, Eq. 26, which is 1 / (1 + Lambda).
  Real G1(const Vec& v, const Vec& m) const {
    if (!SameSide(v, m, alpha)) return 0;
    return 1 / (1 + Lambda(v));
  }

  Real DVisible(const Vec& v, const Vec& m) const { return VisibleDensity(*this, v, m); }

  // (1 + Lambda(v)) |v.n| at v.n = 0: a Lambda tends to 1/(2 sqrt(pi)).
  Real GrazingArea(const Vec& v) const { return sqrt(ProjectedRoughness2(v, alpha)) / (2 * SqrtPi()); }

  // |dLambda/dv.x| + |dLambda/dv.y| + |dLambda/dv.z| at most: dLambda/da = -exp(-a^2)/(2 sqrt(pi) a^2) of a =
  // |v.n|/s, where s = |(alpha_x v.x, alpha_y v.y)| changes by the alphas.
  Real LambdaSlope(const Vec& v) const {
    const Real z = abs(v.z), s = sqrt(ProjectedRoughness2(v, alpha));
    if (s == 0) return 0;
    return exp(-Square(z / s)) / (2 * SqrtPi()) * (s / (z * z) + Alphas() / z);
  }

  // Walter 2007, Eq. 27; its a is infinite at normal incidence.
  Real G1Rational(const Vec& v, const Vec& m) const {
    if (!SameSide(v, m, alpha)) return 0;
    return RationalG1(1 / sqrt(InverseA2(v, alpha)));
  }

  // Walter 2007, Eqs. 28 and 29, stretched.
  Vec SampleNormal(const Real& u1, const Real& u2) const {
    return StretchedNormal(sqrt(NegLog1m(u1)), u2, alpha);
  }
};

// A visible normal of Beckmann, with what Metric::kDirection is made of.
struct BeckmannNormal {
  Vec m, h;        // h: at unit roughness, not normalised
  Vec sizes;       // of the parts of h
  Real end_share;  // T / (a + t)
};

// The slope t at unit roughness along the azimuth of a view whose height is z and whose length along the
// surface is r, z/r = a: u is the share of the visible normals above t, whose density is that of max(0, z + r
// t) exp(-t^2) (Heitz 2014, Eq. 16). By Halley's method, which leaves the cube of the error, from a root in
// double. reach = z + r t; spread = T - |t|.
inline void VisibleSlope(const Real& z, const Real& r, const Real& u, Real& t, Real& reach, Real& spread) {
  const Real a = r == 0 ? Real(0) : Real(z / r);
  const Real defect = r == 0 ? Real(0) : Real(r * exp(-a * a) - z * SqrtPi() * erfc(a));
  const Real whole = 2 * SqrtPi() * z + defect;
  const auto above = [&](const Real& s) { return Real(z * SqrtPi() * erfc(s) + r * exp(-s * s)); };
  const Real end = r == 0 || a > 40 ? Real(-40) : Real(-a);
  double low = static_cast<double>(end), high = 40;
  const double size = static_cast<double>(z + r), zd = static_cast<double>(z) / size,
               rd = static_cast<double>(r) / size, wanted = static_cast<double>(u * whole) / size;
  for (int i = 0; i < 60; ++i) {
    const double middle = (low + high) / 2;
    const double value =
        zd * static_cast<double>(SqrtPi()) * std::erfc(middle) + rd * std::exp(-middle * middle);
    (value > wanted ? low : high) = middle;
  }
  t = (low + high) / 2;
  // So near the end that doubles do not see it: the part below t is (z + r t)^2 exp(-a^2) / r there.
  if (t < 0 && z + r * t < 1e-6 * r) t = (sqrt((1 - u) * whole * exp(a * a) * r) - z) / r;
  Real upper, exp_t2;
  for (int i = 0; i < 12; ++i) {
    reach = z + r * t;
    upper = above(t);
    exp_t2 = exp(t * t);
    const Real h = (upper - u * whole) * exp_t2 / (2 * reach);
    const Real step = h / (1 + h * (r / reach - 2 * t) / 2);
    t += step;
    if (abs(step) < 1e-14 * (reach < r ? Real(reach / r) : Real(1))) break;
  }
  // As of the last step's t, for a unit of error.
  const Real lower = whole - upper + r / exp_t2;
  spread = (upper < lower ? upper : lower) * exp_t2 / (2 * reach);
  reach = z + r * t;
}

inline BeckmannNormal VisibleNormal(const Beckmann& beckmann, const Vec& v, const Real& u1, const Real& u2) {
  const Roughness& alpha = beckmann.alpha;
  const Vec view = UnitView(alpha.Cosine(v) < 0 ? -v : v, alpha);
  if (IsZero(view)) return {view, {0, 0, 1}, {0, 0, 1}, 0};
  const Real r = sqrt(view.x * view.x + view.y * view.y);
  const Real cos = r == 0 ? Real(1) : Real(view.x / r), sin = r == 0 ? Real(0) : Real(view.y / r);
  Real t, reach, spread;
  VisibleSlope(view.z, r, FromTiny(u1), t, reach, spread);
  const Real y = ErfInv(u2), size = abs(t) + spread;
  const Vec h{cos * t - sin * y, sin * t + cos * y, 1};
  return {FromUnit(h, alpha),
          h,
          {abs(cos) * size + abs(sin * y), abs(sin) * size + abs(cos * y), 1},
          size * r / reach};
}

// Walter 2007, section 5.3: the distribution to sample for wi at grazing.
inline Beckmann Widened(const Beckmann& beckmann, const Real& cos_i) {
  static const Real kBase("1.2"), kSlope("0.2");
  const Real factor = kBase - kSlope * sqrt(abs(cos_i));
  return {{factor * beckmann.alpha.alpha_x, factor * beckmann.alpha.alpha_y}};
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_BECKMANN_H_
