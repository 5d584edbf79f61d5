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
  static constexpr size_t kOwn = 0;
  static constexpr bool kHasExponent = true, kMaskingInDouble = true, kDensityOfCosine = false,
                        kLogDensityInDouble = false;

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

  // exp is 0 long before z^2 gets to its limits.
  template <class DD>
  static HWY_INLINE Vec<DD> UnitDensity(DD dd, Vec<DD>, Vec<DD>, Vec<DD> z) {
    return hn::Max(hn::Mul(z, z), Const(dd, 0x1p-36));
  }
  template <class DD>
  static HWY_INLINE Vec<DD> UnitLogDensity(DD dd, Vec<DD> x, Vec<DD> y, Vec<DD> z) {
    const Vec<DD> z2 = hn::Max(hn::Mul(z, z), Const(dd, 0x1p-60));
    return hn::Neg(hn::Div(hn::MulAdd(x, x, hn::Mul(y, y)), z2));
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

  // A step towards the slope t of visible normals along the view's azimuth, with a = cot(theta) of the
  // stretched view. Their density there is that of max(0, a + t) exp(-t^2) (Heitz 2014 Eq. 16 at unit
  // roughness), and
  //   P(t) = (exp(-t^2) + sqrt(pi) a erfc(t)) / M, M = 2 sqrt(pi) a + D, D = exp(-a^2) - sqrt(pi) a erfc(a),
  // is the share above t >= -a. P(t) = u is solved from Slope0 by a fixed number of steps of Householder's
  // method of third order, which leave the fourth power of the error. With delta = a + t and R = (P - u) M
  // exp(t^2),
  //   -P/P' = R/(2 delta), P''/P' = 1/delta - 2 t, P'''/P' = 4 t (t - 1/delta) - 2,
  // rational but for R: a step is exact to the fourth order both for the exponential that P is far above and
  // for the square of delta that 1 - P is next to -a.
  //
  // Why two steps are enough: for a from 0 to 2^30 and u from 2^-126 to 1 - 2^-24, on a grid, Slope0 is
  // within 0.35 min(1, delta), the first step leaves 1e-3 and the second 1e-8 of min(1, delta) max(1, |t|),
  // rounding aside; of doubles up to 1 - 2^-53 the third leaves 4e-8 and the fourth 2e-13. Both ends of a are
  // limits that Slope0 has in closed form. A step changes delta by a factor from 1/2 to 2, so that no
  // rounding of R next to -a, where R is the small difference of two terms, leaves the domain.
  //
  // R is formed from the nearer end of the distribution: above t = 0 as 1 + sqrt(pi) a erfcx(t) - u M
  // exp(t^2), below as
  // ((1 - u) M - D) exp(t^2) + 1 - sqrt(pi) a erfcx(-t).
  template <Accuracy A, class D>
  static HWY_INLINE void SlopeStep(D d, Vec<D> t, Vec<D> delta, Vec<D> root_pi_a, Vec<D> above, Vec<D> below,
                                   Vec<D>& step, Vec<D>& exp_t2) {
    const Vec<D> one = Const(d, 1), zero = hn::Zero(d);
    Vec<D> t2, t2_tail;
    if constexpr (A == Accuracy::kFast) {
      t2 = hn::Mul(t, t);
      t2_tail = zero;
    } else {
      TwoProduct(d, t, t, t2, t2_tail);
    }
    exp_t2 = Exp<A>(d, t2, t2_tail);
    const Vec<D> inverse = Div<A>(d, one, delta);
    const auto negative = hn::Lt(t, zero);
    const Vec<D> tail = hn::MulAdd(root_pi_a, FlipSign(d, Erfcx<A>(d, hn::Abs(t)), t), one);
    const Vec<D> rest = hn::MulAdd(hn::IfThenElse(negative, below, above), exp_t2, tail);
    const Vec<D> newton = hn::Mul(hn::Mul(Const(d, 0.5), rest), inverse);
    const Vec<D> bend = hn::NegMulAdd(Const(d, 2), t, inverse);
    const Vec<D> third = hn::MulAdd(hn::Mul(Const(d, 4), t), hn::Sub(t, inverse), Const(d, -2));
    const Vec<D> bent = hn::Mul(bend, newton);
    const Vec<D> divisor =
        hn::MulAdd(hn::Mul(newton, newton), hn::Mul(third, Const(d, 1.0 / 6)), hn::Add(one, bent));
    step = Div<A>(d, hn::MulAdd(hn::Mul(bent, Const(d, 0.5)), newton, newton), divisor);
    step = hn::Min(hn::Max(step, hn::Mul(delta, Const(d, -0.5))), delta);
  }

  // r^2 = -log(min(u, w)), to the 2^-20 that Slope0 needs.
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> SquaredRadius(D d, Vec<D> u, Vec<D> w) {
    const Vec<D> one = Const(d, 1);
    Vec<D> k, m;
    SplitExponent(d, hn::Min(u, w), k, m);
    const Vec<D> f = hn::Sub(m, one);
    const Vec<D> log_m = TwoAtanh<Accuracy::kFast>(d, Div<A>(d, f, hn::Add(f, Const(d, 2))));
    return hn::NegMulAdd(k, Const(d, 0.69314718), hn::Neg(log_m));
  }

  // A first t and delta = a + t from w = 1 - u, r2 = SquaredRadius and t_a = 1/(1 + 0.3 a). Where u is less
  // than w, t is r less a polynomial in r and 1 - t_a, which is 0 for a = 0. Elsewhere 0.3 delta = (1 + 0.3
  // a)/(1 + t_a Q), where Q is a polynomial in r and t_a and `end`, which grows towards -a, where delta^2 = w
  // M exp(a^2): it is exp((r2 - a^2)/2) / (0.3 t_a^2 sqrt(M)). Fits of least squares, weighted for the
  // largest error over min(1, delta), u and w from 2^-126 and 2^-53 to 1/2.
  template <Accuracy A, class D>
  static HWY_INLINE void Slope0(D d, Vec<D> a, Vec<D> t_a, Vec<D> u, Vec<D> w, Vec<D> r2, Vec<D>& t,
                                Vec<D>& delta) {
    const Vec<D> one = Const(d, 1), zero = hn::Zero(d), r = Sqrt<A>(d, r2), b = hn::Sub(one, t_a);
    const Vec<D> p1 = Polynomial(d, r, {-2.69347, 1.19113, -0.251222, 0.0246904, -0.00090922});
    const Vec<D> p2 = Polynomial(d, r, {1.61909, -0.777177, 0.166299, -0.0164243, 0.000606369});
    const Vec<D> upper = hn::MulAdd(hn::MulAdd(p2, b, p1), b, r);
    const Vec<D> end = ExpTimes<Accuracy::kFast>(d, hn::Mul(hn::NegMulAdd(a, a, r2), Const(d, 0.5)), zero,
                                                 Polynomial(d, t_a, {16.8399, -48.0285, 54.0438, -19.5742}));
    const Vec<D> q0 = Polynomial(d, r, {0.729034, 0.447622, -0.0388192, 0.00285638});
    const Vec<D> q1 = Polynomial(d, r, {-3.54629, 0.122153, 0.849904, -0.082167});
    const Vec<D> q2 = Polynomial(d, r, {23.5736, 11.4606, -10.4691, 1.70646});
    const Vec<D> q3 = Polynomial(d, r, {-31.8803, -61.5402, 62.9258, -13.0174});
    const Vec<D> q4 = Polynomial(d, r, {-50.2775, 189.297, -156.194, 35.1456});
    const Vec<D> high = hn::MulAdd(hn::MulAdd(q4, t_a, q3), hn::Mul(t_a, t_a), hn::MulAdd(q2, t_a, q1));
    const Vec<D> q = hn::MulAdd(high, t_a, hn::Add(q0, end));
    const Vec<D> inverse = Div<A>(d, Const(d, 1 / 0.3), hn::MulAdd(t_a, q, one));
    const auto above = hn::Lt(u, w);
    t = hn::IfThenElse(above, upper, hn::Mul(hn::NegMulAdd(b, q, one), inverse));
    delta = hn::IfThenElse(above, hn::Add(a, upper), hn::Mul(hn::MulAdd(a, Const(d, 0.3), one), inverse));
  }

  // Visible normals (Heitz 2014 Eq. 16): slopes t along the azimuth of the stretched view q = (alpha_x vx,
  // alpha_y vy, |vz|), u1 the share of those above t, and y = erfinv(2 u2 - 1) across it: m = M/|M|, M =
  // (alpha_x (t cos - y sin), alpha_y (t sin + y cos), 1) = (x, y, 1). With delta = a + t,
  //   D_v(m) = 2 delta exp(-t^2 - y^2) |M|^3 / (sqrt(pi) alpha_x alpha_y M(a)),
  // in which no exponential is rounded twice: 2 exp(-t^2 - y^2) / sqrt(pi) is 2^-40 `share` / (erfcx exp_t2),
  // because exp(-y^2) = 2 min(u2, 1 - u2) / erfcx(|y|), and exp_t2 is that of the last step's t but for a
  // small correction of the share. 2^40 keeps that above the underflow.
  //
  // The view comes as vx, vy times any power of two `scale` and its sign, and z = |vz| times the same; q is
  // the length of its stretched tangent, and 1 along the normal, where a stops at LargestA.
  template <class D>
  static HWY_INLINE Vec<D> LargestA(D d) {
    return Const(d, kIsFloat<D> ? 0x1p30 : 0x1p60);  // beyond, P(t) is that of a = infinity
  }
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void VisibleSlopes(D d, Vec<D>& x, Vec<D>& y, Vec<D>& delta, Vec<D>& share, Vec<D>& erfcx,
                                       Vec<D>& exp_t2, Vec<D>& a, Vec<D>& q, Vec<D>& defect, Vec<D>& whole,
                                       Vec<D> vx, Vec<D> vy, Vec<D> z, Vec<D> u1, Vec<D> u2, P... p) {
    const Vec<D> zero = hn::Zero(d), one = Const(d, 1), ax = AlphaX(p...), ay = AlphaY(p...);
    u1 = FromTiny(d, BelowOne(d, u1));
    u2 = FromTiny(d, BelowOne(d, u2));
    const Vec<D> w1 = hn::Sub(one, u1), w2 = hn::Sub(one, u2);
    const Vec<D> r2 = SquaredRadius<A>(d, u1, w1);
    const Vec<D> qx = hn::Mul(ax, vx), qy = hn::Mul(ay, vy), q2 = hn::MulAdd(qx, qx, hn::Mul(qy, qy));
    const auto normal = hn::Eq(q2, zero);
    q = CloseSqrt<A>(d, hn::IfThenElse(normal, one, q2));
    const Vec<D> cos = hn::IfThenElse(normal, one, hn::Div(qx, q)), sin = hn::Div(qy, q);
    a = hn::IfThenElse(normal, LargestA(d), hn::Min(LargestA(d), hn::Div(z, q)));

    const Vec<D> t_a = hn::Div(one, hn::MulAdd(a, Const(d, 0.3), one));
    Vec<D> a2, a2_tail;
    TwoProduct(d, a, a, a2, a2_tail);
    const Vec<D> exp_a2 = Exp<A>(d, hn::Neg(a2), hn::Neg(a2_tail));
    const Vec<D> root_pi_a = hn::Mul(a, Const(d, kRootPi));
    // D exp(a^2) where sqrt(pi) a is small: as R has it, so that what both lack is the same.
    const Vec<D> near = hn::NegMulAdd(root_pi_a, Erfcx<A>(d, a), one);
    const Vec<D> far = hn::Mul(hn::Mul(t_a, t_a), ErfcxDefectOverT2<A>(d, t_a));
    defect = hn::Mul(hn::IfThenElse(hn::Lt(a, one), near, far), exp_a2);
    whole = hn::MulAdd(Const(d, 2), root_pi_a, defect);
    const Vec<D> minus_above = hn::Neg(hn::Mul(u1, whole)), from_end = hn::MulSub(w1, whole, defect);

    Vec<D> t, step;
    Slope0<A>(d, a, t_a, u1, w1, r2, t, delta);
    // Of u2 alone, here to fill the wait for t.
    const Vec<D> across = ErfInv<A>(d, u2);
    erfcx = Erfcx<A>(d, hn::Abs(across));
    SlopeStep<A>(d, t, delta, root_pi_a, minus_above, from_end, step, exp_t2);
    constexpr int kMoreSteps = kIsFloat<D> ? 1 : 3;
    for (int i = 0; i < kMoreSteps; ++i) {
      t = hn::Add(t, step);
      delta = hn::Add(a, t);
      SlopeStep<A>(d, t, delta, root_pi_a, minus_above, from_end, step, exp_t2);
    }
    // share exp(s) but for fourth powers, s = t^2 - (t + step)^2.
    const Vec<D> s = hn::Mul(hn::Neg(step), hn::MulAdd(Const(d, 2), t, step));
    share = hn::Mul(hn::Min(u2, w2), Const(d, 0x1p40 * 4 / kRootPi));
    const Vec<D> grown =
        hn::MulAdd(hn::Mul(s, s), hn::MulAdd(s, Const(d, 1.0 / 6), Const(d, 0.5)), s);  // exp(s) - 1
    share = hn::MulAdd(grown, share, share);
    t = hn::Add(t, step);
    delta = hn::Add(delta, step);
    x = hn::Mul(ax, hn::NegMulAdd(across, sin, hn::Mul(t, cos)));
    y = hn::Mul(ay, hn::MulAdd(across, cos, hn::Mul(t, sin)));
  }

  // density / (2^40 exp_t2), finite.
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> OverExp(D d, Vec<D> density, Vec<D> exp_t2) {
    const Vec<D> down = Const(d, 0x1p-40);
    if constexpr (A == Accuracy::kFast) {
      // Scaled, for approximations do not reach the reciprocal of 2^126.
      const Vec<D> r = RefinedReciprocal<A>(d, hn::Mul(exp_t2, down));
      return hn::Mul(hn::Mul(density, r), hn::Mul(down, down));
    } else {
      return hn::Mul(hn::Div(density, exp_t2), down);
    }
  }

  template <bool kBounded, Accuracy A, class D, class... P>
  static HWY_INLINE void SampleVisibleNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> vx,
                                             Vec<D> vy, Vec<D> vz, Vec<D> u1, Vec<D> u2, P... p) {
    static_assert(!kBounded, "caps are GGX's");
    const Vec<D> zero = hn::Zero(d), one = Const(d, 1);
    // The bits of a view next to the normal are kept.
    const Vec<D> scale = PowerOfTwoScale(d, vx, vy, zero), z = hn::Abs(vz);
    const Vec<D> side = hn::IfThenElse(hn::Lt(vz, zero), hn::Neg(scale), scale);
    Vec<D> x, y, delta, share, erfcx, exp_t2, a, q, defect, whole;
    VisibleSlopes<A>(d, x, y, delta, share, erfcx, exp_t2, a, q, defect, whole, hn::Mul(vx, side),
                     hn::Mul(vy, side), hn::Mul(z, scale), u1, u2, p...);
    const Vec<D> length2 = hn::MulAdd(x, x, hn::MulAdd(y, y, one));
    const Vec<D> divisor = hn::Mul(hn::Mul(hn::Mul(AlphaX(p...), AlphaY(p...)), erfcx), whole);
    const Vec<D> scaled = hn::Mul(length2, hn::Mul(length2, delta));
    Vec<D> inverse, both;  // 1/|M|, 1/(|M| divisor)
    if constexpr (A == Accuracy::kFast) {
      inverse = FastReciprocalSqrt(d, length2);
      both = hn::Mul(inverse, RefinedReciprocal<A>(d, divisor));
    } else {
      both = hn::Div(one, hn::Mul(hn::Sqrt(length2), divisor));
      inverse = hn::Mul(both, divisor);
    }
    const auto none = hn::Eq(hn::Add(hn::Add(hn::Abs(vx), hn::Abs(vy)), z), zero);
    mx = ZeroIf(none, hn::Mul(x, inverse));
    my = ZeroIf(none, hn::Mul(y, inverse));
    mz = ZeroIf(none, inverse);
    pdf = ZeroIf(none, OverExp<A>(d, hn::Mul(hn::Mul(scaled, both), share), exp_t2));
  }

  // Reflection about a visible normal: v.M = q delta, and (z + mu) sqrt(pi) = q M(a) with mu = z (1 + 2
  // Lambda), so that the density of wo,
  //   D_v(m)/(4 v.m) = exp(-t^2 - y^2) |M|^4 / (2 sqrt(pi) alpha_x alpha_y q M(a)),
  // is free of delta, and no length is formed. Of a view of the length 1 to 2; the powers of two are put
  // back. cos2 = (v.m)^2.
  template <bool kBounded, JointMasking kG, Accuracy A, class D, class... P>
  static HWY_INLINE void SampleVisibleReflection(D d, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz, Vec<D>& weight,
                                                 Vec<D>& pdf, Vec<D>& lobe, Vec<D>& cos2, Vec<D> vx,
                                                 Vec<D> vy, Vec<D> vz, Vec<D> u1, Vec<D> u2, P... p) {
    static_assert(!kBounded, "caps are GGX's");
    const Vec<D> zero = hn::Zero(d), one = Const(d, 1);
    const Vec<D> unit = PowerOfTwoScale(d, vx, vy, vz);
    const auto below = hn::Lt(vz, zero);
    vx = hn::Mul(vx, unit);
    vy = hn::Mul(vy, unit);
    vz = hn::Mul(vz, unit);
    const Vec<D> scale = PowerOfTwoScale(d, vx, vy, zero), z = hn::Abs(vz);
    const Vec<D> side = hn::IfThenElse(below, hn::Neg(scale), scale);
    Vec<D> x, y, delta, share, erfcx, exp_t2, a, q, defect, whole;
    VisibleSlopes<A>(d, x, y, delta, share, erfcx, exp_t2, a, q, defect, whole, hn::Mul(vx, side),
                     hn::Mul(vy, side), hn::Mul(z, scale), u1, u2, p...);
    // Where a had to stop, v.M is z to a rounding.
    q = hn::Mul(q, InversePowerOfTwo(d, scale));
    const Vec<D> v_m = hn::IfThenElse(hn::Lt(a, LargestA(d)), hn::Mul(q, delta), z);
    const Vec<D> mu = hn::MulAdd(hn::Mul(q, defect), Const(d, 1 / kRootPi), z), visible = hn::Add(z, mu);
    const Vec<D> m2 = hn::MulAdd(x, x, hn::MulAdd(y, y, one));
    const Vec<D> r_m2 = RefinedReciprocal<A>(d, m2);
    const Vec<D> area = hn::Mul(hn::Mul(AlphaX(p...), AlphaY(p...)), Const(d, 4 * kRootPi));
    const Vec<D> divisor = hn::Mul(hn::Mul(area, erfcx), visible);
    const Vec<D> density = OverExp<A>(d, Div<A>(d, hn::Mul(hn::Mul(m2, m2), share), divisor), exp_t2);
    ReflectAboutVisible<Beckmann, kG, A>(d, ox, oy, oz, weight, pdf, lobe, hn::Mul(hn::Add(v_m, v_m), r_m2),
                                         x, y, one, zero, density, mu, visible, vx, vy, vz, p...);
    const Vec<D> down = InversePowerOfTwo(d, unit);
    cos2 = hn::Mul(hn::Mul(v_m, down), hn::Mul(hn::Mul(v_m, down), r_m2));
    ox = hn::Mul(ox, down);
    oy = hn::Mul(oy, down);
    oz = hn::Mul(oz, down);
    pdf = hn::Min(hn::Mul(pdf, unit), hn::Set(d, std::numeric_limits<T<D>>::max()));
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
