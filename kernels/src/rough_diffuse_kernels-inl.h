// Batch kernels of diffuse rough surfaces, over a distribution policy and the kernel list's quantities.
#if defined(MICROLANE_SRC_ROUGH_DIFFUSE_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_SRC_ROUGH_DIFFUSE_KERNELS_INL_H_
#undef MICROLANE_SRC_ROUGH_DIFFUSE_KERNELS_INL_H_
#else
#define MICROLANE_SRC_ROUGH_DIFFUSE_KERNELS_INL_H_
#endif

#include <cstddef>
#include <string_view>
#include <utility>

#include "microlane/rough_diffuse-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

template <class Dist, class Radius, Normals kNormals, std::size_t kQuantity>
struct RoughDiffuseKernel {
  static constexpr std::string_view kId = kKernels[DiffuseKernel(kNormals, kQuantity)].id;
  static constexpr JointMasking kG = kDiffuseQuantities[kQuantity].joint == DielectricQuantity::kSeparable
                                         ? JointMasking::kSeparable
                                         : JointMasking::kHeightCorrelated;

  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, V... v) {
    out.v0 =
        RoughDiffuse<Dist, Radius, kG, A>(d, static_cast<const QuadratureRule&>(*options.prepared), v...);
  }
};

template <class Dist, class Radius, Normals kNormals, std::size_t... kQuantity>
FamilyCode RoughDiffuseFamily(std::index_sequence<kQuantity...>) {
  return Family<RoughDiffuseKernel<Dist, Radius, kNormals, kQuantity>...>();
}
template <class Dist, class Radius, Normals kNormals>
FamilyCode RoughDiffuseFamily() {
  return RoughDiffuseFamily<Dist, Radius, kNormals>(std::make_index_sequence<kNumDiffuseQuantities>());
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_SRC_ROUGH_DIFFUSE_KERNELS_INL_H_
