// Roughness as a stretch (Heitz 2014 section 5): maps applied to directions so that a distribution needs unit
// roughness only. One alpha: isotropic; two: anisotropic; r_xy behind them: rotated; mean_x, mean_y behind
// that: off-centre.
#if defined(MICROLANE_STRETCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_STRETCH_INL_H_
#undef MICROLANE_STRETCH_INL_H_
#else
#define MICROLANE_STRETCH_INL_H_
#endif

#include "microlane/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// How far a lane function goes for accuracy and range. kPlain: rounding errors as they come, for inputs whose
// products stay in range. kCareful: rounding errors of products carried, powers of two taken out of every
// factor.
enum class Care { kPlain, kCompensated, kCareful };

// alpha = m / scale with scale a power of two and m in [1, 2); kPlain: m = alpha, scale = 1. Total: kCareful
// keeps alpha within 2^-40 and 2^40; NaN passes.
template <Care kCare, class D>
HWY_INLINE void SplitAlpha(D d, Vec<D> alpha, Vec<D>& m, Vec<D>& scale) {
  if constexpr (kCare != Care::kCareful) {
    m = alpha;
    scale = Const(d, 1);
  } else {
    const hn::RebindToUnsigned<D> du;
    using U = hn::TFromD<decltype(du)>;
    constexpr U kExponent = kIsFloat<D> ? static_cast<U>(0x7F800000u) : static_cast<U>(0x7FF0000000000000u);
    constexpr U kTwiceBias = kIsFloat<D> ? static_cast<U>(0x7F000000u) : static_cast<U>(0x7FE0000000000000u);
    const Vec<D> low = Const(d, 0x1p-40), high = Const(d, 0x1p40);
    alpha = hn::IfThenElse(hn::Lt(alpha, low), low, alpha);
    alpha = hn::IfThenElse(hn::Gt(alpha, high), high, alpha);
    const auto exponent = hn::And(hn::BitCast(du, alpha), hn::Set(du, kExponent));
    scale = hn::BitCast(d, hn::Sub(hn::Set(du, kTwiceBias), exponent));
    m = hn::Mul(alpha, scale);
  }
}

// Factors (ux, uy, uz + uz_tail) and w such that, for any half vector H (not normalised), with A = Hx ux, B =
// Hy uy, C = Hz uz, a distribution of slopes f (Heitz 2014 Eqs. 65, 73) has
//   D(H/|H|) / |H|^4 = w f((A^2 + B^2)/C^2) / C^4.
template <Care kCare, class D>
HWY_INLINE void Stretch(D d, Vec<D>& ux, Vec<D>& uy, Vec<D>& uz, Vec<D>& uz_tail, Vec<D>& w, Vec<D> alpha_x,
                        Vec<D> alpha_y) {
  Vec<D> ax, ay, sx, sy;
  SplitAlpha<kCare>(d, alpha_x, ax, sx);
  SplitAlpha<kCare>(d, alpha_y, ay, sy);
  if constexpr (kCare != Care::kCareful) {
    ux = ay;
    uy = ax;
    Vec<D> last = hn::Mul(ax, ay);  // NOLINT(misc-const-correctness)
    uz = last;
    uz_tail = hn::Zero(d);
    if constexpr (kCare == Care::kCompensated) {
      TwoProduct(d, ax, ay, uz, uz_tail);
      last = hn::MulAdd(Const(d, 3), uz_tail, uz);  // takes up three tails for one rounding
    }
    w = hn::Mul(hn::Mul(uz, uz), last);
  } else {
    ux = hn::Mul(ay, sx);
    uy = hn::Mul(ax, sy);
    TwoProduct(d, ax, ay, uz, uz_tail);
    Vec<D> square, square_tail;
    TwoProduct(d, uz, uz, square, square_tail);
    square_tail = hn::MulAdd(hn::Add(uz, uz), uz_tail, square_tail);
    const Vec<D> cube = hn::MulAdd(square, uz, hn::MulAdd(square, uz_tail, hn::Mul(square_tail, uz)));
    w = hn::Mul(cube, hn::Mul(sx, sy));
  }
}

template <Care kCare, class D>
HWY_INLINE void Stretch(D d, Vec<D>& ux, Vec<D>& uy, Vec<D>& uz, Vec<D>& uz_tail, Vec<D>& w, Vec<D> alpha) {
  Vec<D> s;
  SplitAlpha<kCare>(d, alpha, uz, s);
  ux = uy = s;
  uz_tail = hn::Zero(d);
  w = hn::Mul(hn::Mul(uz, uz), hn::Mul(s, s));
}

// (alpha_x x)^2 + (alpha_y y)^2: the squared slope scale seen along a direction, times sin^2 (Heitz 2014 Eq.
// 80).
template <Care kCare, class D>
HWY_INLINE Vec<D> ProjectedRoughness2(D d, Vec<D> x, Vec<D> y, Vec<D> alpha_x, Vec<D> alpha_y) {
  const Vec<D> a = hn::Mul(alpha_x, x), b = hn::Mul(alpha_y, y);
  if constexpr (kCare != Care::kCareful) {
    (void)d;
    return hn::MulAdd(a, a, hn::Mul(b, b));
  } else {
    Vec<D> p, a_tail, b_tail;
    TwoProduct(d, alpha_x, x, p, a_tail);
    TwoProduct(d, alpha_y, y, p, b_tail);
    const Vec<D> tail = hn::MulAdd(a, a_tail, hn::Mul(b, b_tail));
    return hn::MulAdd(a, a, hn::MulAdd(b, b, hn::Add(tail, tail)));
  }
}

template <Care kCare, class D>
HWY_INLINE Vec<D> ProjectedRoughness2(D d, Vec<D> x, Vec<D> y, Vec<D> alpha) {
  return ProjectedRoughness2<kCare>(d, x, y, alpha, alpha);
}

// Parameters come as those of a distribution's own shape, Dist::kOwn of them, then those of its roughness.
//
// f of all but the first kCount, and of those: of the roughness alone, and of the shape's own.
template <size_t kCount, class F, class First, class... Rest>
HWY_INLINE auto WithoutFirst(const F& f, First first, Rest... rest) {
  if constexpr (kCount == 0) {
    return f(first, rest...);
  } else {
    return WithoutFirst<kCount - 1>(f, rest...);
  }
}
template <size_t kCount, class F, class First, class... Rest>
HWY_INLINE auto WithFirst(const F& f, First first, Rest... rest) {
  if constexpr (kCount == 0) {
    return f();
  } else {
    return WithFirst<kCount - 1>([&](auto... more) HWY_ATTR { return f(first, more...); }, rest...);
  }
}
template <class Dist, class F, class... P>
HWY_INLINE auto OfRoughness(const F& f, P... p) {
  return WithoutFirst<Dist::kOwn>(f, p...);
}
template <class Dist, class F, class... P>
HWY_INLINE auto OfShape(const F& f, P... p) {
  return WithFirst<Dist::kOwn>(f, p...);
}

// Kinds of roughness that shear: sums of products cancel, so they are formed in double lanes.
template <class Dist, class... P>
inline constexpr bool kShears = sizeof...(P) - Dist::kOwn > 2;
template <class Dist, class... P>
inline constexpr bool kHasMean = sizeof...(P) - Dist::kOwn > 3;

// sqrt(1 - r^2): 1 - r is exact near 1.
template <class D>
HWY_INLINE Vec<D> Uncorrelated(D d, Vec<D> r_xy) {
  const Vec<D> one = Const(d, 1);
  return hn::Sqrt(hn::Mul(hn::Sub(one, r_xy), hn::Add(one, r_xy)));
}

// Numerators and denominator of the slopes at unit roughness of a normal H, not normalised: Heitz 2014
// Eqs. 92, 95 are (x^2 + y^2)/Hz^2. `area` is alpha_x alpha_y sqrt(1 - r^2).
template <class D>
HWY_INLINE void UnitSlopes(D d, Vec<D>& x, Vec<D>& y, Vec<D>& area, Vec<D> hx, Vec<D> hy, Vec<D> alpha_x,
                           Vec<D> alpha_y, Vec<D> r_xy) {
  const Vec<D> s = Uncorrelated(d, r_xy), one = Const(d, 1);
  area = hn::Mul(hn::Mul(alpha_x, alpha_y), s);
  x = hn::Mul(hx, hn::Div(one, alpha_x));
  y = hn::Mul(hn::NegMulAdd(r_xy, x, hn::Mul(hy, hn::Div(one, alpha_y))), hn::Div(one, s));
}
template <class D>
HWY_INLINE void UnitSlopes(D d, Vec<D>& x, Vec<D>& y, Vec<D>& area, Vec<D> hx, Vec<D> hy, Vec<D> hz,
                           Vec<D> alpha_x, Vec<D> alpha_y, Vec<D> r_xy) {
  (void)hz;
  UnitSlopes(d, x, y, area, hx, hy, alpha_x, alpha_y, r_xy);
}
template <class D>
HWY_INLINE void UnitSlopes(D d, Vec<D>& x, Vec<D>& y, Vec<D>& area, Vec<D> hx, Vec<D> hy, Vec<D> hz,
                           Vec<D> alpha_x, Vec<D> alpha_y, Vec<D> r_xy, Vec<D> mean_x, Vec<D> mean_y) {
  UnitSlopes(d, x, y, area, hn::MulAdd(mean_x, hz, hx), hn::MulAdd(mean_y, hz, hy), alpha_x, alpha_y, r_xy);
}

// alpha_o^2 sin^2 of Heitz 2014 Eqs. 93, 97, as a sum of squares.
struct ShearedRoughness2Op {
  template <class DD>
  static HWY_INLINE void Run(DD dd, Vec<DD>& square, Vec<DD>& unused, Vec<DD> vx, Vec<DD> vy, Vec<DD> alpha_x,
                             Vec<DD> alpha_y, Vec<DD> r_xy) {
    const Vec<DD> y = hn::Mul(alpha_y, vy), b = hn::Mul(Uncorrelated(dd, r_xy), y);
    const Vec<DD> a = hn::MulAdd(r_xy, y, hn::Mul(alpha_x, vx));
    square = unused = hn::MulAdd(a, a, hn::Mul(b, b));
  }
};
template <Care, class D>
HWY_INLINE Vec<D> ProjectedRoughness2(D d, Vec<D> vx, Vec<D> vy, Vec<D> alpha_x, Vec<D> alpha_y,
                                      Vec<D> r_xy) {
  Vec<D> square, unused;
  InDouble2<ShearedRoughness2Op>(d, square, unused, vx, vy, alpha_x, alpha_y, r_xy);
  return square;
}
template <Care kCare, class D>
HWY_INLINE Vec<D> ProjectedRoughness2(D d, Vec<D> vx, Vec<D> vy, Vec<D> alpha_x, Vec<D> alpha_y, Vec<D> r_xy,
                                      Vec<D> /*mean_x*/, Vec<D> /*mean_y*/) {
  return ProjectedRoughness2<kCare>(d, vx, vy, alpha_x, alpha_y, r_xy);
}

// vz - mean_x vx - mean_y vy, from products that are exact, as those of floats are: right to a few roundings
// where it cancels.
struct MesosurfaceOp {
  template <class DD>
  static HWY_INLINE void Run(DD, Vec<DD>& cosine, Vec<DD>& unused, Vec<DD> vx, Vec<DD> vy, Vec<DD> vz,
                             Vec<DD> mean_x, Vec<DD> mean_y) {
    Vec<DD> s, s_tail, t, t_tail;
    TwoSum(hn::Mul(mean_x, vx), hn::Mul(mean_y, vy), s, s_tail);
    TwoSum(vz, hn::Neg(s), t, t_tail);
    cosine = unused = hn::Add(t, hn::Sub(t_tail, s_tail));
  }
};

// v.n over the projected area of the mesosurface's normal: the cosine that masking goes by (Heitz 2014
// Eq. 96). vz but off-centre.
template <class D, class... P>
HWY_INLINE Vec<D> MesosurfaceCosine(D, Vec<D>, Vec<D>, Vec<D> vz, P...) {
  return vz;
}
template <class D>
HWY_INLINE Vec<D> MesosurfaceCosine(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, Vec<D> /*alpha_x*/,
                                    Vec<D> /*alpha_y*/, Vec<D> /*r_xy*/, Vec<D> mean_x, Vec<D> mean_y) {
  Vec<D> cosine, unused;
  InDouble2<MesosurfaceOp>(d, cosine, unused, vx, vy, vz, mean_x, mean_y);
  return cosine;
}

template <class V>
HWY_INLINE V AlphaX(V alpha_x, V /*alpha_y*/) {
  return alpha_x;
}
template <class V>
HWY_INLINE V AlphaX(V alpha) {
  return alpha;
}
template <class V>
HWY_INLINE V AlphaY(V /*alpha_x*/, V alpha_y) {
  return alpha_y;
}
template <class V>
HWY_INLINE V AlphaY(V alpha) {
  return alpha;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_STRETCH_INL_H_
