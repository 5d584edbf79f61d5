// Masking functions that Heitz 2014 reviews beside Smith's (section 4), and the joint forms of masking and
// shadowing (section 6), in lanes.
#if defined(MICROLANE_MASKING_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_MASKING_INL_H_
#undef MICROLANE_MASKING_INL_H_
#else
#define MICROLANE_MASKING_INL_H_
#endif

#include "microlane/distribution-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// 2^40 v.m as seen from v's side of the surface; 0 where v is along it.
template <class D>
HWY_INLINE Vec<D> FacingDot(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> mx, Vec<D> my, Vec<D> mz) {
  Vec<D> dot, unused;
  InDouble2<InStandard<CarefulDotOp>>(d, dot, unused, vx, vy, vz, mx, my, mz);
  return ZeroIf(hn::Eq(vz, hn::Zero(d)), FlipSign(d, dot, vz));
}

// min(1, 2 mz |vz| / |v.m|) (Heitz 2014 Eq. 49).
struct VCavityOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& g1, Vec<D>& unused, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> mx,
                             Vec<D> my, Vec<D> mz) {
    const Vec<D> facing = FacingDot(d, vx, vy, vz, mx, my, mz), zero = hn::Zero(d);
    const Vec<D> low = Const(d, kIsFloat<D> ? 1e-30 : 1e-280);
    const Vec<D> area = hn::Mul(hn::Mul(mz, Const(d, 0x1p20)), hn::Mul(hn::Abs(vz), Const(d, 0x1p21)));
    const Vec<D> ratio = Div<A>(d, area, hn::Max(facing, low));
    g1 = unused = ZeroIf(hn::Or(hn::Le(facing, zero), hn::Le(mz, zero)), hn::Min(ratio, Const(d, 1)));
  }
};

template <Accuracy A, class D>
HWY_INLINE Vec<D> VCavityG1(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> mx, Vec<D> my, Vec<D> mz) {
  Vec<D> g1, unused;
  Precisely<VCavityOp, A>(d, g1, unused, vx, vy, vz, mx, my, mz);
  return g1;
}

// |vz| (Heitz 2014 Eq. 56).
template <class D>
HWY_INLINE Vec<D> ImplicitG1(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> mx, Vec<D> my, Vec<D> mz) {
  return ZeroIf(hn::Le(FacingDot(d, vx, vy, vz, mx, my, mz), hn::Zero(d)), hn::Abs(vz));
}

// c/(c (1 - k) + k) = c/(c + k (1 - c)), c = |vz|, k = alpha sqrt(2/pi) (Heitz 2014 section 4.3): a sum of
// positive terms.
template <Accuracy A, class D>
HWY_INLINE Vec<D> SchlickSmithG1(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> mx, Vec<D> my, Vec<D> mz,
                                 Vec<D> alpha) {
  const Vec<D> c = hn::Abs(vz), k = hn::Mul(alpha, Const(d, 0.79788456080286535588));
  const Vec<D> g1 = Div<A>(d, c, hn::MulAdd(k, hn::Sub(Const(d, 1), c), c));
  return ZeroIf(hn::Le(FacingDot(d, vx, vy, vz, mx, my, mz), hn::Zero(d)), g1);
}

// |vz| / |v.m| (Heitz 2014 Eq. 59).
struct KelemenOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& g1, Vec<D>& unused, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> mx,
                             Vec<D> my, Vec<D> mz) {
    const Vec<D> facing = FacingDot(d, vx, vy, vz, mx, my, mz);
    const Vec<D> low = Const(d, kIsFloat<D> ? 1e-30 : 1e-280);
    const Vec<D> ratio = Div<A>(d, hn::Mul(hn::Abs(vz), Const(d, 0x1p40)), hn::Max(facing, low));
    g1 = unused = ZeroIf(hn::Le(facing, hn::Zero(d)), ratio);
  }
};

template <Accuracy A, class D>
HWY_INLINE Vec<D> KelemenG1(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> mx, Vec<D> my, Vec<D> mz) {
  Vec<D> g1, unused;
  Precisely<KelemenOp, A>(d, g1, unused, vx, vy, vz, mx, my, mz);
  return g1;
}

enum class JointForm { kSeparable, kHeight, kDirection, kHeightDirection };

// Scale of the joint forms' denominators, with which sums and products of the largest Lambda, and approximate
// reciprocals of them, stay within range.
constexpr double kJointScale = 0x1p-8;

// s (1 + Lambda), s the scale.
template <class D>
HWY_INLINE Vec<D> ScaledArea(D d, Vec<D> lambda) {
  return hn::MulAdd(lambda, Const(d, kJointScale), Const(d, kJointScale));
}

// G2 from both Lambdas: 1/((1 + Lambda_i)(1 + Lambda_o)) (Heitz 2014 Eq. 98), 1/(1 + Lambda_i + Lambda_o)
// (Eq. 99).
template <JointForm kForm, Accuracy A, class D>
HWY_INLINE Vec<D> JointG2(D d, Vec<D> lambda_i, Vec<D> lambda_o) {
  const Vec<D> s = Const(d, kJointScale), area_i = ScaledArea(d, lambda_i);
  if constexpr (kForm == JointForm::kSeparable) {
    // In two quotients, as G2 may be subnormal where the product of the areas overflows.
    return hn::Mul(Div<A>(d, s, area_i), Div<A>(d, s, ScaledArea(d, lambda_o)));
  } else {
    return Div<A>(d, s, hn::MulAdd(lambda_o, s, area_i));
  }
}

// With lambda = t/(1 + t), t = 4.41 phi, and the lesser and the greater of both Lambdas, sums of positive
// terms:
//   Eq. 100: (1 + t/(1 + lesser)) / ((1 + t)(1 + greater)),
//   Eq. 101: (1 + t) / ((1 + t)(1 + greater) + t lesser).
template <JointForm kForm>
struct DirectionalMaskingOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& g2, Vec<D>& unused, Vec<D> lambda_i, Vec<D> lambda_o, Vec<D> phi) {
    const Vec<D> s = Const(d, kJointScale), one = Const(d, 1);
    const Vec<D> t = hn::Mul(phi, Const(d, 4.41)), t1 = hn::Add(t, one);
    const Vec<D> lesser = hn::Min(lambda_i, lambda_o), greater = hn::Max(lambda_i, lambda_o);
    const Vec<D> area = hn::Mul(t1, ScaledArea(d, greater));
    if constexpr (kForm == JointForm::kDirection) {
      const Vec<D> shadowing = hn::Add(one, Div<A>(d, hn::Mul(t, s), ScaledArea(d, lesser)));
      g2 = unused = Div<A>(d, hn::Mul(s, shadowing), area);
    } else {
      g2 = unused = Div<A>(d, hn::Mul(s, t1), hn::MulAdd(hn::Mul(t, s), lesser, area));
    }
  }
};

// G2 of the forms that take the azimuths. Eq. 100 takes more roundings than kStandard has room for.
template <JointForm kForm, Accuracy A, class D>
HWY_INLINE Vec<D> JointG2(D d, Vec<D> lambda_i, Vec<D> lambda_o, Vec<D> wix, Vec<D> wiy, Vec<D> wox,
                          Vec<D> woy) {
  using Op = DirectionalMaskingOp<kForm>;
  const Vec<D> phi = AzimuthDifference<A>(d, wix, wiy, wox, woy);
  Vec<D> g2, unused;
  if constexpr (kForm == JointForm::kDirection) {
    Precisely<Op, A>(d, g2, unused, lambda_i, lambda_o, phi);
  } else {
    Op::template Run<A>(d, g2, unused, lambda_i, lambda_o, phi);
  }
  return g2;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_MASKING_INL_H_
