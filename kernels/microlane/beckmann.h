// Beckmann in batches: normal density, Smith masking, sampling of normals.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function; NaN in gives NaN out in that lane. Roughness is one value or
// one per lane, from 1e-5 to 100; one alpha is isotropic, two stretch along x and y (Heitz 2014 section 5).
#ifndef MICROLANE_BECKMANN_H_
#define MICROLANE_BECKMANN_H_

#include <cstddef>

#include "microlane/packets.h"

namespace microlane::beckmann {

// Density of normals m, in 1/sr; 0 where m.z <= 0. Heitz 2014 Eq. 82. beckmann.D.
template <class T>
void D(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y, T* d,
       Accuracy accuracy = Accuracy::kStandard);
// Walter 2007 Eq. 25. beckmann.D_isotropic.
template <class T>
void D(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> alpha, T* d,
       Accuracy accuracy = Accuracy::kStandard);

// Smith's Lambda of v, the same on both sides of the surface: 0 along the normal, the largest finite number
// where the exact value exceeds it (v.z = 0). Heitz 2014 Eq. 83. beckmann.Lambda.
template <class T>
void Lambda(std::size_t n, const DirectionsOf<T>& v, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y,
            T* lambda, Accuracy accuracy = Accuracy::kStandard);
// Heitz 2014 Eq. 69. beckmann.Lambda_isotropic.
template <class T>
void Lambda(std::size_t n, const DirectionsOf<T>& v, ParameterOf<T> alpha, T* lambda,
            Accuracy accuracy = Accuracy::kStandard);

// Masking of v for facets of normal m: 1/(1 + Lambda(v)), 0 where v.m and v.z differ in sign.
// Walter 2007 Eq. 26, stretched. beckmann.G1.
template <class T>
void G1(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> alpha_x,
        ParameterOf<T> alpha_y, T* g1, Accuracy accuracy = Accuracy::kStandard);
// Walter 2007 Eq. 26. beckmann.G1_isotropic.
template <class T>
void G1(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> alpha, T* g1,
        Accuracy accuracy = Accuracy::kStandard);
// G1 by a rational function, within 0.313% of the exact one and at most 1. Errors are against the rational
// function. Walter 2007 Eq. 27, stretched. beckmann.G1_rational.
template <class T>
void G1Rational(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> alpha_x,
                ParameterOf<T> alpha_y, T* g1, Accuracy accuracy = Accuracy::kStandard);

// Normals m with density pdf = D(m) m.z, in 1/sr, from uniform numbers in [0, 1).
// Walter 2007 Eqs. 28, 29, stretched. beckmann.sample_normal.
template <class T>
void SampleNormal(std::size_t n, const T* u1, const T* u2, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y,
                  MutableDirections<T> m, T* pdf, Accuracy accuracy = Accuracy::kStandard);
// The same with both alphas widened by 1.2 - 0.2 sqrt(|cos_i|), which tames the weights at grazing; pdf is
// that of the widened D. Walter 2007 section 5.3. beckmann.sample_normal_widened.
template <class T>
void SampleNormalWidened(std::size_t n, const T* u1, const T* u2, const T* cos_i, ParameterOf<T> alpha_x,
                         ParameterOf<T> alpha_y, MutableDirections<T> m, T* pdf,
                         Accuracy accuracy = Accuracy::kStandard);

}  // namespace microlane::beckmann

#endif  // MICROLANE_BECKMANN_H_
