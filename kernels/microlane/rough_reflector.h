// Opaque rough surfaces in batches: ideal mirrors, conductors and Schlick's approximation as facets. Value,
// both value and density in one call, sampling. The density alone is that of the distribution:
// PdfVisibleReflection of normals.h, or, of D cos sampling, PdfReflection of rough_dielectric.h.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function, <family>.<id>; NaN in gives NaN out in that lane.
//
// Light comes from wi and leaves to wo on the same side of the surface, above or below. Values f_cos = f
// |cos(theta_o)| and densities pdf are in 1/sr, and 0 where a direction lies in the surface and for opposite
// sides.
#ifndef MICROLANE_ROUGH_REFLECTOR_H_
#define MICROLANE_ROUGH_REFLECTOR_H_

#include <cstddef>
#include <type_traits>

#include "microlane/kernel_list.h"
#include "microlane/packets.h"
#include "microlane/rough_dielectric.h"

namespace microlane {

// Roughness of GGX or Beckmann normals, and of Phong's. Each is one value or one per lane.
template <class T>
struct StretchedRoughness {
  Parameter<T> alpha_x;  // 1e-5 to 100
  Parameter<T> alpha_y;  // 1e-5 to 100
};
template <class T>
struct PhongRoughness {
  Parameter<T> exponent;  // 0 to 2e10
};
template <Normals kNormals, class T>
using RoughnessOf = std::conditional_t<kNormals == Normals::kPhong, PhongRoughness<T>, StretchedRoughness<T>>;

// What facets reflect.
template <Reflector kReflector, class T>
struct FacetParameters {};  // kMirror: all
template <class T>
struct FacetParameters<Reflector::kConductor, T> {
  Parameter<T> n;      // real part of the index over that of wi's side, 0.05 to 10
  Parameter<T> kappa;  // its imaginary part, 0 to 20
};
template <class T>
struct FacetParameters<Reflector::kSchlick, T> {
  Parameter<T> f0;  // reflectance at normal incidence, 0 to 1
};

// Braces within braces may be left out: {alpha_x, alpha_y, n, kappa}.
template <Normals kNormals, Reflector kReflector, class T>
struct OpaqueSurface {
  RoughnessOf<kNormals, T> roughness;
  FacetParameters<kReflector, T> facets;
};

// The calls over one distribution of normals and one kind of facets in lanes of T.
template <Normals kNormals, Reflector kReflector, class T>
class RoughReflectorLanes {
 public:
  using Surface = OpaqueSurface<kNormals, kReflector, T>;

  // Walter 2007 Eq. 20. eval, eval_separable.
  static void Eval(std::size_t n, const Directions<T>& wi, const Directions<T>& wo, const Surface& surface,
                   T* f_cos, Accuracy accuracy = Accuracy::kStandard,
                   JointMasking masking = JointMasking::kHeightCorrelated);

  // Eval for `channels` wavelengths: facets and output of each. Conductors and Schlick's facets share one D
  // and G2 in kStandard and kFast lanes of float; errors are those of eval, eval_separable. No output may
  // overlap an input.
  static void EvalChannels(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                           const RoughnessOf<kNormals, T>& roughness, std::size_t channels,
                           const FacetParameters<kReflector, T>* facets, T* const* f_cos,
                           Accuracy accuracy = Accuracy::kStandard,
                           JointMasking masking = JointMasking::kHeightCorrelated);

  // Eval and the density with which Sample finds wo. Walter 2007 Eqs. 14, 20; Heitz 2014 Eq. 16, or Walter
  // 2007 Eqs. 24, 38. eval_pdf_visible, eval_pdf, and these with _separable.
  static void EvalPdf(std::size_t n, const Directions<T>& wi, const Directions<T>& wo, const Surface& surface,
                      T* f_cos, T* pdf, Accuracy accuracy = Accuracy::kStandard,
                      JointMasking masking = JointMasking::kHeightCorrelated,
                      Sampling sampling = Sampling::kVisibleNormals);

  // Directions wo from uniform numbers in [0, 1): reflection about normals that are visible from wi, whose
  // weight is at most 1, or about normals by D cos. Walter 2007 Eqs. 37-39, 41. sample_visible, sample, and
  // these with _separable.
  static void Sample(std::size_t n, const Directions<T>& wi, const T* u1, const T* u2, const Surface& surface,
                     const DielectricSamples<T>& samples, Accuracy accuracy = Accuracy::kStandard,
                     JointMasking masking = JointMasking::kHeightCorrelated,
                     Sampling sampling = Sampling::kVisibleNormals);

  // The same of V-cavities (Cook and Torrance 1982; Heitz 2014 Eq. 49) in place of Smith's surface: G =
  // min(1, 2 h.z |wi.z|/(wi.h), 2 h.z |wo.z|/(wo.h)). Densities and samples are of the normals that they show
  // (SampleVisibleNormalVCavity of normals.h, where u3 chooses the facet); weights are at most 1.
  // eval_v_cavity, eval_pdf_v_cavity, sample_v_cavity.
  static void EvalVCavity(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                          const Surface& surface, T* f_cos, Accuracy accuracy = Accuracy::kStandard);
  static void EvalPdfVCavity(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                             const Surface& surface, T* f_cos, T* pdf,
                             Accuracy accuracy = Accuracy::kStandard);
  static void SampleVCavity(std::size_t n, const Directions<T>& wi, const T* u1, const T* u2, const T* u3,
                            const Surface& surface, const DielectricSamples<T>& samples,
                            Accuracy accuracy = Accuracy::kStandard);

  // The lobe of Kelemen 2001 Eq. 3, P_H F/(h.h) with P_H = D cos(theta_h) (half_vector_density::Ward over
  // Beckmann, half_vector_density::Phong over Phong) and h = wi + wo, which has no masking of its own.
  // Samples are by P_H, of weight F |wo.z|/(wi.m), at most 2. eval_kelemen, eval_pdf_kelemen, sample_kelemen.
  static void EvalKelemen(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                          const Surface& surface, T* f_cos, Accuracy accuracy = Accuracy::kStandard);
  static void EvalPdfKelemen(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                             const Surface& surface, T* f_cos, T* pdf,
                             Accuracy accuracy = Accuracy::kStandard);
  static void SampleKelemen(std::size_t n, const Directions<T>& wi, const T* u1, const T* u2,
                            const Surface& surface, const DielectricSamples<T>& samples,
                            Accuracy accuracy = Accuracy::kStandard);
};

// The same in float and double: T is that of the outputs.
template <Normals kNormals, Reflector kReflector>
class RoughReflectorCalls : RoughReflectorLanes<kNormals, kReflector, float>,
                            RoughReflectorLanes<kNormals, kReflector, double> {
  using Float = RoughReflectorLanes<kNormals, kReflector, float>;
  using Double = RoughReflectorLanes<kNormals, kReflector, double>;

 public:
  using Double::Eval;
  using Double::EvalChannels;
  using Double::EvalKelemen;
  using Double::EvalPdf;
  using Double::EvalPdfKelemen;
  using Double::EvalPdfVCavity;
  using Double::EvalVCavity;
  using Double::Sample;
  using Double::SampleKelemen;
  using Double::SampleVCavity;
  using Float::Eval;
  using Float::EvalChannels;
  using Float::EvalKelemen;
  using Float::EvalPdf;
  using Float::EvalPdfKelemen;
  using Float::EvalPdfVCavity;
  using Float::EvalVCavity;
  using Float::Sample;
  using Float::SampleKelemen;
  using Float::SampleVCavity;
};

using rough_mirror = RoughReflectorCalls<Normals::kGgx, Reflector::kMirror>;
using rough_mirror_beckmann = RoughReflectorCalls<Normals::kBeckmann, Reflector::kMirror>;
using rough_mirror_phong = RoughReflectorCalls<Normals::kPhong, Reflector::kMirror>;
using rough_conductor = RoughReflectorCalls<Normals::kGgx, Reflector::kConductor>;
using rough_conductor_beckmann = RoughReflectorCalls<Normals::kBeckmann, Reflector::kConductor>;
using rough_conductor_phong = RoughReflectorCalls<Normals::kPhong, Reflector::kConductor>;
using rough_schlick = RoughReflectorCalls<Normals::kGgx, Reflector::kSchlick>;
using rough_schlick_beckmann = RoughReflectorCalls<Normals::kBeckmann, Reflector::kSchlick>;
using rough_schlick_phong = RoughReflectorCalls<Normals::kPhong, Reflector::kSchlick>;

}  // namespace microlane

#endif  // MICROLANE_ROUGH_REFLECTOR_H_
