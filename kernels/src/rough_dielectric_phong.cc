#include "microlane/rough_dielectric.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/rough_dielectric_phong.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/phong-inl.h"
#include "src/rough_dielectric_call.h"
#include "src/rough_dielectric_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

constexpr std::string_view kEval = "rough_dielectric_phong.eval";
constexpr std::string_view kEvalReflection = "rough_dielectric_phong.eval_reflection";
constexpr std::string_view kEvalTransmission = "rough_dielectric_phong.eval_transmission";
constexpr std::string_view kEvalSeparable = "rough_dielectric_phong.eval_separable";
constexpr std::string_view kPdf = "rough_dielectric_phong.pdf";
constexpr std::string_view kEvalPdf = "rough_dielectric_phong.eval_pdf";
constexpr std::string_view kSample = "rough_dielectric_phong.sample";

FamilyCode FamilyOnTarget() {
  return Family<
      RoughDielectricKernel<Phong, Lobes::kBoth, JointMasking::kHeightCorrelated, true, false, kEval>,
      RoughDielectricKernel<Phong, Lobes::kReflection, JointMasking::kHeightCorrelated, true, false,
                            kEvalReflection>,
      RoughDielectricKernel<Phong, Lobes::kTransmission, JointMasking::kHeightCorrelated, true, false,
                            kEvalTransmission>,
      RoughDielectricKernel<Phong, Lobes::kBoth, JointMasking::kSeparable, true, false, kEvalSeparable>,
      RoughDielectricKernel<Phong, Lobes::kBoth, JointMasking::kHeightCorrelated, false, true, kPdf>,
      RoughDielectricKernel<Phong, Lobes::kBoth, JointMasking::kHeightCorrelated, true, true, kEvalPdf>,
      SampleRoughDielectricKernel<Phong, JointMasking::kHeightCorrelated, kSample>>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* RoughDielectricPhongTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace rough_dielectric_phong {

template <class T>
void Eval(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
          const PhongDielectricParametersOf<T>& surface, T* f_cos, Accuracy accuracy, Transport transport,
          JointMasking masking) {
  const std::string_view id = masking == JointMasking::kSeparable ? "rough_dielectric_phong.eval_separable"
                                                                  : "rough_dielectric_phong.eval";
  DirectionPairCall<T>(wi, wo, surface)
      .Out(f_cos)
      .With(transport)
      .Run(RoughDielectricPhongTable(), id, accuracy, n);
}

template <class T>
void EvalReflection(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
                    const PhongDielectricParametersOf<T>& surface, T* f_cos, Accuracy accuracy) {
  DirectionPairCall<T>(wi, wo, surface)
      .Out(f_cos)
      .Run(RoughDielectricPhongTable(), "rough_dielectric_phong.eval_reflection", accuracy, n);
}

template <class T>
void EvalTransmission(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
                      const PhongDielectricParametersOf<T>& surface, T* f_cos, Accuracy accuracy,
                      Transport transport) {
  DirectionPairCall<T>(wi, wo, surface)
      .Out(f_cos)
      .With(transport)
      .Run(RoughDielectricPhongTable(), "rough_dielectric_phong.eval_transmission", accuracy, n);
}

template <class T>
void Pdf(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
         const PhongDielectricParametersOf<T>& surface, T* pdf, Accuracy accuracy) {
  DirectionPairCall<T>(wi, wo, surface)
      .Out(pdf)
      .Run(RoughDielectricPhongTable(), "rough_dielectric_phong.pdf", accuracy, n);
}

template <class T>
void EvalPdf(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
             const PhongDielectricParametersOf<T>& surface, T* f_cos, T* pdf, Accuracy accuracy,
             Transport transport) {
  DirectionPairCall<T>(wi, wo, surface)
      .Out(f_cos)
      .Out(pdf)
      .With(transport)
      .Run(RoughDielectricPhongTable(), "rough_dielectric_phong.eval_pdf", accuracy, n);
}

template <class T>
void Sample(std::size_t n, const DirectionsOf<T>& wi, const T* u1, const T* u2, const T* u3,
            const PhongDielectricParametersOf<T>& surface, const DielectricSamples<T>& samples,
            Accuracy accuracy, Transport transport) {
  SampleCall<T>(wi, u1, u2, u3, surface, samples)
      .With(transport)
      .Run(RoughDielectricPhongTable(), "rough_dielectric_phong.sample", accuracy, n);
}

#define MICROLANE_INSTANTIATE(T)                                                                     \
  template void Eval(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,                    \
                     const PhongDielectricParametersOf<T>&, T*, Accuracy, Transport, JointMasking);  \
  template void EvalReflection(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,          \
                               const PhongDielectricParametersOf<T>&, T*, Accuracy);                 \
  template void EvalTransmission(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,        \
                                 const PhongDielectricParametersOf<T>&, T*, Accuracy, Transport);    \
  template void Pdf(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,                     \
                    const PhongDielectricParametersOf<T>&, T*, Accuracy);                            \
  template void EvalPdf(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,                 \
                        const PhongDielectricParametersOf<T>&, T*, T*, Accuracy, Transport);         \
  template void Sample(std::size_t, const DirectionsOf<T>&, const T*, const T*, const T*,            \
                       const PhongDielectricParametersOf<T>&, const DielectricSamples<T>&, Accuracy, \
                       Transport);
MICROLANE_INSTANTIATE(float)
MICROLANE_INSTANTIATE(double)
#undef MICROLANE_INSTANTIATE

}  // namespace rough_dielectric_phong

}  // namespace microlane
#endif  // HWY_ONCE
