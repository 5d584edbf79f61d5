// GGX: Walter 2007 section 5.2, Heitz 2014 section 5.
#ifndef MICROLANE_SCALAR_GGX_H_
#define MICROLANE_SCALAR_GGX_H_

#include <algorithm>
#include <cmath>

#include "microlane/scalar/direction.h"
#include "microlane/scalar/smith.h"

namespace microlane::scalar {

template <class Real>
struct Ggx {
  Real alpha_x, alpha_y;

  // Heitz 2014 Eq. 85 (Walter 2007 Eq. 33), with cos^4 multiplied into the bracket: sums of squares
  // only, and no 1 - cos^2. 0 for m.z <= 0.
  Real D(const Vec3<Real>& m) const { return Saturate<Real>(DTimes(m, 1)); }

  // factor D(m), for a factor that may bring D back into range.
  double DTimes(const Vec3<Real>& m, double factor) const { return DOfGiven(Widen(m), factor); }
  double DOfGiven(const Vec3<Wide<Real>>& m, double factor) const { return factor * DOf(m, Wide<Real>(1)); }

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

  // Dupuy and Benyoub 2023: half vectors h of the stretched view s and of points c that are uniform on the
  // cap c.z > -k s.z, stretched back to m. 1 - c.z = u1 (1 + k s.z), 1 + c.z = 2 (1 - u1) + u1 (1 - k s.z),
  // and h.z are sums of positive terms. The density is Heitz 2014 Eq. 16 where s.h = h.h / 2, over the share
  // of the cap. Below the surface -v is seen. k = 1 draws from all visible normals. Bounded, for reflection:
  // k = (1 - a^2) t^2 / (t^2 + a^2 v.z^2) with a = min(alpha_x, alpha_y, 1) and t = 1 + sin(theta_v), Eto and
  // Tokuyoshi 2023.
  SampledNormal<double> SampleVisibleNormal(const Vec3<Real>& v, double u1, double u2,
                                            bool bounded = false) const {
    return SampleFacing(v, u1, u2, bounded).normal;
  }

  // |v.m| = |q| h.h / (2 |m|) of the stretched view q and m before it was normalised.
  VisibleNormal SampleFacing(const Vec3<Real>& v, double u1, double u2, bool bounded) const {
    if (AnyNan(v, u1, u2, alpha_x, alpha_y)) {
      return {{{kNan<double>, kNan<double>, kNan<double>}, kNan<double>}, kNan<double>};
    }
    const double side = Side(v), ax = alpha_x, ay = alpha_y;
    const Vec3<double> stretched{side * ax * v.x, side * ay * v.y, side * v.z};
    const double tangent = Hypot<Real>(stretched.x, stretched.y);
    const double length = Hypot<Real>(tangent, stretched.z);
    if (!(length > 0)) return {{{0, 0, 0}, 0}, 0};
    const Vec3<double> s = stretched / length;
    const auto [k, one_minus_k] = CapBound(v, bounded);
    const double above = 1 + k * s.z;
    const double below = Square(tangent / length) / (1 + s.z) + one_minus_k * s.z;  // 1 - k s.z
    const double sin_c = std::sqrt(u1 * above * (2 * (1 - u1) + u1 * below));
    const SinCos<double> phi = SinCos2Pi(u2);
    const Vec3<double> h{sin_c * phi.cos + s.x, sin_c * phi.sin + s.y, (1 - u1) * above + one_minus_k * s.z};
    const Vec3<double> m{ax * h.x, ay * h.y, h.z};
    const double h2 = Dot(h, h), m_length = std::sqrt(Dot(m, m));
    if (!(m_length > 0)) return {{{0, 0, 0}, 0}, 0};
    return {{m / m_length, m_length * (Square(m_length) / h2) / (kPi<double> * ax * ay * above)},
            length * h2 / (2 * m_length)};
  }

  // The share of the cap that is left to bounded sampling: (1 + k s.z) / (1 + s.z).
  double ShareOfVisible(const Vec3<Real>& v, bool bounded) const {
    const double tangent = Hypot<Real>(double{alpha_x} * v.x, double{alpha_y} * v.y), z = std::abs(v.z);
    const double length = Hypot<Real>(tangent, z);
    return (length + CapBound(v, bounded).k * z) / (length + z);
  }

 private:
  struct Bound {
    double k, one_minus_k;
  };
  Bound CapBound(const Vec3<Real>& v, bool bounded) const {
    if (!bounded) return {1, 0};
    const double a2 = Square(std::min({double{alpha_x}, double{alpha_y}, 1.0}));
    const double t2 = Square(1 + Hypot<Real>(v.x, v.y)), z2 = Square(double{v.z});
    return {(1 - std::sqrt(a2)) * (1 + std::sqrt(a2)) * (t2 / (t2 + a2 * z2)),
            a2 * ((z2 + t2) / (t2 + a2 * z2))};
  }

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
