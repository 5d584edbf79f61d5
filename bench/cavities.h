// The simulation of V-cavities for the report.
#ifndef MICROLANE_BENCH_CAVITIES_H_
#define MICROLANE_BENCH_CAVITIES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "cavity_picture.h"

namespace microlane {

// The most facet hits a second of one core's time, of repetitions in lanes and scalar in turn.
struct CavitySpeed {
  double lanes = 0, scalar = 0;
};

struct CavityFigure {
  std::string title;
  bool ggx;
  CavityResult result;
  CavitySpeed speed;
};

// As Meneveaux 2015 Fig. 7: rough surfaces of Lambertian, interfaced and specular facets, and of mirrors, by
// `paths` paths each on all cores.
std::vector<CavityFigure> MeasureCavities(std::uint64_t paths);

}  // namespace microlane

#endif  // MICROLANE_BENCH_CAVITIES_H_
