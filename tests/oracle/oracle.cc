#include "oracle/oracle.h"

#include <array>
#include <limits>
#include <string_view>
#include <utility>

#include "oracle/beckmann.h"
#include "oracle/fresnel.h"
#include "oracle/ggx.h"
#include "oracle/half_vector.h"
#include "oracle/math.h"
#include "oracle/phong.h"

namespace microlane::oracle {
namespace {

struct Call {
  const Real* in;
  Transport transport;
  int lobe_hint;
  Real* out;
  Real kappa = 1, direction_kappa = 1;
  double margin = std::numeric_limits<double>::infinity();
};

using Function = void (*)(Call&);

Vec Direction(const Real* in) { return {in[0], in[1], in[2]}; }

void Store(const Vec& v, Real* out) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

// Parameters, as they follow the per-lane inputs: alpha_x alpha_y, one alpha for both, or an exponent.
enum class Roughnesses { kAnisotropic, kIsotropic };

template <class Distribution, Roughnesses kRoughnesses = Roughnesses::kAnisotropic>
struct Maker {
  static constexpr std::size_t kParameters = kRoughnesses == Roughnesses::kAnisotropic ? 2 : 1;
  static Distribution Make(const Real* in) { return {{in[0], in[kParameters - 1]}}; }
};

template <>
struct Maker<Phong> {
  static constexpr std::size_t kParameters = 1;
  static Phong Make(const Real* in) { return {in[0]}; }
};

template <class M>
void D(Call& call) {
  call.out[0] = M::Make(call.in + 3).D(Direction(call.in));
}

template <class M>
void Lambda(Call& call) {
  call.out[0] = M::Make(call.in + 3).Lambda(Direction(call.in));
}

template <class M>
void G1(Call& call) {
  call.out[0] = M::Make(call.in + 6).G1(Direction(call.in), Direction(call.in + 3));
}

template <class Distribution>
void StoreNormal(const Distribution& distribution, Call& call) {
  const Vec m = distribution.SampleNormal(call.in[0], call.in[1]);
  Store(m, call.out);
  call.out[3] = distribution.D(m) * m.z;  // Walter 2007, Eq. 24
}

template <class M>
void SampleNormal(Call& call) {
  StoreNormal(M::Make(call.in + 2), call);
}

template <class M>
void DVisible(Call& call) {
  call.out[0] = M::Make(call.in + 6).DVisible(Direction(call.in), Direction(call.in + 3));
}

template <class M, bool kBounded>
void SampleVisibleNormal(Call& call) {
  const auto distribution = M::Make(call.in + 5);
  const Vec v = Direction(call.in);
  const Real k = kBounded ? CapBound(v, distribution.alpha) : Real(1);
  const CapNormal normal = VisibleNormal(v, call.in[3], call.in[4], distribution.alpha, k);
  Store(normal.m, call.out);
  call.out[3] = distribution.DVisible(v, normal.m) * (1 + normal.view.z) / (1 + k * normal.view.z);
  call.direction_kappa = CapCancellation(normal, distribution.alpha);
  const Real unstretched = CapCancellation(normal, {1, 1});
  call.kappa = call.direction_kappa > unstretched ? call.direction_kappa : unstretched;
}

// The rough dielectric by its place in kDielectricQuantities.
template <class M, std::size_t kQuantity>
void Dielectric(Call& call) {
  constexpr DielectricQuantity row = kDielectricQuantities[kQuantity];
  constexpr int lobes = (row.reflects ? kReflection : 0) | (row.transmits ? kTransmission : 0);
  constexpr bool one_lobe_sampled = row.what == DielectricQuantity::kSample && !row.HasBothLobes();
  const Real* const parameters = call.in + (one_lobe_sampled ? 5 : 6);
  using Distribution = decltype(M::Make(parameters));
  const RoughDielectric<Distribution> bsdf{M::Make(parameters), parameters[M::kParameters],
                                           row.separable ? Masking::kSeparable : Masking::kCorrelated,
                                           call.transport};
  const Vec wi = Direction(call.in);
  if constexpr (row.what == DielectricQuantity::kSample) {
    const DirectionSample sample = bsdf.Sample(
        wi, call.in[3], call.in[4], one_lobe_sampled ? Real(0) : call.in[5], lobes, call.lobe_hint);
    Store(sample.wo, call.out);
    call.out[3] = sample.weight;
    call.out[4] = sample.pdf;
    call.out[5] = sample.lobe;
    call.kappa = sample.kappa;
    call.direction_kappa = sample.direction_kappa;
    call.margin = sample.margin;
  } else {
    const Vec wo = Direction(call.in + 3);
    if constexpr (row.HasValue()) call.out[0] = bsdf.EvalCos(wi, wo, lobes);
    if constexpr (row.what != DielectricQuantity::kEval) {
      call.out[row.HasValue() ? 1 : 0] = bsdf.Pdf(wi, wo, lobes);
    }
  }
}

struct Entry {
  std::string_view id;
  Function function;
};

using GgxXy = Maker<Ggx>;
using GgxIsotropic = Maker<Ggx, Roughnesses::kIsotropic>;
using BeckmannXy = Maker<Beckmann>;
using BeckmannIsotropic = Maker<Beckmann, Roughnesses::kIsotropic>;
using PhongExp = Maker<Phong>;

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

    {"ggx.D", D<GgxXy>},
    {"ggx.D_isotropic", D<GgxIsotropic>},
    {"ggx.Lambda", Lambda<GgxXy>},
    {"ggx.Lambda_isotropic", Lambda<GgxIsotropic>},
    {"ggx.G1", G1<GgxXy>},
    {"ggx.G1_isotropic", G1<GgxIsotropic>},
    {"ggx.sample_normal", SampleNormal<GgxXy>},
    {"ggx.D_visible", DVisible<GgxXy>},
    {"ggx.sample_visible_normal", SampleVisibleNormal<GgxXy, false>},
    {"ggx.sample_visible_normal_bounded", SampleVisibleNormal<GgxXy, true>},

    {"beckmann.D", D<BeckmannXy>},
    {"beckmann.D_isotropic", D<BeckmannIsotropic>},
    {"beckmann.Lambda", Lambda<BeckmannXy>},
    {"beckmann.Lambda_isotropic", Lambda<BeckmannIsotropic>},
    {"beckmann.G1", G1<BeckmannXy>},
    {"beckmann.G1_isotropic", G1<BeckmannIsotropic>},
    {"beckmann.G1_rational",
     [](Call& call) {
       call.out[0] = BeckmannXy::Make(call.in + 6).G1Rational(Direction(call.in), Direction(call.in + 3));
     }},
    {"beckmann.sample_normal", SampleNormal<BeckmannXy>},
    {"beckmann.sample_normal_widened",
     [](Call& call) { StoreNormal(Widened(BeckmannXy::Make(call.in + 3), call.in[2]), call); }},

    {"phong.exponent", [](Call& call) { call.out[0] = PhongExponent(call.in[0]); }},
    {"phong.D", D<PhongExp>},
    {"phong.G1", G1<PhongExp>},
    {"phong.sample_normal", SampleNormal<PhongExp>},

    {"fresnel.dielectric", [](Call& call) { call.out[0] = FresnelDielectric(call.in[0], call.in[1]); }},
    {"fresnel.dielectric_transmittance",
     [](Call& call) { call.out[0] = 1 - FresnelDielectric(call.in[0], call.in[1]); }},
    {"fresnel.dielectric_s", [](Call& call) { call.out[0] = FresnelDielectricS(call.in[0], call.in[1]); }},
    {"fresnel.dielectric_p", [](Call& call) { call.out[0] = FresnelDielectricP(call.in[0], call.in[1]); }},

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
};

struct Resolved {
  Function function = nullptr;
  std::size_t num_inputs = 0;
  std::size_t num_outputs = 0;
  Metric metric[kMaxOutputs] = {};
};

template <class M, std::size_t... kQuantity>
constexpr void AddDielectrics(std::array<Resolved, kNumKernels>& table, Normals normals,
                              std::index_sequence<kQuantity...>) {
  ((table[DielectricKernel(normals, kQuantity)].function = Dielectric<M, kQuantity>), ...);
}

constexpr std::array<Resolved, kNumKernels> Resolve() {
  std::array<Resolved, kNumKernels> table{};
  for (std::size_t k = 0; k < kNumKernels; ++k) {
    const Names outputs = Split(kKernels[k].outputs);
    table[k].num_inputs = Split(kKernels[k].inputs).count;
    table[k].num_outputs = outputs.count;
    for (std::size_t i = 0; i < outputs.count; ++i)
      table[k].metric[i] = MetricOf(kKernels[k], outputs.name[i]);
    for (const Entry& entry : kEntries) {
      if (entry.id == kKernels[k].id) table[k].function = entry.function;
    }
  }
  constexpr auto quantities = std::make_index_sequence<kNumDielectricQuantities>();
  AddDielectrics<GgxXy>(table, Normals::kGgx, quantities);
  AddDielectrics<BeckmannXy>(table, Normals::kBeckmann, quantities);
  AddDielectrics<PhongExp>(table, Normals::kPhong, quantities);
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

Result Evaluate(std::size_t kernel, const Real* inputs, Transport transport, int lobe_hint) {
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
  Call call{inputs, transport, lobe_hint, result.exact};
  resolved.function(call);
  result.margin = call.margin;
  for (std::size_t i = 0; i < resolved.num_outputs; ++i) {
    result.scale[i] = Scale(resolved.metric[i], result.exact[i], call.kappa, call.direction_kappa);
  }
  return result;
}

Result Evaluate(std::size_t kernel, const double* inputs, Transport transport, int lobe_hint) {
  Real real_inputs[kMaxInputs];
  for (std::size_t i = 0; i < kTable[kernel].num_inputs; ++i) real_inputs[i] = inputs[i];
  return Evaluate(kernel, real_inputs, transport, lobe_hint);
}

bool HasKernel(std::size_t kernel) { return kernel < kNumKernels && kTable[kernel].function != nullptr; }

}  // namespace microlane::oracle
