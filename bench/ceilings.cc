#include "ceilings.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "ceilings.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "hwy/highway.h"
#include "stopwatch.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

// Chains side by side: enough that none waits (4 cycles of latency, 2 instructions in each), few enough for
// 16 registers.
constexpr int kChains = 10;
constexpr int kSteps = 200;

#if HWY_ARCH_X86
constexpr bool kHasFma = HWY_TARGET <= HWY_AVX2;
#else
constexpr bool kHasFma = HWY_TARGET != HWY_SCALAR && HWY_TARGET != HWY_EMU128;
#endif

volatile double sink;

template <class D, class V>
HWY_INLINE void Consume(D d, V v) {
  sink = static_cast<double>(hn::GetLane(v));
  (void)d;
}

// Keeps GCC from making vectors of single numbers.
template <class V>
HWY_INLINE V Apart(V v) {
#if HWY_TARGET == HWY_SCALAR && HWY_ARCH_X86
  asm volatile("" : "+x"(v.raw));
#endif
  return v;
}

// The cheapest bitwise operation.
template <class V>
HWY_INLINE V Bitwise(V v, V c) {
#if HWY_TARGET == HWY_SCALAR && HWY_ARCH_X86
  asm("andnps %1, %0" : "+x"(v.raw) : "x"(c.raw));  // Highway's own goes through a general register
  return v;
#else
  return hn::AndNot(v, c);
#endif
}

// Nanoseconds per call of `step`, which takes a vector to the next of its chain.
template <class D, class Step>
HWY_INLINE double Chains(D d, const Step& step) {
  using V = hn::Vec<D>;
  using T = hn::TFromD<D>;
  const auto run = [&]() HWY_ATTR {
    V v0 = hn::Set(d, T(1.1)), v1 = hn::Set(d, T(1.2)), v2 = hn::Set(d, T(1.3)), v3 = hn::Set(d, T(1.4)),
      v4 = hn::Set(d, T(1.5)), v5 = hn::Set(d, T(1.6)), v6 = hn::Set(d, T(1.7)), v7 = hn::Set(d, T(1.8)),
      v8 = hn::Set(d, T(1.9)), v9 = hn::Set(d, T(1.95));
    for (int i = 0; i < kSteps; ++i) {
      v0 = Apart(step(v0));
      v1 = Apart(step(v1));
      v2 = Apart(step(v2));
      v3 = Apart(step(v3));
      v4 = Apart(step(v4));
      v5 = Apart(step(v5));
      v6 = Apart(step(v6));
      v7 = Apart(step(v7));
      v8 = Apart(step(v8));
      v9 = Apart(step(v9));
    }
    const V a = hn::Add(hn::Add(v0, v1), hn::Add(v2, v3)), b = hn::Add(hn::Add(v4, v5), hn::Add(v6, v7));
    Consume(d, hn::Add(hn::Add(a, b), hn::Add(v8, v9)));
  };
  return Measure(0.004, run).min / (kChains * kSteps);
}

template <class D>
void MeasureUnits(D d, double* ns) {
  using V = hn::Vec<D>;
  using T = hn::TFromD<D>;
  const V c = hn::Set(d, T(1.37)), e = hn::Set(d, T(-0.51));
  const auto set = [&](Unit unit, double value) { ns[static_cast<std::size_t>(unit)] = value; };
  if (kHasFma) {
    set(Unit::kMultiplication, Chains(d, [&](V v) HWY_ATTR { return hn::MulAdd(v, e, c); }));
  } else {
    const V near_one = hn::Set(d, T(1.01));
    set(Unit::kMultiplication, Chains(d, [&](V v) HWY_ATTR { return hn::Mul(v, near_one); }));
  }
  set(Unit::kAddition, Chains(d, [&](V v) HWY_ATTR { return hn::Add(v, e); }));
  set(Unit::kLogic, Chains(d, [&](V v) HWY_ATTR { return Bitwise(v, c); }));
  set(Unit::kDivision, Chains(d, [&](V v) HWY_ATTR { return hn::Div(c, v); }));
  // A root of c v stays off 1. The product runs beside the divider.
  set(Unit::kRoot, Chains(d, [&](V v) HWY_ATTR { return hn::Sqrt(hn::Mul(v, c)); }));
  if constexpr (sizeof(T) == 4) {
    set(Unit::kReciprocal, Chains(d, [&](V v) HWY_ATTR { return hn::ApproximateReciprocal(v); }));
    set(Unit::kReciprocalRoot, Chains(d, [&](V v) HWY_ATTR { return hn::ApproximateReciprocalSqrt(v); }));
  }
}

template <std::size_t kWidth>
void MeasureWidth(Ceilings& ceilings) {
#if HWY_TARGET == HWY_SCALAR
  if constexpr (kWidth == 0) {
    MeasureUnits(hn::CappedTag<float, 1>(), ceilings.ns[kWidth][0]);
    MeasureUnits(hn::CappedTag<double, 1>(), ceilings.ns[kWidth][1]);
  }
#else
  constexpr std::size_t kBytes = kWidthBytes[kWidth];
  if (kWidth == 0 || hn::Lanes(hn::ScalableTag<float>()) * sizeof(float) < kBytes) return;
  MeasureUnits(hn::CappedTag<float, kBytes / 4>(), ceilings.ns[kWidth][0]);
  MeasureUnits(hn::CappedTag<double, kBytes / 8>(), ceilings.ns[kWidth][1]);
#endif
}

void MeasureCeilings(Ceilings& ceilings) {
  MeasureWidth<0>(ceilings);
  MeasureWidth<1>(ceilings);
  MeasureWidth<2>(ceilings);
  MeasureWidth<3>(ceilings);
}

std::size_t LanesOfFloat() { return hn::Lanes(hn::ScalableTag<float>()); }

template <std::size_t kIn, std::size_t kOut>
void Copy(const Call<float>& call, std::size_t n) {
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  const float* in[kIn];
  float* out[kOut];
  for (std::size_t k = 0; k < kIn; ++k) in[k] = call.in[k];
  for (std::size_t k = 0; k < kOut; ++k) out[k] = call.out[k];
  for (std::size_t i = 0; i + lanes <= n; i += lanes) {
    auto v = hn::LoadU(d, in[0] + i);
    for (std::size_t k = 1; k < kIn; ++k) v = hn::Xor(v, hn::LoadU(d, in[k] + i));
    for (std::size_t k = 0; k < kOut; ++k) hn::StoreU(v, d, out[k] + i);
  }
}

template <std::size_t kIn>
void CopyOut(const Call<float>& call, std::size_t stored, std::size_t n) {
  switch (stored) {
    case 1:
      return Copy<kIn, 1>(call, n);
    case 2:
      return Copy<kIn, 2>(call, n);
    case 3:
      return Copy<kIn, 3>(call, n);
    case 4:
      return Copy<kIn, 4>(call, n);
    case 5:
      return Copy<kIn, 5>(call, n);
    default:
      return Copy<kIn, 6>(call, n);
  }
}

void CopyInOut(const Call<float>& call, std::size_t loaded, std::size_t stored, std::size_t n) {
  switch (loaded) {
    case 1:
      return CopyOut<1>(call, stored, n);
    case 2:
      return CopyOut<2>(call, stored, n);
    case 3:
      return CopyOut<3>(call, stored, n);
    case 4:
      return CopyOut<4>(call, stored, n);
    case 5:
      return CopyOut<5>(call, stored, n);
    case 6:
      return CopyOut<6>(call, stored, n);
    case 7:
      return CopyOut<7>(call, stored, n);
    case 8:
      return CopyOut<8>(call, stored, n);
    default:
      return CopyOut<9>(call, stored, n);
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include <map>
#include <string>

#include "microlane/targets.h"
#include "src/dispatch.h"

namespace microlane {

HWY_EXPORT(MeasureCeilings);
HWY_EXPORT(LanesOfFloat);
HWY_EXPORT(CopyInOut);

double Ceilings::Of(std::size_t width, bool is_double, Unit unit) const {
  const std::size_t u = static_cast<std::size_t>(unit);
  for (std::size_t w = width; w < kWidths; ++w) {
    if (ns[w][is_double][u] > 0) return ns[w][is_double][u];
  }
  for (std::size_t w = width; w-- > 0;) {
    if (ns[w][is_double][u] > 0) return ns[w][is_double][u];
  }
  return is_double ? Of(width, false, unit) : 0;
}

const Ceilings& ChosenCeilings() {
  static std::map<std::string, Ceilings> measured;
  const auto [place, is_new] = measured.try_emplace(ChosenTarget());
  if (is_new) HWY_DISPATCH_TABLE(MeasureCeilings)[ChosenTableIndex()](place->second);
  return place->second;
}

std::size_t FloatLanes() { return HWY_DISPATCH_TABLE(LanesOfFloat)[ChosenTableIndex()](); }

void LoadAndStore(const Call<float>& call, std::size_t loaded, std::size_t stored, std::size_t n) {
  HWY_DISPATCH_TABLE(CopyInOut)[ChosenTableIndex()](call, loaded, stored, n);
}

}  // namespace microlane
#endif  // HWY_ONCE
