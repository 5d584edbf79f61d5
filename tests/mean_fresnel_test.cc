// That means over visible normals tend to the integral, and how far the fit is from them.
#include "microlane/mean_fresnel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <string>
#include <string_view>
#include <vector>

#include "columns.h"
#include "quadrature.h"
#include "statistics.h"

namespace microlane {
namespace {

struct Facets {
  std::string_view quantity;
  double q0, q1;
  double order8, order16;  // largest differences from order 32
};

// Index 1.5 and 2.5, gold and aluminium, Schlick's of f0 = 0 and 0.04; and glass from inside, where some
// normals reflect totally.
constexpr Facets kFacets[] = {{"dielectric", 1.5, 0, 3e-3, 3e-4},   {"dielectric", 2.5, 0, 3e-3, 3e-4},
                              {"conductor", 0.18, 3.4, 3e-4, 1e-4}, {"conductor", 1.5, 7.6, 3e-3, 3e-4},
                              {"schlick", 0, 0, 3e-3, 3e-4},        {"schlick", 0.04, 0, 3e-3, 3e-4},
                              {"dielectric", 1 / 1.5, 0, 0.5, 0.2}};

// Directions from the normal to 89 degrees, at several azimuths.
DirectionColumns<double> Views() {
  DirectionColumns<double> v;
  for (const double theta : {0.0, 20.0, 45.0, 60.0, 75.0, 85.0, 89.0}) {
    for (const double azimuth : {0.0, 0.4, 1.1, 1.5, 2.9}) v.PushBack(Spherical(Radians(theta), azimuth));
  }
  return v;
}

Column<double> Means(const Distribution& distribution, const Facets& facets,
                     const DirectionColumns<double>& v, int order) {
  const std::string id = distribution.Model("mean_fresnel", facets.quantity);
  if (facets.quantity == "conductor") {
    return RunOne<double>(id, v.size(), {}, v, distribution, facets.q0, facets.q1, double{1} * order);
  }
  return RunOne<double>(id, v.size(), {}, v, distribution, facets.q0, double{1} * order);
}

std::vector<Distribution> Distributions() {
  std::vector<Distribution> distributions;
  for (const auto& make : {Ggx, Beckmann}) {
    for (const float alpha : {0.05f, 0.2f, 0.5f, 1.0f, 2.0f}) {
      distributions.push_back(make(alpha, alpha));
      distributions.push_back(make(alpha, 0.4f * alpha));
    }
  }
  return distributions;
}

std::string Name(const Facets& facets) {
  return std::string(facets.quantity) + Text(" %g %g", facets.q0, facets.q1);
}

double Reflectance(const Facets& facets, double cosine) {
  const std::string id = "fresnel." + std::string(facets.quantity);
  const Column<double> cosines{cosine};
  return facets.quantity == "conductor" ? RunOne<double>(id, 1, {}, cosines, facets.q0, facets.q1)[0]
                                        : RunOne<double>(id, 1, {}, cosines, facets.q0)[0];
}

// Against cells of the sphere of normals with D_visible, quartered until nothing changes.
TEST(MeanFresnel, TendsToTheIntegralOverVisibleNormals) {
  std::vector<Cell> cells;
  for (int j = 0; j < 16; ++j) {
    for (int k = 0; k < 16; ++k) {
      cells.push_back({j * kTestPi / 32, (j + 1) * kTestPi / 32, k * kTestPi / 8, (k + 1) * kTestPi / 8});
    }
  }
  Tally tally("the sum of order 32 is the integral of Heitz 2014 Eq. 105");
  std::size_t num_evaluations = 0;
  for (const auto& make : {Ggx, Beckmann}) {
    for (const float alpha : {0.2f, 0.7f, 2.0f}) {
      const Distribution distribution = make(alpha, 0.5f * alpha);
      for (const double theta : {0.0, 50.0, 80.0}) {
        const Direction view = Spherical(Radians(theta), 0.4);
        for (const Facets& facets : kFacets) {
          if (facets.order8 > 0.01) continue;
          const CellIntegrals integrals = IntegrateCells(cells, 1e-8, [&](const DirectionColumns<double>& m) {
            Column<double> value =
                RunOne<double>(distribution.Id("D_visible"), m.size(), {}, view, m, distribution);
            Column<double> cosine;
            for (std::size_t i = 0; i < m.size(); ++i) cosine.push_back(std::max(0.0, Dot(view, m[i])));
            const std::string id = "fresnel." + std::string(facets.quantity);
            const Column<double> F = facets.quantity == "conductor"
                                         ? RunOne<double>(id, m.size(), {}, cosine, facets.q0, facets.q1)
                                         : RunOne<double>(id, m.size(), {}, cosine, facets.q0);
            for (std::size_t i = 0; i < m.size(); ++i) value[i] *= F[i];
            return value;
          });
          num_evaluations += integrals.num_evaluations;
          double integral = 0;
          for (const double value : integrals.value) integral += value;
          DirectionColumns<double> v;
          v.PushBack(view);
          tally.Add(std::abs(Means(distribution, facets, v, 32)[0] - integral), 3e-5 + integrals.error,
                    [&] { return distribution.Text() + ", " + Name(facets) + Text(", %g degrees", theta); });
        }
      }
    }
  }
  tally.Note(", evaluations " + std::to_string(num_evaluations));
}

TEST(MeanFresnel, ErrorFallsWithTheOrder) {
  const DirectionColumns<double> v = Views();
  for (const Facets& facets : kFacets) {
    const int orders[] = {2, 4, 8, 16};
    double largest[4] = {};
    for (const Distribution& distribution : Distributions()) {
      const Column<double> exact = Means(distribution, facets, v, 32);
      for (int k = 0; k < 4; ++k) {
        const Column<double> got = Means(distribution, facets, v, orders[k]);
        for (std::size_t i = 0; i < v.size(); ++i)
          largest[k] = std::max(largest[k], std::abs(got[i] - exact[i]));
      }
    }
    std::printf(
        "[points] mean of %s, largest error by order over %zu views and 20 surfaces: 2: %.1e  4: %.1e  8: "
        "%.1e  16: %.1e\n",
        Name(facets).c_str(), v.size(), largest[0], largest[1], largest[2], largest[3]);
    EXPECT_LT(largest[2], facets.order8) << Name(facets);
    EXPECT_LT(largest[3], facets.order16) << Name(facets);
  }
}

// F = 1 is 1 whatever the order; a smooth surface has the F of its own normal; and the mean is one of F's
// values.
TEST(MeanFresnel, LimitsComeOut) {
  const DirectionColumns<double> v = Views();
  for (const int order : {1, 2, 3, 8, 32}) {
    for (const Distribution& distribution : Distributions()) {
      for (const double F : Means(distribution, {"schlick", 1, 0, 0, 0}, v, order)) EXPECT_NEAR(F, 1, 4e-15);
      for (const double F : Means(distribution, {"dielectric", 1, 0, 0, 0}, v, order)) EXPECT_EQ(F, 0);
      for (const double F : Means(distribution, kFacets[1], v, order)) {
        EXPECT_GE(F, Reflectance(kFacets[1], 1) * (1 - 1e-13));
        EXPECT_LE(F, 1);
      }
    }
  }
  for (const auto& make : {Ggx, Beckmann}) {
    for (const Facets& facets : kFacets) {
      const Column<double> means = Means(make(1e-5f, 1e-5f), facets, v, 32);
      for (std::size_t i = 0; i < v.size(); ++i) {
        EXPECT_NEAR(means[i], Reflectance(facets, v.z[i]), 3e-4) << Name(facets) << ", cosine " << v.z[i];
      }
    }
  }
}

// Largest errors of F.
struct FitBounds {
  Distribution (*make)(float, float);
  double schlick, others;
};
constexpr FitBounds kFitBounds[] = {{Ggx, 0.006, 0.05}, {Beckmann, 0.0014, 0.03}};

// The fit against the sum of order 32: Schlick's F within what its note says, others as printed.
TEST(MeanFresnelCosine, IsWithinWhatItsNoteSays) {
  for (const auto& [make, schlick, others] : kFitBounds) {
    std::vector<float> alphas;
    for (int i = 0; i <= 48; ++i)
      alphas.push_back(std::min(2.f, 1e-5f * std::pow(2e5f, static_cast<float>(i) / 48)));
    DirectionColumns<double> v;
    for (int j = 0; j <= 90; ++j) v.PushBack(Spherical(Radians(std::min(89.99, 1.0 * j)), 0.3));
    for (const Facets& facets : kFacets) {
      double largest = 0, sum = 0;
      std::string where;
      for (const float alpha : alphas) {
        const Distribution distribution = make(alpha, alpha);
        const Column<double> means = Means(distribution, facets, v, 32);
        const std::string id = distribution.Model("mean_fresnel", "cosine");
        const Column<double> cosine = RunOne<double>(id, v.size(), {}, v.z, double{alpha});
        for (std::size_t i = 0; i < v.size(); ++i) {
          EXPECT_GT(cosine[i], 0);
          EXPECT_LE(cosine[i], 1);
          const double error = std::abs(Reflectance(facets, cosine[i]) - means[i]);
          sum += error * error;
          if (error > largest) where = Text("alpha %g, cosine %g", double{alpha}, v.z[i]);
          largest = std::max(largest, error);
        }
      }
      const std::size_t count = alphas.size() * v.size();
      std::printf(
          "[points] fit of the cosine, %s over %s: %zu points, largest error of F %.2e at %s, rms %.1e\n",
          Name(facets).c_str(), make(1, 1).Text().c_str(), count, largest, where.c_str(),
          std::sqrt(sum / static_cast<double>(count)));
      if (facets.quantity == "schlick") {
        EXPECT_LT(largest, schlick * (1 - facets.q0)) << Name(facets);
      } else if (facets.q0 > 1 || facets.quantity == "conductor") {
        EXPECT_LT(largest, others) << Name(facets);
      }
    }
  }
}

}  // namespace
}  // namespace microlane
