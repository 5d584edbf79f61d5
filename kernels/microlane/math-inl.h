// Lane mathematics that Highway 1.0.3 lacks, in float and double lanes. Bounds: kernel_list.h, family `math`.
#if defined(MICROLANE_MATH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_MATH_INL_H_
#undef MICROLANE_MATH_INL_H_
#else
#define MICROLANE_MATH_INL_H_
#endif

#include "microlane/compat-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kRootPi = 1.77245385090551602730;

// ln 2 = high + low, where high has so few bits that its product with an exponent is exact.
template <class D>
constexpr double kLn2High = kIsFloat<D> ? 0.693145751953125 : 0.693147180369123816490;
template <class D>
constexpr double kLn2Low = kIsFloat<D> ? 1.42860682030941723212e-6 : 1.90821492927058770002e-10;

// Square root, reciprocal and quotient at an accuracy. kFast: relative error below 2^-13; zero stays zero.
template <Accuracy A, class D>
HWY_INLINE Vec<D> Sqrt(D d, Vec<D> x) {
  if constexpr (A == Accuracy::kFast) {
    return hn::Mul(x, FastReciprocalSqrt(d, hn::Max(hn::Set(d, 1e-37f), x)));
  } else {
    (void)d;
    return hn::Sqrt(x);
  }
}

// The same for x >= 1e-37.
template <Accuracy A, class D>
HWY_INLINE Vec<D> SqrtOfPositive(D d, Vec<D> x) {
  if constexpr (A == Accuracy::kFast) {
    return hn::Mul(x, FastReciprocalSqrt(d, x));
  } else {
    (void)d;
    return hn::Sqrt(x);
  }
}

// The same for what is about to cancel: kFast has a relative error below 2^-21.
template <Accuracy A, class D>
HWY_INLINE Vec<D> CloseSqrt(D d, Vec<D> x) {
  if constexpr (A == Accuracy::kFast) {
    const Vec<D> y = FastReciprocalSqrt(d, hn::Max(hn::Set(d, 1e-37f), x));
    const Vec<D> root = hn::Mul(x, y);
    return hn::MulAdd(hn::NegMulAdd(root, root, x), hn::Mul(hn::Set(d, 0.5f), y), root);
  } else {
    return Sqrt<A>(d, x);
  }
}

template <Accuracy A, class D>
HWY_INLINE Vec<D> Reciprocal(D d, Vec<D> x) {
  if constexpr (A == Accuracy::kFast) {
    return FastReciprocal(d, x);
  } else {
    return hn::Div(Const(d, 1), x);
  }
}

// Reciprocal with kFast's error taken to a rounding or two, where it is not, by a Newton step.
template <Accuracy A, class D>
HWY_INLINE Vec<D> RefinedReciprocal(D d, Vec<D> x) {
  const Vec<D> r = Reciprocal<A>(d, x);
  return A == Accuracy::kFast && !kFastIsRefined ? NewtonReciprocal(d, x, r) : r;
}

// x/y from r = Reciprocal<A>(y), for several x over one y: rounded as a division but for rare cases.
template <Accuracy A, class D>
HWY_INLINE Vec<D> DivByReciprocal(D d, Vec<D> x, Vec<D> y, Vec<D> r) {
  (void)d;
  const Vec<D> q = hn::Mul(x, r);
  if constexpr (A == Accuracy::kFast) return q;
#if HWY_NATIVE_FMA
  return hn::MulAdd(hn::NegMulAdd(q, y, x), r, q);
#else
  return hn::Div(x, y);
#endif
}

template <Accuracy A, class D>
HWY_INLINE Vec<D> Div(D d, Vec<D> a, Vec<D> b) {
  if constexpr (A == Accuracy::kFast) {
    return hn::Mul(a, FastReciprocal(d, b));
  } else {
    (void)d;
    return hn::Div(a, b);
  }
}

// The same with kFast's error taken to a rounding or two.
template <Accuracy A, class D>
HWY_INLINE Vec<D> RefinedDiv(D d, Vec<D> a, Vec<D> b) {
  if constexpr (A == Accuracy::kFast) {
    return hn::Mul(a, RefinedReciprocal<A>(d, b));
  } else {
    return Div<A>(d, a, b);
  }
}

// value where `invalid` does not hold, else 0. Tests are written so that NaN is never `invalid`.
template <class M, class V>
HWY_INLINE V ZeroIf(M invalid, V value) {
  return hn::IfThenZeroElse(invalid, value);
}

// Whether x is not within [low, high], for positive float bounds; true of NaN. Positive floats are ordered as
// their bits.
template <class D>
HWY_INLINE hn::Mask<D> OutOfRange(D d, Vec<D> x, float low, float high) {
  const hn::RebindToUnsigned<D> du;
  const auto bottom = hn::BitCast(du, hn::Set(d, low)), top = hn::BitCast(du, hn::Set(d, high));
  return hn::RebindMask(d, hn::Gt(hn::Sub(hn::BitCast(du, x), bottom), hn::Sub(top, bottom)));
}

// a * b = p + e exactly.
template <class D>
HWY_INLINE void TwoProduct(D d, Vec<D> a, Vec<D> b, Vec<D>& p, Vec<D>& e) {
  p = hn::Mul(a, b);
#if HWY_NATIVE_FMA
  (void)d;
  e = hn::MulSub(a, b, p);
#else
  // Dekker's splitting, exact while 4097 a (2^27 + 1 in double) does not overflow.
  const Vec<D> factor = Const(d, kIsFloat<D> ? 4097.0 : 134217729.0);
  const Vec<D> ca = hn::Mul(factor, a), cb = hn::Mul(factor, b);
  const Vec<D> ah = hn::Sub(ca, hn::Sub(ca, a)), bh = hn::Sub(cb, hn::Sub(cb, b));
  const Vec<D> al = hn::Sub(a, ah), bl = hn::Sub(b, bh);
  e = hn::Add(hn::Add(hn::Add(hn::Sub(hn::Mul(ah, bh), p), hn::Mul(ah, bl)), hn::Mul(al, bh)),
              hn::Mul(al, bl));
#endif
}

// a + b = s + e exactly.
template <class V>
HWY_INLINE void TwoSum(V a, V b, V& s, V& e) {
  s = hn::Add(a, b);
  const V bb = hn::Sub(s, a);
  e = hn::Add(hn::Sub(a, hn::Sub(s, bb)), hn::Sub(b, bb));
}

// The same for |a| >= |b|.
template <class V>
HWY_INLINE void FastTwoSum(V a, V b, V& s, V& e) {
  s = hn::Add(a, b);
  e = hn::Sub(b, hn::Sub(s, a));
}

// sum + tail += x y, positive terms; without a tail in kFast.
template <Accuracy A, class V>
HWY_INLINE void AddTerm(V& sum, V& tail, V x, V y) {
  const V added = hn::MulAdd(x, y, sum);
  if constexpr (A != Accuracy::kFast) tail = hn::Add(tail, hn::MulAdd(x, y, hn::Sub(sum, added)));
  sum = added;
}

// 1 - u = w + w_tail exactly, for u in [0, 1].
template <class D>
HWY_INLINE void OneMinus(D d, Vec<D> u, Vec<D>& w, Vec<D>& w_tail) {
  const Vec<D> one = Const(d, 1);
  w = hn::Sub(one, u);
  w_tail = hn::Sub(hn::Sub(one, w), u);
}

// (a (b + b_tail))^2 = p + p_tail to twice the working precision.
template <class D>
HWY_INLINE void SquareOfProduct(D d, Vec<D> a, Vec<D> b, Vec<D> b_tail, Vec<D>& p, Vec<D>& p_tail) {
  Vec<D> q, q_tail;
  TwoProduct(d, a, b, q, q_tail);
  q_tail = hn::MulAdd(a, b_tail, q_tail);
  TwoProduct(d, q, q, p, p_tail);
  p_tail = hn::MulAdd(hn::Add(q, q), q_tail, p_tail);
}

// x = high + low, where high of a double has no more bits than a float, so that both can be demoted.
template <class D>
HWY_INLINE void SplitHigh(D d, Vec<D> x, Vec<D>& high, Vec<D>& low) {
  if constexpr (kIsFloat<D>) {
    high = x;
    low = hn::Zero(d);
  } else {
    const hn::RebindToUnsigned<D> du;
    high = hn::BitCast(d, hn::And(hn::BitCast(du, x), hn::Set(du, 0xFFFFFFFFE0000000u)));
    low = hn::Sub(x, high);
  }
}

template <class V>
HWY_INLINE V Dot(V ax, V ay, V az, V bx, V by, V bz) {
  return hn::MulAdd(az, bz, hn::MulAdd(ay, by, hn::Mul(ax, bx)));
}

// x with its sign flipped where `sign` is negative.
template <class D>
HWY_INLINE Vec<D> FlipSign(D d, Vec<D> x, Vec<D> sign) {
  return hn::Xor(x, hn::And(sign, hn::SignBit(d)));
}

// Power of two that brings the largest component to [1, 2), exactly; 2^127 (2^1023) for the zero vector.
template <class D>
HWY_INLINE Vec<D> PowerOfTwoScale(D d, Vec<D> x, Vec<D> y, Vec<D> z) {
  const hn::RebindToUnsigned<D> du;
  using U = hn::TFromD<decltype(du)>;
  constexpr U kExponent = kIsFloat<D> ? static_cast<U>(0x7F800000u) : static_cast<U>(0x7FF0000000000000u);
  constexpr U kTwiceBias = kIsFloat<D> ? static_cast<U>(0x7F000000u) : static_cast<U>(0x7FE0000000000000u);
  const Vec<D> largest = hn::Max(hn::Max(hn::Abs(x), hn::Abs(y)), hn::Abs(z));
  const auto exponent = hn::And(hn::BitCast(du, largest), hn::Set(du, kExponent));
  return hn::BitCast(d, hn::Sub(hn::Set(du, kTwiceBias), exponent));
}

// 1/x of a power of two up to 2^126 (2^1022); 0 of the next one.
template <class D>
HWY_INLINE Vec<D> InversePowerOfTwo(D d, Vec<D> x) {
  const hn::RebindToUnsigned<D> du;
  using U = hn::TFromD<decltype(du)>;
  constexpr U kTwiceBias = kIsFloat<D> ? static_cast<U>(0x7F000000u) : static_cast<U>(0x7FE0000000000000u);
  return hn::BitCast(d, hn::Sub(hn::Set(du, kTwiceBias), hn::BitCast(du, x)));
}

// sum_i c[kFirst + i kStep] x^i by Horner's rule, rounded as one FMA per step. A recursion, for loops of this
// length stay loops at -O2.
template <size_t kFirst = 0, size_t kStep = 1, class D, size_t N>
HWY_INLINE Vec<D> Polynomial(D d, Vec<D> x, const double (&c)[N]) {
  const Vec<D> first = Const(d, c[kFirst]);
  if constexpr (kFirst + kStep >= N) {
    return first;
  } else {
    return hn::MulAdd(Polynomial<kFirst + kStep, kStep>(d, x, c), x, first);
  }
}

// sum_ij c[i][j] x^i y^j.
template <std::size_t kRow = 0, class D, size_t N, size_t M>
HWY_INLINE Vec<D> Polynomial(D d, Vec<D> x, Vec<D> y, const double (&c)[N][M]) {
  const Vec<D> row = Polynomial(d, y, c[kRow]);
  if constexpr (kRow + 1 == N) {
    return row;
  } else {
    return hn::MulAdd(Polynomial<kRow + 1>(d, x, y, c), x, row);
  }
}

// sum_i c[i] x^i in half the latency: even and odd powers apart.
template <class D, size_t N>
HWY_INLINE Vec<D> SplitPolynomial(D d, Vec<D> x, const double (&c)[N]) {
  const Vec<D> x2 = hn::Mul(x, x);
  return hn::MulAdd(Polynomial<1, 2>(d, x2, c), x, Polynomial<0, 2>(d, x2, c));
}

// factor e^(x + tail), tail a correction of at most a few ulps of x, rounded once into the subnormal range
// even where e^x alone is below it. |log2 factor| <= 90 (900 in double). 0 far below the subnormal range,
// without arithmetic that underflows (it is slow on x86).
template <Accuracy A, class D>
HWY_INLINE Vec<D> ExpTimes(D d, Vec<D> x, Vec<D> tail, Vec<D> factor) {
  const hn::RebindToSigned<D> di;
  constexpr int kBits = kIsFloat<D> ? 23 : 52, kBias = kIsFloat<D> ? 127 : 1023;
  constexpr double kLimit = kIsFloat<D> ? 170 : 1400;
  const auto vanishes = hn::Lt(x, Const(d, -kLimit));  // NaN passes
  const Vec<D> high = Const(d, kLimit);
  x = ZeroIf(vanishes, hn::IfThenElse(hn::Gt(x, high), high, x));
  const Vec<D> n = hn::Round(hn::Mul(x, Const(d, 1.44269504088896340736)));
  Vec<D> r = hn::NegMulAdd(n, Const(d, kLn2High<D>), x);
  r = hn::Add(hn::NegMulAdd(n, Const(d, kLn2Low<D>), r), tail);
  Vec<D> p;
  if constexpr (A == Accuracy::kFast) {
    // sollya: fpminimax(exp(x), [|2,3,4|], [|SG...|], [-0.3466;0.3466], relative, 1+x): 2^-17.5
    p = Polynomial(d, r,
                   {0.50005114078521728515625, 0.1675352752208709716796875, 4.1278026998043060302734375e-2});
  } else if constexpr (kIsFloat<D>) {
    // sollya: fpminimax(exp(x), [|2,...,6|], [|SG...|], [-0.3466;0.3466], relative, 1+x): 2^-28.2
    p = Polynomial(
        d, r,
        {0.4999999105930328369140625, 0.16666521131992340087890625, 4.16689626872539520263671875e-2,
         8.368670009076595306396484375e-3, 1.378246466629207134246826171875e-3});
  } else {
    // sollya: fpminimax(exp(x), [|2,...,12|], [|D...|], [-0.3466;0.3466], relative, 1+x): 2^-63.5
    p = Polynomial(d, r,
                   {0.5, 0.16666666666666685170383743752609007060527801513671875,
                    4.16666666666665463925056656080414541065692901611328125e-2,
                    8.33333333331599639126618939144464093260467052459716796875e-3,
                    1.38888888889564352142891312524852764909155666828155517578125e-3,
                    1.98412698985076549167139159379757984424941241741180419921875e-4,
                    2.480158717782842217342703650118096447840798646211624145507812e-5,
                    2.755723304631957282695344652045932321016152855008840560913086e-6,
                    2.755739908990350990288832611074809619822190143167972564697266e-7,
                    2.511259157709188156915254867222048185126936914457473903894424e-8,
                    2.08765893735687343299628254602445798226995066215749830007553e-9});
  }
  const Vec<D> y = hn::MulAdd(factor, hn::MulAdd(hn::Mul(r, r), p, r), factor);
  // 2^n in two factors, so that subnormal results are rounded once.
  const auto ni = ToInteger(di, n);
  const auto n1 = hn::ShiftRight<1>(ni);
  const auto n2 = hn::Sub(ni, n1);
  const auto bias = hn::Set(di, static_cast<hn::TFromD<decltype(di)>>(kBias));
  const Vec<D> s1 = hn::BitCast(d, hn::ShiftLeft<kBits>(hn::Add(n1, bias)));
  const Vec<D> s2 = hn::BitCast(d, hn::ShiftLeft<kBits>(hn::Add(n2, bias)));
  return ZeroIf(vanishes, hn::Mul(hn::Mul(y, s1), s2));
}

// e^(x + tail).
template <Accuracy A, class D>
HWY_INLINE Vec<D> Exp(D d, Vec<D> x, Vec<D> tail) {
  return ExpTimes<A>(d, x, tail, Const(d, 1));
}

// e^x - 1 for |x| <= 0.1.
template <class D>
HWY_INLINE Vec<D> ExpMinusOneSeries(D d, Vec<D> x) {
  return hn::MulAdd(
      hn::Mul(x, x),
      Polynomial(d, x, {0.5, 1.0 / 6, 1.0 / 24, 1.0 / 120, 1.0 / 720, 1.0 / 5040, 1.0 / 40320, 1.0 / 362880}),
      x);
}

// (2 atanh(s) - 2 s)/s^3 of y = s^2, |s| <= 3 - 2 sqrt 2.
template <Accuracy A, class D>
HWY_INLINE Vec<D> TwoAtanhPolynomial(D d, Vec<D> y) {
  if constexpr (A == Accuracy::kFast) {
    // sollya: fpminimax((2*atanh(sqrt(x))/sqrt(x)-2)/x, 1, [|24...|], [1b-60;0.02945], absolute): 2^-21
    return Polynomial(d, y, {0.666634619235992431640625, 0.40861070156097412109375});
  } else if constexpr (kIsFloat<D>) {
    // as above, degree 2: 2^-28.5
    return Polynomial(d, y,
                      {0.66666686534881591796875, 0.3998853862285614013671875, 0.29587137699127197265625});
  } else {
    // as above, degree 7, [|D...|]: 2^-65.7
    return Polynomial(d, y,
                      {0.66666666666666662965923251249478198587894439697265625,
                       0.400000000000053201887340037501417100429534912109375,
                       0.285714285691719804827215511977556161582469940185546875,
                       0.222222226558418167741137949633412063121795654296875,
                       0.1818177369468834403409829292036283303625676441192626953125,
                       0.1538721608392169259982625296399532352365553379058837890625,
                       0.13246652407214931995645648068492300808429718017578125,
                       0.1328707950828539596788147036932056963086128234863281250});
  }
}

// 2 atanh(s) for |s| <= 3 - 2 sqrt 2, where log((1 + s)/(1 - s)) is meant.
template <Accuracy A, class D>
HWY_INLINE Vec<D> TwoAtanh(D d, Vec<D> s) {
  const Vec<D> y = hn::Mul(s, s);
  return hn::MulAdd(s, Const(d, 2), hn::Mul(hn::Mul(s, y), TwoAtanhPolynomial<A>(d, y)));
}

// x = 2^k m with m in [sqrt(1/2), sqrt(2)), x positive and normal.
template <class D>
HWY_INLINE void SplitExponent(D d, Vec<D> x, Vec<D>& k, Vec<D>& m) {
  const hn::RebindToSigned<D> di;
  using I = hn::TFromD<decltype(di)>;
  constexpr int kBits = kIsFloat<D> ? 23 : 52;
  const auto half =
      hn::Set(di, kIsFloat<D> ? static_cast<I>(0x3F3504F3) : static_cast<I>(0x3FE6A09E667F3BCD));
  const auto steps = hn::Sub(hn::BitCast(di, x), half);
  const auto e = hn::ShiftRight<kBits>(steps);
  const auto mantissa = hn::Sub(hn::BitCast(di, x), hn::ShiftLeft<kBits>(e));
  k = hn::ConvertTo(d, e);
  m = hn::BitCast(d, mantissa);
}

// y + y_tail = -log(1 - u) for u in [0, 1), keeping the relative accuracy of small u. y_tail is what y lacks
// but in kFast.
template <Accuracy A, class D>
HWY_INLINE void NegLog1m(D d, Vec<D> u, Vec<D>& y, Vec<D>& y_tail) {
  const Vec<D> zero = hn::Zero(d), one = Const(d, 1), two = Const(d, 2);
  // Total function: u >= 1 behaves as the largest number below 1; NaN passes.
  const Vec<D> largest = Const(d, kIsFloat<D> ? 0x1.fffffep-1 : 0x1.fffffffffffffp-1);
  u = hn::IfThenElse(hn::Ge(u, one), largest, u);
  const Vec<D> w = hn::Sub(one, u);
  Vec<D> k, m;
  SplitExponent(d, w, k, m);
  // log(m) = 2 atanh(n/(2 + n)) of n = m - 1, which is exact from u: w has lost bits of a small one.
  const hn::RebindToUnsigned<D> du;
  const auto shift = hn::Sub(hn::BitCast(du, w), hn::BitCast(du, m));
  const Vec<D> scale = hn::BitCast(d, hn::Sub(hn::BitCast(du, one), shift));  // 2^-k
  const Vec<D> n = hn::NegMulAdd(scale, u, hn::Sub(scale, one));
  const Vec<D> sum = hn::Add(n, two);
  const Vec<D> k_low = hn::Mul(k, Const(d, -kLn2Low<D>));
  if constexpr (A == Accuracy::kFast) {
    const Vec<D> log_m = TwoAtanh<A>(d, hn::Div(n, sum));
    // At least u, which the quotient loses where it is subnormal.
    y = hn::Max(u, hn::NegMulAdd(k, Const(d, kLn2High<D>), hn::Sub(k_low, log_m)));
    y_tail = zero;
  } else {
    const Vec<D> r = hn::Div(one, sum), s = hn::Mul(n, r), s2 = hn::Mul(s, s);
    const Vec<D> sum_tail = hn::Sub(n, hn::Sub(sum, two));
    const Vec<D> rest = hn::NegMulAdd(s, sum_tail, hn::NegMulAdd(s, sum, n));
    const Vec<D> low = hn::NegMulAdd(hn::Mul(s, s2), TwoAtanhPolynomial<A>(d, s2),
                                     hn::NegMulAdd(hn::Add(r, r), rest, k_low));
    const Vec<D> k_high = hn::Mul(k, Const(d, -kLn2High<D>));
    Vec<D> high, high_tail;
    FastTwoSum(k_high, hn::Mul(s, Const(d, -2)), high, high_tail);
    FastTwoSum(high, hn::Add(high_tail, low), y, y_tail);
  }
}

template <Accuracy A, class D>
HWY_INLINE Vec<D> NegLog1m(D d, Vec<D> u) {
  Vec<D> y, y_tail;
  NegLog1m<A>(d, u, y, y_tail);
  return y;
}

// log(x) for positive normal x.
template <Accuracy A, class D>
HWY_INLINE Vec<D> Log(D d, Vec<D> x) {
  Vec<D> k, m;
  SplitExponent(d, x, k, m);
  const Vec<D> f = hn::Sub(m, Const(d, 1));
  const Vec<D> log_m = TwoAtanh<A>(d, Div<A>(d, f, hn::Add(f, Const(d, 2))));
  return hn::MulAdd(k, Const(d, kLn2High<D>), hn::MulAdd(k, Const(d, kLn2Low<D>), log_m));
}

// log(1 + a/b) of a >= 0, b > 0, and a normal sum. Below 0.41 of a/b, log(1 + t) = 2 atanh(t/(2 + t)) by its
// series alone; above, through the exponent of 1 + t.
template <class D>
HWY_INLINE Vec<D> LogOnePlusRatio(D d, Vec<D> a, Vec<D> b) {
  const Vec<D> sum = hn::Add(a, b);
  const Vec<D> near = TwoAtanh<Accuracy::kStandard>(d, hn::Div(a, hn::Add(sum, b)));
  const Vec<D> far = Log<Accuracy::kStandard>(d, hn::Div(sum, b));
  return hn::IfThenElse(hn::Lt(a, hn::Mul(b, Const(d, 0.41))), near, far);
}

// s + s_tail = sin(2 pi r), c + c_tail = cos(2 pi r) of r = u - q/4, an eighth of a turn at most, for |u| <
// 2^21 (2^50 in double): the reduction is exact. Tails are 0 in kFast.
template <Accuracy A, class D>
HWY_INLINE void SinCosOfEighth(D d, Vec<D> u, Vec<D>& q, Vec<D>& s, Vec<D>& s_tail, Vec<D>& c,
                               Vec<D>& c_tail) {
  q = hn::Round(hn::Mul(u, Const(d, 4)));
  const Vec<D> r = hn::NegMulAdd(q, Const(d, 0.25), u);
  const Vec<D> y = hn::Mul(r, r);
  s_tail = c_tail = hn::Zero(d);
  if constexpr (A == Accuracy::kFast) {
    // sollya: fpminimax(sin(2*pi*sqrt(x))/sqrt(x), 2, [|24...|], [1b-40;1b-6], relative): 2^-19.3; cos:
    // 2^-16.4
    s = hn::Mul(r, Polynomial(d, y, {6.283175945281982421875, -41.3311004638671875, 79.8117523193359375}));
    c = Polynomial(d, y, {0.99998819828033447265625, -19.726787567138671875, 62.9062347412109375});
  } else if constexpr (kIsFloat<D>) {
    // sollya: fpminimax((sin(2*pi*sqrt(x))/sqrt(x)-2*pi)/x, 3, [|24...|], [1b-40;1b-6], absolute): 2^-31.9,
    // with 2 pi in two parts; fpminimax(cos(2*pi*sqrt(x)), 4, [|24...|], [1b-40;1b-6], relative): 2^-30.8
    const Vec<D> p = Polynomial(
        d, y, {-41.341701507568359375, 81.60486602783203125, -76.654205322265625, 39.870723724365234375});
    const Vec<D> low = hn::Mul(r, hn::MulAdd(y, p, Const(d, -1.7484555e-7)));
    const Vec<D> two_pi = Const(d, 6.283185482025146484375), one = Const(d, 1);
    s = hn::MulAdd(r, two_pi, low);
    s_tail = hn::Add(hn::MulSub(r, two_pi, s), low);
    const Vec<D> rest = Polynomial(
        d, y, {-19.739208221435546875, 64.939178466796875, -85.42949676513671875, 58.814777374267578125});
    c = hn::MulAdd(y, rest, one);
    c_tail = hn::MulAdd(y, rest, hn::Sub(one, c));
  } else {
    // as above, degrees 7 and 8, [|53...|]: 2^-61.5 and 2^-61.4
    const Vec<D> p = Polynomial(d, y,
                                {-41.34170224039976204721824615262448787689208984375,
                                 81.6052492760793910520078497938811779022216796875,
                                 -76.7058597560603203646678593941032886505126953125,
                                 42.05869485907934546276010223664343357086181640625,
                                 -15.0947856171911443112776396446861326694488525390625,
                                 3.831937978176611192537848182837478816509246826171875,
                                 -1.2295319608865826754851013902225531637668609619140625,
                                 8.8324023774429054611800893326289951801300048828125});
    s = hn::MulAdd(r, Const(d, 6.28318530717958623),
                   hn::Mul(r, hn::MulAdd(y, p, Const(d, 2.4492935982947064e-16))));
    c = Polynomial(
        d, y,
        {1, -19.73920880217871598460988025180995464324951171875,
         64.939394022666732553261681459844112396240234375, -85.45681720597877983891521580517292022705078125,
         60.24464120865024341355820070020854473114013671875, -26.42623622542015482395072467625141143798828125,
         7.902082880912221440894427360035479068756103515625,
         -1.660302315941826645229184578056447207927703857421875,
         -0.5434452619824003960502523113973438739776611328125});
  }
}

// sin(2 pi u), cos(2 pi u) for |u| < 2^21 (2^50 in double) from SinCosOfEighth; `odd`: they changed places.
template <class D>
HWY_INLINE void TurnSinCos(D d, Vec<D> q, Vec<D> s, Vec<D> c, Vec<D>& sin, Vec<D>& cos, hn::Mask<D>& odd) {
  const hn::RebindToSigned<D> di;
  // Quarter turns: odd ones swap, 2 and 3 negate the sine, 1 and 2 the cosine.
  const auto qi = ToInteger(di, q);
  using I = hn::TFromD<decltype(di)>;
  constexpr int kSign = sizeof(I) * 8 - 2;
  const auto one = hn::Set(di, I{1}), two = hn::Set(di, I{2});
  odd = hn::MaskFromVec(hn::BitCast(d, hn::VecFromMask(di, hn::Eq(hn::And(qi, one), one))));
  const auto sin_sign = hn::BitCast(d, hn::ShiftLeft<kSign>(hn::And(qi, two)));
  const auto cos_sign = hn::BitCast(d, hn::ShiftLeft<kSign>(hn::And(hn::Add(qi, one), two)));
  sin = hn::Xor(hn::IfThenElse(odd, c, s), sin_sign);
  cos = hn::Xor(hn::IfThenElse(odd, s, c), cos_sign);
}

template <Accuracy A, class D>
HWY_INLINE void SinCos2Pi(D d, Vec<D> u, Vec<D>& sin, Vec<D>& cos) {
  Vec<D> q, s, s_tail, c, c_tail;
  hn::Mask<D> odd;
  SinCosOfEighth<A>(d, u, q, s, s_tail, c, c_tail);
  TurnSinCos(d, q, s, c, sin, cos, odd);
}

// atan2(sine, cosine) of numbers of which neither is below 0, as turns pi/4 + atan(slope), |slope| <= sqrt(2)
// - 1; 0 where both are 0.
template <class D>
HWY_INLINE void SlopeOfAngle(D d, Vec<D>& slope, Vec<D>& turns, Vec<D> sine, Vec<D> cosine) {
  const auto steep = hn::Gt(sine, cosine);
  const Vec<D> high = hn::IfThenElse(steep, sine, cosine), low = hn::IfThenElse(steep, cosine, sine);
  const auto middle = hn::Gt(low, hn::Mul(high, Const(d, 0.41421356237309505)));
  const Vec<D> rise = hn::IfThenElse(middle, hn::Sub(low, high), low);
  const Vec<D> run = hn::IfThenElse(middle, hn::Add(low, high), high);
  const Vec<D> ratio = ZeroIf(hn::Eq(run, hn::Zero(d)), hn::Div(rise, run));
  const Vec<D> eighth = hn::IfThenElseZero(middle, Const(d, 1));
  // From the quadrant's other axis.
  slope = hn::IfThenElse(steep, hn::Neg(ratio), ratio);
  turns = hn::IfThenElse(steep, hn::Sub(Const(d, 2), eighth), eighth);
}

// turns pi/4 + atan(slope), |slope| <= sqrt(2) - 1.
template <Accuracy A, class D>
HWY_INLINE Vec<D> AngleOfSlope(D d, Vec<D> slope, Vec<D> turns) {
  const Vec<D> y = hn::Mul(slope, slope);
  Vec<D> p;
  if constexpr (A == Accuracy::kFast) {
    // sollya: fpminimax((atan(sqrt(x))/sqrt(x)-1)/x, 2, [|24...|], [1b-60;0.17158], absolute): 2^-18.7 of
    // atan
    p = Polynomial(
        d, y, {-0.333319842815399169921875, 0.19852156937122344970703125, -0.118430100381374359130859375});
  } else if constexpr (kIsFloat<D>) {
    // as above, degree 4: 2^-28.1
    p = Polynomial(d, y,
                   {-0.333333313465118408203125, 0.1999951899051666259765625, -0.1426365375518798828125,
                    0.1074220836162567138671875, -6.44957125186920166015625e-2});
  } else {
    // as above, degree 11, [|53...|]: 2^-58.1
    p = Polynomial(d, y,
                   {-0.333333333333333314829616256247390992939472198486328125,
                    0.1999999999999892141833157666042097844183444976806640625,
                    -0.142857142855268237635613104430376552045345306396484375,
                    0.1111111109590250112244547153750318102538585662841796875,
                    -9.090908395633819083503368574383785016834735870361328125e-2,
                    7.6922879147082456885442525162943638861179351806640625e-2,
                    -6.66629638432653937041294510800515465438365936279296875e-2,
                    5.877649178449824429737446962462854571640491485595703125e-2,
                    -5.2221412931610811103411151634645648300647735595703125e-2,
                    4.5176799880734384851077578559852554462850093841552734375e-2,
                    -3.378176842132794843731602441039285622537136077880859375e-2,
                    1.54879053811577856170078604236550745554268360137939453125e-2});
  }
  const Vec<D> atan = hn::MulAdd(hn::Mul(slope, y), p, slope);
  // pi/4 in two parts.
  return hn::MulAdd(turns, Const(d, kIsFloat<D> ? 0.785398185253143310546875 : 0.78539816339744828),
                    hn::MulAdd(turns, Const(d, kIsFloat<D> ? -2.18556941e-8 : 3.06161699786838e-17), atan));
}

// Azimuths' difference from the sine and cosine of plane vectors: phi = turns pi/4 + atan(slope), where
// products of floats are exact in double lanes.
struct AzimuthDifferenceOp {
  template <class DD>
  static HWY_INLINE void Run(DD dd, Vec<DD>& slope, Vec<DD>& turns, Vec<DD> ax, Vec<DD> ay, Vec<DD> bx,
                             Vec<DD> by) {
    Vec<DD> p, p_tail, q, q_tail;
    TwoProduct(dd, ax, by, p, p_tail);
    TwoProduct(dd, ay, bx, q, q_tail);
    const Vec<DD> sine = hn::Abs(hn::Add(hn::Sub(p, q), hn::Sub(p_tail, q_tail)));
    const Vec<DD> dot = hn::MulAdd(ax, bx, hn::Mul(ay, by));
    SlopeOfAngle(dd, slope, turns, sine, hn::Abs(dot));
    // From the other half turn.
    const auto behind = hn::Lt(dot, hn::Zero(dd));
    slope = hn::IfThenElse(behind, hn::Neg(slope), slope);
    turns = hn::IfThenElse(behind, hn::Sub(Const(dd, 4), turns), turns);
  }
};

// The angle in [0, pi] between the azimuths of (ax, ay) and (bx, by); 0 where either vector is 0.
template <Accuracy A, class D>
HWY_INLINE Vec<D> AzimuthDifference(D d, Vec<D> ax, Vec<D> ay, Vec<D> bx, Vec<D> by) {
  Vec<D> slope, turns;
  InDouble2<AzimuthDifferenceOp>(d, slope, turns, ax, ay, bx, by);
  return AngleOfSlope<A>(d, slope, turns);
}

// The factor Q(t) of 1 - sqrt(pi) a erfcx(a) = t^2 Q(t), t = 1/(1 + 0.3 a), for a >= 0: smooth and positive,
// so the product keeps its relative accuracy both where the left side tends to 1 and where it falls as 1/(2
// a^2).
template <Accuracy A, class D>
HWY_INLINE Vec<D> ErfcxDefectOverT2(D d, Vec<D> t) {
  const Vec<D> u = hn::Sub(t, Const(d, 0.5));
  // sollya: fpminimax(h, n, [|24...|], [1/(1+0.3*32)-0.5; 0.5], relative), x = t - 1/2, a =
  // (1/(x+0.5)-1)/0.3, h = (1 - sqrt(pi)*a*exp(a^2)*erfc(a))/(x+0.5)^2. n = 6: 2^-13.8; 11: 2^-26.0; 23
  // ([|53...|]): 2^-58.
  if constexpr (A == Accuracy::kFast) {
    return Polynomial(
        d, u,
        {0.15991902351379394531, 0.50528323650360107421, 1.01261687278747558593, 1.50253736972808837890,
         1.66112601757049560546, 1.18941855430603027343, 0.35511824488639831542});
  } else if constexpr (kIsFloat<D>) {
    return Polynomial(d, u,
                      {0.15992057323455810546, 0.50547331571578979492, 1.01295614242553710937,
                       1.49464774131774902343, 1.64550137519836425781, 1.26388192176818847656,
                       0.49650272727012634277, -0.18230207264423370361, -0.35347989201545715332,
                       -8.64281132817268371582e-2, 0.12273683398962020874, 5.88537827134132385253e-2});
  } else {
    return Polynomial(
        d, u, {0.1599205735508623,    0.5054733181831186,    1.012956586972307,    1.4946491849556878,
               1.6454699745495296,    1.2637903546370086,    0.4972037245253817,   -0.1805243532248227,
               -0.3603990984405766,   -0.10109790510108742,  0.15522535356316522,  0.11337103549662786,
               -0.0652487339701891,   -0.08501314322562978,  0.033689121588146576, 0.06047603115585666,
               -0.02477833422946185,  -0.04229037271195809,  0.02318471639553396,  0.026310067724108672,
               -0.020470189051618255, -0.010159721248863957, 0.01105217126668251,  -0.0006755781710294431});
  }
}

// 1 - sqrt(pi) a erfcx(a). Float lanes lose bits of a small a in t = 1 - 0.3 a + ...
struct ErfcxDefectOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& y, Vec<D>& unused, Vec<D> a) {
    const Vec<D> one = Const(d, 1), t = hn::Div(one, hn::MulAdd(a, Const(d, 0.3), one));
    y = unused = hn::Mul(hn::Mul(t, t), ErfcxDefectOverT2<A>(d, t));
  }
};

// u below 1, for the total functions of the samplers; NaN passes.
template <class D>
HWY_INLINE Vec<D> BelowOne(D d, Vec<D> u) {
  const Vec<D> largest = Const(d, kIsFloat<D> ? 0x1.fffffep-1 : 0x1.fffffffffffffp-1);
  return hn::IfThenElse(hn::Gt(u, largest), largest, u);
}

// u of a uniform random number, counting as at least the smallest normal float, which no flush of subnormal
// numbers changes: what is infinite at 0 is finite there, and no tail that numbers of 24 or 32 bits reach is
// cut. NaN passes.
template <class D>
HWY_INLINE Vec<D> FromTiny(D d, Vec<D> u) {
  const Vec<D> least = Const(d, 0x1p-126);
  return hn::IfThenElse(hn::Lt(u, least), least, u);
}

// erfcx(x) = e^(x^2) erfc(x) for x >= 0, as t P(t) with t = 1/(1 + 0.4 x): smooth and positive down to its
// limit 1/(sqrt(pi) x).
template <Accuracy A, class D>
HWY_INLINE Vec<D> Erfcx(D d, Vec<D> x) {
  const Vec<D> one = Const(d, 1);
  const Vec<D> t = RefinedReciprocal<A>(d, hn::MulAdd(x, Const(d, 0.4), one));
  // sollya: y = (1/x-1)/0.4; fpminimax(exp(y^2)*erfc(y)/x, n, [|24...|], [1/(1+32*0.4);1], relative), n = 6:
  // 2^-17.8, 10: 2^-27.4; x = t - 1/2, 24 ([|53...|]): 2^-55
  if constexpr (A == Accuracy::kFast) {
    return hn::Mul(t, SplitPolynomial(d, t,
                                      {0.225689024, 0.225437433, 0.208350003, 0.177913621, 0.0745333062,
                                       0.18193388, -0.0938617364}));
  } else if constexpr (kIsFloat<D>) {
    return hn::Mul(t,
                   SplitPolynomial(d, t,
                                   {0.225676, 0.225670069, 0.20769456, 0.171137556, 0.121694066, 0.0763078928,
                                    -0.0328899249, 0.120872512, -0.22311528, 0.135212198, -0.0282596555}));
  } else {
    return hn::Mul(
        t,
        SplitPolynomial(
            d, hn::Sub(t, Const(d, 0.5)),
            {0.42161272812228717,     0.64372147955131909,    0.72626258663694887,   0.5480036647873594,
             0.18151392084552104,     -0.10743096707358327,   -0.1233609094524223,   0.022487463397575187,
             0.071955839878170988,    -0.011941440331481864,  -0.046123009175867348, 0.016000728577680663,
             0.029892818711005451,    -0.022130155723784621,  -0.015299554592772891, 0.025693142588432555,
             -3.8424790059092804e-05, -0.023249979307561671,  0.013829187757694357,  0.013604795894293413,
             -0.019802578870377972,   -0.0015478527325451048, 0.01352635002469703,   -0.0032382219352775432,
             -0.0027006739659174569}));
  }
}

// The same on its own. Float lanes lose bits of a small x in t.
struct ErfcxOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& y, Vec<D>& unused, Vec<D> x) {
    y = unused = Erfcx<A>(d, x);
  }
};

// y = erfinv(2 u - 1), its sign that of u - 1/2, for u in [0, 1); u counts as at least 2^-126. With x = |2 u
// - 1| and s^2 = -log(1 - x^2), y/x is a polynomial of s^2 up to s^2 = 5, and y/(x s) one of 1/(1 + s)
// beyond.
template <Accuracy A, class D>
HWY_INLINE Vec<D> ErfInv(D d, Vec<D> u) {
  const Vec<D> one = Const(d, 1), half = Const(d, 0.5);
  u = FromTiny(d, BelowOne(d, u));
  const Vec<D> x = hn::Sub(u, half), w = hn::Sub(one, u);
  const Vec<D> s2 = hn::Neg(Log<A>(d, hn::Mul(hn::Mul(u, Const(d, 4)), w)));
  const Vec<D> s = CloseSqrt<A>(d, hn::Max(s2, hn::Zero(d)));
  const Vec<D> c = hn::Sub(s2, Const(d, 2.5));
  const Vec<D> v = hn::Sub(RefinedReciprocal<A>(d, hn::Add(s, one)), Const(d, 0.2));
  // Chebyshev interpolation of erfinv(x)/x in s^2 - 2.5 on [0, 5], degrees 5: 2^-14.9, 11: 2^-23.7, 25:
  // 2^-54.3; of erfinv(x)/(x s) in 1/(1 + s) - 0.2 for s up to 9.3, degrees 5: 2^-15.1, 12: 2^-24.0.
  Vec<D> centre, tail;
  if constexpr (A == Accuracy::kFast) {
    centre = Polynomial(
        d, c, {1.50138462, 0.246643215, -0.00410591252, -0.0012612415, 0.000187412908, -1.17246111e-06});
    tail = Polynomial(d, v, {0.959973037, -0.309344977, -0.234213695, 1.92677879, 16.6557159, 116.609673});
  } else {
    tail = Polynomial(d, v,
                      {0.959945917, -0.309667677, -0.190131485, 2.1654501, 4.86242723, 58.6711388, 942.995605,
                       7094.51709, -10951.8125, -430484.625, -1058572.88, 8720677, 34251876});
    if constexpr (kIsFloat<D>) {
      centre = Polynomial(
          d, c,
          {1.50140929, 0.24664028, -0.00417732494, -0.00125270791, 0.000218264118, -4.99599992e-06,
           -3.42626618e-06, 4.78689685e-07, 1.65036447e-08, -1.08617613e-08, 4.34062675e-10, 1.23465765e-10});
    } else {
      centre = Polynomial(
          d, c,
          {1.501409351110792,       0.246640276744167,       -0.0041773177243836267,  -0.0012527079078108632,
           0.00021825026434410554,  -4.9960795995576159e-06, -3.4166195967501582e-06, 4.7872521989902983e-07,
           1.3416804111154447e-08,  -1.0861170431995838e-08, 9.0730326958716992e-10,  1.1960798667790424e-10,
           -3.110253901893291e-11,  9.1113312846659112e-13,  5.3553063644565966e-13,  -7.6001879150543628e-14,
           -2.8526692598750598e-15, 1.8727286000199051e-15,  -1.4170554303333301e-16, -2.3812487620808927e-17,
           5.4805033357619391e-18,  -6.4621808612046553e-20, -1.0545798226936863e-19, 1.0036550555220893e-20,
           1.0170247759811024e-21,  -1.7255492952198284e-22});
    }
  }
  const Vec<D> twice = hn::Add(x, x);
  tail = hn::Mul(tail, s);
  if constexpr (!kIsFloat<D>) {
    // A step of Halley's method on erfc(y) = p, y > 0, leaves the square of what is missing times 2^-48.
    const Vec<D> p = hn::Mul(Const(d, 2), hn::Min(u, w)), y = hn::Mul(hn::Abs(twice), tail);
    Vec<D> y2, y2_tail;
    TwoProduct(d, y, y, y2, y2_tail);
    const Vec<D> rest =
        hn::Mul(hn::Sub(Erfcx<A>(d, y), ExpTimes<A>(d, y2, y2_tail, p)), Const(d, 0.88622692545275801));
    const Vec<D> better = hn::Add(y, hn::Div(rest, hn::NegMulAdd(y, rest, one)));
    return hn::IfThenElse(hn::Gt(s2, Const(d, 5)), hn::CopySign(better, x), hn::Mul(twice, centre));
  }
  return hn::Mul(twice, hn::IfThenElse(hn::Gt(s2, Const(d, 5)), tail, centre));
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_MATH_INL_H_
