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
#include "microlane/targets.h"
#include "points.h"

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

}  // namespace
}  // namespace microlane
