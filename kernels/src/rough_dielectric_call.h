// Builds the calls of the rough dielectric's public functions. Includes no Highway.
#ifndef MICROLANE_SRC_ROUGH_DIELECTRIC_CALL_H_
#define MICROLANE_SRC_ROUGH_DIELECTRIC_CALL_H_

#include "microlane/rough_dielectric.h"
#include "src/dispatch.h"

namespace microlane {

template <class T>
void AddSurface(const DielectricParameters<T>& surface, CallBuilder<T>& call) {
  call.In(surface.alpha_x).In(surface.alpha_y).In(surface.eta);
}
template <class T>
void AddSurface(const PhongDielectricParameters<T>& surface, CallBuilder<T>& call) {
  call.In(surface.exponent).In(surface.eta);
}

// The arguments must outlive the call.
template <class T, class Surface>
CallBuilder<T> DirectionPairCall(const Directions<T>& wi, const Directions<T>& wo, const Surface& surface) {
  CallBuilder<T> call;
  call.In(wi).In(wo);
  AddSurface(surface, call);
  return call;
}

template <class T, class Surface>
CallBuilder<T> SampleCall(const Directions<T>& wi, const T* u1, const T* u2, const T* u3,
                          const Surface& surface, const DielectricSamples<T>& samples) {
  CallBuilder<T> call;
  call.In(wi).In(u1).In(u2).In(u3);
  AddSurface(surface, call);
  call.Out(samples.wo).Out(samples.weight).Out(samples.pdf).Out(samples.lobe);
  return call;
}

}  // namespace microlane

#endif  // MICROLANE_SRC_ROUGH_DIELECTRIC_CALL_H_
