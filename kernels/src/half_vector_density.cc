#include "microlane/half_vector_density.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/half_vector_density.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/phong-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// D cos, the cosine taken into the density's factor.
template <class Dist>
struct DensityKernel {
  static constexpr std::string_view kId =
      Dist::kDensityOfCosine ? "half_vector_density.phong" : "half_vector_density.ward";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> mx, Vec<D> my, Vec<D> mz,
                              Vec<D> parameter) {
    const Vec<D> y = TimesPiNormalDensity<Dist, A>(d, mz, mx, my, mz, parameter);
    // 1/pi with what its rounding leaves, but for what is beyond the range already.
    constexpr double kRest = 1 / kPi - static_cast<double>(static_cast<T<D>>(1 / kPi));
    const Vec<D> largest = hn::Set(d, std::numeric_limits<T<D>>::max());
    const Vec<D> density = hn::MulAdd(y, Const(d, 1 / kPi), hn::Mul(y, Const(d, kRest)));
    out.v0 = hn::IfThenElse(hn::Lt(y, largest), density, y);
  }
};

FamilyCode FamilyOnTarget() { return Family<DensityKernel<Beckmann>, DensityKernel<Phong>>(); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* HalfVectorDensityTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace half_vector_density {
namespace {

template <std::size_t kKernel, class T>
void OfNormal(std::size_t n, const Directions<T>& m, const Parameter<T>& parameter, T* density,
              Accuracy accuracy) {
  CallBuilder<T>().In(m).In(parameter).Out(density).template Run<kKernel>(HalfVectorDensityTable(), accuracy,
                                                                          n);
}

}  // namespace

template <class T>
void Ward(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> alpha, T* density, Accuracy accuracy) {
  OfNormal<KernelIndex("half_vector_density.ward")>(n, m, alpha, density, accuracy);
}

template <class T>
void Phong(std::size_t n, const DirectionsOf<T>& m, ParameterOf<T> exponent, T* density, Accuracy accuracy) {
  OfNormal<KernelIndex("half_vector_density.phong")>(n, m, exponent, density, accuracy);
}

template void Ward(std::size_t, const DirectionsOf<float>&, ParameterOf<float>, float*, Accuracy);
template void Ward(std::size_t, const DirectionsOf<double>&, ParameterOf<double>, double*, Accuracy);
template void Phong(std::size_t, const DirectionsOf<float>&, ParameterOf<float>, float*, Accuracy);
template void Phong(std::size_t, const DirectionsOf<double>&, ParameterOf<double>, double*, Accuracy);

}  // namespace half_vector_density

}  // namespace microlane
#endif  // HWY_ONCE
