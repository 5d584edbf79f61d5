#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/tabulated.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/tabulated-inl.h"
#include "src/distribution_kernels-inl.h"
#include "src/normals_call.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

FamilyCode FamilyOnTarget() { return NormalsFamily<Tabulated, Normals::kTabulated>(); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
template <>
const FamilyFunction* NormalsTable<Normals::kTabulated>() {
  return HWY_DISPATCH_TABLE(FamilyOnTarget);
}
template void RunFrom(const NormalsCode<Normals::kTabulated>&, std::size_t, Accuracy, const Call<float>&,
                      std::size_t);
template void RunFrom(const NormalsCode<Normals::kTabulated>&, std::size_t, Accuracy, const Call<double>&,
                      std::size_t);

}  // namespace microlane
#endif  // HWY_ONCE
