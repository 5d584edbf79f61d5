// Batch kernels of means over visible normals, over a distribution's nodes and the kernel list's quantities.
#if defined(MICROLANE_SRC_MEAN_FRESNEL_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_SRC_MEAN_FRESNEL_KERNELS_INL_H_
#undef MICROLANE_SRC_MEAN_FRESNEL_KERNELS_INL_H_
#else
#define MICROLANE_SRC_MEAN_FRESNEL_KERNELS_INL_H_
#endif

#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>

#include "microlane/mean_fresnel-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

template <class Visible, Normals kNormals, std::size_t kQuantity>
struct MeanFresnelQuantityKernel {
  static constexpr std::string_view kId = kKernels[MeanFresnelKernel(kNormals, kQuantity)].id;
  using Facets = std::conditional_t<
      kQuantity == MeanFresnelQuantity::kDielectric, DielectricInterface,
      std::conditional_t<kQuantity == MeanFresnelQuantity::kConductor, ConductorFacets, SchlickFacets>>;

  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, V... v) {
    if constexpr (kQuantity == MeanFresnelQuantity::kCosine) {
      (void)options;
      out.v0 = MeanFresnelCosine<Visible, A>(d, v...);
    } else {
      const QuadratureTable<T<D>> table =
          static_cast<const QuadratureRule&>(*options.prepared).template Table<T<D>>();
      if constexpr (Facets::kParameters == 1) {
        out.v0 = MeanFresnel<Visible, Facets, A>(d, table, v..., hn::Zero(d));
      } else {
        out.v0 = MeanFresnel<Visible, Facets, A>(d, table, v...);
      }
    }
  }
};

template <class Visible, Normals kNormals, std::size_t... kQuantity>
FamilyCode MeanFresnelFamily(std::index_sequence<kQuantity...>) {
  return Family<MeanFresnelQuantityKernel<Visible, kNormals, kQuantity>...>();
}
template <class Visible, Normals kNormals>
FamilyCode MeanFresnelFamily() {
  return MeanFresnelFamily<Visible, kNormals>(std::make_index_sequence<kNumMeanFresnelQuantities>());
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_SRC_MEAN_FRESNEL_KERNELS_INL_H_
