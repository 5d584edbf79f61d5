#include "microlane/albedo.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/albedo_lookup.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/albedo-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct DirectionalKernel {
  static constexpr std::string_view kId = "albedo.directional";
  template <Accuracy, class D>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> cos_i) {
    DirectionalAlbedo(d, static_cast<const AlbedoTable&>(*options.prepared).entries(), cos_i, out.v0, out.v1);
  }
};

FamilyCode FamilyOnTarget() { return Family<DirectionalKernel>(); }

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* AlbedoLookupTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

namespace albedo {

template <class T>
void Directional(std::size_t n, const T* cos_i, const AlbedoTable& table, T* albedo, T* deficit,
                 Accuracy accuracy) {
  CallBuilder<T>()
      .In(cos_i)
      .Out(albedo)
      .Out(deficit)
      .In(table)
      .template Run<KernelIndex("albedo.directional")>(AlbedoLookupTable(), accuracy, n);
}

template void Directional(std::size_t, const float*, const AlbedoTable&, float*, float*, Accuracy);
template void Directional(std::size_t, const double*, const AlbedoTable&, double*, double*, Accuracy);

}  // namespace albedo

}  // namespace microlane
#endif  // HWY_ONCE
