// Fresnel reflectance and transmittance of a dielectric, Walter 2007 Eq. 22, and reflectance of a conductor.
#ifndef MICROLANE_SCALAR_FRESNEL_H_
#define MICROLANE_SCALAR_FRESNEL_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "microlane/scalar/legendre.h"
#include "microlane/scalar/math.h"

namespace microlane::scalar {

// With k = eta^2 - 1 and g^2 = k + c^2, the differences of Eq. 22 become quotients:
//   g - c       = k / (g + c)
//   eta^2 c - g = k ((eta^2 + 1) c^2 - 1) / (eta^2 c + g)
// so reflection is exact to rounding as eta goes to 1, and transmission is a product, never 1 - F.
template <class Real>
class FresnelDielectric {
  using W = Wide<Real>;

 public:
  // cos2 = c^2. g^2 cancels at the critical angle and the bracket at Brewster's, so all of this is Wide; the
  // ratios are rounded once.
  FresnelDielectric(W cos2, Real eta)
      : eta2_(Square(W(eta))), k_((W(eta) - W(1)) * (W(eta) + W(1))), cos2_(cos2) {
    const W g2 = k_ + cos2;
    total_ = g2 < W(0);
    near_critical_ = std::abs(Narrow<double>(g2)) < 0x1p-16;
    if (total_) return;
    c_ = Sqrt(cos2);
    g_ = Sqrt(g2);
  }

  // Walter's g, and k; g only where there is no total internal reflection.
  double g() const { return Narrow<double>(g_); }
  double k() const { return Narrow<double>(k_); }
  bool total_internal_reflection() const { return total_; }
  // Where g^2 magnifies a relative error of c^2 more than 2^15 times.
  bool near_critical_angle() const { return near_critical_; }

  // ((g - c)/(g + c))^2.
  double ReflectanceS() const {
    if (total_) return 1;
    if (MatchedIndex()) return 0;
    return Square(Narrow<double>(k_ / Square(g_ + c_)));
  }
  // ((eta^2 c - g)/(eta^2 c + g))^2.
  double ReflectanceP() const {
    if (total_) return 1;
    if (MatchedIndex()) return 0;
    return Square(Narrow<double>(k_ * MultiplyAdd(eta2_, cos2_, cos2_ - W(1)) / Square(eta2_ * c_ + g_)));
  }
  // Walter 2007 Eq. 22.
  double Reflectance() const { return (ReflectanceS() + ReflectanceP()) / 2; }

  // 1 - F = 2 c g (1/(g + c)^2 + eta^2/(eta^2 c + g)^2).
  double Transmittance() const {
    if (total_) return 0;
    if (MatchedIndex()) return 1;
    return Narrow<double>(W(2) * c_ * g_ * (W(1) / Square(g_ + c_) + eta2_ / Square(eta2_ * c_ + g_)));
  }

 private:
  // eta = 1, where c = 0 leaves 0/0.
  bool MatchedIndex() const { return Narrow<double>(k_) == 0; }

  W eta2_, k_, cos2_;
  W c_ = 0, g_ = 0;
  bool total_, near_critical_;
};

// One kernel's function of (cos_i, eta), given a member above.
template <class Real>
Real OfCosine(Real cos_i, Real eta, double (FresnelDielectric<Real>::*member)() const) {
  if (AnyNan(cos_i, eta)) return kNan<Real>;
  return static_cast<Real>((FresnelDielectric<Real>(Square(Wide<Real>(cos_i)), eta).*member)());
}

// Reflectance of unpolarised light by a conductor of index N = n + i kappa. With g^2 = N^2 - s^2 complex,
//   r_s = (c - g)/(c + g),   r_p = r_s (c g - s^2)/(c g + s^2),
// and c^2 - g^2 = 1 - N^2, hence (|r_s|^2 + |r_p|^2)/2 = |N^2 - 1|^2 (|c g|^2 + s^4) / (|c + g|^2 |c g +
// s^2|)^2, where nothing cancels but Re g^2.
template <class Real>
class FresnelConductor {
  using W = Wide<Real>;

 public:
  // cos2 = c^2.
  FresnelConductor(W cos2, Real n, Real kappa)
      : n_(n), kappa_(kappa), cos2_(cos2), real_(((n_ - W(1)) * (n_ + W(1)) + cos2) - Square(kappa_)) {}

  // Where Re g^2 magnifies a relative error of c^2 more than 2^15 times.
  bool near_critical_angle() const { return std::abs(Narrow<double>(real_)) < 0x1p-16; }

  double Reflectance() const {
    const W below = n_ - W(1), above = n_ + W(1), kappa2 = Square(kappa_);
    if (Narrow<double>(below) == 0 && Narrow<double>(kappa_) == 0) return 0;
    const W c = Sqrt(cos2_), sin2 = W(1) - cos2_;
    // g^2 = real + i imaginary; its modulus; Re g.
    const W imaginary = W(2) * n_ * kappa_;
    const W modulus = Sqrt(Square(real_) + Square(imaginary));
    W re_g = 0;
    if (!(real_ < W(0))) {
      re_g = Sqrt((modulus + real_) / W(2));
    } else {
      re_g = imaginary / Sqrt(W(2) * (modulus - real_));
    }
    const W cross = W(2) * c * re_g;
    const W sum2 = modulus + cos2_ + cross;            // |c + g|^2
    const W squares = modulus * cos2_ + Square(sin2);  // |c g|^2 + s^4
    const W mixed2 = squares + cross * sin2;           // |c g + s^2|^2
    if (!(mixed2 > W(0))) return 1;                    // a cosine above 1
    const W s = (Square(below) + kappa2) / sum2, p = (Square(above) + kappa2) / sum2 * (squares / mixed2);
    return Narrow<double>(s * p);
  }

 private:
  W n_, kappa_, cos2_;
  W real_;  // Re g^2
};

template <class Real>
Real ConductorOfCosine(Real cos_i, Real n, Real kappa) {
  if (AnyNan(cos_i, n, kappa)) return kNan<Real>;
  return static_cast<Real>(FresnelConductor<Real>(Square(Wide<Real>(cos_i)), n, kappa).Reflectance());
}

// r_e of N = (1 + x)/(1 - x) >= 1, Int 2 c F dc over cosines c (Molenaar; Meneveaux 2015 Eq. 10). With c =
// sqrt(k) sinh(t), k = N^2 - 1, g is sqrt(k) cosh(t), and Eq. 7 has (g - c)/(g + c) = exp(-2 t), c (g + c) =
// k (exp(2 t) - 1)/2 and c (g - c) = k (1 - exp(-2 t))/2: nothing cancels as N goes to 1.
inline double DiffuseFresnelOfRatio(double x) {
  static const std::vector<LegendreNode> nodes = LegendreNodes(48);
  if (x == 0) return 0;
  const double k = 4 * x / Square(1 - x), end = std::min(20.0, -std::log(x) / 2);
  double sum = 0;
  for (const LegendreNode& node : nodes) {
    const double t = end * node.t;
    const double ratio = (k / 2 * std::expm1(2 * t) - 1) / (1 - k / 2 * std::expm1(-2 * t));
    sum += node.weight * std::sinh(2 * t) * std::exp(-4 * t) * (1 + Square(ratio));
  }
  return k / 2 * end * sum;
}

template <class Real>
Real Clamp(Real x, Real low, Real high) {
  return x < low ? low : x > high ? high : x;
}

// r_e and r_i by n^2 (1 - r_i) = 1 - r_e; from the denser side r_e is r_i of 1/n.
template <class Real>
double DiffuseFresnel(Real eta, bool external) {
  const double n = Clamp<Real>(eta, Real(0.25), 4), thin = DiffuseFresnelOfRatio(std::abs(n - 1) / (n + 1));
  if ((n >= 1) == external) return thin;
  return external ? (1 - n) * (1 + n) + n * n * thin : ((n - 1) * (n + 1) + thin) / (n * n);
}

template <class Real>
Real DiffuseExternal(Real eta) {
  return AnyNan(eta) ? kNan<Real> : static_cast<Real>(DiffuseFresnel(eta, true));
}
template <class Real>
Real DiffuseInternal(Real eta) {
  return AnyNan(eta) ? kNan<Real> : static_cast<Real>(DiffuseFresnel(eta, false));
}

// k/(n^2 (1 - k r_i)) of Meneveaux 2015 Eq. 8, as k/(n^2 (1 - k) + k (1 - r_e)).
template <class Real>
double BodyAlbedo(Real n_i, Real k_d) {
  const double n = Clamp<Real>(n_i, 1, 4), k = Clamp<Real>(k_d, 0, 1);
  return k / (n * n * (1 - k) + k * (1 - DiffuseFresnel(n, true)));
}

// f0 + (1 - f0) x^5 of x = 1 - |cos|, Schlick 1994.
inline double FresnelSchlick(double x, double f0) {
  x = std::max(0.0, x);
  return f0 + (1 - f0) * Square(Square(x)) * x;
}

template <class Real>
Real SchlickOfCosine(Real cos_i, Real f0) {
  if (AnyNan(cos_i, f0)) return kNan<Real>;
  return static_cast<Real>(FresnelSchlick(1 - std::abs(double{cos_i}), f0));
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_FRESNEL_H_
