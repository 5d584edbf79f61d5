// Phong in batches: normal density, masking by Walter's recipe, sampling of normals.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function; NaN in gives NaN out in that lane. The exponent is one value
// or one per lane, from 0 to 2e10.
#ifndef MICROLANE_PHONG_H_
#define MICROLANE_PHONG_H_

#include <cstddef>

#include "microlane/packets.h"

namespace microlane::phong {

// The exponent 2/alpha^2 - 2 that matches a Beckmann roughness; 0 for alpha >= 1. Walter 2007 after Eq. 30.
// phong.exponent.
template <class T>
void Exponent(std::size_t n, const T* alpha, T* exponent, Accuracy accuracy = Accuracy::kStandard);

// Density of normals m, in 1/sr; 0 where m.z <= 0. Walter 2007 Eq. 30. phong.D.
template <class T>
void D(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> exponent, T* d,
       Accuracy accuracy = Accuracy::kStandard);

// Masking of v for facets of normal m, 0 where v.m and v.z differ in sign. Walter 2007 Eq. 27 with
// a = sqrt(0.5 exponent + 1)/tan(theta_v), at most 1. phong.G1.
template <class T>
void G1(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> exponent, T* g1,
        Accuracy accuracy = Accuracy::kStandard);

// Normals m with density pdf = D(m) m.z, in 1/sr, from uniform numbers in [0, 1).
// Walter 2007 Eqs. 31, 32. phong.sample_normal.
template <class T>
void SampleNormal(std::size_t n, const T* u1, const T* u2, ParameterOf<T> exponent, MutableDirections<T> m,
                  T* pdf, Accuracy accuracy = Accuracy::kStandard);

}  // namespace microlane::phong

#endif  // MICROLANE_PHONG_H_
