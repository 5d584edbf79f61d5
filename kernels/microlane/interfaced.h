// Interfaced Lambertian microfacets in batches (Meneveaux 2015): a Lambertian body under a smooth dielectric
// interface, of one facet or flat surface, and of rough ones by a quadrature of any order over the normals or
// by one random normal.
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
  // Eval for `channels` albedos k under one interface, output by output. In kFast and kStandard float lanes
  // they share one sum over the normals. eval, eval_separable.
  static void EvalChannels(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                           const RoughnessOf<kNormals, T>& roughness, const Parameter<T>& n_i,
                           std::size_t channels, const Parameter<T>* k, const QuadratureRule& rule,
                           T* const* f_cos, Accuracy accuracy = Accuracy::kStandard,
                           JointMasking masking = JointMasking::kHeightCorrelated);
  // One normal's estimate of Eval's integral (Meneveaux 2015 Eq. 28), unbiased for m drawn as `sampling`
  // says, by the distribution's SampleVisibleNormal of wi or SampleNormal. eval_one_visible_normal,
  // eval_one_normal, and these with _separable.
  static void EvalOneNormal(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                            const Directions<T>& m, const RoughnessOf<kNormals, T>& roughness,
                            const Body<T>& body, T* f_cos, Accuracy accuracy = Accuracy::kStandard,
                            JointMasking masking = JointMasking::kHeightCorrelated,
                            Sampling sampling = Sampling::kVisibleNormals);
  // Density in 1/sr of wo drawn from the interface, as rough_dielectric's visible normals reflect, or from
  // the body, by the cosine: with the probabilities R_s/(R_s + R_b) and R_b/(R_s + R_b) of a flat surface
  // (Meneveaux 2015 section 4). pdf_with_interface.
  static void PdfWithInterface(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                               const RoughnessOf<kNormals, T>& roughness, const Body<T>& body, T* pdf,
                               Accuracy accuracy = Accuracy::kStandard);
  // wo with PdfWithInterface's density, and f_cos of interface and body over it, the body's estimated by one
  // visible normal of u4 and u5: u1 and u2 draw wo, u3 chooses between interface (lobe 1) and body (2). Where
  // wo is below the surface all is 0. sample_with_interface.
  static void SampleWithInterface(std::size_t n, const Directions<T>& wi, const T* u1, const T* u2,
                                  const T* u3, const T* u4, const T* u5,
                                  const RoughnessOf<kNormals, T>& roughness, const Body<T>& body,
                                  const DielectricSamples<T>& samples,
                                  Accuracy accuracy = Accuracy::kStandard);
};

// The same in float and double: T is that of the outputs.
template <Normals kNormals>
class InterfacedBodyCalls : InterfacedBodyLanes<kNormals, float>, InterfacedBodyLanes<kNormals, double> {
 public:
  using InterfacedBodyLanes<kNormals, float>::Eval;
  using InterfacedBodyLanes<kNormals, double>::Eval;
  using InterfacedBodyLanes<kNormals, float>::EvalChannels;
  using InterfacedBodyLanes<kNormals, double>::EvalChannels;
  using InterfacedBodyLanes<kNormals, float>::EvalOneNormal;
  using InterfacedBodyLanes<kNormals, double>::EvalOneNormal;
  using InterfacedBodyLanes<kNormals, float>::PdfWithInterface;
  using InterfacedBodyLanes<kNormals, double>::PdfWithInterface;
  using InterfacedBodyLanes<kNormals, float>::SampleWithInterface;
  using InterfacedBodyLanes<kNormals, double>::SampleWithInterface;
};

using interfaced_body = InterfacedBodyCalls<Normals::kGgx>;
using interfaced_body_beckmann = InterfacedBodyCalls<Normals::kBeckmann>;

}  // namespace microlane

#endif  // MICROLANE_INTERFACED_H_
