// Half vectors, their Jacobians, reflection and refraction in batches.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function; NaN in gives NaN out in that lane. eta is the index of the
// transmitted over the incident side, one value or one per lane, from 1/4 to 4.
#ifndef MICROLANE_HALF_VECTOR_H_
#define MICROLANE_HALF_VECTOR_H_

#include <cstddef>

#include "microlane/packets.h"

namespace microlane {
namespace half_vector {

// The unit normal h that reflects wi to wo, on wi's side; 0 where wi = -wo. Walter 2007 Eq. 13.
// half_vector.reflection.
template <class T>
void Reflection(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, MutableDirections<T> h,
                Accuracy accuracy = Accuracy::kStandard);

// Solid angle of h over that of wo: |wo.h|/|wi + wo|^2, 0 where wi = -wo. Walter 2007 Eq. 14, first form.
// half_vector.reflection_jacobian.
template <class T>
void ReflectionJacobian(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, T* jacobian,
                        Accuracy accuracy = Accuracy::kStandard);
// From cos_o = wo.h: 1/(4 |cos_o|), the largest finite number at 0. Walter 2007 Eq. 14, second form.
// half_vector.reflection_jacobian_cos.
template <class T>
void ReflectionJacobian(std::size_t n, const T* cos_o, T* jacobian, Accuracy accuracy = Accuracy::kStandard);

// The unit normal h that refracts wi to wo, -normalize(wi + eta wo): it points into the side of lower index;
// 0 where wi = -eta wo. Walter 2007 Eq. 16. half_vector.refraction.
template <class T>
void Refraction(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, ParameterOf<T> eta,
                MutableDirections<T> h, Accuracy accuracy = Accuracy::kStandard);

// Solid angle of h over that of wo: eta^2 |wo.h|/|wi + eta wo|^2, 0 where wi = -eta wo. Walter 2007 Eq. 17,
// first form. half_vector.refraction_jacobian.
template <class T>
void RefractionJacobian(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
                        ParameterOf<T> eta, T* jacobian, Accuracy accuracy = Accuracy::kStandard);
// From cos_i = wi.h and cos_o = wo.h: eta^2 |cos_o|/(cos_i + eta cos_o)^2; the largest finite number where
// the denominator is 0, and 0 where cos_o is 0. Walter 2007 Eq. 17, second form.
// half_vector.refraction_jacobian_cos.
template <class T>
void RefractionJacobian(std::size_t n, const T* cos_i, const T* cos_o, ParameterOf<T> eta, T* jacobian,
                        Accuracy accuracy = Accuracy::kStandard);

}  // namespace half_vector

// wo = 2 (wi.m) m - wi. Walter 2007 Eq. 39. reflect.
template <class T>
void Reflect(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& m, MutableDirections<T> wo,
             Accuracy accuracy = Accuracy::kStandard);

// wi refracted by facets of normal m; 0 under total internal reflection. Walter 2007 Eq. 40. refract.
template <class T>
void Refract(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& m, ParameterOf<T> eta,
             MutableDirections<T> wo, Accuracy accuracy = Accuracy::kStandard);

}  // namespace microlane

#endif  // MICROLANE_HALF_VECTOR_H_
