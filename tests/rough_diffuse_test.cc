// What theory demands of diffuse microfacets, and that their quadrature tends to the integral, exponentially
// with the order.
#include "microlane/rough_diffuse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <vector>

#include "columns.h"
#include "microlane/quadrature.h"
#include "pairs.h"
#include "quadrature.h"
#include "statistics.h"

namespace microlane {
namespace {

Column<double> Values(const Distribution& distribution, const DirectionColumns<double>& wi,
                      const DirectionColumns<double>& wo, int order, std::string_view quantity = "eval") {
  return RunOne<double>(distribution.Model("rough_diffuse", quantity), wi.size(), {}, wi, wo, distribution,
                        double{1} * order);
}

std::vector<Distribution> DiffuseDistributions() {
  std::vector<Distribution> distributions;
  for (const auto& make : {Ggx, Beckmann}) {
    for (const float alpha : {0.05f, 0.2f, 0.5f, 1.0f, 2.0f}) {
      distributions.push_back(make(alpha, alpha));
      distributions.push_back(make(alpha, 0.5f * alpha));
    }
  }
  return distributions;
}

// The rule knows polynomials, the circle and the densities.
TEST(QuadratureRule, IntegratesWhatItsRowsStandFor) {
  for (int order = 1; order <= static_cast<int>(QuadratureRule::kMaxOrder); ++order) {
    const QuadratureRule rule(order);
    ASSERT_TRUE(rule.ok()) << rule.error();
    const QuadratureTable<double> table = rule.Table<double>();
    ASSERT_EQ(table.order, static_cast<std::size_t>(order));
    const auto sum = [&](QuadratureRow row, const auto& function) {
      double total = 0;
      for (std::size_t i = 0; i < table.order; ++i) total += table[row][i] * function(i);
      return total;
    };
    for (int power = 0; power < 2 * order; ++power) {
      const double moment = sum(QuadratureRow::kWeight, [&](std::size_t i) {
        return std::pow(table[QuadratureRow::kBeckmannPart][i], power);
      });
      EXPECT_NEAR(moment, 1.0 / (power + 1), 2e-15) << "order " << order << ", power " << power;
    }
    for (std::size_t i = 0; i < table.order; ++i) {
      EXPECT_NEAR(
          table[QuadratureRow::kFirst][i] + table[QuadratureRow::kMiddle][i] + table[QuadratureRow::kLast][i],
          1, 1e-15);
      EXPECT_NEAR(table[QuadratureRow::kBeckmannPart][i] + table[QuadratureRow::kBeckmannRest][i], 1, 1e-15);
      EXPECT_FLOAT_EQ(rule.Table<float>()[QuadratureRow::kGgxRadius][i],
                      static_cast<float>(table[QuadratureRow::kGgxRadius][i]));
    }
    if (order < 8) continue;
    const auto one = [](std::size_t) { return 1.0; };
    EXPECT_NEAR(sum(QuadratureRow::kGgxFree, one), 0.5, 1e-10) << order;
    const double cut = table.beckmann_radius * table.beckmann_radius;
    EXPECT_NEAR(sum(QuadratureRow::kBeckmannFree, one), 0.5 * (1 - std::exp(-cut)), 1e-4) << order;
    if (order < 16) continue;
    EXPECT_NEAR(sum(QuadratureRow::kBeckmannFree, one), 0.5, 1e-9) << order;
  }
}

TEST(QuadratureRule, RefusesOrdersByNameValueAndRange) {
  const double kNan = std::nan("");
  const struct {
    double order;
    const char* text;
  } cases[] = {{0, "order = 0"}, {-1, "order = -1"}, {33, "order = 33"}, {2.5, "order = 2.5"}, {kNan, "nan"}};
  for (const auto& [order, text] : cases) {
    const QuadratureRule rule(order);
    EXPECT_FALSE(rule.ok()) << order;
    EXPECT_NE(rule.error().find("order = "), std::string::npos) << rule.error();
    EXPECT_NE(rule.error().find(text), std::string::npos) << rule.error();
    EXPECT_NE(rule.error().find("[1, 32]"), std::string::npos) << rule.error();
    const double x[] = {0, 0.6}, y[] = {0, 0}, z[] = {1, 0.8};
    double f_cos[2] = {};
    rough_diffuse::Eval(2, {x, y, z}, {x, y, z}, {0.3, 0.3}, rule, f_cos);
    EXPECT_TRUE(std::isnan(f_cos[0]) && std::isnan(f_cos[1]));
  }
}

// Against cells of the sphere of normals, quartered until nothing changes; clamps and all.
TEST(Quadrature, TendsToTheIntegral) {
  std::vector<Cell> cells;
  for (int j = 0; j < 16; ++j) {
    for (int k = 0; k < 16; ++k) {
      cells.push_back({j * kTestPi / 32, (j + 1) * kTestPi / 32, k * kTestPi / 8, (k + 1) * kTestPi / 8});
    }
  }
  Tally tally("the sum of order 32 is the integral of Heitz 2014 Eq. 31");
  std::size_t num_evaluations = 0;
  for (const auto& make : {Ggx, Beckmann}) {
    for (const float alpha : {0.1f, 0.4f, 1.0f, 2.0f}) {
      const Distribution distribution = make(alpha, 0.7f * alpha);
      for (const double azimuth : {0.0, 1.0, 2.6, kTestPi}) {
        DirectionColumns<double> wi, wo;
        wi.PushBack(Spherical(Radians(70), 0.4));
        wo.PushBack(Spherical(Radians(50), 0.4 + azimuth));
        const CellIntegrals integrals = IntegrateCells(cells, 1e-9, [&](const DirectionColumns<double>& m) {
          Column<double> value = RunOne<double>(distribution.Id("D"), m.size(), {}, m, distribution);
          for (std::size_t i = 0; i < m.size(); ++i) {
            value[i] *= std::max(0.0, Dot(wi[0], m[i])) * std::max(0.0, Dot(wo[0], m[i]));
          }
          return value;
        });
        num_evaluations += integrals.num_evaluations;
        double integral = 0;
        for (const double value : integrals.value) integral += value;
        const double lambda_i = RunOne<double>(distribution.Id("Lambda"), 1, {}, wi, distribution)[0];
        const double lambda_o = RunOne<double>(distribution.Id("Lambda"), 1, {}, wo, distribution)[0];
        const double exact = integral / ((1 + lambda_i + lambda_o) * kTestPi * wi.z[0]);
        tally.AddRelative(Values(distribution, wi, wo, 32)[0], exact, 2e-5 + integrals.error / integral, [&] {
          return distribution.Text() + ", azimuths " + std::to_string(azimuth) + " apart";
        });
      }
    }
  }
  tally.Note(", evaluations " + std::to_string(num_evaluations));
}

// Each doubling of the order divides the error by more than the last: it falls faster than any power.
TEST(Quadrature, ErrorFallsExponentiallyWithTheOrder) {
  const Pairs pairs(85);
  const int orders[] = {1, 2, 4, 8, 16};
  for (const Distribution& distribution : DiffuseDistributions()) {
    const Column<double> exact = Values(distribution, pairs.wi, pairs.wo, 32);
    std::string text;
    double rms[5] = {};
    for (int k = 0; k < 5; ++k) {
      const Column<double> got = Values(distribution, pairs.wi, pairs.wo, orders[k]);
      double largest = 0;
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const double error = got[i] / exact[i] - 1;
        rms[k] += error * error / static_cast<double>(pairs.size());
        largest = std::max(largest, std::abs(error));
      }
      rms[k] = std::sqrt(rms[k]);
      char part[80];
      std::snprintf(part, sizeof part, "  %d: %.1e (%.1e)", orders[k], rms[k], largest);
      text += part;
    }
    std::printf("[points] quadrature of %s, rms (largest) error by order:%s\n", distribution.Text().c_str(),
                text.c_str());
    EXPECT_LT(rms[1], 0.4) << distribution.Text();
    EXPECT_LT(rms[2], 0.05) << distribution.Text();
    EXPECT_LT(rms[3], 5e-3) << distribution.Text();
    EXPECT_LT(rms[4], 6e-4) << distribution.Text();
    EXPECT_LT(rms[2], rms[1] / 4) << distribution.Text();
    EXPECT_LT(rms[3], rms[2] / 4) << distribution.Text();
    EXPECT_LT(rms[4], rms[3] / 6) << distribution.Text();
  }
}

// Heitz 2014 Eq. 37: without shadowing, what leaves to either side is all of the light. A facet m sends (1 +
// m.z)/2 of it to the upper side.
TEST(WeakWhiteFurnace, DiffuseFacetsSendOnAllThatTheySee) {
  constexpr int kCosines = 32, kAzimuths = 64, kOrder = 24;
  const Rule rule = GaussLegendre(kCosines);
  Tally tally("int G1(wi) / (pi |wi.n|) <wi.m> <wo.m> D dm dwo is that of visible normals"), energy("energy");
  for (const auto& make : {Ggx, Beckmann}) {
    for (const float alpha : {0.05f, 0.2f, 0.5f, 1.0f}) {
      for (const double theta : {0.0, 30.0, 60.0, 80.0}) {
        const Distribution distribution = make(alpha, 0.6f * alpha);
        const Direction v = Spherical(Radians(theta), 0.7);
        DirectionColumns<double> wi, wo;
        Column<double> solid_angle;
        for (int j = 0; j < kCosines; ++j) {
          for (int k = 0; k < kAzimuths; ++k) {
            const double angle = kTestPi / 4 * (1 + rule.node[j]);
            wi.PushBack(v);
            wo.PushBack(Spherical(angle, (k + 0.5) * 2 * kTestPi / kAzimuths));
            solid_angle.push_back(rule.weight[j] * kTestPi / 4 * std::sin(angle) * 2 * kTestPi / kAzimuths);
          }
        }
        const Column<double> separable = Values(distribution, wi, wo, kOrder, "eval_separable");
        const Column<double> correlated = Values(distribution, wi, wo, kOrder);
        const Column<double> lambda =
            RunOne<double>(distribution.Id("Lambda"), wo.size(), {}, wo, distribution);
        double unshadowed = 0, shadowed = 0;
        for (std::size_t i = 0; i < wo.size(); ++i) {
          unshadowed += separable[i] * (1 + lambda[i]) * solid_angle[i];
          shadowed += correlated[i] * solid_angle[i];
        }
        const NormalNodes nodes = NormalsOnSide(v, alpha, 0.6f * alpha, Side::kFacing, 96, 64);
        const Column<double> visible =
            RunOne<double>(distribution.Id("D_visible"), nodes.size(), {}, v, nodes.m, distribution);
        double upwards = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
          upwards += visible[i] * 0.5 * (1 + nodes.m.z[i]) * nodes.solid_angle[i];
        }
        const auto where = [&] { return distribution.Text() + Text(", %g degrees", theta); };
        tally.AddRelative(unshadowed, upwards, 1e-4, where);
        energy.Add(std::max(0.0, shadowed - unshadowed), 0, where);
        EXPECT_LE(unshadowed, 1 + 1e-4) << where();
        EXPECT_GT(shadowed, 0.4) << where();
      }
    }
  }
}

TEST(Reciprocity, DiffuseFacets) {
  const Pairs pairs(85);
  for (const Distribution& distribution : DiffuseDistributions()) {
    for (const std::string_view quantity : {"eval", "eval_separable"}) {
      for (const int order : {1, 2, 3, 6, 13}) {
        const Column<double> there = Values(distribution, pairs.wi, pairs.wo, order, quantity);
        const Column<double> back = Values(distribution, pairs.wo, pairs.wi, order, quantity);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
          const double f = there[i] / pairs.wo.z[i], g = back[i] / pairs.wi.z[i];
          EXPECT_NEAR(f, g, 1e-11 * g) << distribution.Text() << ", order " << order;
          EXPECT_GT(f, 0) << distribution.Text() << ", order " << order;
        }
      }
    }
  }
}

TEST(SmoothLimit, DiffuseFacetsAreLambertian) {
  const Pairs pairs(75);
  for (const auto& make : {Ggx, Beckmann}) {
    const Distribution distribution = make(1e-4f, 2e-4f);
    const Column<double> f_cos = Values(distribution, pairs.wi, pairs.wo, 32);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      EXPECT_NEAR(f_cos[i], pairs.wo.z[i] / kTestPi, 1e-4 * pairs.wo.z[i]) << distribution.Text();
    }
  }
}

}  // namespace
}  // namespace microlane
