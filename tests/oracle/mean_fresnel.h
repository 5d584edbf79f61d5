// Fresnel's mean over visible normals: Heitz 2014, Eq. 105, summed over the normals of
// kernels/microlane/quadrature.h, and the fit of mean_fresnel_fit.h.
#ifndef MICROLANE_TESTS_ORACLE_MEAN_FRESNEL_H_
#define MICROLANE_TESTS_ORACLE_MEAN_FRESNEL_H_

#include "microlane/mean_fresnel_fit.h"
#include "oracle/fresnel.h"
#include "oracle/rough_diffuse.h"

namespace microlane::oracle {

// node(m, weight, the kappa of Metric::kDirection) for each normal of the rule; of GGX the points of its
// caps, each with the area of the ring that it stands for.
template <class Node>
void ForVisible(const Ggx& ggx, const Vec& v, int order, const Node& node) {
  for (const LegendreNode& of_u : LegendreNodes(order)) {
    const Real u = (1 - cos(Pi() * of_u.t)) / 2, weight = of_u.weight * sin(Pi() * of_u.t);
    for (int j = 0; j < 2 * order; ++j) {
      const CapNormal normal = VisibleNormal(v, u, (j + Real(0.5)) / (2 * order), ggx.alpha);
      // Of M, and of H, whose square is v.M.
      const Real of_m = CapCancellation(normal, ggx.alpha), of_h = CapCancellation(normal, {1, 1});
      node(normal.m, weight, of_m > of_h ? of_m : of_h);
    }
  }
}
// Of Beckmann, slopes with the density of those of visible normals.
template <class Node>
void ForVisible(const Beckmann& beckmann, const Vec& v, int order, const Node& node) {
  const Real &ax = beckmann.alpha.alpha_x, &ay = beckmann.alpha.alpha_y, R = sqrt(Real(6) / 10 * (order + 1));
  const Vec q{ax * v.x, ay * v.y, 0};
  const Real length = sqrt(Dot(q, q));
  const Vec e = length > 0 ? Normalized(q) : Vec{1, 0, 0};
  const Real first = length * R > v.z ? Real(-v.z / length) : Real(-R);
  for (const LegendreNode& along : LegendreNodes(order)) {
    const Real t = first + along.t * (R - first);
    for (const LegendreNode& across : LegendreNodes(order)) {
      const Real y = (2 * across.t - 1) * R;
      const Vec h{e.x * t - e.y * y, e.y * t + e.x * y, 1}, M{ax * h.x, ay * h.y, 1};
      const Vec sizes{abs(e.x * t) + abs(e.y * y), abs(e.y * t) + abs(e.x * y), 1};
      node(Normalized(M), along.weight * across.weight * Dot(v, M) * exp(-t * t - y * y),
           Cancellation(sizes, h, beckmann.alpha));
    }
  }
}

struct MeanReflectance {
  Real mean, kappa;
};

// kappa: Metric::kConditioned.
template <class Distribution, class Reflectance>
MeanReflectance MeanFresnel(const Distribution& distribution, Vec v, int order, const Reflectance& F) {
  if (IsZero(v)) return {0, 1};
  v.z = abs(v.z);
  Real sum = 0, change = 0, total = 0;
  ForVisible(distribution, v, order, [&](const Vec& m, const Real& weight, const Real& direction_kappa) {
    const Real c = Dot(v, m), e = c * direction_kappa * Real(0x1p-21);
    const Real f = F(c);
    sum += weight * f;
    change += weight * (abs(F(c + e) - f) + abs(F(c > e ? Real(c - e) : Real(0)) - f));
    total += weight;
  });
  if (!(sum > 0)) return {0, change > 0 ? Infinity() : Real(1)};
  return {sum / total, 1 + change / (sum * Real(0x1p-21))};
}

inline Real MeanFresnelCosine(const Real& cos_i, const Real& alpha, const double (&k)[7][7]) {
  const Real largest = kLargestAlphaOfFit, a = alpha < largest ? alpha : largest, c = abs(cos_i);
  const Real s2 = c < 1 ? Real(1 - c * c) : Real(0);
  const Real r = sqrt(c * c + a * a * s2), x = 2 * c / r - 1, y = 2 * sqrt(a / largest) - 1;
  Real sum = 0;
  for (int i = 0; i < 7; ++i) {
    for (int j = 0; j < 7; ++j) sum += Real(k[i][j]) * pow(x, i) * pow(y, j);
  }
  const Real cosine = r / (1 + a) * sum;
  return cosine < 1 ? cosine : Real(1);
}

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_MEAN_FRESNEL_H_
