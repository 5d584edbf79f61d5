// Diffuse rough surfaces in batches: white Lambertian microfacets (Heitz 2014 Eq. 31), by a quadrature of any
// order over the normals, or by one random normal. Multiply by the facets' albedo; light that goes from facet
// to facet is left out.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function, <family>.<id>, against the sum over the rule's normals; NaN
// in gives NaN out in that lane.
//
// Light comes from wi and leaves to wo on the same side of the surface, above or below. Values f_cos = f
// |cos(theta_o)| are in 1/sr, and 0 where a direction lies in the surface and for opposite sides.
#ifndef MICROLANE_ROUGH_DIFFUSE_H_
#define MICROLANE_ROUGH_DIFFUSE_H_

#include <cstddef>

#include "microlane/kernel_list.h"
#include "microlane/packets.h"
#include "microlane/quadrature.h"
#include "microlane/rough_reflector.h"

namespace microlane {

// The calls over one distribution of normals in lanes of T.
template <Normals kNormals, class T>
class RoughDiffuseLanes {
 public:
  // Heitz 2014 Eq. 31. eval, eval_separable.
  static void Eval(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                   const RoughnessOf<kNormals, T>& roughness, const QuadratureRule& rule, T* f_cos,
                   Accuracy accuracy = Accuracy::kStandard,
                   JointMasking masking = JointMasking::kHeightCorrelated);
  // One normal's estimate of Eval's integral (Meneveaux 2015 Eq. 28), unbiased for m drawn as `sampling`
  // says, by the distribution's SampleVisibleNormal of wi or SampleNormal. eval_one_visible_normal,
  // eval_one_normal, and these with _separable.
  static void EvalOneNormal(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                            const Directions<T>& m, const RoughnessOf<kNormals, T>& roughness, T* f_cos,
                            Accuracy accuracy = Accuracy::kStandard,
                            JointMasking masking = JointMasking::kHeightCorrelated,
                            Sampling sampling = Sampling::kVisibleNormals);
};

// The same in float and double: T is that of the outputs.
template <Normals kNormals>
class RoughDiffuseCalls : RoughDiffuseLanes<kNormals, float>, RoughDiffuseLanes<kNormals, double> {
 public:
  using RoughDiffuseLanes<kNormals, float>::Eval;
  using RoughDiffuseLanes<kNormals, double>::Eval;
  using RoughDiffuseLanes<kNormals, float>::EvalOneNormal;
  using RoughDiffuseLanes<kNormals, double>::EvalOneNormal;
};

using rough_diffuse = RoughDiffuseCalls<Normals::kGgx>;
using rough_diffuse_beckmann = RoughDiffuseCalls<Normals::kBeckmann>;

}  // namespace microlane

#endif  // MICROLANE_ROUGH_DIFFUSE_H_
