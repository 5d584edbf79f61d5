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

#include "microlane/interfaced-inl.h"
#include "microlane/rough_reflector-inl.h"
#include "src/batch-inl.h"
#include "src/channels.h"
#include "src/rough_surface_kernels-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// A channel's parameter k, and what channels of it make: Run<kG, A>(d, call, parameter, store, wi, wo, what
// the call has behind them).
template <class Dist, Reflector kReflector>
struct ReflectorChannels {
  static constexpr std::size_t kParameters = FacetsOf<kReflector>::kParameters;

  static const Parameter<float>& Of(const FacetParameters<kReflector, float>& facets, std::size_t k) {
    if constexpr (kReflector == Reflector::kConductor) {
      return k == 0 ? facets.n : facets.kappa;
    } else {
      (void)k;
      return facets.f0;
    }
  }

  template <JointMasking kG, Accuracy A, class D, class Call, class Parameter, class Store, class... V>
  static HWY_INLINE void Run(D d, const Call& call, const Parameter& parameter, const Store& store, V... in) {
    RoughReflectorChannels<Dist, FacetsOf<kReflector>, kG, A>(d, call.channels, parameter, store, in...);
  }
};

template <class Dist, class Radius>
struct InterfacedBodyChannels {
  static constexpr std::size_t kParameters = 1;

  static const Parameter<float>& Of(const Parameter<float>& k, std::size_t) { return k; }

  template <JointMasking kG, Accuracy A, class D, class Call, class Parameter, class Store, class... V>
  static HWY_INLINE void Run(D d, const Call& call, const Parameter& parameter, const Store& store, V... in) {
    InterfacedBodiesOf<Dist, Radius, kG, A>(d, *call.rule, call.channels, parameter, store, in...);
  }
};

template <class Model, JointMasking kG, Accuracy A, class Facets, std::size_t... kShared>
HWY_NOINLINE void ChannelLoop(const ChannelCall<Facets>& call, std::size_t n,
                              std::index_sequence<kShared...>) {
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
      const Parameter<float>& p = Model::Of(call.facets[channel], k);
      return load(p.data(), p.uniform());
    };
    const auto evaluate = [&](auto... in) HWY_ATTR {
      const auto any_nan = AnyNan(d, in...);
      const auto store = [&](std::size_t channel, V value) HWY_ATTR {
        const V q0 = parameter(channel, 0);
        const V q1 = Model::kParameters > 1 ? parameter(channel, 1) : zero;
        const V nan = hn::Set(d, std::numeric_limits<float>::quiet_NaN());
        value = hn::IfThenElse(hn::Or(any_nan, AnyNan(d, q0, q1)), nan, value);
        if (count == lanes) {
          StoreTotal(d, value, call.out[channel] + i, in..., q0, q1);
        } else {
          StoreTotal(d, value, buffer, in..., q0, q1);
          StoreTail(d, buffer, call.out[channel] + i, count);
        }
      };
      Model::template Run<kG, A>(d, call, parameter, store, in...);
    };
    evaluate(load(call.in[0], false), load(call.in[1], false), load(call.in[2], false),
             load(call.in[3], false), load(call.in[4], false), load(call.in[5], false),
             load(call.in[6 + kShared], call.uniform[6 + kShared])...);
  }
}

// kShared: how many parameters the channels share.
template <class Model, std::size_t kShared, class Facets>
void RunChannels(const ChannelCall<Facets>& call, std::size_t n) {
  constexpr auto shared = std::make_index_sequence<kShared>();
  constexpr JointMasking kCorrelated = JointMasking::kHeightCorrelated, kSeparable = JointMasking::kSeparable;
  const bool fast = call.accuracy == Accuracy::kFast;
  if (call.separable) {
    fast ? ChannelLoop<Model, kSeparable, Accuracy::kFast>(call, n, shared)
         : ChannelLoop<Model, kSeparable, Accuracy::kStandard>(call, n, shared);
  } else {
    fast ? ChannelLoop<Model, kCorrelated, Accuracy::kFast>(call, n, shared)
         : ChannelLoop<Model, kCorrelated, Accuracy::kStandard>(call, n, shared);
  }
}

template <Normals kNormals>
inline constexpr std::size_t kRoughnessParameters =
    Split(kModelFamilies[static_cast<std::size_t>(kNormals)].parameters).count;

template <class Dist, Normals kNormals>
ChannelCode Channels() {
  constexpr std::size_t kShared = kRoughnessParameters<kNormals>;
  return {RunChannels<ReflectorChannels<Dist, Reflector::kConductor>, kShared>,
          RunChannels<ReflectorChannels<Dist, Reflector::kSchlick>, kShared>};
}
template <class Dist, class Radius, Normals kNormals>
BodyChannelCode BodyChannelsOf() {
  return RunChannels<InterfacedBodyChannels<Dist, Radius>, kRoughnessParameters<kNormals> + 1>;
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#endif  // MICROLANE_SRC_CHANNELS_INL_H_
