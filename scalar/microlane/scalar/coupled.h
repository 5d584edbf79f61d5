// The coupled specular-matte model of Kelemen 2001: Ward's P_H over a dielectric, and a matte part that takes
// what the specular albedo leaves.
#ifndef MICROLANE_SCALAR_COUPLED_H_
#define MICROLANE_SCALAR_COUPLED_H_

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "microlane/albedo.h"
#include "microlane/scalar/albedo.h"
#include "microlane/scalar/beckmann.h"
#include "microlane/scalar/rough_reflector.h"

namespace microlane::scalar {

// F of Walter 2007 Eq. 22.
template <class Real>
struct DielectricFacets {
  Real eta;

  double Reflectance(Wide<Real> cos2) const { return FresnelDielectric<Real>(cos2, eta).Reflectance(); }
  bool NeedsDigits(Wide<Real> cos2) const { return FresnelDielectric<Real>(cos2, eta).near_critical_angle(); }
  DielectricFacets<double> Widened() const { return {eta}; }
};
template <class Real>
bool IsNan(const DielectricFacets<Real>& facets) {
  return IsNan(facets.eta);
}

// cos(theta) of density proportional to (1 - a) cos over solid angle, and 1 - cos, from u. In the cell that u
// falls in, t from 0 at its upper end solves a cubic.
struct MatteCosine {
  double cosine, from_one;
};
inline MatteCosine SampleMatteCosine(const AlbedoEntries& table, double u) {
  const double q = u * table.cumulative[0];
  std::size_t j = 0, length = table.last;
  while (length > 1) {
    const std::size_t half = length / 2;
    if (table.cumulative[j + half] > q) j += half;
    length -= half;
  }
  const double mu1 = table.Node(j + 1), width = mu1 - table.Node(j);
  const double r1 = double{table.deficit[j + 1]}, fall = r1 - double{table.deficit[j]};
  const double y = std::max(0.0, q - table.cumulative[j + 1]) / width;
  const double a = r1 * mu1, b = (r1 * width + fall * mu1) / 2, c = fall * width / 3;
  double t = std::min(1.0, 2 * y / (a + std::sqrt(std::max(0.0, a * a - 4 * b * y))));
  for (int step = 0; step < 4; ++step) {
    const double slope = (r1 - fall * t) * (mu1 - width * t);
    if (slope > 0) t = std::clamp(t - (t * (a - t * (b - t * c)) - y) / slope, 0.0, 1.0);
  }
  const double from_one = (1 - mu1) + width * t;
  return {1 - from_one, from_one};
}

template <class Real>
struct Coupled {
  const AlbedoTable& table;
  Real k;

  // f |cos(theta_o)| = (P_H F/(h.h) + k s r r') |cos(theta_o)| and the density of what Sample draws.
  EvalPdf<Real> EvalAndPdf(const Vec3<Real>& wi, const Vec3<Real>& wo) const {
    const EvalPdf<double> value = InDouble(wi, wo);
    return {Saturate<Real>(value.f_cos), Saturate<Real>(value.pdf)};
  }

  // Russian roulette by u3 between the specular part, the matte one and nothing.
  DirectionSample<Real> Sample(const Vec3<Real>& wi, Real u1, Real u2, Real u3) const {
    constexpr DirectionSample<Real> none{{0, 0, 0}, 0, 0, kNoLobe};
    if (AnyNan(wi, u1, u2, u3, k))
      return {{kNan<Real>, kNan<Real>, kNan<Real>}, kNan<Real>, kNan<Real>, kNoLobe};
    const AlbedoEntries& entries = table.entries();
    const AlbedoCell cell = FindCell(entries, static_cast<double>(wi.z));
    const double a = Interpolate(entries.albedo, cell), r = Interpolate(entries.deficit, cell);
    const bool specular = u3 < a;
    if (!(specular || u3 < a + k * r)) return none;
    const Vec3<double> v{wi.x, wi.y, std::abs(wi.z)};
    Vec3<double> wo;
    if (specular) {
      wo = Reflect(v, Ward<double>().SampleNormal(u1, u2).m);
    } else {
      const MatteCosine matte = SampleMatteCosine(entries, u1);
      const SinCos<double> azimuth = SinCos2Pi(static_cast<double>(u2));
      const double sine = std::sqrt(matte.from_one * (1 + matte.cosine));
      wo = {sine * azimuth.cos, sine * azimuth.sin, matte.cosine};
    }
    const EvalPdf<double> value = InDouble(v, wo);
    if (!(wo.z > 0 && value.pdf > 0)) return none;
    const Vec3<double> out{wo.x, wo.y, wi.z < 0 ? -wo.z : wo.z};
    return {Narrow<Real>(out), Saturate<Real>(value.f_cos / value.pdf), Saturate<Real>(value.pdf),
            specular ? kReflection : kTransmission};
  }

 private:
  template <class Number>
  static Vec3<double> Doubles(const Vec3<Number>& v) {
    return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
  }

  template <class Number>
  Beckmann<Number> Ward() const {
    const Number m = static_cast<Number>(table.lobe().roughness);
    return {m, m};
  }

  template <class Number>
  EvalPdf<double> InDouble(const Vec3<Number>& wi, const Vec3<Number>& wo) const {
    if (AnyNan(wi, wo, k)) return {kNan<double>, kNan<double>};
    if (!(static_cast<double>(wi.z) * static_cast<double>(wo.z) > 0)) return {0, 0};
    const RoughReflector<Beckmann, DielectricFacets, double, Masking::kKelemen> surface{Ward<double>(),
                                                                                        {table.lobe().n}};
    const EvalPdf<double> specular = surface.EvalAndPdf(Doubles(wi), Doubles(wo));
    const AlbedoEntries& entries = table.entries();
    const AlbedoCell cell_i = FindCell(entries, static_cast<double>(wi.z));
    const AlbedoCell cell_o = FindCell(entries, static_cast<double>(wo.z));
    const double r_i = Interpolate(entries.deficit, cell_i), r_o = Interpolate(entries.deficit, cell_o);
    const double matte = k * r_i * r_o * entries.matte_scale * std::abs(static_cast<double>(wo.z));
    return {specular.f_cos + matte, Interpolate(entries.albedo, cell_i) * specular.pdf + matte};
  }
};

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_COUPLED_H_
