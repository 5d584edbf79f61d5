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

void ConductorsOnTarget(const ConductorChannels& call, std::size_t n) {
  RunChannels<Ggx, Reflector::kConductor, 2>(call, n);
}
void SchlickOnTarget(const SchlickChannels& call, std::size_t n) {
  RunChannels<Ggx, Reflector::kSchlick, 2>(call, n);
}

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

HWY_EXPORT(ConductorsOnTarget);
HWY_EXPORT(SchlickOnTarget);
template <>
void RunOnTarget<Normals::kGgx>(const ConductorChannels& call, std::size_t n) {
  HWY_DISPATCH_TABLE(ConductorsOnTarget)[ChosenTableIndex()](call, n);
}
template <>
void RunOnTarget<Normals::kGgx>(const SchlickChannels& call, std::size_t n) {
  HWY_DISPATCH_TABLE(SchlickOnTarget)[ChosenTableIndex()](call, n);
}

template class RoughReflectorLanes<Normals::kGgx, Reflector::kMirror, float>;
template class RoughReflectorLanes<Normals::kGgx, Reflector::kMirror, double>;
template class RoughReflectorLanes<Normals::kGgx, Reflector::kConductor, float>;
template class RoughReflectorLanes<Normals::kGgx, Reflector::kConductor, double>;
template class RoughReflectorLanes<Normals::kGgx, Reflector::kSchlick, float>;
template class RoughReflectorLanes<Normals::kGgx, Reflector::kSchlick, double>;

}  // namespace microlane
#endif  // HWY_ONCE
