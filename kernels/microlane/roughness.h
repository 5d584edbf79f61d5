// Roughness as the moments of its slopes (LEAN, Olano and Baker 2010; LEADR, Dupuy et al. 2013), which
// textures filter linearly, in batches.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function; NaN in gives NaN out in that lane. An output may be the same
// array as an input; other overlap is not allowed.
//
// The slopes (x, y) = (-m.x/m.z, -m.y/m.z) of normals m have the means E[x], E[y], and variances alpha_x^2/2
// and alpha_y^2/2 of correlation r_xy, which are Beckmann's; those of GGX are infinite, and its alphas the
// same by convention. Off-centre roughness of normals.h takes the means as they are.
#ifndef MICROLANE_ROUGHNESS_H_
#define MICROLANE_ROUGHNESS_H_

#include <cstddef>

#include "microlane/packets.h"

namespace microlane::roughness {

// alpha_x, alpha_y and r_xy from the means and E[x^2], E[y^2], E[x y]. Variances that filtering left below
// those of alpha = 1e-5, or above those of 100, count as these, correlations beyond 0.9999 as that.
// roughness.from_moments.
template <class T>
void FromMoments(std::size_t n, const T* mean_x, const T* mean_y, const T* moment_xx, const T* moment_yy,
                 const T* moment_xy, T* alpha_x, T* alpha_y, T* r_xy,
                 Accuracy accuracy = Accuracy::kStandard);

// E[x^2], E[y^2] and E[x y]. roughness.to_moments.
template <class T>
void ToMoments(std::size_t n, const T* alpha_x, const T* alpha_y, const T* r_xy, const T* mean_x,
               const T* mean_y, T* moment_xx, T* moment_yy, T* moment_xy,
               Accuracy accuracy = Accuracy::kStandard);

}  // namespace microlane::roughness

#endif  // MICROLANE_ROUGHNESS_H_
