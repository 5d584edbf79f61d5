// What theory demands of interfaced Lambertian facets (Meneveaux 2015): means of F, limits, energy,
// reciprocity, and that the quadrature of rough ones tends to the integral.
#include "microlane/interfaced.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <iterator>
#include <random>
#include <string>
#include <string_view>
#include <vector>

#include "columns.h"
#include "pairs.h"
#include "quadrature.h"
#include "statistics.h"

namespace microlane {
namespace {

constexpr double kIndices[] = {1, 1 + 0x1p-23, 1.00001, 1.001, 1.1, 1.33, 1.5, 1.7, 2.42, 4};

double Mean(std::string_view id, double eta) { return RunOne<double>(id, 1, {}, Column<double>{eta})[0]; }

Column<double> Body(const Distribution& distribution, const DirectionColumns<double>& wi,
                    const DirectionColumns<double>& wo, double n, double k, int order,
                    std::string_view quantity = "eval") {
  return RunOne<double>(distribution.Model("interfaced_body", quantity), wi.size(), {}, wi, wo, distribution,
                        n, k, double{1} * order);
}

std::string Where(const Distribution& distribution, double n, double k) {
  return distribution.Text() + Text(", n = %g, k = %g", n, k);
}

// Int 2 c F dc over cosines, by cells towards 0 and, where there is total internal reflection, on either side
// of the critical angle, in the square root of the distance from it.
double MeanOfReflectance(double eta) {
  const Rule rule = GaussLegendre(64);
  const double critical = eta < 1 ? std::sqrt((1 - eta) * (1 + eta)) : 0;
  double mean = critical * critical;
  Column<double> cosines, weights;
  // c = critical + (1 - critical) x^2, x by decades down to where nothing is left of 2 c F.
  for (double high = 1; high > 1e-12; high /= 4) {
    const double low = high > 4e-12 ? high / 4 : 0;
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double x = low + (high - low) * 0.5 * (1 + rule.node[i]);
      cosines.push_back(critical + (1 - critical) * x * x);
      weights.push_back(rule.weight[i] * 0.5 * (high - low) * 2 * x * (1 - critical));
    }
  }
  const Column<double> reflectance = RunOne<double>("fresnel.dielectric", cosines.size(), {}, cosines, eta);
  for (std::size_t i = 0; i < cosines.size(); ++i) mean += 2 * cosines[i] * reflectance[i] * weights[i];
  return mean;
}

TEST(DiffuseFresnel, IsTheMeanOfTheReflectance) {
  Tally external("r_e is Int F sin(2 theta) dtheta"), internal("r_i of n is r_e of 1/n");
  for (const double n : kIndices) {
    for (const double eta : {n, 1 / n}) {
      const auto where = [&] { return Text("eta = %a", eta); };
      external.AddRelative(Mean("fresnel.diffuse_external", eta), MeanOfReflectance(eta), 1e-11, where);
      internal.AddRelative(Mean("fresnel.diffuse_internal", eta), MeanOfReflectance(1 / eta), 1e-11, where);
    }
  }
}

// n^2 (1 - r_i) = 1 - r_e, and r_e = (n - 1)/3 next to n = 1.
TEST(DiffuseFresnel, ObeysReciprocityAndItsLimit) {
  Tally sides("n^2 (1 - r_i) = 1 - r_e"), limit("r_e/(n - 1) is 1/3 at n = 1");
  for (const double n : kIndices) {
    const double left = n * n * (1 - Mean("fresnel.diffuse_internal", n));
    const auto where = [&] { return Text("n = %a", n); };
    sides.AddRelative(left, 1 - Mean("fresnel.diffuse_external", n), 1e-14, where);
    if (n > 1 && n < 1.000001) {
      limit.AddRelative(Mean("fresnel.diffuse_external", n) / (n - 1), 1.0 / 3, 1e-5, where);
    }
  }
  EXPECT_EQ(Mean("fresnel.diffuse_external", 1), 0);
  EXPECT_EQ(Mean("fresnel.diffuse_internal", 1), 0);
}

// k = 1 under a smooth interface gives back all that the interface lets in.
TEST(FlatBody, WhiteOneLosesNothing) {
  const Rule rule = GaussLegendre(200);
  Tally energy("Int f cos dwo = T(cos_i) of k = 1");
  for (const double n : {1.0, 1.1, 1.33, 1.5, 2.42, 4.0}) {
    for (const double cos_i : {1.0, 0.7, 0.3, 0.05}) {
      Column<double> cosines;
      for (const double node : rule.node) cosines.push_back(0.5 * (1 + node));
      const Column<double> f = RunOne<double>("interfaced.facet_body", cosines.size(), {},
                                              Column<double>(cosines.size(), cos_i), cosines, n, 1.0);
      double sum = 0;
      for (std::size_t i = 0; i < cosines.size(); ++i) sum += f[i] * cosines[i] * rule.weight[i] * kTestPi;
      const double entered =
          RunOne<double>("fresnel.dielectric_transmittance", 1, {}, Column<double>{cos_i}, n)[0];
      energy.AddRelative(sum, entered, 1e-5, [&] { return Text("n = %g, cos_i = %g", n, cos_i); });
    }
  }
}

std::vector<Distribution> Distributions() {
  std::vector<Distribution> distributions;
  for (const auto& make : {Ggx, Beckmann}) {
    for (const float alpha : {0.05f, 0.3f, 1.0f, 2.0f}) {
      distributions.push_back(make(alpha, alpha));
      distributions.push_back(make(alpha, 0.5f * alpha));
    }
  }
  return distributions;
}

// n = 1 is Lambertian microfacets, alpha = 0 the flat body, both Lambert, and k = 0 leaves the surface alone.
TEST(RoughBody, HasThePaperLimits) {
  const Pairs pairs(75);
  Tally lambertian("n = 1 is rough_diffuse times k"), flat("alpha = 1e-4 is the flat body"),
      lambert("alpha = 1e-4 and n = 1 is k cos/pi");
  for (const Distribution& distribution : Distributions()) {
    for (const std::string_view quantity : {"eval", "eval_separable"}) {
      const Column<double> got = Body(distribution, pairs.wi, pairs.wo, 1, 0.7, 5, quantity);
      const Column<double> dark = Body(distribution, pairs.wi, pairs.wo, 1.5, 0, 5, quantity);
      const Column<double> white = RunOne<double>(distribution.Model("rough_diffuse", quantity), pairs.size(),
                                                  {}, pairs.wi, pairs.wo, distribution, 5.0);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        lambertian.AddRelative(got[i], 0.7 * white[i], 2e-14, [&] { return distribution.Text(); });
        EXPECT_EQ(dark[i], 0) << distribution.Text();
      }
    }
  }
  for (const auto& make : {Ggx, Beckmann}) {
    const Distribution smooth = make(1e-4f, 2e-4f);
    for (const double n : {1.0, 1.33, 1.5, 2.42}) {
      const Column<double> got = Body(smooth, pairs.wi, pairs.wo, n, 0.6, 32);
      Column<double> cos_i, cos_o;
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        cos_i.push_back(pairs.wi.z[i]);
        cos_o.push_back(pairs.wo.z[i]);
      }
      const Column<double> f =
          RunOne<double>("interfaced.facet_body", pairs.size(), {}, cos_i, cos_o, n, 0.6);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto where = [&] { return Where(smooth, n, 0.6); };
        flat.AddRelative(got[i], f[i] * cos_o[i], 4e-4, where);
        if (n == 1) lambert.AddRelative(got[i], 0.6 * cos_o[i] / kTestPi, 1e-4, where);
      }
    }
  }
}

TEST(RoughBody, IsReciprocal) {
  const Pairs pairs(85);
  Tally tally("f(wi, wo) = f(wo, wi)");
  for (const Distribution& distribution : Distributions()) {
    for (const std::string_view quantity : {"eval", "eval_separable"}) {
      for (const int order : {1, 3, 6, 13}) {
        const Column<double> there = Body(distribution, pairs.wi, pairs.wo, 1.5, 0.8, order, quantity);
        const Column<double> back = Body(distribution, pairs.wo, pairs.wi, 1.5, 0.8, order, quantity);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
          tally.AddRelative(there[i] * pairs.wi.z[i], back[i] * pairs.wo.z[i], 1e-11,
                            [&] { return distribution.Text() + Text(", order %d", order); });
          EXPECT_GT(there[i], 0);
        }
      }
    }
  }
}

// Against cells of the sphere of normals, quartered until nothing changes.
TEST(RoughBody, QuadratureTendsToTheIntegral) {
  std::vector<Cell> cells;
  for (int j = 0; j < 16; ++j) {
    for (int k = 0; k < 16; ++k) {
      cells.push_back({j * kTestPi / 32, (j + 1) * kTestPi / 32, k * kTestPi / 8, (k + 1) * kTestPi / 8});
    }
  }
  Tally tally("the sum of order 32 is the integral of Meneveaux 2015 Eq. 12");
  constexpr double kAlbedo = 0.6;
  for (const auto& make : {Ggx, Beckmann}) {
    for (const float alpha : {0.2f, 1.0f}) {
      const Distribution distribution = make(alpha, 0.7f * alpha);
      for (const double n : {1.1, 1.5, 2.42}) {
        for (const double azimuth : {0.0, 1.0, kTestPi}) {
          DirectionColumns<double> wi, wo;
          wi.PushBack(Spherical(Radians(70), 0.4));
          wo.PushBack(Spherical(Radians(50), 0.4 + azimuth));
          const CellIntegrals integrals = IntegrateCells(cells, 1e-8, [&](const DirectionColumns<double>& m) {
            Column<double> value = RunOne<double>(distribution.Id("D"), m.size(), {}, m, distribution);
            Column<double> cos_i, cos_o;
            for (std::size_t i = 0; i < m.size(); ++i) {
              cos_i.push_back(Dot(wi[0], m[i]));
              cos_o.push_back(Dot(wo[0], m[i]));
            }
            const Column<double> f =
                RunOne<double>("interfaced.facet_body", m.size(), {}, cos_i, cos_o, n, kAlbedo);
            for (std::size_t i = 0; i < m.size(); ++i) {
              value[i] *= f[i] * std::max(0.0, cos_i[i]) * std::max(0.0, cos_o[i]);
            }
            return value;
          });
          double integral = 0;
          for (const double value : integrals.value) integral += value;
          const double lambda_i = RunOne<double>(distribution.Id("Lambda"), 1, {}, wi, distribution)[0];
          const double lambda_o = RunOne<double>(distribution.Id("Lambda"), 1, {}, wo, distribution)[0];
          const double exact = integral / ((1 + lambda_i + lambda_o) * wi.z[0]);
          tally.AddRelative(
              Body(distribution, wi, wo, n, kAlbedo, 32)[0], exact, 2e-5 + integrals.error / integral,
              [&] { return Where(distribution, n, kAlbedo) + Text(", azimuths %g apart", azimuth); });
        }
      }
    }
  }
}

// Each doubling of the order divides the error, more slowly where T is steep at grazing facets.
TEST(RoughBody, ErrorFallsWithTheOrder) {
  const Pairs pairs(85);
  const int orders[] = {1, 2, 4, 8, 16};
  for (const Distribution& distribution : Distributions()) {
    for (const double n : {1.01, 1.5}) {
      const Column<double> exact = Body(distribution, pairs.wi, pairs.wo, n, 0.8, 32);
      std::string text;
      double rms[5] = {};
      for (int k = 0; k < 5; ++k) {
        const Column<double> got = Body(distribution, pairs.wi, pairs.wo, n, 0.8, orders[k]);
        for (std::size_t i = 0; i < pairs.size(); ++i) {
          const double error = got[i] / exact[i] - 1;
          rms[k] += error * error / static_cast<double>(pairs.size());
        }
        rms[k] = std::sqrt(rms[k]);
        text += Text("  %d: %.1e", orders[k], rms[k]);
      }
      std::printf("[points] body of %s, rms error by order:%s\n", Where(distribution, n, 0.8).c_str(),
                  text.c_str());
      EXPECT_LT(rms[2], 0.08) << Where(distribution, n, 0.8);
      EXPECT_LT(rms[3], n < 1.1 ? 0.03 : 0.012) << Where(distribution, n, 0.8);
      EXPECT_LT(rms[3], rms[2]) << Where(distribution, n, 0.8);
      EXPECT_LT(rms[4], rms[3] / 2) << Where(distribution, n, 0.8);
    }
  }
}

// What the interface reflects and a white body gives back are at most what came.
TEST(RoughBody, EnergyIsAtMostOne) {
  constexpr int kCosines = 64, kAzimuths = 64;
  const Rule rule = GaussLegendre(kCosines);
  Tally tally("Int (f_s + f_b) cos dwo <= 1");
  double largest = 0;
  for (const auto& make : {Ggx, Beckmann}) {
    for (const float alpha : {0.2f, 0.5f, 1.0f}) {
      const Distribution distribution = make(alpha, 0.7f * alpha);
      for (const double n : {1.0, 1.1, 1.5, 2.42}) {
        for (const double theta : {0.0, 40.0, 70.0, 85.0}) {
          DirectionColumns<double> wi, wo;
          Column<double> solid_angle;
          for (int j = 0; j < kCosines; ++j) {
            for (int k = 0; k < kAzimuths; ++k) {
              const double angle = kTestPi / 4 * (1 + rule.node[j]);
              wi.PushBack(Spherical(Radians(theta), 0.7));
              wo.PushBack(Spherical(angle, (k + 0.5) * 2 * kTestPi / kAzimuths));
              solid_angle.push_back(rule.weight[j] * kTestPi / 4 * std::sin(angle) * 2 * kTestPi / kAzimuths);
            }
          }
          const Column<double> body = Body(distribution, wi, wo, n, 1, 12);
          const Column<double> surface = RunOne<double>(distribution.Dielectric("eval_reflection"), wo.size(),
                                                        {}, wi, wo, distribution, n);
          double sum = 0;
          for (std::size_t i = 0; i < wo.size(); ++i) sum += (body[i] + surface[i]) * solid_angle[i];
          largest = std::max(largest, sum);
          tally.Add(std::max(0.0, sum - 1), 1e-4,
                    [&] { return Where(distribution, n, 1) + Text(", %g degrees", theta); });
        }
      }
    }
  }
  EXPECT_GT(largest, 0.9);
  tally.Note(Text(", largest %.6f", largest));
}

// The mean of one random normal's value is the integral, whose rule is within 1e-6 of it at order 32.
TEST(OneNormal, MeanIsTheIntegralWithinItsConfidenceInterval) {
  constexpr std::size_t kSamples = 40000;
  constexpr double kAngles[][3] = {{30, 50, 100}, {70, 20, 0}, {80, 75, 180}, {60, 60, 30}, {85, 5, 250}};
  struct Estimator {
    const char *sampler, *quantity, *exact;
  };
  constexpr Estimator kEstimators[] = {
      {"sample_normal", "eval_one_normal", "eval"},
      {"sample_normal", "eval_one_normal_separable", "eval_separable"},
      {"sample_visible_normal", "eval_one_visible_normal", "eval"},
      {"sample_visible_normal", "eval_one_visible_normal_separable", "eval_separable"}};
  const double bound = NormalBound(SidakSignificance(1e-4, 2 * 3 * 2 * std::size(kAngles) * 4));
  std::mt19937_64 random(28);
  Tally tally("mean over random normals, in standard errors");
  double spread[2] = {};
  for (const auto& make : {Ggx, Beckmann}) {
    for (const float alpha : {0.1f, 0.4f, 1.0f}) {
      const Distribution distribution = make(alpha, 0.7f * alpha);
      for (const double n : {1.0, 1.5}) {
        for (const auto& [theta_i, theta_o, azimuth] : kAngles) {
          const Direction wi = Spherical(Radians(theta_i), 0.3),
                          wo = Spherical(Radians(theta_o), 0.3 + Radians(azimuth));
          for (const Estimator& e : kEstimators) {
            const bool visible = e.sampler != kEstimators[0].sampler;
            const Column<double> u1 = UniformNumbers<double>(kSamples, random),
                                 u2 = UniformNumbers<double>(kSamples, random);
            const DirectionColumns<double> m =
                visible
                    ? RunDirection<double>(distribution.Id(e.sampler), kSamples, {}, wi, u1, u2, distribution)
                    : RunDirection<double>(distribution.Id(e.sampler), kSamples, {}, u1, u2, distribution);
            const Column<double> f = RunOne<double>(distribution.Model("interfaced_body", e.quantity),
                                                    kSamples, {}, wi, wo, m, distribution, n, 0.8);
            const double exact = RunOne<double>(distribution.Model("interfaced_body", e.exact), 1, {}, wi, wo,
                                                distribution, n, 0.8, 32.0)[0];
            double sum = 0, squares = 0;
            for (const double x : f) {
              sum += x;
              squares += x * x;
            }
            const double mean = sum / kSamples;
            const double error = std::sqrt((squares / kSamples - mean * mean) / (kSamples - 1.0));
            spread[visible] += error * std::sqrt(static_cast<double>(kSamples)) / exact;
            // Of tables of float wi, and of a wi that is not quite unit.
            tally.Add(mean - exact, bound * error + 1e-6 * exact, [&] {
              return Where(distribution, n, 0.8) +
                     Text(", %s, %g %g %g degrees", e.quantity, theta_i, theta_o, azimuth);
            });
          }
        }
      }
    }
  }
  const double cases = 2 * 3 * 2 * std::size(kAngles) * 2;
  tally.Note(Text("; standard deviation %.2f of the value by D cos, %.2f by visible normals",
                  spread[0] / cases, spread[1] / cases));
  EXPECT_LT(spread[1], spread[0]);
}

// K_d = 0 leaves the interface's samples, n = 1 the cosine's; all of them together are a density.
TEST(PdfWithInterface, HasItsLimitsAndIntegratesToOneButForWhatTheInterfaceLoses) {
  const Pairs pairs(85);
  Tally surface("k = 0: pdf_visible_reflection"), body("n = 1: |cos|/pi"),
      mass("Int pdf dwo = R_b + R_s x Int pdf_visible_reflection dwo");
  const Rule rule = GaussLegendre(96);
  constexpr int kAzimuths = 128;
  for (const auto& make : {Ggx, Beckmann}) {
    for (const float alpha : {0.3f, 0.6f, 1.0f}) {
      const Distribution distribution = make(alpha, 0.7f * alpha);
      const auto pdf = [&](const DirectionColumns<double>& wi, const DirectionColumns<double>& wo, double n,
                           double k) {
        return RunOne<double>(distribution.Model("interfaced_body", "pdf_with_interface"), wo.size(), {}, wi,
                              wo, distribution, n, k);
      };
      const auto visible = [&](const DirectionColumns<double>& wi, const DirectionColumns<double>& wo) {
        return RunOne<double>(distribution.Id("pdf_visible_reflection"), wo.size(), {}, wi, wo, distribution);
      };
      const Column<double> of_surface = pdf(pairs.wi, pairs.wo, 1.5, 0),
                           of_body = pdf(pairs.wi, pairs.wo, 1, 0.5), reflected = visible(pairs.wi, pairs.wo);
      for (std::size_t i = 0; i < pairs.size(); ++i) {
        const auto where = [&] { return Where(distribution, 0, 0); };
        surface.AddRelative(of_surface[i], reflected[i], 1e-12, where);
        body.AddRelative(of_body[i], pairs.wo.z[i] / kTestPi, 1e-15, where);
      }
      for (const double theta : {0.0, 40.0, 70.0}) {
        DirectionColumns<double> wi, wo;
        Column<double> solid_angle;
        for (std::size_t j = 0; j < rule.node.size(); ++j) {
          for (int k = 0; k < kAzimuths; ++k) {
            const double angle = kTestPi / 4 * (1 + rule.node[j]);
            wi.PushBack(Spherical(Radians(theta), 0.7));
            wo.PushBack(Spherical(angle, (k + 0.5) * 2 * kTestPi / kAzimuths));
            solid_angle.push_back(rule.weight[j] * kTestPi / 4 * std::sin(angle) * 2 * kTestPi / kAzimuths);
          }
        }
        const double n = 1.5, k = 0.6, r_s = Mean("fresnel.diffuse_external", n),
                     r_i = Mean("fresnel.diffuse_internal", n);
        const double r_b = (1 - r_s) * (1 - r_s) * k / (n * n * (1 - k * r_i));
        const Column<double> both = pdf(wi, wo, n, k), one = visible(wi, wo);
        double sum = 0, above = 0;
        for (std::size_t i = 0; i < wo.size(); ++i) {
          sum += both[i] * solid_angle[i];
          above += one[i] * solid_angle[i];
        }
        mass.Add(sum - (r_s * above + r_b) / (r_s + r_b), 1e-6, [&] { return Where(distribution, n, k); });
        EXPECT_GT(above, 0.5);
        EXPECT_LT(sum, 1 + 1e-4);
      }
    }
  }
}

// Channels give what calls of one give, bit for bit, and touch n lanes.
TEST(Channels, AreSingleCalls) {
  const Pairs pairs(85);
  DirectionColumns<float> wi, wo;
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    wi.PushBack({pairs.wi.x[i], pairs.wi.y[i], pairs.wi.z[i]});
    wo.PushBack({pairs.wo.x[i], pairs.wo.y[i], pairs.wo.z[i]});
  }
  std::mt19937_64 random(5);
  Column<float> lanes_of_n = UniformNumbers<float>(pairs.size(), random);
  for (float& n : lanes_of_n) n = 1 + 3 * n;
  const Column<float> lanes_of_k = UniformNumbers<float>(pairs.size(), random);
  const QuadratureRule rule(6);
  Tally tally("EvalChannels is Eval");
  const auto check = [&](auto body, std::size_t n, std::size_t channels, Accuracy accuracy,
                         JointMasking masking) {
    constexpr float kUntouched = 12345;
    std::vector<Column<float>> out(channels, Column<float>(n + 1, kUntouched));
    std::vector<float*> to;
    std::vector<Parameter<float>> k;
    for (std::size_t c = 0; c < channels; ++c) {
      to.push_back(out[c].data());
      k.emplace_back(0.1f + 0.2f * static_cast<float>(c));
    }
    k.back() = lanes_of_k.data();
    const Directions<float> from{wi.x.data(), wi.y.data(), wi.z.data()},
        into{wo.x.data(), wo.y.data(), wo.z.data()};
    body.EvalChannels(n, from, into, {0.4f, 0.3f}, lanes_of_n.data(), channels, k.data(), rule, to.data(),
                      accuracy, masking);
    for (std::size_t c = 0; c < channels; ++c) {
      Column<float> one(n);
      body.Eval(n, from, into, {0.4f, 0.3f}, {lanes_of_n.data(), k[c]}, rule, one.data(), accuracy, masking);
      EXPECT_EQ(out[c][n], kUntouched);
      for (std::size_t i = 0; i < n; ++i) {
        EXPECT_GT(one[i], 0);
        tally.Add(out[c][i] == one[i] ? 0 : 1, 0,
                  [&] { return Text("channel %zu of %zu, lane %zu", c, channels, i); });
      }
    }
  };
  for (const Accuracy accuracy : {Accuracy::kHigh, Accuracy::kStandard, Accuracy::kFast}) {
    for (const JointMasking masking : {JointMasking::kHeightCorrelated, JointMasking::kSeparable}) {
      for (const std::size_t channels : {1, 3, 5}) {
        for (const std::size_t n : {std::size_t{1}, std::size_t{37}, pairs.size()}) {
          check(interfaced_body(), n, channels, accuracy, masking);
          check(interfaced_body_beckmann(), n, channels, accuracy, masking);
        }
      }
    }
  }
}

}  // namespace
}  // namespace microlane
