#include "microlane/rough_dielectric.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/rough_dielectric_ggx.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/ggx-inl.h"
#include "src/rough_dielectric_call.h"
#include "src/rough_dielectric_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

constexpr std::string_view kEval = "rough_dielectric.eval";
constexpr std::string_view kEvalReflection = "rough_dielectric.eval_reflection";
constexpr std::string_view kEvalTransmission = "rough_dielectric.eval_transmission";
constexpr std::string_view kEvalSeparable = "rough_dielectric.eval_separable";
constexpr std::string_view kEvalReflectionSeparable = "rough_dielectric.eval_reflection_separable";
constexpr std::string_view kEvalTransmissionSeparable = "rough_dielectric.eval_transmission_separable";
constexpr std::string_view kPdf = "rough_dielectric.pdf";
constexpr std::string_view kPdfReflection = "rough_dielectric.pdf_reflection";
constexpr std::string_view kPdfTransmission = "rough_dielectric.pdf_transmission";
constexpr std::string_view kEvalPdf = "rough_dielectric.eval_pdf";
constexpr std::string_view kEvalPdfSeparable = "rough_dielectric.eval_pdf_separable";
constexpr std::string_view kSample = "rough_dielectric.sample";
constexpr std::string_view kSampleSeparable = "rough_dielectric.sample_separable";

FamilyCode FamilyOnTarget() {
  return Family<
      RoughDielectricKernel<Ggx, Lobes::kBoth, JointMasking::kHeightCorrelated, true, false, kEval>,
      RoughDielectricKernel<Ggx, Lobes::kReflection, JointMasking::kHeightCorrelated, true, false,
                            kEvalReflection>,
      RoughDielectricKernel<Ggx, Lobes::kTransmission, JointMasking::kHeightCorrelated, true, false,
                            kEvalTransmission>,
      RoughDielectricKernel<Ggx, Lobes::kBoth, JointMasking::kSeparable, true, false, kEvalSeparable>,
      RoughDielectricKernel<Ggx, Lobes::kReflection, JointMasking::kSeparable, true, false,
                            kEvalReflectionSeparable>,
      RoughDielectricKernel<Ggx, Lobes::kTransmission, JointMasking::kSeparable, true, false,
                            kEvalTransmissionSeparable>,
      RoughDielectricKernel<Ggx, Lobes::kBoth, JointMasking::kHeightCorrelated, false, true, kPdf>,
      RoughDielectricKernel<Ggx, Lobes::kReflection, JointMasking::kHeightCorrelated, false, true,
                            kPdfReflection>,
      RoughDielectricKernel<Ggx, Lobes::kTransmission, JointMasking::kHeightCorrelated, false, true,
                            kPdfTransmission>,
      RoughDielectricKernel<Ggx, Lobes::kBoth, JointMasking::kHeightCorrelated, true, true, kEvalPdf>,
      RoughDielectricKernel<Ggx, Lobes::kBoth, JointMasking::kSeparable, true, true, kEvalPdfSeparable>,
      SampleRoughDielectricKernel<Ggx, JointMasking::kHeightCorrelated, kSample>,
      SampleRoughDielectricKernel<Ggx, JointMasking::kSeparable, kSampleSeparable>>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* RoughDielectricGgxTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace rough_dielectric {

template <class T>
void Eval(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
          const DielectricParametersOf<T>& surface, T* f_cos, Accuracy accuracy, Transport transport,
          JointMasking masking) {
  const std::string_view id =
      masking == JointMasking::kSeparable ? "rough_dielectric.eval_separable" : "rough_dielectric.eval";
  DirectionPairCall<T>(wi, wo, surface)
      .Out(f_cos)
      .With(transport)
      .Run(RoughDielectricGgxTable(), id, accuracy, n);
}

template <class T>
void EvalReflection(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
                    const DielectricParametersOf<T>& surface, T* f_cos, Accuracy accuracy,
                    JointMasking masking) {
  const std::string_view id = masking == JointMasking::kSeparable
                                  ? "rough_dielectric.eval_reflection_separable"
                                  : "rough_dielectric.eval_reflection";
  DirectionPairCall<T>(wi, wo, surface).Out(f_cos).Run(RoughDielectricGgxTable(), id, accuracy, n);
}

template <class T>
void EvalTransmission(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
                      const DielectricParametersOf<T>& surface, T* f_cos, Accuracy accuracy,
                      Transport transport, JointMasking masking) {
  const std::string_view id = masking == JointMasking::kSeparable
                                  ? "rough_dielectric.eval_transmission_separable"
                                  : "rough_dielectric.eval_transmission";
  DirectionPairCall<T>(wi, wo, surface)
      .Out(f_cos)
      .With(transport)
      .Run(RoughDielectricGgxTable(), id, accuracy, n);
}

template <class T>
void Pdf(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
         const DielectricParametersOf<T>& surface, T* pdf, Accuracy accuracy) {
  DirectionPairCall<T>(wi, wo, surface)
      .Out(pdf)
      .Run(RoughDielectricGgxTable(), "rough_dielectric.pdf", accuracy, n);
}

template <class T>
void PdfReflection(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
                   const DielectricParametersOf<T>& surface, T* pdf, Accuracy accuracy) {
  DirectionPairCall<T>(wi, wo, surface)
      .Out(pdf)
      .Run(RoughDielectricGgxTable(), "rough_dielectric.pdf_reflection", accuracy, n);
}

template <class T>
void PdfTransmission(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
                     const DielectricParametersOf<T>& surface, T* pdf, Accuracy accuracy) {
  DirectionPairCall<T>(wi, wo, surface)
      .Out(pdf)
      .Run(RoughDielectricGgxTable(), "rough_dielectric.pdf_transmission", accuracy, n);
}

template <class T>
void EvalPdf(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
             const DielectricParametersOf<T>& surface, T* f_cos, T* pdf, Accuracy accuracy,
             Transport transport, JointMasking masking) {
  const std::string_view id = masking == JointMasking::kSeparable ? "rough_dielectric.eval_pdf_separable"
                                                                  : "rough_dielectric.eval_pdf";
  DirectionPairCall<T>(wi, wo, surface)
      .Out(f_cos)
      .Out(pdf)
      .With(transport)
      .Run(RoughDielectricGgxTable(), id, accuracy, n);
}

template <class T>
void Sample(std::size_t n, const DirectionsOf<T>& wi, const T* u1, const T* u2, const T* u3,
            const DielectricParametersOf<T>& surface, const DielectricSamples<T>& samples, Accuracy accuracy,
            Transport transport, JointMasking masking) {
  const std::string_view id =
      masking == JointMasking::kSeparable ? "rough_dielectric.sample_separable" : "rough_dielectric.sample";
  SampleCall<T>(wi, u1, u2, u3, surface, samples)
      .With(transport)
      .Run(RoughDielectricGgxTable(), id, accuracy, n);
}

#define MICROLANE_INSTANTIATE(T)                                                                           \
  template void Eval(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,                          \
                     const DielectricParametersOf<T>&, T*, Accuracy, Transport, JointMasking);             \
  template void EvalReflection(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,                \
                               const DielectricParametersOf<T>&, T*, Accuracy, JointMasking);              \
  template void EvalTransmission(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,              \
                                 const DielectricParametersOf<T>&, T*, Accuracy, Transport, JointMasking); \
  template void Pdf(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,                           \
                    const DielectricParametersOf<T>&, T*, Accuracy);                                       \
  template void PdfReflection(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,                 \
                              const DielectricParametersOf<T>&, T*, Accuracy);                             \
  template void PdfTransmission(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,               \
                                const DielectricParametersOf<T>&, T*, Accuracy);                           \
  template void EvalPdf(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,                       \
                        const DielectricParametersOf<T>&, T*, T*, Accuracy, Transport, JointMasking);      \
  template void Sample(std::size_t, const DirectionsOf<T>&, const T*, const T*, const T*,                  \
                       const DielectricParametersOf<T>&, const DielectricSamples<T>&, Accuracy, Transport, \
                       JointMasking);
MICROLANE_INSTANTIATE(float)
MICROLANE_INSTANTIATE(double)
#undef MICROLANE_INSTANTIATE

}  // namespace rough_dielectric

}  // namespace microlane
#endif  // HWY_ONCE
