// Interfaced Lambertian microfacets in batches (Meneveaux 2015): a Lambertian body under a smooth dielectric
// interface, of one facet or flat surface, and of rough ones by a quadrature of any order over the normals.
// What the interface itself reflects is rough_dielectric's eval_reflection.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function, of rough surfaces <family>.<id>, against the sum over the
// rule's normals; NaN in gives NaN out in that lane.
#ifndef MICROLANE_INTERFACED_H_
#define MICROLANE_INTERFACED_H_

#include <cstddef>

#include "microlane/kernel_list.h"
#include "microlane/packets.h"
#include "microlane/quadrature.h"
#include "microlane/rough_reflector.h"

namespace microlane {

// A body: its index over that of the outside, 1 to 4, and its albedo in one channel, 0 to 1; beyond these
// they count as the nearer end.
template <class T>
struct Body {
  Parameter<T> n_i, k;
};

namespace interfaced {

// T(cos_i) T(cos_o) k/(pi n_i^2 (1 - k r_i)) in 1/sr, 0 where a cosine is not above 0. Meneveaux 2015 Eq. 8.
// interfaced.facet_body.
template <class T>
void FacetBody(std::size_t n, const T* cos_i, const T* cos_o, const Body<T>& body, T* f,
               Accuracy accuracy = Accuracy::kStandard);

}  // namespace interfaced

// Rough surfaces over one distribution of normals in lanes of T. Light comes from wi and leaves to wo on the
// same side of the surface, above or below; f_cos = f |cos(theta_o)| in 1/sr, 0 where a direction lies in the
// surface and for opposite sides. Light that goes from facet to facet is left out.
template <Normals kNormals, class T>
class InterfacedBodyLanes {
 public:
  // Meneveaux 2015 Eq. 12. eval, eval_separable.
  static void Eval(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                   const RoughnessOf<kNormals, T>& roughness, const Body<T>& body, const QuadratureRule& rule,
                   T* f_cos, Accuracy accuracy = Accuracy::kStandard,
                   JointMasking masking = JointMasking::kHeightCorrelated);
};

// The same in float and double: T is that of the outputs.
template <Normals kNormals>
class InterfacedBodyCalls : InterfacedBodyLanes<kNormals, float>, InterfacedBodyLanes<kNormals, double> {
 public:
  using InterfacedBodyLanes<kNormals, float>::Eval;
  using InterfacedBodyLanes<kNormals, double>::Eval;
};

using interfaced_body = InterfacedBodyCalls<Normals::kGgx>;
using interfaced_body_beckmann = InterfacedBodyCalls<Normals::kBeckmann>;

}  // namespace microlane

#endif  // MICROLANE_INTERFACED_H_
