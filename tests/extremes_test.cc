// The stiff and extreme cases, one test for each row that applies to these kernels, named after its id. Rows
// about lanes and memory are in lanes_test.cc; the row `reassociated` is reassociated_test.cc.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "accuracy.h"
#include "microlane/kernel_list.h"
#include "microlane/material.h"
#include "microlane/targets.h"
#include "points.h"

namespace microlane {
namespace {

using Outputs = std::array<double, kMaxOutputs>;

std::vector<AccuracyOptions> AllAccuraciesOnAllTargets() {
  std::vector<AccuracyOptions> all;
  for (const std::string& target : SupportedTargets()) {
    for (const AccuracyOptions& options : AllAccuracies(target)) all.push_back(options);
  }
  return all;
}

// The values that an output can take by what it means; results of kFast may pass an end by its error.
struct Range {
  double low, high;
};

Range RangeOf(std::string_view output, bool fast) {
  constexpr double kLargest = 1.7976931348623157e308;
  const double slack = fast ? 0x1p-11 : 0;
  if (output == "G1" || output == "G2" || output == "F" || output == "T") return {0, 1 + slack};
  if (output == "albedo" || output == "deficit") return {0, 1 + slack};
  if (output == "phi") return {0, 3.14159274101257324 + slack};
  if (output == "lobe") return {0, 2};
  if (output == "r_xy") return {-1, 1};
  if (output.substr(0, 7) == "moment_") return {-kLargest, kLargest};
  if (output.front() == 'm' || output.front() == 'h') return {-1 - 0x1p-22 - slack, 1 + 0x1p-22 + slack};
  if (output == "wox" || output == "woy" || output == "woz") return {-1.01, 1.01};  // of wi not quite unit
  if (output == "sin" || output == "cos") return {-1 - 0x1p-23 - slack, 1 + 0x1p-23 + slack};
  return {0, kLargest};
}

std::vector<Point> CasesOf(std::string_view row, std::size_t kernel) {
  std::vector<Point> points;
  for (const ExtremeCase& extreme : ExtremeCases(kernel)) {
    if (extreme.row == row) points.push_back(extreme.in);
  }
  return points;
}

void ExpectInRange(std::size_t kernel, const AccuracyOptions& options, const std::vector<Point>& points) {
  const Names outputs = Split(kKernels[kernel].outputs);
  const bool fast = !options.double_lanes && options.accuracy == Accuracy::kFast;
  const std::vector<Outputs> results = Compute(kernel, options, points);
  for (std::size_t i = 0; i < outputs.count; ++i) {
    Range range = RangeOf(outputs.name[i], fast);
    const std::string_view id = kKernels[kernel].id;
    if (id == "math.erfinv") range.low = -range.high;
    if (id == "masking.kelemen") range.high = std::numeric_limits<double>::max();
    if (id == "masking.implicit" || id == "masking.schlick_smith") range.high = 1.01;  // of v not quite unit
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double got = results[j][i];
      if (got >= range.low && got <= range.high) continue;
      ADD_FAILURE() << kKernels[kernel].id << " " << AccuracyName(options) << " " << options.target << ": "
                    << outputs.name[i] << " = " << got << " at " << Describe(kernel, points[j]);
      break;
    }
  }
}

// Finite, in range and within the declared bound: every case of the row, every kernel it applies to, every
// accuracy, every target.
void CheckRow(std::string_view row) {
  const std::vector<AccuracyOptions> all = AllAccuraciesOnAllTargets();
  std::size_t tried = 0, kernels = 0;
  for (std::size_t kernel = 0; kernel < kNumKernels; ++kernel) {
    const std::vector<Point> points = CasesOf(row, kernel);
    if (points.empty()) continue;
    ++kernels;
    const std::vector<AccuracyReport> reports = MeasureAccuracy(kernel, all, points);
    for (std::size_t k = 0; k < all.size(); ++k) {
      tried += reports[k].points;
      EXPECT_TRUE(reports[k].ok) << row << ": " << Describe(kernel, all[k], reports[k]);
      ExpectInRange(kernel, all[k], points);
    }
  }
  EXPECT_GT(tried, 0u) << "no case of " << row;
  std::printf("[points] %s: %zu cases x accuracies x targets, %zu kernels\n", std::string(row).c_str(), tried,
              kernels);
}

TEST(Extremes, AlphaProduct) { CheckRow("alpha-product"); }
TEST(Extremes, AlphaPeak) { CheckRow("alpha-peak"); }
TEST(Extremes, LambdaSmall) { CheckRow("lambda-small"); }
TEST(Extremes, GammaEnds) { CheckRow("gamma-ends"); }
TEST(Extremes, G1Normal) { CheckRow("g1-normal"); }
TEST(Extremes, AlphaHuge) { CheckRow("alpha-huge"); }
TEST(Extremes, AnisoRatio) { CheckRow("aniso-ratio"); }
TEST(Extremes, Grazing) { CheckRow("grazing"); }
TEST(Extremes, Opposite) { CheckRow("opposite"); }
TEST(Extremes, Below) { CheckRow("below"); }
TEST(Extremes, ParallelHalf) { CheckRow("parallel-half"); }
TEST(Extremes, NotUnit) { CheckRow("not-unit"); }
TEST(Extremes, EtaOne) { CheckRow("eta-one"); }
TEST(Extremes, EtaExtreme) { CheckRow("eta-extreme"); }
TEST(Extremes, MeanFresnelOne) { CheckRow("mean-fresnel-one"); }
TEST(Extremes, TirEdge) { CheckRow("tir-edge"); }
TEST(Extremes, UEdges) { CheckRow("u-edges"); }
TEST(Extremes, OffCentre) { CheckRow("off-centre"); }
TEST(Extremes, RationalOverOne) { CheckRow("rational-over-one"); }
TEST(Extremes, WeightRatio) { CheckRow("weight-ratio"); }

// A point of a kernel from its inputs by name; those not named are 0.
class PointOf {
 public:
  explicit PointOf(std::string_view id) : kernel_(KernelIndex(id)), names_(Split(kKernels[kernel_].inputs)) {}
  std::size_t kernel() const { return kernel_; }

  PointOf& Set(std::string_view name, double value) {
    for (std::size_t k = 0; k < names_.count; ++k) {
      if (names_.name[k] == name) in_[k] = value;
    }
    return *this;
  }
  PointOf& SetDirection(std::string_view prefix, double x, double y, double z) {
    const std::string name(prefix);
    return Set(name + "x", x).Set(name + "y", y).Set(name + "z", z);
  }
  PointOf& SetAlpha(double alpha) {
    return Set("alpha_x", alpha).Set("alpha_y", alpha).Set("exponent", 2 / (alpha * alpha) - 2);
  }
  const Point& in() const { return in_; }

 private:
  std::size_t kernel_;
  Names names_;
  Point in_{};
};

AccuracyOptions DoubleLanes() {
  AccuracyOptions options;
  options.double_lanes = true;
  return options;
}

constexpr std::string_view kModels[] = {"rough_dielectric", "rough_dielectric_beckmann",
                                        "rough_dielectric_phong"};

std::string Id(std::string_view model, std::string_view quantity) {
  return std::string(model) + "." + std::string(quantity);
}

Outputs ComputeOne(const PointOf& point, const AccuracyOptions& options,
                   Transport transport = Transport::kRadiance) {
  return Compute(point.kernel(), options, {point.in()}, transport)[0];
}

TEST(Extremes, OneAxisZero) {
  for (const std::string_view name : {"alpha_x", "alpha_y"}) {
    for (const double value : {0.0, -0.0, -0.1, 1e-6, 1e3, std::nan("")}) {
      const std::string error = CheckParameter(name, value);
      EXPECT_NE(error.find(name), std::string::npos) << value;
    }
    EXPECT_EQ(CheckParameter(name, 0.1), "");
  }
  EXPECT_FALSE(RoughDielectricMaterial(0, 0.3, 1.5).ok());
  EXPECT_FALSE(RoughDielectricMaterial(0.3, 0, 1.5).ok());
  EXPECT_NE(RoughDielectricMaterial(0.3, 0, 1.5).error().find("alpha_y"), std::string::npos);
  EXPECT_TRUE(RoughDielectricMaterial(0.3, 0.3, 1.5).ok());
  std::printf("[points] one-axis-zero: 12 values\n");
}

// As alpha tends to 0, samples tend to the mirror direction and to Snell's, weights to 1, lobes to Fresnel's
// shares.
TEST(Extremes, DeltaLimit) {
  CheckRow("delta-limit");
  std::size_t tried = 0;
  const std::size_t fresnel = KernelIndex("fresnel.dielectric");
  for (const std::string_view model : kModels) {
    for (const AccuracyOptions& options : AllAccuraciesOnAllTargets()) {
      for (const double eta : {1.5, 1 / 1.5}) {
        for (const double cosine : {1.0, 0.9, 0.8, -0.9}) {
          PointOf point(Id(model, "sample"));
          const double sine = std::sqrt(1 - cosine * cosine), side = std::copysign(1, cosine);
          point.SetDirection("wi", sine, 0, cosine).SetAlpha(1e-5).Set("eta", eta);
          const double F = Compute(fresnel, options, {Point{cosine, eta}})[0][0];
          const double cos_t = std::sqrt(1 - sine * sine / (eta * eta));
          std::vector<Point> points;
          for (const double u1 : {0.1, 0.5, 0.9}) {
            for (const double u2 : {0.0, 0.3, 0.8}) {
              for (const double u3 : {0.0, F * 0.98, std::min(F * 1.02, 0.999), 0.999}) {
                points.push_back(point.Set("u1", u1).Set("u2", u2).Set("u3", u3).in());
              }
            }
          }
          const std::vector<Outputs> results = Compute(point.kernel(), options, points);
          for (std::size_t j = 0; j < points.size(); ++j) {
            const Outputs& got = results[j];
            const bool reflects = points[j][5] < F;
            const std::string where =
                AccuracyName(options) + " " + options.target + " " + Describe(point.kernel(), points[j]);
            EXPECT_EQ(got[5], reflects ? 1 : 2) << where;
            EXPECT_NEAR(got[3], 1, 1e-3) << where;
            EXPECT_NEAR(got[0], reflects ? -sine : -sine / eta, 1e-3) << where;
            EXPECT_NEAR(got[2], side * (reflects ? std::abs(cosine) : -cos_t), 1e-3) << where;
            ++tried;
          }
        }
      }
    }
  }
  std::printf("[points] delta-limit: %zu samples at alpha 1e-5 against mirror and smooth refraction\n",
              tried);
}

// Besides the bounds: the largest weight of the D cos samplers, which grows towards grazing by itself.
TEST(Extremes, RetroGrazing) {
  CheckRow("retro-grazing");
  for (const std::string_view model : kModels) {
    double largest = 0;
    Point where{};
    PointOf point(Id(model, "sample"));
    std::size_t tried = 0;
    for (const double alpha : {1e-3, 0.1, 0.5, 1.0}) {
      for (const double height : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7}) {
        point.SetAlpha(alpha).Set("eta", 1.5).SetDirection("wi", std::sqrt(1 - height * height), 0, height);
        std::vector<Point> points;
        for (std::uint64_t i = 0; i < 2000; ++i) {
          Random random(5, i);
          points.push_back(
              point.Set("u1", random.Uniform()).Set("u2", random.Uniform()).Set("u3", random.Uniform()).in());
        }
        const std::vector<Outputs> results = Compute(point.kernel(), AccuracyOptions(), points);
        for (std::size_t j = 0; j < points.size(); ++j) {
          ASSERT_TRUE(std::isfinite(results[j][3])) << Describe(point.kernel(), points[j]);
          if (results[j][3] > largest) {
            largest = results[j][3];
            where = points[j];
          }
        }
        tried += points.size();
      }
    }
    std::printf("[points] retro-grazing: %zu samples of %s, largest weight %.4g at %s\n", tried,
                std::string(kKernels[point.kernel()].id).c_str(), largest,
                Describe(point.kernel(), where).c_str());
  }
}

// Under total internal reflection from inside, light is reflected, never black.
TEST(Extremes, HalfOutward) {
  CheckRow("half-outward");
  std::size_t tried = 0;
  for (const std::string_view model : kModels) {
    for (const AccuracyOptions& options : AllAccuraciesOnAllTargets()) {
      for (const double cosine : {0.1, 0.3, 0.6, -0.1, -0.3, -0.6}) {
        const double sine = std::sqrt(1 - cosine * cosine);
        PointOf eval(Id(model, "eval")), sample(Id(model, "sample"));
        eval.SetAlpha(0.1).Set("eta", 1 / 1.5).SetDirection("wi", sine, 0, cosine);
        eval.SetDirection("wo", -sine, 0, cosine);
        EXPECT_GT(ComputeOne(eval, options)[0], 0)
            << AccuracyName(options) << Describe(eval.kernel(), eval.in());
        sample.SetAlpha(1e-3).Set("eta", 1 / 1.5).SetDirection("wi", sine, 0, cosine);
        for (const double u1 : {0.3, 0.5, 0.9}) {
          for (const double u3 : {0.0, 0.5, 0.999}) {
            sample.Set("u1", u1).Set("u2", 0.2).Set("u3", u3);
            EXPECT_EQ(ComputeOne(sample, options)[5], 1)
                << AccuracyName(options) << Describe(sample.kernel(), sample.in());
          }
        }
        tried += 10;
      }
    }
  }
  std::printf("[points] half-outward: %zu values and samples from inside\n", tried);
}

// At kappa = 0 a conductor is the dielectric, under total internal reflection and near eta = 1 too.
TEST(Extremes, Conductor) {
  CheckRow("conductor");
  std::size_t tried = 0;
  const std::size_t conductor = KernelIndex("fresnel.conductor"),
                    dielectric = KernelIndex("fresnel.dielectric");
  for (const AccuracyOptions& options : AllAccuraciesOnAllTargets()) {
    std::vector<Point> metals, glasses;
    for (const double eta :
         {0.25, 1 / 2.42, 1 / 1.5, 0.999, 1 - 0x1p-23, 1.0, 1 + 0x1p-22, 1.0003, 1.5, 4.0}) {
      for (const double cosine : {1.0, 0.9, 0.7, 0.5, 0.3, 0.1, 1e-3, 1e-6, 0.0, -0.4}) {
        const double c = static_cast<float>(cosine), n = static_cast<float>(eta);
        metals.push_back(Point{c, n, 0});
        glasses.push_back(Point{c, n});
      }
    }
    const std::vector<Outputs> metal = Compute(conductor, options, metals),
                               glass = Compute(dielectric, options, glasses);
    const double tolerance = options.double_lanes ? 1e-13 : options.accuracy == Accuracy::kFast ? 1e-3 : 1e-6;
    for (std::size_t i = 0; i < metals.size(); ++i) {
      EXPECT_NEAR(metal[i][0], glass[i][0], tolerance * glass[i][0])
          << AccuracyName(options) << " " << options.target << " " << Describe(conductor, metals[i]);
      ++tried;
    }
  }
  std::printf("[points] conductor: %zu dielectrics as conductors\n", tried);
}

TEST(Extremes, AzimuthWrap) { CheckRow("azimuth-wrap"); }
TEST(Extremes, VcavityKink) { CheckRow("vcavity-kink"); }

// Fresnel's reflectance is the same from both sides of the interface along one ray.
TEST(Extremes, OrderOfEta) {
  CheckRow("order-of-eta");
  std::size_t tried = 0;
  for (const std::string_view id : {"fresnel.dielectric", "fresnel.dielectric_s", "fresnel.dielectric_p"}) {
    const std::size_t kernel = KernelIndex(id);
    for (const double eta : {1.0003, 1.2, 1.5, 2.42, 4.0}) {
      for (const double cosine : {1.0, 0.9, 0.6, 0.3, 0.1, 0.01}) {
        const double cos_t = std::sqrt(1 - (1 - cosine * cosine) / (eta * eta));
        const double outside = Compute(kernel, DoubleLanes(), {Point{cosine, eta}})[0][0];
        const double inside = Compute(kernel, DoubleLanes(), {Point{cos_t, 1 / eta}})[0][0];
        EXPECT_NEAR(inside, outside, 1e-11 * outside + 1e-20) << id << " " << cosine << " " << eta;
        ++tried;
      }
    }
  }
  std::printf("[points] order-of-eta: %zu rays from both sides\n", tried);
}

// Radiance carries eta^2 in transmission and nothing in reflection.
TEST(Extremes, Transport) {
  CheckRow("transport");
  std::size_t tried = 0;
  for (std::size_t kernel = 0; kernel < kNumKernels; ++kernel) {
    if (!kKernels[kernel].has_transport) continue;
    const Names inputs = Split(kKernels[kernel].inputs), outputs = Split(kKernels[kernel].outputs);
    const bool samples = outputs.name[outputs.count - 1] == "lobe";
    std::vector<Point> points = CasesOf("transport", kernel);
    const std::vector<Outputs> radiance = Compute(kernel, DoubleLanes(), points, Transport::kRadiance);
    const std::vector<Outputs> importance = Compute(kernel, DoubleLanes(), points, Transport::kImportance);
    for (std::size_t j = 0; j < points.size(); ++j) {
      const double eta = points[j][inputs.count - 1];
      const bool transmits = samples ? radiance[j][5] == 2 : points[j][2] * points[j][5] < 0;
      const double factor = transmits ? eta * eta : 1;
      const std::size_t value = samples ? 3 : 0;
      for (std::size_t i = 0; i < outputs.count; ++i) {
        const double expected = i == value ? radiance[j][i] / factor : radiance[j][i];
        EXPECT_NEAR(importance[j][i], expected, 1e-14 * std::abs(expected))
            << kKernels[kernel].id << " " << outputs.name[i] << " " << Describe(kernel, points[j]);
      }
      ++tried;
    }
  }
  std::printf("[points] transport: %zu pairs\n", tried);
}

// A grid of samples of every model, for the rows that compare a sample with the values of its direction.
struct SampledDirection {
  Point in;  // of the sampler
  Outputs out;
};

std::vector<SampledDirection> Samples(const PointOf& base, const AccuracyOptions& options) {
  std::vector<Point> points;
  PointOf point = base;
  for (const double alpha : {1e-3, 0.05, 0.3, 1.0}) {
    for (const double eta : {1.5, 1 / 1.5, 1.01, 2.42}) {
      for (const double cosine : {1.0, 0.8, 0.3, 0.05, -0.6, -0.1}) {
        point.SetAlpha(alpha).Set("eta", static_cast<float>(eta));
        if (base.in()[0] == 0 && alpha == 0.3) point.Set("alpha_y", 0.1);
        point.SetDirection("wi", std::sqrt(1 - cosine * cosine) * 0.6, std::sqrt(1 - cosine * cosine) * 0.8,
                           cosine);
        for (std::uint64_t i = 0; i < 24; ++i) {
          Random random(9, i);
          point.Set("u1", static_cast<float>(random.Uniform()))
              .Set("u2", static_cast<float>(random.Uniform()));
          points.push_back(
              point.Set("u3", static_cast<float>(random.Uniform() * (i % 2 == 0 ? 1 : 0.1))).in());
        }
      }
    }
  }
  const std::vector<Outputs> results = Compute(point.kernel(), options, points);
  std::vector<SampledDirection> samples;
  samples.reserve(points.size());
  for (std::size_t j = 0; j < points.size(); ++j) samples.push_back({points[j], results[j]});
  return samples;
}

// A sample has a density that is not 0, and a weight.
TEST(Extremes, PdfZero) {
  CheckRow("pdf-zero");
  std::size_t tried = 0;
  for (const std::string_view model : kModels) {
    for (const AccuracyOptions& options : AllAccuraciesOnAllTargets()) {
      for (const std::string_view sampler : {"sample", "sample_reflection", "sample_transmission"}) {
        const PointOf base(Id(model, sampler));
        for (const SampledDirection& sample : Samples(base, options)) {
          const bool none = sample.out[5] == 0;
          EXPECT_EQ(sample.out[4] > 0, !none) << AccuracyName(options) << Describe(base.kernel(), sample.in);
          EXPECT_EQ(sample.out[3] > 0, !none) << AccuracyName(options) << Describe(base.kernel(), sample.in);
          ++tried;
        }
      }
    }
  }
  std::printf("[points] pdf-zero: %zu samples\n", tried);
}

// weight * pdf = f cos and pdf = pdf at the sampled direction, for every model, masking and transport. In
// double lanes: what remains is the rounding of wo, seen through the lobe's width and the geometry.
TEST(Extremes, SampleVsEval) {
  std::size_t tried = 0;
  double largest = 0;
  for (const std::string_view model : kModels) {
    for (const DielectricQuantity& quantity : kDielectricQuantities) {
      if (quantity.what != DielectricQuantity::kSample) continue;
      const auto same = [&](DielectricQuantity::What what, DielectricQuantity::Joint joint, bool visible) {
        return KernelIndex(
            Id(model, kDielectricQuantities[FindDielectricQuantity(what, quantity.reflects,
                                                                   quantity.transmits, joint, visible)]
                          .name));
      };
      const std::size_t sampler = same(DielectricQuantity::kSample, quantity.joint, quantity.visible);
      if (sampler == kNumKernels) continue;  // Phong has no visible normals
      const std::size_t eval = same(DielectricQuantity::kEval, quantity.joint, false);
      const std::size_t pdf =
          same(DielectricQuantity::kPdf, DielectricQuantity::kCorrelated, quantity.visible);
      const std::size_t parameters = Split(kKernels[sampler].inputs).per_lane;
      const std::size_t num_inputs = Split(kKernels[sampler].inputs).count;
      for (const Transport transport : {Transport::kRadiance, Transport::kImportance}) {
        std::vector<Point> points, pairs;
        for (const SampledDirection& sample : Samples(PointOf(kKernels[sampler].id), DoubleLanes())) {
          points.push_back(sample.in);
        }
        const std::vector<Outputs> samples = Compute(sampler, DoubleLanes(), points, transport);
        for (std::size_t j = 0; j < points.size(); ++j) {
          Point& pair = pairs.emplace_back(points[j]);
          for (int k = 0; k < 3; ++k) pair[3 + k] = samples[j][k];
          for (std::size_t k = parameters; k < num_inputs; ++k) pair[6 + k - parameters] = points[j][k];
        }
        const std::vector<Outputs> values = Compute(eval, DoubleLanes(), pairs, transport);
        const std::vector<Outputs> densities = Compute(pdf, DoubleLanes(), pairs);
        for (std::size_t j = 0; j < points.size(); ++j) {
          if (samples[j][5] == 0) continue;
          const double eta = points[j][num_inputs - 1];
          const double p = points[j][parameters], alpha = model == kModels[2] ? std::sqrt(2 / (p + 2)) : p;
          // The half vector of transmission is determined to 1 / |eta - 1| roundings of wo.
          const double h = samples[j][5] == 2 ? 1 / std::abs(eta - 1) : 1;
          const double tolerance = 1e-13 * (1 + h) * (1 + h) / alpha * (1 + 1 / std::abs(samples[j][2]));
          const double density = densities[j][0] / samples[j][4] - 1;
          const double product = samples[j][3] * samples[j][4], value = values[j][0] / product - 1;
          EXPECT_LT(std::abs(density), tolerance)
              << kKernels[sampler].id << " pdf " << samples[j][4] << " against " << densities[j][0] << " at "
              << Describe(sampler, points[j]);
          EXPECT_LT(std::abs(value), tolerance)
              << kKernels[sampler].id << " weight * pdf " << product << " against " << values[j][0] << " at "
              << Describe(sampler, points[j]);
          largest = std::max({largest, std::abs(density), std::abs(value)});
          ++tried;
        }
      }
    }
  }
  std::printf("[points] sample-vs-eval: %zu samples, largest relative difference %.3g\n", tried, largest);
}

// The probability of a lobe is F of the sampled normal: u3 just below reflects, just above transmits, and the
// density of the sample is that share of the lobe's own.
TEST(Extremes, ChoiceProb) {
  std::size_t tried = 0;
  for (const std::string_view model : kModels) {
    for (const AccuracyOptions& options : AllAccuraciesOnAllTargets()) {
      const bool fast = !options.double_lanes && options.accuracy == Accuracy::kFast;
      const double tolerance = fast ? 4e-3 : options.double_lanes ? 1e-9 : 2e-4;
      PointOf point(Id(model, "sample"));
      point.SetAlpha(0.2);
      for (const double eta : {1.5, 1 / 1.5, 2.42}) {
        for (const double cosine : {1.0, 0.7, 0.3, -0.8}) {
          const double sine = std::sqrt(1 - cosine * cosine);
          point.Set("eta", static_cast<float>(eta)).SetDirection("wi", sine, 0, cosine);
          for (const double u1 : {0.05, 0.3, 0.6}) {
            for (const double u2 : {0.1, 0.6}) {
              point.Set("u1", u1).Set("u2", u2).Set("u3", 0);
              const Outputs mirrored = ComputeOne(point, options);
              if (mirrored[5] != 1) continue;  // masked
              PointOf fresnel("fresnel.dielectric");
              const double x = sine + mirrored[0], y = mirrored[1], z = cosine + mirrored[2];
              const double c = (sine * x + cosine * z) / std::sqrt(x * x + y * y + z * z);
              const double F =
                  ComputeOne(fresnel.Set("cos_i", c).Set("eta", static_cast<float>(eta)), options)[0];
              const std::string where =
                  AccuracyName(options) + " " + options.target + " " + Describe(point.kernel(), point.in());
              EXPECT_EQ(ComputeOne(point.Set("u3", F * (1 - tolerance)), options)[5], 1) << where;
              if (F * (1 + tolerance) < 1) {
                EXPECT_NE(ComputeOne(point.Set("u3", F * (1 + tolerance)), options)[5], 1) << where;
              }
              PointOf reflection(Id(model, "pdf_reflection"));
              reflection.SetAlpha(0.2).SetDirection("wi", sine, 0, cosine);
              reflection.SetDirection("wo", mirrored[0], mirrored[1], mirrored[2]).Set("eta", eta);
              const double own = ComputeOne(reflection, options)[0];
              EXPECT_NEAR(mirrored[4] / own, F, (fast ? 0.01 : 1e-3) * F) << where;
              tried += 3;
            }
          }
        }
      }
    }
  }
  std::printf("[points] choice-prob: %zu samples\n", tried);
}

}  // namespace
}  // namespace microlane
