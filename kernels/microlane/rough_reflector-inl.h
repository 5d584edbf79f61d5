// Facets of opaque rough surfaces in lanes, for RoughSurface and SampleRoughSurface with Lobes::kReflection:
// Walter 2007 Eq. 20 with the Fresnel factors of conductor-inl.h.
#if defined(MICROLANE_ROUGH_REFLECTOR_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_ROUGH_REFLECTOR_INL_H_
#undef MICROLANE_ROUGH_REFLECTOR_INL_H_
#else
#define MICROLANE_ROUGH_REFLECTOR_INL_H_
#endif

#include <cstddef>

#include "microlane/conductor-inl.h"
#include "microlane/rough_dielectric-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// NOLINTBEGIN(misc-const-correctness): what one instantiation leaves alone, another assigns.
struct MirrorFacets {
  static constexpr std::size_t kParameters = 0;
  static constexpr bool kReflectsAll = true, kHasG = false;
};

// F of a conductor of index n + i kappa, from squares times `norm`, as conductor-inl.h has it.
struct ConductorFacets {
  static constexpr std::size_t kParameters = 2;
  static constexpr bool kReflectsAll = false, kHasG = true;

  // F = |g^2 - c^2|^2 N / (A^2 M^2); g2 is n^2 - s^2, and 2 n kappa times norm `twice`.
  template <Accuracy A, class D>
  static HWY_INLINE void Terms(D d, Vec<D>& big_n, Vec<D>& a, Vec<D>& m2, Vec<D>& twice, hn::Mask<D>& hard,
                               Vec<D> c2, Vec<D> s2, Vec<D> g2, Vec<D> norm, Vec<D> n, Vec<D> kappa) {
    constexpr bool kInFloat = kIsFloat<D>, kFast = A == Accuracy::kFast;
    const Vec<D> zero = hn::Zero(d), kappa_norm = hn::Mul(kappa, norm);
    // Where n^2 - s^2 and kappa^2 cancel, 2 n kappa is the greater part of R.
    const Vec<D> t = hn::NegMulAdd(kappa, kappa_norm, g2);
    twice = hn::Mul(hn::Add(n, n), kappa_norm);
    Vec<D> r2 = hn::MulAdd(t, t, hn::Mul(twice, twice));
    if constexpr (kFast) r2 = hn::Max(r2, Const(d, 1e-30));
    const Vec<D> r = SqrtOfPositive<A>(d, r2);
    if constexpr (kInFloat) {
      // The error of g^2 reaches F divided by c g.
      constexpr double kLeast = kFast ? 0x1p-10 : 0x1p-19;
      hard = hn::Or(hard, hn::Lt(hn::Abs(hn::Mul(c2, r)), Const(d, kLeast)));
    }
    // (2 a c)^2 = 2 c^2 (R + t), where that cancels 2 c^2 (2 n kappa)^2 / (R - t).
    const Vec<D> sum = hn::Add(r, hn::Abs(t));
    const Vec<D> part = hn::IfThenElse(hn::Lt(t, zero), hn::Mul(twice, Div<A>(d, twice, sum)), sum);
    Vec<D> square = hn::Mul(hn::Add(c2, c2), part);
    square = hn::Max(kFast ? Const(d, 1e-30) : zero, square);
    const Vec<D> two_ac = SqrtOfPositive<A>(d, square);
    big_n = hn::MulAdd(r, c2, hn::Mul(s2, s2));
    m2 = hn::MulAdd(two_ac, s2, big_n);
    a = hn::Add(hn::Add(r, c2), two_ac);
    if constexpr (!kInFloat) a = hn::Max(a, Const(d, 1e-280));
  }

  // F = f / (A^2 M^2).
  template <Accuracy A, class D>
  static HWY_INLINE void Reflectance(D d, Vec<D>& f, Vec<D>& a, Vec<D>& m2, hn::Mask<D>& hard, Vec<D> c2,
                                     Vec<D> s2, Vec<D>, Vec<D> g2, Vec<D> norm, Vec<D> n, Vec<D> kappa) {
    Vec<D> big_n, twice;
    Terms<A>(d, big_n, a, m2, twice, hard, c2, s2, g2, norm, n, kappa);
    // |g^2 - c^2|^2 = (n^2 - 1 - kappa^2)^2 + (2 n kappa)^2: where the difference cancels, the other is
    // greater.
    const Vec<D> real = hn::Mul(hn::NegMulAdd(kappa, kappa, FusedMulSub(d, n, n, Const(d, 1))), norm);
    f = hn::Mul(hn::MulAdd(real, real, hn::Mul(twice, twice)), big_n);
  }

  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> ReflectanceOfCosine(D d, Vec<D> c, Vec<D> n, Vec<D> kappa) {
    return FresnelConductor<A>(d, c, n, kappa);
  }
};

// Schlick's F = f0 + (1 - f0) (1 - c)^5 with 1 - c = s^2 / (1 + c).
struct SchlickFacets {
  static constexpr std::size_t kParameters = 1;  // f0
  static constexpr bool kReflectsAll = false, kHasG = false;

  // F = f / (A^2 M^2) = (f0 A^2 M^2 + (1 - f0) s^10) / (norm (1 + c))^5.
  template <Accuracy A, class D>
  static HWY_INLINE void Reflectance(D d, Vec<D>& f, Vec<D>& a, Vec<D>& m2, hn::Mask<D>& hard, Vec<D> c2,
                                     Vec<D> s2, Vec<D> s2_tail, Vec<D>, Vec<D> norm, Vec<D> f0, Vec<D>) {
    constexpr bool kCompensated = kIsFloat<D> && A != Accuracy::kFast;
    const Vec<D> zero = hn::Zero(d), five = Const(d, 5);
    const Vec<D> product = hn::Mul(c2, norm);
    const Vec<D> root = SqrtOfPositive<A>(d, hn::Max(A == Accuracy::kFast ? Const(d, 1e-30) : zero, product));
    const Vec<D> q = hn::Add(norm, root), s4 = hn::Mul(s2, s2);
    Vec<D> s = s2;
    a = hn::Mul(q, q);
    m2 = q;
    if constexpr (kCompensated) {
      // Fifth powers magnify what q and s^2 have lost.
      m2 = hn::MulAdd(five, hn::Add(hn::Sub(norm, q), root), q);
      s = hn::MulAdd(five, s2_tail, s2);
    }
    const Vec<D> power = hn::Max(zero, hn::Mul(hn::Mul(s4, s4), s));
    f = hn::MulAdd(f0, hn::Mul(hn::Mul(a, a), m2), hn::NegMulAdd(f0, power, power));
    // Without f0, F is a fifth power of the s^2 left of 1 - c^2.
    if constexpr (kIsFloat<D> && !kCompensated) hard = hn::Or(hard, hn::Lt(f, Const(d, 0x1p-30)));
  }

  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> ReflectanceOfCosine(D d, Vec<D> c, Vec<D> f0, Vec<D>) {
    return FresnelSchlick<A>(d, c, f0);
  }
};

// Reflection about a visible normal m, its density, and the weight F G2/G1(i). p: the parameters of Facets,
// then the distribution's.
template <class Dist, class Facets, JointMasking kG, Accuracy A, class D, class... P>
HWY_INLINE void SampleVisibleOfBoth(D d, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz, Vec<D>& weight, Vec<D>& pdf,
                                    Vec<D>& lobe, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> u1, Vec<D> u2,
                                    Vec<D> q0, Vec<D> q1, P... p) {
  Vec<D> cos2;
  Dist::template SampleVisibleReflection<false, kG, A>(d, ox, oy, oz, weight, pdf, lobe, cos2, ix, iy, iz, u1,
                                                       u2, p...);
  if constexpr (!Facets::kReflectsAll) {
    weight = hn::Mul(weight, Facets::template ReflectanceOfCosine<A>(d, Sqrt<A>(d, cos2), q0, q1));
  }
}
template <class Dist, class Facets, JointMasking kG, Accuracy A, class D, class... P>
HWY_INLINE void SampleVisibleOfOne(D d, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz, Vec<D>& weight, Vec<D>& pdf,
                                   Vec<D>& lobe, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> u1, Vec<D> u2,
                                   Vec<D> q0, P... p) {
  SampleVisibleOfBoth<Dist, Facets, kG, A>(d, ox, oy, oz, weight, pdf, lobe, ix, iy, iz, u1, u2, q0,
                                           hn::Zero(d), p...);
}
template <class Dist, class Facets, JointMasking kG, Accuracy A, class D, class... P>
HWY_INLINE void SampleVisible(D d, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz, Vec<D>& weight, Vec<D>& pdf,
                              Vec<D>& lobe, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> u1, Vec<D> u2, P... p) {
  if constexpr (Facets::kParameters == 0) {
    SampleVisibleOfBoth<Dist, Facets, kG, A>(d, ox, oy, oz, weight, pdf, lobe, ix, iy, iz, u1, u2,
                                             hn::Zero(d), hn::Zero(d), p...);
  } else if constexpr (Facets::kParameters == 1) {
    SampleVisibleOfOne<Dist, Facets, kG, A>(d, ox, oy, oz, weight, pdf, lobe, ix, iy, iz, u1, u2, p...);
  } else {
    SampleVisibleOfBoth<Dist, Facets, kG, A>(d, ox, oy, oz, weight, pdf, lobe, ix, iy, iz, u1, u2, p...);
  }
}

// f |cos o| of several channels, float lanes: D and G2 once, F for each. parameter(c, k) gives parameter k of
// channel c's Facets, store(c, f) takes its value. p: the distribution's parameters. Not for kHigh.
template <class Dist, class Facets, JointMasking kG, Accuracy A, class D, class Parameter, class Store,
          class... P>
HWY_INLINE void RoughReflectorChannels(D d, std::size_t channels, const Parameter& parameter,
                                       const Store& store, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox,
                                       Vec<D> oy, Vec<D> oz, P... p) {
  static_assert(kIsFloat<D> && A != Accuracy::kHigh, "others go channel by channel");
  const Vec<D> zero = hn::Zero(d), one = Const(d, 1);
  const auto none = hn::MaskFromVec(zero);
  Vec<D> mirror, unused, c2, s2, s2_tail;
  hn::Mask<D> hard_mirror = none;
  RoughSurfacePass<Dist, MirrorFacets, Lobes::kReflection, kG, true, false, Drawn::kNormals, A>(
      d, none, mirror, unused, hard_mirror, FacetTerms<D>{c2, s2, s2_tail}, ix, iy, iz, ox, oy, oz, zero,
      zero, p...);
  for (std::size_t channel = 0; channel < channels; ++channel) {
    const Vec<D> q0 = parameter(channel, 0);
    Vec<D> q1 = zero, g2 = zero, f, a, m2;
    if constexpr (Facets::kParameters > 1) q1 = parameter(channel, 1);
    if constexpr (Facets::kHasG) g2 = hn::Sub(FusedMulSub(d, q0, q0, s2), s2_tail);
    hn::Mask<D> hard = hard_mirror;
    Facets::template Reflectance<A>(d, f, a, m2, hard, c2, s2, s2_tail, g2, one, q0, q1);
    hard = hn::Or(hard, hn::Lt(f, Const(d, 0x1p-42)));
    Vec<D> value = hn::Mul(mirror, Div<A>(d, f, hn::Mul(hn::Mul(a, a), m2)));
    if (HWY_UNLIKELY(!hn::AllFalse(d, hard))) {
      Vec<D> in_double;
      RoughSurfaceInDouble<Dist, Facets, Lobes::kReflection, kG, true, false, Drawn::kNormals>(
          d, none, in_double, unused, ix, iy, iz, ox, oy, oz, q0, q1, p...);
      value = hn::IfThenElse(hard, in_double, value);
    }
    store(channel, value);
  }
}
// NOLINTEND(misc-const-correctness)

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_ROUGH_REFLECTOR_INL_H_
