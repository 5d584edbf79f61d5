// Dielectric Fresnel (Walter 2007 Eq. 22) in lanes, from squares: with c = |i.m|, g = sqrt(eta^2 - 1 + c^2),
// p = c g, s^2 = 1 - c^2, k = eta^2 - 1, A = (g + c)^2 = g^2 + c^2 + 2 p and M = p + s^2,
//   F = k^2 (p^2 + s^4) / (A M)^2   since (g - c)(g + c) = k,
//   T = 1 - F = 2 p A (M^2 + eta^2) / (A M)^2,
//   R_s = (k/A)^2,   R_p = (k ((eta^2 + 1) c^2 - 1) / (A M^2))^2.
// One root (p) and one division; nothing cancels.
#if defined(MICROLANE_FRESNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_FRESNEL_INL_H_
#undef MICROLANE_FRESNEL_INL_H_
#else
#define MICROLANE_FRESNEL_INL_H_
#endif

#include "microlane/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// A and M times a common scale of c^2, g^2, p and s^2. kKeepPositive: A stays above 0 where c = g = 0 (no
// interface, no light), so that 0/0 is 0.
template <bool kKeepPositive, class D>
HWY_INLINE void FresnelTerms(D d, Vec<D>& a, Vec<D>& m, Vec<D> c2_plus_g2, Vec<D> p, Vec<D> s2) {
  a = hn::MulAdd(Const(d, 2), p, c2_plus_g2);
  if constexpr (kKeepPositive) {
    const Vec<D> low = Const(d, kIsFloat<D> ? 1e-30 : 1e-280);
    a = hn::IfThenElse(hn::Lt(a, low), low, a);
  }
  m = hn::Add(p, s2);
}

// eta^2 - 1, rounded once.
template <class D>
HWY_INLINE Vec<D> EtaSquaredMinus1(D d, Vec<D> eta) {
  const Vec<D> one = Const(d, 1);
#if HWY_NATIVE_FMA
  return hn::MulSub(eta, eta, one);
#else
  return hn::Mul(hn::Sub(eta, one), hn::Add(eta, one));
#endif
}

// g^2 = eta^2 - 1 + c^2; negative under total internal reflection. For a c and eta that are floats, double
// lanes make it exact, which nothing less does at the critical angle.
struct GSquaredOp {
  template <class DD>
  static HWY_INLINE void Run(DD dd, Vec<DD>& g2, Vec<DD>& unused, Vec<DD> c, Vec<DD> eta) {
    g2 = unused = hn::MulAdd(c, c, EtaSquaredMinus1(dd, eta));
  }
};

enum class FresnelPart { kUnpolarised, kS, kP, kTransmittance };

template <FresnelPart kPart>
struct FresnelOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& out, Vec<D>& unused, Vec<D> cos_i, Vec<D> eta) {
    out = unused = Of<A>(d, cos_i, eta);
  }

  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> Of(D d, Vec<D> cos_i, Vec<D> eta) {
    const Vec<D> one = Const(d, 1), zero = hn::Zero(d);
    const Vec<D> c = hn::Abs(cos_i), k = EtaSquaredMinus1(d, eta);
    Vec<D> g2, unused;
    InDouble2<GSquaredOp>(d, g2, unused, c, eta);
    g2 = hn::IfThenElse(hn::Lt(g2, zero), zero, g2);
    const Vec<D> p = hn::Mul(c, Sqrt<A>(d, g2));
    const Vec<D> s2 = hn::NegMulAdd(c, c, one);
    Vec<D> a, m;
    FresnelTerms<true>(d, a, m, hn::MulAdd(c, c, g2), p, s2);
    const auto total = hn::Le(g2, zero);
    const Vec<D> total_value = ZeroIf(hn::Eq(k, zero), one);
    if constexpr (kPart == FresnelPart::kS) {
      const Vec<D> r = Div<A>(d, k, a);
      return hn::IfThenElse(total, total_value, hn::Mul(r, r));
    } else if constexpr (kPart == FresnelPart::kP) {
      // (eta^2 + 1) c^2 - 1 carried to a relative rounding, for Brewster's angle.
      Vec<D> e2, e2_tail, cc, cc_tail, q, q_tail, s, s_tail, u, u_tail;
      TwoProduct(d, eta, eta, e2, e2_tail);
      TwoProduct(d, c, c, cc, cc_tail);
      TwoProduct(d, e2, cc, q, q_tail);
      TwoSum(q, hn::Neg(one), s, s_tail);
      TwoSum(s, cc, u, u_tail);
      const Vec<D> tail =
          hn::Add(hn::Add(s_tail, q_tail), hn::MulAdd(e2, cc_tail, hn::MulAdd(e2_tail, cc, cc_tail)));
      const Vec<D> r = Div<A>(d, hn::Mul(k, hn::Add(u, hn::Add(u_tail, tail))), hn::Mul(a, hn::Mul(m, m)));
      return hn::IfThenElse(total, total_value, hn::Mul(r, r));
    } else if constexpr (kPart == FresnelPart::kTransmittance) {
      const Vec<D> m2 = hn::Mul(m, m);
      const Vec<D> t = Div<A>(d, hn::Mul(hn::Add(p, p), hn::MulAdd(eta, eta, m2)), hn::Mul(a, m2));
      return hn::IfThenElse(hn::Eq(k, zero), hn::MulAdd(c, zero, one), t);
    } else {
      const Vec<D> kr = Div<A>(d, k, hn::Mul(a, m)), kp = hn::Mul(kr, p), ks = hn::Mul(kr, s2);
      const Vec<D> f = hn::MulAdd(kp, kp, hn::Mul(ks, ks));
      return hn::IfThenElse(total, total_value, f);
    }
  }
};

// F, or a part of it, of a cosine of either sign (Walter 2007 Eq. 22). kStandard runs in double lanes: its
// formula squares what has taken five roundings.
template <FresnelPart kPart, Accuracy A, class D>
HWY_INLINE Vec<D> FresnelDielectric(D d, Vec<D> cos_i, Vec<D> eta) {
  Vec<D> out, unused;
  // Near Brewster's angle the zero of R_p leaves nothing for kFast to save.
  Precisely<FresnelOp<kPart>, kPart == FresnelPart::kP ? Accuracy::kStandard : A>(d, out, unused, cos_i, eta);
  return out;
}

// Mean of F over diffuse light from the thinner side, r_e of Meneveaux 2015 Eq. 10, of N >= 1: with x = (N -
// 1)/(N + 1), up to 0.6,
//   r_e = x (P(x) + 2 x (1 + x)^2 log x)/(1 + x^2)^3,
// where P has what cancels in Eq. 10 as N goes to 1.
template <Accuracy A, class D>
HWY_INLINE Vec<D> DiffuseFresnelOfRatio(D d, Vec<D> x) {
  const Vec<D> one = Const(d, 1), tiny = Const(d, 1e-37);
  Vec<D> p;
  // Interpolation in Chebyshev's nodes of [0, 0.6], of r_e to 2^-15.9 and 2^-52.5.
  if constexpr (A == Accuracy::kFast) {
    p = Polynomial(d, x,
                   {0.66667404060075997, 3.8321328006941502, 0.49815342335205054, -1.5380073034619355,
                    1.6562614360722334, -1.225296710480934, 3.7272054896350806});
  } else {
    p = Polynomial(d, x, {0.66666666666666674, 3.8333333333332416,   0.46666666668901602, -1.233333335491599,
                          0.28571439580242852, 1.8047584769667639,   0.73975355435908163, 0.67356781019165113,
                          0.32503518155223227, 0.031676966107465135, 0.62664673949490057, -2.5177738324594916,
                          9.5358646256533763,  -27.399204703061855,  61.628682606510111,  -106.55540275609353,
                          139.32115742564275,  -133.23237726206531,  88.149692183447115,  -36.148579855205831,
                          6.9790078249563683});
  }
  const Vec<D> log_x = Log<A>(d, hn::IfThenElse(hn::Lt(x, tiny), tiny, x));
  const Vec<D> above = hn::Add(one, x), u = hn::MulAdd(x, x, one);
  const Vec<D> q = hn::MulAdd(hn::Mul(hn::Add(x, x), hn::Mul(above, above)), log_x, p);
  return RefinedDiv<A>(d, hn::Mul(x, q), hn::Mul(u, hn::Mul(u, u)));
}

// low or high where x is beyond them; NaN passes.
template <class D>
HWY_INLINE Vec<D> Clamped(D d, Vec<D> x, double low, double high) {
  const Vec<D> from = Const(d, low), to = Const(d, high);
  return hn::IfThenElse(hn::Lt(x, from), from, hn::IfThenElse(hn::Gt(x, to), to, x));
}

enum class DiffuseSide { kExternal, kInternal };

// r_e and r_i, by n^2 (1 - r_i) = 1 - r_e; from the denser side r_e is r_i of 1/n.
template <DiffuseSide kSide>
struct DiffuseFresnelOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& out, Vec<D>& unused, Vec<D> eta) {
    const Vec<D> one = Const(d, 1);
    eta = Clamped(d, eta, 0.25, 4);
    const Vec<D> below = hn::Sub(one, eta), above = hn::Add(one, eta);
    const Vec<D> k = hn::Mul(below, above), eta2 = hn::Mul(eta, eta);  // 1 - eta^2
    const Vec<D> thin = DiffuseFresnelOfRatio<A>(d, RefinedDiv<A>(d, hn::Abs(below), above));
    const auto denser = hn::Lt(eta, one);
    if constexpr (kSide == DiffuseSide::kExternal) {
      out = unused = hn::IfThenElse(denser, hn::MulAdd(eta2, thin, k), thin);
    } else {
      out = unused = hn::IfThenElse(denser, thin, RefinedDiv<A>(d, hn::NegMulAdd(below, above, thin), eta2));
    }
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_FRESNEL_INL_H_
