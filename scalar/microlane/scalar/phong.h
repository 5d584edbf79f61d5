// Phong: Walter 2007 section 5.2.
#ifndef MICROLANE_SCALAR_PHONG_H_
#define MICROLANE_SCALAR_PHONG_H_

#include <cmath>

#include "microlane/scalar/beckmann.h"
#include "microlane/scalar/direction.h"
#include "microlane/scalar/smith.h"

namespace microlane::scalar {

// Walter 2007, after Eq. 30: 2 / alpha^2 - 2, as 2 (1 - alpha^2) / alpha^2: the fused difference is right
// to rounding near alpha = 1. At least 0.
template <class Real>
Real PhongExponent(Real alpha) {
  if (alpha >= 1) return 0;
  return Saturate<Real>(2 * std::fma(-alpha, alpha, Real(1)) / alpha / alpha);
}

template <class Real>
struct Phong {
  Real exponent;

  // Walter 2007 Eq. 30 of m.z as given. 0 for m.z <= 0.
  Real D(const Vec3<Real>& m) const { return Saturate<Real>(DTimes(m, 1)); }

  // factor D(m), for a factor that may bring D back into range.
  double DTimes(const Vec3<Real>& m, double factor) const {
    if (AnyNan(m, exponent)) return kNan<double>;
    if (!(m.z > 0)) return 0;
    return Scaled(std::pow(m.z, exponent / 2), factor);
  }

  // factor D(half / |half|): cos^e = (1 + tan^2)^(-e/2), and 1 + tan^2 keeps the digits of tan^2 that e, up
  // to 2e10, multiplies. The cosine has lost them. The factor as for the other distributions.
  double DOfHalf(const Vec3<Wide<Real>>& half, double factor) const {
    if (AnyNan(half, exponent)) return kNan<Real>;
    if (!(half.z > Wide<Real>(0))) return 0;
    const Wide<Real> tan2 = (Square(half.x) + Square(half.y)) / Square(half.z);
    return Scaled(Pow(DoubleDouble(1) + DoubleDouble(tan2), exponent / -4.0), factor);
  }

  // a = b |v.n| / tangent, b = sqrt(e/2 + 1), with which Walter 2007 uses Eq. 27 for Phong.
  double A(const Vec3<Real>& v) const { return B() * (std::abs(v.z) / Tangent(v)); }

  // scale |v.n| Lambda(v), Lambda = 1/G1 - 1 of Walter 2007 Eq. 27: at least 0, as G1 is at most 1.
  double ScaledLambda(const Vec3<Real>& v, double scale) const {
    const double tangent = Tangent(v);
    if (tangent == 0) return 0;
    const double a = A(v);
    if (a >= 1.6) return 0;
    const double excess = 1 - a * (1.259 - 0.396 * a);
    return excess <= 0 ? 0 : scale * (tangent / B()) * excess / (3.535 + 2.181 * a);
  }

  // Walter 2007 Eqs. 31, 32: cos = u1^(1/(e + 2)), and sin from expm1 so that it survives cos near 1. There
  // D(m) cos = (e + 2)/(2 pi) u1 / cos.
  SampledNormal<double> SampleNormal(double u1, double u2) const {
    if (AnyNan(u1, u2, exponent)) return {{kNan<double>, kNan<double>, kNan<double>}, kNan<double>};
    const SinCos<double> phi = SinCos2Pi(u2);
    if (u1 <= 0) return {{phi.cos, phi.sin, 0}, 0};
    const DoubleDouble power = DoubleDouble(1) / (DoubleDouble(exponent) + DoubleDouble(2));
    const double log_u1 = std::log(u1);
    // u1^power with the power's low part, which log(u1) multiplies.
    const double cos_m = std::pow(u1, power.hi) * (1 + power.lo * log_u1);
    const double sin_m = std::sqrt(-std::expm1(2 * log_u1 * power.hi));
    return {{sin_m * phi.cos, sin_m * phi.sin, cos_m}, Peak() * (u1 / cos_m)};
  }

 private:
  // D(n).
  double Peak() const { return (exponent + 2.0) / (2 * kPi<double>); }
  double B() const { return std::sqrt(exponent / 2.0 + 1); }
  static double Tangent(const Vec3<Real>& v) { return Hypot<Real>(v.x, v.y); }

  // factor D(n) root^2: root = cos^(e/2) is in range whenever the product is.
  double Scaled(double root, double factor) const { return factor * (Peak() * root) * root; }
};

template <class Real>
bool IsNan(const Phong<Real>& d) {
  return AnyNan(d.exponent);
}

// chi+ times Walter 2007 Eq. 27 with Phong's a.
template <class Real>
Real G1(const Phong<Real>& phong, const Vec3<Real>& v, const Vec3<Real>& m) {
  if (AnyNan(phong, v, m)) return kNan<Real>;
  if (!SidesAgree(Dot(Widen(v), Widen(m)), v.z)) return 0;
  return static_cast<Real>(RationalG1(phong.A(v)));
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_PHONG_H_
