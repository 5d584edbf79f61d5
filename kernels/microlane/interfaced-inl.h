// The body under smooth interfaces in lanes (Meneveaux 2015): a Lambertian of albedo k, reached and left
// through an interface of index n, with all light that goes back and forth between the two.
#if defined(MICROLANE_INTERFACED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_INTERFACED_INL_H_
#undef MICROLANE_INTERFACED_INL_H_
#else
#define MICROLANE_INTERFACED_INL_H_
#endif

#include "microlane/fresnel-inl.h"
#include "microlane/rough_diffuse-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// k/(n^2 (1 - k r_i)) of Meneveaux 2015 Eq. 8, as k/(n^2 (1 - k) + k (1 - r_e)), where nothing cancels.
struct BodyAlbedoOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& out, Vec<D>& unused, Vec<D> n_i, Vec<D> k) {
    const Vec<D> one = Const(d, 1);
    n_i = Clamped(d, n_i, 1, 4);
    k = Clamped(d, k, 0, 1);
    Vec<D> external, also_unused;
    DiffuseFresnelOp<DiffuseSide::kExternal>::template Run<A>(d, external, also_unused, n_i);
    const Vec<D> absorbed = hn::Mul(hn::Mul(n_i, n_i), hn::Sub(one, k));
    out = unused = RefinedDiv<A>(d, k, hn::MulAdd(k, hn::Sub(one, external), absorbed));
  }
};

// The body of one facet, Meneveaux 2015 Eq. 8.
struct FacetBodyOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& out, Vec<D>& unused, Vec<D> cos_i, Vec<D> cos_o, Vec<D> n_i,
                             Vec<D> k) {
    using Transmittance = FresnelOp<FresnelPart::kTransmittance>;
    const Vec<D> zero = hn::Zero(d), index = Clamped(d, n_i, 1, 4);
    Vec<D> albedo, also_unused;
    BodyAlbedoOp::Run<A>(d, albedo, also_unused, n_i, k);
    const Vec<D> both = hn::Mul(Transmittance::template Of<A>(d, cos_i, index),
                                Transmittance::template Of<A>(d, cos_o, index));
    const auto outside = hn::Or(hn::Le(cos_i, zero), hn::Le(cos_o, zero));
    out = unused = ZeroIf(outside, hn::Mul(hn::Mul(both, Const(d, 1 / kPi)), albedo));
  }
};

// Interfaced facets for the sums of RoughDiffuse, s = T(wi.m) T(wo.m), of k = n^2 - 1 and n2 = n^2. With c
// the cosine, g^2 = k + c^2 and p = c g,
//   T = 2 p (n^2 + (p + 1 - c^2)^2) / ((k + 2 (c^2 + p)) (p + 1 - c^2)^2)
// (see fresnel-inl.h), which needs one root; both T and the rest share one division, which is all that is
// approximate in kFast: T takes every error of c and g once more.
struct InterfacedFacets {
  // Numerators times 2^24: two of them and grazing cosines do not underflow together.
  static constexpr double kScale = 0x1p-48;

  template <Accuracy A, class D>
  static HWY_INLINE void Transmittance(D d, Vec<D>& numerator, Vec<D>& denominator, Vec<D> c, Vec<D> k,
                                       Vec<D> n2) {
    const Vec<D> one = Const(d, 1), unit = Const(d, 0x1p24);
    const Vec<D> root = CloseSqrt<A>(d, hn::MulAdd(c, c, k)), p = hn::Mul(c, root);
    const Vec<D> m = hn::MulAdd(c, root, hn::NegMulAdd(c, c, one)), m2 = hn::Mul(m, m);
    const auto none = hn::Eq(k, hn::Zero(d));
    numerator = hn::IfThenElse(none, unit, hn::Mul(hn::Mul(p, Const(d, 0x1p25)), hn::MulAdd(m, m, n2)));
    denominator = hn::IfThenElse(none, one, hn::Mul(hn::MulAdd(Const(d, 2), hn::MulAdd(c, c, p), k), m2));
  }

  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> Add(D d, Vec<D> sum, Vec<D> x, Vec<D> m2, Vec<D> a, Vec<D> b, Vec<D> k,
                               Vec<D> n2) {
    return AddOver<A>(d, sum, x, Const(d, 1), m2, a, b, k, n2);
  }

  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> AddOver(D d, Vec<D> sum, Vec<D> x, Vec<D> y, Vec<D> m2, Vec<D> a, Vec<D> b,
                                   Vec<D> k, Vec<D> n2) {
    Vec<D> inverse, of_i, under_i, of_o, under_o;
    if constexpr (A == Accuracy::kFast) {
      inverse = RefinedReciprocalSqrt(d, m2);
    } else {
      inverse = hn::Div(Const(d, 1), hn::Sqrt(m2));
    }
    Transmittance<A>(d, of_i, under_i, hn::Mul(a, inverse), k, n2);
    Transmittance<A>(d, of_o, under_o, hn::Mul(b, inverse), k, n2);
    const Vec<D> numerator = hn::Mul(hn::Mul(hn::Mul(x, inverse), of_i), of_o);
    const Vec<D> denominator = hn::Mul(y, hn::Mul(under_i, under_o));
    if constexpr (A == Accuracy::kFast) {
      return hn::MulAdd(numerator, FastReciprocal(d, denominator), sum);
    } else {
      return hn::Add(sum, hn::Div(numerator, denominator));
    }
  }
};

// f |cos(theta_o)| of the body, Meneveaux 2015 Eq. 12.
template <class Dist, class Radius, JointMasking kG, Accuracy A, class D>
HWY_INLINE Vec<D> InterfacedBody(D d, const QuadratureRule& rule, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox,
                                 Vec<D> oy, Vec<D> oz, Vec<D> alpha_x, Vec<D> alpha_y, Vec<D> n_i, Vec<D> k) {
  Vec<D> albedo, unused;
  Precisely<BodyAlbedoOp, A>(d, albedo, unused, n_i, k);
  const Vec<D> index = Clamped(d, n_i, 1, 4);
  const Vec<D> white = RoughDiffuse<Dist, Radius, InterfacedFacets, kG, A>(
      d, rule, ix, iy, iz, ox, oy, oz, alpha_x, alpha_y, EtaSquaredMinus1(d, index), hn::Mul(index, index));
  return hn::Mul(white, albedo);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_INTERFACED_INL_H_
