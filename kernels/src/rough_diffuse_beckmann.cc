#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/rough_diffuse_beckmann.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/beckmann-inl.h"
#include "src/rough_diffuse_call.h"
#include "src/rough_diffuse_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

FamilyCode FamilyOnTarget() {
  return RoughDiffuseFamily<Beckmann, BeckmannRadius, Normals::kBeckmann, Scatterer::kLambertian>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
template <>
const FamilyFunction* RoughDiffuseTable<Normals::kBeckmann, Scatterer::kLambertian>() {
  return HWY_DISPATCH_TABLE(FamilyOnTarget);
}
template class RoughDiffuseLanes<Normals::kBeckmann, float>;
template class RoughDiffuseLanes<Normals::kBeckmann, double>;

}  // namespace microlane
#endif  // HWY_ONCE
