// Smith's Lambda of Student-T slopes (Heitz 2014 Eqs. 41-43), and with them of Phong (section 7).
#ifndef MICROLANE_SCALAR_STUDENT_H_
#define MICROLANE_SCALAR_STUDENT_H_

#include <cmath>

#include "microlane/scalar/direction.h"
#include "microlane/scalar/masking.h"
#include "microlane/scalar/smith.h"

namespace microlane::scalar {

// 2 sqrt(pi) Gamma(n + 1/2) / Gamma(n), n > 0: Gamma's recurrence up to 16, and there Stirling's formula.
inline double StudentNorm(double n) {
  double recurrence = 1;
  for (; n < 16; ++n) recurrence *= n / (n + 0.5);
  const double log_ratio = n * std::log1p(0.5 / n) - 0.5 + StirlingRest(n + 0.5) - StirlingRest(n);
  return 2 * kSqrtPi<double> * recurrence * std::sqrt(n) * std::exp(log_ratio);
}

// d = 1 - 2 n mu (1 + mu^2)^n int_mu^inf (1 + x^2)^-(n + 1) dx, mu >= 0, which is the mean of 1 - mu/S over v
// in [0, 1], S^2 = mu^2 + (1 + mu^2) (v^(-1/n) - 1). With v = e^-y, y = exp(s - e^-s), the trapezoidal rule
// in s (Takahasi and Mori 1974) has positive terms alone.
inline double StudentDefect(double mu, double n) {
  constexpr int steps = 16, low = -4 * steps, high = 4 * steps;
  struct Rule {
    double y[high - low], weight[high - low];
    Rule() {
      for (int k = low; k < high; ++k) {
        const double s = static_cast<double>(k) / steps, x = std::exp(s - std::exp(-s));
        y[k - low] = x;
        weight[k - low] = std::exp(-x) * x * (1 + std::exp(-s)) / steps;
      }
    }
  };
  static const Rule rule;

  const double over_mu2 = 1 + 1 / (mu * mu);
  double sum = 0;
  for (int k = 0; k < high - low; ++k) {
    const double t = over_mu2 * std::expm1(rule.y[k] / n), root = std::sqrt(1 + t);  // S/mu
    sum += rule.weight[k] * (t < 1 ? t / (root * (root + 1)) : 1 - 1 / root);
  }
  return sum;
}

// scale |v.n| Lambda(v) = scale s (1 + mu^2)^-n d Gamma(n) / (2 sqrt(pi) Gamma(n + 1/2)), with s = |v.n| /
// mu. mu^2 is Wide, for n up to 1e10 multiplies its relative error.
template <class Real>
double StudentScaledLambda(Wide<Real> s2, Real vz, double n, double scale) {
  if (Narrow<double>(s2) == 0) return 0;
  const Wide<Real> mu2 = Square(Wide<Real>(vz)) / s2;
  const double defect = StudentDefect(std::sqrt(Narrow<double>(mu2)), n);
  return scale * Narrow<double>(Sqrt(s2)) * (defect / StudentNorm(n)) *
         Pow(DoubleDouble(1) + DoubleDouble(mu2), -n);
}

// Phong with Smith's masking of its own: slopes of the density (exponent + 2)/(2 pi) (1 + x^2 +
// y^2)^-(exponent/2 + 2).
template <class Real>
struct PhongSmith {
  Real exponent;

  double ScaledLambda(const Vec3<Real>& v, double scale) const {
    using W = Wide<Real>;
    return StudentScaledLambda(Square(W(v.x)) + Square(W(v.y)), v.z, exponent / 2.0 + 0.5, scale);
  }
};

template <class Real>
bool IsNan(const PhongSmith<Real>& d) {
  return AnyNan(d.exponent);
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_STUDENT_H_
