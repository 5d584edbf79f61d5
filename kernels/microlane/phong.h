// Phong in batches: D, G1, SampleNormal and V-cavities of normals.h with one parameter, the exponent, from 0
// to 2e10. Walter 2007 Eqs. 30-32; G1 by Walter's recipe, Eq. 27 with a = sqrt(0.5 exponent +
// 1)/tan(theta_v), at most 1, and Lambda and G1Smith of Phong's own slopes.
#ifndef MICROLANE_PHONG_H_
#define MICROLANE_PHONG_H_

#include <cstddef>

#include "microlane/normals.h"

namespace microlane {

template <class T>
using PhongLanes = NormalLanes<Normals::kPhong, RoughnessKind::kExponent, T, Parameter<T>>;

struct phong : NormalCalls<PhongLanes<float>, PhongLanes<double>> {
  // Smith's Lambda of v, exactly, which Heitz 2014 section 7 leaves open: the slopes of Phong's normals have
  // Student's density (exponent + 2)/(2 pi) (1 + x^2 + y^2)^-(exponent/2 + 2). The same on both sides of the
  // surface: 0 along the normal, the largest finite number where the exact value exceeds it (v.z = 0). Heitz
  // 2014 Eqs. 41-43. phong.Lambda.
  template <class T>
  static void Lambda(std::size_t n, const DirectionsOf<T>& v, ParameterOf<T> exponent, T* lambda,
                     Accuracy accuracy = Accuracy::kStandard) {
    CallBuilder<T>().In(v).In(exponent).Out(lambda).template Run<KernelIndex("phong.Lambda")>(
        NormalsCode<Normals::kPhong>(), accuracy, n);
  }

  // Masking of v for facets of normal m: 1/(1 + Lambda(v)), 0 where v.m and v.z differ in sign. Unlike G1 it
  // satisfies the weak white furnace. Heitz 2014 Eq. 80. phong.G1_smith.
  template <class T>
  static void G1Smith(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m,
                      ParameterOf<T> exponent, T* g1, Accuracy accuracy = Accuracy::kStandard) {
    CallBuilder<T>().In(v).In(m).In(exponent).Out(g1).template Run<KernelIndex("phong.G1_smith")>(
        NormalsCode<Normals::kPhong>(), accuracy, n);
  }

  // The exponent 2/alpha^2 - 2 that matches a Beckmann roughness; 0 for alpha >= 1. Walter 2007 after Eq. 30.
  // phong.exponent.
  template <class T>
  static void Exponent(std::size_t n, const T* alpha, T* exponent, Accuracy accuracy = Accuracy::kStandard) {
    CallBuilder<T>().In(alpha).Out(exponent).template Run<KernelIndex("phong.exponent")>(
        NormalsCode<Normals::kPhong>(), accuracy, n);
  }
};

}  // namespace microlane

#endif  // MICROLANE_PHONG_H_
