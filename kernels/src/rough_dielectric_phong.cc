#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/rough_dielectric_phong.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/phong-inl.h"
#include "src/rough_dielectric_call.h"
#include "src/rough_surface_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

FamilyCode FamilyOnTarget() { return RoughDielectricFamily<Phong, Normals::kPhong>(); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
template <>
const FamilyFunction* RoughDielectricTable<Normals::kPhong>() {
  return HWY_DISPATCH_TABLE(FamilyOnTarget);
}
template class RoughDielectricLanes<Normals::kPhong, float>;
template class RoughDielectricLanes<Normals::kPhong, double>;

}  // namespace microlane
#endif  // HWY_ONCE
