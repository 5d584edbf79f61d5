// The rough dielectric of Walter 2007 (Eqs. 19-21, 37-41) in lanes, over a distribution policy (Ggx,
// Beckmann, Phong).
//
// With unnormalised H = i + e o (e = 1 for reflection, eta for transmission) and D(H/|H|) = K |H|^4,
//   f_r |cos o| = F |H|^4 K / 4              * G/|i.n| * |o.n| / |o.n|
//   f_t |cos o| = eta^2 |i.H| |o.H| (1-F) K  * G/|i.n|
//   pdf_r       = K Hz |o.H|,   pdf_t = eta^2 K Hz |o.H|
// and, of normals visible from i (Heitz 2014 Eq. 16) in place of D cos,
//   pdf_r       = |H|^4 K / 4 G1(i)/|i.n|,   pdf_t = eta^2 |i.H| |o.H| K G1(i)/|i.n|
// so no vector is normalised, and one division serves F, K and G.
#if defined(MICROLANE_ROUGH_DIELECTRIC_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_ROUGH_DIELECTRIC_INL_H_
#undef MICROLANE_ROUGH_DIELECTRIC_INL_H_
#else
#define MICROLANE_ROUGH_DIELECTRIC_INL_H_
#endif

#include <cstddef>
#include <limits>
#include <type_traits>

#include "microlane/half_vector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

enum class Lobes { kReflection, kTransmission, kBoth };
// What densities are of: D cos; visible normals; those of Dist's smaller cap for reflection; those that
// V-cavities show.
enum class Drawn { kNormals, kVisible, kBoundedVisible, kVCavity };

// The lane's own of two values of lobes.
template <Lobes kLobes, class M, class V>
HWY_INLINE V OfLobe(M transmits, V transmitted, V reflected) {
  return kLobes == Lobes::kBoth         ? hn::IfThenElse(transmits, transmitted, reflected)
         : kLobes == Lobes::kReflection ? reflected
                                        : transmitted;
}

// c^2, s^2 = 1 - c^2 and g^2 from i.H, o.H, H.H and k = eta^2 - 1: times H.H in transmission. In reflection
// as they are, through c^2 = i.H - H.H/4, which for vectors of lengths li and lo lacks a relative ((li^2 -
// lo^2)/H.H)^2.
template <Lobes kLobes, class D>
HWY_INLINE void TermsOfDots(D d, Vec<D>& c2, Vec<D>& s2, Vec<D>& g2, hn::Mask<D> transmits, Vec<D> ih,
                            Vec<D> h2, Vec<D> k) {
  const Vec<D> c2r = hn::NegMulAdd(Const(d, 0.25), h2, ih), c2t = hn::Mul(ih, ih);
  c2 = OfLobe<kLobes>(transmits, c2t, c2r);
  s2 = OfLobe<kLobes>(transmits, hn::NegMulAdd(ih, ih, h2), hn::Sub(Const(d, 1), c2r));
  g2 = OfLobe<kLobes>(transmits, hn::MulAdd(k, h2, c2t), hn::Add(k, c2r));
}

// h + h_tail = i + e o, h_tail below the rounding of h; e = 1 unless kScaled.
template <bool kScaled, class D>
HWY_INLINE void SumWithTail(D d, Vec<D>& h, Vec<D>& h_tail, Vec<D> i, Vec<D> o, Vec<D> e) {
  if constexpr (kScaled) {
    Vec<D> p, p_tail, s, s_tail;
    TwoProduct(d, e, o, p, p_tail);
    TwoSum(p, i, s, s_tail);
    FastTwoSum(s, hn::Add(s_tail, p_tail), h, h_tail);
  } else {
    (void)d;
    (void)e;
    TwoSum(i, o, h, h_tail);
  }
}

// Sums of products next to 6 all round on the grid of 2^-21, so that what each product lost is known exactly.
constexpr double kGrid = 6;

// v.v - 1 of a direction of length 1, within 2^-44 or a rounding: the last sum cancels.
template <class D>
HWY_INLINE Vec<D> LengthSquaredMinus1(D d, Vec<D> x, Vec<D> y, Vec<D> z) {
  const Vec<D> s0 = Const(d, kGrid), s1 = hn::MulAdd(x, x, s0), s2 = hn::MulAdd(y, y, s1);
  const Vec<D> lost = hn::Add(hn::MulSub(x, x, hn::Sub(s1, s0)), hn::MulSub(y, y, hn::Sub(s2, s1)));
  return hn::Add(hn::MulAdd(z, z, hn::Sub(s2, Const(d, kGrid + 1))), lost);
}

// 1 + a.b = high + low of directions of length 1: high on the grid, low within 2^-44.
template <class D>
HWY_INLINE void OnePlusDot(D d, Vec<D>& high, Vec<D>& low, Vec<D> ax, Vec<D> ay, Vec<D> az, Vec<D> bx,
                           Vec<D> by, Vec<D> bz) {
  const Vec<D> s0 = Const(d, kGrid);
  const Vec<D> s1 = hn::MulAdd(ax, bx, s0), s2 = hn::MulAdd(ay, by, s1), s3 = hn::MulAdd(az, bz, s2);
  high = hn::Sub(s3, Const(d, kGrid - 1));
  low = hn::Add(hn::MulSub(ax, bx, hn::Sub(s1, s0)),
                hn::Add(hn::MulSub(ay, by, hn::Sub(s2, s1)), hn::MulSub(az, bz, hn::Sub(s3, s2))));
}

struct UnitDotsOp {
  template <class DD>
  static HWY_INLINE void Run(DD dd, Vec<DD>& a, Vec<DD>& b, Vec<DD>& w, Vec<DD>& w_low, Vec<DD>& unused0,
                             Vec<DD>& unused1, Vec<DD> ix, Vec<DD> iy, Vec<DD> iz, Vec<DD> ox, Vec<DD> oy,
                             Vec<DD> oz) {
    const Vec<DD> one = Const(dd, 1), shift = Const(dd, 0x1.8p31);
    a = hn::Sub(Dot(ix, iy, iz, ix, iy, iz), one);
    b = hn::Sub(Dot(ox, oy, oz, ox, oy, oz), one);
    const Vec<DD> io = hn::Add(Dot(ix, iy, iz, ox, oy, oz), one);
    w = hn::Sub(hn::Add(io, shift), shift);
    w_low = hn::Sub(io, w);
    unused0 = unused1 = w;
  }
};

// a = i.i - 1, b = o.o - 1 and w + w_low = 1 + i.o of float directions of length 1 to within 2^-44, where
// float products would leave 2^-24. w is on the grid of 2^-21.
template <class D>
HWY_INLINE void UnitDots(D d, Vec<D>& a, Vec<D>& b, Vec<D>& w, Vec<D>& w_low, Vec<D> ix, Vec<D> iy, Vec<D> iz,
                         Vec<D> ox, Vec<D> oy, Vec<D> oz) {
#if HWY_NATIVE_FMA
  a = LengthSquaredMinus1(d, ix, iy, iz);
  b = LengthSquaredMinus1(d, ox, oy, oz);
  OnePlusDot(d, w, w_low, ix, iy, iz, ox, oy, oz);
#else
  Vec<D> unused0, unused1;
  InDouble6<UnitDotsOp>(d, a, b, w, w_low, unused0, unused1, ix, iy, iz, ox, oy, oz);
#endif
}

// The terms of TermsOfDots, i.H, o.H, H.H and its square, of H = i + e o in float lanes to a rounding or two;
// of reflection, s2_tail is what the rounding of s^2 took.
// `ill` where more is lost: lengths not near 1, H near 0, a facet seen edge-on.
template <Lobes kLobes, class D>
HWY_INLINE void InterfaceTermsSplit(D d, Vec<D>& ih, Vec<D>& oh, Vec<D>& h2, Vec<D>& h4, Vec<D>& c2,
                                    Vec<D>& s2, Vec<D>& s2_tail, Vec<D>& g2, Vec<D>& c2_plus_g2,
                                    hn::Mask<D>& ill, hn::Mask<D> transmits, Vec<D> ix, Vec<D> iy, Vec<D> iz,
                                    Vec<D> ox, Vec<D> oy, Vec<D> oz, Vec<D> e, Vec<D> eta, Vec<D> k) {
  Vec<D> a, b, w, w_low;
  UnitDots(d, a, b, w, w_low, ix, iy, iz, ox, oy, oz);
  const Vec<D> half = Const(d, 0.5), one = Const(d, 1), two = Const(d, 2);
  // Reflection: c^2 = w/2 + (3 a - b)/4, and w/2 - 1 is exact.
  const Vec<D> low = hn::MulAdd(half, w_low, hn::MulSub(Const(d, 0.75), a, hn::Mul(Const(d, 0.25), b)));
  const Vec<D> s2_high = hn::NegMulAdd(half, w, one);
  const Vec<D> c2r = hn::MulAdd(half, w, low), s2r = hn::Sub(s2_high, low);
  const Vec<D> g2r = hn::Add(FusedMulSub(d, eta, eta, s2_high), low);
  const Vec<D> sum_r = hn::Add(w, hn::MulAdd(two, low, k));
  if constexpr (kLobes == Lobes::kReflection) {
    const Vec<D> rest = hn::MulAdd(two, w_low, hn::Add(a, b));
    h2 = hn::MulAdd(two, w, rest);
    const Vec<D> h2_tail = hn::Add(hn::MulSub(two, w, h2), rest);
    h4 = hn::Mul(h2, hn::MulAdd(two, h2_tail, h2));
    oh = hn::Mul(hn::Add(h2, hn::Sub(b, a)), half);
    ih = hn::Sub(h2, oh);
    c2 = c2r;
    s2 = s2r;
    s2_tail = hn::Sub(hn::Sub(s2_high, s2r), low);
    g2 = g2r;
    c2_plus_g2 = sum_r;
  } else {
    // s^2 H.H = e^2 ((i.i)(o.o) - (i.o)^2) - a H.H, and g^2 H.H = (e o.H)^2 + (a - e^2 b) H.H of a refracted
    // o.
    const Vec<D> r = hn::Sub(one, e), r_low = hn::Sub(hn::Sub(one, r), e), e2 = hn::Mul(e, e),
                 two_e = hn::Add(e, e);
    ih = hn::Add(FusedMulAdd(d, e, w, r), hn::MulAdd(e, w_low, hn::Add(a, r_low)));
    oh = hn::Add(hn::Sub(w, r), hn::MulAdd(e, b, hn::Sub(w_low, r_low)));
    h2 = hn::MulAdd(r, r, hn::MulAdd(two_e, w, hn::MulAdd(two_e, w_low, hn::MulAdd(e2, b, a))));
    const Vec<D> w1 = hn::Add(w, w_low), eoh = hn::Mul(e, oh);
    const Vec<D> cross2 = hn::MulAdd(hn::Sub(two, w1), w1, hn::MulAdd(a, b, hn::Add(a, b)));
    // Where neither cancels, s^2 = H.H - c^2 and g^2 = k H.H + c^2: an error of H.H that all share leaves F
    // and T alone.
    const Vec<D> c2t = hn::Mul(ih, ih);
    const Vec<D> s2t = hn::IfThenElse(hn::Lt(hn::Add(c2t, c2t), h2), hn::NegMulAdd(ih, ih, h2),
                                      hn::NegMulAdd(a, h2, hn::Mul(e2, cross2)));
    const Vec<D> g2t = hn::IfThenElse(hn::Gt(k, hn::Zero(d)), hn::MulAdd(k, h2, c2t),
                                      hn::MulAdd(eoh, eoh, hn::Mul(hn::NegMulAdd(e2, b, a), h2)));
    c2 = OfLobe<kLobes>(transmits, c2t, c2r);
    s2 = OfLobe<kLobes>(transmits, s2t, s2r);
    g2 = OfLobe<kLobes>(transmits, g2t, g2r);
    c2_plus_g2 = OfLobe<kLobes>(transmits, hn::Add(c2, g2), sum_r);
    h4 = hn::Mul(h2, h2);
  }
  const Vec<D> off2 = hn::MulAdd(a, a, hn::Mul(b, b));
  ill = hn::Lt(hn::Mul(h2, h2), hn::MulAdd(off2, Const(d, 0x1p26), Const(d, 0x1p-24)));
  if constexpr (kLobes != Lobes::kReflection) {
    ill = hn::Or(ill, hn::Lt(hn::Min(hn::Abs(ih), hn::Abs(oh)), Const(d, 0x1p-12)));
  }
}

// a + a_tail += x (h + h_tail), to twice the working precision.
template <class D>
HWY_INLINE void AddProduct(D d, Vec<D>& a, Vec<D>& a_tail, Vec<D> x, Vec<D> h, Vec<D> h_tail) {
  Vec<D> p, p_tail, s, s_tail;
  TwoProduct(d, x, h, p, p_tail);
  TwoSum(a, p, s, s_tail);
  a = s;
  a_tail = hn::Add(a_tail, hn::Add(s_tail, hn::MulAdd(x, h_tail, p_tail)));
}

// InterfaceTerms to twice the working precision, of H = scale (i + e o): at the critical angle, where g^2 may
// have nothing left of either term, where a facet is seen edge-on, and s^2 where i and o nearly agree. Out of
// line: few lanes need it.
template <class D>
HWY_NOINLINE void InterfaceTermsTwice(D d, Vec<D>& ih, Vec<D>& oh, Vec<D>& h2, Vec<D>& s2, Vec<D>& g2,
                                      Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz,
                                      Vec<D> e, Vec<D> eta, Vec<D> scale) {
  const Vec<D> zero = hn::Zero(d);
  Vec<D> ih_tail = zero, oh_tail = zero, h2_tail = zero;
  ih = oh = h2 = zero;
  const auto component = [&](Vec<D> i, Vec<D> o) HWY_ATTR {
    Vec<D> p, p_tail, s, s_tail, h, h_tail;
    TwoProduct(d, e, o, p, p_tail);
    TwoSum(p, i, s, s_tail);
    FastTwoSum(s, hn::Add(s_tail, p_tail), h, h_tail);
    h = hn::Mul(h, scale);
    h_tail = hn::Mul(h_tail, scale);
    AddProduct(d, ih, ih_tail, i, h, h_tail);
    AddProduct(d, oh, oh_tail, o, h, h_tail);
    AddProduct(d, h2, h2_tail, h, h, hn::Add(h_tail, h_tail));
  };
  component(ix, ox);
  component(iy, oy);
  component(iz, oz);
  Vec<D> e2, e2_tail, k, k_tail, m, m_tail, q, q_tail, s, s_tail, i1, i1_tail;
  TwoProduct(d, eta, eta, e2, e2_tail);
  TwoSum(e2, Const(d, -1), k, k_tail);
  k_tail = hn::Add(k_tail, e2_tail);
  TwoSum(ih, ih_tail, i1, i1_tail);
  TwoProduct(d, k, h2, m, m_tail);
  TwoProduct(d, i1, i1, q, q_tail);
  TwoSum(q, m, s, s_tail);
  const Vec<D> square_tail = hn::MulAdd(hn::Add(i1, i1), i1_tail, q_tail);
  const Vec<D> tail = hn::Add(hn::MulAdd(k, h2_tail, hn::MulAdd(k_tail, h2, m_tail)), square_tail);
  g2 = hn::Add(s, hn::Add(s_tail, tail));
  TwoSum(h2, hn::Neg(q), s, s_tail);
  s2 = hn::Add(s, hn::Add(s_tail, hn::Sub(h2_tail, square_tail)));
  ih = i1;
  oh = hn::Add(oh, oh_tail);
  h2 = hn::Add(h2, h2_tail);
}

// G/|i.n| |o.n| = factor |o.n| / denominator, from z = |v.n| and mu = |v.n| (1 + 2 Lambda(v)).
template <JointMasking kG, class V>
HWY_INLINE V MaskingDenominator(V zi, V mu_i, V zo, V mu_o) {
  if constexpr (kG == JointMasking::kHeightCorrelated) {
    return hn::MulAdd(zo, mu_i, hn::Mul(zi, mu_o));
  } else {
    return hn::Mul(hn::Add(mu_i, zi), hn::Add(mu_o, zo));
  }
}
template <JointMasking kG>
constexpr double kMaskingFactor = kG == JointMasking::kHeightCorrelated ? 2.0  // NOLINT
                                  : kG == JointMasking::kVCavity        ? 1.0
                                                                        : 4.0;

// What facets are: an interface between dielectrics, or what opaque surfaces have (rough_reflector-inl.h).
// q0 and q1 are its parameters.
struct DielectricInterface {
  static constexpr std::size_t kParameters = 1;  // eta
  static constexpr bool kReflectsAll = false;    // F = 1
  static constexpr bool kHasG = true;            // F depends on g^2 = q0^2 - 1 + c^2
};

// x/y, by r = 1/y where that is at hand.
template <bool kInverse, Accuracy A, class D>
HWY_INLINE Vec<D> OverDenominator(D d, Vec<D> x, Vec<D> y, Vec<D> r) {
  if constexpr (kInverse) {
    return DivByReciprocal<A>(d, x, y, r);
  } else {
    return Div<A>(d, x, y);
  }
}

// NOLINTBEGIN(misc-const-correctness): what one instantiation leaves alone, another assigns.
// c^2, s^2 and what the rounding of s^2 took, times H.H in double lanes, for whoever adds facets of its own.
template <class D>
struct FacetTerms {
  Vec<D>&c2, &s2, &s2_tail;
};

// One pass, of the lobes of Interface. In float lanes `hard` marks the lanes that double lanes must do: some
// product may have underflowed, or cancellation has taken too much.
template <class Dist, class Interface, Lobes kLobes, JointMasking kG, bool kValue, bool kPdf, Drawn kDrawn,
          Accuracy A, class D, class... P>
HWY_INLINE void RoughSurfacePass(D d, hn::Mask<D> radiance, Vec<D>& value, Vec<D>& pdf, hn::Mask<D>& hard,
                                 const FacetTerms<D>& terms, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox,
                                 Vec<D> oy, Vec<D> oz, Vec<D> q0, Vec<D> q1, P... p) {
  constexpr bool kDielectric = std::is_same_v<Interface, DielectricInterface>;
  static_assert(kDielectric || kLobes == Lobes::kReflection, "opaque surfaces reflect alone");
  constexpr bool kReflects = kLobes != Lobes::kTransmission, kTransmits = kLobes != Lobes::kReflection;
  constexpr bool kOfVisible = kPdf && kDrawn != Drawn::kNormals, kVCavity = kG == JointMasking::kVCavity;
  static_assert(!kVCavity || (kLobes == Lobes::kReflection && kValue), "a joint masking of reflection");
  constexpr bool kKelemen = kG == JointMasking::kKelemen, kSmith = !kVCavity && !kKelemen;
  static_assert(!kKelemen || (kLobes == Lobes::kReflection && kDrawn == Drawn::kNormals), "P_H F/(h.h)");
  static_assert(kVCavity || kDrawn != Drawn::kVCavity, "their densities come with their values");
  constexpr bool kWide = !kIsFloat<D>, kFast = A == Accuracy::kFast;
  constexpr bool kNeedsFresnel = !Interface::kReflectsAll && (kValue || kLobes == Lobes::kBoth);
  constexpr bool kNeedsG = kNeedsFresnel && Interface::kHasG,
                 kNeedsCosines = kTransmits || (kPdf && kDrawn == Drawn::kNormals);
  const Vec<D> eta = q0;
  const Vec<D> zero = hn::Zero(d), one = Const(d, 1);
  // i to the upper side.
  oz = FlipSign(d, oz, iz);
  iz = hn::Abs(iz);
  const Vec<D> zo = kTransmits ? hn::Abs(oz) : oz;
  const auto transmits = hn::Lt(oz, zero);
  Vec<D> e = one;
  if constexpr (kTransmits) e = kReflects ? hn::IfThenElse(transmits, eta, one) : eta;

  constexpr bool kSplit = !kWide && !kFast, kCarefulExponent = Dist::kHasExponent && kSplit;
  Vec<D> hx, hy, hz, hx_tail = zero, hy_tail = zero, hz_tail = zero, scale = one;
  if constexpr (kSplit) {
    SumWithTail<kTransmits>(d, hx, hx_tail, ix, ox, e);
    SumWithTail<kTransmits>(d, hy, hy_tail, iy, oy, e);
    SumWithTail<kTransmits>(d, hz, hz_tail, iz, oz, e);
  } else if constexpr (kTransmits) {
    hx = FusedMulAdd(d, e, ox, ix);
    hy = FusedMulAdd(d, e, oy, iy);
    hz = FusedMulAdd(d, e, oz, iz);
  } else {
    hx = hn::Add(ox, ix);
    hy = hn::Add(oy, iy);
    hz = hn::Add(oz, iz);
  }
  if constexpr (kWide) {
    scale = PowerOfTwoScale(d, hx, hy, hz);
    hx = hn::Mul(hx, scale);
    hy = hn::Mul(hy, scale);
    hz = hn::Mul(hz, scale);
  }

  // i.H, o.H, H.H, and c^2, s^2 = 1 - c^2 and g^2 times `norm`, which is H.H in double lanes and in
  // transmission.
  constexpr Lobes kScaled = kWide ? Lobes::kTransmission : kLobes;
  const Vec<D> k = EtaSquaredMinus1(d, eta);
  Vec<D> ih, oh, h2, h4, g2, c2_plus_g2 = zero, log_high = zero, log_low = zero;
  Vec<D>&c2 = terms.c2, &s2 = terms.s2, &s2_tail = terms.s2_tail;
  s2_tail = zero;
  if constexpr (kWide || kFast) {
    ih = Dot(ix, iy, iz, hx, hy, hz);
    h2 = Dot(hx, hy, hz, hx, hy, hz);
    oh = kWide || kNeedsCosines ? Dot(ox, oy, oz, hx, hy, hz) : hn::Sub(h2, ih);
    if constexpr (Dist::kHasExponent) log_high = Dist::LogDensity(d, hx, hy, hz, p...);
    TermsOfDots<kScaled>(d, c2, s2, g2, transmits, ih, h2, k);
    if constexpr (kWide) {
      // F depends on the dots by 4/g times their errors, T also on the relative errors of i.H, o.H and g.
      auto ill = hn::MaskFromVec(zero);
      const Vec<D> little = hn::Mul(h2, Const(d, kDielectric ? 0x1p-18 : 0x1p-8));
      if constexpr (kNeedsG) ill = hn::Lt(hn::Abs(g2), little);
      if constexpr (kNeedsCosines) {
        const Vec<D> least = hn::Min(c2, hn::Mul(oh, oh));
        ill = hn::Or(ill, hn::Lt(least, hn::Mul(h2, Const(d, 0x1p-40))));
      }
      if constexpr (kNeedsFresnel && !Interface::kHasG) {
        ill = hn::Or(ill, hn::Lt(s2, little));
      }
      if (HWY_UNLIKELY(!hn::AllFalse(d, ill))) {
        Vec<D> ih_, oh_, h2_, s2_, g2_;
        InterfaceTermsTwice(d, ih_, oh_, h2_, s2_, g2_, ix, iy, iz, ox, oy, oz, e, eta, scale);
        ih = hn::IfThenElse(ill, ih_, ih);
        oh = hn::IfThenElse(ill, oh_, oh);
        h2 = hn::IfThenElse(ill, h2_, h2);
        g2 = hn::IfThenElse(ill, g2_, g2);
        c2 = hn::Mul(ih, ih);
        s2 = kDielectric ? hn::NegMulAdd(ih, ih, h2) : hn::IfThenElse(ill, s2_, s2);
      }
    }
  } else {
    InterfaceTermsSplit<kLobes>(d, ih, oh, h2, h4, c2, s2, s2_tail, g2, c2_plus_g2, hard, transmits, ix, iy,
                                iz, ox, oy, oz, e, eta, k);
  }
  if constexpr (!kSplit) h4 = hn::Mul(h2, h2);
  const Vec<D> norm = OfLobe<kScaled>(transmits, h2, one), norm2 = OfLobe<kScaled>(transmits, h4, one);
  if constexpr (!kWide && kFast) {
    const Vec<D> skew = hn::Mul(hn::Sub(ih, oh), Const(d, 0x1p7));
    if constexpr (kReflects) hard = hn::Lt(h2, OfLobe<kLobes>(transmits, zero, hn::Abs(skew)));
    if constexpr (kNeedsCosines) {
      const Vec<D> cos2 = hn::Min(hn::Mul(ih, ih), hn::Mul(oh, oh));
      hard = hn::Or(hard, hn::Lt(cos2, hn::Mul(h2, Const(d, 0x1p-18))));
    }
  }
  if constexpr (!kWide && kNeedsFresnel && kDielectric) {
    // The error of g^2 reaches F divided by c g, T divided by g^2.
    constexpr double kLeast = kFast ? 0x1p-12 : 0x1p-19;
    hard = hn::Or(hard, hn::Lt(hn::Abs(hn::Mul(c2, g2)), hn::Mul(norm2, Const(d, kLeast))));
    if constexpr (kTransmits) {
      constexpr double kLeastT = kFast ? 0x1p-11 : 0x1p-13;
      hard =
          hn::Or(hard, hn::Lt(hn::Abs(g2), OfLobe<kLobes>(transmits, hn::Mul(h2, Const(d, kLeastT)), zero)));
    }
  }

  // Sidedness (Walter 2007 Eq. 7), H taken as pointing to the upper side.
  const Vec<D> signed_hz = hz;
  Vec<D> least = hn::Min(iz, zo);
  if constexpr (kTransmits) {
    const Vec<D> side_i = FlipSign(d, ih, hz), side_o = FlipSign(d, oh, hn::Xor(hz, oz));
    hz = hn::Abs(hz);
    least = hn::Min(hn::Min(least, hz), hn::Min(side_i, side_o));
    ih = hn::Abs(ih);
    oh = hn::Abs(oh);
  } else if constexpr (kWide) {
    least = hn::Min(least, hn::Min(ih, oh));
  }  // else i.H and o.H are positive, near H.H/2
  auto invalid = hn::Le(least, zero);
  if constexpr (!kReflects) invalid = hn::Or(invalid, hn::Gt(oz, zero));

  // K = w exp(log) / (pi density^2). That of a cosine has |H|^4 there, which cancels from the value in
  // reflection.
  Vec<D> density = one, unused = zero, w;
  constexpr Care kDensityCare = kSplit ? Care::kCompensated : Care::kPlain;
  constexpr bool kCancels = Dist::kDensityOfCosine && (!kPdf || kOfVisible);
  if constexpr (Dist::kDensityOfCosine) {
    w = Dist::Norm(d, p...);
  } else {
    Dist::template Density<kDensityCare>(d, density, unused, w, hx, hy, signed_hz, hx_tail, hy_tail, hz_tail,
                                         p...);
  }

  // F = fresnel / (A M)^2. Of a dielectric from squares times H.H, with N = p^2 + s^4 and M^2 = N + 2 p s^2:
  // an error of p or N leaves the quotient of the two at half its size or less.
  Vec<D> a = one, m2 = one, n = one, twice_p = one, fresnel = one;
  const Vec<D> eta2 = hn::Mul(eta, eta);
  if constexpr (kNeedsFresnel && !kDielectric) {
    Interface::template Reflectance<A>(d, fresnel, a, m2, hard, c2, s2, s2_tail, g2, norm, q0, q1);
  } else if constexpr (kNeedsFresnel) {
    g2 = hn::Max(kFast ? Const(d, 1e-25) : zero, g2);
    const Vec<D> root = SqrtOfPositive<A>(d, hn::Mul(c2, g2));
    twice_p = hn::Add(root, root);
    a = hn::Add(kSplit ? hn::Max(c2, c2_plus_g2) : hn::Add(c2, g2), twice_p);
    if constexpr (kWide) {
      // Above 0 where c = g = 0 (no interface, no light), so that 0/0 is 0.
      const Vec<D> low = Const(d, 1e-280);
      a = hn::IfThenElse(hn::Lt(a, low), low, a);
    }
    n = hn::MulAdd(s2, s2, hn::Mul(root, root));
    m2 = hn::MulAdd(twice_p, s2, n);
  }

  // masking: G/|i.n| |o.n| = kMaskingFactor zo / masking. visible: G1(i)/|i.n| = 2 / visible, or more of the
  // share of visible normals that are drawn from. Of V-cavities G/|i.n| = seen/masking and G1(i)/|i.n| =
  // seen_i/masking. Of Kelemen 2001 Eq. 3, D h.n/|H|^2 = D G/(4 |i.n| |o.n|) with G/|i.n| |o.n| = 4
  // seen/masking = 4 Hz |o.n|/|H|^3.
  Vec<D> masking = one, visible = one, mu_i = one, seen = zo, seen_i = one;
  if constexpr (kVCavity) {
    const Vec<D> two_hz = hn::Add(hz, hz), product = hn::Mul(ih, oh);
    seen_i = hn::Min(product, hn::Mul(hn::Mul(two_hz, oh), iz));
    seen = hn::Min(seen_i, hn::Mul(hn::Mul(two_hz, ih), zo));
    masking = hn::Mul(product, iz);
  }
  if constexpr (kValue && kKelemen) {
    masking = hn::Mul(h2, SqrtOfPositive<A>(d, h2));
    seen = kWide ? hn::Mul(hn::Mul(hz, scale), hn::Mul(zo, scale)) : hn::Mul(hz, zo);
  }
  if constexpr ((kValue || kOfVisible) && kSmith)
    mu_i = Dist::template Masking<Care::kPlain, A>(d, ix, iy, iz, p...);
  if constexpr (kDrawn == Drawn::kBoundedVisible) {
    Vec<D> factor, over;
    Dist::template LeftOut<A>(d, factor, over, ix, iy, iz, p...);
    visible = hn::NegMulAdd(factor, over, hn::Add(mu_i, iz));
  } else if constexpr (kOfVisible && !kVCavity) {
    visible = hn::Add(mu_i, iz);
  }
  if constexpr (kOfVisible && !kValue) masking = visible;
  if constexpr (kValue && kSmith) {
    const Vec<D> mu_o = Dist::template Masking<Care::kPlain, A>(d, ox, oy, zo, p...);
    masking = MaskingDenominator<kG>(iz, mu_i, zo, mu_o);
  }

  // Everything is over (scaled A density)^2 M^2 masking, with (k H.H)^2 N and 2 p A (M^2 + eta^2 H.H^2) as
  // the Fresnel factors F and T times A^2 M^2. |k H.H| <= A is reached under total internal reflection.
  constexpr double kScale = kWide ? 1 : 0x1p21;
  const Vec<D> scaled_a = hn::Mul(a, Const(d, kScale)), ad = hn::Mul(density, scaled_a);
  Vec<D> last_ad = ad;
  // Takes up what both factors have lost.
  if constexpr (kSplit && kNeedsFresnel)
    last_ad = hn::MulAdd(Const(d, 2), FusedMulSub(d, density, scaled_a, ad), ad);
  Vec<D> ad2 = hn::Mul(ad, last_ad);
  if constexpr (Dist::kDensityOfCosine)
    ad2 = hn::Mul(ad2, kCancels ? OfLobe<kLobes>(transmits, h4, one) : h4);
  const Vec<D> denominator = hn::Mul(hn::Mul(ad2, m2), masking);
  // Of a dielectric F or T (both lobes: that of the lane), times A^2 M^2.
  if constexpr (kNeedsFresnel && kDielectric) {
    Vec<D> f = one, t = one;
    if constexpr (kReflects) {
      const Vec<D> kn = hn::Min(hn::Abs(hn::Mul(k, norm)), a);
      f = hn::Mul(hn::Mul(kn, kn), n);
    }
    if constexpr (kTransmits) {
      t = hn::Mul(hn::Mul(twice_p, a), hn::MulAdd(eta2, norm2, m2));
    }
    fresnel = kReflects && kTransmits ? hn::IfThenElse(transmits, t, f) : kReflects ? f : t;
  }
  constexpr double kFactor = kMaskingFactor<kG> * (kTransmits ? 1 : 0.25);  // of the value over K
  constexpr double kNorm = kScale * kScale / kPi * (kValue && !kPdf ? kFactor : 1);
  Vec<D> ws = hn::Mul(w, Const(d, kNorm));
  if constexpr (kSplit)
    ws = hn::MulAdd(w, Const(d, kNorm), hn::Mul(w, Const(d, kNorm - static_cast<float>(kNorm))));
  if constexpr (!kWide) {
    // Factors whose products could leave the range. F A^2 M^2 also bounds H.H (for A M <= 2^11 H.H^2), so
    // that rounding has not changed the sign of i.H or o.H, which are H.H/2 for unit vectors.
    constexpr bool kHasReflectance = kNeedsFresnel && !kTransmits;
    Vec<D> low = hn::Min(ws, kHasReflectance && kDielectric ? fresnel : hn::Mul(h2, h4));
    if constexpr (kHasReflectance && !kDielectric) low = hn::Min(low, fresnel);
    if constexpr (kValue || kOfVisible) low = hn::Min(low, masking);
    hard =
        hn::Or(hard, hn::Or(hn::Lt(low, Const(d, 0x1p-42)), OutOfRange(d, denominator, 0x1p-70f, 0x1p120f)));
  }
  // What may be tiny of itself (a cosine) is multiplied last.
  Vec<D> r = one;
  // The errors of two roots add up in the separable masking; kFast leaves none to the division there.
  constexpr bool kRefined = kFast && kG == JointMasking::kSeparable, kInverse = kRefined || (kValue && kPdf);
  if constexpr (kRefined) {
    r = RefinedReciprocal<A>(d, denominator);
  } else if constexpr (kInverse) {
    r = Reciprocal<A>(d, denominator);
  }
  if constexpr (kCarefulExponent) {
    // A division of its own: the exponential need not wait for Fresnel and masking.
    const Vec<D> over_density = hn::Div(one, density);
    CarefulLogDensity<Dist, kDensityCare>(d, log_high, log_low, over_density, density, unused, hx, hy,
                                          signed_hz, hx_tail, hy_tail, hz_tail, p...);
  }

  // |H|^4, of both lobes |H|^4 / 4; and |i.H| |o.H|.
  Vec<D> reflection = one, transmission = one;
  if constexpr (kValue || kOfVisible) {
    const Vec<D> left_of_h4 = kCancels ? one : h4;
    if constexpr (kReflects) reflection = kTransmits ? hn::Mul(left_of_h4, Const(d, 0.25)) : left_of_h4;
    if constexpr (kTransmits) {
      transmission = kWide ? hn::Mul(hn::Mul(ih, scale), hn::Mul(oh, scale)) : hn::Mul(ih, oh);
    }
  }
  if constexpr (kValue) {
    // f_r |o.n| = F |H|^4 K/4 G/|i.n|, f_t |o.n| = eta^2 |i.H| |o.H| T K G/|i.n|.
    Vec<D> transmitted = one;
    if constexpr (kTransmits) transmitted = hn::Mul(transmission, hn::IfThenElse(radiance, eta2, one));
    const Vec<D> x = OfLobe<kLobes>(transmits, transmitted, reflection);
    const Vec<D> numerator = hn::Mul(hn::Mul(kPdf ? hn::Mul(ws, Const(d, kFactor)) : ws, x), fresnel);
    value = hn::Mul(OverDenominator<kInverse, A>(d, numerator, denominator, r), seen);
    if constexpr (Dist::kHasExponent) value = ExpTimes<A>(d, log_high, log_low, value);
    value = ZeroIf(invalid, value);
  }
  if constexpr (kPdf) {
    // K Hz |o.H|, or K |H|^4 / (2 visible) and 2 K |i.H| |o.H| / visible (eta^2 and F or T where they apply).
    Vec<D> x = ws;
    if constexpr (kOfVisible) x = hn::Mul(ws, OfLobe<kLobes>(transmits, transmission, reflection));
    if constexpr (kLobes == Lobes::kTransmission) {
      x = hn::Mul(x, eta2);
    } else if constexpr (kLobes == Lobes::kBoth) {
      x = hn::Mul(x, hn::Mul(fresnel, hn::IfThenElse(transmits, eta2, one)));
    } else {
      invalid = hn::Or(invalid, transmits);
      if constexpr (kNeedsFresnel) x = hn::Mul(x, hn::Mul(hn::Mul(a, a), m2));
    }
    if constexpr (kValue && !kVCavity) x = hn::Mul(x, masking);
    x = OverDenominator<kInverse, A>(d, x, denominator, r);
    if constexpr (kOfVisible && kVCavity) {
      x = hn::Mul(hn::Mul(x, seen_i), Const(d, kFactor));
    } else if constexpr (kOfVisible) {
      x = hn::Mul(x, Const(d, kTransmits ? 2 : 0.5));
      if constexpr (kValue) x = Div<A>(d, x, visible);
    } else {
      x = hn::Mul(hn::Mul(x, kWide ? hn::Mul(oh, scale) : oh), kWide ? hn::Mul(hz, scale) : hz);
    }
    if constexpr (Dist::kHasExponent) x = ExpTimes<A>(d, log_high, log_low, x);
    pdf = ZeroIf(invalid, x);
  }
}

// RoughSurfacePass in double lanes; `radiance` as a number, 1 or 0.
template <class Dist, class Interface, Lobes kLobes, JointMasking kG, bool kValue, bool kPdf, Drawn kDrawn>
struct RoughSurfaceOp {
  template <class DD, class... In>
  static HWY_INLINE void Run(DD dd, Vec<DD>& value, Vec<DD>& pdf, Vec<DD> radiance, In... in) {
    hn::Mask<DD> none = hn::MaskFromVec(hn::Zero(dd));
    Vec<DD> c2, s2, s2_tail;
    value = pdf = hn::Zero(dd);
    RoughSurfacePass<Dist, Interface, kLobes, kG, kValue, kPdf, kDrawn, Accuracy::kStandard>(
        dd, hn::Gt(radiance, hn::Zero(dd)), value, pdf, none, FacetTerms<DD>{c2, s2, s2_tail}, in...);
  }
};

// Out of line: few lanes need it.
template <class Dist, class Interface, Lobes kLobes, JointMasking kG, bool kValue, bool kPdf, Drawn kDrawn,
          class D, class... In>
HWY_NOINLINE void RoughSurfaceInDouble(D d, hn::Mask<D> radiance, Vec<D>& value, Vec<D>& pdf, In... in) {
  InDouble2<RoughSurfaceOp<Dist, Interface, kLobes, kG, kValue, kPdf, kDrawn>>(
      d, value, pdf, hn::IfThenElseZero(radiance, Const(d, 1)), in...);
}

// RoughSurfacePass, then what it found hard in double lanes. q0 and q1: parameters of Interface, 0 where it
// has none.
template <class Dist, class Interface, Lobes kLobes, JointMasking kG, bool kValue, bool kPdf, Drawn kDrawn,
          Accuracy A, class D, class... P>
HWY_INLINE void RoughSurfaceOfBoth(D d, hn::Mask<D> radiance, Vec<D>& value, Vec<D>& pdf, Vec<D> ix,
                                   Vec<D> iy, Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz, Vec<D> q0,
                                   Vec<D> q1, P... p) {
  hn::Mask<D> hard = hn::MaskFromVec(hn::Zero(d));
  Vec<D> c2, s2, s2_tail;
  RoughSurfacePass<Dist, Interface, kLobes, kG, kValue, kPdf, kDrawn, A>(
      d, radiance, value, pdf, hard, FacetTerms<D>{c2, s2, s2_tail}, ix, iy, iz, ox, oy, oz, q0, q1, p...);
  if (kIsFloat<D> && HWY_UNLIKELY(!hn::AllFalse(d, hard))) {
    Vec<D> hard_value, hard_pdf;
    RoughSurfaceInDouble<Dist, Interface, kLobes, kG, kValue, kPdf, kDrawn>(
        d, radiance, hard_value, hard_pdf, ix, iy, iz, ox, oy, oz, q0, q1, p...);
    if constexpr (kValue) value = hn::IfThenElse(hard, hard_value, value);
    if constexpr (kPdf) pdf = hn::IfThenElse(hard, hard_pdf, pdf);
  }
}
template <class Dist, class Interface, Lobes kLobes, JointMasking kG, bool kValue, bool kPdf, Drawn kDrawn,
          Accuracy A, class D, class... P>
HWY_INLINE void RoughSurfaceOfOne(D d, hn::Mask<D> radiance, Vec<D>& value, Vec<D>& pdf, Vec<D> ix, Vec<D> iy,
                                  Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz, Vec<D> q0, P... p) {
  RoughSurfaceOfBoth<Dist, Interface, kLobes, kG, kValue, kPdf, kDrawn, A>(
      d, radiance, value, pdf, ix, iy, iz, ox, oy, oz, q0, hn::Zero(d), p...);
}

// f |cos o| into `value` if kValue, the density of o into `pdf` if kPdf. `radiance`: mask of
// Transport::kRadiance, of no effect in reflection. p: the parameters of Interface (DielectricInterface:
// eta), then the distribution's.
template <class Dist, class Interface, Lobes kLobes, JointMasking kG, bool kValue, bool kPdf, Drawn kDrawn,
          Accuracy A, class D, class... P>
HWY_INLINE void RoughSurface(D d, hn::Mask<D> radiance, Vec<D>& value, Vec<D>& pdf, Vec<D> ix, Vec<D> iy,
                             Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz, P... p) {
  if constexpr (Interface::kParameters == 0) {
    RoughSurfaceOfBoth<Dist, Interface, kLobes, kG, kValue, kPdf, kDrawn, A>(
        d, radiance, value, pdf, ix, iy, iz, ox, oy, oz, hn::Zero(d), hn::Zero(d), p...);
  } else if constexpr (Interface::kParameters == 1) {
    RoughSurfaceOfOne<Dist, Interface, kLobes, kG, kValue, kPdf, kDrawn, A>(d, radiance, value, pdf, ix, iy,
                                                                            iz, ox, oy, oz, p...);
  } else {
    RoughSurfaceOfBoth<Dist, Interface, kLobes, kG, kValue, kPdf, kDrawn, A>(d, radiance, value, pdf, ix, iy,
                                                                             iz, ox, oy, oz, p...);
  }
}

// One pass of sampling. `hard` as in RoughSurfacePass.
template <class Dist, class Interface, Lobes kLobes, JointMasking kG, Drawn kDrawn, Accuracy A, class D,
          class... P>
HWY_INLINE void SampleRoughSurfacePass(D d, hn::Mask<D> radiance, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz,
                                       Vec<D>& weight, Vec<D>& pdf, Vec<D>& lobe, hn::Mask<D>& hard,
                                       Vec<D> ix, Vec<D> iy, Vec<D> iz_signed, Vec<D> u1, Vec<D> u2,
                                       Vec<D> u3, Vec<D> q0, Vec<D> q1, P... p) {
  constexpr bool kWide = !kIsFloat<D>, kDielectric = std::is_same_v<Interface, DielectricInterface>;
  constexpr bool kVisible = kDrawn != Drawn::kNormals, kVCavity = kDrawn == Drawn::kVCavity;
  static_assert(kVCavity == (kG == JointMasking::kVCavity), "V-cavities show normals of their own");
  static_assert(kDielectric || kLobes == Lobes::kReflection, "opaque surfaces reflect alone");
  static_assert(kDrawn != Drawn::kBoundedVisible, "the smaller cap leaves out normals that refract");
  const Vec<D> zero = hn::Zero(d), one = Const(d, 1);
  const Vec<D> iz = hn::Abs(iz_signed);
  Vec<D> mx, my, mz, pdf_m;
  if constexpr (kVCavity) {
    SampleVCavityNormal<Dist, Care::kPlain, A>(d, mx, my, mz, pdf_m, ix, iy, iz_signed, u1, u2, u3, p...);
  } else if constexpr (kVisible) {
    Dist::template SampleVisibleNormal<false, A>(d, mx, my, mz, pdf_m, ix, iy, iz_signed, u1, u2, p...);
  } else {
    Dist::template SampleNormal<Care::kPlain, A>(d, mx, my, mz, pdf_m, u1, u2, p...);
  }
  // Below the surface the whole is turned over: m -> -m, then z -> -z.
  mx = FlipSign(d, mx, iz_signed);
  my = FlipSign(d, my, iz_signed);
  const Vec<D> c = Dot(ix, iy, iz, mx, my, mz);
  const Vec<D> eta = q0, eta2 = hn::Mul(eta, eta), k = EtaSquaredMinus1(d, eta);
  Vec<D> g2 = hn::MulAdd(c, c, k);
  if constexpr (!kWide) {
    hard = hn::Lt(kDielectric ? hn::Min(hn::Abs(g2), hn::Abs(c)) : hn::Abs(c), Const(d, 0x1p-12));
  }
  // A density of u1 near 0, or of a normal that is hardly visible, may be subnormal.
  if constexpr (!kWide && (Dist::kDensityOfCosine || kVisible))
    hard = hn::Or(hard, hn::Lt(pdf_m, Const(d, 0x1p-100)));
  g2 = hn::IfThenElse(hn::Lt(g2, zero), zero, g2);
  const Vec<D> g = Sqrt<A>(d, g2), root = hn::Mul(c, g);
  const Vec<D> s2 = hn::NegMulAdd(c, c, one);
  Vec<D> a, m;
  FresnelTerms<true>(d, a, m, hn::MulAdd(c, c, g2), root, s2);
  const Vec<D> q = hn::Mul(a, m), gc = hn::Add(g, c), eta_gc = hn::Mul(eta, gc);
  Vec<D> r, r_eta;  // 1/q and 1/(eta (g + c))
  if constexpr (kWide) {
    r = Reciprocal<A>(d, q);
    r_eta = Reciprocal<A>(d, eta_gc);
  } else {
    const Vec<D> both = Reciprocal<A>(d, hn::Mul(q, eta_gc));
    r = hn::Mul(both, eta_gc);
    r_eta = hn::Mul(both, q);
  }
  const Vec<D> kr = hn::Mul(k, r), kp = hn::Mul(kr, root), ks = hn::Mul(kr, s2);
  const Vec<D> reflectance = hn::Min(one, hn::MulAdd(kp, kp, hn::Mul(ks, ks)));
  const Vec<D> transmittance =
      hn::Mul(hn::Mul(hn::Mul(hn::Add(root, root), a), hn::MulAdd(eta, eta, hn::Mul(m, m))), hn::Mul(r, r));

  const auto transmits = hn::Ge(u3, reflectance);
  Vec<D> share = one;
  if constexpr (kDielectric) {
    share = OfLobe<kLobes>(transmits, transmittance, reflectance);
  } else if constexpr (!Interface::kReflectsAll) {
    share = Interface::template ReflectanceOfCosine<A>(d, c, q0, q1);
    if constexpr (!kWide) hard = hn::Or(hard, hn::Lt(share, Const(d, 0x1p-100)));
  }
  // o = s m - t i: s = 2 c, t = 1, or s = (c - g)/eta = -(eta^2 - 1)/(eta (c + g)), t = 1/eta.
  const Vec<D> s = OfLobe<kLobes>(transmits, hn::Neg(hn::Mul(k, r_eta)), hn::Add(c, c));
  const Vec<D> t = OfLobe<kLobes>(transmits, hn::Mul(gc, r_eta), one);
  ox = hn::MulSub(s, mx, hn::Mul(t, ix));
  oy = hn::MulSub(s, my, hn::Mul(t, iy));
  oz = hn::MulSub(s, mz, hn::Mul(t, iz));
  const Vec<D> zo = hn::Abs(oz);
  if constexpr (!kWide) hard = hn::Or(hard, hn::Lt(zo, Const(d, 0x1p-12)));
  const auto wrong_side = hn::Le(OfLobe<kLobes>(transmits, hn::Neg(oz), oz), zero);
  auto invalid = hn::Or(hn::Le(hn::Min(c, hn::Min(iz, mz)), zero), wrong_side);
  // Of the zero vector no normal is visible: c and m are NaN.
  if constexpr (kVisible) invalid = hn::Or(invalid, hn::Le(iz, zero));
  if constexpr (kLobes == Lobes::kTransmission) invalid = hn::Or(invalid, hn::Le(g2, zero));

  // weight = numerator / masking: c G/(|i.n| mz), or G2/G1(i) of visible normals, or |o.n|/c of Kelemen 2001.
  constexpr bool kKelemen = kG == JointMasking::kKelemen;
  Vec<D> numerator, masking, mu_o = one;
  if constexpr (!kVCavity && !kKelemen) mu_o = Dist::template Masking<Care::kPlain, A>(d, ox, oy, zo, p...);
  if constexpr (kVCavity) {
    const Vec<D> two_mz = hn::Add(mz, mz);
    masking = hn::Min(c, hn::Mul(two_mz, iz));
    numerator = hn::Min(masking, hn::Mul(two_mz, zo));
  } else if constexpr (kKelemen) {
    masking = c;
    numerator = zo;
  } else if constexpr (kVisible && kG == JointMasking::kSeparable) {
    numerator = hn::Add(zo, zo);
    masking = hn::Add(zo, mu_o);
  } else {
    const Vec<D> mu_i = Dist::template Masking<Care::kPlain, A>(d, ix, iy, iz, p...);
    masking = MaskingDenominator<kG>(iz, mu_i, zo, mu_o);
    if constexpr (kVisible) {
      numerator = hn::Mul(zo, hn::Add(iz, mu_i));
    } else {
      numerator =
          hn::Mul(hn::Mul(Const(d, kMaskingFactor<kG>), zo), c);  // NOLINT(google-readability-casting)
      masking = hn::Mul(mz, masking);
    }
  }
  // Radiance takes Eq. 41 as it is; importance loses the eta^2 of transmission.
  const Vec<D> lobe_factor = OfLobe<kLobes>(transmits, hn::IfThenElse(radiance, one, eta2), one);
  const Vec<D> denominator = hn::Mul(masking, lobe_factor);
  // Jacobians of Eqs. 14 and 17: 1/(4 c), and eta^2 (g/eta) / (c - g)^2 with c - g = -(eta^2 - 1)/(g + c).
  const Vec<D> jacobian_over = OfLobe<kLobes>(transmits, hn::Mul(hn::Mul(eta, g), hn::Mul(gc, gc)), one);
  const Vec<D> jacobian_under = OfLobe<kLobes>(transmits, hn::Mul(k, k), hn::Mul(Const(d, 4), c));
  if constexpr (kWide) {
    weight = Div<A>(d, numerator, denominator);
    pdf = hn::Mul(pdf_m, hn::Div(jacobian_over, jacobian_under));
  } else {
    const Vec<D> product = hn::Mul(denominator, jacobian_under);
    hard = hn::Or(hard, OutOfRange(d, hn::Abs(product), 0x1p-90f, 0x1p90f));
    const Vec<D> both = RefinedReciprocal<A>(d, product);
    weight = hn::Mul(numerator, hn::Mul(both, jacobian_under));
    pdf = hn::Mul(hn::Mul(pdf_m, jacobian_over), hn::Mul(both, denominator));
  }
  if constexpr (kLobes == Lobes::kBoth) {
    pdf = hn::Mul(pdf, share);
  } else {
    weight = hn::Mul(weight, share);
  }
  // Without an interface all facets refract straight on; the normal's density may have underflowed.
  if constexpr (kLobes != Lobes::kReflection) {
    pdf = hn::IfThenElse(hn::Eq(k, zero), Const(d, std::numeric_limits<double>::infinity()), pdf);
  }
  weight = ZeroIf(invalid, weight);
  pdf = ZeroIf(invalid, pdf);
  ox = ZeroIf(invalid, ox);
  oy = ZeroIf(invalid, oy);
  oz = ZeroIf(invalid, FlipSign(d, oz, iz_signed));
  lobe = ZeroIf(invalid, OfLobe<kLobes>(transmits, Const(d, 2), one));
}
// NOLINTEND(misc-const-correctness)

// SampleRoughSurfacePass in double lanes; `radiance` as a number, 1 or 0.
template <class Dist, class Interface, Lobes kLobes, JointMasking kG, Drawn kDrawn>
struct SampleRoughSurfaceOp {
  template <class DD, class... In>
  static HWY_INLINE void Run(DD dd, Vec<DD>& ox, Vec<DD>& oy, Vec<DD>& oz, Vec<DD>& weight, Vec<DD>& pdf,
                             Vec<DD>& lobe, Vec<DD> radiance, In... in) {
    hn::Mask<DD> none = hn::MaskFromVec(hn::Zero(dd));
    SampleRoughSurfacePass<Dist, Interface, kLobes, kG, kDrawn, Accuracy::kStandard>(
        dd, hn::Gt(radiance, hn::Zero(dd)), ox, oy, oz, weight, pdf, lobe, none, in...);
  }
};

// Out of line: few lanes need it.
template <class Dist, class Interface, Lobes kLobes, JointMasking kG, Drawn kDrawn, class D, class... In>
HWY_NOINLINE void SampleRoughSurfaceInDouble(D d, hn::Mask<D> radiance, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz,
                                             Vec<D>& weight, Vec<D>& pdf, Vec<D>& lobe, In... in) {
  InDouble6<SampleRoughSurfaceOp<Dist, Interface, kLobes, kG, kDrawn>>(
      d, ox, oy, oz, weight, pdf, lobe, hn::IfThenElseZero(radiance, Const(d, 1)), in...);
}

// SampleRoughSurfacePass, then what it found hard in double lanes. q0 and q1 as in RoughSurfaceOfBoth.
template <class Dist, class Interface, Lobes kLobes, JointMasking kG, Drawn kDrawn, Accuracy A, class D,
          class... P>
HWY_INLINE void SampleRoughSurfaceOfBoth(D d, hn::Mask<D> radiance, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz,
                                         Vec<D>& weight, Vec<D>& pdf, Vec<D>& lobe, Vec<D> ix, Vec<D> iy,
                                         Vec<D> iz, Vec<D> u1, Vec<D> u2, Vec<D> u3, Vec<D> q0, Vec<D> q1,
                                         P... p) {
  hn::Mask<D> hard = hn::MaskFromVec(hn::Zero(d));
  SampleRoughSurfacePass<Dist, Interface, kLobes, kG, kDrawn, A>(d, radiance, ox, oy, oz, weight, pdf, lobe,
                                                                 hard, ix, iy, iz, u1, u2, u3, q0, q1, p...);
  if (kIsFloat<D> && HWY_UNLIKELY(!hn::AllFalse(d, hard))) {
    Vec<D> ox_, oy_, oz_, weight_, pdf_, lobe_;
    SampleRoughSurfaceInDouble<Dist, Interface, kLobes, kG, kDrawn>(
        d, radiance, ox_, oy_, oz_, weight_, pdf_, lobe_, ix, iy, iz, u1, u2, u3, q0, q1, p...);
    ox = hn::IfThenElse(hard, ox_, ox);
    oy = hn::IfThenElse(hard, oy_, oy);
    oz = hn::IfThenElse(hard, oz_, oz);
    weight = hn::IfThenElse(hard, weight_, weight);
    pdf = hn::IfThenElse(hard, pdf_, pdf);
    lobe = hn::IfThenElse(hard, lobe_, lobe);
  }
}
template <class Dist, class Interface, Lobes kLobes, JointMasking kG, Drawn kDrawn, Accuracy A, class D,
          class... P>
HWY_INLINE void SampleRoughSurfaceOfOne(D d, hn::Mask<D> radiance, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz,
                                        Vec<D>& weight, Vec<D>& pdf, Vec<D>& lobe, Vec<D> ix, Vec<D> iy,
                                        Vec<D> iz, Vec<D> u1, Vec<D> u2, Vec<D> u3, Vec<D> q0, P... p) {
  SampleRoughSurfaceOfBoth<Dist, Interface, kLobes, kG, kDrawn, A>(
      d, radiance, ox, oy, oz, weight, pdf, lobe, ix, iy, iz, u1, u2, u3, q0, hn::Zero(d), p...);
}

// Walter 2007 section 5.3: m by Dist's D cos or visible sampling, o by Eq. 39 or 40, the weight by Eq. 41.
// With both lobes u3 chooses by Fresnel, else the weight carries F or 1 - F and u3 has no effect, but that of
// V-cavities chooses their facet. p: the parameters of Interface, then the distribution's.
template <class Dist, class Interface, Lobes kLobes, JointMasking kG, Drawn kDrawn, Accuracy A, class D,
          class... P>
HWY_INLINE void SampleRoughSurface(D d, hn::Mask<D> radiance, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz,
                                   Vec<D>& weight, Vec<D>& pdf, Vec<D>& lobe, Vec<D> ix, Vec<D> iy, Vec<D> iz,
                                   Vec<D> u1, Vec<D> u2, Vec<D> u3, P... p) {
  if constexpr (Interface::kParameters == 0) {
    SampleRoughSurfaceOfBoth<Dist, Interface, kLobes, kG, kDrawn, A>(
        d, radiance, ox, oy, oz, weight, pdf, lobe, ix, iy, iz, u1, u2, u3, hn::Zero(d), hn::Zero(d), p...);
  } else if constexpr (Interface::kParameters == 1) {
    SampleRoughSurfaceOfOne<Dist, Interface, kLobes, kG, kDrawn, A>(d, radiance, ox, oy, oz, weight, pdf,
                                                                    lobe, ix, iy, iz, u1, u2, u3, p...);
  } else {
    SampleRoughSurfaceOfBoth<Dist, Interface, kLobes, kG, kDrawn, A>(d, radiance, ox, oy, oz, weight, pdf,
                                                                     lobe, ix, iy, iz, u1, u2, u3, p...);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_ROUGH_DIELECTRIC_INL_H_
