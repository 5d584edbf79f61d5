// Fresnel factors of dielectrics and conductors in batches.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function; NaN in gives NaN out in that lane. cos_i is the cosine
// between direction and facet normal on the incident side (its sign is ignored), eta the index of the
// transmitted over the incident side, one value or one per lane, from 1/4 to 4.
#ifndef MICROLANE_FRESNEL_H_
#define MICROLANE_FRESNEL_H_

#include <cstddef>

#include "microlane/packets.h"

namespace microlane::fresnel {

// Reflectance of unpolarised light: 1 under total internal reflection, 0 at eta = 1. Walter 2007 Eq. 22.
// fresnel.dielectric.
template <class T>
void Dielectric(std::size_t n, const T* cos_i, ParameterOf<T> eta, T* reflectance,
                Accuracy accuracy = Accuracy::kStandard);

// 1 - reflectance without the subtraction, accurate where it is small: 0 under total internal reflection, 1
// at eta = 1. Walter 2007 Eq. 22. fresnel.dielectric_transmittance.
template <class T>
void DielectricTransmittance(std::size_t n, const T* cos_i, ParameterOf<T> eta, T* transmittance,
                             Accuracy accuracy = Accuracy::kStandard);

// Reflectance of light polarised across the plane of incidence, ((g - c)/(g + c))^2. Walter 2007 Eq. 22.
// fresnel.dielectric_s.
template <class T>
void DielectricS(std::size_t n, const T* cos_i, ParameterOf<T> eta, T* reflectance,
                 Accuracy accuracy = Accuracy::kStandard);

// Reflectance of light polarised in the plane of incidence, ((eta^2 c - g)/(eta^2 c + g))^2. Walter 2007
// Eq. 22. fresnel.dielectric_p.
template <class T>
void DielectricP(std::size_t n, const T* cos_i, ParameterOf<T> eta, T* reflectance,
                 Accuracy accuracy = Accuracy::kStandard);

// Reflectance of unpolarised light by a conductor of index n + i kappa over that of the incident side, n from
// 0.05 to 10, kappa from 0 (a dielectric) to 20. fresnel.conductor.
template <class T>
void Conductor(std::size_t n, const T* cos_i, ParameterOf<T> index, ParameterOf<T> kappa, T* reflectance,
               Accuracy accuracy = Accuracy::kStandard);

// The same of `channels` wavelengths: index, kappa and the output of each.
template <class T>
void Conductor(std::size_t n, const T* cos_i, std::size_t channels, const Parameter<T>* index,
               const Parameter<T>* kappa, T* const* reflectance, Accuracy accuracy = Accuracy::kStandard);

// Mean of the dielectric's reflectance over diffuse light from outside, r_e, for eta from 1/4 to 4 (beyond
// them it counts as the nearer): 0 at eta = 1. Meneveaux 2015 Eq. 10. fresnel.diffuse_external.
template <class T>
void DiffuseExternal(std::size_t n, const T* eta, T* reflectance, Accuracy accuracy = Accuracy::kStandard);

// The same from inside, r_i = 1 - (1 - r_e)/eta^2. Meneveaux 2015 Eq. 9. fresnel.diffuse_internal.
template <class T>
void DiffuseInternal(std::size_t n, const T* eta, T* reflectance, Accuracy accuracy = Accuracy::kStandard);

// Schlick's approximation from the reflectance at normal incidence, f0 + (1 - f0) (1 - |cos_i|)^5.
// fresnel.schlick.
template <class T>
void Schlick(std::size_t n, const T* cos_i, ParameterOf<T> f0, T* reflectance,
             Accuracy accuracy = Accuracy::kStandard);

}  // namespace microlane::fresnel

#endif  // MICROLANE_FRESNEL_H_
