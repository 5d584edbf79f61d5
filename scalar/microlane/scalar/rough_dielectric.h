// The rough dielectric of Walter 2007, over any distribution of normals that has D, DOfHalf, ScaledLambda
// and SampleNormal.
#ifndef MICROLANE_SCALAR_ROUGH_DIELECTRIC_H_
#define MICROLANE_SCALAR_ROUGH_DIELECTRIC_H_

#include <cmath>
#include <limits>
#include <type_traits>

#include "microlane/scalar/direction.h"
#include "microlane/scalar/fresnel.h"
#include "microlane/scalar/half_vector.h"
#include "microlane/scalar/smith.h"

namespace microlane::scalar {

enum Lobes : unsigned { kNoLobe = 0, kReflection = 1, kTransmission = 2, kBothLobes = 3 };

// The one microfacet normal h that scatters wi into wo. Wide, because transmission at eta near 1 subtracts
// nearly equal directions, and because c = |wi.h| is squared into g^2, which cancels at the critical angle.
template <class Real>
struct Facet {
  Lobes lobe = kNoLobe;
  Vec3<Wide<Real>> half;  // along h, half.z > 0, not normalised
  Wide<Real> length2;     // |half|^2
  Wide<Real> cos2_i;      // (wi.h)^2
  double cos_h;           // h.n
  double cos_i, cos_o;    // |wi.h|, |wo.h|

  // cos |dh/do| of Walter 2007 Eqs. 24 and 38, by the first forms of Eqs. 14 and 17 less eta^2.
  double DensityFactor() const { return cos_h * (cos_o / Narrow<double>(length2)); }
};

// kNoLobe where wi or wo grazes exactly or where a side of Walter 2007 Eq. 7 disagrees.
template <class Real>
Facet<Real> FindFacet(const Vec3<Real>& wi, const Vec3<Real>& wo, Real eta) {
  using W = Wide<Real>;
  Facet<Real> facet{};
  if (wi.z == 0 || wo.z == 0) return facet;
  const bool reflects = (wi.z > 0) == (wo.z > 0);
  facet.half = reflects ? ReflectionHalf(wi, wo) : RefractionHalf(wi, wo, eta);
  if (facet.half.z < W(0)) facet.half = -facet.half;
  if (!(facet.half.z > W(0))) return facet;
  const W i_dot = Dot(Widen(wi), facet.half);
  const W o_dot = Dot(Widen(wo), facet.half);
  if (!SidesAgree(i_dot, wi.z) || !SidesAgree(o_dot, wo.z)) return facet;
  facet.lobe = reflects ? kReflection : kTransmission;
  facet.length2 = Dot(facet.half, facet.half);
  facet.cos2_i = i_dot * i_dot / facet.length2;
  const double inverse = 1 / std::sqrt(Narrow<double>(facet.length2));
  facet.cos_h = Narrow<double>(facet.half.z) * inverse;
  facet.cos_i = std::abs(Narrow<double>(i_dot)) * inverse;
  facet.cos_o = std::abs(Narrow<double>(o_dot)) * inverse;
  return facet;
}

// Normals with density D cos, or D_v of those visible from wi, and their density.
template <bool visible, template <class> class Distribution, class Real>
SampledNormal<double> SampleFacetNormal(const Distribution<Real>& distribution, const Vec3<Real>& wi, Real u1,
                                        Real u2) {
  if constexpr (visible) return distribution.SampleVisibleNormal(wi, u1, u2);
  if constexpr (!visible) return distribution.SampleNormal(u1, u2);
}

// Walter 2007 Eq. 41 of the normal m, cos_i = |wi.m|; of visible normals G2/G1(wi).
template <Masking masking, bool visible = false, template <class> class Distribution, class Real>
double SampledWeight(const Distribution<Real>& distribution, const Vec3<Real>& wi, const Vec3<Real>& wo,
                     double cos_i, const Vec3<double>& m) {
  const double over_density = visible ? std::abs(wi.z) + distribution.ScaledLambda(wi, 1) : cos_i / m.z;
  return over_density * G2OverCos<masking>(distribution, wi, wo);
}

// As Facet::DensityFactor for the normals visible from wi, Heitz 2014 Eq. 16, over the share of them that is
// drawn from.
template <template <class> class Distribution, class Real>
double VisibleDensityFactor(const Distribution<Real>& distribution, const Vec3<Real>& wi,
                            const Facet<Real>& facet, double share = 1) {
  const double visible = (std::abs(wi.z) + distribution.ScaledLambda(wi, 1)) * share;
  if (facet.lobe == kReflection) return 0.25 / visible;
  return facet.cos_i * (facet.cos_o / Narrow<double>(facet.length2)) / visible;
}

// The density with which SampleVisibleReflection finds wo.
template <template <class> class Distribution, class Real>
Real PdfVisibleReflection(const Distribution<Real>& distribution, const Vec3<Real>& wi, const Vec3<Real>& wo,
                          bool bounded) {
  if (AnyNan(wi, wo, distribution)) return kNan<Real>;
  const Facet<Real> facet = FindFacet(wi, wo, Real(1));
  if (facet.lobe != kReflection) return 0;
  const double share = distribution.ShareOfVisible(wi, bounded);
  return Saturate<Real>(
      distribution.DOfHalf(facet.half, VisibleDensityFactor(distribution, wi, facet, share)));
}

template <class Real>
struct EvalPdf {
  Real f_cos, pdf;
};

template <class Real>
struct DirectionSample {
  Vec3<Real> wo;
  Real weight, pdf;
  Lobes lobe;
};

template <template <class> class Distribution, class Real, Masking masking = Masking::kHeightCorrelated>
struct RoughDielectric {
  Distribution<Real> distribution;
  Real eta;
  Transport transport = Transport::kRadiance;

  // f |wo.n| of the wanted lobes, 0 for the other's configurations.
  Real Eval(const Vec3<Real>& wi, const Vec3<Real>& wo, Lobes wanted) const {
    if (AnyNan(wi, wo, distribution, eta)) return kNan<Real>;
    return Eval(wi, wo, FindFacet(wi, wo, eta), wanted);
  }

  // Density of wo for D cos sampling of normals, or of visible ones; with both lobes, times the probability F
  // or 1 - F of the lobe.
  template <bool visible = false>
  Real Pdf(const Vec3<Real>& wi, const Vec3<Real>& wo, Lobes wanted) const {
    if (AnyNan(wi, wo, distribution, eta)) return kNan<Real>;
    return PdfOf<visible>(wi, wo, FindFacet(wi, wo, eta), wanted);
  }

  template <bool visible = false>
  EvalPdf<Real> EvalAndPdf(const Vec3<Real>& wi, const Vec3<Real>& wo) const {
    if (AnyNan(wi, wo, distribution, eta)) return {kNan<Real>, kNan<Real>};
    const Facet<Real> facet = FindFacet(wi, wo, eta);
    return {Eval(wi, wo, facet, kBothLobes), PdfOf<visible>(wi, wo, facet, kBothLobes)};
  }

  // Walter 2007 section 5.3; with one lobe wanted, u3 has no effect and the weight carries F or 1 - F. The
  // normal and the direction are found in double at least: near the critical angle, refraction magnifies a
  // rounding of m by c/g.
  template <bool visible = false>
  DirectionSample<Real> Sample(const Vec3<Real>& wi, Real u1, Real u2, Real u3,
                               Lobes wanted = kBothLobes) const {
    using W = Wide<Real>;
    constexpr DirectionSample<Real> none{{0, 0, 0}, 0, 0, kNoLobe};
    if (AnyNan(wi, u1, u2, u3, distribution, eta)) {
      return {{kNan<Real>, kNan<Real>, kNan<Real>}, kNan<Real>, kNan<Real>, kNoLobe};
    }
    if (wi.z == 0) return none;
    const SampledNormal<double> normal = SampleFacetNormal<visible>(distribution, wi, u1, u2);
    if (normal.m.z == 0) return none;
    const W side = Side(wi);
    const Vec3<W> wide_wi = Widen(wi);
    const Vec3<W> m = side * Vec3<W>{normal.m.x, normal.m.y, normal.m.z};
    const W c = Dot(wide_wi, m);
    if (!(c > W(0))) return none;

    const FresnelDielectric<Real> fresnel(c * c, eta);
    const bool chooses = wanted == kBothLobes;
    const Lobes lobe = !chooses ? wanted : u3 < fresnel.Reflectance() ? kReflection : kTransmission;
    if (lobe == kTransmission && (fresnel.total_internal_reflection() || fresnel.g() == 0)) return none;
    const Vec3<W> wo = lobe == kReflection ? Reflect(wide_wi, m) : Refract(wide_wi, m, W(eta), W(1));
    const W along = lobe == kReflection ? side * wo.z : -side * wo.z;
    if (!(along > W(0))) return none;

    DirectionSample<Real> sample{Narrow<Real>(wo), 0, 0, lobe};
    const double cos_i = Narrow<double>(c);
    const double share = lobe == kReflection ? fresnel.Reflectance() : fresnel.Transmittance();
    double weight =
        SampledWeight<masking, visible>(distribution, wi, sample.wo, cos_i, normal.m) * (chooses ? 1 : share);
    if (lobe == kTransmission && transport == Transport::kImportance) weight /= double{eta} * eta;
    sample.weight = Saturate<Real>(weight);
    sample.pdf = Saturate<Real>(SampledPdf((chooses ? share : 1) * normal.pdf, lobe, cos_i, fresnel));
    return sample;
  }

 private:
  // F or 1 - F, as the facet reflects or refracts. Next to the critical angle double has too few digits of
  // c^2 for float as well.
  double Choice(const Vec3<Real>& wi, const Vec3<Real>& wo, const Facet<Real>& facet) const {
    const FresnelDielectric<Real> fresnel(facet.cos2_i, eta);
    if constexpr (std::is_same_v<Real, float>) {
      if (fresnel.near_critical_angle()) {
        const FresnelDielectric<double> fine(FindFacet(Widen(wi), Widen(wo), double{eta}).cos2_i, eta);
        return facet.lobe == kReflection ? fine.Reflectance() : fine.Transmittance();
      }
    }
    return facet.lobe == kReflection ? fresnel.Reflectance() : fresnel.Transmittance();
  }

  // Walter 2007 Eqs. 20 and 21 times |wo.n|. The factors of D are multiplied in double so that none
  // leaves the range before the result does.
  Real Eval(const Vec3<Real>& wi, const Vec3<Real>& wo, const Facet<Real>& facet, Lobes wanted) const {
    if ((facet.lobe & wanted) == 0) return 0;
    const double factor = Choice(wi, wo, facet) * G2OverCos<masking>(distribution, wi, wo);
    if (facet.lobe == kReflection) return Saturate<Real>(distribution.DOfHalf(facet.half, factor / 4));
    const double scale = transport == Transport::kRadiance ? double{eta} * eta : 1;
    const double jacobian = facet.cos_o / Narrow<double>(facet.length2);
    return Saturate<Real>(distribution.DOfHalf(facet.half, scale * factor * facet.cos_i * jacobian));
  }

  template <bool visible>
  Real PdfOf(const Vec3<Real>& wi, const Vec3<Real>& wo, const Facet<Real>& facet, Lobes wanted) const {
    if ((facet.lobe & wanted) == 0) return 0;
    double factor = facet.DensityFactor();
    if constexpr (visible) factor = VisibleDensityFactor(distribution, wi, facet);
    if (facet.lobe == kTransmission) factor *= double{eta} * eta;
    if (wanted == kBothLobes) factor *= Choice(wi, wo, facet);
    return Saturate<Real>(distribution.DOfHalf(facet.half, factor));
  }

  // Walter 2007 Eq. 38 with the second forms of Eqs. 14 and 17: 1/(4 c), and with o.m = -g/eta
  // eta g/(c - g)^2 = eta g ((c + g)/k)^2, largest finite at eta = 1.
  double SampledPdf(double normal_pdf, Lobes lobe, double c, const FresnelDielectric<Real>& fresnel) const {
    if (lobe == kTransmission && fresnel.k() == 0) return std::numeric_limits<double>::infinity();
    if (normal_pdf == 0) return 0;
    if (lobe == kReflection) return normal_pdf / (4 * c);
    return normal_pdf * eta * fresnel.g() * Square((c + fresnel.g()) / fresnel.k());
  }
};

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_ROUGH_DIELECTRIC_H_
