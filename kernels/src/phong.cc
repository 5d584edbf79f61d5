#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/phong.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/phong-inl.h"
#include "src/distribution_kernels-inl.h"
#include "src/normals_call.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct ExponentKernel {
  static constexpr std::string_view kId = "phong.exponent";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> alpha) {
    out.v0 = Phong::Exponent<A>(d, alpha);
  }
};

struct LambdaKernel {
  static constexpr std::string_view kId = "phong.Lambda";
  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    Vec<D> unused;
    Precisely<typename PhongSmith<kIsFloat<D>>::LambdaOp, A>(d, out.v0, unused, in...);
  }
};

struct G1SmithKernel {
  static constexpr std::string_view kId = "phong.G1_smith";
  template <Accuracy A, class D, class... V>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = G1<PhongSmith<kIsFloat<D>>, A>(d, in...);
  }
};

FamilyCode FamilyOnTarget() {
  return NormalsFamily<Phong, Normals::kPhong, ExponentKernel, LambdaKernel, G1SmithKernel>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
template <>
const FamilyFunction* NormalsTable<Normals::kPhong>() {
  return HWY_DISPATCH_TABLE(FamilyOnTarget);
}
template void RunFrom(const NormalsCode<Normals::kPhong>&, std::size_t, Accuracy, const Call<float>&,
                      std::size_t);
template void RunFrom(const NormalsCode<Normals::kPhong>&, std::size_t, Accuracy, const Call<double>&,
                      std::size_t);

}  // namespace microlane
#endif  // HWY_ONCE
