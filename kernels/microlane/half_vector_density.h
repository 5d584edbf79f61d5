// Densities P_H of half vectors over solid angle (Kelemen 2001 Eqs. 4, 5) in batches: D cos(theta_m) of a
// distribution of normals.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function; NaN in gives NaN out in that lane. 0 where m.z <= 0.
#ifndef MICROLANE_HALF_VECTOR_DENSITY_H_
#define MICROLANE_HALF_VECTOR_DENSITY_H_

#include <cstddef>

#include "microlane/packets.h"

namespace microlane::half_vector_density {

// exp(-tan^2/alpha^2) / (pi alpha^2 cos^3), that of Beckmann: alpha is Kelemen's m. half_vector_density.ward.
template <class T>
void Ward(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> alpha, T* density,
          Accuracy accuracy = Accuracy::kStandard);

// (exponent + 2)/(2 pi) cos^(exponent + 1), that of Phong's D: Kelemen's n is exponent + 1.
// half_vector_density.phong.
template <class T>
void Phong(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> exponent, T* density,
           Accuracy accuracy = Accuracy::kStandard);

}  // namespace microlane::half_vector_density

#endif  // MICROLANE_HALF_VECTOR_DENSITY_H_
