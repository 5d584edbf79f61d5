// The coupled specular-matte model of Kelemen 2001, Eqs. 3, 4, 6 and 7, with the entries of a table for the
// albedo.
#ifndef MICROLANE_TESTS_ORACLE_COUPLED_H_
#define MICROLANE_TESTS_ORACLE_COUPLED_H_

#include <algorithm>
#include <cstddef>

#include "oracle/albedo.h"
#include "oracle/beckmann.h"
#include "oracle/rough_reflector.h"

namespace microlane::oracle {

struct DielectricFacets {
  Real eta;

  Real Reflectance(const Real& c) const { return FresnelDielectric(c, eta); }
  Real Conditioning(const Real&) const { return 1; }
  Real Curvature(const Real&) const { return 0; }
};

// The cumulative reflection function of Kelemen 2001, with its sine: Int (1 - a) mu dmu from mu to 1, of a
// linear between the entries.
inline Real MatteCumulative(const AlbedoEntries& table, std::size_t j, const Real& mu) {
  const Real mu0 = AlbedoNode(table, j), mu1 = AlbedoNode(table, j + 1);
  const Real slope = (Real(table.deficit[j + 1]) - table.deficit[j]) / (mu1 - mu0);
  // r = r_1 + slope (mu - mu1).
  const Real at_0 = table.deficit[j + 1] - slope * mu1;
  return table.cumulative[j + 1] + at_0 * (mu1 * mu1 - mu * mu) / 2 +
         slope * (mu1 * mu1 * mu1 - mu * mu * mu) / 3;
}

// The mu at which that is u of its whole, by bisection and then Newton's method.
inline Real MatteCosine(const AlbedoEntries& table, const Real& u) {
  const Real q = u * table.cumulative[0];
  std::size_t j = 0;
  while (j + 1 < table.last && table.cumulative[j + 1] > q) ++j;
  Real low = AlbedoNode(table, j), high = AlbedoNode(table, j + 1);
  for (int step = 0; step < 40; ++step) {
    const Real middle = (low + high) / 2;
    (MatteCumulative(table, j, middle) > q ? low : high) = middle;
  }
  Real mu = (low + high) / 2;
  for (int step = 0; step < 5; ++step) {
    const Real slope = mu * AlbedoCurve(table, table.deficit, mu);
    if (slope == 0) break;
    mu += (MatteCumulative(table, j, mu) - q) / slope;
  }
  return mu;
}

struct Coupled {
  const AlbedoEntries& table;
  Real m, index;  // of Ward's P_H, and of the interface
  Real k;

  // f |cos(theta_o)|, Eqs. 3 and 7.
  Real EvalCos(const Vec& wi, const Vec& wo) const { return Specular().EvalCos(wi, wo) + Matte(wi, wo); }

  // Sections 2.1.4 and 2.2.1, each part with its probability.
  Real Pdf(const Vec& wi, const Vec& wo) const { return Albedo(wi) * Specular().Pdf(wi, wo) + Matte(wi, wo); }

  // A lobe_hint >= 0 takes that lobe whatever the decisions would be; margins are still those of the
  // decisions.
  DirectionSample Sample(const Vec& wi, const Real& u1, const Real& u2, const Real& u3, int lobe_hint) const {
    DirectionSample sample;
    if (wi.z == 0) return sample;
    const Real a = Albedo(wi), matte = a + k * Deficit(wi);
    int lobe = u3 < a ? kReflection : u3 < matte ? kTransmission : kNone;
    sample.margin = static_cast<double>(std::min(Real(abs(u3 - a)), Real(abs(u3 - matte))));
    const int side = Sign(wi.z);
    const Vec v{wi.x, wi.y, abs(wi.z)};
    const auto direction = [&](int of) -> Vec {
      if (of == kReflection) return Reflect(v, Ward().SampleNormal(u1, u2));
      const Real z = MatteCosine(table, u1), sine = sqrt((1 - z) * (1 + z));
      const SinCos azimuth = SinCos2Pi(u2);
      return {sine * azimuth.cos, sine * azimuth.sin, z};
    };
    if (lobe == kReflection) {
      const Real z = direction(lobe).z;
      sample.margin = std::min(sample.margin, static_cast<double>(Real(abs(z))));
      if (z <= 0) lobe = kNone;
    }
    if (lobe_hint >= 0) lobe = lobe_hint;
    if (lobe == kNone) return sample;
    const Vec wo = direction(lobe);
    const Real pdf = Pdf(v, wo);
    if (wo.z <= 0 || pdf == 0) return sample;
    sample.lobe = lobe;
    sample.wo = {wo.x, wo.y, side * wo.z};
    sample.pdf = pdf;
    sample.weight = EvalCos(v, wo) / pdf;
    const Vec h = v + wo;
    const Real c = Dot(v, h) / sqrt(Dot(h, h));
    sample.kappa = sample.weight_kappa = (1 + 1 / abs(c)) * (1 + 1 / abs(wo.z));
    return sample;
  }

 private:
  Beckmann Ward() const { return {{m, m}}; }
  RoughReflector<Beckmann, DielectricFacets> Specular() const { return {Ward(), {index}, Masking::kKelemen}; }
  Real Albedo(const Vec& v) const { return AlbedoCurve(table, table.albedo, v.z); }
  Real Deficit(const Vec& v) const { return AlbedoCurve(table, table.deficit, v.z); }

  // k s r(theta) r(theta') |cos(theta_o)|; the average of the table's own curve.
  Real Matte(const Vec& wi, const Vec& wo) const {
    const double total = table.cumulative[0];
    if (!(wi.z * wo.z > 0) || total == 0) return 0;
    return k * Deficit(wi) * Deficit(wo) * abs(wo.z) / (2 * Pi() * total);
  }
};

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_COUPLED_H_
