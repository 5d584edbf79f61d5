// The rough dielectric's public functions. Includes no Highway.
#ifndef MICROLANE_SRC_ROUGH_DIELECTRIC_CALL_H_
#define MICROLANE_SRC_ROUGH_DIELECTRIC_CALL_H_

#include <cstddef>

#include "microlane/rough_dielectric.h"
#include "src/dispatch.h"

namespace microlane {

template <class T>
void AddSurface(const DielectricParameters<T>& surface, CallBuilder<T>& call) {
  call.In(surface.alpha_x).In(surface.alpha_y).In(surface.eta);
}
template <class T>
void AddSurface(const PhongDielectricParameters<T>& surface, CallBuilder<T>& call) {
  call.In(surface.exponent).In(surface.eta);
}

// What the calls of one distribution have in common. The arguments must outlive it.
template <Normals kNormals, class T>
class RoughDielectricCall {
 public:
  using What = DielectricQuantity::What;
  using Surface = DielectricParametersOf<kNormals, T>;

  RoughDielectricCall(const Directions<T>& wi, const Directions<T>& wo, const Surface& surface) {
    call_.In(wi).In(wo);
    AddSurface(surface, call_);
  }
  // u3 may be null.
  RoughDielectricCall(const Directions<T>& wi, const T* u1, const T* u2, const T* u3, const Surface& surface,
                      const DielectricSamples<T>& samples) {
    call_.In(wi).In(u1).In(u2);
    if (u3 != nullptr) call_.In(u3);
    AddSurface(surface, call_);
    call_.Out(samples.wo).Out(samples.weight).Out(samples.pdf).Out(samples.lobe);
  }

  RoughDielectricCall& Out(T* lanes) {
    call_.Out(lanes);
    return *this;
  }
  RoughDielectricCall& With(Transport transport) {
    call_.With(transport);
    return *this;
  }

  // Of values, which hang on no sampling.
  template <What kWhat, bool kReflects, bool kTransmits>
  void Run(JointMasking masking, Accuracy accuracy, std::size_t n) const {
    RunFrom<kWhat, kReflects, kTransmits, false>(masking, accuracy, n);
  }
  template <What kWhat, bool kReflects, bool kTransmits>
  void Run(JointMasking masking, Sampling sampling, Accuracy accuracy, std::size_t n) const {
    constexpr bool kHasVisible = HasVisibleNormals(kNormals);
    if (kHasVisible && sampling == Sampling::kVisibleNormals) {
      RunFrom<kWhat, kReflects, kTransmits, kHasVisible>(masking, accuracy, n);
    } else {
      RunFrom<kWhat, kReflects, kTransmits, false>(masking, accuracy, n);
    }
  }

 private:
  template <What kWhat, bool kReflects, bool kTransmits, bool kVisible>
  void RunFrom(JointMasking masking, Accuracy accuracy, std::size_t n) const {
    constexpr auto kernel = [](DielectricQuantity::Joint joint) {
      return DielectricKernel(kNormals,
                              FindDielectricQuantity(kWhat, kReflects, kTransmits, joint, kVisible));
    };
    constexpr auto kNoMasking = DielectricQuantity::kCorrelated;  // the density alone has none
    constexpr std::size_t kCorrelated = kernel(DielectricQuantity::kCorrelated);
    constexpr std::size_t kSeparable =
        kernel(kWhat == What::kPdf ? kNoMasking : DielectricQuantity::kSeparable);
    if (masking == JointMasking::kSeparable) {
      call_.template Run<kSeparable>(RoughDielectricTable<kNormals>(), accuracy, n);
    } else {
      call_.template Run<kCorrelated>(RoughDielectricTable<kNormals>(), accuracy, n);
    }
  }

  CallBuilder<T> call_;
};

template <Normals kNormals, class T>
void RoughDielectricLanes<kNormals, T>::Eval(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                                             const Surface& surface, T* f_cos, Accuracy accuracy,
                                             Transport transport, JointMasking masking) {
  RoughDielectricCall<kNormals, T>(wi, wo, surface)
      .Out(f_cos)
      .With(transport)
      .template Run<DielectricQuantity::kEval, true, true>(masking, accuracy, n);
}

template <Normals kNormals, class T>
void RoughDielectricLanes<kNormals, T>::EvalReflection(std::size_t n, const Directions<T>& wi,
                                                       const Directions<T>& wo, const Surface& surface,
                                                       T* f_cos, Accuracy accuracy, JointMasking masking) {
  RoughDielectricCall<kNormals, T>(wi, wo, surface)
      .Out(f_cos)
      .template Run<DielectricQuantity::kEval, true, false>(masking, accuracy, n);
}

template <Normals kNormals, class T>
void RoughDielectricLanes<kNormals, T>::EvalTransmission(std::size_t n, const Directions<T>& wi,
                                                         const Directions<T>& wo, const Surface& surface,
                                                         T* f_cos, Accuracy accuracy, Transport transport,
                                                         JointMasking masking) {
  RoughDielectricCall<kNormals, T>(wi, wo, surface)
      .Out(f_cos)
      .With(transport)
      .template Run<DielectricQuantity::kEval, false, true>(masking, accuracy, n);
}

template <Normals kNormals, class T>
void RoughDielectricLanes<kNormals, T>::Pdf(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                                            const Surface& surface, T* pdf, Accuracy accuracy,
                                            Sampling sampling) {
  RoughDielectricCall<kNormals, T>(wi, wo, surface)
      .Out(pdf)
      .template Run<DielectricQuantity::kPdf, true, true>(JointMasking::kHeightCorrelated, sampling, accuracy,
                                                          n);
}

template <Normals kNormals, class T>
void RoughDielectricLanes<kNormals, T>::PdfReflection(std::size_t n, const Directions<T>& wi,
                                                      const Directions<T>& wo, const Surface& surface, T* pdf,
                                                      Accuracy accuracy, Sampling sampling) {
  RoughDielectricCall<kNormals, T>(wi, wo, surface)
      .Out(pdf)
      .template Run<DielectricQuantity::kPdf, true, false>(JointMasking::kHeightCorrelated, sampling,
                                                           accuracy, n);
}

template <Normals kNormals, class T>
void RoughDielectricLanes<kNormals, T>::PdfTransmission(std::size_t n, const Directions<T>& wi,
                                                        const Directions<T>& wo, const Surface& surface,
                                                        T* pdf, Accuracy accuracy, Sampling sampling) {
  RoughDielectricCall<kNormals, T>(wi, wo, surface)
      .Out(pdf)
      .template Run<DielectricQuantity::kPdf, false, true>(JointMasking::kHeightCorrelated, sampling,
                                                           accuracy, n);
}

template <Normals kNormals, class T>
void RoughDielectricLanes<kNormals, T>::EvalPdf(std::size_t n, const Directions<T>& wi,
                                                const Directions<T>& wo, const Surface& surface, T* f_cos,
                                                T* pdf, Accuracy accuracy, Transport transport,
                                                JointMasking masking, Sampling sampling) {
  RoughDielectricCall<kNormals, T>(wi, wo, surface)
      .Out(f_cos)
      .Out(pdf)
      .With(transport)
      .template Run<DielectricQuantity::kEvalPdf, true, true>(masking, sampling, accuracy, n);
}

template <Normals kNormals, class T>
void RoughDielectricLanes<kNormals, T>::Sample(std::size_t n, const Directions<T>& wi, const T* u1,
                                               const T* u2, const T* u3, const Surface& surface,
                                               const DielectricSamples<T>& samples, Accuracy accuracy,
                                               Transport transport, JointMasking masking, Sampling sampling) {
  RoughDielectricCall<kNormals, T>(wi, u1, u2, u3, surface, samples)
      .With(transport)
      .template Run<DielectricQuantity::kSample, true, true>(masking, sampling, accuracy, n);
}

template <Normals kNormals, class T>
void RoughDielectricLanes<kNormals, T>::SampleReflection(std::size_t n, const Directions<T>& wi, const T* u1,
                                                         const T* u2, const Surface& surface,
                                                         const DielectricSamples<T>& samples,
                                                         Accuracy accuracy, JointMasking masking,
                                                         Sampling sampling) {
  RoughDielectricCall<kNormals, T>(wi, u1, u2, nullptr, surface, samples)
      .template Run<DielectricQuantity::kSample, true, false>(masking, sampling, accuracy, n);
}

template <Normals kNormals, class T>
void RoughDielectricLanes<kNormals, T>::SampleTransmission(std::size_t n, const Directions<T>& wi,
                                                           const T* u1, const T* u2, const Surface& surface,
                                                           const DielectricSamples<T>& samples,
                                                           Accuracy accuracy, Transport transport,
                                                           JointMasking masking, Sampling sampling) {
  RoughDielectricCall<kNormals, T>(wi, u1, u2, nullptr, surface, samples)
      .With(transport)
      .template Run<DielectricQuantity::kSample, false, true>(masking, sampling, accuracy, n);
}

}  // namespace microlane

#endif  // MICROLANE_SRC_ROUGH_DIELECTRIC_CALL_H_
