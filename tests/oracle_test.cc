// Properties that the oracle must have for its own sake: integrals, identities and mended misprints. All in
// the oracle's precision, so that an identity holds to dozens of digits or not at all.
#include "oracle/oracle.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <initializer_list>
#include <limits>
#include <string>
#include <vector>

#include "oracle/beckmann.h"
#include "oracle/fresnel.h"
#include "oracle/ggx.h"
#include "oracle/half_vector.h"
#include "oracle/math.h"
#include "oracle/phong.h"
#include "oracle/rough_dielectric.h"
#include "oracle/student.h"
#include "oracle/student_t.h"
#include "ulp.h"

namespace microlane::oracle {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void ExpectRelative(const Real& got, const Real& expected, double tolerance, const std::string& what = "") {
  const Real error = expected == 0 ? Real(abs(got)) : Real(abs(got / expected - 1));
  EXPECT_LE(static_cast<double>(error), tolerance)
      << what << " got " << static_cast<double>(got) << ", expected " << static_cast<double>(expected);
}

Result EvaluateId(const char* id, const std::vector<Real>& inputs, Transport transport = Transport::kRadiance,
                  int lobe_hint = -1) {
  const std::size_t kernel = KernelIndex(id);
  EXPECT_LT(kernel, kNumKernels) << id;
  EXPECT_EQ(Split(kKernels[kernel].inputs).count, inputs.size()) << id;
  return Evaluate(kernel, inputs.data(), transport, lobe_hint);
}

// Rational points of the unit sphere: unit to the last of the oracle's bits.
Vec UnitFrom(int a, int b, int c, int length) {
  return {Real(a) / length, Real(b) / length, Real(c) / length};
}
const Vec kUnits[] = {UnitFrom(2, 1, 2, 3),    UnitFrom(-3, 2, 6, 7),  UnitFrom(1, -4, 8, 9),
                      UnitFrom(-6, -2, 9, 11), UnitFrom(12, 4, 3, 13), UnitFrom(-4, 12, 3, 13)};

// Visits normals m(theta, phi), tan(theta) = scale e^x, with the solid angle each stands for. The trapezoidal
// rule is exact to the tails here: smooth and decaying in x, periodic in phi.
template <class Visit>
void ForEachNormal(double scale, double step, int num_phi, const Visit& visit) {
  std::vector<SinCos> phi;
  for (int k = 0; k < num_phi; ++k) phi.push_back(SinCos2Pi(Real(2 * k + 1) / (2 * num_phi)));
  for (double x = -20; x <= 20; x += step) {
    const Real tan_theta = scale * exp(Real(x));
    const Real cos_theta = 1 / sqrt(1 + tan_theta * tan_theta);
    const Real sin_theta = tan_theta * cos_theta;
    const Real solid_angle = sin_theta * sin_theta * cos_theta * step * (2 * Pi() / num_phi);
    for (const SinCos& p : phi) visit(Vec{sin_theta * p.cos, sin_theta * p.sin, cos_theta}, solid_angle);
  }
}

// Walter 2007, Eq. 4 and, for the given v, Eq. 3.
template <class Distribution>
void ExpectNormalised(const Distribution& distribution, double scale, const std::string& what) {
  const Vec v = kUnits[0];
  Real projected_n = 0, projected_v = 0;
  ForEachNormal(scale, 0.125, 48, [&](const Vec& m, const Real& solid_angle) {
    const Real area = distribution.D(m) * solid_angle;
    projected_n += area * m.z;
    projected_v += area * Dot(v, m);
  });
  ExpectRelative(projected_n, 1, 1e-12, what + ": int D (n.m)");
  ExpectRelative(projected_v, v.z, 1e-6, what + ": int D (v.m)");
}

TEST(OracleDistribution, ProjectedAreaIsThatOfTheMacrosurface) {
  for (const double alpha : {1e-4, 0.03, 0.3, 1.0, 3.0}) {
    const std::string what = " alpha " + std::to_string(alpha);
    ExpectNormalised(Ggx{{alpha, alpha}}, alpha, "GGX" + what);
    // With cos^2 for cos^4, as Heitz 2014, Eq. 68 prints, alpha = 0.3 would give 0.923.
    ExpectNormalised(Beckmann{{alpha, alpha}}, alpha, "Beckmann" + what);
  }
  ExpectNormalised(Ggx{{0.3, 0.5}}, 0.4, "GGX 0.3 0.5");
  ExpectNormalised(Beckmann{{0.3, 0.5}}, 0.4, "Beckmann 0.3 0.5");
  for (const double gamma : {1.8, 4.0, 50.0}) {
    ExpectNormalised(StudentT{gamma, {0.3, 0.5}}, 0.4, "Student-T " + std::to_string(gamma));
  }
  for (const double exponent : {0.0, 0.5, 10.0, 1e6}) {
    ExpectNormalised(Phong{exponent}, std::sqrt(2 / (exponent + 2)), "Phong " + std::to_string(exponent));
  }
}

// Heitz 2014, Eq. 41 with Eq. 16: the area seen from v is (1 + Lambda(v)) cos(theta_v).
template <class Distribution>
void ExpectSmith(const Distribution& distribution, double scale, const std::string& what) {
  for (const Vec& v : {kUnits[1], kUnits[4]}) {
    Real visible = 0;
    ForEachNormal(scale, 0.1, 96, [&](const Vec& m, const Real& solid_angle) {
      const Real v_m = Dot(v, m);
      if (v_m > 0) visible += v_m * distribution.D(m) * solid_angle;
    });
    ExpectRelative(visible, (1 + distribution.Lambda(v)) * v.z, 1e-3, what);
  }
}

TEST(OracleMasking, SmithLambdaIsTheVisibleProjectedArea) {
  for (const auto& [x, y] : {std::array{0.3, 0.3}, std::array{0.5, 1.5}, std::array{2.0, 0.4}}) {
    const std::string what = " alpha " + std::to_string(x) + " " + std::to_string(y);
    ExpectSmith(Ggx{{x, y}}, std::sqrt(x * y), "GGX" + what);
    ExpectSmith(Beckmann{{x, y}}, std::sqrt(x * y), "Beckmann" + what);
    ExpectSmith(StudentT{2.5, {x, y}}, std::sqrt(x * y), "Student-T" + what);
  }
  for (const double exponent : {0.0, 1.0, 10.0}) {
    ExpectSmith(PhongSmith{{exponent}}, std::sqrt(2 / (exponent + 2)), "Phong " + std::to_string(exponent));
  }
}

TEST(OracleMasking, G1IsOneOverOnePlusLambda) {
  const Ggx ggx{{0.25, 0.75}};
  const Beckmann beckmann{{0.25, 0.75}};
  const Vec n{0, 0, 1};
  for (const Vec& v : kUnits) {
    ExpectRelative(ggx.G1(v, n), 1 / (1 + ggx.Lambda(v)), 1e-120);
    // Walter 2007, Eq. 26 as printed.
    const Real a = 1 / sqrt(InverseA2(v, beckmann.alpha));
    ExpectRelative(beckmann.G1(v, n), 2 / (1 + erf(a) + exp(-a * a) / (a * SqrtPi())), 1e-60);
    EXPECT_EQ(ggx.G1(v, -n), 0);
    EXPECT_EQ(ggx.G1(-v, n), ggx.G1(v, n)) << "same on both sides";
  }
}

TEST(OracleMasking, BeckmannLambdaIsHeitz69AsPrinted) {
  for (const char* digits : {"1e-30", "1e-3", "0.4", "1.6", "3", "6.3", "9", "12.5", "12.6", "14"}) {
    const Real a(digits);
    // v at 45 degrees, alpha = 1/a.
    const Beckmann beckmann{{1 / a, 1 / a}};
    const Real printed = (erf(a) - 1) / 2 + exp(-a * a) / (2 * a * SqrtPi());
    // erf(a) - 1 keeps 447 - a^2 / log(2) of 447 bits.
    const double tolerance = std::max(2e-64, std::exp2(-435 + static_cast<double>(a * a) * 1.45));
    ExpectRelative(beckmann.Lambda({1, 0, 1}), printed, tolerance, digits);
  }
}

TEST(OracleMath, ErfcxDefectIsItsDefinition) {
  for (const char* digits :
       {"1e-40", "1e-8", "0.1", "1", "6.28", "12.5", "12.56", "12.57", "13", "100", "1e4"}) {
    const Real a(digits);
    ExpectRelative(ErfcxDefect(a), 1 - SqrtPi() * a * exp(a * a) * erfc(a), std::exp2(-212), digits);
  }
  EXPECT_EQ(ErfcxDefect(0), 1);
}

// By parts, d(n) = (1 + 2 n w d(n + 1)) / (2 n + 1): of series and continued fraction, on either side of
// where one gives way to the other.
TEST(OracleMath, StudentDefectIsItsOwnSumByParts) {
  for (const char* n_digits : {"0.05", "0.5", "1", "7.3", "58", "60", "1000", "1e10"}) {
    for (const char* a_digits : {"1e-30", "1e-3", "0.3", "1", "5.3", "5.5", "30", "1e4", "1e20"}) {
      const Real n(n_digits), mu = Real(a_digits) / sqrt(n), w = 1 / (1 + mu * mu);
      const Real parts = (1 + 2 * n * w * StudentDefect(mu, n + 1)) / (2 * n + 1);
      ExpectRelative(StudentDefect(mu, n), parts, std::exp2(-200), std::string(n_digits) + " " + a_digits);
    }
  }
  EXPECT_EQ(StudentDefect(0, 3), 1);
}

// The integral by the trapezoidal rule in log(x/mu - 1).
TEST(OracleMath, StudentDefectIsItsDefinition) {
  for (const Real n : {0.05, 0.5, 3.0, 100.0}) {
    for (const Real mu : {1e-3, 0.2, 1.0, 20.0}) {
      Real integral = 0;
      constexpr double kStep = 0.125;
      for (double s = -60; s < (n < 0.1 ? 520 : 160); s += kStep) {
        const Real from = exp(Real(s)) * mu, x = mu + from;
        integral += pow(1 + x * x, -n - 1) * from * kStep;
      }
      const Real exact = 1 - 2 * n * mu * pow(1 + mu * mu, n) * integral;
      ExpectRelative(StudentDefect(mu, n), exact, 1e-20, n.str(3) + " " + mu.str(3));
    }
  }
}

TEST(OracleMasking, StudentSlopesAreGgxPhongAndBeckmann) {
  for (const Vec& v : kUnits) {
    const Roughness alpha{0.4, 1.5};
    ExpectRelative(StudentT{2, alpha}.Lambda(v), Ggx{alpha}.Lambda(v), 1e-100, "GGX");
    ExpectRelative(StudentT{2, alpha}.D(v), Ggx{alpha}.D(v), 1e-100, "D of GGX");
    ExpectRelative(PhongSmith{{0}}.Lambda(v), Ggx{{1, 1}}.Lambda(v), 1e-100, "Phong, e = 0");
    const Real e = 37, same = sqrt(2 / (e + 2));
    ExpectRelative(StudentT{e / 2 + 2, {same, same}}.Lambda(v), PhongSmith{{e}}.Lambda(v), 1e-100, "Phong");
    const Real a = 1 / sqrt(InverseA2(v, alpha)), gamma = 1e20;
    ExpectRelative(StudentT{gamma, alpha}.Lambda(v), Beckmann{alpha}.Lambda(v),
                   4e-20 * (1 + static_cast<double>(a * a * a * a)), "Beckmann");
    const double tan2 = static_cast<double>(StretchedTan2(v, alpha));
    ExpectRelative(StudentT{gamma, alpha}.D(v), Beckmann{alpha}.D(v), 4e-20 * (1 + tan2 * tan2),
                   "D of Beckmann");
  }
}

TEST(OracleMath, QuarterTurnsAreExact) {
  const int sin_quarter[] = {0, 1, 0, -1}, cos_quarter[] = {1, 0, -1, 0};
  for (int k = 0; k < 4; ++k) {
    const SinCos s = SinCos2Pi(Real(k) / 4);
    EXPECT_EQ(s.sin, sin_quarter[k]);
    EXPECT_EQ(s.cos, cos_quarter[k]);
  }
  for (const double u : {1e-30, 0.1, 0.125, 0.3, 0.45, 0.6, 0.875, 0.99}) {
    const SinCos s = SinCos2Pi(u);
    const Real angle = 2 * Pi() * Real(u);
    ExpectRelative(s.sin, sin(angle), 1e-100);
    ExpectRelative(s.cos, cos(angle), 1e-100);
  }
}

TEST(OracleMasking, RationalG1StaysWithinOneAndNearEq26) {
  double largest = 0;
  for (int k = 1; k <= 400; ++k) {
    const Real a = Real(k) / 200;
    const Real rational = RationalG1(a);
    EXPECT_LE(rational, 1) << static_cast<double>(a);
    const Real exact = 2 / (1 + erf(a) + exp(-a * a) / (a * SqrtPi()));
    largest = std::max(largest, static_cast<double>(abs(rational / exact - 1)));
  }
  EXPECT_NEAR(largest, 0.00313, 1e-5);
  EXPECT_EQ(RationalG1(Real("1.5999")), 1) << "as printed: 1.00006";
}

TEST(OracleMasking, PhongLambdaIsZeroAtTheNormalAndInfiniteAtGrazing) {
  const Phong phong{100};
  EXPECT_EQ(phong.Lambda({0, 0, 1}), 0);
  EXPECT_TRUE(isinf(phong.Lambda({1, 0, 0})));
  EXPECT_GE(phong.Lambda({1, 0, 1}), 0);
}

// |d(omega) / d(u1, u2)| of a map onto the sphere, by finite differences that are good to 40 digits.
template <class Map>
Real SphereJacobian(const Map& map, const Real& u1, const Real& u2) {
  const Real step("1e-40");
  const Vec w = map(u1, u2);
  const Vec d1 = map(u1 + step, u2) - w, d2 = map(u1, u2 + step) - w;
  const Vec cross{d1.y * d2.z - d1.z * d2.y, d1.z * d2.x - d1.x * d2.z, d1.x * d2.y - d1.y * d2.x};
  return abs(Dot(w, cross)) / (step * step);
}

template <class Distribution>
void ExpectSamplesItsDensity(const Distribution& distribution, const std::string& what) {
  for (const double u1 : {1e-6, 0.2, 0.7, 0.999}) {
    for (const double u2 : {0.03, 0.3, 0.55, 0.9}) {
      const Vec m = distribution.SampleNormal(u1, u2);
      ExpectRelative(Dot(m, m), 1, 1e-120, what);
      const auto map = [&](const Real& a, const Real& b) { return distribution.SampleNormal(a, b); };
      ExpectRelative(distribution.D(m) * m.z * SphereJacobian(map, u1, u2), 1, 1e-25, what);
      // The quadrant of phi_m, which the arctan of Meneveaux 2015, Eq. 29 forgets.
      EXPECT_EQ(m.x > 0, u2 < 0.25 || u2 > 0.75);
      EXPECT_EQ(m.y > 0, u2 < 0.5);
    }
  }
}

TEST(OracleSampling, NormalsHaveTheDensityDCos) {
  ExpectSamplesItsDensity(Ggx{{0.2, 0.7}}, "GGX");
  ExpectSamplesItsDensity(Beckmann{{0.2, 0.7}}, "Beckmann");
  ExpectSamplesItsDensity(Widened(Beckmann{{0.2, 0.7}}, -0.3), "Beckmann widened");
  ExpectSamplesItsDensity(Phong{37.5}, "Phong");
  for (const double gamma : {1.55, 4.0}) {
    ExpectSamplesItsDensity(StudentT{gamma, {0.2, 0.7}}, "Student-T " + std::to_string(gamma));
  }
}

TEST(OracleSampling, VisibleNormalsHaveTheirDensity) {
  const Ggx ggx{{0.2, 0.7}};
  for (const Vec& v : kUnits) {
    for (const double u1 : {1e-6, 0.2, 0.7, 0.999}) {
      for (const double u2 : {0.03, 0.3, 0.55, 0.9}) {
        const auto map = [&](const Real& a, const Real& b) { return VisibleNormal(v, a, b, ggx.alpha).m; };
        const Vec m = map(u1, u2);
        ExpectRelative(Dot(m, m), 1, 1e-120, "|m|");
        EXPECT_GT(m.z, 0);
        EXPECT_GT(Dot(v, m) * v.z, 0);
        ExpectRelative(ggx.DVisible(v, m) * SphereJacobian(map, u1, u2), 1, 1e-25, "D_visible");
        EXPECT_EQ(ggx.DVisible(-v, m), ggx.DVisible(v, m)) << "same on both sides";
        const Result bounded =
            EvaluateId("ggx.sample_visible_normal_bounded", {v.x, v.y, v.z, u1, u2, 0.2, 0.7});
        const Real k = CapBound(v, ggx.alpha);
        const auto in_cap = [&](const Real& a, const Real& b) {
          return VisibleNormal(v, a, b, ggx.alpha, k).m;
        };
        ExpectRelative(bounded.exact[3] * SphereJacobian(in_cap, u1, u2), 1, 1e-25, "bounded");
      }
    }
  }
}

// The share of visible normals above the slope, by quadrature of Heitz 2014, Eq. 16 at unit roughness, is u1.
TEST(OracleSampling, VisibleSlopesInvertTheirCumulativeFunction) {
  for (const double z : {0.0, 1e-3, 0.3, 1.0}) {
    for (const double r : {1.0, 0.05}) {
      for (const double u : {1e-9, 0.1, 0.6, 0.95, 1 - 0x1p-24}) {
        Real t, reach, spread;
        VisibleSlope(z, r, u, t, reach, spread);
        EXPECT_GT(reach, 0);
        const auto density = [&](const Real& s) { return Real((z + r * s) * exp(-s * s)); };
        const auto integral = [&](const Real& from, const Real& to) {
          constexpr int kSteps = 4000;
          const Real h = (to - from) / kSteps;
          Real sum = density(from) + density(to);
          for (int i = 1; i < kSteps; ++i) sum += (i % 2 == 1 ? 4 : 2) * density(from + i * h);
          return Real(sum * h / 3);
        };
        const Real end = -z / r < -12 ? Real(-12) : Real(-z / r);
        const Real below = integral(end, t), above = integral(t, t + 6);
        ExpectRelative(above / (below + above), u, 1e-8, "share");
      }
    }
  }
}

TEST(OracleSampling, VisibleNormalsOfBeckmannHaveTheirDensity) {
  const Beckmann beckmann{{0.2, 0.7}};
  for (const Vec& v : kUnits) {
    for (const double u1 : {1e-6, 0.2, 0.7, 0.999}) {
      for (const double u2 : {0.03, 0.3, 0.55, 0.9}) {
        const auto map = [&](const Real& a, const Real& b) { return VisibleNormal(beckmann, v, a, b).m; };
        const Vec m = map(u1, u2);
        ExpectRelative(Dot(m, m), 1, 1e-120, "|m|");
        EXPECT_GT(m.z, 0);
        EXPECT_GT(Dot(v, m) * v.z, 0);
        ExpectRelative(beckmann.DVisible(v, m) * SphereJacobian(map, u1, u2), 1, 1e-20, "D_visible");
      }
    }
  }
}

// Walter 2007, Eq. 20 with F = 1 over the density; failed samples are 0 in every output.
TEST(OracleSampling, VisibleReflectionsHaveTheirDensityAndWeight) {
  const Ggx ggx{{0.2, 0.7}};
  const Beckmann beckmann{ggx.alpha};
  std::size_t kept = 0, lost = 0;
  for (const std::string id : {"ggx.sample_visible_reflection", "ggx.sample_visible_reflection_bounded",
                               "beckmann.sample_visible_reflection"}) {
    for (const Vec& wi : kUnits) {
      for (const double u1 : {1e-6, 0.2, 0.7, 0.999}) {
        for (const double u2 : {0.03, 0.3, 0.55, 0.9}) {
          const auto sample = [&](const Real& a, const Real& b) {
            return EvaluateId(id.c_str(), {wi.x, wi.y, wi.z, a, b, ggx.alpha.alpha_x, ggx.alpha.alpha_y});
          };
          const Result r = sample(u1, u2);
          const Vec wo{r.exact[0], r.exact[1], r.exact[2]};
          if (r.exact[5] == 0) {
            ++lost;
            for (int i = 0; i < 5; ++i) EXPECT_EQ(r.exact[i], 0);
            continue;
          }
          ++kept;
          EXPECT_GT(wo.z * wi.z, 0);
          const auto map = [&](const Real& a, const Real& b) {
            const Result at = sample(a, b);
            return Vec{at.exact[0], at.exact[1], at.exact[2]};
          };
          ExpectRelative(r.exact[4] * SphereJacobian(map, u1, u2), 1, 1e-25, id);
          const Vec m = Normalized(ReflectionHalfVector(wi, wo));
          const auto value = [&](const auto& normals) {
            return Real(normals.D(m) / (4 * abs(wi.z) * (1 + normals.Lambda(wi) + normals.Lambda(wo))));
          };
          const Real f_cos = id.front() == 'g' ? value(ggx) : value(beckmann);
          ExpectRelative(r.exact[3] * r.exact[4], f_cos, 1e-100, id);
          EXPECT_LE(r.exact[3], 1);
        }
      }
    }
  }
  EXPECT_GT(kept, 20);
  EXPECT_GT(lost, 0);
}

TEST(OracleSampling, VisibleDensityAtGrazingIsItsLimit) {
  const Ggx ggx{{0.2, 0.7}};
  const Vec m = Normalized({Real(1) / 10, Real(-1) / 5, 1});
  const Real tiny("1e-60");
  ExpectRelative(ggx.DVisible({1, 0, 0}, m), ggx.DVisible({1, 0, tiny}, m), 1e-50);
  EXPECT_EQ(ggx.DVisible({-1, 0, 0}, m), 0);
}

TEST(OracleSampling, FirstRandomNumberOfZeroIsTheNormalOrPhongsHorizon) {
  for (const char* id : {"ggx.sample_normal", "beckmann.sample_normal"}) {
    const Result r = EvaluateId(id, {0, 0.3, 0.5, 0.25});
    EXPECT_EQ(r.exact[0], 0);
    EXPECT_EQ(r.exact[1], 0);
    EXPECT_EQ(r.exact[2], 1);
    ExpectRelative(r.exact[3], 1 / (Pi() * 0.125), 1e-120, id);
  }
  EXPECT_EQ(EvaluateId("phong.sample_normal", {0, 0.3, 20}).exact[2], 0);
}

TEST(OracleDistribution, AnisotropicWithEqualAlphasIsIsotropic) {
  const Vec& m = kUnits[3];
  const Real alpha = 0.375, tan2 = (m.x * m.x + m.y * m.y) / (m.z * m.z), cos4 = m.z * m.z * m.z * m.z;
  // Walter 2007, Eqs. 33 and 25.
  ExpectRelative(EvaluateId("ggx.D_isotropic", {m.x, m.y, m.z, alpha}).exact[0],
                 alpha * alpha / (Pi() * cos4 * Square(alpha * alpha + tan2)), 1e-120);
  ExpectRelative(EvaluateId("beckmann.D_isotropic", {m.x, m.y, m.z, alpha}).exact[0],
                 exp(-tan2 / (alpha * alpha)) / (Pi() * alpha * alpha * cos4), 1e-120);
  for (const char* id : {"ggx.D", "beckmann.D", "ggx.Lambda", "beckmann.Lambda"}) {
    EXPECT_EQ(EvaluateId(id, {m.x, m.y, m.z, alpha, alpha}).exact[0],
              EvaluateId((std::string(id) + "_isotropic").c_str(), {m.x, m.y, m.z, alpha}).exact[0]);
  }
}

// Meneveaux 2015, Eq. 20 exchanges sigma_x and sigma_y.
TEST(OracleDistribution, LargerAlphaXSpreadsAlongX) {
  const std::vector<Real> along_x{0.6, 0, 0.8, 0.9, 0.1}, along_y{0, 0.6, 0.8, 0.9, 0.1};
  for (const char* id : {"ggx.D", "beckmann.D"}) {
    EXPECT_GT(EvaluateId(id, along_x).exact[0], EvaluateId(id, along_y).exact[0]) << id;
  }
}

TEST(OracleDistribution, PhongExponentMatchesBeckmannAtTheNormal) {
  const Real alpha = 0.125;
  const Vec n{0, 0, 1};
  ExpectRelative(Phong{PhongExponent(alpha)}.D(n), Beckmann{{alpha, alpha}}.D(n), 1e-120);
  EXPECT_EQ(PhongExponent(1.5), 0);
}

TEST(OracleFresnel, NormalIncidence) {
  for (const char* eta_digits : {"0.25", "0.9999999", "1.0003", "1.5", "2.42", "4"}) {
    const Real eta(eta_digits);
    ExpectRelative(FresnelDielectric(1, eta), Square((eta - 1) / (eta + 1)), 1e-100, eta_digits);
  }
  ExpectRelative(FresnelDielectric(1, 1.5), Real("0.04"), 1e-120);
}

TEST(OracleFresnel, UnpolarisedIsTheMeanOfBothParts) {
  for (const double eta : {0.3, 0.67, 1.0000001, 1.33, 3.9}) {
    for (const double c : {0.0, 1e-6, 0.1, 0.5, 0.75, 0.9, 1.0, -0.6}) {
      const Real mean = (FresnelDielectricS(c, eta) + FresnelDielectricP(c, eta)) / 2;
      ExpectRelative(FresnelDielectric(c, eta), mean, 1e-100);
      ExpectRelative(EvaluateId("fresnel.dielectric_transmittance", {c, eta}).exact[0], 1 - mean, 1e-90);
    }
  }
}

TEST(OracleFresnel, SameFromBothSidesOfTheInterface) {
  const Real eta("1.5");
  for (const double c : {0.01, 0.3, 0.8, 1.0}) {
    const Real cos_t = sqrt(RefractionRadicand(c, eta));
    ExpectRelative(FresnelDielectric(cos_t, 1 / eta), FresnelDielectric(c, eta), 1e-100);
  }
}

TEST(OracleFresnel, BrewsterTotalReflectionAndEqualIndices) {
  const Real eta("1.5");
  EXPECT_LT(FresnelDielectricP(1 / sqrt(1 + eta * eta), eta), Real("1e-200"));
  EXPECT_EQ(FresnelDielectric(0.7, 1 / eta), 1) << "critical cosine 0.745";
  EXPECT_LT(FresnelDielectric(0.75, 1 / eta), 1);
  EXPECT_EQ(FresnelDielectric(0, eta), 1);
  EXPECT_EQ(FresnelDielectric(0, 1), 0);
  EXPECT_EQ(FresnelDielectric(0.3, 1), 0);
}

TEST(OracleHalfVector, BothFormsOfTheReflectionJacobianAgree) {
  for (const Vec& wi : kUnits) {
    for (const Vec& wo : kUnits) {
      const Vec H = ReflectionHalfVector(wi, wo);
      ExpectRelative(HalfVectorJacobian(wo, H), ReflectionJacobian(Dot(wo, Normalized(H))), 1e-100);
      ExpectRelative(HalfVectorJacobian(-wo, ReflectionHalfVector(-wi, -wo)), HalfVectorJacobian(wo, H),
                     1e-100);
    }
  }
}

TEST(OracleHalfVector, BothFormsOfTheRefractionJacobianAgree) {
  for (const Real& eta : {Real("1.5"), Real("0.6"), Real("1.0001")}) {
    for (const Vec& wi : kUnits) {
      for (const Vec& up : kUnits) {
        const Vec wo = -up, H = RefractionHalfVector(wi, wo, eta), h = Normalized(H);
        ExpectRelative(eta * eta * HalfVectorJacobian(wo, H), RefractionJacobian(Dot(wi, h), Dot(wo, h), eta),
                       1e-90);
      }
    }
  }
}

TEST(OracleHalfVector, ReflectionAndRefractionAreFoundAgain) {
  for (const Vec& wi : {kUnits[0], kUnits[2], -kUnits[0]}) {
    const Vec m = kUnits[1];
    // Walter 2007, Eq. 39 prints |i.m|, which would not be reflected here.
    const Vec reflected = Reflect(wi, m);
    ExpectRelative(Dot(reflected, reflected), 1, 1e-120);
    ExpectRelative(Dot(reflected, m), Dot(wi, m), 1e-120);
    for (const Real& eta : {Real("1.5"), Real("0.95")}) {
      const Vec refracted = Refract(wi, m, eta);
      ExpectRelative(Dot(refracted, refracted), 1, 1e-120);
      const Vec h = Normalized(RefractionHalfVector(wi, refracted, eta));
      ExpectRelative(Square(Dot(h, m)), 1, 1e-110, "Snell");
      EXPECT_LT(Dot(refracted, m) * Dot(wi, m), 0);
    }
  }
  EXPECT_TRUE(IsZero(Refract({0.8, 0, 0.6}, {0, 0, 1}, 0.5)));
}

// Transmitted from kUnits[0] by a normal near n.
const Vec kThrough = UnitFrom(-6, -2, -9, 11);

struct Model {
  std::string id;
  std::vector<Real> parameters;  // and eta
};

std::vector<Model> Models(const Real& eta) {
  return {{"rough_dielectric", {0.4, 0.7, eta}},
          {"rough_dielectric_beckmann", {0.5, 0.3, eta}},
          {"rough_dielectric_phong", {Real(9), eta}}};
}

Result EvaluateModel(const Model& model, const char* kernel, const Vec& a, const Vec& b,
                     Transport transport = Transport::kRadiance, int lobe_hint = -1) {
  std::vector<Real> inputs{a.x, a.y, a.z, b.x, b.y, b.z};
  inputs.insert(inputs.end(), model.parameters.begin(), model.parameters.end());
  return EvaluateId((model.id + "." + kernel).c_str(), inputs, transport, lobe_hint);
}

// Of one lobe, a sampler takes no u3.
Result EvaluateSample(const Model& model, const char* kernel, const Vec& wi, const Vec& u,
                      Transport transport = Transport::kRadiance) {
  const std::string id = model.id + "." + kernel;
  std::vector<Real> inputs{wi.x, wi.y, wi.z, u.x, u.y, u.z};
  if (Split(kKernels[KernelIndex(id)].inputs).per_lane == 5) inputs.pop_back();
  inputs.insert(inputs.end(), model.parameters.begin(), model.parameters.end());
  return EvaluateId(id.c_str(), inputs, transport);
}

TEST(OracleRoughDielectric, WeightTimesPdfIsTheValueAtTheSample) {
  constexpr const char* kKernelsOf[][3] = {{"sample", "eval", "pdf"},
                                           {"sample_separable", "eval_separable", "pdf"},
                                           {"sample_reflection", "eval_reflection", "pdf_reflection"},
                                           {"sample_transmission", "eval_transmission", "pdf_transmission"}};
  for (const auto& [sample, eval, pdf] : kKernelsOf) {
    int lobes[3] = {0, 0, 0};
    const bool chooses = std::string_view(pdf) == "pdf";
    for (const Real& eta : {Real("1.5"), Real("0.7")}) {
      for (const Model& model : Models(eta)) {
        for (const Vec& wi : {kUnits[0], kUnits[1], -kUnits[2], kUnits[4]}) {
          for (const Transport transport : {Transport::kRadiance, Transport::kImportance}) {
            for (const double u3 : {0.0, 0.9}) {
              const Result s =
                  EvaluateSample(model, sample, wi, {0.3, chooses ? 0.45 : 0.5 * u3, u3}, transport);
              ++lobes[static_cast<int>(s.exact[5])];
              if (s.exact[5] == 0) continue;
              const Vec wo{s.exact[0], s.exact[1], s.exact[2]};
              ExpectRelative(Dot(wo, wo), 1, 1e-110);
              ExpectRelative(s.exact[3] * s.exact[4], EvaluateModel(model, eval, wi, wo, transport).exact[0],
                             1e-60, model.id + sample);
              ExpectRelative(s.exact[4], EvaluateModel(model, pdf, wi, wo).exact[0], 1e-60,
                             model.id + sample);
            }
          }
        }
      }
    }
    EXPECT_EQ(lobes[kReflection] > 0, chooses || std::string_view(pdf) == "pdf_reflection") << sample;
    EXPECT_EQ(lobes[kTransmission] > 0, chooses || std::string_view(pdf) == "pdf_transmission") << sample;
  }
}

// Walter 2007, Eq. 38: the density of the scattered direction is that of the map from random numbers, times
// the probability of the lobe.
TEST(OracleRoughDielectric, SamplesHaveTheReportedDensity) {
  const Real eta("1.5");
  for (const Model& model : Models(eta)) {
    for (const int lobe : {kReflection, kTransmission}) {
      const Real u3 = lobe == kReflection ? 0 : 0.9999;
      int judged = 0;
      for (const Vec& wi : kUnits) {
        for (const double u2 : {0.1, 0.4, 0.7}) {
          const Real u1 = 0.5;
          const Vec signed_wi = judged % 2 == 0 ? wi : -wi;
          const auto sample = [&](const Real& a, const Real& b) {
            const Result r = EvaluateModel(model, "sample", signed_wi, {a, b, u3});
            return Vec{r.exact[0], r.exact[1], r.exact[2]};
          };
          const Result r = EvaluateModel(model, "sample", signed_wi, {u1, u2, u3});
          if (r.exact[5] != lobe) continue;
          ++judged;
          const Vec wo{r.exact[0], r.exact[1], r.exact[2]};
          const Vec H = lobe == kReflection ? ReflectionHalfVector(signed_wi, wo)
                                            : RefractionHalfVector(signed_wi, wo, eta);
          const Real F = FresnelDielectric(Dot(signed_wi, Normalized(H)), eta);
          ExpectRelative(r.exact[4] * SphereJacobian(sample, u1, u2), lobe == kReflection ? F : Real(1 - F),
                         1e-25, model.id);
        }
      }
      EXPECT_GT(judged, 5) << model.id;
    }
  }
}

// Walter 2007, section 4.2: f_r is symmetric, f_t / eta_o^2 is.
TEST(OracleRoughDielectric, Reciprocity) {
  const Real eta("1.5");
  const std::vector<Model> models = Models(eta), reversed = Models(1 / eta);
  int transmitted = 0;
  for (std::size_t k = 0; k < models.size(); ++k) {
    for (const Vec& wi : kUnits) {
      for (const Vec& up : kUnits) {
        const Real reflection = EvaluateModel(models[k], "eval", wi, up).exact[0] / up.z;
        ExpectRelative(EvaluateModel(models[k], "eval", up, wi).exact[0] / wi.z, reflection, 1e-60);
        const Vec wo = -up;
        const Real forth = EvaluateModel(models[k], "eval", wi, wo).exact[0] / up.z;
        const Real back = EvaluateModel(reversed[k], "eval", wo, wi).exact[0] / wi.z;
        ExpectRelative(back * eta * eta, forth, 1e-60, models[k].id);
        transmitted += forth > 0;
      }
    }
  }
  EXPECT_GT(transmitted, 20);
}

TEST(OracleRoughDielectric, ImportanceLacksTheSquareOfEta) {
  const Real eta("1.5");
  for (const Model& model : Models(eta)) {
    const Vec wi = kUnits[0], wo = kThrough;
    const Real radiance = EvaluateModel(model, "eval", wi, wo).exact[0];
    const Real importance = EvaluateModel(model, "eval", wi, wo, Transport::kImportance).exact[0];
    ASSERT_GT(radiance, 0);
    ExpectRelative(radiance, eta * eta * importance, 1e-120, model.id);
    EXPECT_EQ(EvaluateModel(model, "eval", wi, kUnits[3]).exact[0],
              EvaluateModel(model, "eval", wi, kUnits[3], Transport::kImportance).exact[0]);
  }
}

TEST(OracleRoughDielectric, LobesAddUpToTheWhole) {
  for (const Model& model : Models(Real("1.5"))) {
    for (const Vec& wo : {kUnits[3], kThrough}) {
      const Vec wi = kUnits[0];
      const Real reflection = EvaluateModel(model, "eval_reflection", wi, wo).exact[0];
      const Real transmission = EvaluateModel(model, "eval_transmission", wi, wo).exact[0];
      EXPECT_EQ(reflection > 0, wo.z > 0);
      EXPECT_EQ(transmission > 0, wo.z < 0);
      EXPECT_EQ(EvaluateModel(model, "eval", wi, wo).exact[0], reflection + transmission);
    }
  }
}

TEST(OracleRoughDielectric, CorrelatedMaskingIsNotDarkerThanSeparable) {
  for (const Model& model : Models(Real("1.5"))) {
    EXPECT_GT(EvaluateModel(model, "eval", kUnits[4], kUnits[5]).exact[0],
              EvaluateModel(model, "eval_separable", kUnits[4], kUnits[5]).exact[0]);
  }
}

// Energy: what leaves is at most what came, Walter 2007, Eq. 37 averaged over the samples.
TEST(OracleRoughDielectric, NoMoreLeavesThanCame) {
  constexpr int kSide = 12;
  for (const Model& model : Models(Real("1.5"))) {
    Real sum = 0;
    for (int i = 0; i < kSide; ++i) {
      for (int j = 0; j < kSide; ++j) {
        for (const int lobe : {kReflection, kTransmission}) {
          const Real u1 = (i + Real("0.5")) / kSide, u2 = (j + Real("0.5")) / kSide,
                     u3 = lobe == kReflection ? 0 : 0.9999999;
          const Result r =
              EvaluateModel(model, "sample", {0.6, 0, 0.8}, {u1, u2, u3}, Transport::kImportance);
          if (r.exact[5] != lobe) continue;
          const Vec wo{r.exact[0], r.exact[1], r.exact[2]};
          const Vec wi{0.6, 0, 0.8};
          const Vec H =
              lobe == kReflection ? ReflectionHalfVector(wi, wo) : RefractionHalfVector(wi, wo, Real("1.5"));
          const Real F = FresnelDielectric(Dot(wi, Normalized(H)), Real("1.5"));
          sum += r.exact[3] * (lobe == kReflection ? F : Real(Real("2.25") * (1 - F)));
        }
      }
    }
    const double energy = static_cast<double>(sum) / (kSide * kSide);
    EXPECT_LT(energy, 1.01) << model.id;
    EXPECT_GT(energy, 0.8) << model.id;
  }
}

TEST(OracleSpecialValues, DegenerateGeometryIsZero) {
  const std::vector<Real> parameters{0.3, 0.3, 1.5};
  const Model ggx{"rough_dielectric", parameters};
  const Vec up = kUnits[0];
  for (const char* kernel : {"eval", "pdf", "eval_separable"}) {
    EXPECT_EQ(EvaluateModel(ggx, kernel, {1, 0, 0}, up).exact[0], 0);
    EXPECT_EQ(EvaluateModel(ggx, kernel, up, {1, 0, 0}).exact[0], 0);
    EXPECT_EQ(EvaluateModel(ggx, kernel, {0, 0, 0}, {0, 0, 0}).exact[0], 0);
    EXPECT_EQ(EvaluateModel({"rough_dielectric", {0.3, 0.3, 1}}, kernel, up, -up).exact[0], 0) << "H = 0";
  }
  for (const Real& output : EvaluateModel(ggx, "sample", {1, 0, 0}, {0.5, 0.5, 0.5}).exact)
    EXPECT_EQ(output, 0);
  EXPECT_TRUE(
      isinf(EvaluateModel({"rough_dielectric", {0.3, 0.3, 1}}, "sample", up, {0.1, 0.1, 0.5}).exact[4]))
      << "the refraction Jacobian at eta = 1";
}

TEST(OracleSpecialValues, LambdaAtTheNormalAndAtGrazing) {
  for (const char* id : {"ggx.Lambda", "beckmann.Lambda"}) {
    EXPECT_EQ(EvaluateId(id, {0, 0, 1, 0.5, 0.5}).exact[0], 0) << id;
    EXPECT_EQ(EvaluateId(id, {0, 0, 0, 0.5, 0.5}).exact[0], 0) << id;
    EXPECT_TRUE(isinf(EvaluateId(id, {0, 1, 0, 0.5, 0.5}).exact[0])) << id;
  }
}

// The smallest Lambda of float inputs, 5e-101, keeps its digits through sqrt(1 + t) - 1.
TEST(OraclePrecision, PrintedGgxLambdaSurvivesTheSmallestFloat) {
  const double tiny = std::numeric_limits<float>::denorm_min(), alpha = 1e-5F;
  const Real t = Square(Real(tiny) * Real(alpha));
  ExpectRelative(EvaluateId("ggx.Lambda", {tiny, 0, 1, alpha, 1}).exact[0], t / (2 * (1 + sqrt(1 + t))),
                 1e-30);
}

TEST(OracleKernelList, EveryEntryIsKnownAndPassesNaNOn) {
  for (std::size_t kernel = 0; kernel < kNumKernels; ++kernel) {
    EXPECT_TRUE(HasKernel(kernel)) << kKernels[kernel].id;
    const std::size_t num_inputs = Split(kKernels[kernel].inputs).count;
    const std::size_t num_outputs = Split(kKernels[kernel].outputs).count;
    for (std::size_t bad = 0; bad < num_inputs; ++bad) {
      double inputs[kMaxInputs];
      for (std::size_t k = 0; k < num_inputs; ++k) {
        inputs[k] = std::max(0.5, FindInput(Split(kKernels[kernel].inputs).name[k]).low);
      }
      const Result fine = Evaluate(kernel, inputs);
      inputs[bad] = kNaN;
      const Result r = Evaluate(kernel, inputs);
      for (std::size_t i = 0; i < num_outputs; ++i) {
        EXPECT_FALSE(isnan(fine.exact[i])) << kKernels[kernel].id;
        EXPECT_TRUE(isnan(r.exact[i])) << kKernels[kernel].id;
      }
    }
  }
}

TEST(OracleSampling, MarginTellsHowFarTheDecisionWas) {
  const Model ggx{"rough_dielectric", {0.3, 0.3, 1.5}};
  const Vec wi = kUnits[0];
  const Result reflected = EvaluateModel(ggx, "sample", wi, {0.1, 0.2, 0});
  ASSERT_EQ(reflected.exact[5], kReflection);
  const Vec h =
      Normalized(ReflectionHalfVector(wi, {reflected.exact[0], reflected.exact[1], reflected.exact[2]}));
  const Real F = FresnelDielectric(Dot(wi, h), 1.5);
  const Result near = EvaluateModel(ggx, "sample", wi, {0.1, 0.2, F * (1 + Real("1e-9"))});
  EXPECT_EQ(near.exact[5], kTransmission);
  EXPECT_LT(near.margin, 1e-9);
  EXPECT_GT(near.margin, 0);
  EXPECT_GT(EvaluateModel(ggx, "sample", wi, {0.1, 0.2, 0.5}).margin, 0.1);

  const Result hinted =
      EvaluateModel(ggx, "sample", wi, {0.1, 0.2, F * (1 + Real("1e-9"))}, Transport::kRadiance, kReflection);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(hinted.exact[i], reflected.exact[i]);
  EXPECT_EQ(hinted.margin, near.margin);
  const Result none = EvaluateModel(ggx, "sample", wi, {0.1, 0.2, 0}, Transport::kRadiance, kNone);
  for (int i = 0; i < 6; ++i) EXPECT_EQ(none.exact[i], 0);
}

TEST(OracleSampling, ScaleCarriesTheConditioning) {
  const Vec wi = kUnits[0];
  const Result r = EvaluateModel({"rough_dielectric", {0.3, 0.3, 1.5}}, "sample", wi, {0.1, 0.2, 0.9});
  ASSERT_EQ(r.exact[5], kTransmission);
  const Vec wo{r.exact[0], r.exact[1], r.exact[2]};
  const Real c = abs(Dot(wi, Normalized(RefractionHalfVector(wi, wo, 1.5))));
  const Real geometry = (1 + 1 / c) * (1 + c * c / FresnelG2(c, 1.5));
  const Real kappa = geometry * (1 + 1 / abs(wo.z));
  const Real length = sqrt(Square(wo.z) + Square(Real(0.3)) * (Square(wo.x) + Square(wo.y)));
  for (int i = 0; i < 3; ++i) ExpectRelative(r.scale[i], 1 + c / sqrt(FresnelG2(c, 1.5)), 1e-90);
  ExpectRelative(r.scale[3], r.exact[3] * geometry * (1 + 1 / abs(wo.z) + 2 * Real(0.3) / length), 1e-30);
  ExpectRelative(r.scale[4], r.exact[4] * kappa, 1e-90);
}

TEST(Ulp, CountsSpacingsOfTheScale) {
  EXPECT_EQ(UlpError(1.0F, Real(1)), 0);
  EXPECT_EQ(UlpError(std::nextafter(1.0F, 2.0F), Real(1)), 1);
  EXPECT_EQ(UlpError(std::nextafter(1.0F, 0.0F), Real(1)), 0.5);
  EXPECT_EQ(UlpError(1.0, Real(1) + ldexp(Real(1), -54)), 0.25);
  EXPECT_EQ(UlpError(0.25F, Real(0.25) + ldexp(Real(1), -24), Real(1)), 0.5);
  const float tiny = std::numeric_limits<float>::denorm_min();
  EXPECT_EQ(UlpError(3 * tiny, Real(tiny)), 2);
  EXPECT_EQ(UlpError(tiny, Real(0)), 1);
  EXPECT_EQ(UlpError(0.0F, ldexp(Real(1), -150)), 0.5);
  EXPECT_EQ(UlpError(-0.0F, Real(0)), 0);
}

TEST(Ulp, InfinitiesAndNaN) {
  const float largest = std::numeric_limits<float>::max(), inf = std::numeric_limits<float>::infinity();
  const Real real_inf = std::numeric_limits<Real>::infinity(), huge = ldexp(Real(1), 1000);
  for (const Real& beyond : {real_inf, huge, Real(2 * Real(largest))}) {
    EXPECT_EQ(UlpError(largest, beyond), 0);
    EXPECT_EQ(UlpError(inf, beyond), 0);
    EXPECT_EQ(UlpError(-inf, beyond), kInfinity);
    EXPECT_EQ(UlpError(-largest, Real(-beyond)), 0);
    EXPECT_EQ(UlpError(std::nextafter(largest, 0.0F), beyond), 1);
    EXPECT_GT(UlpError(1.0F, beyond), 1e6);
  }
  EXPECT_EQ(UlpError(inf, Real(1)), kInfinity);
  EXPECT_EQ(UlpError(static_cast<float>(kNaN), Real(1)), kInfinity);
  const Real nan = std::numeric_limits<Real>::quiet_NaN();
  EXPECT_EQ(UlpError(static_cast<float>(kNaN), nan), 0);
  EXPECT_EQ(UlpError(0.0F, nan), kInfinity);
  EXPECT_EQ(UlpError(0.5F, Real(1), real_inf), 0);
}

TEST(Ulp, CorrectlyRounded) {
  const Real third = Real(1) / 3;
  EXPECT_TRUE(CorrectlyRounded(1.0F / 3.0F, third));
  EXPECT_TRUE(CorrectlyRounded(1.0 / 3.0, third));
  EXPECT_FALSE(CorrectlyRounded(std::nextafter(1.0F / 3.0F, 1.0F), third));
  EXPECT_TRUE(CorrectlyRounded(0.0F, ldexp(Real(1), -150))) << "tie to even";
  EXPECT_TRUE(CorrectlyRounded(std::numeric_limits<float>::denorm_min(), ldexp(Real(3), -151)));
  EXPECT_TRUE(CorrectlyRounded(std::numeric_limits<float>::max(), ldexp(Real(1), 128)));
}

}  // namespace
}  // namespace microlane::oracle
