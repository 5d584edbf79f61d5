// Light inside V-cavities, simulated path by path (Meneveaux 2015 section 3.3, Eqs. 22, 23): all that facets
// pass on to each other, which single-bounce models leave out.
//
// A V-cavity is two facets of unit width, with normals m and (-m.x, -m.y, m.z), much longer than wide. A path
// comes from wi to a facet drawn from those that wi sees and to a point uniform on the part that it sees, is
// scattered from facet to facet, and counts 1 in the cell of the hemisphere that it leaves through, under the
// number of its hits. What a facet absorbs ends the path (Russian roulette with the facet's albedo), so that
// every path has the weight 1 and counts are exact.
#ifndef MICROLANE_V_CAVITY_H_
#define MICROLANE_V_CAVITY_H_

#include <cstddef>
#include <cstdint>
#include <string>

#include "microlane/kernel_list.h"

namespace microlane {

enum class VCavityFacets {
  kMirror,      // F = 1
  kInterfaced,  // a Lambertian of albedo k under an interface of index n_i (Meneveaux 2015 Eqs. 7, 8)
};

struct VCavityScene {
  double alpha_x = 0.5, alpha_y = 0.5;  // 1e-5 to 100; facets above 89.999 degrees count as of that slope
  VCavityFacets facets = VCavityFacets::kInterfaced;
  double n_i = 1.5, k = 0;   // 1 to 4, 0 to 1; mirrors have none
  double wi[3] = {0, 0, 1};  // where light comes from, wi[2] > 0; of any finite length

  // Cells of equal solid angle: rows of equal height in cos(theta) from the horizon up, columns of equal
  // azimuth from +x on. The last of the orders counts paths of that many hits and of more.
  std::size_t rows = 36, columns = 90, orders = 4;  // at least 1; 2^26 counts at most

  std::uint32_t seed = 0;
  std::uint32_t max_hits = 0;  // ends paths that meet more facets; 0: none
};

// What became of paths that are in no cell, and how many facets all paths met.
struct VCavityTotals {
  std::uint64_t hits = 0, absorbed = 0, cut = 0;
};

// Empty, or what is wrong with the scene, with name, value and range.
std::string VCavityError(const VCavityScene& scene);

// The number of counts: orders x rows x columns.
std::size_t VCavityCounts(const VCavityScene& scene);

// Over one distribution of normals.
template <Normals kNormals>
class VCavityCalls {
 public:
  // Adds the paths first to first + count - 1 to counts[(order x rows + row) x columns + column], order 0
  // that of one hit. A path depends on the scene and on its number alone, so that any way to cut a range
  // gives the same sums, and so do all targets with a fused multiply-add. Nothing is traced of a scene with
  // an error. Thread-safe for different `counts`.
  static VCavityTotals Trace(const VCavityScene& scene, std::uint64_t first, std::uint64_t count,
                             std::uint64_t* counts);
};

using v_cavity = VCavityCalls<Normals::kGgx>;
using v_cavity_beckmann = VCavityCalls<Normals::kBeckmann>;

}  // namespace microlane

#endif  // MICROLANE_V_CAVITY_H_
