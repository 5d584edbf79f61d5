// Fresnel reflectance of a dielectric, Walter 2007, Eq. 22, of a conductor, and Schlick's approximation. eta
// is the index of the transmitted over the incident side.
#ifndef MICROLANE_TESTS_ORACLE_FRESNEL_H_
#define MICROLANE_TESTS_ORACLE_FRESNEL_H_

#include "oracle/real.h"

namespace microlane::oracle {

// g^2 of Walter 2007, Eq. 22; negative under total internal reflection.
inline Real FresnelG2(const Real& c, const Real& eta) { return eta * eta - 1 + c * c; }

// Walter 2007, Eq. 22.
inline Real FresnelDielectric(const Real& cos_i, const Real& eta) {
  if (eta == 1) return 0;
  const Real c = abs(cos_i);
  const Real g2 = FresnelG2(c, eta);
  if (g2 < 0) return 1;
  const Real g = sqrt(g2);
  return Square((g - c) / (g + c)) / 2 * (1 + Square((c * (g + c) - 1) / (c * (g - c) + 1)));
}

// The part polarised across the plane of incidence: the first factor of Walter 2007, Eq. 22.
inline Real FresnelDielectricS(const Real& cos_i, const Real& eta) {
  if (eta == 1) return 0;
  const Real c = abs(cos_i);
  const Real g2 = FresnelG2(c, eta);
  if (g2 < 0) return 1;
  const Real g = sqrt(g2);
  return Square((g - c) / (g + c));
}

// The part polarised in the plane of incidence: both factors of Walter 2007, Eq. 22.
inline Real FresnelDielectricP(const Real& cos_i, const Real& eta) {
  if (eta == 1) return 0;
  const Real c = abs(cos_i);
  const Real g2 = FresnelG2(c, eta);
  if (g2 < 0) return 1;
  const Real g = sqrt(g2);
  return Square((eta * eta * c - g) / (eta * eta * c + g));
}

struct Complex {
  Real re, im;
};
inline Complex operator+(const Complex& a, const Complex& b) { return {a.re + b.re, a.im + b.im}; }
inline Complex operator-(const Complex& a, const Complex& b) { return {a.re - b.re, a.im - b.im}; }
inline Complex operator*(const Complex& a, const Complex& b) {
  return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re};
}
inline Real SquaredModulus(const Complex& a) { return a.re * a.re + a.im * a.im; }

// The root in the first quadrant, for im >= 0. The lesser part follows from im = 2 re(root) im(root), as
// Real's digits do not reach where kappa is subnormal.
inline Complex Root(const Complex& a) {
  const Real larger = sqrt((sqrt(SquaredModulus(a)) + abs(a.re)) / 2);
  if (larger == 0) return {0, 0};
  const Real lesser = a.im / (2 * larger);
  return a.re < 0 ? Complex{lesser, larger} : Complex{larger, lesser};
}

// g of a conductor, below.
inline Complex ConductorG(const Real& c, const Real& n, const Real& kappa) {
  const Complex index{n, kappa};
  return Root(index * index - Complex{1 - c * c, 0});
}

// r_s = (c - g)/(c + g) and r_p = (N^2 c - g)/(N^2 c + g) for N = n + i kappa, g = sqrt(N^2 - s^2), s^2 = 1 -
// c^2;
// (|r_s|^2 + |r_p|^2)/2.
inline Real FresnelConductor(const Real& cos_i, const Real& n, const Real& kappa) {
  if (n == 1 && kappa == 0) return 0;
  const Complex c{abs(cos_i), 0}, index{n, kappa}, index2 = index * index;
  const Complex g = ConductorG(c.re, n, kappa);
  const Real s = SquaredModulus(c - g) / SquaredModulus(c + g);
  const Real p = SquaredModulus(index2 * c - g) / SquaredModulus(index2 * c + g);
  return (s + p) / 2;
}

// Molenaar's r_e, Meneveaux 2015, Eq. 10, which is of n >= 1; from the denser side it is r_i of 1/n.
inline Real DiffuseFresnelExternal(const Real& n) {
  if (n == 1) return 0;
  if (n < 1) return 1 - (1 - DiffuseFresnelExternal(1 / n)) * n * n;
  const Real n2 = n * n, n4 = n2 * n2;
  return Real(1) / 2 - 2 * n * n2 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
         (n - 1) * (3 * n + 1) / (6 * Square(n + 1)) +
         8 * n4 * (n4 + 1) / ((n2 + 1) * Square(n4 - 1)) * log(n) +
         n2 * Square(n2 - 1) / (Square(n2 + 1) * (n2 + 1)) * log((n - 1) / (n + 1));
}
// r_i, Meneveaux 2015, Eq. 9, by n^2 (1 - r_i) = 1 - r_e.
inline Real DiffuseFresnelInternal(const Real& n) { return 1 - (1 - DiffuseFresnelExternal(n)) / (n * n); }

// k/(n^2 (1 - k r_i)), of Meneveaux 2015, Eq. 8.
inline Real BodyAlbedo(const Real& n, const Real& k) {
  return k / (n * n * (1 - k * DiffuseFresnelInternal(n)));
}

// f0 + (1 - f0)(1 - c)^5.
inline Real FresnelSchlick(const Real& cos_i, const Real& f0) {
  const Real x = 1 - abs(cos_i);
  return x > 0 ? f0 + (1 - f0) * pow(x, 5) : f0;
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_FRESNEL_H_
