// Any entry of the kernel list by its index.
#ifndef MICROLANE_SCALAR_EVALUATE_H_
#define MICROLANE_SCALAR_EVALUATE_H_

#include <array>
#include <cstddef>
#include <string_view>
#include <utility>

#include "microlane/kernel_list.h"
#include "microlane/scalar/beckmann.h"
#include "microlane/scalar/direction.h"
#include "microlane/scalar/fresnel.h"
#include "microlane/scalar/ggx.h"
#include "microlane/scalar/half_vector.h"
#include "microlane/scalar/math.h"
#include "microlane/scalar/phong.h"
#include "microlane/scalar/rough_dielectric.h"

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

// How a distribution's parameters follow the other inputs.
template <class Real>
struct GgxXy {
  static constexpr std::size_t kParameters = 2;
  static Ggx<Real> Make(const Real* in) { return {in[0], in[1]}; }
};
template <class Real>
struct GgxIsotropic {
  static Ggx<Real> Make(const Real* in) { return {in[0], in[0]}; }
};
template <class Real>
struct BeckmannXy {
  static constexpr std::size_t kParameters = 2;
  static Beckmann<Real> Make(const Real* in) { return {in[0], in[1]}; }
};
template <class Real>
struct BeckmannIsotropic {
  static Beckmann<Real> Make(const Real* in) { return {in[0], in[0]}; }
};
template <class Real>
struct PhongExponentOnly {
  static constexpr std::size_t kParameters = 1;
  static Phong<Real> Make(const Real* in) { return {in[0]}; }
};

template <class Real, template <class> class Parameters>
struct NormalKernels {
  static void D(const Real* in, Real* out, Transport) { out[0] = Parameters<Real>::Make(in + 3).D(Load(in)); }
  static void Lambda(const Real* in, Real* out, Transport) {
    out[0] = scalar::Lambda(Parameters<Real>::Make(in + 3), Load(in));
  }
  static void G1(const Real* in, Real* out, Transport) {
    out[0] = scalar::G1(Parameters<Real>::Make(in + 6), Load(in), Load(in + 3));
  }
  static void DVisible(const Real* in, Real* out, Transport) {
    out[0] = scalar::DVisible(Parameters<Real>::Make(in + 6), Load(in), Load(in + 3));
  }
  template <bool kBounded>
  static void SampleVisible(const Real* in, Real* out, Transport) {
    Store(Parameters<Real>::Make(in + 5).SampleVisibleNormal(Load(in), in[3], in[4], kBounded), out);
  }
  static void Sample(const Real* in, Real* out, Transport) {
    Store(Parameters<Real>::Make(in + 2).SampleNormal(in[0], in[1]), out);
  }
};

template <Masking masking, template <class> class Distribution, class Real>
RoughDielectric<Distribution, Real, masking> MakeDielectric(const Distribution<Real>& distribution, Real eta,
                                                            Transport transport) {
  return {distribution, eta, transport};
}

// The rough dielectric by its place in kDielectricQuantities.
template <class Real, template <class> class Parameters, std::size_t kQuantity>
struct Dielectric {
  static constexpr DielectricQuantity kRow = kDielectricQuantities[kQuantity];
  static constexpr Lobes kLobes =
      static_cast<Lobes>((kRow.reflects ? kReflection : 0U) | (kRow.transmits ? kTransmission : 0U));

  static void Run(const Real* in, Real* out, Transport transport) {
    constexpr Masking masking = kRow.separable ? Masking::kSeparable : Masking::kHeightCorrelated;
    constexpr bool one_lobe_sampled = kRow.what == DielectricQuantity::kSample && !kRow.HasBothLobes();
    const Real* const parameters = in + (one_lobe_sampled ? 5 : 6);
    const auto dielectric = MakeDielectric<masking>(Parameters<Real>::Make(parameters),
                                                    parameters[Parameters<Real>::kParameters], transport);
    if constexpr (kRow.what == DielectricQuantity::kEval) {
      out[0] = dielectric.Eval(Load(in), Load(in + 3), kLobes);
    } else if constexpr (kRow.what == DielectricQuantity::kPdf) {
      out[0] = dielectric.Pdf(Load(in), Load(in + 3), kLobes);
    } else if constexpr (kRow.what == DielectricQuantity::kEvalPdf) {
      const auto value = dielectric.EvalAndPdf(Load(in), Load(in + 3));
      out[0] = value.f_cos;
      out[1] = value.pdf;
    } else {
      const auto sample = dielectric.Sample(Load(in), in[3], in[4], one_lobe_sampled ? 0 : in[5], kLobes);
      Store(sample.wo, out);
      out[3] = sample.weight;
      out[4] = sample.pdf;
      out[5] = IsNan(sample.weight) ? sample.weight : static_cast<Real>(static_cast<unsigned>(sample.lobe));
    }
  }
};

template <class Real>
struct Entry {
  std::string_view id;
  Function<Real> function;
};

template <class Real>
constexpr auto Entries() {
  using GgxNormals = NormalKernels<Real, GgxXy>;
  using GgxIsotropicNormals = NormalKernels<Real, GgxIsotropic>;
  using BeckmannNormals = NormalKernels<Real, BeckmannXy>;
  using BeckmannIsotropicNormals = NormalKernels<Real, BeckmannIsotropic>;
  using PhongNormals = NormalKernels<Real, PhongExponentOnly>;
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

      Entry<Real>{"ggx.D", GgxNormals::D},
      Entry<Real>{"ggx.D_isotropic", GgxIsotropicNormals::D},
      Entry<Real>{"ggx.Lambda", GgxNormals::Lambda},
      Entry<Real>{"ggx.Lambda_isotropic", GgxIsotropicNormals::Lambda},
      Entry<Real>{"ggx.G1", GgxNormals::G1},
      Entry<Real>{"ggx.G1_isotropic", GgxIsotropicNormals::G1},
      Entry<Real>{"ggx.sample_normal", GgxNormals::Sample},
      Entry<Real>{"ggx.D_visible", GgxNormals::DVisible},
      Entry<Real>{"ggx.sample_visible_normal", GgxNormals::template SampleVisible<false>},
      Entry<Real>{"ggx.sample_visible_normal_bounded", GgxNormals::template SampleVisible<true>},

      Entry<Real>{"beckmann.D", BeckmannNormals::D},
      Entry<Real>{"beckmann.D_isotropic", BeckmannIsotropicNormals::D},
      Entry<Real>{"beckmann.Lambda", BeckmannNormals::Lambda},
      Entry<Real>{"beckmann.Lambda_isotropic", BeckmannIsotropicNormals::Lambda},
      Entry<Real>{"beckmann.G1", BeckmannNormals::G1},
      Entry<Real>{"beckmann.G1_isotropic", BeckmannIsotropicNormals::G1},
      Entry<Real>{"beckmann.G1_rational",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = BeckmannXy<Real>::Make(in + 6).G1Rational(Load(in), Load(in + 3));
                  }},
      Entry<Real>{"beckmann.sample_normal", BeckmannNormals::Sample},
      Entry<Real>{"beckmann.sample_normal_widened",
                  [](const Real* in, Real* out, Transport) {
                    Store(BeckmannXy<Real>::Make(in + 3).Widened(in[2]).SampleNormal(in[0], in[1]), out);
                  }},

      Entry<Real>{"phong.exponent",
                  [](const Real* in, Real* out, Transport) { out[0] = PhongExponent(in[0]); }},
      Entry<Real>{"phong.D", PhongNormals::D},
      Entry<Real>{"phong.G1",
                  [](const Real* in, Real* out, Transport) {
                    out[0] = PhongG1(Phong<Real>{in[6]}, Load(in), Load(in + 3));
                  }},
      Entry<Real>{"phong.sample_normal", PhongNormals::Sample},

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
  };
}

template <class Real, template <class> class Parameters, std::size_t... kQuantity>
constexpr void AddDielectrics(std::array<Function<Real>, kNumKernels>& table, Normals normals,
                              std::index_sequence<kQuantity...>) {
  ((table[DielectricKernel(normals, kQuantity)] = Dielectric<Real, Parameters, kQuantity>::Run), ...);
}

// Functions in the order of kKernels; null where the list has an entry that this file has not.
template <class Real>
constexpr std::array<Function<Real>, kNumKernels> Resolve() {
  std::array<Function<Real>, kNumKernels> table{};
  for (const Entry<Real>& entry : Entries<Real>()) table[KernelIndex(entry.id)] = entry.function;
  constexpr auto quantities = std::make_index_sequence<kNumDielectricQuantities>();
  AddDielectrics<Real, GgxXy>(table, Normals::kGgx, quantities);
  AddDielectrics<Real, BeckmannXy>(table, Normals::kBeckmann, quantities);
  AddDielectrics<Real, PhongExponentOnly>(table, Normals::kPhong, quantities);
  return table;
}

template <class Real>
inline constexpr std::array<Function<Real>, kNumKernels> kTable = Resolve<Real>();

constexpr bool Complete() {
  for (const Function<float> function : kTable<float>) {
    if (function == nullptr) return false;
  }
  return true;
}
static_assert(Complete(), "every entry of the kernel list has its scalar function");

}  // namespace evaluate_internal

// Entry `kernel` of kKernels: inputs and outputs in the list's order. A NaN input makes every output NaN.
template <class Real>
void Evaluate(std::size_t kernel, const Real* inputs, Real* outputs,
              Transport transport = Transport::kRadiance) {
  evaluate_internal::kTable<Real>[kernel](inputs, outputs, transport);
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_EVALUATE_H_
