// Fresnel reflectance and transmittance of a dielectric, Walter 2007 Eq. 22.
#ifndef MICROLANE_SCALAR_FRESNEL_H_
#define MICROLANE_SCALAR_FRESNEL_H_

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

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_FRESNEL_H_
