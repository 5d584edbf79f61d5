// Roughness from the moments of slopes, and back (roughness.h), in lanes. In double lanes, where squares and
// products of floats are exact and what cancels is rounded once.
#if defined(MICROLANE_ROUGHNESS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_ROUGHNESS_INL_H_
#undef MICROLANE_ROUGHNESS_INL_H_
#else
#define MICROLANE_ROUGHNESS_INL_H_
#endif

#include "microlane/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct FromMomentsOp {
  // 2 (second moment - mean^2), within the squares of 1e-5 and 100.
  template <class DD>
  static HWY_INLINE Vec<DD> Alpha2(DD dd, Vec<DD> mean, Vec<DD> moment) {
    const Vec<DD> variance = hn::NegMulAdd(mean, mean, moment);
    return hn::Min(hn::Max(hn::Add(variance, variance), Const(dd, 1e-10)), Const(dd, 1e4));
  }

  template <class DD>
  static HWY_INLINE void Run(DD dd, Vec<DD>& alpha_x, Vec<DD>& alpha_y, Vec<DD>& r_xy, Vec<DD>& unused0,
                             Vec<DD>& unused1, Vec<DD>& unused2, Vec<DD> mean_x, Vec<DD> mean_y,
                             Vec<DD> moment_xx, Vec<DD> moment_yy, Vec<DD> moment_xy) {
    alpha_x = hn::Sqrt(Alpha2(dd, mean_x, moment_xx));
    alpha_y = hn::Sqrt(Alpha2(dd, mean_y, moment_yy));
    const Vec<DD> covariance = hn::NegMulAdd(mean_x, mean_y, moment_xy), limit = Const(dd, 0.9999);
    const Vec<DD> r = hn::Div(hn::Add(covariance, covariance), hn::Mul(alpha_x, alpha_y));
    r_xy = hn::Min(hn::Max(r, hn::Neg(limit)), limit);
    unused0 = unused1 = unused2 = r_xy;
  }
};

struct ToMomentsOp {
  template <class DD>
  static HWY_INLINE void Run(DD dd, Vec<DD>& moment_xx, Vec<DD>& moment_yy, Vec<DD>& moment_xy,
                             Vec<DD>& unused0, Vec<DD>& unused1, Vec<DD>& unused2, Vec<DD> alpha_x,
                             Vec<DD> alpha_y, Vec<DD> r_xy, Vec<DD> mean_x, Vec<DD> mean_y) {
    const Vec<DD> half = Const(dd, 0.5), half_x = hn::Mul(alpha_x, half), half_y = hn::Mul(alpha_y, half);
    moment_xx = hn::MulAdd(mean_x, mean_x, hn::Mul(alpha_x, half_x));
    moment_yy = hn::MulAdd(mean_y, mean_y, hn::Mul(alpha_y, half_y));
    // Both products of the mixed moment may cancel.
    Vec<DD> p, p_tail, q, q_tail, s, s_tail;
    TwoProduct(dd, r_xy, hn::Mul(half_x, alpha_y), p, p_tail);
    TwoProduct(dd, mean_x, mean_y, q, q_tail);
    TwoSum(p, q, s, s_tail);
    moment_xy = hn::Add(s, hn::Add(s_tail, hn::Add(p_tail, q_tail)));
    unused0 = unused1 = unused2 = moment_xy;
  }
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_ROUGHNESS_INL_H_
