// Opaque rough surfaces, over any distribution of normals that rough_dielectric.h takes: Walter 2007 Eq. 20.
#ifndef MICROLANE_SCALAR_ROUGH_REFLECTOR_H_
#define MICROLANE_SCALAR_ROUGH_REFLECTOR_H_

#include <algorithm>
#include <cmath>
#include <type_traits>

#include "microlane/scalar/direction.h"
#include "microlane/scalar/fresnel.h"
#include "microlane/scalar/half_vector.h"
#include "microlane/scalar/masking.h"
#include "microlane/scalar/rough_dielectric.h"
#include "microlane/scalar/smith.h"

namespace microlane::scalar {

// What facets reflect, as a function of the squared cosine cos2 = (wi.m)^2.
template <class Real>
struct MirrorFacets {
  double Reflectance(Wide<Real>) const { return 1; }
  bool NeedsDigits(Wide<Real>) const { return false; }
  MirrorFacets<double> Widened() const { return {}; }
};
template <class Real>
bool IsNan(const MirrorFacets<Real>&) {
  return false;
}

template <class Real>
struct ConductorFacets {
  Real n, kappa;

  double Reflectance(Wide<Real> cos2) const { return FresnelConductor<Real>(cos2, n, kappa).Reflectance(); }
  // Whether double has too few digits of cos2 for float: what a function of it cancels to.
  bool NeedsDigits(Wide<Real> cos2) const {
    return FresnelConductor<Real>(cos2, n, kappa).near_critical_angle();
  }
  ConductorFacets<double> Widened() const { return {n, kappa}; }
};
template <class Real>
bool IsNan(const ConductorFacets<Real>& facets) {
  return AnyNan(facets.n, facets.kappa);
}

template <class Real>
struct SchlickFacets {
  Real f0;

  // 1 - c = s^2/(1 + c).
  double Reflectance(Wide<Real> cos2) const {
    return FresnelSchlick(Narrow<double>(Wide<Real>(1) - cos2) / (1 + std::sqrt(Narrow<double>(cos2))), f0);
  }
  bool NeedsDigits(Wide<Real> cos2) const { return Narrow<double>(Wide<Real>(1) - cos2) < 0x1p-16; }
  SchlickFacets<double> Widened() const { return {f0}; }
};
template <class Real>
bool IsNan(const SchlickFacets<Real>& facets) {
  return IsNan(facets.f0);
}

template <template <class> class Distribution, template <class> class Facets, class Real,
          Masking masking = Masking::kHeightCorrelated>
struct RoughReflector {
  Distribution<Real> distribution;
  Facets<Real> facets;

  // f |wo.n|.
  Real Eval(const Vec3<Real>& wi, const Vec3<Real>& wo) const {
    if (AnyNan(wi, wo, distribution, facets)) return kNan<Real>;
    return Eval(wi, wo, FindFacet(wi, wo, Real(1)));
  }

  // With the density of wo for D cos sampling of normals, Walter 2007 Eqs. 24 and 38.
  EvalPdf<Real> EvalAndPdf(const Vec3<Real>& wi, const Vec3<Real>& wo) const {
    return EvalAndPdf(wi, wo, [](const Facet<Real>& facet) { return facet.DensityFactor(); });
  }
  // With that for sampling of visible normals.
  EvalPdf<Real> EvalAndPdfVisible(const Vec3<Real>& wi, const Vec3<Real>& wo) const {
    return EvalAndPdf(
        wi, wo, [&](const Facet<Real>& facet) { return VisibleDensityFactor(distribution, wi, facet); });
  }
  // With that for sampling of the normals that V-cavities show: G1/(4 |wi.n|) of Heitz 2014 Eq. 49.
  EvalPdf<Real> EvalAndPdfVCavity(const Vec3<Real>& wi, const Vec3<Real>& wo) const {
    return EvalAndPdf(wi, wo, [&](const Facet<Real>& facet) {
      const double cos_i = std::abs(wi.z);
      return std::min(1.0, 2 * facet.cos_h * cos_i / facet.cos_i) / (4 * cos_i);
    });
  }

  // Walter 2007 section 5.3, with Eq. 41 for the weight.
  DirectionSample<Real> Sample(const Vec3<Real>& wi, Real u1, Real u2) const { return Sample(wi, u1, u2, 0); }
  // About normals that V-cavities show, with F G2/G1(wi) for the weight.
  DirectionSample<Real> SampleVCavity(const Vec3<Real>& wi, Real u1, Real u2, Real u3) const {
    static_assert(masking == Masking::kVCavity);
    return Sample(wi, u1, u2, u3);
  }

  // About visible normals, with F G2/G1(wi) for the weight.
  DirectionSample<Real> SampleVisible(const Vec3<Real>& wi, Real u1, Real u2) const {
    if (AnyNan(wi, u1, u2, distribution, facets)) {
      return {{kNan<Real>, kNan<Real>, kNan<Real>}, kNan<Real>, kNan<Real>, kNoLobe};
    }
    const SampledReflection sample = SampleVisibleReflection<masking>(distribution, wi, u1, u2, false);
    if (sample.lobe == 0) return {{0, 0, 0}, 0, 0, kNoLobe};
    const double weight = sample.weight * facets.Reflectance(Square(Wide<Real>(sample.v_m)));
    return {Narrow<Real>(sample.wo), Saturate<Real>(weight), Saturate<Real>(sample.pdf), kReflection};
  }

 private:
  // u3 chooses the facet of V-cavities.
  DirectionSample<Real> Sample(const Vec3<Real>& wi, Real u1, Real u2, Real u3) const {
    using W = Wide<Real>;
    constexpr DirectionSample<Real> none{{0, 0, 0}, 0, 0, kNoLobe};
    if (AnyNan(wi, u1, u2, u3, distribution, facets)) {
      return {{kNan<Real>, kNan<Real>, kNan<Real>}, kNan<Real>, kNan<Real>, kNoLobe};
    }
    if (wi.z == 0) return none;
    const SampledNormal<double> normal = [&] {
      if constexpr (masking == Masking::kVCavity) return scalar::SampleVCavity(distribution, wi, u1, u2, u3);
      if constexpr (masking != Masking::kVCavity) return distribution.SampleNormal(u1, u2);
    }();
    if (normal.m.z == 0) return none;
    const W side = Side(wi);
    const Vec3<W> m = side * Vec3<W>{normal.m.x, normal.m.y, normal.m.z}, wide_wi = Widen(wi);
    const W c = Dot(wide_wi, m);
    if (!(c > W(0))) return none;
    const Vec3<W> wo = Reflect(wide_wi, m);
    if (!(side * wo.z > W(0))) return none;
    DirectionSample<Real> sample{Narrow<Real>(wo), 0, 0, kReflection};
    const double cos_i = Narrow<double>(c);
    const double weight = [&] {
      if constexpr (masking == Masking::kVCavity) {
        const double of_i = std::min(cos_i, 2 * normal.m.z * std::abs(wi.z));
        return std::min(of_i, 2 * normal.m.z * std::abs(Narrow<double>(wo.z))) / of_i;
      } else if constexpr (masking == Masking::kKelemen) {
        return std::abs(Narrow<double>(wo.z)) / cos_i;
      } else {
        return SampledWeight<masking>(distribution, wi, sample.wo, cos_i, normal.m);
      }
    }();
    sample.weight = Saturate<Real>(weight * facets.Reflectance(c * c));
    sample.pdf = Saturate<Real>(normal.pdf / (4 * cos_i));
    return sample;
  }

  // density_factor: the density over D, from the facet.
  template <class DensityFactor>
  EvalPdf<Real> EvalAndPdf(const Vec3<Real>& wi, const Vec3<Real>& wo,
                           const DensityFactor& density_factor) const {
    if (AnyNan(wi, wo, distribution, facets)) return {kNan<Real>, kNan<Real>};
    const Facet<Real> facet = FindFacet(wi, wo, Real(1));
    if (facet.lobe != kReflection) return {0, 0};
    return {Eval(wi, wo, facet), Saturate<Real>(distribution.DOfHalf(facet.half, density_factor(facet)))};
  }

  Real Eval(const Vec3<Real>& wi, const Vec3<Real>& wo, const Facet<Real>& facet) const {
    if (facet.lobe != kReflection) return 0;
    double reflectance = facets.Reflectance(facet.cos2_i);
    if constexpr (std::is_same_v<Real, float>) {
      if (facets.NeedsDigits(facet.cos2_i)) {
        reflectance = facets.Widened().Reflectance(FindFacet(Widen(wi), Widen(wo), 1.0).cos2_i);
      }
    }
    const double masking_over_cos = [&] {
      if constexpr (masking == Masking::kVCavity) {
        const double of_i = std::abs(wi.z) / facet.cos_i, of_o = std::abs(wo.z) / facet.cos_o;
        return std::min(1.0, 2 * facet.cos_h * std::min(of_i, of_o)) / std::abs(wi.z);
      } else if constexpr (masking == Masking::kKelemen) {
        return 4 * facet.cos_h * (std::abs(wo.z) / Narrow<double>(facet.length2));
      } else {
        return G2OverCos<masking>(distribution, wi, wo);
      }
    }();
    const double factor = reflectance * masking_over_cos / 4;
    return Saturate<Real>(distribution.DOfHalf(facet.half, factor));
  }
};

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_ROUGH_REFLECTOR_H_
