#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/math.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/math-inl.h"
#include "microlane/student-inl.h"
#include "src/batch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct ExpKernel {
  static constexpr std::string_view kId = "math.exp";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> x) {
    out.v0 = Exp<A>(d, x, hn::Zero(d));
  }
};

struct NegLog1mKernel {
  static constexpr std::string_view kId = "math.neg_log1m";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> u) {
    out.v0 = NegLog1m<A>(d, u);
  }
};

struct SinCos2PiKernel {
  static constexpr std::string_view kId = "math.sincos_2pi";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> u) {
    SinCos2Pi<A>(d, u, out.v0, out.v1);
  }
};

struct ErfcxDefectKernel {
  static constexpr std::string_view kId = "math.erfcx_defect";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> a) {
    Vec<D> unused;
    Precisely<ErfcxDefectOp, A>(d, out.v0, unused, a);
  }
};

struct ErfcxKernel {
  static constexpr std::string_view kId = "math.erfcx";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> a) {
    Vec<D> unused;
    Precisely<ErfcxOp, A>(d, out.v0, unused, a);
  }
};

struct ErfInvKernel {
  static constexpr std::string_view kId = "math.erfinv";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> u) {
    out.v0 = ErfInv<A>(d, u);
  }
};

struct AzimuthDifferenceKernel {
  static constexpr std::string_view kId = "math.azimuth_difference";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> wix, Vec<D> wiy,
                              Vec<D> wox, Vec<D> woy) {
    out.v0 = AzimuthDifference<A>(d, wix, wiy, wox, woy);
  }
};

struct StudentDefectKernel {
  static constexpr std::string_view kId = "math.student_defect";
  template <Accuracy A, class D>
  static HWY_INLINE void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> mu, Vec<D> gamma) {
    Vec<D> unused;
    Precisely<StudentDefectOp<kIsFloat<D>>, A>(d, out.v0, unused, mu, gamma);
  }
};

FamilyCode FamilyOnTarget() {
  return Family<ExpKernel, NegLog1mKernel, SinCos2PiKernel, ErfcxDefectKernel, ErfcxKernel, ErfInvKernel,
                AzimuthDifferenceKernel, StudentDefectKernel>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace microlane {

HWY_EXPORT(FamilyOnTarget);
const FamilyFunction* MathTable() { return HWY_DISPATCH_TABLE(FamilyOnTarget); }

}  // namespace microlane
#endif  // HWY_ONCE
