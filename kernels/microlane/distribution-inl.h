// Lane functions common to every distribution of normals, over a policy `Dist` with parameters p...: kOwn of
// its own shape (gamma), then its roughness (alpha; alpha_x, alpha_y; exponent; ...):
//
// Density: e + e_tail and w such that D(H/|H|) / |H|^4 = w exp(LogDensity) / (pi e^2) for any half vector H.
// Where kDensityOfCosine, Norm instead: pi D = Norm exp(LogDensity).
//
// LogDensity: used where kHasExponent. CarefulLogDensity: the same as two numbers in float lanes, because its
// rounding error is multiplied by up to 104; kLogDensityInDouble: LogDensity in double lanes instead.
//
// UnitDensity, UnitLogDensity: e and LogDensity of unit roughness, where slopes are (x, y)/z; double lanes.
//
// Masking: |vz| (1 + 2 Lambda(v)) of z = |vz|; finite at grazing.
//
// SampleNormal: m and its density D cos.
#if defined(MICROLANE_DISTRIBUTION_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_DISTRIBUTION_INL_H_
#undef MICROLANE_DISTRIBUTION_INL_H_
#else
#define MICROLANE_DISTRIBUTION_INL_H_
#endif

#include <type_traits>

#include "microlane/stretch-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// Dist, or what it gives in its place where results are floats or are not.
template <class Dist, bool kFloat, class = void>
struct ResultPolicy {
  using Type = Dist;
};
template <class Dist, bool kFloat>
struct ResultPolicy<Dist, kFloat, std::void_t<typename Dist::template ForResult<kFloat>>> {
  using Type = typename Dist::template ForResult<kFloat>;
};
template <class Dist, bool kFloat>
using ForResult = typename ResultPolicy<Dist, kFloat>::Type;

// Walter 2007 Eq. 23; Heitz 2014 Eq. 99; of V-cavities min(1, 2 hz |i.n|/i.h, 2 hz |o.n|/o.h); of Kelemen
// 2001 Eq. 3 what stands for it, 4 |i.n| |o.n| hz/(H.H), H = i + o.
enum class JointMasking { kSeparable, kHeightCorrelated, kVCavity, kKelemen };

template <class Dist>
struct LogDensityOp {
  template <class DD, class... P>
  static HWY_INLINE void Run(DD dd, Vec<DD>& high, Vec<DD>& low, Vec<DD> hx, Vec<DD> hy, Vec<DD> hz,
                             Vec<DD> hx_tail, Vec<DD> hy_tail, Vec<DD> hz_tail, P... p) {
    const Vec<DD> x = hn::Add(hx, hx_tail), y = hn::Add(hy, hy_tail), z = hn::Add(hz, hz_tail);
    SplitHigh(dd, Dist::LogDensity(dd, x, y, z, p...), high, low);
  }
};

// high + low = LogDensity of H + H_tail to 2^-33 of itself, in float lanes, less twice the log of what e +
// e_tail of Density<kCare> has lost to rounding in e. r is 1/e to a few roundings.
template <class Dist, Care kCare, class D, class... P>
HWY_INLINE void CarefulLogDensity(D d, Vec<D>& high, Vec<D>& low, Vec<D> r, Vec<D> e, Vec<D> e_tail,
                                  Vec<D> hx, Vec<D> hy, Vec<D> hz, Vec<D> hx_tail, Vec<D> hy_tail,
                                  Vec<D> hz_tail, P... p) {
#if HWY_NATIVE_FMA
  constexpr bool kInDouble = Dist::kLogDensityInDouble;
#else
  constexpr bool kInDouble = true;
#endif
  if constexpr (kInDouble) {
    InDouble2<LogDensityOp<Dist>>(d, high, low, hx, hy, hz, hx_tail, hy_tail, hz_tail, p...);
    low = hn::Sub(low, hn::Mul(hn::Add(e_tail, e_tail), r));
  } else {
    // e_tail is taken from H and e.
    Dist::template CarefulLogDensity<kCare>(d, high, low, r, e, hx, hy, hz, hx_tail, hy_tail, hz_tail, p...);
  }
}

// 1/(area e^2) of Dist::UnitDensity's e: what multiplies exp(LogDensity) then.
template <class Dist>
struct ShearedDensityOp {
  template <class DD, class... P>
  static HWY_INLINE void Run(DD dd, Vec<DD>& density, Vec<DD>& unused, Vec<DD> hx, Vec<DD> hy, Vec<DD> hz,
                             P... p) {
    Vec<DD> x, y, area;
    OfRoughness<Dist>(
        [&](auto... roughness) HWY_ATTR { UnitSlopes(dd, x, y, area, hx, hy, hz, roughness...); }, p...);
    const Vec<DD> e =
        OfShape<Dist>([&](auto... own) HWY_ATTR { return Dist::UnitDensity(dd, x, y, hz, own...); }, p...);
    density = unused = hn::Div(Const(dd, 1), hn::Mul(area, hn::Mul(e, e)));
  }
};

// LogDensity of Heitz 2014 Eqs. 92, 95 as high + low.
template <class Dist>
struct ShearedLogDensityOp {
  template <class DD, class... P>
  static HWY_INLINE void Run(DD dd, Vec<DD>& high, Vec<DD>& low, Vec<DD> hx, Vec<DD> hy, Vec<DD> hz, P... p) {
    Vec<DD> x, y, area;
    OfRoughness<Dist>(
        [&](auto... roughness) HWY_ATTR { UnitSlopes(dd, x, y, area, hx, hy, hz, roughness...); }, p...);
    const Vec<DD> log =
        OfShape<Dist>([&](auto... own) HWY_ATTR { return Dist::UnitLogDensity(dd, x, y, hz, own...); }, p...);
    SplitHigh(dd, log, high, low);
  }
};

// MesosurfaceCosine of the roughness among p.
template <class Dist, class D, class... P>
HWY_INLINE Vec<D> CosineOf(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, P... p) {
  return OfRoughness<Dist>(
      [&](auto... roughness) HWY_ATTR { return MesosurfaceCosine(d, vx, vy, vz, roughness...); }, p...);
}

// factor pi D(m) (Walter 2007 Eqs. 25, 30, 33; Heitz 2014 Eqs. 82, 85) of a normal as given, not normalised.
template <class Dist, Accuracy A, class D, class... P>
HWY_INLINE Vec<D> TimesPiNormalDensity(D d, Vec<D> factor, Vec<D> mx, Vec<D> my, Vec<D> mz, P... p) {
  if constexpr (Dist::kDensityOfCosine) {
    return Dist::template TimesPiNormalDensity<A>(d, factor, mz, p...);
  } else if constexpr (kShears<Dist, P...>) {
    Vec<D> q, unused;
    InDouble2<ShearedDensityOp<Dist>>(d, q, unused, mx, my, mz, p...);
    q = hn::Mul(q, factor);
    if constexpr (Dist::kHasExponent) {
      Vec<D> high, low;
      InDouble2<ShearedLogDensityOp<Dist>>(d, high, low, mx, my, mz, p...);
      q = ExpTimes<A>(d, high, low, q);
    }
    return ZeroIf(hn::Le(mz, hn::Zero(d)), q);
  } else {
    const Vec<D> zero = hn::Zero(d);
    Vec<D> e, e_tail, w;
    Dist::template Density<Care::kCareful>(d, e, e_tail, w, mx, my, mz, zero, zero, zero, p...);
    const Vec<D> n = hn::Mul(w, factor);
    Vec<D> q;
    if constexpr (A == Accuracy::kFast) {
      const Vec<D> r = FastReciprocal(d, e);
      q = hn::Mul(hn::Mul(n, r), r);
      if constexpr (Dist::kHasExponent) {
        q = ExpTimes<A>(d, Dist::LogDensity(d, mx, my, mz, p...), zero, q);
      }
    } else if constexpr (Dist::kHasExponent) {
      const Vec<D> r = hn::Div(Const(d, 1), e);
      Vec<D> high, low;
      if constexpr (kIsFloat<D>) {
        CarefulLogDensity<Dist, Care::kCareful>(d, high, low, r, e, e_tail, mx, my, mz, zero, zero, zero,
                                                p...);
      } else {
        SplitHigh(d, Dist::LogDensity(d, mx, my, mz, p...), high, low);
      }
      // 1/e^2 = r^2 (1 + 2 (1 - e r)) but for squares, and r^2 = r2 + r2_tail.
      const Vec<D> rest = FusedMulSub(d, e, r, Const(d, 1));
      Vec<D> r2, r2_tail;
      TwoProduct(d, r, r, r2, r2_tail);
      low = hn::MulAdd(hn::Mul(r2_tail, e), e, hn::NegMulAdd(Const(d, 2), rest, low));
      q = ExpTimes<A>(d, high, low, hn::Mul(n, r2));
    } else {
      // n / e^2 with the rounding errors of e^2 and of the quotient put back.
      Vec<D> e2, e2_tail, qe, qe_tail;
      TwoProduct(d, e, e, e2, e2_tail);
      e2_tail = hn::MulAdd(hn::Add(e, e), e_tail, e2_tail);
      const Vec<D> r = hn::Div(Const(d, 1), e2);
      q = hn::Mul(n, r);
      TwoProduct(d, q, e2, qe, qe_tail);
      const Vec<D> rest = hn::Sub(hn::Sub(hn::Sub(n, qe), qe_tail), hn::Mul(q, e2_tail));
      q = hn::MulAdd(rest, r, q);
    }
    return ZeroIf(hn::Le(mz, zero), q);
  }
}

template <class Dist, Accuracy A, class D, class... P>
HWY_INLINE Vec<D> NormalDensity(D d, Vec<D> mx, Vec<D> my, Vec<D> mz, P... p) {
  return TimesPiNormalDensity<Dist, A>(d, Const(d, 1 / kPi), mx, my, mz, p...);
}

template <class Dist>
struct LambdaOp {
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void Run(D d, Vec<D>& lambda, Vec<D>& unused, Vec<D> vx, Vec<D> vy, Vec<D> vz, P... p) {
    lambda = unused = Dist::template Lambda<A>(d, vx, vy, vz, p...);
  }
};

// Smith's Lambda. That of sheared slopes in double lanes: the square of a rounded cosine of the mesosurface
// is off by its rounding twice. kFast too where a mean slope leaves that cosine subnormal.
template <class Dist, Accuracy A, class D, class... P>
HWY_INLINE Vec<D> Lambda(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, P... p) {
  Vec<D> lambda, unused;
  if constexpr (kShears<Dist, P...>) {
    Precisely<LambdaOp<Dist>, kHasMean<Dist, P...> ? Accuracy::kStandard : A>(d, lambda, unused, vx, vy, vz,
                                                                              p...);
  } else {
    LambdaOp<Dist>::template Run<A>(d, lambda, unused, vx, vy, vz, p...);
  }
  return lambda;
}

// 2^40 a.b, for products that are exact, as those of floats in double lanes are: right to a few roundings
// where it cancels, and with all its bits as a float.
struct CarefulDotOp {
  template <Accuracy, class DD>
  static HWY_INLINE void Run(DD d, Vec<DD>& dot, Vec<DD>& unused, Vec<DD> ax, Vec<DD> ay, Vec<DD> az,
                             Vec<DD> bx, Vec<DD> by, Vec<DD> bz) {
    Vec<DD> s, s_tail, t, t_tail;
    TwoSum(hn::Mul(ax, bx), hn::Mul(ay, by), s, s_tail);
    TwoSum(s, hn::Mul(az, bz), t, t_tail);
    dot = unused = hn::Mul(hn::Add(t, hn::Add(s_tail, t_tail)), Const(d, 0x1p40));
  }
};

template <class Dist>
struct G1OfViewOp {
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void Run(D d, Vec<D>& g1, Vec<D>& unused, Vec<D> vx, Vec<D> vy, Vec<D> vz, P... p) {
    const Vec<D> z = hn::Abs(CosineOf<Dist>(d, vx, vy, vz, p...));
    g1 = unused =
        Div<A>(d, hn::Add(z, z), hn::Add(z, Dist::template Masking<Care::kCareful, A>(d, vx, vy, z, p...)));
  }
};

// chi+((v.m)/(v.n)) / (1 + Lambda(v)) (Walter 2007 Eq. 51). The sign of v.m decides, so v.m is taken in
// double lanes.
template <class Dist, Accuracy A, class D, class... P>
HWY_INLINE Vec<D> G1(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> mx, Vec<D> my, Vec<D> mz, P... p) {
  Vec<D> g1, dot, unused;
  if constexpr (Dist::kMaskingInDouble) {
    Precisely<G1OfViewOp<Dist>, A>(d, g1, unused, vx, vy, vz, p...);
  } else {
    G1OfViewOp<Dist>::template Run<A>(d, g1, unused, vx, vy, vz, p...);
  }
  Precisely<CarefulDotOp, Accuracy::kStandard>(d, dot, unused, vx, vy, vz, mx, my, mz);
  vz = CosineOf<Dist>(d, vx, vy, vz, p...);
  const Vec<D> zero = hn::Zero(d);
  return ZeroIf(hn::Or(hn::Le(FlipSign(d, dot, vz), zero), hn::Eq(vz, zero)), g1);
}

// 2^40 G1 (v.m)/(pi v.n) where it is positive, from dot = 2^40 v.m: G1/|v.n| = 2/(|vz| + |vz| (1 + 2 Lambda))
// is finite at grazing. sign(0) = 1: vz = 0 counts as above, and so does -0.
template <class Dist>
struct VisibilityOfDotOp {
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void Run(D d, Vec<D>& visibility, Vec<D>& unused, Vec<D> dot, Vec<D> vx, Vec<D> vy,
                             Vec<D> vz, P... p) {
    vz = CosineOf<Dist>(d, vx, vy, vz, p...);
    const Vec<D> z = hn::Abs(vz);
    const Vec<D> facing = hn::IfThenElse(hn::Lt(vz, hn::Zero(d)), hn::Neg(dot), dot);
    visibility = unused = Div<A>(d, hn::Mul(facing, Const(d, 2 / kPi)),
                                 hn::Add(z, Dist::template Masking<Care::kCareful, A>(d, vx, vy, z, p...)));
  }
};
template <class Dist>
struct VisibilityOp {
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void Run(D d, Vec<D>& visibility, Vec<D>& unused, Vec<D> vx, Vec<D> vy, Vec<D> vz,
                             Vec<D> mx, Vec<D> my, Vec<D> mz, P... p) {
    Vec<D> dot;
    CarefulDotOp::Run<A>(d, dot, unused, vx, vy, vz, mx, my, mz);
    VisibilityOfDotOp<Dist>::template Run<A>(d, visibility, unused, dot, vx, vy, vz, p...);
  }
};

// The visibility of sheared slopes times their ShearedDensityOp, rounded once.
template <class Dist>
struct ShearedVisibilityOp {
  template <class DD, class... P>
  static HWY_INLINE void Run(DD dd, Vec<DD>& product, Vec<DD>& unused, Vec<DD> vx, Vec<DD> vy, Vec<DD> vz,
                             Vec<DD> mx, Vec<DD> my, Vec<DD> mz, P... p) {
    Vec<DD> visibility, density;
    VisibilityOp<Dist>::template Run<Accuracy::kStandard>(dd, visibility, unused, vx, vy, vz, mx, my, mz,
                                                          p...);
    ShearedDensityOp<Dist>::Run(dd, density, unused, mx, my, mz, p...);
    product = unused = hn::Mul(hn::Mul(visibility, Const(dd, 0x1p-40)), density);
  }
};

// 2^-40 visibility pi D(m); 0 where it is not positive.
template <class Dist, Accuracy A, class D, class... P>
HWY_INLINE Vec<D> TimesVisibility(D d, Vec<D> visibility, Vec<D> mx, Vec<D> my, Vec<D> mz, P... p) {
  const auto hidden = hn::Le(visibility, hn::Zero(d));
  const Vec<D> scale = Const(d, 0x1p-40);
  // Before the exponential, which may leave the density subnormal where the product is not.
  if constexpr (Dist::kHasExponent) {
    return ZeroIf(hidden, hn::Mul(TimesPiNormalDensity<Dist, A>(d, visibility, mx, my, mz, p...), scale));
  } else {
    const Vec<D> pi_density = TimesPiNormalDensity<Dist, A>(d, Const(d, 1), mx, my, mz, p...);
    return ZeroIf(hidden, hn::Mul(hn::Mul(pi_density, visibility), scale));
  }
}

// Density of visible normals (Heitz 2014 Eq. 16).
template <class Dist, Accuracy A, class D, class... P>
HWY_INLINE Vec<D> VisibleNormalDensity(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> mx, Vec<D> my, Vec<D> mz,
                                       P... p) {
  if constexpr (kShears<Dist, P...> && A != Accuracy::kFast) {
    Vec<D> q, unused;
    InDouble2<ShearedVisibilityOp<Dist>>(d, q, unused, vx, vy, vz, mx, my, mz, p...);
    if constexpr (Dist::kHasExponent) {
      Vec<D> high, low;
      InDouble2<ShearedLogDensityOp<Dist>>(d, high, low, mx, my, mz, p...);
      q = ExpTimes<A>(d, high, low, q);
    }
    return ZeroIf(hn::Or(hn::Le(q, hn::Zero(d)), hn::Le(mz, hn::Zero(d))), q);
  }
  Vec<D> visibility, unused;
  if constexpr (A == Accuracy::kFast) {
    Vec<D> dot;
    InDouble2<InStandard<CarefulDotOp>>(d, dot, unused, vx, vy, vz, mx, my, mz);
    VisibilityOfDotOp<Dist>::template Run<A>(d, visibility, unused, dot, vx, vy, vz, p...);
  } else {
    InDouble2<InStandard<VisibilityOp<Dist>>>(d, visibility, unused, vx, vy, vz, mx, my, mz, p...);
  }
  return TimesVisibility<Dist, A>(d, visibility, mx, my, mz, p...);
}

// 2^40 min((v.m)/|v.n|, 2 mz)/pi of V-cavities, as VisibilityOfDotOp has Smith's.
struct VCavityVisibilityOfDotOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& visibility, Vec<D>& unused, Vec<D> dot, Vec<D> vz, Vec<D> mz) {
    const Vec<D> facing = hn::IfThenElse(hn::Lt(vz, hn::Zero(d)), hn::Neg(dot), dot);
    // |v.n| may be subnormal; 0 leaves the other.
    const Vec<D> scale = Const(d, 0x1p40), z = hn::Max(hn::Mul(hn::Abs(vz), scale), Const(d, 1e-36));
    const Vec<D> seen = hn::Min(Div<A>(d, facing, z), hn::Add(mz, mz));
    visibility = unused = hn::Mul(seen, Const(d, 0x1p40 / kPi));
  }
};
struct VCavityVisibilityOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& visibility, Vec<D>& unused, Vec<D> vx, Vec<D> vy, Vec<D> vz,
                             Vec<D> mx, Vec<D> my, Vec<D> mz) {
    Vec<D> dot;
    CarefulDotOp::Run<A>(d, dot, unused, vx, vy, vz, mx, my, mz);
    VCavityVisibilityOfDotOp::Run<A>(d, visibility, unused, dot, vz, mz);
  }
};

// Density of the normals that V-cavities show (Heitz 2014 Eqs. 16, 49).
template <class Dist, Accuracy A, class D, class... P>
HWY_INLINE Vec<D> VCavityNormalDensity(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> mx, Vec<D> my, Vec<D> mz,
                                       P... p) {
  Vec<D> visibility, unused;
  if constexpr (A == Accuracy::kFast) {
    Vec<D> dot;
    InDouble2<InStandard<CarefulDotOp>>(d, dot, unused, vx, vy, vz, mx, my, mz);
    VCavityVisibilityOfDotOp::Run<A>(d, visibility, unused, dot, vz, mz);
  } else {
    InDouble2<InStandard<VCavityVisibilityOp>>(d, visibility, unused, vx, vy, vz, mx, my, mz);
  }
  return TimesVisibility<Dist, A>(d, visibility, mx, my, mz, p...);
}

// y + y_tail = (alpha_x cos phi)^2 + (alpha_y sin phi)^2 of the SinCosOfEighth of phi, whose cosine and sine
// have changed places where `odd`. Without tails in kFast.
template <Accuracy A, class D>
HWY_INLINE void AzimuthRoughness2(D d, Vec<D>& y, Vec<D>& y_tail, hn::Mask<D> odd, Vec<D> s, Vec<D> s_tail,
                                  Vec<D> c, Vec<D> c_tail, Vec<D> alpha_x, Vec<D> alpha_y) {
  const Vec<D> of_c = hn::IfThenElse(odd, alpha_y, alpha_x), of_s = hn::IfThenElse(odd, alpha_x, alpha_y);
  if constexpr (A == Accuracy::kFast) {
    const Vec<D> a = hn::Mul(of_c, c), b = hn::Mul(of_s, s);
    y = hn::MulAdd(a, a, hn::Mul(b, b));
    y_tail = hn::Zero(d);
  } else {
    Vec<D> a, b, a_tail, b_tail;
    TwoProduct(d, of_c, c, a, a_tail);
    TwoProduct(d, of_s, s, b, b_tail);
    a_tail = hn::MulAdd(of_c, c_tail, a_tail);
    b_tail = hn::MulAdd(of_s, s_tail, b_tail);
    const Vec<D> tail = hn::MulAdd(a, a_tail, hn::Mul(b, b_tail));
    // The larger square enters last; what is rounded off then is known to half an ulp of the rest.
    a = hn::Abs(a);
    b = hn::Abs(b);
    const Vec<D> large = hn::Max(a, b), small = hn::Min(a, b);
    const Vec<D> rest = hn::MulAdd(small, small, hn::Add(tail, tail));
    y = FusedMulAdd(d, large, large, rest);
    y_tail = hn::Add(rest, FusedMulSub(d, large, large, y));
  }
}
template <Accuracy A, class D>
HWY_INLINE void AzimuthRoughness2(D d, Vec<D>& y, Vec<D>& y_tail, hn::Mask<D>, Vec<D>, Vec<D>, Vec<D>, Vec<D>,
                                  Vec<D> alpha) {
  y = hn::Mul(alpha, alpha);
  y_tail = A == Accuracy::kFast ? hn::Zero(d) : FusedMulSub(d, alpha, alpha, y);
}

// Azimuth of Walter 2007 Eq. 29 and a normal whose squared slope at unit roughness is t/z, r^2 = t z (Heitz
// 2014 section 5.4): M = (alpha_x r cos(2 pi u2), alpha_y r sin(2 pi u2), z), m = M/|M|, and with n = z + t
// (alpha_x^2 cos^2 + alpha_y^2 sin^2) |M|^2 = z n. w + w_tail = 1 - u1. z = w, pdf = n |M| / (pi alpha_x
// alpha_y); or kUnitZ: z = 1, pdf = w n |M| / (pi alpha_x alpha_y). kCareful: all roundings of the density
// but two are put back.
template <bool kUnitZ, Care kCare, Accuracy A, class D, class... P>
HWY_INLINE void NormalFromSlopes(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> r, Vec<D> t,
                                 Vec<D> t_tail, Vec<D> w, Vec<D> w_tail, Vec<D> u2, P... p) {
  constexpr bool kTails = kCare == Care::kCareful && A != Accuracy::kFast && kIsFloat<D>;
  Vec<D> q, s, s_tail, c, c_tail, sin, cos;
  hn::Mask<D> odd;
  SinCosOfEighth<A>(d, u2, q, s, s_tail, c, c_tail);
  TurnSinCos(d, q, s, c, sin, cos, odd);
  const Vec<D> alpha_x = AlphaX(p...), alpha_y = AlphaY(p...), pi = Const(d, kPi), one = Const(d, 1);
  const Vec<D> x = hn::Mul(hn::Mul(alpha_x, cos), r), y = hn::Mul(hn::Mul(alpha_y, sin), r);
  const Vec<D> z = kUnitZ ? one : w;
  Vec<D> roughness2, roughness2_tail;
  AzimuthRoughness2<A>(d, roughness2, roughness2_tail, odd, s, s_tail, c, c_tail, p...);
  const Vec<D> alpha2 = hn::Mul(alpha_x, alpha_y), area = hn::Mul(alpha2, pi);
  Vec<D> inverse;  // 1/|M|
  if constexpr (kTails) {
    Vec<D> slope2, slope2_tail, n, n_tail;
    TwoProduct(d, roughness2, t, slope2, slope2_tail);
    TwoSum(z, slope2, n, n_tail);
    slope2_tail = hn::MulAdd(roughness2, t_tail, hn::MulAdd(roughness2_tail, t, slope2_tail));
    n_tail = hn::Add(n_tail, kUnitZ ? slope2_tail : hn::Add(slope2_tail, w_tail));
    Vec<D> length2 = n, length2_tail = n_tail;  // NOLINT(misc-const-correctness)
    if constexpr (!kUnitZ) {
      TwoProduct(d, w, n, length2, length2_tail);
      length2_tail = hn::MulAdd(w, n_tail, hn::MulAdd(w_tail, n, length2_tail));
    }
    const Vec<D> length = hn::Sqrt(length2);
    const Vec<D> both = hn::Div(one, hn::Mul(length, area)), over_area = hn::Mul(both, length);
    inverse = hn::Mul(both, area);
    const Vec<D> length_tail = hn::Mul(hn::Mul(inverse, Const(d, 0.5)),
                                       hn::Sub(length2_tail, FusedMulSub(d, length, length, length2)));
    Vec<D> f, f_tail;
    TwoProduct(d, n, length, f, f_tail);
    f_tail = hn::Add(f_tail, hn::MulAdd(n, length_tail, hn::Mul(n_tail, length)));
    if constexpr (kUnitZ) {
      const Vec<D> rest = hn::MulAdd(f_tail, w, hn::Mul(f, w_tail));
      TwoProduct(d, f, w, f, f_tail);
      f_tail = hn::Add(f_tail, rest);
    }
    const Vec<D> alpha2_tail = FusedMulSub(d, alpha_x, alpha_y, alpha2);
    const Vec<D> pi_tail = Const(d, kPi - static_cast<double>(static_cast<float>(kPi)));
    const Vec<D> area_tail =
        hn::MulAdd(alpha2, pi_tail, hn::MulAdd(alpha2_tail, pi, FusedMulSub(d, alpha2, pi, area)));
    pdf = hn::Mul(f, over_area);
    const Vec<D> rest = hn::Sub(hn::NegMulAdd(pdf, area_tail, f_tail), FusedMulSub(d, pdf, area, f));
    pdf = hn::MulAdd(rest, over_area, pdf);
  } else {
    const Vec<D> n = hn::MulAdd(roughness2, t, z), length2 = kUnitZ ? n : hn::Mul(z, n);
    const Vec<D> f = kUnitZ ? hn::Mul(n, w) : n;
    if constexpr (A == Accuracy::kFast) {
      inverse = RefinedReciprocalSqrt(d, length2);
      pdf = hn::Mul(hn::Mul(f, FastReciprocal(d, area)), hn::Mul(length2, inverse));
    } else {
      const Vec<D> both = hn::Div(one, hn::Mul(hn::Sqrt(length2), area));
      inverse = hn::Mul(both, area);
      pdf = hn::Mul(hn::Mul(f, both), length2);
    }
  }
  mx = hn::Mul(x, inverse);
  my = hn::Mul(y, inverse);
  mz = hn::Mul(z, inverse);
}

// Normals of unit roughness turned into those of p, and their density: slopes go by (alpha_x x, alpha_y (r x
// + sqrt(1
// - r^2) y)), less the mean slope, and solid angles by |M|^3 / (alpha_x alpha_y sqrt(1 - r^2)) of the normal
// M that comes out.
template <class D>
HWY_INLINE void ShearNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> alpha_x,
                            Vec<D> alpha_y, Vec<D> r_xy, Vec<D> mean_x, Vec<D> mean_y) {
  const Vec<D> s = Uncorrelated(d, r_xy);
  const Vec<D> x = hn::NegMulAdd(mean_x, mz, hn::Mul(alpha_x, mx));
  const Vec<D> y = hn::NegMulAdd(mean_y, mz, hn::Mul(alpha_y, hn::MulAdd(r_xy, mx, hn::Mul(s, my))));
  const Vec<D> length2 = Dot(x, y, mz, x, y, mz), length = hn::Sqrt(length2);
  const Vec<D> area = hn::Mul(hn::Mul(alpha_x, alpha_y), s);
  const Vec<D> both = hn::Div(Const(d, 1), hn::Mul(length, area)), inverse = hn::Mul(both, area);
  pdf = hn::Mul(hn::Mul(hn::Mul(pdf, length2), both), length2);
  mx = hn::Mul(x, inverse);
  my = hn::Mul(y, inverse);
  mz = hn::Mul(mz, inverse);
}
template <class D>
HWY_INLINE void ShearNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> alpha_x,
                            Vec<D> alpha_y, Vec<D> r_xy) {
  ShearNormal(d, mx, my, mz, pdf, alpha_x, alpha_y, r_xy, hn::Zero(d), hn::Zero(d));
}

// A view turned into that of the surface of unit roughness.
template <class D, class... Mean>
HWY_INLINE void StretchView(D d, Vec<D>& vx, Vec<D>& vy, Vec<D>& vz, Vec<D> alpha_x, Vec<D> alpha_y,
                            Vec<D> r_xy, Mean... mean) {
  vz = MesosurfaceCosine(d, vx, vy, vz, alpha_x, alpha_y, r_xy, mean...);
  const Vec<D> y = hn::Mul(alpha_y, vy);
  vx = hn::MulAdd(r_xy, y, hn::Mul(alpha_x, vx));
  vy = hn::Mul(Uncorrelated(d, r_xy), y);
}

template <class Dist>
struct ShearedSampleOp {
  template <class DD, class... P>
  static HWY_INLINE void Run(DD dd, Vec<DD>& mx, Vec<DD>& my, Vec<DD>& mz, Vec<DD>& pdf, Vec<DD>& unused0,
                             Vec<DD>& unused1, Vec<DD> u1, Vec<DD> u2, P... p) {
    const auto of_shape = [&](auto... own) HWY_ATTR {
      Dist::template SampleNormal<Care::kPlain, Accuracy::kStandard>(dd, mx, my, mz, pdf, u1, u2, own...,
                                                                     Const(dd, 1));
    };
    OfShape<Dist>(of_shape, p...);
    OfRoughness<Dist>([&](auto... roughness) HWY_ATTR { ShearNormal(dd, mx, my, mz, pdf, roughness...); },
                      p...);
    unused0 = unused1 = pdf;
  }
};
template <class Dist>
struct ShearedSampleVisibleOp {
  template <class DD, class... P>
  static HWY_INLINE void Run(DD dd, Vec<DD>& mx, Vec<DD>& my, Vec<DD>& mz, Vec<DD>& pdf, Vec<DD>& unused0,
                             Vec<DD>& unused1, Vec<DD> vx, Vec<DD> vy, Vec<DD> vz, Vec<DD> u1, Vec<DD> u2,
                             P... p) {
    OfRoughness<Dist>([&](auto... roughness) HWY_ATTR { StretchView(dd, vx, vy, vz, roughness...); }, p...);
    const auto of_shape = [&](auto... own) HWY_ATTR {
      Dist::template SampleVisibleNormal<false, Accuracy::kStandard>(dd, mx, my, mz, pdf, vx, vy, vz, u1, u2,
                                                                     own..., Const(dd, 1));
    };
    OfShape<Dist>(of_shape, p...);
    OfRoughness<Dist>([&](auto... roughness) HWY_ATTR { ShearNormal(dd, mx, my, mz, pdf, roughness...); },
                      p...);
    unused0 = unused1 = pdf;
  }
};

// Normals m with pdf = D cos. Sheared ones in double lanes in every accuracy: mean slopes magnify roundings.
template <class Dist, Accuracy A, class D, class... P>
HWY_INLINE void SampleNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> u1, Vec<D> u2,
                             P... p) {
  if constexpr (kShears<Dist, P...>) {
    Vec<D> unused0, unused1;
    InDouble6<ShearedSampleOp<Dist>>(d, mx, my, mz, pdf, unused0, unused1, u1, u2, p...);
  } else {
    Dist::template SampleNormal<Care::kCareful, A>(d, mx, my, mz, pdf, u1, u2, p...);
  }
}

// Normals m with pdf = VCavityNormalDensity: one by D cos, or the other facet of its V-cavity (Heitz and
// d'Eon 2014), each by its share of what v sees. With z = mz |vz| and t = mx vx + my vy those are (z + t)/(2
// z) and (z - t)/(2 z), cut off at 0 and 1, and the density is D cos (1 + min(1, t/z)) of the normal that is
// taken.
template <class Dist, Care kCare, Accuracy A, class D, class... P>
HWY_INLINE void SampleVCavityNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> vx,
                                    Vec<D> vy, Vec<D> vz, Vec<D> u1, Vec<D> u2, Vec<D> u3, P... p) {
  Dist::template SampleNormal<kCare, A>(d, mx, my, mz, pdf, u1, u2, p...);
  // Scaled, as a cosine may be subnormal.
  const Vec<D> scale = Const(d, 0x1p40), z = hn::Mul(hn::Mul(hn::Abs(vz), scale), mz), two_z = hn::Add(z, z);
  Vec<D> t = hn::MulAdd(hn::Mul(vx, scale), mx, hn::Mul(hn::Mul(vy, scale), my));
  t = hn::IfThenElse(hn::Lt(vz, hn::Zero(d)), hn::Neg(t), t);
  const Vec<D> part = hn::Mul(two_z, u3);
  const auto other = hn::Lt(part, hn::Sub(z, t));
  mx = hn::IfThenElse(other, hn::Neg(mx), mx);
  my = hn::IfThenElse(other, hn::Neg(my), my);
  t = hn::IfThenElse(other, hn::Neg(t), t);
  // z + t is at least what u3 has decided by, whatever rounding makes of it.
  const Vec<D> least = hn::IfThenElse(other, part, hn::Sub(two_z, part));
  const Vec<D> share = Div<A>(d, hn::Max(hn::Add(z, t), least), z);
  pdf = hn::Mul(pdf, hn::IfThenElse(hn::Ge(t, z), Const(d, 2), share));
}

// Normals m with pdf = D_v(m), or of the smaller cap for reflection.
template <class Dist, bool kBounded, Accuracy A, class D, class... P>
HWY_INLINE void SampleVisibleNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> vx,
                                    Vec<D> vy, Vec<D> vz, Vec<D> u1, Vec<D> u2, P... p) {
  if constexpr (kShears<Dist, P...>) {
    static_assert(!kBounded, "the smaller cap is of stretched surfaces");
    Vec<D> unused0, unused1;
    InDouble6<ShearedSampleVisibleOp<Dist>>(d, mx, my, mz, pdf, unused0, unused1, vx, vy, vz, u1, u2, p...);
  } else {
    Dist::template SampleVisibleNormal<kBounded, A>(d, mx, my, mz, pdf, vx, vy, vz, u1, u2, p...);
  }
}

// Reflection of v about a normal M that is visible from it, s = 2 |v.M| / |M|^2 (Walter 2007 Eq. 39), with
// its density and, of the ideal mirror and F = 1, its weight G2/G1(v), from mu = |vz| (1 + 2 Lambda_v) and
// kept = |vz| + mu, or what is left of that to bounded caps (of height-correlated masking). M and o of the
// view -v, seen from below the surface, are turned back with it. All 0 where o is on the other side. M is (x,
// y, z_m + z_tail); the tail counts but in kFast.
template <class Dist, JointMasking kG, Accuracy A, class D, class... P>
HWY_INLINE void ReflectAboutVisible(D d, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz, Vec<D>& weight, Vec<D>& pdf,
                                    Vec<D>& lobe, Vec<D> s, Vec<D> x, Vec<D> y, Vec<D> z_m, Vec<D> z_tail,
                                    Vec<D> density, Vec<D> mu, Vec<D> kept, Vec<D> vx, Vec<D> vy, Vec<D> vz,
                                    P... p) {
  const Vec<D> zero = hn::Zero(d), one = Const(d, 1), z = hn::Abs(vz);
  const auto below = hn::Lt(vz, zero);
  const Vec<D> turned = hn::IfThenElse(below, hn::Neg(s), s);
  const Vec<D> wx = hn::MulSub(turned, x, vx), wy = hn::MulSub(turned, y, vy);
  Vec<D> wz = hn::MulSub(s, z_m, z);  // NOLINT(misc-const-correctness)
  if constexpr (A != Accuracy::kFast) wz = hn::MulAdd(s, z_tail, wz);
  const Vec<D> mu_o = Dist::template Masking<Care::kPlain, A>(d, wx, wy, wz, p...);
  // Scaled, so that two grazing cosines do not underflow together.
  const Vec<D> scale = Const(d, 0x1p60), scaled_wz = hn::Mul(wz, scale);
  Vec<D> numerator, masking;
  if constexpr (kG == JointMasking::kSeparable) {
    numerator = hn::Add(scaled_wz, scaled_wz);
    masking = hn::Mul(hn::Add(wz, mu_o), scale);
  } else {
    numerator = hn::Mul(kept, scaled_wz);
    masking = hn::MulAdd(mu, scaled_wz, hn::Mul(mu_o, hn::Mul(z, scale)));
  }
  const auto invalid = hn::Le(wz, zero);
  // 0 to 1 whatever an approximate reciprocal makes of a view whose length is next to 0.
  const Vec<D> ratio = Div<A>(d, numerator, masking);
  weight = ZeroIf(invalid, hn::Max(zero, hn::Min(one, ratio)));
  pdf = ZeroIf(invalid, density);
  ox = ZeroIf(invalid, wx);
  oy = ZeroIf(invalid, wy);
  oz = ZeroIf(invalid, hn::IfThenElse(below, hn::Neg(wz), wz));
  lobe = ZeroIf(invalid, one);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_DISTRIBUTION_INL_H_
