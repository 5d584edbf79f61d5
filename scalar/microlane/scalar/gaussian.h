// The Gaussian of the angle: Meneveaux 2015 Eq. 13.
#ifndef MICROLANE_SCALAR_GAUSSIAN_H_
#define MICROLANE_SCALAR_GAUSSIAN_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "microlane/scalar/direction.h"
#include "microlane/scalar/fresnel.h"
#include "microlane/scalar/legendre.h"

namespace microlane::scalar {

template <class Real>
struct Gaussian {
  Real sigma;

  // C, by a rule over nine sigma or up to the horizon: beyond, 1e-18 of the integral is left.
  double Normalisation() const {
    static const std::vector<LegendreNode> nodes = LegendreNodes(48);
    const double s = Sigma(), end = std::min(9 * s, kPi<double> / 2);
    double sum = 0;
    for (const LegendreNode& node : nodes) {
      const double t = end * node.t;
      sum += node.weight * std::exp(-Square(t / s) / 2) * std::sin(t);
    }
    return 1 / (2 * kPi<double> * end * sum);
  }

  // Eq. 13. 0 for m.z <= 0.
  Real D(const Vec3<Real>& m) const { return Saturate<Real>(DTimes(m, 1)); }

  // factor D(m), for a factor that may bring D back into range.
  double DTimes(const Vec3<Real>& m, double factor) const {
    if (AnyNan(m, sigma)) return kNan<double>;
    if (!(m.z > 0)) return 0;
    return TimesGaussian(std::atan2(Hypot<Real>(m.x, m.y), double{m.z}), factor / m.z);
  }

  // f |wo.n| of ideal mirrors with the masking of V-cavities, Eqs. 13, 14, about H = wi + wo whose length
  // cancels in G. 0 for opposite sides.
  Real EvalVCavity(const Vec3<Real>& wi, const Vec3<Real>& wo) const {
    if (AnyNan(wi, wo, sigma)) return kNan<Real>;
    if (wi.z == 0 || wo.z == 0 || (wi.z > 0) != (wo.z > 0)) return 0;
    const Vec3<Wide<Real>> h = Widen(wi) + Widen(wo);
    const double wi_h = Narrow<double>(Dot(Widen(wi), h)), wo_h = Narrow<double>(Dot(Widen(wo), h));
    if (!(wi_h > 0 && wo_h > 0)) return 0;
    const Vec3<double> half = Narrow<double>(h);
    const double hz = std::abs(half.z), zi = std::abs(wi.z), zo = std::abs(wo.z);
    const double visible = std::min({1 / (4 * zi), hz / (2 * wi_h), hz * zo / (2 * wo_h * zi)});
    const double sine = std::hypot(half.x, half.y);
    return Saturate<Real>(TimesGaussian(std::atan2(sine, hz), visible * std::hypot(sine, hz) / hz));
  }

  // theta = sigma sqrt(-2 log(1 - u1 q)), q = 1 - exp(-pi^2/(8 sigma^2)): Rayleigh's distribution cut off at
  // the horizon. The logarithm's argument is 1 - u1 plus what u1 q lacks of u1, from which nothing cancels as
  // u1 goes to 1. pdf is the density over solid angle, which is not D cos.
  SampledNormal<double> SampleNormal(double u1, double u2) const {
    if (AnyNan(u1, u2, sigma)) return {{kNan<double>, kNan<double>, kNan<double>}, kNan<double>};
    u1 = std::min(std::max(u1, 0.0), 1 - 0x1p-53);
    const double s = Sigma(), log_horizon = -Square(kPi<double> / s) / 8;
    const double q = -std::expm1(log_horizon), u = u1 * q, left = 1 - u1 + u1 * std::exp(log_horizon);
    const double log_left = u < 0.5 ? std::log1p(-u) : std::log(left);
    const double theta = std::min(s * std::sqrt(-2 * log_left), kPi<double> / 2);
    const double sin_m = std::sin(theta);
    const SinCos<double> phi = SinCos2Pi(u2);
    const double pdf = (sin_m > 0 ? theta / sin_m : 1) * left / (2 * kPi<double> * s * s * q);
    return {{sin_m * phi.cos, sin_m * phi.sin, std::cos(theta)}, pdf};
  }

 private:
  // factor C exp(-theta^2/(2 sigma^2)): the root is in range whenever the product is.
  double TimesGaussian(double theta, double factor) const {
    const double root = std::exp(-Square(theta / Sigma()) / 4);
    return factor * (Normalisation() * root) * root;
  }
  double Sigma() const { return Clamp<double>(sigma, 1e-3, 2); }
};

template <class Real>
bool IsNan(const Gaussian<Real>& d) {
  return AnyNan(d.sigma);
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_GAUSSIAN_H_
