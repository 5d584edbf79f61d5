// Directions in the shading frame, z along the normal. Used as given: nothing here normalises.
#ifndef MICROLANE_SCALAR_DIRECTION_H_
#define MICROLANE_SCALAR_DIRECTION_H_

#include "microlane/scalar/math.h"

namespace microlane::scalar {

// What flows along the path: refraction scales radiance by eta^2, and leaves importance alone.
enum class Transport { kRadiance, kImportance };

template <class T>
struct Vec3 {
  T x, y, z;
};

template <class T>
Vec3<T> operator+(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
template <class T>
Vec3<T> operator-(const Vec3<T>& a, const Vec3<T>& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
template <class T>
Vec3<T> operator-(const Vec3<T>& a) {
  return {-a.x, -a.y, -a.z};
}
template <class T>
Vec3<T> operator*(T s, const Vec3<T>& a) {
  return {s * a.x, s * a.y, s * a.z};
}
template <class T>
Vec3<T> operator/(const Vec3<T>& a, T s) {
  return {a.x / s, a.y / s, a.z / s};
}
template <class T>
T Dot(const Vec3<T>& a, const Vec3<T>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}

template <class Real>
Vec3<Wide<Real>> Widen(const Vec3<Real>& v) {
  return {v.x, v.y, v.z};
}
template <class Real, class T>
Vec3<Real> Narrow(const Vec3<T>& v) {
  return {Narrow<Real>(v.x), Narrow<Real>(v.y), Narrow<Real>(v.z)};
}

// A normal drawn from D cos. The samplers work in double: what is made of the normal afterwards, refraction
// near the critical angle above all, magnifies its rounding.
template <class Real>
struct SampledNormal {
  Vec3<Real> m;
  Real pdf;  // D(m) cos(theta_m)
};

template <class T>
bool IsNan(const Vec3<T>& v) {
  return AnyNan(v.x, v.y, v.z);
}

// sign(v.n), sign(0) = 1.
template <class Real>
Real Side(const Vec3<Real>& v) {
  return v.z < 0 ? Real(-1) : Real(1);
}

// chi+((v.m)/(v.n)), Walter 2007 Eq. 7: v on the same side of the microfacet and of the surface.
// v_dot_m is a Wide sum, so its sign is right where v grazes m.
template <class Real, class T>
bool SidesAgree(T v_dot_m, Real vz) {
  return (v_dot_m > T(0) && vz > 0) || (v_dot_m < T(0) && vz < 0);
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_DIRECTION_H_
