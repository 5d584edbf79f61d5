// The four measured glasses of Walter 2007, Fig. 12: transmission in the plane of incidence.
#ifndef MICROLANE_BENCH_GLASSES_H_
#define MICROLANE_BENCH_GLASSES_H_

#include <vector>

namespace microlane {

// One row and fit of Fig. 12. The plots of Figs. 10 to 14 show the model times `scale`.
struct Fit {
  const char* glass;
  const char* distribution;
  float scale, alpha;
};
inline constexpr Fit kFits[] = {
    {"ground", "Beckmann", 0.542f, 0.344f},    {"ground", "GGX", 0.755f, 0.394f},
    {"frosted", "Beckmann", 0.629f, 0.400f},   {"frosted", "GGX", 0.861f, 0.454f},
    {"etched", "Beckmann", 0.711f, 0.493f},    {"etched", "GGX", 0.955f, 0.553f},
    {"antiglare", "Beckmann", 0.607f, 0.023f}, {"antiglare", "GGX", 0.847f, 0.027f},
};
inline constexpr float kGlassEta = 1.51f;
inline constexpr int kIncidence[] = {0, 30, 60, 80};  // degrees

// f_t |cos(theta_o)| over the transmitted angle, light coming through air at the angle of incidence, with the
// separable Smith G of the paper (Walter 2007 Eqs. 21, 23).
struct GlassCurve {
  Fit fit;
  int incidence;
  std::vector<double> angle;  // degrees from the normal inside the glass, positive on the side of refraction
  std::vector<float> high, fast;
};

// All fits and angles of incidence on the chosen target.
std::vector<GlassCurve> MeasureGlasses();

}  // namespace microlane

#endif  // MICROLANE_BENCH_GLASSES_H_
