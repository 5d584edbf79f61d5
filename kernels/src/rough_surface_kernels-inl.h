// Batch kernels of rough dielectrics and opaque surfaces, over a distribution policy and the kernel list's
// quantities.
#if defined(MICROLANE_SRC_ROUGH_SURFACE_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_SRC_ROUGH_SURFACE_KERNELS_INL_H_
#undef MICROLANE_SRC_ROUGH_SURFACE_KERNELS_INL_H_
#else
#define MICROLANE_SRC_ROUGH_SURFACE_KERNELS_INL_H_
#endif

#include <cstddef>
#include <string_view>
#include <type_traits>
#include <utility>

#include "microlane/rough_dielectric-inl.h"
#include "microlane/rough_reflector-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// One kernel of a model; kRow is its place in kDielectricQuantities or kReflectorQuantities.
template <class Dist, class Facets, std::size_t kKernel, std::size_t kRow>
struct RoughSurfaceKernel {
  static constexpr bool kDielectric = std::is_same_v<Facets, DielectricInterface>;
  static constexpr DielectricQuantity kQuantity = kDielectric ? kDielectricQuantities[kDielectric ? kRow : 0]
                                                              : kReflectorQuantities[kDielectric ? 0 : kRow];
  static constexpr std::string_view kId = kKernels[kKernel].id;
  static constexpr bool kSamples = kQuantity.what == DielectricQuantity::kSample;
  static constexpr bool kVCavity = kQuantity.joint == DielectricQuantity::kVCavity;
  static constexpr Drawn kDrawn = kVCavity            ? Drawn::kVCavity
                                  : kQuantity.visible ? Drawn::kVisible
                                                      : Drawn::kNormals;
  static constexpr bool kValue = kQuantity.HasValue(), kPdf = kQuantity.what != DielectricQuantity::kEval;
  static constexpr Lobes kLobes = kQuantity.HasBothLobes() ? Lobes::kBoth
                                  : kQuantity.reflects     ? Lobes::kReflection
                                                           : Lobes::kTransmission;
  static constexpr JointMasking kG =
      kVCavity                                            ? JointMasking::kVCavity
      : kQuantity.joint == DielectricQuantity::kKelemen   ? JointMasking::kKelemen
      : kQuantity.joint == DielectricQuantity::kSeparable ? JointMasking::kSeparable
                                                          : JointMasking::kHeightCorrelated;
  // Every input enters a product of the result; but Min and Max drop NaN on SCALAR, EMU128 and Arm.
  static constexpr bool kPassesNan = kDielectric && !Dist::kHasExponent && kValue && !kPdf &&
                                     kLobes != Lobes::kTransmission && HWY_ARCH_X86 &&
                                     HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128;

  // Parameters come as (the distribution's, the facets') in the kernel list, and the other way round in the
  // lane functions.
  static constexpr std::size_t kRoughness =
      Split(kKernels[kKernel].inputs).count - Split(kKernels[kKernel].inputs).per_lane - Facets::kParameters;

  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> ix, Vec<D> iy,
                              Vec<D> iz, Vec<D> a, Vec<D> b, V... rest) {
    if constexpr (kSamples && kLobes != Lobes::kBoth && !kVCavity) {
      FacetsFirst<kRoughness, A>(d, options, out, ix, iy, iz, a, b, hn::Zero(d), rest...);
    } else {
      FacetsFirst<kRoughness, A>(d, options, out, ix, iy, iz, a, b, rest...);
    }
  }

 private:
  // Brings the first kCount parameters behind the others. a, b, c: wo, or the random numbers.
  template <std::size_t kCount, Accuracy A, class D, class... P>
  static HWY_INLINE void FacetsFirst(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> ix,
                                     Vec<D> iy, Vec<D> iz, Vec<D> a, Vec<D> b, Vec<D> c, Vec<D> first,
                                     P... p) {
    if constexpr (kCount > 0) {
      FacetsFirst<kCount - 1, A>(d, options, out, ix, iy, iz, a, b, c, p..., first);
    } else if constexpr (kSamples && !kDielectric && kDrawn == Drawn::kVisible) {
      SampleVisible<Dist, Facets, kG, A>(d, out.v0, out.v1, out.v2, out.v3, out.v4, out.v5, ix, iy, iz, a, b,
                                         first, p...);
    } else if constexpr (kSamples) {
      SampleRoughSurface<Dist, Facets, kLobes, kG, kDrawn, A>(d, options.radiance, out.v0, out.v1, out.v2,
                                                              out.v3, out.v4, out.v5, ix, iy, iz, a, b, c,
                                                              first, p...);
    } else {
      RoughSurface<Dist, Facets, kLobes, kG, kValue, kPdf, kDrawn, A>(
          d, options.radiance, out.v0, kValue ? out.v1 : out.v0, ix, iy, iz, a, b, c, first, p...);
    }
  }
};

template <class Dist, Normals kNormals, std::size_t kQuantity>
using RoughDielectricKernel =
    RoughSurfaceKernel<Dist, DielectricInterface, DielectricKernel(kNormals, kQuantity), kQuantity>;

template <Reflector kReflector>
using FacetsOf = std::conditional_t<
    kReflector == Reflector::kMirror, MirrorFacets,
    std::conditional_t<kReflector == Reflector::kConductor, ConductorFacets, SchlickFacets>>;

template <class Dist, std::size_t kKernel>
using RoughReflectorKernel = RoughSurfaceKernel<Dist, FacetsOf<PlaceOfReflectorKernel(kKernel).reflector>,
                                                kKernel, PlaceOfReflectorKernel(kKernel).quantity>;

template <class Dist, Normals kNormals, std::size_t... kQuantity>
FamilyCode RoughDielectricFamily(std::index_sequence<kQuantity...>) {
  return Family<RoughDielectricKernel<Dist, kNormals, kQuantity>...>();
}
template <class Dist, std::size_t kFirst, std::size_t... kKernel>
FamilyCode RoughReflectorFamily(std::index_sequence<kKernel...>) {
  return Family<RoughReflectorKernel<Dist, kFirst + kKernel>...>();
}

// The tables of all of the kernel list's quantities on this target.
template <class Dist, Normals kNormals>
FamilyCode RoughDielectricFamily() {
  return RoughDielectricFamily<Dist, kNormals>(std::make_index_sequence<NumDielectricQuantities(kNormals)>());
}
template <class Dist, Normals kNormals>
FamilyCode RoughReflectorFamily() {
  return RoughReflectorFamily<Dist, ReflectorKernel({kNormals, Reflector::kMirror, 0})>(
      std::make_index_sequence<NumReflectorKernels(kNormals)>());
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_SRC_ROUGH_SURFACE_KERNELS_INL_H_
