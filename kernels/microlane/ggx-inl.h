// GGX (Walter 2007 Eqs. 33-36; Heitz 2014 Eqs. 70-72, 84-86) in lanes, isotropic (one alpha) or anisotropic
// (two).
#if defined(MICROLANE_GGX_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_GGX_INL_H_
#undef MICROLANE_GGX_INL_H_
#else
#define MICROLANE_GGX_INL_H_
#endif

#include "microlane/distribution-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct Ggx {
  static constexpr bool kHasExponent = false, kMaskingInDouble = false;

  // A^2 + B^2 + C^2 of Stretch as an unevaluated sum.
  template <Care kCare, class D, class... P>
  static HWY_INLINE void Density(D d, Vec<D>& e, Vec<D>& e_tail, Vec<D>& w, Vec<D> hx, Vec<D> hy, Vec<D> hz,
                                 P... p) {
    Vec<D> ux, uy, uz, uz_tail;
    Stretch<kCare>(d, ux, uy, uz, uz_tail, w, p...);
    if constexpr (kCare == Care::kPlain) {
      const Vec<D> a = hn::Mul(hx, ux), b = hn::Mul(hy, uy), c = hn::Mul(hz, uz);
      e = Dot(a, b, c, a, b, c);
      e_tail = hn::Zero(d);
    } else {
      Vec<D> a2, b2, c2, a2_tail, b2_tail, c2_tail, s, s_tail;
      SquareOfProduct(d, hx, ux, hn::Zero(d), a2, a2_tail);
      SquareOfProduct(d, hy, uy, hn::Zero(d), b2, b2_tail);
      SquareOfProduct(d, hz, uz, uz_tail, c2, c2_tail);
      TwoSum(a2, b2, s, s_tail);
      TwoSum(s, c2, e, e_tail);
      e_tail = hn::Add(hn::Add(e_tail, s_tail), hn::Add(hn::Add(a2_tail, b2_tail), c2_tail));
    }
  }

  // |vz| (1 + 2 Lambda) = sqrt(vz^2 + (alpha_x vx)^2 + (alpha_y vy)^2), from Heitz 2014 Eq. 86.
  template <Care kCare, Accuracy A, class D, class... P>
  static HWY_INLINE Vec<D> Masking(D d, Vec<D> vx, Vec<D> vy, Vec<D> z, P... p) {
    const Vec<D> square = hn::MulAdd(z, z, ProjectedRoughness2<kCare>(d, vx, vy, p...));
    return kCare == Care::kPlain ? SqrtOfPositive<A>(d, square) : Sqrt<A>(d, square);
  }

  // Lambda = t / (2 (1 + sqrt(1 + t))), t = tan^2 / a^2 form of Heitz 2014 Eq. 86: nothing cancels. vz is
  // scaled so that a subnormal cosine keeps its bits.
  template <Accuracy A, class D, class... P>
  static HWY_INLINE Vec<D> Lambda(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, P... p) {
    const Vec<D> z = hn::Abs(vz), scale = Const(d, 0x1p60);
    const Vec<D> s2 = ProjectedRoughness2<Care::kCareful>(d, vx, vy, p...);
    const Vec<D> root = Sqrt<A>(d, hn::MulAdd(z, z, s2));
    const Vec<D> half = Const(d, 0.5);
    const Vec<D> zs = hn::Mul(z, scale);
    const Vec<D> q = hn::Div(hn::Mul(hn::Mul(s2, half), scale), hn::MulAdd(zs, root, hn::Mul(zs, z)));
    return ZeroIf(hn::Eq(s2, hn::Zero(d)), q);
  }

  // Walter 2007 Eqs. 35, 36 with r = sqrt(u1/(1 - u1)), scaled by 1 - u1; pdf = D cos = |.|^3 / (pi ax ay (1
  // - u1)).
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void SampleNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> u1,
                                      Vec<D> u2, P... p) {
    u1 = BelowOne(d, u1);
    const Vec<D> w = hn::Sub(Const(d, 1), u1);
    const Vec<D> area = hn::Mul(hn::Mul(hn::Mul(AlphaX(p...), AlphaY(p...)), Const(d, kPi)), w);
    NormalFromSlopes<A>(d, mx, my, mz, pdf, hn::Sqrt(hn::Mul(u1, w)), w, u2, area, AlphaX(p...),
                        AlphaY(p...));
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_GGX_INL_H_
