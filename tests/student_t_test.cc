// Student-T normals: what microfacet theory demands of every gamma, and what they are at its ends. Rotated
// and off-centre ones are in roughness_test.cc, their samplers in sampling_test.cc.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "columns.h"
#include "quadrature.h"
#include "statistics.h"

namespace microlane {
namespace {

std::vector<Distribution> Distributions() {
  std::vector<Distribution> all;
  for (const float gamma : {1.55f, 1.6f, 1.8f, 2.0f, 2.3f, 4.0f, 50.0f, 1e6f, 1e10f}) {
    for (const auto& alpha : {std::pair(1e-3f, 1e-3f), std::pair(0.1f, 0.1f), std::pair(0.5f, 0.5f),
                              std::pair(2.0f, 2.0f), std::pair(0.4f, 0.05f)}) {
      all.push_back(StudentT(gamma, alpha.first, alpha.second));
    }
    all.push_back(Isotropic(StudentT(gamma, 0.3f, 0.3f)));
  }
  return all;
}

std::vector<Direction> Views() {
  std::vector<Direction> views = {{0, 0, 1}};
  for (const double theta : {1.0, 30.0, 60.0, 80.0, 89.0, 89.9}) {
    views.push_back(Spherical(Radians(theta), Radians(20)));
    views.push_back(Spherical(Radians(theta), Radians(130)));
  }
  return views;
}

// Normals that v sees, or sees from behind, by rules for tails of any power, with slopes (P, Q) at unit
// roughness, P along v's azimuth: Q = width sinh(pi/2 sinh t); P in double-exponential steps e^(pi/2 sinh t)
// up from 0, or away from the edge v.m = 0 at P = -a; and P = -sinh y by Gauss-Legendre from there to 0.
constexpr double kReach = 120;
class HeavyNodes {
 public:
  HeavyNodes(const Direction& v, const Distribution& distribution, Side side)
      : distribution_(distribution), gamma_(distribution.parameters[0]) {
    const double sx = distribution.scale_x * v.x, sy = distribution.scale_y * v.y, s = std::hypot(sx, sy);
    px_ = s > 0 ? sx / s : 1;
    py_ = s > 0 ? sy / s : 0;
    if (side == Side::kAverted) {
      AddHalf(-v.z / s, -1);
      return;
    }
    AddHalf(0, 1);
    if (s == 0) {
      AddHalf(0, -1);
      return;
    }
    static const Rule rule = GaussLegendre(96);
    const double half = 0.5 * std::asinh(v.z / s);
    for (std::size_t i = 0; i < rule.node.size(); ++i) {
      const double y = half * (1 + rule.node[i]);
      AddRow(-std::sinh(y), half * rule.weight[i] * std::cosh(y));
    }
  }
  const NormalNodes& nodes() const { return nodes_; }

 private:
  static constexpr double kStep = 1.0 / 12;

  // P = from + sign e^u.
  void AddHalf(double from, double sign) {
    for (int i = -60; i <= 60; ++i) {
      const double t = i * kStep, u = kTestPi / 2 * std::sinh(t);
      if (std::abs(u) > kReach) continue;
      AddRow(from + sign * std::exp(u), kStep * kTestPi / 2 * std::cosh(t) * std::exp(u));
    }
  }
  void AddRow(double p, double dp) {
    const double width = std::sqrt((gamma_ - 1 + p * p) / gamma_);
    for (int j = -48; j <= 48; ++j) {
      const double t = j * kStep, u = kTestPi / 2 * std::sinh(t);
      if (std::abs(u) > 60) continue;
      const double q = width * std::sinh(u), dq = kStep * kTestPi / 2 * std::cosh(t) * width * std::cosh(u);
      nodes_.PushBack(distribution_.scale_x, distribution_.scale_y, p * px_ - q * py_, p * py_ + q * px_,
                      dp * dq);
    }
  }

  const Distribution& distribution_;
  double gamma_, px_, py_;
  NormalNodes nodes_;
};

// What the rule leaves out beyond e^kReach, where <v.m> D falls as P^(2 - 2 gamma), and its own 1e-9.
double QuadratureError(const Distribution& distribution) {
  return 1e-9 + 4 * std::exp(-kReach * (2 * distribution.parameters[0] - 3));
}

// Walter 2007 Eqs. 2-4; Heitz 2014 Eqs. 14, 16, 17.
TEST(StudentT, AreasAreThoseOfSmithsMasking) {
  Tally normalisation("int D cos = 1"), facing("int D <v.m> = (1 + Lambda) cos"),
      averted("int D <-v.m> = Lambda cos"), g1("int D <v.m> G1 = cos"), visible("int D_visible = 1");
  std::size_t num_nodes = 0;
  for (const Distribution& distribution : Distributions()) {
    const double tolerance = QuadratureError(distribution) + DeclaredError<double>(distribution.Id("D"));
    for (const Direction& v : Views()) {
      const auto where = [&] { return distribution.Text() + " v " + Text(v); };
      const double lambda = RunOne<double>(distribution.Id("Lambda"), 1, {}, v, distribution)[0];
      const double masking =
          RunOne<double>(distribution.Id("G1"), 1, {}, v, Direction{0, 0, 1}, distribution)[0];
      const double x = distribution.scale_x * v.x, y = distribution.scale_y * v.y;
      const double a2 = v.z * v.z / (x * x + y * y);
      double cosines = 0;
      for (const Side side : {Side::kFacing, Side::kAverted}) {
        if (side == Side::kAverted && x == 0 && y == 0) continue;
        const HeavyNodes heavy(v, distribution, side);
        const NormalNodes& nodes = heavy.nodes();
        const std::size_t n = nodes.size();
        num_nodes += n;
        const Column<double> density = RunOne<double>(distribution.Id("D"), n, {}, nodes.m, distribution);
        double area = 0;
        for (std::size_t i = 0; i < n; ++i) {
          area += density[i] * nodes.solid_angle[i] * std::abs(Dot(v, nodes.m[i]));
          cosines += density[i] * nodes.solid_angle[i] * nodes.m.z[i];
        }
        if (side == Side::kAverted) {
          // A rounding of v and m beyond the edge, over what is left there.
          if (a2 < 300) averted.AddRelative(area, lambda * v.z, tolerance + 1e-13 * (1 + a2 * a2), where);
          continue;
        }
        facing.AddRelative(area, (1 + lambda) * v.z, tolerance, where);
        g1.AddRelative(area * masking, v.z, tolerance, where);
        const Column<double> seen =
            RunOne<double>(distribution.Id("D_visible"), n, {}, v, nodes.m, distribution);
        double sum = 0;
        for (std::size_t i = 0; i < n; ++i) sum += seen[i] * nodes.solid_angle[i];
        visible.AddRelative(sum, 1, tolerance + DeclaredError<double>(distribution.Id("D_visible")), where);
      }
      normalisation.AddRelative(cosines, 1, tolerance, where);
    }
  }
  normalisation.Note(", nodes " + std::to_string(num_nodes));
}

// Heitz 2014 Eq. 36 with the normals as nodes, each with the direction that it reflects v into.
TEST(StudentT, WeakWhiteFurnaceReflectsEverything) {
  Tally tally("int D(h) G1(wi, h) / (4 |wi.n|) = 1");
  for (const Distribution& distribution : Distributions()) {
    // Half vectors lose narrow lobes, and slopes of 1e12, where the longest tails have not ended.
    if (distribution.scale_y < 0.01 || distribution.parameters[0] < 1.8f) continue;
    for (const double theta : {0.0, 30.0, 60.0, 80.0}) {
      const Direction wi = Spherical(Radians(theta), 0.7);
      const HeavyNodes heavy(wi, distribution, Side::kFacing);
      const NormalNodes& nodes = heavy.nodes();
      const std::size_t n = nodes.size();
      const DirectionColumns<double> wo = RunDirection<double>("reflect", n, {}, wi, nodes.m);
      const DirectionColumns<double> h = RunDirection<double>("half_vector.reflection", n, {}, wi, wo);
      const Column<double> jacobian = RunOne<double>("half_vector.reflection_jacobian", n, {}, wi, wo);
      const Column<double> density = RunOne<double>(distribution.Id("D"), n, {}, h, distribution);
      const Column<double> masking = RunOne<double>(distribution.Id("G1"), n, {}, wi, h, distribution);
      double sum = 0;
      for (std::size_t i = 0; i < n; ++i) {
        // Facets seen at grazing reflect into next to -wi, whose half vector is lost; their share is small.
        if (Dot(wi, nodes.m[i]) < 1e-6) continue;
        sum += density[i] * masking[i] / (4 * wi.z * jacobian[i]) * nodes.solid_angle[i];
      }
      tally.AddRelative(sum, 1, 1e-8, [&] { return distribution.Text() + Text(", %g degrees", theta); });
    }
  }
}

struct Pair {
  std::string_view quantity;
  bool has_v, has_m;
};
constexpr Pair kQuantities[] = {
    {"D", false, true}, {"Lambda", true, false}, {"G1", true, true}, {"D_visible", true, true}};

// Views and normals over the hemisphere, denser towards its ends.
struct Scenes {
  DirectionColumns<double> v, m;
  Column<double> u1, u2;
};
Scenes MakeScenes(double alpha) {
  Scenes scenes;
  for (int i = 0; i < 40; ++i) {
    for (int j = 0; j < 40; ++j) {
      const double z = i < 20 ? std::pow(10.0, -0.3 * i) : (i - 19.0) / 21;
      const double slope = alpha * std::pow(10.0, -2 + 0.1 * j), length = std::sqrt(1 + slope * slope);
      const double phi = 0.7 * i + 1.3 * j;
      const double sine = std::sqrt((1 - z) * (1 + z));
      scenes.v.PushBack({static_cast<float>(sine * std::cos(0.3 * i)),
                         static_cast<float>(sine * std::sin(0.3 * i)), static_cast<float>(z)});
      scenes.m.PushBack({static_cast<float>(slope * std::cos(phi) / length),
                         static_cast<float>(slope * std::sin(phi) / length), static_cast<float>(1 / length)});
      scenes.u1.push_back((i + 0.5) / 40);
      scenes.u2.push_back((j + 0.5) / 40);
    }
  }
  return scenes;
}

// Every quantity of `family` beside Student-T's of that gamma, in every kind of roughness, to the bounds of
// both and `distance`(quantity, i) beyond.
template <class T, class Distance>
void ExpectSame(std::string_view family, double gamma, Accuracy accuracy, Tally& tally,
                const Distance& distance) {
  const Mode mode{accuracy};
  const struct {
    std::string_view suffix;
    std::vector<double> parameters;
  } kinds[] = {{"_isotropic", {0.25}},
               {"", {0.5, 0.125}},
               {"_rotated", {0.5, 0.125, 0.75}},
               {"_off_centre", {0.5, 0.125, 0.75, 0.25, -0.5}}};
  const Scenes scenes = MakeScenes(0.25);
  const std::size_t n = scenes.u1.size();
  DirectionColumns<T> v, m;
  Column<T> u1, u2;
  for (std::size_t i = 0; i < n; ++i) {
    v.PushBack(scenes.v[i]);
    m.PushBack(scenes.m[i]);
    u1.push_back(static_cast<T>(scenes.u1[i]));
    u2.push_back(static_cast<T>(scenes.u2[i]));
  }
  const std::string other(family);
  for (const auto& kind : kinds) {
    const Values p{kind.parameters};
    const auto compare = [&](const std::string& name, const Column<T>& got, const Column<T>& expected,
                             bool component) {
      const double declared =
          DeclaredError<T>("student_t." + name, accuracy) + DeclaredError<T>(other + '.' + name, accuracy);
      for (std::size_t i = 0; i < n; ++i) {
        const auto where = [&] { return name + Text(" %zu", i); };
        const double tolerance = declared + distance(name, i, kind.parameters);
        if (component) {
          tally.Add(double{got[i]} - expected[i], tolerance, where);
        } else if (expected[i] == 0 || expected[i] > 1e-30) {
          tally.AddRelative(got[i], expected[i], expected[i] == 0 ? 0 : tolerance, where);
        }
      }
    };
    for (const Pair& pair : kQuantities) {
      const std::string name = std::string(pair.quantity) + std::string(kind.suffix);
      const auto run = [&](const std::string& of, const Values& own) {
        const std::string id = of + '.' + name;
        return !pair.has_m   ? RunOne<T>(id, n, mode, v, own, p)
               : !pair.has_v ? RunOne<T>(id, n, mode, m, own, p)
                             : RunOne<T>(id, n, mode, v, m, own, p);
      };
      compare(name, run("student_t", Values{{gamma}}), run(other, Values{}), false);
    }
    const std::string name = "sample_normal" + std::string(kind.suffix);
    const auto got = RunAll<T>("student_t." + name, n, mode, u1, u2, Values{{gamma}}, p);
    const auto expected = RunAll<T>(other + '.' + name, n, mode, u1, u2, p);
    for (std::size_t k = 0; k < 4; ++k) compare(name, got[k], expected[k], k < 3);
  }
}

// GGX is gamma = 2.
TEST(StudentT, IsGgxAtGammaTwo) {
  const auto none = [](const std::string&, std::size_t, const std::vector<double>&) { return 0.0; };
  Tally tally("every quantity as of ggx");
  ExpectSame<double>("ggx", 2, Accuracy::kStandard, tally, none);
  for (const Accuracy accuracy : {Accuracy::kHigh, Accuracy::kStandard, Accuracy::kFast}) {
    ExpectSame<float>("ggx", 2, accuracy, tally, none);
  }
}

// Beckmann is the limit, off by the square of the exponent over gamma.
TEST(StudentT, IsBeckmannAsGammaGrows) {
  Tally tally("every quantity as of beckmann");
  // The exponents of the cases are below 80 where the result is above 1e-30.
  const auto apart = [](const std::string&, std::size_t, const std::vector<double>&) {
    return (80.0 * 80 + 10) / 1e10;
  };
  ExpectSame<double>("beckmann", 1e10, Accuracy::kStandard, tally, apart);
  for (const Accuracy accuracy : {Accuracy::kHigh, Accuracy::kStandard, Accuracy::kFast}) {
    ExpectSame<float>("beckmann", 1e10, accuracy, tally, apart);
  }
}

}  // namespace
}  // namespace microlane
