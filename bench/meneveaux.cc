#include "meneveaux.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <string>

#include "microlane/beckmann.h"
#include "microlane/fresnel.h"
#include "microlane/gaussian.h"
#include "microlane/interfaced.h"
#include "microlane/masking.h"
#include "microlane/quadrature.h"

namespace microlane {
namespace {

constexpr Accuracy kHigh = Accuracy::kHigh;
constexpr double kIncidence = 60;
constexpr float kAlbedo = 0.6f;

// Slopes of Gaussian height fields and angles of a Gaussian are alike for alpha = sqrt(2) sigma.
float AlphaOf(float sigma) { return std::sqrt(2.0f) * sigma; }

// f of the plane's directions.
std::vector<float> OverCosine(const Plane& plane, std::vector<float> f_cos) {
  for (std::size_t i = 0; i < plane.size(); ++i) f_cos[i] /= plane.z[i];
  return f_cos;
}

std::vector<Curve> Albedos() {
  std::vector<Curve> curves;
  for (const float n : {1.0f, 1.1f, 1.33f, 1.5f}) {
    Curve curve{fmt::format("n = {:g}", n), static_cast<int>(curves.size()), false, {}, {}};
    float r_e = 0, r_i = 0;
    fresnel::DiffuseExternal(1, &n, &r_e, kHigh);
    fresnel::DiffuseInternal(1, &n, &r_i, kHigh);
    for (int i = 0; i <= 100; ++i) {
      const float k = 0.01f * static_cast<float>(i);
      curve.x.push_back(static_cast<double>(k));
      curve.y.push_back(static_cast<double>((1 - r_e) * (1 - r_e) * k / (n * n * (1 - k * r_i))));
    }
    curves.push_back(curve);
  }
  return curves;
}

std::vector<Curve> Flat() {
  std::vector<Curve> curves;
  const Plane plane(kIncidence);
  for (const float n : {1.0f, 1.2f, 1.33f, 1.5f}) {
    std::vector<float> f(plane.size());
    interfaced::FacetBody(plane.size(), plane.from_z.data(), plane.z.data(), {n, kAlbedo}, f.data(), kHigh);
    curves.push_back(
        OverDegrees(plane, f, fmt::format("n = {:g}", n), static_cast<int>(curves.size()), false));
  }
  return curves;
}

// Normals of the hemisphere, at the middles of equal steps of theta^2 and of the azimuth.
struct Hemisphere {
  static constexpr int kAngles = 128, kAzimuths = 128;
  Hemisphere() {
    constexpr double kEnd = 90 * kDegree;
    for (int i = 0; i < kAngles; ++i) {
      const double t = (i + 0.5) / kAngles, theta = kEnd * t * t;
      for (int j = 0; j < kAzimuths; ++j) {
        const double phi = 360 * kDegree * (j + 0.5) / kAzimuths;
        x.push_back(static_cast<float>(std::sin(theta) * std::cos(phi)));
        y.push_back(static_cast<float>(std::sin(theta) * std::sin(phi)));
        z.push_back(static_cast<float>(std::cos(theta)));
        solid_angle.push_back(std::sin(theta) * kEnd * 2 * t / kAngles * (360 * kDegree / kAzimuths));
      }
    }
  }
  std::size_t size() const { return x.size(); }
  Directions<float> directions() const { return {x.data(), y.data(), z.data()}; }

  std::vector<float> x, y, z;
  std::vector<double> solid_angle;
};

// f of the body with the masking of V-cavities (Meneveaux 2015 Eqs. 12, 14), a sum over normals of density d.
std::vector<float> VCavityBody(const Plane& plane, const Hemisphere& normals, const std::vector<float>& d,
                               float n) {
  const std::size_t count = normals.size();
  const Directions<float> m = normals.directions();
  std::vector<float> vx(count), vy(count), vz(count), cos_i(count), cos_o(count), g_i(count), g_o(count),
      f(count), values;
  const auto look = [&](float x, float z, std::vector<float>& cosine, std::vector<float>& g) {
    std::fill(vx.begin(), vx.end(), x);
    std::fill(vz.begin(), vz.end(), z);
    masking::VCavity<float>(count, {vx.data(), vy.data(), vz.data()}, m, g.data(), kHigh);
    for (std::size_t k = 0; k < count; ++k) cosine[k] = x * m.x[k] + z * m.z[k];
  };
  look(plane.from_x[0], plane.from_z[0], cos_i, g_i);
  for (std::size_t i = 0; i < plane.size(); ++i) {
    look(plane.x[i], plane.z[i], cos_o, g_o);
    interfaced::FacetBody(count, cos_i.data(), cos_o.data(), {n, kAlbedo}, f.data(), kHigh);
    double sum = 0;
    for (std::size_t k = 0; k < count; ++k) {
      sum += static_cast<double>(f[k] * cos_i[k] * cos_o[k] * d[k] * std::min(g_i[k], g_o[k])) *
             normals.solid_angle[k];
    }
    values.push_back(static_cast<float>(sum / static_cast<double>(plane.from_z[0] * plane.z[i])));
  }
  return values;
}

std::vector<Curve> Rough(float n) {
  constexpr float kSigma = 0.4f;
  const float alpha = AlphaOf(kSigma);
  const Plane plane(kIncidence);
  const Hemisphere normals;
  const QuadratureRule rule(16);
  std::vector<float> d(normals.size()), f_cos(plane.size());
  std::vector<Curve> curves;
  gaussian::D(normals.size(), normals.directions(), kSigma, d.data(), kHigh);
  curves.push_back(OverDegrees(plane, VCavityBody(plane, normals, d, n), "Gaussian, V-cavities", 0, false));
  beckmann::D(normals.size(), normals.directions(), alpha, alpha, d.data(), kHigh);
  curves.push_back(OverDegrees(plane, VCavityBody(plane, normals, d, n), "Beckmann, V-cavities", 1, true));
  interfaced_body_beckmann::Eval(plane.size(), plane.from(), plane.out(), {alpha, alpha}, {n, kAlbedo}, rule,
                                 f_cos.data(), kHigh, JointMasking::kSeparable);
  curves.push_back(OverDegrees(plane, OverCosine(plane, f_cos), "Beckmann, Smith", 2, false));
  interfaced_body::Eval(plane.size(), plane.from(), plane.out(), {alpha, alpha}, {n, kAlbedo}, rule,
                        f_cos.data(), kHigh, JointMasking::kSeparable);
  curves.push_back(OverDegrees(plane, OverCosine(plane, f_cos), "GGX, Smith", 3, false));
  return curves;
}

// Oren and Nayar 1994's qualitative model, light and view in one plane.
float OrenNayar(float sigma, double theta_i, double theta_o) {
  const double s2 = static_cast<double>(sigma) * static_cast<double>(sigma);
  const double a = 1 - 0.5 * s2 / (s2 + 0.33), b = 0.45 * s2 / (s2 + 0.09);
  const double same_side = theta_i * theta_o < 0 ? 1 : 0;  // light comes from the side of negative angles
  const double larger = std::max(std::abs(theta_i), std::abs(theta_o)),
               smaller = std::min(std::abs(theta_i), std::abs(theta_o));
  return static_cast<float>(static_cast<double>(kAlbedo) / (180 * kDegree) *
                            (a + b * same_side * std::sin(larger) * std::tan(smaller)));
}

std::vector<Curve> WithOrenNayar() {
  constexpr float kIndex = 1.5f;
  const Plane plane(kIncidence);
  const Hemisphere normals;
  const std::size_t count = plane.size();
  std::vector<float> half_angle, reflectance(count), mirror(count), d(normals.size());
  for (std::size_t i = 0; i < count; ++i) {
    half_angle.push_back(static_cast<float>(std::cos(0.5 * (Plane::DegreesAt(i) + kIncidence) * kDegree)));
  }
  fresnel::Dielectric(count, half_angle.data(), kIndex, reflectance.data(), kHigh);
  std::vector<Curve> curves;
  for (const float sigma : {0.1f, 0.3f, 0.5f}) {
    gaussian::EvalVCavity(count, plane.from(), plane.out(), sigma, mirror.data(), kHigh);
    gaussian::D(normals.size(), normals.directions(), sigma, d.data(), kHigh);
    std::vector<float> ours = VCavityBody(plane, normals, d, kIndex), theirs(count);
    for (std::size_t i = 0; i < count; ++i) {
      const float specular = reflectance[i] * mirror[i] / plane.z[i];
      theirs[i] = OrenNayar(sigma, kIncidence * kDegree, Plane::DegreesAt(i) * kDegree) + specular;
      ours[i] += specular;
    }
    const int colour = static_cast<int>(curves.size() / 2);
    curves.push_back(OverDegrees(plane, ours, fmt::format("interfaced, sigma = {:g}", sigma), colour, false));
    curves.push_back(OverDegrees(plane, theirs, "Oren-Nayar and specular", colour, true));
  }
  return curves;
}

}  // namespace

MeneveauxFigures MeasureMeneveaux() {
  return {Albedos(), Flat(), {Rough(1.1f), Rough(1.5f)}, WithOrenNayar()};
}

}  // namespace microlane
