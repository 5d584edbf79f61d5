// Half vectors, their Jacobians, reflection and refraction (Walter 2007 Eqs. 13, 14, 16, 17, 39, 40) in
// lanes.
#if defined(MICROLANE_HALF_VECTOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_HALF_VECTOR_INL_H_
#undef MICROLANE_HALF_VECTOR_INL_H_
#else
#define MICROLANE_HALF_VECTOR_INL_H_
#endif

#include "microlane/fresnel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// H = e o + i, normalised into h (0 for the zero vector).
template <Accuracy A, class D>
HWY_INLINE void NormalizedSum(D d, Vec<D>& hx, Vec<D>& hy, Vec<D>& hz, Vec<D> ix, Vec<D> iy, Vec<D> iz,
                              Vec<D> ox, Vec<D> oy, Vec<D> oz, Vec<D> e) {
  // A power of two keeps the bits of subnormal components.
  const Vec<D> up = Const(d, 0x1p64);
  hx = FusedMulAdd(d, e, hn::Mul(ox, up), hn::Mul(ix, up));
  hy = FusedMulAdd(d, e, hn::Mul(oy, up), hn::Mul(iy, up));
  hz = FusedMulAdd(d, e, hn::Mul(oz, up), hn::Mul(iz, up));
  const Vec<D> scale = PowerOfTwoScale(d, hx, hy, hz);
  hx = hn::Mul(hx, scale);
  hy = hn::Mul(hy, scale);
  hz = hn::Mul(hz, scale);
  const Vec<D> length2 = Dot(hx, hy, hz, hx, hy, hz);
  const Vec<D> length = Sqrt<A>(d, length2), inverse = Reciprocal<A>(d, length);
  const auto none = hn::Eq(length2, hn::Zero(d));
  hx = ZeroIf(none, DivByReciprocal<A>(d, hx, length, inverse));
  hy = ZeroIf(none, DivByReciprocal<A>(d, hy, length, inverse));
  hz = ZeroIf(none, DivByReciprocal<A>(d, hz, length, inverse));
}

// h_r of Walter 2007 Eq. 13.
template <Accuracy A, class D>
HWY_INLINE void HalfVectorReflection(D d, Vec<D>& hx, Vec<D>& hy, Vec<D>& hz, Vec<D> ix, Vec<D> iy, Vec<D> iz,
                                     Vec<D> ox, Vec<D> oy, Vec<D> oz) {
  NormalizedSum<A>(d, hx, hy, hz, ix, iy, iz, ox, oy, oz, Const(d, 1));
  // sign(0) = 1: -0 counts as 0.
  const Vec<D> sign = hn::IfThenElse(hn::Lt(iz, hn::Zero(d)), Const(d, -1), Const(d, 1));
  hx = hn::Mul(hx, sign);
  hy = hn::Mul(hy, sign);
  hz = hn::Mul(hz, sign);
}

// h_t of Walter 2007 Eq. 16 with the relative index (Marschner 2012).
template <Accuracy A, class D>
HWY_INLINE void HalfVectorRefraction(D d, Vec<D>& hx, Vec<D>& hy, Vec<D>& hz, Vec<D> ix, Vec<D> iy, Vec<D> iz,
                                     Vec<D> ox, Vec<D> oy, Vec<D> oz, Vec<D> eta) {
  NormalizedSum<A>(d, hx, hy, hz, ix, iy, iz, ox, oy, oz, eta);
  hx = hn::Neg(hx);
  hy = hn::Neg(hy);
  hz = hn::Neg(hz);
}

// 1/(4 |o.h|), the second form of Walter 2007 Eq. 14.
template <class D>
HWY_INLINE Vec<D> ReflectionJacobian(D d, Vec<D> cos_o) {
  return hn::Div(Const(d, 0.25), hn::Abs(cos_o));
}

// eta^2 |o.h| / (i.h + eta o.h)^2, the second form of Walter 2007 Eq. 17; the sum cancels for indices near 1.
struct RefractionJacobianOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& j, Vec<D>& unused, Vec<D> cos_i, Vec<D> cos_o, Vec<D> eta) {
    const Vec<D> o = hn::Abs(cos_o), q = hn::Div(eta, FusedMulAdd(d, eta, cos_o, cos_i));
    j = unused = ZeroIf(hn::Eq(o, hn::Zero(d)), hn::Mul(hn::Mul(q, o), q));
  }
};

template <Accuracy A, class D>
HWY_INLINE Vec<D> RefractionJacobian(D d, Vec<D> cos_i, Vec<D> cos_o, Vec<D> eta) {
  Vec<D> j, unused;
  Precisely<RefractionJacobianOp, A>(d, j, unused, cos_i, cos_o, eta);
  return j;
}

// e^2 |o.h| / |H|^2 with H = i + e o, h = H/|H|: Walter 2007 Eq. 17 with the relative index e, and Eq. 14 at
// e = 1. In double lanes: o.H cancels near grazing, and tiny H take the range.
struct HalfVectorJacobianOp {
  template <class D>
  static HWY_INLINE void Run(D d, Vec<D>& j, Vec<D>& unused, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox,
                             Vec<D> oy, Vec<D> oz, Vec<D> e) {
    Vec<D> hx = hn::MulAdd(e, ox, ix), hy = hn::MulAdd(e, oy, iy), hz = hn::MulAdd(e, oz, iz);
    const Vec<D> scale = PowerOfTwoScale(d, hx, hy, hz);
    hx = hn::Mul(hx, scale);
    hy = hn::Mul(hy, scale);
    hz = hn::Mul(hz, scale);
    const Vec<D> h2 = Dot(hx, hy, hz, hx, hy, hz), es = hn::Mul(e, scale);
    const Vec<D> q = hn::Div(hn::Abs(Dot(ox, oy, oz, hx, hy, hz)), hn::Mul(h2, hn::Sqrt(h2)));
    j = unused = ZeroIf(hn::Eq(h2, hn::Zero(d)), hn::Mul(hn::Mul(q, es), es));
  }
};

template <Accuracy, class D>
HWY_INLINE Vec<D> HalfVectorJacobian(D d, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz,
                                     Vec<D> e) {
  Vec<D> j, unused;
  InDouble2<HalfVectorJacobianOp>(d, j, unused, ix, iy, iz, ox, oy, oz, e);
  return j;
}

// 2 (i.m) m - i (Walter 2007 Eq. 39, mended).
template <class D>
HWY_INLINE void Reflect(D, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> mx,
                        Vec<D> my, Vec<D> mz) {
  const Vec<D> c = Dot(ix, iy, iz, mx, my, mz), c2 = hn::Add(c, c);
  ox = hn::MulSub(c2, mx, ix);
  oy = hn::MulSub(c2, my, iy);
  oz = hn::MulSub(c2, mz, iz);
}

// Walter 2007 Eq. 40 with eta relative: ((c - sign(i.n) g) m - i) / eta, g = sqrt(eta^2 - 1 + c^2); 0 under
// total internal reflection. c is taken in double lanes: near the critical angle its rounding error is all
// there is to g.
struct RefractOp {
  template <class DD>
  static HWY_INLINE void Run(DD dd, Vec<DD>& c, Vec<DD>& g2, Vec<DD> ix, Vec<DD> iy, Vec<DD> iz, Vec<DD> mx,
                             Vec<DD> my, Vec<DD> mz, Vec<DD> eta) {
    c = Dot(ix, iy, iz, mx, my, mz);
    g2 = hn::MulAdd(c, c, EtaSquaredMinus1(dd, eta));
  }
};

template <Accuracy A, class D>
HWY_INLINE void Refract(D d, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> mx,
                        Vec<D> my, Vec<D> mz, Vec<D> eta) {
  Vec<D> c, g2;
  InDouble2<RefractOp>(d, c, g2, ix, iy, iz, mx, my, mz, eta);
  const Vec<D> zero = hn::Zero(d);
  const auto total = hn::Lt(g2, zero);
  const Vec<D> g = Sqrt<A>(d, hn::IfThenElse(total, zero, g2));
  // sign(0) = 1: -0 counts as 0. A small eta magnifies what c - sign g loses to rounding.
  Vec<D> cg, cg_tail;
  TwoSum(c, hn::IfThenElse(hn::Lt(iz, zero), g, hn::Neg(g)), cg, cg_tail);
  Vec<D> x = hn::MulSub(cg, mx, ix), y = hn::MulSub(cg, my, iy), z = hn::MulSub(cg, mz, iz);
  if constexpr (A != Accuracy::kFast) {
    x = hn::MulAdd(cg_tail, mx, x);
    y = hn::MulAdd(cg_tail, my, y);
    z = hn::MulAdd(cg_tail, mz, z);
  }
  const Vec<D> r = Reciprocal<A>(d, eta);
  ox = ZeroIf(total, DivByReciprocal<A>(d, x, eta, r));
  oy = ZeroIf(total, DivByReciprocal<A>(d, y, eta, r));
  oz = ZeroIf(total, DivByReciprocal<A>(d, z, eta, r));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_HALF_VECTOR_INL_H_
