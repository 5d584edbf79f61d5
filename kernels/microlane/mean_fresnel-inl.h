// Fresnel's mean over the normals visible from v in lanes (Heitz 2014 Eq. 105), by the nodes of quadrature.h:
// sums of F(v.m), m = M/|M|, where (v.m)^2 = P^2/N.
#if defined(MICROLANE_MEAN_FRESNEL_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_MEAN_FRESNEL_INL_H_
#undef MICROLANE_MEAN_FRESNEL_INL_H_
#else
#define MICROLANE_MEAN_FRESNEL_INL_H_
#endif

#include <cstddef>
#include <type_traits>

#include "microlane/distribution-inl.h"
#include "microlane/mean_fresnel_fit.h"
#include "microlane/quadrature.h"
#include "microlane/rough_reflector-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// Alphas within 2^-40 and 2^40, so that the terms below are total; NaN passes.
template <class D>
HWY_INLINE Vec<D> WithinRange(D d, Vec<D> alpha) {
  const Vec<D> low = Const(d, 0x1p-40), high = Const(d, 0x1p40);
  alpha = hn::IfThenElse(hn::Lt(alpha, low), low, alpha);
  return hn::IfThenElse(hn::Gt(alpha, high), high, alpha);
}

// The mean of f(P, N), which is to be F where cos^2 = P^2/N, over the spherical caps of ggx-inl.h: with s =
// q/r and H = c + s, P = |H|^2 and N = 4 |M|^2/r^2.
struct GgxVisibleNormals {
  static constexpr const auto& kCosineFit = kGgxCosineFit;

  template <Accuracy A, class D, class Reflectance>
  static HWY_INLINE Vec<D> Mean(D d, const QuadratureTable<T<D>>& rule, Vec<D> vx, Vec<D> vy, Vec<D> vz,
                                Vec<D> alpha_x, Vec<D> alpha_y, const Reflectance& f) {
    const Vec<D> z = hn::Abs(vz), tiny = Const(d, 1e-36);
    const Vec<D> qx = hn::Mul(alpha_x, vx), qy = hn::Mul(alpha_y, vy),
                 q2 = hn::MulAdd(qx, qx, hn::Mul(qy, qy));
    const Vec<D> over_r = hn::Div(Const(d, 1), hn::Sqrt(hn::Max(tiny, hn::MulAdd(z, z, q2))));
    const Vec<D> sx = hn::Mul(qx, over_r), sy = hn::Mul(qy, over_r), sz = hn::Mul(z, over_r);
    const Vec<D> one_plus = hn::Add(Const(d, 1), sz);
    // 1 - s.z
    const Vec<D> rest = hn::Div(hn::Mul(q2, hn::Mul(over_r, over_r)), one_plus);
    const Vec<D> twice = hn::Add(over_r, over_r), ax = hn::Mul(alpha_x, twice), ay = hn::Mul(alpha_y, twice);
    Vec<D> sum = hn::Zero(d), tail = sum;
    for (std::size_t i = 0; i < rule.order; ++i) {
      const Vec<D> u = hn::Set(d, rule[QuadratureRow::kCapPart][i]);
      const Vec<D> w = hn::Set(d, rule[QuadratureRow::kCapRest][i]);
      // c.z = w - u s.z, so that 1 - c.z = u (1 + s.z) and 1 + c.z = 2 w + u (1 - s.z).
      const Vec<D> hz = hn::Mul(w, one_plus), nz = hn::Mul(hz, twice);
      const Vec<D> sine2 = hn::Mul(hn::Mul(u, one_plus), hn::MulAdd(u, rest, hn::Add(w, w)));
      const Vec<D> sine = hn::Sqrt(sine2), hz2 = hn::Mul(hz, hz), nz2 = hn::MulAdd(nz, nz, tiny);
      Vec<D> ring = hn::Zero(d);
      const auto add = [&](Vec<D> hx, Vec<D> hy) HWY_ATTR {
        const Vec<D> p = hn::MulAdd(hx, hx, hn::MulAdd(hy, hy, hz2));
        const Vec<D> x = hn::Mul(ax, hx), y = hn::Mul(ay, hy);
        ring = hn::Add(ring, f(p, hn::MulAdd(x, x, hn::MulAdd(y, y, nz2))));
      };
      for (std::size_t j = 0; j < rule.order; ++j) {
        const Vec<D> hx = hn::MulAdd(sine, hn::Set(d, rule[QuadratureRow::kCosine][j]), sx);
        const Vec<D> side = hn::Mul(sine, hn::Set(d, rule[QuadratureRow::kSine][j]));
        add(hx, hn::Add(sy, side));
        add(hx, hn::Sub(sy, side));
      }
      AddTerm<A>(sum, tail, hn::Set(d, rule[QuadratureRow::kCapWeight][i]), ring);
    }
    return hn::Add(sum, tail);
  }
};

// Slopes (t, y) of unit roughness along and across the azimuth of A = (alpha_x vx, alpha_y vy, |vz|): P = A.z
// + |(A.x, A.y)| t of those t where it is positive, N = |M|^2.
struct BeckmannVisibleNormals {
  static constexpr const auto& kCosineFit = kBeckmannCosineFit;

  template <Accuracy A, class D, class Reflectance>
  static HWY_INLINE Vec<D> Mean(D d, const QuadratureTable<T<D>>& rule, Vec<D> vx, Vec<D> vy, Vec<D> vz,
                                Vec<D> alpha_x, Vec<D> alpha_y, const Reflectance& f) {
    const Vec<D> z = hn::Abs(vz), one = Const(d, 1), zero = hn::Zero(d), tiny = Const(d, 1e-36);
    // The azimuth of what may be subnormal.
    const Vec<D> scale = PowerOfTwoScale(d, vx, vy, zero);
    const Vec<D> qx = hn::Mul(alpha_x, hn::Mul(vx, scale)), qy = hn::Mul(alpha_y, hn::Mul(vy, scale));
    const Vec<D> scaled = hn::Sqrt(hn::MulAdd(qx, qx, hn::Mul(qy, qy)));
    const auto upright = hn::Eq(scaled, zero);
    const Vec<D> over = ZeroIf(upright, hn::Div(one, scaled));
    const Vec<D> ex = hn::IfThenElse(upright, one, hn::Mul(qx, over)), ey = hn::Mul(qy, over);
    const Vec<D> length = hn::Mul(scaled, InversePowerOfTwo(d, scale));
    // t from -b on, b = min(R, A.z/length); P there and at R.
    const Vec<D> radius = hn::Set(d, rule.beckmann_visible), high = Const(d, 0x1p100);
    const Vec<D> edge = hn::Mul(hn::Mul(hn::Min(z, high), over), hn::Min(scale, high));
    const Vec<D> b = hn::IfThenElse(upright, radius, hn::Min(radius, edge));
    const Vec<D> first = hn::Max(zero, hn::NegMulAdd(length, radius, z)),
                 last = hn::MulAdd(length, radius, z);
    const Vec<D> along_x = hn::Mul(alpha_x, ex), along_y = hn::Mul(alpha_y, ey);
    const Vec<D> across_x = hn::Mul(alpha_x, ey), across_y = hn::Mul(alpha_y, ex);
    Vec<D> sum = zero, tail = zero, total = zero;
    for (std::size_t i = 0; i < rule.order; ++i) {
      const Vec<D> part = hn::Set(d, rule[QuadratureRow::kBeckmannPart][i]);
      const Vec<D> rest = hn::Set(d, rule[QuadratureRow::kBeckmannRest][i]);
      const Vec<D> t = hn::MulSub(part, radius, hn::Mul(rest, b));
      const Vec<D> p = hn::MulAdd(rest, first, hn::Mul(part, last));
      const Vec<D> weight = ExpTimes<A>(d, hn::Neg(hn::Mul(t, t)), zero,
                                        hn::Mul(p, hn::Set(d, rule[QuadratureRow::kWeight][i])));
      const Vec<D> mx = hn::Mul(along_x, t), my = hn::Mul(along_y, t);
      Vec<D> line = zero;
      for (std::size_t j = 0; j < rule.order; ++j) {
        const Vec<D> y = hn::Set(d, rule[QuadratureRow::kBeckmannAcross][j]);
        const Vec<D> nx = hn::NegMulAdd(across_x, y, mx), ny = hn::MulAdd(across_y, y, my);
        line = hn::MulAdd(hn::Set(d, rule[QuadratureRow::kBeckmannAcrossWeight][j]),
                          f(p, hn::MulAdd(nx, nx, hn::MulAdd(ny, ny, one))), line);
      }
      AddTerm<A>(sum, tail, weight, line);
      total = hn::Add(total, weight);
    }
    return hn::Div(hn::Add(sum, tail), hn::Max(tiny, total));
  }
};

// F where cos^2 = P^2/N, of conductors over |g^2 - c^2|^2, which all angles share; k = q0^2 - 1 where the
// facets have an index q0.
template <class Facets, Accuracy A, class D>
HWY_INLINE Vec<D> ReflectanceOfRatio(D d, Vec<D> p, Vec<D> n, Vec<D> k, Vec<D> q0, Vec<D> q1) {
  const Vec<D> zero = hn::Zero(d), one = Const(d, 1), p2 = hn::Mul(p, p);
  if constexpr (std::is_same_v<Facets, DielectricInterface>) {
    // c^2, g^2 and s^2 of fresnel-inl.h times N.
    const Vec<D> g2 = hn::MulAdd(k, n, p2), s2 = hn::NegMulAdd(p, p, n);
    const Vec<D> root = Sqrt<A>(d, hn::Mul(p2, hn::Max(zero, g2)));
    Vec<D> a, m;
    FresnelTerms<true>(d, a, m, hn::Add(p2, g2), root, s2);
    const Vec<D> kr = Div<A>(d, hn::Mul(k, n), hn::Mul(a, m)), kp = hn::Mul(kr, root), ks = hn::Mul(kr, s2);
    return hn::IfThenElse(hn::Le(g2, zero), one, hn::MulAdd(kp, kp, hn::Mul(ks, ks)));
  } else if constexpr (std::is_same_v<Facets, ConductorFacets>) {
    // t cancels at the critical angle.
    const Vec<D> c2 = A == Accuracy::kFast ? hn::Mul(p2, RefinedReciprocal<A>(d, n)) : hn::Div(p2, n),
                 s2 = hn::Sub(one, c2);
    Vec<D> a, m2, big_n, twice;
    hn::Mask<D> unused = hn::MaskFromVec(zero);
    Facets::template Terms<A>(d, big_n, a, m2, twice, unused, c2, s2, hn::Add(k, c2), one, q0, q1);
    if constexpr (kIsFloat<D>) a = hn::Max(a, Const(d, 1e-18));
    return Div<A>(d, big_n, hn::Mul(hn::Mul(a, a), m2));
  } else {
    const Vec<D> x = hn::Max(zero, hn::Sub(one, Div<A>(d, p, Sqrt<A>(d, n)))), x2 = hn::Mul(x, x);
    return hn::MulAdd(hn::Sub(one, q0), hn::Mul(hn::Mul(x2, x2), x), q0);
  }
}

// The mean over the normals visible from v. Facets: DielectricInterface, or those of rough_reflector-inl.h;
// q0 and q1 their parameters, 0 where they have none.
template <class Visible, class Facets, Accuracy A, class D>
HWY_INLINE Vec<D> MeanFresnel(D d, const QuadratureTable<T<D>>& rule, Vec<D> vx, Vec<D> vy, Vec<D> vz,
                              Vec<D> alpha_x, Vec<D> alpha_y, Vec<D> q0, Vec<D> q1) {
  const Vec<D> k = EtaSquaredMinus1(d, q0), one = Const(d, 1);
  const auto f = [&](Vec<D> p, Vec<D> n)
                     HWY_ATTR { return ReflectanceOfRatio<Facets, A>(d, p, n, k, q0, q1); };
  Vec<D> mean =  // NOLINT(misc-const-correctness)
      Visible::template Mean<A>(d, rule, vx, vy, vz, WithinRange(d, alpha_x), WithinRange(d, alpha_y), f);
  if constexpr (std::is_same_v<Facets, ConductorFacets>) {
    // |g^2 - c^2|^2 scaled, as it may be subnormal where F is not.
    const Vec<D> scale = Const(d, 0x1p40), back = Const(d, 0x1p-40);
    const Vec<D> real = hn::Mul(hn::NegMulAdd(q1, q1, k), scale);
    const Vec<D> imaginary = hn::Mul(hn::Mul(hn::Add(q0, q0), scale), q1);
    const Vec<D> square = hn::MulAdd(real, real, hn::Mul(imaginary, imaginary));
    mean = hn::Mul(hn::Mul(hn::Mul(mean, square), back), back);
  }
  mean = hn::Min(one, mean);
  const Vec<D> zero = hn::Zero(d), largest = hn::Max(hn::Abs(vx), hn::Max(hn::Abs(vy), hn::Abs(vz)));
  auto none = hn::Eq(largest, zero);
  // Where nothing changes, nothing reflects, edge-on too.
  if constexpr (!std::is_same_v<Facets, SchlickFacets>) {
    none = hn::Or(none, hn::And(hn::Eq(k, zero), hn::Eq(q1, zero)));
  }
  return ZeroIf(none, mean);
}

// The cosine of mean_fresnel_fit.h. Float lanes would lose bits of its sum, whose terms cancel.
template <class Visible>
struct MeanFresnelCosineOp {
  template <Accuracy A, class D>
  static HWY_INLINE void Run(D d, Vec<D>& cosine, Vec<D>& unused, Vec<D> cos_i, Vec<D> alpha) {
    const Vec<D> one = Const(d, 1), two = Const(d, 2), largest = Const(d, kLargestAlphaOfFit);
    alpha = WithinRange(d, alpha);
    alpha = hn::IfThenElse(hn::Gt(alpha, largest), largest, alpha);
    const Vec<D> c = hn::Abs(cos_i), s2 = hn::Max(hn::Zero(d), hn::NegMulAdd(c, c, one));
    const Vec<D> r = CloseSqrt<A>(d, hn::MulAdd(c, c, hn::Mul(hn::Mul(alpha, alpha), s2)));
    const Vec<D> root = CloseSqrt<A>(d, hn::Mul(alpha, Const(d, 1 / kLargestAlphaOfFit)));
    // c/r and 1/(1 + alpha) from one division.
    const Vec<D> rest = hn::Add(one, alpha), both = RefinedReciprocal<A>(d, hn::Mul(r, rest));
    const Vec<D> x = hn::MulSub(two, hn::Mul(c, hn::Mul(both, rest)), one);
    const Vec<D> y = hn::MulSub(two, root, one);
    const Vec<D> sum = Polynomial(d, x, y, Visible::kCosineFit);
    cosine = unused = hn::Min(one, hn::Mul(sum, hn::Mul(r, hn::Mul(both, r))));
  }
};
template <class Visible, Accuracy A, class D>
HWY_INLINE Vec<D> MeanFresnelCosine(D d, Vec<D> cos_i, Vec<D> alpha) {
  Vec<D> cosine, unused;
  Precisely<MeanFresnelCosineOp<Visible>, A>(d, cosine, unused, cos_i, alpha);
  return cosine;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_MEAN_FRESNEL_INL_H_
