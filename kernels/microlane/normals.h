// The batch calls that distributions of normals have in common: density, Smith masking, sampling.
//
// All functions work on n lanes of float or double and are thread-safe. Errors are those that the kernel list
// declares for the id named with each function, <distribution>.<id> and the suffix of the roughness; NaN in
// gives NaN out in that lane. Each parameter is one value or one per lane.
#ifndef MICROLANE_NORMALS_H_
#define MICROLANE_NORMALS_H_

#include <cstddef>

#include "microlane/call.h"
#include "microlane/kernel_list.h"
#include "microlane/packets.h"

namespace microlane {

// The library's object of one distribution.
template <Normals kNormals>
struct NormalsCode {};
template <Normals kNormals, class T>
void RunFrom(const NormalsCode<kNormals>& code, std::size_t kernel, Accuracy accuracy, const Call<T>& call,
             std::size_t n);

// The calls for one kind of roughness in lanes of T; P: Parameter<T>, once for each of its parameters, or an
// object that calls take whole.
template <Normals kNormals, RoughnessKind kRoughness, class T, class... P>
class NormalLanes {
 public:
  // Density of normals m, in 1/sr; 0 where m.z <= 0. D.
  static void D(std::size_t n, const Directions<T>& m, const P&... p, T* d,
                Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kD>(CallBuilder<T>().In(m).Out(d), p..., accuracy, n);
  }

  // Smith's Lambda of v, the same on both sides of the surface: 0 along the normal, the largest finite number
  // where the exact value exceeds it (v.z = 0). Lambda.
  static void Lambda(std::size_t n, const Directions<T>& v, const P&... p, T* lambda,
                     Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kLambda>(CallBuilder<T>().In(v).Out(lambda), p..., accuracy, n);
  }

  // Masking of v for facets of normal m: 1/(1 + Lambda(v)), 0 where v.m and v.z differ in sign. G1.
  static void G1(std::size_t n, const Directions<T>& v, const Directions<T>& m, const P&... p, T* g1,
                 Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kG1>(CallBuilder<T>().In(v).In(m).Out(g1), p..., accuracy, n);
  }

  // Density of the normals m that are visible from v, in 1/sr: G1(v,m) |v.m| D(m) / |v.z|, formed so that it
  // stays finite at grazing. v of either side; below the surface it is that of -v, and v.z = 0 counts as
  // above. 0 where v.m and v.z differ in sign, and where m.z <= 0. Heitz 2014 Eq. 16. D_visible.
  static void DVisible(std::size_t n, const Directions<T>& v, const Directions<T>& m, const P&... p, T* d,
                       Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kDVisible>(CallBuilder<T>().In(v).In(m).Out(d), p..., accuracy, n);
  }

  // Normals m with density pdf = D(m) m.z, in 1/sr, from uniform numbers in [0, 1). sample_normal.
  static void SampleNormal(std::size_t n, const T* u1, const T* u2, const P&... p, MutableDirections<T> m,
                           T* pdf, Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kSampleNormal>(CallBuilder<T>().In(u1).In(u2).Out(m).Out(pdf), p..., accuracy, n);
  }

  // Normals m with density pdf = DVisible(v, m), in 1/sr, from uniform numbers in [0, 1): of GGX, u1 is the
  // height on the spherical cap and u2 its azimuth (Dupuy and Benyoub 2023); of Beckmann and of
  // tables, u1 is the share of visible normals that slope more towards v and u2 that of those that slope less
  // across it. m.z > 0
  // whatever the side of v. With them, the weight of a reflection is F G2/G1, never above 1.
  // sample_visible_normal.
  static void SampleVisibleNormal(std::size_t n, const Directions<T>& v, const T* u1, const T* u2,
                                  const P&... p, MutableDirections<T> m, T* pdf,
                                  Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kSampleVisible>(CallBuilder<T>().In(v).In(u1).In(u2).Out(m).Out(pdf), p..., accuracy,
                                        n);
  }

  // The same for reflection: normals are drawn from a smaller cap, which leaves out many that reflect v below
  // the surface and none that do not. pdf is that of m, DVisible(v, m) (|v.z| + r)/(k |v.z| + r) with r =
  // |(alpha_x v.x, alpha_y v.y, v.z)| and k of the kernel list; over 4 |v.m| it is that of the reflected
  // direction. Eto and Tokuyoshi 2023. sample_visible_normal_bounded.
  static void SampleVisibleNormalBounded(std::size_t n, const Directions<T>& v, const T* u1, const T* u2,
                                         const P&... p, MutableDirections<T> m, T* pdf,
                                         Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kSampleVisibleBounded>(CallBuilder<T>().In(v).In(u1).In(u2).Out(m).Out(pdf), p...,
                                               accuracy, n);
  }

  // Density of the normals m that V-cavities show to v, in 1/sr: min(|v.m|/|v.z|, 2 m.z) D(m), of masking.h's
  // VCavity in place of Smith's; sides as for DVisible. Heitz 2014 Eqs. 16, 49. D_visible_v_cavity.
  static void DVisibleVCavity(std::size_t n, const Directions<T>& v, const Directions<T>& m, const P&... p,
                              T* d, Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kDVisibleVCavity>(CallBuilder<T>().In(v).In(m).Out(d), p..., accuracy, n);
  }

  // Normals m with density pdf = DVisibleVCavity(v, m), in 1/sr, from uniform numbers in [0, 1):
  // SampleNormal's of u1 and u2, or the other facet of its V-cavity as u3 chooses. m.z > 0 whatever the side
  // of v. Heitz and d'Eon 2014. sample_visible_normal_v_cavity.
  static void SampleVisibleNormalVCavity(std::size_t n, const Directions<T>& v, const T* u1, const T* u2,
                                         const T* u3, const P&... p, MutableDirections<T> m, T* pdf,
                                         Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kSampleVCavity>(CallBuilder<T>().In(v).In(u1).In(u2).In(u3).Out(m).Out(pdf), p...,
                                        accuracy, n);
  }

  // Directions wo that the ideal mirror (F = 1) reflects wi into, about visible normals of
  // SampleVisibleNormal: weight = f |cos(theta_o)| / pdf = G2/G1 with height-correlated masking (Heitz 2014
  // Eq. 99), never above 1; pdf is that of wo, in 1/sr. Another Fresnel multiplies the weight. lobe is 1; it
  // is 0, and with it every output, where wo is not on wi's side. sample_visible_reflection.
  static void SampleVisibleReflection(std::size_t n, const Directions<T>& wi, const T* u1, const T* u2,
                                      const P&... p, MutableDirections<T> wo, T* weight, T* pdf, T* lobe,
                                      Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kSampleReflection>(
        CallBuilder<T>().In(wi).In(u1).In(u2).Out(wo).Out(weight).Out(pdf).Out(lobe), p..., accuracy, n);
  }

  // The same about normals of SampleVisibleNormalBounded, which loses fewer samples.
  // sample_visible_reflection_bounded.
  static void SampleVisibleReflectionBounded(std::size_t n, const Directions<T>& wi, const T* u1, const T* u2,
                                             const P&... p, MutableDirections<T> wo, T* weight, T* pdf,
                                             T* lobe, Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kSampleReflectionBounded>(
        CallBuilder<T>().In(wi).In(u1).In(u2).Out(wo).Out(weight).Out(pdf).Out(lobe), p..., accuracy, n);
  }

  // Densities with which SampleVisibleReflection, and SampleVisibleReflectionBounded, find wo, in 1/sr; 0
  // where wi or wo lies in the surface, and for opposite sides. pdf_visible_reflection,
  // pdf_visible_reflection_bounded.
  static void PdfVisibleReflection(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                                   const P&... p, T* pdf, Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kPdfReflection>(CallBuilder<T>().In(wi).In(wo).Out(pdf), p..., accuracy, n);
  }
  static void PdfVisibleReflectionBounded(std::size_t n, const Directions<T>& wi, const Directions<T>& wo,
                                          const P&... p, T* pdf, Accuracy accuracy = Accuracy::kStandard) {
    Run<NormalQuantity::kPdfReflectionBounded>(CallBuilder<T>().In(wi).In(wo).Out(pdf), p..., accuracy, n);
  }

 private:
  template <NormalQuantity::What kWhat>
  static void Run(CallBuilder<T>& call, const P&... p, Accuracy accuracy, std::size_t n) {
    (call.In(p), ...);
    call.template Run<NormalKernel(kNormals, kWhat, kRoughness)>(NormalsCode<kNormals>(), accuracy, n);
  }
};

// The calls of all Lanes by overloading: T is that of the outputs, the roughness that of the parameters.
template <class... Lanes>
class NormalCalls : Lanes... {
 public:
  using Lanes::D...;
  using Lanes::DVisible...;
  using Lanes::DVisibleVCavity...;
  using Lanes::G1...;
  using Lanes::Lambda...;
  using Lanes::PdfVisibleReflection...;
  using Lanes::PdfVisibleReflectionBounded...;
  using Lanes::SampleNormal...;
  using Lanes::SampleVisibleNormal...;
  using Lanes::SampleVisibleNormalBounded...;
  using Lanes::SampleVisibleNormalVCavity...;
  using Lanes::SampleVisibleReflection...;
  using Lanes::SampleVisibleReflectionBounded...;
};

// Own: the parameters of the distribution's shape.
template <Normals kNormals, class T, class... Own>
using IsotropicLanes = NormalLanes<kNormals, RoughnessKind::kIsotropic, T, Own..., Parameter<T>>;
template <Normals kNormals, class T, class... Own>
using AnisotropicLanes =
    NormalLanes<kNormals, RoughnessKind::kAnisotropic, T, Own..., Parameter<T>, Parameter<T>>;

template <Normals kNormals, class T, class... Own>
using RotatedLanes =
    NormalLanes<kNormals, RoughnessKind::kRotated, T, Own..., Parameter<T>, Parameter<T>, Parameter<T>>;
template <Normals kNormals, class T, class... Own>
using OffCentreLanes = NormalLanes<kNormals, RoughnessKind::kOffCentre, T, Own..., Parameter<T>, Parameter<T>,
                                   Parameter<T>, Parameter<T>, Parameter<T>>;

// A distribution of slopes of one shape (Heitz 2014 section 5). Its parameters are Own<T>..., those of the
// shape or its table, and then one of
//   alpha                                    isotropic, _isotropic
//   alpha_x, alpha_y                         anisotropic, from 1e-5 to 100
//   alpha_x, alpha_y, r_xy                   rotated: slopes correlate by r_xy, within 0.9999; Eqs. 88-93
//   alpha_x, alpha_y, r_xy, mean_x, mean_y   off-centre: mean slopes, within 16; Eqs. 94-97
// Off-centre, v.z - mean_x v.x - mean_y v.y, the projected area of the mesosurface, stands for v.z, and its
// sign for the side of the surface.
template <Normals kNormals, template <class> class... Own>
using ShapeInvariantCalls = NormalCalls<
    IsotropicLanes<kNormals, float, Own<float>...>, IsotropicLanes<kNormals, double, Own<double>...>,
    AnisotropicLanes<kNormals, float, Own<float>...>, AnisotropicLanes<kNormals, double, Own<double>...>,
    RotatedLanes<kNormals, float, Own<float>...>, RotatedLanes<kNormals, double, Own<double>...>,
    OffCentreLanes<kNormals, float, Own<float>...>, OffCentreLanes<kNormals, double, Own<double>...>>;

}  // namespace microlane

#endif  // MICROLANE_NORMALS_H_
