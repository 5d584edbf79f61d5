// Batch kernels of the rough dielectric, over a distribution policy and the kernel list's quantities.
#if defined(MICROLANE_SRC_ROUGH_DIELECTRIC_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_SRC_ROUGH_DIELECTRIC_KERNELS_INL_H_
#undef MICROLANE_SRC_ROUGH_DIELECTRIC_KERNELS_INL_H_
#else
#define MICROLANE_SRC_ROUGH_DIELECTRIC_KERNELS_INL_H_
#endif

#include <utility>

#include "microlane/rough_dielectric-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

template <class Dist, Normals kNormals, std::size_t kQuantity>
struct RoughDielectricKernel {
  static constexpr DielectricQuantity kRow = kDielectricQuantities[kQuantity];
  static constexpr std::string_view kId = kKernels[DielectricKernel(kNormals, kQuantity)].id;
  static constexpr bool kSamples = kRow.what == DielectricQuantity::kSample;
  static constexpr bool kValue = kRow.HasValue(), kPdf = kRow.what != DielectricQuantity::kEval;
  static constexpr Lobes kLobes = kRow.HasBothLobes() ? Lobes::kBoth
                                  : kRow.reflects     ? Lobes::kReflection
                                                      : Lobes::kTransmission;
  static constexpr JointMasking kG =
      kRow.separable ? JointMasking::kSeparable : JointMasking::kHeightCorrelated;
  // Every input enters a product of the result; but Min and Max drop NaN on SCALAR, EMU128 and Arm.
  static constexpr bool kPassesNan = !Dist::kHasExponent && kValue && !kPdf &&
                                     kLobes != Lobes::kTransmission && HWY_ARCH_X86 &&
                                     HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128;

  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> ix, Vec<D> iy,
                              Vec<D> iz, Vec<D> a, Vec<D> b, V... rest) {
    if constexpr (kSamples && kLobes != Lobes::kBoth) {
      EtaLast<A>(d, options, out, ix, iy, iz, a, b, hn::Zero(d), rest...);
    } else {
      EtaLast<A>(d, options, out, ix, iy, iz, a, b, rest...);
    }
  }

 private:
  // Parameters come as (distribution parameters..., eta) in the kernel list, and as (eta, distribution
  // parameters...) in the lane functions.
  template <Accuracy A, class D>
  static HWY_INLINE void EtaLast(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> ix, Vec<D> iy,
                                 Vec<D> iz, Vec<D> a, Vec<D> b, Vec<D> c, Vec<D> p0, Vec<D> eta) {
    EtaFirst<A>(d, options, out, ix, iy, iz, a, b, c, eta, p0);
  }
  template <Accuracy A, class D>
  static HWY_INLINE void EtaLast(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> ix, Vec<D> iy,
                                 Vec<D> iz, Vec<D> a, Vec<D> b, Vec<D> c, Vec<D> p0, Vec<D> p1, Vec<D> eta) {
    EtaFirst<A>(d, options, out, ix, iy, iz, a, b, c, eta, p0, p1);
  }

  // a, b, c: wo, or the random numbers.
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void EtaFirst(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> ix, Vec<D> iy,
                                  Vec<D> iz, Vec<D> a, Vec<D> b, Vec<D> c, Vec<D> eta, P... p) {
    if constexpr (kSamples) {
      SampleRoughDielectric<Dist, kLobes, kG, A>(d, options.radiance, out.v0, out.v1, out.v2, out.v3, out.v4,
                                                 out.v5, ix, iy, iz, a, b, c, eta, p...);
    } else {
      RoughDielectric<Dist, kLobes, kG, kValue, kPdf, A>(
          d, options.radiance, out.v0, kValue ? out.v1 : out.v0, ix, iy, iz, a, b, c, eta, p...);
    }
  }
};

template <class Dist, Normals kNormals, std::size_t... kQuantity>
FamilyCode RoughDielectricFamily(std::index_sequence<kQuantity...>) {
  return Family<RoughDielectricKernel<Dist, kNormals, kQuantity>...>();
}

// The table of all of the kernel list's quantities on this target.
template <class Dist, Normals kNormals>
FamilyCode RoughDielectricFamily() {
  return RoughDielectricFamily<Dist, kNormals>(std::make_index_sequence<kNumDielectricQuantities>());
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_SRC_ROUGH_DIELECTRIC_KERNELS_INL_H_
