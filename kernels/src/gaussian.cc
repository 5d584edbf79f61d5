#include "microlane/gaussian.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/gaussian.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/gaussian-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct NormalisationKernel {
  static constexpr std::string_view kId = "gaussian.C";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> sigma) {
    Vec<D> unused;
    Precisely<GaussianNormalisationOp, A>(d, out.v0, unused, sigma);
  }
};

struct DensityKernel {
  static constexpr std::string_view kId = "gaussian.D";
  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    Vec<D> unused;
    Precisely<GaussianDensityOp, A>(d, out.v0, unused, in...);
  }
};

struct VCavityKernel {
  static constexpr std::string_view kId = "gaussian.D_visible_v_cavity";
  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    Vec<D> unused;
    Precisely<GaussianVCavityOp, A>(d, out.v0, unused, in...);
  }
};

struct EvalVCavityKernel {
  static constexpr std::string_view kId = "gaussian.eval_v_cavity";
  template <Accuracy, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    Vec<D> unused;
    InDouble2<InStandard<GaussianEvalVCavityOp>>(d, out.v0, unused, in...);  // kFast too
  }
};

struct SampleNormalKernel {
  static constexpr std::string_view kId = "gaussian.sample_normal";
  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    SampleGaussian<A>(d, out.v0, out.v1, out.v2, out.v3, in...);
  }
};

FamilyCode FamilyOnTarget() {
  return Family<NormalisationKernel, DensityKernel, VCavityKernel, EvalVCavityKernel, SampleNormalKernel>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* GaussianTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace gaussian {

template <class T>
void C(std::size_t n, const T* sigma, T* c, Accuracy accuracy) {
  CallBuilder<T>().In(sigma).Out(c).template Run<KernelIndex("gaussian.C")>(GaussianTable(), accuracy, n);
}

template <class T>
void D(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> sigma, T* density, Accuracy accuracy) {
  CallBuilder<T>().In(m).In(sigma).Out(density).template Run<KernelIndex("gaussian.D")>(GaussianTable(),
                                                                                        accuracy, n);
}

template <class T>
void DVisibleVCavity(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> sigma,
                     T* density, Accuracy accuracy) {
  CallBuilder<T>()
      .In(v)
      .In(m)
      .In(sigma)
      .Out(density)
      .template Run<KernelIndex("gaussian.D_visible_v_cavity")>(GaussianTable(), accuracy, n);
}

template <class T>
void EvalVCavity(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, ParameterOf<T> sigma,
                 T* f_cos, Accuracy accuracy) {
  CallBuilder<T>().In(wi).In(wo).In(sigma).Out(f_cos).template Run<KernelIndex("gaussian.eval_v_cavity")>(
      GaussianTable(), accuracy, n);
}

template <class T>
void SampleNormal(std::size_t n, const T* u1, const T* u2, ParameterOf<T> sigma, MutableDirections<T> m,
                  T* pdf, Accuracy accuracy) {
  CallBuilder<T>()
      .In(u1)
      .In(u2)
      .In(sigma)
      .Out(m)
      .Out(pdf)
      .template Run<KernelIndex("gaussian.sample_normal")>(GaussianTable(), accuracy, n);
}

template void C(std::size_t, const float*, float*, Accuracy);
template void C(std::size_t, const double*, double*, Accuracy);
template void D(std::size_t, const DirectionsOf<float>&, ParameterOf<float>, float*, Accuracy);
template void D(std::size_t, const DirectionsOf<double>&, ParameterOf<double>, double*, Accuracy);
template void DVisibleVCavity(std::size_t, const DirectionsOf<float>&, const DirectionsOf<float>&,
                              ParameterOf<float>, float*, Accuracy);
template void DVisibleVCavity(std::size_t, const DirectionsOf<double>&, const DirectionsOf<double>&,
                              ParameterOf<double>, double*, Accuracy);
template void EvalVCavity(std::size_t, const DirectionsOf<float>&, const DirectionsOf<float>&,
                          ParameterOf<float>, float*, Accuracy);
template void EvalVCavity(std::size_t, const DirectionsOf<double>&, const DirectionsOf<double>&,
                          ParameterOf<double>, double*, Accuracy);
template void SampleNormal(std::size_t, const float*, const float*, ParameterOf<float>,
                           MutableDirections<float>, float*, Accuracy);
template void SampleNormal(std::size_t, const double*, const double*, ParameterOf<double>,
                           MutableDirections<double>, double*, Accuracy);

}  // namespace gaussian

}  // namespace microlane
#endif  // HWY_ONCE
