#include "microlane/fresnel.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/fresnel.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/conductor-inl.h"
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

struct ConductorKernel {
  static constexpr std::string_view kId = "fresnel.conductor";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> cos_i, Vec<D> n,
                              Vec<D> kappa) {
    out.v0 = FresnelConductor<A>(d, cos_i, n, kappa);
  }
};

struct SchlickKernel {
  static constexpr std::string_view kId = "fresnel.schlick";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> cos_i, Vec<D> f0) {
    out.v0 = FresnelSchlick<A>(d, cos_i, f0);
  }
};

template <DiffuseSide kSide>
struct DiffuseKernelOf {
  static constexpr std::string_view kId =
      kSide == DiffuseSide::kExternal ? "fresnel.diffuse_external" : "fresnel.diffuse_internal";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> eta) {
    Vec<D> unused;
    Precisely<DiffuseFresnelOp<kSide>, A>(d, out.v0, unused, eta);
  }
};

FamilyCode FamilyOnTarget() {
  return Family<FresnelKernel<FresnelPart::kUnpolarised>, FresnelKernel<FresnelPart::kTransmittance>,
                FresnelKernel<FresnelPart::kS>, FresnelKernel<FresnelPart::kP>, ConductorKernel,
                DiffuseKernelOf<DiffuseSide::kExternal>, DiffuseKernelOf<DiffuseSide::kInternal>,
                SchlickKernel>();
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

namespace {

// A factor of a cosine and one parameter.
template <std::size_t kKernel, class T>
void OfCosine(std::size_t n, const T* cos_i, const Parameter<T>& parameter, T* factor, Accuracy accuracy) {
  CallBuilder<T>().In(cos_i).In(parameter).Out(factor).template Run<kKernel>(FresnelTable(), accuracy, n);
}

}  // namespace

template <class T>
void Dielectric(std::size_t n, const T* cos_i, ParameterOf<T> eta, T* reflectance, Accuracy accuracy) {
  OfCosine<KernelIndex("fresnel.dielectric")>(n, cos_i, eta, reflectance, accuracy);
}

template <class T>
void DielectricTransmittance(std::size_t n, const T* cos_i, ParameterOf<T> eta, T* transmittance,
                             Accuracy accuracy) {
  OfCosine<KernelIndex("fresnel.dielectric_transmittance")>(n, cos_i, eta, transmittance, accuracy);
}

template <class T>
void DielectricS(std::size_t n, const T* cos_i, ParameterOf<T> eta, T* reflectance, Accuracy accuracy) {
  OfCosine<KernelIndex("fresnel.dielectric_s")>(n, cos_i, eta, reflectance, accuracy);
}

template <class T>
void DielectricP(std::size_t n, const T* cos_i, ParameterOf<T> eta, T* reflectance, Accuracy accuracy) {
  OfCosine<KernelIndex("fresnel.dielectric_p")>(n, cos_i, eta, reflectance, accuracy);
}

template <class T>
void Conductor(std::size_t n, const T* cos_i, ParameterOf<T> index, ParameterOf<T> kappa, T* reflectance,
               Accuracy accuracy) {
  CallBuilder<T>()
      .In(cos_i)
      .In(index)
      .In(kappa)
      .Out(reflectance)
      .template Run<KernelIndex("fresnel.conductor")>(FresnelTable(), accuracy, n);
}

template <class T>
void Conductor(std::size_t n, const T* cos_i, std::size_t channels, const Parameter<T>* index,
               const Parameter<T>* kappa, T* const* reflectance, Accuracy accuracy) {
  for (std::size_t c = 0; c < channels; ++c) {
    Conductor(n, cos_i, index[c], kappa[c], reflectance[c], accuracy);
  }
}

template <class T>
void Schlick(std::size_t n, const T* cos_i, ParameterOf<T> f0, T* reflectance, Accuracy accuracy) {
  OfCosine<KernelIndex("fresnel.schlick")>(n, cos_i, f0, reflectance, accuracy);
}

template <class T>
void DiffuseExternal(std::size_t n, const T* eta, T* reflectance, Accuracy accuracy) {
  CallBuilder<T>()
      .In(eta)
      .Out(reflectance)
      .template Run<KernelIndex("fresnel.diffuse_external")>(FresnelTable(), accuracy, n);
}

template <class T>
void DiffuseInternal(std::size_t n, const T* eta, T* reflectance, Accuracy accuracy) {
  CallBuilder<T>()
      .In(eta)
      .Out(reflectance)
      .template Run<KernelIndex("fresnel.diffuse_internal")>(FresnelTable(), accuracy, n);
}

#define MICROLANE_INSTANTIATE(T)                                                                        \
  template void Dielectric(std::size_t, const T*, ParameterOf<T>, T*, Accuracy);                        \
  template void DielectricTransmittance(std::size_t, const T*, ParameterOf<T>, T*, Accuracy);           \
  template void DielectricS(std::size_t, const T*, ParameterOf<T>, T*, Accuracy);                       \
  template void DielectricP(std::size_t, const T*, ParameterOf<T>, T*, Accuracy);                       \
  template void Conductor(std::size_t, const T*, ParameterOf<T>, ParameterOf<T>, T*, Accuracy);         \
  template void Conductor(std::size_t, const T*, std::size_t, const Parameter<T>*, const Parameter<T>*, \
                          T* const*, Accuracy);                                                         \
  template void DiffuseExternal(std::size_t, const T*, T*, Accuracy);                                   \
  template void DiffuseInternal(std::size_t, const T*, T*, Accuracy);                                   \
  template void Schlick(std::size_t, const T*, ParameterOf<T>, T*, Accuracy);
MICROLANE_INSTANTIATE(float)
MICROLANE_INSTANTIATE(double)
#undef MICROLANE_INSTANTIATE

}  // namespace fresnel

}  // namespace microlane
#endif  // HWY_ONCE
