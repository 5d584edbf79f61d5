// Number types and the few functions the formulas need beyond <cmath>.
#ifndef MICROLANE_SCALAR_MATH_H_
#define MICROLANE_SCALAR_MATH_H_

#include <cmath>
#include <limits>
#include <type_traits>

namespace microlane::scalar {

template <class Real>
inline constexpr Real kPi = static_cast<Real>(3.14159265358979323846L);
template <class Real>
inline constexpr Real kSqrtPi = static_cast<Real>(1.77245385090551602730L);
template <class Real>
inline constexpr Real kLargest = std::numeric_limits<Real>::max();
template <class Real>
inline constexpr Real kNan = std::numeric_limits<Real>::quiet_NaN();

// The unevaluated sum hi + lo of two doubles, |lo| <= ulp(hi) / 2: about 106 bits.
// Joldes, Muller, Popescu 2017, "Tight and rigorous error bounds for basic building blocks of
// double-word arithmetic". lo is 0 where hi is not finite, so infinity does not turn into NaN.
struct DoubleDouble {
  double hi = 0;
  double lo = 0;

  constexpr DoubleDouble() = default;
  constexpr DoubleDouble(double x) : hi(x) {}  // NOLINT(google-explicit-constructor): a number type
  constexpr DoubleDouble(double high, double low) : hi(high), lo(low) {}
};

// Requires |a| >= |b| or a = 0.
inline DoubleDouble FastTwoSum(double a, double b) {
  const double sum = a + b;
  return {sum, std::isfinite(sum) ? b - (sum - a) : 0};
}

inline DoubleDouble TwoSum(double a, double b) {
  const double sum = a + b;
  const double part = sum - a;
  return {sum, std::isfinite(sum) ? (a - (sum - part)) + (b - part) : 0};
}

inline DoubleDouble TwoProduct(double a, double b) {
  const double product = a * b;
  return {product, std::isfinite(product) ? std::fma(a, b, -product) : 0};
}

inline DoubleDouble operator-(DoubleDouble a) { return {-a.hi, -a.lo}; }
inline DoubleDouble operator+(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble s = TwoSum(a.hi, b.hi);
  const DoubleDouble t = TwoSum(a.lo, b.lo);
  const DoubleDouble v = FastTwoSum(s.hi, s.lo + t.hi);
  return FastTwoSum(v.hi, t.lo + v.lo);
}
inline DoubleDouble operator-(DoubleDouble a, DoubleDouble b) { return a + -b; }
inline DoubleDouble operator*(DoubleDouble a, DoubleDouble b) {
  const DoubleDouble p = TwoProduct(a.hi, b.hi);
  return FastTwoSum(p.hi, p.lo + std::fma(a.lo, b.hi, a.hi * b.lo));
}
inline DoubleDouble operator/(DoubleDouble a, DoubleDouble b) {
  const double quotient = a.hi / b.hi;
  if (!std::isfinite(quotient)) return quotient;
  const DoubleDouble rest = a - b * quotient;
  return FastTwoSum(quotient, rest.hi / b.hi);
}
inline bool operator<(DoubleDouble a, DoubleDouble b) { return a.hi < b.hi || (a.hi == b.hi && a.lo < b.lo); }
inline bool operator>(DoubleDouble a, DoubleDouble b) { return b < a; }

inline double Sqrt(double x) { return std::sqrt(x); }
inline DoubleDouble Sqrt(DoubleDouble x) {
  const double root = std::sqrt(x.hi);
  if (!(root > 0) || !std::isfinite(root)) return root;
  const DoubleDouble rest = x - TwoProduct(root, root);
  return FastTwoSum(root, rest.hi / (2 * root));
}

inline double MultiplyAdd(double a, double b, double c) { return std::fma(a, b, c); }
inline DoubleDouble MultiplyAdd(DoubleDouble a, DoubleDouble b, DoubleDouble c) { return a * b + c; }

// A number with at least twice the digits of Real. Whatever cancels, or is multiplied by a large
// exponent, is formed in it and then rounded once: products of two Reals are exact in it.
template <class Real>
using Wide = std::conditional_t<std::is_same_v<Real, float>, double, DoubleDouble>;

// The largest finite number in place of infinity; NaN stays NaN.
template <class Real>
Real Saturate(double x) {
  constexpr double largest = kLargest<Real>;
  return static_cast<Real>(x > largest ? largest : x < -largest ? -largest : x);
}

// Rounds a Wide number to Real.
template <class Real>
Real Narrow(double x) {
  return Saturate<Real>(x);
}
template <class Real>
Real Narrow(DoubleDouble x) {
  return Saturate<Real>(x.hi);
}

template <class T>
T Square(T x) {
  return x * x;
}

// sqrt(a^2 + b^2) of numbers no larger or smaller than Real's: double holds the squares of floats.
template <class Real>
double Hypot(double a, double b) {
  if constexpr (std::is_same_v<Real, float>) return std::sqrt(a * a + b * b);
  return std::hypot(a, b);
}

inline bool IsNan(float x) { return std::isnan(x); }
inline bool IsNan(double x) { return std::isnan(x); }
inline bool IsNan(DoubleDouble x) { return std::isnan(x.hi); }

// Comparisons send NaN down one branch or the other, so a function that branches asks first.
template <class... T>
bool AnyNan(const T&... x) {
  return (IsNan(x) || ...);
}

// e^x.
template <class Real>
Real Exp(Real x) {
  return Saturate<Real>(std::exp(x));
}

// e^(hi + lo): the exponent's rounding error, which |x| would multiply, is carried.
inline double ExpWide(double x) { return std::exp(x); }
inline double ExpWide(DoubleDouble x) {
  const double y = std::exp(x.hi);
  return std::fma(y, x.lo, y);
}

// base^exponent. The base's low part is worth e^(exponent lo / hi): exponent * lo^2 / hi^2 is below
// one ULP for |exponent| < 2^52.
inline double Pow(DoubleDouble base, double exponent) {
  return std::pow(base.hi, exponent) * std::exp(exponent * (base.lo / base.hi));
}

// -log(1 - u), u in [0, 1); the largest finite number from 1 on.
template <class Real>
Real NegLog1m(Real u) {
  if (u >= 1) return kLargest<Real>;
  return -std::log1p(-u);
}

template <class Real>
struct SinCos {
  Real sin, cos;
};

template <class T>
constexpr T TwoPi() {
  if constexpr (std::is_same_v<T, DoubleDouble>) return {6.283185307179586, 2.4492935982947064e-16};
  return 6.283185307179586;
}

// sin(2 pi u), cos(2 pi u). The reduction to |r| <= 1/8 turn is exact, and the rounding error of
// 2 pi r is carried into first order.
template <class Real>
SinCos<Real> SinCos2Pi(Real u) {
  u -= std::floor(u);
  const Real quarter = std::floor(4 * u + Real(0.5));
  const Real r = u - quarter / 4;
  const Wide<Real> x = TwoPi<Wide<Real>>() * Wide<Real>(r);
  const Real hi = Narrow<Real>(x);
  const Real lo = Narrow<Real>(x - Wide<Real>(hi));
  const Real s0 = std::sin(hi);
  const Real c0 = std::cos(hi);
  const Real s = std::fma(lo, c0, s0);
  const Real c = std::fma(-lo, s0, c0);
  if (quarter == 1) return {c, -s};
  if (quarter == 2) return {-s, -c};
  if (quarter == 3) return {-c, s};
  return {s, c};
}

// y = 1 - sqrt(pi) a exp(a^2) erfc(a), the part of Smith's Lambda for Beckmann that cancels
// (Heitz 2014 Eq. 69): it falls like 1 / (2 a^2).
// y = 2/sqrt(pi) * integral of t^2 exp(-t^2) / (a^2 + t^2) over t > 0, by the trapezoidal rule of
// step h = 7/16 with the residue of the poles t = +-ia put back (Goodwin 1949; Matta and Reichel 1971). Every
// term is positive. What is left out is of the order of exp(-(pi/h)^2) = 4e-23, and so is the residue from
// a = pi/h on.
template <class Real>
Real ErfcxDefect(Real a) {
  // exp(-(k h)^2), k = 1, 2, ...
  constexpr double gauss[] = {
      8.25797039950100658873e-1,  4.65043188134056313034e-1,  1.78591134612435621905e-1,
      4.67706223839589836528e-2,  8.35281851808101350665e-3,  1.01727784361470065887e-3,
      8.44875602850465196059e-5,  4.78511739212900908961e-6,  1.84815787720480327733e-7,
      4.86779390210819835810e-9,  8.74323075473376093168e-11, 1.07092323825080764559e-12,
      8.94522745590463127740e-15, 5.09531546273744540318e-17, 1.97923521865490644076e-19};
  constexpr Real h = Real(7) / 16;
  constexpr int terms = std::is_same_v<Real, float> ? 10 : 15;
  if (std::abs(a) < std::numeric_limits<Real>::epsilon() / 8) return 1;
  if (a < 0)
    return Saturate<Real>(1 - double{kSqrtPi<Real>} * a * std::exp(double{a} * a) * std::erfc(double{a}));
  const Real a2 = a * a;
  Real sum = 0;
  for (int k = terms; k >= 1; --k) {
    const Real t2 = Square(static_cast<Real>(k) * h);
    sum += t2 * static_cast<Real>(gauss[k - 1]) / (a2 + t2);
  }
  sum *= 2 * h;
  if (a < kPi<Real> / h) sum += 2 * kPi<Real> * a * std::exp(a2) / std::expm1(2 * kPi<Real> / h * a);
  return sum / kSqrtPi<Real>;
}

// u of a uniform random number for what is infinite at 0 and 1: from the smallest normal float to the largest
// double below 1.
inline double InsideUnit(double u) { return u < 0x1p-126 ? 0x1p-126 : u < 1 ? u : 1 - 0x1p-53; }

// exp(x^2) erfc(x) for x >= 0, without their range and rounding where x is not small.
inline double Erfcx(double x) {
  if (x < 1) return std::exp(x * x) * std::erfc(x);
  return (1 - ErfcxDefect(x)) / (kSqrtPi<double> * x);
}

// exp(x^2), with the rounding error of x^2.
inline double ExpOfSquare(double x) { return ExpWide(TwoProduct(x, x)); }

// y = erfinv(2 u - 1): erfc(|y|) = p, the tail that u is in, by Halley's method. As a function of log p the
// tail is close to a parabola, and the iteration, which is monotonic after its first step, is within a
// rounding after four. Where p is near 1, y comes from 2 u - 1, which is exact.
inline double ErfInv(double u) {
  u = InsideUnit(u);
  const double x = 2 * (u - 0.5), p = 2 * (u < 0.5 ? u : 1 - u);
  double y = std::sqrt(-std::log(p));
  for (int i = 0; i < 8; ++i) {
    const double rest =
        y < 0.5 ? (std::abs(x) - std::erf(y)) * ExpOfSquare(y) : Erfcx(y) - p * ExpOfSquare(y);
    const double h = kSqrtPi<double> / 2 * rest;
    y += h / (1 - y * h);
  }
  return x < 0 ? -y : y;
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_MATH_H_
