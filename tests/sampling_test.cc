// Properties of every sampler: its density, its weights and its edges. All random numbers have fixed seeds.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <random>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "columns.h"
#include "quadrature.h"
#include "statistics.h"

namespace microlane {
namespace {

constexpr double kOverallSignificance = 0.01;

template <class T>
constexpr double kRounding = std::is_same_v<T, float> ? 0x1p-24 : 0x1p-53;

// A sampler of normals: a distribution, and the cosine that widens its lobe or 0 for the plain one.
struct NormalCase {
  Distribution distribution;
  double widening_cos;
  Accuracy accuracy;
};

std::vector<NormalCase> NormalCases() {
  std::vector<NormalCase> cases;
  for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kFast, Accuracy::kHigh}) {
    constexpr float kAlphas[][2] = {{0.05f, 0.05f}, {0.1f, 0.1f},  {0.344f, 0.344f}, {0.6f, 0.6f},
                                    {1, 1},         {0.05f, 0.5f}, {1, 0.1f}};
    for (const auto& alpha : kAlphas) {
      cases.push_back({Ggx(alpha[0], alpha[1]), 0, accuracy});
      cases.push_back({Beckmann(alpha[0], alpha[1]), 0, accuracy});
      for (const double cos_i : {1.0, 0.5, 0.01}) {
        cases.push_back({Beckmann(alpha[0], alpha[1]), cos_i, accuracy});
      }
    }
    for (const float exponent : {0.0f, 0.5f, 6.0f, 48.0f, 798.0f}) {
      cases.push_back({Phong(exponent), 0, accuracy});
    }
    for (const float gamma : {1.55f, 2.0f, 4.0f, 50.0f}) {
      for (const auto& alpha : {std::pair(0.05f, 0.05f), std::pair(0.3f, 0.3f), std::pair(1.0f, 0.1f)}) {
        cases.push_back({StudentT(gamma, alpha.first, alpha.second), 0, accuracy});
        cases.push_back({Tabulated(gamma, alpha.first, alpha.second), 0, accuracy});
      }
    }
  }
  return cases;
}

// A sampler of visible normals: a distribution and the view.
struct VisibleCase {
  Distribution distribution;
  double theta, side;
  Accuracy accuracy;
  bool bounded;

  Direction v() const { return side * Spherical(Radians(theta), 0.7); }
  std::string Text() const {
    return distribution.Text() + microlane::Text(", %g degrees from %s%s", theta,
                                                 side > 0 ? "above" : "below", bounded ? ", bounded" : "");
  }
};

// From the normal to grazing, and from below.
std::vector<VisibleCase> VisibleCases() {
  constexpr float kAlphas[][2] = {{0.01f, 0.01f}, {0.05f, 0.05f}, {0.3f, 0.3f}, {1, 1},
                                  {2, 2},         {0.01f, 1},     {2, 0.02f}};
  constexpr double kViews[][2] = {{0, 1},    {30, 1}, {60, 1},  {85, 1},
                                  {89.9, 1}, {0, -1}, {70, -1}, {89.9, -1}};
  std::vector<VisibleCase> cases;
  for (const auto& alpha : kAlphas) {
    for (const auto& view : kViews) {
      const Accuracy accuracy = cases.size() % 4 == 3 ? Accuracy::kFast : Accuracy::kStandard;
      cases.push_back({Ggx(alpha[0], alpha[1]), view[0], view[1], accuracy, false});
      cases.push_back({Beckmann(alpha[0], alpha[1]), view[0], view[1], accuracy, false});
      if (view[0] == 60 || view[1] < 0)
        cases.push_back({Ggx(alpha[0], alpha[1]), view[0], view[1], accuracy, true});
    }
  }
  return cases;
}

// Of tables. Not of longer tails, whose normals lie so near the horizon that cells do not resolve them.
std::vector<VisibleCase> TabulatedVisibleCases() {
  constexpr float kAlphas[][2] = {{0.01f, 0.01f}, {0.3f, 0.3f}, {2, 2}, {0.01f, 0.1f}, {1, 0.1f}};
  constexpr double kViews[][2] = {{0, 1}, {30, 1}, {60, 1}, {85, 1}, {70, -1}};
  std::vector<VisibleCase> cases;
  for (const float gamma : {2.5f, 4.0f, 50.0f}) {
    for (const auto& alpha : kAlphas) {
      for (const auto& view : kViews) {
        const Accuracy accuracy = cases.size() % 4 == 3 ? Accuracy::kFast : Accuracy::kStandard;
        cases.push_back({Tabulated(gamma, alpha[0], alpha[1]), view[0], view[1], accuracy, false});
      }
    }
  }
  return cases;
}

// The normals that V-cavities show, of every distribution.
std::vector<VisibleCase> VCavityCases() {
  std::vector<Distribution> distributions;
  for (const auto& make : {Ggx, Beckmann}) {
    for (const float alpha : {0.01f, 0.3f, 1.0f, 2.0f}) distributions.push_back(make(alpha, alpha));
    distributions.push_back(make(0.05f, 1));
  }
  for (const float exponent : {798.0f, 6.0f, 0.0f}) distributions.push_back(Phong(exponent));
  for (const float gamma : {1.55f, 4.0f, 50.0f}) {
    distributions.push_back(StudentT(gamma, 0.3f, 0.3f));
    distributions.push_back(StudentT(gamma, 0.1f, 1));
    distributions.push_back(Tabulated(gamma, 0.1f, 1));
  }
  // Not beyond: next to v.m = 0 the density rises from 0 within cos(theta_v), which cells do not resolve.
  constexpr double kViews[][2] = {{0, 1}, {30, 1}, {60, 1}, {85, 1}, {70, -1}};
  std::vector<VisibleCase> cases;
  for (const Distribution& distribution : distributions) {
    for (const auto& view : kViews) {
      const Accuracy accuracy = cases.size() % 4 == 3 ? Accuracy::kFast : Accuracy::kStandard;
      cases.push_back({distribution, view[0], view[1], accuracy, false});
    }
  }
  return cases;
}

// Eto and Tokuyoshi 2023: the cap that bounded sampling leaves, over the whole one.
double CapShare(const VisibleCase& c) {
  const Direction v = c.side * c.v();
  const double ax = c.distribution.scale_x, ay = c.distribution.scale_y;
  const double s_z = v.z / Length({ax * v.x, ay * v.y, v.z});
  const double a2 = std::pow(std::min({ax, ay, 1.0}), 2), t2 = std::pow(1 + std::hypot(v.x, v.y), 2);
  const double k = (1 - a2) * t2 / (t2 + a2 * v.z * v.z);
  return (1 + k * s_z) / (1 + s_z);
}

// A sampler of directions: a surface and a direction of incidence.
struct DielectricCase {
  Distribution distribution;
  double eta, theta, side;

  Direction wi() const { return side * Spherical(Radians(theta), 0.7); }
  // Where a transmitting facet is vertical; visible ones do not fade out there. NaN if it nowhere is.
  double HorizonOfFacets() const { return std::acos(-wi().z / eta); }
  std::string Text() const {
    return distribution.Text() +
           microlane::Text(", eta %g, %g degrees from %s", eta, theta, side > 0 ? "above" : "below");
  }
};

// Walter's range and its corners; at eta = 1/1.5 the critical angle is 41.8 degrees.
std::vector<DielectricCase> DielectricCases() {
  std::vector<Distribution> distributions;
  for (const auto& make : {Ggx, Beckmann}) {
    for (const float alpha : {0.05f, 0.2f, 0.5f, 1.0f}) distributions.push_back(make(alpha, alpha));
    distributions.push_back(make(0.05f, 0.4f));
    distributions.push_back(make(0.8f, 0.2f));
  }
  for (const float exponent : {798.0f, 48.0f, 6.0f, 0.0f}) distributions.push_back(Phong(exponent));
  std::vector<DielectricCase> cases;
  for (const Distribution& distribution : distributions) {
    for (const float eta : {1.5f, 1 / 1.5f, 1.1f}) {
      for (const double theta : {0.0, 30.0, 60.0, 75.0, 85.0}) {
        for (const double side : {1.0, -1.0}) cases.push_back({distribution, eta, theta, side});
      }
    }
  }
  return cases;
}

// A sampler of directions with the value and the density that it must agree with.
struct DielectricSampler {
  std::string_view sample, eval, pdf;
  std::size_t every;  // of the cases, how many are tried for the density

  bool ChoosesLobe() const { return pdf == "pdf" || pdf == "pdf_visible"; }
  bool DrawsVisibleNormals() const { return pdf.substr(0, 11) == "pdf_visible"; }
  bool Has(const Distribution& distribution) const {
    return !DrawsVisibleNormals() || distribution.family != "phong";
  }
};
constexpr DielectricSampler kDielectricSamplers[] = {
    {"sample", "eval", "pdf", 1},
    {"sample_reflection", "eval_reflection", "pdf_reflection", 7},
    {"sample_transmission", "eval_transmission", "pdf_transmission", 7},
    {"sample_separable", "eval_separable", "pdf", 53},
    {"sample_reflection_separable", "eval_reflection_separable", "pdf_reflection", 53},
    {"sample_transmission_separable", "eval_transmission_separable", "pdf_transmission", 53},
    {"sample_visible", "eval", "pdf_visible", 3},
    {"sample_visible_reflection", "eval_reflection", "pdf_visible_reflection", 53},
    {"sample_visible_transmission", "eval_transmission", "pdf_visible_transmission", 13},
    {"sample_visible_separable", "eval_separable", "pdf_visible", 53},
    {"sample_visible_reflection_separable", "eval_reflection_separable", "pdf_visible_reflection", 101},
    {"sample_visible_transmission_separable", "eval_transmission_separable", "pdf_visible_transmission", 101},
};

// The coupled model, from wi at cos_i; Kelemen 2001's n = 1.7, m = 0.03 and m = 0.8 among them.
struct CoupledCase {
  double cos_i, m, index, k;

  Direction wi() const { return Spherical(std::acos(cos_i), 0.7); }
  std::string Text() const { return microlane::Text("cos %g m %g index %g k %g", cos_i, m, index, k); }
};
constexpr CoupledCase kCoupledCases[] = {
    {0.95, 0.03, 1.7, 1}, {0.6, 0.03, 1.7, 0.5}, {0.2, 0.03, 1.7, 0.2},
    {0.9, 0.8, 1.7, 1},   {0.5, 0.8, 1.7, 0.5},  {-0.15, 0.8, 1.7, 1},
    {0.7, 0.3, 4, 0},     {0.4, 0.1, 4, 0.7},    {-0.8, 0.3, 1, 0.9},
};

// An interface over a body, from wi at cos_i: shares of the interface from 0 to 1.
struct InterfacedCase {
  Distribution distribution;
  double cos_i, n, k;

  Direction wi() const { return Spherical(std::acos(cos_i), 0.7); }
  std::string Text() const { return distribution.Text() + microlane::Text(" cos %g n %g k %g", cos_i, n, k); }
};
std::vector<InterfacedCase> InterfacedCases() {
  return {{Ggx(0.3f, 0.3f), 0.9, 1.5, 0.5},       {Ggx(0.1f, 0.4f), 0.5, 1.5, 0.1},
          {Ggx(0.8f, 0.5f), -0.2, 2.5, 0.8},      {Ggx(0.3f, 0.2f), 0.7, 1.5, 0},
          {Ggx(0.3f, 0.2f), 0.7, 1, 0.5},         {Beckmann(0.3f, 0.3f), 0.9, 1.5, 0.2},
          {Beckmann(0.2f, 0.6f), 0.4, 1.33, 0.1}, {Beckmann(0.8f, 0.5f), -0.3, 4, 1}};
}

// Sidak's correction over all chi-square tests of this file.
double ChiSquareSignificance() {
  std::size_t count = std::size(kCoupledCases) + InterfacedCases().size() + NormalCases().size() +
                      2 * VisibleCases().size() + VCavityCases().size() + TabulatedVisibleCases().size();
  const std::size_t cases = DielectricCases().size();
  for (const DielectricSampler& sampler : kDielectricSamplers) {
    count += (cases + sampler.every - 1) / sampler.every;
  }
  return SidakSignificance(kOverallSignificance, count);
}

// Cells of the sphere, between quantiles of the colatitude and of the azimuth of given directions, for each
// hemisphere. Azimuths are counted from the mean one.
class SphereGrid {
 public:
  // About `num_cells` cells, shared by the hemispheres as the directions are; of none, a hemisphere gets a
  // few. `jump` is a colatitude where the density may jump, which no cell shall straddle; NaN of none.
  template <class T>
  SphereGrid(const DirectionColumns<T>& directions, int num_cells, double jump) {
    for (const bool upper : {true, false}) {
      Edges& edges = edges_[upper ? 0 : 1];
      Direction mean{0, 0, 0};
      std::vector<Direction> members;
      for (std::size_t i = 0; i < directions.size(); ++i) {
        const Direction v = directions[i];
        if (v.z == 0 || (v.z > 0) != upper) continue;
        members.push_back(v);
        mean = mean + v;
      }
      edges.origin = std::atan2(mean.y, mean.x);
      std::vector<double> theta, phi;
      for (const Direction& v : members) {
        theta.push_back(Theta(v));
        phi.push_back(edges.Phi(v));
      }
      const double share = static_cast<double>(members.size()) / directions.size();
      const int count = std::max(5, static_cast<int>(std::sqrt(share * num_cells)));
      edges.theta = Quantiles(theta, count, upper ? 0 : kTestPi / 2, upper ? kTestPi / 2 : kTestPi);
      if (jump > edges.theta.front() && jump < edges.theta.back()) {
        edges.theta.insert(std::upper_bound(edges.theta.begin(), edges.theta.end(), jump), jump);
      }
      edges.phi = Quantiles(phi, count, -kTestPi, kTestPi);
      edges.first_cell = cells_.size();
      for (std::size_t j = 0; j + 1 < edges.theta.size(); ++j) {
        for (std::size_t k = 0; k + 1 < edges.phi.size(); ++k) {
          cells_.push_back({edges.theta[j], edges.theta[j + 1], edges.origin + edges.phi[k],
                            edges.origin + edges.phi[k + 1]});
        }
      }
    }
  }

  const std::vector<Cell>& cells() const { return cells_; }
  std::size_t CellOf(const Direction& v) const {
    const Edges& edges = edges_[v.z > 0 ? 0 : 1];
    return edges.first_cell + Interval(edges.theta, Theta(v)) * (edges.phi.size() - 1) +
           Interval(edges.phi, edges.Phi(v));
  }

 private:
  struct Edges {
    double Phi(const Direction& v) const {
      return std::remainder(std::atan2(v.y, v.x) - origin, 2 * kTestPi);
    }

    double origin = 0;
    std::vector<double> theta, phi;
    std::size_t first_cell = 0;
  };

  static double Theta(const Direction& v) { return std::atan2(std::sqrt(v.x * v.x + v.y * v.y), v.z); }
  // Beyond the outermost quantiles, intervals double, so that no interval is wide where its end is still
  // steep.
  static std::vector<double> Quantiles(std::vector<double> values, int count, double low, double high) {
    std::sort(values.begin(), values.end());
    std::vector<double> edges;
    for (int k = 1; k < count; ++k) {
      const double edge = values.empty() ? low + (high - low) * k / count : values[values.size() * k / count];
      if (edge > low && edge < high && (edges.empty() || edge > edges.back())) edges.push_back(edge);
    }
    if (edges.size() >= 2) {
      const double least = 1e-3 * (high - low);
      for (double step = std::max(least, edges[1] - edges[0]); edges[0] - step > low; step *= 2) {
        edges.insert(edges.begin(), edges[0] - step);
      }
      for (double step = std::max(least, edges.back() - edges[edges.size() - 2]); edges.back() + step < high;
           step *= 2) {
        edges.push_back(edges.back() + step);
      }
    }
    edges.insert(edges.begin(), low);
    edges.push_back(high);
    return edges;
  }
  static std::size_t Interval(const std::vector<double>& edges, double x) {
    const auto above = std::upper_bound(edges.begin() + 1, edges.end() - 1, x);
    return static_cast<std::size_t>(above - edges.begin()) - 1;
  }

  Edges edges_[2];
  std::vector<Cell> cells_;
};

struct DensityTest {
  ChiSquareResult chi_square;
  double total_density = 0;  // integral over the sphere
  double quadrature_error = 0;
  std::size_t num_evaluations = 0;
};

// Integrals of `density` over the cells of a grid, to `tolerance` each by its own estimate. Where a cell got
// visibly less than the pilot's weights promise, or next to nothing where the pilot has a sample, a ridge may
// have passed between all nodes: such cells are integrated again in 256 parts. The pilot decides where to
// look closer, never what is found there.
template <class T, class Density>
CellIntegrals IntegrateOverGrid(const SphereGrid& grid, const DirectionColumns<T>& pilot,
                                const Column<T>& weights, double tolerance, const Density& density) {
  constexpr int kParts = 16;
  const std::vector<Cell>& cells = grid.cells();
  CellIntegrals integrals = IntegrateCells(cells, tolerance, density);
  std::vector<double> sums(cells.size(), 0.0), squares(cells.size(), 0.0);
  for (std::size_t i = 0; i < pilot.size(); ++i) {
    if (pilot.z[i] == 0) continue;
    const std::size_t c = grid.CellOf(pilot[i]);
    sums[c] += weights[i];
    squares[c] += double{weights[i]} * weights[i];
  }
  std::vector<std::size_t> suspects;
  std::vector<Cell> parts;
  for (std::size_t c = 0; c < cells.size(); ++c) {
    const double least = std::max(sums[c] - 4 * std::sqrt(squares[c]), 0.01 * sums[c]);
    if (integrals.value[c] * pilot.size() >= least) continue;
    suspects.push_back(c);
    const Cell& cell = cells[c];
    const double theta_step = (cell.theta_high - cell.theta_low) / kParts;
    const double phi_step = (cell.phi_high - cell.phi_low) / kParts;
    for (int j = 0; j < kParts; ++j) {
      for (int k = 0; k < kParts; ++k) {
        parts.push_back({cell.theta_low + j * theta_step, cell.theta_low + (j + 1) * theta_step,
                         cell.phi_low + k * phi_step, cell.phi_low + (k + 1) * phi_step});
      }
    }
  }
  const CellIntegrals closer = IntegrateCells(parts, tolerance / kParts, density);
  for (std::size_t s = 0; s < suspects.size(); ++s) {
    double& value = integrals.value[suspects[s]];
    value = 0;
    for (std::size_t part = s * kParts * kParts; part < (s + 1) * kParts * kParts; ++part) {
      value += closer.value[part];
    }
  }
  integrals.num_evaluations += closer.num_evaluations;
  integrals.error += closer.error;
  return integrals;
}

// Chi-square of directions (zero: a sample that failed) against a density over the sphere whose integral is
// the probability not to fail. `jump` as in SphereGrid.
template <class T, class Density>
DensityTest TestDensity(const DirectionColumns<T>& pilot, const DirectionColumns<T>& samples,
                        const Density& density, double jump = std::numeric_limits<double>::quiet_NaN()) {
  const SphereGrid grid(pilot, 600, jump);
  // 5e-7 of n = 10^5 is a twentieth of a count in each cell.
  const CellIntegrals integrals = IntegrateOverGrid(grid, pilot, Column<T>(pilot.size(), 1), 5e-7, density);
  DensityTest test;
  test.num_evaluations = integrals.num_evaluations;
  test.quadrature_error = integrals.error;
  const double n = static_cast<double>(samples.size());
  std::vector<double> expected, observed(grid.cells().size() + 1, 0.0);
  for (const double value : integrals.value) {
    test.total_density += value;
    expected.push_back(n * value);
  }
  expected.push_back(std::max(0.0, n * (1 - test.total_density)));
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const Direction v = samples[i];
    ++observed[v.z == 0 ? grid.cells().size() : grid.CellOf(v)];
  }
  test.chi_square = ChiSquareTest(observed, expected);
  return test;
}

// Collects chi-square tests: each against the corrected significance, and the smallest p-value for the
// report.
class ChiSquareTally {
 public:
  explicit ChiSquareTally(std::string property) : property_(std::move(property)) {}
  ChiSquareTally(const ChiSquareTally&) = delete;
  ChiSquareTally& operator=(const ChiSquareTally&) = delete;
  ~ChiSquareTally() {
    std::printf(
        "  %s: %zu tests of %zu samples, %zu nodes, mean %.0f degrees of freedom, smallest p %.3g (>= %.3g) "
        "at %s, "
        "quadrature error <= %.1e\n",
        property_.c_str(), tests_, samples_, nodes_, degrees_ / static_cast<double>(tests_), smallest_p_,
        significance_, where_.c_str(), quadrature_error_);
  }
  void Add(const DensityTest& test, std::size_t num_samples, const std::string& where) {
    ++tests_;
    samples_ = num_samples;
    nodes_ += test.num_evaluations;
    degrees_ += test.chi_square.degrees_of_freedom;
    quadrature_error_ = std::max(quadrature_error_, test.quadrature_error);
    if (tests_ == 1 || test.chi_square.p_value < smallest_p_) {
      smallest_p_ = test.chi_square.p_value;
      where_ = where;
    }
    EXPECT_GE(test.chi_square.p_value, significance_)
        << where << ": chi-square " << test.chi_square.statistic << " with "
        << test.chi_square.degrees_of_freedom << " degrees of freedom, density integrates to "
        << test.total_density;
    // The quadrature's own estimate, and a floor for what it cannot see.
    EXPECT_LE(test.total_density, 1 + test.quadrature_error + 1e-6) << where;
  }

 private:
  std::string property_, where_ = "none";
  double significance_ = ChiSquareSignificance(), smallest_p_ = 1, degrees_ = 0, quadrature_error_ = 0;
  std::size_t tests_ = 0, samples_ = 0, nodes_ = 0;
};

TEST(Statistics, TailsOfKnownDistributions) {
  EXPECT_NEAR(ChiSquareTail(3.841458820694124, 1), 0.05, 1e-12);
  EXPECT_NEAR(ChiSquareTail(18.307038053275146, 10), 0.05, 1e-12);
  EXPECT_NEAR(ChiSquareTail(82.35814, 100), 0.9, 1e-6);
  EXPECT_NEAR(ChiSquareTail(149.44925, 100), 0.001, 1e-8);
  EXPECT_NEAR(NormalBound(0.05), 1.959963984540054, 1e-12);
  EXPECT_NEAR(SidakSignificance(0.01, 500), 2.00998e-5, 1e-9);
}

template <class T>
DirectionColumns<T> SampleNormals(const NormalCase& c, std::size_t n, std::mt19937_64& random) {
  const Column<T> u1 = UniformNumbers<T>(n, random), u2 = UniformNumbers<T>(n, random);
  const std::string family(c.distribution.family);
  if (c.widening_cos == 0) {
    return RunDirection<T>(family + ".sample_normal", n, {c.accuracy}, u1, u2, c.distribution);
  }
  const Column<T> cos_i(n, static_cast<T>(c.widening_cos));
  return RunDirection<T>(family + ".sample_normal_widened", n, {c.accuracy}, u1, u2, cos_i, c.distribution);
}

// Walter 2007, Eq. 24; widened, of the alphas of section 5.3.
TEST(NormalSampler, DensityIsDTimesTheCosine) {
  constexpr std::size_t kSamples = 100000;
  ChiSquareTally tally("normals against D cos");
  std::uint64_t seed = 1;
  for (const NormalCase& c : NormalCases()) {
    std::mt19937_64 random(seed++);
    const DirectionColumns<float> pilot = SampleNormals<float>(c, 20000, random);
    const DirectionColumns<float> samples = SampleNormals<float>(c, kSamples, random);
    const double widening = c.widening_cos == 0 ? 1 : 1.2 - 0.2 * std::sqrt(c.widening_cos);
    Distribution wide = c.distribution;
    if (wide.family != "phong") {
      for (double& parameter : wide.parameters) parameter *= widening;
    }
    const DensityTest test = TestDensity(pilot, samples, [&](const DirectionColumns<double>& m) {
      Column<double> density = RunOne<double>(wide.Id("D"), m.size(), {}, m, wide);
      for (std::size_t i = 0; i < m.size(); ++i) density[i] *= std::abs(m.z[i]);
      return density;
    });
    tally.Add(test, kSamples, c.distribution.Text() + Text(", widening %g", widening));
  }
}

// Outputs of a sampler of visible normals at random numbers.
std::vector<Column<float>> SampleVisible(const VisibleCase& c, std::size_t n, std::mt19937_64& random) {
  const Column<float> u1 = UniformNumbers<float>(n, random), u2 = UniformNumbers<float>(n, random);
  const std::string id =
      c.distribution.Id(c.bounded ? "sample_visible_normal_bounded" : "sample_visible_normal");
  return RunAll<float>(id, n, {c.accuracy}, c.v(), u1, u2, c.distribution);
}

// Density of directions that v is reflected into about visible normals, in double lanes.
Column<double> ReflectedDensity(const VisibleCase& c, const DirectionColumns<double>& wo) {
  const Direction v = c.v();
  const std::size_t n = wo.size();
  const DirectionColumns<double> h = RunDirection<double>("half_vector.reflection", n, {}, v, wo);
  Column<double> density = RunOne<double>(c.distribution.Id("D_visible"), n, {}, v, h, c.distribution);
  const double share = c.bounded ? CapShare(c) : 1;
  for (std::size_t i = 0; i < n; ++i) {
    density[i] *= wo.z[i] * v.z > 0 ? 1 / (4 * std::abs(Dot(v, h[i])) * share) : 0;
  }
  return density;
}

// Outputs of a sampler of reflections about visible normals.
template <class T>
std::vector<Column<T>> SampleReflections(const VisibleCase& c, std::size_t n, std::mt19937_64& random) {
  const Column<T> u1 = UniformNumbers<T>(n, random), u2 = UniformNumbers<T>(n, random);
  const std::string id =
      c.distribution.Id(c.bounded ? "sample_visible_reflection_bounded" : "sample_visible_reflection");
  return RunAll<T>(id, n, {c.accuracy}, c.v(), u1, u2, c.distribution);
}

// Normals of a surface of unit roughness, and the density there of one over the stretched ones: of Beckmann's
// narrow lobes, cells of the sphere do not resolve the exponential.
template <class T>
DirectionColumns<T> ToUnitRoughness(const Distribution& distribution, const DirectionColumns<T>& m) {
  DirectionColumns<T> unit;
  for (std::size_t i = 0; i < m.size(); ++i) {
    unit.PushBack(Normalized({m.x[i] / distribution.scale_x, m.y[i] / distribution.scale_y, double{m.z[i]}}));
  }
  return unit;
}
template <class Density>
Column<double> DensityAtUnitRoughness(const Distribution& distribution, const DirectionColumns<double>& unit,
                                      const Density& density) {
  DirectionColumns<double> m;
  Column<double> jacobian;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const Direction h{distribution.scale_x * unit.x[i], distribution.scale_y * unit.y[i], unit.z[i]};
    m.PushBack(Normalized(h));
    jacobian.push_back(distribution.scale_x * distribution.scale_y / std::pow(Length(h), 3));
  }
  Column<double> result = density(m);
  for (std::size_t i = 0; i < unit.size(); ++i) result[i] *= jacobian[i];
  return result;
}

// Heitz 2014, Eq. 16, from views on either side. Bounded caps are tested by the directions they reflect v
// into, since they leave out normals that reflect it below the surface: above, their density is that of whole
// caps over the share of the cap that is left.
TEST(VisibleNormalSampler, DensityIsThatOfVisibleNormals) {
  constexpr std::size_t kSamples = 100000;
  ChiSquareTally tally("visible normals against D_visible");
  std::uint64_t seed = 1;
  std::vector<VisibleCase> cases = VisibleCases();
  for (const VisibleCase& c : TabulatedVisibleCases()) cases.push_back(c);
  for (const VisibleCase& c : cases) {
    std::mt19937_64 random(seed++);
    const Direction v = c.v();
    const bool unit = c.distribution.family == "beckmann";
    const auto sample = [&](std::size_t n) {
      const std::vector<Column<float>> out = SampleVisible(c, n, random);
      DirectionColumns<float> sampled{out[0], out[1], out[2]};
      if (unit) return ToUnitRoughness(c.distribution, sampled);
      if (!c.bounded) return sampled;
      DirectionColumns<float> wo;
      for (std::size_t i = 0; i < n; ++i) {
        const Direction mirrored = 2 * Dot(v, sampled[i]) * sampled[i] - v;
        wo.PushBack(mirrored.z * v.z > 0 ? mirrored : Direction{0, 0, 0});
      }
      return wo;
    };
    const DirectionColumns<float> pilot = sample(20000), samples = sample(kSamples);
    const DensityTest test = TestDensity(pilot, samples, [&](const DirectionColumns<double>& nodes) {
      if (c.bounded) return ReflectedDensity(c, nodes);
      const auto visible = [&](const DirectionColumns<double>& m) {
        return RunOne<double>(c.distribution.Id("D_visible"), m.size(), {}, v, m, c.distribution);
      };
      return unit ? DensityAtUnitRoughness(c.distribution, nodes, visible) : visible(nodes);
    });
    tally.Add(test, kSamples, c.Text());
  }
}

// Heitz 2014, Eqs. 16 and 49: a facet of a V-cavity by its share of what is seen.
TEST(VCavityNormalSampler, DensityIsThatOfTheNormalsShown) {
  constexpr std::size_t kSamples = 100000;
  ChiSquareTally tally("normals that V-cavities show against D_visible_v_cavity");
  Tally densities("pdf = D_visible_v_cavity");
  std::uint64_t seed = 500;
  for (const VisibleCase& c : VCavityCases()) {
    std::mt19937_64 random(seed++);
    const Direction v = c.v();
    const bool unit = c.distribution.family == "beckmann";
    const auto visible = [&](const DirectionColumns<double>& m) {
      return RunOne<double>(c.distribution.Id("D_visible_v_cavity"), m.size(), {}, v, m, c.distribution);
    };
    const auto sample = [&](std::size_t n) {
      const Column<float> u1 = UniformNumbers<float>(n, random), u2 = UniformNumbers<float>(n, random),
                          u3 = UniformNumbers<float>(n, random);
      const std::vector<Column<float>> out =
          RunAll<float>(c.distribution.Id("sample_visible_normal_v_cavity"), n, {c.accuracy}, v, u1, u2, u3,
                        c.distribution);
      const DirectionColumns<float> m{out[0], out[1], out[2]};
      return unit ? ToUnitRoughness(c.distribution, m) : m;
    };
    const DirectionColumns<float> pilot = sample(20000), samples = sample(kSamples);
    tally.Add(TestDensity(pilot, samples,
                          [&](const DirectionColumns<double>& nodes) {
                            return unit ? DensityAtUnitRoughness(c.distribution, nodes, visible)
                                        : visible(nodes);
                          }),
              kSamples, c.Text());
    // What the sampler says of its own normals, in double lanes.
    constexpr std::size_t kFew = 500;
    const Column<double> u1 = UniformNumbers<double>(kFew, random), u2 = UniformNumbers<double>(kFew, random),
                         u3 = UniformNumbers<double>(kFew, random);
    const std::vector<Column<double>> out = RunAll<double>(
        c.distribution.Id("sample_visible_normal_v_cavity"), kFew, {}, v, u1, u2, u3, c.distribution);
    const DirectionColumns<double> m{out[0], out[1], out[2]};
    const Column<double> density = visible(m);
    for (std::size_t i = 0; i < kFew; ++i) {
      const double tolerance = 1e-14 * (10 + c.distribution.LogSlope(m[i]) + 1 / std::abs(Dot(v, m[i])));
      densities.AddRelative(out[3][i], density[i], tolerance, [&] { return c.Text() + " m " + Text(m[i]); });
    }
  }
}

// Bounded caps lose no more reflections below the surface than whole ones, and fewer where the bound is
// active.
TEST(VisibleNormalSampler, BoundedCapsLoseFewerReflections) {
  constexpr std::size_t kSamples = 50000;
  for (const float alpha : {0.1f, 0.3f, 0.6f, 1.0f, 2.0f}) {
    std::string line;
    for (const double theta : {0.0, 30.0, 60.0, 80.0, 89.0}) {
      VisibleCase c{Ggx(alpha, alpha), theta, 1, Accuracy::kStandard, false};
      double lost[2] = {0, 0};
      for (const bool bounded : {false, true}) {
        c.bounded = bounded;
        std::mt19937_64 random(3);
        const std::vector<Column<float>> out = SampleReflections<float>(c, kSamples, random);
        for (const float lobe : out[5]) lost[bounded ? 1 : 0] += lobe == 0 ? 1.0 / kSamples : 0;
      }
      // The normals kept are the same, so what is lost falls exactly with the cap; 5 standard deviations.
      const double expected = 1 - (1 - lost[0]) / CapShare(c), tolerance = 5 * std::sqrt(0.5 / kSamples);
      EXPECT_NEAR(lost[1], expected, tolerance) << c.Text();
      EXPECT_LE(lost[1], lost[0] + tolerance) << c.Text();
      line += Text("  %.4f %.4f", lost[0], lost[1]);
    }
    std::printf("  alpha %-4g share lost, whole and bounded caps, at 0, 30, 60, 80, 89 degrees:%s\n",
                double{alpha}, line.c_str());
  }
}

TEST(VisibleReflectionSampler, DensityIsThatOfReflectedVisibleNormals) {
  constexpr std::size_t kSamples = 100000;
  ChiSquareTally tally("reflections about visible normals against D_visible");
  std::uint64_t seed = 2000;
  for (VisibleCase c : VisibleCases()) {
    // Cells of the sphere of wo do not resolve Beckmann's exponential in narrower lobes; that the density
    // reported is D_visible's in those is the next test's.
    const double ax = c.distribution.scale_x, ay = c.distribution.scale_y;
    if (c.distribution.family == "beckmann" && std::max(ax, ay) > 20 * std::min(ax, ay)) {
      c.distribution =
          Beckmann(static_cast<float>(std::max(ax, ay / 20)), static_cast<float>(std::max(ay, ax / 20)));
    }
    std::mt19937_64 random(seed++);
    const auto sample = [&](std::size_t n) {
      const std::vector<Column<float>> out = SampleReflections<float>(c, n, random);
      return DirectionColumns<float>{out[0], out[1], out[2]};
    };
    const DirectionColumns<float> pilot = sample(20000), samples = sample(kSamples);
    tally.Add(TestDensity(pilot, samples,
                          [&](const DirectionColumns<double>& nodes) { return ReflectedDensity(c, nodes); }),
              kSamples, c.Text());
  }
}

// The weight is f |cos| / pdf of the rough dielectric's value over its F, never above 1, and the density that
// of the visible normal.
TEST(VisibleReflectionSampler, WeightsAreValueOverDensity) {
  constexpr std::size_t kSamples = 2000;
  constexpr double kEta = 1.5;
  Tally weights("weight = f |cos| / (F pdf)"), densities("pdf = D_visible's"), lost("0 where lost");
  Tally evaluated("pdf_visible_reflection = D_visible's");
  std::size_t successes = 0;
  double largest = 0;
  std::uint64_t seed = 3000;
  for (const VisibleCase& c : VisibleCases()) {
    std::mt19937_64 random(seed++);
    const std::vector<Column<double>> out = SampleReflections<double>(c, kSamples, random);
    const DirectionColumns<double> wo{out[0], out[1], out[2]};
    const Column<double> f_cos = RunOne<double>(c.distribution.Dielectric("eval_reflection"), kSamples, {},
                                                c.v(), wo, c.distribution, kEta);
    const Column<double> density = ReflectedDensity(c, wo);
    const std::string pdf_id =
        c.distribution.Id(c.bounded ? "pdf_visible_reflection_bounded" : "pdf_visible_reflection");
    const Column<double> pdf = RunOne<double>(pdf_id, kSamples, {}, c.v(), wo, c.distribution);
    Column<double> cos_i;
    for (std::size_t i = 0; i < kSamples; ++i) cos_i.push_back(Dot(c.v(), Normalized(c.v() + wo[i])));
    const Column<double> F = RunOne<double>("fresnel.dielectric", kSamples, {}, cos_i, kEta);
    const double alpha = std::min(c.distribution.scale_x, c.distribution.scale_y);
    for (std::size_t i = 0; i < kSamples; ++i) {
      const auto where = [&] { return c.Text() + " wo " + Text(wo[i]); };
      if (out[5][i] == 0) {
        lost.Add(std::abs(out[0][i]) + std::abs(out[1][i]) + std::abs(out[2][i]) + out[3][i] + out[4][i], 0,
                 where);
        continue;
      }
      ++successes;
      largest = std::max(largest, out[3][i]);
      const double geometric = 1 + 1 / std::abs(wo.z[i]) + 1 / cos_i[i];
      weights.AddRelative(f_cos[i] / (F[i] * density[i]), out[3][i], 1e-11 * geometric, where);
      densities.AddRelative(out[4][i], density[i], 1e-12 * geometric / std::min(alpha, 1.0), where);
      evaluated.AddRelative(pdf[i], density[i], 1e-12 * geometric / std::min(alpha, 1.0), where);
    }
  }
  weights.Note(Text(", %zu samples, largest weight %.17g", successes, largest));
  EXPECT_GT(successes, 50 * kSamples);
  EXPECT_LE(largest, 1);
}

// In float lanes too.
TEST(VisibleReflectionSampler, WeightsAreAtMostOne) {
  Tally tally("largest weight - 1");
  std::uint64_t seed = 4000;
  for (const VisibleCase& c : VisibleCases()) {
    std::mt19937_64 random(seed++);
    const std::vector<Column<float>> out = SampleReflections<float>(c, 20000, random);
    for (const float weight : out[3]) {
      tally.Add(std::max(0.0, double{weight} - 1), 0, [&] { return c.Text(); });
    }
  }
}

struct SampledDirections {
  DirectionColumns<float> wo;
  Column<float> weight;
};

// The outputs of a sampler at random numbers.
template <class T, class Incident>
std::vector<Column<T>> RunSampler(const DielectricSampler& sampler, const DielectricCase& c,
                                  const Incident& wi, std::size_t n, Mode mode, std::mt19937_64& random) {
  const Column<T> u1 = UniformNumbers<T>(n, random), u2 = UniformNumbers<T>(n, random),
                  u3 = UniformNumbers<T>(n, random);
  const std::string id = c.distribution.Dielectric(sampler.sample);
  if (!sampler.ChoosesLobe()) return RunAll<T>(id, n, mode, wi, u1, u2, c.distribution, c.eta);
  return RunAll<T>(id, n, mode, wi, u1, u2, u3, c.distribution, c.eta);
}

SampledDirections SampleDirections(const DielectricCase& c, std::size_t n, std::mt19937_64& random,
                                   Accuracy accuracy,
                                   const DielectricSampler& sampler = kDielectricSamplers[0]) {
  std::vector<Column<float>> out = RunSampler<float>(sampler, c, c.wi(), n, {accuracy}, random);
  return {{std::move(out[0]), std::move(out[1]), std::move(out[2])}, std::move(out[3])};
}

TEST(RoughDielectricSampler, DensityIsItsPdfOverTheWholeSphereAndFailuresAreTheRest) {
  constexpr std::size_t kSamples = 100000;
  const std::vector<DielectricCase> cases = DielectricCases();
  for (const DielectricSampler& sampler : kDielectricSamplers) {
    ChiSquareTally tally(std::string(sampler.sample) + " against " + std::string(sampler.pdf));
    std::uint64_t seed = 1000;
    for (std::size_t i = 0; i < cases.size(); i += sampler.every) {
      const DielectricCase& c = cases[i];
      if (!sampler.Has(c.distribution)) continue;
      std::mt19937_64 random(seed);
      // Every fourth case in the fast accuracy.
      const Accuracy accuracy = seed++ % 4 == 0 ? Accuracy::kFast : Accuracy::kStandard;
      const DirectionColumns<float> pilot = SampleDirections(c, 20000, random, accuracy, sampler).wo;
      const DirectionColumns<float> samples = SampleDirections(c, kSamples, random, accuracy, sampler).wo;
      const Direction wi = c.wi();
      const DensityTest test = TestDensity(
          pilot, samples,
          [&](const DirectionColumns<double>& wo) {
            return RunOne<double>(c.distribution.Dielectric(sampler.pdf), wo.size(), {}, wi, wo,
                                  c.distribution, c.eta);
          },
          c.HorizonOfFacets());
      tally.Add(test, kSamples, c.Text());
    }
  }
}

// Both lobes and the stop: what is drawn is pdf's, and a sample that is none has what pdf leaves.
TEST(CoupledSampler, DensityIsItsPdfAndFailuresAreTheRest) {
  constexpr std::size_t kSamples = 100000;
  ChiSquareTally tally("coupled.sample against coupled.pdf");
  std::uint64_t seed = 7000;
  for (const CoupledCase& c : kCoupledCases) {
    std::mt19937_64 random(seed);
    const Accuracy accuracy = seed++ % 4 == 0 ? Accuracy::kFast : Accuracy::kStandard;
    const auto draw = [&](std::size_t n) {
      const Column<float> u1 = UniformNumbers<float>(n, random), u2 = UniformNumbers<float>(n, random),
                          u3 = UniformNumbers<float>(n, random);
      return RunDirection<float>("coupled.sample", n, {accuracy}, c.wi(), u1, u2, u3, c.k, c.m, c.index);
    };
    const DirectionColumns<float> pilot = draw(20000), samples = draw(kSamples);
    const Direction wi = c.wi();
    const DensityTest test = TestDensity(pilot, samples, [&](const DirectionColumns<double>& wo) {
      return RunOne<double>("coupled.pdf", wo.size(), {}, wi, wo, c.k, c.m, c.index);
    });
    tally.Add(test, kSamples, c.Text());
  }
}

// Interface and body: what is drawn is the density of both, failures are what it leaves, and weights have the
// mean that the integral of both has.
TEST(InterfacedSampler, DensityIsItsPdfAndWeightsHaveTheMeanOfTheIntegral) {
  constexpr std::size_t kSamples = 100000;
  ChiSquareTally tally("sample_with_interface against pdf_with_interface");
  Tally means("mean weight is Int (f_s + f_b) |cos| dwo");
  const std::vector<InterfacedCase> cases = InterfacedCases();
  const double bound = NormalBound(SidakSignificance(kOverallSignificance, cases.size()));
  std::uint64_t seed = 8000;
  for (const InterfacedCase& c : cases) {
    std::mt19937_64 random(seed);
    const Accuracy accuracy = seed++ % 4 == 0 ? Accuracy::kFast : Accuracy::kStandard;
    const Direction wi = c.wi();
    const auto of = [&](std::string_view quantity, const DirectionColumns<double>& wo, auto... more) {
      return RunOne<double>(c.distribution.Model("interfaced_body", quantity), wo.size(), {}, wi, wo,
                            c.distribution, c.n, c.k, more...);
    };
    const auto draw = [&](std::size_t n) {
      Column<float> u[5];
      for (Column<float>& column : u) column = UniformNumbers<float>(n, random);
      return RunAll<float>(c.distribution.Model("interfaced_body", "sample_with_interface"), n, {accuracy},
                           wi, u[0], u[1], u[2], u[3], u[4], c.distribution, c.n, c.k);
    };
    const std::vector<Column<float>> pilot = draw(20000), samples = draw(kSamples);
    const DensityTest test =
        TestDensity(DirectionColumns<float>{pilot[0], pilot[1], pilot[2]},
                    DirectionColumns<float>{samples[0], samples[1], samples[2]},
                    [&](const DirectionColumns<double>& wo) { return of("pdf_with_interface", wo); });
    tally.Add(test, kSamples, c.Text());

    double sum = 0, squares = 0, missed = 0;
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double weight = samples[3][i];
      missed += samples[5][i] == 0 ? 1 : 0;
      EXPECT_EQ(samples[5][i] == 0, samples[4][i] == 0);
      sum += weight;
      squares += weight * weight;
    }
    EXPECT_LT(missed, 0.5 * kSamples);
    // The integral by cells of equal cosine and azimuth, refined where the interface reflects.
    const Rule rule = GaussLegendre(160);
    DirectionColumns<double> wo;
    Column<double> solid_angle;
    constexpr int kAzimuths = 160;
    const double side = wi.z < 0 ? -1 : 1;
    for (std::size_t j = 0; j < rule.node.size(); ++j) {
      for (int k = 0; k < kAzimuths; ++k) {
        const double theta = kTestPi / 4 * (1 + rule.node[j]);
        const Direction v = Spherical(theta, (k + 0.5) * 2 * kTestPi / kAzimuths);
        wo.PushBack({v.x, v.y, side * v.z});
        solid_angle.push_back(rule.weight[j] * kTestPi / 4 * std::sin(theta) * 2 * kTestPi / kAzimuths);
      }
    }
    const Column<double> body = of("eval", wo, 16.0);
    const Column<double> surface = RunOne<double>(c.distribution.Dielectric("eval_reflection"), wo.size(), {},
                                                  wi, wo, c.distribution, c.n);
    double exact = 0;
    for (std::size_t i = 0; i < wo.size(); ++i) exact += (body[i] + surface[i]) * solid_angle[i];
    const double mean = sum / kSamples;
    const double error = std::sqrt((squares / kSamples - mean * mean) / (kSamples - 1.0));
    means.Add(mean - exact, bound * error + 1e-5, [&] { return c.Text(); });
    EXPECT_LT(error * std::sqrt(double{kSamples}), 3 * mean) << c.Text();
  }
}

// The test above can fail: it sees a roughness off by 4 %, an index off by 2 %.
TEST(RoughDielectricSampler, ChiSquareRejectsADensitySlightlyWrong) {
  constexpr std::size_t kSamples = 100000;
  std::size_t rejected = 0;
  const DielectricCase truth{Ggx(0.3f, 0.3f), 1.5f, 30, 1};
  DielectricCase wrong_alpha = truth, wrong_eta = truth;
  wrong_alpha.distribution = Ggx(0.312f, 0.312f);
  wrong_eta.eta = 1.53;
  std::mt19937_64 random(7);
  const DirectionColumns<float> pilot = SampleDirections(truth, 20000, random, Accuracy::kStandard).wo;
  const DirectionColumns<float> samples = SampleDirections(truth, kSamples, random, Accuracy::kStandard).wo;
  for (const DielectricCase& c : {wrong_alpha, wrong_eta}) {
    const DensityTest test = TestDensity(pilot, samples, [&](const DirectionColumns<double>& wo) {
      return RunOne<double>(c.distribution.Dielectric("pdf"), wo.size(), {}, truth.wi(), wo, c.distribution,
                            c.eta);
    });
    EXPECT_LT(test.chi_square.p_value, ChiSquareSignificance()) << c.Text();
    rejected += test.chi_square.p_value < ChiSquareSignificance() ? 1 : 0;
  }
  std::printf("  %zu of 2 wrong densities rejected\n", rejected);
}

// One sample of every lane, and the kernels evaluated at the direction it returned.
template <class T>
struct Checked {
  DirectionColumns<T> wi, wo;
  Column<T> weight, pdf, lobe, f_cos, pdf_there;
};

template <class T>
Checked<T> SampleAndEvaluate(const DielectricSampler& sampler, const DielectricCase& c, Mode mode,
                             std::size_t n, std::mt19937_64& random) {
  Checked<T> result;
  for (std::size_t i = 0; i < n; ++i) result.wi.PushBack(c.wi());
  const std::vector<Column<T>> out = RunSampler<T>(sampler, c, result.wi, n, mode, random);
  result.wo = {out[0], out[1], out[2]};
  result.weight = out[3];
  result.pdf = out[4];
  result.lobe = out[5];
  const auto there = [&](std::string_view quantity) {
    return RunOne<T>(c.distribution.Dielectric(quantity), n, mode, result.wi, result.wo, c.distribution,
                     c.eta);
  };
  result.f_cos = there(sampler.eval);
  result.pdf_there = there(sampler.pdf);
  return result;
}

// Walter 2007, Eqs. 37 and 41: the closed form is f |cos(theta_o)| / pdf, and the density is that of the pdf
// kernel.
template <class T>
void ExpectWeightsAreValueOverDensity(Accuracy accuracy, const std::string& name) {
  Tally weights("weight = f |cos| / pdf, " + name), densities("pdf = the pdf kernel's, " + name);
  Tally invisible("failed samples are 0 in every output, " + name);
  Tally at_most_one("weight of visible normals, without the scale of radiance, - 1, " + name);
  std::size_t doubtful = 0, successes = 0, failures = 0;
  std::uint64_t seed = 5000;
  for (const DielectricCase& c : DielectricCases()) {
    for (const DielectricSampler& sampler : kDielectricSamplers) {
      if (!sampler.Has(c.distribution)) continue;
      std::mt19937_64 random(seed);
      const Mode mode{accuracy, seed++ % 2 == 0 ? Transport::kRadiance : Transport::kImportance};
      const std::size_t n = 500;
      const Checked<T> s = SampleAndEvaluate<T>(sampler, c, mode, n, random);
      const double declared =
          std::is_same_v<T, float> ? 2 * DeclaredError<T>(c.distribution.Dielectric("eval"), accuracy) : 0;
      // In the fast accuracy every step counts as a rounding, to about 2^-14.
      const bool fast = accuracy == Accuracy::kFast;
      const double u = fast ? 0x1p-14 : kRounding<T>, factor = fast ? 4 : 16, largest = fast ? 0.02 : 1e-3;
      for (std::size_t i = 0; i < n; ++i) {
        const auto where = [&] {
          return std::string(sampler.sample) + ' ' + c.Text() + " wi " + Text(s.wi[i]) + " wo " +
                 Text(s.wo[i]);
        };
        if (s.lobe[i] == 0) {
          ++failures;
          invisible.Add(
              std::abs(s.wo.x[i]) + std::abs(s.wo.y[i]) + std::abs(s.wo.z[i]) + s.weight[i] + s.pdf[i], 0,
              where);
          continue;
        }
        ++successes;
        const bool reflects = s.lobe[i] == 1;
        if (sampler.DrawsVisibleNormals()) {
          const double scale = reflects || mode.transport == Transport::kRadiance ? 1 : c.eta * c.eta;
          at_most_one.Add(std::max(0.0, s.weight[i] * scale - 1), declared + 4 * u, where);
        }
        Direction m = Normalized(s.wi[i] + (reflects ? 1 : c.eta) * s.wo[i]);
        if (m.z < 0) m = -1 * m;
        const double conditioning = Conditioning(c.distribution, s.wi[i], s.wo[i], m, c.eta, reflects);
        // f and pdf hold the same D and the same F; what is left is conditioned by the geometry only.
        Distribution flat = c.distribution;
        flat.scale_x = flat.scale_y = 1e30;
        flat.parameters.assign(flat.parameters.size(), 0.0);
        const double geometric = Conditioning(flat, s.wi[i], s.wo[i], m, c.eta, reflects);
        if (conditioning * u > largest || s.pdf[i] < std::numeric_limits<T>::min() * 0x1p20 ||
            s.f_cos[i] < std::numeric_limits<T>::min() * 0x1p20) {
          ++doubtful;
          continue;
        }
        weights.AddRelative(double{s.f_cos[i]} / s.pdf_there[i], s.weight[i],
                            declared + factor * geometric * u, where);
        densities.AddRelative(s.pdf[i], s.pdf_there[i], declared + factor * conditioning * u, where);
      }
    }
  }
  weights.Note(Text(", %zu failed, %zu too ill-conditioned to compare", failures, doubtful));
  EXPECT_LT(doubtful, (accuracy == Accuracy::kFast ? 0.3 : 0.05) * successes);
}

TEST(RoughDielectricSampler, WeightsAreValueOverDensityInDoubleLanes) {
  ExpectWeightsAreValueOverDensity<double>(Accuracy::kStandard, "double");
}
TEST(RoughDielectricSampler, WeightsAreValueOverDensityInFloatLanes) {
  ExpectWeightsAreValueOverDensity<float>(Accuracy::kHigh, "float high");
  ExpectWeightsAreValueOverDensity<float>(Accuracy::kStandard, "float standard");
  ExpectWeightsAreValueOverDensity<float>(Accuracy::kFast, "float fast");
}

// What a sampler of reflections gives of normals and their densities; no weights.
std::vector<Column<double>> Reflected(const DielectricCase& c, const std::vector<Column<double>>& normals) {
  const std::size_t n = normals[0].size();
  std::vector<Column<double>> out(6, Column<double>(n, 0));
  for (std::size_t i = 0; i < n; ++i) {
    const Direction m = c.side * Direction{normals[0][i], normals[1][i], normals[2][i]};
    const double cos_i = Dot(c.wi(), m);
    const Direction wo = 2 * cos_i * m - c.wi();
    if (!(wo.z * c.side > 0)) continue;
    out[0][i] = wo.x;
    out[1][i] = wo.y;
    out[2][i] = wo.z;
    out[4][i] = normals[3][i] / (4 * cos_i);
    out[5][i] = 1;
  }
  return out;
}

// Samples of opaque surfaces: directions and densities of the dielectric's reflection, or of the mirror about
// visible normals, or of V-cavities' normals, whose chi-squares are above, and weights that are value over
// density.
TEST(OpaqueSurfaceSampler, DirectionsAreThoseOfNormalsAndWeightsAreValueOverDensity) {
  struct Opaque {
    std::string_view model;
    Values parameters;
  };
  const Opaque surfaces[] = {{"rough_mirror", {{}}},
                             {"rough_conductor", {{0.2f, 3.0f}}},
                             {"rough_conductor", {{1.5f, 0}}},
                             {"rough_schlick", {{0.04f}}}};
  constexpr std::size_t kSamples = 500;
  Tally directions("wo and pdf of the normals' reflection"), weights("weight = f |cos| / pdf");
  Tally at_most_one("weight of visible normals - 1");
  std::uint64_t seed = 9000;
  std::size_t successes = 0;
  for (const DielectricCase& c : DielectricCases()) {
    if (c.eta != 1.5f) continue;
    for (const Opaque& surface : surfaces) {
      for (const std::string suffix : {"", "_separable", "_visible", "_visible_separable", "_v_cavity"}) {
        const bool visible = suffix.find("visible") != std::string::npos, v_cavity = suffix == "_v_cavity";
        if (visible && c.distribution.family == "phong") continue;
        std::mt19937_64 random(seed++);
        const Column<double> u1 = UniformNumbers<double>(kSamples, random),
                             u2 = UniformNumbers<double>(kSamples, random),
                             u3 = UniformNumbers<double>(kSamples, random);
        const auto sample = [&](const std::string& id, const Values& parameters) {
          if (v_cavity) {
            return RunAll<double>(id, kSamples, {}, c.wi(), u1, u2, u3, c.distribution, parameters);
          }
          return RunAll<double>(id, kSamples, {}, c.wi(), u1, u2, c.distribution, parameters);
        };
        const std::vector<Column<double>> out =
            sample(c.distribution.Model(surface.model, "sample" + suffix), surface.parameters);
        const std::vector<Column<double>> reflection =
            visible    ? sample(c.distribution.Id("sample_visible_reflection"), {{}})
            : v_cavity ? Reflected(c, sample(c.distribution.Id("sample_visible_normal_v_cavity"), {{}}))
                       : sample(c.distribution.Dielectric("sample_reflection" + suffix), {{c.eta}});
        const DirectionColumns<double> wo{out[0], out[1], out[2]};
        const std::vector<Column<double>> value =
            RunAll<double>(c.distribution.Model(surface.model, "eval_pdf" + suffix), kSamples, {}, c.wi(), wo,
                           c.distribution, surface.parameters);
        for (std::size_t i = 0; i < kSamples; ++i) {
          const auto where = [&] {
            return std::string(surface.model) + suffix + ' ' + c.Text() + " wo " + Text(wo[i]);
          };
          // Of V-cavities the reflection is this test's own, and the share of a facet that is hardly seen
          // cancels.
          const double seen = Dot(c.wi(), Normalized(c.wi() + wo[i]));
          for (const std::size_t k : {0, 1, 2, 4, 5}) {
            if (v_cavity && k < 3) {
              directions.Add(std::abs(out[k][i] - reflection[k][i]), 1e-14, where);
            } else {
              const double cancels = v_cavity && k == 4 && out[5][i] != 0 ? 1 + 1 / seen : 1;
              directions.AddRelative(out[k][i], reflection[k][i], 1e-13 * cancels, where);
            }
          }
          if (visible || v_cavity) at_most_one.Add(std::max(0.0, out[3][i] - 1), 0, where);
          if (out[5][i] == 0) continue;
          ++successes;
          const double cos_i = Dot(c.wi(), Normalized(c.wi() + wo[i]));
          const double geometric = 1 + 1 / std::abs(wo.z[i]) + 1 / cos_i;
          weights.AddRelative(value[0][i] / value[1][i], out[3][i], 1e-12 * geometric, where);
        }
      }
    }
  }
  weights.Note(Text(", %zu samples", successes));
  EXPECT_GT(successes, 200 * kSamples);
}

// The mean weight, failed samples counted with 0, estimates int f |cos| dwo.
TEST(RoughDielectricSampler, MeanWeightIsTheDirectionalAlbedo) {
  constexpr std::size_t kSamples = 200000;
  std::vector<DielectricCase> cases;
  for (const DielectricCase& c : DielectricCases()) {
    if (c.side > 0 ? c.theta < 80 : c.theta == 60) cases.push_back(c);
  }
  const double bound = NormalBound(SidakSignificance(kOverallSignificance, cases.size()));
  Tally tally("mean weight - albedo, in standard deviations");
  std::size_t num_nodes = 0;
  double quadrature_error = 0;
  std::uint64_t seed = 9000;
  for (const DielectricCase& c : cases) {
    std::mt19937_64 random(seed++);
    const SampledDirections pilot = SampleDirections(c, 20000, random, Accuracy::kStandard);
    const SampledDirections samples = SampleDirections(c, kSamples, random, Accuracy::kStandard);
    const SphereGrid grid(pilot.wo, 100, c.HorizonOfFacets());
    const CellIntegrals albedo =
        IntegrateOverGrid(grid, pilot.wo, pilot.weight, 2e-5, [&](const DirectionColumns<double>& wo) {
          return RunOne<double>(c.distribution.Dielectric("eval"), wo.size(), {}, c.wi(), wo, c.distribution,
                                c.eta);
        });
    double expected = 0, sum = 0, sum2 = 0;
    for (const double value : albedo.value) expected += value;
    for (const float w : samples.weight) {
      sum += w;
      sum2 += double{w} * w;
    }
    const double mean = sum / kSamples,
                 deviation = std::sqrt(std::max(0.0, sum2 / kSamples - mean * mean) / kSamples);
    num_nodes += albedo.num_evaluations;
    quadrature_error = std::max(quadrature_error, albedo.error);
    // A lobe of constant weight has no deviation of its own: the quadrature's error stands in.
    const double unit = deviation + 1e-6 + albedo.error / bound;
    tally.Add((mean - expected) / unit, bound,
              [&] { return c.Text() + Text(", mean %g, albedo %g", mean, expected); });
  }
  tally.Note(Text(", of %zu samples each, %zu nodes, quadrature error <= %.1e", kSamples, num_nodes,
                  quadrature_error));
}

// For one facet, the share of u3 that reflects is F(wi.m).
TEST(RoughDielectricSampler, LobesAreChosenByFresnel) {
  constexpr int kSteps = 4096;
  Tally tally("share of u3 that reflects = F");
  for (const float u1 : {0.05f, 0.5f, 0.9f}) {
    for (const float u2 : {0.1f, 0.4f, 0.8f}) {
      for (const Distribution& distribution : {Ggx(0.1f, 0.3f), Beckmann(0.3f, 0.3f), Phong(40)}) {
        for (const float eta : {1.5f, 1 / 1.5f, 1.1f, 4.0f}) {
          for (const double theta : {5.0, 30.0, 50.0, 70.0}) {
            for (const double side : {1.0, -1.0}) {
              const DielectricCase c{distribution, eta, theta, side};
              Column<double> u3;
              for (int k = 0; k < kSteps; ++k) u3.push_back((k + 0.5) / kSteps);
              const std::vector<Column<double>> out =
                  RunAll<double>(distribution.Dielectric("sample"), kSteps, {}, c.wi(), double{u1},
                                 double{u2}, u3, distribution, c.eta);
              int reflected = 0, transmitted = 0;
              double cos_i = 0;
              for (int k = 0; k < kSteps; ++k) {
                const int lobe = static_cast<int>(out[5][k]);
                reflected += lobe == 1 ? 1 : 0;
                transmitted += lobe == 2 ? 1 : 0;
                if (lobe == 0) continue;
                const Direction wo{out[0][k], out[1][k], out[2][k]};
                cos_i = Dot(c.wi(), Normalized(c.wi() + (lobe == 1 ? 1 : c.eta) * wo));
              }
              // The facet may be invisible, or one lobe fail below its horizon: the other shows the share.
              if (reflected + transmitted == 0) continue;
              const double F = RunOne<double>("fresnel.dielectric", 1, {}, cos_i, c.eta)[0];
              const double share =
                  transmitted == 0 ? 1.0 * reflected / kSteps : 1 - 1.0 * transmitted / kSteps;
              tally.Add(share - F, 1.0 / kSteps,
                        [&] { return c.Text() + Text(", u1 %g u2 %g", double{u1}, double{u2}); });
            }
          }
        }
      }
    }
  }
}

// Random numbers over the unit square: a grid, and the lattice towards u1 = 1, where the tail is.
struct SquarePoints {
  Column<double> u1, u2;
};

SquarePoints TailPoints() {
  std::vector<double> first;
  first.reserve(250);
  for (int k = 0; k < 200; ++k) first.push_back(k / 200.0);
  for (int k = 1; k <= 24; ++k) {
    first.push_back(1 - std::ldexp(1.0, -k));
    if (k < 24) first.push_back(1 - std::ldexp(1.5, -k - 1));
  }
  SquarePoints points;
  for (const double u : first) {
    for (int k = 0; k < 128; ++k) {
      points.u1.push_back(u);
      points.u2.push_back(k / 128.0);
    }
  }
  return points;
}

// How large the weights of Walter 2007, Eq. 41 become; "as high as hundreds to millions", says his
// section 5.3.
TEST(RoughDielectricSampler, LargestWeightsAreFinite) {
  const SquarePoints points = TailPoints();
  const std::size_t n = points.u1.size();
  Tally tally("weights of D cos sampling are finite");
  for (const Distribution& distribution :
       {Ggx(0.05f, 0.05f), Ggx(0.3f, 0.3f), Ggx(1, 1), Beckmann(0.05f, 0.05f), Beckmann(0.3f, 0.3f),
        Beckmann(1, 1), Phong(798), Phong(20), Phong(0)}) {
    std::string line;
    for (const double theta : {0.0, 60.0, 80.0, 85.0, 89.0, 89.9}) {
      double largest = 0;
      for (const float eta : {1.5f, 1 / 1.5f}) {
        const Direction wi = Spherical(Radians(theta), 0);
        for (const double u3 : {0.0, 0.5, 1 - 0x1p-24}) {
          const Column<double> weight = RunAll<double>(distribution.Dielectric("sample"), n, {}, wi,
                                                       points.u1, points.u2, u3, distribution, eta)[3];
          for (std::size_t i = 0; i < n; ++i) {
            tally.Add(std::isfinite(weight[i]) && weight[i] >= 0 ? 0 : 1, 0,
                      [&] { return distribution.Text() + Text(", %g degrees", theta); });
            largest = std::max(largest, weight[i]);
          }
        }
      }
      line += Text(" %9.4g", largest);
    }
    std::printf("  %-30s largest weight at 0, 60, 80, 85, 89, 89.9 degrees:%s\n", distribution.Text().c_str(),
                line.c_str());
  }
}

// Walter 2007, section 5.3: at grazing, D cos sampling can give huge weights; with Beckmann's alpha widened
// by 1.2 - 0.2 sqrt(|i.n|), "this reduces the maximum sample weight to roughly four".
TEST(WidenedBeckmann, LargestWeightIsThatOfThePaper) {
  const auto [u1, u2] = TailPoints();
  const std::size_t n = u1.size();
  std::size_t points = 0;
  double largest_widened = 0, largest_plain = 0;
  std::string where_widened, where_plain;
  for (const float alpha : {0.01f, 0.05f, 0.1f, 0.2f, 0.344f, 0.5f, 0.7f, 1.0f}) {
    const Distribution distribution = Beckmann(alpha, alpha);
    double at_alpha[2] = {0, 0};
    for (const double theta : {0.0, 20.0, 40.0, 60.0, 70.0, 75.0, 80.0, 83.0, 85.0, 87.0, 89.0, 89.9}) {
      const Direction wi = Spherical(Radians(theta), 0);
      const Column<double> cos_i(n, wi.z);
      for (const bool widened : {true, false}) {
        const std::vector<Column<double>> out =
            widened ? RunAll<double>("beckmann.sample_normal_widened", n, {}, u1, u2, cos_i, distribution)
                    : RunAll<double>("beckmann.sample_normal", n, {}, u1, u2, distribution);
        const DirectionColumns<double> m{out[0], out[1], out[2]};
        const Column<double> density = RunOne<double>("beckmann.D", n, {}, m, distribution);
        for (const double eta : {1.0, 1.5, 1 / 1.5}) {  // 1: reflection
          const DirectionColumns<double> wo = eta == 1 ? RunDirection<double>("reflect", n, {}, wi, m)
                                                       : RunDirection<double>("refract", n, {}, wi, m, eta);
          const Column<double> g1_i = RunOne<double>("beckmann.G1", n, {}, wi, m, distribution);
          const Column<double> g1_o = RunOne<double>("beckmann.G1", n, {}, wo, m, distribution);
          for (std::size_t i = 0; i < n; ++i) {
            if (Dot(wo[i], wo[i]) < 0.5 || (wo.z[i] > 0) != (eta == 1) || out[3][i] == 0) continue;
            ++points;
            // Walter 2007, Eq. 41 with the density drawn from: f |cos| / pdf is |i.m| G D / (|i.n| pdf_m).
            const double weight = Dot(wi, m[i]) * g1_i[i] * g1_o[i] * density[i] / (wi.z * out[3][i]);
            double& largest = widened ? largest_widened : largest_plain;
            double& here = at_alpha[widened ? 0 : 1];
            here = std::max(here, weight);
            if (weight > largest) {
              largest = weight;
              (widened ? where_widened : where_plain) =
                  Text("alpha %g, %g degrees, eta %g, u1 %a, u2 %g, cos_m %.3g", double{alpha}, theta, eta,
                       u1[i], u2[i], m.z[i]);
            }
          }
        }
      }
    }
    std::printf("  alpha %-6g largest weight: widened %-8.4g D cos %.4g\n", double{alpha}, at_alpha[0],
                at_alpha[1]);
  }
  std::printf("  %zu points; largest weight widened %.4g at %s; D cos %.4g at %s\n", points, largest_widened,
              where_widened.c_str(), largest_plain, where_plain.c_str());
  EXPECT_LT(largest_widened, 4);
  EXPECT_GT(largest_plain, 10);
}

template <class T>
Column<T> EdgesOfUnitInterval() {
  Column<T> u = {0, static_cast<T>(0x1p-32), static_cast<T>(0x1p-24), T{0.25}, T{0.5}, T{0.75}};
  u.push_back(std::is_same_v<T, float> ? static_cast<T>(1 - 0x1p-24) : static_cast<T>(1 - 0x1p-53));
  return u;
}

// All of the boundary of the unit square and cube.
TEST(Samplers, EdgesOfTheRandomNumbersGiveUnitVectors) {
  const auto test = [](auto lane, Accuracy accuracy, const std::string& name) {
    using T = decltype(lane);
    const Mode mode{accuracy};
    const double tolerance = accuracy == Accuracy::kFast ? 0x1p-11 : 16 * kRounding<T>;
    const Column<T> edges = EdgesOfUnitInterval<T>();
    Column<T> u1, u2, u3;
    for (const T a : edges) {
      for (const T b : edges) {
        for (const T c : edges) {
          u1.push_back(a);
          u2.push_back(b);
          u3.push_back(c);
        }
      }
    }
    const std::size_t n = u1.size();
    Tally normals("|m| = 1, mz >= 0, pdf finite, " + name), directions("|wo| = 1 on its side, " + name);
    const auto finite = [](double x) { return std::isfinite(x) && x >= 0; };
    std::vector<Distribution> distributions;
    for (const auto& make : {Ggx, Beckmann}) {
      for (const float alpha : {1e-5f, 0.01f, 0.3f, 1.0f, 100.0f}) {
        distributions.push_back(make(alpha, alpha));
      }
      distributions.push_back(make(1e-4f, 1.0f));
    }
    for (const float exponent : {0.0f, 20.0f, 2e10f}) distributions.push_back(Phong(exponent));
    for (const float gamma : {1.55f, 4.0f, 1e10f}) {
      for (const float alpha : {1e-5f, 0.3f, 100.0f}) {
        distributions.push_back(StudentT(gamma, alpha, alpha));
        distributions.push_back(Tabulated(gamma, alpha, alpha));
      }
    }
    for (const Distribution& distribution : distributions) {
      const std::string family(distribution.family);
      for (const float widening_cos : {0.0f, 1e-7f, 0.5f, 1.0f, -1.0f}) {
        const bool widened = widening_cos >= 0;
        if (widened && family != "beckmann") continue;
        const std::vector<Column<T>> out =
            widened
                ? RunAll<T>(family + ".sample_normal_widened", n, mode, u1, u2, widening_cos, distribution)
                : RunAll<T>(family + ".sample_normal", n, mode, u1, u2, distribution);
        for (std::size_t i = 0; i < n; ++i) {
          const auto where = [&] {
            return distribution.Text() +
                   Text(", u %a %a, cos %g", double{u1[i]}, double{u2[i]}, double{widening_cos});
          };
          const Direction m{double{out[0][i]}, double{out[1][i]}, double{out[2][i]}};
          normals.Add(Length(m) - 1, tolerance, where);
          normals.Add(finite(m.z) && finite(out[3][i]) ? 0 : 1, 0, where);
        }
      }
      for (const double vz : {1.0, 0.5, 1e-3, 1e-7, 1e-42, 0.0, -0.0, -1e-7, -0.5, -1.0}) {
        if (family == "phong" || family == "student_t") continue;
        const double sine = std::sqrt((1 - vz) * (1 + vz));
        const auto at = [&](const char* quantity, std::size_t i) {
          return distribution.Text() +
                 Text(", %s, vz %g, u %a %a", quantity, vz, double{u1[i]}, double{u2[i]});
        };
        // Beckmann's density, and that of tables, leaves the range of float where a random number next to 0
        // meets another.
        const auto far = [&](std::size_t i) {
          return family != "ggx" && std::min(u1[i], u2[i]) < static_cast<T>(0x1p-24);
        };
        for (const Direction& v : {Direction{0.8 * sine, 0.6 * sine, vz}, Direction{-sine, 0, vz}}) {
          for (const char* quantity : {"sample_visible_normal", "sample_visible_normal_bounded"}) {
            if (family != "ggx" && std::string_view(quantity) != "sample_visible_normal") continue;
            const std::vector<Column<T>> out =
                RunAll<T>(distribution.Id(quantity), n, mode, v, u1, u2, distribution);
            for (std::size_t i = 0; i < n; ++i) {
              const auto where = [&] { return at(quantity, i); };
              const Direction m{double{out[0][i]}, double{out[1][i]}, double{out[2][i]}};
              normals.Add(Length(m) - 1, tolerance, where);
              normals.Add(m.z > 0 && finite(out[3][i]) && (out[3][i] > 0 || far(i)) ? 0 : 1, 0, where);
            }
          }
          for (const char* quantity : {"sample_visible_reflection", "sample_visible_reflection_bounded"}) {
            if (family == "tabulated") continue;
            if (family != "ggx" && std::string_view(quantity) != "sample_visible_reflection") continue;
            const std::vector<Column<T>> out =
                RunAll<T>(distribution.Id(quantity), n, mode, v, u1, u2, distribution);
            for (std::size_t i = 0; i < n; ++i) {
              const auto where = [&] { return at(quantity, i); };
              const Direction wo{double{out[0][i]}, double{out[1][i]}, double{out[2][i]}};
              const bool kept = out[5][i] == 1;
              directions.Add(Length(wo) - (kept ? 1 : 0), kept ? 4 * tolerance : 0, where);
              const bool valid =
                  kept ? (vz < 0 ? -wo.z : wo.z) > 0 && out[3][i] >= 0 && (out[4][i] > 0 || far(i))
                       : out[3][i] == 0 && out[4][i] == 0 && out[5][i] == 0;
              directions.Add(valid && finite(out[3][i]) && finite(out[4][i]) ? 0 : 1, 0, where);
            }
            // Of a view of no length nothing but the range is asked.
            for (const double length : {1e-10, 1e-20, 1e-30, 1e-42}) {
              const std::vector<Column<T>> of_short =
                  RunAll<T>(distribution.Id(quantity), n, mode, length * v, u1, u2, distribution);
              for (std::size_t i = 0; i < n; ++i) {
                const double weight = of_short[3][i], pdf = of_short[4][i];
                const auto where = [&] { return at(quantity, i) + Text(", |v| = %g", length); };
                directions.Add(weight >= 0 && weight <= 1 && pdf >= 0 && finite(pdf) ? 0 : 1, 0, where);
              }
            }
          }
        }
      }
      if (family == "student_t" || family == "tabulated") continue;  // no models over it
      for (const float eta : {1.5f, 1 / 1.5f, 1.0f, 1.0003f, 4.0f}) {
        for (const double theta : {0.0, 30.0, 41.8, 60.0, 85.0, 89.99}) {
          for (const double side : {1.0, -1.0}) {
            const Direction wi = side * Spherical(Radians(theta), 0.7);
            const std::vector<Column<T>> out =
                RunAll<T>(distribution.Dielectric("sample"), n, mode, wi, u1, u2, u3, distribution, eta);
            for (std::size_t i = 0; i < n; ++i) {
              const auto where = [&] {
                return distribution.Text() + Text(", eta %g, %g degrees, side %g, u %a %a %a", double{eta},
                                                  theta, side, double{u1[i]}, double{u2[i]}, double{u3[i]});
              };
              const Direction wo{double{out[0][i]}, double{out[1][i]}, double{out[2][i]}};
              const double weight = out[3][i], pdf = out[4][i];
              const int lobe = static_cast<int>(out[5][i]);
              if (lobe == 0) {
                directions.Add(std::abs(wo.x) + std::abs(wo.y) + std::abs(wo.z) + weight + pdf, 0, where);
                continue;
              }
              // Refraction out of the denser side magnifies roundings by 1 / eta.
              directions.Add(Length(wo) - 1, tolerance * (1 + 1 / (eta * eta)), where);
              const bool right_side =
                  (wo.z * wi.z > 0) == (lobe == 1) && wo.z != 0 && (lobe == 1 || lobe == 2);
              directions.Add(right_side && finite(weight) && finite(pdf) ? 0 : 1, 0, where);
            }
          }
        }
      }
    }
  };
  test(double{}, Accuracy::kStandard, "double");
  test(float{}, Accuracy::kHigh, "float high");
  test(float{}, Accuracy::kStandard, "float standard");
  test(float{}, Accuracy::kFast, "float fast");
}

}  // namespace
}  // namespace microlane
