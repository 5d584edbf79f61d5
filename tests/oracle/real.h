// The oracle's number and vector types.
#ifndef MICROLANE_TESTS_ORACLE_REAL_H_
#define MICROLANE_TESTS_ORACLE_REAL_H_

#include <boost/multiprecision/mpfr.hpp>
#include <limits>

namespace microlane::oracle {

// 447 bits, seven limbs, no heap. Sums and products of a few floats, subnormals included, are exact or
// nearly so, hence the printed formulas lose nothing that a double could show to cancellation.
using Real = boost::multiprecision::number<
    boost::multiprecision::mpfr_float_backend<134, boost::multiprecision::allocate_stack>,
    boost::multiprecision::et_off>;

inline const Real& Pi() {
  static const Real pi = [] {
    Real value;
    mpfr_const_pi(value.backend().data(), MPFR_RNDN);
    return value;
  }();
  return pi;
}

inline const Real& SqrtPi() {
  static const Real sqrt_pi = sqrt(Pi());
  return sqrt_pi;
}

// std::numeric_limits<Real>::infinity() of Boost 1.74 fills a static without a lock: another thread may see
// 0.
inline Real Infinity() { return std::numeric_limits<double>::infinity(); }

inline Real Square(const Real& x) { return x * x; }

// sign(0) = 1.
inline int Sign(const Real& x) { return x < 0 ? -1 : 1; }

// A direction in the shading frame, used as given: never normalised behind the caller's back.
struct Vec {
  Real x, y, z;
};

inline Real Dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Vec operator+(const Vec& a, const Vec& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec operator-(const Vec& a, const Vec& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec operator-(const Vec& a) { return {-a.x, -a.y, -a.z}; }
inline Vec operator*(const Real& s, const Vec& a) { return {s * a.x, s * a.y, s * a.z}; }

inline bool IsZero(const Vec& a) { return a.x == 0 && a.y == 0 && a.z == 0; }

// a / |a|, and 0 for a = 0.
inline Vec Normalized(const Vec& a) {
  if (IsZero(a)) return a;
  return (1 / sqrt(Dot(a, a))) * a;
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_REAL_H_
