// Smith's masking and joint masking-shadowing, from a distribution's Lambda.
#ifndef MICROLANE_SCALAR_SMITH_H_
#define MICROLANE_SCALAR_SMITH_H_

#include <cmath>

#include "microlane/scalar/direction.h"

namespace microlane::scalar {

enum class Masking {
  kHeightCorrelated,  // G2 = 1 / (1 + Lambda_i + Lambda_o), Heitz 2014 Eq. 99
  kSeparable,         // G2 = G1(i) G1(o), Walter 2007 Eq. 23
  kKelemen,           // G2 = 4 hz |iz| |oz| / |i + o|^2, Kelemen 2001 Eq. 3
  kVCavity,           // G2 = min(1, 2 hz |iz| / i.h, 2 hz |oz| / o.h), Cook and Torrance 1982
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

// A visible normal with v_m = |v.m|.
struct VisibleNormal {
  SampledNormal<double> normal;
  double v_m;
};

// A direction into which the ideal mirror reflects wi about a visible normal; all 0 where it is not on wi's
// side.
struct SampledReflection {
  Vec3<double> wo;
  double weight, pdf, lobe;
  double v_m;  // |wi.m|
};

// Walter 2007 Eqs. 14 and 39 about m of SampleVisibleNormal. weight = f |cos| / pdf = G2/G1 times the share
// of the visible normals that are drawn from, where F, D and the Jacobian are gone: (|wi.n| (1 + Lambda_i)) /
// (|wi.n| (1 + Lambda_i + Lambda_o)), or G1(wo).
template <Masking masking = Masking::kHeightCorrelated, template <class> class Distribution, class Real>
SampledReflection SampleVisibleReflection(const Distribution<Real>& distribution, const Vec3<Real>& wi,
                                          double u1, double u2, bool bounded) {
  const auto [normal, v_m] = distribution.SampleFacing(wi, u1, u2, bounded);
  if (AnyNan(normal.m)) return {normal.m, kNan<double>, kNan<double>, kNan<double>, v_m};
  const double side = Side(wi);
  const Vec3<double> v{side * wi.x, side * wi.y, side * wi.z};
  const Vec3<double> wo = (2 * Dot(v, normal.m)) * normal.m - v;  // of the length of v
  if (!(wo.z > 0)) return {{0, 0, 0}, 0, 0, 0, v_m};
  const bool separable = masking == Masking::kSeparable;
  const double cos_i = separable ? 1 : v.z + distribution.ScaledLambda(wi, 1);  // times Lambda_o's factor
  const double lambda_o = Distribution<double>{distribution.alpha_x, distribution.alpha_y}.ScaledLambda(
      wo, (separable ? 1 : v.z) / wo.z);
  return {side * wo, distribution.ShareOfVisible(wi, bounded) * cos_i / (cos_i + lambda_o),
          normal.pdf / (4 * v_m), 1, v_m};
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_SMITH_H_
