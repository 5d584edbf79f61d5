// Any entry of the kernel list by its index.
#ifndef MICROLANE_SCALAR_EVALUATE_H_
#define MICROLANE_SCALAR_EVALUATE_H_

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>

#include "microlane/kernel_list.h"
#include "microlane/prepared.h"
#include "microlane/radial_table.h"
#include "microlane/scalar/albedo.h"
#include "microlane/scalar/beckmann.h"
#include "microlane/scalar/coupled.h"
#include "microlane/scalar/direction.h"
#include "microlane/scalar/fresnel.h"
#include "microlane/scalar/gaussian.h"
#include "microlane/scalar/ggx.h"
#include "microlane/scalar/half_vector.h"
#include "microlane/scalar/masking.h"
#include "microlane/scalar/math.h"
#include "microlane/scalar/mean_fresnel.h"
#include "microlane/scalar/phong.h"
#include "microlane/scalar/rough_dielectric.h"
#include "microlane/scalar/rough_diffuse.h"
#include "microlane/scalar/rough_reflector.h"
#include "microlane/scalar/roughness.h"
#include "microlane/scalar/sheared.h"
#include "microlane/scalar/student.h"
#include "microlane/scalar/student_t.h"
#include "microlane/scalar/tabulated.h"

namespace microlane::scalar {

// inputs and outputs in the order of the list.
template <class Real>
using Function = void (*)(const Real* inputs, Real* outputs, Transport transport);

namespace evaluate_internal {

template <class Real>
Vec3<Real> Load(const Real* in) {
  return {in[0], in[1], in[2]};
}
template <class Real>
void Store(const Vec3<Real>& v, Real* out) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}
template <class Real>
void Store(const SampledNormal<double>& normal, Real* out) {
  Store(Narrow<Real>(normal.m), out);
  out[3] = Saturate<Real>(normal.pdf);
}

template <RoughnessKind kRoughness, template <class> class Distribution, class Real, class... Own>
auto MakeRough(const Real* in, Own... own) {
  using Rough = Sheared<Distribution, Real, Own...>;
  if constexpr (kRoughness == RoughnessKind::kIsotropic) {
    return Distribution<Real>{own..., in[0], in[0]};
  } else if constexpr (kRoughness == RoughnessKind::kAnisotropic) {
    return Distribution<Real>{own..., in[0], in[1]};
  } else if constexpr (kRoughness == RoughnessKind::kRotated) {
    return Rough{{own...}, in[0], in[1], in[2]};
  } else {
    return Rough{{own...}, in[0], in[1], in[2], in[3], in[4]};
  }
}

// A distribution from its parameters, as they follow the other inputs.
template <Normals kNormals, RoughnessKind kRoughness, class Real>
auto MakeNormals(const Real* in) {
  if constexpr (kNormals == Normals::kPhong) return Phong<Real>{in[0]};
  if constexpr (kNormals == Normals::kBeckmann) return MakeRough<kRoughness, Beckmann>(in);
  if constexpr (kNormals == Normals::kGgx) return MakeRough<kRoughness, Ggx>(in);
  if constexpr (kNormals == Normals::kStudentT) return MakeRough<kRoughness, StudentT>(in + 1, in[0]);
}

// The roughness that the models take.
constexpr RoughnessKind ModelRoughness(Normals normals) {
  return normals == Normals::kPhong ? RoughnessKind::kExponent : RoughnessKind::kAnisotropic;
}

// The object that a kernel takes, from the inputs behind the list's second bar; null where they make none.
template <std::size_t kKernel, class Object, class Real>
std::shared_ptr<const Object> PreparedOf(const Real* in) {
  constexpr Names names = Split(kKernels[kKernel].inputs);
  double values[kMaxInputs] = {};
  for (std::size_t k = names.columns; k < names.count; ++k) {
    values[k - names.columns] = static_cast<double>(in[k]);
  }
  auto object = std::static_pointer_cast<const Object>(Prepare(kKernel, values));
  return object->ok() ? object : nullptr;
}

// A quantity of a distribution by its place in kNormalKernelPlaces.
template <std::size_t kPlace, class Distribution, class Real>
void RunNormals(const Distribution& normals, const Real* in, Real* out) {
  constexpr NormalRow row = kNormalRows[kNormalKernelPlaces[kPlace].row];
  if constexpr (row.what == NormalQuantity::kD) {
    out[0] = normals.D(Load(in));
  } else if constexpr (row.what == NormalQuantity::kLambda) {
    out[0] = Lambda(normals, Load(in));
  } else if constexpr (row.what == NormalQuantity::kG1) {
    out[0] = G1(normals, Load(in), Load(in + 3));
  } else if constexpr (row.what == NormalQuantity::kDVisible) {
    out[0] = DVisible(normals, Load(in), Load(in + 3));
  } else if constexpr (row.what == NormalQuantity::kDVisibleVCavity) {
    out[0] = DVisibleVCavity(normals, Load(in), Load(in + 3));
  } else if constexpr (row.what == NormalQuantity::kSampleVCavity) {
    Store(SampleVCavity(normals, Load(in), in[3], in[4], in[5]), out);
  } else if constexpr (row.what == NormalQuantity::kSampleNormal) {
    Store(normals.SampleNormal(in[0], in[1]), out);
  } else if constexpr (row.what == NormalQuantity::kSampleReflection ||
                       row.what == NormalQuantity::kSampleReflectionBounded) {
    constexpr bool bounded = row.what == NormalQuantity::kSampleReflectionBounded;
    const SampledReflection sample = SampleVisibleReflection(normals, Load(in), in[3], in[4], bounded);
    Store(Narrow<Real>(sample.wo), out);
    out[3] = static_cast<Real>(sample.weight);
    out[4] = Saturate<Real>(sample.pdf);
    out[5] = static_cast<Real>(sample.lobe);
  } else if constexpr (row.what == NormalQuantity::kPdfReflection ||
                       row.what == NormalQuantity::kPdfReflectionBounded) {
    out[0] = PdfVisibleReflection(normals, Load(in), Load(in + 3),
                                  row.what == NormalQuantity::kPdfReflectionBounded);
  } else {
    constexpr bool bounded = row.what == NormalQuantity::kSampleVisibleBounded;
    Store(normals.SampleVisibleNormal(Load(in), in[3], in[4], bounded), out);
  }
}
template <class Real, std::size_t kPlace>
void RunNormals(const Real* in, Real* out, Transport) {
  constexpr NormalKernelPlace place = kNormalKernelPlaces[kPlace];
  constexpr std::size_t kernel = kNumComponentKernels + kPlace,
                        lanes = Split(kKernels[kernel].inputs).per_lane;
  if constexpr (kNormalRows[place.row].normals == Normals::kTabulated) {
    const auto table = PreparedOf<kernel, RadialTable>(in);
    if (table == nullptr) {
      std::fill_n(out, Split(kKernels[kernel].outputs).count, kNan<Real>);
      return;
    }
    RunNormals<kPlace>(MakeRough<place.roughness, Tabulated>(in + lanes, &table->entries()), in, out);
  } else {
    RunNormals<kPlace>(MakeNormals<kNormalRows[place.row].normals, place.roughness>(in + lanes), in, out);
  }
}

template <class Real>
void Store(const DirectionSample<Real>& sample, Real* out) {
  Store(sample.wo, out);
  out[3] = sample.weight;
  out[4] = sample.pdf;
  out[5] = IsNan(sample.weight) ? sample.weight : static_cast<Real>(static_cast<unsigned>(sample.lobe));
}

template <Masking masking, template <class> class Distribution, class Real>
RoughDielectric<Distribution, Real, masking> MakeDielectric(const Distribution<Real>& distribution, Real eta,
                                                            Transport transport) {
  return {distribution, eta, transport};
}

constexpr Masking MaskingOf(const DielectricQuantity& row) {
  return row.joint == DielectricQuantity::kVCavity     ? Masking::kVCavity
         : row.joint == DielectricQuantity::kKelemen   ? Masking::kKelemen
         : row.joint == DielectricQuantity::kSeparable ? Masking::kSeparable
                                                       : Masking::kHeightCorrelated;
}

// The rough dielectric by its place in kDielectricQuantities.
template <class Real, Normals kNormals, std::size_t kQuantity>
struct Dielectric {
  static constexpr DielectricQuantity kRow = kDielectricQuantities[kQuantity];
  static constexpr Lobes kLobes =
      static_cast<Lobes>((kRow.reflects ? kReflection : 0U) | (kRow.transmits ? kTransmission : 0U));

  static void Run(const Real* in, Real* out, Transport transport) {
    constexpr Masking masking = MaskingOf(kRow);
    constexpr bool one_lobe_sampled = kRow.what == DielectricQuantity::kSample && !kRow.HasBothLobes();
    const Real* const parameters = in + (one_lobe_sampled ? 5 : 6);
    constexpr RoughnessKind roughness = ModelRoughness(kNormals);
    constexpr std::size_t eta = Split(kModelFamilies[static_cast<std::size_t>(kNormals)].parameters).count;
    const auto dielectric =
        MakeDielectric<masking>(MakeNormals<kNormals, roughness>(parameters), parameters[eta], transport);
    if constexpr (kRow.what == DielectricQuantity::kEval) {
      out[0] = dielectric.Eval(Load(in), Load(in + 3), kLobes);
    } else if constexpr (kRow.what == DielectricQuantity::kPdf) {
      out[0] = dielectric.template Pdf<kRow.visible>(Load(in), Load(in + 3), kLobes);
    } else if constexpr (kRow.what == DielectricQuantity::kEvalPdf) {
      const auto value = dielectric.template EvalAndPdf<kRow.visible>(Load(in), Load(in + 3));
      out[0] = value.f_cos;
      out[1] = value.pdf;
    } else {
      Store(dielectric.template Sample<kRow.visible>(Load(in), in[3], in[4], one_lobe_sampled ? 0 : in[5],
                                                     kLobes),
            out);
    }
  }
};

template <Masking masking, template <class> class Distribution, template <class> class Facets, class Real>
RoughReflector<Distribution, Facets, Real, masking> MakeReflector(const Distribution<Real>& distribution,
                                                                  const Facets<Real>& facets) {
  return {distribution, facets};
}

// An opaque surface's facets from their parameters.
template <Reflector kReflector, class Real>
auto MakeFacets(const Real* in) {
  if constexpr (kReflector == Reflector::kMirror) {
    return MirrorFacets<Real>{};
  } else if constexpr (kReflector == Reflector::kConductor) {
    return ConductorFacets<Real>{in[0], in[1]};
  } else {
    return SchlickFacets<Real>{in[0]};
  }
}

// A kernel of an opaque surface.
template <class Real, std::size_t kKernel>
void RunReflector(const Real* in, Real* out, Transport) {
  constexpr ReflectorKernelPlace place = PlaceOfReflectorKernel(kKernel);
  constexpr DielectricQuantity row = kReflectorQuantities[place.quantity];
  constexpr Masking masking = MaskingOf(row);
  constexpr bool v_cavity = masking == Masking::kVCavity;
  constexpr RoughnessKind roughness = ModelRoughness(place.normals);
  constexpr std::size_t count =
      Split(kModelFamilies[static_cast<std::size_t>(place.normals)].parameters).count;
  const Real* const parameters = in + Split(kKernels[kKernel].inputs).per_lane;
  const auto surface = MakeReflector<masking>(MakeNormals<place.normals, roughness>(parameters),
                                              MakeFacets<place.reflector>(parameters + count));
  if constexpr (row.what == DielectricQuantity::kEval) {
    out[0] = surface.Eval(Load(in), Load(in + 3));
  } else if constexpr (row.what == DielectricQuantity::kEvalPdf) {
    const auto value = [&] {
      if constexpr (v_cavity) return surface.EvalAndPdfVCavity(Load(in), Load(in + 3));
      if constexpr (row.visible) return surface.EvalAndPdfVisible(Load(in), Load(in + 3));
      if constexpr (!row.visible && !v_cavity) return surface.EvalAndPdf(Load(in), Load(in + 3));
    }();
    out[0] = value.f_cos;
    out[1] = value.pdf;
  } else if constexpr (v_cavity) {
    Store(surface.SampleVCavity(Load(in), in[3], in[4], in[5]), out);
  } else if constexpr (row.visible) {
    Store(surface.SampleVisible(Load(in), in[3], in[4]), out);
  } else {
    Store(surface.Sample(Load(in), in[3], in[4]), out);
  }
}

template <Masking masking, template <class> class Distribution, class Real, class Facet>
RoughDiffuse<Distribution, Real, masking, Facet> MakeDiffuse(const Distribution<Real>& distribution,
                                                             const Facet& facet, int order) {
  return {distribution, facet, order};
}

template <Scatterer kScatterer, class Real>
auto MakeFacet(const Real* in) {
  if constexpr (kScatterer == Scatterer::kInterfaced) {
    return InterfacedFacet<Real>{in[0], in[1]};
  } else {
    (void)in;
    return LambertianFacet<Real>{};
  }
}

// A whole number of those that rules have.
template <class Real>
bool IsOrder(Real order) {
  constexpr Input range = FindInput("order");
  return order >= Real(range.low) && order <= Real(range.high) && order == std::floor(order);
}

// A kernel of facets that scatter. NaN where the order is none.
template <class Real, std::size_t kKernel>
void RunDiffuse(const Real* in, Real* out, Transport) {
  constexpr DiffuseKernelPlace place = PlaceOfDiffuseKernel(kKernel);
  constexpr Names inputs = Split(kKernels[kKernel].inputs);
  constexpr DielectricQuantity row = kDiffuseQuantities[place.quantity];
  constexpr Masking masking = MaskingOf(row);
  const auto normals = MakeNormals<place.normals, ModelRoughness(place.normals)>(in + inputs.per_lane);
  const auto facet = MakeFacet<place.scatterer>(in + inputs.per_lane + 2);
  const Vec3<Real> wi = Load(in), wo = Load(in + 3);
  if constexpr (row.what == DielectricQuantity::kSample) {
    const Real u[5] = {in[3], in[4], in[5], in[6], in[7]};
    Store(SampleWithInterface<masking>(normals, facet, wi, u), out);
  } else if constexpr (row.what == DielectricQuantity::kPdf) {
    out[0] = PdfWithInterface(normals, facet, wi, wo);
  } else if constexpr (row.what == DielectricQuantity::kEvalNormal) {
    out[0] = OneNormal<masking, row.visible>(normals, facet, wi, wo, Load(in + 6));
  } else {
    const Real order = in[inputs.columns];
    out[0] = IsOrder(order) ? MakeDiffuse<masking>(normals, facet, static_cast<int>(order)).Eval(wi, wo)
                            : kNan<Real>;
  }
}

// A mean over visible normals. NaN where the order is none.
template <class Real, std::size_t kKernel>
void RunMeanFresnel(const Real* in, Real* out, Transport) {
  constexpr ModelKernelPlace place = PlaceOfMeanFresnelKernel(kKernel);
  if constexpr (place.quantity == MeanFresnelQuantity::kCosine) {
    out[0] =
        MeanFresnelCosine(in[0], in[1], place.normals == Normals::kGgx ? kGgxCosineFit : kBeckmannCosineFit);
  } else {
    constexpr Names inputs = Split(kKernels[kKernel].inputs);
    const Real order = in[inputs.columns];
    const Real* const facets = in + 5;
    if (!IsOrder(order) || std::isnan(facets[0]) || std::isnan(facets[1])) {
      out[0] = kNan<Real>;
      return;
    }
    const auto normals = MakeNormals<place.normals, ModelRoughness(place.normals)>(in + inputs.per_lane);
    const auto mean = [&](const auto& reflectance) {
      return MeanFresnel<Real>(normals, Load(in), static_cast<int>(order), reflectance);
    };
    if constexpr (place.quantity == MeanFresnelQuantity::kDielectric) {
      out[0] = mean([&](auto cos2) { return FresnelDielectric<Real>(cos2, facets[0]).Reflectance(); });
    } else if constexpr (place.quantity == MeanFresnelQuantity::kConductor) {
      out[0] = mean([&](auto cos2) { return ConductorFacets<Real>{facets[0], facets[1]}.Reflectance(cos2); });
    } else {
      out[0] = mean([&](auto cos2) { return SchlickFacets<Real>{facets[0]}.Reflectance(cos2); });
    }
  }
}

// Kelemen 2001 Eqs. 4, 5: P_H = D cos.
template <class Distribution, class Real>
Real HalfVectorDensity(const Distribution& distribution, const Vec3<Real>& m) {
  return Saturate<Real>(distribution.DTimes(m, m.z));
}

template <class Real>
void RunDirectionalAlbedo(const Real* in, Real* out, Transport) {
  const auto table = PreparedOf<KernelIndex("albedo.directional"), AlbedoTable>(in);
  if (IsNan(in[0]) || table == nullptr) {
    out[0] = out[1] = kNan<Real>;
    return;
  }
  const AlbedoEntries& entries = table->entries();
  const AlbedoCell cell = FindCell(entries, static_cast<double>(in[0]));
  out[0] = static_cast<Real>(Interpolate(entries.albedo, cell));
  out[1] = static_cast<Real>(Interpolate(entries.deficit, cell));
}

// A kernel of the coupled model.
template <class Real, std::size_t kKernel>
void RunCoupled(const Real* in, Real* out, Transport) {
  constexpr Names names = Split(kKernels[kKernel].inputs), outputs = Split(kKernels[kKernel].outputs);
  const auto table = PreparedOf<kKernel, AlbedoTable>(in);
  if (table == nullptr) {
    for (std::size_t i = 0; i < outputs.count; ++i) out[i] = kNan<Real>;
    return;
  }
  const Coupled<Real> model{*table, in[names.per_lane]};
  if constexpr (names.name[3] == "u1") {
    Store(model.Sample(Load(in), in[3], in[4], in[5]), out);
  } else {
    const EvalPdf<Real> value = model.EvalAndPdf(Load(in), Load(in + 3));
    for (std::size_t i = 0; i < outputs.count; ++i)
      out[i] = outputs.name[i] == "pdf" ? value.pdf : value.f_cos;
  }
}

template <class Real>
struct Entry {
  std::string_view id;
  Function<Real> function;
};

template <class Real>
constexpr auto Entries() {
  using Fresnel = FresnelDielectric<Real>;
  return std::array{
      Entry<Real>{"math.exp", [](const Real* in, Real* out, Transport) { out[0] = Exp(in[0]); }},
      Entry<Real>{"math.neg_log1m", [](const Real* in, Real* out, Transport) { out[0] = NegLog1m(in[0]); }},
      Entry<Real>{"math.sincos_2pi",
                  [](const Real* in, Real* out, Transport) {
                    const SinCos<Real> value = SinCos2Pi(in[0]);
                    out[0] = value.sin;
                    out[1] = value.cos;
                  }},
      Entry<Real>{"math.erfcx_defect",
                  [](const Real* in, Real* out, Transport) { out[0] = ErfcxDefect(in[0]); }},

      Entry<Real>{"math.erfcx",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = IsNan(in[0]) ? in[0] : static_cast<Real>(Erfcx(in[0]));
                  }},
      Entry<Real>{"math.erfinv",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = IsNan(in[0]) ? in[0] : static_cast<Real>(ErfInv(in[0]));
                  }},

      Entry<Real>{"math.azimuth_difference",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = AnyNan(in[0], in[1], in[2], in[3])
                                 ? kNan<Real>
                                 : static_cast<Real>(AzimuthDifference(in[0], in[1], in[2], in[3]));
                  }},
      Entry<Real>{"math.student_defect",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = AnyNan(in[0], in[1])
                                 ? kNan<Real>
                                 : static_cast<Real>(StudentDefect(std::abs(in[0]), in[1] - 1.5));
                  }},

      Entry<Real>{"beckmann.G1_rational",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = Beckmann<Real>{in[6], in[7]}.G1Rational(Load(in), Load(in + 3));
                  }},
      Entry<Real>{"beckmann.sample_normal_widened",
                  [](const Real* in, Real* out, Transport) {
                    Store(Beckmann<Real>{in[3], in[4]}.Widened(in[2]).SampleNormal(in[0], in[1]), out);
                  }},

      Entry<Real>{"phong.exponent",
                  [](const Real* in, Real* out, Transport) { out[0] = PhongExponent(in[0]); }},
      Entry<Real>{"phong.Lambda", [](const Real* in, Real* out,
                                     Transport) { out[0] = Lambda(PhongSmith<Real>{in[3]}, Load(in)); }},
      Entry<Real>{"phong.G1_smith",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = G1(PhongSmith<Real>{in[6]}, Load(in), Load(in + 3));
                  }},

      Entry<Real>{"gaussian.C",
                  [](const Real* in, Real* out, Transport) {
                    const Gaussian<Real> gaussian{in[0]};
                    out[0] = IsNan(gaussian) ? kNan<Real> : static_cast<Real>(gaussian.Normalisation());
                  }},
      Entry<Real>{"gaussian.D",
                  [](const Real* in, Real* out, Transport) { out[0] = Gaussian<Real>{in[3]}.D(Load(in)); }},
      Entry<Real>{"gaussian.D_visible_v_cavity",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = DVisibleVCavity(Gaussian<Real>{in[6]}, Load(in), Load(in + 3));
                  }},
      Entry<Real>{"gaussian.eval_v_cavity",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = Gaussian<Real>{in[6]}.EvalVCavity(Load(in), Load(in + 3));
                  }},
      Entry<Real>{"gaussian.sample_normal",
                  [](const Real* in, Real* out, Transport) {
                    Store(Gaussian<Real>{in[2]}.SampleNormal(in[0], in[1]), out);
                  }},

      Entry<Real>{"fresnel.dielectric",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = OfCosine(in[0], in[1], &Fresnel::Reflectance);
                  }},
      Entry<Real>{"fresnel.dielectric_transmittance",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = OfCosine(in[0], in[1], &Fresnel::Transmittance);
                  }},
      Entry<Real>{"fresnel.dielectric_s",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = OfCosine(in[0], in[1], &Fresnel::ReflectanceS);
                  }},
      Entry<Real>{"fresnel.dielectric_p",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = OfCosine(in[0], in[1], &Fresnel::ReflectanceP);
                  }},

      Entry<Real>{"fresnel.conductor", [](const Real* in, Real* out,
                                          Transport) { out[0] = ConductorOfCosine(in[0], in[1], in[2]); }},
      Entry<Real>{"fresnel.diffuse_external",
                  [](const Real* in, Real* out, Transport) { out[0] = DiffuseExternal(in[0]); }},
      Entry<Real>{"fresnel.diffuse_internal",
                  [](const Real* in, Real* out, Transport) { out[0] = DiffuseInternal(in[0]); }},
      Entry<Real>{"interfaced.facet_body", [](const Real* in, Real* out,
                                              Transport) { out[0] = FacetBody(in[0], in[1], in[2], in[3]); }},
      Entry<Real>{"fresnel.schlick",
                  [](const Real* in, Real* out, Transport) { out[0] = SchlickOfCosine(in[0], in[1]); }},

      Entry<Real>{"half_vector_density.ward",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = HalfVectorDensity(Beckmann<Real>{in[3], in[3]}, Load(in));
                  }},
      Entry<Real>{"half_vector_density.phong",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = HalfVectorDensity(Phong<Real>{in[3]}, Load(in));
                  }},

      Entry<Real>{"coupled.eval", RunCoupled<Real, KernelIndex("coupled.eval")>},
      Entry<Real>{"coupled.pdf", RunCoupled<Real, KernelIndex("coupled.pdf")>},
      Entry<Real>{"coupled.eval_pdf", RunCoupled<Real, KernelIndex("coupled.eval_pdf")>},
      Entry<Real>{"coupled.sample", RunCoupled<Real, KernelIndex("coupled.sample")>},
      Entry<Real>{"albedo.directional", RunDirectionalAlbedo<Real>},

      Entry<Real>{"half_vector.reflection",
                  [](const Real* in, Real* out, Transport) {
                    Store(Normalized<Real>(ReflectionHalf(Load(in), Load(in + 3))), out);
                  }},
      Entry<Real>{
          "half_vector.reflection_jacobian",
          [](const Real* in, Real* out, Transport) { out[0] = ReflectionJacobian(Load(in), Load(in + 3)); }},
      Entry<Real>{"half_vector.reflection_jacobian_cos",
                  [](const Real* in, Real* out, Transport) { out[0] = ReflectionJacobianCos(in[0]); }},
      Entry<Real>{"half_vector.refraction",
                  [](const Real* in, Real* out, Transport) {
                    Store(Normalized<Real>(RefractionHalf(Load(in), Load(in + 3), in[6])), out);
                  }},
      Entry<Real>{"half_vector.refraction_jacobian",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = RefractionJacobian(Load(in), Load(in + 3), in[6]);
                  }},
      Entry<Real>{
          "half_vector.refraction_jacobian_cos",
          [](const Real* in, Real* out, Transport) { out[0] = RefractionJacobianCos(in[0], in[1], in[2]); }},

      Entry<Real>{"reflect",
                  [](const Real* in, Real* out, Transport) {
                    Store(Narrow<Real>(Reflect(Widen(Load(in)), Widen(Load(in + 3)))), out);
                  }},
      Entry<Real>{"refract",
                  [](const Real* in, Real* out, Transport) {
                    using W = Wide<Real>;
                    const Vec3<Real> wi = Load(in);
                    Store(Narrow<Real>(Refract(Widen(wi), Widen(Load(in + 3)), W(in[6]), W(Side(wi)))), out);
                  }},

      Entry<Real>{
          "roughness.from_moments",
          [](const Real* in, Real* out, Transport) {
            const Correlation<Real> c = FromMoments(in[0], in[1], SlopeMoments<Real>{in[2], in[3], in[4]});
            out[0] = c.alpha_x;
            out[1] = c.alpha_y;
            out[2] = c.r_xy;
          }},
      Entry<Real>{
          "roughness.to_moments",
          [](const Real* in, Real* out, Transport) {
            const SlopeMoments<Real> m = ToMoments(Correlation<Real>{in[0], in[1], in[2]}, in[3], in[4]);
            out[0] = m.xx;
            out[1] = m.yy;
            out[2] = m.xy;
          }},

      Entry<Real>{"masking.v_cavity",
                  [](const Real* in, Real* out, Transport) { out[0] = VCavityG1(Load(in), Load(in + 3)); }},
      Entry<Real>{"masking.implicit",
                  [](const Real* in, Real* out, Transport) { out[0] = ImplicitG1(Load(in), Load(in + 3)); }},
      Entry<Real>{"masking.schlick_smith",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = SchlickSmithG1(Load(in), Load(in + 3), in[6]);
                  }},
      Entry<Real>{"masking.kelemen",
                  [](const Real* in, Real* out, Transport) { out[0] = KelemenG1(Load(in), Load(in + 3)); }},
      Entry<Real>{"masking.separable",
                  [](const Real* in, Real* out, Transport) { out[0] = SeparableG2(in[0], in[1]); }},
      Entry<Real>{"masking.height_correlated",
                  [](const Real* in, Real* out, Transport) { out[0] = HeightCorrelatedG2(in[0], in[1]); }},
      Entry<Real>{"masking.height_correlated_transmission",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = HeightCorrelatedTransmissionG2(in[0], in[1]);
                  }},
      Entry<Real>{"masking.student_lambda",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = Lambda(StudentT<Real>{in[5], in[3], in[4]}, Load(in));
                  }},
      Entry<Real>{"masking.direction_correlated",
                  [](const Real* in, Real* out, Transport) {
                    out[0] =
                        DirectionCorrelatedG2(in[0], in[1], AzimuthDifference(in[2], in[3], in[4], in[5]));
                  }},
      Entry<Real>{"masking.height_direction_correlated",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = HeightDirectionCorrelatedG2(in[0], in[1],
                                                         AzimuthDifference(in[2], in[3], in[4], in[5]));
                  }},
  };
}

template <class Real, std::size_t... kPlace>
constexpr void AddNormals(KernelTable<Function<Real>>& table, std::index_sequence<kPlace...>) {
  const auto add = [&](auto place) {
    constexpr std::size_t kThis = decltype(place)::value;
    if constexpr (kNormalRows[kNormalKernelPlaces[kThis].row].what != NormalQuantity::kOwn) {
      table[kNumComponentKernels + kThis] = {RunNormals<Real, kThis>, true};
    }
  };
  (add(std::integral_constant<std::size_t, kPlace>()), ...);
}

template <Normals kNormals, class Real, std::size_t... kQuantity>
constexpr void AddDielectrics(KernelTable<Function<Real>>& table, std::index_sequence<kQuantity...>) {
  ((table[DielectricKernel(kNormals, kQuantity)] = {Dielectric<Real, kNormals, kQuantity>::Run, true}), ...);
}

template <Normals kNormals, class Real>
constexpr void AddDielectrics(KernelTable<Function<Real>>& table) {
  AddDielectrics<kNormals>(table, std::make_index_sequence<NumDielectricQuantities(kNormals)>());
}

template <class Real, std::size_t... kPlace>
constexpr void AddReflectors(KernelTable<Function<Real>>& table, std::index_sequence<kPlace...>) {
  ((table[kFirstReflectorKernel + kPlace] = {RunReflector<Real, kFirstReflectorKernel + kPlace>, true}), ...);
}

template <class Real, std::size_t... kPlace>
constexpr void AddDiffuse(KernelTable<Function<Real>>& table, std::index_sequence<kPlace...>) {
  ((table[kFirstDiffuseKernel + kPlace] = {RunDiffuse<Real, kFirstDiffuseKernel + kPlace>, true}), ...);
}

template <class Real, std::size_t... kPlace>
constexpr void AddMeanFresnel(KernelTable<Function<Real>>& table, std::index_sequence<kPlace...>) {
  ((table[kFirstMeanFresnelKernel + kPlace] = {RunMeanFresnel<Real, kFirstMeanFresnelKernel + kPlace>, true}),
   ...);
}

// Functions in the order of kKernels; null where the list has an entry that this file has not.
template <class Real>
constexpr KernelTable<Function<Real>> Resolve() {
  KernelTable<Function<Real>> table{};
  for (const Entry<Real>& entry : Entries<Real>()) table[KernelIndex(entry.id)] = {entry.function, true};
  AddNormals(table, std::make_index_sequence<kNumNormalKernels>());
  AddDielectrics<Normals::kGgx>(table);
  AddDielectrics<Normals::kBeckmann>(table);
  AddDielectrics<Normals::kPhong>(table);
  AddReflectors(table, std::make_index_sequence<kNumReflectorKernels>());
  AddDiffuse(table, std::make_index_sequence<kNumDiffuseKernels>());
  AddMeanFresnel(table, std::make_index_sequence<kNumMeanFresnelKernels>());
  return table;
}

template <class Real>
inline constexpr KernelTable<Function<Real>> kTable = Resolve<Real>();

static_assert(HasEveryKernel(kTable<float>), "every entry of the kernel list has its scalar function");

}  // namespace evaluate_internal

// Entry `kernel` of kKernels: inputs and outputs in the list's order. A NaN input makes every output NaN.
template <class Real>
void Evaluate(std::size_t kernel, const Real* inputs, Real* outputs,
              Transport transport = Transport::kRadiance) {
  evaluate_internal::kTable<Real>[kernel].function(inputs, outputs, transport);
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_EVALUATE_H_
