// The coupled specular-matte model of Kelemen 2001 and its specular lobe.
#include "microlane/coupled.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "columns.h"
#include "statistics.h"

namespace microlane {
namespace {

struct Material {
  double m, index;
};
constexpr Material kMaterials[] = {{0.03, 1.7}, {0.8, 1.7}, {0.1, 1.5}, {0.3, 4}, {0.001, 1.33}, {2, 1.7}};
constexpr std::string_view kSpecular = "rough_conductor_beckmann.";  // at kappa = 0

std::string Describe(const Material& material) { return Text("m %g index %g", material.m, material.index); }

template <class T, class... V>
std::vector<Column<T>> RunSpecular(std::string_view quantity, std::size_t n, const Material& material,
                                   const V&... v) {
  return RunAll<T>(std::string(kSpecular) + std::string(quantity), n, {}, v..., material.m, material.m,
                   material.index, 0.0);
}

// Random directions of the upper side, uniform over solid angle.
DirectionColumns<double> Hemisphere(std::size_t n, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const Column<double> u1 = UniformNumbers<double>(n, random), u2 = UniformNumbers<double>(n, random);
  DirectionColumns<double> directions;
  for (std::size_t i = 0; i < n; ++i)
    directions.PushBack(Spherical(std::acos(1 - u1[i]), 2 * kTestPi * u2[i]));
  return directions;
}

// The specular part as the mean weight of samples by P_H at the midpoints of a grid, the matte part, which
// does not depend on the azimuth, by a rule in its cosine.
TEST(Coupled, ReflectsAllLightWithAWhiteMattePart) {
  constexpr std::size_t kSteps = 700, kCosines = 4000;
  double largest = 0;
  Column<double> u1, u2;
  for (std::size_t i = 0; i < kSteps * kSteps; ++i) {
    u1.push_back((static_cast<double>(i / kSteps) + 0.5) / kSteps);
    u2.push_back((static_cast<double>(i % kSteps) + 0.5) / kSteps);
  }
  DirectionColumns<double> wo;
  for (std::size_t i = 0; i < kCosines; ++i) {
    const double z = (static_cast<double>(i) + 0.5) / kCosines;
    wo.PushBack({0, std::sqrt(1 - z * z), z});  // away from the plane of wi and of the lobe
  }
  for (const Material& material : kMaterials) {
    for (const double degrees : {0.0, 20.0, 40.0, 60.0, 75.0, 85.0, 89.0}) {
      const Direction wi = Spherical(Radians(degrees), 0);
      const Column<double> weight = RunSpecular<double>("sample_kelemen", u1.size(), material, wi, u1, u2)[3];
      double specular = 0;
      for (const double w : weight) specular += w / static_cast<double>(weight.size());
      const Column<double> white =
          RunOne<double>("coupled.eval", kCosines, {}, wi, wo, 1.0, material.m, material.index);
      const Column<double> black =
          RunOne<double>("coupled.eval", kCosines, {}, wi, wo, 0.0, material.m, material.index);
      double matte = 0;
      for (std::size_t i = 0; i < kCosines; ++i) matte += 2 * kTestPi * (white[i] - black[i]) / kCosines;
      largest = std::max(largest, std::abs(specular + matte - 1));
      EXPECT_NEAR(specular + matte, 1, 2e-4) << Describe(material) << " at " << degrees;
    }
  }
  std::printf("  total albedo of k = 1 off by at most %.2g\n", largest);
}

TEST(Coupled, IsReciprocal) {
  constexpr std::size_t kCount = 20000;
  const DirectionColumns<double> a = Hemisphere(kCount, 1), b = Hemisphere(kCount, 2);
  Tally tally("f(wi, wo) against f(wo, wi)");
  for (const Material& material : kMaterials) {
    const Column<double> ab =
        RunOne<double>("coupled.eval", kCount, {}, a, b, 0.7, material.m, material.index);
    const Column<double> ba =
        RunOne<double>("coupled.eval", kCount, {}, b, a, 0.7, material.m, material.index);
    for (std::size_t i = 0; i < kCount; ++i) {
      tally.AddRelative(ab[i] / b.z[i], ba[i] / a.z[i], 1e-9, [&] { return Describe(material); });
    }
  }
}

TEST(Coupled, SamplesCarryTheirDensityAndValueOverIt) {
  constexpr std::size_t kCount = 20000;
  Tally densities("pdf of samples against coupled.pdf"), weights("weight pdf against f cos");
  double largest = 0;
  for (const Material& material : kMaterials) {
    for (const double k : {0.0, 0.3, 1.0}) {
      std::mt19937_64 random(3);
      const DirectionColumns<double> wi = Hemisphere(kCount, 4);
      const Column<double> u1 = UniformNumbers<double>(kCount, random),
                           u2 = UniformNumbers<double>(kCount, random),
                           u3 = UniformNumbers<double>(kCount, random);
      const auto out =
          RunAll<double>("coupled.sample", kCount, {}, wi, u1, u2, u3, k, material.m, material.index);
      const DirectionColumns<double> wo{out[0], out[1], out[2]};
      const auto value =
          RunAll<double>("coupled.eval_pdf", kCount, {}, wi, wo, k, material.m, material.index);
      const auto albedo = RunAll<double>("albedo.directional", kCount, {}, wi.z, material.m, material.index);
      for (std::size_t i = 0; i < kCount; ++i) {
        const bool specular = u3[i] < albedo[0][i],
                   matte = !specular && u3[i] < albedo[0][i] + k * albedo[1][i];
        if (out[5][i] == 0) {
          EXPECT_TRUE(specular || !matte);
          EXPECT_EQ(out[3][i] + out[4][i], 0);
          continue;
        }
        EXPECT_EQ(out[5][i], specular ? 1 : 2);
        EXPECT_TRUE(specular || matte);
        const auto where = [&] { return Describe(material) + Text(", k %g", k); };
        const double tolerance = 1e-8 * (1 + 1 / wi.z[i]) * (1 + 1 / wo.z[i]);
        densities.AddRelative(out[4][i], value[1][i], tolerance, where);
        weights.AddRelative(out[3][i] * out[4][i], value[0][i], tolerance, where);
        // f cos = p_s w + M and pdf = a p_s + M, w <= 2.
        EXPECT_LE(out[3][i], std::max(1.0, 2 / albedo[0][i]) * (1 + 1e-9));
        largest = std::max(largest, out[3][i]);
      }
    }
  }
  weights.Note(Text(", largest weight %g", largest));
}

// Section 2.1.4: F cos(theta')/cos(beta), at most 2.
TEST(KelemenLobe, SpecularWeightsAreAtMostTwo) {
  constexpr std::size_t kCount = 100000;
  double largest = 0;
  for (const Material& material : kMaterials) {
    std::mt19937_64 random(5);
    const DirectionColumns<float> wi = [&] {
      const DirectionColumns<double> v = Hemisphere(kCount, 6);
      DirectionColumns<float> floats;
      for (std::size_t i = 0; i < kCount; ++i) floats.PushBack(v[i]);
      return floats;
    }();
    const Column<float> u1 = UniformNumbers<float>(kCount, random),
                        u2 = UniformNumbers<float>(kCount, random);
    for (const float weight : RunAll<float>("rough_mirror_beckmann.sample_kelemen", kCount, {}, wi, u1, u2,
                                            material.m, material.m)[3]) {
      largest = std::max(largest, double{weight});
    }
  }
  EXPECT_LE(largest, 2);
  EXPECT_GT(largest, 1.5);
  std::printf("  largest specular weight of the mirror %g\n", largest);
}

// Fig. 2: F = 1, m = 0.1, angles 22.5, 45 and 67.5 degrees.
TEST(KelemenLobe, PeaksBeyondTheMirrorDirection) {
  double last = 0;
  for (const double degrees : {22.5, 45.0, 67.5}) {
    DirectionColumns<double> wo;
    for (int i = 0; i < 9000; ++i) wo.PushBack(Spherical(Radians(i * 0.01), kTestPi));
    const Column<double> f_cos = RunOne<double>("rough_mirror_beckmann.eval_kelemen", wo.size(), {},
                                                Spherical(Radians(degrees), 0), wo, 0.1, 0.1);
    std::size_t peak = 0;
    for (std::size_t i = 0; i < wo.size(); ++i) {
      if (f_cos[i] / wo.z[i] > f_cos[peak] / wo.z[peak]) peak = i;
    }
    const double beyond = static_cast<double>(peak) * 0.01 - degrees;
    EXPECT_GT(beyond, last) << degrees;
    last = beyond;
    std::printf("  peak %.2f degrees beyond the mirror direction at %g\n", beyond, degrees);
  }
}

// The model is Ward's over a dielectric: the table of another lobe would give another model's albedo.
TEST(Coupled, RefusesTablesOfOtherLobes) {
  SpecularLobe metal = WardLobe(0.3, 0.2), smith = WardLobe(0.3, 1.5), mirror = smith, ggx = smith;
  metal.kappa = 3;
  smith.masking = LobeMasking::kHeightCorrelated;
  mirror.facets = Reflector::kMirror;
  ggx.normals = Normals::kGgx;
  const float x[] = {0, 0.6f}, y[] = {0, 0}, z[] = {1, 0.8f}, u[] = {0.3f, 0.9f};
  const Directions<float> w{x, y, z};
  std::size_t outputs = 0;
  for (const SpecularLobe& lobe : {metal, smith, mirror, ggx, WardLobe(-1, 1.5)}) {
    const AlbedoTable table(lobe);
    float out[10][2] = {};
    coupled::Eval(2, w, w, 1.f, table, out[0]);
    coupled::Pdf(2, w, w, 1.f, table, out[1]);
    coupled::EvalPdf(2, w, w, 1.f, table, out[2], out[3]);
    coupled::Sample<float>(2, w, u, u, u, 1.f, table, {{out[4], out[5], out[6]}, out[7], out[8], out[9]});
    for (const auto& lanes : out) {
      for (const float value : lanes) {
        EXPECT_TRUE(std::isnan(value)) << table.error();
        ++outputs;
      }
    }
  }
  std::printf("  %zu outputs of tables of other lobes are NaN\n", outputs);
}

TEST(Coupled, IsLambertianWithoutAnInterface) {
  constexpr std::size_t kCount = 1000;
  const DirectionColumns<double> wi = Hemisphere(kCount, 7), wo = Hemisphere(kCount, 8);
  const auto value = RunAll<double>("coupled.eval_pdf", kCount, {}, wi, wo, 0.6, 0.3, 1.0);
  for (std::size_t i = 0; i < kCount; ++i) {
    EXPECT_NEAR(value[0][i], 0.6 * wo.z[i] / kTestPi, 1e-15);
    EXPECT_NEAR(value[1][i], 0.6 * wo.z[i] / kTestPi, 1e-15);
  }
}

// m to 0: samples of the specular part gather about the mirror direction, with F over its own table's albedo.
TEST(Coupled, BecomesASmoothMirrorOverAMattePart) {
  constexpr std::size_t kCount = 2000;
  std::mt19937_64 random(9);
  const Direction wi = Spherical(0.6, 0);
  const Column<double> u1 = UniformNumbers<double>(kCount, random),
                       u2 = UniformNumbers<double>(kCount, random);
  const auto out =
      RunAll<double>("coupled.sample", kCount, {}, wi, u1, u2, Column<double>(kCount, 0), 0.5, 1e-4, 1.7);
  const double F = RunOne<double>("fresnel.dielectric", 1, {}, Column<double>(1, wi.z), 1.7)[0];
  const double a = RunOne<double>("albedo.directional", 1, {}, Column<double>(1, wi.z), 1e-4, 1.7)[0];
  for (std::size_t i = 0; i < kCount; ++i) {
    ASSERT_EQ(out[5][i], 1);
    EXPECT_LT(Length(Direction{out[0][i], out[1][i], out[2][i]} - Direction{-wi.x, -wi.y, wi.z}), 2e-3);
    EXPECT_NEAR(out[3][i], F / a, 3e-3 * F / a);
  }
  EXPECT_NEAR(a, F, 1e-4);
}

}  // namespace
}  // namespace microlane
