// Fresnel reflectance of a conductor, index eta + i kappa (Meneveaux 2015 section 2.2; Kelemen 2001
// appendix), and Schlick's approximation, in lanes. With c = |i.m|, s^2 = 1 - c^2, the complex g^2 = (eta + i
// kappa)^2 - s^2, R = |g|^2 and a = Re g, the complex forms of the dielectric's A and M (fresnel-inl.h) are
//   A = |g + c|^2 = R + c^2 + 2 a c,   M^2 = |g c + s^2|^2 = N + 2 a c s^2,   N = R c^2 + s^4,
//   F = |g^2 - c^2|^2 N / (A M)^2,   |g^2 - c^2|^2 = ((eta - 1)^2 + kappa^2) ((eta + 1)^2 + kappa^2),
// sums of positive terms but for t = Re g^2 = eta^2 - kappa^2 - s^2. At kappa = 0 this is the dielectric,
// total internal reflection included.
#if defined(MICROLANE_CONDUCTOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_CONDUCTOR_INL_H_
#undef MICROLANE_CONDUCTOR_INL_H_
#else
#define MICROLANE_CONDUCTOR_INL_H_
#endif

#include "microlane/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// t = eta^2 - kappa^2 + c^2 - 1, of floats to a few roundings of itself: their products are exact in double
// lanes.
struct ConductorTOp {
  template <class DD>
  static HWY_INLINE void Run(DD dd, Vec<DD>& t, Vec<DD>& unused, Vec<DD> c, Vec<DD> eta, Vec<DD> kappa) {
    Vec<DD> e, e_tail, k, k_tail, s, s_tail, u, u_tail, v, v_tail;
    TwoProduct(dd, eta, eta, e, e_tail);
    TwoProduct(dd, kappa, kappa, k, k_tail);
    TwoSum(e, Const(dd, -1), s, s_tail);
    TwoSum(s, hn::Neg(k), u, u_tail);
    TwoSum(u, hn::Mul(c, c), v, v_tail);
    const Vec<DD> tail = hn::Add(hn::Add(hn::Add(s_tail, u_tail), v_tail), hn::Sub(e_tail, k_tail));
    t = unused = hn::Add(v, tail);
  }
};

struct ConductorOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& f, Vec<D>& unused, Vec<D> cos_i, Vec<D> eta, Vec<D> kappa) {
    const Vec<D> one = Const(d, 1), low = Const(d, kIsFloat<D> ? 1e-30 : 1e-280);
    const Vec<D> c = hn::Abs(cos_i), c2 = hn::Mul(c, c), s2 = hn::NegMulAdd(c, c, one);
    Vec<D> t, ignored;
    InDouble2<ConductorTOp>(d, t, ignored, c, eta, kappa);
    const Vec<D> ek = hn::Mul(eta, kappa), twice = hn::Add(ek, ek);
    const Vec<D> r = CloseSqrt<A>(d, hn::MulAdd(t, t, hn::Mul(twice, twice)));
    // a^2 = (R + t)/2, or where that cancels 2 (eta kappa)^2 / (R - t).
    const Vec<D> sum = hn::Max(hn::Add(r, hn::Abs(t)), low);
    const Vec<D> a2 = hn::IfThenElse(hn::Lt(t, hn::Zero(d)), hn::Mul(twice, Div<A>(d, ek, sum)),
                                     hn::Mul(sum, Const(d, 0.5)));
    const Vec<D> two_ac = hn::Mul(hn::Add(c, c), Sqrt<A>(d, a2));
    const Vec<D> n = hn::MulAdd(r, c2, hn::Mul(s2, s2)), m2 = hn::MulAdd(two_ac, s2, n);
    const Vec<D> amplitude = hn::Max(hn::Add(hn::Add(r, c2), two_ac), low);
    // |eta + i kappa - 1|^2 scaled, as it may be subnormal where F is not.
    constexpr double kScale = 0x1p40;
    const Vec<D> below = hn::Mul(hn::Sub(eta, one), Const(d, kScale)), above = hn::Add(eta, one);
    const Vec<D> k = hn::Mul(kappa, Const(d, kScale));
    const Vec<D> r_s = Div<A>(d, hn::MulAdd(below, below, hn::Mul(k, k)), amplitude);
    const Vec<D> p = hn::Mul(hn::MulAdd(above, above, hn::Mul(kappa, kappa)), n);
    const Vec<D> r_p = Div<A>(d, p, hn::Max(hn::Mul(amplitude, m2), low));
    f = unused = hn::Min(one, hn::Mul(hn::Mul(r_s, r_p), Const(d, 1 / (kScale * kScale))));
  }
};

// F of a conductor, of a cosine of either sign. kStandard runs in double lanes.
template <Accuracy A, class D>
HWY_INLINE Vec<D> FresnelConductor(D d, Vec<D> cos_i, Vec<D> eta, Vec<D> kappa) {
  Vec<D> f, unused;
  Precisely<ConductorOp, A>(d, f, unused, cos_i, eta, kappa);
  if constexpr (A == Accuracy::kFast) {
    // Where g^2 is nearly 0, squares of floats leave their range: no other lanes take the double lanes' F.
    Vec<D> t;
    InDouble2<ConductorTOp>(d, t, unused, hn::Abs(cos_i), eta, kappa);
    const Vec<D> tiny = Const(d, 1e-12);
    const auto vanishes = hn::And(hn::Lt(hn::Abs(t), tiny), hn::Lt(hn::Mul(eta, kappa), tiny));
    if (HWY_UNLIKELY(!hn::AllFalse(d, vanishes))) {
      Vec<D> exact;
      InDouble2<InStandard<ConductorOp>>(d, exact, unused, cos_i, eta, kappa);
      f = hn::IfThenElse(vanishes, exact, f);
    }
  }
  return f;
}

// f0 + (1 - f0) (1 - |cos|)^5.
struct SchlickOp {
  template <Accuracy, class D>
  static HWY_INLINE void Run(D d, Vec<D>& f, Vec<D>& unused, Vec<D> cos_i, Vec<D> f0) {
    const Vec<D> x = hn::Max(hn::Zero(d), hn::Sub(Const(d, 1), hn::Abs(cos_i))), x2 = hn::Mul(x, x);
    f = unused = hn::MulAdd(hn::Sub(Const(d, 1), f0), hn::Mul(hn::Mul(x2, x2), x), f0);
  }
};

template <Accuracy A, class D>
HWY_INLINE Vec<D> FresnelSchlick(D d, Vec<D> cos_i, Vec<D> f0) {
  Vec<D> f, unused;
  Precisely<SchlickOp, A>(d, f, unused, cos_i, f0);
  return f;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_CONDUCTOR_INL_H_
