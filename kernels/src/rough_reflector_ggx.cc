#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/rough_reflector_ggx.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/ggx-inl.h"
#include "src/channels-inl.h"
#include "src/rough_reflector_call.h"
#include "src/rough_surface_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

FamilyCode FamilyOnTarget() { return RoughReflectorFamily<Ggx, Normals::kGgx>(); }
ChannelCode ChannelsOnTarget() { return Channels<Ggx, Normals::kGgx>(); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
template <>
const FamilyFunction* RoughReflectorTable<Normals::kGgx>() {
  return HWY_DISPATCH_TABLE(FamilyOnTarget);
}
HWY_EXPORT(ChannelsOnTarget);
template <>
const ChannelFunction* ChannelTable<Normals::kGgx>() {
  return HWY_DISPATCH_TABLE(ChannelsOnTarget);
}
template class RoughReflectorLanes<Normals::kGgx, Reflector::kMirror, float>;
template class RoughReflectorLanes<Normals::kGgx, Reflector::kMirror, double>;
template class RoughReflectorLanes<Normals::kGgx, Reflector::kConductor, float>;
template class RoughReflectorLanes<Normals::kGgx, Reflector::kConductor, double>;
template class RoughReflectorLanes<Normals::kGgx, Reflector::kSchlick, float>;
template class RoughReflectorLanes<Normals::kGgx, Reflector::kSchlick, double>;

}  // namespace microlane
#endif  // HWY_ONCE
