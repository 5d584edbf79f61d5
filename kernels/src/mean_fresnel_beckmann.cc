#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/mean_fresnel_beckmann.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "src/mean_fresnel_call.h"
#include "src/mean_fresnel_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

FamilyCode FamilyOnTarget() { return MeanFresnelFamily<BeckmannVisibleNormals, Normals::kBeckmann>(); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
template <>
const FamilyFunction* MeanFresnelTable<Normals::kBeckmann>() {
  return HWY_DISPATCH_TABLE(FamilyOnTarget);
}
template class MeanFresnelLanes<Normals::kBeckmann, float>;
template class MeanFresnelLanes<Normals::kBeckmann, double>;

}  // namespace microlane
#endif  // HWY_ONCE
