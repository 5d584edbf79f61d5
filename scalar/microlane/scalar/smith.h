// Smith's masking and joint masking-shadowing, from a distribution's Lambda.
#ifndef MICROLANE_SCALAR_SMITH_H_
#define MICROLANE_SCALAR_SMITH_H_

#include <cmath>

#include "microlane/scalar/direction.h"

namespace microlane::scalar {

enum class Masking {
  kHeightCorrelated,  // G2 = 1 / (1 + Lambda_i + Lambda_o), Heitz 2014 Eq. 99
  kSeparable,         // G2 = G1(i) G1(o), Walter 2007 Eq. 23
};

// A distribution gives scale |v.n| Lambda(v) in double: at grazing |v.n| Lambda stays finite where Lambda
// leaves the range of Real, and products with |v.n| fall below it.

// v.n, for a surface that slopes along its macrosurface.
template <class Distribution, class Real>
double Cosine(const Distribution&, const Vec3<Real>& v) {
  return v.z;
}

// Largest finite number at v.n = 0; 0 at normal incidence and for the zero vector.
template <class Distribution, class Real>
Real Lambda(const Distribution& distribution, const Vec3<Real>& v) {
  if (AnyNan(distribution, v)) return kNan<Real>;
  return Saturate<Real>(distribution.ScaledLambda(v, 1.0 / std::abs(Cosine(distribution, v))));
}

// chi+((v.m)/(v.n)) / (1 + Lambda(v)), Heitz 2014 Eq. 80.
template <class Distribution, class Real>
Real G1(const Distribution& distribution, const Vec3<Real>& v, const Vec3<Real>& m) {
  if (AnyNan(distribution, v, m)) return kNan<Real>;
  const double cosine = Cosine(distribution, v), cos_v = std::abs(cosine);
  if (!SidesAgree(Dot(Widen(v), Widen(m)), cosine)) return 0;
  return static_cast<Real>(cos_v / (cos_v + distribution.ScaledLambda(v, 1)));
}

// G1(v, m) |v.m| D(m) / |v.n|, Heitz 2014 Eq. 16, with |v.n| (1 + Lambda) formed at once: finite at grazing.
// v.n = 0 counts as above the surface.
template <class Distribution, class Real>
Real DVisible(const Distribution& distribution, const Vec3<Real>& v, const Vec3<Real>& m) {
  if (AnyNan(distribution, v, m)) return kNan<Real>;
  const double cosine = Cosine(distribution, v), v_m = Narrow<double>(Dot(Widen(v), Widen(m)));
  const double facing = cosine < 0 ? -v_m : v_m;
  if (!(facing > 0)) return 0;
  return Saturate<Real>(
      distribution.DTimes(m, facing / (std::abs(cosine) + distribution.ScaledLambda(v, 1))));
}

// G2(wi, wo) / |wi.n| for wi.n, wo.n != 0, sidedness left to the caller.
template <Masking masking, template <class> class Distribution, class Real>
double G2OverCos(const Distribution<Real>& distribution, const Vec3<Real>& wi, const Vec3<Real>& wo) {
  const double cos_i = std::abs(wi.z);
  const double visible = cos_i + distribution.ScaledLambda(wi, 1);
  if constexpr (masking == Masking::kSeparable) {
    return 1 / (visible * (1 + distribution.ScaledLambda(wo, 1.0 / std::abs(wo.z))));
  }
  return 1 / (visible + distribution.ScaledLambda(wo, cos_i / std::abs(wo.z)));
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_SMITH_H_
