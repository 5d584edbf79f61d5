#include "microlane/beckmann.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/beckmann.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/beckmann-inl.h"
#include "src/distribution_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

constexpr std::string_view kDId = "beckmann.D";
constexpr std::string_view kDIsotropicId = "beckmann.D_isotropic";
constexpr std::string_view kLambdaId = "beckmann.Lambda";
constexpr std::string_view kLambdaIsotropicId = "beckmann.Lambda_isotropic";
constexpr std::string_view kG1Id = "beckmann.G1";
constexpr std::string_view kG1IsotropicId = "beckmann.G1_isotropic";
constexpr std::string_view kSampleNormalId = "beckmann.sample_normal";
constexpr std::string_view kG1RationalId = "beckmann.G1_rational";
constexpr std::string_view kSampleNormalWidenedId = "beckmann.sample_normal_widened";

// Beckmann with Walter 2007 Eq. 27 for its masking.
struct BeckmannRational : Beckmann {
  template <Care, Accuracy A, class D, class... P>
  static HWY_INLINE Vec<D> Masking(D d, Vec<D> vx, Vec<D> vy, Vec<D> z, P... p) {
    return Beckmann::RationalMasking<A>(d, vx, vy, z, p...);
  }
};

struct SampleNormalWidenedKernel {
  static constexpr std::string_view kId = kSampleNormalWidenedId;
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> u1, Vec<D> u2,
                              Vec<D> cos_i, Vec<D> alpha_x, Vec<D> alpha_y) {
    const Vec<D> factor = Beckmann::Widening<A>(d, cos_i);
    Beckmann::SampleNormal<A>(d, out.v0, out.v1, out.v2, out.v3, u1, u2, hn::Mul(alpha_x, factor),
                              hn::Mul(alpha_y, factor));
  }
};

FamilyCode FamilyOnTarget() {
  return Family<DKernel<Beckmann, kDId>, DKernel<Beckmann, kDIsotropicId>, LambdaKernel<Beckmann, kLambdaId>,
                LambdaKernel<Beckmann, kLambdaIsotropicId>, G1Kernel<Beckmann, kG1Id>,
                G1Kernel<Beckmann, kG1IsotropicId>, SampleNormalKernel<Beckmann, kSampleNormalId>,
                G1Kernel<BeckmannRational, kG1RationalId>, SampleNormalWidenedKernel>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* BeckmannTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace beckmann {

template <class T>
void D(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y, T* d,
       Accuracy accuracy) {
  CallBuilder<T>().In(m).In(alpha_x).In(alpha_y).Out(d).template Run<KernelIndex("beckmann.D")>(
      BeckmannTable(), accuracy, n);
}

template <class T>
void D(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> alpha, T* d, Accuracy accuracy) {
  CallBuilder<T>().In(m).In(alpha).Out(d).template Run<KernelIndex("beckmann.D_isotropic")>(BeckmannTable(),
                                                                                            accuracy, n);
}

template <class T>
void Lambda(std::size_t n, const DirectionsOf<T>& v, ParameterOf<T> alpha_x, ParameterOf<T> alpha_y,
            T* lambda, Accuracy accuracy) {
  CallBuilder<T>().In(v).In(alpha_x).In(alpha_y).Out(lambda).template Run<KernelIndex("beckmann.Lambda")>(
      BeckmannTable(), accuracy, n);
}

template <class T>
void Lambda(std::size_t n, const DirectionsOf<T>& v, ParameterOf<T> alpha, T* lambda, Accuracy accuracy) {
  CallBuilder<T>().In(v).In(alpha).Out(lambda).template Run<KernelIndex("beckmann.Lambda_isotropic")>(
      BeckmannTable(), accuracy, n);
}

template <class T>
void G1(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> alpha_x,
        ParameterOf<T> alpha_y, T* g1, Accuracy accuracy) {
  CallBuilder<T>().In(v).In(m).In(alpha_x).In(alpha_y).Out(g1).template Run<KernelIndex("beckmann.G1")>(
      BeckmannTable(), accuracy, n);
}

template <class T>
void G1(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> alpha, T* g1,
        Accuracy accuracy) {
  CallBuilder<T>().In(v).In(m).In(alpha).Out(g1).template Run<KernelIndex("beckmann.G1_isotropic")>(
      BeckmannTable(), accuracy, n);
}

template <class T>
void G1Rational(std::size_t n, const DirectionsOf<T>& v, const DirectionsOf<T>& m, ParameterOf<T> alpha_x,
                ParameterOf<T> alpha_y, T* g1, Accuracy accuracy) {
  CallBuilder<T>()
      .In(v)
      .In(m)
      .In(alpha_x)
      .In(alpha_y)
      .Out(g1)
      .template Run<KernelIndex("beckmann.G1_rational")>(BeckmannTable(), accuracy, n);
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
      .template Run<KernelIndex("beckmann.sample_normal")>(BeckmannTable(), accuracy, n);
}

template <class T>
void SampleNormalWidened(std::size_t n, const T* u1, const T* u2, const T* cos_i, ParameterOf<T> alpha_x,
                         ParameterOf<T> alpha_y, MutableDirections<T> m, T* pdf, Accuracy accuracy) {
  CallBuilder<T>()
      .In(u1)
      .In(u2)
      .In(cos_i)
      .In(alpha_x)
      .In(alpha_y)
      .Out(m)
      .Out(pdf)
      .template Run<KernelIndex("beckmann.sample_normal_widened")>(BeckmannTable(), accuracy, n);
}

#define MICROLANE_INSTANTIATE(T)                                                                           \
  template void D(std::size_t, const DirectionsOf<T>&, ParameterOf<T>, ParameterOf<T>, T*, Accuracy);      \
  template void D(std::size_t, const DirectionsOf<T>&, ParameterOf<T>, T*, Accuracy);                      \
  template void Lambda(std::size_t, const DirectionsOf<T>&, ParameterOf<T>, ParameterOf<T>, T*, Accuracy); \
  template void Lambda(std::size_t, const DirectionsOf<T>&, ParameterOf<T>, T*, Accuracy);                 \
  template void G1(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, ParameterOf<T>,            \
                   ParameterOf<T>, T*, Accuracy);                                                          \
  template void G1(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, ParameterOf<T>, T*,        \
                   Accuracy);                                                                              \
  template void G1Rational(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, ParameterOf<T>,    \
                           ParameterOf<T>, T*, Accuracy);                                                  \
  template void SampleNormal(std::size_t, const T*, const T*, ParameterOf<T>, ParameterOf<T>,              \
                             MutableDirections<T>, T*, Accuracy);                                          \
  template void SampleNormalWidened(std::size_t, const T*, const T*, const T*, ParameterOf<T>,             \
                                    ParameterOf<T>, MutableDirections<T>, T*, Accuracy);
MICROLANE_INSTANTIATE(float)
MICROLANE_INSTANTIATE(double)
#undef MICROLANE_INSTANTIATE

}  // namespace beckmann

}  // namespace microlane
#endif  // HWY_ONCE
