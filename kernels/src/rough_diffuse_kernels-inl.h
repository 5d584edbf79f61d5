// Batch kernels of facets that scatter, over a distribution policy and the kernel list's quantities.
#if defined(MICROLANE_SRC_ROUGH_DIFFUSE_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_SRC_ROUGH_DIFFUSE_KERNELS_INL_H_
#undef MICROLANE_SRC_ROUGH_DIFFUSE_KERNELS_INL_H_
#else
#define MICROLANE_SRC_ROUGH_DIFFUSE_KERNELS_INL_H_
#endif

#include <cstddef>
#include <string_view>
#include <utility>

#include "microlane/interfaced-inl.h"
#include "microlane/rough_diffuse-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

template <class Dist, class Radius, std::size_t kKernel>
struct RoughDiffuseKernel {
  static constexpr DiffuseKernelPlace kPlace = PlaceOfDiffuseKernel(kKernel);
  static constexpr std::string_view kId = kKernels[kKernel].id;
  static constexpr DielectricQuantity kQuantity = kDiffuseQuantities[kPlace.quantity];
  static constexpr bool kInterfaced = kPlace.scatterer == Scatterer::kInterfaced;
  static constexpr JointMasking kG = kQuantity.joint == DielectricQuantity::kSeparable
                                         ? JointMasking::kSeparable
                                         : JointMasking::kHeightCorrelated;

  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, V... v) {
    if constexpr (kQuantity.what == DielectricQuantity::kSample) {
      HWY_ALIGN T<D> in[sizeof...(V)][hn::MaxLanes(D())];
      HWY_ALIGN T<D> drawn[6][hn::MaxLanes(D())];
      std::size_t i = 0;
      (hn::Store(v, d, in[i++]), ...);
      SampleWithInterface<Dist, kG>(d, in, drawn);
      out.v0 = hn::Load(d, drawn[0]);
      out.v1 = hn::Load(d, drawn[1]);
      out.v2 = hn::Load(d, drawn[2]);
      out.v3 = hn::Load(d, drawn[3]);
      out.v4 = hn::Load(d, drawn[4]);
      out.v5 = hn::Load(d, drawn[5]);
    } else if constexpr (kQuantity.what == DielectricQuantity::kPdf) {
      out.v0 = PdfWithInterface<Dist, A>(d, v...);
    } else if constexpr (kQuantity.what == DielectricQuantity::kEvalNormal) {
      if constexpr (kInterfaced) {
        out.v0 = InterfacedOneNormal<Dist, kG, kQuantity.visible, A>(d, v...);
      } else {
        out.v0 = OneNormal<Dist, LambertianFacets, kG, kQuantity.visible, A>(d, v...);
      }
    } else {
      const QuadratureRule& rule = static_cast<const QuadratureRule&>(*options.prepared);
      if constexpr (kInterfaced) {
        out.v0 = InterfacedBody<Dist, Radius, kG, A>(d, rule, v...);
      } else {
        out.v0 = RoughDiffuse<Dist, Radius, LambertianFacets, kG, A>(d, rule, v...);
      }
    }
  }
};

template <class Dist, class Radius, std::size_t kFirst, std::size_t... kQuantity>
FamilyCode RoughDiffuseFamily(std::index_sequence<kQuantity...>) {
  return Family<RoughDiffuseKernel<Dist, Radius, kFirst + kQuantity>...>();
}
template <class Dist, class Radius, Normals kNormals, Scatterer kScatterer>
FamilyCode RoughDiffuseFamily() {
  return RoughDiffuseFamily<Dist, Radius, DiffuseKernel({kNormals, kScatterer, 0})>(
      std::make_index_sequence<kScatterers[static_cast<std::size_t>(kScatterer)].quantities>());
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_SRC_ROUGH_DIFFUSE_KERNELS_INL_H_
