// Fresnel reflectance and transmittance of a dielectric, Walter 2007 Eq. 22, and reflectance of a conductor.
#ifndef MICROLANE_SCALAR_FRESNEL_H_
#define MICROLANE_SCALAR_FRESNEL_H_

#include <algorithm>
#include <cmath>

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
Real FresnelConductor(Real cos_i, Real n, Real kappa) {
  if (AnyNan(cos_i, n, kappa)) return kNan<Real>;
  using W = Wide<Real>;
  const W wide_n = n, wide_kappa = kappa, c = std::abs(cos_i), cos2 = Square(c), sin2 = W(1) - cos2;
  const W below = wide_n - W(1), above = wide_n + W(1), kappa2 = Square(wide_kappa);
  if (Narrow<double>(below) == 0 && kappa == 0) return 0;
  // g^2 = real + i imaginary; its modulus; Re g.
  const W real = (below * above + cos2) - kappa2, imaginary = W(2) * wide_n * wide_kappa;
  const W modulus = Sqrt(Square(real) + Square(imaginary));
  W re_g = 0;
  if (!(real < W(0))) {
    re_g = Sqrt((modulus + real) / W(2));
  } else {
    re_g = imaginary / Sqrt(W(2) * (modulus - real));
  }
  const W cross = W(2) * c * re_g;
  const W sum2 = modulus + cos2 + cross;            // |c + g|^2
  const W squares = modulus * cos2 + Square(sin2);  // |c g|^2 + s^4
  const W mixed2 = squares + cross * sin2;          // |c g + s^2|^2
  if (!(mixed2 > W(0))) return 1;                   // cosines above 1
  const W s = (Square(below) + kappa2) / sum2, p = (Square(above) + kappa2) / sum2 * (squares / mixed2);
  return std::min(Narrow<Real>(s * p), Real(1));
}

// f0 + (1 - f0) (1 - |cos|)^5, Schlick 1994.
template <class Real>
Real FresnelSchlick(Real cos_i, Real f0) {
  if (AnyNan(cos_i, f0)) return kNan<Real>;
  const double x = std::max(0.0, 1 - std::abs(double{cos_i}));
  return static_cast<Real>(f0 + (1 - double{f0}) * Square(Square(x)) * x);
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_FRESNEL_H_
