// Pairs of directions for tests of what is smooth in both.
#ifndef MICROLANE_TESTS_PAIRS_H_
#define MICROLANE_TESTS_PAIRS_H_

#include <cstddef>

#include "columns.h"

namespace microlane {

// Pairs of directions of the upper hemisphere up to `degrees`, at every azimuth.
struct Pairs {
  DirectionColumns<double> wi, wo;

  explicit Pairs(double degrees) {
    for (const double theta_i : {0.0, 20.0, 45.0, 60.0, 75.0, 85.0}) {
      for (const double theta_o : {0.0, 20.0, 45.0, 60.0, 75.0, 85.0}) {
        if (theta_i > degrees || theta_o > degrees) continue;
        for (const double azimuth : {0.0, 10.0, 45.0, 90.0, 135.0, 170.0, 180.0, 200.0, 300.0}) {
          for (const double turned : {0.0, 0.7}) {
            wi.PushBack(Spherical(Radians(theta_i), turned));
            wo.PushBack(Spherical(Radians(theta_o), turned + Radians(azimuth)));
          }
        }
      }
    }
  }
  std::size_t size() const { return wi.size(); }
};

}  // namespace microlane

#endif  // MICROLANE_TESTS_PAIRS_H_
