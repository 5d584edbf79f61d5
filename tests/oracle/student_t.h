// Student-T slopes with any gamma: d'Eon 2023; Burley 2012 (GTR); Heitz 2014, Eqs. 41-43 and section 5.
#ifndef MICROLANE_TESTS_ORACLE_STUDENT_T_H_
#define MICROLANE_TESTS_ORACLE_STUDENT_T_H_

#include "oracle/stretch.h"
#include "oracle/student.h"

namespace microlane::oracle {

// Slopes of unit roughness have the density (1 + r^2/(gamma - 1))^-gamma / pi.
struct StudentT {
  Real gamma;
  Roughness alpha;

  Real Alphas() const { return alpha.alpha_x + alpha.alpha_y; }

  Real D(const Vec& m) const {
    if (m.z <= 0) return 0;
    const Real cos4 = Square(Square(m.z));
    return pow(1 + StretchedTan2(m, alpha) / (gamma - 1), -gamma) / (Pi() * alpha.Area() * cos4);
  }

  // Infinite at v.n = 0.
  Real Lambda(const Vec& v) const { return StudentLambda(SlopeScale2(v), alpha.Cosine(v), Order()); }

  Real G1(const Vec& v, const Vec& m) const { return SameSide(v, m, alpha) ? 1 / (1 + Lambda(v)) : Real(0); }

  Real DVisible(const Vec& v, const Vec& m) const { return VisibleDensity(*this, v, m); }

  Real GrazingArea(const Vec& v) const { return StudentGrazingArea(SlopeScale2(v), Order()); }

  // The inverse of the cumulative function of r^2: 1 - u1 = (1 + r^2/(gamma - 1))^(1 - gamma).
  Vec SampleNormal(const Real& u1, const Real& u2) const {
    const Real r2 = (gamma - 1) * (pow(1 - u1, -1 / (gamma - 1)) - 1);
    return StretchedNormal(sqrt(r2), u2, alpha);
  }

 private:
  Real Order() const { return gamma - Real(3) / 2; }
  // s^2 of StudentLambda.
  Real SlopeScale2(const Vec& v) const { return (gamma - 1) * ProjectedRoughness2(v, alpha); }
};

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_STUDENT_T_H_
