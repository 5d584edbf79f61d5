// Tables of user-supplied distributions of slopes: their stated errors against Student-T in closed form, what
// microfacet theory demands of any radial function, and what is no distribution.
#include "microlane/tabulated.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <ctime>
#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "columns.h"
#include "microlane/student_t.h"
#include "quadrature.h"
#include "statistics.h"

namespace microlane {
namespace {

using Radial = std::function<double(double)>;

// Slopes of d'Eon 2023, up to a factor.
Radial StudentRadial(double gamma) {
  return [gamma](double r) { return 7 * std::exp(-gamma * std::log1p(r * r / (gamma - 1))); };
}

Directions<double> Span(const DirectionColumns<double>& v) { return {v.x.data(), v.y.data(), v.z.data()}; }

std::string Stated(const RadialTable& table) {
  return Text("stated errors: D %.1e, Lambda %.1e, sampling %.1e, of visible normals %.1e",
              table.density_error(), table.masking_error(), table.sampling_error(),
              table.visible_sampling_error());
}

struct Kind {
  const char* suffix;
  std::vector<double> roughness;
};
const std::vector<Kind>& Kinds() {
  static const std::vector<Kind> kinds = {{"_isotropic", {0.25}},
                                          {"", {0.5, 0.125}},
                                          {"_rotated", {0.5, 0.125, 0.75}},
                                          {"_off_centre", {0.5, 0.125, 0.75, 0.25, -0.5}}};
  return kinds;
}

// Unit directions from next to the normal to grazing; `below` of them on the other side too.
DirectionColumns<double> Spread(bool below) {
  DirectionColumns<double> v;
  for (int i = 0; i <= 60; ++i) {
    const double tangent = std::exp2(-12 + 0.4 * i), cosine = 1 / std::sqrt(1 + tangent * tangent);
    for (int j = 0; j < 7; ++j) {
      const double phi = 0.9 * j + 0.1 * i, sine = tangent * cosine;
      const Direction up{sine * std::cos(phi), sine * std::sin(phi), cosine};
      v.PushBack(up);
      if (below) v.PushBack(-1 * up);
    }
  }
  return v;
}

// As stated, and next to nothing of what both kernels declare.
TEST(RadialTable, StatesItsErrorsAgainstStudentSlopes) {
  Tally density("D as of student_t"), masking("Lambda as of student_t"), seen("D_visible as of student_t"),
      masked("G1 as of student_t"), share("the share of slopes below sample_normal's"),
      pdf("pdf of sample_normal = D cos");
  for (const float gamma : {1.55f, 1.6f, 1.8f, 2.0f, 2.5f, 4.0f, 30.0f, 1e3f, 1e10f}) {
    const std::clock_t begin = std::clock();
    const RadialTable table(StudentRadial(gamma));
    const double ms = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    ASSERT_TRUE(table.ok()) << table.error();
    std::printf("  gamma %-6g %5zu bytes, %5.1f ms, %s\n", double{gamma}, table.bytes(), ms,
                Stated(table).c_str());
    EXPECT_LE(table.bytes(), 96u << 10);
    EXPECT_LE(table.density_error(), 1e-6);
    EXPECT_LE(table.masking_error(), 2e-6);
    EXPECT_LE(table.sampling_error(), 2e-5);
    EXPECT_LE(table.visible_sampling_error(), 1e-3);
    const double d = 1.05 * table.density_error() + 2e-12, l = table.masking_error() + 2e-12;
    const DirectionColumns<double> v = Spread(true), m = Spread(false);
    for (const Kind& kind : Kinds()) {
      const auto run = [&](std::string_view quantity, const auto&... lanes) {
        const std::string name = std::string(quantity) + kind.suffix;
        const std::size_t n = std::get<0>(std::tie(lanes...)).size();
        struct Pair {
          Column<double> got, expected;
        };
        const Values p{kind.roughness};
        return Pair{RunOne<double>("tabulated." + name, n, {}, lanes..., p, double{gamma}),
                    RunOne<double>("student_t." + name, n, {}, lanes..., double{gamma}, p)};
      };
      const auto where = [&](const DirectionColumns<double>& of, std::size_t i) {
        return [&, i] { return Text("gamma %g", double{gamma}) + kind.suffix + ' ' + Text(of[i]); };
      };
      const auto of_normal = run("D", m);
      const double most = *std::max_element(of_normal.expected.begin(), of_normal.expected.end());
      for (std::size_t i = 0; i < m.size(); ++i) {
        if (!(of_normal.expected[i] > 1e-28 * most)) continue;
        density.AddRelative(of_normal.got[i], of_normal.expected[i], d, where(m, i));
      }
      const auto of_view = run("Lambda", v);
      for (std::size_t i = 0; i < v.size(); ++i) {
        if (!(of_view.expected[i] > 1e-25)) continue;
        masking.AddRelative(of_view.got[i], of_view.expected[i], l, where(v, i));
      }
      DirectionColumns<double> other;
      for (std::size_t i = 0; i < v.size(); ++i) other.PushBack(m[(7 * i) % m.size()]);
      const auto g1 = run("G1", v, other), visible = run("D_visible", v, other);
      for (std::size_t i = 0; i < v.size(); ++i) {
        masked.AddRelative(g1.got[i], g1.expected[i], l, where(v, i));
        if (!(visible.expected[i] > 1e-28 * most)) continue;
        seen.AddRelative(visible.got[i], visible.expected[i], d + l, where(v, i));
      }
    }
    // Of unit roughness, 1 - u = (1 + tan^2/k)^-k.
    Column<double> u1, u2;
    for (int i = 1; i < 2000; ++i) {
      u1.push_back(i < 1000   ? i / 1000.0
                   : i < 1500 ? std::exp2(-0.1 * (i - 999))
                              : 1 - std::exp2(-0.1 * (i - 1499)));
      u2.push_back(0.618 * i - std::floor(0.618 * i));
    }
    const std::size_t n = u1.size();
    const auto out = RunAll<double>("tabulated.sample_normal_isotropic", n, {}, u1, u2, 1.0, double{gamma});
    DirectionColumns<double> drawn{out[0], out[1], out[2]};
    const Column<double> at = RunOne<double>("tabulated.D_isotropic", n, {}, drawn, 1.0, double{gamma});
    for (std::size_t i = 0; i < n; ++i) {
      const auto where = [&] { return Text("gamma %g, u %a", double{gamma}, u1[i]); };
      const double tangent = std::hypot(out[0][i], out[1][i]) / out[2][i], k = gamma - 1.0;
      const double beyond = std::exp(-k * std::log1p(tangent * tangent / k));
      // 1 - u is exact; a rounding of m moves the tangent, and with it a power of up to 37.
      share.AddRelative(u1[i] < 0.5 ? 1 - beyond : beyond, u1[i] < 0.5 ? u1[i] : 1 - u1[i],
                        table.sampling_error() + 1e-12 + 1e-14 / std::min(1.0, u1[i]), where);
      pdf.AddRelative(out[3][i], at[i] * out[2][i], 1e-11 + 1e-14 / out[2][i] / out[2][i], where);
    }
  }
}

struct Named {
  const char* name;
  Radial f;
};
const std::vector<Named>& RadialFunctions() {
  static const std::vector<Named> functions = {
      {"exp(-r)", [](double r) { return std::exp(-r); }},
      {"exp(-r^4)", [](double r) { return std::exp(-std::pow(r, 4)); }},
      {"sum of two lobes", [](double r) { return 0.7 * std::exp(-r * r) + 4 * std::exp(-16 * r * r); }},
      {"GGX and a Gaussian", [](double r) { return std::pow(1 + r * r, -2) + 3 * std::exp(-9 * r * r); }},
      {"power 6, and a ring", [](double r) { return (1 + 3 * r * r) * std::pow(1 + r * r, -4); }},
  };
  return functions;
}

// Walter 2007 Eqs. 2-4; Heitz 2014 Eqs. 14, 16, 17.
TEST(RadialTable, AnyRadialFunctionMakesASmithSurface) {
  Tally normalisation("int D cos = 1"), facing("int D <v.m> = (1 + Lambda) cos"),
      averted("int D <-v.m> = Lambda cos"), visible("int D_visible = 1");
  for (const Named& named : RadialFunctions()) {
    const RadialTable table(named.f);
    ASSERT_TRUE(table.ok()) << named.name << ": " << table.error();
    std::printf("  %-20s %s\n", named.name, Stated(table).c_str());
    for (const double alpha : {0.05, 0.5, 2.0}) {
      const auto where = [&] { return named.name + Text(", alpha %g", alpha); };
      const auto integral = [&](const NormalNodes& nodes, const auto& weight) {
        std::vector<double> d(nodes.size());
        tabulated::D(nodes.size(), Span(nodes.m), table, alpha, alpha / 2, d.data());
        double sum = 0;
        for (std::size_t i = 0; i < nodes.size(); ++i)
          sum += d[i] * nodes.solid_angle[i] * weight(nodes.m[i]);
        return sum;
      };
      // Cubics meet with kinks, which the rules take to 2e-6.
      constexpr double kKinks = 2e-6;
      normalisation.AddRelative(
          integral(AllNormals(alpha, alpha / 2), [](const Direction& m) { return m.z; }), 1, kKinks, where);
      for (const double theta : {1.0, 30.0, 60.0, 85.0, 89.9}) {
        DirectionColumns<double> v;
        v.PushBack(Spherical(Radians(theta), 0.4));
        double lambda = 0;
        tabulated::Lambda(1, Span(v), table, alpha, alpha / 2, &lambda);
        const double a = v[0].z / std::hypot(alpha * v[0].x, alpha / 2 * v[0].y);
        for (const Side side : {Side::kFacing, Side::kAverted}) {
          if (side == Side::kAverted && !(a < 2)) continue;
          const NormalNodes nodes = NormalsOnSide(v[0], alpha, alpha / 2, side, 400, 400);
          const double area = integral(nodes, [&](const Direction& m) { return std::abs(Dot(v[0], m)); });
          const double tolerance = table.masking_error() + kKinks;
          const auto at = [&] { return where() + Text(", %g degrees", theta); };
          if (side == Side::kAverted) {
            averted.AddRelative(area, lambda * v[0].z, tolerance, at);
            continue;
          }
          facing.AddRelative(area, (1 + lambda) * v[0].z, tolerance, at);
          DirectionColumns<double> views;
          for (std::size_t i = 0; i < nodes.size(); ++i) views.PushBack(v[0]);
          std::vector<double> d(nodes.size());
          tabulated::DVisible(nodes.size(), Span(views), Span(nodes.m), table, alpha, alpha / 2, d.data());
          double sum = 0;
          for (std::size_t i = 0; i < nodes.size(); ++i) sum += d[i] * nodes.solid_angle[i];
          visible.AddRelative(sum, 1, tolerance, at);
        }
      }
    }
  }
}

// GTR (Burley 2012), c/(alpha^2 cos^2 + sin^2)^gamma, is the slopes' (1 + r^2)^-gamma: Student-T of another
// alpha.
TEST(RadialTable, ServesGtr) {
  Tally density("D of (1 + r^2)^-gamma"), masking("Lambda of (1 + r^2)^-gamma");
  const DirectionColumns<double> v = Spread(false);
  const std::size_t n = v.size();
  for (const double gamma : {1.6, 3.0, 10.0}) {
    const RadialTable table([&](double r) { return std::pow(1 + r * r, -gamma); });
    ASSERT_TRUE(table.ok()) << table.error();
    for (const double alpha : {0.01, 0.3, 1.0}) {
      const auto where = [&] { return Text("gamma %g, alpha %g", gamma, alpha); };
      std::vector<double> got(n), expected(n);
      const double scaled = alpha / std::sqrt(gamma - 1);
      // alpha / sqrt(gamma - 1) is rounded, and a power multiplies that.
      const double rounded = 1e-12 * gamma;
      tabulated::D(n, Span(v), table, alpha, got.data());
      student_t::D(n, Span(v), gamma, scaled, expected.data());
      const double most = *std::max_element(expected.begin(), expected.end());
      for (std::size_t i = 0; i < n; ++i) {
        if (!(expected[i] > 1e-28 * most)) continue;  // what the table states its error of
        density.AddRelative(got[i], expected[i], 1.05 * table.density_error() + rounded, where);
      }
      tabulated::Lambda(n, Span(v), table, alpha, got.data());
      student_t::Lambda(n, Span(v), gamma, scaled, expected.data());
      for (std::size_t i = 0; i < n; ++i) {
        if (!(expected[i] > 1e-25)) continue;
        masking.AddRelative(got[i], expected[i], table.masking_error() + rounded, where);
      }
    }
  }
}

TEST(RadialTable, RefusesWhatIsNoDistribution) {
  const double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const struct {
    Radial f;
    std::string error;
  } cases[] = {
      {nullptr, "f: no function"},
      {[](double) { return 0; }, "f(0) = 0, must be positive and finite"},
      {[](double) { return -1; }, "f(0) = -1, must be positive and finite"},
      {[=](double) { return nan; }, "f(0) = nan, must be positive and finite"},
      {[=](double) { return inf; }, "f(0) = inf, must be positive and finite"},
      {[](double r) { return 1 / r; }, "f(0) = inf, must be positive and finite"},
      {[=](double r) { return r > 3 ? nan : std::exp(-r * r); },
       "f(3.03125) = nan, must be positive and finite"},
      {[=](double r) { return r > 3 ? -1e-9 : std::exp(-r * r); },
       "f(3.03125) = -1e-09, must be positive and finite"},
      {[](double r) { return std::max(0.0, 1 - r); },
       "f(1) = 0, must be positive until it is below 1e-30 of f(0)"},
      {[](double r) { return std::exp(-1e6 * r * r); },
       "f(0.03125) = 0, must be positive until it is below 1e-30 of f(0)"},
      {[](double) { return 1; }, "f falls as r^-0.00 in the end, must fall at least as r^-3.05"},
      // The end of Student-T: its area is infinite.
      {[](double r) { return std::pow(1 + 2 * r * r, -1.5); },
       "f falls as r^-3.00 in the end, must fall at least as r^-3.05"},
  };
  std::size_t lanes = 0;
  for (const auto& c : cases) {
    const RadialTable table(c.f);
    EXPECT_EQ(table.error(), c.error);
    EXPECT_FALSE(table.ok());
    EXPECT_EQ(table.bytes(), 0u);
    const float x[] = {0, 0.6f, -0.6f}, y[] = {0, 0, 0}, z[] = {1, 0.8f, 0.8f}, u[] = {0, 0.3f, 0.9f};
    const Directions<float> v{x, y, z};
    float out[7][3] = {};
    tabulated::D(3, v, table, 0.3f, out[0]);
    tabulated::Lambda(3, v, table, 0.3f, 0.2f, out[1]);
    tabulated::G1(3, v, v, table, 0.3f, 0.2f, 0.5f, out[2]);
    tabulated::SampleNormal(3, u, u, table, 0.3f, 0.2f, 0.5f, 0.1f, 0.1f, {out[3], out[4], out[5]}, out[6]);
    for (const auto& output : out) {
      for (const float value : output) {
        EXPECT_TRUE(std::isnan(value)) << c.error;
        ++lanes;
      }
    }
  }
  const RadialTable rough([](double r) { return std::exp(-r * r) * (1.5 + std::sin(40 * r)); });
  EXPECT_EQ(rough.error().substr(0, 15), "f is not smooth") << rough.error();
  const RadialTable wide([](double r) { return std::exp(-1e-6 * r * r); });
  EXPECT_EQ(wide.error().substr(0, 27), "f does not vary about r = 1") << wide.error();
  std::printf("  %zu tables refused, %zu lanes of them NaN\n", std::size(cases) + 2, lanes);
}

}  // namespace
}  // namespace microlane
