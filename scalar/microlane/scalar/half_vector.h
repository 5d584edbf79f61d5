// Half vectors, their Jacobians, and the mirror and refracted directions: Walter 2007 sections 4 and 5.3.
#ifndef MICROLANE_SCALAR_HALF_VECTOR_H_
#define MICROLANE_SCALAR_HALF_VECTOR_H_

#include <cmath>

#include "microlane/scalar/direction.h"

namespace microlane::scalar {

// sign(wi.n)(wi + wo), Walter 2007 Eq. 13. Not normalised; Wide, because it cancels where wo is near -wi.
template <class Real>
Vec3<Wide<Real>> ReflectionHalf(const Vec3<Real>& wi, const Vec3<Real>& wo) {
  return Wide<Real>(Side(wi)) * (Widen(wi) + Widen(wo));
}

// -(wi + eta wo), Walter 2007 Eq. 16 over eta_i. Cancels where eta is near 1.
template <class Real>
Vec3<Wide<Real>> RefractionHalf(const Vec3<Real>& wi, const Vec3<Real>& wo, Real eta) {
  return -(Widen(wi) + Wide<Real>(eta) * Widen(wo));
}

// half / |half|; 0 where it is 0.
template <class Real>
Vec3<Real> Normalized(const Vec3<Wide<Real>>& half) {
  const Wide<Real> length2 = Dot(half, half);
  if (Narrow<double>(length2) == 0) return {0, 0, 0};
  return Narrow<Real>((Wide<Real>(1) / Sqrt(length2)) * half);
}

// |o.h| / |half|^2, the first forms of Walter 2007 Eqs. 14 and 17 (17 without its eta^2).
template <class Real>
Wide<Real> HalfJacobian(const Vec3<Wide<Real>>& half, const Vec3<Real>& wo) {
  const Wide<Real> length2 = Dot(half, half);
  if (Narrow<double>(length2) == 0) return 0;
  const Wide<Real> jacobian = Dot(Widen(wo), half) / (length2 * Sqrt(length2));
  return jacobian < Wide<Real>(0) ? -jacobian : jacobian;
}

template <class Real>
Real ReflectionJacobian(const Vec3<Real>& wi, const Vec3<Real>& wo) {
  return Narrow<Real>(HalfJacobian(ReflectionHalf(wi, wo), wo));
}

template <class Real>
Real RefractionJacobian(const Vec3<Real>& wi, const Vec3<Real>& wo, Real eta) {
  return Narrow<Real>(Square(Wide<Real>(eta)) * HalfJacobian(RefractionHalf(wi, wo, eta), wo));
}

// 1 / (4 |o.h|), second form of Walter 2007 Eq. 14.
template <class Real>
Real ReflectionJacobianCos(Real cos_o) {
  return Saturate<Real>(1 / (4 * std::abs(cos_o)));
}

// eta^2 |o.h| / (i.h + eta o.h)^2, second form of Walter 2007 Eq. 17. Wide, because the
// sum cancels.
template <class Real>
Real RefractionJacobianCos(Real cos_i, Real cos_o, Real eta) {
  if (cos_o == 0) return AnyNan(cos_i, eta) ? cos_i + eta : Real(0);
  const Wide<Real> sum = MultiplyAdd(Wide<Real>(eta), Wide<Real>(cos_o), Wide<Real>(cos_i));
  if (Narrow<double>(sum) == 0) return kLargest<Real>;
  return Narrow<Real>(Square(Wide<Real>(eta) / sum) * Wide<Real>(std::abs(cos_o)));
}

// 2 (i.m) m - i, Walter 2007 Eq. 39 mended.
template <class T>
Vec3<T> Reflect(const Vec3<T>& wi, const Vec3<T>& m) {
  return (T(2) * Dot(wi, m)) * m - wi;
}

// Walter 2007 Eq. 40 with Walter's eta = 1/eta: ((c - side g) m - wi) / eta, g^2 = eta^2 - 1 + c^2, which
// cancels at the critical angle. 0 under total internal reflection. T is a Wide number.
template <class T>
Vec3<T> Refract(const Vec3<T>& wi, const Vec3<T>& m, T eta, T side) {
  const T c = Dot(wi, m);
  const T g2 = (eta - T(1)) * (eta + T(1)) + c * c;
  if (g2 < T(0)) return {T(0), T(0), T(0)};
  return ((c - side * Sqrt(g2)) * m - wi) / eta;
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_HALF_VECTOR_H_
