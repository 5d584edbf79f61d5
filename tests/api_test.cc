// The typed batch calls, the checked materials and the choice of a target.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "microlane/kernels.h"
#include "microlane/microlane.h"

namespace microlane {
namespace {

constexpr std::size_t kLanes = 67;

// Arguments by position, as the kernel list orders them.
template <class T>
struct Arguments {
  std::size_t n;
  std::vector<T> in[kMaxInputs];
  bool uniform[kMaxInputs] = {};
  std::vector<T> out[kMaxOutputs];
  Accuracy accuracy;
  Transport transport;

  const T* Lanes(int k) const { return in[k].data(); }
  Directions<T> Direction(int k) const { return {in[k].data(), in[k + 1].data(), in[k + 2].data()}; }
  Parameter<T> Value(int k) const { return uniform[k] ? Parameter<T>(in[k][0]) : Parameter<T>(in[k].data()); }
  T* Out(int k) { return out[k].data(); }
  MutableDirections<T> OutDirection(int k) { return {Out(k), Out(k + 1), Out(k + 2)}; }
  // Of the first lane.
  SpecularLobe Ward(int k) const {
    return WardLobe(static_cast<double>(in[k][0]), static_cast<double>(in[k + 1][0]));
  }
  template <Normals kNormals>
  DielectricParametersOf<kNormals, T> Surface(int k) const {
    if constexpr (kNormals == Normals::kPhong) {
      return {Value(k), Value(k + 1)};
    } else {
      return {Value(k), Value(k + 1), Value(k + 2)};
    }
  }
  template <Normals kNormals, Reflector kReflector>
  OpaqueSurface<kNormals, kReflector, T> Opaque(int k) const {
    const RoughnessOf<kNormals, T> roughness = [&]() -> RoughnessOf<kNormals, T> {
      if constexpr (kNormals == Normals::kPhong) return {Value(k)};
      if constexpr (kNormals != Normals::kPhong) return {Value(k), Value(k + 1)};
    }();
    const int facets = kNormals == Normals::kPhong ? k + 1 : k + 2;
    if constexpr (kReflector == Reflector::kMirror) {
      return {roughness, {}};
    } else if constexpr (kReflector == Reflector::kConductor) {
      return {roughness, {Value(facets), Value(facets + 1)}};
    } else {
      return {roughness, {Value(facets)}};
    }
  }
  DielectricSamples<T> Samples() { return {OutDirection(0), Out(3), Out(4), Out(5)}; }
};

template <class T>
struct Row {
  std::string_view id;
  void (*run)(Arguments<T>& a);
};

// The typed function of a quantity of the rough dielectric.
template <class T, Normals kNormals, std::size_t kQuantity>
void RunDielectric(Arguments<T>& a) {
  using Calls = RoughDielectricCalls<kNormals>;
  constexpr DielectricQuantity row = kDielectricQuantities[kQuantity];
  constexpr JointMasking masking = row.joint == DielectricQuantity::kSeparable
                                       ? JointMasking::kSeparable
                                       : JointMasking::kHeightCorrelated;
  constexpr Sampling sampling = row.visible ? Sampling::kVisibleNormals : Sampling::kNormals;
  constexpr bool both = row.HasBothLobes(), reflects = row.reflects;
  const Directions<T> wi = a.Direction(0);
  if constexpr (row.what == DielectricQuantity::kSample) {
    const auto surface = a.template Surface<kNormals>(both ? 6 : 5);
    const T *const u1 = a.Lanes(3), *const u2 = a.Lanes(4);
    if constexpr (both) {
      Calls::Sample(a.n, wi, u1, u2, a.Lanes(5), surface, a.Samples(), a.accuracy, a.transport, masking,
                    sampling);
    } else if constexpr (reflects) {
      Calls::SampleReflection(a.n, wi, u1, u2, surface, a.Samples(), a.accuracy, masking, sampling);
    } else {
      Calls::SampleTransmission(a.n, wi, u1, u2, surface, a.Samples(), a.accuracy, a.transport, masking,
                                sampling);
    }
  } else {
    const auto surface = a.template Surface<kNormals>(6);
    const Directions<T> wo = a.Direction(3);
    if constexpr (row.what == DielectricQuantity::kEvalPdf) {
      Calls::EvalPdf(a.n, wi, wo, surface, a.Out(0), a.Out(1), a.accuracy, a.transport, masking, sampling);
    } else if constexpr (row.what == DielectricQuantity::kPdf) {
      if constexpr (both) Calls::Pdf(a.n, wi, wo, surface, a.Out(0), a.accuracy, sampling);
      if constexpr (!both && reflects)
        Calls::PdfReflection(a.n, wi, wo, surface, a.Out(0), a.accuracy, sampling);
      if constexpr (!both && !reflects)
        Calls::PdfTransmission(a.n, wi, wo, surface, a.Out(0), a.accuracy, sampling);
    } else if constexpr (both) {
      Calls::Eval(a.n, wi, wo, surface, a.Out(0), a.accuracy, a.transport, masking);
    } else if constexpr (reflects) {
      Calls::EvalReflection(a.n, wi, wo, surface, a.Out(0), a.accuracy, masking);
    } else {
      Calls::EvalTransmission(a.n, wi, wo, surface, a.Out(0), a.accuracy, a.transport, masking);
    }
  }
}

template <class T, Normals kNormals, std::size_t... kQuantity>
void AppendDielectrics(std::vector<Row<T>>& rows, std::index_sequence<kQuantity...>) {
  (rows.push_back(
       {kKernels[DielectricKernel(kNormals, kQuantity)].id, RunDielectric<T, kNormals, kQuantity>}),
   ...);
}

// The typed function of a kernel of an opaque surface.
template <class T, std::size_t kKernel>
void RunReflector(Arguments<T>& a) {
  constexpr ReflectorKernelPlace place = PlaceOfReflectorKernel(kKernel);
  using Calls = RoughReflectorCalls<place.normals, place.reflector>;
  constexpr DielectricQuantity row = kReflectorQuantities[place.quantity];
  constexpr JointMasking masking = row.joint == DielectricQuantity::kSeparable
                                       ? JointMasking::kSeparable
                                       : JointMasking::kHeightCorrelated;
  constexpr Sampling sampling = row.visible ? Sampling::kVisibleNormals : Sampling::kNormals;
  constexpr bool samples = row.what == DielectricQuantity::kSample;
  constexpr bool v_cavity = row.joint == DielectricQuantity::kVCavity;
  const auto surface = a.template Opaque<place.normals, place.reflector>(samples && !v_cavity ? 5 : 6);
  const Directions<T> wi = a.Direction(0);
  constexpr bool kelemen = row.joint == DielectricQuantity::kKelemen;
  if constexpr (kelemen && samples) {
    Calls::SampleKelemen(a.n, wi, a.Lanes(3), a.Lanes(4), surface, a.Samples(), a.accuracy);
  } else if constexpr (kelemen && row.what == DielectricQuantity::kEvalPdf) {
    Calls::EvalPdfKelemen(a.n, wi, a.Direction(3), surface, a.Out(0), a.Out(1), a.accuracy);
  } else if constexpr (kelemen) {
    Calls::EvalKelemen(a.n, wi, a.Direction(3), surface, a.Out(0), a.accuracy);
  } else if constexpr (v_cavity && samples) {
    Calls::SampleVCavity(a.n, wi, a.Lanes(3), a.Lanes(4), a.Lanes(5), surface, a.Samples(), a.accuracy);
  } else if constexpr (v_cavity && row.what == DielectricQuantity::kEvalPdf) {
    Calls::EvalPdfVCavity(a.n, wi, a.Direction(3), surface, a.Out(0), a.Out(1), a.accuracy);
  } else if constexpr (v_cavity) {
    Calls::EvalVCavity(a.n, wi, a.Direction(3), surface, a.Out(0), a.accuracy);
  } else if constexpr (samples) {
    Calls::Sample(a.n, wi, a.Lanes(3), a.Lanes(4), surface, a.Samples(), a.accuracy, masking, sampling);
  } else if constexpr (row.what == DielectricQuantity::kEvalPdf) {
    Calls::EvalPdf(a.n, wi, a.Direction(3), surface, a.Out(0), a.Out(1), a.accuracy, masking, sampling);
  } else {
    Calls::Eval(a.n, wi, a.Direction(3), surface, a.Out(0), a.accuracy, masking);
  }
}

template <class T, std::size_t... kPlace>
void AppendReflectors(std::vector<Row<T>>& rows, std::index_sequence<kPlace...>) {
  (rows.push_back(
       {kKernels[kFirstReflectorKernel + kPlace].id, RunReflector<T, kFirstReflectorKernel + kPlace>}),
   ...);
}

// The typed function of a kernel of facets that scatter, of sums with the first lane's order.
template <class T, std::size_t kKernel>
void RunDiffuse(Arguments<T>& a) {
  constexpr DiffuseKernelPlace place = PlaceOfDiffuseKernel(kKernel);
  constexpr DielectricQuantity row = kDiffuseQuantities[place.quantity];
  constexpr bool interfaced = place.scatterer == Scatterer::kInterfaced;
  constexpr JointMasking masking = row.joint == DielectricQuantity::kSeparable
                                       ? JointMasking::kSeparable
                                       : JointMasking::kHeightCorrelated;
  constexpr Names inputs = Split(kKernels[kKernel].inputs);
  constexpr std::size_t first = inputs.per_lane;
  const RoughnessOf<place.normals, T> roughness{a.Value(first), a.Value(first + 1)};
  const Directions<T> wi = a.Direction(0), wo = a.Direction(3);
  if constexpr (row.what == DielectricQuantity::kSample) {
    InterfacedBodyCalls<place.normals>::SampleWithInterface(
        a.n, wi, a.Lanes(3), a.Lanes(4), a.Lanes(5), a.Lanes(6), a.Lanes(7), roughness,
        {a.Value(first + 2), a.Value(first + 3)}, a.Samples(), a.accuracy);
  } else if constexpr (row.what == DielectricQuantity::kPdf) {
    InterfacedBodyCalls<place.normals>::PdfWithInterface(
        a.n, wi, wo, roughness, {a.Value(first + 2), a.Value(first + 3)}, a.Out(0), a.accuracy);
  } else if constexpr (row.what == DielectricQuantity::kEvalNormal) {
    constexpr Sampling sampling = row.visible ? Sampling::kVisibleNormals : Sampling::kNormals;
    if constexpr (interfaced) {
      InterfacedBodyCalls<place.normals>::EvalOneNormal(a.n, wi, wo, a.Direction(6), roughness,
                                                        {a.Value(first + 2), a.Value(first + 3)}, a.Out(0),
                                                        a.accuracy, masking, sampling);
    } else {
      RoughDiffuseCalls<place.normals>::EvalOneNormal(a.n, wi, wo, a.Direction(6), roughness, a.Out(0),
                                                      a.accuracy, masking, sampling);
    }
  } else {
    const QuadratureRule rule(static_cast<double>(a.in[inputs.columns][0]));
    if constexpr (interfaced) {
      InterfacedBodyCalls<place.normals>::Eval(a.n, wi, wo, roughness,
                                               {a.Value(first + 2), a.Value(first + 3)}, rule, a.Out(0),
                                               a.accuracy, masking);
    } else {
      RoughDiffuseCalls<place.normals>::Eval(a.n, wi, wo, roughness, rule, a.Out(0), a.accuracy, masking);
    }
  }
}

template <class T, std::size_t... kPlace>
void AppendDiffuse(std::vector<Row<T>>& rows, std::index_sequence<kPlace...>) {
  (rows.push_back({kKernels[kFirstDiffuseKernel + kPlace].id, RunDiffuse<T, kFirstDiffuseKernel + kPlace>}),
   ...);
}

// The typed function of a mean over visible normals, with the first lane's order.
template <class T, std::size_t kKernel>
void RunMeanFresnel(Arguments<T>& a) {
  constexpr ModelKernelPlace place = PlaceOfMeanFresnelKernel(kKernel);
  using Calls = MeanFresnelCalls<place.normals>;
  if constexpr (place.quantity == MeanFresnelQuantity::kCosine) {
    Calls::Cosine(a.n, a.Lanes(0), a.Value(1), a.Out(0), a.accuracy);
  } else {
    constexpr std::size_t kOrder = Split(kKernels[kKernel].inputs).columns;
    const QuadratureRule rule(static_cast<double>(a.in[kOrder][0]));
    if constexpr (place.quantity == MeanFresnelQuantity::kDielectric) {
      Calls::Dielectric(a.n, a.Direction(0), {a.Value(3), a.Value(4)}, a.Value(5), rule, a.Out(0),
                        a.accuracy);
    } else if constexpr (place.quantity == MeanFresnelQuantity::kConductor) {
      Calls::Conductor(a.n, a.Direction(0), {a.Value(3), a.Value(4)}, {a.Value(5), a.Value(6)}, rule,
                       a.Out(0), a.accuracy);
    } else {
      Calls::Schlick(a.n, a.Direction(0), {a.Value(3), a.Value(4)}, {a.Value(5)}, rule, a.Out(0), a.accuracy);
    }
  }
}

template <class T, std::size_t... kPlace>
void AppendMeanFresnel(std::vector<Row<T>>& rows, std::index_sequence<kPlace...>) {
  (rows.push_back(
       {kKernels[kFirstMeanFresnelKernel + kPlace].id, RunMeanFresnel<T, kFirstMeanFresnelKernel + kPlace>}),
   ...);
}

template <Normals kNormals>
using NormalCallsOf = std::conditional_t<
    kNormals == Normals::kGgx, ggx,
    std::conditional_t<
        kNormals == Normals::kBeckmann, beckmann,
        std::conditional_t<kNormals == Normals::kStudentT, student_t,
                           std::conditional_t<kNormals == Normals::kTabulated, tabulated, phong>>>>;

// The typed function of a quantity of a distribution with parameters p.
template <class T, std::size_t kPlace, class... P>
void CallNormals(Arguments<T>& a, const P&... p) {
  constexpr NormalRow row = kNormalRows[kNormalKernelPlaces[kPlace].row];
  using Calls = NormalCallsOf<row.normals>;
  if constexpr (row.what == NormalQuantity::kD) {
    Calls::D(a.n, a.Direction(0), p..., a.Out(0), a.accuracy);
  } else if constexpr (row.what == NormalQuantity::kLambda) {
    Calls::Lambda(a.n, a.Direction(0), p..., a.Out(0), a.accuracy);
  } else if constexpr (row.what == NormalQuantity::kG1) {
    Calls::G1(a.n, a.Direction(0), a.Direction(3), p..., a.Out(0), a.accuracy);
  } else if constexpr (row.what == NormalQuantity::kDVisible) {
    Calls::DVisible(a.n, a.Direction(0), a.Direction(3), p..., a.Out(0), a.accuracy);
  } else if constexpr (row.what == NormalQuantity::kDVisibleVCavity) {
    Calls::DVisibleVCavity(a.n, a.Direction(0), a.Direction(3), p..., a.Out(0), a.accuracy);
  } else if constexpr (row.what == NormalQuantity::kSampleVCavity) {
    Calls::SampleVisibleNormalVCavity(a.n, a.Direction(0), a.Lanes(3), a.Lanes(4), a.Lanes(5), p...,
                                      a.OutDirection(0), a.Out(3), a.accuracy);
  } else if constexpr (row.what == NormalQuantity::kSampleNormal) {
    Calls::SampleNormal(a.n, a.Lanes(0), a.Lanes(1), p..., a.OutDirection(0), a.Out(3), a.accuracy);
  } else if constexpr (row.what == NormalQuantity::kSampleVisible) {
    Calls::SampleVisibleNormal(a.n, a.Direction(0), a.Lanes(3), a.Lanes(4), p..., a.OutDirection(0), a.Out(3),
                               a.accuracy);
  } else if constexpr (row.what == NormalQuantity::kSampleReflection) {
    Calls::SampleVisibleReflection(a.n, a.Direction(0), a.Lanes(3), a.Lanes(4), p..., a.OutDirection(0),
                                   a.Out(3), a.Out(4), a.Out(5), a.accuracy);
  } else if constexpr (row.what == NormalQuantity::kSampleReflectionBounded) {
    Calls::SampleVisibleReflectionBounded(a.n, a.Direction(0), a.Lanes(3), a.Lanes(4), p...,
                                          a.OutDirection(0), a.Out(3), a.Out(4), a.Out(5), a.accuracy);
  } else if constexpr (row.what == NormalQuantity::kPdfReflection) {
    Calls::PdfVisibleReflection(a.n, a.Direction(0), a.Direction(3), p..., a.Out(0), a.accuracy);
  } else if constexpr (row.what == NormalQuantity::kPdfReflectionBounded) {
    Calls::PdfVisibleReflectionBounded(a.n, a.Direction(0), a.Direction(3), p..., a.Out(0), a.accuracy);
  } else {
    Calls::SampleVisibleNormalBounded(a.n, a.Direction(0), a.Lanes(3), a.Lanes(4), p..., a.OutDirection(0),
                                      a.Out(3), a.accuracy);
  }
}

template <class T, std::size_t kPlace, std::size_t... kParameter>
void AppendNormals(std::vector<Row<T>>& rows, std::index_sequence<kParameter...>) {
  constexpr NormalKernelPlace place = kNormalKernelPlaces[kPlace];
  if constexpr (kNormalRows[place.row].what != NormalQuantity::kOwn) {
    static constexpr int first =
        static_cast<int>(Split(kNormalQuantities[kNormalRows[place.row].what].lanes).count);
    rows.push_back({kNormalText[kPlace].id.view(), [](Arguments<T>& a) {
                      if constexpr (kNormalRows[place.row].normals == Normals::kTabulated) {
                        // Of the first lane's values.
                        double tail =
                            static_cast<double>(a.in[first + static_cast<int>(sizeof...(kParameter))][0]);
                        const auto table = std::static_pointer_cast<const RadialTable>(
                            Prepare(kNumComponentKernels + kPlace, &tail));
                        CallNormals<T, kPlace>(a, *table, a.Value(first + static_cast<int>(kParameter))...);
                      } else {
                        CallNormals<T, kPlace>(a, a.Value(first + static_cast<int>(kParameter))...);
                      }
                    }});
  }
}
template <class T, std::size_t... kPlace>
void AppendAllNormals(std::vector<Row<T>>& rows, std::index_sequence<kPlace...>) {
  (AppendNormals<T, kPlace>(rows,
                            std::make_index_sequence<Split(kNormalText[kPlace].inputs.view()).columns -
                                                     Split(kNormalText[kPlace].inputs.view()).per_lane>()),
   ...);
}

// Every typed function.
template <class T>
const std::vector<Row<T>>& Rows() {
  using A = Arguments<T>;
  // clang-format off
  static const std::vector<Row<T>> components = {
      {"beckmann.G1_rational", [](A& a) { beckmann::G1Rational(a.n, a.Direction(0), a.Direction(3), a.Value(6), a.Value(7), a.Out(0), a.accuracy); }},
      {"beckmann.sample_normal_widened", [](A& a) { beckmann::SampleNormalWidened(a.n, a.Lanes(0), a.Lanes(1), a.Lanes(2), a.Value(3), a.Value(4), a.OutDirection(0), a.Out(3), a.accuracy); }},

      {"phong.Lambda", [](A& a) { phong::Lambda(a.n, a.Direction(0), a.Value(3), a.Out(0), a.accuracy); }},
      {"phong.G1_smith", [](A& a) { phong::G1Smith(a.n, a.Direction(0), a.Direction(3), a.Value(6), a.Out(0), a.accuracy); }},
      {"phong.exponent", [](A& a) { phong::Exponent(a.n, a.Lanes(0), a.Out(0), a.accuracy); }},

      {"gaussian.C", [](A& a) { gaussian::C(a.n, a.Lanes(0), a.Out(0), a.accuracy); }},
      {"gaussian.D", [](A& a) { gaussian::D(a.n, a.Direction(0), a.Value(3), a.Out(0), a.accuracy); }},
      {"gaussian.D_visible_v_cavity", [](A& a) { gaussian::DVisibleVCavity(a.n, a.Direction(0), a.Direction(3), a.Value(6), a.Out(0), a.accuracy); }},
      {"gaussian.eval_v_cavity", [](A& a) { gaussian::EvalVCavity(a.n, a.Direction(0), a.Direction(3), a.Value(6), a.Out(0), a.accuracy); }},
      {"gaussian.sample_normal", [](A& a) { gaussian::SampleNormal(a.n, a.Lanes(0), a.Lanes(1), a.Value(2), a.OutDirection(0), a.Out(3), a.accuracy); }},

      {"fresnel.dielectric", [](A& a) { fresnel::Dielectric(a.n, a.Lanes(0), a.Value(1), a.Out(0), a.accuracy); }},
      {"fresnel.dielectric_transmittance", [](A& a) { fresnel::DielectricTransmittance(a.n, a.Lanes(0), a.Value(1), a.Out(0), a.accuracy); }},
      {"fresnel.dielectric_s", [](A& a) { fresnel::DielectricS(a.n, a.Lanes(0), a.Value(1), a.Out(0), a.accuracy); }},
      {"fresnel.dielectric_p", [](A& a) { fresnel::DielectricP(a.n, a.Lanes(0), a.Value(1), a.Out(0), a.accuracy); }},

      {"fresnel.conductor", [](A& a) { fresnel::Conductor(a.n, a.Lanes(0), a.Value(1), a.Value(2), a.Out(0), a.accuracy); }},
      {"fresnel.diffuse_external", [](A& a) { fresnel::DiffuseExternal(a.n, a.Lanes(0), a.Out(0), a.accuracy); }},
      {"fresnel.diffuse_internal", [](A& a) { fresnel::DiffuseInternal(a.n, a.Lanes(0), a.Out(0), a.accuracy); }},
      {"interfaced.facet_body", [](A& a) { interfaced::FacetBody(a.n, a.Lanes(0), a.Lanes(1), {a.Value(2), a.Value(3)}, a.Out(0), a.accuracy); }},
      {"fresnel.schlick", [](A& a) { fresnel::Schlick(a.n, a.Lanes(0), a.Value(1), a.Out(0), a.accuracy); }},

      {"half_vector.reflection", [](A& a) { half_vector::Reflection(a.n, a.Direction(0), a.Direction(3), a.OutDirection(0), a.accuracy); }},
      {"half_vector.reflection_jacobian", [](A& a) { half_vector::ReflectionJacobian(a.n, a.Direction(0), a.Direction(3), a.Out(0), a.accuracy); }},
      {"half_vector.reflection_jacobian_cos", [](A& a) { half_vector::ReflectionJacobian(a.n, a.Lanes(0), a.Out(0), a.accuracy); }},
      {"half_vector.refraction", [](A& a) { half_vector::Refraction(a.n, a.Direction(0), a.Direction(3), a.Value(6), a.OutDirection(0), a.accuracy); }},
      {"half_vector.refraction_jacobian", [](A& a) { half_vector::RefractionJacobian(a.n, a.Direction(0), a.Direction(3), a.Value(6), a.Out(0), a.accuracy); }},
      {"half_vector.refraction_jacobian_cos", [](A& a) { half_vector::RefractionJacobian(a.n, a.Lanes(0), a.Lanes(1), a.Value(2), a.Out(0), a.accuracy); }},
      {"reflect", [](A& a) { Reflect(a.n, a.Direction(0), a.Direction(3), a.OutDirection(0), a.accuracy); }},
      {"refract", [](A& a) { Refract(a.n, a.Direction(0), a.Direction(3), a.Value(6), a.OutDirection(0), a.accuracy); }},

      {"half_vector_density.ward", [](A& a) { half_vector_density::Ward(a.n, a.Direction(0), a.Value(3), a.Out(0), a.accuracy); }},
      {"half_vector_density.phong", [](A& a) { half_vector_density::Phong(a.n, a.Direction(0), a.Value(3), a.Out(0), a.accuracy); }},
      {"coupled.eval", [](A& a) { coupled::Eval(a.n, a.Direction(0), a.Direction(3), a.Value(6), AlbedoTable(a.Ward(7)), a.Out(0), a.accuracy); }},
      {"coupled.pdf", [](A& a) { coupled::Pdf(a.n, a.Direction(0), a.Direction(3), a.Value(6), AlbedoTable(a.Ward(7)), a.Out(0), a.accuracy); }},
      {"coupled.eval_pdf", [](A& a) { coupled::EvalPdf(a.n, a.Direction(0), a.Direction(3), a.Value(6), AlbedoTable(a.Ward(7)), a.Out(0), a.Out(1), a.accuracy); }},
      {"coupled.sample", [](A& a) { coupled::Sample(a.n, a.Direction(0), a.Lanes(3), a.Lanes(4), a.Lanes(5), a.Value(6), AlbedoTable(a.Ward(7)), a.Samples(), a.accuracy); }},
      {"albedo.directional", [](A& a) { albedo::Directional(a.n, a.Lanes(0), AlbedoTable(a.Ward(1)), a.Out(0), a.Out(1), a.accuracy); }},

      {"roughness.from_moments", [](A& a) { roughness::FromMoments(a.n, a.Lanes(0), a.Lanes(1), a.Lanes(2), a.Lanes(3), a.Lanes(4), a.Out(0), a.Out(1), a.Out(2), a.accuracy); }},
      {"roughness.to_moments", [](A& a) { roughness::ToMoments(a.n, a.Lanes(0), a.Lanes(1), a.Lanes(2), a.Lanes(3), a.Lanes(4), a.Out(0), a.Out(1), a.Out(2), a.accuracy); }},

      {"masking.v_cavity", [](A& a) { masking::VCavity(a.n, a.Direction(0), a.Direction(3), a.Out(0), a.accuracy); }},
      {"masking.implicit", [](A& a) { masking::Implicit(a.n, a.Direction(0), a.Direction(3), a.Out(0), a.accuracy); }},
      {"masking.schlick_smith", [](A& a) { masking::SchlickSmith(a.n, a.Direction(0), a.Direction(3), a.Value(6), a.Out(0), a.accuracy); }},
      {"masking.kelemen", [](A& a) { masking::Kelemen(a.n, a.Direction(0), a.Direction(3), a.Out(0), a.accuracy); }},
      {"masking.separable", [](A& a) { masking::Separable(a.n, a.Lanes(0), a.Lanes(1), a.Out(0), a.accuracy); }},
      {"masking.height_correlated", [](A& a) { masking::HeightCorrelated(a.n, a.Lanes(0), a.Lanes(1), a.Out(0), a.accuracy); }},
      {"masking.student_lambda", [](A& a) { masking::StudentLambda(a.n, a.Direction(0), a.Value(3), a.Value(4), a.Value(5), a.Out(0), a.accuracy); }},
      {"masking.direction_correlated", [](A& a) { masking::DirectionCorrelated(a.n, a.Lanes(0), a.Lanes(1), {a.Lanes(2), a.Lanes(3), nullptr}, {a.Lanes(4), a.Lanes(5), nullptr}, a.Out(0), a.accuracy); }},
      {"masking.height_correlated_transmission", [](A& a) { masking::HeightCorrelatedTransmission(a.n, a.Lanes(0), a.Lanes(1), a.Out(0), a.accuracy); }},
      {"masking.height_direction_correlated", [](A& a) { masking::HeightDirectionCorrelated(a.n, a.Lanes(0), a.Lanes(1), {a.Lanes(2), a.Lanes(3), nullptr}, {a.Lanes(4), a.Lanes(5), nullptr}, a.Out(0), a.accuracy); }},
  };
  // clang-format on
  static const std::vector<Row<T>> rows = [] {
    std::vector<Row<T>> all = components;
    AppendAllNormals(all, std::make_index_sequence<kNumNormalKernels>());
    AppendDielectrics<T, Normals::kGgx>(all,
                                        std::make_index_sequence<NumDielectricQuantities(Normals::kGgx)>());
    AppendDielectrics<T, Normals::kBeckmann>(
        all, std::make_index_sequence<NumDielectricQuantities(Normals::kBeckmann)>());
    AppendDielectrics<T, Normals::kPhong>(
        all, std::make_index_sequence<NumDielectricQuantities(Normals::kPhong)>());
    AppendReflectors(all, std::make_index_sequence<kNumReflectorKernels>());
    AppendDiffuse(all, std::make_index_sequence<kNumDiffuseKernels>());
    AppendMeanFresnel(all, std::make_index_sequence<kNumMeanFresnelKernels>());
    return all;
  }();
  return rows;
}

// Values over each input's domain: logarithmic for parameters, unit vectors for triples x, y, z.
template <class T>
Arguments<T> RandomArguments(const Names& inputs, std::size_t n, bool uniform, std::mt19937& random) {
  Arguments<T> arguments;
  arguments.n = n;
  std::uniform_real_distribution<double> unit(0, 1);
  std::normal_distribution<double> normal;
  for (std::size_t k = 0; k < inputs.count; ++k) {
    const std::string_view name = inputs.name[k];
    const Input& input = FindInput(name);
    arguments.uniform[k] = uniform && k >= inputs.per_lane;
    for (std::size_t i = 0; i < kLanes; ++i) {
      double value = input.low + (input.high - input.low) * unit(random);
      if (input.low > 0) value = input.low * std::pow(input.high / input.low, unit(random));
      if (name == "order") value = 3;
      if (name == "m") value = 0.3;
      if (name == "index") value = 1.7;
      if (name == "tail") value = 2.5;
      if (name == "exponent") value = std::pow(2e10, unit(random)) - 1;
      if (name.back() == 'x' && name.size() <= 3) value = normal(random);
      if ((name.back() == 'y' || name.back() == 'z') && name.size() <= 3) value = normal(random);
      arguments.in[k].push_back(static_cast<T>(value));
    }
  }
  for (std::size_t k = 0; k + 2 < inputs.count; ++k) {
    const std::string_view name = inputs.name[k];
    if (name.back() != 'x' || name.size() > 3) continue;
    for (std::size_t i = 0; i < kLanes; ++i) {
      T &x = arguments.in[k][i], &y = arguments.in[k + 1][i], &z = arguments.in[k + 2][i];
      const T length = std::hypot(x, y, z);
      x /= length;
      y /= length;
      z /= length;
    }
  }
  for (std::vector<T>& out : arguments.out) out.assign(kLanes, T{-1234});
  return arguments;
}

template <class T>
void RunById(std::size_t kernel, Arguments<T>& a) {
  Call<T> call;
  for (std::size_t k = 0; k < kMaxInputs; ++k) {
    call.in[k] = a.in[k].data();
    call.uniform[k] = a.uniform[k];
  }
  for (std::size_t k = 0; k < kMaxOutputs; ++k) call.out[k] = a.out[k].data();
  call.transport = a.transport;
  if constexpr (std::is_same_v<T, float>) {
    RunKernel(kernel, a.accuracy, call, a.n);
  } else {
    RunKernel(kernel, call, a.n);
  }
}

template <class T>
class TypedCalls : public ::testing::Test {};
using Types = ::testing::Types<float, double>;
TYPED_TEST_SUITE(TypedCalls, Types);

// The moments of Q^-1 / 2 come back as Q's parameters.
// Every channel of a conductor has the bits of a call of its own.
TEST(Fresnel, ChannelsAreSingleCalls) {
  const std::vector<float> cosines = {1, 0.9f, 0.5f, 0.1f, -0.3f, 1e-4f, 0};
  const std::vector<float> per_lane = {0.2f, 0.5f, 1, 1.5f, 3, 5, 9};
  for (const std::size_t channels : {std::size_t{1}, std::size_t{3}, std::size_t{16}}) {
    std::vector<Parameter<float>> index, kappa;
    std::vector<std::vector<float>> together(channels, std::vector<float>(cosines.size()));
    std::vector<float*> outputs;
    for (std::size_t c = 0; c < channels; ++c) {
      index.push_back(c % 4 == 1 ? Parameter<float>(per_lane.data())
                                 : Parameter<float>(0.2f + 0.3f * static_cast<float>(c)));
      kappa.push_back(c % 4 == 2 ? Parameter<float>(per_lane.data())
                                 : Parameter<float>(3.0f - 0.1f * static_cast<float>(c)));
      outputs.push_back(together[c].data());
    }
    fresnel::Conductor(cosines.size(), cosines.data(), channels, index.data(), kappa.data(), outputs.data());
    for (std::size_t c = 0; c < channels; ++c) {
      std::vector<float> alone(cosines.size());
      fresnel::Conductor(cosines.size(), cosines.data(), index[c], kappa[c], alone.data());
      EXPECT_EQ(alone, together[c]) << c;
      EXPECT_GT(alone[0], 0);
    }
  }
}

TEST(Material, SlopeMomentsBecomeRoughness) {
  const double ax = 0.3, ay = 0.05, r = -0.8;
  const SlopeRoughness rough(SlopeMoments{0.2, -1.5, ax * ax / 2, ay * ay / 2, r * ax * ay / 2});
  ASSERT_TRUE(rough.ok()) << rough.error();
  EXPECT_NEAR(rough.alpha_x(), ax, 1e-15);
  EXPECT_NEAR(rough.alpha_y(), ay, 1e-15);
  EXPECT_NEAR(rough.r_xy(), r, 1e-15);
  EXPECT_EQ(rough.mean_x(), 0.2);
  EXPECT_EQ(rough.mean_y(), -1.5);
  EXPECT_EQ(SlopeRoughness(0.3, 0.3, 1, 0, 0).error(), "r_xy = 1 is outside [-0.9999, 0.9999]");
  EXPECT_EQ(SlopeRoughness(0.3, 0.3, 0, 0, 17).error(), "mean_y = 17 is outside [-16, 16]");
  const SlopeRoughness degenerate(SlopeMoments{0, 0, 0.1, 0.1, 0.1});
  EXPECT_NE(degenerate.error().find("r_xy = "), std::string::npos);
  EXPECT_NE(SlopeRoughness(SlopeMoments{0, 0, -0.1, 0.1, 0}).error().find("variance_x = -0.1"),
            std::string::npos);
  EXPECT_TRUE(std::isnan(degenerate.alpha_x()));
}

TYPED_TEST(TypedCalls, CoverTheKernelListButItsMathematics) {
  for (const Kernel& kernel : kKernels) {
    int rows = 0;
    for (const Row<TypeParam>& row : Rows<TypeParam>()) rows += row.id == kernel.id ? 1 : 0;
    EXPECT_EQ(rows, kernel.id.substr(0, 5) == "math." ? 0 : 1) << kernel.id;
  }
}

TYPED_TEST(TypedCalls, GiveTheSameBitsAsTheKernelById) {
  std::mt19937 random(1);
  std::size_t points = 0;
  for (const Row<TypeParam>& row : Rows<TypeParam>()) {
    const std::size_t kernel = KernelIndex(row.id);
    ASSERT_LT(kernel, kNumKernels) << row.id;
    const Names inputs = Split(kKernels[kernel].inputs);
    for (const Accuracy accuracy : {Accuracy::kHigh, Accuracy::kStandard, Accuracy::kFast}) {
      for (const Transport transport : {Transport::kRadiance, Transport::kImportance}) {
        for (const bool uniform : {false, true}) {
          for (const std::size_t n : {std::size_t{0}, std::size_t{1}, std::size_t{16}, kLanes}) {
            Arguments<TypeParam> typed = RandomArguments<TypeParam>(inputs, n, uniform, random);
            typed.accuracy = accuracy;
            typed.transport = transport;
            Arguments<TypeParam> by_id = typed;
            row.run(typed);
            RunById(kernel, by_id);
            for (std::size_t k = 0; k < kMaxOutputs; ++k) {
              // NOLINTNEXTLINE(bugprone-suspicious-memory-comparison): encodings are compared.
              EXPECT_EQ(std::memcmp(typed.out[k].data(), by_id.out[k].data(), kLanes * sizeof(TypeParam)), 0)
                  << row.id << " output " << k << " accuracy " << static_cast<int>(accuracy) << " n " << n;
            }
            points += n;
          }
        }
      }
    }
  }
  std::printf("%zu points\n", points);
}

TEST(Parameters, ConvertFromLiteralsAndPointers) {
  const float x[] = {0.6f, 0}, y[] = {0, 0.6f}, z[] = {0.8f, 0.8f}, alphas[] = {0.25f, 0.25f};
  float uniform[2], per_lane[2], isotropic[2];
  ggx::D(2, {x, y, z}, 0.25, alphas, uniform);
  ggx::D(2, {x, y, z}, alphas, 0.25f, per_lane);
  ggx::D(2, {x, y, z}, alphas, isotropic);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(uniform[i], per_lane[i]);
    EXPECT_FLOAT_EQ(uniform[i], isotropic[i]);
  }
}

TEST(Materials, AcceptTheWholeDomainAndCarryItsValues) {
  for (const double alpha : {1e-5, static_cast<double>(1e-5f), 0.1, 100.0}) {
    for (const double eta : {0.25, 1.0, 1.5, 4.0}) {
      const RoughDielectricMaterial material(alpha, 0.5, eta);
      EXPECT_TRUE(material.ok()) << material.error();
      EXPECT_EQ(*material.Parameters<double>().alpha_x.data(), alpha);
      EXPECT_EQ(*material.Parameters<float>().alpha_y.data(), 0.5f);
      EXPECT_EQ(*material.Parameters<float>().eta.data(), static_cast<float>(eta));
    }
  }
  for (const double exponent : {0.0, 1.0, 2e10}) {
    const PhongDielectricMaterial material(exponent, 1.5);
    EXPECT_TRUE(material.ok()) << material.error();
    EXPECT_EQ(*material.Parameters<double>().exponent.data(), exponent);
  }
}

// EXTREMES: one-axis-zero.
TEST(Materials, NameParameterValueAndRangeOfAnError) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(RoughDielectricMaterial(0, 0.5, 1.5).error(), "alpha_x = 0 is outside [1e-05, 100]");
  EXPECT_EQ(RoughDielectricMaterial(0.5, -0.5, 1.5).error(), "alpha_y = -0.5 is outside [1e-05, 100]");
  EXPECT_EQ(RoughDielectricMaterial(0.5, 1e-6, 1.5).error(), "alpha_y = 1e-06 is outside [1e-05, 100]");
  EXPECT_EQ(RoughDielectricMaterial(0.5, kInfinity, 1.5).error(), "alpha_y = inf is outside [1e-05, 100]");
  EXPECT_EQ(RoughDielectricMaterial(0.5, 0.5, kNaN).error(), "eta = nan is outside [0.25, 4]");
  EXPECT_EQ(RoughDielectricMaterial(kNaN, 0.5, 0).error(),
            "alpha_x = nan is outside [1e-05, 100]; eta = 0 is outside [0.25, 4]");
  EXPECT_EQ(PhongDielectricMaterial(-1, 1.5).error(), "exponent = -1 is outside [0, 2e+10]");
  EXPECT_EQ(PhongDielectricMaterial(10, 5).error(), "eta = 5 is outside [0.25, 4]");
  EXPECT_TRUE(RoughConductorMaterial({{0.1, 0.2}, {0.2, 3.4}}).ok());
  EXPECT_EQ(
      RoughConductorMaterial({{0.1, 0}, {0.01, -1}}).error(),
      "alpha_y = 0 is outside [1e-05, 100]; n = 0.01 is outside [0.05, 10]; kappa = -1 is outside [0, 20]");
  EXPECT_EQ(RoughSchlickMaterial({{0.1, 0.1}, {1.5}}).error(), "f0 = 1.5 is outside [0, 1]");
  EXPECT_EQ(RoughMirrorMaterial({{101, 0.1}, {}}).error(), "alpha_x = 101 is outside [1e-05, 100]");
  using PhongMirror = OpaqueMaterial<Normals::kPhong, Reflector::kMirror>;
  EXPECT_EQ(PhongMirror({{-1.0}, {}}).error(), "exponent = -1 is outside [0, 2e+10]");
  EXPECT_FLOAT_EQ(*RoughConductorMaterial({{0.1, 0.2}, {0.2, 3.4}}).Surface<float>().facets.kappa.data(),
                  3.4f);
  EXPECT_EQ(CheckParameter("roughness", 0.5), "unknown parameter 'roughness'");
  EXPECT_EQ(CheckParameter("alpha", 0.5), "");
}

TEST(Materials, OfWrongParametersGiveNaN) {
  const RoughDielectricMaterial material(0, 0.5, 1.5);
  EXPECT_FALSE(material.ok());
  const float x = 0.6f, y = 0, z = 0.8f;
  float f_cos = 0;
  rough_dielectric::Eval(1, {&x, &y, &z}, {&x, &y, &z}, material.Parameters<float>(), &f_cos);
  EXPECT_TRUE(std::isnan(f_cos)) << f_cos;
}

class Targets : public ::testing::Test {
 protected:
  void TearDown() override {
    ChooseTarget(chosen_);
    unsetenv("MICROLANE_TARGET");
  }

 private:
  std::string chosen_ = ChosenTarget();
};

TEST_F(Targets, AreListedBestFirstAndChosenByNameInAnyCase) {
  const std::vector<std::string> targets = SupportedTargets();
  ASSERT_FALSE(targets.empty());
  for (const std::string& name : targets) {
    EXPECT_EQ(ChooseTarget(name), "");
    EXPECT_EQ(ChosenTarget(), name);
    std::string lower = name;
    for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    ChooseTarget("best");
    EXPECT_EQ(ChosenTarget(), targets[0]);
    EXPECT_EQ(ChooseTarget(lower), "");
    EXPECT_EQ(ChosenTarget(), name);
  }
}

TEST_F(Targets, AnUnknownNameIsAnErrorThatListsTheKnownOnes) {
  const std::vector<std::string> targets = SupportedTargets();
  ASSERT_EQ(ChooseTarget(targets.back()), "");
  const std::string error = ChooseTarget("no-such");
  EXPECT_NE(error.find("no-such"), std::string::npos) << error;
  for (const std::string& name : targets) EXPECT_NE(error.find(name), std::string::npos) << error;
  EXPECT_EQ(ChosenTarget(), targets.back()) << "the choice changed";
}

TEST_F(Targets, AnUnknownNameInTheEnvironmentIsReported) {
  unsetenv("MICROLANE_TARGET");
  EXPECT_EQ(TargetEnvironmentError(), "");
  setenv("MICROLANE_TARGET", SupportedTargets().back().c_str(), 1);
  EXPECT_EQ(TargetEnvironmentError(), "");
  setenv("MICROLANE_TARGET", "no-such", 1);
  const std::string error = TargetEnvironmentError();
  for (const char* part : {"MICROLANE_TARGET", "no-such"}) {
    EXPECT_NE(error.find(part), std::string::npos) << error;
  }
  for (const std::string& name : SupportedTargets()) EXPECT_NE(error.find(name), std::string::npos) << error;
}

// Writes the first choice of a process whose environment names `name`.
void WriteFirstChoice(const std::string& name) {
  setenv("MICROLANE_TARGET", name.c_str(), 1);
  std::fprintf(stderr, "first choice: %s.", ChosenTarget().c_str());
  std::exit(0);
}

// Each in a process of its own, since the environment is read once.
TEST(Environment, DecidesTheFirstChoiceAndAnUnknownNameLeavesTheBest) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const std::vector<std::string> targets = SupportedTargets();
  for (const std::string& name : targets) {
    EXPECT_EXIT(WriteFirstChoice(name), ::testing::ExitedWithCode(0), "first choice: " + name + "\\.");
  }
  EXPECT_EXIT(WriteFirstChoice("no-such"), ::testing::ExitedWithCode(0),
              "first choice: " + targets[0] + "\\.");
}

}  // namespace
}  // namespace microlane
