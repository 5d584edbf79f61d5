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

// Walter 2007, section 5.3: the distribution to sample for wi at grazing.
inline Beckmann Widened(const Beckmann& beckmann, const Real& cos_i) {
  static const Real kBase("1.2"), kSlope("0.2");
  const Real factor = kBase - kSlope * sqrt(abs(cos_i));
  return {{factor * beckmann.alpha.alpha_x, factor * beckmann.alpha.alpha_y}};
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_BECKMANN_H_
