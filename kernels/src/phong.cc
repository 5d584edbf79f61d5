#include "microlane/phong.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/phong.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/phong-inl.h"
#include "src/distribution_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

constexpr std::string_view kG1Id = "phong.G1";
constexpr std::string_view kSampleNormalId = "phong.sample_normal";

struct ExponentKernel {
  static constexpr std::string_view kId = "phong.exponent";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> alpha) {
    out.v0 = Phong::Exponent<A>(d, alpha);
  }
};

struct PhongDKernel {
  static constexpr std::string_view kId = "phong.D";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D>, Vec<D>, Vec<D> mz,
                              Vec<D> exponent) {
    out.v0 = Phong::NormalDensity<A>(d, mz, exponent);
  }
};

FamilyCode FamilyOnTarget() {
  return Family<ExponentKernel, PhongDKernel, G1Kernel<Phong, kG1Id>,
                SampleNormalKernel<Phong, kSampleNormalId>>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* PhongTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace phong {

template <class T>
void Exponent(std::size_t n, const T* alpha, T* exponent, Accuracy accuracy) {
  CallBuilder<T>().In(alpha).Out(exponent).template Run<KernelIndex("phong.exponent")>(PhongTable(), accuracy,
                                                                                       n);
}

template <class T>
void D(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> exponent, T* d, Accuracy accuracy) {
  CallBuilder<T>().In(m).In(exponent).Out(d).template Run<KernelIndex("phong.D")>(PhongTable(), accuracy, n);
}

template <class T>
void G1(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> exponent, T* g1,
        Accuracy accuracy) {
  CallBuilder<T>().In(v).In(m).In(exponent).Out(g1).template Run<KernelIndex("phong.G1")>(PhongTable(),
                                                                                          accuracy, n);
}

template <class T>
void SampleNormal(std::size_t n, const T* u1, const T* u2, ParameterOf<T> exponent, MutableDirections<T> m,
                  T* pdf, Accuracy accuracy) {
  CallBuilder<T>()
      .In(u1)
      .In(u2)
      .In(exponent)
      .Out(m)
      .Out(pdf)
      .template Run<KernelIndex("phong.sample_normal")>(PhongTable(), accuracy, n);
}

#define MICROLANE_INSTANTIATE(T)                                                                        \
  template void Exponent(std::size_t, const T*, T*, Accuracy);                                          \
  template void D(std::size_t, const DirectionsOf<T>&, ParameterOf<T>, T*, Accuracy);                   \
  template void G1(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, ParameterOf<T>, T*,     \
                   Accuracy);                                                                           \
  template void SampleNormal(std::size_t, const T*, const T*, ParameterOf<T>, MutableDirections<T>, T*, \
                             Accuracy);
MICROLANE_INSTANTIATE(float)
MICROLANE_INSTANTIATE(double)
#undef MICROLANE_INSTANTIATE

}  // namespace phong

}  // namespace microlane
#endif  // HWY_ONCE
