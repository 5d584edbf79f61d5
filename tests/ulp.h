// Real-valued error in units in the last place of T (float or double).
#ifndef MICROLANE_TESTS_ULP_H_
#define MICROLANE_TESTS_ULP_H_

#include <algorithm>
#include <cmath>
#include <limits>

#include "oracle/real.h"

namespace microlane {

namespace ulp_internal {

// floor(log2 |x|) of a finite x that is not 0.
inline long Exponent(const oracle::Real& x) { return mpfr_get_exp(x.backend().data()) - 1; }

}  // namespace ulp_internal

// |got - exact| / ulp(scale), where ulp(s) = 2^(max(floor(log2 |s|), emin) - p + 1): p bits of significand,
// emin the exponent of the smallest normal, so that subnormals and 0 share the subnormal spacing.
//
// - exact NaN: 0 if got is NaN, else infinite. Any other exact: infinite if got is NaN.
// - exact beyond the largest finite number, or infinite: judged as that number with its sign, scale
//   reduced by the same power of two; an infinite got of that sign counts as that number too.
// - got infinite otherwise: infinite.
// - scale infinite for an exact in range (no digit is determined): 0.
// - The sign of a zero is not looked at.
template <class T>
double UlpError(T got, const oracle::Real& exact, const oracle::Real& scale) {
  using Limits = std::numeric_limits<T>;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  constexpr long kMinExponent = Limits::min_exponent - 1;
  constexpr long kMaxExponent = Limits::max_exponent - 1;
  using ulp_internal::Exponent;

  if (isnan(exact)) return std::isnan(got) ? 0 : kInfinity;
  if (std::isnan(got)) return kInfinity;
  const bool overflow = abs(exact) > Limits::max();
  const T largest = exact < 0 ? Limits::lowest() : Limits::max();
  if (std::isinf(got)) {
    if (!overflow || std::signbit(got) != std::signbit(largest)) return kInfinity;
    got = largest;
  }
  oracle::Real error = static_cast<double>(got) - (overflow ? oracle::Real(largest) : exact);
  if (error == 0) return 0;

  long exponent = kMinExponent;
  if (isinf(scale)) {
    if (!overflow) return 0;
    exponent = kMaxExponent;
  } else if (isnan(scale)) {
    return kInfinity;
  } else if (scale != 0) {
    exponent = Exponent(scale);
    if (overflow) exponent -= Exponent(exact) - kMaxExponent;
    exponent = std::max(exponent, kMinExponent);
  }
  mpfr_mul_2si(error.backend().data(), error.backend().data(), Limits::digits - 1 - exponent, MPFR_RNDN);
  return std::abs(static_cast<double>(error));
}

// As above in units of the exact value's own last place.
template <class T>
double UlpError(T got, const oracle::Real& exact) {
  return UlpError(got, exact, exact);
}

// exact rounded to T, to nearest and ties to even, subnormals included; infinite beyond the largest number.
template <class T>
T Rounded(const oracle::Real& exact);
template <>
inline float Rounded<float>(const oracle::Real& exact) {
  return mpfr_get_flt(exact.backend().data(), MPFR_RNDN);
}
template <>
inline double Rounded<double>(const oracle::Real& exact) {
  return mpfr_get_d(exact.backend().data(), MPFR_RNDN);
}

// Whether got is exact rounded to nearest. NaN matches NaN, zeros match whatever their sign, and the largest
// finite number matches what rounds to infinity.
template <class T>
bool CorrectlyRounded(T got, const oracle::Real& exact) {
  const T rounded = Rounded<T>(exact);
  if (std::isnan(rounded)) return std::isnan(got);
  if (std::isinf(rounded) && std::isfinite(got)) {
    return got == (rounded < 0 ? std::numeric_limits<T>::lowest() : std::numeric_limits<T>::max());
  }
  return got == rounded;
}

}  // namespace microlane

#endif  // MICROLANE_TESTS_ULP_H_
