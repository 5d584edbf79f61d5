#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/mean_fresnel_ggx.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "src/mean_fresnel_call.h"
#include "src/mean_fresnel_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

FamilyCode FamilyOnTarget() { return MeanFresnelFamily<GgxVisibleNormals, Normals::kGgx>(); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
template <>
const FamilyFunction* MeanFresnelTable<Normals::kGgx>() {
  return HWY_DISPATCH_TABLE(FamilyOnTarget);
}
template class MeanFresnelLanes<Normals::kGgx, float>;
template class MeanFresnelLanes<Normals::kGgx, double>;

}  // namespace microlane
#endif  // HWY_ONCE
