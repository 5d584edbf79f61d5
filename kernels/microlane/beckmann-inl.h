// Beckmann (Walter 2007 Eqs. 25-29; Heitz 2014 Eqs. 67-69, 81-83) in lanes, isotropic (one alpha) or
// anisotropic (two).
#if defined(MICROLANE_BECKMANN_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_BECKMANN_INL_H_
#undef MICROLANE_BECKMANN_INL_H_
#else
#define MICROLANE_BECKMANN_INL_H_
#endif

#include <limits>

#include "microlane/distribution-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct Beckmann {
  static constexpr bool kHasExponent = true, kMaskingInDouble = true, kDensityOfCosine = false;

  // C^2 of Stretch, kCareful with its rounding error, kept off the underflow where exp(LogDensity) is 0
  // already. CarefulLogDensity sees to H_tail.
  template <Care kCare, class D, class... P>
  static HWY_INLINE void Density(D d, Vec<D>& e, Vec<D>& e_tail, Vec<D>& w, Vec<D>, Vec<D>, Vec<D> hz, Vec<D>,
                                 Vec<D>, Vec<D>, P... p) {
    Vec<D> ux, uy, uz, uz_tail;
    Stretch<kCare>(d, ux, uy, uz, uz_tail, w, p...);
    if constexpr (kCare != Care::kCareful) {
      const Vec<D> c = hn::Mul(hz, uz);
      e = hn::Mul(c, c);
      e_tail = hn::Zero(d);
    } else {
      SquareOfProduct(d, hz, uz, uz_tail, e, e_tail);
    }
    if constexpr (kCare == Care::kCareful || !kIsFloat<D>) {
      const Vec<D> low = Const(d, kIsFloat<D> ? 0x1p-60 : 0x1p-150);
      e = hn::IfThenElse(hn::Lt(e, low), low, e);
    }
  }

  // LogDensity of H + H_tail, less twice the log of what e = C^2 has lost to rounding. r is 1/e to a few
  // roundings: the remainder of the quotient puts right what it lacks.
  template <Care kCare, class D, class... P>
  static HWY_INLINE void CarefulLogDensity(D d, Vec<D>& high, Vec<D>& low, Vec<D> r, Vec<D> e, Vec<D> hx,
                                           Vec<D> hy, Vec<D> hz, Vec<D> hx_tail, Vec<D> hy_tail,
                                           Vec<D> hz_tail, P... p) {
    Vec<D> ux, uy, uz, uz_tail, w, a, a_tail, b, b_tail, c, c_tail, a2, a2_tail, b2, b2_tail, n, n_tail;
    Stretch<kCare>(d, ux, uy, uz, uz_tail, w, p...);
    TwoProduct(d, hx, ux, a, a_tail);
    TwoProduct(d, hy, uy, b, b_tail);
    TwoProduct(d, hz, uz, c, c_tail);
    a_tail = hn::MulAdd(hx_tail, ux, a_tail);
    b_tail = hn::MulAdd(hy_tail, uy, b_tail);
    c_tail = hn::MulAdd(hz_tail, uz, hn::MulAdd(hz, uz_tail, c_tail));
    TwoProduct(d, a, a, a2, a2_tail);
    TwoProduct(d, b, b, b2, b2_tail);
    FastTwoSum(hn::Max(a2, b2), hn::Min(a2, b2), n, n_tail);
    n_tail = hn::Add(n_tail, hn::MulAdd(Const(d, 2), hn::MulAdd(a, a_tail, hn::Mul(b, b_tail)),
                                        hn::Add(a2_tail, b2_tail)));
    const Vec<D> e_tail = hn::MulAdd(hn::Add(c, c), c_tail, hn::MulSub(c, c, e));
    const Vec<D> x = hn::Mul(n, r);
    const Vec<D> rest = hn::Add(hn::NegMulAdd(x, e, n), hn::NegMulAdd(x, e_tail, n_tail));
    high = hn::Neg(x);
    low = hn::Mul(hn::Neg(hn::MulAdd(Const(d, 2), e_tail, rest)), r);
  }

  // -(A^2 + B^2)/C^2 = -tan^2 (cos^2/alpha_x^2 + sin^2/alpha_y^2), Heitz 2014 Eq. 82.
  template <class D, class... P>
  static HWY_INLINE Vec<D> LogDensity(D d, Vec<D> hx, Vec<D> hy, Vec<D> hz, P... p) {
    Vec<D> ux, uy, uz, uz_tail, w;
    Stretch<kIsFloat<D> ? Care::kCareful : Care::kPlain>(d, ux, uy, uz, uz_tail, w, p...);
    const Vec<D> a = hn::Mul(hx, ux), b = hn::Mul(hy, uy), c = hn::Mul(hz, uz);
    const Vec<D> c2 = hn::Max(hn::Mul(c, c), Const(d, kIsFloat<D> ? 0x1p-60 : 0x1p-400));
    return hn::Neg(hn::Div(hn::MulAdd(a, a, hn::Mul(b, b)), c2));
  }

  // Lambda = factor exp(-a^2) / vz with a = vz/s (Heitz 2014 Eq. 69): factor = (1 - sqrt(pi) a erfcx(a)) s /
  // (2 sqrt(pi)), every part positive. a^2 stops at `largest_a2`.
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void LambdaFactors(D d, double largest_a2, Vec<D>& factor, Vec<D>& a2, Vec<D> vx,
                                       Vec<D> vy, Vec<D> z, P... p) {
    const Vec<D> z2 = hn::Mul(z, z), roughness2 = ProjectedRoughness2<Care::kPlain>(d, vx, vy, p...);
    const Vec<D> least =
        hn::Max(hn::Mul(z2, Const(d, 1 / largest_a2)), Const(d, kIsFloat<D> ? 0x1p-80 : 0x1p-600));
    const Vec<D> s2 = hn::Max(least, roughness2);
    const Vec<D> s = hn::Sqrt(s2);
    const Vec<D> y = hn::MulAdd(z, Const(d, 0.3), s);
    // IEEE divisions in every accuracy: near t = 1 the result takes six times the error of t.
    const Vec<D> rs2 = hn::Div(Const(d, 1), s2), t = hn::Div(s, y);
    a2 = hn::Mul(z2, rs2);
    factor = hn::Mul(hn::Mul(hn::Mul(ErfcxDefectOverT2<A>(d, t), t), t),
                     hn::Mul(s, Const(d, 0.28209479177387814)));
  }

  // |vz| (1 + 2 Lambda) = s E with E = exp(-a^2)/sqrt(pi) + a erf(a). E is even in a, E^2 - a^2 falls from
  // 1/pi to 0, and so (s E)^2 = z^2 + s^2 (E^2 - a^2) needs neither a nor an exponential.
  template <Care kCare, Accuracy A, class D, class... P>
  static HWY_INLINE Vec<D> Masking(D d, Vec<D> vx, Vec<D> vy, Vec<D> z, P... p) {
    if constexpr (kIsFloat<D>) {
      const Vec<D> z2 = hn::Mul(z, z), s2 = ProjectedRoughness2<kCare>(d, vx, vy, p...);
      const Vec<D> square = hn::MulAdd(s2, SquareDefect<A>(d, s2, z2), z2);
      return kCare == Care::kCareful ? Sqrt<A>(d, square) : SqrtOfPositive<A>(d, square);
    } else {
      Vec<D> factor, a2;
      // Beyond, Lambda is lost beside 1.
      LambdaFactors<A>(d, 64, factor, a2, vx, vy, z, p...);
      return hn::Add(z, ExpTimes<A>(d, hn::Neg(a2), hn::Zero(d), hn::Add(factor, factor)));
    }
  }

  // E^2 - a^2 of a^2 = z2/s2, as a polynomial in 1 - t, t = 1/(1 + c a^2), up to a^2 = 24. Float lanes. 1 - t
  // keeps the bits of a small a, which t would round away.
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> SquareDefect(D d, Vec<D> s2, Vec<D> z2) {
    constexpr bool kFast = A == Accuracy::kFast;
    constexpr double c = kFast ? 0.13 : 0.14;
    const Vec<D> cz2 = hn::Mul(Const(d, c), z2), sum = hn::Max(hn::Add(cz2, s2), Const(d, 1e-37));
    const Vec<D> rest = hn::Min(Div<A>(d, cz2, sum), Const(d, 24 * c / (1 + 24 * c)));
    // sollya, x = t - m: y = (1/(x+m)-1)/c; e = exp(-y)/sqrt(pi)+sqrt(y)*erf(sqrt(y)); f = e^2-y; w = 1/e^2;
    // remez(f*w, n, [1/(1+24*c)-m;1-m-1b-20], w), rounded: error of f*w, half of which reaches E.
    if constexpr (kFast) {
      // m = 0, n = 5: 2^-14.5
      return Polynomial(
          d, hn::Sub(Const(d, 1), rest),
          {-3.9722032845020294189453125e-2, 0.60660398006439208984375, -3.3561027050018310546875,
           8.67492580413818359375, -10.71608638763427734375, 5.14870357513427734375});
    } else {
      // m = 0.625, n = 10, its two lowest coefficients rounded before the others are fitted: 2^-25.2
      return Polynomial(d, hn::Sub(Const(d, 0.375), rest),
                        {2.88253626786172389984130859375e-3, 5.63121326267719268798828125e-2,
                         0.464344024658203125, 2.04346370697021484375, 4.852694034576416015625,
                         4.795073032379150390625, -2.324512481689453125, -5.757721424102783203125,
                         4.779048442840576171875, 4.924413204193115234375, -7.1712055206298828125});
    }
  }

  struct LambdaOp {
    template <Accuracy A, class D, class... P>
    static HWY_INLINE void Run(D d, Vec<D>& lambda, Vec<D>& unused, Vec<D> vx, Vec<D> vy, Vec<D> vz, P... p) {
      Vec<D> factor, a2;
      const Vec<D> z = hn::Abs(MesosurfaceCosine(d, vx, vy, vz, p...));
      LambdaFactors<A>(d, kIsFloat<D> ? 400 : 2000, factor, a2, vx, vy, z, p...);  // exp is 0 beyond
      const Vec<D> largest = hn::Set(d, std::numeric_limits<T<D>>::max());
      const Vec<D> over_z = hn::Min(hn::Div(factor, z), largest);
      const Vec<D> q = ExpTimes<A>(d, hn::Neg(a2), hn::Zero(d), over_z);
      lambda = unused = ZeroIf(hn::Eq(hn::Add(hn::Abs(vx), hn::Abs(vy)), hn::Zero(d)), q);
    }
  };

  // In double lanes but for kFast: t near 1 has lost bits of a small a.
  template <Accuracy A, class D, class... P>
  static HWY_INLINE Vec<D> Lambda(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, P... p) {
    Vec<D> lambda, unused;
    Precisely<LambdaOp, A>(d, lambda, unused, vx, vy, vz, p...);
    return lambda;
  }

  // Walter 2007 Eq. 27 with G1 clamped at 1: (3.535 a + 2.181 a^2)/(1 + 2.276 a + 2.577 a^2) below a = 1.6.
  template <Accuracy A, class D, class... P>
  static HWY_INLINE Vec<D> RationalMasking(D d, Vec<D> vx, Vec<D> vy, Vec<D> z, P... p) {
    const Vec<D> s = Sqrt<A>(d, ProjectedRoughness2<Care::kCareful>(d, vx, vy, p...));
    return RationalMaskingOf<A>(d, z, s, Const(d, 1));
  }

  // |vz| (1 + 2 Lambda) for a = factor z / s, with Lambda = max(0, (1 - 1.259 a + 0.396 a^2)/(3.535 a + 2.181
  // a^2)).
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> RationalMaskingOf(D d, Vec<D> z, Vec<D> s, Vec<D> factor) {
    const Vec<D> f = hn::Mul(factor, z);
    const Vec<D> numerator =
        hn::MulAdd(s, s, hn::Mul(f, hn::MulAdd(Const(d, 0.396), f, hn::Mul(Const(d, -1.259), s))));
    const Vec<D> denominator = hn::Mul(factor, hn::MulAdd(Const(d, 2.181), f, hn::Mul(Const(d, 3.535), s)));
    const Vec<D> zero = hn::Zero(d);
    const auto one = hn::Or(hn::Ge(f, hn::Mul(Const(d, 1.6), s)), hn::Le(numerator, zero));
    const Vec<D> twice = hn::Add(numerator, numerator);
    const Vec<D> quotient = A == Accuracy::kFast ? hn::Mul(twice, RefinedReciprocal<A>(d, denominator))
                                                 : hn::Div(twice, denominator);
    return hn::Add(z, ZeroIf(one, quotient));
  }

  // Walter 2007 Eqs. 28, 29: tan^2 = -log(1 - u1).
  template <Care kCare, Accuracy A, class D, class... P>
  static HWY_INLINE void SampleNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> u1,
                                      Vec<D> u2, P... p) {
    u1 = BelowOne(d, u1);
    Vec<D> w, w_tail, t, t_tail;
    OneMinus(d, u1, w, w_tail);
    NegLog1m<A>(d, u1, t, t_tail);
    NormalFromSlopes<true, kCare, A>(d, mx, my, mz, pdf, hn::Sqrt(t), t, t_tail, w, w_tail, u2, p...);
  }

  // The same with both alphas times f = 1.2 - 0.2 sqrt(|i.n|), Walter 2007 section 5.3: f^2 goes to the
  // squared slope and to the density's alphas.
  template <Care kCare, Accuracy A, class D, class... P>
  static HWY_INLINE void SampleNormalWidened(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> u1,
                                             Vec<D> u2, Vec<D> cos_i, P... p) {
    constexpr double kHigh = kIsFloat<D> ? 1.2f : 1.2, kHighRoot = kIsFloat<D> ? 0.2f : 0.2;
    u1 = BelowOne(d, u1);
    Vec<D> w, w_tail;
    OneMinus(d, u1, w, w_tail);
    const Vec<D> root = Sqrt<A>(d, hn::Abs(cos_i)),
                 f = hn::NegMulAdd(root, Const(d, kHighRoot), Const(d, kHigh));
    const Vec<D> f_tail = hn::Add(hn::NegMulAdd(root, Const(d, kHighRoot), hn::Sub(Const(d, kHigh), f)),
                                  hn::NegMulAdd(root, Const(d, 0.2 - kHighRoot), Const(d, 1.2 - kHigh)));
    Vec<D> f2, f2_tail, t, t_tail, tf2, tf2_tail;
    TwoProduct(d, f, f, f2, f2_tail);
    f2_tail = hn::MulAdd(hn::Add(f, f), f_tail, f2_tail);
    NegLog1m<A>(d, u1, t, t_tail);
    TwoProduct(d, t, f2, tf2, tf2_tail);
    tf2_tail = hn::MulAdd(t, f2_tail, hn::MulAdd(t_tail, f2, tf2_tail));
    const Vec<D> over_f2 = Reciprocal<A>(d, f2), q = hn::Mul(w, over_f2);
    const Vec<D> rest = hn::Sub(hn::NegMulAdd(q, f2_tail, w_tail), FusedMulSub(d, q, f2, w));
    NormalFromSlopes<true, kCare, A>(d, mx, my, mz, pdf, hn::Sqrt(tf2), tf2, tf2_tail, q,
                                     hn::Mul(rest, over_f2), u2, p...);
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_BECKMANN_INL_H_
