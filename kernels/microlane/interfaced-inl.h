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
#include "microlane/rough_reflector-inl.h"

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

  // T is in proportion to cosines below 2^-64, of which few bits are left unscaled.
  template <Accuracy A, class D>
  static HWY_INLINE void TransmittanceOfScaled(D d, Vec<D>& numerator, Vec<D>& denominator, Vec<D> scaled,
                                               Vec<D> k, Vec<D> n2) {
    const Vec<D> tiny = Const(d, 0x1p-64), c = hn::Mul(scaled, Const(d, 0x1p-40));
    Transmittance<A>(d, numerator, denominator, hn::Max(c, tiny), k, n2);
    const auto small = hn::And(hn::Lt(c, tiny), hn::Gt(k, hn::Zero(d)));
    const Vec<D> part = hn::Mul(numerator, hn::Mul(scaled, Const(d, 0x1p24)));
    numerator = hn::IfThenElse(small, part, numerator);
  }

  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> TimesOver(D d, Vec<D> x, Vec<D> y, Vec<D> a, Vec<D> b, Vec<D> k, Vec<D> n2,
                                     Vec<D> albedo) {
    Vec<D> of_i, under_i, of_o, under_o;
    TransmittanceOfScaled<A>(d, of_i, under_i, a, k, n2);
    TransmittanceOfScaled<A>(d, of_o, under_o, b, k, n2);
    // Both are times 2^24 and become times 2^30: small cosines do not underflow together.
    const Vec<D> unit = Const(d, 0x1p6);
    const Vec<D> scaled =
        Div<A>(d, hn::Mul(hn::Mul(hn::Mul(x, albedo), hn::Mul(of_i, unit)), hn::Mul(of_o, unit)),
               hn::Mul(y, hn::Mul(under_i, under_o)));
    return hn::Mul(scaled, Const(d, 0x1p-60));
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

// f |cos(theta_o)| of the bodies of several channels, Meneveaux 2015 Eq. 12: one sum over the normals.
// parameter(c, 0) gives channel c's k, store(c, f) takes its value.
template <class Dist, class Radius, JointMasking kG, Accuracy A, class D, class Parameter, class Store>
HWY_INLINE void InterfacedBodiesOf(D d, const QuadratureRule& rule, std::size_t channels,
                                   const Parameter& parameter, const Store& store, Vec<D> ix, Vec<D> iy,
                                   Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz, Vec<D> alpha_x, Vec<D> alpha_y,
                                   Vec<D> n_i) {
  const Vec<D> index = Clamped(d, n_i, 1, 4);
  const Vec<D> white = RoughDiffuse<Dist, Radius, InterfacedFacets, kG, A>(
      d, rule, ix, iy, iz, ox, oy, oz, alpha_x, alpha_y, EtaSquaredMinus1(d, index), hn::Mul(index, index));
  for (std::size_t channel = 0; channel < channels; ++channel) {
    Vec<D> albedo, unused;
    Precisely<BodyAlbedoOp, A>(d, albedo, unused, n_i, parameter(channel, 0));
    store(channel, hn::Mul(white, albedo));
  }
}
template <class Dist, class Radius, JointMasking kG, Accuracy A, class D>
HWY_INLINE Vec<D> InterfacedBody(D d, const QuadratureRule& rule, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox,
                                 Vec<D> oy, Vec<D> oz, Vec<D> alpha_x, Vec<D> alpha_y, Vec<D> n_i, Vec<D> k) {
  Vec<D> value = hn::Zero(d);
  InterfacedBodiesOf<Dist, Radius, kG, A>(
      d, rule, 1, [&](std::size_t, std::size_t) HWY_ATTR { return k; },
      [&](std::size_t, Vec<D> of_channel) HWY_ATTR { value = of_channel; }, ix, iy, iz, ox, oy, oz, alpha_x,
      alpha_y, n_i);
  return value;
}

// The same about one normal.
template <class Dist, JointMasking kG, bool kVisible, Accuracy A, class D>
HWY_INLINE Vec<D> InterfacedOneNormal(D d, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz,
                                      Vec<D> mx, Vec<D> my, Vec<D> mz, Vec<D> alpha_x, Vec<D> alpha_y,
                                      Vec<D> n_i, Vec<D> k) {
  Vec<D> albedo, unused;
  Precisely<BodyAlbedoOp, A>(d, albedo, unused, n_i, k);
  const Vec<D> index = Clamped(d, n_i, 1, 4);
  return OneNormal<Dist, InterfacedFacets, kG, kVisible, A>(d, ix, iy, iz, ox, oy, oz, mx, my, mz, alpha_x,
                                                            alpha_y, EtaSquaredMinus1(d, index),
                                                            hn::Mul(index, index), albedo);
}

// R_s/(R_s + R_b) and R_b/(R_s + R_b) of a flat surface (Meneveaux 2015 section 4), R_s = r_e and R_b = (1 -
// r_e)^2 k/(n^2 (1 - k r_i)); 0 and 1 where r_e is 0.
struct InterfaceShareOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& surface, Vec<D>& body, Vec<D> n_i, Vec<D> k) {
    Vec<D> albedo, r_e, unused;
    BodyAlbedoOp::Run<A>(d, albedo, unused, n_i, k);
    DiffuseFresnelOp<DiffuseSide::kExternal>::template Run<A>(d, r_e, unused, Clamped(d, n_i, 1, 4));
    const Vec<D> one = Const(d, 1), through = hn::Sub(one, r_e);
    const Vec<D> r_b = hn::Mul(hn::Mul(through, through), albedo), sum = hn::Add(r_e, r_b);
    const auto none = hn::Eq(r_e, hn::Zero(d));
    surface = ZeroIf(none, RefinedDiv<A>(d, r_e, sum));
    body = hn::IfThenElse(none, one, RefinedDiv<A>(d, r_b, sum));
  }
};

// Density of directions from the interface's visible normals or, as InterfaceShareOp has it, from the cosine.
template <class Dist, Accuracy A, class D>
HWY_INLINE Vec<D> PdfWithInterface(D d, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz,
                                   Vec<D> alpha_x, Vec<D> alpha_y, Vec<D> n_i, Vec<D> k) {
  const Vec<D> zero = hn::Zero(d);
  Vec<D> surface, body, pdf;
  Precisely<InterfaceShareOp, A>(d, surface, body, n_i, k);
  RoughSurface<Dist, MirrorFacets, Lobes::kReflection, JointMasking::kHeightCorrelated, false, true,
               Drawn::kVisible, A>(d, hn::MaskFromVec(zero), pdf, pdf, ix, iy, iz, ox, oy, oz, alpha_x,
                                   alpha_y);
  const Vec<D> zo = FlipSign(d, oz, iz), cosine = hn::Mul(zo, Const(d, 1 / kPi));
  const auto outside = hn::Or(hn::Eq(iz, zero), hn::Le(zo, zero));
  return ZeroIf(outside, hn::MulAdd(surface, pdf, hn::Mul(body, cosine)));
}

// wo from the interface or the body, in double lanes; weight: f |cos(theta_o)| of both over pdf, the body's
// by the visible normal of u4 and u5.
template <class Dist, JointMasking kG, class DD>
HWY_INLINE void SampleWithInterfacePass(DD dd, Vec<DD>& ox, Vec<DD>& oy, Vec<DD>& oz, Vec<DD>& weight,
                                        Vec<DD>& pdf, Vec<DD>& lobe, Vec<DD> ix, Vec<DD> iy, Vec<DD> side,
                                        Vec<DD> u1, Vec<DD> u2, Vec<DD> u3, Vec<DD> u4, Vec<DD> u5,
                                        Vec<DD> alpha_x, Vec<DD> alpha_y, Vec<DD> n_i, Vec<DD> k) {
  constexpr Accuracy kStandard = Accuracy::kStandard;
  const Vec<DD> zero = hn::Zero(dd), one = Const(dd, 1), iz = hn::Abs(side);
  Vec<DD> surface, body, mx, my, mz, unused;
  InterfaceShareOp::Run<kStandard>(dd, surface, body, n_i, k);
  SampleVisibleNormal<Dist, false, kStandard>(dd, mx, my, mz, unused, ix, iy, iz, u1, u2, alpha_x, alpha_y);
  Reflect(dd, ox, oy, oz, ix, iy, iz, mx, my, mz);
  const auto specular = hn::Lt(u3, surface);
  const Vec<DD> u = BelowOne(dd, u1), sine = hn::Sqrt(u);
  Vec<DD> sin_phi, cos_phi;
  SinCos2Pi<kStandard>(dd, u2, sin_phi, cos_phi);
  ox = hn::IfThenElse(specular, ox, hn::Mul(sine, cos_phi));
  oy = hn::IfThenElse(specular, oy, hn::Mul(sine, sin_phi));
  oz = hn::IfThenElse(specular, oz, hn::Sqrt(hn::Sub(one, u)));

  Vec<DD> of_surface, of_body;
  pdf = PdfWithInterface<Dist, kStandard>(dd, ix, iy, iz, ox, oy, oz, alpha_x, alpha_y, n_i, k);
  RoughSurface<Dist, DielectricInterface, Lobes::kReflection, kG, true, false, Drawn::kNormals, kStandard>(
      dd, hn::MaskFromVec(zero), of_surface, unused, ix, iy, iz, ox, oy, oz, Clamped(dd, n_i, 1, 4), alpha_x,
      alpha_y);
  SampleVisibleNormal<Dist, false, kStandard>(dd, mx, my, mz, unused, ix, iy, iz, u4, u5, alpha_x, alpha_y);
  of_body = InterfacedOneNormal<Dist, kG, true, kStandard>(dd, ix, iy, iz, ox, oy, oz, mx, my, mz, alpha_x,
                                                           alpha_y, n_i, k);
  weight = hn::Div(hn::Add(of_surface, of_body), pdf);
  const auto drawn = hn::And(hn::Gt(iz, zero), hn::Gt(hn::Min(oz, pdf), zero));
  lobe = hn::IfThenElseZero(drawn, hn::IfThenElse(specular, one, Const(dd, 2)));
  weight = hn::IfThenElseZero(drawn, weight);
  pdf = hn::IfThenElseZero(drawn, pdf);
  ox = hn::IfThenElseZero(drawn, ox);
  oy = hn::IfThenElseZero(drawn, oy);
  oz = hn::IfThenElseZero(drawn, FlipSign(dd, oz, side));
}

// SampleWithInterfacePass of lanes of any kind, rounded once. in: wi, u1 to u5, the parameters; out: wo,
// weight, pdf, lobe.
template <class Dist, JointMasking kG, class D>
HWY_NOINLINE void SampleWithInterface(D d, const T<D> (*in)[hn::MaxLanes(D())],
                                      T<D> (*out)[hn::MaxLanes(D())]) {
  const HalfInDouble<D> dd;
  for (std::size_t lane = 0; lane < hn::Lanes(d); lane += hn::Lanes(dd)) {
    const auto load = [&](std::size_t i) HWY_ATTR { return LoadWide(dd, in[i] + lane); };
    Vec<decltype(dd)> ox, oy, oz, weight, pdf, lobe;
    SampleWithInterfacePass<Dist, kG>(dd, ox, oy, oz, weight, pdf, lobe, load(0), load(1), load(2), load(3),
                                      load(4), load(5), load(6), load(7), load(8), load(9), load(10),
                                      load(11));
    StoreNarrow(dd, ox, out[0] + lane);
    StoreNarrow(dd, oy, out[1] + lane);
    StoreNarrow(dd, oz, out[2] + lane);
    StoreNarrow(dd, weight, out[3] + lane);
    StoreNarrow(dd, pdf, out[4] + lane);
    StoreNarrow(dd, lobe, out[5] + lane);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_INTERFACED_INL_H_
