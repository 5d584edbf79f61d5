// Opaque rough surfaces: Walter 2007, Eq. 20, over any distribution of normals and kind of facets.
#ifndef MICROLANE_TESTS_ORACLE_ROUGH_REFLECTOR_H_
#define MICROLANE_TESTS_ORACLE_ROUGH_REFLECTOR_H_

#include <algorithm>

#include "oracle/fresnel.h"
#include "oracle/half_vector.h"
#include "oracle/masking.h"
#include "oracle/real.h"
#include "oracle/rough_dielectric.h"

namespace microlane::oracle {

// Reflectance F of a facet at the cosine c; what it makes of a relative rounding of c, at least 1; and 1 over
// the change of c in which F changes its slope. See Metric::kConditioned.
struct MirrorFacets {
  Real Reflectance(const Real&) const { return 1; }
  Real Conditioning(const Real&) const { return 1; }
  Real Curvature(const Real&) const { return 0; }
};

struct ConductorFacets {
  Real n, kappa;

  Real Reflectance(const Real& c) const { return FresnelConductor(c, n, kappa); }
  Real Conditioning(const Real& c) const { return 1 + abs(c) * Curvature(c); }
  Real Curvature(const Real& c) const { return abs(c) / SquaredModulus(ConductorG(abs(c), n, kappa)); }
};

struct SchlickFacets {
  Real f0;

  Real Reflectance(const Real& c) const { return FresnelSchlick(c, f0); }
  // 1 + |dF/dc| / F.
  Real Conditioning(const Real& c) const {
    const Real x = 1 - abs(c);
    if (x <= 0) return f0 > 0 ? Real(1) : Infinity();
    return 1 + 5 * (1 - f0) * pow(x, 4) / Reflectance(c);
  }
  // At least |dF/dc| / F: a change of c by F^(1/5) changes F by as much as itself, and by no less where c
  // counts as 1.
  Real Curvature(const Real& c) const { return 5 / pow(Reflectance(c), Real(1) / 5); }
};

// |dF/dc| / F.
template <class Facets>
Real RelativeSlope(const Facets& facets, const Real& c) {
  const Real F = facets.Reflectance(c), step = c * Real("1e-30"), below = facets.Reflectance(c - step);
  return F == below ? Real(0) : Real(abs(F - below) / (F * step));
}

// The density of reflections about normals visible from wi: Heitz 2014, Eq. 16, and Walter 2007, Eq. 14.
template <class Distribution>
Real PdfVisible(const Distribution& distribution, const Vec& wi, const Vec& wo) {
  const Geometry g = MakeGeometry(wi, wo, 1);
  return g.lobe != kReflection ? Real(0) : PdfVisible(distribution, wi, g);
}

template <class Distribution, class Facets>
struct RoughReflector {
  Distribution distribution;
  Facets facets;
  Masking masking = Masking::kCorrelated;

  // f |cos(theta_o)|, Walter 2007, Eq. 20.
  Real EvalCos(const Vec& wi, const Vec& wo) const {
    const Geometry g = MakeGeometry(wi, wo, 1);
    if (g.lobe != kReflection) return 0;
    if (masking == Masking::kKelemen) {
      const Real P_H = distribution.D(g.h) * g.h.z;
      return P_H * facets.Reflectance(g.wi_h) / g.h_length2 * abs(wo.z);  // Kelemen 2001, Eq. 3
    }
    return facets.Reflectance(g.wi_h) * distribution.D(g.h) * G2(wi, wo, g.h) / (4 * abs(wi.z));
  }

  // Walter 2007, Eqs. 14, 24 and 38.
  Real Pdf(const Vec& wi, const Vec& wo) const {
    const Geometry g = MakeGeometry(wi, wo, 1);
    if (g.lobe != kReflection) return 0;
    return distribution.D(g.h) * g.h.z * abs(g.wo_h) / g.h_length2;
  }

  // Heitz 2014, Eqs. 16 and 49; Walter 2007, Eq. 14.
  Real PdfVCavity(const Vec& wi, const Vec& wo) const {
    const Geometry g = MakeGeometry(wi, wo, 1);
    if (g.lobe != kReflection) return 0;
    return VCavityDensity(distribution, wi, g.h) * ReflectionJacobian(abs(g.wi_h));
  }

  // Walter 2007, section 5.3; of V-cavities about the normals that they show. A lobe_hint >= 0 takes that
  // lobe whatever the decisions would be, other_facet the other facet; margins are still those of the
  // decisions.
  DirectionSample Sample(const Vec& wi, const Real& u1, const Real& u2, const Real& u3, int lobe_hint,
                         bool other_facet) const {
    DirectionSample sample;
    if (wi.z == 0) return sample;
    const int sign = Sign(wi.z);
    const bool v_cavity = masking == Masking::kVCavity;
    const Vec n = distribution.SampleNormal(u1, u2);
    if (n.z == 0) return sample;
    const VCavityFacet facet = ChooseFacet(wi, n, u3, other_facet);
    const Vec m = v_cavity ? facet.m : n;
    if (v_cavity) sample.facet_margin = facet.margin;
    const Vec facing = Real(sign) * m;
    const Real c = Dot(wi, facing);
    const Vec wo = Reflect(wi, facing);
    sample.margin = static_cast<double>(Real(abs(c)));
    int lobe = kNone;
    if (c > 0) {
      sample.margin = std::min(sample.margin, static_cast<double>(Real(abs(wo.z))));
      if (sign * wo.z > 0) lobe = kReflection;
    }
    if (lobe_hint >= 0) lobe = lobe_hint;
    if (lobe == kNone) return sample;
    sample.lobe = lobe;
    sample.wo = wo;
    const Real normal_pdf = v_cavity ? VCavityDensity(distribution, wi, m) : Real(distribution.D(m) * m.z);
    const Real over_pdf = v_cavity ? Real(1 / VCavityG1(wi, m)) : Real(c / (abs(wi.z) * m.z));
    sample.weight = facets.Reflectance(c) *
                    (masking == Masking::kKelemen ? Real(abs(wo.z) / c) : Real(over_pdf * G2(wi, wo, m)));
    sample.pdf = normal_pdf * ReflectionJacobian(c);
    sample.kappa = (1 + 1 / abs(c)) * (1 + 1 / abs(wo.z));
    const Real slope =
        v_cavity || masking == Masking::kKelemen ? Real(1 / abs(wo.z)) : MaskingSlope(distribution, wo);
    sample.weight_kappa = (1 + 1 / abs(c)) * facets.Conditioning(c) * (1 + slope);
    sample.weight_curvature = static_cast<double>(facets.Curvature(c));
    return sample;
  }

 private:
  // Without its sidedness. V-cavities: Cook and Torrance 1982; h.z > 0.
  Real G2(const Vec& wi, const Vec& wo, const Vec& h) const {
    if (masking != Masking::kVCavity) return SmithG2(distribution, masking, wi, wo);
    const Real of_i = VCavityG1(wi, h), of_o = VCavityG1(wo, h);
    return of_i < of_o ? of_i : of_o;
  }
};

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_ROUGH_REFLECTOR_H_
