// GGX: Walter 2007 section 5.2, Heitz 2014 section 5.
#ifndef MICROLANE_SCALAR_GGX_H_
#define MICROLANE_SCALAR_GGX_H_

#include <cmath>

#include "microlane/scalar/direction.h"
#include "microlane/scalar/smith.h"

namespace microlane::scalar {

template <class Real>
struct Ggx {
  Real alpha_x, alpha_y;

  // Heitz 2014 Eq. 85 (Walter 2007 Eq. 33), with cos^4 multiplied into the bracket: sums of squares
  // only, and no 1 - cos^2. 0 for m.z <= 0.
  Real D(const Vec3<Real>& m) const { return Saturate<Real>(DOf(Widen(m), Wide<Real>(1))); }

  // factor D(half / |half|). The factor comes in, and the product leaves in double, because it may bring D
  // back into range.
  double DOfHalf(const Vec3<Wide<Real>>& half, double factor) const {
    return factor * DOf(half, Dot(half, half));
  }

  // scale |v.n| Lambda(v), Heitz 2014 Eq. 86: (sqrt(1 + t) - 1) / 2 = t / (2 (1 + sqrt(1 + t))), where
  // t = (s / v.n)^2 and s is the stretched tangent.
  double ScaledLambda(const Vec3<Real>& v, double scale) const {
    const double s = Hypot<Real>(double{alpha_x} * v.x, double{alpha_y} * v.y);
    if (s == 0) return s;
    const double cos_v = std::abs(v.z);
    return scale * s / 2 * (s / (cos_v + Hypot<Real>(cos_v, s)));
  }

  // Walter 2007 Eqs. 35, 36 and the stretch of Heitz 2014: m along (alpha_x r cos, alpha_y r sin, 1) with
  // r = sqrt(u1 / (1 - u1)), multiplied by sqrt(1 - u1). There D(m) = (1 - u1)^2 / (pi ax ay m.z^4).
  SampledNormal<double> SampleNormal(double u1, double u2) const {
    const SinCos<double> phi = SinCos2Pi(u2);
    const double radius = std::sqrt(u1);
    const double z = std::sqrt(1 - u1);
    const double x = alpha_x * radius * phi.cos;
    const double y = alpha_y * radius * phi.sin;
    const double length2 = x * x + y * y + (1 - u1);
    const double length = std::sqrt(length2);
    const double pdf = z * length * length2 / (kPi<double> * alpha_x * alpha_y);
    return {{x / length, y / length, z / length}, pdf};
  }

 private:
  // D(m / sqrt(length2)), with every slope's denominator multiplied out.
  double DOf(const Vec3<Wide<Real>>& m, Wide<Real> length2) const {
    if (AnyNan(m, alpha_x, alpha_y)) return kNan<Real>;
    if (!(m.z > Wide<Real>(0))) return 0;
    const Wide<Real> ax = alpha_x, ay = alpha_y;
    const Wide<Real> area = ax * ay;
    const Wide<Real> stretched = Square(m.x * ay) + Square(m.y * ax) + Square(m.z * area);
    return Narrow<double>(area) / kPi<double> * Square(Narrow<double>(area * length2 / stretched));
  }
};

template <class Real>
bool IsNan(const Ggx<Real>& d) {
  return AnyNan(d.alpha_x, d.alpha_y);
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_GGX_H_
