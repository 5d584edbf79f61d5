// What theory demands of the Gaussian of the angle (Meneveaux 2015 Eq. 13): its normalisation, its limit,
// what V-cavities show of it, and its sampler.
#include "microlane/gaussian.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "columns.h"
#include "oracle/gaussian.h"
#include "quadrature.h"
#include "statistics.h"

namespace microlane {
namespace {

constexpr double kSigmas[] = {1e-3, 2e-3, 0.01, 0.05, 0.1, 0.17, 0.2, 0.25, 0.3, 0.5, 0.7, 1, 1.4, 2};
constexpr Accuracy kAccuracies[] = {Accuracy::kHigh, Accuracy::kStandard, Accuracy::kFast};
constexpr double kHorizon = kTestPi / 2;

// Angles from 0 to the horizon, or to where nothing is left, with their weights.
struct AngleRule {
  std::vector<double> theta, weight;

  explicit AngleRule(double sigma, int count = 96) {
    const Rule rule = GaussLegendre(count);
    const double half = 0.5 * std::min(kHorizon, 12 * sigma);
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      theta.push_back(half * (1 + rule.node[i]));
      weight.push_back(half * rule.weight[i]);
    }
  }
};

double C(double sigma) { return RunOne<double>("gaussian.C", 1, {}, Column<double>{sigma})[0]; }

TEST(GaussianNormalisation, IsOneOverTheIntegral) {
  Tally tally("C is 1/(2 pi Int exp(-theta^2/(2 sigma^2)) sin dtheta)");
  for (int k = 0; k <= 2000; ++k) {
    const double sigma = 1e-3 * std::pow(2000, k / 2000.0);
    const AngleRule rule(sigma);
    double sum = 0;
    for (std::size_t i = 0; i < rule.theta.size(); ++i) {
      sum += rule.weight[i] * std::exp(-0.5 * std::pow(rule.theta[i] / sigma, 2)) * std::sin(rule.theta[i]);
    }
    tally.AddRelative(C(std::min(sigma, 2.0)), 1 / (2 * kTestPi * sum), 1e-13,
                      [&] { return Text("sigma = %a", sigma); });
  }
}

// The oracle's series, by the trapezoidal rule after Takahasi and Mori 1974.
TEST(GaussianNormalisation, OfTheOracleIsOneOverTheIntegral) {
  using oracle::Real, oracle::Square;
  Tally tally("the oracle's C");
  for (const double sigma : kSigmas) {
    const Real horizon = oracle::Pi() / 2, cut = 40 * Real(sigma), end = cut < horizon ? cut : horizon;
    Real sum = 0;
    for (int k = -384; k <= 384; ++k) {
      const Real x = Real(k) / 64, inner = horizon * sinh(x);
      const Real place = end / (1 + exp(-2 * inner)),
                 speed = horizon * cosh(x) / (2 * Square(Real(cosh(inner))));
      sum += end * speed * exp(-Square(Real(place / sigma)) / 2) * sin(place) / 64;
    }
    const Real c = oracle::MakeGaussian(sigma).C(), error = c * 2 * oracle::Pi() * sum - 1;
    tally.Add(static_cast<double>(error), 1e-40, [&] { return Text("sigma = %g", sigma); });
  }
}

template <class T>
void ExpectProjectedAreaOfOne(Accuracy accuracy, double tolerance, const char* what) {
  Tally tally(std::string("Int D cos dm = 1, ") + what);
  for (const double value : kSigmas) {
    const double sigma = static_cast<double>(static_cast<T>(value));
    const AngleRule rule(sigma);
    DirectionColumns<T> m;
    for (const double theta : rule.theta) m.PushBack(Spherical(theta, 0.7));
    const Column<T> d = RunOne<T>("gaussian.D", m.size(), {accuracy}, m, sigma);
    double sum = 0;
    for (std::size_t i = 0; i < m.size(); ++i) {
      sum += rule.weight[i] * 2 * kTestPi * std::sin(rule.theta[i]) * double{d[i]} * double{m.z[i]};
    }
    tally.AddRelative(sum, 1, tolerance, [&] { return Text("sigma = %g", sigma); });
  }
}

TEST(GaussianDensity, ProjectedAreaIsOne) {
  ExpectProjectedAreaOfOne<double>(Accuracy::kStandard, 1e-12, "double lanes");
  ExpectProjectedAreaOfOne<float>(Accuracy::kHigh, 2e-7, "high");
  ExpectProjectedAreaOfOne<float>(Accuracy::kStandard, 2e-7, "standard");
  ExpectProjectedAreaOfOne<float>(Accuracy::kFast, 0x1p-11, "fast");
}

// D over Beckmann's of alpha = sqrt(2) sigma at theta = k sigma is 1 + sigma^2 (1/3 + k^4/3 - 3 k^2/2) + ...
TEST(GaussianDensity, TendsToBeckmannOfRootTwoSigma) {
  Tally tally("(D/Beckmann - 1)/sigma^2");
  for (const double sigma : {1e-3, 2e-3, 4e-3, 8e-3}) {
    for (const double k : {0.0, 0.3, 1.0, 2.0, 3.0, 4.0}) {
      const double theta = k * sigma, k2 = k * k;
      const Direction m = Spherical(theta, 0.4);
      const double ratio = RunOne<double>("gaussian.D", 1, {}, m, sigma)[0] /
                           RunOne<double>("beckmann.D_isotropic", 1, {}, m, std::sqrt(2) * sigma)[0];
      const double limit = 1.0 / 3 + k2 * k2 / 3 - 1.5 * k2;
      tally.Add((ratio - 1) / (sigma * sigma) - limit, 1e-3 + 4000 * sigma * sigma,
                [&] { return Text("sigma = %g, theta = %g sigma", sigma, k); });
    }
  }
}

// Heitz 2014 Eq. 17 of V-cavities.
TEST(GaussianDensity, ThatVCavitiesShowIsNormalised) {
  constexpr int kAzimuths = 720;
  Tally tally("Int D_visible_v_cavity dm = 1");
  for (const double sigma : {0.01, 0.1, 0.3, 1.0, 2.0}) {
    const AngleRule rule(sigma, 400);
    for (const double degrees : {0.0, 30.0, 60.0, 85.0, -20.0}) {
      const Direction v = (degrees < 0 ? -1 : 1) * Spherical(Radians(std::abs(degrees)), 0.3);
      DirectionColumns<double> m;
      Column<double> area;
      for (std::size_t i = 0; i < rule.theta.size(); ++i) {
        for (int k = 0; k < kAzimuths; ++k) {
          m.PushBack(Spherical(rule.theta[i], 2 * kTestPi * (k + 0.5) / kAzimuths));
          area.push_back(rule.weight[i] * std::sin(rule.theta[i]) * 2 * kTestPi / kAzimuths);
        }
      }
      const Column<double> d = RunOne<double>("gaussian.D_visible_v_cavity", m.size(), {}, v, m, sigma);
      double sum = 0;
      for (std::size_t i = 0; i < m.size(); ++i) sum += area[i] * d[i];
      tally.AddRelative(sum, 1, 1e-4, [&] { return Text("sigma = %g, %g degrees", sigma, degrees); });
    }
  }
}

// Counts of angle and azimuth against the angle's distribution (1 - exp(-theta^2/(2 sigma^2)))/q.
TEST(GaussianSampler, HasItsDistribution) {
  constexpr std::size_t kSamples = 1 << 18, kRings = 24, kSectors = 12;
  constexpr double kTests = std::size(kSigmas) * std::size(kAccuracies);
  const double significance = SidakSignificance(1e-3, static_cast<std::size_t>(kTests));
  std::mt19937_64 random(41);
  Tally tally("p-values of chi-square tests, 1 - p");
  for (const double value : kSigmas) {
    const double sigma = double{static_cast<float>(value)};
    const double q = -std::expm1(-0.5 * std::pow(kHorizon / sigma, 2));
    const double end = std::min(kHorizon, 5 * sigma);
    const auto below = [&](double theta) { return -std::expm1(-0.5 * std::pow(theta / sigma, 2)) / q; };
    for (const Accuracy accuracy : kAccuracies) {
      const Column<float> u1 = UniformNumbers<float>(kSamples, random);
      const Column<float> u2 = UniformNumbers<float>(kSamples, random);
      const DirectionColumns<float> m =
          RunDirection<float>("gaussian.sample_normal", kSamples, {accuracy}, u1, u2, sigma);
      std::vector<double> observed(kRings * kSectors), expected(kRings * kSectors);
      for (std::size_t i = 0; i < kSamples; ++i) {
        const Direction v = m[i];
        const double theta = std::atan2(std::hypot(v.x, v.y), v.z);
        const double turn = std::atan2(v.y, v.x) / (2 * kTestPi);
        const auto ring = std::min(static_cast<std::size_t>(kRings * theta / end), kRings - 1);
        const auto sector = static_cast<std::size_t>(kSectors * (turn - std::floor(turn)));
        ++observed[ring * kSectors + std::min(sector, kSectors - 1)];
      }
      for (std::size_t ring = 0; ring < kRings; ++ring) {
        const double low = below(end * static_cast<double>(ring) / kRings);
        const double high = ring + 1 == kRings ? 1 : below(end * static_cast<double>(ring + 1) / kRings);
        std::fill_n(expected.begin() + static_cast<std::ptrdiff_t>(ring * kSectors), kSectors,
                    kSamples * (high - low) / kSectors);
      }
      const ChiSquareResult result = ChiSquareTest(observed, expected);
      tally.Add(1 - result.p_value, 1 - significance,
                [&] { return Text("sigma = %g, accuracy %d", sigma, static_cast<int>(accuracy)); });
    }
  }
}

// pdf is D cos theta/sin(theta) times a constant, D cos/pdf is bounded by it, and its mean is 1.
TEST(GaussianSampler, DensityIsThatOfItsNormals) {
  const Rule rule = GaussLegendre(64);
  Tally density("pdf over D cos theta/sin(theta)"), mean("mean of D cos/pdf = 1"),
      bound("D cos/pdf is bounded");
  for (const double sigma : kSigmas) {
    const double q = -std::expm1(-0.5 * std::pow(kHorizon / sigma, 2));
    const double constant = 1 / (2 * kTestPi * C(sigma) * sigma * sigma * q);
    Column<double> u1;
    // 1 - u1 = x^4, as the angle goes by its logarithm.
    Column<double> weight;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double x = 0.5 * (1 + rule.node[i]);
      u1.push_back(1 - std::pow(x, 4));
      weight.push_back(0.5 * rule.weight[i] * 4 * std::pow(x, 3));
    }
    const std::vector<Column<double>> out =
        RunAll<double>("gaussian.sample_normal", u1.size(), {}, u1, 0.3, sigma);
    const DirectionColumns<double> m{out[0], out[1], out[2]};
    const Column<double> d = RunOne<double>("gaussian.D", m.size(), {}, m, sigma);
    double sum = 0;
    for (std::size_t i = 0; i < m.size(); ++i) {
      const double sine = std::hypot(m.x[i], m.y[i]), theta = std::atan2(sine, m.z[i]);
      const double projected = d[i] * m.z[i], pdf = out[3][i];
      const auto where = [&] { return Text("sigma = %g, u1 = %g", sigma, u1[i]); };
      density.AddRelative(pdf, projected * theta / sine * constant, 1e-11, where);
      bound.Add(std::max(projected / pdf - 1 / constant, 0.0), 1e-11, where);
      sum += weight[i] * projected / pdf;
    }
    mean.AddRelative(sum, 1, 1e-9, [&] { return Text("sigma = %g", sigma); });
  }
}

TEST(GaussianParameters, BeyondTheirEndsCountAsTheNearer) {
  const Direction m = Spherical(1e-3, 0.2), tilted = Spherical(1.2, 0.2);
  for (const Accuracy accuracy : kAccuracies) {
    const auto density = [&](const Direction& normal, float sigma) {
      return RunOne<float>("gaussian.D", 1, {accuracy}, normal, sigma)[0];
    };
    const auto c = [&](float sigma) {
      return RunOne<float>("gaussian.C", 1, {accuracy}, Column<float>{sigma})[0];
    };
    constexpr float kLargest = std::numeric_limits<float>::max(),
                    kNan = std::numeric_limits<float>::quiet_NaN();
    for (const float sigma : {2.0f, 2.5f, 1e30f, kLargest}) {
      EXPECT_EQ(c(sigma), c(2));
      EXPECT_EQ(density(tilted, sigma), density(tilted, 2));
    }
    for (const float sigma : {-kLargest, -1.0f, 0.0f, 0x1p-149f, 1e-4f}) {
      EXPECT_EQ(c(sigma), c(0));
      EXPECT_EQ(density(m, sigma), density(m, 0));
      EXPECT_NEAR(c(sigma) / c(1e-3f), 1, 1e-6);
    }
    EXPECT_TRUE(std::isnan(c(kNan)));
    EXPECT_TRUE(std::isnan(density(m, kNan)));
    EXPECT_EQ(density({0.6, 0, -0.8}, 1), 0);
    EXPECT_EQ(density({1, 0, 0}, 1), 0);
  }
}

// The typed calls, with one sigma and with one per lane.
TEST(GaussianCalls, TakeOneSigmaOrOnePerLane) {
  const float x[] = {0, 0.3f, -0.2f}, y[] = {0, 0.1f, 0.4f}, z[] = {1, 0.9f, 0.8f},
              sigma[] = {0.5f, 0.5f, 0.5f};
  float one[3], each[3];
  gaussian::D(3, {x, y, z}, 0.5, one);
  gaussian::D(3, {x, y, z}, sigma, each);
  for (int i = 0; i < 3; ++i) EXPECT_EQ(one[i], each[i]);
  float c[1];
  gaussian::C(1, sigma, c);
  EXPECT_EQ(one[0], c[0]);  // along the normal D is C
}

}  // namespace
}  // namespace microlane
