// What the simulation of V-cavities takes on every target. Includes no Highway.
#ifndef MICROLANE_SRC_V_CAVITY_CALL_H_
#define MICROLANE_SRC_V_CAVITY_CALL_H_

#include <cstdint>

#include "microlane/v_cavity.h"
#include "src/dispatch.h"

namespace microlane {

// A checked scene, with what its paths share.
struct VCavityPlan {
  explicit VCavityPlan(const VCavityScene& scene);

  enum class Facets { kMirror, kLambertian, kInterfaced } facets;
  float alpha_x, alpha_y, wi[3];
  float eta2_minus_1, eta2;  // n_i^2 - 1, n_i^2
  // Of light that comes up from the body in a direction of transmittance T the share `leave` T leaves, and
  // the share 1 - `stay` is absorbed; the rest tries again. With leave = k/(T_max k + n_i^2 (1 - k)) and 1 -
  // stay = leave n_i^2 (1 - k)/k, what leaves is T k/(n_i^2 (1 - k) + k (1 - r_e)) cos/pi, Meneveaux 2015
  // Eq. 8.
  float leave, stay;
  std::uint32_t rows, columns, orders, seed, max_hits;
};

// The places of the bits of each byte, then the others.
struct PackedLanes {
  std::uint8_t row[256][8] = {};
  constexpr PackedLanes() {
    for (int bits = 0; bits < 256; ++bits) {
      int at = 0;
      for (const int wanted : {1, 0}) {
        for (int lane = 0; lane < 8; ++lane) {
          if (((bits >> lane) & 1) == wanted) row[bits][at++] = static_cast<std::uint8_t>(lane);
        }
      }
    }
  }
};
inline constexpr PackedLanes kPackedLanes;

using VCavityFunction = VCavityTotals (*)(const VCavityPlan&, std::uint64_t, std::uint64_t, std::uint64_t*);

// Each distribution's dispatch table.
template <Normals kNormals>
const VCavityFunction* VCavityTable();
template <>
const VCavityFunction* VCavityTable<Normals::kGgx>();
template <>
const VCavityFunction* VCavityTable<Normals::kBeckmann>();

template <Normals kNormals>
VCavityTotals VCavityCalls<kNormals>::Trace(const VCavityScene& scene, std::uint64_t first,
                                            std::uint64_t count, std::uint64_t* counts) {
  if (!VCavityError(scene).empty()) return {};
  return VCavityTable<kNormals>()[ChosenTableIndex()](VCavityPlan(scene), first, count, counts);
}

}  // namespace microlane

#endif  // MICROLANE_SRC_V_CAVITY_CALL_H_
