// The row `reassociated` of the stiff and extreme cases: lane functions in someone else's translation unit,
// built with -O3 and with products and sums contracted as GCC does by default, beside the library's own.
#if defined(__GNUC__) && !defined(__clang__)
#pragma GCC optimize("O3", "fp-contract=fast")
#endif

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "reassociated_test.cc"
#include "hwy/foreach_target.h"  // must stand before highway.h
#include "microlane/beckmann-inl.h"
#include "microlane/fresnel-inl.h"
#include "microlane/ggx-inl.h"
#include "microlane/half_vector-inl.h"
#include "microlane/rough_dielectric-inl.h"

HWY_BEFORE_NAMESPACE();
namespace microlane {
namespace HWY_NAMESPACE {
namespace {

// Runs op(d, in, out) over whole vectors; n is a multiple of every vector's lanes.
template <int kIn, int kOut, class Op>
void OverVectors(const float* const* in, float* const* out, size_t n, const Op& op) {
  const hn::ScalableTag<float> d;
  for (size_t i = 0; i < n; i += hn::Lanes(d)) {
    Vec<decltype(d)> v[kIn], w[kOut];
    for (int k = 0; k < kIn; ++k) v[k] = hn::LoadU(d, in[k] + i);
    op(d, v, w);
    for (int k = 0; k < kOut; ++k) hn::StoreU(w[k], d, out[k] + i);
  }
}

constexpr Accuracy kA = Accuracy::kStandard;

void GgxD(const float* const* in, float* const* out, size_t n) {
  OverVectors<5, 1>(in, out, n, [](auto d, const auto* v, auto* w) HWY_ATTR {
    w[0] = NormalDensity<Ggx, kA>(d, v[0], v[1], v[2], v[3], v[4]);
  });
}
void GgxLambda(const float* const* in, float* const* out, size_t n) {
  OverVectors<5, 1>(in, out, n, [](auto d, const auto* v, auto* w) HWY_ATTR {
    w[0] = Ggx::Lambda<kA>(d, v[0], v[1], v[2], v[3], v[4]);
  });
}
void BeckmannD(const float* const* in, float* const* out, size_t n) {
  OverVectors<5, 1>(in, out, n, [](auto d, const auto* v, auto* w) HWY_ATTR {
    w[0] = NormalDensity<Beckmann, kA>(d, v[0], v[1], v[2], v[3], v[4]);
  });
}
void Fresnel(const float* const* in, float* const* out, size_t n) {
  OverVectors<2, 1>(in, out, n, [](auto d, const auto* v, auto* w) HWY_ATTR {
    w[0] = FresnelDielectric<FresnelPart::kUnpolarised, kA>(d, v[0], v[1]);
  });
}
void HalfVector(const float* const* in, float* const* out, size_t n) {
  OverVectors<6, 3>(in, out, n, [](auto d, const auto* v, auto* w) HWY_ATTR {
    HalfVectorReflection<kA>(d, w[0], w[1], w[2], v[0], v[1], v[2], v[3], v[4], v[5]);
  });
}
void Eval(const float* const* in, float* const* out, size_t n) {
  OverVectors<9, 1>(in, out, n, [](auto d, const auto* v, auto* w) HWY_ATTR {
    const auto radiance = hn::Eq(hn::Zero(d), hn::Zero(d));
    auto unused = hn::Zero(d);
    RoughDielectric<Ggx, Lobes::kBoth, JointMasking::kHeightCorrelated, true, false, kA>(
        d, radiance, w[0], unused, v[0], v[1], v[2], v[3], v[4], v[5], v[8], v[6], v[7]);
  });
}

void BeckmannLambda(const float* const* in, float* const* out, size_t n) {
  OverVectors<5, 1>(in, out, n, [](auto d, const auto* v, auto* w) HWY_ATTR {
    w[0] = Beckmann::Lambda<kA>(d, v[0], v[1], v[2], v[3], v[4]);
  });
}
void Sample(const float* const* in, float* const* out, size_t n) {
  OverVectors<9, 6>(in, out, n, [](auto d, const auto* v, auto* w) HWY_ATTR {
    const auto radiance = hn::Eq(hn::Zero(d), hn::Zero(d));
    SampleRoughDielectric<Ggx, Lobes::kBoth, JointMasking::kHeightCorrelated, kA>(
        d, radiance, w[0], w[1], w[2], w[3], w[4], w[5], v[0], v[1], v[2], v[3], v[4], v[5], v[8], v[6],
        v[7]);
  });
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace microlane
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy.h"
#include "microlane/kernel_list.h"
#include "microlane/targets.h"
#include "oracle/oracle.h"
#include "points.h"
#include "ulp.h"

namespace microlane {
namespace {

HWY_EXPORT(GgxD);
HWY_EXPORT(GgxLambda);
HWY_EXPORT(BeckmannD);
HWY_EXPORT(Fresnel);
HWY_EXPORT(HalfVector);
HWY_EXPORT(Eval);
HWY_EXPORT(BeckmannLambda);
HWY_EXPORT(Sample);

struct Case {
  std::string_view id;
  void (*run)(const float* const* in, float* const* out, size_t n);  // on the target that Highway has chosen
};

const Case kCases[] = {
    {"ggx.D",
     [](const float* const* in, float* const* out, size_t n) { HWY_DYNAMIC_DISPATCH(GgxD)(in, out, n); }},
    {"ggx.Lambda", [](const float* const* in, float* const* out,
                      size_t n) { HWY_DYNAMIC_DISPATCH(GgxLambda)(in, out, n); }},
    {"beckmann.D", [](const float* const* in, float* const* out,
                      size_t n) { HWY_DYNAMIC_DISPATCH(BeckmannD)(in, out, n); }},
    {"beckmann.Lambda", [](const float* const* in, float* const* out,
                           size_t n) { HWY_DYNAMIC_DISPATCH(BeckmannLambda)(in, out, n); }},
    {"fresnel.dielectric",
     [](const float* const* in, float* const* out, size_t n) { HWY_DYNAMIC_DISPATCH(Fresnel)(in, out, n); }},
    {"half_vector.reflection", [](const float* const* in, float* const* out,
                                  size_t n) { HWY_DYNAMIC_DISPATCH(HalfVector)(in, out, n); }},
    {"rough_dielectric.eval",
     [](const float* const* in, float* const* out, size_t n) { HWY_DYNAMIC_DISPATCH(Eval)(in, out, n); }},
    {"rough_dielectric.sample",
     [](const float* const* in, float* const* out, size_t n) { HWY_DYNAMIC_DISPATCH(Sample)(in, out, n); }}};

std::vector<Point> PointsOf(std::size_t kernel) {
  std::vector<Point> points(20000);
  const RandomPoints random_points(kernel, 31);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = random_points(i);
  for (const ExtremeCase& extreme : ExtremeCases(kernel)) points.push_back(extreme.in);
  points.resize(points.size() / 64 * 64);
  return points;
}

std::vector<std::vector<float>> RunHere(const Case& one, std::int64_t target,
                                        const std::vector<Point>& points) {
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
  hwy::GetChosenTarget().Update(target);  // until Highway is next asked for its targets
  one.run(in_data.data(), out_data.data(), n);
  return out;
}

// Lane functions built here give the bits of the batch calls, and both stay within the declared bounds. Sums
// of products are therefore written as MulAdd wherever contraction would reach the result.
TEST(Reassociated, LaneFunctionsGiveTheBitsOfTheLibrary) {
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    const std::string name = hwy::TargetName(target);
    for (const Case& one : kCases) {
      const std::size_t kernel = KernelIndex(one.id);
      const bool samples = MetricOf(kKernels[kernel], "pdf") == Metric::kConditioned;
      AccuracyOptions options;
      options.target = name;
      const std::vector<Point> points = PointsOf(kernel);
      const std::vector<std::vector<float>> here = RunHere(one, target, points);
      const auto library = Compute(kernel, options, points);
      std::size_t different = 0, where = 0;
      double worst = 0;
      for (std::size_t j = 0; j < points.size(); ++j) {
        for (std::size_t i = 0; i < here.size(); ++i) {
          // To saturate is the batch call's part.
          if (!std::isfinite(here[i][j])) continue;
          const auto from_library = static_cast<float>(library[j][i]);
          const bool same =
              here[i][j] == from_library && std::signbit(here[i][j]) == std::signbit(from_library);
          if (!same && different++ == 0) where = j;
        }
        if (samples) continue;
        const oracle::Result truth = oracle::Evaluate(kernel, points[j].data());
        for (std::size_t i = 0; i < here.size(); ++i) {
          if (std::isfinite(here[i][j])) worst = std::max(worst, UlpError(here[i][j], truth.exact[i]));
        }
      }
      std::printf("[points] reassociated %s %s: %zu points, %zu results with other bits, max %.3g ulp\n",
                  std::string(one.id).c_str(), name.c_str(), points.size(), different, worst);
      EXPECT_EQ(different, 0u) << one.id << " " << name << ", first at " << Describe(kernel, points[where]);
      EXPECT_LE(worst, DeclaredBound(kernel, options)) << one.id << " " << name;
    }
  }
}

}  // namespace
}  // namespace microlane

#endif  // HWY_ONCE
