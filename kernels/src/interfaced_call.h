// The public functions of rough interfaced bodies. Includes no Highway.
#ifndef MICROLANE_SRC_INTERFACED_CALL_H_
#define MICROLANE_SRC_INTERFACED_CALL_H_

#include <cstddef>

#include "microlane/interfaced.h"
#include "src/dispatch.h"

namespace microlane {

template <Normals kNormals, class T>
void InterfacedBodyLanes<kNormals, T>::Eval(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                                            const RoughnessOf<kNormals, T>& roughness, const Body<T>& body,
                                            const QuadratureRule& rule, T* f_cos, Accuracy accuracy,
                                            JointMasking masking) {
  static_assert(kDiffuseQuantities[0].joint == DielectricQuantity::kCorrelated &&
                kDiffuseQuantities[1].joint == DielectricQuantity::kSeparable);
  constexpr Scatterer kScatterer = Scatterer::kInterfaced;
  CallBuilder<T> call;
  call.In(wi).In(wo).In(roughness.alpha_x).In(roughness.alpha_y).In(body.n_i).In(body.k).Out(f_cos).In(rule);
  const FamilyFunction* table = RoughDiffuseTable<kNormals, kScatterer>();
  if (masking == JointMasking::kSeparable) {
    call.template Run<DiffuseKernel({kNormals, kScatterer, 1})>(table, accuracy, n);
  } else {
    call.template Run<DiffuseKernel({kNormals, kScatterer, 0})>(table, accuracy, n);
  }
}

}  // namespace microlane

#endif  // MICROLANE_SRC_INTERFACED_CALL_H_
