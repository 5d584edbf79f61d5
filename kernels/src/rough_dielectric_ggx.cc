#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/rough_dielectric_ggx.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/ggx-inl.h"
#include "src/rough_dielectric_call.h"
#include "src/rough_surface_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

FamilyCode FamilyOnTarget() { return RoughDielectricFamily<Ggx, Normals::kGgx>(); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
template <>
const FamilyFunction* RoughDielectricTable<Normals::kGgx>() {
  return HWY_DISPATCH_TABLE(FamilyOnTarget);
}
template class RoughDielectricLanes<Normals::kGgx, float>;
template class RoughDielectricLanes<Normals::kGgx, double>;

}  // namespace microlane
#endif  // HWY_ONCE
