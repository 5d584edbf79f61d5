// GGX in batches: normal density, Smith masking, sampling of normals.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function; NaN in gives NaN out in that lane. Roughness is one value or
// one per lane, from 1e-5 to 100; one alpha is isotropic, two stretch along x and y (Heitz 2014 section 5).
#ifndef MICROLANE_GGX_H_
#define MICROLANE_GGX_H_

#include <cstddef>

#include "microlane/packets.h"

namespace microlane::ggx {

// Density of normals m, in 1/sr; 0 where m.z <= 0. Heitz 2014 Eq. 85. ggx.D.
template <class T>
void D(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y, T* d,
       Accuracy accuracy = Accuracy::kStandard);
// Walter 2007 Eq. 33. ggx.D_isotropic.
template <class T>
void D(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> alpha, T* d,
       Accuracy accuracy = Accuracy::kStandard);

// Smith's Lambda of v, the same on both sides of the surface: 0 along the normal, the largest finite number
// where the exact value exceeds it (v.z = 0). Heitz 2014 Eq. 86. ggx.Lambda.
template <class T>
void Lambda(std::size_t n, const DirectionsOf<T>& v, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y,
            T* lambda, Accuracy accuracy = Accuracy::kStandard);
// Heitz 2014 Eq. 72. ggx.Lambda_isotropic.
template <class T>
void Lambda(std::size_t n, const DirectionsOf<T>& v, ParameterOf<T> alpha, T* lambda,
            Accuracy accuracy = Accuracy::kStandard);

// Masking of v for facets of normal m: 1/(1 + Lambda(v)), 0 where v.m and v.z differ in sign.
// Walter 2007 Eq. 34, stretched. ggx.G1.
template <class T>
void G1(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> alpha_x,
        ParameterOf<T> alpha_y, T* g1, Accuracy accuracy = Accuracy::kStandard);
// Walter 2007 Eq. 34. ggx.G1_isotropic.
template <class T>
void G1(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> alpha, T* g1,
        Accuracy accuracy = Accuracy::kStandard);

// Normals m with density pdf = D(m) m.z, in 1/sr, from uniform numbers in [0, 1).
// Walter 2007 Eqs. 35, 36, stretched. ggx.sample_normal.
template <class T>
void SampleNormal(std::size_t n, const T* u1, const T* u2, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y,
                  MutableDirections<T> m, T* pdf, Accuracy accuracy = Accuracy::kStandard);

// Density of the normals m that are visible from v, in 1/sr: G1(v,m) |v.m| D(m) / |v.z|, formed so that it
// stays finite at grazing. v of either side; below the surface it is that of -v, and v.z = 0 counts as above.
// 0 where v.m and v.z differ in sign, and where m.z <= 0. Heitz 2014 Eq. 16. ggx.D_visible.
template <class T>
void DVisible(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> alpha_x,
              ParameterOf<T> alpha_y, T* d, Accuracy accuracy = Accuracy::kStandard);

// Normals m with density pdf = DVisible(v, m), in 1/sr, from uniform numbers in [0, 1): u1 is the height on
// the spherical cap, u2 its azimuth. m.z > 0 whatever the side of v. With them, the weight of a reflection is
// F G2/G1, never above 1. Dupuy and Benyoub 2023. ggx.sample_visible_normal.
template <class T>
void SampleVisibleNormal(std::size_t n, const DirectionsOf<T>& v, const T* u1, const T* u2,
                         ParameterOf<T> alpha_x, ParameterOf<T> alpha_y, MutableDirections<T> m, T* pdf,
                         Accuracy accuracy = Accuracy::kStandard);

// The same for reflection: normals are drawn from a smaller cap, which leaves out many that reflect v below
// the surface and none that do not. pdf is that of m, DVisible(v, m) (|v.z| + r)/(k |v.z| + r) with r =
// |(alpha_x v.x, alpha_y v.y, v.z)| and k of the kernel list; over 4 |v.m| it is that of the reflected
// direction. Eto and Tokuyoshi 2023. ggx.sample_visible_normal_bounded.
template <class T>
void SampleVisibleNormalBounded(std::size_t n, const DirectionsOf<T>& v, const T* u1, const T* u2,
                                ParameterOf<T> alpha_x, ParameterOf<T> alpha_y, MutableDirections<T> m,
                                T* pdf, Accuracy accuracy = Accuracy::kStandard);

}  // namespace microlane::ggx

#endif  // MICROLANE_GGX_H_
