// Facets that scatter, over any distribution of normals that gives its radius here: Heitz 2014 Eq. 31 and
// Meneveaux 2015 Eq. 12, by the nodes that quadrature.h of the kernels describes.
#ifndef MICROLANE_SCALAR_ROUGH_DIFFUSE_H_
#define MICROLANE_SCALAR_ROUGH_DIFFUSE_H_

#include <algorithm>
#include <cmath>
#include <vector>

#include "microlane/scalar/beckmann.h"
#include "microlane/scalar/direction.h"
#include "microlane/scalar/fresnel.h"
#include "microlane/scalar/ggx.h"
#include "microlane/scalar/legendre.h"
#include "microlane/scalar/smith.h"

namespace microlane::scalar {

// A slope's length r at unit roughness, seen along an azimuth whose edge is at 1/K: the density of slopes
// there times pi r dr, and 1 - K r without cancellation.
struct RadiusNode {
  double r, weight, rest;
};

// r = p/(1 + K + K p), p = tan(pi t/2).
template <class Real>
RadiusNode RadiusAt(const Ggx<Real>&, int, const LegendreNode& node, double K) {
  const double p = node.t < 0.5   ? std::tan(kPi<double> / 2 * node.t)
                   : node.t > 0.5 ? 1 / std::tan(kPi<double> / 2 * node.rest)
                                  : 1;
  const double scale = 1 + K + K * p, r = p / scale, rest = (1 + K) / scale;
  const double slope = kPi<double> / 2 * (1 + p * p) * rest / scale;  // dr/dt
  return {r, node.weight * slope * r / Square(1 + r * r), rest};
}

// r = t min(1/K, R), R^2 = 1 + 1.5 order.
template <class Real>
RadiusNode RadiusAt(const Beckmann<Real>&, int order, const LegendreNode& node, double K) {
  const double R = std::sqrt(1 + 1.5 * order), end = K * R > 1 ? 1 / K : R, r = node.t * end;
  const double rest = K * R > 1 ? node.rest : 1 - K * r;
  return {r, node.weight * end * r * std::exp(-r * r), rest};
}

// What a facet scatters, as a part of what a white Lambertian does: by wi.m and wo.m, and independent of
// them.
template <class Real>
struct LambertianFacet {
  double operator()(double, double) const { return 1; }
  double Albedo() const { return 1; }
};
template <class Real>
struct InterfacedFacet {
  Real n, k;

  double operator()(double cos_i, double cos_o) const {
    using W = Wide<Real>;
    const auto transmittance = [&](double c) {
      return FresnelDielectric<Real>(Square(W(c)), Clamp<Real>(n, 1, 4)).Transmittance();
    };
    return transmittance(cos_i) * transmittance(cos_o);
  }
  double Albedo() const { return BodyAlbedo<Real>(n, k); }
};
template <class Real>
bool IsNan(const LambertianFacet<Real>&) {
  return false;
}
template <class Real>
bool IsNan(const InterfacedFacet<Real>& facet) {
  return AnyNan(facet.n, facet.k);
}

// Of one facet, or a flat surface: Meneveaux 2015 Eq. 8.
template <class Real>
Real FacetBody(Real cos_i, Real cos_o, Real n, Real k) {
  if (AnyNan(cos_i, cos_o, n, k)) return kNan<Real>;
  if (!(cos_i > 0 && cos_o > 0)) return 0;
  const InterfacedFacet<Real> facet{n, k};
  return static_cast<Real>(facet(cos_i, cos_o) * facet.Albedo() / kPi<double>);
}

template <template <class> class Distribution, class Real, Masking masking, class Facet>
struct RoughDiffuse {
  Distribution<Real> distribution;
  Facet facet;
  int order;  // of the quadrature

  // f |wo.n|.
  Real Eval(const Vec3<Real>& wi, Vec3<Real> wo) const {
    if (AnyNan(wi, wo, distribution, facet)) return kNan<Real>;
    const Vec3<Real> up{wi.x, wi.y, std::abs(wi.z)};
    wo.z = wi.z < 0 ? -wo.z : wo.z;
    if (!(up.z > 0 && wo.z > 0)) return 0;
    const double white = Sum(up, wo) * G2OverCos<masking>(distribution, up, wo) / Square(kPi<double>);
    return Saturate<Real>(white * facet.Albedo());
  }

 private:
  struct Vec2 {
    double x, y;
  };
  static double Along(const Vec2& a, const Vec2& e) { return a.x * e.x + a.y * e.y; }
  static double Length(const Vec2& a) { return std::sqrt(Square(a.x) + Square(a.y)); }
  static Vec2 Unit(const Vec2& a, const Vec2& otherwise) {
    const double length = Length(a);
    return length == 0 ? otherwise : Vec2{a.x / length, a.y / length};
  }
  // a b - c d, which may cancel.
  static double Difference(Real a, Real b, Real c, Real d) {
    using W = Wide<Real>;
    return Narrow<double>(W(a) * W(b) - W(c) * W(d));
  }

  // Int <wi.m> <wo.m> facet D(m) dm, times pi.
  double Sum(const Vec3<Real>& wi, const Vec3<Real>& wo) const {
    const double alpha_x = distribution.alpha_x, alpha_y = distribution.alpha_y, zi = wi.z, zo = wo.z;
    // Horizontal parts of A, B and zo A - zi B, which is across the corner's azimuth, and A x B.
    const Vec2 a{alpha_x * wi.x, alpha_y * wi.y}, b{alpha_x * wo.x, alpha_y * wo.y};
    const Vec2 c{alpha_x * Difference(wi.x, wo.z, wo.x, wi.z), alpha_y * Difference(wi.y, wo.z, wo.y, wi.z)};
    const double turned = Difference(wi.x, wo.y, wi.y, wo.x), turn = turned < 0 ? -1 : 1;
    const double cross = alpha_x * alpha_y * std::abs(turned);
    const Vec2 along_a = Unit(a, Unit(b, {1, 0})), along_b = Unit(b, along_a), along_c = Unit(c, along_a);
    const Vec2 horizon_a{-turn * along_a.y, turn * along_a.x}, horizon_b{turn * along_b.y, -turn * along_b.x};
    const Vec2 corner{turn * along_c.y, -turn * along_c.x};
    const double length_a = Length(a), length_b = Length(b), length_c = Length(c);
    const std::vector<LegendreNode> nodes = LegendreNodes(order);

    // Facets towards e: the sum over radii with A.U = zi rest + r a_rises, B.U = zo rest + r b_rises.
    const auto radii = [&](const Vec2& e, double K, double a_rises, double b_rises) {
      const double slope2 = Square(alpha_x * e.x) + Square(alpha_y * e.y);
      double sum = 0;
      for (const LegendreNode& node : nodes) {
        const auto [r, weight, rest] = RadiusAt(distribution, order, node, K);
        const double of_i = zi * rest + r * a_rises, of_o = zo * rest + r * b_rises;
        const double length = std::sqrt(1 + r * r * slope2);
        sum += weight * of_i * of_o / length * facet(of_i / length, of_o / length);
      }
      return sum;
    };
    double sum = Azimuths(nodes, {horizon_b, horizon_a, turn, length_b, length_a, cross},
                          [&](const Vec2& e, double of_b, double of_a) { return radii(e, 0, of_a, of_b); });
    sum += Azimuths(
        nodes, {horizon_a, corner, turn, length_a, length_c, zi * cross},
        [&](const Vec2& e, double falls, double across) { return radii(e, falls / zi, 0, across / zi); });
    sum += Azimuths(
        nodes, {horizon_b, corner, -turn, length_b, length_c, zo * cross},
        [&](const Vec2& e, double falls, double across) { return radii(e, falls / zo, across / zo, 0); });
    return sum;
  }

  // Azimuths from j to k, within half a turn to the side of `turn`; vectors of lengths u and v at right
  // angles to j and to k, and |u x v|.
  struct Arc {
    Vec2 j, k;
    double turn, u, v, cross;
  };

  // The integral over the arc of function(e, u.e, v.e). Where j and k are next to each other, what is between
  // them keeps its digits in the cross product.
  template <class Function>
  static double Azimuths(const std::vector<LegendreNode>& nodes, const Arc& arc, const Function& function) {
    const Vec2 &j = arc.j, &k = arc.k;
    const bool wide = Along(j, k) < 0;
    const Vec2 m =
        wide ? Unit({arc.turn * (k.y - j.y), arc.turn * (j.x - k.x)}, j) : Unit({j.x + k.x, j.y + k.y}, j);
    const double v_at_j = arc.u == 0 ? 0 : arc.cross / arc.u, u_at_k = arc.v == 0 ? 0 : arc.cross / arc.v;
    const double sine = wide         ? std::abs(j.x * m.y - j.y * m.x)
                        : arc.v == 0 ? 0
                                     : v_at_j / arc.v / (2 * Along(j, m));
    double sum = 0;
    for (const LegendreNode& node : nodes) {
      const double first = Square(node.rest), middle = 2 * node.t * node.rest, last = Square(node.t);
      const Vec2 q{first * j.x + middle * m.x + last * k.x, first * j.y + middle * m.y + last * k.y};
      const double length = Length(q);
      sum += node.weight * 2 * sine / length *
             function({q.x / length, q.y / length}, (middle * arc.u * sine + last * u_at_k) / length,
                      (middle * arc.v * sine + first * v_at_j) / length);
    }
    return sum;
  }
};

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_ROUGH_DIFFUSE_H_
