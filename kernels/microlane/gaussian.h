// The Gaussian of the angle in batches (Meneveaux 2015 Eq. 13): normals of density D(m) = C exp(-theta_m^2/(2
// sigma^2))/cos(theta_m), of one roughness sigma in radians. It resembles Beckmann's of alpha = sqrt(2) sigma
// where sigma is small.
//
// All functions work on n lanes of float or double and are thread-safe. sigma is from 1e-3 to 2, and beyond
// them counts as the nearer. Errors are those that the kernel list declares for the id named with each
// function; NaN in gives NaN out in that lane.
#ifndef MICROLANE_GAUSSIAN_H_
#define MICROLANE_GAUSSIAN_H_

#include <cstddef>

#include "microlane/packets.h"

namespace microlane::gaussian {

// The normalisation C in 1/sr, 1/C = 2 pi Int_0^(pi/2) exp(-theta^2/(2 sigma^2)) sin(theta) dtheta.
// gaussian.C.
template <class T>
void C(std::size_t n, const T* sigma, T* c, Accuracy accuracy = Accuracy::kStandard);

// The density D in 1/sr of m as given, tan(theta_m)^2 = (m.x^2 + m.y^2)/m.z^2, cos(theta_m) = m.z; 0 where
// m.z <= 0. gaussian.D.
template <class T>
void D(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> sigma, T* density,
       Accuracy accuracy = Accuracy::kStandard);

// Density of the normals that v sees with the masking of V-cavities, min(|v.m|/|v.z|, 2 m.z) D(m); 0 where
// v.m and v.z differ in sign, and where m.z <= 0. gaussian.D_visible_v_cavity.
template <class T>
void DVisibleVCavity(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> sigma,
                     T* density, Accuracy accuracy = Accuracy::kStandard);

// f |cos(theta_o)| in 1/sr of a rough mirror, D(h) G/(4 |wi.z|), with the masking G of V-cavities: light
// comes from wi and leaves to wo on the same side of the surface; 0 for opposite sides, and where a direction
// lies in it. Meneveaux 2015 Eqs. 13, 14. gaussian.eval_v_cavity.
template <class T>
void EvalVCavity(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, ParameterOf<T> sigma,
                 T* f_cos, Accuracy accuracy = Accuracy::kStandard);

// Normals m of unit length, their angle from Rayleigh's distribution cut off at the horizon, and the density
// pdf over solid angle with which they are drawn: not D cos(theta_m), but that times theta_m/sin(theta_m), at
// most pi/2, and a constant. gaussian.sample_normal.
template <class T>
void SampleNormal(std::size_t n, const T* u1, const T* u2, ParameterOf<T> sigma, MutableDirections<T> m,
                  T* pdf, Accuracy accuracy = Accuracy::kStandard);

}  // namespace microlane::gaussian

#endif  // MICROLANE_GAUSSIAN_H_
