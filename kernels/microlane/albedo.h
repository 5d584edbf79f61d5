// Albedo of a rough surface's specular lobe, tabulated once for a material and looked up in lanes.
//
// a(mu) = Int f cos(theta_o) dwo at |cos(theta_i)| = mu, and what it leaves to other light, 1 - a. The slopes
// (x, y) of facets that reflect into the upper side fill the disc (x - tan)^2 + y^2 < 1/cos^2 about theta_i's
// tangent; on a line of constant x their cosines to wi have one factor in common. Two substitutions that
// follow the peak of the slopes and the edge of the disc leave smooth integrands to Gauss-Legendre nodes.
//
// A table holds both at nodes, and cells between them are linear in mu. With an offset c = 2^-k, nodes stand
// at x = c + (1 - c) mu = 2^(j/32 - k), each octave cut into 32 equal cells: as near to each other about
// grazing as the roughness asks for, and found from the bits of x.
//
// Error of what is looked up, against the quadrature: at most 6e-5 for WardLobe, m from 1e-4 to 10 and
// indices up to 4; beyond them, and with Smith's masking at alpha above 1, up to 7e-4 was found.
#ifndef MICROLANE_ALBEDO_H_
#define MICROLANE_ALBEDO_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "microlane/albedo_entries.h"
#include "microlane/kernel_list.h"
#include "microlane/packets.h"
#include "microlane/prepared.h"

namespace microlane {

// The lobe f of facets that reflect F.
enum class LobeMasking {
  kKelemen,           // P_H F/(h.h), P_H = D cos(theta_h): Kelemen 2001 Eq. 3
  kHeightCorrelated,  // Walter 2007 Eq. 20 with Smith's masking: Heitz 2014 Eq. 99
  kSeparable,         // the same with Heitz 2014 Eq. 98
};

struct SpecularLobe {
  Normals normals;
  double roughness;  // alpha of GGX and Beckmann, exponent of Phong (which takes Kelemen's lobe alone)
  LobeMasking masking = LobeMasking::kKelemen;
  Reflector facets = Reflector::kConductor;  // at kappa = 0 a dielectric
  double n = 1.5, kappa = 0;                 // of a conductor
  double f0 = 0.04;                          // of Schlick's
};

// Kelemen 2001 Eqs. 3, 4: P_H of Ward, which is D cos(theta_h) of Beckmann, over a dielectric.
inline SpecularLobe WardLobe(double m, double index) {
  SpecularLobe lobe{Normals::kBeckmann, m};
  lobe.n = index;
  return lobe;
}
constexpr bool IsWardLobe(const SpecularLobe& lobe) {
  return lobe.normals == Normals::kBeckmann && lobe.masking == LobeMasking::kKelemen &&
         lobe.facets == Reflector::kConductor && lobe.kappa == 0;
}

class AlbedoTable : public Prepared {
 public:
  // Refuses parameters outside the kernel list's ranges, and facets with total internal reflection, whose
  // kink no table follows.
  explicit AlbedoTable(const SpecularLobe& lobe);
  AlbedoTable(const AlbedoTable&) = delete;
  AlbedoTable& operator=(const AlbedoTable&) = delete;

  const SpecularLobe& lobe() const { return lobe_; }
  // 2 Int a(mu) mu dmu.
  double average() const { return 1 - entries_.mean_deficit; }
  const AlbedoEntries& entries() const { return entries_; }
  std::size_t bytes() const {
    return floats_.size() * sizeof(float) + doubles_.size() * sizeof(double) +
           guide_.size() * sizeof(guide_[0]);
  }

 private:
  void MakeGuide();

  SpecularLobe lobe_;
  AlbedoEntries entries_{};
  std::vector<float> floats_;
  std::vector<double> doubles_;
  std::vector<std::uint32_t> guide_;
};

// a(mu) by the quadrature that tables are made with, for a lobe that a table takes.
double DirectionalAlbedo(const SpecularLobe& lobe, double mu);

namespace albedo {

// a and 1 - a at the cosines cos_i (their signs are ignored), from a table. albedo.directional.
template <class T>
void Directional(std::size_t n, const T* cos_i, const AlbedoTable& table, T* albedo, T* deficit,
                 Accuracy accuracy = Accuracy::kStandard);

}  // namespace albedo

}  // namespace microlane

#endif  // MICROLANE_ALBEDO_H_
