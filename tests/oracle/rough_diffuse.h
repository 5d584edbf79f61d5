// Facets that scatter: Heitz 2014, Eq. 31, and Meneveaux 2015, Eq. 12, summed over the normals of
// kernels/microlane/quadrature.h, each with the solid angle that it stands for.
#ifndef MICROLANE_TESTS_ORACLE_ROUGH_DIFFUSE_H_
#define MICROLANE_TESTS_ORACLE_ROUGH_DIFFUSE_H_

#include <map>
#include <mutex>
#include <vector>

#include "oracle/beckmann.h"
#include "oracle/fresnel.h"
#include "oracle/ggx.h"
#include "oracle/real.h"
#include "oracle/rough_dielectric.h"
#include "oracle/rough_reflector.h"

namespace microlane::oracle {

// Node and weight of a rule on [0, 1], with what a radius makes of the node.
struct LegendreNode {
  Real t, weight;
  Real tangent;  // tan(pi t/2)
};

// Gauss-Legendre of that order, by Newton's method on the polynomial.
inline const std::vector<LegendreNode>& LegendreNodes(int order) {
  static std::mutex mutex;
  static std::map<int, std::vector<LegendreNode>> all;
  const std::lock_guard<std::mutex> lock(mutex);
  std::vector<LegendreNode>& nodes = all[order];
  for (int k = static_cast<int>(nodes.size()); k < order; ++k) {
    Real x = -cos(Pi() * (k + Real(0.75)) / (order + Real(0.5))), slope = 1;
    for (int step = 0; step < 9; ++step) {
      Real p = 1, before = 0;
      for (int j = 0; j < order; ++j) {
        const Real next = ((2 * j + 1) * x * p - j * before) / (j + 1);
        before = p;
        p = next;
      }
      slope = order * (x * p - before) / (x * x - 1);
      x -= p / slope;
    }
    const Real t = (1 + x) / 2;
    nodes.push_back({t, 1 / ((1 - x * x) * slope * slope), sin(Pi() * t / 2) / cos(Pi() * t / 2)});
  }
  return nodes;
}

// r and dr/dt of an azimuth whose edge is at 1/K.
struct RadiusNode {
  Real r, slope;
};
inline RadiusNode RadiusAt(const Ggx&, int, const LegendreNode& node, const Real& K) {
  const Real& p = node.tangent;
  return {p / (1 + K + K * p), (1 + K) / Square(1 + K + K * p) * (1 + p * p) * Pi() / 2};
}
inline RadiusNode RadiusAt(const Beckmann&, int order, const LegendreNode& node, const Real& K) {
  const Real R = sqrt(1 + Real(1.5) * order), end = K * R > 1 ? Real(1 / K) : R;
  return {node.t * end, end};
}

// What a facet scatters, as a part of what a white Lambertian does.
struct LambertianFacet {
  Real operator()(const Real&, const Real&) const { return 1; }
};
struct InterfacedFacet {
  Real n, k;

  Real operator()(const Real& cos_i, const Real& cos_o) const {
    return BodyAlbedo(n, k) * (1 - FresnelDielectric(cos_i, n)) * (1 - FresnelDielectric(cos_o, n));
  }
};

// R_s and R_b of a flat surface, as parts of both.
struct InterfaceShares {
  Real surface, body;
};
inline InterfaceShares SharesOf(const InterfacedFacet& facet) {
  const Real R_s = DiffuseFresnelExternal(facet.n);
  const Real R_b = Square(1 - R_s) * BodyAlbedo(facet.n, facet.k), sum = R_s + R_b;
  if (sum == 0) return {0, 1};
  return {R_s / sum, R_b / sum};
}

// Density of what is drawn, wo from the interface or from the body, as of a flat surface: Meneveaux 2015,
// section 4, after Eq. 25.
template <class Distribution>
Real PdfWithInterface(const Distribution& distribution, const InterfacedFacet& facet, const Vec& wi,
                      const Vec& wo) {
  if (wi.z == 0 || wo.z == 0 || Sign(wi.z) != Sign(wo.z)) return 0;
  const InterfaceShares shares = SharesOf(facet);
  return shares.surface * PdfVisible(distribution, wi, wo) + shares.body * abs(wo.z) / Pi();
}

template <class Distribution, class Facet>
struct RoughDiffuse {
  Distribution distribution;
  Facet facet;
  int order;
  Masking masking = Masking::kCorrelated;

  // f |cos(theta_o)|.
  Real EvalCos(Vec wi, Vec wo) const {
    if (wi.z == 0 || wo.z == 0 || Sign(wi.z) != Sign(wo.z)) return 0;
    wi.z = abs(wi.z);
    wo.z = abs(wo.z);
    return Integral(wi, wo) * SmithG2(distribution, masking, wi, wo) / (Pi() * wi.z);
  }

  // The integrand of Meneveaux 2015, Eq. 28, times |cos(theta_o)|, over the density of m that is drawn by D
  // cos or from the visible normals of wi: Heitz 2014, Eq. 16.
  Real OneNormalCos(Vec wi, Vec wo, const Vec& m, bool visible) const {
    if (wi.z == 0 || wo.z == 0 || Sign(wi.z) != Sign(wo.z)) return 0;
    if (wi.z < 0) {
      wi = -1 * wi;
      wo = -1 * wo;
    }
    const Real cos_i = Dot(wi, m), cos_o = Dot(wo, m);
    if (cos_i <= 0 || cos_o <= 0 || m.z <= 0) return 0;
    const Real value = facet(cos_i, cos_o) / Pi() * cos_i * cos_o / (wi.z * wo.z) *
                       SmithG2(distribution, masking, wi, wo) * wo.z;
    return visible ? Real(value * wi.z / (distribution.G1(wi, m) * cos_i)) : Real(value / m.z);
  }

 private:
  // A direction of the plane of slopes.
  static Vec Unit(const Vec& a, const Vec& otherwise) { return IsZero(a) ? otherwise : Normalized(a); }
  static Vec TurnedLeft(const Vec& a) { return {-a.y, a.x, 0}; }

  // Int <wi.m> <wo.m> facet D(m) dm.
  Real Integral(const Vec& wi, const Vec& wo) const {
    const Real &alpha_x = distribution.alpha.alpha_x, &alpha_y = distribution.alpha.alpha_y;
    const Vec a{alpha_x * wi.x, alpha_y * wi.y, 0}, b{alpha_x * wo.x, alpha_y * wo.y, 0};
    const Real turn = wi.x * wo.y - wi.y * wo.x < 0 ? -1 : 1;
    const Vec along_a = Unit(a, Unit(b, {1, 0, 0})), along_b = Unit(b, along_a);
    const Vec horizon_a = turn * TurnedLeft(along_a), horizon_b = -turn * TurnedLeft(along_b);
    const Vec corner = -turn * TurnedLeft(Unit(wo.z * a - wi.z * b, along_a));
    // Largest of the edges' 1/r towards e, where there is one.
    const auto edge = [&](const Vec& e) {
      const Real of_i = -Dot(a, e) / wi.z, of_o = -Dot(b, e) / wo.z, K = of_i > of_o ? of_i : of_o;
      return K > 0 ? K : Real(0);
    };
    const std::vector<LegendreNode>& nodes = LegendreNodes(order);
    Real sum = 0;
    const auto azimuths = [&](const Vec& from, const Vec& to, const Real& sense) {
      const Vec middle =
          Dot(from, to) < 0 ? Normalized(sense * TurnedLeft(from - to)) : Normalized(from + to);
      const Real sine = abs(from.x * middle.y - from.y * middle.x);
      for (const LegendreNode& node : nodes) {
        const Real &x = node.t, y = 1 - x;
        const Vec q = y * y * from + 2 * x * y * middle + x * x * to;
        const Real length = sqrt(Dot(q, q)), width = node.weight * 2 * sine / length;
        const Vec e = (1 / length) * q;
        const Real K = edge(e);
        for (const LegendreNode& radius : nodes) {
          const RadiusNode at = RadiusAt(distribution, order, radius, K);
          const Vec m = Normalized({alpha_x * at.r * e.x, alpha_y * at.r * e.y, 1});
          const Real solid_angle =
              width * radius.weight * at.r * at.slope * alpha_x * alpha_y * m.z * m.z * m.z;
          const Real cos_i = Dot(wi, m), cos_o = Dot(wo, m);
          sum += cos_i * cos_o * facet(cos_i, cos_o) * distribution.D(m) * solid_angle;
        }
      }
    };
    azimuths(horizon_b, horizon_a, turn);
    azimuths(horizon_a, corner, turn);
    azimuths(horizon_b, corner, -turn);
    return sum;
  }
};

// Meneveaux 2015, section 4, about visible normals: `drawn` of u1 and u2, `other` of u4 and u5; wi above the
// surface. A lobe_hint >= 0 takes that lobe whatever the decisions would be; margins are still those of the
// decisions.
template <class Distribution>
DirectionSample SampleWithInterface(const Distribution& distribution, const InterfacedFacet& facet,
                                    const Vec& wi, const NormalSample& drawn, const NormalSample& other,
                                    const Real (&u)[3], int lobe_hint) {
  DirectionSample sample;
  const Real surface = SharesOf(facet).surface;
  const Vec reflected = Reflect(wi, drawn.m);
  int lobe = u[2] < surface ? kReflection : kTransmission;
  sample.margin = static_cast<double>(Real(abs(u[2] - surface)));
  if (lobe == kReflection) {
    sample.margin = std::min(sample.margin, static_cast<double>(Real(abs(reflected.z))));
    if (reflected.z <= 0) lobe = kNone;
  }
  if (lobe_hint >= 0) lobe = lobe_hint;
  if (lobe == kNone) return sample;
  const SinCos azimuth = SinCos2Pi(u[1]);
  const Real sine = sqrt(u[0]);
  const Vec wo =
      lobe == kReflection ? reflected : Vec{sine * azimuth.cos, sine * azimuth.sin, Real(sqrt(1 - u[0]))};
  const Real pdf = PdfWithInterface(distribution, facet, wi, wo);
  if (wo.z <= 0 || pdf == 0) return sample;
  const RoughDiffuse<Distribution, InterfacedFacet> body{distribution, facet, 0};
  const RoughReflector<Distribution, DielectricFacets> interface {
    distribution, { facet.n }
  };
  sample.lobe = lobe;
  sample.wo = wo;
  sample.pdf = pdf;
  sample.weight = (interface.EvalCos(wi, wo) + body.OneNormalCos(wi, wo, other.m, true)) / pdf;
  const Vec h = wi + wo;
  const Real c = Dot(wi, h) / sqrt(Dot(h, h));
  sample.direction_kappa = lobe == kReflection ? drawn.direction_kappa : Real(1);
  sample.kappa = (1 + 1 / abs(c)) * (1 + 1 / abs(wo.z)) * sample.direction_kappa;
  const Real cos_i = Dot(wi, other.m), cos_o = Dot(wo, other.m);  // T is as they are where small
  sample.weight_kappa = sample.kappa;
  if (cos_i > 0 && cos_o > 0) sample.weight_kappa += other.direction_kappa * (1 / cos_i + 1 / cos_o);
  return sample;
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_ROUGH_DIFFUSE_H_
