// Curves of directions in the plane of incidence.
#ifndef MICROLANE_BENCH_CURVES_H_
#define MICROLANE_BENCH_CURVES_H_

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include "microlane/packets.h"

namespace microlane {

inline constexpr double kDegree = 3.14159265358979323846 / 180;

struct Curve {
  std::string title;
  int colour;  // of the plots' colours
  bool dashed;
  std::vector<double> x, y;
};

// Directions of the plane of incidence from one horizon to the other, and one that light comes from.
struct Plane {
  explicit Plane(double incidence) {
    for (int i = -899; i <= 899; ++i) {
      const double angle = 0.1 * i * kDegree;
      x.push_back(static_cast<float>(std::sin(angle)));
      z.push_back(static_cast<float>(std::cos(angle)));
    }
    y.assign(x.size(), 0);
    from_x.assign(x.size(), static_cast<float>(-std::sin(incidence * kDegree)));
    from_z.assign(x.size(), static_cast<float>(std::cos(incidence * kDegree)));
  }
  std::size_t size() const { return x.size(); }
  // Degrees from the normal, positive on the side of the mirror direction.
  static double DegreesAt(std::size_t i) { return 0.1 * static_cast<double>(i) - 89.9; }
  Directions<float> out() const { return {x.data(), y.data(), z.data()}; }
  Directions<float> from() const { return {from_x.data(), y.data(), from_z.data()}; }

  std::vector<float> x, y, z, from_x, from_z;
};

// Values of the plane's directions over degrees.
inline Curve OverDegrees(const Plane& plane, const std::vector<float>& values, const std::string& title,
                         int colour, bool dashed) {
  Curve curve{title, colour, dashed, {}, {}};
  for (std::size_t i = 0; i < plane.size(); ++i) {
    curve.x.push_back(Plane::DegreesAt(i));
    curve.y.push_back(static_cast<double>(values[i]));
  }
  return curve;
}

}  // namespace microlane

#endif  // MICROLANE_BENCH_CURVES_H_
