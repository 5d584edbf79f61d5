#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/interfaced_body_beckmann.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/beckmann-inl.h"
#include "src/channels-inl.h"
#include "src/interfaced_call.h"
#include "src/rough_diffuse_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

FamilyCode FamilyOnTarget() {
  return RoughDiffuseFamily<Beckmann, BeckmannRadius, Normals::kBeckmann, Scatterer::kInterfaced>();
}

BodyChannelCode ChannelsOnTarget() { return BodyChannelsOf<Beckmann, BeckmannRadius, Normals::kBeckmann>(); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
template <>
const FamilyFunction* RoughDiffuseTable<Normals::kBeckmann, Scatterer::kInterfaced>() {
  return HWY_DISPATCH_TABLE(FamilyOnTarget);
}
HWY_EXPORT(ChannelsOnTarget);
template <>
const BodyChannelFunction* BodyChannelTable<Normals::kBeckmann>() {
  return HWY_DISPATCH_TABLE(ChannelsOnTarget);
}
template class InterfacedBodyLanes<Normals::kBeckmann, float>;
template class InterfacedBodyLanes<Normals::kBeckmann, double>;

}  // namespace microlane
#endif  // HWY_ONCE
