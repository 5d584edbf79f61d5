// Phong in batches: D, G1, SampleNormal and V-cavities of normals.h with one parameter, the exponent, from 0
// to 2e10. Walter 2007 Eqs. 30-32; masking by Walter's recipe, Eq. 27 with a = sqrt(0.5 exponent +
// 1)/tan(theta_v), at most 1.
#ifndef MICROLANE_PHONG_H_
#define MICROLANE_PHONG_H_

#include <cstddef>

#include "microlane/normals.h"

namespace microlane {

template <class T>
using PhongLanes = NormalLanes<Normals::kPhong, RoughnessKind::kExponent, T, Parameter<T>>;

struct phong : NormalCalls<PhongLanes<float>, PhongLanes<double>> {
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
