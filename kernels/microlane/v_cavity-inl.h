// Light inside V-cavities (Meneveaux 2015 section 3.3) in lanes: a path a lane, one facet after the other.
//
// In the frame of the facet that a path is at, u lies along the horizontal part of its normal m = (s, 0, c),
// v along the cavity and z along the surface's normal. The facet is t (-c, s), t from 0 at the bottom to 1,
// in (u, z), the other one has the normal m' = (-s, 0, c), and half a turn about z makes it the first: (u, v)
// and the world's direction of u change sign.
#if defined(MICROLANE_V_CAVITY_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_V_CAVITY_INL_H_
#undef MICROLANE_V_CAVITY_INL_H_
#else
#define MICROLANE_V_CAVITY_INL_H_
#endif

#include "microlane/distribution-inl.h"
#include "microlane/interfaced-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// Four random words of the four words that count: pcg4d of Jarzynski and Olano 2020.
template <class DU>
HWY_INLINE void RandomWords(DU du, Vec<DU>& x, Vec<DU>& y, Vec<DU>& z, Vec<DU>& w) {
  const Vec<DU> factor = hn::Set(du, 1664525u), term = hn::Set(du, 1013904223u);
  x = hn::Add(hn::Mul(x, factor), term);
  y = hn::Add(hn::Mul(y, factor), term);
  z = hn::Add(hn::Mul(z, factor), term);
  w = hn::Add(hn::Mul(w, factor), term);
  const auto stir = [&]() HWY_ATTR {
    x = hn::Add(x, hn::Mul(y, w));
    y = hn::Add(y, hn::Mul(z, x));
    z = hn::Add(z, hn::Mul(x, y));
    w = hn::Add(w, hn::Mul(y, z));
  };
  stir();
  x = hn::Xor(x, hn::ShiftRight<16>(x));
  y = hn::Xor(y, hn::ShiftRight<16>(y));
  z = hn::Xor(z, hn::ShiftRight<16>(z));
  w = hn::Xor(w, hn::ShiftRight<16>(w));
  stir();
}

// The first 24 bits, as a whole number.
template <class D, class VU>
HWY_INLINE Vec<D> WholeNumber(D d, VU bits) {
  return hn::ConvertTo(d, hn::BitCast(hn::RebindToSigned<D>(), hn::ShiftRight<8>(bits)));
}
// The same times 2^-24: uniform in [0, 1).
template <class D, class VU>
HWY_INLINE Vec<D> UniformNumber(D d, VU bits) {
  return hn::Mul(WholeNumber(d, bits), Const(d, 0x1p-24));
}

// A path's first facet, by what the direction w sees of a cavity whose normal is drawn by D cos, and a point
// uniform on what it sees of the facet; its frame, turned from the world's by (ex, ey), and w in it. With z =
// c wz and across = s wu, w sees z + across and z - across of the facets, in all 2 z, and of the first the
// share min(1, 2 z/(z + across)) from the top down.
template <class Dist, class D>
HWY_INLINE void EnterVCavity(D d, Vec<D>& iu, Vec<D>& iv, Vec<D>& s, Vec<D>& c, Vec<D>& t, Vec<D>& ex,
                             Vec<D>& ey, Vec<D> wx, Vec<D> wy, Vec<D> wz, Vec<D> u1, Vec<D> u2, Vec<D> u3,
                             Vec<D> u4, Vec<D> alpha_x, Vec<D> alpha_y) {
  constexpr Accuracy kAccuracy = Accuracy::kStandard;
  const Vec<D> zero = hn::Zero(d), one = Const(d, 1);
  Vec<D> mx, my, mz, unused;
  Dist::template SampleNormal<Care::kPlain, kAccuracy>(d, mx, my, mz, unused, u1, u2, alpha_x, alpha_y);
  // Steeper cavities would hold paths for too long.
  c = hn::Max(mz, Const(d, 0x1p-16));
  s = hn::Sqrt(hn::MulAdd(mx, mx, hn::Mul(my, my)));
  const auto flat = hn::Eq(s, zero);
  const Vec<D> inverse = hn::Div(one, hn::IfThenElse(flat, one, s));
  ex = hn::IfThenElse(flat, one, hn::Mul(mx, inverse));
  ey = hn::Mul(my, inverse);
  iu = hn::MulAdd(wx, ex, hn::Mul(wy, ey));
  iv = hn::MulSub(wy, ex, hn::Mul(wx, ey));
  const Vec<D> z = hn::Mul(c, wz), two_z = hn::Add(z, z), across = hn::Mul(s, iu);
  const auto other = hn::Lt(hn::Mul(two_z, u3), hn::Sub(z, across));
  const Vec<D> turn = hn::IfThenElseZero(other, hn::SignBit(d));
  ex = hn::Xor(ex, turn);
  ey = hn::Xor(ey, turn);
  iu = hn::Xor(iu, turn);
  iv = hn::Xor(iv, turn);
  const Vec<D> seen = hn::Max(hn::Add(z, hn::Xor(across, turn)), two_z);  // two_z: all of the facet
  t = hn::NegMulAdd(u4, hn::Div(two_z, seen), one);
}

// The direction that a mirror reflects i to.
template <class D>
HWY_INLINE void ReflectAtFacet(D, Vec<D>& ou, Vec<D>& ov, Vec<D>& oz, Vec<D> iu, Vec<D> iv, Vec<D> iz,
                               Vec<D> s, Vec<D> c, Vec<D> cos_i) {
  const Vec<D> twice = hn::Add(cos_i, cos_i);
  ou = hn::MulSub(twice, s, iu);
  ov = hn::Neg(iv);
  oz = hn::MulSub(twice, c, iz);
}

// A direction by the cosine with the facet's normal, which is cos_o.
template <class D>
HWY_INLINE void SampleFacetCosine(D d, Vec<D>& ou, Vec<D>& ov, Vec<D>& oz, Vec<D>& cos_o, Vec<D> u1,
                                  Vec<D> u2, Vec<D> s, Vec<D> c) {
  Vec<D> sin, cos;
  SinCos2Pi<Accuracy::kStandard>(d, u1, sin, cos);
  const Vec<D> r = hn::Sqrt(u2), along = hn::Mul(r, cos);
  cos_o = hn::Sqrt(hn::Sub(Const(d, 1), u2));
  ou = hn::MulAdd(c, along, hn::Mul(s, cos_o));
  ov = hn::Mul(r, sin);
  oz = hn::MulSub(c, cos_o, hn::Mul(s, along));
}

// Whether o, which leaves the facet at t, meets the other one, and where: at t o.m/-(o.m').
template <class D>
HWY_INLINE hn::Mask<D> MeetsOtherFacet(D d, Vec<D>& next, Vec<D> ou, Vec<D> oz, Vec<D> s, Vec<D> c,
                                       Vec<D> t) {
  const Vec<D> zero = hn::Zero(d), one = Const(d, 1);
  const Vec<D> away = hn::Max(zero, hn::MulAdd(s, ou, hn::Mul(c, oz)));
  const Vec<D> towards = hn::MulSub(s, ou, hn::Mul(c, oz)), reach = hn::Mul(t, away);
  const auto meets = hn::And(hn::Gt(towards, zero), hn::Le(reach, towards));
  next = hn::Div(reach, hn::IfThenElse(meets, towards, one));
  return meets;
}

// The cell of a direction above the surface: rows of equal height in z, columns of equal azimuth.
template <class D>
HWY_INLINE Vec<hn::RebindToSigned<D>> HemisphereCell(D d, Vec<D> x, Vec<D> y, Vec<D> z, Vec<D> rows,
                                                     Vec<D> columns) {
  const hn::RebindToSigned<D> di;
  const Vec<D> zero = hn::Zero(d), one = Const(d, 1);
  const Vec<D> half =
      hn::Mul(AzimuthDifference<Accuracy::kStandard>(d, one, zero, x, y), Const(d, 0.5 / kPi));
  const Vec<D> turns = hn::IfThenElse(hn::Lt(y, zero), hn::Sub(one, half), half);
  const auto place = [&](Vec<D> part, Vec<D> number) HWY_ATTR {
    const Vec<D> at = hn::Min(hn::Mul(hn::Max(part, zero), number), hn::Sub(number, one));
    return hn::ConvertTo(di, hn::Floor(at));
  };
  const auto row = place(z, rows), column = place(turns, columns);
  return hn::Add(hn::Mul(row, hn::ConvertTo(di, columns)), column);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_V_CAVITY_INL_H_
