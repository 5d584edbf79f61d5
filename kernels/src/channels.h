// A call of a surface whose channels share everything but their facets. Includes no Highway.
#ifndef MICROLANE_SRC_CHANNELS_H_
#define MICROLANE_SRC_CHANNELS_H_

#include <cstddef>

#include "microlane/rough_reflector.h"

namespace microlane {

template <Reflector kReflector>
struct ChannelCall {
  const float* in[8];  // wi, wo, then the distribution's parameters
  bool uniform[8];     // of the latter
  bool separable;      // masking
  Accuracy accuracy;   // kStandard or kFast
  std::size_t channels;
  const FacetParameters<kReflector, float>* facets;
  float* const* out;
};

using ConductorChannels = ChannelCall<Reflector::kConductor>;
using SchlickChannels = ChannelCall<Reflector::kSchlick>;

// One distribution's on one target.
struct ChannelCode {
  void (*conductors)(const ConductorChannels&, std::size_t);
  void (*schlick)(const SchlickChannels&, std::size_t);
};
using ChannelFunction = ChannelCode (*)();

template <Normals kNormals>
const ChannelFunction* ChannelTable();
template <>
const ChannelFunction* ChannelTable<Normals::kGgx>();
template <>
const ChannelFunction* ChannelTable<Normals::kBeckmann>();
template <>
const ChannelFunction* ChannelTable<Normals::kPhong>();

inline void Run(const ChannelCode& code, const ConductorChannels& call, std::size_t n) {
  code.conductors(call, n);
}
inline void Run(const ChannelCode& code, const SchlickChannels& call, std::size_t n) {
  code.schlick(call, n);
}

}  // namespace microlane

#endif  // MICROLANE_SRC_CHANNELS_H_
