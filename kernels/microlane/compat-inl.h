// Per-target include guard; the Highway names that Microlane uses beyond plain operations, and every
// difference between Highway versions and targets.
#if defined(MICROLANE_COMPAT_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_COMPAT_INL_H_
#undef MICROLANE_COMPAT_INL_H_
#else
#define MICROLANE_COMPAT_INL_H_
#endif

#include <type_traits>

#include "hwy/highway.h"
#include "microlane/packets.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {  // internal linkage: a user's copy may be built with other flags

namespace hn = hwy::HWY_NAMESPACE;

template <class D>
using Vec = hn::Vec<D>;
template <class D>
using T = hn::TFromD<D>;
template <class D>
inline constexpr bool kIsFloat = sizeof(T<D>) == 4;

template <class D>
HWY_INLINE Vec<D> Const(D d, double value) {
  return hn::Set(d, static_cast<T<D>>(value));
}

// Whether any lane is infinite or NaN.
template <class D>
HWY_INLINE bool AnyNonFinite(D d, Vec<D> x) {
  return !hn::AllTrue(d, hn::Eq(hn::Sub(x, x), hn::Zero(d)));  // Ne is false of NaN on x86
}
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
HWY_INLINE bool AnyNonFinite(hn::Full512<float>, hn::Vec512<float> x) {
  return _mm512_fpclass_ps_mask(x.raw, 0x99) != 0;
}
#endif

// Bits of FastReciprocal and FastReciprocalSqrt: AVX-512's 14 as they are, after one Newton step from x86's
// 11.5 or Arm's 8, or of a division.
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3
constexpr int kFastBits = 14;
#elif HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
constexpr int kFastBits = 24;
#else
constexpr int kFastBits = HWY_ARCH_X86 ? 22 : 16;
#endif
constexpr bool kFastIsRefined = kFastBits > 20;

template <class D>
HWY_INLINE Vec<D> NewtonReciprocal(D d, Vec<D> x, Vec<D> r) {
  return hn::Mul(r, hn::NegMulAdd(x, r, hn::Set(d, 2.0f)));
}
template <class D>
HWY_INLINE Vec<D> NewtonReciprocalSqrt(D d, Vec<D> x, Vec<D> r) {
  const Vec<D> half_xr = hn::Mul(hn::Mul(hn::Set(d, 0.5f), x), r);
  return hn::Mul(r, hn::NegMulAdd(half_xr, r, hn::Set(d, 1.5f)));
}

// Approximate reciprocal and reciprocal root with relative error below 2^-13.9 on every target.
template <class D>
HWY_INLINE Vec<D> FastReciprocal(D d, Vec<D> x) {
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
  return hn::Div(hn::Set(d, 1.0f), x);
#else
  const Vec<D> r = hn::ApproximateReciprocal(x);
  return kFastBits == 14 ? r : NewtonReciprocal(d, x, r);
#endif
}

template <class D>
HWY_INLINE Vec<D> FastReciprocalSqrt(D d, Vec<D> x) {
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
  return hn::Div(hn::Set(d, 1.0f), hn::Sqrt(x));
#else
  const Vec<D> r = hn::ApproximateReciprocalSqrt(x);
  return kFastBits == 14 ? r : NewtonReciprocalSqrt(d, x, r);
#endif
}

// The latter to 2^-21 or better on every target, for what is to be of unit length.
template <class D>
HWY_INLINE Vec<D> RefinedReciprocalSqrt(D d, Vec<D> x) {
  const Vec<D> r = FastReciprocalSqrt(d, x);
  return kFastIsRefined ? r : NewtonReciprocalSqrt(d, x, r);
}

// x, a whole number or NaN, as an integer; NaN gives any. Highway's SCALAR and EMU128 cast it, which is
// undefined.
template <class DI, class V>
HWY_INLINE hn::Vec<DI> ToInteger(DI di, V x) {
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128
  x = hn::IfThenElseZero(hn::Eq(x, x), x);
#endif
  return hn::ConvertTo(di, x);
}

// What a lane function takes, in double lanes: vectors are widened, pointers to tables stay as they are.
template <class DD, class V>
HWY_INLINE auto Widened(DD dd, V in) {
  if constexpr (std::is_pointer_v<V>) {
    (void)dd;
    return in;
  } else {
    return hn::PromoteTo(dd, in);
  }
}
#if HWY_TARGET != HWY_SCALAR  // has no halves
template <class DH, class V>
HWY_INLINE auto Lower(DH dh, V in) {
  if constexpr (std::is_pointer_v<V>) {
    (void)dh;
    return in;
  } else {
    return hn::LowerHalf(dh, in);
  }
}
template <class DH, class V>
HWY_INLINE auto Upper(DH dh, V in) {
  if constexpr (std::is_pointer_v<V>) {
    (void)dh;
    return in;
  } else {
    return hn::UpperHalf(dh, in);
  }
}
#endif

// Runs Op::Run(double tag, double inputs..., double outputs&...) on the double lanes of float vectors, and
// rounds the outputs once. Double tags run Op on the lanes as they are. Outputs come first.
template <class Op, class D, class... In>
HWY_INLINE void InDouble6(D d, Vec<D>& o0, Vec<D>& o1, Vec<D>& o2, Vec<D>& o3, Vec<D>& o4, Vec<D>& o5,
                          In... in) {
  if constexpr (!kIsFloat<D>) {
    Op::Run(d, o0, o1, o2, o3, o4, o5, in...);
  } else {
#if HWY_TARGET == HWY_SCALAR  // has no halves
    const hn::Rebind<double, D> dd;
    Vec<decltype(dd)> a0, a1, a2, a3, a4, a5;
    Op::Run(dd, a0, a1, a2, a3, a4, a5, Widened(dd, in)...);
    o0 = hn::DemoteTo(d, a0);
    o1 = hn::DemoteTo(d, a1);
    o2 = hn::DemoteTo(d, a2);
    o3 = hn::DemoteTo(d, a3);
    o4 = hn::DemoteTo(d, a4);
    o5 = hn::DemoteTo(d, a5);
#else
    const hn::Half<D> dh;
    const hn::Rebind<double, decltype(dh)> dd;
    Vec<decltype(dd)> a0, a1, a2, a3, a4, a5, b0, b1, b2, b3, b4, b5;
    Op::Run(dd, a0, a1, a2, a3, a4, a5, Widened(dd, Lower(dh, in))...);
    Op::Run(dd, b0, b1, b2, b3, b4, b5, Widened(dd, Upper(dh, in))...);
    o0 = hn::Combine(d, hn::DemoteTo(dh, b0), hn::DemoteTo(dh, a0));
    o1 = hn::Combine(d, hn::DemoteTo(dh, b1), hn::DemoteTo(dh, a1));
    o2 = hn::Combine(d, hn::DemoteTo(dh, b2), hn::DemoteTo(dh, a2));
    o3 = hn::Combine(d, hn::DemoteTo(dh, b3), hn::DemoteTo(dh, a3));
    o4 = hn::Combine(d, hn::DemoteTo(dh, b4), hn::DemoteTo(dh, a4));
    o5 = hn::Combine(d, hn::DemoteTo(dh, b5), hn::DemoteTo(dh, a5));
#endif
  }
}

// InDouble6 with two outputs.
template <class Op>
struct TwoOutputs {
  template <class DD, class... In>
  static HWY_INLINE void Run(DD dd, Vec<DD>& o0, Vec<DD>& o1, Vec<DD>& o2, Vec<DD>& o3, Vec<DD>& o4,
                             Vec<DD>& o5, In... in) {
    Op::Run(dd, o0, o1, in...);
    o2 = o3 = o4 = o5 = o0;
  }
};

template <class Op, class D, class... In>
HWY_INLINE void InDouble2(D d, Vec<D>& o0, Vec<D>& o1, In... in) {
  Vec<D> o2, o3, o4, o5;
  InDouble6<TwoOutputs<Op>>(d, o0, o1, o2, o3, o4, o5, in...);
}

// The double lanes of half a vector of floats, or doubles as they are.
#if HWY_TARGET == HWY_SCALAR  // has no halves
template <class D>
using HalfInDouble = hn::Rebind<double, D>;
#else
template <class D>
using HalfInDouble = hn::Repartition<double, D>;
#endif

template <class DD>
HWY_INLINE Vec<DD> LoadWide(DD dd, const double* from) {
  return hn::LoadU(dd, from);
}
template <class DD>
HWY_INLINE Vec<DD> LoadWide(DD dd, const float* from) {
  return hn::PromoteTo(dd, hn::LoadU(hn::Rebind<float, DD>(), from));
}
template <class DD>
HWY_INLINE void StoreNarrow(DD dd, Vec<DD> x, double* to) {
  hn::StoreU(x, dd, to);
}
template <class DD>
HWY_INLINE void StoreNarrow(DD, Vec<DD> x, float* to) {
  const hn::Rebind<float, DD> df;
  hn::StoreU(hn::DemoteTo(df, x), df, to);
}

struct FusedMulAddOp {
  template <class DD>
  static HWY_INLINE void Run(DD, Vec<DD>& sum, Vec<DD>& unused, Vec<DD> a, Vec<DD> b, Vec<DD> c) {
    sum = unused = hn::MulAdd(a, b, c);
  }
};

// a b + c rounded once on every target: float products are exact in double lanes.
template <class D>
HWY_INLINE Vec<D> FusedMulAdd(D d, Vec<D> a, Vec<D> b, Vec<D> c) {
#if HWY_NATIVE_FMA
  (void)d;
  return hn::MulAdd(a, b, c);
#else
  Vec<D> sum, unused;
  InDouble2<FusedMulAddOp>(d, sum, unused, a, b, c);
  return sum;
#endif
}

// a b - c rounded once on every target.
template <class D>
HWY_INLINE Vec<D> FusedMulSub(D d, Vec<D> a, Vec<D> b, Vec<D> c) {
#if HWY_NATIVE_FMA
  (void)d;
  return hn::MulSub(a, b, c);
#else
  return FusedMulAdd(d, a, b, hn::Neg(c));
#endif
}

// Op::Run<kStandard> in double lanes, rounded once; with kFast, Op::Run<kFast> in the lanes given.
template <class Op>
struct InStandard {
  template <class DD, class... In>
  static HWY_INLINE void Run(DD dd, Vec<DD>& o0, Vec<DD>& o1, In... in) {
    Op::template Run<Accuracy::kStandard>(dd, o0, o1, in...);
  }
};

template <class Op, Accuracy A, class D, class... In>
HWY_INLINE void Precisely(D d, Vec<D>& o0, Vec<D>& o1, In... in) {
  if constexpr (A == Accuracy::kFast) {
    Op::template Run<A>(d, o0, o1, in...);
  } else {
    InDouble2<InStandard<Op>>(d, o0, o1, in...);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_COMPAT_INL_H_
