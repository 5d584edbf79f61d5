// The public functions of means over visible normals. Includes no Highway.
#ifndef MICROLANE_SRC_MEAN_FRESNEL_CALL_H_
#define MICROLANE_SRC_MEAN_FRESNEL_CALL_H_

#include <cstddef>

#include "microlane/mean_fresnel.h"
#include "src/dispatch.h"

namespace microlane {

// A call with the parameters of the facets.
template <Normals kNormals, MeanFresnelQuantity::What kWhat, class T, class... Facets>
void RunMeanFresnel(std::size_t n, const Directions<T>& v, const RoughnessOf<kNormals, T>& roughness,
                    const QuadratureRule& rule, T* f, Accuracy accuracy, const Facets&... facets) {
  CallBuilder<T> call;
  call.In(v).In(roughness.alpha_x).In(roughness.alpha_y);
  (call.In(facets), ...);
  call.Out(f).In(rule);
  call.template Run<MeanFresnelKernel(kNormals, kWhat)>(MeanFresnelTable<kNormals>(), accuracy, n);
}

template <Normals kNormals, class T>
void MeanFresnelLanes<kNormals, T>::Dielectric(std::size_t n, const Directions<T>& v,
                                               const Roughness& roughness, const Parameter<T>& eta,
                                               const QuadratureRule& rule, T* f, Accuracy accuracy) {
  RunMeanFresnel<kNormals, MeanFresnelQuantity::kDielectric>(n, v, roughness, rule, f, accuracy, eta);
}

template <Normals kNormals, class T>
void MeanFresnelLanes<kNormals, T>::Conductor(std::size_t n, const Directions<T>& v,
                                              const Roughness& roughness,
                                              const FacetParameters<Reflector::kConductor, T>& facets,
                                              const QuadratureRule& rule, T* f, Accuracy accuracy) {
  RunMeanFresnel<kNormals, MeanFresnelQuantity::kConductor>(n, v, roughness, rule, f, accuracy, facets.n,
                                                            facets.kappa);
}

template <Normals kNormals, class T>
void MeanFresnelLanes<kNormals, T>::Schlick(std::size_t n, const Directions<T>& v, const Roughness& roughness,
                                            const FacetParameters<Reflector::kSchlick, T>& facets,
                                            const QuadratureRule& rule, T* f, Accuracy accuracy) {
  RunMeanFresnel<kNormals, MeanFresnelQuantity::kSchlick>(n, v, roughness, rule, f, accuracy, facets.f0);
}

template <Normals kNormals, class T>
void MeanFresnelLanes<kNormals, T>::Cosine(std::size_t n, const T* cos_i, const Parameter<T>& alpha,
                                           T* cosine, Accuracy accuracy) {
  CallBuilder<T>()
      .In(cos_i)
      .In(alpha)
      .Out(cosine)
      .template Run<MeanFresnelKernel(kNormals, MeanFresnelQuantity::kCosine)>(MeanFresnelTable<kNormals>(),
                                                                               accuracy, n);
}

}  // namespace microlane

#endif  // MICROLANE_SRC_MEAN_FRESNEL_CALL_H_
