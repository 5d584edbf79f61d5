// Batch kernels that every distribution has, over its policy and an `Ids` struct that names them.
#if defined(MICROLANE_SRC_DISTRIBUTION_KERNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_SRC_DISTRIBUTION_KERNELS_INL_H_
#undef MICROLANE_SRC_DISTRIBUTION_KERNELS_INL_H_
#else
#define MICROLANE_SRC_DISTRIBUTION_KERNELS_INL_H_
#endif

#include "microlane/distribution-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

template <class Dist, const std::string_view& kName>
struct DKernel {
  static constexpr std::string_view kId = kName;
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> mx, Vec<D> my, Vec<D> mz,
                              P... p) {
    out.v0 = NormalDensity<Dist, A>(d, mx, my, mz, p...);
  }
};

template <class Dist, const std::string_view& kName>
struct LambdaKernel {
  static constexpr std::string_view kId = kName;
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> vx, Vec<D> vy, Vec<D> vz,
                              P... p) {
    out.v0 = Dist::template Lambda<A>(d, vx, vy, vz, p...);
  }
};

template <class Dist, const std::string_view& kName>
struct G1Kernel {
  static constexpr std::string_view kId = kName;
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> vx, Vec<D> vy, Vec<D> vz,
                              Vec<D> mx, Vec<D> my, Vec<D> mz, P... p) {
    out.v0 = G1<Dist, A>(d, vx, vy, vz, mx, my, mz, p...);
  }
};

template <class Dist, const std::string_view& kName>
struct DVisibleKernel {
  static constexpr std::string_view kId = kName;
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> vx, Vec<D> vy, Vec<D> vz,
                              Vec<D> mx, Vec<D> my, Vec<D> mz, P... p) {
    out.v0 = VisibleNormalDensity<Dist, A>(d, vx, vy, vz, mx, my, mz, p...);
  }
};

template <class Dist, const std::string_view& kName, bool kBounded = false>
struct SampleVisibleNormalKernel {
  static constexpr std::string_view kId = kName;
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> vx, Vec<D> vy, Vec<D> vz,
                              Vec<D> u1, Vec<D> u2, P... p) {
    Dist::template SampleVisibleNormal<kBounded, A>(d, out.v0, out.v1, out.v2, out.v3, vx, vy, vz, u1, u2,
                                                    p...);
  }
};

template <class Dist, const std::string_view& kName>
struct SampleNormalKernel {
  static constexpr std::string_view kId = kName;
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> u1, Vec<D> u2, P... p) {
    Dist::template SampleNormal<A>(d, out.v0, out.v1, out.v2, out.v3, u1, u2, p...);
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_SRC_DISTRIBUTION_KERNELS_INL_H_
