// The public functions of opaque rough surfaces. Includes no Highway.
#ifndef MICROLANE_SRC_ROUGH_REFLECTOR_CALL_H_
#define MICROLANE_SRC_ROUGH_REFLECTOR_CALL_H_

#include <cstddef>
#include <type_traits>

#include "microlane/rough_reflector.h"
#include "src/channels.h"
#include "src/dispatch.h"

namespace microlane {

template <class T>
void AddRoughness(const StretchedRoughness<T>& roughness, CallBuilder<T>& call) {
  call.In(roughness.alpha_x).In(roughness.alpha_y);
}
template <class T>
void AddRoughness(const PhongRoughness<T>& roughness, CallBuilder<T>& call) {
  call.In(roughness.exponent);
}

template <class Facets>
void AddRoughness(const StretchedRoughness<float>& roughness, ChannelCall<Facets>& call) {
  call.Put(6, roughness.alpha_x);
  call.Put(7, roughness.alpha_y);
}
template <class Facets>
void AddRoughness(const PhongRoughness<float>& roughness, ChannelCall<Facets>& call) {
  call.Put(6, roughness.exponent);
}

template <class T>
void AddFacets(const FacetParameters<Reflector::kMirror, T>&, CallBuilder<T>&) {}
template <class T>
void AddFacets(const FacetParameters<Reflector::kConductor, T>& facets, CallBuilder<T>& call) {
  call.In(facets.n).In(facets.kappa);
}
template <class T>
void AddFacets(const FacetParameters<Reflector::kSchlick, T>& facets, CallBuilder<T>& call) {
  call.In(facets.f0);
}

template <Normals kNormals, Reflector kReflector, class T>
void AddSurface(const OpaqueSurface<kNormals, kReflector, T>& surface, CallBuilder<T>& call) {
  AddRoughness(surface.roughness, call);
  AddFacets(surface.facets, call);
}

template <Normals kNormals, Reflector kReflector, DielectricQuantity::What kWhat, bool kVisible, class T>
void RunReflector(const CallBuilder<T>& call, JointMasking masking, Accuracy accuracy, std::size_t n) {
  constexpr std::size_t kCorrelated = FindReflectorQuantity(kWhat, DielectricQuantity::kCorrelated, kVisible);
  constexpr std::size_t kSeparable = FindReflectorQuantity(kWhat, DielectricQuantity::kSeparable, kVisible);
  const FamilyFunction* table = RoughReflectorTable<kNormals>();
  if (masking == JointMasking::kSeparable) {
    call.template Run<ReflectorKernel({kNormals, kReflector, kSeparable})>(table, accuracy, n);
  } else {
    call.template Run<ReflectorKernel({kNormals, kReflector, kCorrelated})>(table, accuracy, n);
  }
}
template <Normals kNormals, Reflector kReflector, DielectricQuantity::What kWhat, class T>
void RunReflector(const CallBuilder<T>& call, JointMasking masking, Sampling sampling, Accuracy accuracy,
                  std::size_t n) {
  if (HasVisibleNormals(kNormals) && sampling == Sampling::kVisibleNormals) {
    RunReflector<kNormals, kReflector, kWhat, HasVisibleNormals(kNormals)>(call, masking, accuracy, n);
  } else {
    RunReflector<kNormals, kReflector, kWhat, false>(call, masking, accuracy, n);
  }
}

// Of a joint masking that has calls of its own; `call` has the lanes that go in.
template <DielectricQuantity::Joint kJoint, DielectricQuantity::What kWhat, Normals kNormals,
          Reflector kReflector, class T, class... Out>
void RunJoint(CallBuilder<T>& call, const OpaqueSurface<kNormals, kReflector, T>& surface, Accuracy accuracy,
              std::size_t n, const Out&... out) {
  AddSurface(surface, call);
  (call.Out(out), ...);
  constexpr std::size_t kQuantity = FindReflectorQuantity(kWhat, kJoint);
  call.template Run<ReflectorKernel({kNormals, kReflector, kQuantity})>(RoughReflectorTable<kNormals>(),
                                                                        accuracy, n);
}

template <Normals kNormals, Reflector kReflector, class T>
void RoughReflectorLanes<kNormals, kReflector, T>::Eval(std::size_t n, const Directions<T>& wi,
                                                        const Directions<T>& wo, const Surface& surface,
                                                        T* f_cos, Accuracy accuracy, JointMasking masking) {
  CallBuilder<T> call;
  call.In(wi).In(wo);
  AddSurface(surface, call);
  call.Out(f_cos);
  RunReflector<kNormals, kReflector, DielectricQuantity::kEval, false>(call, masking, accuracy, n);
}

template <Normals kNormals, Reflector kReflector, class T>
void RoughReflectorLanes<kNormals, kReflector, T>::EvalChannels(
    std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
    const RoughnessOf<kNormals, T>& roughness, std::size_t channels,
    const FacetParameters<kReflector, T>* facets, T* const* f_cos, Accuracy accuracy, JointMasking masking) {
  if constexpr (std::is_same_v<T, float> && kReflector != Reflector::kMirror) {
    if (accuracy != Accuracy::kHigh) {
      ChannelCall<FacetParameters<kReflector, float>> call{{wi.x, wi.y, wi.z, wo.x, wo.y, wo.z},
                                                           {},
                                                           masking == JointMasking::kSeparable,
                                                           accuracy,
                                                           channels,
                                                           facets,
                                                           f_cos,
                                                           nullptr};
      AddRoughness(roughness, call);
      microlane::Run(ChannelTable<kNormals>()[ChosenTableIndex()](), call, n);
      return;
    }
  }
  for (std::size_t c = 0; c < channels; ++c) {
    Eval(n, wi, wo, {roughness, facets[c]}, f_cos[c], accuracy, masking);
  }
}

template <Normals kNormals, Reflector kReflector, class T>
void RoughReflectorLanes<kNormals, kReflector, T>::EvalPdf(std::size_t n, const Directions<T>& wi,
                                                           const Directions<T>& wo, const Surface& surface,
                                                           T* f_cos, T* pdf, Accuracy accuracy,
                                                           JointMasking masking, Sampling sampling) {
  CallBuilder<T> call;
  call.In(wi).In(wo);
  AddSurface(surface, call);
  call.Out(f_cos).Out(pdf);
  RunReflector<kNormals, kReflector, DielectricQuantity::kEvalPdf>(call, masking, sampling, accuracy, n);
}

template <Normals kNormals, Reflector kReflector, class T>
void RoughReflectorLanes<kNormals, kReflector, T>::Sample(std::size_t n, const Directions<T>& wi, const T* u1,
                                                          const T* u2, const Surface& surface,
                                                          const DielectricSamples<T>& samples,
                                                          Accuracy accuracy, JointMasking masking,
                                                          Sampling sampling) {
  CallBuilder<T> call;
  call.In(wi).In(u1).In(u2);
  AddSurface(surface, call);
  call.Out(samples.wo).Out(samples.weight).Out(samples.pdf).Out(samples.lobe);
  RunReflector<kNormals, kReflector, DielectricQuantity::kSample>(call, masking, sampling, accuracy, n);
}

template <Normals kNormals, Reflector kReflector, class T>
void RoughReflectorLanes<kNormals, kReflector, T>::EvalVCavity(std::size_t n, const Directions<T>& wi,
                                                               const Directions<T>& wo,
                                                               const Surface& surface, T* f_cos,
                                                               Accuracy accuracy) {
  RunJoint<DielectricQuantity::kVCavity, DielectricQuantity::kEval>(CallBuilder<T>().In(wi).In(wo), surface,
                                                                    accuracy, n, f_cos);
}

template <Normals kNormals, Reflector kReflector, class T>
void RoughReflectorLanes<kNormals, kReflector, T>::EvalPdfVCavity(std::size_t n, const Directions<T>& wi,
                                                                  const Directions<T>& wo,
                                                                  const Surface& surface, T* f_cos, T* pdf,
                                                                  Accuracy accuracy) {
  RunJoint<DielectricQuantity::kVCavity, DielectricQuantity::kEvalPdf>(CallBuilder<T>().In(wi).In(wo),
                                                                       surface, accuracy, n, f_cos, pdf);
}

template <Normals kNormals, Reflector kReflector, class T>
void RoughReflectorLanes<kNormals, kReflector, T>::SampleVCavity(std::size_t n, const Directions<T>& wi,
                                                                 const T* u1, const T* u2, const T* u3,
                                                                 const Surface& surface,
                                                                 const DielectricSamples<T>& samples,
                                                                 Accuracy accuracy) {
  RunJoint<DielectricQuantity::kVCavity, DielectricQuantity::kSample>(
      CallBuilder<T>().In(wi).In(u1).In(u2).In(u3), surface, accuracy, n, samples.wo, samples.weight,
      samples.pdf, samples.lobe);
}

template <Normals kNormals, Reflector kReflector, class T>
void RoughReflectorLanes<kNormals, kReflector, T>::EvalKelemen(std::size_t n, const Directions<T>& wi,
                                                               const Directions<T>& wo,
                                                               const Surface& surface, T* f_cos,
                                                               Accuracy accuracy) {
  RunJoint<DielectricQuantity::kKelemen, DielectricQuantity::kEval>(CallBuilder<T>().In(wi).In(wo), surface,
                                                                    accuracy, n, f_cos);
}

template <Normals kNormals, Reflector kReflector, class T>
void RoughReflectorLanes<kNormals, kReflector, T>::EvalPdfKelemen(std::size_t n, const Directions<T>& wi,
                                                                  const Directions<T>& wo,
                                                                  const Surface& surface, T* f_cos, T* pdf,
                                                                  Accuracy accuracy) {
  RunJoint<DielectricQuantity::kKelemen, DielectricQuantity::kEvalPdf>(CallBuilder<T>().In(wi).In(wo),
                                                                       surface, accuracy, n, f_cos, pdf);
}

template <Normals kNormals, Reflector kReflector, class T>
void RoughReflectorLanes<kNormals, kReflector, T>::SampleKelemen(std::size_t n, const Directions<T>& wi,
                                                                 const T* u1, const T* u2,
                                                                 const Surface& surface,
                                                                 const DielectricSamples<T>& samples,
                                                                 Accuracy accuracy) {
  RunJoint<DielectricQuantity::kKelemen, DielectricQuantity::kSample>(
      CallBuilder<T>().In(wi).In(u1).In(u2), surface, accuracy, n, samples.wo, samples.weight, samples.pdf,
      samples.lobe);
}

}  // namespace microlane

#endif  // MICROLANE_SRC_ROUGH_REFLECTOR_CALL_H_
