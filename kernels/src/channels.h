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

// On the chosen target.
template <Normals kNormals>
void RunOnTarget(const ConductorChannels& call, std::size_t n);
template <Normals kNormals>
void RunOnTarget(const SchlickChannels& call, std::size_t n);

}  // namespace microlane

#endif  // MICROLANE_SRC_CHANNELS_H_
