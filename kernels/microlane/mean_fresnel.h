// Fresnel's mean over the normals visible from a direction in batches (Heitz 2014 Eq. 105): what share of the
// light that a rough surface shows is reflected at the first facet. By a quadrature of any order, or by a
// fit.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function, <family>.<id>, against the sum over the rule's normals; NaN
// in gives NaN out in that lane.
//
// Directions v are of either side, and count as on the upper one. Results are in [0, 1].
#ifndef MICROLANE_MEAN_FRESNEL_H_
#define MICROLANE_MEAN_FRESNEL_H_

#include <cstddef>

#include "microlane/kernel_list.h"
#include "microlane/packets.h"
#include "microlane/quadrature.h"
#include "microlane/rough_reflector.h"

namespace microlane {

// The calls over one distribution of normals in lanes of T.
template <Normals kNormals, class T>
class MeanFresnelLanes {
 public:
  using Roughness = RoughnessOf<kNormals, T>;

  // Of a dielectric, eta the index of the transmitted over the incident side. The sum converges slowly where
  // some of the normals reflect totally (eta < 1). dielectric.
  static void Dielectric(std::size_t n, const Directions<T>& v, const Roughness& roughness,
                         const Parameter<T>& eta, const QuadratureRule& rule, T* f,
                         Accuracy accuracy = Accuracy::kStandard);

  // Of a conductor. conductor.
  static void Conductor(std::size_t n, const Directions<T>& v, const Roughness& roughness,
                        const FacetParameters<Reflector::kConductor, T>& facets, const QuadratureRule& rule,
                        T* f, Accuracy accuracy = Accuracy::kStandard);

  // Of Schlick's approximation. schlick.
  static void Schlick(std::size_t n, const Directions<T>& v, const Roughness& roughness,
                      const FacetParameters<Reflector::kSchlick, T>& facets, const QuadratureRule& rule, T* f,
                      Accuracy accuracy = Accuracy::kStandard);

  // For real time: the cosine at which Schlick's F is its mean over an isotropic surface seen at cos_i, as a
  // fit for alpha up to 2 (above, it counts as 2). Any F at that cosine is near its mean. cosine.
  static void Cosine(std::size_t n, const T* cos_i, const Parameter<T>& alpha, T* cosine,
                     Accuracy accuracy = Accuracy::kStandard);
};

// The same in float and double: T is that of the outputs.
template <Normals kNormals>
class MeanFresnelCalls : MeanFresnelLanes<kNormals, float>, MeanFresnelLanes<kNormals, double> {
 public:
  using MeanFresnelLanes<kNormals, float>::Dielectric;
  using MeanFresnelLanes<kNormals, double>::Dielectric;
  using MeanFresnelLanes<kNormals, float>::Conductor;
  using MeanFresnelLanes<kNormals, double>::Conductor;
  using MeanFresnelLanes<kNormals, float>::Schlick;
  using MeanFresnelLanes<kNormals, double>::Schlick;
  using MeanFresnelLanes<kNormals, float>::Cosine;
  using MeanFresnelLanes<kNormals, double>::Cosine;
};

using mean_fresnel = MeanFresnelCalls<Normals::kGgx>;
using mean_fresnel_beckmann = MeanFresnelCalls<Normals::kBeckmann>;

}  // namespace microlane

#endif  // MICROLANE_MEAN_FRESNEL_H_
