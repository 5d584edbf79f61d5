// Masking functions beside Smith's, joint masking-shadowing, and Smith's Lambda of Student-T slopes, in
// batches.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function; NaN in gives NaN out in that lane. An output may be the same
// array as an input; other overlap is not allowed.
#ifndef MICROLANE_MASKING_H_
#define MICROLANE_MASKING_H_

#include <cstddef>

#include "microlane/packets.h"

namespace microlane::masking {

// Masking of the normal m from the direction v of either side; 0 where v.m and v.z differ in sign or either
// is 0. A physically based form satisfies the weak white furnace (Heitz 2014 Eqs. 14, 18, 36, 37, Table 3).

// V-cavities: min(1, 2 m.z |v.z| / |v.m|), and 0 where m.z <= 0. Physically based, with every distribution of
// normals. Heitz 2014 Eq. 49. masking.v_cavity.
template <class T>
void VCavity(std::size_t n, DirectionsOf<T> v, DirectionsOf<T> m, T* g1,
             Accuracy accuracy = Accuracy::kStandard);

// |v.z|. Not physically based. Heitz 2014 Eq. 56. masking.implicit.
template <class T>
void Implicit(std::size_t n, DirectionsOf<T> v, DirectionsOf<T> m, T* g1,
              Accuracy accuracy = Accuracy::kStandard);

// |v.z| / (|v.z| (1 - k) + k), k = alpha sqrt(2/pi). Not physically based. Heitz 2014 section 4.3.
// masking.schlick_smith.
template <class T>
void SchlickSmith(std::size_t n, DirectionsOf<T> v, DirectionsOf<T> m, ParameterOf<T> alpha, T* g1,
                  Accuracy accuracy = Accuracy::kStandard);

// |v.z| / |v.m|, which may exceed 1. Not physically based. Heitz 2014 Eq. 59. masking.kelemen.
template <class T>
void Kelemen(std::size_t n, DirectionsOf<T> v, DirectionsOf<T> m, T* g1,
             Accuracy accuracy = Accuracy::kStandard);

// Joint masking-shadowing from Smith's Lambda of wi and wo, up to the largest float. Sidedness is left to the
// caller.

// 1 / ((1 + Lambda_i)(1 + Lambda_o)). Heitz 2014 Eq. 98. masking.separable.
template <class T>
void Separable(std::size_t n, const T* lambda_i, const T* lambda_o, T* g2,
               Accuracy accuracy = Accuracy::kStandard);

// 1 / (1 + Lambda_i + Lambda_o). Heitz 2014 Eq. 99. masking.height_correlated.
template <class T>
void HeightCorrelated(std::size_t n, const T* lambda_i, const T* lambda_o, T* g2,
                      Accuracy accuracy = Accuracy::kStandard);

// Of light that is refracted, whose heights are correlated the other way: B(1 + Lambda_i, 1 + Lambda_o), B
// Euler's Beta function; never more than HeightCorrelated. masking.height_correlated_transmission.
template <class T>
void HeightCorrelatedTransmission(std::size_t n, const T* lambda_i, const T* lambda_o, T* g2,
                                  Accuracy accuracy = Accuracy::kStandard);

// Those correlated by direction blend from no shadowing of what is seen, where wi and wo have one azimuth, by
// lambda = 4.41 phi / (4.41 phi + 1), phi the difference of their azimuths within [0, pi], 0 where one is
// undefined. Of wi and wo, x and y are read.

// lambda G1(i) G1(o) + (1 - lambda) min(G1(i), G1(o)). Heitz 2014 Eq. 100. masking.direction_correlated.
template <class T>
void DirectionCorrelated(std::size_t n, const T* lambda_i, const T* lambda_o, DirectionsOf<T> wi,
                         DirectionsOf<T> wo, T* g2, Accuracy accuracy = Accuracy::kStandard);

// 1 / (1 + max(Lambda_i, Lambda_o) + lambda min(Lambda_i, Lambda_o)). Heitz 2014 Eq. 101.
// masking.height_direction_correlated.
template <class T>
void HeightDirectionCorrelated(std::size_t n, const T* lambda_i, const T* lambda_o, DirectionsOf<T> wi,
                               DirectionsOf<T> wo, T* g2, Accuracy accuracy = Accuracy::kStandard);

// Smith's Lambda of v for Student-T slopes (d'Eon 2023; Burley 2012), whose density is 1/(pi alpha_x alpha_y)
// (1 + (x^2/alpha_x^2 + y^2/alpha_y^2)/(gamma - 1))^-gamma: GGX at gamma = 2, Beckmann as gamma grows, Phong
// of exponent e at gamma = e/2 + 2 and alphas of sqrt(2/(e + 2)). gamma from 1.55 to 1e10. The same on both
// sides of the surface: 0 along the normal, the largest finite number where the exact value exceeds it. Heitz
// 2014 Eqs. 41-43. masking.student_lambda.
template <class T>
void StudentLambda(std::size_t n, DirectionsOf<T> v, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y,
                   ParameterOf<T> gamma, T* lambda, Accuracy accuracy = Accuracy::kStandard);

}  // namespace microlane::masking

#endif  // MICROLANE_MASKING_H_
