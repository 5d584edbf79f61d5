#include "oracle/oracle.h"

#include <array>
#include <limits>
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>

#include "oracle/albedo.h"
#include "oracle/beckmann.h"
#include "oracle/coupled.h"
#include "oracle/fresnel.h"
#include "oracle/gaussian.h"
#include "oracle/ggx.h"
#include "oracle/half_vector.h"
#include "oracle/masking.h"
#include "oracle/math.h"
#include "oracle/mean_fresnel.h"
#include "oracle/phong.h"
#include "oracle/rough_diffuse.h"
#include "oracle/rough_reflector.h"
#include "oracle/roughness.h"
#include "oracle/student.h"
#include "oracle/student_t.h"
#include "oracle/tabulated.h"

namespace microlane::oracle {
namespace {

struct Call {
  const Real* in;
  Transport transport;
  int lobe_hint;
  bool other_facet;
  Real* out;
  Real kappa = 1, direction_kappa = 1;  // of density and direction
  Real weight_kappa = 0;                // 0: kappa
  double weight_curvature = 0;
  double margin = std::numeric_limits<double>::infinity();
  double facet_margin = std::numeric_limits<double>::infinity();
};

using Function = void (*)(Call&);

Vec Direction(const Real* in) { return {in[0], in[1], in[2]}; }

void Store(const Vec& v, Real* out) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

template <RoughnessKind kRoughness>
Roughness MakeRoughness(const Real* in) {
  constexpr bool shears = kRoughness == RoughnessKind::kRotated || kRoughness == RoughnessKind::kOffCentre;
  Roughness roughness{in[0], in[kRoughness == RoughnessKind::kIsotropic ? 0 : 1]};
  if constexpr (shears) roughness.r_xy = in[2];
  if constexpr (kRoughness == RoughnessKind::kOffCentre) {
    roughness.mean_x = in[3];
    roughness.mean_y = in[4];
  }
  return roughness;
}

// A distribution from its parameters, as they follow the other inputs.
template <Normals kNormals, RoughnessKind kRoughness>
auto MakeNormals(const Real* in) {
  if constexpr (kNormals == Normals::kPhong) {
    return Phong{in[0]};
  } else if constexpr (kNormals == Normals::kStudentT) {
    return StudentT{in[0], MakeRoughness<kRoughness>(in + 1)};
  } else {
    return std::conditional_t<kNormals == Normals::kGgx, Ggx, Beckmann>{MakeRoughness<kRoughness>(in)};
  }
}

template <class Distribution>
void StoreNormal(const Distribution& distribution, Call& call) {
  const Vec m = distribution.SampleNormal(call.in[0], call.in[1]);
  Store(m, call.out);
  call.out[3] = distribution.D(m) * m.z;  // Walter 2007, Eq. 24
}

// A visible normal, the share of them that is drawn from, and what Metric::kDirection and kConditioned make
// of it.
struct VisibleSample {
  Vec m;
  Real share, direction_kappa, kappa;
};

const Real& Larger(const Real& a, const Real& b) { return a > b ? a : b; }

// How much of the visible normals is drawn from.
template <bool kBounded, class Distribution>
Real ShareOfVisible(const Distribution& distribution, const Vec& v) {
  if constexpr (kBounded) {
    const Vec s = Normalized(UnitView(v, distribution.alpha));
    return (1 + CapBound(v, distribution.alpha) * abs(s.z)) / (1 + abs(s.z));
  } else {
    return 1;
  }
}

template <bool kBounded>
VisibleSample SampleVisible(const Ggx& ggx, const Vec& v, const Real& u1, const Real& u2) {
  const Real k = kBounded ? CapBound(v, ggx.alpha) : Real(1);
  const CapNormal normal = VisibleNormal(v, u1, u2, ggx.alpha, k);
  const Real stretched = CapCancellation(normal, ggx.alpha);
  return {normal.m, ShareOfVisible<kBounded>(ggx, v), stretched,
          Larger(stretched, CapCancellation(normal, {1, 1}))};
}
// Of Beckmann's and tables' slopes.
template <bool kBounded, class Distribution>
VisibleSample SampleVisible(const Distribution& distribution, const Vec& v, const Real& u1, const Real& u2) {
  const auto normal = VisibleNormal(distribution, v, u1, u2);
  const Real stretched = Cancellation(normal.sizes, normal.h, distribution.alpha);
  return {normal.m, 1, stretched,
          Larger(stretched, Cancellation(normal.sizes, normal.h, {1, 1})) + normal.end_share};
}

// The normals of a model's sampler.
template <bool kVisible, class Distribution>
NormalSample SampleNormal(const Distribution& distribution, const Vec& wi, const Real& u1, const Real& u2) {
  if constexpr (kVisible) {
    const VisibleSample normal = SampleVisible<false>(distribution, wi, u1, u2);
    return {normal.m, distribution.DVisible(wi, normal.m), true, normal.direction_kappa, normal.kappa};
  } else {
    const Vec m = distribution.SampleNormal(u1, u2);
    return {m, distribution.D(m) * m.z};
  }
}

template <bool kBounded, class Distribution>
void StoreVisibleNormal(const Distribution& distribution, Call& call) {
  const Vec v = Direction(call.in);
  const VisibleSample normal = SampleVisible<kBounded>(distribution, v, call.in[3], call.in[4]);
  Store(normal.m, call.out);
  call.out[3] = distribution.DVisible(v, normal.m) / normal.share;
  call.direction_kappa = normal.direction_kappa;
  call.kappa = normal.kappa;
}

// A normal that V-cavities show.
template <class Distribution>
void StoreVCavityNormal(const Distribution& distribution, Call& call) {
  const Vec n = distribution.SampleNormal(call.in[3], call.in[4]);
  const VCavityFacet facet = ChooseFacet(Direction(call.in), n, call.in[5], call.other_facet);
  Store(facet.m, call.out);
  call.out[3] = distribution.D(facet.m) * facet.m.z * 2 * facet.share;
  call.kappa = facet.kappa;
  call.facet_margin = facet.margin;
}

// Reflection about a visible normal: Walter 2007, Eqs. 14 and 39; the weight is f |cos(theta_o)| / pdf of
// Heitz 2014, Eqs. 16 and 99 or 98, less what both have in common.
template <bool kBounded, class Distribution, class Facets>
void StoreVisibleReflection(const Distribution& distribution, const Facets& facets, Masking masking,
                            Call& call) {
  const Vec wi = Direction(call.in);
  const VisibleSample normal = SampleVisible<kBounded>(distribution, wi, call.in[3], call.in[4]);
  const Real side = wi.z < 0 ? -1 : 1;
  const Vec wo = Reflect(wi, side * normal.m);
  call.direction_kappa = normal.direction_kappa;
  call.margin = static_cast<double>(Real(abs(wo.z) / call.direction_kappa));
  const bool reflects = call.lobe_hint >= 0 ? call.lobe_hint != 0 : side * wo.z > 0;
  for (std::size_t i = 0; i < 6; ++i) call.out[i] = 0;
  if (!reflects) return;
  Store(wo, call.out);
  // |wi.n| times Lambda; |wi.n| (1 + Lambda) has a limit at wi.n = 0.
  const Real lambda_i =
      wi.z == 0 ? Real(distribution.GrazingArea(wi)) : Real(abs(wi.z) * distribution.Lambda(wi));
  const Real lambda_o = distribution.Lambda(wo);
  // d(Lambda_o) times this is d(G2)/G2.
  const Real over_visible = masking == Masking::kSeparable
                                ? Real(1 / (1 + lambda_o))
                                : Real(abs(wi.z) / (abs(wi.z) + lambda_i + abs(wi.z) * lambda_o));
  const Real c = abs(Dot(wi, normal.m)), F = facets.Reflectance(c), slope = RelativeSlope(facets, c);
  call.out[3] = F * normal.share * (1 - lambda_o * over_visible);
  call.out[4] = distribution.DVisible(wi, normal.m) / normal.share * ReflectionJacobian(c);
  call.out[5] = 1;
  call.kappa = normal.kappa;
  // |d ln(weight)| for changes of wo by 1 along each axis, and of wi.m, at most.
  call.weight_kappa = 1 + call.direction_kappa * (over_visible * distribution.LambdaSlope(wo) + slope);
  const Real length = sqrt(ProjectedRoughness2(wo, distribution.alpha) + wo.z * wo.z);
  call.weight_curvature = static_cast<double>(
      Real(call.direction_kappa * (1 / abs(wo.z) + distribution.Alphas() / length + facets.Curvature(c))));
}

// A quantity of a distribution by its place in kNormalKernelPlaces.
template <std::size_t kPlace, class Distribution>
void OfNormals(const Distribution& normals, Call& call) {
  constexpr NormalRow row = kNormalRows[kNormalKernelPlaces[kPlace].row];
  if constexpr (row.what == NormalQuantity::kD) {
    call.out[0] = normals.D(Direction(call.in));
  } else if constexpr (row.what == NormalQuantity::kLambda) {
    call.out[0] = normals.Lambda(Direction(call.in));
  } else if constexpr (row.what == NormalQuantity::kG1) {
    call.out[0] = normals.G1(Direction(call.in), Direction(call.in + 3));
  } else if constexpr (row.what == NormalQuantity::kDVisible) {
    call.out[0] = normals.DVisible(Direction(call.in), Direction(call.in + 3));
  } else if constexpr (row.what == NormalQuantity::kDVisibleVCavity) {
    call.out[0] = VCavityDensity(normals, Direction(call.in), Direction(call.in + 3));
  } else if constexpr (row.what == NormalQuantity::kSampleVCavity) {
    StoreVCavityNormal(normals, call);
  } else if constexpr (row.what == NormalQuantity::kSampleNormal) {
    StoreNormal(normals, call);
  } else if constexpr (row.what == NormalQuantity::kSampleReflection ||
                       row.what == NormalQuantity::kSampleReflectionBounded) {
    StoreVisibleReflection<row.what == NormalQuantity::kSampleReflectionBounded>(normals, MirrorFacets{},
                                                                                 Masking::kCorrelated, call);
  } else if constexpr (row.what == NormalQuantity::kPdfReflection ||
                       row.what == NormalQuantity::kPdfReflectionBounded) {
    const Vec wi = Direction(call.in);
    const Real pdf = PdfVisible(normals, wi, Direction(call.in + 3));
    constexpr bool bounded = row.what == NormalQuantity::kPdfReflectionBounded;
    call.out[0] = pdf == 0 ? pdf : Real(pdf / ShareOfVisible<bounded>(normals, wi));
  } else {
    StoreVisibleNormal<row.what == NormalQuantity::kSampleVisibleBounded>(normals, call);
  }
}

// What a kernel's table is made of, the inputs behind the list's second bar.
template <std::size_t kKernel>
std::array<double, kMaxInputs> TableValues(const Real* in) {
  constexpr Names names = Split(kKernels[kKernel].inputs);
  std::array<double, kMaxInputs> values{};
  for (std::size_t k = names.columns; k < names.count; ++k) {
    values[k - names.columns] = static_cast<double>(in[k]);
  }
  return values;
}

template <std::size_t kPlace>
void OfNormals(Call& call) {
  constexpr NormalKernelPlace place = kNormalKernelPlaces[kPlace];
  constexpr NormalRow row = kNormalRows[place.row];
  constexpr std::size_t kernel = kNumComponentKernels + kPlace,
                        lanes = Split(kKernels[kernel].inputs).per_lane;
  if constexpr (row.normals == Normals::kTabulated) {
    const auto table = GivenRadialEntries(kernel, TableValues<kernel>(call.in).data());
    if (table == nullptr) {
      for (std::size_t i = 0; i < kMaxOutputs; ++i) call.out[i] = std::numeric_limits<double>::quiet_NaN();
      return;
    }
    OfNormals<kPlace>(Tabulated{table.get(), MakeRoughness<place.roughness>(call.in + lanes)}, call);
  } else {
    OfNormals<kPlace>(MakeNormals<row.normals, place.roughness>(call.in + lanes), call);
  }
}

void StoreSample(const DirectionSample& sample, Call& call) {
  Store(sample.wo, call.out);
  call.out[3] = sample.weight;
  call.out[4] = sample.pdf;
  call.out[5] = sample.lobe;
  call.kappa = sample.kappa;
  call.weight_kappa = sample.weight_kappa;
  call.weight_curvature = sample.weight_curvature;
  call.direction_kappa = sample.direction_kappa;
  call.margin = sample.margin;
  call.facet_margin = sample.facet_margin;
}

// The roughness that the models take.
constexpr RoughnessKind ModelRoughness(Normals normals) {
  return normals == Normals::kPhong ? RoughnessKind::kExponent : RoughnessKind::kAnisotropic;
}

constexpr Masking MaskingOf(const DielectricQuantity& row) {
  return row.joint == DielectricQuantity::kVCavity     ? Masking::kVCavity
         : row.joint == DielectricQuantity::kKelemen   ? Masking::kKelemen
         : row.joint == DielectricQuantity::kSeparable ? Masking::kSeparable
                                                       : Masking::kCorrelated;
}

// The rough dielectric by its place in kDielectricQuantities.
template <Normals kNormals, std::size_t kQuantity>
void Dielectric(Call& call) {
  constexpr DielectricQuantity row = kDielectricQuantities[kQuantity];
  constexpr int lobes = (row.reflects ? kReflection : 0) | (row.transmits ? kTransmission : 0);
  constexpr bool one_lobe_sampled = row.what == DielectricQuantity::kSample && !row.HasBothLobes();
  const Real* const parameters = call.in + (one_lobe_sampled ? 5 : 6);
  constexpr RoughnessKind roughness = ModelRoughness(kNormals);
  constexpr std::size_t eta = Split(kModelFamilies[static_cast<std::size_t>(kNormals)].parameters).count;
  const auto normals = MakeNormals<kNormals, roughness>(parameters);
  const RoughDielectric<std::remove_const_t<decltype(normals)>> bsdf{normals, parameters[eta], MaskingOf(row),
                                                                     call.transport};
  const Vec wi = Direction(call.in);
  if constexpr (row.what == DielectricQuantity::kSample) {
    StoreSample(bsdf.Sample(wi, SampleNormal<row.visible>(normals, wi, call.in[3], call.in[4]),
                            one_lobe_sampled ? Real(0) : call.in[5], lobes, call.lobe_hint),
                call);
  } else {
    const Vec wo = Direction(call.in + 3);
    if constexpr (row.HasValue()) call.out[0] = bsdf.EvalCos(wi, wo, lobes);
    if constexpr (row.what != DielectricQuantity::kEval) {
      call.out[row.HasValue() ? 1 : 0] = bsdf.Pdf(wi, wo, lobes, row.visible);
    }
  }
}

template <Reflector kReflector>
auto MakeFacets(const Real* in) {
  if constexpr (kReflector == Reflector::kMirror) {
    return MirrorFacets{};
  } else if constexpr (kReflector == Reflector::kConductor) {
    return ConductorFacets{in[0], in[1]};
  } else {
    return SchlickFacets{in[0]};
  }
}

// A kernel of an opaque surface.
template <std::size_t kKernel>
void OfReflector(Call& call) {
  constexpr ReflectorKernelPlace place = PlaceOfReflectorKernel(kKernel);
  constexpr DielectricQuantity row = kReflectorQuantities[place.quantity];
  constexpr RoughnessKind roughness = ModelRoughness(place.normals);
  constexpr std::size_t count =
      Split(kModelFamilies[static_cast<std::size_t>(place.normals)].parameters).count;
  const Real* const parameters = call.in + Split(kKernels[kKernel].inputs).per_lane;
  const auto normals = MakeNormals<place.normals, roughness>(parameters);
  const auto facets = MakeFacets<place.reflector>(parameters + count);
  constexpr Masking masking = MaskingOf(row);
  constexpr bool v_cavity = masking == Masking::kVCavity;
  const RoughReflector<std::remove_const_t<decltype(normals)>, std::remove_const_t<decltype(facets)>> surface{
      normals, facets, masking};
  const Vec wi = Direction(call.in);
  if constexpr (row.what == DielectricQuantity::kSample && row.visible) {
    StoreVisibleReflection<false>(normals, facets, masking, call);
  } else if constexpr (row.what == DielectricQuantity::kSample) {
    const Real u3 = v_cavity ? call.in[5] : Real(0);
    StoreSample(surface.Sample(wi, call.in[3], call.in[4], u3, call.lobe_hint, call.other_facet), call);
  } else {
    const Vec wo = Direction(call.in + 3);
    call.out[0] = surface.EvalCos(wi, wo);
    if constexpr (row.what == DielectricQuantity::kEvalPdf) {
      call.out[1] = v_cavity      ? surface.PdfVCavity(wi, wo)
                    : row.visible ? PdfVisible(normals, wi, wo)
                                  : surface.Pdf(wi, wo);
    }
  }
}

template <Scatterer kScatterer>
auto MakeFacet(const Real* in) {
  if constexpr (kScatterer == Scatterer::kInterfaced) {
    return InterfacedFacet{in[0], in[1]};
  } else {
    return LambertianFacet{};
  }
}

// A kernel of facets that scatter.
template <std::size_t kKernel>
void OfDiffuse(Call& call) {
  constexpr DiffuseKernelPlace place = PlaceOfDiffuseKernel(kKernel);
  constexpr Names inputs = Split(kKernels[kKernel].inputs);
  const auto normals = MakeNormals<place.normals, ModelRoughness(place.normals)>(call.in + inputs.per_lane);
  constexpr DielectricQuantity row = kDiffuseQuantities[place.quantity];
  const auto facet = MakeFacet<place.scatterer>(call.in + inputs.per_lane + 2);
  const Vec wi = Direction(call.in), wo = Direction(call.in + 3);
  if constexpr (row.what == DielectricQuantity::kSample) {
    DirectionSample sample;
    if (wi.z != 0) {
      const Vec v{wi.x, wi.y, abs(wi.z)};
      sample = SampleWithInterface(normals, facet, v, SampleNormal<true>(normals, v, call.in[3], call.in[4]),
                                   SampleNormal<true>(normals, v, call.in[6], call.in[7]),
                                   {call.in[3], call.in[4], call.in[5]}, call.lobe_hint);
      if (wi.z < 0) sample.wo.z = -sample.wo.z;
    }
    StoreSample(sample, call);
  } else if constexpr (row.what == DielectricQuantity::kPdf) {
    call.out[0] = PdfWithInterface(normals, facet, wi, wo);
  } else {
    const bool sums = row.what == DielectricQuantity::kEval;
    const RoughDiffuse<std::remove_const_t<decltype(normals)>, std::remove_const_t<decltype(facet)>> surface{
        normals, facet, sums ? static_cast<int>(call.in[inputs.columns]) : 0, MaskingOf(row)};
    call.out[0] =
        sums ? surface.EvalCos(wi, wo) : surface.OneNormalCos(wi, wo, Direction(call.in + 6), row.visible);
  }
}

// A mean over visible normals.
template <std::size_t kKernel>
void OfMeanFresnel(Call& call) {
  constexpr ModelKernelPlace place = PlaceOfMeanFresnelKernel(kKernel);
  if constexpr (place.quantity == MeanFresnelQuantity::kCosine) {
    call.out[0] = MeanFresnelCosine(call.in[0], call.in[1],
                                    place.normals == Normals::kGgx ? kGgxCosineFit : kBeckmannCosineFit);
  } else {
    constexpr Names inputs = Split(kKernels[kKernel].inputs);
    const auto normals = MakeNormals<place.normals, ModelRoughness(place.normals)>(call.in + inputs.per_lane);
    const Real* const facets = call.in + 5;
    const MeanReflectance result = MeanFresnel(
        normals, Direction(call.in), static_cast<int>(call.in[inputs.columns]), [&](const Real& c) {
          if constexpr (place.quantity == MeanFresnelQuantity::kDielectric) {
            return FresnelDielectric(c, facets[0]);
          } else if constexpr (place.quantity == MeanFresnelQuantity::kConductor) {
            return FresnelConductor(c, facets[0], facets[1]);
          } else {
            return FresnelSchlick(c, facets[0]);
          }
        });
    call.out[0] = result.mean;
    call.kappa = result.kappa;
  }
}

// The table of a kernel, from the inputs behind the list's second bar; null where they make none.
template <std::size_t kKernel>
std::shared_ptr<const AlbedoEntries> TableOf(const Real* in) {
  return GivenEntries(kKernel, TableValues<kKernel>(in).data());
}

// A kernel of the coupled model.
template <std::size_t kKernel>
void OfCoupled(Call& call) {
  constexpr Names names = Split(kKernels[kKernel].inputs), outputs = Split(kKernels[kKernel].outputs);
  const auto table = TableOf<kKernel>(call.in);
  if (table == nullptr) {
    for (std::size_t i = 0; i < outputs.count; ++i) call.out[i] = std::numeric_limits<double>::quiet_NaN();
    return;
  }
  const Coupled model{*table, call.in[names.columns], call.in[names.columns + 1], call.in[names.per_lane]};
  const Vec wi = Direction(call.in);
  if constexpr (names.name[3] == "u1") {
    StoreSample(model.Sample(wi, call.in[3], call.in[4], call.in[5], call.lobe_hint), call);
  } else {
    const Vec wo = Direction(call.in + 3);
    for (std::size_t i = 0; i < outputs.count; ++i) {
      call.out[i] = outputs.name[i] == "pdf" ? model.Pdf(wi, wo) : model.EvalCos(wi, wo);
    }
  }
}

struct Entry {
  std::string_view id;
  Function function;
};

constexpr Entry kEntries[] = {
    {"math.exp", [](Call& call) { call.out[0] = exp(call.in[0]); }},
    {"math.neg_log1m", [](Call& call) { call.out[0] = NegLog1m(call.in[0]); }},
    {"math.sincos_2pi",
     [](Call& call) {
       const SinCos s = SinCos2Pi(call.in[0]);
       call.out[0] = s.sin;
       call.out[1] = s.cos;
     }},
    {"math.erfcx_defect", [](Call& call) { call.out[0] = ErfcxDefect(call.in[0]); }},

    {"math.erfcx", [](Call& call) { call.out[0] = Erfcx(call.in[0]); }},
    {"math.erfinv", [](Call& call) { call.out[0] = ErfInv(call.in[0]); }},
    {"math.azimuth_difference",
     [](Call& call) { call.out[0] = AzimuthDifference(call.in[0], call.in[1], call.in[2], call.in[3]); }},
    {"math.student_defect",
     [](Call& call) { call.out[0] = StudentDefect(abs(call.in[0]), call.in[1] - Real(3) / 2); }},

    {"beckmann.G1_rational",
     [](Call& call) {
       call.out[0] = MakeNormals<Normals::kBeckmann, RoughnessKind::kAnisotropic>(call.in + 6)
                         .G1Rational(Direction(call.in), Direction(call.in + 3));
     }},
    {"beckmann.sample_normal_widened",
     [](Call& call) {
       StoreNormal(
           Widened(MakeNormals<Normals::kBeckmann, RoughnessKind::kAnisotropic>(call.in + 3), call.in[2]),
           call);
     }},

    {"phong.exponent", [](Call& call) { call.out[0] = PhongExponent(call.in[0]); }},
    {"phong.Lambda", [](Call& call) { call.out[0] = PhongSmith{{call.in[3]}}.Lambda(Direction(call.in)); }},
    {"phong.G1_smith",
     [](Call& call) {
       call.out[0] = PhongSmith{{call.in[6]}}.G1(Direction(call.in), Direction(call.in + 3));
     }},

    {"gaussian.C", [](Call& call) { call.out[0] = MakeGaussian(call.in[0]).C(); }},
    {"gaussian.D", [](Call& call) { call.out[0] = MakeGaussian(call.in[3]).D(Direction(call.in)); }},
    {"gaussian.D_visible_v_cavity",
     [](Call& call) {
       call.out[0] = VCavityDensity(MakeGaussian(call.in[6]), Direction(call.in), Direction(call.in + 3));
     }},
    {"gaussian.eval_v_cavity",
     [](Call& call) {
       const Vec wi = Direction(call.in), wo = Direction(call.in + 3);
       const Geometry g = MakeGeometry(wi, wo, 1);
       if (g.lobe != kReflection) return void(call.out[0] = 0);
       const Real of_i = VCavityG1(wi, g.h), of_o = VCavityG1(wo, g.h);
       call.out[0] = MakeGaussian(call.in[6]).D(g.h) * (of_i < of_o ? of_i : of_o) / (4 * abs(wi.z));
     }},
    {"gaussian.sample_normal",
     [](Call& call) {
       const Gaussian gaussian = MakeGaussian(call.in[2]);
       const Real theta = gaussian.SampleTheta(call.in[0]);
       Store(Gaussian::Normal(theta, call.in[1]), call.out);
       call.out[3] = gaussian.PdfOfTheta(theta);
     }},

    {"fresnel.dielectric", [](Call& call) { call.out[0] = FresnelDielectric(call.in[0], call.in[1]); }},
    {"fresnel.dielectric_transmittance",
     [](Call& call) { call.out[0] = 1 - FresnelDielectric(call.in[0], call.in[1]); }},
    {"fresnel.dielectric_s", [](Call& call) { call.out[0] = FresnelDielectricS(call.in[0], call.in[1]); }},
    {"fresnel.dielectric_p", [](Call& call) { call.out[0] = FresnelDielectricP(call.in[0], call.in[1]); }},

    {"fresnel.conductor",
     [](Call& call) { call.out[0] = FresnelConductor(call.in[0], call.in[1], call.in[2]); }},
    {"fresnel.diffuse_external", [](Call& call) { call.out[0] = DiffuseFresnelExternal(call.in[0]); }},
    {"fresnel.diffuse_internal", [](Call& call) { call.out[0] = DiffuseFresnelInternal(call.in[0]); }},
    {"interfaced.facet_body",
     [](Call& call) {
       const Real &cos_i = call.in[0], &cos_o = call.in[1];
       if (!(cos_i > 0 && cos_o > 0)) return void(call.out[0] = 0);
       call.out[0] = InterfacedFacet{call.in[2], call.in[3]}(cos_i, cos_o) / Pi();
     }},
    {"fresnel.schlick", [](Call& call) { call.out[0] = FresnelSchlick(call.in[0], call.in[1]); }},

    {"half_vector.reflection",
     [](Call& call) {
       Store(Normalized(ReflectionHalfVector(Direction(call.in), Direction(call.in + 3))), call.out);
     }},
    {"half_vector.reflection_jacobian",
     [](Call& call) {
       const Vec wi = Direction(call.in), wo = Direction(call.in + 3);
       call.out[0] = HalfVectorJacobian(wo, ReflectionHalfVector(wi, wo));
     }},
    {"half_vector.reflection_jacobian_cos", [](Call& call) { call.out[0] = ReflectionJacobian(call.in[0]); }},
    {"half_vector.refraction",
     [](Call& call) {
       const Vec wi = Direction(call.in), wo = Direction(call.in + 3);
       Store(Normalized(RefractionHalfVector(wi, wo, call.in[6])), call.out);
     }},
    {"half_vector.refraction_jacobian",
     [](Call& call) {
       const Vec wi = Direction(call.in), wo = Direction(call.in + 3);
       const Real& eta = call.in[6];
       call.out[0] = eta * eta * HalfVectorJacobian(wo, RefractionHalfVector(wi, wo, eta));
     }},
    {"half_vector.refraction_jacobian_cos",
     [](Call& call) { call.out[0] = RefractionJacobian(call.in[0], call.in[1], call.in[2]); }},

    {"reflect", [](Call& call) { Store(Reflect(Direction(call.in), Direction(call.in + 3)), call.out); }},
    {"refract",
     [](Call& call) { Store(Refract(Direction(call.in), Direction(call.in + 3), call.in[6]), call.out); }},

    {"half_vector_density.ward",
     [](Call& call) {
       const Vec m = Direction(call.in);
       call.out[0] = Beckmann{{call.in[3], call.in[3]}}.D(m) * m.z;
     }},
    {"half_vector_density.phong",
     [](Call& call) {
       const Vec m = Direction(call.in);
       call.out[0] = Phong{call.in[3]}.D(m) * m.z;
     }},

    {"albedo.directional",
     [](Call& call) {
       const auto table = TableOf<KernelIndex("albedo.directional")>(call.in);
       call.out[0] = call.out[1] = std::numeric_limits<double>::quiet_NaN();
       if (table == nullptr) return;
       const AlbedoEntries& entries = *table;
       call.out[0] = AlbedoCurve(entries, entries.albedo, call.in[0]);
       call.out[1] = AlbedoCurve(entries, entries.deficit, call.in[0]);
     }},

    {"coupled.eval", OfCoupled<KernelIndex("coupled.eval")>},
    {"coupled.pdf", OfCoupled<KernelIndex("coupled.pdf")>},
    {"coupled.eval_pdf", OfCoupled<KernelIndex("coupled.eval_pdf")>},
    {"coupled.sample", OfCoupled<KernelIndex("coupled.sample")>},

    {"roughness.from_moments",
     [](Call& call) {
       const Real* const in = call.in;
       call.out[0] = AlphaOfMoments(in[0], in[2]);
       call.out[1] = AlphaOfMoments(in[1], in[3]);
       call.out[2] = CorrelationOfMoments(in[0], in[1], in[2], in[3], in[4]);
     }},
    {"roughness.to_moments",
     [](Call& call) {
       const Real* const in = call.in;
       call.out[0] = MixedMoment(in[3], in[3], in[0], in[0], 1);
       call.out[1] = MixedMoment(in[4], in[4], in[1], in[1], 1);
       call.out[2] = MixedMoment(in[3], in[4], in[0], in[1], in[2]);
     }},

    {"masking.v_cavity",
     [](Call& call) { call.out[0] = VCavityG1(Direction(call.in), Direction(call.in + 3)); }},
    {"masking.implicit",
     [](Call& call) { call.out[0] = ImplicitG1(Direction(call.in), Direction(call.in + 3)); }},
    {"masking.schlick_smith",
     [](Call& call) {
       call.out[0] = SchlickSmithG1(Direction(call.in), Direction(call.in + 3), call.in[6]);
     }},
    {"masking.kelemen",
     [](Call& call) { call.out[0] = KelemenG1(Direction(call.in), Direction(call.in + 3)); }},
    {"masking.separable", [](Call& call) { call.out[0] = SeparableG2(call.in[0], call.in[1]); }},
    {"masking.height_correlated",
     [](Call& call) { call.out[0] = HeightCorrelatedG2(call.in[0], call.in[1]); }},
    {"masking.height_correlated_transmission",
     [](Call& call) { call.out[0] = HeightCorrelatedTransmissionG2(call.in[0], call.in[1]); }},
    {"masking.student_lambda",
     [](Call& call) {
       const StudentT student{call.in[5], {call.in[3], call.in[4]}};
       call.out[0] = student.Lambda(Direction(call.in));
     }},
    {"masking.direction_correlated",
     [](Call& call) {
       const Real phi = AzimuthDifference(call.in[2], call.in[3], call.in[4], call.in[5]);
       call.out[0] = DirectionCorrelatedG2(call.in[0], call.in[1], phi);
     }},
    {"masking.height_direction_correlated",
     [](Call& call) {
       const Real phi = AzimuthDifference(call.in[2], call.in[3], call.in[4], call.in[5]);
       call.out[0] = HeightDirectionCorrelatedG2(call.in[0], call.in[1], phi);
     }},
};

struct Resolved {
  Function function = nullptr;
  std::size_t num_inputs = 0;
  std::size_t num_outputs = 0;
  Metric metric[kMaxOutputs] = {};
  bool weighs[kMaxOutputs] = {};  // the output is a weight
};

template <std::size_t... kPlace>
constexpr void AddNormals(std::array<Resolved, kNumKernels>& table, std::index_sequence<kPlace...>) {
  const auto add = [&](auto place) {
    constexpr std::size_t kThis = decltype(place)::value;
    if constexpr (kNormalRows[kNormalKernelPlaces[kThis].row].what != NormalQuantity::kOwn) {
      table[kNumComponentKernels + kThis].function = OfNormals<kThis>;
    }
  };
  (add(std::integral_constant<std::size_t, kPlace>()), ...);
}

template <Normals kNormals, std::size_t... kQuantity>
constexpr void AddDielectrics(std::array<Resolved, kNumKernels>& table, std::index_sequence<kQuantity...>) {
  ((table[DielectricKernel(kNormals, kQuantity)].function = Dielectric<kNormals, kQuantity>), ...);
}

template <std::size_t... kPlace>
constexpr void AddReflectors(std::array<Resolved, kNumKernels>& table, std::index_sequence<kPlace...>) {
  ((table[kFirstReflectorKernel + kPlace].function = OfReflector<kFirstReflectorKernel + kPlace>), ...);
}

template <std::size_t... kPlace>
constexpr void AddDiffuse(std::array<Resolved, kNumKernels>& table, std::index_sequence<kPlace...>) {
  ((table[kFirstDiffuseKernel + kPlace].function = OfDiffuse<kFirstDiffuseKernel + kPlace>), ...);
}

template <std::size_t... kPlace>
constexpr void AddMeanFresnel(std::array<Resolved, kNumKernels>& table, std::index_sequence<kPlace...>) {
  ((table[kFirstMeanFresnelKernel + kPlace].function = OfMeanFresnel<kFirstMeanFresnelKernel + kPlace>), ...);
}

constexpr std::array<Resolved, kNumKernels> Resolve() {
  std::array<Resolved, kNumKernels> table{};
  for (std::size_t k = 0; k < kNumKernels; ++k) {
    const Names outputs = Split(kKernels[k].outputs);
    table[k].num_inputs = Split(kKernels[k].inputs).count;
    table[k].num_outputs = outputs.count;
    for (std::size_t i = 0; i < outputs.count; ++i) {
      table[k].metric[i] = MetricOf(kKernels[k], outputs.name[i]);
      table[k].weighs[i] = outputs.name[i] == "weight";
    }
    for (const Entry& entry : kEntries) {
      if (entry.id == kKernels[k].id) table[k].function = entry.function;
    }
  }
  AddNormals(table, std::make_index_sequence<kNumNormalKernels>());
  AddDielectrics<Normals::kGgx>(table, std::make_index_sequence<NumDielectricQuantities(Normals::kGgx)>());
  AddDielectrics<Normals::kBeckmann>(table,
                                     std::make_index_sequence<NumDielectricQuantities(Normals::kBeckmann)>());
  AddDielectrics<Normals::kPhong>(table,
                                  std::make_index_sequence<NumDielectricQuantities(Normals::kPhong)>());
  AddReflectors(table, std::make_index_sequence<kNumReflectorKernels>());
  AddDiffuse(table, std::make_index_sequence<kNumDiffuseKernels>());
  AddMeanFresnel(table, std::make_index_sequence<kNumMeanFresnelKernels>());
  return table;
}

constexpr std::array<Resolved, kNumKernels> kTable = Resolve();

Real Scale(Metric metric, const Real& exact, const Real& kappa, const Real& direction_kappa) {
  switch (metric) {
    case Metric::kDirection:
      return direction_kappa;
    case Metric::kConditioned:
      return isinf(kappa) ? kappa : abs(exact) * kappa;
    default:
      return exact;
  }
}

}  // namespace

Result Evaluate(std::size_t kernel, const Real* inputs, Transport transport, int lobe_hint,
                bool other_facet) {
  const Resolved& resolved = kTable[kernel];
  Result result;
  result.margin = std::numeric_limits<double>::infinity();
  bool nan = resolved.function == nullptr;
  for (std::size_t i = 0; i < resolved.num_inputs; ++i) nan |= isnan(inputs[i]);
  if (nan) {
    for (std::size_t i = 0; i < resolved.num_outputs; ++i) {
      result.exact[i] = result.scale[i] = Real(std::numeric_limits<double>::quiet_NaN());
    }
    return result;
  }
  Call call{inputs, transport, lobe_hint, other_facet, result.exact};
  resolved.function(call);
  result.margin = call.margin;
  result.facet_margin = call.facet_margin;
  for (std::size_t i = 0; i < resolved.num_outputs; ++i) {
    const Real& kappa = resolved.weighs[i] && call.weight_kappa != 0 ? call.weight_kappa : call.kappa;
    result.scale[i] = Scale(resolved.metric[i], result.exact[i], kappa, call.direction_kappa);
    if (resolved.weighs[i]) result.curvature[i] = call.weight_curvature;
  }
  return result;
}

Result Evaluate(std::size_t kernel, const double* inputs, Transport transport, int lobe_hint,
                bool other_facet) {
  Real real_inputs[kMaxInputs];
  for (std::size_t i = 0; i < kTable[kernel].num_inputs; ++i) real_inputs[i] = inputs[i];
  return Evaluate(kernel, real_inputs, transport, lobe_hint, other_facet);
}

bool HasKernel(std::size_t kernel) { return kernel < kNumKernels && kTable[kernel].function != nullptr; }

}  // namespace microlane::oracle
