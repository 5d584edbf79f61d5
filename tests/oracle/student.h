// Smith's Lambda of Student-T slopes, and with them of Phong: Heitz 2014, Eqs. 41-43 and section 7.
#ifndef MICROLANE_TESTS_ORACLE_STUDENT_H_
#define MICROLANE_TESTS_ORACLE_STUDENT_H_

#include "oracle/masking.h"
#include "oracle/phong.h"

namespace microlane::oracle {

// Gamma(n + 1/2) / Gamma(n). log Gamma of n up to 1e10 leaves 400 bits.
inline Real GammaRatio(const Real& n) { return exp(LogGamma(n + Real(1) / 2) - LogGamma(n)); }

// 2 n mu (1 + mu^2)^n times the integral of (1 + x^2)^-(n + 1) over x > mu, an incomplete Beta function of w
// = 1/(1 + mu^2). Where the other part of the whole is no more than e^30 times the integral, it is taken off,
// by its power series in z^2 = 1 - w; elsewhere the continued fraction of DLMF 8.17.22, to 2^-240 or better.
inline Real StudentTail(const Real& mu, const Real& n) {
  const Real w = 1 / (1 + mu * mu), z2 = mu * mu * w;
  const double peak = static_cast<double>(Real((n + 1) * z2));
  if (peak < 30 && z2 < 0.5) {
    Real term = 1, sum = 0;
    for (int j = 0; term > sum * ldexp(Real(1), -400); ++j) {
      sum += term;
      term *= (n + 1 + j) / (Real(3) / 2 + j) * z2;
    }
    return SqrtPi() * GammaRatio(n) * mu * pow(1 + mu * mu, n) - 2 * n * z2 * sum;
  }
  const Real a = n + Real(1) / 2, b = Real(1) / 2;
  Real fraction = 1;
  for (int m = peak < 30 ? 130 : 100 + static_cast<int>(5000 / peak); m >= 0; --m) {
    const Real even = (m + 1) * (b - (m + 1)) * w / ((a + 2 * m + 1) * (a + 2 * m + 2));
    const Real odd = -(a + m) * (a + b + m) * w / ((a + 2 * m) * (a + 2 * m + 1));
    fraction = 1 + odd / (1 + even / fraction);
  }
  return 2 * n / (2 * n + 1) * z2 / fraction;
}

// 1 less that, as Heitz's Lambda has it; of 447 bits 36 are lost at n = 1e10.
inline Real StudentDefect(const Real& mu, const Real& n) {
  return mu == 0 ? Real(1) : 1 - StudentTail(mu, n);
}

// Lambda at mu = |v.n|/s; infinite at mu = 0.
inline Real StudentLambda(const Real& s2, const Real& vz, const Real& n) {
  if (s2 == 0) return 0;
  if (vz == 0) return Infinity();
  const Real mu = abs(vz) / sqrt(s2);
  return StudentDefect(mu, n) / (2 * SqrtPi() * GammaRatio(n) * mu * pow(1 + mu * mu, n));
}

// (1 + Lambda) |v.n| at v.n = 0.
inline Real StudentGrazingArea(const Real& s2, const Real& n) {
  return sqrt(s2) / (2 * SqrtPi() * GammaRatio(n));
}

// Phong with Smith's masking of its own.
struct PhongSmith : Phong {
  Real Lambda(const Vec& v) const {
    return StudentLambda(Square(v.x) + Square(v.y), v.z, (exponent + 1) / 2);
  }
  Real G1(const Vec& v, const Vec& m) const { return SameSide(v, m) ? 1 / (1 + Lambda(v)) : Real(0); }
};

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_STUDENT_H_
