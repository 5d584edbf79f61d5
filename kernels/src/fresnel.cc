#include "microlane/fresnel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/fresnel.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/fresnel-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

template <FresnelPart kPart>
struct FresnelKernel {
  static constexpr std::string_view kId = kPart == FresnelPart::kUnpolarised ? "fresnel.dielectric"
                                          : kPart == FresnelPart::kS         ? "fresnel.dielectric_s"
                                          : kPart == FresnelPart::kP         ? "fresnel.dielectric_p"
                                                                     : "fresnel.dielectric_transmittance";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> cos_i, Vec<D> eta) {
    out.v0 = FresnelDielectric<kPart, A>(d, cos_i, eta);
  }
};

FamilyCode FamilyOnTarget() {
  return Family<FresnelKernel<FresnelPart::kUnpolarised>, FresnelKernel<FresnelPart::kTransmittance>,
                FresnelKernel<FresnelPart::kS>, FresnelKernel<FresnelPart::kP>>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* FresnelTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace fresnel {

template <class T>
void Dielectric(std::size_t n, const T* cos_i, ParameterOf<T> eta, T* reflectance, Accuracy accuracy) {
  CallBuilder<T>()
      .In(cos_i)
      .In(eta)
      .Out(reflectance)
      .template Run<KernelIndex("fresnel.dielectric")>(FresnelTable(), accuracy, n);
}

template <class T>
void DielectricTransmittance(std::size_t n, const T* cos_i, ParameterOf<T> eta, T* transmittance,
                             Accuracy accuracy) {
  CallBuilder<T>()
      .In(cos_i)
      .In(eta)
      .Out(transmittance)
      .template Run<KernelIndex("fresnel.dielectric_transmittance")>(FresnelTable(), accuracy, n);
}

template <class T>
void DielectricS(std::size_t n, const T* cos_i, ParameterOf<T> eta, T* reflectance, Accuracy accuracy) {
  CallBuilder<T>()
      .In(cos_i)
      .In(eta)
      .Out(reflectance)
      .template Run<KernelIndex("fresnel.dielectric_s")>(FresnelTable(), accuracy, n);
}

template <class T>
void DielectricP(std::size_t n, const T* cos_i, ParameterOf<T> eta, T* reflectance, Accuracy accuracy) {
  CallBuilder<T>()
      .In(cos_i)
      .In(eta)
      .Out(reflectance)
      .template Run<KernelIndex("fresnel.dielectric_p")>(FresnelTable(), accuracy, n);
}

#define MICROLANE_INSTANTIATE(T)                                                              \
  template void Dielectric(std::size_t, const T*, ParameterOf<T>, T*, Accuracy);              \
  template void DielectricTransmittance(std::size_t, const T*, ParameterOf<T>, T*, Accuracy); \
  template void DielectricS(std::size_t, const T*, ParameterOf<T>, T*, Accuracy);             \
  template void DielectricP(std::size_t, const T*, ParameterOf<T>, T*, Accuracy);
MICROLANE_INSTANTIATE(float)
MICROLANE_INSTANTIATE(double)
#undef MICROLANE_INSTANTIATE

}  // namespace fresnel

}  // namespace microlane
#endif  // HWY_ONCE
