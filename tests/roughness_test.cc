// Rotated and off-centre roughness: what Heitz 2014 section 5 says of distributions that are linear maps of
// one of unit roughness.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
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

// Parameters are floats, so that float and double lanes see the same ones.
struct Shear {
  float alpha_x, alpha_y, r_xy, mean_x, mean_y;

  double Uncorrelated() const { return std::sqrt((1 - double{r_xy}) * (1 + double{r_xy})); }
  double Area() const { return double{alpha_x} * alpha_y * Uncorrelated(); }
  double Cosine(const Direction& v) const { return v.z - mean_x * v.x - mean_y * v.y; }
  // Heitz 2014 Eqs. 88, 95: a normal of unit roughness, not normalised, as a normal of this one.
  Direction Normal(const Direction& unit) const {
    const double across = r_xy * unit.x + Uncorrelated() * unit.y;
    return {alpha_x * unit.x - mean_x * unit.z, alpha_y * across - mean_y * unit.z, unit.z};
  }
  // The view of the surface of unit roughness (Eqs. 96, 97).
  Direction UnitView(const Direction& v) const {
    const double y = alpha_y * v.y;
    return {alpha_x * v.x + r_xy * y, Uncorrelated() * y, Cosine(v)};
  }
  std::vector<double> Parameters(std::string_view kind) const {
    std::vector<double> all = {alpha_x, alpha_y, r_xy, mean_x, mean_y};
    all.resize(kind == "_rotated" ? 3 : 5);
    return all;
  }
  std::string Text() const {
    return microlane::Text("alpha %g %g, r %g, ", double{alpha_x}, double{alpha_y}, double{r_xy}) +
           microlane::Text("mean %g %g", double{mean_x}, double{mean_y});
  }
};

struct Case {
  std::string_view family, kind;
  std::vector<double> own;  // parameters of the family's shape
  Shear shear;

  std::string Id(std::string_view quantity) const {
    return std::string(family) + '.' + std::string(quantity) + std::string(kind);
  }
  Distribution Of() const {
    std::vector<double> parameters = own;
    for (const double p : shear.Parameters(kind)) parameters.push_back(p);
    return {family, kind, parameters, shear.alpha_x, shear.alpha_y};
  }
  bool HasVisibleNormals() const { return own.empty(); }
  std::string Text() const { return std::string(family) + std::string(kind) + ' ' + shear.Text(); }
};

std::vector<Case> Cases() {
  std::vector<Case> cases;
  // Of Student-T, powers that the quadrature takes exactly.
  const std::pair<std::string_view, std::vector<double>> families[] = {
      {"ggx", {}}, {"beckmann", {}}, {"student_t", {3}}, {"student_t", {5}}};
  for (const auto& [family, own] : families) {
    for (const float r : {0.0f, 0.5f, -0.9f, 0.99f}) {
      for (const auto& alpha : {std::pair(0.3f, 0.3f), std::pair(1.0f, 0.1f), std::pair(0.05f, 0.4f)}) {
        cases.push_back({family, "_rotated", own, {alpha.first, alpha.second, r, 0, 0}});
        cases.push_back({family, "_off_centre", own, {alpha.first, alpha.second, r, 0.5f, -0.25f}});
        cases.push_back({family, "_off_centre", own, {alpha.first, alpha.second, r, -2, 1}});
      }
    }
  }
  return cases;
}

std::vector<Direction> Views() {
  std::vector<Direction> views = {{0, 0, 1}};
  for (const double theta : {10.0, 45.0, 70.0, 85.0}) {
    for (const double phi : {20.0, 130.0, 250.0}) views.push_back(Spherical(Radians(theta), Radians(phi)));
  }
  return views;
}

// Nodes of unit roughness as normals of the shear, with their solid angles.
struct Nodes {
  DirectionColumns<double> m;
  Column<double> solid_angle;
};
Nodes Sheared(const NormalNodes& unit, const Shear& shear) {
  Nodes nodes;
  for (std::size_t i = 0; i < unit.size(); ++i) {
    const Direction m = shear.Normal(unit.m[i]);
    const double length = Length(m);
    nodes.m.PushBack((1 / length) * m);
    nodes.solid_angle.push_back(unit.solid_angle[i] * shear.Area() / (length * length * length));
  }
  return nodes;
}

// Roundings of m and of D: what cancels is magnified by the mean slope over alpha and by the correlation.
double Tolerance(const Case& c) {
  const Shear& s = c.shear;
  const double slope = (1 + std::hypot(double{s.mean_x}, double{s.mean_y})) /
                       (std::min(s.alpha_x, s.alpha_y) * s.Uncorrelated());
  return 1e-9 + 64 * slope * 0x1p-53 + 2e4 * 0x1p-52;
}

// Walter 2007 Eqs. 2-4; Heitz 2014 Eqs. 9, 94: the microfacets project to the mesosurface.
TEST(Roughness, MicrofacetsProjectToTheMesosurface) {
  Tally tally("int D m = (-mean_x, -mean_y, 1)");
  for (const Case& c : Cases()) {
    const Nodes nodes = Sheared(AllNormals(1, 1), c.shear);
    const Column<double> density = RunOne<double>(c.Id("D"), nodes.m.size(), {}, nodes.m, c.Of());
    double area = 0;
    Direction sum{0, 0, 0};
    for (std::size_t i = 0; i < nodes.m.size(); ++i) {
      const double weight = density[i] * nodes.solid_angle[i];
      area += weight;
      sum = sum + weight * nodes.m[i];
    }
    const auto where = [&] { return c.Text(); };
    tally.Add(sum.z - 1, Tolerance(c), where);
    tally.Add(sum.x + c.shear.mean_x, Tolerance(c) * area + 1e-8, where);
    tally.Add(sum.y + c.shear.mean_y, Tolerance(c) * area + 1e-8, where);
  }
}

// Heitz 2014 Eqs. 14, 16, 96: the areas that face v and -v, of the mesosurface's own cosine.
TEST(Roughness, AreasOfBothSidesAreThoseOfTheMesosurface) {
  Tally facing("int D <v.m> = (1 + Lambda) cos"), averted("int D <-v.m> = Lambda cos");
  Tally visible("int D_visible = 1");
  for (const Case& c : Cases()) {
    for (const Direction& v : Views()) {
      const double cosine = c.shear.Cosine(v);
      const Direction toward = cosine < 0 ? -1 * v : v, unit = c.shear.UnitView(toward);
      const double lambda = RunOne<double>(c.Id("Lambda"), 1, {}, v, c.Of())[0];
      const double a = unit.z / std::hypot(unit.x, unit.y);
      const auto where = [&] { return c.Text() + Text(", v %g %g", v.x, v.y) + Text(" %g", v.z); };
      for (const Side side : {Side::kFacing, Side::kAverted}) {
        if (side == Side::kAverted && !(a < (c.family == "beckmann" ? 5 : 1e8))) continue;
        const Nodes nodes = Sheared(NormalsOnSide(unit, 1, 1, side, 112, 80), c.shear);
        const std::size_t n = nodes.m.size();
        const Column<double> density = RunOne<double>(c.Id("D"), n, {}, nodes.m, c.Of());
        double area = 0;
        for (std::size_t i = 0; i < n; ++i) {
          area += density[i] * nodes.solid_angle[i] * std::abs(Dot(toward, nodes.m[i]));
        }
        if (side == Side::kAverted) {
          averted.AddRelative(area, lambda * unit.z, 1e3 * Tolerance(c), where);
          continue;
        }
        facing.AddRelative(area, (1 + lambda) * unit.z, Tolerance(c), where);
        const Column<double> seen = RunOne<double>(c.Id("D_visible"), n, {}, v, nodes.m, c.Of());
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) sum += seen[i] * nodes.solid_angle[i];
        visible.AddRelative(sum, 1, Tolerance(c), where);
      }
    }
  }
}

// Heitz 2014 Eqs. 66, 74, 96: Lambda is that of unit roughness and of the view that the map makes of v.
TEST(Roughness, MaskingIsInvariantUnderStretchAndShear) {
  Tally tally("Lambda(v) = Lambda at unit roughness of the stretched view");
  for (const Case& c : Cases()) {
    for (const Direction& v : Views()) {
      const double lambda = RunOne<double>(c.Id("Lambda"), 1, {}, v, c.Of())[0];
      const double unit = RunOne<double>(std::string(c.family) + ".Lambda_isotropic", 1, {},
                                         c.shear.UnitView(v), Values{c.own}, 1.0)[0];
      const Direction u = c.shear.UnitView(v);
      const double a2 = u.z * u.z / (u.x * u.x + u.y * u.y);
      if (!(a2 < 600)) continue;
      tally.AddRelative(lambda, unit, (1 + a2) * 1e-12 * (1 + 1 / std::abs(u.z)),
                        [&] { return c.Text() + Text(", v %g %g", v.x, v.y) + Text(" %g", v.z); });
    }
  }
}

// Kinds with nothing to rotate or to move are the kinds before them.
TEST(Roughness, KindsContainEachOther) {
  Tally tally("r_xy = 0, mean slope 0");
  const Direction v = Spherical(1.2, 0.4), m = Spherical(0.3, 2);
  for (const std::string_view family : {"ggx", "beckmann", "student_t"}) {
    const Values own{family == "student_t" ? std::vector<double>{2.5} : std::vector<double>()};
    for (const std::string_view quantity : {"D", "Lambda", "G1", "D_visible"}) {
      const std::string id = std::string(family) + '.' + std::string(quantity);
      const auto run = [&](const std::string& suffix, std::initializer_list<double> parameters) {
        return quantity == "D"        ? RunOne<float>(id + suffix, 1, {}, m, own, parameters)[0]
               : quantity == "Lambda" ? RunOne<float>(id + suffix, 1, {}, v, own, parameters)[0]
                                      : RunOne<float>(id + suffix, 1, {}, v, m, own, parameters)[0];
      };
      const double plain = run("", {0.3, 0.5}), rotated = run("_rotated", {0.3, 0.5, 0.6});
      const auto where = [&] { return id; };
      tally.AddRelative(run("_isotropic", {0.3}), run("", {0.3, 0.3}), 8 * 0x1p-23, where);
      tally.AddRelative(run("_rotated", {0.3, 0.5, 0}), plain, 8 * 0x1p-23, where);
      tally.AddRelative(run("_off_centre", {0.3, 0.5, 0.6, 0, 0}), rotated, 8 * 0x1p-23, where);
      if (quantity != "G1") {
        EXPECT_NE(rotated, plain) << id;
      }
    }
  }
}

// Samples are those of unit roughness, which are tested against their density, mapped; and their density is
// the kernel's.
TEST(Roughness, SamplesAreThoseOfUnitRoughnessMapped) {
  Tally places("sampled normals"), densities("their density");
  Column<double> u1, u2;
  for (int i = 0; i < 16; ++i) {
    for (int j = 0; j < 16; ++j) {
      u1.push_back((i + 0.5) / 16);
      u2.push_back((j + 0.25) / 16);
    }
  }
  const std::size_t n = u1.size();
  for (const Case& c : Cases()) {
    const auto check = [&](const std::vector<Column<double>>& got, const std::vector<Column<double>>& unit,
                           const Column<double>& density, bool times_cosine) {
      for (std::size_t i = 0; i < n; ++i) {
        const auto where = [&] { return c.Text() + Text(", u %g %g", u1[i], u2[i]); };
        const Direction m{got[0][i], got[1][i], got[2][i]};
        const Direction expected = Normalized(c.shear.Normal({unit[0][i], unit[1][i], unit[2][i]}));
        places.Add(Length(m - expected), 1e-13, where);
        densities.AddRelative(got[3][i], density[i] * (times_cosine ? m.z : 1), Tolerance(c), where);
      }
    };
    const auto of = [&](const std::vector<Column<double>>& out) {
      return DirectionColumns<double>{out[0], out[1], out[2]};
    };
    const std::string unit = std::string(c.family) + ".sample_normal_isotropic";
    const auto got = RunAll<double>(c.Id("sample_normal"), n, {}, u1, u2, c.Of());
    check(got, RunAll<double>(unit, n, {}, u1, u2, Values{c.own}, 1.0),
          RunOne<double>(c.Id("D"), n, {}, of(got), c.Of()), true);
    if (!c.HasVisibleNormals()) continue;
    for (const Direction& upper : Views()) {
      for (const double side : {1.0, -1.0}) {
        const Direction v = side * upper;
        const auto seen = RunAll<double>(c.Id("sample_visible_normal"), n, {}, v, u1, u2, c.Of());
        check(seen,
              RunAll<double>(std::string(c.family) + ".sample_visible_normal_isotropic", n, {},
                             c.shear.UnitView(v), u1, u2, 1.0),
              RunOne<double>(c.Id("D_visible"), n, {}, v, of(seen), c.Of()), false);
      }
    }
  }
}

// What LEADR maps rest on: slopes of sampled off-centre normals have the moments that ToMoments says, within
// 5 standard deviations, and FromMoments finds the roughness again.
TEST(Roughness, MomentsAreThoseOfSampledSlopes) {
  constexpr std::size_t kSamples = 200000;
  std::size_t tried = 0;
  double largest = 0, largest_return = 0;
  std::uint64_t seed = 1;
  for (const Case& c : Cases()) {
    if (c.family != "beckmann" || c.kind != "_off_centre") continue;
    const Shear& s = c.shear;
    const Values roughness{{s.alpha_x, s.alpha_y, s.r_xy}}, means{{s.mean_x, s.mean_y}};
    const auto moments = RunAll<double>("roughness.to_moments", 1, {}, roughness, means);
    std::mt19937_64 random(seed++);
    const Column<double> u1 = UniformNumbers<double>(kSamples, random),
                         u2 = UniformNumbers<double>(kSamples, random);
    const auto m = RunAll<double>(c.Id("sample_normal"), kSamples, {}, u1, u2, c.Of());
    // Sums of x^2, y^2, x y and of their squares, x and y the slopes.
    double sum[3] = {0, 0, 0}, square[3] = {0, 0, 0};
    for (std::size_t i = 0; i < kSamples; ++i) {
      const double x = -m[0][i] / m[2][i], y = -m[1][i] / m[2][i];
      const double products[] = {x * x, y * y, x * y};
      for (int k = 0; k < 3; ++k) {
        sum[k] += products[k] / kSamples;
        square[k] += products[k] * products[k] / kSamples;
      }
    }
    for (std::size_t k = 0; k < 3; ++k) {
      const double deviation = std::sqrt((square[k] - sum[k] * sum[k]) / kSamples);
      EXPECT_NEAR(moments[k][0], sum[k], 5 * deviation) << c.Text() << ", moment " << k;
      largest = std::max(largest, std::abs(moments[k][0] - sum[k]) / deviation);
    }
    const Values given{{moments[0][0], moments[1][0], moments[2][0]}};
    const auto back = RunAll<double>("roughness.from_moments", 1, {}, means, given);
    const double expected[] = {s.alpha_x, s.alpha_y, s.r_xy};
    // A rounding of a moment, over the variance that is left of it.
    const double least = std::min(double{s.alpha_x} * s.alpha_x, double{s.alpha_y} * s.alpha_y) / 2;
    const double tolerance = 4e-16 * (1 + (moments[0][0] + moments[1][0]) / least);
    for (std::size_t k = 0; k < 3; ++k) {
      EXPECT_NEAR(back[k][0], expected[k], tolerance) << c.Text() << ", parameter " << k;
      largest_return = std::max(largest_return, std::abs(back[k][0] - expected[k]));
    }
    ++tried;
  }
  std::printf(
      "[points] slope moments: %zu surfaces of %zu samples, at most %.2f standard deviations off; back "
      "within %.1e\n",
      tried, kSamples, largest, largest_return);
  EXPECT_GT(tried, 20U);
}

}  // namespace
}  // namespace microlane
