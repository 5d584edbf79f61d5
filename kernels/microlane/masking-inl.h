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

// B(1 + Lambda_i, 1 + Lambda_o), B Euler's Beta function, in double lanes. With l and g the lesser and the
// greater Lambda, p = l + 7, q = g + 7, r = p + q, it is R B(p, q), where R, of six steps of Gamma's
// recurrence each, is the first below, and Stirling's series gives the second: every logarithm is of a ratio,
// so that huge ones cancel nowhere.
//   prod_k (l + g + 2 k)/(g + k) * prod_k (l + g + 2 k + 1)/(l + k),  k = 1 ... 6
//   log B(p, q) = -(p - 1/2) log(r/p) - q log(1 + p/q) - log(q/(2 pi))/2 + S(p) + S(q) - S(r)
struct TransmissionMaskingOp {
  // S(x) = log Gamma(x) - (x - 1/2) log x + x - log(2 pi)/2 for x >= 7, within 2^-53.
  template <class DD>
  static HWY_INLINE Vec<DD> Stirling(DD d, Vec<DD> x) {
    const Vec<DD> y = hn::Div(Const(d, 1), x);
    return hn::Mul(y, Polynomial(d, hn::Mul(y, y),
                                 {1.0 / 12, -1.0 / 360, 1.0 / 1260, -1.0 / 1680, 1.0 / 1188, -691.0 / 360360,
                                  1.0 / 156, -3617.0 / 122400, 43867.0 / 244188}));
  }

  template <Accuracy A, class DD>
  static HWY_INLINE void Run(DD d, Vec<DD>& g2, Vec<DD>& unused, Vec<DD> lambda_i, Vec<DD> lambda_o) {
    static_assert(!kIsFloat<DD>, "products of six Lambdas");
    constexpr int kSteps = 6;
    const Vec<DD> one = Const(d, 1), shift = Const(d, kSteps + 1);
    // Total: Lambdas outside [0, 2^129) count as its ends; NaN passes.
    const Vec<DD> high = Const(d, 0x1p129);
    lambda_i = ZeroIf(hn::Lt(lambda_i, hn::Zero(d)), hn::IfThenElse(hn::Gt(lambda_i, high), high, lambda_i));
    lambda_o = ZeroIf(hn::Lt(lambda_o, hn::Zero(d)), hn::IfThenElse(hn::Gt(lambda_o, high), high, lambda_o));
    const Vec<DD> l = hn::Min(lambda_i, lambda_o), g = hn::Max(lambda_i, lambda_o), sum = hn::Add(l, g);
    Vec<DD> even = one, odd = one, of_g = one, of_l = one;
    for (int k = 1; k <= kSteps; ++k) {
      even = hn::Mul(even, hn::Add(sum, Const(d, 2 * k)));
      odd = hn::Mul(odd, hn::Add(sum, Const(d, 2 * k + 1)));
      of_g = hn::Mul(of_g, hn::Add(g, Const(d, k)));
      of_l = hn::Mul(of_l, hn::Add(l, Const(d, k)));
    }
    const Vec<DD> recurrence = hn::Mul(hn::Div(even, of_g), hn::Div(odd, of_l));
    const Vec<DD> p = hn::Add(l, shift), q = hn::Add(g, shift), r = hn::Add(p, q);
    // log(1 + x) of x = p/q: that of the rounded sum, and what it lacks.
    const Vec<DD> x = hn::Div(p, q), x1 = hn::Add(x, one);
    const Vec<DD> log_x1 = hn::Add(Log<A>(d, x1), hn::Div(hn::Sub(x, hn::Sub(x1, one)), x1));
    const Vec<DD> of_p = hn::Mul(hn::Sub(p, Const(d, 0.5)), Log<A>(d, hn::Div(r, p)));
    const Vec<DD> of_q =
        hn::MulAdd(q, log_x1, hn::Mul(Const(d, 0.5), Log<A>(d, hn::Mul(q, Const(d, 0.5 / kPi)))));
    const Vec<DD> rest = hn::Sub(hn::Add(Stirling(d, p), Stirling(d, q)), Stirling(d, r));
    g2 = unused = ExpTimes<A>(d, hn::Neg(hn::Add(of_p, of_q)), rest, recurrence);
  }
};

// G2 of heights that transmission correlates: 1 where both Lambdas are 0.
template <class D>
HWY_INLINE Vec<D> TransmissionG2(D d, Vec<D> lambda_i, Vec<D> lambda_o) {
  Vec<D> g2, unused;
  InDouble2<InStandard<TransmissionMaskingOp>>(d, g2, unused, lambda_i, lambda_o);
  return g2;
}

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
