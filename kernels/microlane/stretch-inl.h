// Roughness as a stretch (Heitz 2014 section 5): maps applied to directions so that a distribution needs unit
// roughness only. One alpha: isotropic; two: anisotropic.
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
    Vec<D> last = hn::Mul(ax, ay);
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
