// Every kernel within its declared bound of the oracle, in every accuracy and on every target.
#include "accuracy.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>
#include <vector>

#include "microlane/kernel_list.h"
#include "microlane/rough_reflector.h"
#include "microlane/targets.h"
#include "oracle/oracle.h"
#include "points.h"
#include "ulp.h"

namespace microlane {
namespace {

// MICROLANE_LONG=1: at least 10^8 random points in all, and functions of one variable on every float.
bool LongRun() {
  const char* value = std::getenv("MICROLANE_LONG");
  return value != nullptr && std::string_view(value) != "0";
}

void Print(std::size_t kernel, const AccuracyOptions& options, const AccuracyReport& report) {
  std::printf("[points] %s\n", Describe(kernel, options, report).c_str());
  std::fflush(stdout);
}

void Expect(std::size_t kernel, const AccuracyOptions& options, const AccuracyReport& report) {
  Print(kernel, options, report);
  EXPECT_LE(report.max_ulp, report.bound) << Describe(kernel, options, report);
  if (!options.double_lanes && options.accuracy == Accuracy::kFast) {
    EXPECT_LE(report.max_relative, 0x1p-11) << Describe(kernel, options, report);
  }
  EXPECT_EQ(report.nan_count, 0u) << Describe(kernel, options, report);
  EXPECT_EQ(report.inf_count, 0u) << Describe(kernel, options, report);
}

std::string KernelName(const testing::TestParamInfo<std::size_t>& info) {
  std::string name(kKernels[info.param].id);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

class AccuracyTest : public testing::TestWithParam<std::size_t> {};
INSTANTIATE_TEST_SUITE_P(Kernels, AccuracyTest, testing::Range(std::size_t{0}, kNumKernels), KernelName);

TEST_P(AccuracyTest, IsWithinItsBoundOnTheBestTarget) {
  for (AccuracyOptions options : AllAccuracies()) {
    options.samples = options.double_lanes ? 10000 : 150000;
    if (LongRun()) options.samples = options.double_lanes ? 200000 : 3000000;
    options.samples /= OracleCost(GetParam());
    options.grid /= OracleCost(GetParam());
    options.extremes = false;  // extremes_test has them, on every target
    options.seed = LongRun() ? 2 : 1;
    Expect(GetParam(), options, MeasureAccuracy(GetParam(), options));
  }
}

TEST_P(AccuracyTest, IsWithinItsBoundOnTheOtherTargets) {
  std::vector<Point> points = GridPoints(GetParam(), 2000);
  const RandomPoints random_points(GetParam(), 3);
  for (std::uint64_t i = 0; i < (LongRun() ? 200000u : 6000u); ++i) points.push_back(random_points(i));
  std::vector<AccuracyOptions> options;
  for (const std::string& target : SupportedTargets()) {
    if (target == SupportedTargets().front()) continue;
    for (const AccuracyOptions& mode : AllAccuracies(target)) options.push_back(mode);
  }
  const std::vector<AccuracyReport> reports = MeasureAccuracy(GetParam(), options, points);
  for (std::size_t i = 0; i < options.size(); ++i) Expect(GetParam(), options[i], reports[i]);
}

// The floats from low to high by their bits, negative and positive ones apart: Count() of them, every
// step-th.
class FloatRange {
 public:
  FloatRange(double low, double high, std::uint32_t step) : step_(step) {
    if (low < 0) negative_ = Bits(static_cast<float>(-low)) / step + 1;
    first_ = low > 0 ? Bits(static_cast<float>(low)) : 0;
    positive_ = (Bits(static_cast<float>(high)) - first_) / step + 1;
  }
  std::uint64_t Count() const { return negative_ + positive_; }
  double operator[](std::uint64_t i) const {
    const bool negative = i < negative_;
    const std::uint32_t bits = negative ? static_cast<std::uint32_t>(i) * step_
                                        : first_ + static_cast<std::uint32_t>(i - negative_) * step_;
    float value;
    std::memcpy(&value, &bits, sizeof value);
    return static_cast<double>(negative ? -value : value);
  }

 private:
  static std::uint32_t Bits(float value) {
    std::uint32_t bits;
    std::memcpy(&bits, &value, sizeof bits);
    return bits;
  }

  std::uint32_t step_, first_;
  std::uint64_t negative_ = 0, positive_;
};

TEST_P(AccuracyTest, OfOneVariableIsWithinItsBoundOnEveryFloat) {
  const Names inputs = Split(kKernels[GetParam()].inputs);
  if (inputs.count != 1) GTEST_SKIP() << "has several inputs";
  const Input& input = FindInput(inputs.name[0]);
  const bool below_high = input.name.front() == 'u';  // [0, 1)
  const double high = below_high ? 1 - 0x1p-24 : input.high;
  const FloatRange range(input.low, high, LongRun() ? 1 : 1009);
  for (AccuracyOptions options : AllAccuracies()) {
    if (options.double_lanes) continue;
    options.oracle_share = LongRun() ? 4096 : 64;
    const auto point = [&](std::uint64_t i) { return Point{range[i]}; };
    Expect(GetParam(), options, MeasureAccuracy(GetParam(), options, point, range.Count()));
  }
}

// Any finite bits, with parameters within their domains.
TEST_P(AccuracyTest, FiniteInputsGiveFiniteOutputs) {
  const Names inputs = Split(kKernels[GetParam()].inputs);
  const std::size_t num_outputs = Split(kKernels[GetParam()].outputs).count;
  constexpr double kSpecials[] = {0,     -0.0,   1,     -1,  0x1p-149, -0x1p-149, 0x1p-126, 0x1.fffffep+127,
                                  1e-38, -1e-38, 1e-20, 0.6, -0.8,     1e30,      -1e19,    -0x1.fffffep+127};
  const std::size_t count = LongRun() ? 1000000 : 20000;
  std::vector<Point> points(count);
  for (std::size_t j = 0; j < count; ++j) {
    Random random(11, j);
    points[j] = Point{};
    for (std::size_t k = 0; k < inputs.count; ++k) {
      const Input& input = FindInput(inputs.name[k]);
      double& x = points[j][k];
      x = random.Sign() * std::exp2(278 * random.Uniform() - 150);
      if (random.Chance(0.2)) x = kSpecials[random.Index(16)];
      const bool parameter = k >= inputs.per_lane;
      if (parameter || random.Chance(0.4)) x = input.low + (input.high - input.low) * random.Uniform();
      if (parameter && random.Chance(0.2)) x = random.Chance(0.5) ? input.low : input.high;
      if (input.name == "order") x = std::round(x);
      if (input.name == "m") x = random.Chance(0.5) ? input.low : 0.8;  // few tables
      if (input.name == "index") x = random.Chance(0.5) ? input.high : 1.7;
      if (input.name == "tail") x = random.Chance(0.5) ? input.low : 4;
      x = static_cast<float>(x);
    }
  }
  std::size_t bad = 0;
  for (const std::string& target : SupportedTargets()) {
    for (const AccuracyOptions& options : AllAccuracies(target)) {
      const auto results = Compute(GetParam(), options, points);
      for (std::size_t j = 0; j < count; ++j) {
        for (std::size_t i = 0; i < num_outputs; ++i) {
          if (std::isfinite(results[j][i]) || ++bad > 5) continue;
          ADD_FAILURE() << AccuracyName(options) << " " << target << ": output " << i << " is "
                        << results[j][i] << " at " << Describe(GetParam(), points[j]);
        }
      }
    }
  }
  EXPECT_EQ(bad, 0u);
  std::printf("[points] %s finite: %zu points, 4 accuracies, %zu targets\n",
              std::string(kKernels[GetParam()].id).c_str(), count, SupportedTargets().size());
}

// Inputs of a kernel of an opaque surface, column by column.
struct Columns {
  std::vector<std::vector<float>> in;

  Columns(std::size_t kernel, const std::vector<Point>& points)
      : in(Split(kKernels[kernel].inputs).count, std::vector<float>(points.size())) {
    for (std::size_t k = 0; k < in.size(); ++k) {
      for (std::size_t j = 0; j < points.size(); ++j) in[k][j] = static_cast<float>(points[j][k]);
    }
  }
  Directions<float> Direction(std::size_t k) const {
    return {in[k].data(), in[k + 1].data(), in[k + 2].data()};
  }
  Parameter<float> Lanes(std::size_t k) const { return in[k].data(); }
};

template <Normals kNormals, Reflector kReflector>
class ChannelCheck {
  static constexpr std::size_t kRoughness = kNormals == Normals::kPhong ? 1 : 2,
                               kFacets = kReflector == Reflector::kConductor ? 2 : 1;
  static constexpr std::size_t kShifts = 3, kChannels[] = {1, 3, 4, 8, 16};

 public:
  explicit ChannelCheck(JointMasking masking)
      : masking_(masking),
        kernel_(ReflectorKernel(
            {kNormals, kReflector,
             FindReflectorQuantity(DielectricQuantity::kEval, masking == JointMasking::kSeparable
                                                                  ? DielectricQuantity::kSeparable
                                                                  : DielectricQuantity::kCorrelated)})) {}

  // Channel c has the facets of the lane c % kShifts further on.
  void Run() {
    std::vector<Point> points;
    const RandomPoints random_points(kernel_, 6);
    const std::size_t count = LongRun() ? 100000 : 2000;
    points.reserve(count);
    for (std::uint64_t i = 0; i < count; ++i) points.push_back(random_points(i));
    for (const ExtremeCase& extreme : ExtremeCases(kernel_)) {
      if (extreme.row == "conductor" || extreme.row == "tir-edge") points.push_back(extreme.in);
    }
    const std::size_t n = points.size();
    const Columns columns(kernel_, points);
    std::vector<oracle::Result> truth(kShifts * n);
    std::vector<std::vector<std::vector<float>>> facets(kShifts);
    for (std::size_t shift = 0; shift < kShifts; ++shift) {
      facets[shift].assign(kFacets, std::vector<float>(n));
      for (std::size_t j = 0; j < n; ++j) {
        Point shifted = points[j];
        for (std::size_t k = 0; k < kFacets; ++k) {
          shifted[6 + kRoughness + k] = points[(j + shift) % n][6 + kRoughness + k];
          facets[shift][k][j] = static_cast<float>(shifted[6 + kRoughness + k]);
        }
        truth[shift * n + j] = oracle::Evaluate(kernel_, shifted.data(), oracle::Transport::kRadiance, -1);
      }
    }
    for (const std::string& target : SupportedTargets()) {
      for (const AccuracyOptions& options : AllAccuracies(target)) {
        if (!options.double_lanes) RunOn(options, columns, facets, truth, n);
      }
    }
    ASSERT_EQ(ChooseTarget(""), "");
  }

 private:
  FacetParameters<kReflector, float> FacetsOfLanes(const std::vector<std::vector<float>>& lanes) const {
    if constexpr (kReflector == Reflector::kConductor) return {lanes[0].data(), lanes[1].data()};
    if constexpr (kReflector == Reflector::kSchlick) return {lanes[0].data()};
  }

  void RunOn(const AccuracyOptions& options, const Columns& columns,
             const std::vector<std::vector<std::vector<float>>>& facets,
             const std::vector<oracle::Result>& truth, std::size_t n) {
    ASSERT_EQ(ChooseTarget(options.target), "");
    const RoughnessOf<kNormals, float> roughness = [&]() -> RoughnessOf<kNormals, float> {
      if constexpr (kRoughness == 1) return {columns.Lanes(6)};
      if constexpr (kRoughness == 2) return {columns.Lanes(6), columns.Lanes(7)};
    }();
    constexpr float kUntouched = 12345;
    double largest = 0;
    for (const std::size_t channels : kChannels) {
      std::vector<std::vector<float>> out(channels, std::vector<float>(n + 1, kUntouched));
      std::vector<FacetParameters<kReflector, float>> parameters;
      std::vector<float*> to;
      for (std::size_t c = 0; c < channels; ++c) {
        parameters.push_back(FacetsOfLanes(facets[c % kShifts]));
        to.push_back(out[c].data());
      }
      RoughReflectorCalls<kNormals, kReflector>::EvalChannels(n, columns.Direction(0), columns.Direction(3),
                                                              roughness, channels, parameters.data(),
                                                              to.data(), options.accuracy, masking_);
      for (std::size_t c = 0; c < channels; ++c) {
        EXPECT_EQ(out[c][n], kUntouched);
        if (c >= kShifts) {
          EXPECT_EQ(std::memcmp(out[c].data(), out[c % kShifts].data(), n * sizeof(float)), 0);
          continue;
        }
        if (channels != 3 && c + 1 != channels) continue;
        for (std::size_t j = 0; j < n; ++j) {
          const oracle::Result& exact = truth[c * n + j];
          const double error = UlpError(out[c][j], exact.exact[0], exact.scale[0]);
          largest = std::max(largest, error);
          ASSERT_LE(error, DeclaredBound(kernel_, options))
              << AccuracyName(options) << ' ' << options.target << ", channel " << c << ", lane " << j;
        }
      }
    }
    std::printf("[points] %s, 1 to 16 channels, %s %s: %zu points, largest error %.3g ULP of %g\n",
                std::string(kKernels[kernel_].id).c_str(), AccuracyName(options).c_str(),
                options.target.c_str(), kShifts * n, largest, DeclaredBound(kernel_, options));
  }

  JointMasking masking_;
  std::size_t kernel_;
};

TEST(Channels, AreWithinTheBoundOfOneAndDoNotDependOnTheirNumber) {
  for (const JointMasking masking : {JointMasking::kHeightCorrelated, JointMasking::kSeparable}) {
    ChannelCheck<Normals::kGgx, Reflector::kConductor>(masking).Run();
    ChannelCheck<Normals::kGgx, Reflector::kSchlick>(masking).Run();
    ChannelCheck<Normals::kBeckmann, Reflector::kConductor>(masking).Run();
    ChannelCheck<Normals::kBeckmann, Reflector::kSchlick>(masking).Run();
    ChannelCheck<Normals::kPhong, Reflector::kConductor>(masking).Run();
    ChannelCheck<Normals::kPhong, Reflector::kSchlick>(masking).Run();
  }
}

}  // namespace
}  // namespace microlane
