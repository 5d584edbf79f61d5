#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/beckmann.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/beckmann-inl.h"
#include "src/distribution_kernels-inl.h"
#include "src/normals_call.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// Beckmann with Walter 2007 Eq. 27 for its masking.
struct BeckmannRational : Beckmann {
  template <Care, Accuracy A, class D, class... P>
  static HWY_INLINE Vec<D> Masking(D d, Vec<D> vx, Vec<D> vy, Vec<D> z, P... p) {
    return Beckmann::RationalMasking<A>(d, vx, vy, z, p...);
  }
};

struct G1RationalKernel {
  static constexpr std::string_view kId = "beckmann.G1_rational";
  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = G1<BeckmannRational, A>(d, in...);
  }
};

struct SampleNormalWidenedKernel {
  static constexpr std::string_view kId = "beckmann.sample_normal_widened";
  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    Beckmann::SampleNormalWidened<Care::kCareful, A>(d, out.v0, out.v1, out.v2, out.v3, in...);
  }
};

FamilyCode FamilyOnTarget() {
  return NormalsFamily<Beckmann, Normals::kBeckmann, G1RationalKernel, SampleNormalWidenedKernel>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
template <>
const FamilyFunction* NormalsTable<Normals::kBeckmann>() {
  return HWY_DISPATCH_TABLE(FamilyOnTarget);
}
template void RunFrom(const NormalsCode<Normals::kBeckmann>&, std::size_t, Accuracy, const Call<float>&,
                      std::size_t);
template void RunFrom(const NormalsCode<Normals::kBeckmann>&, std::size_t, Accuracy, const Call<double>&,
                      std::size_t);

}  // namespace microlane
#endif  // HWY_ONCE
