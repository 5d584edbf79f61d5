// Batch kernels of a distribution, over its policy and the kernel list's rows.
#if defined(MICROLANE_SRC_DISTRIBUTION_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_SRC_DISTRIBUTION_KERNELS_INL_H_
#undef MICROLANE_SRC_DISTRIBUTION_KERNELS_INL_H_
#else
#define MICROLANE_SRC_DISTRIBUTION_KERNELS_INL_H_
#endif

#include <utility>

#include "microlane/rough_reflector-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// The kernel at a place of kNormalKernelPlaces.
template <class Dist, std::size_t kPlace>
struct NormalQuantityKernel {
  static constexpr std::string_view kId = kNormalText[kPlace].id.view();
  static constexpr NormalQuantity::What kWhat = kNormalRows[kNormalKernelPlaces[kPlace].row].what;
  static constexpr bool kTable = TakesPrepared(kNumComponentKernels + kPlace);

  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> a, Vec<D> b,
                              V... in) {
    using Policy = ForResult<Dist, kIsFloat<D>>;
    if constexpr (kTable) {
      // The table's entries stand before the roughness.
      constexpr std::size_t kLanes = Split(kNormalQuantities[kWhat].lanes).count - 2;
      const auto entries = Dist::EntriesOf(*options.prepared);
      WithFirst<kLanes>(
          [&](auto... lanes) HWY_ATTR {
            WithoutFirst<kLanes>(
                [&](auto... roughness)
                    HWY_ATTR { EvalOf<Policy, A>(d, options, out, a, b, lanes..., entries, roughness...); },
                in...);
          },
          in...);
    } else {
      EvalOf<Policy, A>(d, options, out, a, b, in...);
    }
  }

 private:
  template <class Policy, Accuracy A, class D, class... V>
  static HWY_INLINE void EvalOf(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> a, Vec<D> b,
                                V... in) {
    (void)options;
    if constexpr (kWhat == NormalQuantity::kD) {
      out.v0 = NormalDensity<Policy, A>(d, a, b, in...);
    } else if constexpr (kWhat == NormalQuantity::kLambda) {
      out.v0 = Lambda<Policy, A>(d, a, b, in...);
    } else if constexpr (kWhat == NormalQuantity::kG1) {
      out.v0 = G1<Policy, A>(d, a, b, in...);
    } else if constexpr (kWhat == NormalQuantity::kDVisible) {
      out.v0 = VisibleNormalDensity<Policy, A>(d, a, b, in...);
    } else if constexpr (kWhat == NormalQuantity::kDVisibleVCavity) {
      out.v0 = VCavityNormalDensity<Policy, A>(d, a, b, in...);
    } else if constexpr (kWhat == NormalQuantity::kSampleVCavity) {
      SampleVCavityNormal<Policy, Care::kCareful, A>(d, out.v0, out.v1, out.v2, out.v3, a, b, in...);
    } else if constexpr (kWhat == NormalQuantity::kSampleNormal) {
      SampleNormal<Policy, A>(d, out.v0, out.v1, out.v2, out.v3, a, b, in...);
    } else if constexpr (kWhat == NormalQuantity::kSampleReflection ||
                         kWhat == NormalQuantity::kSampleReflectionBounded) {
      constexpr bool bounded = kWhat == NormalQuantity::kSampleReflectionBounded;
      Vec<D> cos2;
      Policy::template SampleVisibleReflection<bounded, JointMasking::kHeightCorrelated, A>(
          d, out.v0, out.v1, out.v2, out.v3, out.v4, out.v5, cos2, a, b, in...);
    } else if constexpr (kWhat == NormalQuantity::kPdfReflection ||
                         kWhat == NormalQuantity::kPdfReflectionBounded) {
      constexpr Drawn drawn =
          kWhat == NormalQuantity::kPdfReflection ? Drawn::kVisible : Drawn::kBoundedVisible;
      RoughSurface<Policy, MirrorFacets, Lobes::kReflection, JointMasking::kHeightCorrelated, false, true,
                   drawn, A>(d, options.radiance, out.v0, out.v0, a, b, in...);
    } else {
      constexpr bool bounded = kWhat == NormalQuantity::kSampleVisibleBounded;
      SampleVisibleNormal<Policy, bounded, A>(d, out.v0, out.v1, out.v2, out.v3, a, b, in...);
    }
  }
};

// Places in kNormalKernelPlaces of what a distribution gives, but for its own quantities.
template <Normals kNormals>
struct NormalPlaces {
  static constexpr bool Contains(std::size_t place) {
    const NormalRow& row = kNormalRows[kNormalKernelPlaces[place].row];
    return row.normals == kNormals && row.what != NormalQuantity::kOwn;
  }
  static constexpr std::size_t Count() {
    std::size_t count = 0;
    for (std::size_t i = 0; i < kNumNormalKernels; ++i) count += Contains(i) ? 1 : 0;
    return count;
  }
  // The place of that number.
  static constexpr std::size_t At(std::size_t number) {
    std::size_t i = 0;
    while (!Contains(i) || number-- > 0) ++i;
    return i;
  }
};

template <class Dist, Normals kNormals, class... Own, std::size_t... kNumber>
FamilyCode NormalsFamily(std::index_sequence<kNumber...>) {
  return Family<NormalQuantityKernel<Dist, NormalPlaces<kNormals>::At(kNumber)>..., Own...>();
}

// The table of all of the kernel list's quantities of a distribution on this target, Own... its own.
template <class Dist, Normals kNormals, class... Own>
FamilyCode NormalsFamily() {
  return NormalsFamily<Dist, kNormals, Own...>(std::make_index_sequence<NormalPlaces<kNormals>::Count()>());
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_SRC_DISTRIBUTION_KERNELS_INL_H_
