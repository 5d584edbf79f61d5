// Fresnel's mean over visible normals, Heitz 2014 Eq. 105, by the nodes that quadrature.h of the kernels
// describes, and as a fit.
#ifndef MICROLANE_SCALAR_MEAN_FRESNEL_H_
#define MICROLANE_SCALAR_MEAN_FRESNEL_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "microlane/mean_fresnel_fit.h"
#include "microlane/scalar/rough_diffuse.h"

namespace microlane::scalar {

// The sum of f(cos^2) over visible normals m, each with its share of them; cos = v.m = v.M/|M|.
//
// Spherical caps (ggx.h): s is the stretched view of length 1, r the length it had, h = c + s, and M =
// (alpha_x h.x, alpha_y h.y, h.z), so that v.M = r s.h = r h.h/2.
template <class Real, class Reflectance>
double MeanOverVisible(const Ggx<Real>& ggx, const Vec3<Real>& v, int order, const Reflectance& f) {
  const double ax = ggx.alpha_x, ay = ggx.alpha_y, z = std::abs(v.z);
  const double across = Hypot<double>(ax * v.x, ay * v.y), r = Hypot<double>(across, z);
  const double scale = r > 0 ? 1 / r : 0, sx = ax * v.x * scale, sy = ay * v.y * scale, sz = z * scale;
  double sum = 0, total = 0;
  for (const LegendreNode& node : LegendreNodes(order)) {
    const double u = Square(std::sin(kPi<double> / 2 * node.t));
    const double w = Square(std::sin(kPi<double> / 2 * node.rest)), weight = node.weight * std::sqrt(u * w);
    // 1 - c.z and 1 + c.z.
    const double below = u * (1 + sz), above = 2 * w + u * Square(across * scale) / (1 + sz);
    const double sine = std::sqrt(below * above), hz = w * (1 + sz);
    for (int j = 0; j < 2 * order; ++j) {
      const double phi = kPi<double> * (j + 0.5) / order;
      const double hx = sine * std::cos(phi) + sx, hy = sine * std::sin(phi) + sy;
      const double h2 = hx * hx + hy * hy + hz * hz;
      const double m2 = Square(ax * hx) + Square(ay * hy) + hz * hz;
      sum += weight * f(m2 > 0 ? Square(r * h2 / 2) / m2 : 0);
      total += weight;
    }
  }
  return sum / total;
}

// Slopes t along the stretched view's azimuth and y across it, of unit roughness: v.M = z + across t.
template <class Real, class Reflectance>
double MeanOverVisible(const Beckmann<Real>& beckmann, const Vec3<Real>& v, int order, const Reflectance& f) {
  const double ax = beckmann.alpha_x, ay = beckmann.alpha_y, z = std::abs(v.z);
  const double R = std::sqrt(0.6 * (order + 1)), qx = ax * v.x, qy = ay * v.y;
  const double across = Hypot<double>(qx, qy);
  const double ex = across > 0 ? qx / across : 1, ey = across > 0 ? qy / across : 0;
  const double first = across * R > z ? z / across : R, first_facing = std::max(0.0, z - across * R);
  const std::vector<LegendreNode> nodes = LegendreNodes(order);
  double sum = 0, total = 0;
  for (const LegendreNode& along : nodes) {
    const double t = along.t * R - along.rest * first;
    const double facing = along.rest * first_facing + along.t * (z + across * R);
    for (const LegendreNode& node : nodes) {
      const double y = (node.t - node.rest) * R;
      const double mx = ax * (ex * t - ey * y), my = ay * (ey * t + ex * y);
      const double weight = along.weight * node.weight * facing * std::exp(-t * t - y * y);
      sum += weight * f(Square(facing) / (1 + mx * mx + my * my));
      total += weight;
    }
  }
  return total > 0 ? sum / total : f(0.0);
}

template <class Real, template <class> class Distribution, class Reflectance>
Real MeanFresnel(const Distribution<Real>& distribution, const Vec3<Real>& v, int order,
                 const Reflectance& reflectance) {
  if (AnyNan(v, distribution)) return kNan<Real>;
  if (v.x == 0 && v.y == 0 && v.z == 0) return 0;
  return static_cast<Real>(MeanOverVisible(distribution, v, order, [&](double cos2) {
    return static_cast<double>(reflectance(Wide<Real>(cos2)));
  }));
}

// mean_fresnel_fit.h.
template <class Real>
Real MeanFresnelCosine(Real cos_i, Real alpha, const double (&k)[7][7]) {
  if (std::isnan(cos_i) || std::isnan(alpha)) return kNan<Real>;
  const double a = std::min(double{alpha}, kLargestAlphaOfFit), c = std::abs(double{cos_i});
  const double r = Hypot<double>(c, a * std::sqrt(std::max(0.0, 1 - c * c)));
  const double x = 2 * c / r - 1, y = 2 * std::sqrt(a / kLargestAlphaOfFit) - 1;
  double sum = 0;
  for (int i = 6; i >= 0; --i) {
    double row = 0;
    for (int j = 6; j >= 0; --j) row = row * y + k[i][j];
    sum = sum * x + row;
  }
  return Saturate<Real>(std::min(1.0, r / (1 + a) * sum));
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_MEAN_FRESNEL_H_
