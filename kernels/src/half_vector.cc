#include "microlane/half_vector.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/half_vector.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/half_vector-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct ReflectionKernel {
  static constexpr std::string_view kId = "half_vector.reflection";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> ix, Vec<D> iy, Vec<D> iz,
                              Vec<D> ox, Vec<D> oy, Vec<D> oz) {
    HalfVectorReflection<A>(d, out.v0, out.v1, out.v2, ix, iy, iz, ox, oy, oz);
  }
};

struct ReflectionJacobianKernel {
  static constexpr std::string_view kId = "half_vector.reflection_jacobian";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> ix, Vec<D> iy, Vec<D> iz,
                              Vec<D> ox, Vec<D> oy, Vec<D> oz) {
    out.v0 = HalfVectorJacobian<A>(d, ix, iy, iz, ox, oy, oz, Const(d, 1));
  }
};

struct ReflectionJacobianCosKernel {
  static constexpr std::string_view kId = "half_vector.reflection_jacobian_cos";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> cos_o) {
    out.v0 = ReflectionJacobian(d, cos_o);
  }
};

struct RefractionKernel {
  static constexpr std::string_view kId = "half_vector.refraction";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> ix, Vec<D> iy, Vec<D> iz,
                              Vec<D> ox, Vec<D> oy, Vec<D> oz, Vec<D> eta) {
    HalfVectorRefraction<A>(d, out.v0, out.v1, out.v2, ix, iy, iz, ox, oy, oz, eta);
  }
};

struct RefractionJacobianKernel {
  static constexpr std::string_view kId = "half_vector.refraction_jacobian";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> ix, Vec<D> iy, Vec<D> iz,
                              Vec<D> ox, Vec<D> oy, Vec<D> oz, Vec<D> eta) {
    out.v0 = HalfVectorJacobian<A>(d, ix, iy, iz, ox, oy, oz, eta);
  }
};

struct RefractionJacobianCosKernel {
  static constexpr std::string_view kId = "half_vector.refraction_jacobian_cos";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> cos_i, Vec<D> cos_o,
                              Vec<D> eta) {
    out.v0 = RefractionJacobian<A>(d, cos_i, cos_o, eta);
  }
};

struct ReflectKernel {
  static constexpr std::string_view kId = "reflect";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> ix, Vec<D> iy, Vec<D> iz,
                              Vec<D> mx, Vec<D> my, Vec<D> mz) {
    Reflect(d, out.v0, out.v1, out.v2, ix, iy, iz, mx, my, mz);
  }
};

struct RefractKernel {
  static constexpr std::string_view kId = "refract";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> ix, Vec<D> iy, Vec<D> iz,
                              Vec<D> mx, Vec<D> my, Vec<D> mz, Vec<D> eta) {
    Refract<A>(d, out.v0, out.v1, out.v2, ix, iy, iz, mx, my, mz, eta);
  }
};

FamilyCode FamilyOnTarget() {
  return Family<ReflectionKernel, ReflectionJacobianKernel, ReflectionJacobianCosKernel, RefractionKernel,
                RefractionJacobianKernel, RefractionJacobianCosKernel, ReflectKernel, RefractKernel>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* HalfVectorTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace half_vector {

template <class T>
void Reflection(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, MutableDirections<T> h,
                Accuracy accuracy) {
  CallBuilder<T>().In(wi).In(wo).Out(h).template Run<KernelIndex("half_vector.reflection")>(HalfVectorTable(),
                                                                                            accuracy, n);
}

template <class T>
void ReflectionJacobian(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, T* jacobian,
                        Accuracy accuracy) {
  CallBuilder<T>().In(wi).In(wo).Out(jacobian).template Run<KernelIndex("half_vector.reflection_jacobian")>(
      HalfVectorTable(), accuracy, n);
}

template <class T>
void ReflectionJacobian(std::size_t n, const T* cos_o, T* jacobian, Accuracy accuracy) {
  CallBuilder<T>().In(cos_o).Out(jacobian).template Run<KernelIndex("half_vector.reflection_jacobian_cos")>(
      HalfVectorTable(), accuracy, n);
}

template <class T>
void Refraction(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo, ParameterOf<T> eta,
                MutableDirections<T> h, Accuracy accuracy) {
  CallBuilder<T>().In(wi).In(wo).In(eta).Out(h).template Run<KernelIndex("half_vector.refraction")>(
      HalfVectorTable(), accuracy, n);
}

template <class T>
void RefractionJacobian(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& wo,
                        ParameterOf<T> eta, T* jacobian, Accuracy accuracy) {
  CallBuilder<T>()
      .In(wi)
      .In(wo)
      .In(eta)
      .Out(jacobian)
      .template Run<KernelIndex("half_vector.refraction_jacobian")>(HalfVectorTable(), accuracy, n);
}

template <class T>
void RefractionJacobian(std::size_t n, const T* cos_i, const T* cos_o, ParameterOf<T> eta, T* jacobian,
                        Accuracy accuracy) {
  CallBuilder<T>()
      .In(cos_i)
      .In(cos_o)
      .In(eta)
      .Out(jacobian)
      .template Run<KernelIndex("half_vector.refraction_jacobian_cos")>(HalfVectorTable(), accuracy, n);
}

#define MICROLANE_INSTANTIATE(T)                                                                        \
  template void Reflection(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,                 \
                           MutableDirections<T>, Accuracy);                                             \
  template void ReflectionJacobian(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, T*,     \
                                   Accuracy);                                                           \
  template void ReflectionJacobian(std::size_t, const T*, T*, Accuracy);                                \
  template void Refraction(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, ParameterOf<T>, \
                           MutableDirections<T>, Accuracy);                                             \
  template void RefractionJacobian(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&,         \
                                   ParameterOf<T>, T*, Accuracy);                                       \
  template void RefractionJacobian(std::size_t, const T*, const T*, ParameterOf<T>, T*, Accuracy);
MICROLANE_INSTANTIATE(float)
MICROLANE_INSTANTIATE(double)
#undef MICROLANE_INSTANTIATE

}  // namespace half_vector

template <class T>
void Reflect(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& m, MutableDirections<T> wo,
             Accuracy accuracy) {
  CallBuilder<T>().In(wi).In(m).Out(wo).template Run<KernelIndex("reflect")>(HalfVectorTable(), accuracy, n);
}

template <class T>
void Refract(std::size_t n, const DirectionsOf<T>& wi, const DirectionsOf<T>& m, ParameterOf<T> eta,
             MutableDirections<T> wo, Accuracy accuracy) {
  CallBuilder<T>().In(wi).In(m).In(eta).Out(wo).template Run<KernelIndex("refract")>(HalfVectorTable(),
                                                                                     accuracy, n);
}

#define MICROLANE_INSTANTIATE(T)                                                                           \
  template void Reflect(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, MutableDirections<T>, \
                        Accuracy);                                                                         \
  template void Refract(std::size_t, const DirectionsOf<T>&, const DirectionsOf<T>&, ParameterOf<T>,       \
                        MutableDirections<T>, Accuracy);
MICROLANE_INSTANTIATE(float)
MICROLANE_INSTANTIATE(double)
#undef MICROLANE_INSTANTIATE

}  // namespace microlane
#endif  // HWY_ONCE
