#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/v_cavity_ggx.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/ggx-inl.h"
#include "src/v_cavity_call.h"
#include "src/v_cavity_trace-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

VCavityTotals TraceOnTarget(const VCavityPlan& plan, std::uint64_t first, std::uint64_t count,
                            std::uint64_t* counts) {
  return TraceVCavities<Ggx>(plan, first, count, counts);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(TraceOnTarget);
template <>
const VCavityFunction* VCavityTable<Normals::kGgx>() {
  return HWY_DISPATCH_TABLE(TraceOnTarget);
}
template class VCavityCalls<Normals::kGgx>;

}  // namespace microlane
#endif  // HWY_ONCE
