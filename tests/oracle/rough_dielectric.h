// The rough dielectric of Walter 2007: BSDF, densities and sampling over any distribution of normals.
#ifndef MICROLANE_TESTS_ORACLE_ROUGH_DIELECTRIC_H_
#define MICROLANE_TESTS_ORACLE_ROUGH_DIELECTRIC_H_

#include <algorithm>
#include <cmath>
#include <limits>

#include "oracle/fresnel.h"
#include "oracle/half_vector.h"
#include "oracle/real.h"
#include "oracle/stretch.h"

namespace microlane::oracle {

enum class Transport { kRadiance, kImportance };
enum class Masking { kCorrelated, kSeparable, kVCavity, kKelemen };

// Lobes, as the kernel list numbers them; kBoth selects either.
inline constexpr int kNone = 0, kReflection = 1, kTransmission = 2, kBoth = 3;

// The configuration of wi and wo, and the only microfacet normal that scatters one into the other.
struct Geometry {
  int lobe;
  Vec h;           // unit, hz > 0
  Real h_length2;  // |H|^2 of the half vector before it was normalised
  Real wi_h, wo_h;
};

// lobe is kNone where wi or wo is grazing, where H.z = 0, or where Walter 2007, Eq. 7 fails.
inline Geometry MakeGeometry(const Vec& wi, const Vec& wo, const Real& eta) {
  Geometry g{kNone, {}, {}, {}, {}};
  if (wi.z == 0 || wo.z == 0) return g;
  const bool reflects = (wi.z > 0) == (wo.z > 0);
  Vec half_vector = reflects ? ReflectionHalfVector(wi, wo) : RefractionHalfVector(wi, wo, eta);
  if (half_vector.z == 0) return g;
  if (half_vector.z < 0) half_vector = -half_vector;
  g.h_length2 = Dot(half_vector, half_vector);
  g.h = (1 / sqrt(g.h_length2)) * half_vector;
  g.wi_h = Dot(wi, g.h);
  g.wo_h = Dot(wo, g.h);
  if (!(g.wi_h * wi.z > 0 && g.wo_h * wo.z > 0)) return g;
  g.lobe = reflects ? kReflection : kTransmission;
  return g;
}

struct DirectionSample {
  Vec wo;
  Real weight, pdf;
  int lobe = kNone;
  // How far the nearest decision is from turning out otherwise, as a change of wi.m, wo.z or u3.
  double margin = std::numeric_limits<double>::infinity();
  double facet_margin = std::numeric_limits<double>::infinity();  // of the facets of a V-cavity
  // Amplification of an input rounding by the geometry; see Metric::kConditioned.
  Real kappa = 1;  // of pdf
  Real weight_kappa = 1;
  double weight_curvature = 0;  // oracle::Result::curvature
  Real direction_kappa = 1;     // of wo
};

// G without its sidedness: Heitz 2014, Eq. 99 (correlated) or 98 (separable; Walter 2007, Eq. 23).
template <class Distribution>
Real SmithG2(const Distribution& distribution, Masking masking, const Vec& wi, const Vec& wo) {
  const Real lambda_i = distribution.Lambda(wi);
  const Real lambda_o = distribution.Lambda(wo);
  if (masking == Masking::kCorrelated) return 1 / (1 + lambda_i + lambda_o);
  return 1 / ((1 + lambda_i) * (1 + lambda_o));
}

// A normal that was drawn, its density, and what Metric::kDirection and kConditioned make of it.
struct NormalSample {
  Vec m;
  Real pdf;
  bool visible = false;  // from wi; else by D cos
  Real direction_kappa = 1, kappa = 1;
};

// The density of wo for normals visible from wi: D_v of Heitz 2014, Eq. 16, which has |wi.h|, times the
// Jacobians of Walter 2007, Eqs. 14 and 17, less eta^2.
template <class Distribution>
Real PdfVisible(const Distribution& distribution, const Vec& wi, const Geometry& g) {
  const Real jacobian = g.lobe == kReflection ? Real(Real(1) / 4) : Real(abs(g.wi_h * g.wo_h) / g.h_length2);
  return distribution.D(g.h) * jacobian / ((1 + distribution.Lambda(wi)) * abs(wi.z));
}

// |d ln G| for a change of wo by 1, at most: by 1/|wo.n|, and by the length |(alpha_x wo.x, alpha_y wo.y,
// wo.z)| = |wo.n| (1 + 2 Lambda_o).
template <class Distribution>
Real MaskingSlope(const Distribution& distribution, const Vec& wo) {
  const Real alphas = distribution.Alphas();
  if (alphas == 0) return 1 / abs(wo.z);  // 0/0 at wo.n = 0
  return 1 / abs(wo.z) + alphas / (abs(wo.z) * (1 + 2 * distribution.Lambda(wo)));
}

template <class Distribution>
struct RoughDielectric {
  Distribution distribution;
  Real eta;
  Masking masking = Masking::kCorrelated;
  Transport transport = Transport::kRadiance;

  // f |cos(theta_o)|, Walter 2007, Eqs. 19-21, of the lobes wanted.
  Real EvalCos(const Vec& wi, const Vec& wo, int lobes) const {
    const Geometry g = MakeGeometry(wi, wo, eta);
    if ((g.lobe & lobes) == 0) return 0;
    const Real F = FresnelDielectric(g.wi_h, eta);
    const Real DG = distribution.D(g.h) * SmithG2(distribution, masking, wi, wo);
    if (g.lobe == kReflection) return F * DG / (4 * abs(wi.z));
    const Real f_cos = abs(g.wi_h * g.wo_h) * (1 - F) * DG / (abs(wi.z) * g.h_length2);
    return transport == Transport::kRadiance ? eta * eta * f_cos : f_cos;
  }

  // Walter 2007, Eq. 38, of the lobes wanted, of normals by Eq. 24 or of visible ones; with both lobes, times
  // the probability of the lobe.
  Real Pdf(const Vec& wi, const Vec& wo, int lobes, bool visible = false) const {
    const Geometry g = MakeGeometry(wi, wo, eta);
    if ((g.lobe & lobes) == 0) return 0;
    Real pdf = visible ? PdfVisible(distribution, wi, g)
                       : Real(distribution.D(g.h) * g.h.z * abs(g.wo_h) / g.h_length2);
    if (g.lobe == kTransmission) pdf *= eta * eta;
    if (lobes == kBoth) {
      const Real F = FresnelDielectric(g.wi_h, eta);
      pdf *= g.lobe == kReflection ? F : 1 - F;
    }
    return pdf;
  }

  // Walter 2007, section 5.3; of one lobe, u3 decides nothing and the weight carries F or 1 - F. A lobe_hint
  // >= 0 takes that lobe whatever the decisions would be; margin is still that of the decisions.
  DirectionSample Sample(const Vec& wi, const NormalSample& normal, const Real& u3, int lobes,
                         int lobe_hint) const {
    DirectionSample sample;
    if (wi.z == 0) return sample;
    const int sign = Sign(wi.z);
    const Vec& m = normal.m;
    if (m.z == 0) return sample;
    const Vec facing = Real(sign) * m;  // the normal on wi's side
    const Real c = Dot(wi, facing);
    const Real F = FresnelDielectric(c, eta);
    Real radicand = RefractionRadicand(c, eta);

    sample.margin = ToDouble(abs(c));
    if ((lobes & kTransmission) != 0) {
      sample.margin =
          std::min(sample.margin, ToDouble(abs(radicand)) / (1 + 2 * ToDouble(abs(c) / (eta * eta))));
    }
    const Real g2 = eta * eta * radicand;
    const bool total = radicand <= 0;
    if (total) radicand = 0;
    const Real cos_t = sqrt(radicand);
    const auto scatter = [&](int lobe) {
      return lobe == kReflection ? Reflect(wi, facing) : Refract(wi, facing, eta, c, 1, radicand);
    };

    int lobe = kNone;
    Vec wo{0, 0, 0};
    if (c > 0) {
      lobe = lobes != kBoth ? lobes : u3 < F ? kReflection : kTransmission;
      wo = scatter(lobe);
      if (lobes == kBoth) {
        sample.margin =
            std::min(sample.margin, ToDouble(abs(u3 - F)) / (1 + FresnelSlope(ToDouble(c), ToDouble(cos_t))));
      }
      sample.margin = std::min(
          sample.margin, ToDouble(abs(wo.z)) / (1 + (lobe == kReflection ? 0 : RefractionSlope(c, cos_t))));
      const bool valid = lobe == kReflection ? sign * wo.z > 0 : sign * wo.z < 0 && !total;
      if (!valid) lobe = kNone;
    }
    sample.margin /= ToDouble(normal.direction_kappa);
    if (lobe_hint >= 0 && lobe_hint != lobe) {
      lobe = lobe_hint;
      wo = scatter(lobe);
    }
    if (lobe == kNone) return sample;

    sample.lobe = lobe;
    sample.wo = wo;
    sample.weight = SmithG2(distribution, masking, wi, wo) *
                    (normal.visible ? Real(1 + distribution.Lambda(wi)) : Real(c / (abs(wi.z) * m.z)));
    sample.pdf = normal.pdf;
    const Real geometry = (1 + 1 / abs(c)) * (1 + c * c / abs(g2));
    sample.kappa = normal.kappa * geometry * (1 + 1 / abs(wo.z));
    sample.weight_kappa = normal.direction_kappa * geometry * (1 + MaskingSlope(distribution, wo));
    sample.direction_kappa = normal.direction_kappa;
    (lobes == kBoth ? sample.pdf : sample.weight) *= lobe == kReflection ? F : Real(1 - F);
    if (lobe == kReflection) {
      sample.pdf *= ReflectionJacobian(c);
    } else {
      sample.pdf *= RefractionJacobian(c, -cos_t, eta);
      sample.direction_kappa *= 1 + c / sqrt(abs(g2));
      if (g2 <= 0)
        sample.kappa = sample.weight_kappa = sample.direction_kappa = Infinity();  // only by a hint
      // Without an interface every facet refracts straight on: the density is a delta.
      if (eta == 1) sample.pdf = Infinity();
      if (transport == Transport::kImportance) sample.weight /= eta * eta;
    }
    return sample;
  }

 private:
  static double ToDouble(const Real& x) { return static_cast<double>(x); }

  // |dF / d(wi.m)|, by which a rounding of wi.m shifts the choice of lobe.
  double FresnelSlope(double c, double cos_t) const {
    const double n = ToDouble(eta), n2 = n * n;
    const double g = n * cos_t;
    if (g == 0) return 0;
    const double r_s = (c - g) / (c + g), r_p = (g - n2 * c) / (g + n2 * c);
    const double dr_s = 2 * (n2 - 1) / (g * (g + c) * (g + c));
    const double dr_p = -2 * n2 * (n2 - 1) / (g * (g + n2 * c) * (g + n2 * c));
    return std::abs(r_s * dr_s + r_p * dr_p);
  }

  // |d(wo) / d(wi.m)| of Walter 2007, Eq. 40, without its regular part.
  double RefractionSlope(const Real& c, const Real& cos_t) const {
    return cos_t == 0 ? 0 : ToDouble(c / (eta * eta * cos_t));
  }
};

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_ROUGH_DIELECTRIC_H_
