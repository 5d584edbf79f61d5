// The simulation of light inside V-cavities (Meneveaux 2015 section 3.3): exact where it must be, and within
// its interval of what the analytic model gives for one bounce.
#include "microlane/v_cavity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <thread>
#include <vector>

#include "columns.h"
#include "microlane/scalar/beckmann.h"
#include "microlane/scalar/ggx.h"
#include "microlane/scalar/v_cavity.h"
#include "microlane/targets.h"
#include "quadrature.h"
#include "statistics.h"

namespace microlane {
namespace {

VCavityScene Scene(double alpha, double degrees, VCavityFacets facets, double n = 1, double k = 0) {
  VCavityScene scene;
  scene.alpha_x = scene.alpha_y = alpha;
  scene.facets = facets;
  scene.n_i = n;
  scene.k = k;
  const Direction wi = Spherical(Radians(degrees), 0.4);
  scene.wi[0] = wi.x;
  scene.wi[1] = wi.y;
  scene.wi[2] = wi.z;
  scene.rows = 8;
  scene.columns = 16;
  scene.seed = 7;
  return scene;
}

struct Result {
  VCavityTotals totals;
  std::vector<std::uint64_t> counts;
  std::uint64_t paths;

  std::uint64_t Left() const {
    std::uint64_t sum = 0;
    for (const std::uint64_t count : counts) sum += count;
    return sum;
  }
  // Energy that leaves after that many hits, 1 the first.
  double Energy(const VCavityScene& scene, std::size_t hits) const {
    const std::size_t cells = scene.rows * scene.columns;
    std::uint64_t sum = 0;
    for (std::size_t j = 0; j < cells; ++j) sum += counts[(hits - 1) * cells + j];
    return static_cast<double>(sum) / static_cast<double>(paths);
  }
  double Energy() const { return static_cast<double>(Left()) / static_cast<double>(paths); }
};

template <class Calls>
Result Trace(const VCavityScene& scene, std::uint64_t paths, std::uint64_t first = 0) {
  Result result{{}, std::vector<std::uint64_t>(VCavityCounts(scene)), paths};
  result.totals = Calls::Trace(scene, first, paths, result.counts.data());
  return result;
}

void ExpectSame(const Result& a, const Result& b, const std::string& where) {
  EXPECT_EQ(a.counts, b.counts) << where;
  EXPECT_EQ(a.totals.hits, b.totals.hits) << where;
  EXPECT_EQ(a.totals.absorbed, b.totals.absorbed) << where;
  EXPECT_EQ(a.totals.cut, b.totals.cut) << where;
}

std::string Where(const VCavityScene& scene) {
  return Text("alpha %g, wi.z %.3g, n %g, k %g%s", scene.alpha_x, scene.wi[2], scene.n_i, scene.k,
              scene.facets == VCavityFacets::kMirror ? ", mirrors" : "");
}

std::vector<VCavityScene> Scenes() {
  std::vector<VCavityScene> scenes;
  for (const double alpha : {0.1, 0.6, 1.5}) {
    for (const double degrees : {10.0, 65.0}) {
      scenes.push_back(Scene(alpha, degrees, VCavityFacets::kMirror));
      scenes.push_back(Scene(alpha, degrees, VCavityFacets::kInterfaced, 1, 0.8));
      scenes.push_back(Scene(alpha, degrees, VCavityFacets::kInterfaced, 1.5, 0.8));
      scenes.push_back(Scene(alpha, degrees, VCavityFacets::kInterfaced, 4, 0.3));
    }
  }
  return scenes;
}

// Every path ends once: it leaves, is absorbed, or is cut.
template <class Calls>
void ExpectPathsEndOnce() {
  Tally tally("paths that left, were absorbed or cut are all paths");
  for (VCavityScene scene : Scenes()) {
    for (const std::uint32_t max_hits : {0u, 1u, 3u}) {
      for (const std::uint64_t paths : {0u, 1u, 7u, 255u, 256u, 257u, 20000u}) {
        scene.max_hits = max_hits;
        const Result result = Trace<Calls>(scene, paths);
        const std::uint64_t ends = result.Left() + result.totals.absorbed + result.totals.cut;
        tally.Add(static_cast<double>(ends) - static_cast<double>(paths), 0, [&] { return Where(scene); });
        if (max_hits == 0) {
          EXPECT_EQ(result.totals.cut, 0u);
        } else {
          EXPECT_LE(result.totals.hits, paths * max_hits);
        }
        EXPECT_GE(result.totals.hits, paths);
      }
    }
  }
}
TEST(VCavityPaths, EndOnce) {
  ExpectPathsEndOnce<v_cavity>();
  ExpectPathsEndOnce<v_cavity_beckmann>();
}

// However a range is cut, across 2^32 too, and on however many threads.
template <class Calls>
void ExpectCutsAgree() {
  constexpr std::uint64_t kPaths = 30011;
  std::size_t points = 0;
  for (const VCavityScene& scene : Scenes()) {
    for (const std::uint64_t first : {std::uint64_t{0}, (std::uint64_t{1} << 32) - 12345}) {
      const Result whole = Trace<Calls>(scene, kPaths, first);
      for (const std::uint64_t step : {1009u, 15000u}) {
        Result cut{{}, std::vector<std::uint64_t>(VCavityCounts(scene)), kPaths};
        for (std::uint64_t at = 0; at < kPaths; at += step) {
          const VCavityTotals totals =
              Calls::Trace(scene, first + at, std::min(step, kPaths - at), cut.counts.data());
          cut.totals.hits += totals.hits;
          cut.totals.absorbed += totals.absorbed;
        }
        ExpectSame(whole, cut, Where(scene));
        points += kPaths;
      }
      for (const int threads : {2, 5}) {
        std::vector<Result> parts(threads);
        std::vector<std::thread> pool;
        for (int j = 0; j < threads; ++j) {
          pool.emplace_back([&, j] {
            const std::uint64_t begin = kPaths * j / threads, end = kPaths * (j + 1) / threads;
            parts[j] = Trace<Calls>(scene, end - begin, first + begin);
          });
        }
        Result sum{{}, std::vector<std::uint64_t>(VCavityCounts(scene)), kPaths};
        for (int j = 0; j < threads; ++j) {
          pool[j].join();
          for (std::size_t i = 0; i < sum.counts.size(); ++i) sum.counts[i] += parts[j].counts[i];
          sum.totals.hits += parts[j].totals.hits;
          sum.totals.absorbed += parts[j].totals.absorbed;
        }
        ExpectSame(whole, sum, Where(scene));
        points += kPaths;
      }
    }
  }
  std::printf("  any cut of a range, and 2 and 5 threads: %zu paths, all counts equal\n", points);
}
TEST(VCavityPaths, DoNotDependOnHowARangeIsCut) {
  ExpectCutsAgree<v_cavity>();
  ExpectCutsAgree<v_cavity_beckmann>();
}

TEST(VCavityPaths, DependOnTheSeed) {
  VCavityScene scene = Scene(0.6, 30, VCavityFacets::kInterfaced, 1.5, 0.8);
  const Result one = Trace<v_cavity>(scene, 10000);
  scene.seed = 8;
  EXPECT_NE(one.counts, Trace<v_cavity>(scene, 10000).counts);
}

// Path by path against the scalar twin in double, which takes the same random numbers: a path may differ
// where a choice, an edge or a cell's border is within rounding.
template <class Calls, template <class> class Distribution>
void ExpectLanesAreTheTwin() {
  constexpr std::uint64_t kPaths = 3000;
  Tally tally("paths whose end, hits or cell is not the scalar twin's");
  for (VCavityScene scene : Scenes()) {
    scene.orders = 12;
    const scalar::VCavity<Distribution, double> twin(scene);
    const std::size_t cells = scene.rows * scene.columns;
    std::size_t different = 0;
    for (std::uint64_t number = 0; number < kPaths; ++number) {
      const Result lanes = Trace<Calls>(scene, 1, number);
      std::vector<std::uint64_t> counts(scene.orders * cells);
      const VCavityTotals totals = twin.Trace(number, 1, counts.data());
      different += counts != lanes.counts || totals.hits != lanes.totals.hits;
    }
    tally.Add(static_cast<double>(different), 0.002 * kPaths, [&] { return Where(scene); });
  }
  tally.Note(Text(", %d paths each", static_cast<int>(kPaths)));
}
TEST(VCavityPaths, AreThoseOfTheScalarTwin) {
  ExpectLanesAreTheTwin<v_cavity, scalar::Ggx>();
  ExpectLanesAreTheTwin<v_cavity_beckmann, scalar::Beckmann>();
}

// Targets with a fused multiply-add agree in every count, the others but for paths within rounding.
TEST(VCavityPaths, AgreeOnAllTargets) {
  const std::string chosen = ChosenTarget();
  std::size_t targets = 0;
  for (const VCavityScene& scene : Scenes()) {
    constexpr std::uint64_t kPaths = 20000;
    ChooseTarget("best");
    const Result best = Trace<v_cavity>(scene, kPaths);
    for (const std::string& target : SupportedTargets()) {
      ASSERT_EQ(ChooseTarget(target), "");
      const Result got = Trace<v_cavity>(scene, kPaths);
      ++targets;
      if (TargetHasFma(target)) {
        ExpectSame(best, got, target + ", " + Where(scene));
        continue;
      }
      std::uint64_t moved = 0;
      for (std::size_t i = 0; i < got.counts.size(); ++i) {
        moved += std::max(got.counts[i], best.counts[i]) - std::min(got.counts[i], best.counts[i]);
      }
      EXPECT_LE(moved, 40u) << target << ", " << Where(scene);
    }
  }
  ChooseTarget(chosen);
  std::printf("  targets: %zu runs of 20000 paths\n", targets);
}

// The share of light that T passes is below what leaving divides by, at every index.
TEST(VCavityBody, TransmittanceIsBelowItsBound) {
  Tally tally("T(c) <= 1.01 T(1)");
  for (int j = 0; j <= 300; ++j) {
    const double n = 1 + 0.01 * j, bound = std::min(1.0, 1.01 * 4 * n / ((n + 1) * (n + 1)));
    for (int i = 1; i <= 1000; ++i) {
      const double c = 0.001 * i, t = scalar::FresnelDielectric<double>(c * c, n).Transmittance();
      tally.Add(std::max(0.0, t - bound), 1e-15, [&] { return Text("n = %g, c = %g", n, c); });
    }
  }
}

// White cavities and mirrors give back all that came: every path leaves.
template <class Calls>
void ExpectWhiteLosesNothing() {
  constexpr std::uint64_t kPaths = 30000;
  Tally white("K_d = 1 loses no path"), mirrors("mirrors lose no path");
  Tally restored("all bounces of mirrors restore what the first has lost");
  for (const double alpha : {0.05, 0.4, 1.0, 3.0}) {
    for (const double degrees : {0.0, 45.0, 80.0, 89.9}) {
      for (const double n : {1.0, 1.5, 2.4}) {
        const VCavityScene scene = Scene(alpha, degrees, VCavityFacets::kInterfaced, n, 1);
        white.Add(1 - Trace<Calls>(scene, kPaths).Energy(), 0, [&] { return Where(scene); });
      }
      const VCavityScene scene = Scene(alpha, degrees, VCavityFacets::kMirror);
      const Result result = Trace<Calls>(scene, kPaths);
      mirrors.Add(1 - result.Energy(), 0, [&] { return Where(scene); });
      const double first = result.Energy(scene, 1);
      if (alpha >= 0.4 && degrees < 89) {
        EXPECT_LT(first, degrees > 60 || alpha > 0.9 ? 0.96 : 0.9999) << Where(scene);
      }
      const double rest = result.Energy(scene, 2) + result.Energy(scene, 3) + result.Energy(scene, 4);
      restored.Add(first + rest - 1, 1e-12, [&] { return Where(scene) + Text(", first %.4f", first); });
    }
  }
}
TEST(VCavityEnergy, WhiteAndMirrorsLoseNothing) {
  ExpectWhiteLosesNothing<v_cavity>();
  ExpectWhiteLosesNothing<v_cavity_beckmann>();
}

// The first bounce in each cell against the analytic model with the masking of Torrance and Sparrow,
//   f cos = Int f_m <i.m> <o.m> D min(1, 2 m.z i.z/i.m, 2 m.z o.z/o.m) dm / i.z,
// of which the interface's part is F D G/(4 i.z) at the half vector.
double Masking(const Direction& i, const Direction& o, const Direction& m) {
  return std::min({1.0, 2 * m.z * i.z / Dot(i, m), 2 * m.z * o.z / Dot(o, m)});
}

template <class Dist>
double SurfaceValue(const Dist& distribution, const Direction& i, const Direction& o,
                    const VCavityScene& scene) {
  const Direction h = Normalized(i + o);
  const double cos_i = Dot(i, h);
  const double f = scene.facets == VCavityFacets::kMirror
                       ? 1
                       : scalar::FresnelDielectric<double>(cos_i * cos_i, scene.n_i).Reflectance();
  return f * distribution.D({h.x, h.y, h.z}) * Masking(i, o, h) / (4 * i.z);
}

// Of a cell, by `count` x `count` nodes; those of the surface part grow where alpha is small.
template <class Function>
double CellIntegral(const VCavityScene& scene, std::size_t row, std::size_t column, int count,
                    const Function& function) {
  const Rule rule = GaussLegendre(count);
  double sum = 0;
  for (int a = 0; a < count; ++a) {
    for (int b = 0; b < count; ++b) {
      const double z =
          (static_cast<double>(row) + 0.5 * (1 + rule.node[a])) / static_cast<double>(scene.rows);
      const double phi = (static_cast<double>(column) + 0.5 * (1 + rule.node[b])) * 2 * kTestPi /
                         static_cast<double>(scene.columns);
      const double r = std::sqrt((1 - z) * (1 + z));
      sum +=
          rule.weight[a] * rule.weight[b] / 4 * function(Direction{r * std::cos(phi), r * std::sin(phi), z});
    }
  }
  return sum * 2 * kTestPi / static_cast<double>(scene.rows * scene.columns);
}

template <class Calls, template <class> class Distribution>
void ExpectFirstBounceIsAnalytic() {
  constexpr std::uint64_t kPaths = 2000000;
  constexpr int kTests = 24;
  std::size_t cells = 0;
  double largest = 0, least_p = 1;
  for (const double alpha : {0.3, 1.0}) {
    for (const double degrees : {0.0, 35.0, 75.0}) {
      for (const VCavityScene& scene : {Scene(alpha, degrees, VCavityFacets::kMirror),
                                        Scene(alpha, degrees, VCavityFacets::kInterfaced, 1.5, 0),
                                        Scene(alpha, degrees, VCavityFacets::kInterfaced, 1, 0.7),
                                        Scene(alpha, degrees, VCavityFacets::kInterfaced, 1.5, 0.9)}) {
        const Distribution<double> distribution{alpha, alpha};
        const Direction i{scene.wi[0], scene.wi[1], scene.wi[2]};
        const bool mirror = scene.facets == VCavityFacets::kMirror, body = !mirror && scene.k > 0;
        // Facets that i sees, with all but what depends on o.
        struct Facet {
          Direction m;
          double cos_i, weight;
        };
        std::vector<Facet> facets;
        if (body) {
          const NormalNodes nodes = AllNormals(alpha, alpha, 36);
          const double albedo = scalar::BodyAlbedo<double>(scene.n_i, scene.k);
          for (std::size_t j = 0; j < nodes.size(); ++j) {
            const Direction m = nodes.m[j];
            const double cos_i = Dot(i, m);
            if (cos_i <= 0) continue;
            const double t = scalar::FresnelDielectric<double>(cos_i * cos_i, scene.n_i).Transmittance();
            const double weight =
                distribution.D({m.x, m.y, m.z}) * nodes.solid_angle[j] * cos_i * t * albedo / (kTestPi * i.z);
            if (weight > 1e-8) facets.push_back({m, cos_i, weight});
          }
        }
        const auto body_value = [&](const Direction& o) {
          double sum = 0;
          for (const Facet& facet : facets) {
            const double cos_o = Dot(o, facet.m);
            if (cos_o <= 0) continue;
            const double t =
                scene.n_i == 1 ? 1
                               : scalar::FresnelDielectric<double>(cos_o * cos_o, scene.n_i).Transmittance();
            sum += facet.weight * t * cos_o *
                   std::min({1.0, 2 * facet.m.z * i.z / facet.cos_i, 2 * facet.m.z * o.z / cos_o});
          }
          return sum;
        };
        const Result result = Trace<Calls>(scene, kPaths);
        std::vector<double> observed, expected;
        double rest = 1, rest_count = static_cast<double>(kPaths);
        for (std::size_t row = 0; row < scene.rows; ++row) {
          for (std::size_t column = 0; column < scene.columns; ++column) {
            double share = CellIntegral(scene, row, column, 24, [&](const Direction& o) {
              return mirror || scene.n_i > 1 ? SurfaceValue(distribution, i, o, scene) : 0;
            });
            if (body) share += CellIntegral(scene, row, column, 2, body_value);
            const double count = static_cast<double>(result.counts[row * scene.columns + column]);
            observed.push_back(count);
            expected.push_back(share * kPaths);
            rest -= share;
            rest_count -= count;
            const double deviation = std::sqrt(share * (1 - share) * kPaths) + 0.5;
            largest = std::max(largest, std::abs(count - share * kPaths) / deviation);
            ++cells;
          }
        }
        observed.push_back(rest_count);
        expected.push_back(rest * kPaths);
        const ChiSquareResult test = ChiSquareTest(observed, expected);
        least_p = std::min(least_p, test.p_value);
        EXPECT_GT(test.p_value, SidakSignificance(0.001, kTests))
            << Where(scene) << ", chi-square " << test.statistic << " of " << test.degrees_of_freedom;
      }
    }
  }
  EXPECT_LT(largest, NormalBound(SidakSignificance(0.001, cells)));
  std::printf(
      "  first bounce against the analytic value: %zu cells of 2e6 paths, largest deviation %.2f sigma, "
      "least p %.3g\n",
      cells, largest, least_p);
}
TEST(VCavityFirstBounce, IsTheAnalyticValueInEachCell) {
  ExpectFirstBounceIsAnalytic<v_cavity, scalar::Ggx>();
  ExpectFirstBounceIsAnalytic<v_cavity_beckmann, scalar::Beckmann>();
}

// Meneveaux 2015 Fig. 7: inter-reflection counts for rough, almost Lambertian facets, two bounces have most
// of it, and specular dielectric facets have almost none.
TEST(VCavityInterreflection, CountsForLambertianFacetsAlone) {
  constexpr std::uint64_t kPaths = 1000000;
  for (const double degrees : {0.0, 30.0, 60.0}) {
    const VCavityScene matte = Scene(0.8, degrees, VCavityFacets::kInterfaced, 1, 1);
    const VCavityScene glossy = Scene(0.8, degrees, VCavityFacets::kInterfaced, 1.5, 0);
    for (const bool beckmann : {false, true}) {
      const auto trace = beckmann ? &Trace<v_cavity_beckmann> : &Trace<v_cavity>;
      const Result of_matte = trace(matte, kPaths, 0), of_glossy = trace(glossy, kPaths, 0);
      const double added = of_matte.Energy() - of_matte.Energy(matte, 1);
      const double specular = of_glossy.Energy() - of_glossy.Energy(glossy, 1);
      std::printf(
          "  %s, %2g degrees, %d paths: after the first bounce Lambertian facets add %.4f (the second %.4f), "
          "specular ones of n = 1.5 %.5f\n",
          beckmann ? "Beckmann" : "GGX", degrees, static_cast<int>(kPaths), added, of_matte.Energy(matte, 2),
          specular);
      EXPECT_GT(added, 0.15);
      EXPECT_GT(of_matte.Energy(matte, 2), 0.5 * added);
      EXPECT_LT(specular, 0.01);
      EXPECT_GT(specular, 0);
    }
  }
}

TEST(VCavityScene, ErrorsNameParameterValueAndRange) {
  const auto error = [](const auto& change) {
    VCavityScene scene;
    change(scene);
    std::vector<std::uint64_t> counts(16, 0);
    const VCavityTotals totals = v_cavity::Trace(scene, 0, 100, counts.data());
    EXPECT_EQ(totals.hits, 0u);
    return VCavityError(scene);
  };
  EXPECT_EQ(VCavityError(VCavityScene()), "");
  EXPECT_EQ(error([](VCavityScene& s) { s.alpha_x = 0; }), "alpha_x = 0 is outside [1e-05, 100]");
  EXPECT_EQ(error([](VCavityScene& s) { s.n_i = 0.5; }), "n_i = 0.5 is outside [1, 4]");
  EXPECT_EQ(error([](VCavityScene& s) { s.k = NAN; }), "k = nan is outside [0, 1]");
  EXPECT_EQ(error([](VCavityScene& s) { s.rows = 0; }), "rows = 0 is outside [1, 2^26]");
  EXPECT_NE(error([](VCavityScene& s) { s.rows = s.columns = 1 << 20; }), "");
  EXPECT_EQ(error([](VCavityScene& s) { s.wi[2] = -1; }), "wi = (0, 0, -1) is not above the surface");
  EXPECT_NE(error([](VCavityScene& s) { s.wi[0] = INFINITY; }), "");
  std::printf("  7 scenes with an error\n");
}

}  // namespace
}  // namespace microlane
