// Student-T, also called GTR (d'Eon 2023; Burley 2012), in lanes: gamma, then any roughness of stretch-inl.h.
#if defined(MICROLANE_STUDENT_T_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_STUDENT_T_INL_H_
#undef MICROLANE_STUDENT_T_INL_H_
#else
#define MICROLANE_STUDENT_T_INL_H_
#endif

#include "microlane/student-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// Slopes of unit roughness have the density (1 + (x^2 + y^2)/k)^-gamma / pi, k = gamma - 1. kFloatResult: for
// what leaves the lanes as floats.
template <bool kFloatResult>
struct StudentT : StudentSmith<StudentT<kFloatResult>, kFloatResult> {
  static constexpr size_t kOwn = 1;
  static constexpr bool kHasExponent = true, kMaskingInDouble = true, kDensityOfCosine = false,
                        kLogDensityInDouble = true;
  template <bool kFloat>
  using ForResult = StudentT<kFloat>;

  using StudentSmith<StudentT, kFloatResult>::Masking;

  // h + h_tail = 1/k. Float lanes round k from 2^24 on, where next to nothing is left of what it divides: of
  // t/k beside 1, t is at most 150 before the density is 0.
  template <class D>
  static HWY_INLINE void Inverse(D d, Vec<D>& h, Vec<D>& h_tail, Vec<D> gamma) {
    const Vec<D> one = Const(d, 1), k = hn::Sub(gamma, one);
    h = hn::Div(one, k);
    Vec<D> product, product_tail;
    TwoProduct(d, h, k, product, product_tail);
    h_tail = hn::Mul(h, hn::Sub(hn::Sub(one, product), product_tail));
  }

  // C^2 + (A^2 + B^2)/k of Stretch, kept off the underflow where exp(LogDensity) is 0 already.
  template <Care kCare, class D, class... P>
  static HWY_INLINE void Density(D d, Vec<D>& e, Vec<D>& e_tail, Vec<D>& w, Vec<D> hx, Vec<D> hy, Vec<D> hz,
                                 Vec<D> hx_tail, Vec<D> hy_tail, Vec<D> hz_tail, Vec<D> gamma, P... p) {
    Vec<D> ux, uy, uz, uz_tail;
    Stretch<kCare>(d, ux, uy, uz, uz_tail, w, p...);
    if constexpr (kCare == Care::kPlain) {
      const Vec<D> a = hn::Mul(hx, ux), b = hn::Mul(hy, uy), c = hn::Mul(hz, uz);
      const Vec<D> s = hn::Div(hn::MulAdd(a, a, hn::Mul(b, b)), hn::Sub(gamma, Const(d, 1)));
      e = hn::MulAdd(c, c, s);
      e_tail = hn::Zero(d);
    } else {
      const Vec<D> zero = hn::Zero(d);
      const auto square = [&](Vec<D> x, Vec<D> x_tail, Vec<D> u, Vec<D> u_tail, Vec<D>& p2, Vec<D>& p2_tail)
                              HWY_ATTR {
                                SquareOfProduct(d, x, u, u_tail, p2, p2_tail);
                                if constexpr (kCare == Care::kCompensated) {
                                  const Vec<D> xu = hn::Mul(x, u);
                                  p2_tail = hn::MulAdd(hn::Add(xu, xu), hn::Mul(x_tail, u), p2_tail);
                                }
                              };
      Vec<D> h, h_tail, a2, b2, c2, a2_tail, b2_tail, c2_tail, s, s_tail, t, t_tail;
      Inverse(d, h, h_tail, gamma);
      square(hx, hx_tail, ux, zero, a2, a2_tail);
      square(hy, hy_tail, uy, zero, b2, b2_tail);
      square(hz, hz_tail, uz, uz_tail, c2, c2_tail);
      TwoSum(a2, b2, s, s_tail);
      s_tail = hn::Add(s_tail, hn::Add(a2_tail, b2_tail));
      TwoProduct(d, s, h, t, t_tail);
      t_tail = hn::MulAdd(s, h_tail, hn::MulAdd(s_tail, h, t_tail));
      TwoSum(c2, t, e, e_tail);
      e_tail = hn::Add(e_tail, hn::Add(c2_tail, t_tail));
    }
    const Vec<D> low = Const(d, kIsFloat<D> ? 0x1p-60 : 0x1p-150);
    e = hn::IfThenElse(hn::Lt(e, low), low, e);
  }

  // (2 - gamma) log(1 + (A^2 + B^2)/(k C^2)).
  template <class D, class... P>
  static HWY_INLINE Vec<D> LogDensity(D d, Vec<D> hx, Vec<D> hy, Vec<D> hz, Vec<D> gamma, P... p) {
    Vec<D> ux, uy, uz, uz_tail, w;
    Stretch<kIsFloat<D> ? Care::kCareful : Care::kPlain>(d, ux, uy, uz, uz_tail, w, p...);
    const Vec<D> c = hn::Mul(hz, uz);
    Vec<D> log = UnitLogDensity(d, hn::Mul(hx, ux), hn::Mul(hy, uy), c, gamma);
    if constexpr (kIsFloat<D>) {
      // Next to the horizon C^2 leaves float's range, where long tails have not ended.
      const auto far = hn::Lt(hn::Abs(c), Const(d, 0x1p-30));
      if (HWY_UNLIKELY(!hn::AllFalse(d, far))) {
        const Vec<D> zero = hn::Zero(d);
        Vec<D> high, low;
        InDouble2<LogDensityOp<StudentT>>(d, high, low, hx, hy, hz, zero, zero, zero, gamma, p...);
        log = hn::IfThenElse(far, hn::Add(high, low), log);
      }
    }
    return log;
  }
  template <class D>
  static HWY_INLINE Vec<D> UnitLogDensity(D d, Vec<D> x, Vec<D> y, Vec<D> z, Vec<D> gamma) {
    const Vec<D> r2 = hn::MulAdd(x, x, hn::Mul(y, y));
    const Vec<D> z2 = hn::Max(hn::Mul(z, z), Const(d, kIsFloat<D> ? 0x1p-60 : 0x1p-400));
    const Vec<D> log = LogOnePlusRatio(d, r2, hn::Mul(z2, hn::Sub(gamma, Const(d, 1))));
    // Nothing is left of the density below.
    return hn::Max(hn::Mul(hn::Sub(Const(d, 2), gamma), log), Const(d, -2000));
  }
  template <class DD>
  static HWY_INLINE Vec<DD> UnitDensity(DD dd, Vec<DD> x, Vec<DD> y, Vec<DD> z, Vec<DD> gamma) {
    const Vec<DD> s = hn::Div(hn::MulAdd(x, x, hn::Mul(y, y)), hn::Sub(gamma, Const(dd, 1)));
    return hn::Max(hn::MulAdd(z, z, s), Const(dd, 0x1p-36));
  }

  template <class D, class... P>
  static HWY_INLINE Vec<D> Tangent2(D d, Vec<D> x, Vec<D> y, Vec<D> gamma, P... p) {
    return hn::Mul(hn::Sub(gamma, Const(d, 1)), ProjectedRoughness2<Care::kPlain>(d, x, y, p...));
  }
  template <class D, class... P>
  static HWY_INLINE Vec<D> Order(D d, Vec<D> gamma, P...) {
    return hn::Sub(gamma, Const(d, 1.5));
  }

  // In double lanes in every accuracy: s spans more than float's range.
  template <Accuracy, class D, class... P>
  static HWY_INLINE Vec<D> Lambda(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, P... p) {
    Vec<D> lambda, unused;
    Precisely<typename StudentSmith<StudentT, kFloatResult>::LambdaOp, Accuracy::kStandard>(d, lambda, unused,
                                                                                            vx, vy, vz, p...);
    return lambda;
  }

  // 1 + tan^2/k = (1 - u1)^(-1/k) at unit roughness, where pi D cos^4 is (1 - u1)^(1 + 1/k).
  template <Care kCare, Accuracy A, class D, class... P>
  static HWY_INLINE void SampleNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> u1,
                                      Vec<D> u2, Vec<D> gamma, P... p) {
    u1 = BelowOne(d, u1);
    Vec<D> t, t_tail, w, w_tail;
    if constexpr (kIsFloat<D> && A != Accuracy::kFast) {
      Vec<D> unused0, unused1;
      InDouble6<SlopeOp>(d, t, t_tail, w, w_tail, unused0, unused1, u1, gamma);
    } else {
      SlopeOf<A>(d, t, w, u1, gamma);
      t_tail = w_tail = hn::Zero(d);
    }
    NormalFromSlopes<true, kCare, A>(d, mx, my, mz, pdf, hn::Sqrt(t), t, t_tail, w, w_tail, u2, p...);
  }

 private:
  // t = tan^2 and w = pi D cos^4. With L = -log(1 - u1) and E = exp(L/k) - 1, t = k E, w = (1 - u1)/(1 + E).
  template <Accuracy A, class D>
  static HWY_INLINE void SlopeOf(D d, Vec<D>& t, Vec<D>& w, Vec<D> u1, Vec<D> gamma) {
    const Vec<D> one = Const(d, 1), k = hn::Sub(gamma, one);
    Vec<D> log, log_tail, s, s_tail;
    NegLog1m<A>(d, u1, log, log_tail);
    if constexpr (A == Accuracy::kFast) {
      s = hn::Div(log, k);
      s_tail = hn::Zero(d);
    } else {
      Vec<D> h, h_tail;
      Inverse(d, h, h_tail, gamma);
      TwoProduct(d, log, h, s, s_tail);
      s_tail = hn::MulAdd(log_tail, h, hn::MulAdd(log, h_tail, s_tail));
    }
    const Vec<D> more = hn::IfThenElse(hn::Lt(s, Const(d, 0.1)), hn::Add(ExpMinusOneSeries(d, s), s_tail),
                                       hn::Sub(Exp<A>(d, s, s_tail), one));
    t = hn::Mul(k, more);
    w = hn::Div(hn::Sub(one, u1), hn::Add(one, more));
  }
  struct SlopeOp {
    template <class DD>
    static HWY_INLINE void Run(DD dd, Vec<DD>& t, Vec<DD>& t_tail, Vec<DD>& w, Vec<DD>& w_tail,
                               Vec<DD>& unused0, Vec<DD>& unused1, Vec<DD> u1, Vec<DD> gamma) {
      Vec<DD> t_all, w_all;
      SlopeOf<Accuracy::kStandard>(dd, t_all, w_all, u1, gamma);
      SplitHigh(dd, t_all, t, t_tail);
      SplitHigh(dd, w_all, w, w_tail);
      unused0 = unused1 = t;
    }
  };
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_STUDENT_T_INL_H_
