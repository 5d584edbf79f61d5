// The scalar rung against the oracle: every entry of the kernel list, on log-uniform and adversarial inputs,
// in float and in double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <string_view>

#include "microlane/kernel_list.h"
#include "microlane/scalar/evaluate.h"
#include "oracle/oracle.h"
#include "points.h"
#include "ulp.h"

namespace microlane {
namespace {

// Largest errors measured over 40 times the points of a plain run, rounded up, in the outputs' metrics. A
// sample's normal is a double for both: refraction near the critical angle magnifies its rounding, beyond
// what double directions can hide.
struct ScalarBound {
  std::string_view id;
  double of_float, of_double;
};

// clang-format off
constexpr ScalarBound kScalarBounds[] = {
    {"math.exp", 0.75, 0.75},
    {"math.neg_log1m", 1, 1},
    {"math.sincos_2pi", 1.25, 1.25},
    {"math.erfcx_defect", 4, 4},
    {"math.student_defect", 0.51, 12},
    {"ggx.D", 0.51, 5},
    {"ggx.D_isotropic", 0.51, 5},
    {"ggx.Lambda", 0.51, 5},
    {"ggx.Lambda_isotropic", 0.51, 5},
    {"ggx.G1", 0.51, 4},
    {"ggx.G1_isotropic", 0.51, 4},
    {"ggx.sample_normal", 0.51, 12},
    {"ggx.D_visible", 0.51, 8},
    {"ggx.sample_visible_normal", 0.51, 16},
    {"ggx.sample_visible_normal_bounded", 0.51, 24},
    {"ggx.sample_visible_reflection", 0.51, 24},
    {"ggx.sample_visible_reflection_bounded", 0.51, 24},
    {"ggx.sample_visible_reflection_isotropic", 0.51, 24},
    {"ggx.sample_visible_reflection_bounded_isotropic", 0.51, 24},
    {"ggx.pdf_visible_reflection", 0.51, 16},
    {"ggx.pdf_visible_reflection_isotropic", 0.51, 16},
    {"ggx.pdf_visible_reflection_bounded", 0.51, 16},
    {"ggx.pdf_visible_reflection_bounded_isotropic", 0.51, 16},
    {"beckmann.pdf_visible_reflection", 6, 20},
    {"beckmann.pdf_visible_reflection_isotropic", 6, 20},
    {"beckmann.D", 0.51, 8},
    {"beckmann.D_isotropic", 0.51, 10},
    {"beckmann.Lambda", 6, 10},
    {"beckmann.Lambda_isotropic", 6, 10},
    {"beckmann.G1", 4, 6},
    {"beckmann.G1_isotropic", 4, 6},
    {"beckmann.G1_rational", 0.51, 5},
    {"beckmann.sample_normal", 0.51, 12},
    {"beckmann.sample_normal_widened", 0.51, 16},
    {"ggx.D_rotated", 0.51, 10},
    {"ggx.D_off_centre", 0.51, 10},
    {"ggx.Lambda_rotated", 0.51, 10},
    {"ggx.Lambda_off_centre", 0.51, 10},
    {"ggx.G1_rotated", 0.51, 10},
    {"ggx.G1_off_centre", 0.51, 10},
    {"ggx.D_visible_rotated", 0.51, 16},
    {"ggx.D_visible_off_centre", 0.51, 16},
    {"ggx.sample_normal_rotated", 0.51, 512},
    {"ggx.sample_normal_off_centre", 0.51, 512},
    {"ggx.sample_visible_normal_rotated", 0.51, 64},
    {"ggx.sample_visible_normal_off_centre", 0.51, 64},
    {"beckmann.D_rotated", 0.51, 10},
    {"beckmann.D_off_centre", 0.51, 10},
    {"beckmann.Lambda_rotated", 0.51, 2400},
    {"beckmann.Lambda_off_centre", 0.51, 2400},
    {"beckmann.G1_rotated", 0.51, 10},
    {"beckmann.G1_off_centre", 0.51, 10},
    {"beckmann.D_visible_rotated", 0.51, 16},
    {"beckmann.D_visible_off_centre", 0.51, 16},
    {"beckmann.sample_normal_rotated", 0.51, 512},
    {"beckmann.sample_normal_off_centre", 0.51, 512},
    {"ggx.D_visible_isotropic", 0.51, 8},
    {"ggx.sample_normal_isotropic", 0.51, 12},
    {"ggx.sample_visible_normal_isotropic", 0.51, 16},
    {"ggx.sample_visible_normal_bounded_isotropic", 0.51, 24},
    {"math.erfcx", 0.51, 8},
    {"math.erfinv", 0.51, 16},
    {"beckmann.sample_visible_normal", 0.51, 64},
    {"beckmann.sample_visible_normal_isotropic", 0.51, 64},
    {"beckmann.sample_visible_reflection", 0.51, 64},
    {"beckmann.sample_visible_reflection_isotropic", 0.51, 64},
    {"beckmann.sample_visible_normal_rotated", 0.51, 64},
    {"beckmann.sample_visible_normal_off_centre", 0.51, 64},
    {"beckmann.D_visible", 6, 20},
    {"beckmann.D_visible_isotropic", 6, 20},
    {"beckmann.sample_normal_isotropic", 0.51, 12},
    {"phong.exponent", 2.5, 2},
    {"phong.Lambda", 0.51, 16},
    {"phong.G1_smith", 0.51, 12},
    {"phong.D", 3, 4},
    {"phong.G1", 0.51, 5},
    {"phong.sample_normal", 0.51, 4},
    {"gaussian.C", 0.51, 32},
    {"gaussian.D", 0.51, 6000},
    {"gaussian.D_visible_v_cavity", 0.51, 6000},
    {"gaussian.eval_v_cavity", 0.51, 6000},
    {"gaussian.sample_normal", 0.51, 48},
    {"fresnel.dielectric", 0.51, 3},
    {"fresnel.dielectric_transmittance", 0.51, 0.51},
    {"fresnel.dielectric_s", 0.51, 2.5},
    {"fresnel.dielectric_p", 0.51, 2.5},
    {"fresnel.conductor", 0.51, 0.51},
    {"fresnel.schlick", 0.51, 3},
    {"fresnel.diffuse_external", 0.51, 24},
    {"fresnel.diffuse_internal", 0.51, 16},
    {"interfaced.facet_body", 0.51, 16},
    {"math.azimuth_difference", 0.51, 2},
    {"roughness.from_moments", 0.51, 4},
    {"roughness.to_moments", 0.51, 0.51},
    {"ggx.D_visible_v_cavity", 0.51, 8},
    {"ggx.D_visible_v_cavity_isotropic", 0.51, 8},
    {"ggx.sample_visible_normal_v_cavity", 0.51, 24},
    {"ggx.sample_visible_normal_v_cavity_isotropic", 0.51, 24},
    {"beckmann.D_visible_v_cavity", 0.51, 20},
    {"beckmann.D_visible_v_cavity_isotropic", 0.51, 20},
    {"beckmann.sample_visible_normal_v_cavity", 0.51, 24},
    {"beckmann.sample_visible_normal_v_cavity_isotropic", 0.51, 24},
    {"student_t.D", 0.51, 10},
    {"student_t.D_isotropic", 0.51, 10},
    {"student_t.D_rotated", 0.51, 10},
    {"student_t.D_off_centre", 0.51, 10},
    {"student_t.Lambda", 0.51, 16},
    {"student_t.Lambda_isotropic", 0.51, 16},
    {"student_t.Lambda_rotated", 0.51, 2400},
    {"student_t.Lambda_off_centre", 0.51, 2400},
    {"student_t.G1", 0.51, 12},
    {"student_t.G1_isotropic", 0.51, 12},
    {"student_t.G1_rotated", 0.51, 16},
    {"student_t.G1_off_centre", 0.51, 16},
    {"student_t.D_visible", 0.51, 20},
    {"student_t.D_visible_isotropic", 0.51, 20},
    {"student_t.D_visible_rotated", 0.51, 20},
    {"student_t.D_visible_off_centre", 0.51, 20},
    {"student_t.sample_normal", 0.51, 64},
    {"student_t.sample_normal_isotropic", 0.51, 64},
    {"student_t.sample_normal_rotated", 0.51, 512},
    {"student_t.sample_normal_off_centre", 0.51, 512},
    {"student_t.D_visible_v_cavity", 0.51, 20},
    {"student_t.D_visible_v_cavity_isotropic", 0.51, 20},
    {"student_t.sample_visible_normal_v_cavity", 0.51, 64},
    {"student_t.sample_visible_normal_v_cavity_isotropic", 0.51, 64},
    {"tabulated.D", 0.51, 500},
    {"tabulated.D_isotropic", 0.51, 500},
    {"tabulated.D_rotated", 0.51, 2500},
    {"tabulated.D_off_centre", 0.51, 2500},
    {"tabulated.Lambda", 0.51, 3000},
    {"tabulated.Lambda_isotropic", 0.51, 3000},
    {"tabulated.Lambda_rotated", 0.51, 3000},
    {"tabulated.Lambda_off_centre", 0.51, 3000},
    {"tabulated.G1", 0.51, 12},
    {"tabulated.G1_isotropic", 0.51, 12},
    {"tabulated.G1_rotated", 0.51, 16},
    {"tabulated.G1_off_centre", 0.51, 16},
    {"tabulated.D_visible", 0.51, 500},
    {"tabulated.D_visible_isotropic", 0.51, 500},
    {"tabulated.D_visible_rotated", 0.51, 3000},
    {"tabulated.D_visible_off_centre", 0.51, 3000},
    {"tabulated.sample_visible_normal", 0.51, 40000},
    {"tabulated.sample_visible_normal_isotropic", 0.51, 40000},
    {"tabulated.sample_visible_normal_rotated", 0.51, 40000},
    {"tabulated.sample_visible_normal_off_centre", 0.51, 400000},
    {"tabulated.sample_normal", 0.51, 256},
    {"tabulated.sample_normal_isotropic", 0.51, 256},
    {"tabulated.sample_normal_rotated", 0.51, 256},
    {"tabulated.sample_normal_off_centre", 0.51, 256},
    {"tabulated.D_visible_v_cavity", 0.51, 500},
    {"tabulated.D_visible_v_cavity_isotropic", 0.51, 500},
    {"tabulated.sample_visible_normal_v_cavity", 0.51, 256},
    {"tabulated.sample_visible_normal_v_cavity_isotropic", 0.51, 256},
    {"phong.D_visible_v_cavity", 3, 5},
    {"phong.sample_visible_normal_v_cavity", 0.51, 6},
    {"masking.v_cavity", 0.51, 0.51},
    {"masking.implicit", 0, 0},
    {"masking.schlick_smith", 0.51, 3},
    {"masking.kelemen", 0.51, 0.51},
    {"masking.separable", 0.51, 2.5},
    {"masking.height_correlated", 0.51, 2},
    {"masking.height_correlated_transmission", 0.51, 4000},
    {"masking.student_lambda", 0.51, 16},
    {"masking.direction_correlated", 0.51, 3.5},
    {"masking.height_direction_correlated", 0.51, 2.5},
    {"half_vector.reflection", 0.51, 0.51},
    {"half_vector.reflection_jacobian", 0.51, 0.51},
    {"half_vector.reflection_jacobian_cos", 0.51, 0.51},
    {"half_vector.refraction", 0.51, 0.51},
    {"half_vector.refraction_jacobian", 0.51, 0.51},
    {"half_vector.refraction_jacobian_cos", 0.51, 0.51},
    {"half_vector_density.ward", 3, 8},
    {"half_vector_density.phong", 3, 5},
    {"albedo.directional", 0.51, 4},
    {"coupled.eval", 0.51, 64},
    {"coupled.pdf", 0.51, 64},
    {"coupled.eval_pdf", 0.51, 64},
    {"coupled.sample", 0.51, 0x1p14},
    {"reflect", 4, 4},
    {"refract", 6, 6},
};
// clang-format on

// Of each family's quantities, by DielectricQuantity::What; the density of visible normals has a Lambda, as
// the value has.
constexpr ScalarBound kScalarModelBounds[kNumModelFamilies][4] = {
    {{"eval", 0.51, 16}, {"pdf", 0.51, 16}, {"eval_pdf", 0.51, 16}, {"sample", 2.5, 32768}},
    {{"eval", 6, 20}, {"pdf", 0.51, 20}, {"eval_pdf", 6, 20}, {"sample", 2.5, 32768}},
    {{"eval", 0.51, 16}, {"pdf", 0.51, 16}, {"eval_pdf", 0.51, 16}, {"sample", 2.5, 32768}}};

constexpr ScalarBound FindModelBound(Normals normals, const DielectricQuantity& row) {
  const bool has_lambda = row.visible && row.what == DielectricQuantity::kPdf;
  return kScalarModelBounds[static_cast<std::size_t>(normals)]
                           [has_lambda ? DielectricQuantity::kEvalPdf : row.what];
}

constexpr ScalarBound FindBound(std::size_t kernel) {
  if (kernel >= kFirstMeanFresnelKernel) return {"", 1, 1024};
  if (kernel >= kFirstDiffuseKernel) {
    const bool samples =
        kDiffuseQuantities[PlaceOfDiffuseKernel(kernel).quantity].what == DielectricQuantity::kSample;
    return {"", 6, samples ? 0x1p18 : 64};  // Lambda of Beckmann
  }
  if (kernel >= kFirstReflectorKernel) {
    const ReflectorKernelPlace place = PlaceOfReflectorKernel(kernel);
    return FindModelBound(place.normals, kReflectorQuantities[place.quantity]);
  }
  if (kernel >= kFirstDielectricKernel) {
    const ModelKernelPlace place = PlaceOfDielectricKernel(kernel);
    return FindModelBound(place.normals, kDielectricQuantities[place.quantity]);
  }
  const std::string_view id = kKernels[kernel].id;
  for (const ScalarBound& bound : kScalarBounds) {
    if (bound.id == id) return bound;
  }
  return {"", -1, -1};
}

// Points per kernel; MICROLANE_POINTS multiplies them.
std::size_t NumPoints() {
  const char* factor = std::getenv("MICROLANE_POINTS");
  return static_cast<std::size_t>(6000 * (factor == nullptr ? 1.0 : std::atof(factor)));
}

struct Direction {
  double x, y, z;
};

Direction operator*(double s, const Direction& v) { return {s * v.x, s * v.y, s * v.z}; }
Direction operator-(const Direction& a, const Direction& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
double Dot(const Direction& a, const Direction& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }

// Inputs for one entry of the list. All are floats, so that both rungs see the same ones.
class Generator {
 public:
  explicit Generator(std::size_t kernel)
      : id_(kKernels[kernel].id),
        inputs_(Split(kKernels[kernel].inputs)),
        random_(20070 + SeedOf(kKernels[kernel].id)) {}

  void Fill(double* in) {
    DrawParameters();
    DrawGeometry();
    for (std::size_t i = 0; i < inputs_.count; ++i) {
      double value = Named(inputs_.name[i]);
      // Directions need not be unit, nor sums of them generic.
      if (inputs_.name[i].back() == 'x' || inputs_.name[i].back() == 'y' || inputs_.name[i].back() == 'z') {
        if (inputs_.name[i] != "x" && Chance(0.05)) value = Nudge(value);
      }
      in[i] = static_cast<float>(value);
    }
  }

 private:
  double Uniform() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  bool Chance(double p) { return Uniform() < p; }
  double LogUniform(double low, double high) { return low * std::pow(high / low, Uniform()); }
  double Sign() { return Chance(0.5) ? 1 : -1; }
  // A few floats away.
  double Nudge(double x) {
    float y = static_cast<float>(x);
    const int steps = static_cast<int>(4 * Uniform());
    const float to = static_cast<float>(Sign()) * std::numeric_limits<float>::max();
    for (int i = 0; i < steps; ++i) y = std::nextafter(y, to);
    return y;
  }

  double Alpha() {
    const double u = Uniform();
    if (u < 0.05) return 1;
    if (u < 0.1) return 1e-5;
    if (u < 0.15) return 1e2;
    return LogUniform(1e-5, u < 0.6 ? 2 : 1e2);
  }

  double Eta() {
    constexpr double typical[] = {1, 1.0003, 1.33, 1.5, 2.42, 4};
    const double u = Uniform();
    if (u < 0.25) return std::pow(typical[static_cast<int>(6 * Uniform())], Sign());
    if (u < 0.5) return 1 + Sign() * LogUniform(1e-7, 0.3);
    return LogUniform(0.25, 4);
  }

  double Exponent() {
    const double u = Uniform();
    if (u < 0.05) return 0;
    if (u < 0.1) return 2e10;
    return u < 0.4 ? std::floor(LogUniform(1, 1000)) : LogUniform(1e-3, 2e10);
  }

  // Cosines in (0, 1]: anywhere, grazing, and near the pole.
  double Cosine() {
    constexpr double edges[] = {1, 0, 1e-38, 1e-42};
    const double u = Uniform();
    if (u < 0.04) return edges[static_cast<int>(4 * Uniform())];
    if (u < 0.4) return LogUniform(1e-7, 1);
    if (u < 0.6) return 1 - LogUniform(1e-7, 1);
    return Uniform();
  }

  // In [0, 1).
  double Random() {
    constexpr double edges[] = {0, 0x1p-32, 0x1p-24, 0.25, 0.5, 0.75, 1 - 0x1p-24};
    const double u = Uniform();
    if (u < 0.05) return edges[static_cast<int>(7 * Uniform())];
    if (u < 0.15) return LogUniform(1e-30, 1);
    if (u < 0.3) return std::min(1 - LogUniform(0x1p-24, 1), 1 - 0x1p-24);
    return std::min(Uniform(), 1 - 0x1p-24);
  }

  Direction FromCosine(double cosine) {
    const double sine = std::sqrt((1 - cosine) * (1 + cosine));
    const double phi = Chance(0.1) ? std::floor(4 * Uniform()) * M_PI_2 : 2 * M_PI * Uniform();
    return {sine * std::cos(phi), sine * std::sin(phi), cosine};
  }

  // Zeros, ones, and numbers at the bottom of float's range.
  Direction AxisDirection() {
    constexpr double values[] = {0, 0, -0.0, 1, -1, 0.6, -0.8, 1e-38, -1e-38, 1e-42, -1e-42, 1e-7};
    const auto value = [&] { return values[static_cast<int>(12 * Uniform())]; };
    while (true) {
      const Direction v{value(), value(), value()};
      if (Dot(v, v) > 0.1) return v;
    }
  }

  Direction AnyDirection() {
    if (Chance(0.03)) return AxisDirection();
    Direction v = FromCosine(Sign() * Cosine());
    if (Chance(0.02)) v = (1 + 1e-3 * (Uniform() - 0.5)) * v;
    return v;
  }

  bool Has(std::string_view part) const { return id_.find(part) != std::string_view::npos; }

  // A normal inside the lobe, and now and then in its far tail.
  Direction LobeNormal() {
    if (sigma_ > 0) {
      const double angle =
          sigma_ * std::sqrt(-2 * std::log(Chance(0.2) ? LogUniform(1e-42, 1) : 1 - Uniform()));
      const double phi = 2 * M_PI * Uniform(), theta = std::fmod(angle, M_PI_2);
      return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
    }
    const double u = Chance(0.2) ? LogUniform(1e-42, 1) : 1 - Uniform();
    double radius;
    double scale_x = alpha_x_, scale_y = alpha_y_;
    if (Has("phong")) {
      radius = std::sqrt(std::expm1(-2 * std::log(u) / (exponent_ + 2)));
      scale_x = scale_y = 1;
    } else if (Has("beckmann")) {
      radius = std::sqrt(-std::log(u));
    } else if (Has("student_t") || Has("tabulated")) {
      radius = std::sqrt((gamma_ - 1) * std::expm1(-std::log(u) / (gamma_ - 1)));
    } else {
      radius = std::sqrt((1 - u) / u);
    }
    if (Has("isotropic")) scale_y = scale_x;
    const double phi = 2 * M_PI * Uniform();
    const double x = scale_x * radius * std::cos(phi), y = scale_y * radius * std::sin(phi);
    return 1 / std::sqrt(x * x + y * y + 1) * Direction{x, y, 1};
  }

  void DrawParameters() {
    if (std::count(inputs_.name.begin(), inputs_.name.end(), "gamma") > 0) {
      gamma_ = static_cast<float>(Chance(0.1) ? 2 : 1.5 + LogUniform(0.0500001, Chance(0.3) ? 10 : 1e10));
    }
    if (Has("tabulated")) {
      constexpr float kTails[] = {1.55f, 1.7f, 2, 2.5f, 4, 30, 1e3f, 1e10f};
      gamma_ = kTails[static_cast<int>(8 * Uniform())];
    }
    if (std::count(inputs_.name.begin(), inputs_.name.end(), "sigma") > 0) {
      sigma_ = static_cast<float>(Chance(0.1)   ? 1e-3
                                  : Chance(0.1) ? 2
                                                : LogUniform(Chance(0.5) ? 0.1 : 1e-3, 2));
    }
    alpha_x_ = Alpha();
    alpha_y_ = Chance(0.3) ? alpha_x_ : Alpha();
    eta_ = static_cast<float>(Eta());
    exponent_ = Exponent();
  }

  // wi, a normal in the lobe on its side, and wo reflected or refracted in it, near it, or unrelated.
  void DrawGeometry() {
    m_ = LobeNormal();
    v_ = wi_ = AnyDirection();
    // Not an axis: with an axis for v, the sign of v.m can hang on a term of 1e-42.
    if (Has("G1")) m_ = Chance(0.5) ? FromCosine(Sign() * Cosine()) : m_;
    if (Has("Lambda") || Has("G1")) DrawMasked();
    const double side = wi_.z < 0 ? -1 : 1;
    Direction facing = side * m_;
    if (Chance(0.2) && eta_ < 1) DrawCritical(facing);
    const double c = Dot(wi_, facing);
    const double g2 = (eta_ - 1) * (eta_ + 1) + c * c;
    const double u = Uniform();
    if (u < 0.1) {
      wo_ = AnyDirection();
    } else if (u < 0.15) {
      wo_ = -1 * wi_;
    } else if (u < 0.2) {
      wo_ = {-wi_.x, -wi_.y, wi_.z};
    } else if (g2 < 0 || u < 0.2 + 0.8 * ReflectionShare()) {
      wo_ = 2 * c * facing - wi_;
    } else {
      wo_ = 1 / eta_ * ((c - std::sqrt(g2)) * facing - wi_);
    }
    if (Has("reflect") || Has("refract")) m_ = Chance(0.5) ? facing : AnyDirection();
    cos_i_ = Sign() * Cosine();
    if (Has("fresnel") && Chance(0.3)) DrawSpecialCosine();
    cos_o_ = Chance(0.5) ? Sign() * Cosine() : Nudge(-cos_i_ / eta_);
    if (Chance(0.01)) cos_o_ = 0;
  }

  double ReflectionShare() const {
    if (Has("transmission") || Has("half_vector.refraction")) return 0;
    return Has("reflection") ? 1 : 0.5;
  }

  // a = 1 / (alpha tan) of the order of 1, where Lambda is neither 0 nor infinite.
  void DrawMasked() {
    if (Chance(0.3)) return;
    const double a = LogUniform(1e-3, 12);
    const double scale = Has("phong") ? 1 / std::sqrt(exponent_ / 2 + 1) : alpha_x_;
    const double tangent = 1 / (a * scale);
    v_ = 1 / std::hypot(1, tangent) * Direction{tangent, 0, Sign()};
    if (Has("isotropic") || Has("phong")) {
      const double phi = 2 * M_PI * Uniform();
      v_ = {v_.x * std::cos(phi), v_.x * std::sin(phi), v_.z};
    }
  }

  // wi at the critical angle to the normal.
  void DrawCritical(const Direction& facing) {
    const double c = std::sqrt((1 - eta_) * (1 + eta_)) * (1 + Sign() * LogUniform(1e-9, 1e-2));
    Direction tangent = AnyDirection();
    tangent = tangent - Dot(tangent, facing) * facing;
    const double length = std::sqrt(Dot(tangent, tangent));
    if (length < 1e-3 || c >= 1) return;
    wi_ = c * facing - -std::sqrt(1 - c * c) / length * tangent;
  }

  // At the critical angle, or Brewster's.
  void DrawSpecialCosine() {
    if (eta_ < 1 && Chance(0.5)) {
      cos_i_ = Nudge(std::sqrt((1 - eta_) * (1 + eta_)));
    } else {
      cos_i_ = Nudge(1 / std::sqrt(1 + eta_ * eta_));
    }
  }

  double Named(std::string_view name) {
    if (name == "mx") return m_.x;
    if (name == "my") return m_.y;
    if (name == "mz") return Chance(0.02) ? -m_.z : m_.z;
    if (name == "vx") return v_.x;
    if (name == "vy") return v_.y;
    if (name == "vz") return v_.z;
    if (name == "wix") return wi_.x;
    if (name == "wiy") return wi_.y;
    if (name == "wiz") return wi_.z;
    if (name == "wox") return wo_.x;
    if (name == "woy") return wo_.y;
    if (name == "woz") return wo_.z;
    if (name == "cos_i") return cos_i_;
    if (name == "cos_o") return cos_o_;
    if (name == "alpha" || name == "alpha_x") return alpha_x_;
    if (name == "alpha_y") return alpha_y_;
    if (name == "r_xy") return Chance(0.1) ? Sign() * 0.9999 : Sign() * Uniform() * 0.9999;
    if (name == "mean_x" || name == "mean_y") return Chance(0.1) ? 0 : Sign() * LogUniform(1e-4, 16);
    if (name == "moment_xx" || name == "moment_yy") return LogUniform(1e-9, 5e3);
    if (name == "moment_xy") return Sign() * LogUniform(1e-9, 5e3);
    if (name == "exponent") return exponent_;
    if (name == "eta") return eta_;
    if (name == "n") return Chance(0.4) ? eta_ : static_cast<float>(LogUniform(0.05, 10));
    if (name == "kappa") return Chance(0.2) ? 0 : LogUniform(Chance(0.2) ? 1e-30 : 1e-4, 20);
    if (name == "f0") return Chance(0.2) ? 0 : Chance(0.2) ? 1 : LogUniform(1e-9, 1);
    if (name == "Lambda_i" || name == "Lambda_o")
      return Chance(0.1) ? 0 : LogUniform(Chance(0.2) ? 1e-44 : 1e-4, Chance(0.2) ? 1e38 : 1e4);
    if (name[0] == 'u') return Random();
    if (name == "x") return Chance(0.2) ? Sign() * LogUniform(1e-20, 1) : -104 + 192 * Uniform();
    if (name == "gamma" || name == "tail") return gamma_;
    if (name == "mu") {
      const double a = LogUniform(Chance(0.1) ? 1e-44 : 1e-5, Chance(0.5) ? 10 : 1e4);
      return Chance(0.05) ? 0 : a / std::sqrt(gamma_ - 1);
    }
    if (name == "a") return Chance(0.05) ? 0 : LogUniform(Chance(0.1) ? 1e-44 : 1e-5, Chance(0.5) ? 10 : 1e4);
    if (name == "order") return 1 + std::floor(Chance(0.05) ? 32 * Uniform() : 5 * Uniform());
    if (name == "n_i") return static_cast<float>(eta_ < 1 ? 1 / eta_ : eta_);
    if (name == "k") return Chance(0.2) ? 0 : Chance(0.2) ? 1 : Uniform();
    if (name == "m") return Chance(0.5) ? 0.03 : Chance(0.5) ? 0.8 : 1e-4;  // few tables
    if (name == "sigma") return sigma_;
    if (name == "index") return Chance(0.6) ? 1.7 : Chance(0.5) ? 1.0003 : 4;
    ADD_FAILURE() << "no generator for input " << name;
    return 0;
  }

  const std::string_view id_;
  const Names inputs_;
  std::mt19937_64 random_;
  double alpha_x_ = 1, alpha_y_ = 1, eta_ = 1, exponent_ = 0, cos_i_ = 1, cos_o_ = 1, gamma_ = 2, sigma_ = 0;
  Direction m_{}, v_{}, wi_{}, wo_{};
};

std::string HexFloats(const double* values, std::size_t count) {
  std::ostringstream out;
  out << std::hexfloat;
  for (std::size_t i = 0; i < count; ++i) out << (i == 0 ? "" : ", ") << values[i];
  return out.str();
}

struct Worst {
  double ulp = 0;
  double inputs[kMaxInputs] = {};
  std::string what;

  void Take(double error, const double* in, const std::string& description) {
    if (error <= ulp) return;
    ulp = error;
    std::copy(in, in + kMaxInputs, inputs);
    what = description;
  }
};

// A decision that lies this close may turn out either way.
template <class T>
constexpr double kDecision = 64 * std::numeric_limits<T>::epsilon();

template <class T>
void Judge(std::size_t kernel, const double* in, bool importance, Worst& worst) {
  const Names outputs = Split(kKernels[kernel].outputs);
  T inputs[kMaxInputs] = {};
  for (std::size_t i = 0; i < kMaxInputs; ++i) inputs[i] = static_cast<T>(in[i]);
  T got[kMaxOutputs] = {};
  scalar::Evaluate(kernel, inputs, got,
                   importance ? scalar::Transport::kImportance : scalar::Transport::kRadiance);
  const oracle::Transport transport =
      importance ? oracle::Transport::kImportance : oracle::Transport::kRadiance;
  oracle::Result truth = oracle::Evaluate(kernel, in, transport);
  if (outputs.name[outputs.count - 1] == "lobe" && got[outputs.count - 1] != truth.exact[outputs.count - 1] &&
      truth.margin < kDecision<T>) {
    truth = oracle::Evaluate(kernel, in, transport, static_cast<int>(got[outputs.count - 1]));
  }
  if (truth.facet_margin < kDecision<T>) {
    // Either facet of the V-cavity: that of the normal, or of the direction, that came out.
    const oracle::Result other = oracle::Evaluate(kernel, in, transport, -1, true);
    const auto distance = [&](const oracle::Result& result) {
      double sum = 0;
      for (int k = 0; k < 3; ++k) {
        sum += std::abs(static_cast<double>(got[k]) - static_cast<double>(result.exact[k]));
      }
      return sum;
    };
    if (distance(other) < distance(truth)) truth = other;
  }
  // At eta = 1 the refraction Jacobian is infinite, however its oracle rounds 1/0.
  const bool samples = outputs.name[outputs.count - 1] == "lobe";
  const Names names = Split(kKernels[kernel].inputs);
  if (samples && got[5] == 2 && names.name[names.count - 1] == "eta" && in[names.count - 1] == 1 &&
      truth.exact[4] > 0) {
    truth.exact[4] = truth.scale[4] = oracle::Infinity();
  }
  for (std::size_t i = 0; i < outputs.count; ++i) {
    const double error = UlpError(got[i], truth.exact[i], truth.scale[i]);
    std::ostringstream what;
    if (error > worst.ulp) {
      what << outputs.name[i] << " = " << std::hexfloat << got[i] << std::defaultfloat << " (" << got[i]
           << "), exact " << truth.exact[i].str(20) << ", margin " << truth.margin
           << (importance ? ", importance" : "");
    }
    worst.Take(error, in, what.str());
  }
}

std::string TestName(std::size_t kernel) {
  std::string name(kKernels[kernel].id);
  std::replace(name.begin(), name.end(), '.', '_');
  return name;
}

class ScalarKernel : public testing::TestWithParam<std::size_t> {};

INSTANTIATE_TEST_SUITE_P(List, ScalarKernel, testing::Range(std::size_t{0}, kNumKernels),
                         [](const auto& named) { return TestName(named.param); });

TEST_P(ScalarKernel, StaysWithinItsBoundOfTheOracle) {
  const std::size_t kernel = GetParam();
  const std::string_view id = kKernels[kernel].id;
  ASSERT_TRUE(oracle::HasKernel(kernel));
  const std::size_t num_inputs = Split(kKernels[kernel].inputs).count;
  Generator generator(kernel);
  Worst of_float, of_double;
  const std::size_t points = NumPoints() / OracleCost(kernel);
  for (std::size_t i = 0; i < points; ++i) {
    double in[kMaxInputs] = {};
    generator.Fill(in);
    const bool importance = kKernels[kernel].has_transport && i % 4 == 0;
    Judge<float>(kernel, in, importance, of_float);
    Judge<double>(kernel, in, importance, of_double);
  }
  std::printf("[points] %.*s %zu, max ulp float %.3g, double %.3g\n", static_cast<int>(id.size()), id.data(),
              points, of_float.ulp, of_double.ulp);
  const ScalarBound bound = FindBound(kernel);
  EXPECT_LE(of_float.ulp, bound.of_float) << "inputs " << HexFloats(of_float.inputs, num_inputs) << "\n"
                                          << of_float.what;
  EXPECT_LE(of_double.ulp, bound.of_double) << "inputs " << HexFloats(of_double.inputs, num_inputs) << "\n"
                                            << of_double.what;
}

// Any finite float in a direction, with parameters in their domains.
template <class T>
void ExpectFinite(std::size_t kernel, const double* in) {
  const Names names = Split(kKernels[kernel].inputs), outputs = Split(kKernels[kernel].outputs);
  T inputs[kMaxInputs] = {}, got[kMaxOutputs] = {};
  for (std::size_t i = 0; i < kMaxInputs; ++i) inputs[i] = static_cast<T>(in[i]);
  scalar::Evaluate(kernel, inputs, got);
  for (std::size_t i = 0; i < outputs.count; ++i) {
    ASSERT_TRUE(std::isfinite(got[i]))
        << outputs.name[i] << " = " << got[i] << " at " << HexFloats(in, names.count)
        << (sizeof(T) == 4 ? " float" : " double");
  }
}

TEST_P(ScalarKernel, GivesFiniteNumbersForFiniteInputs) {
  const std::size_t kernel = GetParam();
  const Names names = Split(kKernels[kernel].inputs);
  std::mt19937_64 random(7);
  constexpr float specials[] = {0.0f,       -0.0f, 1.0f,  -1.0f,  1e-38f, -1e-38f,          0x1p-149f,
                                -0x1p-149f, 0.6f,  -0.8f, 1e-20f, -1e-7f, 0x1.fffffep+127f, -0x1.fffffep+127f,
                                1e30f,      -1e19f};
  for (int point = 0; point < 20000; ++point) {
    double in[kMaxInputs] = {};
    for (std::size_t i = 0; i < names.count; ++i) {
      const Input& input = FindInput(names.name[i]);
      const double u = std::uniform_real_distribution<double>(0, 1)(random);
      const bool bounded = input.low >= 0 || input.name == "r_xy" || input.name.substr(0, 4) == "mean";
      float value =
          static_cast<float>(bounded ? input.low + (input.high - input.low) * u * u * u
                                     : std::ldexp(2 * u - 1, static_cast<int>(random() % 278) - 149));
      if (random() % 4 == 0) {
        value = bounded ? static_cast<float>(random() % 2 == 0 ? input.low : input.high)
                        : specials[random() % 16];
      }
      if (names.name[i] == "eta" && random() % 4 == 0) value = 1;
      if (names.name[i] == "order") value = std::round(value);
      if (names.name[i] == "m") value = random() % 2 == 0 ? 1e-4f : 0.8f;  // few tables
      if (names.name[i] == "index") value = random() % 2 == 0 ? 4.f : 1.7f;
      if (names.name[i] == "tail") value = random() % 2 == 0 ? 1.55f : 4.f;
      in[i] = value;
    }
    ExpectFinite<float>(kernel, in);
    ExpectFinite<double>(kernel, in);
    if (HasFatalFailure()) return;
  }
}

TEST_P(ScalarKernel, GivesNanWhereAnInputIsNan) {
  const std::size_t kernel = GetParam();
  const Names names = Split(kKernels[kernel].inputs), outputs = Split(kKernels[kernel].outputs);
  Generator generator(kernel);
  for (int point = 0; point < 200; ++point) {
    double in[kMaxInputs] = {};
    generator.Fill(in);
    for (std::size_t nan = 0; nan < names.count; ++nan) {
      float inputs[kMaxInputs], got[kMaxOutputs] = {};
      for (std::size_t i = 0; i < kMaxInputs; ++i) inputs[i] = static_cast<float>(in[i]);
      inputs[nan] = std::numeric_limits<float>::quiet_NaN();
      scalar::Evaluate(kernel, inputs, got);
      for (std::size_t i = 0; i < outputs.count; ++i) {
        ASSERT_TRUE(std::isnan(got[i])) << outputs.name[i] << " = " << got[i] << " with NaN in "
                                        << names.name[nan] << " at " << HexFloats(in, names.count);
      }
    }
  }
}

}  // namespace
}  // namespace microlane
