// Paths through V-cavities on one target. Lanes never wait for a path to end: a pool holds more paths than
// there are lanes, each pass takes all of them one facet further, closes the gaps of those that ended, and
// new paths fill the pool again.
#if defined(MICROLANE_SRC_V_CAVITY_TRACE_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_SRC_V_CAVITY_TRACE_INL_H_
#undef MICROLANE_SRC_V_CAVITY_TRACE_INL_H_
#else
#define MICROLANE_SRC_V_CAVITY_TRACE_INL_H_
#endif

#include <algorithm>
#include <cstdint>

#include "microlane/v_cavity-inl.h"
#include "src/v_cavity_call.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

constexpr std::size_t kPoolSize = 256;
constexpr std::size_t kPoolLanes = 64;  // of the widest vectors, SVE's of 2048 bits
constexpr std::size_t kPoolArray = kPoolSize + kPoolLanes;

// Sign bit of `draw`: the path is in the body, whatever the interface reflects.
constexpr std::uint32_t kInside = 0x80000000u;

// Paths on their way; i as in v_cavity-inl.h.
struct PathPool {
  HWY_ALIGN float iu[kPoolArray], iv[kPoolArray], iz[kPoolArray];
  HWY_ALIGN float s[kPoolArray], c[kPoolArray], t[kPoolArray], ex[kPoolArray], ey[kPoolArray];
  HWY_ALIGN std::uint32_t path[kPoolArray], draw[kPoolArray], hits[kPoolArray];
  std::size_t size = 0;
};

// Directions that paths left by.
struct ExitPool {
  HWY_ALIGN float x[kPoolArray], y[kPoolArray], z[kPoolArray];
  HWY_ALIGN std::uint32_t hits[kPoolArray];
  std::size_t size = 0;
};

// Compress, whose tables Highway 1.0.3 copies to the stack with every call on targets that have no
// instruction for it, by one look-up for all vectors of a mask.
template <class D>
inline constexpr bool kPacksByTable = !HWY_HAVE_SCALABLE && HWY_LANES(T<D>) <= 8 && HWY_LANES(T<D>) > 1;

// What PackLanes takes to bring the lanes of `mask` side by side.
template <class D>
HWY_INLINE auto PackingOf(D d, hn::Mask<D> mask) {
  if constexpr (kPacksByTable<D>) {
    const hn::RebindToSigned<D> di;
    std::uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    const hn::Rebind<std::uint8_t, D> du8;
    return hn::IndicesFromVec(d, hn::PromoteTo(di, hn::LoadU(du8, kPackedLanes.row[bits[0]])));
  } else {
    (void)d;
    return mask;
  }
}

// Stores those lanes; what is behind them is overwritten.
template <class D, class Packing>
HWY_INLINE void PackLanes(D d, Vec<D> v, Packing packing, T<D>* to) {
  if constexpr (kPacksByTable<D>) {
    hn::StoreU(hn::TableLookupLanes(v, packing), d, to);
  } else {
    hn::StoreU(hn::Compress(v, packing), d, to);
  }
}
template <class D, class Packing>
HWY_INLINE void PackLanes(D d, Vec<hn::RebindToUnsigned<D>> v, Packing packing, std::uint32_t* to) {
  const hn::RebindToUnsigned<D> du;
  if constexpr (kPacksByTable<D>) {
    hn::StoreU(hn::BitCast(du, hn::TableLookupLanes(hn::BitCast(d, v), packing)), du, to);
  } else {
    hn::StoreU(hn::BitCast(du, hn::Compress(hn::BitCast(d, v), packing)), du, to);
  }
}

template <class Dist, class D>
HWY_INLINE void AddPaths(D d, PathPool& pool, const VCavityPlan& plan, std::uint32_t high_word,
                         std::uint32_t first) {
  const hn::RebindToUnsigned<D> du;
  const Vec<decltype(du)> path = hn::Add(hn::Set(du, first), hn::Iota(du, 0));
  Vec<decltype(du)> r1 = path, r2 = hn::Set(du, high_word), r3 = hn::Set(du, plan.seed), r4 = hn::Zero(du);
  RandomWords(du, r1, r2, r3, r4);
  Vec<D> iu, iv, s, c, t, ex, ey;
  EnterVCavity<Dist>(d, iu, iv, s, c, t, ex, ey, hn::Set(d, plan.wi[0]), hn::Set(d, plan.wi[1]),
                     hn::Set(d, plan.wi[2]), UniformNumber(d, r1), UniformNumber(d, r2), UniformNumber(d, r3),
                     UniformNumber(d, r4), hn::Set(d, plan.alpha_x), hn::Set(d, plan.alpha_y));
  const std::size_t at = pool.size;
  hn::StoreU(iu, d, pool.iu + at);
  hn::StoreU(iv, d, pool.iv + at);
  hn::StoreU(hn::Set(d, plan.wi[2]), d, pool.iz + at);
  hn::StoreU(s, d, pool.s + at);
  hn::StoreU(c, d, pool.c + at);
  hn::StoreU(t, d, pool.t + at);
  hn::StoreU(ex, d, pool.ex + at);
  hn::StoreU(ey, d, pool.ey + at);
  hn::StoreU(path, du, pool.path + at);
  hn::StoreU(hn::Set(du, 1u), du, pool.draw + at);
  hn::StoreU(hn::Zero(du), du, pool.hits + at);
}

// What happens at a facet: o and the masks of paths that leave it and that try again from the body; the rest
// is absorbed.
template <VCavityPlan::Facets kFacets, class D>
HWY_INLINE void Scatter(D d, Vec<D>& ou, Vec<D>& ov, Vec<D>& oz, hn::Mask<D>& leaves, hn::Mask<D>& again,
                        Vec<D> iu, Vec<D> iv, Vec<D> iz, Vec<D> s, Vec<D> c,
                        Vec<hn::RebindToUnsigned<D>> path, Vec<hn::RebindToUnsigned<D>> draw,
                        const VCavityPlan& plan, std::uint32_t high_word) {
  using Facets = VCavityPlan::Facets;
  const hn::RebindToUnsigned<D> du;
  const Vec<D> zero = hn::Zero(d);
  const Vec<D> cos_i = hn::MulAdd(s, iu, hn::Mul(c, iz));
  if constexpr (kFacets == Facets::kMirror) {
    ReflectAtFacet(d, ou, ov, oz, iu, iv, iz, s, c, cos_i);
    leaves = hn::Eq(zero, zero);
    again = hn::Lt(zero, zero);
  } else {
    Vec<decltype(du)> r1 = path, r2 = hn::Set(du, high_word), r3 = hn::Set(du, plan.seed), r4 = draw;
    RandomWords(du, r1, r2, r3, r4);
    Vec<D> cos_o;
    SampleFacetCosine(d, ou, ov, oz, cos_o, UniformNumber(d, r1), UniformNumber(d, r2), s, c);
    const Vec<D> stay = hn::Set(d, plan.stay), choice = UniformNumber(d, r3);
    if constexpr (kFacets == Facets::kLambertian) {
      leaves = hn::Lt(choice, stay);
      again = hn::Lt(zero, zero);
    } else {
      const Vec<D> k = hn::Set(d, plan.eta2_minus_1), n2 = hn::Set(d, plan.eta2);
      // T as quotients, the numerators times 2^24.
      Vec<D> of_i, under_i, of_o, under_o;
      InterfacedFacets::Transmittance<Accuracy::kStandard>(d, of_i, under_i, cos_i, k, n2);
      InterfacedFacets::Transmittance<Accuracy::kStandard>(d, of_o, under_o, cos_o, k, n2);
      const auto inside = hn::Lt(hn::BitCast(d, draw), zero);
      const auto enters = hn::Or(inside, hn::Lt(hn::Mul(WholeNumber(d, r4), under_i), of_i));
      const auto passes = hn::Lt(hn::Mul(WholeNumber(d, r3), under_o), hn::Mul(of_o, hn::Set(d, plan.leave)));
      Vec<D> ru, rv, rz;
      ReflectAtFacet(d, ru, rv, rz, iu, iv, iz, s, c, cos_i);
      ou = hn::IfThenElse(enters, ou, ru);
      ov = hn::IfThenElse(enters, ov, rv);
      oz = hn::IfThenElse(enters, oz, rz);
      leaves = hn::Or(hn::Not(enters), passes);
      again = hn::AndNot(leaves, hn::Lt(choice, stay));
    }
  }
}

// Paths of the pool from `at` on, those of `active`, meet their facet. Those that go on move down to `kept`,
// which is returned behind them.
template <VCavityPlan::Facets kFacets, class D>
HWY_INLINE std::size_t PassFacet(D d, PathPool& pool, ExitPool& exits, VCavityTotals& totals, std::size_t at,
                                 std::size_t kept, hn::Mask<D> active, const VCavityPlan& plan,
                                 std::uint32_t high_word) {
  const hn::RebindToUnsigned<D> du;
  const Vec<D> s = hn::LoadU(d, pool.s + at), c = hn::LoadU(d, pool.c + at), t = hn::LoadU(d, pool.t + at);
  const Vec<D> iu = hn::LoadU(d, pool.iu + at), iv = hn::LoadU(d, pool.iv + at),
               iz = hn::LoadU(d, pool.iz + at);
  const Vec<D> ex = hn::LoadU(d, pool.ex + at), ey = hn::LoadU(d, pool.ey + at);
  const auto path = hn::LoadU(du, pool.path + at), draw = hn::LoadU(du, pool.draw + at);
  const auto hits = hn::LoadU(du, pool.hits + at);
  Vec<D> ou, ov, oz, next;
  hn::Mask<D> leaves, again;
  Scatter<kFacets>(d, ou, ov, oz, leaves, again, iu, iv, iz, s, c, path, draw, plan, high_word);
  leaves = hn::And(leaves, active);
  again = hn::And(again, active);
  const auto meets = hn::And(leaves, MeetsOtherFacet(d, next, ou, oz, s, c, t));
  const auto out = hn::AndNot(meets, leaves);
  const auto met = hn::Add(hits, hn::Set(du, 1u));
  const std::size_t decided = hn::CountTrue(d, active) - hn::CountTrue(d, again);
  totals.hits += decided;
  totals.absorbed += decided - hn::CountTrue(d, leaves);

  if (!hn::AllFalse(d, out)) {
    const std::size_t end = exits.size;
    const auto packing = PackingOf(d, out);
    PackLanes(d, hn::MulSub(ou, ex, hn::Mul(ov, ey)), packing, exits.x + end);
    PackLanes(d, hn::MulAdd(ou, ey, hn::Mul(ov, ex)), packing, exits.y + end);
    PackLanes(d, oz, packing, exits.z + end);
    PackLanes(d, met, packing, exits.hits + end);
    exits.size += hn::CountTrue(d, out);
  }
  // Of those that meet the other facet: what went out by o comes in from -o, half a turn about z further.
  auto on = meets;
  if (plan.max_hits != 0) {
    on = hn::And(on, hn::RebindMask(d, hn::Lt(met, hn::Set(du, plan.max_hits))));
    totals.cut += hn::CountTrue(d, meets) - hn::CountTrue(d, on);
  }
  constexpr bool kMayTryAgain = kFacets == VCavityPlan::Facets::kInterfaced;
  const auto keep = kMayTryAgain ? hn::Or(on, again) : on;
  if (hn::AllFalse(d, keep)) return kept;
  const auto one = hn::Set(du, 1u), drawn = hn::Add(draw, one);
  const auto either = [&](Vec<D> moved, Vec<D> same)
                          HWY_ATTR { return kMayTryAgain ? hn::IfThenElse(again, same, moved) : moved; };
  const auto again_words = hn::RebindMask(du, again);
  const auto next_draw = kMayTryAgain ? hn::IfThenElse(again_words, hn::Or(drawn, hn::Set(du, kInside)),
                                                       hn::And(drawn, hn::Set(du, kInside - 1)))
                                      : drawn;
  const auto next_hits = kMayTryAgain ? hn::IfThenElse(again_words, hits, met) : met;
  const auto packing = PackingOf(d, keep);
  PackLanes(d, s, packing, pool.s + kept);
  PackLanes(d, c, packing, pool.c + kept);
  PackLanes(d, either(next, t), packing, pool.t + kept);
  PackLanes(d, either(ou, iu), packing, pool.iu + kept);
  PackLanes(d, either(ov, iv), packing, pool.iv + kept);
  PackLanes(d, either(hn::Neg(oz), iz), packing, pool.iz + kept);
  PackLanes(d, either(hn::Neg(ex), ex), packing, pool.ex + kept);
  PackLanes(d, either(hn::Neg(ey), ey), packing, pool.ey + kept);
  PackLanes(d, path, packing, pool.path + kept);
  PackLanes(d, next_draw, packing, pool.draw + kept);
  PackLanes(d, next_hits, packing, pool.hits + kept);
  return kept + hn::CountTrue(d, keep);
}

template <class D>
HWY_INLINE void CountExits(D d, ExitPool& exits, const VCavityPlan& plan, std::uint64_t* counts) {
  const hn::RebindToSigned<D> di;
  const hn::RebindToUnsigned<D> du;
  const std::uint32_t cells = plan.rows * plan.columns;
  const Vec<D> rows = hn::ConvertTo(d, hn::Set(di, static_cast<std::int32_t>(plan.rows)));
  const Vec<D> columns = hn::ConvertTo(d, hn::Set(di, static_cast<std::int32_t>(plan.columns)));
  HWY_ALIGN std::uint32_t place[kPoolLanes];
  for (std::size_t i = 0; i < exits.size; i += hn::Lanes(d)) {
    const auto cell = HemisphereCell(d, hn::LoadU(d, exits.x + i), hn::LoadU(d, exits.y + i),
                                     hn::LoadU(d, exits.z + i), rows, columns);
    const auto order =
        hn::Sub(hn::Min(hn::LoadU(du, exits.hits + i), hn::Set(du, plan.orders)), hn::Set(du, 1u));
    hn::Store(hn::Add(hn::Mul(order, hn::Set(du, cells)), hn::BitCast(du, cell)), du, place);
    const std::size_t number = std::min(hn::Lanes(d), exits.size - i);
    for (std::size_t j = 0; j < number; ++j) ++counts[place[j]];
  }
  exits.size = 0;
}

// The paths of one high word of their numbers, which end below 2^32.
template <class Dist, VCavityPlan::Facets kFacets>
void TraceWords(const VCavityPlan& plan, std::uint32_t high_word, std::uint32_t first, std::uint64_t count,
                std::uint64_t* counts, VCavityTotals& totals) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  PathPool pool = {};
  ExitPool exits = {};
  while (count != 0 || pool.size != 0) {
    while (count != 0 && pool.size + lanes <= kPoolSize) {
      AddPaths<Dist>(d, pool, plan, high_word, first);
      const std::size_t added = static_cast<std::size_t>(std::min<std::uint64_t>(lanes, count));
      pool.size += added;
      count -= added;
      first += static_cast<std::uint32_t>(added);
    }
    std::size_t kept = 0;
    for (std::size_t at = 0; at < pool.size; at += lanes) {
      kept = PassFacet<kFacets>(d, pool, exits, totals, at, kept, hn::FirstN(d, pool.size - at), plan,
                                high_word);
    }
    pool.size = kept;
    CountExits(d, exits, plan, counts);
  }
}

template <class Dist>
VCavityTotals TraceVCavities(const VCavityPlan& plan, std::uint64_t first, std::uint64_t count,
                             std::uint64_t* counts) {
  using Facets = VCavityPlan::Facets;
  const auto trace = plan.facets == Facets::kMirror       ? &TraceWords<Dist, Facets::kMirror>
                     : plan.facets == Facets::kLambertian ? &TraceWords<Dist, Facets::kLambertian>
                                                          : &TraceWords<Dist, Facets::kInterfaced>;
  VCavityTotals totals;
  while (count != 0) {
    const std::uint64_t word = std::uint64_t{1} << 32, low = first % word;
    const std::uint64_t part = std::min(count, word - low);
    trace(plan, static_cast<std::uint32_t>(first / word), static_cast<std::uint32_t>(low), part, counts,
          totals);
    first += part;
    count -= part;
  }
  return totals;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_SRC_V_CAVITY_TRACE_INL_H_
