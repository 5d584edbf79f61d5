// The figures of Meneveaux 2015.
#ifndef MICROLANE_BENCH_MENEVEAUX_H_
#define MICROLANE_BENCH_MENEVEAUX_H_

#include <vector>

#include "curves.h"

namespace microlane {

// By the lanes of the chosen target, high accuracy, in the plane of incidence.
struct MeneveauxFigures {
  std::vector<Curve> albedos;     // for Fig. 4: diffuse reflectance R_b over K_d, flat
  std::vector<Curve> flat;        // Fig. 5: the body of a flat surface, K_d = 0.6
  std::vector<Curve> rough[2];    // Fig. 8: bodies of n = 1.1 and 1.5, light at 60 degrees
  std::vector<Curve> oren_nayar;  // Fig. 9: with Oren-Nayar and specular facets, light at 60 degrees
};
MeneveauxFigures MeasureMeneveaux();

}  // namespace microlane

#endif  // MICROLANE_BENCH_MENEVEAUX_H_
