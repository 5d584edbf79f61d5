// The row `reassociated` of the stiff and extreme cases: lane functions in someone else's translation unit,
// built with -O3 and with products and sums contracted as GCC does by default, beside the library's own.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O3", "fp-contract=fast")
#endif

#include <cstddef>
#include <string_view>
#include <utility>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reassociated_test.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/beckmann-inl.h"
#include "microlane/conductor-inl.h"
#include "microlane/fresnel-inl.h"
#include "microlane/gaussian-inl.h"
#include "microlane/ggx-inl.h"
#include "microlane/half_vector-inl.h"
#include "microlane/masking-inl.h"
#include "microlane/phong-inl.h"
#include "microlane/student_t-inl.h"
#include "src/distribution_kernels-inl.h"
#include "src/rough_diffuse_kernels-inl.h"
#include "src/rough_surface_kernels-inl.h"

#ifndef MICROLANE_TESTS_REASSOCIATED_CASE
#define MICROLANE_TESTS_REASSOCIATED_CASE
namespace microlane {
constexpr int kOrder = 3;  // of quadratures

struct Case {
  std::string_view id;
  void (*run)(const float* const* in, float* const* out, size_t n);
};
struct Cases {
  const Case* begin_;
  const Case* end_;
  const Case* begin() const { return begin_; }
  const Case* end() const { return end_; }
};
}  // namespace microlane
#endif

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

template <class Dist, Normals kNormals, NormalQuantity::What kWhat,
          RoughnessKind kRoughness = RoughnessKind::kAnisotropic>
using NormalCase =
    NormalQuantityKernel<Dist, NormalKernel(kNormals, kWhat, kRoughness) - kNumComponentKernels>;

template <FresnelPart kPart>
struct FresnelCase {
  static constexpr std::string_view kId = kPart == FresnelPart::kUnpolarised ? "fresnel.dielectric"
                                          : kPart == FresnelPart::kS         ? "fresnel.dielectric_s"
                                          : kPart == FresnelPart::kP         ? "fresnel.dielectric_p"
                                                                     : "fresnel.dielectric_transmittance";
  template <Accuracy A, class D>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, Vec<D> cos_i, Vec<D> eta) {
    out.v0 = FresnelDielectric<kPart, A>(d, cos_i, eta);
  }
};
struct ConductorCase {
  static constexpr std::string_view kId = "fresnel.conductor";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = FresnelConductor<A>(d, in...);
  }
};
struct SchlickCase {
  static constexpr std::string_view kId = "fresnel.schlick";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = FresnelSchlick<A>(d, in...);
  }
};
struct VCavityCase {
  static constexpr std::string_view kId = "masking.v_cavity";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = VCavityG1<A>(d, in...);
  }
};
struct SchlickSmithCase {
  static constexpr std::string_view kId = "masking.schlick_smith";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = SchlickSmithG1<A>(d, in...);
  }
};
struct KelemenCase {
  static constexpr std::string_view kId = "masking.kelemen";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = KelemenG1<A>(d, in...);
  }
};
template <JointForm kForm>
struct JointCase {
  static constexpr std::string_view kId = kForm == JointForm::kHeight ? "masking.height_correlated"
                                          : kForm == JointForm::kDirection
                                              ? "masking.direction_correlated"
                                              : "masking.height_direction_correlated";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = JointG2<kForm, A>(d, in...);
  }
};
struct TransmissionCase {
  static constexpr std::string_view kId = "masking.height_correlated_transmission";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = TransmissionG2(d, in...);
  }
};
struct HalfReflectionCase {
  static constexpr std::string_view kId = "half_vector.reflection";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    HalfVectorReflection<A>(d, out.v0, out.v1, out.v2, in...);
  }
};
struct HalfRefractionCase {
  static constexpr std::string_view kId = "half_vector.refraction";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    HalfVectorRefraction<A>(d, out.v0, out.v1, out.v2, in...);
  }
};
struct HalfJacobianCase {
  static constexpr std::string_view kId = "half_vector.refraction_jacobian";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = HalfVectorJacobian<A>(d, in...);
  }
};
struct HalfJacobianCosCase {
  static constexpr std::string_view kId = "half_vector.refraction_jacobian_cos";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    out.v0 = RefractionJacobian<A>(d, in...);
  }
};
struct ReflectCase {
  static constexpr std::string_view kId = "reflect";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    Reflect(d, out.v0, out.v1, out.v2, in...);
  }
};
struct RefractCase {
  static constexpr std::string_view kId = "refract";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    Refract<A>(d, out.v0, out.v1, out.v2, in...);
  }
};

constexpr std::size_t Quantity(std::string_view name) {
  std::size_t i = 0;
  while (kDielectricQuantities[i].name != name) ++i;
  return i;
}
template <class Dist, Normals kNormals, std::size_t kQuantity>
using DielectricCase = RoughDielectricKernel<Dist, kNormals, kQuantity>;
constexpr std::size_t kEval = Quantity("eval"), kEvalReflection = Quantity("eval_reflection"),
                      kEvalTransmission = Quantity("eval_transmission"),
                      kEvalSeparable = Quantity("eval_separable"), kPdf = Quantity("pdf"),
                      kPdfReflection = Quantity("pdf_reflection"),
                      kPdfTransmission = Quantity("pdf_transmission"), kEvalPdf = Quantity("eval_pdf"),
                      kSample = Quantity("sample"), kSampleReflection = Quantity("sample_reflection"),
                      kSampleTransmission = Quantity("sample_transmission");

template <class Dist, Normals kNormals, Reflector kReflector, DielectricQuantity::What kWhat,
          bool kVisible = false, DielectricQuantity::Joint kJoint = DielectricQuantity::kCorrelated>
using OpaqueCase =
    RoughReflectorKernel<Dist, ReflectorKernel(
                                   {kNormals, kReflector, FindReflectorQuantity(kWhat, kJoint, kVisible)})>;

template <class Dist, class Radius, Normals kNormals, Scatterer kScatterer, std::size_t kQuantity = 0>
using DiffuseCase = RoughDiffuseKernel<Dist, Radius, DiffuseKernel({kNormals, kScatterer, kQuantity})>;

// K over whole vectors; n is a multiple of every vector's lanes.
template <class K, size_t... kIn>
void OverVectors(const float* const* in, float* const* out, size_t n, std::index_sequence<kIn...>) {
  using D = hn::ScalableTag<float>;
  const D d;
  static const QuadratureRule rule(kOrder);
  const Options<D> options{RadianceMask(d, Transport::kRadiance), &rule};
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    Vec<D> w[6] = {hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d), hn::Zero(d)};
    const Outputs<D> outputs{w[0], w[1], w[2], w[3], w[4], w[5]};
    K::template Eval<Accuracy::kStandard>(d, options, outputs, hn::LoadU(d, in[kIn] + i)...);
    for (size_t k = 0; k < Shape<K>::kOut; ++k) hn::StoreU(w[k], d, out[k] + i);
  }
}
template <class K>
void Run(const float* const* in, float* const* out, size_t n) {
  OverVectors<K>(in, out, n, std::make_index_sequence<Shape<K>::kIn>());
}

template <class Op>
struct GaussianCase {
  static constexpr std::string_view kId = std::is_same_v<Op, GaussianNormalisationOp> ? "gaussian.C"
                                          : std::is_same_v<Op, GaussianDensityOp>
                                              ? "gaussian.D"
                                              : "gaussian.D_visible_v_cavity";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    Vec<D> unused;
    Precisely<Op, A>(d, out.v0, unused, in...);
  }
};
struct GaussianEvalVCavityCase {
  static constexpr std::string_view kId = "gaussian.eval_v_cavity";
  template <Accuracy, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    Vec<D> unused;
    InDouble2<InStandard<GaussianEvalVCavityOp>>(d, out.v0, unused, in...);
  }
};
struct GaussianSampleCase {
  static constexpr std::string_view kId = "gaussian.sample_normal";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    SampleGaussian<A>(d, out.v0, out.v1, out.v2, out.v3, in...);
  }
};

struct PhongLambdaCase {
  static constexpr std::string_view kId = "phong.Lambda";
  template <Accuracy A, class D, class... V>
  static void Eval(D d, const Options<D>&, const Outputs<D>& out, V... in) {
    Vec<D> unused;
    Precisely<typename PhongSmith<kIsFloat<D>>::LambdaOp, A>(d, out.v0, unused, in...);
  }
};

template <class... K>
Cases MakeCases() {
  static constexpr Case cases[] = {{K::kId, &Run<K>}...};
  return {cases, cases + sizeof...(K)};
}

// Every lane function with sums of products of its own.
Cases CasesOnTarget() {
  constexpr Normals ggx = Normals::kGgx, beckmann = Normals::kBeckmann, phong = Normals::kPhong,
                    student_t = Normals::kStudentT;
  return MakeCases<
      NormalCase<Ggx, ggx, NormalQuantity::kD>, NormalCase<Ggx, ggx, NormalQuantity::kLambda>,
      NormalCase<Ggx, ggx, NormalQuantity::kG1>, NormalCase<Ggx, ggx, NormalQuantity::kSampleNormal>,
      NormalCase<Ggx, ggx, NormalQuantity::kDVisible>, NormalCase<Ggx, ggx, NormalQuantity::kSampleVisible>,
      NormalCase<Ggx, ggx, NormalQuantity::kSampleVisibleBounded>,
      NormalCase<Ggx, ggx, NormalQuantity::kSampleReflection>,
      NormalCase<Ggx, ggx, NormalQuantity::kSampleReflectionBounded>,
      NormalCase<Ggx, ggx, NormalQuantity::kPdfReflectionBounded>,
      NormalCase<Ggx, ggx, NormalQuantity::kDVisibleVCavity>,
      NormalCase<Ggx, ggx, NormalQuantity::kSampleVCavity>,
      NormalCase<Beckmann, beckmann, NormalQuantity::kD>,
      NormalCase<Beckmann, beckmann, NormalQuantity::kLambda>,
      NormalCase<Beckmann, beckmann, NormalQuantity::kG1>,
      NormalCase<Beckmann, beckmann, NormalQuantity::kSampleNormal>,
      NormalCase<Beckmann, beckmann, NormalQuantity::kSampleVisible>,
      NormalCase<Beckmann, beckmann, NormalQuantity::kSampleReflection>,
      NormalCase<Phong, phong, NormalQuantity::kD, RoughnessKind::kExponent>,
      NormalCase<Phong, phong, NormalQuantity::kG1, RoughnessKind::kExponent>,
      NormalCase<Phong, phong, NormalQuantity::kSampleNormal, RoughnessKind::kExponent>, PhongLambdaCase,
      GaussianCase<GaussianNormalisationOp>, GaussianCase<GaussianDensityOp>, GaussianCase<GaussianVCavityOp>,
      GaussianEvalVCavityCase, GaussianSampleCase, NormalCase<StudentT<false>, student_t, NormalQuantity::kD>,
      NormalCase<StudentT<false>, student_t, NormalQuantity::kLambda>,
      NormalCase<StudentT<false>, student_t, NormalQuantity::kG1>,
      NormalCase<StudentT<false>, student_t, NormalQuantity::kSampleNormal>,
      NormalCase<StudentT<false>, student_t, NormalQuantity::kDVisible>,
      FresnelCase<FresnelPart::kUnpolarised>, FresnelCase<FresnelPart::kS>, FresnelCase<FresnelPart::kP>,
      FresnelCase<FresnelPart::kTransmittance>, ConductorCase, SchlickCase, VCavityCase, SchlickSmithCase,
      KelemenCase, JointCase<JointForm::kHeight>, JointCase<JointForm::kDirection>,
      JointCase<JointForm::kHeightDirection>, TransmissionCase, HalfReflectionCase, HalfRefractionCase,
      HalfJacobianCase, HalfJacobianCosCase, ReflectCase, RefractCase, DielectricCase<Ggx, ggx, kEval>,
      DielectricCase<Ggx, ggx, kEvalReflection>, DielectricCase<Ggx, ggx, kEvalTransmission>,
      DielectricCase<Ggx, ggx, kEvalSeparable>, DielectricCase<Ggx, ggx, kPdf>,
      DielectricCase<Ggx, ggx, kPdfReflection>, DielectricCase<Ggx, ggx, kPdfTransmission>,
      DielectricCase<Ggx, ggx, kSample>, DielectricCase<Ggx, ggx, kSampleReflection>,
      DielectricCase<Ggx, ggx, kSampleTransmission>, DielectricCase<Beckmann, beckmann, kEvalPdf>,
      DielectricCase<Beckmann, beckmann, kEvalReflection>, DielectricCase<Beckmann, beckmann, kSample>,
      DielectricCase<Phong, phong, kEvalPdf>, DielectricCase<Phong, phong, kEvalReflection>,
      DielectricCase<Phong, phong, kSample>,
      OpaqueCase<Ggx, ggx, Reflector::kMirror, DielectricQuantity::kEval>,
      OpaqueCase<Ggx, ggx, Reflector::kConductor, DielectricQuantity::kEvalPdf>,
      OpaqueCase<Ggx, ggx, Reflector::kSchlick, DielectricQuantity::kEvalPdf>,
      OpaqueCase<Ggx, ggx, Reflector::kConductor, DielectricQuantity::kSample>,
      OpaqueCase<Ggx, ggx, Reflector::kConductor, DielectricQuantity::kEvalPdf, true>,
      OpaqueCase<Ggx, ggx, Reflector::kConductor, DielectricQuantity::kSample, true>,
      OpaqueCase<Ggx, ggx, Reflector::kConductor, DielectricQuantity::kEvalPdf, false,
                 DielectricQuantity::kVCavity>,
      OpaqueCase<Ggx, ggx, Reflector::kConductor, DielectricQuantity::kSample, false,
                 DielectricQuantity::kVCavity>,
      OpaqueCase<Beckmann, beckmann, Reflector::kConductor, DielectricQuantity::kEval>,
      OpaqueCase<Phong, phong, Reflector::kSchlick, DielectricQuantity::kEval>,
      DiffuseCase<Ggx, GgxRadius, ggx, Scatterer::kLambertian>,
      DiffuseCase<Beckmann, BeckmannRadius, beckmann, Scatterer::kLambertian>,
      DiffuseCase<Ggx, GgxRadius, ggx, Scatterer::kInterfaced>,
      DiffuseCase<Ggx, GgxRadius, ggx, Scatterer::kInterfaced,
                  FindDiffuseQuantity(DielectricQuantity::kEvalNormal, DielectricQuantity::kCorrelated)>,
      DiffuseCase<Ggx, GgxRadius, ggx, Scatterer::kInterfaced,
                  FindDiffuseQuantity(DielectricQuantity::kPdf, DielectricQuantity::kCorrelated, true)>>();
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy.h"
#include "microlane/kernel_list.h"
#include "microlane/targets.h"
#include "points.h"

namespace microlane {
namespace {

HWY_EXPORT(CasesOnTarget);

std::vector<Point> PointsOf(std::size_t kernel) {
  std::vector<Point> points(20000);
  const RandomPoints random_points(kernel, 31);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = random_points(i);
  for (const ExtremeCase& extreme : ExtremeCases(kernel)) points.push_back(extreme.in);
  points.resize(points.size() / 64 * 64);
  const Names inputs = Split(kKernels[kernel].inputs);
  for (Point& point : points) {
    if (inputs.columns < inputs.count) point[inputs.columns] = kOrder;
  }
  return points;
}

std::vector<std::vector<float>> RunHere(const Case& one, const std::vector<Point>& points) {
  const std::size_t kernel = KernelIndex(one.id), n = points.size();
  std::vector<std::vector<float>> in(Split(kKernels[kernel].inputs).count, std::vector<float>(n));
  std::vector<std::vector<float>> out(Split(kKernels[kernel].outputs).count, std::vector<float>(n));
  std::vector<const float*> in_data;
  std::vector<float*> out_data;
  out_data.reserve(out.size());
  for (std::size_t k = 0; k < in.size(); ++k) {
    for (std::size_t j = 0; j < n; ++j) in[k][j] = static_cast<float>(points[j][k]);
    in_data.push_back(in[k].data());
  }
  for (std::vector<float>& values : out) out_data.push_back(values.data());
  one.run(in_data.data(), out_data.data(), n);
  return out;
}

// Lane functions built here give the bits of the batch calls, which other tests hold to the declared bounds.
// Sums of products are therefore written as MulAdd wherever contraction would reach the result.
TEST(Reassociated, LaneFunctionsGiveTheBitsOfTheLibrary) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const std::string name = hwy::TargetName(target);
    AccuracyOptions options;
    options.target = name;
    hwy::GetChosenTarget().Update(target);
    for (const Case& one : HWY_DYNAMIC_DISPATCH(CasesOnTarget)()) {
      const std::size_t kernel = KernelIndex(one.id);
      const std::vector<Point> points = PointsOf(kernel);
      const std::vector<std::vector<float>> here = RunHere(one, points);
      const auto library = Compute(kernel, options, points);
      std::size_t different = 0, where = 0;
      for (std::size_t j = 0; j < points.size(); ++j) {
        for (std::size_t i = 0; i < here.size(); ++i) {
          // To saturate is the batch call's part.
          if (!std::isfinite(here[i][j])) continue;
          const auto from_library = static_cast<float>(library[j][i]);
          const bool same =
              here[i][j] == from_library && std::signbit(here[i][j]) == std::signbit(from_library);
          if (!same && different++ == 0) where = j;
        }
      }
      std::printf("[points] reassociated %s %s: %zu points, %zu results with other bits\n",
                  std::string(one.id).c_str(), name.c_str(), points.size(), different);
      EXPECT_EQ(different, 0u) << one.id << " " << name << ", first at " << Describe(kernel, points[where]);
    }
  }
}

}  // namespace
}  // namespace microlane

#endif  // HWY_ONCE
