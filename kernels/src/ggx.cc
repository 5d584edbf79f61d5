#include "microlane/ggx.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/ggx.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/ggx-inl.h"
#include "src/distribution_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

constexpr std::string_view kDId = "ggx.D";
constexpr std::string_view kDIsotropicId = "ggx.D_isotropic";
constexpr std::string_view kLambdaId = "ggx.Lambda";
constexpr std::string_view kLambdaIsotropicId = "ggx.Lambda_isotropic";
constexpr std::string_view kG1Id = "ggx.G1";
constexpr std::string_view kG1IsotropicId = "ggx.G1_isotropic";
constexpr std::string_view kSampleNormalId = "ggx.sample_normal";
constexpr std::string_view kDVisibleId = "ggx.D_visible";
constexpr std::string_view kSampleVisibleNormalId = "ggx.sample_visible_normal";
constexpr std::string_view kSampleVisibleNormalBoundedId = "ggx.sample_visible_normal_bounded";

FamilyCode FamilyOnTarget() {
  return Family<DKernel<Ggx, kDId>, DKernel<Ggx, kDIsotropicId>, LambdaKernel<Ggx, kLambdaId>,
                LambdaKernel<Ggx, kLambdaIsotropicId>, G1Kernel<Ggx, kG1Id>, G1Kernel<Ggx, kG1IsotropicId>,
                SampleNormalKernel<Ggx, kSampleNormalId>, DVisibleKernel<Ggx, kDVisibleId>,
                SampleVisibleNormalKernel<Ggx, kSampleVisibleNormalId>,
                SampleVisibleNormalKernel<Ggx, kSampleVisibleNormalBoundedId, true>>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* GgxTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace ggx {

template <class T>
void D(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y, T* d,
       Accuracy accuracy) {
  CallBuilder<T>().In(m).In(alpha_x).In(alpha_y).Out(d).template Run<KernelIndex("ggx.D")>(GgxTable(),
                                                                                           accuracy, n);
}

template <class T>
void D(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> alpha, T* d, Accuracy accuracy) {
  CallBuilder<T>().In(m).In(alpha).Out(d).template Run<KernelIndex("ggx.D_isotropic")>(GgxTable(), accuracy,
                                                                                       n);
}

template <class T>
void Lambda(std::size_t n, const DirectionsOf<T>& v, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y,
            T* lambda, Accuracy accuracy) {
  CallBuilder<T>().In(v).In(alpha_x).In(alpha_y).Out(lambda).template Run<KernelIndex("ggx.Lambda")>(
      GgxTable(), accuracy, n);
}

template <class T>
void Lambda(std::size_t n, const DirectionsOf<T>& v, ParameterOf<T> alpha, T* lambda, Accuracy accuracy) {
  CallBuilder<T>().In(v).In(alpha).Out(lambda).template Run<KernelIndex("ggx.Lambda_isotropic")>(GgxTable(),
                                                                                                 accuracy, n);
}

template <class T>
void G1(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> alpha_x,
        ParameterOf<T> alpha_y, T* g1, Accuracy accuracy) {
  CallBuilder<T>().In(v).In(m).In(alpha_x).In(alpha_y).Out(g1).template Run<KernelIndex("ggx.G1")>(
      GgxTable(), accuracy, n);
}

template <class T>
void G1(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> alpha, T* g1,
        Accuracy accuracy) {
  CallBuilder<T>().In(v).In(m).In(alpha).Out(g1).template Run<KernelIndex("ggx.G1_isotropic")>(GgxTable(),
                                                                                               accuracy, n);
}

template <class T>
void SampleNormal(std::size_t n, const T* u1, const T* u2, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y,
                  MutableDirections<T> m, T* pdf, Accuracy accuracy) {
  CallBuilder<T>()
      .In(u1)
      .In(u2)
      .In(alpha_x)
      .In(alpha_y)
      .Out(m)
      .Out(pdf)
      .template Run<KernelIndex("ggx.sample_normal")>(GgxTable(), accuracy, n);
}

template <class T>
void DVisible(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> alpha_x,
              ParameterOf<T> alpha_y, T* d, Accuracy accuracy) {
  CallBuilder<T>().In(v).In(m).In(alpha_x).In(alpha_y).Out(d).template Run<KernelIndex("ggx.D_visible")>(
      GgxTable(), accuracy, n);
}

template <class T>
void SampleVisibleNormal(std::size_t n, const DirectionsOf<T>& v, const T* u1, const T* u2,
                         ParameterOf<T> alpha_x, ParameterOf<T> alpha_y, MutableDirections<T> m, T* pdf,
                         Accuracy accuracy) {
  CallBuilder<T>()
      .In(v)
      .In(u1)
      .In(u2)
      .In(alpha_x)
      .In(alpha_y)
      .Out(m)
      .Out(pdf)
      .template Run<KernelIndex("ggx.sample_visible_normal")>(GgxTable(), accuracy, n);
}

template <class T>
void SampleVisibleNormalBounded(std::size_t n, const DirectionsOf<T>& v, const T* u1, const T* u2,
                                ParameterOf<T> alpha_x, ParameterOf<T> alpha_y, MutableDirections<T> m,
                                T* pdf, Accuracy accuracy) {
  CallBuilder<T>()
      .In(v)
      .In(u1)
      .In(u2)
      .In(alpha_x)
      .In(alpha_y)
      .Out(m)
      .Out(pdf)
      .template Run<KernelIndex("ggx.sample_visible_normal_bounded")>(GgxTable(), accuracy, n);
}

#define MICROLANE_INSTANTIATE(T)                                                                             \
  template void D(std::size_t, const DirectionsOf<T>&, ParameterOf<T>, ParameterOf<T>, T*, Accuracy);        \
  template void D(std::size_t, const DirectionsOf<T>&, ParameterOf<T>, T*, Accuracy);                        \
  template void Lambda(std::size_t, const DirectionsOf<T>&, ParameterOf<T>, ParameterOf<T>, T*, Accuracy);   \
  template void Lambda(std::size_t, const DirectionsOf<T>&, ParameterOf<T>, T*, Accuracy);                   \
  template void G1(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, ParameterOf<T>,              \
                   ParameterOf<T>, T*, Accuracy);                                                            \
  template void G1(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, ParameterOf<T>, T*,          \
                   Accuracy);                                                                                \
  template void SampleNormal(std::size_t, const T*, const T*, ParameterOf<T>, ParameterOf<T>,                \
                             MutableDirections<T>, T*, Accuracy);                                            \
  template void DVisible(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, ParameterOf<T>,        \
                         ParameterOf<T>, T*, Accuracy);                                                      \
  template void SampleVisibleNormal(std::size_t, const DirectionsOf<T>&, const T*, const T*, ParameterOf<T>, \
                                    ParameterOf<T>, MutableDirections<T>, T*, Accuracy);                     \
  template void SampleVisibleNormalBounded(std::size_t, const DirectionsOf<T>&, const T*, const T*,          \
                                           ParameterOf<T>, ParameterOf<T>, MutableDirections<T>, T*,         \
                                           Accuracy);
MICROLANE_INSTANTIATE(float)
MICROLANE_INSTANTIATE(double)
#undef MICROLANE_INSTANTIATE

}  // namespace ggx

}  // namespace microlane
#endif  // HWY_ONCE
