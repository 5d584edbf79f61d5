// The loop and the tail of every batch call, and the table of a family's kernels on one target.
//
// A kernel is a struct with its id and
//   template <Accuracy A, class D, class... V>
//   static void Eval(D d, const Options<D>& options, const Outputs<D>& out, V... inputs in the kernel list's
//   order)
#if defined(MICROLANE_SRC_BATCH_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_SRC_BATCH_INL_H_
#undef MICROLANE_SRC_BATCH_INL_H_
#else
#define MICROLANE_SRC_BATCH_INL_H_
#endif

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <type_traits>
#include <utility>

#include "microlane/compat-inl.h"
#include "microlane/kernel_list.h"
#include "src/dispatch.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

template <class D>
struct Outputs {
  Vec<D>&v0, &v1, &v2, &v3, &v4, &v5;
};

template <class D>
struct Options {
  const hn::Mask<D>& radiance;  // Transport::kRadiance; a reference, as SVE has no members of vector type
  const Prepared* prepared;     // of kernels with inputs behind the list's second bar
};

template <class K>
struct Shape {
  static constexpr std::size_t kIndex = KernelIndex(K::kId);
  static_assert(kIndex < kNumKernels, "id missing in the kernel list");
  static constexpr Names kInputs = Split(kKernels[kIndex].inputs);
  static constexpr std::size_t kIn = kInputs.columns, kPerLane = kInputs.per_lane;
  static constexpr std::size_t kOut = Split(kKernels[kIndex].outputs).count;
};

template <class D>
HWY_INLINE hn::Mask<D> RadianceMask(D d, Transport transport) {
  return hn::Eq(hn::Set(d, transport == Transport::kRadiance ? T<D>{0} : T<D>{1}), hn::Zero(d));
}

// K says by kPassesNan that NaN of any input reaches its outputs by itself; the loop sees to it for the
// others.
template <class K, class = void>
inline constexpr bool kPassesNan = false;
template <class K>
inline constexpr bool kPassesNan<K, std::void_t<decltype(K::kPassesNan)>> = K::kPassesNan;

// Finite in gives finite out: overflow becomes the largest finite number, and NaN that no input explains 0.
template <class D, class... V>
HWY_NOINLINE Vec<D> Totalize(D d, Vec<D> y, V... in) {
  Vec<D> input_sum = hn::Zero(d);
  ((input_sum = hn::MulAdd(in, hn::Zero(d), input_sum)), ...);  // NaN where an input is NaN or infinite
  const Vec<D> largest = hn::Set(d, std::numeric_limits<T<D>>::max());
  const auto explained = hn::IsNaN(input_sum);
  y = hn::IfThenElse(hn::IsNaN(y), hn::IfThenElse(explained, y, hn::Zero(d)), y);
  return hn::IfThenElse(hn::IsInf(y), hn::IfThenElse(explained, y, hn::CopySign(largest, y)), y);
}

template <class D, class... V>
HWY_INLINE hn::Mask<D> AnyNan(D d, V... v) {
  auto any = hn::MaskFromVec(hn::Zero(d));
  ((any = hn::Or(any, hn::IsNaN(v))), ...);
  return any;
}

template <class D, class... V>
HWY_INLINE void StoreTotal(D d, Vec<D> y, T<D>* to, V... in) {
  if (HWY_UNLIKELY(AnyNonFinite(d, y))) y = Totalize(d, y, in...);
  hn::StoreU(y, d, to);
}

// The first `count` lanes from `from`, and its first lane in the others. Touches `count` lanes alone.
template <class D>
HWY_INLINE Vec<D> LoadTail(D d, const T<D>* from, std::size_t count) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2  // masked loads do not touch other lanes
  const auto mask = hn::FirstN(d, count);
  return hn::IfThenElse(mask, hn::MaskedLoad(mask, d, from), hn::Set(d, from[0]));
#else
  HWY_ALIGN T<D> lanes[hn::MaxLanes(D())];
  hn::Store(hn::Set(d, from[0]), d, lanes);
  std::memcpy(lanes, from, count * sizeof(T<D>));
  return hn::Load(d, lanes);
#endif
}

template <class D>
HWY_INLINE void StoreTail(D d, const T<D>* lanes, T<D>* to, std::size_t count) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX2
  hn::BlendedStore(hn::Load(d, lanes), hn::FirstN(d, count), d, to);
#else
  (void)d;
  std::memcpy(to, lanes, count * sizeof(T<D>));
#endif
}

// One lane at a time serves machines without vectors: nothing is hoisted or approximated there, and the body
// stands apart from its loop. That is a third of the code, and a fraction of the time to compile it.
inline constexpr bool kOneLane = HWY_TARGET == HWY_SCALAR;

template <class K, Accuracy A, class D, class... V>
HWY_NOINLINE void EvalApart(D d, const Options<D>& options, const Outputs<D>& out, V... v) {
  K::template Eval<A>(d, options, out, v...);
}

// Runs K over n lanes. Inputs I... are loaded in every iteration (those that are one value from a spread
// copy); `uniform` are the inputs behind them, the same in all iterations, so that what K derives from them
// is hoisted. Every index into the arrays here is a constant, so that they live in registers.
template <class K, Accuracy A, class D, std::size_t... I, std::size_t... O, class... V>
HWY_INLINE void Loop(D d, const Call<T<D>>& call, std::size_t n, std::index_sequence<I...>,
                     std::index_sequence<O...>, V... uniform) {
  using TD = T<D>;
  constexpr std::size_t kIn = sizeof...(I), kOut = sizeof...(O), kMaxLanes = hn::MaxLanes(D());
  HWY_ALIGN TD copy[kIn][kMaxLanes];
  HWY_ALIGN TD tail_out[kOut][kMaxLanes];
  const std::size_t lanes = hn::Lanes(d);
  const bool spread[] = {(I >= Shape<K>::kPerLane && call.uniform[I])...};
  const std::size_t step[] = {(spread[I] ? std::size_t{0} : std::size_t{1})...};
  const TD* in[] = {(spread[I] ? copy[I] : call.in[I])...};
  TD* out[] = {call.out[O]...};
  const auto spread_one = [&](std::size_t k) HWY_ATTR { hn::Store(hn::Set(d, call.in[k][0]), d, copy[k]); };
  ((spread[I] ? spread_one(I) : void()), ...);
  const auto radiance = RadianceMask(d, call.transport);
  const Options<D> options{radiance, call.prepared};
  const auto body = [&](std::size_t i, auto... v) HWY_ATTR {
    Vec<D> o0 = hn::Zero(d), o1 = o0, o2 = o0, o3 = o0, o4 = o0, o5 = o0;
    const Outputs<D> outputs{o0, o1, o2, o3, o4, o5};
    if constexpr (kOneLane) {
      EvalApart<K, A>(d, options, outputs, v...);
    } else {
      K::template Eval<A>(d, options, outputs, v...);
    }
    if constexpr (!kPassesNan<K>) {
      const Vec<D> nan = hn::Set(d, std::numeric_limits<TD>::quiet_NaN());
      const auto any = AnyNan(d, v...);
      o0 = hn::IfThenElse(any, nan, o0);
      o1 = hn::IfThenElse(any, nan, o1);
      o2 = hn::IfThenElse(any, nan, o2);
      o3 = hn::IfThenElse(any, nan, o3);
      o4 = hn::IfThenElse(any, nan, o4);
      o5 = hn::IfThenElse(any, nan, o5);
    }
    StoreTotal(d, o0, out[0] + i, v...);
    if constexpr (kOut > 1) StoreTotal(d, o1, out[1] + i, v...);
    if constexpr (kOut > 2) StoreTotal(d, o2, out[2] + i, v...);
    if constexpr (kOut > 3) StoreTotal(d, o3, out[3] + i, v...);
    if constexpr (kOut > 4) StoreTotal(d, o4, out[4] + i, v...);
    if constexpr (kOut > 5) StoreTotal(d, o5, out[5] + i, v...);
  };

  const std::size_t whole = n / lanes * lanes, rest = n - whole;
  std::size_t count = whole;
  for (bool tail = false;; tail = true) {
    for (std::size_t i = 0; i < count; i += lanes) {
      body(i, hn::LoadU(d, in[I] + i * step[I])..., uniform...);
    }
    if (tail || rest == 0) break;
    // The tail goes through the same code as one whole vector of copies.
    const auto copy_tail = [&](std::size_t k)
                               HWY_ATTR { hn::Store(LoadTail(d, call.in[k] + whole, rest), d, copy[k]); };
    ((spread[I] ? void() : copy_tail(I)), ...);
    ((in[I] = copy[I]), ...);
    ((out[O] = tail_out[O]), ...);
    count = lanes;
  }
  if (rest == 0) return;
  (StoreTail(d, tail_out[O], call.out[O] + whole, rest), ...);
}

template <class K, Accuracy A, class TD, std::size_t... P>
HWY_INLINE void LoopUniform(const Call<TD>& call, std::size_t n, std::index_sequence<P...>) {
  const hn::ScalableTag<TD> d;
  constexpr std::size_t kPerLane = Shape<K>::kPerLane;
  Loop<K, A>(d, call, n, std::make_index_sequence<kPerLane>(), std::make_index_sequence<Shape<K>::kOut>(),
             hn::Set(d, call.in[kPerLane + P][0])...);
}

template <class K, Accuracy A, class TD>
void RunLanes(const Call<TD>& call, std::size_t n) {
  using S = Shape<K>;
  if constexpr (S::kPerLane < S::kIn && sizeof(TD) == 4 && !kOneLane) {
    bool all_uniform = true;
    for (std::size_t k = S::kPerLane; k < S::kIn; ++k) all_uniform = all_uniform && call.uniform[k];
    if (all_uniform) {
      LoopUniform<K, A>(call, n, std::make_index_sequence<S::kIn - S::kPerLane>());
      return;
    }
  }
  Loop<K, A>(hn::ScalableTag<TD>(), call, n, std::make_index_sequence<S::kIn>(),
             std::make_index_sequence<S::kOut>());
}

// kHigh: double lanes over blocks that stay in L1, each result rounded once.
template <class K>
void RunHigh(const Call<float>& call, std::size_t n) {
  constexpr std::size_t kBlock = 64, kIn = Shape<K>::kIn, kOut = Shape<K>::kOut;
  HWY_ALIGN double in[kIn][kBlock];
  HWY_ALIGN double out[kOut][kBlock];
  Call<double> wide;
  wide.transport = call.transport;
  wide.prepared = call.prepared;
  for (std::size_t k = 0; k < kIn; ++k) {
    wide.in[k] = in[k];
    wide.uniform[k] = call.uniform[k];
    if (call.uniform[k]) in[k][0] = static_cast<double>(call.in[k][0]);
  }
  for (std::size_t k = 0; k < kOut; ++k) wide.out[k] = out[k];
  constexpr double kLargest = static_cast<double>(std::numeric_limits<float>::max());
  for (std::size_t begin = 0; begin < n; begin += kBlock) {
    const std::size_t count = HWY_MIN(kBlock, n - begin);
    for (std::size_t k = 0; k < kIn; ++k) {
      if (call.uniform[k]) continue;
      for (std::size_t j = 0; j < count; ++j) in[k][j] = static_cast<double>(call.in[k][begin + j]);
    }
    RunLanes<K, Accuracy::kStandard>(wide, count);
    for (std::size_t k = 0; k < kOut; ++k) {
      for (std::size_t j = 0; j < count; ++j) {
        const double y = out[k][j];
        call.out[k][begin + j] = static_cast<float>(y > kLargest ? kLargest : y < -kLargest ? -kLargest : y);
      }
    }
  }
}

// The kernels K..., which stand together in the kernel list, on this target.
template <class... K>
struct FamilyKernels {
  static constexpr std::size_t kFirst = std::min({Shape<K>::kIndex...});
  static constexpr std::array<KernelCode, sizeof...(K)> Make() {
    static_assert(std::max({Shape<K>::kIndex...}) == kFirst + sizeof...(K) - 1);
    std::array<KernelCode, sizeof...(K)> code{};
    ((code[Shape<K>::kIndex - kFirst] = {&RunLanes<K, Accuracy::kStandard, float>,
                                         &RunLanes<K, Accuracy::kFast, float>, &RunHigh<K>,
                                         &RunLanes<K, Accuracy::kStandard, double>}),
     ...);
    return code;
  }
  static constexpr std::array<KernelCode, sizeof...(K)> kCode = Make();
};

template <class... K>
FamilyCode Family() {
  return {FamilyKernels<K...>::kCode.data(), FamilyKernels<K...>::kFirst};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_SRC_BATCH_INL_H_
