// Slopes by a table of radial_table.h in lanes: its entries, then any roughness of stretch-inl.h.
#if defined(MICROLANE_TABULATED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_TABULATED_INL_H_
#undef MICROLANE_TABULATED_INL_H_
#else
#define MICROLANE_TABULATED_INL_H_
#endif

#include <cmath>
#include <type_traits>

#include "microlane/ggx-inl.h"
#include "microlane/radial_table.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

template <class DD>
using TableIndex = Vec<hn::RebindToSigned<DD>>;

// The cell of u = 1 + x, 2^kBits to an octave, and how far along: u counts octaves and cells in its exponent
// and leading bits.
template <size_t kBits, class DD>
HWY_INLINE void FindPlace(DD dd, Vec<DD> u, TableIndex<DD>& cell, Vec<DD>& part) {
  constexpr int kPartBits = 52 - static_cast<int>(kBits);
  const hn::RebindToUnsigned<DD> du;
  const hn::RebindToSigned<DD> di;
  const Vec<DD> one = Const(dd, 1);
  const auto bits = hn::Sub(hn::BitCast(du, u), hn::BitCast(du, one));
  cell = hn::BitCast(di, hn::ShiftRight<kPartBits>(bits));
  const auto rest =
      hn::And(hn::ShiftLeft<static_cast<int>(kBits)>(bits), hn::Set(du, (std::uint64_t{1} << 52) - 1));
  part = hn::Sub(hn::BitCast(dd, hn::Or(rest, hn::BitCast(du, one))), one);
}
// u where a cell begins.
template <size_t kBits, class DD>
HWY_INLINE Vec<DD> PlaceBegin(DD dd, TableIndex<DD> cell) {
  const hn::RebindToSigned<DD> di;
  return hn::BitCast(
      dd, hn::Add(hn::ShiftLeft<52 - static_cast<int>(kBits)>(cell), hn::BitCast(di, Const(dd, 1))));
}

template <class DD>
HWY_INLINE void LoadCubic(DD dd, const double* cells, TableIndex<DD> cell, Vec<DD>& c0, Vec<DD>& c1,
                          Vec<DD>& c2, Vec<DD>& c3) {
  const auto first = hn::ShiftLeft<2>(cell);
  c0 = hn::GatherIndex(dd, cells, first);
  c1 = hn::GatherIndex(dd, cells + 1, first);
  c2 = hn::GatherIndex(dd, cells + 2, first);
  c3 = hn::GatherIndex(dd, cells + 3, first);
}

// g(x) of a curve, x >= 0 or NaN, in double lanes.
template <class DD>
HWY_INLINE Vec<DD> CurveAt(DD dd, const RadialCurve& curve, Vec<DD> x) {
  const Vec<DD> one = Const(dd, 1), end = Const(dd, curve.end), u = hn::Add(one, x);
  const auto near = hn::Lt(u, Const(dd, 1 + curve.end));  // false of NaN
  TableIndex<DD> cell;
  Vec<DD> p, c0, c1, c2, c3;
  FindPlace<RadialCurve::kCellBits>(dd, hn::IfThenElse(near, u, one), cell, p);
  LoadCubic(dd, curve.cells, cell, c0, c1, c2, c3);
  const Vec<DD> g = hn::MulAdd(hn::MulAdd(hn::MulAdd(c3, p, c2), p, c1), p, c0);
  if (HWY_LIKELY(hn::AllTrue(dd, near))) return g;
  const Vec<DD> log = LogOnePlusRatio(dd, hn::Max(hn::Sub(x, end), hn::Zero(dd)), end);
  const Vec<DD> tail = hn::MulAdd(Const(dd, curve.tail_slope), log, Const(dd, curve.tail_value));
  return hn::IfThenElse(near, g, tail);
}

// g(x, y) of a surface, x and y >= 0: the cubic through the rows at 0, 1/4, 3/4 and 1 of a cell of x.
template <class DD>
HWY_INLINE Vec<DD> SurfaceAt(DD dd, const RadialSurface& surface, Vec<DD> x, Vec<DD> y) {
  const hn::RebindToSigned<DD> di;
  using Index = hn::TFromD<decltype(di)>;
  const Vec<DD> one = Const(dd, 1), below_one = Const(dd, 0x1.fffffffffffffp-1);
  // 1 + x within the cells, whatever x is: NaN has a logarithm here.
  const auto within = [&](Vec<DD> at, auto cells, auto bits) HWY_ATTR {
    const auto past = hn::Set(di, static_cast<Index>(cells));
    const Vec<DD> u = hn::Add(one, at), end = hn::Mul(PlaceBegin<decltype(bits)::value>(dd, past), below_one);
    return hn::IfThenElse(hn::Ge(u, one), hn::Min(u, end), one);
  };
  using RowBits = std::integral_constant<size_t, RadialSurface::kRowBits>;
  using CellBits = std::integral_constant<size_t, RadialSurface::kCellBits>;
  TableIndex<DD> row, column;
  Vec<DD> p, q;
  FindPlace<RowBits::value>(dd, within(x, surface.row_cells, RowBits()), row, p);
  FindPlace<CellBits::value>(dd, within(y, surface.count, CellBits()), column, q);
  // Lagrange's weights.
  const Vec<DD> p1 = hn::Sub(p, Const(dd, 0.25)), p2 = hn::Sub(p, Const(dd, 0.75)), p3 = hn::Sub(p, one);
  const Vec<DD> outer = hn::Mul(p1, p2), inner = hn::Mul(p, p3);
  const Vec<DD> weight[] = {
      hn::Mul(Const(dd, -16.0 / 3), hn::Mul(outer, p3)), hn::Mul(Const(dd, 32.0 / 3), hn::Mul(inner, p2)),
      hn::Mul(Const(dd, -32.0 / 3), hn::Mul(inner, p1)), hn::Mul(Const(dd, 16.0 / 3), hn::Mul(outer, p))};
  // 3 row count + column; the numbers are small.
  const auto three_rows = hn::Add(hn::Add(row, row), row);
  const Vec<DD> first_row =
      hn::Mul(hn::ConvertTo(dd, three_rows), Const(dd, static_cast<double>(surface.count)));
  auto cell = hn::Add(hn::ConvertTo(di, first_row), column);
  Vec<DD> c0 = hn::Zero(dd), c1 = c0, c2 = c0, c3 = c0;
  for (size_t k = 0; k < 4; ++k) {
    Vec<DD> r0, r1, r2, r3;
    LoadCubic(dd, surface.cells, cell, r0, r1, r2, r3);
    c0 = hn::MulAdd(weight[k], r0, c0);
    c1 = hn::MulAdd(weight[k], r1, c1);
    c2 = hn::MulAdd(weight[k], r2, c2);
    c3 = hn::MulAdd(weight[k], r3, c3);
    cell = hn::Add(cell, hn::Set(di, static_cast<Index>(surface.count)));
  }
  return hn::MulAdd(hn::MulAdd(hn::MulAdd(c3, q, c2), q, c1), q, c0);
}

// The slope t >= -a of unit roughness, at most 2^200, above which the share u of visible normals is, whose
// density is that of max(0, a + t) P(t), P = W'' (Heitz 2014 Eq. 16), and reach = a + t. With Q = -W',
//   u W(-a) = W(t) + (a + t) Q(t), W(-x) = x + W(x), Q(-x) = 1 - Q(x),
// and x = |t|, side = 1 or -1 of t,
//   K(x) = side W(x) + (a + side x) Q(x)
// falls from x = 0 to u W(-a), or to (1 - u) W(-a) - W(a) where t < 0. Its values at the beginnings of cells
// bracket x by a fixed number of halvings. In a cell log W is a cubic, and kSteps of Halley's method, each
// kept inside what is left of the bracket, leave no more than roundings; beyond the cells W is a power of x
// and Newton's method goes by log K and log x.
template <class DD>
HWY_INLINE void SolveAlong(DD dd, Vec<DD>& t, Vec<DD>& reach, const RadialEntries& entries, Vec<DD> a,
                           Vec<DD> area, Vec<DD> u) {
  constexpr int kSteps = 6, kTailSteps = 8;
  constexpr size_t kBits = RadialCurve::kCellBits;
  const RadialCurve& curve = entries.masking;
  const hn::RebindToSigned<DD> di;
  const Vec<DD> zero = hn::Zero(dd), one = Const(dd, 1), half = Const(dd, 0.5);
  const Vec<DD> whole = hn::Add(a, area), end = Const(dd, curve.end);
  const Vec<DD> from_above = hn::Mul(u, whole), from_below = hn::Mul(hn::Sub(one, u), whole);
  const auto up = hn::Le(from_above, hn::MulAdd(a, Const(dd, entries.above[0]), Const(dd, entries.area[0])));
  const Vec<DD> side = hn::IfThenElse(up, one, Const(dd, -1)), shift = ZeroIf(up, area);
  const Vec<DD> wanted = hn::IfThenElse(up, from_above, from_below), target = hn::Sub(wanted, shift);
  const Vec<DD> most = hn::IfThenElse(up, Const(dd, 0x1p1000), a);

  TableIndex<DD> cell = hn::Zero(di);
  for (int step = static_cast<int>(RadialEntries::kNodes) / 2; step > 0; step /= 2) {
    const auto next = hn::Add(cell, hn::Set(di, step));
    const Vec<DD> x = hn::Sub(PlaceBegin<kBits>(dd, next), one);
    const Vec<DD> w = hn::GatherIndex(dd, entries.area, next), q = hn::GatherIndex(dd, entries.above, next);
    const Vec<DD> k = hn::MulAdd(hn::MulAdd(side, x, a), q, hn::Mul(side, w));
    const auto there = hn::And(hn::Ge(k, target), hn::Le(x, hn::Min(most, end)));
    cell = hn::IfThenElse(hn::RebindMask(di, there), next, cell);
  }
  const Vec<DD> begin = hn::Sub(PlaceBegin<kBits>(dd, cell), one);
  const auto beyond = hn::Ge(begin, end);
  // Any cell stands for those that are beyond.
  cell = hn::IfThenZeroElse(hn::RebindMask(di, beyond), cell);
  const Vec<DD> start = hn::Sub(PlaceBegin<kBits>(dd, cell), one);
  const Vec<DD> width =
      hn::Sub(PlaceBegin<kBits>(dd, hn::Add(cell, hn::Set(di, 1))), PlaceBegin<kBits>(dd, cell));
  const Vec<DD> over_width = hn::Div(one, width);
  Vec<DD> c0, c1, c2, c3;
  LoadCubic(dd, curve.cells, cell, c0, c1, c2, c3);
  Vec<DD> low = start, high = hn::Min(most, hn::Add(start, width));
  const auto cubic = [&](Vec<DD> p)
                         HWY_ATTR { return hn::MulAdd(hn::MulAdd(hn::MulAdd(c3, p, c2), p, c1), p, c0); };
  // W, log(W)' and log(W)''.
  const auto area_at = [&](Vec<DD> p, Vec<DD>& w, Vec<DD>& d, Vec<DD>& d2) HWY_ATTR {
    const Vec<DD> three_c3 = hn::Mul(Const(dd, 3), c3);
    w = Exp<Accuracy::kStandard>(dd, cubic(p), zero);
    d = hn::Mul(hn::MulAdd(hn::MulAdd(three_c3, p, hn::Add(c2, c2)), p, c1), over_width);
    d2 = hn::Mul(hn::Mul(hn::MulAdd(three_c3, p, c2), Const(dd, 2)), hn::Mul(over_width, over_width));
  };
  // The first x: of a P that stays as it is, half of the square of delta = a + side x times P is K's fall
  // from the cell's beginning, or what is wanted from delta = 0 on; and of a K + shift that falls to less
  // than a quarter in the cell, by its logarithm.
  Vec<DD> w, d, d2;
  area_at(zero, w, d, d2);
  const Vec<DD> p_begin = hn::Mul(w, hn::MulAdd(d, d, d2)), delta_begin = hn::MulAdd(side, start, a);
  const Vec<DD> k_begin = hn::Mul(w, hn::NegMulAdd(delta_begin, d, side));
  const Vec<DD> fall = hn::Div(hn::Mul(Const(dd, 2), hn::Sub(k_begin, target)), p_begin);
  const auto at_end = hn::AndNot(up, hn::Ge(hn::Add(start, width), a));
  const Vec<DD> delta2 = hn::IfThenElse(at_end, hn::Div(hn::Add(wanted, wanted), p_begin),
                                        hn::MulAdd(delta_begin, delta_begin, hn::Mul(side, fall)));
  Vec<DD> x = hn::Mul(side, hn::Sub(hn::Sqrt(hn::Max(delta2, zero)), a));
  area_at(one, w, d, d2);
  const Vec<DD> least = Const(dd, 0x1p-1000);
  const Vec<DD> share_begin = hn::Max(hn::Add(k_begin, shift), least);
  const Vec<DD> share_end = hn::Max(
      hn::MulAdd(w, hn::NegMulAdd(hn::MulAdd(side, hn::Add(start, width), a), d, side), shift), least);
  const auto steep = hn::AndNot(at_end, hn::Lt(share_end, hn::Mul(Const(dd, 0.25), share_begin)));
  if (HWY_UNLIKELY(!hn::AllFalse(dd, steep))) {
    const auto log = [&](Vec<DD> ratio)
                         HWY_ATTR { return Log<Accuracy::kStandard>(dd, hn::Max(ratio, least)); };
    const Vec<DD> part = hn::Div(log(hn::Div(wanted, share_begin)), log(hn::Div(share_end, share_begin)));
    x = hn::IfThenElse(steep, hn::MulAdd(part, width, start), x);
  }
  x = hn::Min(hn::Max(x, low), high);
  for (int i = 0; i < kSteps; ++i) {
    area_at(hn::Mul(hn::Sub(x, start), over_width), w, d, d2);
    const Vec<DD> d3 =
        hn::Mul(hn::Mul(Const(dd, 6), c3), hn::Mul(over_width, hn::Mul(over_width, over_width)));
    const Vec<DD> density = hn::MulAdd(d, d, d2);  // P/W
    const Vec<DD> delta = hn::MulAdd(side, x, a);
    // (K - target)/W, which falls as delta P/W.
    const Vec<DD> rest = hn::Sub(hn::NegMulAdd(delta, d, side), hn::Div(target, w));
    const auto before = hn::Gt(rest, zero);
    low = hn::IfThenElse(before, x, low);
    high = hn::IfThenElse(before, high, x);
    // Halley's: n/(1 - n K''/(2 K')), n = -K/K', K''/K' = side/delta + P'/P.
    const Vec<DD> slope = hn::Mul(delta, density), n = hn::Div(rest, slope);
    const Vec<DD> change = hn::MulAdd(d, hn::MulAdd(Const(dd, 2), d2, density), d3);  // P'/W
    const Vec<DD> bend = hn::Add(hn::Div(side, delta), hn::Div(change, density));
    const Vec<DD> next = hn::Add(x, hn::Div(n, hn::MulAdd(hn::Mul(half, n), bend, one)));
    const auto inside = hn::And(hn::Ge(next, low), hn::Le(next, high));  // false of NaN
    x = hn::IfThenElse(inside, next, hn::Mul(half, hn::Add(low, high)));
  }
  if (HWY_UNLIKELY(!hn::AllFalse(dd, beyond))) {
    // K + shift = W (side - s (a + side x)/x) + shift of W = W_end (x/end)^s, by y = log(x/end).
    const double s = curve.tail_slope;
    const Vec<DD> over_end = hn::Div(a, end), limit = Const(dd, 150);
    Vec<DD> y_low = zero;
    Vec<DD> y_high = hn::IfThenElse(
        up, limit,
        hn::Min(limit,
                LogOnePlusRatio(dd, hn::Max(hn::Sub(hn::Min(a, Const(dd, 0x1p300)), end), zero), end)));
    const Vec<DD> log_wanted = Log<Accuracy::kStandard>(dd, wanted);
    // From t = -a on as above; else as what K is where a is next to nothing beside x, or x beside a, of which
    // up has the sum.
    const Vec<DD> p_end = hn::Div(hn::Mul(Const(dd, s * (s - 1)), area), hn::Mul(a, a));
    const Vec<DD> delta_end = hn::Sqrt(hn::Div(hn::Add(wanted, wanted), p_end));
    const auto near_end = hn::AndNot(up, hn::Lt(delta_end, hn::Mul(half, a)));
    const Vec<DD> from_end = LogOnePlusRatio(dd, hn::Max(hn::Sub(hn::Sub(a, delta_end), end), zero), end);
    const Vec<DD> over_w = hn::Sub(log_wanted, Const(dd, curve.tail_value));
    const Vec<DD> log_a = Log<Accuracy::kStandard>(dd, hn::Max(over_end, Const(dd, 0x1p-1000)));
    const Vec<DD> far_power = hn::Mul(hn::Sub(over_w, Const(dd, std::log1p(-s))), Const(dd, 1 / s));
    const Vec<DD> near_power =
        hn::Mul(hn::Sub(over_w, hn::Add(log_a, Const(dd, std::log(-s)))), Const(dd, 1 / (s - 1)));
    const Vec<DD> from_power = hn::Min(near_power, hn::Mul(half, y_high));
    Vec<DD> y =
        hn::IfThenElse(up, hn::Max(far_power, near_power), hn::IfThenElse(near_end, from_end, from_power));
    y = hn::Min(hn::Max(y, y_low), y_high);
    for (int i = 0; i < kTailSteps; ++i) {
      const Vec<DD> w_far =
          Exp<Accuracy::kStandard>(dd, hn::MulAdd(Const(dd, s), y, Const(dd, curve.tail_value)), zero);
      const Vec<DD> a_x = hn::Mul(over_end, Exp<Accuracy::kStandard>(dd, hn::Neg(y), zero)),
                    ratio = hn::Add(a_x, side);
      const Vec<DD> share = hn::MulAdd(w_far, hn::NegMulAdd(Const(dd, s), ratio, side), shift);
      const Vec<DD> falls = hn::Mul(hn::Mul(w_far, Const(dd, s * (s - 1))), ratio);
      const Vec<DD> off =
          hn::Sub(Log<Accuracy::kStandard>(dd, hn::Max(share, Const(dd, 0x1p-1000))), log_wanted);
      const auto before = hn::Gt(off, zero);
      y_low = hn::IfThenElse(before, y, y_low);
      y_high = hn::IfThenElse(before, y_high, y);
      const Vec<DD> next = hn::MulAdd(hn::Div(share, falls), off, y);
      const auto inside = hn::And(hn::Ge(next, y_low), hn::Le(next, y_high));
      y = hn::IfThenElse(inside, next, hn::Mul(half, hn::Add(y_low, y_high)));
    }
    const Vec<DD> far = hn::Mul(end, Exp<Accuracy::kStandard>(dd, y, zero));
    x = hn::IfThenElse(beyond, hn::Min(far, Const(dd, 0x1p200)), x);
  }
  t = hn::Mul(side, x);
  reach = hn::Max(hn::Add(a, t), Const(dd, 0x1p-200));
}

struct Tabulated {
  static constexpr size_t kOwn = 1;
  static constexpr bool kHasExponent = true, kMaskingInDouble = true, kDensityOfCosine = false,
                        kLogDensityInDouble = true;
  using Entries = const RadialEntries*;

  static Entries EntriesOf(const Prepared& table) {
    return &static_cast<const RadialTable&>(table).entries();
  }

  // GGX's, whose tail is the same power as (1 + tan^2)^-2; kept off the underflow.
  template <Care kCare, class D, class... P>
  static HWY_INLINE void Density(D d, Vec<D>& e, Vec<D>& e_tail, Vec<D>& w, Vec<D> hx, Vec<D> hy, Vec<D> hz,
                                 Vec<D> hx_tail, Vec<D> hy_tail, Vec<D> hz_tail, Entries, P... p) {
    Ggx::Density<kCare>(d, e, e_tail, w, hx, hy, hz, hx_tail, hy_tail, hz_tail, p...);
    const Vec<D> low = Const(d, kIsFloat<D> ? 0x1p-60 : 0x1p-150);
    e = hn::IfThenElse(hn::Lt(e, low), low, e);
  }

  template <class D, class... P>
  static HWY_INLINE Vec<D> LogDensity(D d, Vec<D> hx, Vec<D> hy, Vec<D> hz, Entries entries, P... p) {
    if constexpr (kIsFloat<D>) {
      const Vec<D> zero = hn::Zero(d);
      Vec<D> high, low;
      InDouble2<LogDensityOp<Tabulated>>(d, high, low, hx, hy, hz, zero, zero, zero, entries, p...);
      return hn::Add(high, low);
    } else {
      Vec<D> ux, uy, uz, uz_tail, w;
      Stretch<Care::kPlain>(d, ux, uy, uz, uz_tail, w, p...);
      return UnitLogDensity(d, hn::Mul(hx, ux), hn::Mul(hy, uy), hn::Mul(hz, uz), entries);
    }
  }
  template <class DD>
  static HWY_INLINE Vec<DD> UnitLogDensity(DD dd, Vec<DD> x, Vec<DD> y, Vec<DD> z, Entries entries) {
    const Vec<DD> z2 = hn::Max(hn::Mul(z, z), Const(dd, 0x1p-400));
    const Vec<DD> r = hn::Sqrt(hn::Div(hn::MulAdd(x, x, hn::Mul(y, y)), z2));
    const Vec<DD> log = CurveAt(dd, entries->density, r);
    return hn::Max(log, Const(dd, -2000));  // nothing is left of the density below
  }
  template <class DD>
  static HWY_INLINE Vec<DD> UnitDensity(DD dd, Vec<DD> x, Vec<DD> y, Vec<DD> z, Entries) {
    return Ggx::UnitDensity(dd, x, y, z);
  }

  template <Care, Accuracy, class D, class... P>
  static HWY_INLINE Vec<D> Masking(D d, Vec<D> vx, Vec<D> vy, Vec<D> z, Entries entries, P... p) {
    Vec<D> masking, unused;
    InDouble2<MaskingOp>(d, masking, unused, vx, vy, z, entries, p...);
    return masking;
  }

  template <Accuracy, class D, class... P>
  static HWY_INLINE Vec<D> Lambda(D d, Vec<D> vx, Vec<D> vy, Vec<D> vz, P... p) {
    Vec<D> lambda, unused;
    InDouble2<LambdaOp>(d, lambda, unused, vx, vy, vz, p...);
    return lambda;
  }

  template <Care kCare, Accuracy A, class D, class... P>
  static HWY_INLINE void SampleNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> u1,
                                      Vec<D> u2, Entries entries, P... p) {
    u1 = BelowOne(d, u1);
    Vec<D> t, t_tail, w, w_tail;
    if constexpr (kIsFloat<D>) {
      Vec<D> unused0, unused1;
      InDouble6<SlopeOp>(d, t, t_tail, w, w_tail, unused0, unused1, u1, entries);
    } else {
      SlopeOf(d, t, w, u1, entries);
      t_tail = w_tail = hn::Zero(d);
    }
    NormalFromSlopes<true, kCare, A>(d, mx, my, mz, pdf, hn::Sqrt(t), t, t_tail, w, w_tail, u2, p...);
  }

  template <bool kBounded, Accuracy, class D, class... P>
  static HWY_INLINE void SampleVisibleNormal(D d, Vec<D>& mx, Vec<D>& my, Vec<D>& mz, Vec<D>& pdf, Vec<D> vx,
                                             Vec<D> vy, Vec<D> vz, Vec<D> u1, Vec<D> u2, P... p) {
    static_assert(!kBounded, "caps are GGX's");
    Vec<D> unused0, unused1;
    InDouble6<VisibleOp>(d, mx, my, mz, pdf, unused0, unused1, vx, vy, vz, BelowOne(d, u1), BelowOne(d, u2),
                         p...);
  }

 private:
  // |v.n| Lambda(v) = scale exp(log), scale = s of a = |v.n|/s.
  template <class DD, class... P>
  static HWY_INLINE void LambdaFactors(DD dd, Vec<DD>& scale, Vec<DD>& log, Vec<DD> vx, Vec<DD> vy, Vec<DD> z,
                                       Entries entries, P... p) {
    const Vec<DD> s2 = hn::Max(ProjectedRoughness2<Care::kPlain>(dd, vx, vy, p...), Const(dd, 0x1p-1000));
    scale = hn::Sqrt(s2);
    log = CurveAt(dd, entries->masking, hn::Div(z, scale));
  }
  struct MaskingOp {
    template <class DD, class... P>
    static HWY_INLINE void Run(DD dd, Vec<DD>& masking, Vec<DD>& unused, Vec<DD> vx, Vec<DD> vy, Vec<DD> z,
                               P... p) {
      Vec<DD> scale, log;
      LambdaFactors(dd, scale, log, vx, vy, z, p...);
      masking = unused =
          hn::Add(z, ExpTimes<Accuracy::kStandard>(dd, log, hn::Zero(dd), hn::Add(scale, scale)));
    }
  };
  struct LambdaOp {
    template <class DD, class... P>
    static HWY_INLINE void Run(DD dd, Vec<DD>& lambda, Vec<DD>& unused, Vec<DD> vx, Vec<DD> vy, Vec<DD> vz,
                               P... p) {
      const Vec<DD> zero = hn::Zero(dd), z = hn::Abs(CosineOf<Tabulated>(dd, vx, vy, vz, p...));
      Vec<DD> scale, log;
      LambdaFactors(dd, scale, log, vx, vy, z, p...);
      const Vec<DD> over = hn::Div(ExpTimes<Accuracy::kStandard>(dd, log, zero, scale), z);
      const auto flat = hn::Eq(hn::Add(hn::Abs(vx), hn::Abs(vy)), zero);
      lambda = unused = ZeroIf(flat, hn::Min(over, Const(dd, std::numeric_limits<double>::max())));
    }
  };
  // Slopes t along the azimuth of the stretched view q = (alpha_x vx, alpha_y vy, |vz|), and y across it, of
  // which u2 of those of t are below: m = M/|M|, M = (alpha_x (t cos - y sin), alpha_y (t sin + y cos), 1),
  // and
  //   D_v(m) = (a + t) f(r) |M|^3 / (W(-a) alpha_x alpha_y), r^2 = t^2 + y^2.
  struct VisibleOp {
    template <class DD, class... P>
    static HWY_INLINE void Run(DD dd, Vec<DD>& mx, Vec<DD>& my, Vec<DD>& mz, Vec<DD>& pdf, Vec<DD>& unused0,
                               Vec<DD>& unused1, Vec<DD> vx, Vec<DD> vy, Vec<DD> vz, Vec<DD> u1, Vec<DD> u2,
                               Entries entries, P... p) {
      const Vec<DD> zero = hn::Zero(dd), one = Const(dd, 1), ax = AlphaX(p...), ay = AlphaY(p...);
      u1 = FromTiny(dd, u1);
      u2 = FromTiny(dd, u2);
      const Vec<DD> scale = PowerOfTwoScale(dd, vx, vy, zero), z = hn::Mul(hn::Abs(vz), scale);
      const Vec<DD> side = hn::IfThenElse(hn::Lt(vz, zero), hn::Neg(scale), scale);
      const Vec<DD> qx = hn::Mul(ax, hn::Mul(vx, side)), qy = hn::Mul(ay, hn::Mul(vy, side));
      const Vec<DD> q2 = hn::MulAdd(qx, qx, hn::Mul(qy, qy)), largest = Const(dd, 0x1p300);
      const auto normal = hn::Eq(q2, zero);
      const Vec<DD> q = hn::Sqrt(hn::IfThenElse(normal, one, q2));
      const Vec<DD> cos = hn::IfThenElse(normal, one, hn::Div(qx, q)), sin = hn::Div(qy, q);
      const Vec<DD> a = hn::IfThenElse(normal, largest, hn::Min(largest, hn::Div(z, q)));
      const Vec<DD> area = Exp<Accuracy::kStandard>(dd, CurveAt(dd, entries->masking, a), zero);
      Vec<DD> t, reach;
      SolveAlong(dd, t, reach, *entries, a, area, u1);
      // x = -log(2 min(u2, 1 - u2)).
      const Vec<DD> w2 = hn::Sub(one, u2), nearer = hn::Min(u2, w2), twice = hn::Add(nearer, nearer);
      const Vec<DD> off = hn::Abs(hn::Sub(u2, w2));  // 1 - 2 min(u2, 1 - u2), exact where it is small
      const Vec<DD> x = hn::IfThenElse(hn::Lt(off, Const(dd, 0.5)), NegLog1m<Accuracy::kStandard>(dd, off),
                                       hn::Neg(Log<Accuracy::kStandard>(dd, twice)));
      const Vec<DD> t2 = hn::Mul(t, t);
      const Vec<DD> v = hn::Min(hn::Mul(x, SurfaceAt(dd, entries->across, hn::Abs(t), x)), Const(dd, 60));
      const Vec<DD> grown = Exp<Accuracy::kStandard>(dd, v, zero), near = ExpMinusOneSeries(dd, v);
      const auto small = hn::Lt(v, Const(dd, 0.1));
      const Vec<DD> more = hn::IfThenElse(small, near, hn::Sub(grown, one));
      // sinh(v) = (E + E/(1 + E))/2, E = e^v - 1.
      const Vec<DD> sinh = hn::Mul(Const(dd, 0.5), hn::Add(more, hn::Div(more, hn::Add(more, one))));
      const Vec<DD> across = hn::Mul(hn::Sqrt(hn::Add(t2, one)), FlipSign(dd, sinh, hn::Sub(u2, w2)));
      const Vec<DD> m_x = hn::Mul(ax, hn::NegMulAdd(across, sin, hn::Mul(t, cos)));
      const Vec<DD> m_y = hn::Mul(ay, hn::MulAdd(across, cos, hn::Mul(t, sin)));
      const Vec<DD> length2 = hn::MulAdd(m_x, m_x, hn::MulAdd(m_y, m_y, one)), length = hn::Sqrt(length2);
      const Vec<DD> inverse = hn::Div(one, length);
      const Vec<DD> r2 = hn::MulAdd(across, across, t2), w = hn::Add(r2, one);
      const Vec<DD> log = CurveAt(dd, entries->density, hn::Sqrt(r2));
      const Vec<DD> area_pi = hn::Mul(hn::Mul(ax, ay), Const(dd, kPi));
      const Vec<DD> factor = hn::Mul(hn::Div(hn::Mul(reach, length), hn::Mul(hn::Add(a, area), area_pi)),
                                     hn::Div(hn::Div(length2, w), w));
      const auto none = hn::Eq(hn::Add(hn::Add(hn::Abs(vx), hn::Abs(vy)), hn::Abs(vz)), zero);
      mx = ZeroIf(none, hn::Mul(m_x, inverse));
      my = ZeroIf(none, hn::Mul(m_y, inverse));
      mz = ZeroIf(none, hn::Max(inverse, Const(dd, 0x1p-126)));  // a float above 0
      pdf = ZeroIf(none, ExpTimes<Accuracy::kStandard>(dd, log, zero, factor));
      unused0 = unused1 = mz;
    }
  };
  // t = tan^2 and w = pi D cos^4 at unit roughness: log(1 + t) = y quantile(sqrt(y)), y = -log(1 - u1).
  template <class DD>
  static HWY_INLINE void SlopeOf(DD dd, Vec<DD>& t, Vec<DD>& w, Vec<DD> u1, Entries entries) {
    const Vec<DD> zero = hn::Zero(dd), y = NegLog1m<Accuracy::kStandard>(dd, u1);
    const Vec<DD> log = hn::Mul(y, CurveAt(dd, entries->quantile, hn::Sqrt(y)));
    t = hn::IfThenElse(hn::Lt(log, Const(dd, 0.1)), ExpMinusOneSeries(dd, log),
                       hn::Sub(Exp<Accuracy::kStandard>(dd, log, zero), Const(dd, 1)));
    const Vec<DD> density = CurveAt(dd, entries->density, hn::Sqrt(t));
    w = Exp<Accuracy::kStandard>(dd, hn::NegMulAdd(Const(dd, 2), log, density), zero);
  }
  struct SlopeOp {
    template <class DD>
    static HWY_INLINE void Run(DD dd, Vec<DD>& t, Vec<DD>& t_tail, Vec<DD>& w, Vec<DD>& w_tail,
                               Vec<DD>& unused0, Vec<DD>& unused1, Vec<DD> u1, Entries entries) {
      Vec<DD> t_all, w_all;
      SlopeOf(dd, t_all, w_all, u1, entries);
      SplitHigh(dd, t_all, t, t_tail);
      SplitHigh(dd, w_all, w, w_tail);
      unused0 = unused1 = t;
    }
  };
};

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_TABULATED_INL_H_
