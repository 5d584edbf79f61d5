// Masking functions of Heitz 2014 section 4.3 and V-cavities, and joint masking-shadowing from Smith's
// Lambda.
#ifndef MICROLANE_SCALAR_MASKING_H_
#define MICROLANE_SCALAR_MASKING_H_

#include <algorithm>
#include <cmath>

#include "microlane/scalar/direction.h"

namespace microlane::scalar {

// v.m as seen from v's side of the surface; 0 where v is along it.
template <class Real>
Wide<Real> FacingDot(const Vec3<Real>& v, const Vec3<Real>& m) {
  if (v.z == 0) return 0;
  const Wide<Real> dot = Dot(Widen(v), Widen(m));
  return v.z < 0 ? -dot : dot;
}

// min(1, 2 mz |vz| / |v.m|), Heitz 2014 Eq. 49.
template <class Real>
Real VCavityG1(const Vec3<Real>& v, const Vec3<Real>& m) {
  if (AnyNan(v, m)) return kNan<Real>;
  using W = Wide<Real>;
  const W facing = FacingDot(v, m);
  if (!(facing > W(0)) || m.z <= 0) return 0;
  const W area = W(2 * std::abs(v.z)) * W(m.z);
  return area < facing ? Narrow<Real>(area / facing) : Real(1);
}

// The density of the normals that V-cavities show: VCavityG1 |v.m| D(m) / |v.n| = min(|v.m| / |vz|, 2 mz)
// D(m), Heitz 2014 Eqs. 16, 49. v.n = 0 counts as above the surface.
template <class Distribution, class Real>
Real DVisibleVCavity(const Distribution& distribution, const Vec3<Real>& v, const Vec3<Real>& m) {
  if (AnyNan(distribution, v, m)) return kNan<Real>;
  const double v_m = Narrow<double>(Dot(Widen(v), Widen(m))), facing = v.z < 0 ? -v_m : v_m;
  if (!(facing > 0)) return 0;
  return Saturate<Real>(distribution.DTimes(m, std::min(facing / std::abs(v.z), 2.0 * m.z)));
}

// A normal that V-cavities show: one by D cos, or the other facet of its cavity, (-mx, -my, mz), each by its
// share of what v sees (Heitz and d'Eon 2014). Its density is D cos times twice that share.
template <class Distribution, class Real>
SampledNormal<double> SampleVCavity(const Distribution& distribution, const Vec3<Real>& v, double u1,
                                    double u2, double u3) {
  if (AnyNan(distribution, v, u1, u2, u3)) {
    return {{kNan<double>, kNan<double>, kNan<double>}, kNan<double>};
  }
  SampledNormal<double> normal = distribution.SampleNormal(u1, u2);
  Vec3<double>& m = normal.m;
  const double z = m.z * std::abs(v.z), across = Side(v) * (m.x * v.x + m.y * v.y);
  const bool other = 2 * u3 * z < z - across;
  if (other) {
    m.x = -m.x;
    m.y = -m.y;
  }
  const double seen = other ? z - across : z + across;
  normal.pdf *= seen >= 2 * z ? 2 : seen / z;
  return normal;
}

// |vz|, Heitz 2014 Eq. 56.
template <class Real>
Real ImplicitG1(const Vec3<Real>& v, const Vec3<Real>& m) {
  if (AnyNan(v, m)) return kNan<Real>;
  return FacingDot(v, m) > Wide<Real>(0) ? std::abs(v.z) : Real(0);
}

// c/(c (1 - k) + k) with k = alpha sqrt(2/pi), Heitz 2014 section 4.3, as a sum of positive terms.
template <class Real>
Real SchlickSmithG1(const Vec3<Real>& v, const Vec3<Real>& m, Real alpha) {
  if (AnyNan(v, m, alpha)) return kNan<Real>;
  if (!(FacingDot(v, m) > Wide<Real>(0))) return 0;
  const double k = 0.79788456080286535588 * alpha, c = std::abs(v.z);
  return static_cast<Real>(c / (c + k * (1 - c)));
}

// |vz| / |v.m|, Heitz 2014 Eq. 59: above 1 where the microfacet is seen at a smaller cosine than the surface.
template <class Real>
Real KelemenG1(const Vec3<Real>& v, const Vec3<Real>& m) {
  if (AnyNan(v, m)) return kNan<Real>;
  const Wide<Real> facing = FacingDot(v, m);
  return facing > Wide<Real>(0) ? Narrow<Real>(Wide<Real>(std::abs(v.z)) / facing) : Real(0);
}

// The angle in [0, pi] between the azimuths of (ax, ay) and (bx, by); 0 where either has none.
template <class Real>
double AzimuthDifference(Real ax, Real ay, Real bx, Real by) {
  using W = Wide<Real>;
  const double sine = Narrow<double>(W(ax) * W(by) - W(ay) * W(bx));
  const double cosine = Narrow<double>(W(ax) * W(bx) + W(ay) * W(by));
  return sine == 0 && cosine == 0 ? 0 : std::atan2(std::abs(sine), cosine);
}

// G2 as a function of both Lambdas. Products of the largest Lambda are within double's range for float alone,
// so that areas 1 + Lambda divide one after the other.

// 1/((1 + Lambda_i)(1 + Lambda_o)), Heitz 2014 Eq. 98.
template <class Real>
Real SeparableG2(Real lambda_i, Real lambda_o) {
  if (AnyNan(lambda_i, lambda_o)) return kNan<Real>;
  return static_cast<Real>(1 / (1.0 + lambda_i) / (1.0 + lambda_o));
}

// 1/(1 + Lambda_i + Lambda_o), Heitz 2014 Eq. 99.
template <class Real>
Real HeightCorrelatedG2(Real lambda_i, Real lambda_o) {
  if (AnyNan(lambda_i, lambda_o)) return kNan<Real>;
  return static_cast<Real>(0.5 / (0.5 + 0.5 * double{lambda_i} + 0.5 * double{lambda_o}));
}

// What Stirling's formula lacks of log Gamma(x), for x >= 7.
inline double StirlingRest(double x) {
  constexpr double kBernoulli[] = {1.0 / 12,        -1.0 / 360, 1.0 / 1260,       -1.0 / 1680,     1.0 / 1188,
                                   -691.0 / 360360, 1.0 / 156,  -3617.0 / 122400, 43867.0 / 244188};
  double power = 1 / x, sum = 0;
  for (const double term : kBernoulli) {
    sum += term * power;
    power /= x * x;
  }
  return sum;
}

// B(1 + Lambda_i, 1 + Lambda_o), B Euler's Beta function: from B(l + 7, g + 7) by Stirling's series and
// Gamma's recurrence, with logarithms of ratios alone, which do not cancel.
template <class Real>
Real HeightCorrelatedTransmissionG2(Real lambda_i, Real lambda_o) {
  if (AnyNan(lambda_i, lambda_o)) return kNan<Real>;
  // Total: Lambdas outside [0, 2^129) count as its ends.
  const double i = std::clamp<double>(lambda_i, 0, 0x1p129), o = std::clamp<double>(lambda_o, 0, 0x1p129);
  const double l = std::min(i, o), g = std::max(i, o);
  double recurrence = 1;
  for (int k = 1; k <= 6; ++k) {
    recurrence *= (l + g + 2 * k) / (g + k) * ((l + g + 2 * k + 1) / (l + k));
  }
  const double p = l + 7, q = g + 7, r = p + q;
  const double log_beta = -(p - 0.5) * std::log(r / p) - q * std::log1p(p / q) -
                          0.5 * std::log(q / (2 * kPi<double>)) + StirlingRest(p) + StirlingRest(q) -
                          StirlingRest(r);
  const double half = std::exp(0.5 * log_beta);  // the product with the recurrence is in range, not the other
  return static_cast<Real>(half * recurrence * half);
}

// t = 4.41 phi, so that van Ginneken's lambda is t/(1 + t).
inline double DirectionalDecay(double phi) { return 4.41 * phi; }

// lambda G1(i) G1(o) + (1 - lambda) min(G1(i), G1(o)), Heitz 2014 Eq. 100.
template <class Real>
Real DirectionCorrelatedG2(Real lambda_i, Real lambda_o, double phi) {
  if (AnyNan(lambda_i, lambda_o, phi)) return kNan<Real>;
  const double t = DirectionalDecay(phi);
  const double lesser = std::min(lambda_i, lambda_o), greater = std::max(lambda_i, lambda_o);
  return static_cast<Real>((1 + t / (1 + lesser)) / (1 + t) / (1 + greater));
}

// 1/(1 + max(Lambda_i, Lambda_o) + lambda min(Lambda_i, Lambda_o)), Heitz 2014 Eq. 101.
template <class Real>
Real HeightDirectionCorrelatedG2(Real lambda_i, Real lambda_o, double phi) {
  if (AnyNan(lambda_i, lambda_o, phi)) return kNan<Real>;
  const double t = DirectionalDecay(phi), lambda = t / (1 + t);
  const double lesser = std::min(lambda_i, lambda_o), greater = std::max(lambda_i, lambda_o);
  return static_cast<Real>(0.5 / (0.5 + 0.5 * greater + lambda * (0.5 * lesser)));
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_MASKING_H_
