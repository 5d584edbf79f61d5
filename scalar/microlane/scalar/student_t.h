// Student-T slopes with any gamma: d'Eon 2023; Burley 2012 (GTR); Heitz 2014 section 5.
#ifndef MICROLANE_SCALAR_STUDENT_T_H_
#define MICROLANE_SCALAR_STUDENT_T_H_

#include <algorithm>
#include <cmath>

#include "microlane/scalar/direction.h"
#include "microlane/scalar/smith.h"
#include "microlane/scalar/student.h"

namespace microlane::scalar {

// Slopes of the density 1/(pi alpha_x alpha_y) (1 + (x^2/alpha_x^2 + y^2/alpha_y^2)/(gamma - 1))^-gamma.
template <class Real>
struct StudentT {
  Real gamma, alpha_x, alpha_y;

  // 0 for m.z <= 0.
  Real D(const Vec3<Real>& m) const { return Saturate<Real>(DTimes(m, 1)); }

  // factor D(m), for a factor that may bring D back into range.
  double DTimes(const Vec3<Real>& m, double factor) const { return DOfGiven(Widen(m), factor); }
  double DOfGiven(const Vec3<Wide<Real>>& m, double factor) const {
    return DOf(m, Narrow<double>(m.z), factor);
  }

  // factor D(half / |half|). The factor comes in, and the product leaves in double, because it may bring D
  // back into range.
  double DOfHalf(const Vec3<Wide<Real>>& half, double factor) const {
    return DOf(half, Narrow<double>(half.z) / std::sqrt(Narrow<double>(Dot(half, half))), factor);
  }

  double ScaledLambda(const Vec3<Real>& v, double scale) const {
    using W = Wide<Real>;
    const W s2 = Square(W(alpha_x) * W(v.x)) + Square(W(alpha_y) * W(v.y));
    return StudentScaledLambda((W(gamma) - W(1)) * s2, v.z, gamma - 1.5, scale);
  }

  // m along (alpha_x r cos, alpha_y r sin, 1) with 1 + r^2/k = (1 - u1)^(-1/k), k = gamma - 1. There D(m) =
  // (1 - u1)^(1 + 1/k) / (pi ax ay m.z^4). u1 = 1, which is outside [0, 1), counts as the number below it.
  SampledNormal<double> SampleNormal(double u1, double u2) const {
    const double k = gamma - 1.0, log = -std::log1p(-std::min(u1, 1 - 0x1p-53));
    const SinCos<double> phi = SinCos2Pi(u2);
    const double radius = std::sqrt(k * std::expm1(log / k));
    const double x = alpha_x * radius * phi.cos;
    const double y = alpha_y * radius * phi.sin;
    const double length2 = x * x + y * y + 1;
    const double length = std::sqrt(length2);
    const double pdf = std::exp(-log - log / k) * length * length2 / (kPi<double> * alpha_x * alpha_y);
    return {{x / length, y / length, 1 / length}, pdf};
  }

 private:
  // factor (1 + tan^2/k)^-gamma / (pi ax ay cos^4), tan^2 stretched, in halves: neither the power nor cos^4
  // is formed, as either may leave the range while the product is inside it. 1 + tan^2/k keeps the digits
  // that gamma, up to 1e10, multiplies.
  double DOf(const Vec3<Wide<Real>>& m, double cos_m, double factor) const {
    if (AnyNan(m, gamma, alpha_x, alpha_y)) return kNan<Real>;
    if (!(m.z > Wide<Real>(0))) return 0;
    using W = Wide<Real>;
    const W ax = alpha_x, ay = alpha_y, k = W(gamma) - W(1);
    const W q = (Square(m.x * ay) + Square(m.y * ax)) / (Square(m.z * ax * ay) * k);
    const double root = Pow(DoubleDouble(1) + DoubleDouble(q), -0.5 * gamma) / cos_m / cos_m;
    return factor * (root / (kPi<double> * alpha_x * alpha_y)) * root;
  }
};

template <class Real>
bool IsNan(const StudentT<Real>& d) {
  return AnyNan(d.gamma, d.alpha_x, d.alpha_y);
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_STUDENT_T_H_
