// Beckmann: Walter 2007 section 5.2, Heitz 2014 section 5.
#ifndef MICROLANE_SCALAR_BECKMANN_H_
#define MICROLANE_SCALAR_BECKMANN_H_

#include <algorithm>
#include <cmath>

#include "microlane/scalar/direction.h"
#include "microlane/scalar/smith.h"

namespace microlane::scalar {

// Walter 2007 Eq. 27, at most 1 (it reaches 1.00006).
inline double RationalG1(double a) {
  if (a >= 1.6) return 1;
  const double g1 = a * (3.535 + 2.181 * a) / (1 + a * (2.276 + 2.577 * a));
  return g1 > 1 ? 1 : g1;
}

template <class Real>
struct Beckmann {
  Real alpha_x, alpha_y;

  // Heitz 2014 Eq. 82 (Walter 2007 Eq. 25). 0 for m.z <= 0.
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

  // scale |v.n| Lambda(v) = scale s exp(-a^2) y(a) / (2 sqrt(pi)), with s = |v.n| / a the stretched tangent
  // and y the defect of erfcx: Heitz 2014 Eqs. 69, 83 without the difference of erf and 1. a^2 is Wide: up to
  // 88 (745 in double), it multiplies its own relative error.
  double ScaledLambda(const Vec3<Real>& v, double scale) const {
    const Wide<Real> s2 = StretchedTangent2(v);
    if (Narrow<double>(s2) == 0) return 0;
    const Wide<Real> a2 = Square(Wide<Real>(v.z)) / s2;
    const Real a = Narrow<Real>(Sqrt(a2));
    return scale * Narrow<double>(Sqrt(s2)) * (ErfcxDefect(a) / (2 * kSqrtPi<double>)) * ExpWide(-a2);
  }

  // chi+ times Walter 2007 Eq. 27.
  Real G1Rational(const Vec3<Real>& v, const Vec3<Real>& m) const {
    if (AnyNan(v, m, alpha_x, alpha_y)) return kNan<Real>;
    if (!SidesAgree(Dot(Widen(v), Widen(m)), v.z)) return 0;
    const double s = Narrow<double>(Sqrt(StretchedTangent2(v)));
    return static_cast<Real>(RationalG1(s == 0 ? kLargest<double> : std::abs(v.z) / s));
  }

  // Walter 2007 Eqs. 28, 29 and the stretch: m along (alpha_x r cos, alpha_y r sin, 1) with
  // r = sqrt(-log(1 - u1)). There D(m) = (1 - u1) / (pi ax ay m.z^4). u1 = 1, which is outside [0, 1), counts
  // as the number below it.
  SampledNormal<double> SampleNormal(double u1, double u2) const {
    const double u = std::min(u1, 1 - 0x1p-53);
    const SinCos<double> phi = SinCos2Pi(u2);
    const double radius = std::sqrt(-std::log1p(-u));
    const double x = alpha_x * radius * phi.cos;
    const double y = alpha_y * radius * phi.sin;
    const double length2 = x * x + y * y + 1;
    const double length = std::sqrt(length2);
    const double pdf = (1 - u) * length * length2 / (kPi<double> * alpha_x * alpha_y);
    return {{x / length, y / length, 1 / length}, pdf};
  }

  // Slopes t along the azimuth of the stretched view, whose share above t is u1, and y = erfinv(2 u2 - 1)
  // across it, stretched. The density is Heitz 2014 Eq. 16, 2 (a + t) exp(-t^2 - y^2) / (sqrt(pi) M alpha_x
  // alpha_y m.z^3), where exp(-y^2) is taken from u2. Below the surface -v is seen.
  SampledNormal<double> SampleVisibleNormal(const Vec3<Real>& v, double u1, double u2, bool = false) const {
    return SampleFacing(v, u1, u2).normal;
  }
  // v.m is q (a + t) over the length of m before it was normalised.
  VisibleNormal SampleFacing(const Vec3<Real>& v, double u1, double u2, bool = false) const {
    if (AnyNan(v, u1, u2, alpha_x, alpha_y)) {
      return {{{kNan<double>, kNan<double>, kNan<double>}, kNan<double>}, kNan<double>};
    }
    const double side = Side(v), qx = side * alpha_x * v.x, qy = side * alpha_y * v.y;
    const double q = std::hypot(qx, qy), z = std::abs(v.z);
    if (q == 0 && z == 0) return {{{0, 0, 0}, 0}, 0};
    const double cos = q == 0 ? 1 : qx / q, sin = q == 0 ? 0 : qy / q;
    const bool far = q * 1e18 < z;
    const double a = far ? 1e18 : z / q;
    const VisibleSlope slope = SolveVisibleSlope(a, InsideUnit(u1));
    const double y = ErfInv(u2), u = InsideUnit(u2);
    const double exp_y2 = 2 * (u < 0.5 ? u : 1 - u) / Erfcx(std::abs(y));
    const Vec3<double> m{alpha_x * (cos * slope.t - sin * y), alpha_y * (sin * slope.t + cos * y), 1};
    const double length2 = Dot(m, m), length = std::sqrt(length2);
    const double area = kSqrtPi<double> / 2 * alpha_x * alpha_y;
    return {{m / length, slope.density * exp_y2 * length * (length2 / area)},
            (far ? z : q * (a + slope.t)) / length};
  }
  static double ShareOfVisible(const Vec3<Real>&, bool) { return 1; }

  // Walter 2007 section 5.3: wider sampling towards grazing bounds the weights.
  Beckmann<double> Widened(double cos_i) const {
    const double scale = 1.2 - 0.2 * std::sqrt(std::abs(cos_i));
    return {alpha_x * scale, alpha_y * scale};
  }

 private:
  struct VisibleSlope {
    double t, density;  // (a + t) exp(-t^2) / M
  };

  // The t >= -a for which u M = sqrt(pi) a erfc(t) + exp(-t^2), M its value at -a, from the nearer end: the
  // share above t = 0 in terms of erfcx(t), that below in terms of erfcx(-t) and of D = M - 2 sqrt(pi) a.
  // Halley's method, kept within a bracket that every step narrows: a step that leaves it is replaced by its
  // middle.
  static VisibleSlope SolveVisibleSlope(double a, double u) {
    const double root_pi_a = kSqrtPi<double> * a;
    const double defect = a < 26 ? ErfcxDefect(a) / ExpOfSquare(a) : 0;
    const double whole = 2 * root_pi_a + defect, below = (1 - u) * whole;
    const bool negative = u * whole > root_pi_a + 1;
    double low = negative ? -std::min(a, 10.0) : 0, high = negative ? 0 : 10;
    // Where the share from t = 0 on were that of a = 0.
    const double part = negative ? (whole - root_pi_a - 1) / below : (root_pi_a + 1) / (u * whole);
    const double radius = std::sqrt(std::log(std::max(part, 1.0)));
    double t = negative ? std::max(-radius, 0.999 * low) : radius;
    for (int i = 0; i < 100; ++i) {
      const double exp_t2 = ExpOfSquare(t), delta = a + t;
      const double rest = negative ? (below - defect) * exp_t2 + 1 - root_pi_a * Erfcx(-t)
                                   : 1 + root_pi_a * Erfcx(t) - u * whole * exp_t2;
      (rest > 0 ? low : high) = t;
      const double step = 2 * delta * rest / (4 * delta * delta + (1 - 2 * t * delta) * rest);
      const double next = t + step;
      const bool inside = next > low && next < high;
      const double previous = t;
      t = inside ? next : (low + high) / 2;
      if (std::abs(t - previous) <= 1e-16 * std::abs(t)) break;
    }
    const double density = negative ? 1 / (whole * ExpOfSquare(t)) : u / (1 + root_pi_a * Erfcx(t));
    return {t, (a + t) * density};
  }

  Wide<Real> StretchedTangent2(const Vec3<Real>& v) const {
    return Square(Wide<Real>(alpha_x) * Wide<Real>(v.x)) + Square(Wide<Real>(alpha_y) * Wide<Real>(v.y));
  }

  // factor exp(-tan^2) / (pi ax ay cos^4), tan^2 stretched, in halves: neither exp(-tan^2) nor cos^4 is
  // formed, as either may leave the range while the product is inside it. tan^2 is Wide for the reason given
  // at ScaledLambda.
  double DOf(const Vec3<Wide<Real>>& m, double cos_m, double factor) const {
    if (AnyNan(m, alpha_x, alpha_y)) return kNan<Real>;
    if (!(m.z > Wide<Real>(0))) return 0;
    const Wide<Real> ax = alpha_x, ay = alpha_y;
    const Wide<Real> tan2 = (Square(m.x * ay) + Square(m.y * ax)) / Square(m.z * ax * ay);
    const double root = ExpWide(tan2 * Wide<Real>(-0.5)) / cos_m / cos_m;
    return factor * (root / (kPi<double> * alpha_x * alpha_y)) * root;
  }
};

template <class Real>
bool IsNan(const Beckmann<Real>& d) {
  return AnyNan(d.alpha_x, d.alpha_y);
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_BECKMANN_H_
