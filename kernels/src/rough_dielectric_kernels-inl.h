// Batch kernels of the rough dielectric, over a distribution policy and ids.
#if defined(MICROLANE_SRC_ROUGH_DIELECTRIC_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_SRC_ROUGH_DIELECTRIC_KERNELS_INL_H_
#undef MICROLANE_SRC_ROUGH_DIELECTRIC_KERNELS_INL_H_
#else
#define MICROLANE_SRC_ROUGH_DIELECTRIC_KERNELS_INL_H_
#endif

#include "microlane/rough_dielectric-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// Parameters come as (distribution parameters..., eta) in the kernel list, and as (eta, distribution
// parameters...) in the lane functions.
template <class Dist, Lobes kLobes, JointMasking kG, bool kValue, bool kPdf, const std::string_view& kName>
struct RoughDielectricKernel {
  static constexpr std::string_view kId = kName;
  // Every input enters a product of the result; on SCALAR, Min and Max drop NaN.
  static constexpr bool kPassesNan =
      !Dist::kHasExponent && kValue && !kPdf && kLobes != Lobes::kTransmission && HWY_TARGET != HWY_SCALAR;
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> ix, Vec<D> iy,
                              Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz, Vec<D> p0, Vec<D> p1) {
    RoughDielectric<Dist, kLobes, kG, kValue, kPdf, A>(d, options.radiance, out.v0, kValue ? out.v1 : out.v0,
                                                       ix, iy, iz, ox, oy, oz, p1, p0);
  }
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> ix, Vec<D> iy,
                              Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz, Vec<D> p0, Vec<D> p1, Vec<D> p2) {
    RoughDielectric<Dist, kLobes, kG, kValue, kPdf, A>(d, options.radiance, out.v0, kValue ? out.v1 : out.v0,
                                                       ix, iy, iz, ox, oy, oz, p2, p0, p1);
  }
};

template <class Dist, JointMasking kG, const std::string_view& kName>
struct SampleRoughDielectricKernel {
  static constexpr std::string_view kId = kName;
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> ix, Vec<D> iy,
                              Vec<D> iz, Vec<D> u1, Vec<D> u2, Vec<D> u3, Vec<D> p0, Vec<D> p1) {
    SampleRoughDielectric<Dist, kG, A>(d, options.radiance, out.v0, out.v1, out.v2, out.v3, out.v4, out.v5,
                                       ix, iy, iz, u1, u2, u3, p1, p0);
  }
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>& options, const Outputs<D>& out, Vec<D> ix, Vec<D> iy,
                              Vec<D> iz, Vec<D> u1, Vec<D> u2, Vec<D> u3, Vec<D> p0, Vec<D> p1, Vec<D> p2) {
    SampleRoughDielectric<Dist, kG, A>(d, options.radiance, out.v0, out.v1, out.v2, out.v3, out.v4, out.v5,
                                       ix, iy, iz, u1, u2, u3, p2, p0, p1);
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_SRC_ROUGH_DIELECTRIC_KERNELS_INL_H_
