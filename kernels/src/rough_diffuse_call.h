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

template <Normals kNormals, Scatterer kScatterer, DielectricQuantity::Joint kJoint, class T>
void RunOneNormal(const CallBuilder<T>& call, Sampling sampling, Accuracy accuracy, std::size_t n) {
  constexpr DielectricQuantity::What kWhat = DielectricQuantity::kEvalNormal;
  constexpr std::size_t kVisible = FindDiffuseQuantity(kWhat, kJoint, true),
                        kCosine = FindDiffuseQuantity(kWhat, kJoint);
  const FamilyFunction* table = RoughDiffuseTable<kNormals, kScatterer>();
  if (sampling == Sampling::kVisibleNormals) {
    call.template Run<DiffuseKernel({kNormals, kScatterer, kVisible})>(table, accuracy, n);
  } else {
    call.template Run<DiffuseKernel({kNormals, kScatterer, kCosine})>(table, accuracy, n);
  }
}
template <Normals kNormals, Scatterer kScatterer, class T>
void RunOneNormal(const CallBuilder<T>& call, Sampling sampling, JointMasking masking, Accuracy accuracy,
                  std::size_t n) {
  if (masking == JointMasking::kSeparable) {
    RunOneNormal<kNormals, kScatterer, DielectricQuantity::kSeparable>(call, sampling, accuracy, n);
  } else {
    RunOneNormal<kNormals, kScatterer, DielectricQuantity::kCorrelated>(call, sampling, accuracy, n);
  }
}

template <Normals kNormals, class T>
void RoughDiffuseLanes<kNormals, T>::EvalOneNormal(std::size_t n, const Directions<T>& wi,
                                                   const Directions<T>& wo, const Directions<T>& m,
                                                   const RoughnessOf<kNormals, T>& roughness, T* f_cos,
                                                   Accuracy accuracy, JointMasking masking,
                                                   Sampling sampling) {
  CallBuilder<T> call;
  call.In(wi).In(wo).In(m).In(roughness.alpha_x).In(roughness.alpha_y).Out(f_cos);
  RunOneNormal<kNormals, Scatterer::kLambertian>(call, sampling, masking, accuracy, n);
}

}  // namespace microlane

#endif  // MICROLANE_SRC_ROUGH_DIFFUSE_CALL_H_
