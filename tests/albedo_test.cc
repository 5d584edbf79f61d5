// Tables of albedo against sums over normals drawn from D cos, which know nothing of their quadrature.
#include "microlane/albedo.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <string>
#include <vector>

#include "microlane/scalar/albedo.h"
#include "microlane/scalar/fresnel.h"

namespace microlane {
namespace {

constexpr double kPi = 3.14159265358979323846;

double Reflectance(const SpecularLobe& lobe, double c) {
  if (lobe.facets == Reflector::kMirror) return 1;
  if (lobe.facets == Reflector::kSchlick) return scalar::FresnelSchlick(1 - c, lobe.f0);
  return scalar::ConductorOfCosine(c, lobe.n, lobe.kappa);
}

double Lambda(const SpecularLobe& lobe, double z) {
  const double a = z / (lobe.roughness * std::sqrt(std::max(1e-300, 1 - z * z)));
  if (lobe.normals == Normals::kGgx) return (std::sqrt(1 + 1 / (a * a)) - 1) / 2;
  return (std::exp(-a * a) / (a * std::sqrt(kPi)) - std::erfc(a)) / 2;
}

// E[F wo.z/(wi.m)] of Kelemen 2001 section 2.1.5, or with Walter 2007 Eq. 41 in place of wo.z/(wi.m), at the
// midpoints of a grid of random numbers.
double SampledAlbedo(const SpecularLobe& lobe, double mu, int steps) {
  const double sine = std::sqrt((1 - mu) * (1 + mu));
  double sum = 0;
  for (int i = 0; i < steps; ++i) {
    const double s = (i + 0.5) / steps, u = s * s * (3 - 2 * s),
                 weight = 6 * s * (1 - s);  // crowded at both ends
    const double tangent = lobe.normals == Normals::kGgx ? lobe.roughness * std::sqrt(u / (1 - u))
                           : lobe.normals == Normals::kBeckmann
                               ? lobe.roughness * std::sqrt(-std::log1p(-u))
                               : std::sqrt(std::pow(u, -2 / (lobe.roughness + 2)) - 1);
    const double cos_m = 1 / std::sqrt(1 + tangent * tangent), sin_m = tangent * cos_m;
    for (int j = 0; j < steps; ++j) {
      const double c = mu * cos_m + sine * sin_m * std::cos(kPi * (j + 0.5) / steps), z = 2 * c * cos_m - mu;
      if (!(c > 0 && z > 0)) continue;
      const double f = Reflectance(lobe, std::min(1.0, c));
      if (lobe.masking == LobeMasking::kKelemen) {
        sum += weight * f * z / c;
      } else {
        const double in = Lambda(lobe, mu), out = Lambda(lobe, std::min(z, 1.0));
        const double g = lobe.masking == LobeMasking::kSeparable ? (1 + in) * (1 + out) : 1 + in + out;
        sum += weight * f * c / (mu * cos_m * g);
      }
    }
  }
  return sum / steps / steps;
}

SpecularLobe Lobe(Normals normals, double roughness, LobeMasking masking, Reflector facets, double n,
                  double kappa) {
  SpecularLobe lobe{normals, roughness, masking, facets};
  lobe.n = n;
  lobe.kappa = kappa;
  return lobe;
}

double Looked(const AlbedoTable& table, double mu) {
  return scalar::Interpolate(table.entries().albedo, scalar::FindCell(table.entries(), mu));
}

TEST(AlbedoTable, AgreesWithSumsOverSampledNormals) {
  const SpecularLobe lobes[] = {
      WardLobe(0.03, 1.7),
      WardLobe(0.8, 1.7),
      WardLobe(0.1, 4),
      Lobe(Normals::kBeckmann, 0.1, LobeMasking::kKelemen, Reflector::kMirror, 1, 0),
      Lobe(Normals::kPhong, 50, LobeMasking::kKelemen, Reflector::kConductor, 1.7, 0),
      Lobe(Normals::kGgx, 0.3, LobeMasking::kKelemen, Reflector::kConductor, 0.2, 3.4),
      Lobe(Normals::kGgx, 0.2, LobeMasking::kHeightCorrelated, Reflector::kConductor, 1.5, 0),
      Lobe(Normals::kGgx, 0.2, LobeMasking::kSeparable, Reflector::kSchlick, 1, 0),
      Lobe(Normals::kBeckmann, 0.5, LobeMasking::kHeightCorrelated, Reflector::kConductor, 0.2, 3.4),
      Lobe(Normals::kBeckmann, 0.5, LobeMasking::kSeparable, Reflector::kMirror, 1, 0),
  };
  double largest = 0;
  for (const SpecularLobe& lobe : lobes) {
    const AlbedoTable table(lobe);
    ASSERT_TRUE(table.ok()) << table.error();
    for (const double mu : {0.013, 0.11, 0.34, 0.71, 0.97}) {
      // The edge of what is reflected costs the sum a few parts in 10^5.
      const double sum = SampledAlbedo(lobe, mu, 700);
      largest = std::max(largest, std::abs(Looked(table, mu) - sum));
      EXPECT_NEAR(Looked(table, mu), sum, 1.5e-4)
          << static_cast<int>(lobe.normals) << " " << lobe.roughness << " " << mu;
    }
  }
  std::printf("[albedo] largest difference from sums over sampled normals: %.2g\n", largest);
}

TEST(AlbedoTable, IsLinearBetweenNodesToWithinItsError) {
  double largest = 0;
  for (const double m : {1e-4, 1e-3, 0.01, 0.03, 0.1, 0.3, 0.8, 1.0, 10.0}) {
    for (const double index : {1.0003, 1.1, 1.33, 1.7, 4.0}) {
      const AlbedoTable table(WardLobe(m, index));
      ASSERT_TRUE(table.ok()) << table.error();
      for (std::size_t j = 0; j < table.entries().last; j += j < 64 ? 1 : 7) {
        for (const double part : {0.3, 0.5}) {
          const double mu = (1 - part) * table.entries().Node(j) + part * table.entries().Node(j + 1);
          const double error = std::abs(Looked(table, mu) - DirectionalAlbedo(table.lobe(), mu));
          largest = std::max(largest, error);
          ASSERT_LE(error, 1e-4) << m << " " << index << " " << mu;
        }
      }
    }
  }
  std::printf("[albedo] largest interpolation error of Ward's: %.2g\n", largest);
}

TEST(AlbedoTable, LeavesTheAverageDeficitThatItsCellsHave) {
  for (const SpecularLobe& lobe : {WardLobe(0.03, 1.7), WardLobe(0.8, 1.7), WardLobe(1e-4, 1.5)}) {
    const AlbedoTable table(lobe);
    const AlbedoEntries& entries = table.entries();
    double sum = 0;  // Simpson's rule is exact on a cell
    for (std::size_t j = 0; j < entries.last; ++j) {
      const double a = entries.Node(j), b = entries.Node(j + 1);
      const double r0 = static_cast<double>(entries.deficit[j]),
                   r1 = static_cast<double>(entries.deficit[j + 1]);
      sum += (b - a) / 6 * (a * r0 + (a + b) * (r0 + r1) + b * r1);
      EXPECT_NEAR(static_cast<double>(entries.albedo[j]) + r0, 1, 1e-7);
    }
    EXPECT_NEAR(2 * sum, entries.mean_deficit, 1e-13);
    EXPECT_NEAR(table.average(), 1 - 2 * sum, 1e-13);
    EXPECT_EQ(entries.cumulative[entries.last], 0);
    EXPECT_EQ(2 * entries.cumulative[0], entries.mean_deficit);
  }
}

TEST(AlbedoTable, BecomesTheFacetsReflectanceAsRoughnessVanishes) {
  const AlbedoTable table(WardLobe(1e-4, 1.7));
  for (const double mu : {0.05, 0.2, 0.5, 0.9, 1.0}) {
    EXPECT_NEAR(Looked(table, mu), scalar::ConductorOfCosine(mu, 1.7, 0.0), 1e-4) << mu;
  }
}

TEST(AlbedoTable, IsZeroWithoutAnInterface) {
  const AlbedoTable table(WardLobe(0.3, 1));
  ASSERT_TRUE(table.ok()) << table.error();
  EXPECT_NEAR(table.average(), 0, 1e-13);
  for (const double mu : {0.0, 0.5, 1.0}) EXPECT_EQ(Looked(table, mu), 0);
}

TEST(AlbedoTable, RefusesWhatItCannotHold) {
  const auto error = [](const SpecularLobe& lobe) { return AlbedoTable(lobe).error(); };
  EXPECT_EQ(error(WardLobe(0, 1.5)), "alpha = 0 is outside [1e-05, 100]");
  EXPECT_EQ(error(WardLobe(0.3, 11)), "n = 11 is outside [0.05, 10]");
  EXPECT_NE(error(WardLobe(NAN, 1.5)), "");
  EXPECT_NE(error(WardLobe(0.3, 0.9)).find("total internal reflection"), std::string::npos);
  EXPECT_NE(error(Lobe(Normals::kPhong, 10, LobeMasking::kSeparable, Reflector::kMirror, 1, 0)), "");
  const AlbedoTable refused(WardLobe(0, 1.5));
  float albedo = 0, deficit = 0;
  const float cosine = 0.5f;
  albedo::Directional(1, &cosine, refused, &albedo, &deficit);
  EXPECT_TRUE(std::isnan(albedo) && std::isnan(deficit));
}

TEST(AlbedoTable, TakesAtMost16KiB) {
  for (const double m : {1e-5, 1e-4, 0.03, 0.8, 100.0}) {
    const std::clock_t start = std::clock();  // of this process, which does nothing else
    const AlbedoTable table(WardLobe(m, 1.7));
    const double time = 1e3 * static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
    EXPECT_LE(table.bytes(), 16384u) << m;
    std::printf("[albedo] m = %g: %zu bytes, built in %.2f ms\n", m, table.bytes(), time);
  }
}

}  // namespace
}  // namespace microlane
