// GGX (Walter 2007 Eqs. 33-36; Heitz 2014 Eqs. 70-72, 84-86) in lanes, isotropic (one alpha) or anisotropic
// (two).
#if defined(MICROLANE_GGX_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_GGX_INL_H_
#undef MICROLANE_GGX_INL_H_
#else
#define MICROLANE_GGX_INL_H_
#endif

#include "microlane/distribution-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

struct Ggx {
  static constexpr size_t kOwn = 0;
  static constexpr bool kHasExponent = false, kMaskingInDouble = false, kDensityOfCosine = false;

  // A^2 + B^2 + C^2 of Stretch as an unevaluated sum. kCompensated: of H + H_tail, rounded to e.
  template <Care kCare, class D, class... P>
  static HWY_INLINE void Density(D d, Vec<D>& e, Vec<D>& e_tail, Vec<D>& w, Vec<D> hx, Vec<D> hy, Vec<D> hz,
                                 Vec<D> hx_tail, Vec<D> hy_tail, Vec<D> hz_tail, P... p) {
    Vec<D> ux, uy, uz, uz_tail;
    Stretch<kCare>(d, ux, uy, uz, uz_tail, w, p...);
    if constexpr (kCare == Care::kPlain) {
      const Vec<D> a = hn::Mul(hx, ux), b = hn::Mul(hy, uy), c = hn::Mul(hz, uz);
      e = Dot(a, b, c, a, b, c);
      e_tail = hn::Zero(d);
    } else if constexpr (kCare == Care::kCompensated) {
      Vec<D> a, b, c, a_tail, b_tail, c_tail;
      TwoProduct(d, hx, ux, a, a_tail);
      TwoProduct(d, hy, uy, b, b_tail);
      TwoProduct(d, hz, uz, c, c_tail);
      a_tail = hn::MulAdd(hx_tail, ux, a_tail);
      b_tail = hn::MulAdd(hy_tail, uy, b_tail);
      c_tail = hn::MulAdd(hz_tail, uz, hn::MulAdd(hz, uz_tail, c_tail));
      const Vec<D> half_tail = Dot(a, b, c, a_tail, b_tail, c_tail);
      e = hn::MulAdd(c, c, hn::MulAdd(b, b, hn::MulAdd(a, a, hn::Add(half_tail, half_tail))));
      e_tail = hn::Zero(d);
    } else {
      Vec<D> a2, b2, c2, a2_tail, b2_tail, c2_tail, s, s_tail;
      SquareOfProduct(d, hx, ux, hn::Zero(d), a2, a2_tail);
      SquareOfProduct(d, hy, uy, hn::Zero(d), b2, b2_tail);
      SquareOfProduct(d, hz, uz, uz_tail, c2, c2_tail);
      TwoSum(a2, b2, s, s_tail);
      TwoSum(s, c2, e, e_tail);
      e_tail = hn::Add(hn::Add(e_tail, s_tail), hn::Add(hn::Add(a2_tail, b2_tail), c2_tail));
    }
  }

  template <class D>
  static HWY_INLINE Vec<D> UnitDensity(D, Vec<D> x, Vec<D> y, Vec<D> z) {
    return hn::MulAdd(x, x, hn::MulAdd(y, y, hn::Mul(z, z)));
  }

  // |vz| (1 + 2 Lambda) = sqrt(vz^2 + (alpha_x vx)^2 + (alpha_y vy)^2), from Heitz 2014 Eq. 86.
  template <Care kCare, Accuracy A, class D, class... P>
  static HWY_INLINE Vec<D> Masking(D d, Vec<D> vx, Vec<D> vy, Vec<D> z, P... p) {
    const Vec<D> square = hn::MulAdd(z, z, ProjectedRoughness2<kCare>(d, vx, vy, p...));
    return kCare != Care::kCareful ? SqrtOfPositive<A>(d, square) : Sqrt<A>(d, square);
  }

  // Lambda = t / (2 (1 + sqrt(1 + t))), t = tan^2 / a^2 form of Heitz 2014 Eq. 86: nothing cancels. vz is
  // scaled so that a subnormal cosine keeps its bits.
  template <Accuracy A, class D, class... P>
  static HWY_INLINE Vec<D> Lambda(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, P... p) {
    const Vec<D> z = hn::Abs(MesosurfaceCosine(d, vx, vy, vz, p...)), scale = Const(d, 0x1p60);
    const Vec<D> s2 = ProjectedRoughness2<Care::kCareful>(d, vx, vy, p...);
    const Vec<D> root = Sqrt<A>(d, hn::MulAdd(z, z, s2));
    const Vec<D> half = Const(d, 0.5);
    const Vec<D> zs = hn::Mul(z, scale);
    const Vec<D> q = hn::Div(hn::Mul(hn::Mul(s2, half), scale), hn::MulAdd(zs, root, hn::Mul(zs, z)));
    return ZeroIf(hn::Eq(s2, hn::Zero(d)), q);
  }

  // Walter 2007 Eqs. 35, 36: tan^2 = u1/(1 - u1).
  template <Care kCare, Accuracy A, class D, class... P>
  static HWY_INLINE void SampleNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> u1,
                                      Vec<D> u2, P... p) {
    u1 = BelowOne(d, u1);
    Vec<D> w, w_tail;
    OneMinus(d, u1, w, w_tail);
    NormalFromSlopes<false, kCare, A>(d, mx, my, mz, pdf, hn::Sqrt(hn::Mul(u1, w)), u1, hn::Zero(d), w,
                                      w_tail, u2, p...);
  }

  // factor over = (1 - k) z of Eto and Tokuyoshi 2023, z = |vz|.
  template <Accuracy A, class D, class... P>
  static HWY_INLINE void LeftOut(D d, Vec<D>& factor, Vec<D>& over, Vec<D> vx, Vec<D> vy, Vec<D> z, P... p) {
    const Vec<D> one = Const(d, 1), smaller = hn::Min(AlphaX(p...), AlphaY(p...));
    const Vec<D> a = hn::IfThenElse(hn::Gt(smaller, one), one, smaller), a2 = hn::Mul(a, a);
    const Vec<D> t = hn::Add(one, Sqrt<A>(d, hn::MulAdd(vx, vx, hn::Mul(vy, vy)))), t2 = hn::Mul(t, t);
    over = Div<A>(d, z, hn::MulAdd(a2, hn::Mul(z, z), t2));
    factor = hn::Mul(a2, hn::MulAdd(z, z, t2));
  }

  // NOLINTBEGIN(misc-const-correctness): what one instantiation leaves alone, another assigns.
  // Spherical caps (Dupuy and Benyoub 2023), every length times r = |q|, q = (alpha_x vx, alpha_y vy, |vz|),
  // so that nothing is normalised before the end. With s = q/r, the point c of the cap above -k s.z has 1 -
  // c.z = u1 (1 + k s.z) and 1 + c.z = 2 (1 - u1) + u1 (1 - k s.z), where r^2 (1 - (k s.z)^2) is
  //   (alpha_x vx)^2 + (alpha_y vy)^2 + (1 - k) |vz| (2 |vz| - (1 - k) |vz|):
  // no sum cancels. Then H = r (c + s) and M = (alpha_x Hx, alpha_y Hy, Hz) give m = M/|M| and, because v.M =
  // |H|^2 / 2,
  //   pdf = |M|^3 / (pi alpha_x alpha_y (r + k |vz|) |H|^2).
  // k = 1 for all visible normals, pdf = D_v(m). kBounded: k of Eto and Tokuyoshi 2023 leaves out normals
  // that reflect v below the surface.
  //
  // H, with kTails what rounding took from Hz, r, and r + k |vz| in `rz`.
  template <bool kBounded, bool kTails, Accuracy A, class D, class... P>
  static HWY_INLINE void CapHalfVector(D d, Vec<D>& hx, Vec<D>& hy, Vec<D>& hz, Vec<D>& hz_tail, Vec<D>& r,
                                       Vec<D>& rz, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> u1, Vec<D> u2,
                                       P... p) {
    const Vec<D> zero = hn::Zero(d), ax = AlphaX(p...), ay = AlphaY(p...);
    const Vec<D> z = hn::Abs(vz);
    const auto below = hn::Lt(vz, zero);
    const Vec<D> qx = hn::Mul(ax, hn::IfThenElse(below, hn::Neg(vx), vx));
    const Vec<D> qy = hn::Mul(ay, hn::IfThenElse(below, hn::Neg(vy), vy));
    u1 = BelowOne(d, u1);
    Vec<D> w, w_tail;
    OneMinus(d, u1, w, w_tail);
    const Vec<D> s2 = hn::MulAdd(qx, qx, hn::Mul(qy, qy));
    r = CloseSqrt<A>(d, hn::MulAdd(z, z, s2));
    rz = hn::Add(r, z);
    // whole + whole_tail = w (r + |vz|), kept + whole_tail = w (r + k |vz|), beside = r^2 - (k vz)^2.
    const Vec<D> whole = hn::Mul(w, rz);
    Vec<D> whole_tail = zero;
    if constexpr (kTails) {
      const Vec<D> rz_tail = hn::Add(hn::Sub(r, rz), z);
      whole_tail = hn::MulAdd(w_tail, rz, hn::MulAdd(w, rz_tail, hn::MulSub(w, rz, whole)));
    }
    Vec<D> kept = whole, beside = s2;
    hz = whole;
    hz_tail = whole_tail;
    if constexpr (kBounded) {
      Vec<D> factor, over;
      LeftOut<A>(d, factor, over, vx, vy, z, p...);
      const Vec<D> rest = hn::Mul(factor, over);
      rz = hn::Sub(rz, rest);
      kept = hn::NegMulAdd(w, rest, whole);
      beside = hn::MulAdd(rest, hn::Sub(hn::Add(z, z), rest), s2);
      if constexpr (kTails) {
        Vec<D> added, added_tail;
        TwoProduct(d, u1, rest, added, added_tail);
        TwoSum(whole, added, hz, hz_tail);
        hz_tail = hn::Add(hn::Add(hz_tail, added_tail), whole_tail);
      } else {
        hz = hn::MulAdd(u1, rest, whole);
      }
    }
    const Vec<D> two_r = hn::Add(r, r);
    beside = hn::Mul(u1, beside);
    if constexpr (kTails) beside = hn::MulAdd(whole_tail, two_r, beside);
    const Vec<D> sine2 = hn::Mul(u1, hn::MulAdd(kept, two_r, beside));
    const Vec<D> sine = CloseSqrt<A>(d, sine2);
    Vec<D> sin, cos;
    SinCos2Pi<A>(d, u2, sin, cos);
    hx = hn::MulAdd(sine, cos, qx);
    hy = hn::MulAdd(sine, sin, qy);
  }

  template <bool kBounded, Accuracy A, class D, class... P>
  static HWY_INLINE void SampleVisibleNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> vx,
                                             Vec<D> vy, Vec<D> vz, Vec<D> u1, Vec<D> u2, P... p) {
    const Vec<D> ax = AlphaX(p...), ay = AlphaY(p...);
    Vec<D> hx, hy, hz, hz_tail, r, rz;
    CapHalfVector<kBounded, false, A>(d, hx, hy, hz, hz_tail, r, rz, vx, vy, vz, u1, u2, p...);
    const Vec<D> x = hn::Mul(ax, hx), y = hn::Mul(ay, hy);
    const Vec<D> length2 = Dot(x, y, hz, x, y, hz);
    // |H|^2 times a power of two that keeps all products in range, for |H| from 2^-24 1e-5 on.
    const Vec<D> scale = Const(d, 0x1p50);
    const Vec<D> h2 = Dot(hx, hy, hz, hx, hy, hz);
    const Vec<D> area = hn::Mul(hn::Mul(hn::Mul(ax, ay), Const(d, kPi)), rz);
    const Vec<D> divisor = hn::Mul(hn::Mul(h2, scale), area);
    if constexpr (A == Accuracy::kFast) {
      const Vec<D> inverse = RefinedReciprocalSqrt(d, length2);
      pdf = hn::Mul(hn::Mul(length2, FastReciprocal(d, divisor)), hn::Mul(hn::Mul(length2, scale), inverse));
      mx = hn::Mul(x, inverse);
      my = hn::Mul(y, inverse);
      mz = hn::Mul(hz, inverse);
    } else {
      const Vec<D> both = hn::Div(Const(d, 1), hn::Mul(hn::Sqrt(length2), divisor));
      const Vec<D> inverse = hn::Mul(both, divisor);
      pdf = hn::Mul(hn::Mul(length2, both), hn::Mul(length2, scale));
      mx = hn::Mul(x, inverse);
      my = hn::Mul(y, inverse);
      mz = hn::Mul(hz, inverse);
    }
  }

  // Reflection about a visible normal, of the ideal mirror: with t = |H|^2/|M|^2 = 2 v.M/|M|^2,
  //   o = t M - v,  pdf = 1/(2 pi alpha_x alpha_y (r + k |vz|) t^2)  (Walter 2007 Eq. 14),
  // where o takes t from v.M, so that |o| = |v| whatever M lost where c and s cancel, and the density from
  // |H|^2; and with mu = |z| (1 + 2 Lambda), of v the r above, the weight G2/G1 (1 + k s.z)/(1 + s.z) is
  //   (r + k |vz|) oz / (mu_v oz + mu_o |vz|)
  // of height-correlated masking. cos2 = (v.m)^2.
  template <bool kBounded, JointMasking kG, Accuracy A, class D, class... P>
  static HWY_INLINE void SampleVisibleReflection(D d, Vec<D>& ox, Vec<D>& oy, Vec<D>& oz, Vec<D>& weight,
                                                 Vec<D>& pdf, Vec<D>& lobe, Vec<D>& cos2, Vec<D> vx,
                                                 Vec<D> vy, Vec<D> vz, Vec<D> u1, Vec<D> u2, P... p) {
    static_assert(!kBounded || kG == JointMasking::kHeightCorrelated);
    constexpr bool kTails = A != Accuracy::kFast;
    const Vec<D> zero = hn::Zero(d), ax = AlphaX(p...), ay = AlphaY(p...);
    Vec<D> hx, hy, hz, hz_tail, r, rz;
    CapHalfVector<kBounded, kTails, A>(d, hx, hy, hz, hz_tail, r, rz, vx, vy, vz, u1, u2, p...);
    const auto below = hn::Lt(vz, zero);
    const Vec<D> z = hn::Abs(vz), x = hn::Mul(ax, hx), y = hn::Mul(ay, hy);
    Vec<D> z2 = hn::Mul(hz, hz);
    if constexpr (kTails) z2 = hn::MulAdd(hz, hz, hn::Mul(hz, hn::Add(hz_tail, hz_tail)));
    const Vec<D> m2 = hn::MulAdd(y, y, hn::MulAdd(x, x, z2)), h2 = hn::MulAdd(hy, hy, hn::MulAdd(hx, hx, z2));
    // 1/|M|^2 to a rounding in the fast accuracy too: o is the difference of s M and v.
    const Vec<D> r_m2 = RefinedReciprocal<A>(d, m2);
    Vec<D> v_m =
        Dot(hn::IfThenElse(below, hn::Neg(vx), vx), hn::IfThenElse(below, hn::Neg(vy), vy), z, x, y, hz);
    if constexpr (kTails) v_m = hn::MulAdd(z, hz_tail, v_m);
    // 1/t^2 less what the division has left.
    const Vec<D> q = Div<A>(d, m2, h2), q2 = hn::Mul(q, q);
    const Vec<D> left = hn::Mul(hn::NegMulAdd(q, h2, m2), hn::Add(r_m2, r_m2));
    const Vec<D> area = hn::Mul(hn::Mul(hn::Mul(ax, ay), Const(d, 2 * kPi)), rz);
    const Vec<D> density = Div<A>(d, hn::MulAdd(q2, left, q2), area);
    cos2 = hn::Mul(v_m, hn::Mul(v_m, r_m2));
    ReflectAboutVisible<Ggx, kG, A>(d, ox, oy, oz, weight, pdf, lobe, hn::Mul(hn::Add(v_m, v_m), r_m2), x, y,
                                    hz, hz_tail, density, r, rz, vx, vy, vz, p...);
  }
  // NOLINTEND(misc-const-correctness)
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_GGX_INL_H_
