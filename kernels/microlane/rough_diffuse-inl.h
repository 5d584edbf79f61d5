// Facets that scatter light (Heitz 2014 Eq. 31, Meneveaux 2015 Eq. 12) in lanes, over a distribution of
// normals and its radius, by the nodes of quadrature.h.
//
// With U = (x, y, 1) of a slope (x, y) of unit roughness, A = (alpha_x wi.x, alpha_y wi.y, |wi.z|) and B of
// wo likewise, wi.m = A.U / |M|, M = (alpha_x x, alpha_y y, 1), and D(m) dm = |M| P(x, y) dx dy, so that
//   f |cos(theta_o)| = G2 / (pi |wi.z|) Int max(0, A.U) max(0, B.U) / |M| s P dx dy,
// where s of (wi.m, wo.m) is what the facets make of it, 1 of white Lambertian ones.
// Sums over the nodes need no clamp: along azimuth e, wi's edge is at 1/K, K = -A.e/A.z >= 0, where B.U =
// (A.z B.e
// - B.z A.e) / -A.e, and every factor below is positive.
#if defined(MICROLANE_ROUGH_DIFFUSE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_ROUGH_DIFFUSE_INL_H_
#undef MICROLANE_ROUGH_DIFFUSE_INL_H_
#else
#define MICROLANE_ROUGH_DIFFUSE_INL_H_
#endif

#include <cstddef>

#include "microlane/distribution-inl.h"
#include "microlane/quadrature.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// What the nodes of one azimuth have in common, in the numbers of the lanes: its weight, s2 = |(alpha_x e.x,
// alpha_y e.y)|^2 times a square of the radius, and what the radius makes of the rest.
enum AzimuthTerm : std::size_t { kAzimuthWeight, kSlope2, kTerm0, kTerm1, kTerm2, kNumAzimuthTerms };

template <class D>
struct AzimuthTerms {
  static constexpr std::size_t kLanes = hn::MaxLanes(D());
  static constexpr std::size_t kSize = 3 * QuadratureRule::kMaxOrder * kNumAzimuthTerms * kLanes;

  T<D>* lanes;

  T<D>* At(std::size_t azimuth, AzimuthTerm term) const {
    return lanes + (azimuth * kNumAzimuthTerms + term) * kLanes;
  }
  Vec<D> operator()(D d, std::size_t azimuth, AzimuthTerm term) const {
    return hn::LoadU(d, At(azimuth, term));
  }
};

// Where the terms of half the lanes go.
template <class D, class DD>
struct HalfTerms {
  AzimuthTerms<D> terms;
  std::size_t azimuth, first_lane;

  void Put(DD dd, AzimuthTerm term, Vec<DD> x) const {
    StoreNarrow(dd, x, terms.At(azimuth, term) + first_lane);
  }
};

// sum + x / sqrt(y).
template <Accuracy A, class D>
HWY_INLINE Vec<D> AddOverSqrt(D d, Vec<D> sum, Vec<D> x, Vec<D> y) {
  if constexpr (A == Accuracy::kFast) {
    return hn::MulAdd(x, FastReciprocalSqrt(d, y), sum);
  } else {
    (void)d;
    return hn::Add(sum, hn::Div(x, hn::Sqrt(y)));
  }
}

// What facets make of it, 1: `facet` is what a scatterer is made of, none here. With a = A.U and b = B.U on a
// common scale on which |M|^2 is m2.
struct LambertianFacets {
  // What sums below are to be multiplied by.
  static constexpr double kScale = 1;

  // x s / y of cosines 2^-40 a and 2^-40 b.
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> TimesOver(D d, Vec<D> x, Vec<D> y, Vec<D>, Vec<D>) {
    return Div<A>(d, x, y);
  }
  // sum + x s/sqrt(m2).
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> Add(D d, Vec<D> sum, Vec<D> x, Vec<D> m2, Vec<D>, Vec<D>) {
    return AddOverSqrt<A>(d, sum, x, m2);
  }
  // sum + x s/(y sqrt(m2)).
  template <Accuracy A, class D>
  static HWY_INLINE Vec<D> AddOver(D d, Vec<D> sum, Vec<D> x, Vec<D> y, Vec<D> m2, Vec<D>, Vec<D>) {
    if constexpr (A == Accuracy::kFast) {
      return hn::MulAdd(hn::Mul(x, FastReciprocal(d, y)), FastReciprocalSqrt(d, m2), sum);
    } else {
      (void)d;
      return hn::Add(sum, hn::Div(x, hn::Mul(y, hn::Sqrt(m2))));
    }
  }
};

// A distribution's radius: rows of the rule where the radius has no edge; and where it has, what EdgeTerms of
// the azimuth along q, |q| = length, makes of z = A.z, falls = -A.q >= 0, across = A.z B.q - B.z A.q >= 0,
// slope2 =
// |(alpha_x q.x, alpha_y q.y)|^2, and EdgeSum of that.
struct GgxRadius {
  static constexpr QuadratureRow kRadius = QuadratureRow::kGgxRadius, kFree = QuadratureRow::kGgxFree;

  // In units of 1 + K: r = p l / (1 + p h), l = 1/(1 + K), h = K l, and A.U = A.z / (1 + p h), B.U = (B.z + p
  // across l / (A.z |q|)) / (1 + p h).
  template <class D, class DD>
  static HWY_INLINE void EdgeTerms(DD dd, const QuadratureTable<double>&, const HalfTerms<D, DD>& half,
                                   Vec<DD> weight, Vec<DD> length, Vec<DD> slope2, Vec<DD> z, Vec<DD> other_z,
                                   Vec<DD> falls, Vec<DD> across) {
    (void)other_z;
    const Vec<DD> zl = hn::Mul(z, length), u = hn::Div(Const(dd, 1), hn::MulAdd(z, length, falls));
    const Vec<DD> l = hn::Mul(zl, u), zu = hn::Mul(z, u), zu2 = hn::Mul(zu, zu);
    half.Put(dd, kAzimuthWeight, hn::Mul(hn::Mul(weight, zl), zu2));
    half.Put(dd, kSlope2, hn::Mul(slope2, zu2));
    half.Put(dd, kTerm0, hn::Mul(l, l));
    half.Put(dd, kTerm1, hn::Mul(falls, u));
    half.Put(dd, kTerm2, hn::Mul(across, u));
  }

  template <class Facets, Accuracy A, class D, class... V>
  static HWY_INLINE Vec<D> EdgeSum(D d, const QuadratureTable<T<D>>& rule, const AzimuthTerms<D>& terms,
                                   std::size_t azimuth, Vec<D> z, Vec<D> other_z, V... facet) {
    const T<D>* const radius = rule[QuadratureRow::kGgxRadius];
    const T<D>* const weight = rule[QuadratureRow::kGgxWeight];
    const Vec<D> s2 = terms(d, azimuth, kSlope2), l2 = terms(d, azimuth, kTerm0), one = Const(d, 1),
                 h = terms(d, azimuth, kTerm1), g = terms(d, azimuth, kTerm2);
    Vec<D> sum = hn::Zero(d);
    for (std::size_t j = 0; j < rule.order; ++j) {
      const Vec<D> p = hn::Set(d, radius[j]), p2 = hn::Mul(p, p);
      const Vec<D> v = hn::MulAdd(p, h, one), v2 = hn::Mul(v, v);
      const Vec<D> n = hn::MulAdd(p2, l2, v2), m2 = hn::MulAdd(p2, s2, v2), n2 = hn::Mul(n, n);
      const Vec<D> other = hn::MulAdd(p, g, other_z), facing = hn::Mul(other, hn::Set(d, weight[j]));
      sum = Facets::template AddOver<A>(d, sum, facing, n2, m2, z, other, facet...);
    }
    return sum;
  }
};

struct BeckmannRadius {
  static constexpr QuadratureRow kRadius = QuadratureRow::kBeckmannRadius,
                                 kFree = QuadratureRow::kBeckmannFree;

  // r = t c, c = min(1/K, R): A.U = A.z ((1 - t) + t a), B.U = B.z (1 - t) + t b, a and b theirs at c.
  template <class D, class DD>
  static HWY_INLINE void EdgeTerms(DD dd, const QuadratureTable<double>& rule, const HalfTerms<D, DD>& half,
                                   Vec<DD> weight, Vec<DD> length, Vec<DD> slope2, Vec<DD> z, Vec<DD> other_z,
                                   Vec<DD> falls, Vec<DD> across) {
    const Vec<DD> zl = hn::Mul(z, length), one = Const(dd, 1);
    const Vec<DD> u = hn::Div(one, hn::Max(falls, hn::Mul(zl, Const(dd, 1 / rule.beckmann_radius))));
    const Vec<DD> c = hn::Mul(zl, u), zu = hn::Mul(z, u), zu2 = hn::Mul(zu, zu);
    const Vec<DD> a = hn::Max(hn::Zero(dd), hn::NegMulAdd(u, falls, one));
    half.Put(dd, kAzimuthWeight, hn::Mul(hn::Mul(weight, zl), zu2));
    half.Put(dd, kSlope2, hn::Mul(slope2, zu2));
    half.Put(dd, kTerm0, hn::Mul(c, c));
    half.Put(dd, kTerm1, a);
    half.Put(dd, kTerm2, hn::MulAdd(other_z, a, hn::Mul(u, across)));
  }

  template <class Facets, Accuracy A, class D, class... V>
  static HWY_INLINE Vec<D> EdgeSum(D d, const QuadratureTable<T<D>>& rule, const AzimuthTerms<D>& terms,
                                   std::size_t azimuth, Vec<D> z, Vec<D> other_z, V... facet) {
    const T<D>* const part = rule[QuadratureRow::kBeckmannPart];
    const T<D>* const rest = rule[QuadratureRow::kBeckmannRest];
    const T<D>* const weight = rule[QuadratureRow::kBeckmannWeight];
    const Vec<D> s2 = terms(d, azimuth, kSlope2), c2 = terms(d, azimuth, kTerm0), zero = hn::Zero(d),
                 a = terms(d, azimuth, kTerm1), b = terms(d, azimuth, kTerm2), one = Const(d, 1);
    Vec<D> sum = zero;
    for (std::size_t j = 0; j < rule.order; ++j) {
      const Vec<D> t = hn::Set(d, part[j]), t2 = hn::Mul(t, t), w = hn::Set(d, rest[j]);
      const Vec<D> one_facing = hn::MulAdd(t, a, w), other = hn::MulAdd(t, b, hn::Mul(w, other_z));
      const Vec<D> density = ExpTimes<A>(d, hn::Neg(hn::Mul(t2, c2)), zero, hn::Set(d, weight[j]));
      sum = Facets::template Add<A>(d, sum, hn::Mul(hn::Mul(one_facing, other), density),
                                    hn::MulAdd(t2, s2, one), hn::Mul(z, one_facing), other, facet...);
    }
    return sum;
  }
};

// Where the radius has no edge: A.U and B.U from the rows' r.
template <class Radius, class Facets, Accuracy A, class D, class... V>
HWY_INLINE Vec<D> FreeSum(D d, const QuadratureTable<T<D>>& rule, const AzimuthTerms<D>& terms,
                          std::size_t azimuth, Vec<D> zi, Vec<D> zo, V... facet) {
  const T<D>* const radius = rule[Radius::kRadius];
  const T<D>* const weight = rule[Radius::kFree];
  const Vec<D> s2 = terms(d, azimuth, kSlope2), a = terms(d, azimuth, kTerm0), b = terms(d, azimuth, kTerm1);
  Vec<D> sum = hn::Zero(d);
  for (std::size_t j = 0; j < rule.order; ++j) {
    const Vec<D> r = hn::Set(d, radius[j]);
    const Vec<D> one = hn::MulAdd(r, a, zi), other = hn::MulAdd(r, b, zo);
    const Vec<D> m2 = hn::MulAdd(hn::Mul(r, r), s2, Const(d, 1));
    sum = Facets::template Add<A>(d, sum, hn::Mul(hn::Mul(one, other), hn::Set(d, weight[j])), m2, one, other,
                                  facet...);
  }
  return sum;
}

// u = (x, y) / length, length = |(x, y)|; where that is 0, u is left alone and so is `inverse` 0, else 1 /
// length.
template <class D>
HWY_INLINE void UnitAlong(D d, Vec<D>& ux, Vec<D>& uy, Vec<D>& length, Vec<D>& inverse, Vec<D> x, Vec<D> y) {
  length = hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y)));
  const auto none = hn::Eq(length, hn::Zero(d));
  inverse = ZeroIf(none, hn::Div(Const(d, 1), length));
  ux = hn::IfThenElse(none, ux, hn::Mul(x, inverse));
  uy = hn::IfThenElse(none, uy, hn::Mul(y, inverse));
}

// a b - c e of products that may cancel.
template <class D>
HWY_INLINE Vec<D> ProductDifference(D d, Vec<D> a, Vec<D> b, Vec<D> c, Vec<D> e) {
  Vec<D> p, p_tail, q, q_tail;
  TwoProduct(d, a, b, p, p_tail);
  TwoProduct(d, c, e, q, q_tail);
  return hn::Add(hn::Sub(p, q), hn::Sub(p_tail, q_tail));
}

// The azimuths from unit vector j to k, within half a turn to the side that the sign of `turn` is, with u.q
// and v.q of vectors of lengths u and v that are at right angles to j and to k, and |u x v| = cross: positive
// terms, where j and k are next to each other too. node(i, qx, qy, |q|, 2 sin(b) w, u.q, v.q) for each of
// them.
template <class D, class Node>
HWY_INLINE void ForAzimuths(D d, const QuadratureTable<double>& rule, Vec<D> jx, Vec<D> jy, Vec<D> kx,
                            Vec<D> ky, Vec<D> turn, Vec<D> u, Vec<D> u_inverse, Vec<D> v, Vec<D> v_inverse,
                            Vec<D> cross, const Node& node) {
  const auto wide = hn::Lt(hn::MulAdd(jx, kx, hn::Mul(jy, ky)), hn::Zero(d));
  const Vec<D> x = hn::IfThenElse(wide, FlipSign(d, hn::Sub(ky, jy), turn), hn::Add(jx, kx));
  const Vec<D> y = hn::IfThenElse(wide, FlipSign(d, hn::Sub(jx, kx), turn), hn::Add(jy, ky));
  const Vec<D> inverse = hn::Div(Const(d, 1), hn::Sqrt(hn::MulAdd(x, x, hn::Mul(y, y))));
  const Vec<D> mx = hn::Mul(x, inverse), my = hn::Mul(y, inverse);
  const Vec<D> cosine = hn::MulAdd(jx, mx, hn::Mul(jy, my));
  const Vec<D> v_at_j = hn::Mul(cross, u_inverse), u_at_k = hn::Mul(cross, v_inverse);
  const Vec<D> half_sine2 = hn::Mul(hn::Mul(v_at_j, v_inverse), Const(d, 0.5));  // sin(2 b) / 2
  const Vec<D> sine =
      hn::IfThenElse(wide, hn::Abs(hn::MulSub(jx, my, hn::Mul(jy, mx))), hn::Div(half_sine2, cosine));
  const Vec<D> two_sine = hn::Add(sine, sine), u_at_m = hn::Mul(u, sine), v_at_m = hn::Mul(v, sine);
  for (std::size_t i = 0; i < rule.order; ++i) {
    const Vec<D> first = hn::Set(d, rule[QuadratureRow::kFirst][i]);
    const Vec<D> middle = hn::Set(d, rule[QuadratureRow::kMiddle][i]);
    const Vec<D> last = hn::Set(d, rule[QuadratureRow::kLast][i]);
    const Vec<D> qx = hn::MulAdd(middle, mx, hn::MulAdd(first, jx, hn::Mul(last, kx)));
    const Vec<D> qy = hn::MulAdd(middle, my, hn::MulAdd(first, jy, hn::Mul(last, ky)));
    const Vec<D> length = hn::MulAdd(middle, cosine, hn::Add(first, last));
    const Vec<D> u_q = hn::MulAdd(middle, u_at_m, hn::Mul(last, u_at_k));
    const Vec<D> v_q = hn::MulAdd(middle, v_at_m, hn::Mul(first, v_at_j));
    node(i, qx, qy, length, hn::Mul(two_sine, hn::Set(d, rule[QuadratureRow::kWeight][i])), u_q, v_q);
  }
}

// The terms of all azimuths, from arrays of wi, wo (on the upper side) and the alphas, in double lanes: nodes
// are as far off as their azimuths, which a large alpha magnifies.
template <class Radius, class D>
HWY_NOINLINE void MakeAzimuths(D d, const QuadratureRule& rule, const T<D> (*in)[hn::MaxLanes(D())],
                               AzimuthTerms<D> terms) {
  const HalfInDouble<D> dd;
  using V = Vec<decltype(dd)>;
  const QuadratureTable<double> table = rule.Table<double>();
  for (std::size_t lane = 0; lane < hn::Lanes(d); lane += hn::Lanes(dd)) {
    const V ix = LoadWide(dd, in[0] + lane), iy = LoadWide(dd, in[1] + lane), zi = LoadWide(dd, in[2] + lane);
    const V ox = LoadWide(dd, in[3] + lane), oy = LoadWide(dd, in[4] + lane), zo = LoadWide(dd, in[5] + lane);
    const V alpha_x = LoadWide(dd, in[6] + lane), alpha_y = LoadWide(dd, in[7] + lane);
    // The horizontal parts of A, of B and of C = B.z A - A.z B, which is across the corner's azimuth; A x B.
    const V ax = hn::Mul(alpha_x, ix), ay = hn::Mul(alpha_y, iy);
    const V bx = hn::Mul(alpha_x, ox), by = hn::Mul(alpha_y, oy);
    const V cx = hn::Mul(alpha_x, ProductDifference(dd, ix, zo, ox, zi));
    const V cy = hn::Mul(alpha_y, ProductDifference(dd, iy, zo, oy, zi));
    const V turn = ProductDifference(dd, ix, oy, iy, ox);  // 0 turns as positive numbers do
    const V cross = hn::Mul(hn::Mul(alpha_x, alpha_y), hn::Abs(turn));
    // Unit vectors along them; of a view along the normal the other's.
    V a, a_inverse, b, b_inverse, c, c_inverse;
    V aux = Const(dd, 1), auy = hn::Zero(dd);
    UnitAlong(dd, aux, auy, b, b_inverse, bx, by);
    UnitAlong(dd, aux, auy, a, a_inverse, ax, ay);
    V bux = aux, buy = auy, cux = aux, cuy = auy;
    UnitAlong(dd, bux, buy, b, b_inverse, bx, by);
    UnitAlong(dd, cux, cuy, c, c_inverse, cx, cy);
    // The horizons of wi and wo, and the corner.
    const V hix = hn::Neg(FlipSign(dd, auy, turn)), hiy = FlipSign(dd, aux, turn);
    const V hox = FlipSign(dd, buy, turn), hoy = hn::Neg(FlipSign(dd, bux, turn));
    const V kx = FlipSign(dd, cuy, turn), ky = hn::Neg(FlipSign(dd, cux, turn));
    const auto slope2 = [&](V qx, V qy) HWY_ATTR {
      const V x = hn::Mul(alpha_x, qx), y = hn::Mul(alpha_y, qy);
      return hn::MulAdd(x, x, hn::Mul(y, y));
    };
    ForAzimuths(dd, table, hox, hoy, hix, hiy, turn, b, b_inverse, a, a_inverse, cross,
                [&](std::size_t i, V qx, V qy, V length, V weight, V of_b, V of_a) HWY_ATTR {
                  const HalfTerms<D, decltype(dd)> half{terms, i, lane};
                  const V inverse = hn::Div(Const(dd, 1), length);
                  half.Put(dd, kAzimuthWeight, hn::Mul(weight, inverse));
                  half.Put(dd, kSlope2, hn::Mul(hn::Mul(slope2(qx, qy), inverse), inverse));
                  half.Put(dd, kTerm0, hn::Mul(of_a, inverse));
                  half.Put(dd, kTerm1, hn::Mul(of_b, inverse));
                });
    ForAzimuths(dd, table, hix, hiy, kx, ky, turn, a, a_inverse, c, c_inverse, hn::Mul(zi, cross),
                [&](std::size_t i, V qx, V qy, V length, V weight, V falls, V across) HWY_ATTR {
                  Radius::template EdgeTerms<D>(dd, table, {terms, table.order + i, lane}, weight, length,
                                                slope2(qx, qy), zi, zo, falls, across);
                });
    ForAzimuths(dd, table, hox, hoy, kx, ky, hn::Neg(turn), b, b_inverse, c, c_inverse, hn::Mul(zo, cross),
                [&](std::size_t i, V qx, V qy, V length, V weight, V falls, V across) HWY_ATTR {
                  Radius::template EdgeTerms<D>(dd, table, {terms, 2 * table.order + i, lane}, weight, length,
                                                slope2(qx, qy), zo, zi, falls, across);
                });
  }
}

// f |cos(theta_o)|.
template <class Dist, class Radius, class Facets, JointMasking kG, Accuracy A, class D, class... V>
HWY_INLINE Vec<D> RoughDiffuse(D d, const QuadratureRule& rule, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox,
                               Vec<D> oy, Vec<D> oz, Vec<D> alpha_x, Vec<D> alpha_y, V... facet) {
  constexpr std::size_t kLanes = hn::MaxLanes(D());
  const Vec<D> zero = hn::Zero(d), zi = hn::Abs(iz), zo = FlipSign(d, oz, iz);
  HWY_ALIGN T<D> in[8][kLanes];
  HWY_ALIGN T<D> lanes[AzimuthTerms<D>::kSize];
  const AzimuthTerms<D> terms{lanes};
  hn::Store(ix, d, in[0]);
  hn::Store(iy, d, in[1]);
  hn::Store(zi, d, in[2]);
  hn::Store(ox, d, in[3]);
  hn::Store(oy, d, in[4]);
  hn::Store(zo, d, in[5]);
  hn::Store(alpha_x, d, in[6]);
  hn::Store(alpha_y, d, in[7]);
  MakeAzimuths<Radius>(d, rule, in, terms);

  const QuadratureTable<T<D>> table = rule.Table<T<D>>();
  const std::size_t order = table.order;
  Vec<D> sum = zero, tail = zero;
  for (std::size_t i = 0; i < order; ++i) {
    AddTerm<A>(sum, tail, terms(d, i, kAzimuthWeight),
               FreeSum<Radius, Facets, A>(d, table, terms, i, zi, zo, facet...));
  }
  for (std::size_t i = order; i < 2 * order; ++i) {
    AddTerm<A>(sum, tail, terms(d, i, kAzimuthWeight),
               Radius::template EdgeSum<Facets, A>(d, table, terms, i, zi, zo, facet...));
  }
  for (std::size_t i = 2 * order; i < 3 * order; ++i) {
    AddTerm<A>(sum, tail, terms(d, i, kAzimuthWeight),
               Radius::template EdgeSum<Facets, A>(d, table, terms, i, zo, zi, facet...));
  }
  sum = hn::Add(sum, tail);

  // G2/|wi.z| from |v.z| (1 + 2 Lambda(v)), scaled so that two grazing cosines do not underflow together.
  const Vec<D> mu_i = Dist::template Masking<Care::kCareful, A>(d, ix, iy, zi, alpha_x, alpha_y);
  const Vec<D> mu_o = Dist::template Masking<Care::kCareful, A>(d, ox, oy, zo, alpha_x, alpha_y);
  const Vec<D> scale = Const(d, 0x1p60), scaled_zo = hn::Mul(zo, scale);
  Vec<D> numerator, denominator;
  if constexpr (kG == JointMasking::kSeparable) {
    numerator = hn::Mul(scaled_zo, Const(d, 4));
    denominator = hn::Mul(hn::Add(mu_i, zi), hn::Mul(hn::Add(mu_o, zo), scale));
  } else {
    numerator = hn::Add(scaled_zo, scaled_zo);
    denominator = hn::MulAdd(scaled_zo, mu_i, hn::Mul(hn::Mul(zi, scale), mu_o));
  }
  // The terms have two approximations each already.
  const Vec<D> masking = A == Accuracy::kFast ? hn::Mul(numerator, RefinedReciprocal<A>(d, denominator))
                                              : hn::Div(numerator, denominator);
  const auto outside = hn::Or(hn::Le(zi, zero), hn::Le(zo, zero));
  return ZeroIf(outside, hn::Mul(hn::Mul(sum, Const(d, Facets::kScale / (kPi * kPi))), masking));
}

// What m makes of f |cos(theta_o)|, over the density of m, mz D or, kVisible, D_visible of wi (Meneveaux 2015
// Eq. 28): with a facet's f = s/pi and mu = |v.z| (1 + 2 Lambda(v)),
//   mz D: s (wi.m) (wo.m) G2/(pi |wi.z| mz),  D_visible: s (wo.m) G2/(pi G1(wi)),
// where G2/|wi.z| = 2 |wo.z| / (|wo.z| mu_i + |wi.z| mu_o) and G2/G1 = |wo.z| (|wi.z| + mu_i) / the same; of
// separable masking 4 |wo.z| / ((|wi.z| + mu_i) (|wo.z| + mu_o)) and 2 |wo.z| / (|wo.z| + mu_o).
template <class Dist, class Facets, JointMasking kG, bool kVisible, Accuracy A, class D, class... V>
HWY_INLINE Vec<D> OneNormalPass(D d, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz,
                                Vec<D> mx, Vec<D> my, Vec<D> mz, Vec<D> alpha_x, Vec<D> alpha_y, V... facet) {
  const Vec<D> zero = hn::Zero(d), zi = hn::Abs(iz), zo = FlipSign(d, oz, iz);
  Vec<D> a, b, unused;
  InDouble2<InStandard<CarefulDotOp>>(d, a, unused, ix, iy, iz, mx, my, mz);
  InDouble2<InStandard<CarefulDotOp>>(d, b, unused, ox, oy, oz, mx, my, mz);
  a = FlipSign(d, a, iz);
  b = FlipSign(d, b, iz);
  const Vec<D> mu_o = Dist::template Masking<Care::kCareful, A>(d, ox, oy, zo, alpha_x, alpha_y);
  // Scaled so that small cosines do not underflow together; a and b are times 2^40.
  const Vec<D> scale = Const(d, 0x1p20), scaled_zo = hn::Mul(zo, scale), b_zo = hn::Mul(b, scaled_zo);
  const Vec<D> one_over_pi = Const(d, 0x1p-40 / kPi);
  Vec<D> x, y;
  if constexpr (kVisible && kG == JointMasking::kSeparable) {
    x = hn::Mul(hn::Add(b_zo, b_zo), one_over_pi);
    y = hn::Mul(hn::Add(zo, mu_o), scale);
  } else {
    const Vec<D> mu_i = Dist::template Masking<Care::kCareful, A>(d, ix, iy, zi, alpha_x, alpha_y);
    const Vec<D> visible = hn::Add(zi, mu_i);
    if constexpr (kG == JointMasking::kSeparable) {
      x = hn::Mul(b_zo, Const(d, 4 * 0x1p-40 / kPi));
      y = hn::Mul(hn::Mul(hn::Add(zo, mu_o), scale), visible);
    } else {
      x = hn::Mul(b_zo, kVisible ? hn::Mul(visible, one_over_pi) : Const(d, 2 * 0x1p-40 / kPi));
      y = hn::MulAdd(scaled_zo, mu_i, hn::Mul(hn::Mul(zi, scale), mu_o));
    }
    if constexpr (!kVisible) {
      x = hn::Mul(x, hn::Mul(a, Const(d, 0x1p-20)));
      y = hn::Mul(y, hn::Mul(mz, Const(d, 0x1p20)));
    }
  }
  const auto lit = hn::And(hn::Gt(hn::Min(a, b), zero), hn::Gt(mz, zero));
  const auto inside = hn::And(lit, hn::And(hn::Gt(zi, zero), hn::Gt(zo, zero)));
  return hn::IfThenElseZero(inside, Facets::template TimesOver<A>(d, x, y, a, b, facet...));
}
template <class Dist, class Facets, JointMasking kG, bool kVisible>
struct OneNormalOp {
  template <class DD, class... In>
  static HWY_INLINE void Run(DD dd, Vec<DD>& value, Vec<DD>& unused, In... in) {
    value = unused = OneNormalPass<Dist, Facets, kG, kVisible, Accuracy::kStandard>(dd, in...);
  }
};
// Out of line: few lanes need it.
template <class Dist, class Facets, JointMasking kG, bool kVisible, class D, class... In>
HWY_NOINLINE Vec<D> OneNormalInDouble(D d, In... in) {
  Vec<D> value, unused;
  InDouble2<OneNormalOp<Dist, Facets, kG, kVisible>>(d, value, unused, in...);
  return value;
}

// Where cosines are so small that their products leave the range of floats, in double lanes.
template <class Dist, class Facets, JointMasking kG, bool kVisible, Accuracy A, class D, class... In>
HWY_INLINE Vec<D> OneNormal(D d, Vec<D> ix, Vec<D> iy, Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz, Vec<D> mx,
                            Vec<D> my, Vec<D> mz, In... in) {
  Vec<D> value = OneNormalPass<Dist, Facets, kG, kVisible, A>(d, ix, iy, iz, ox, oy, oz, mx, my, mz, in...);
  if constexpr (kIsFloat<D>) {
    const Vec<D> least = hn::Min(hn::Max(hn::Abs(iz), hn::Abs(oz)), hn::Abs(mz));
    const auto hard = hn::Lt(least, Const(d, 0x1p-30));
    if (HWY_UNLIKELY(!hn::AllFalse(d, hard))) {
      value = hn::IfThenElse(
          hard, OneNormalInDouble<Dist, Facets, kG, kVisible>(d, ix, iy, iz, ox, oy, oz, mx, my, mz, in...),
          value);
    }
  }
  return value;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_ROUGH_DIFFUSE_INL_H_
