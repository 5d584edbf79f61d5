// Light inside V-cavities, path by path: Meneveaux 2015 section 3.3.
#ifndef MICROLANE_SCALAR_V_CAVITY_H_
#define MICROLANE_SCALAR_V_CAVITY_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "microlane/scalar/direction.h"
#include "microlane/scalar/fresnel.h"
#include "microlane/v_cavity.h"

namespace microlane::scalar {

// Four uniform numbers in [0, 1), multiples of 2^-24, of a seed, a path and a step of it: pcg4d of Jarzynski
// and Olano 2020.
inline std::array<float, 4> UniformNumbers(std::uint64_t path, std::uint32_t seed, std::uint32_t step) {
  std::uint32_t word[4] = {static_cast<std::uint32_t>(path), static_cast<std::uint32_t>(path >> 32), seed,
                           step};
  auto& [x, y, z, w] = word;
  for (std::uint32_t& v : word) v = v * 1664525u + 1013904223u;
  for (int round = 0; round < 2; ++round) {
    x += y * w;
    y += z * x;
    z += x * y;
    w += y * z;
    if (round == 0) {
      for (std::uint32_t& v : word) v ^= v >> 16;
    }
  }
  std::array<float, 4> u;
  for (int k = 0; k < 4; ++k) u[k] = static_cast<float>(word[k] >> 8) * 0x1p-24f;
  return u;
}

template <template <class> class Distribution, class Real>
class VCavity {
 public:
  explicit VCavity(const VCavityScene& scene) : scene_(scene) {
    const double length = std::hypot(scene.wi[0], scene.wi[1], scene.wi[2]);
    wi_ = {static_cast<Real>(scene.wi[0] / length), static_cast<Real>(scene.wi[1] / length),
           static_cast<Real>(scene.wi[2] / length)};
    const double n = scene.n_i, n2 = n * n, largest = std::min(1.0, 1.01 * 4 * n / Square(n + 1));
    leave_ = scene.k / (largest * scene.k + n2 * (1 - scene.k));
    stay_ = largest * leave_;
  }

  enum class End { kLeft, kAbsorbed, kCut };
  struct Path {
    End end;
    std::uint32_t hits;
    Vec3<Real> wo;  // where it left
  };

  Path Trace(std::uint64_t number) const {
    Vec3<Real> i;
    Facet facet = Enter(number, i);
    std::uint32_t hits = 0;
    bool inside = false;  // in the body, whatever the interface reflects
    for (std::uint32_t step = 1;; ++step) {
      Vec3<Real> o;
      const Event event = Scatter(number, step, facet, i, inside, o);
      inside = event == Event::kTriesAgain;
      if (inside) continue;
      ++hits;
      if (event == Event::kAbsorbed) return {End::kAbsorbed, hits, {0, 0, 0}};
      // o meets the other facet, of the normal m' = (-s, 0, c), at t (o.m)/-(o.m').
      const Real away = facet.s * o.x + facet.c * o.z, towards = facet.s * o.x - facet.c * o.z;
      const Real reach = facet.t * std::max(Real(0), away);
      if (!(towards > 0 && reach <= towards)) {
        const Vec3<Real> wo{o.x * facet.ex - o.y * facet.ey, o.x * facet.ey + o.y * facet.ex, o.z};
        return {End::kLeft, hits, wo};
      }
      if (hits == scene_.max_hits) return {End::kCut, hits, {0, 0, 0}};
      // Half a turn about z makes the other facet the first.
      facet.t = reach / towards;
      facet.ex = -facet.ex;
      facet.ey = -facet.ey;
      i = {o.x, o.y, -o.z};
    }
  }

  // Of rows of equal height and columns of equal azimuth.
  std::size_t Cell(const Vec3<Real>& wo) const {
    const auto place = [](double part, std::size_t number) {
      const double at = std::max(0.0, part) * static_cast<double>(number);
      return std::min(static_cast<std::size_t>(at), number - 1);
    };
    const double turns = std::atan2(wo.y, wo.x) / (2 * kPi<Real>);
    return place(wo.z, scene_.rows) * scene_.columns + place(turns < 0 ? turns + 1 : turns, scene_.columns);
  }

  // As VCavityCalls::Trace.
  VCavityTotals Trace(std::uint64_t first, std::uint64_t count, std::uint64_t* counts) const {
    VCavityTotals totals;
    for (std::uint64_t number = first; number != first + count; ++number) {
      const Path path = Trace(number);
      totals.hits += path.hits;
      totals.absorbed += path.end == End::kAbsorbed;
      totals.cut += path.end == End::kCut;
      if (path.end != End::kLeft) continue;
      const std::size_t order = std::min<std::size_t>(path.hits, scene_.orders) - 1;
      ++counts[order * scene_.rows * scene_.columns + Cell(path.wo)];
    }
    return totals;
  }

 private:
  // The facet t (-c, s), t from 0 to 1, in a frame whose x is turned by (ex, ey) from the world's, along its
  // normal (s, 0, c); y runs along the cavity.
  struct Facet {
    Real s, c, t, ex, ey;
  };
  enum class Event { kLeaves, kAbsorbed, kTriesAgain };

  // A cavity by D cos, a facet by what wi sees of the two, a point uniform on what it sees of the facet.
  Facet Enter(std::uint64_t number, Vec3<Real>& i) const {
    const auto [u1, u2, u3, u4] = UniformNumbers(number, scene_.seed, 0);
    const Distribution<Real> distribution{static_cast<Real>(scene_.alpha_x),
                                          static_cast<Real>(scene_.alpha_y)};
    const Vec3<double> m = distribution.SampleNormal(u1, u2).m;
    const double sine = std::sqrt(m.x * m.x + m.y * m.y);
    Facet facet{static_cast<Real>(sine), static_cast<Real>(std::max(m.z, 0x1p-16)), 1,
                sine == 0 ? Real(1) : static_cast<Real>(m.x / sine),
                sine == 0 ? Real(0) : static_cast<Real>(m.y / sine)};
    i = {wi_.x * facet.ex + wi_.y * facet.ey, wi_.y * facet.ex - wi_.x * facet.ey, wi_.z};
    const Real z = facet.c * wi_.z;
    Real across = facet.s * i.x;
    if (2 * z * u3 < z - across) {
      facet.ex = -facet.ex;
      facet.ey = -facet.ey;
      i.x = -i.x;
      i.y = -i.y;
      across = -across;
    }
    facet.t = 1 - u4 * (2 * z / std::max(z + across, 2 * z));
    return facet;
  }

  Event Scatter(std::uint64_t number, std::uint32_t step, const Facet& facet, const Vec3<Real>& i,
                bool inside, Vec3<Real>& o) const {
    const Real s = facet.s, c = facet.c, cos_i = s * i.x + c * i.z;
    const Vec3<Real> reflected{2 * cos_i * s - i.x, -i.y, 2 * cos_i * c - i.z};
    if (scene_.facets == VCavityFacets::kMirror) {
      o = reflected;
      return Event::kLeaves;
    }
    const auto [u1, u2, u3, u4] = UniformNumbers(number, scene_.seed, inside ? step | 0x80000000u : step);
    if (!inside && !(u4 < Transmittance(cos_i))) {
      o = reflected;
      return Event::kLeaves;
    }
    // By the cosine with the normal, cos_o, through the interface: Meneveaux 2015 Eq. 8 once those that it
    // sends back have tried again.
    const SinCos<Real> phi = SinCos2Pi<Real>(u1);
    const Real r = std::sqrt(Real(u2)), along = r * phi.cos, cos_o = std::sqrt(1 - Real(u2));
    o = {c * along + s * cos_o, r * phi.sin, c * cos_o - s * along};
    if (u3 < Transmittance(cos_o) * leave_) return Event::kLeaves;
    return u3 < stay_ ? Event::kTriesAgain : Event::kAbsorbed;
  }

  double Transmittance(Real cosine) const {
    return FresnelDielectric<Real>(Square(Wide<Real>(cosine)), static_cast<Real>(scene_.n_i)).Transmittance();
  }

  VCavityScene scene_;
  Vec3<Real> wi_;
  double leave_, stay_;
};

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_V_CAVITY_H_
