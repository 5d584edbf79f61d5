// A call of a surface whose channels share everything but their facets. Includes no Highway.
#ifndef MICROLANE_SRC_CHANNELS_H_
#define MICROLANE_SRC_CHANNELS_H_

#include <cstddef>

#include "microlane/quadrature.h"
#include "microlane/rough_reflector.h"

namespace microlane {

// Facets: the parameters of one channel.
template <class Facets>
struct ChannelCall {
  const float* in[9];  // wi, wo, then the distribution's parameters, then those that channels share
  bool uniform[9];     // of the latter two
  bool separable;      // masking
  Accuracy accuracy;   // kStandard or kFast
  std::size_t channels;
  const Facets* facets;
  float* const* out;
  const QuadratureRule* rule;  // of sums over normals, or null

  void Put(std::size_t k, const Parameter<float>& parameter) {
    in[k] = parameter.data();
    uniform[k] = parameter.uniform();
  }
};

using ConductorChannels = ChannelCall<FacetParameters<Reflector::kConductor, float>>;
using SchlickChannels = ChannelCall<FacetParameters<Reflector::kSchlick, float>>;
using BodyChannels = ChannelCall<Parameter<float>>;

// One distribution's on one target.
struct ChannelCode {
  void (*conductors)(const ConductorChannels&, std::size_t);
  void (*schlick)(const SchlickChannels&, std::size_t);
};
using ChannelFunction = ChannelCode (*)();
using BodyChannelCode = void (*)(const BodyChannels&, std::size_t);
using BodyChannelFunction = BodyChannelCode (*)();

template <Normals kNormals>
const ChannelFunction* ChannelTable();
template <>
const ChannelFunction* ChannelTable<Normals::kGgx>();
template <>
const ChannelFunction* ChannelTable<Normals::kBeckmann>();
template <>
const ChannelFunction* ChannelTable<Normals::kPhong>();

template <Normals kNormals>
const BodyChannelFunction* BodyChannelTable();
template <>
const BodyChannelFunction* BodyChannelTable<Normals::kGgx>();
template <>
const BodyChannelFunction* BodyChannelTable<Normals::kBeckmann>();

inline void Run(const ChannelCode& code, const ConductorChannels& call, std::size_t n) {
  code.conductors(call, n);
}
inline void Run(const ChannelCode& code, const SchlickChannels& call, std::size_t n) {
  code.schlick(call, n);
}

}  // namespace microlane

#endif  // MICROLANE_SRC_CHANNELS_H_
