#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/rough_reflector_phong.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/phong-inl.h"
#include "src/channels-inl.h"
#include "src/rough_reflector_call.h"
#include "src/rough_surface_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

FamilyCode FamilyOnTarget() { return RoughReflectorFamily<Phong, Normals::kPhong>(); }
ChannelCode ChannelsOnTarget() { return Channels<Phong, Normals::kPhong>(); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
template <>
const FamilyFunction* RoughReflectorTable<Normals::kPhong>() {
  return HWY_DISPATCH_TABLE(FamilyOnTarget);
}
HWY_EXPORT(ChannelsOnTarget);
template <>
const ChannelFunction* ChannelTable<Normals::kPhong>() {
  return HWY_DISPATCH_TABLE(ChannelsOnTarget);
}
template class RoughReflectorLanes<Normals::kPhong, Reflector::kMirror, float>;
template class RoughReflectorLanes<Normals::kPhong, Reflector::kMirror, double>;
template class RoughReflectorLanes<Normals::kPhong, Reflector::kConductor, float>;
template class RoughReflectorLanes<Normals::kPhong, Reflector::kConductor, double>;
template class RoughReflectorLanes<Normals::kPhong, Reflector::kSchlick, float>;
template class RoughReflectorLanes<Normals::kPhong, Reflector::kSchlick, double>;

}  // namespace microlane
#endif  // HWY_ONCE
