// Phong (Walter 2007 Eqs. 30-32) in lanes, with Walter's recipe for its masking, and with its own.
#if defined(MICROLANE_PHONG_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_PHONG_INL_H_
#undef MICROLANE_PHONG_INL_H_
#else
#define MICROLANE_PHONG_INL_H_
#endif

#include "microlane/beckmann-inl.h"
#include "microlane/student-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct Phong {
  static constexpr size_t kOwn = 0;
  static constexpr bool kHasExponent = true, kMaskingInDouble = true, kDensityOfCosine = true,
                        kLogDensityInDouble = true;

  // pi D = Norm cos^exponent.
  template <class D>
  static HWY_INLINE Vec<D> Norm(D d, Vec<D> exponent) {
    return hn::MulAdd(exponent, Const(d, 0.5), Const(d, 1));
  }

  // exponent log(cos) = -exponent/2 log(1 + tan^2), log1p keeping its accuracy near the normal.
  template <class D>
  static HWY_INLINE Vec<D> LogDensity(D d, Vec<D> hx, Vec<D> hy, Vec<D> hz, Vec<D> exponent) {
    const Vec<D> r2 = hn::MulAdd(hx, hx, hn::Mul(hy, hy));
    const Vec<D> z2 = hn::Max(hn::Mul(hz, hz), Const(d, kIsFloat<D> ? 0x1p-100 : 0x1p-900));
    const Vec<D> log = LogOnePlusRatio(d, r2, z2);
    return hn::Max(hn::Mul(hn::Mul(exponent, Const(d, -0.5)), log), Const(d, -2000));
  }

  // 2/alpha^2 - 2 = 2 (1 - alpha)(1 + alpha)/alpha^2 (Walter 2007, after Eq. 30); 0 for alpha >= 1.
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> Exponent(D d, Vec<D> alpha) {
    const Vec<D> one = Const(d, 1), rest = hn::Sub(one, alpha);
    const Vec<D> q = Div<A>(d, hn::Mul(hn::Add(rest, rest), hn::Add(one, alpha)), hn::Mul(alpha, alpha));
    return ZeroIf(hn::Ge(alpha, one), q);
  }

  // factor pi D(m) of Walter 2007 Eq. 30 with cos(theta_m) = mz as given.
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> TimesPiNormalDensity(D d, Vec<D> factor, Vec<D> mz, Vec<D> exponent) {
    Vec<D> high, low;
    InDouble2<PowerOp>(d, high, low, mz, exponent);
    const Vec<D> norm = hn::Mul(Norm(d, exponent), factor);
    return ZeroIf(hn::Le(mz, hn::Zero(d)), ExpTimes<A>(d, high, low, norm));
  }

  template <Care, Accuracy A, class D>
  static HWY_INLINE Vec<D> Masking(D d, Vec<D> vx, Vec<D> vy, Vec<D> z, Vec<D> exponent) {
    const Vec<D> s = Sqrt<A>(d, hn::MulAdd(vx, vx, hn::Mul(vy, vy)));
    const Vec<D> factor = Sqrt<A>(d, hn::MulAdd(exponent, Const(d, 0.5), Const(d, 1)));
    return Beckmann::RationalMaskingOf<A>(d, z, s, factor);
  }

  // Walter 2007 Eqs. 31, 32: cos = u1^(1/(exponent + 2)); pdf = D cos = (exponent + 2)/(2 pi) u1 / cos.
  template <Care, Accuracy A, class D>
  static HWY_INLINE void SampleNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> u1,
                                      Vec<D> u2, Vec<D> exponent) {
    const Vec<D> one = Const(d, 1), zero = hn::Zero(d);
    u1 = BelowOne(d, u1);
    Vec<D> high, low;
    InDouble2<RootOp>(d, high, low, u1, exponent);
    const Vec<D> cos_m = Exp<A>(d, high, low);
    // sin^2 = -expm1(2 log cos): by its series near the normal.
    const Vec<D> x = hn::Add(hn::Add(high, high), hn::Add(low, low));
    const Vec<D> sin2 = hn::IfThenElse(hn::Gt(x, Const(d, -0.1)), hn::Neg(ExpMinusOneSeries(d, x)),
                                       hn::NegMulAdd(cos_m, cos_m, one));
    Vec<D> sin_phi, cos_phi;
    SinCos2Pi<A>(d, u2, sin_phi, cos_phi);
    const auto none = hn::Le(u1, zero);
    const Vec<D> sin_m = hn::IfThenElse(none, one, Sqrt<A>(d, hn::Max(zero, sin2)));
    mx = hn::Mul(sin_m, cos_phi);
    my = hn::Mul(sin_m, sin_phi);
    mz = ZeroIf(none, cos_m);
    // u1 last, which may be subnormal.
    const Vec<D> norm = hn::MulAdd(exponent, Const(d, 0.5 / kPi), Const(d, 1 / kPi));
    pdf = ZeroIf(none, hn::Mul(Div<A>(d, norm, cos_m), u1));
  }

 private:
  struct PowerOp {
    template <class DD>
    static HWY_INLINE void Run(DD dd, Vec<DD>& high, Vec<DD>& low, Vec<DD> mz, Vec<DD> exponent) {
      const Vec<DD> log = Log<Accuracy::kStandard>(dd, hn::Max(mz, Const(dd, 0x1p-1000)));
      // Beyond e^-2000 and e^2000 all is 0 or overflows; the limits keep what follows in range.
      const Vec<DD> x = hn::Min(hn::Max(hn::Mul(exponent, log), Const(dd, -2000)), Const(dd, 2000));
      SplitHigh(dd, x, high, low);
    }
  };
  struct RootOp {
    template <class DD>
    static HWY_INLINE void Run(DD dd, Vec<DD>& high, Vec<DD>& low, Vec<DD> u1, Vec<DD> exponent) {
      const Vec<DD> log = Log<Accuracy::kStandard>(dd, hn::Max(u1, Const(dd, 0x1p-1000)));
      SplitHigh(dd, hn::Div(log, hn::Add(exponent, Const(dd, 2))), high, low);
    }
  };
};

// Phong with Smith's masking of its own: P22 = (exponent + 2)/(2 pi) (1 + x^2 + y^2)^-(exponent/2 + 2) is
// Student's t of n = (exponent + 1)/2.
template <bool kFloatResult>
struct PhongSmith : Phong, StudentSmith<PhongSmith<kFloatResult>, kFloatResult> {
  using StudentSmith<PhongSmith, kFloatResult>::Masking;

  template <class D>
  static HWY_INLINE Vec<D> Tangent2(D, Vec<D> x, Vec<D> y, Vec<D>) {
    return hn::MulAdd(x, x, hn::Mul(y, y));
  }
  template <class D>
  static HWY_INLINE Vec<D> Order(D d, Vec<D> exponent) {
    return hn::MulAdd(exponent, Const(d, 0.5), Const(d, 0.5));
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_PHONG_INL_H_
