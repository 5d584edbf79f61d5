#include "microlane/roughness.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/roughness.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/roughness-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct FromMomentsKernel {
  static constexpr std::string_view kId = "roughness.from_moments";
  template <Accuracy, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    Vec<D> unused0, unused1, unused2;
    InDouble6<FromMomentsOp>(d, out.v0, out.v1, out.v2, unused0, unused1, unused2, in...);
  }
};

struct ToMomentsKernel {
  static constexpr std::string_view kId = "roughness.to_moments";
  template <Accuracy, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    Vec<D> unused0, unused1, unused2;
    InDouble6<ToMomentsOp>(d, out.v0, out.v1, out.v2, unused0, unused1, unused2, in...);
  }
};

FamilyCode FamilyOnTarget() { return Family<FromMomentsKernel, ToMomentsKernel>(); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* RoughnessTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace roughness {

template <class T>
void FromMoments(std::size_t n, const T* mean_x, const T* mean_y, const T* moment_xx, const T* moment_yy,
                 const T* moment_xy, T* alpha_x, T* alpha_y, T* r_xy, Accuracy accuracy) {
  CallBuilder<T> call;
  call.In(mean_x).In(mean_y).In(moment_xx).In(moment_yy).In(moment_xy);
  call.Out(alpha_x).Out(alpha_y).Out(r_xy);
  call.template Run<KernelIndex("roughness.from_moments")>(RoughnessTable(), accuracy, n);
}

template <class T>
void ToMoments(std::size_t n, const T* alpha_x, const T* alpha_y, const T* r_xy, const T* mean_x,
               const T* mean_y, T* moment_xx, T* moment_yy, T* moment_xy, Accuracy accuracy) {
  CallBuilder<T> call;
  call.In(alpha_x).In(alpha_y).In(r_xy).In(mean_x).In(mean_y);
  call.Out(moment_xx).Out(moment_yy).Out(moment_xy);
  call.template Run<KernelIndex("roughness.to_moments")>(RoughnessTable(), accuracy, n);
}

#define MICROLANE_INSTANTIATE(T)                                                                       \
  template void FromMoments(std::size_t, const T*, const T*, const T*, const T*, const T*, T*, T*, T*, \
                            Accuracy);                                                                 \
  template void ToMoments(std::size_t, const T*, const T*, const T*, const T*, const T*, T*, T*, T*,   \
                          Accuracy);
MICROLANE_INSTANTIATE(float)
MICROLANE_INSTANTIATE(double)
#undef MICROLANE_INSTANTIATE

}  // namespace roughness

}  // namespace microlane
#endif  // HWY_ONCE
