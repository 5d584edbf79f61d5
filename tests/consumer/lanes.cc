#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "lanes.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/fresnel-inl.h"

HWY_BEFORE_NAMESPACE();
namespace consumer {
namespace HWY_NAMESPACE {

// The reflectance of glass seen along its normal: ((n - 1)/(n + 1))^2.
float NormalReflectance(float n) {
  namespace lanes = microlane::HWY_NAMESPACE;
  const hwy::HWY_NAMESPACE::ScalableTag<float> d;
  return hwy::HWY_NAMESPACE::GetLane(
      lanes::FresnelDielectric<lanes::FresnelPart::kUnpolarised, microlane::Accuracy::kStandard>(
          d, lanes::Const(d, 1), lanes::Const(d, n)));
}

}  // namespace HWY_NAMESPACE
}  // namespace consumer
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <cmath>
#include <cstdio>

namespace consumer {

HWY_EXPORT(NormalReflectance);

int Run() {
  const float reflectance = HWY_DYNAMIC_DISPATCH(NormalReflectance)(1.5f);
  std::printf("lanes: reflectance of glass %g\n", reflectance);
  return std::abs(reflectance - 0.04f) < 1e-7f ? 0 : 1;
}

}  // namespace consumer

int main() { return consumer::Run(); }
#endif  // HWY_ONCE
