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
#include "microlane/scalar/rough_dielectric.h"
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

// What a normal makes of f |wo.n|, over D_visible of wi or over D cos: Meneveaux 2015 Eq. 28.
template <Masking masking, bool visible, template <class> class Distribution, class Real, class Facet>
Real OneNormal(const Distribution<Real>& distribution, const Facet& facet, const Vec3<Real>& wi,
               const Vec3<Real>& wo, const Vec3<Real>& m) {
  if (AnyNan(wi, wo, m, distribution, facet)) return kNan<Real>;
  const double side = wi.z < 0 ? -1 : 1;
  const double cos_i = side * Narrow<double>(Dot(Widen(wi), Widen(m)));
  const double cos_o = side * Narrow<double>(Dot(Widen(wo), Widen(m)));
  if (!(cos_i > 0 && cos_o > 0 && m.z > 0 && side * wi.z > 0 && side * wo.z > 0)) return 0;
  const double masked = G2OverCos<masking>(distribution, wi, wo), cosine = std::abs(wi.z);
  const double weight = visible ? masked * (cosine + distribution.ScaledLambda(wi, 1)) : masked * cos_i / m.z;
  return Saturate<Real>(weight * cos_o * facet(cos_i, cos_o) * facet.Albedo() / kPi<double>);
}

// What of diffuse light a flat surface's interface and body reflect, as parts of both: Meneveaux 2015 section
// 4. 0 and 1 where both are 0.
struct InterfaceShares {
  double surface, body;
};
template <class Real>
InterfaceShares SharesOf(const InterfacedFacet<Real>& facet) {
  const double r_e = DiffuseFresnel(Clamp<double>(facet.n, 1, 4), true);
  const double r_b = Square(1 - r_e) * facet.Albedo(), sum = r_e + r_b;
  if (!(sum > 0)) return {0, 1};
  return {r_e / sum, r_b / sum};
}

// Density of directions from the interface's visible normals or from the cosine.
template <template <class> class Distribution, class Real>
Real PdfWithInterface(const Distribution<Real>& distribution, const InterfacedFacet<Real>& facet,
                      const Vec3<Real>& wi, const Vec3<Real>& wo) {
  if (AnyNan(wi, wo, distribution, facet)) return kNan<Real>;
  if (!(wi.z > 0 && wo.z > 0) && !(wi.z < 0 && wo.z < 0)) return 0;
  const InterfaceShares shares = SharesOf(facet);
  const double pdf = PdfVisibleReflection(distribution, wi, wo, false);
  return Saturate<Real>(shares.surface * pdf + shares.body * std::abs(wo.z) / kPi<double>);
}

// wo by the interface's visible normal of u1 and u2, or by the cosine; weighed by f |wo.n| of interface and
// body, the body's about the visible normal of u4 and u5.
template <Masking masking, template <class> class Distribution, class Real>
DirectionSample<Real> SampleWithInterface(const Distribution<Real>& distribution,
                                          const InterfacedFacet<Real>& facet, const Vec3<Real>& wi,
                                          const Real (&u)[5]) {
  if (AnyNan(wi, u[0], u[1], u[2], u[3], u[4], distribution, facet)) {
    return {{kNan<Real>, kNan<Real>, kNan<Real>}, kNan<Real>, kNan<Real>, kNoLobe};
  }
  constexpr DirectionSample<Real> none{{0, 0, 0}, 0, 0, kNoLobe};
  if (wi.z == 0) return none;
  const Vec3<Real> view{wi.x, wi.y, std::abs(wi.z)};
  const Vec3<double> v{view.x, view.y, view.z};
  const Distribution<double> wide{distribution.alpha_x, distribution.alpha_y};
  const InterfacedFacet<double> wide_facet{facet.n, facet.k};
  const bool specular = u[2] < SharesOf(facet).surface;
  Vec3<double> wo;
  if (specular) {
    wo = Reflect(v, distribution.SampleVisibleNormal(view, u[0], u[1]).m);
  } else {
    const double radius2 = std::min<double>(u[0], 1 - 0x1p-53), radius = std::sqrt(radius2);
    const SinCos<double> azimuth = SinCos2Pi(static_cast<double>(u[1]));
    wo = {radius * azimuth.cos, radius * azimuth.sin, std::sqrt(1 - radius2)};
  }
  const double pdf = PdfWithInterface(wide, wide_facet, v, wo);
  if (!(wo.z > 0 && pdf > 0)) return none;
  const RoughDielectric<Distribution, double, masking> surface{wide, Clamp<double>(facet.n, 1, 4),
                                                               Transport::kRadiance};
  const Vec3<double> m = distribution.SampleVisibleNormal(view, u[3], u[4]).m;
  const double value =
      surface.Eval(v, wo, kReflection) + OneNormal<masking, true>(wide, wide_facet, v, wo, m);
  const Vec3<double> out{wo.x, wo.y, wi.z < 0 ? -wo.z : wo.z};
  return {Narrow<Real>(out), Saturate<Real>(value / pdf), Saturate<Real>(pdf),
          specular ? kReflection : kTransmission};
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
