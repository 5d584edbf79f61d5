// The loop of surfaces whose channels share everything but their facets.
#if defined(MICROLANE_SRC_CHANNELS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef MICROLANE_SRC_CHANNELS_INL_H_
#undef MICROLANE_SRC_CHANNELS_INL_H_
#else
#define MICROLANE_SRC_CHANNELS_INL_H_
#endif

#include <cstddef>
#include <limits>
#include <utility>

#include "microlane/rough_reflector-inl.h"
#include "src/batch-inl.h"
#include "src/channels.h"
#include "src/rough_surface_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

inline const Parameter<float>& ParameterOfFacets(const FacetParameters<Reflector::kConductor, float>& facets,
                                                 std::size_t k) {
  return k == 0 ? facets.n : facets.kappa;
}
inline const Parameter<float>& ParameterOfFacets(const FacetParameters<Reflector::kSchlick, float>& facets,
                                                 std::size_t) {
  return facets.f0;
}

template <class Dist, Reflector kReflector, JointMasking kG, Accuracy A, std::size_t... kRoughness>
HWY_NOINLINE void ChannelLoop(const ChannelCall<kReflector>& call, std::size_t n,
                              std::index_sequence<kRoughness...>) {
  using Facets = FacetsOf<kReflector>;
  const hn::ScalableTag<float> d;
  using V = Vec<decltype(d)>;
  const std::size_t lanes = hn::Lanes(d);
  HWY_ALIGN float buffer[hn::MaxLanes(hn::ScalableTag<float>())];
  const V zero = hn::Zero(d);
  for (std::size_t i = 0; i < n; i += lanes) {
    const std::size_t count = HWY_MIN(lanes, n - i);
    const auto load = [&](const float* from, bool uniform) HWY_ATTR {
      return uniform          ? hn::Set(d, from[0])
             : count == lanes ? hn::LoadU(d, from + i)
                              : LoadTail(d, from + i, count);
    };
    const auto parameter = [&](std::size_t channel, std::size_t k) HWY_ATTR {
      const Parameter<float>& p = ParameterOfFacets(call.facets[channel], k);
      return load(p.data(), p.uniform());
    };
    const auto evaluate = [&](auto... in) HWY_ATTR {
      const auto any_nan = AnyNan(d, in...);
      const auto store = [&](std::size_t channel, V value) HWY_ATTR {
        const V q0 = parameter(channel, 0);
        const V q1 = Facets::kParameters > 1 ? parameter(channel, 1) : zero;
        const V nan = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
        value = hn::IfThenElse(hn::Or(any_nan, AnyNan(d, q0, q1)), nan, value);
        if (count == lanes) {
          StoreTotal(d, value, call.out[channel] + i, in..., q0, q1);
        } else {
          StoreTotal(d, value, buffer, in..., q0, q1);
          StoreTail(d, buffer, call.out[channel] + i, count);
        }
      };
      RoughReflectorChannels<Dist, Facets, kG, A>(d, call.channels, parameter, store, in...);
    };
    evaluate(load(call.in[0], false), load(call.in[1], false), load(call.in[2], false),
             load(call.in[3], false), load(call.in[4], false), load(call.in[5], false),
             load(call.in[6 + kRoughness], call.uniform[6 + kRoughness])...);
  }
}

template <class Dist, Normals kNormals, Reflector kReflector>
void RunChannels(const ChannelCall<kReflector>& call, std::size_t n) {
  constexpr auto roughness =
      std::make_index_sequence<Split(kModelFamilies[static_cast<std::size_t>(kNormals)].parameters).count>();
  constexpr JointMasking kCorrelated = JointMasking::kHeightCorrelated, kSeparable = JointMasking::kSeparable;
  const bool fast = call.accuracy == Accuracy::kFast;
  if (call.separable) {
    fast ? ChannelLoop<Dist, kReflector, kSeparable, Accuracy::kFast>(call, n, roughness)
         : ChannelLoop<Dist, kReflector, kSeparable, Accuracy::kStandard>(call, n, roughness);
  } else {
    fast ? ChannelLoop<Dist, kReflector, kCorrelated, Accuracy::kFast>(call, n, roughness)
         : ChannelLoop<Dist, kReflector, kCorrelated, Accuracy::kStandard>(call, n, roughness);
  }
}

template <class Dist, Normals kNormals>
ChannelCode Channels() {
  return {RunChannels<Dist, kNormals, Reflector::kConductor>,
          RunChannels<Dist, kNormals, Reflector::kSchlick>};
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_SRC_CHANNELS_INL_H_
