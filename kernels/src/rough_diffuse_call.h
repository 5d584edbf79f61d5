// The public functions of diffuse rough surfaces. Includes no Highway.
#ifndef MICROLANE_SRC_ROUGH_DIFFUSE_CALL_H_
#define MICROLANE_SRC_ROUGH_DIFFUSE_CALL_H_

#include <cstddef>

#include "microlane/rough_diffuse.h"
#include "src/dispatch.h"

namespace microlane {

template <Normals kNormals, class T>
void RoughDiffuseLanes<kNormals, T>::Eval(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                                          const RoughnessOf<kNormals, T>& roughness,
                                          const QuadratureRule& rule, T* f_cos, Accuracy accuracy,
                                          JointMasking masking) {
  static_assert(kDiffuseQuantities[0].joint == DielectricQuantity::kCorrelated &&
                kDiffuseQuantities[1].joint == DielectricQuantity::kSeparable);
  CallBuilder<T> call;
  call.In(wi).In(wo).In(roughness.alpha_x).In(roughness.alpha_y).Out(f_cos).In(rule);
  const FamilyFunction* table = RoughDiffuseTable<kNormals, Scatterer::kLambertian>();
  if (masking == JointMasking::kSeparable) {
    call.template Run<DiffuseKernel({kNormals, Scatterer::kLambertian, 1})>(table, accuracy, n);
  } else {
    call.template Run<DiffuseKernel({kNormals, Scatterer::kLambertian, 0})>(table, accuracy, n);
  }
}

}  // namespace microlane

#endif  // MICROLANE_SRC_ROUGH_DIFFUSE_CALL_H_
