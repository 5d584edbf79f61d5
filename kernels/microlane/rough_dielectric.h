// The rough dielectric interface of Walter 2007 in batches: value, density, both in one call, sampling.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function, <family>.<id>; NaN in gives NaN out in that lane.
//
// Light comes from wi and leaves to wo. On the same side of the surface it is reflected, on opposite sides
// transmitted. Either may be below the surface; eta is the index on wo's side over that on wi's side in
// transmission. Values f_cos = f |cos(theta_o)| and densities pdf are in 1/sr, and 0 where a direction lies
// in the surface, where the facet that scatters is not seen from its front, and under total internal
// reflection.
#ifndef MICROLANE_ROUGH_DIELECTRIC_H_
#define MICROLANE_ROUGH_DIELECTRIC_H_

#include <cstddef>
#include <type_traits>

#include "microlane/kernel_list.h"
#include "microlane/packets.h"

namespace microlane {

// How the masking of wi and wo combine.
enum class JointMasking {
  kHeightCorrelated,  // 1/(1 + Lambda(wi) + Lambda(wo)), Heitz 2014 Eq. 99
  kSeparable,         // G1(wi) G1(wo), Walter 2007 Eq. 23
};

// What normals are drawn from. Phong has no visible normals here: it always takes kNormals.
enum class Sampling {
  kVisibleNormals,  // Heitz 2014 Eq. 16
  kNormals,         // D cos, Walter 2007 Eq. 24
};

// A surface with GGX or Beckmann normals. Each is one value or one per lane.
template <class T>
struct DielectricParameters {
  Parameter<T> alpha_x;  // 1e-5 to 100
  Parameter<T> alpha_y;  // 1e-5 to 100
  Parameter<T> eta;      // transmitted over incident index, 1/4 to 4
};
// A surface with Phong normals.
template <class T>
struct PhongDielectricParameters {
  Parameter<T> exponent;  // 0 to 2e10
  Parameter<T> eta;       // transmitted over incident index, 1/4 to 4
};
template <Normals kNormals, class T>
using DielectricParametersOf =
    std::conditional_t<kNormals == Normals::kPhong, PhongDielectricParameters<T>, DielectricParameters<T>>;

// What sampling gives. Lobe 0: no direction was found, and every output is 0.
template <class T>
struct DielectricSamples {
  MutableDirections<T> wo;
  T* weight;  // f |cos(theta_o)| / pdf in closed form
  T* pdf;     // density of wo, in 1/sr, with the choice of the lobe
  T* lobe;    // 0 none, 1 reflection, 2 transmission
};

// The calls over one distribution of normals in lanes of T.
template <Normals kNormals, class T>
class RoughDielectricLanes {
 public:
  using Surface = DielectricParametersOf<kNormals, T>;

  // Reflection and transmission. Walter 2007 Eqs. 19-21. eval, eval_separable.
  static void Eval(std::size_t n, const Directions<T>& wi, const Directions<T>& wo, const Surface& surface,
                   T* f_cos, Accuracy accuracy = Accuracy::kStandard,
                   Transport transport = Transport::kRadiance,
                   JointMasking masking = JointMasking::kHeightCorrelated);

  // Reflection alone; 0 for opposite sides. Walter 2007 Eq. 20. eval_reflection, eval_reflection_separable.
  static void EvalReflection(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                             const Surface& surface, T* f_cos, Accuracy accuracy = Accuracy::kStandard,
                             JointMasking masking = JointMasking::kHeightCorrelated);

  // Transmission alone; 0 for the same side. Walter 2007 Eq. 21. eval_transmission,
  // eval_transmission_separable.
  static void EvalTransmission(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                               const Surface& surface, T* f_cos, Accuracy accuracy = Accuracy::kStandard,
                               Transport transport = Transport::kRadiance,
                               JointMasking masking = JointMasking::kHeightCorrelated);

  // Density with which Sample finds wo: that of the normals, choice of the lobe by Fresnel. Walter 2007
  // section 5.3; Heitz 2014 Eq. 16, or Walter 2007 Eqs. 24, 38. pdf_visible, pdf.
  static void Pdf(std::size_t n, const Directions<T>& wi, const Directions<T>& wo, const Surface& surface,
                  T* pdf, Accuracy accuracy = Accuracy::kStandard,
                  Sampling sampling = Sampling::kVisibleNormals);

  // Density with which SampleReflection finds wo. Walter 2007 Eq. 14. pdf_visible_reflection, pdf_reflection.
  static void PdfReflection(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                            const Surface& surface, T* pdf, Accuracy accuracy = Accuracy::kStandard,
                            Sampling sampling = Sampling::kVisibleNormals);

  // Density with which SampleTransmission finds wo. Walter 2007 Eq. 17. pdf_visible_transmission,
  // pdf_transmission.
  static void PdfTransmission(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                              const Surface& surface, T* pdf, Accuracy accuracy = Accuracy::kStandard,
                              Sampling sampling = Sampling::kVisibleNormals);

  // Eval and Pdf in one call. eval_pdf_visible, eval_pdf, and these with _separable.
  static void EvalPdf(std::size_t n, const Directions<T>& wi, const Directions<T>& wo, const Surface& surface,
                      T* f_cos, T* pdf, Accuracy accuracy = Accuracy::kStandard,
                      Transport transport = Transport::kRadiance,
                      JointMasking masking = JointMasking::kHeightCorrelated,
                      Sampling sampling = Sampling::kVisibleNormals);

  // Directions wo from uniform numbers in [0, 1): u1 and u2 find a normal, u3 the lobe. With normals that are
  // visible from wi the weight is at most 1, for radiance. Walter 2007 section 5.3, Eqs. 37-41.
  // sample_visible, sample, and these with _separable.
  static void Sample(std::size_t n, const Directions<T>& wi, const T* u1, const T* u2, const T* u3,
                     const Surface& surface, const DielectricSamples<T>& samples,
                     Accuracy accuracy = Accuracy::kStandard, Transport transport = Transport::kRadiance,
                     JointMasking masking = JointMasking::kHeightCorrelated,
                     Sampling sampling = Sampling::kVisibleNormals);

  // As Sample with reflection at every normal. Walter 2007 Eqs. 37-39, 41. sample_visible_reflection,
  // sample_reflection, and these with _separable.
  static void SampleReflection(std::size_t n, const Directions<T>& wi, const T* u1, const T* u2,
                               const Surface& surface, const DielectricSamples<T>& samples,
                               Accuracy accuracy = Accuracy::kStandard,
                               JointMasking masking = JointMasking::kHeightCorrelated,
                               Sampling sampling = Sampling::kVisibleNormals);

  // As Sample with refraction at every normal; lobe 0 under total internal reflection. Walter 2007 Eqs. 37,
  // 38, 40, 41. sample_visible_transmission, sample_transmission, and these with _separable.
  static void SampleTransmission(std::size_t n, const Directions<T>& wi, const T* u1, const T* u2,
                                 const Surface& surface, const DielectricSamples<T>& samples,
                                 Accuracy accuracy = Accuracy::kStandard,
                                 Transport transport = Transport::kRadiance,
                                 JointMasking masking = JointMasking::kHeightCorrelated,
                                 Sampling sampling = Sampling::kVisibleNormals);
};

// The calls over one distribution of normals, in float and double: T is that of the outputs.
template <Normals kNormals>
class RoughDielectricCalls : RoughDielectricLanes<kNormals, float>, RoughDielectricLanes<kNormals, double> {
  using Float = RoughDielectricLanes<kNormals, float>;
  using Double = RoughDielectricLanes<kNormals, double>;

 public:
  using Double::Eval;
  using Double::EvalPdf;
  using Double::EvalReflection;
  using Double::EvalTransmission;
  using Double::Pdf;
  using Double::PdfReflection;
  using Double::PdfTransmission;
  using Double::Sample;
  using Double::SampleReflection;
  using Double::SampleTransmission;
  using Float::Eval;
  using Float::EvalPdf;
  using Float::EvalReflection;
  using Float::EvalTransmission;
  using Float::Pdf;
  using Float::PdfReflection;
  using Float::PdfTransmission;
  using Float::Sample;
  using Float::SampleReflection;
  using Float::SampleTransmission;
};

using rough_dielectric = RoughDielectricCalls<Normals::kGgx>;
using rough_dielectric_beckmann = RoughDielectricCalls<Normals::kBeckmann>;
using rough_dielectric_phong = RoughDielectricCalls<Normals::kPhong>;  // masking by Walter's recipe

}  // namespace microlane

#endif  // MICROLANE_ROUGH_DIELECTRIC_H_
