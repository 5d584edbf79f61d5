// Tables of albedo.h in lanes.
#if defined(MICROLANE_ALBEDO_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_ALBEDO_INL_H_
#undef MICROLANE_ALBEDO_INL_H_
#else
#define MICROLANE_ALBEDO_INL_H_
#endif

#include <cstdint>

#include "microlane/albedo.h"
#include "microlane/math-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

template <class D>
using CellIndex = Vec<hn::RebindToSigned<D>>;

// The cell that |cosine| is in, and how far along, from 0 to 1: x = c + (1 - c) |cosine| counts octaves and
// cells above c in its exponent and leading bits. What x has lost to rounding is put back: a may go as the
// inverse fourth power. Cosines above 1, and NaN, count as 1.
template <class D>
HWY_INLINE void FindCell(D d, const AlbedoEntries& table, Vec<D> cosine, CellIndex<D>& cell, Vec<D>& part) {
  constexpr int kMantissaBits = kIsFloat<D> ? 23 : 52, kCellBits = AlbedoEntries::kCellBits;
  const hn::RebindToUnsigned<D> du;
  const hn::RebindToSigned<D> di;
  using Bits = hn::TFromD<decltype(du)>;
  const Vec<D> one = Const(d, 1), offset = Const(d, table.offset), scale = hn::Sub(one, offset);
  const Vec<D> given = hn::Abs(cosine), mu = hn::IfThenElse(hn::Lt(given, one), given, one);
  const Vec<D> x = FusedMulAdd(d, mu, scale, offset);
  const auto bits = hn::Sub(hn::BitCast(du, x), hn::BitCast(du, offset));
  cell = hn::BitCast(di, hn::ShiftRight<kMantissaBits - kCellBits>(bits));
  const auto rest = hn::And(hn::ShiftLeft<kCellBits>(bits), hn::Set(du, (Bits{1} << kMantissaBits) - 1));
  part = hn::Sub(hn::BitCast(d, hn::Or(rest, hn::BitCast(du, one))), one);
  if constexpr (kIsFloat<D>) {
    const Vec<D> lost = FusedMulAdd(d, mu, scale, hn::Sub(offset, x));  // the difference is exact
    part = hn::MulAdd(hn::Mul(lost, InversePowerOfTwo(d, x)), Const(d, AlbedoEntries::kCells), part);
  }
}

// Entries `cell` and `cell` + 1, two in a lane of 64 bits, the first in its low half.
template <class DI>
HWY_INLINE Vec<DI> LoadPairs(DI di, const float* entries, Vec<DI> cell) {
  return hn::GatherOffset(di, reinterpret_cast<const std::int64_t*>(entries), hn::ShiftLeft<2>(cell));
}

template <class D>
HWY_INLINE void LoadCell(D d, const float* entries, CellIndex<D> cell, Vec<D>& y0, Vec<D>& y1) {
  if constexpr (!kIsFloat<D>) {
    // Entries are 0 or normal, so a double's bits are a float's with another bias.
    const hn::RebindToUnsigned<D> du;
    const auto pair = hn::BitCast(du, LoadPairs(hn::RebindToSigned<D>(), entries, cell));
    const auto bias = hn::Set(du, std::uint64_t{1023 - 127} << 52);
    const auto widen = [&](auto bits) HWY_ATTR {
      const Vec<D> y = hn::BitCast(d, hn::Add(hn::ShiftLeft<29>(bits), bias));
      return hn::IfThenElseZero(hn::Gt(y, hn::BitCast(d, bias)), y);
    };
    y0 = widen(hn::And(pair, hn::Set(du, 0xFFFFFFFFu)));
    y1 = widen(hn::ShiftRight<32>(pair));
  } else {
#if HWY_TARGET == HWY_SCALAR || HWY_TARGET == HWY_EMU128  // no gain, and no halves
    y0 = hn::GatherIndex(d, entries, cell);
    y1 = hn::GatherIndex(d, entries + 1, cell);
#else
    const hn::Half<hn::RebindToSigned<D>> half;
    const hn::Rebind<std::int64_t, decltype(half)> wide;
    const auto low = LoadPairs(wide, entries, hn::PromoteTo(wide, hn::LowerHalf(half, cell)));
    const auto high = LoadPairs(wide, entries, hn::PromoteTo(wide, hn::UpperHalf(half, cell)));
    y0 = hn::ConcatEven(d, hn::BitCast(d, high), hn::BitCast(d, low));
    y1 = hn::ConcatOdd(d, hn::BitCast(d, high), hn::BitCast(d, low));
#endif
  }
}

// Entries at a place that FindCell has found.
template <class D>
HWY_INLINE Vec<D> Interpolate(D d, const float* entries, CellIndex<D> cell, Vec<D> part) {
  Vec<D> y0, y1;
  LoadCell(d, entries, cell, y0, y1);
  return hn::MulAdd(part, hn::Sub(y1, y0), y0);
}

// a and 1 - a at |cosine|.
template <class D>
HWY_INLINE void DirectionalAlbedo(D d, const AlbedoEntries& table, Vec<D> cosine, Vec<D>& albedo,
                                  Vec<D>& deficit) {
  CellIndex<D> cell;
  Vec<D> part;
  FindCell(d, table, cosine, cell, part);
  albedo = Interpolate(d, table.albedo, cell, part);
  deficit = Interpolate(d, table.deficit, cell, part);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_ALBEDO_INL_H_
