// What `microlane cavities` writes: a table of cells and a picture.
#ifndef MICROLANE_BENCH_CAVITY_PICTURE_H_
#define MICROLANE_BENCH_CAVITY_PICTURE_H_

#include <cstddef>
#include <cstdint>
#include <ostream>
#include <string>
#include <vector>

#include "microlane/v_cavity.h"

namespace microlane {

struct CavityResult {
  VCavityScene scene;
  std::vector<std::uint64_t> counts;  // as VCavityCalls::Trace has them
  VCavityTotals totals;
  std::uint64_t paths;
};

// "1", "2", ..., and "4+" for the last order.
std::string HitsName(const VCavityScene& scene, std::size_t order);

// Paths that left after that many hits.
std::uint64_t CountOfHits(const CavityResult& result, std::size_t order);

void WriteCavityCsv(const CavityResult& result, const std::string& title, std::ostream& out);

// gnuplot's terminal for the name of a picture; empty for any but .svg and .png.
std::string PictureTerminal(const std::string& name);

// gnuplot's commands for a picture of f in the plane of incidence by the number of hits, with what the model
// without inter-reflection gives for one hit, and f of all hits on the hemisphere.
std::string CavityScript(const CavityResult& result, const std::string& title, bool ggx);

// Draws it. Empty, or what went wrong.
std::string DrawCavities(const CavityResult& result, const std::string& title, bool ggx,
                         const std::string& name);

}  // namespace microlane

#endif  // MICROLANE_BENCH_CAVITY_PICTURE_H_
