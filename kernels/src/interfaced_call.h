// The public functions of rough interfaced bodies. Includes no Highway.
#ifndef MICROLANE_SRC_INTERFACED_CALL_H_
#define MICROLANE_SRC_INTERFACED_CALL_H_

#include <cstddef>
#include <type_traits>

#include "microlane/interfaced.h"
#include "src/channels.h"
#include "src/dispatch.h"
#include "src/rough_diffuse_call.h"

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

template <Normals kNormals, class T>
void InterfacedBodyLanes<kNormals, T>::EvalChannels(std::size_t n, const Directions<T>& wi,
                                                    const Directions<T>& wo,
                                                    const RoughnessOf<kNormals, T>& roughness,
                                                    const Parameter<T>& n_i, std::size_t channels,
                                                    const Parameter<T>* k, const QuadratureRule& rule,
                                                    T* const* f_cos, Accuracy accuracy,
                                                    JointMasking masking) {
  if constexpr (std::is_same_v<T, float>) {
    if (accuracy != Accuracy::kHigh && rule.ok()) {
      BodyChannels call{{wi.x, wi.y, wi.z, wo.x, wo.y, wo.z},
                        {},
                        masking == JointMasking::kSeparable,
                        accuracy,
                        channels,
                        k,
                        f_cos,
                        &rule};
      call.Put(6, roughness.alpha_x);
      call.Put(7, roughness.alpha_y);
      call.Put(8, n_i);
      BodyChannelTable<kNormals>()[ChosenTableIndex()]()(call, n);
      return;
    }
  }
  for (std::size_t c = 0; c < channels; ++c) {
    Eval(n, wi, wo, roughness, {n_i, k[c]}, rule, f_cos[c], accuracy, masking);
  }
}

template <Normals kNormals, class T>
void InterfacedBodyLanes<kNormals, T>::EvalOneNormal(std::size_t n, const Directions<T>& wi,
                                                     const Directions<T>& wo, const Directions<T>& m,
                                                     const RoughnessOf<kNormals, T>& roughness,
                                                     const Body<T>& body, T* f_cos, Accuracy accuracy,
                                                     JointMasking masking, Sampling sampling) {
  CallBuilder<T> call;
  call.In(wi).In(wo).In(m).In(roughness.alpha_x).In(roughness.alpha_y).In(body.n_i).In(body.k).Out(f_cos);
  RunOneNormal<kNormals, Scatterer::kInterfaced>(call, sampling, masking, accuracy, n);
}

template <Normals kNormals, class T>
void InterfacedBodyLanes<kNormals, T>::PdfWithInterface(std::size_t n, const Directions<T>& wi,
                                                        const Directions<T>& wo,
                                                        const RoughnessOf<kNormals, T>& roughness,
                                                        const Body<T>& body, T* pdf, Accuracy accuracy) {
  constexpr std::size_t kPdf =
      FindDiffuseQuantity(DielectricQuantity::kPdf, DielectricQuantity::kCorrelated, true);
  CallBuilder<T> call;
  call.In(wi).In(wo).In(roughness.alpha_x).In(roughness.alpha_y).In(body.n_i).In(body.k).Out(pdf);
  call.template Run<DiffuseKernel({kNormals, Scatterer::kInterfaced, kPdf})>(
      RoughDiffuseTable<kNormals, Scatterer::kInterfaced>(), accuracy, n);
}

template <Normals kNormals, class T>
void InterfacedBodyLanes<kNormals, T>::SampleWithInterface(
    std::size_t n, const Directions<T>& wi, const T* u1, const T* u2, const T* u3, const T* u4, const T* u5,
    const RoughnessOf<kNormals, T>& roughness, const Body<T>& body, const DielectricSamples<T>& samples,
    Accuracy accuracy) {
  constexpr std::size_t kSample =
      FindDiffuseQuantity(DielectricQuantity::kSample, DielectricQuantity::kCorrelated, true);
  CallBuilder<T> call;
  call.In(wi).In(u1).In(u2).In(u3).In(u4).In(u5);
  call.In(roughness.alpha_x).In(roughness.alpha_y).In(body.n_i).In(body.k);
  call.Out(samples.wo).Out(samples.weight).Out(samples.pdf).Out(samples.lobe);
  call.template Run<DiffuseKernel({kNormals, Scatterer::kInterfaced, kSample})>(
      RoughDiffuseTable<kNormals, Scatterer::kInterfaced>(), accuracy, n);
}

}  // namespace microlane

#endif  // MICROLANE_SRC_INTERFACED_CALL_H_
