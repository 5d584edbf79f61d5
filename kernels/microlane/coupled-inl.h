// The coupled specular-matte model of Kelemen 2001 in lanes: Ward's P_H over a dielectric, from the table of
// its albedo a. With r = 1 - a and s of Eq. 7,
//   f = P_H F/(h.h) + k s r_i r_o,
//   pdf = a_i P_H/(4 cos(beta)) + k r_i p_m, p_m = s r_o |cos(theta_o)|,
// so that the matte part of f |cos(theta_o)| is that of pdf.
#if defined(MICROLANE_COUPLED_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_COUPLED_INL_H_
#undef MICROLANE_COUPLED_INL_H_
#else
#define MICROLANE_COUPLED_INL_H_
#endif

#include <cstddef>
#include <limits>

#include "microlane/albedo-inl.h"
#include "microlane/beckmann-inl.h"
#include "microlane/rough_dielectric-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// f |cos(theta_o)| into `value` if kValue, the density of o into `pdf` if kPdf.
template <bool kValue, bool kPdf, Accuracy A, class D>
HWY_INLINE void Coupled(D d, const AlbedoTable& table, Vec<D>& value, Vec<D>& pdf, Vec<D> ix, Vec<D> iy,
                        Vec<D> iz, Vec<D> ox, Vec<D> oy, Vec<D> oz, Vec<D> k) {
  const AlbedoEntries& entries = table.entries();
  const Vec<D> zero = hn::Zero(d);
  RoughSurface<Beckmann, DielectricInterface, Lobes::kReflection, JointMasking::kKelemen, kValue, kPdf,
               Drawn::kNormals, A>(d, hn::MaskFromVec(zero), value, pdf, ix, iy, iz, ox, oy, oz,
                                   Const(d, table.lobe().n), Const(d, table.lobe().roughness));
  CellIndex<D> cell_i, cell_o;
  Vec<D> part_i, part_o;
  FindCell(d, entries, iz, cell_i, part_i);
  FindCell(d, entries, oz, cell_o, part_o);
  const Vec<D> of_i = hn::Mul(Interpolate(d, entries.deficit, cell_i, part_i), k);
  const Vec<D> of_o = hn::Mul(Interpolate(d, entries.deficit, cell_o, part_o), Const(d, entries.matte_scale));
  // Opposite sides, or one edge-on; no product of the cosines, which may underflow.
  const Vec<D> zo = FlipSign(d, oz, iz);
  const auto apart = hn::Le(hn::Min(hn::Abs(iz), zo), zero);
  const Vec<D> matte = ZeroIf(apart, hn::Mul(hn::Mul(of_i, of_o), zo));
  if constexpr (kValue) value = hn::Add(value, matte);
  if constexpr (kPdf) {
    // Beyond the range it is there still times a.
    const Vec<D> a = Interpolate(d, entries.albedo, cell_i, part_i);
    const Vec<D> largest = hn::Set(d, std::numeric_limits<T<D>>::max()), specular = hn::Min(pdf, largest);
    const auto beyond = hn::And(hn::Ge(specular, largest), hn::Gt(a, zero));
    pdf = hn::IfThenElse(beyond, largest, hn::MulAdd(a, specular, matte));
  }
}

// The cell that u of the density of matte directions is beyond, from the normal on: cumulative[j] > q >=
// cumulative[j + 1], q = u cumulative[0].
template <class DD>
HWY_INLINE CellIndex<DD> FindCumulative(DD dd, const AlbedoEntries& table, Vec<DD> u, Vec<DD> q) {
  const hn::RebindToSigned<DD> di;
  CellIndex<DD> at;
  Vec<DD> unused;
  FindCell(dd, table, hn::Sqrt(hn::Sub(Const(dd, 1), u)), at, unused);
  const auto pair =
      hn::GatherOffset(di, reinterpret_cast<const std::int64_t*>(table.guide), hn::ShiftLeft<2>(at));
  CellIndex<DD> cell = hn::And(pair, hn::Set(di, 0xFFFFFFFF));
  for (int step = 0; step < table.guide_steps; ++step) {
    const CellIndex<DD> next = hn::Add(cell, hn::Set(di, 1));
    const auto beyond = hn::Gt(hn::GatherIndex(dd, table.cumulative, next), q);
    cell = hn::IfThenElse(hn::RebindMask(di, beyond), next, cell);
  }
  return cell;
}

// cos(theta) of density proportional to (1 - a) cos(theta) over solid angle, in double lanes: the inverse of
// the cumulative reflection function of Kelemen 2001, with the sine of its solid angle, exactly that of the
// table's linear 1 - a. sin2 = 1 - cos^2.
template <class DD>
HWY_INLINE void SampleMatteCosine(DD dd, const AlbedoEntries& table, Vec<DD> u, Vec<DD>& cosine,
                                  Vec<DD>& sin2) {
  const hn::RebindToUnsigned<DD> du;
  const hn::RebindToSigned<DD> di;
  const Vec<DD> zero = hn::Zero(dd), one = Const(dd, 1), half = Const(dd, 0.5), third = Const(dd, 1.0 / 3);
  u = BelowOne(dd, u);
  const Vec<DD> q = hn::Mul(u, Const(dd, table.cumulative[0]));
  const CellIndex<DD> cell = FindCumulative(dd, table, u, q), next = hn::Add(cell, hn::Set(di, 1));
  // 1 - mu of the cell's upper end and its width in mu, from the bits of x.
  const auto x_of = [&](CellIndex<DD> node) HWY_ATTR {
    const auto steps = hn::ShiftLeft<52 - AlbedoEntries::kCellBits>(hn::BitCast(du, node));
    return hn::BitCast(dd, hn::Add(hn::BitCast(du, Const(dd, table.offset)), steps));
  };
  const Vec<DD> scale = Const(dd, 1 / (1 - table.offset)), x1 = x_of(next);
  const Vec<DD> below_one = hn::Mul(hn::Sub(one, x1), scale), width = hn::Mul(hn::Sub(x1, x_of(cell)), scale);
  const Vec<DD> mu1 = hn::Sub(one, below_one);
  Vec<DD> r0, r1;
  LoadCell(dd, table.deficit, cell, r0, r1);
  // q beyond the upper end = width (A t - B t^2 + C t^3) of t, 0 there and 1 at the lower end.
  const Vec<DD> rest = hn::Max(zero, hn::Sub(q, hn::GatherIndex(dd, table.cumulative, next)));
  const Vec<DD> y = hn::Div(rest, width), fall = hn::Sub(r1, r0);
  const Vec<DD> a = hn::Mul(r1, mu1), b = hn::Mul(half, hn::MulAdd(r1, width, hn::Mul(fall, mu1)));
  const Vec<DD> c = hn::Mul(third, hn::Mul(fall, width));
  const Vec<DD> root = hn::Sqrt(hn::Max(zero, hn::NegMulAdd(hn::Mul(Const(dd, 4), b), y, hn::Mul(a, a))));
  Vec<DD> t = hn::Min(one, hn::Div(hn::Add(y, y), hn::Add(a, root)));
  for (int step = 0; step < 2; ++step) {
    const Vec<DD> error = hn::MulSub(t, hn::MulAdd(t, hn::MulSub(t, c, b), a), y);
    const Vec<DD> slope = hn::Mul(hn::NegMulAdd(t, fall, r1), hn::NegMulAdd(t, width, mu1));
    const Vec<DD> moved = hn::Sub(t, hn::Div(error, slope));
    t = hn::IfThenElse(hn::Gt(slope, zero), hn::Max(zero, hn::Min(one, moved)), t);
  }
  const Vec<DD> from_one = hn::MulAdd(width, t, below_one);
  cosine = hn::Sub(one, from_one);
  sin2 = hn::Mul(from_one, hn::Add(one, cosine));
}

// Russian roulette between specular (u3 < a_i), matte (u3 < a_i + k r_i) and nothing, in double lanes. pdf is
// that of both together, and weight f |cos(theta_o)| over it.
template <class DD>
HWY_INLINE void SampleCoupledPass(DD dd, const AlbedoTable& table, Vec<DD>& ox, Vec<DD>& oy, Vec<DD>& oz,
                                  Vec<DD>& weight, Vec<DD>& pdf, Vec<DD>& lobe, Vec<DD> ix, Vec<DD> iy,
                                  Vec<DD> side, Vec<DD> u1, Vec<DD> u2, Vec<DD> u3, Vec<DD> k) {
  const Vec<DD> zero = hn::Zero(dd), one = Const(dd, 1), iz = hn::Abs(side);
  Vec<DD> a, r;
  DirectionalAlbedo(dd, table.entries(), iz, a, r);
  const auto specular = hn::Lt(u3, a), matte = hn::Lt(u3, hn::MulAdd(k, r, a));
  Vec<DD> mx, my, mz, unused;
  Beckmann::SampleNormal<Care::kPlain, Accuracy::kStandard>(dd, mx, my, mz, unused, u1, u2,
                                                            Const(dd, table.lobe().roughness));
  Reflect(dd, ox, oy, oz, ix, iy, iz, mx, my, mz);
  Vec<DD> cosine, sin2, sin_phi, cos_phi;
  SampleMatteCosine(dd, table.entries(), u1, cosine, sin2);
  SinCos2Pi<Accuracy::kStandard>(dd, u2, sin_phi, cos_phi);
  const Vec<DD> sine = hn::Sqrt(sin2);
  ox = hn::IfThenElse(specular, ox, hn::Mul(sine, cos_phi));
  oy = hn::IfThenElse(specular, oy, hn::Mul(sine, sin_phi));
  oz = hn::IfThenElse(specular, oz, cosine);
  Vec<DD> value;
  Coupled<true, true, Accuracy::kStandard>(dd, table, value, pdf, ix, iy, iz, ox, oy, oz, k);
  weight = hn::Div(value, pdf);
  const auto drawn = hn::And(hn::Or(specular, matte), hn::Gt(hn::Min(oz, pdf), zero));
  lobe = hn::IfThenElseZero(drawn, hn::IfThenElse(specular, one, Const(dd, 2)));
  weight = hn::IfThenElseZero(drawn, weight);
  pdf = hn::IfThenElseZero(drawn, pdf);
  ox = hn::IfThenElseZero(drawn, ox);
  oy = hn::IfThenElseZero(drawn, oy);
  oz = hn::IfThenElseZero(drawn, FlipSign(dd, oz, side));
}

// SampleCoupledPass of lanes of any kind, rounded once. in: wi, u1 to u3, k; out: wo, weight, pdf, lobe.
template <class D>
HWY_NOINLINE void SampleCoupled(D d, const AlbedoTable& table, const T<D> (*in)[hn::MaxLanes(D())],
                                T<D> (*out)[hn::MaxLanes(D())]) {
  const HalfInDouble<D> dd;
  for (std::size_t lane = 0; lane < hn::Lanes(d); lane += hn::Lanes(dd)) {
    const auto load = [&](std::size_t i) HWY_ATTR { return LoadWide(dd, in[i] + lane); };
    Vec<decltype(dd)> ox, oy, oz, weight, pdf, lobe;
    SampleCoupledPass(dd, table, ox, oy, oz, weight, pdf, lobe, load(0), load(1), load(2), load(3), load(4),
                      load(5), load(6));
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

#endif  // MICROLANE_COUPLED_INL_H_
