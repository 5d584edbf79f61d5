// Scalar code in the manner of production renderers: pbrt-v3's and pbrt-v4's trigonometry of directions, D,
// Lambda, FrDielectric and dielectric BSDF; Mitsuba 0.6's D cos sampling, its weight, and its Phong
// distribution. Lambda of Beckmann is the rational approximation (Walter 2007 Eq. 27) that all of them use,
// so it is faster than Eq. 26 and within 0.35 % of G1 only. It is inlined and composed at compile time; it is
// neither vectorised nor rearranged.
#include "textbook.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <map>
#include <type_traits>
#include <utility>

#include "microlane/albedo.h"
#include "microlane/kernel_list.h"
#include "microlane/mean_fresnel_fit.h"

// NOLINTBEGIN(clang-analyzer-core*): the analyser enters no loop more than four times, so that Loop's inputs
// behind the fourth have no value to it.
namespace microlane::textbook {
namespace {

constexpr float kPi = 3.14159265358979323846f;

struct Vec3 {
  float x, y, z;
};

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
inline Vec3 operator-(const Vec3& a) { return {-a.x, -a.y, -a.z}; }
inline Vec3 operator*(float s, const Vec3& a) { return {s * a.x, s * a.y, s * a.z}; }
inline Vec3 operator/(const Vec3& a, float s) {
  const float inverse = 1 / s;
  return {a.x * inverse, a.y * inverse, a.z * inverse};
}
inline float Dot(const Vec3& a, const Vec3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline float AbsDot(const Vec3& a, const Vec3& b) { return std::abs(Dot(a, b)); }
inline Vec3 Cross(const Vec3& a, const Vec3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline float LengthSquared(const Vec3& a) { return Dot(a, a); }
inline Vec3 Normalize(const Vec3& a) { return a / std::sqrt(LengthSquared(a)); }
inline float Sqr(float x) { return x * x; }

// Directions in the shading frame.
inline float CosTheta(const Vec3& w) { return w.z; }
inline float Cos2Theta(const Vec3& w) { return w.z * w.z; }
inline float AbsCosTheta(const Vec3& w) { return std::abs(w.z); }
inline float Sin2Theta(const Vec3& w) { return std::max(0.f, 1 - Cos2Theta(w)); }
inline float SinTheta(const Vec3& w) { return std::sqrt(Sin2Theta(w)); }
inline float TanTheta(const Vec3& w) { return SinTheta(w) / CosTheta(w); }
inline float Tan2Theta(const Vec3& w) { return Sin2Theta(w) / Cos2Theta(w); }
inline float CosPhi(const Vec3& w) {
  const float sin_theta = SinTheta(w);
  return sin_theta == 0 ? 1 : std::clamp(w.x / sin_theta, -1.f, 1.f);
}
inline float SinPhi(const Vec3& w) {
  const float sin_theta = SinTheta(w);
  return sin_theta == 0 ? 0 : std::clamp(w.y / sin_theta, -1.f, 1.f);
}
inline float Cos2Phi(const Vec3& w) { return Sqr(CosPhi(w)); }
inline float Sin2Phi(const Vec3& w) { return Sqr(SinPhi(w)); }
inline bool SameHemisphere(const Vec3& a, const Vec3& b) { return a.z * b.z > 0; }
inline Vec3 SphericalDirection(float sin_theta, float cos_theta, float phi) {
  return {sin_theta * std::cos(phi), sin_theta * std::sin(phi), cos_theta};
}

// Azimuth of an anisotropic normal, Ward's way.
inline float EllipticAzimuth(float u, float alpha_x, float alpha_y) {
  return std::atan(alpha_y / alpha_x * std::tan(kPi + 2 * kPi * u)) + kPi * std::floor(2 * u + 0.5f);
}

// Walter 2007 Eq. 27 as Lambda = 1 / G1 - 1, given a.
inline float RationalLambda(float a) {
  if (a >= 1.6f) return 0;
  return (1 - 1.259f * a + 0.396f * a * a) / (3.535f * a + 2.181f * a * a);
}
inline float RationalG1(float a) {
  if (a >= 1.6f) return 1;
  return (3.535f * a + 2.181f * a * a) / (1 + 2.276f * a + 2.577f * a * a);
}

// Incomplete Beta function over the whole, by Lentz's continued fraction.
inline float BetaFraction(float a, float b, float x) {
  constexpr float kTiny = 1e-30f;
  float c = 1, d = 1 / (1 - (a + b) * x / (a + 1)), h = d;
  for (int m = 1; m < 300; ++m) {
    const float k = static_cast<float>(m);
    for (const float term : {k * (b - k) * x / ((a - 1 + 2 * k) * (a + 2 * k)),
                             -(a + k) * (a + b + k) * x / ((a + 2 * k) * (a + 1 + 2 * k))}) {
      const float below = 1 + term * d;
      d = 1 / (std::abs(below) < kTiny ? kTiny : below);
      c = 1 + term / c;
      h *= d * c;
    }
    if (std::abs(d * c - 1) < 3e-7f) break;
  }
  return h;
}
inline float RegularisedBeta(float a, float b, float x) {
  if (x <= 0 || x >= 1) return x <= 0 ? 0 : 1;
  const float front =
      std::exp(std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log(1 - x));
  return x < (a + 1) / (a + b + 2) ? front * BetaFraction(a, b, x) / a
                                   : 1 - front * BetaFraction(b, a, 1 - x) / b;
}

// Smith's Lambda of slopes of Student's density: C (1 + mu^2)^-n / (2 n mu) less the share of slopes above
// mu.
struct StudentParts {
  float gain, loss;
};
inline StudentParts OfStudent(float mu, float n) {
  const float c = std::exp(std::lgamma(n + 1) - std::lgamma(n + 0.5f)) / std::sqrt(kPi);
  return {c * std::pow(1 + Sqr(mu), -n) / (2 * n * mu),
          0.5f * RegularisedBeta(n + 0.5f, 0.5f, 1 / (1 + Sqr(mu)))};
}
inline float StudentLambda(float mu, float n) {
  const StudentParts parts = OfStudent(mu, n);
  return parts.gain - parts.loss;
}
struct Ggx {
  static constexpr Normals kNormals = Normals::kGgx;
  static constexpr std::size_t kParameters = 2;
  float alpha_x, alpha_y;

  static Ggx Make(const float* in) { return {in[0], in[1]}; }

  static float Shape(float e) { return 1 / Sqr(1 + e); }
  static float LambdaOfA(float a) { return (std::sqrt(1 + 1 / Sqr(a)) - 1) / 2; }

  float D(const Vec3& wm) const {
    const float tan2_theta = Tan2Theta(wm);
    if (wm.z <= 0 || std::isinf(tan2_theta)) return 0;
    const float cos4_theta = Sqr(Cos2Theta(wm));
    const float e = tan2_theta * (Cos2Phi(wm) / Sqr(alpha_x) + Sin2Phi(wm) / Sqr(alpha_y));
    return 1 / (kPi * alpha_x * alpha_y * cos4_theta * Sqr(1 + e));
  }

  float Lambda(const Vec3& w) const {
    const float abs_tan_theta = std::abs(TanTheta(w));
    if (std::isinf(abs_tan_theta)) return 0;
    const float alpha = std::sqrt(Cos2Phi(w) * Sqr(alpha_x) + Sin2Phi(w) * Sqr(alpha_y));
    return (std::sqrt(1 + Sqr(alpha * abs_tan_theta)) - 1) / 2;
  }

  Vec3 SampleNormal(float u1, float u2) const {
    float phi = 2 * kPi * u2, alpha2 = Sqr(alpha_x);
    if (alpha_x != alpha_y) {
      phi = EllipticAzimuth(u2, alpha_x, alpha_y);
      alpha2 = 1 / (Sqr(std::cos(phi) / alpha_x) + Sqr(std::sin(phi) / alpha_y));
    }
    const float tan2_theta = alpha2 * u1 / (1 - u1);
    const float cos_theta = 1 / std::sqrt(1 + tan2_theta);
    return SphericalDirection(std::sqrt(std::max(0.f, 1 - Sqr(cos_theta))), cos_theta, phi);
  }

  // As Eto and Tokuyoshi 2023 print it.
  float CapBound(const Vec3& w) const {
    const float a2 = Sqr(std::clamp(std::min(alpha_x, alpha_y), 0.f, 1.f));
    const float s2 = Sqr(1 + std::sqrt(Sqr(w.x) + Sqr(w.y)));
    return (1 - a2) * s2 / (s2 + a2 * Sqr(w.z));
  }
  Vec3 SampleVisibleNormalBounded(const Vec3& w, float u1, float u2) const {
    const Vec3 wh = Normalize({alpha_x * w.x, alpha_y * w.y, w.z});
    const float phi = 2 * kPi * u2, b = CapBound(w) * wh.z;
    const float z = (1 - u1) * (1 + b) - b, sin_theta = std::sqrt(std::clamp(1 - Sqr(z), 0.f, 1.f));
    const Vec3 nh = Vec3{sin_theta * std::cos(phi), sin_theta * std::sin(phi), z} + wh;
    return Normalize({alpha_x * nh.x, alpha_y * nh.y, nh.z});
  }

  // Heitz 2018, "Sampling the GGX Distribution of Visible Normals".
  Vec3 SampleVisibleNormal(const Vec3& w, float u1, float u2) const {
    const Vec3 wh = Normalize({alpha_x * w.x, alpha_y * w.y, w.z});
    const float sin2_theta = Sqr(wh.x) + Sqr(wh.y);
    const Vec3 t1 = sin2_theta > 0 ? Vec3{-wh.y, wh.x, 0} / std::sqrt(sin2_theta) : Vec3{1, 0, 0};
    const Vec3 t2 = Cross(wh, t1);
    const float r = std::sqrt(u1), phi = 2 * kPi * u2;
    const float p1 = r * std::cos(phi), s = 0.5f * (1 + wh.z);
    const float p2 = (1 - s) * std::sqrt(1 - Sqr(p1)) + s * r * std::sin(phi);
    const Vec3 nh = p1 * t1 + p2 * t2 + std::sqrt(std::max(0.f, 1 - Sqr(p1) - Sqr(p2))) * wh;
    return Normalize({alpha_x * nh.x, alpha_y * nh.y, std::max(0.f, nh.z)});
  }
};

struct GgxIsotropic : Ggx {
  float alpha;

  static GgxIsotropic Make(const float* in) { return {{in[0], in[0]}, in[0]}; }

  float D(const Vec3& wm) const {
    const float tan2_theta = Tan2Theta(wm);
    if (wm.z <= 0 || std::isinf(tan2_theta)) return 0;
    const float alpha2 = Sqr(alpha);
    return alpha2 / (kPi * Sqr(Cos2Theta(wm)) * Sqr(alpha2 + tan2_theta));
  }
  float Lambda(const Vec3& w) const {
    const float tan2_theta = Tan2Theta(w);
    if (std::isinf(tan2_theta)) return 0;
    return (std::sqrt(1 + Sqr(alpha) * tan2_theta) - 1) / 2;
  }
};

// Giles 2012, "Approximating the erfinv function".
inline float ErfInv(float x) {
  x = std::clamp(x, -0.99999f, 0.99999f);
  float w = -std::log((1 - x) * (1 + x)), p;
  if (w < 5) {
    w -= 2.5f;
    p = 2.81022636e-08f;
    for (const float c : {3.43273939e-07f, -3.5233877e-06f, -4.39150654e-06f, 0.00021858087f, -0.00125372503f,
                          -0.00417768164f, 0.246640727f, 1.50140941f}) {
      p = c + p * w;
    }
  } else {
    w = std::sqrt(w) - 3;
    p = -0.000200214257f;
    for (const float c : {0.000100950558f, 0.00134934322f, -0.00367342844f, 0.00573950773f, -0.0076224613f,
                          0.00943887047f, 1.00167406f, 2.83297682f}) {
      p = c + p * w;
    }
  }
  return p * x;
}

struct Beckmann {
  static constexpr Normals kNormals = Normals::kBeckmann;
  static constexpr std::size_t kParameters = 2;
  float alpha_x, alpha_y;

  static Beckmann Make(const float* in) { return {in[0], in[1]}; }

  static float Shape(float e) { return std::exp(-e); }
  static float LambdaOfA(float a) { return RationalLambda(a); }

  float D(const Vec3& wm) const {
    const float tan2_theta = Tan2Theta(wm);
    if (wm.z <= 0 || std::isinf(tan2_theta)) return 0;
    const float cos4_theta = Sqr(Cos2Theta(wm));
    return std::exp(-tan2_theta * (Cos2Phi(wm) / Sqr(alpha_x) + Sin2Phi(wm) / Sqr(alpha_y))) /
           (kPi * alpha_x * alpha_y * cos4_theta);
  }

  float A(const Vec3& w) const {
    const float alpha = std::sqrt(Cos2Phi(w) * Sqr(alpha_x) + Sin2Phi(w) * Sqr(alpha_y));
    return 1 / (alpha * std::abs(TanTheta(w)));
  }
  float Lambda(const Vec3& w) const {
    if (std::isinf(TanTheta(w))) return 0;
    return RationalLambda(A(w));
  }

  Vec3 SampleNormal(float u1, float u2) const {
    float phi = 2 * kPi * u2, alpha2 = Sqr(alpha_x);
    if (alpha_x != alpha_y) {
      phi = EllipticAzimuth(u2, alpha_x, alpha_y);
      alpha2 = 1 / (Sqr(std::cos(phi) / alpha_x) + Sqr(std::sin(phi) / alpha_y));
    }
    const float tan2_theta = -alpha2 * std::log(1 - u1);
    const float cos_theta = 1 / std::sqrt(1 + tan2_theta);
    return SphericalDirection(std::sqrt(std::max(0.f, 1 - Sqr(cos_theta))), cos_theta, phi);
  }

  // Slopes along and across the view: Newton's method on the cumulative function in terms of erf(slope), with
  // bisection where it leaves its bracket.
  Vec3 SampleVisibleNormal(const Vec3& w, float u1, float u2) const {
    const Vec3 wh = Normalize({alpha_x * w.x, alpha_y * w.y, w.z});
    u1 = std::max(u1, 1e-6f);
    float slope_x, slope_y = ErfInv(2 * std::max(u2, 1e-6f) - 1);
    if (wh.z > 0.9999f) {
      const float r = std::sqrt(-std::log(1 - u1));
      slope_x = r * std::cos(2 * kPi * u2);
      slope_y = r * std::sin(2 * kPi * u2);
    } else {
      const float sin_theta = std::sqrt(std::max(0.f, 1 - Sqr(wh.z))), tan_theta = sin_theta / wh.z;
      const float cot_theta = 1 / tan_theta, inverse_sqrt_pi = 1 / std::sqrt(kPi);
      float low = -1, high = std::erf(cot_theta);
      float b = high - (1 + high) * std::sqrt(1 - u1);
      const float normalization = 1 / (1 + high + inverse_sqrt_pi * tan_theta * std::exp(-Sqr(cot_theta)));
      for (int i = 0; i < 10; ++i) {
        if (!(b >= low && b <= high)) b = 0.5f * (low + high);
        const float inverse = ErfInv(b);
        const float value =
            normalization * (1 + b + inverse_sqrt_pi * tan_theta * std::exp(-Sqr(inverse))) - u1;
        const float derivative = normalization * (1 - inverse * tan_theta);
        if (std::abs(value) < 1e-5f) break;
        (value > 0 ? high : low) = b;
        b -= value / derivative;
      }
      slope_x = ErfInv(b);
    }
    const float length = std::sqrt(Sqr(wh.x) + Sqr(wh.y));
    const float cos_phi = length == 0 ? 1 : wh.x / length, sin_phi = length == 0 ? 0 : wh.y / length;
    const float x = cos_phi * slope_x - sin_phi * slope_y, y = sin_phi * slope_x + cos_phi * slope_y;
    return Normalize({-alpha_x * x, -alpha_y * y, 1});
  }
};

struct BeckmannIsotropic : Beckmann {
  float alpha;

  static BeckmannIsotropic Make(const float* in) { return {{in[0], in[0]}, in[0]}; }

  float D(const Vec3& wm) const {
    const float tan2_theta = Tan2Theta(wm);
    if (wm.z <= 0 || std::isinf(tan2_theta)) return 0;
    const float alpha2 = Sqr(alpha);
    return std::exp(-tan2_theta / alpha2) / (kPi * alpha2 * Sqr(Cos2Theta(wm)));
  }
  float Lambda(const Vec3& w) const {
    const float tan_theta = TanTheta(w);
    if (std::isinf(tan_theta)) return 0;
    return RationalLambda(1 / (alpha * std::abs(tan_theta)));
  }
};

// Slopes of unit roughness of Student-T as tables at equal steps of their angle and of u, as renderers keep
// them of distributions that they cannot invert.
class StudentSlopes {
 public:
  explicit StudentSlopes(float gamma) {
    // The density along an axis, and across it in units of sqrt(gamma - 1 + t^2), whose angle's cosine to a
    // power it is.
    const double k = double{gamma} - 1, n = 2 * double{gamma};
    double above = 0, area = 0, total = 0;
    above_[kSteps] = area_[kSteps] = 0;
    for (int j = kSteps; j-- > 0;) {
      const double middle = Angle(j + 0.5), step = Angle(1), cosine = std::cos(middle), t = std::tan(middle);
      const double density = std::pow(1 + t * t / k, 0.5 - double{gamma}) / (cosine * cosine) * step;
      // Slopes of this part are above all of the others'.
      area += (above + density / 2) * step / (cosine * cosine);
      above += density;
      above_[j] = static_cast<float>(above);
      area_[j] = static_cast<float>(area);
      total += std::pow(cosine, n - 2);
    }
    for (int j = 0; j <= kSteps; ++j) {
      above_[j] /= static_cast<float>(2 * above);
      area_[j] /= static_cast<float>(2 * above);
    }
    double reached = 0;
    int step = 0;
    for (int j = 0; j < kSteps; ++j) {
      const double part = std::pow(std::cos(Angle(j + 0.5)), n - 2) / total;
      for (; step < kSteps && step <= (reached + part) * kSteps; ++step) {
        across_[step] =
            static_cast<float>(std::tan(Angle(j + (static_cast<double>(step) / kSteps - reached) / part)));
      }
      reached += part;
    }
    for (; step <= kSteps; ++step) across_[step] = across_[step - 1];
  }

  // The slope above which u of those that a view of the slope -a sees are, by halving.
  float Along(float a, float u) const {
    const float whole = a + At(area_, std::atan(a));
    const bool up = u * whole <= area_[0] + a * above_[0];
    const float side = up ? 1.f : -1.f, wanted = up ? u * whole : (1 - u) * whole - (whole - a);
    float low = 0, high = up ? kPi / 2 : std::atan(a);
    for (int i = 0; i < 24; ++i) {
      const float middle = (low + high) / 2;
      const float share = side * At(area_, middle) + (a + side * std::tan(middle)) * At(above_, middle);
      (share >= wanted ? low : high) = middle;
    }
    return side * std::tan(low);
  }
  float Across(float u) const {
    const float x = std::abs(2 * u - 1) * kSteps;
    const int j = std::min(static_cast<int>(x), kSteps - 1);
    const float part = x - static_cast<float>(j), s = (1 - part) * across_[j] + part * across_[j + 1];
    return u < 0.5f ? -s : s;
  }

 private:
  static constexpr int kSteps = 2048;
  static double Angle(double steps) { return steps * 1.5707963267948966 / kSteps; }
  static float At(const float* table, float angle) {
    const float x = angle * (2 / kPi) * kSteps;
    const int j = std::min(static_cast<int>(x), kSteps - 1);
    const float part = x - static_cast<float>(j);
    return (1 - part) * table[j] + part * table[j + 1];
  }

  float above_[kSteps + 1], area_[kSteps + 1], across_[kSteps + 1];
};

const StudentSlopes& SlopesOf(float gamma) {
  thread_local std::map<float, StudentSlopes> all;
  thread_local float last = -1;
  thread_local const StudentSlopes* slopes = nullptr;
  if (last != gamma) {
    last = gamma;
    slopes = &all.try_emplace(last, gamma).first->second;
  }
  return *slopes;
}

struct StudentT {
  float gamma, alpha_x, alpha_y;

  static StudentT Make(const float* in) { return {in[0], in[1], in[2]}; }

  float Shape(float e) const { return std::pow(1 + e / (gamma - 1), -gamma); }
  float LambdaOfA(float a) const { return StudentLambda(a / std::sqrt(gamma - 1), gamma - 1.5f); }

  float D(const Vec3& wm) const {
    const float tan2_theta = Tan2Theta(wm);
    if (wm.z <= 0 || std::isinf(tan2_theta)) return 0;
    const float e = tan2_theta * (Cos2Phi(wm) / Sqr(alpha_x) + Sin2Phi(wm) / Sqr(alpha_y));
    return Shape(e) / (kPi * alpha_x * alpha_y * Sqr(Cos2Theta(wm)));
  }
  float Lambda(const Vec3& w) const {
    if (std::isinf(TanTheta(w))) return 0;
    const float alpha = std::sqrt(Cos2Phi(w) * Sqr(alpha_x) + Sin2Phi(w) * Sqr(alpha_y));
    return LambdaOfA(1 / (alpha * std::abs(TanTheta(w))));
  }
  Vec3 SampleNormal(float u1, float u2) const {
    float phi = 2 * kPi * u2, alpha2 = Sqr(alpha_x);
    if (alpha_x != alpha_y) {
      phi = EllipticAzimuth(u2, alpha_x, alpha_y);
      alpha2 = 1 / (Sqr(std::cos(phi) / alpha_x) + Sqr(std::sin(phi) / alpha_y));
    }
    const float tan2_theta = alpha2 * (gamma - 1) * (std::pow(1 - u1, -1 / (gamma - 1)) - 1);
    const float cos_theta = 1 / std::sqrt(1 + tan2_theta);
    return SphericalDirection(std::sqrt(std::max(0.f, 1 - Sqr(cos_theta))), cos_theta, phi);
  }
  Vec3 SampleVisibleNormal(const Vec3& w, float u1, float u2) const {
    const Vec3 view = Normalize(Vec3{alpha_x * w.x, alpha_y * w.y, w.z});
    const float sin_theta = std::sqrt(Sqr(view.x) + Sqr(view.y));
    const float cos_phi = sin_theta > 0 ? view.x / sin_theta : 1,
                sin_phi = sin_theta > 0 ? view.y / sin_theta : 0;
    const StudentSlopes& slopes = SlopesOf(gamma);
    const float t = slopes.Along(std::min(view.z / std::max(sin_theta, 1e-9f), 1e6f), u1);
    const float s = std::sqrt(gamma - 1 + Sqr(t)) * slopes.Across(u2);
    return Normalize(Vec3{alpha_x * (t * cos_phi - s * sin_phi), alpha_y * (t * sin_phi + s * cos_phi), 1});
  }
};

struct StudentTIsotropic : StudentT {
  static StudentTIsotropic Make(const float* in) { return {{in[0], in[1], in[1]}}; }
};

struct Phong {
  static constexpr Normals kNormals = Normals::kPhong;
  static constexpr std::size_t kParameters = 1;
  float exponent;

  static Phong Make(const float* in) { return {in[0]}; }

  float D(const Vec3& wm) const {
    if (wm.z <= 0) return 0;
    return (exponent + 2) / (2 * kPi) * std::pow(CosTheta(wm), exponent);
  }
  float A(const Vec3& w) const { return std::sqrt(0.5f * exponent + 1) / std::abs(TanTheta(w)); }
  float Lambda(const Vec3& w) const {
    if (std::isinf(TanTheta(w))) return 0;
    return RationalLambda(A(w));
  }
  Vec3 SampleNormal(float u1, float u2) const {
    const float cos_theta = std::pow(u1, 1 / (exponent + 2));
    return SphericalDirection(std::sqrt(std::max(0.f, 1 - Sqr(cos_theta))), cos_theta, 2 * kPi * u2);
  }
};

// Correlated and off-centre slopes as Heitz 2014 Eqs. 92-97 print them.
template <class Base>
struct Sheared {
  Base unit;  // of roughness 1
  float alpha_x, alpha_y, r_xy, mean_x = 0, mean_y = 0;

  float Cosine(const Vec3& w) const { return w.z - mean_x * w.x - mean_y * w.y; }

  float D(const Vec3& wm) const {
    if (wm.z <= 0) return 0;
    const float x = wm.x / wm.z + mean_x, y = wm.y / wm.z + mean_y;
    const float determinant = Sqr(alpha_x) * Sqr(alpha_y) * (1 - Sqr(r_xy));
    const float e =
        (Sqr(x * alpha_y) + Sqr(y * alpha_x) - 2 * x * y * r_xy * alpha_x * alpha_y) / determinant;
    return unit.Shape(e) / (kPi * std::sqrt(determinant) * Sqr(Sqr(wm.z)));
  }

  float Lambda(const Vec3& w) const {
    const float alpha2 = Sqr(alpha_x * w.x) + Sqr(alpha_y * w.y) + 2 * w.x * w.y * r_xy * alpha_x * alpha_y;
    if (!(alpha2 > 0)) return 0;
    return unit.LambdaOfA(std::abs(Cosine(w)) / std::sqrt(alpha2));
  }

  Vec3 FromUnit(const Vec3& wm) const {
    const float y = r_xy * wm.x + std::sqrt(1 - Sqr(r_xy)) * wm.y;
    return Normalize({alpha_x * wm.x - mean_x * wm.z, alpha_y * y - mean_y * wm.z, wm.z});
  }
  Vec3 SampleNormal(float u1, float u2) const { return FromUnit(unit.SampleNormal(u1, u2)); }
  Vec3 SampleVisibleNormal(const Vec3& w, float u1, float u2) const {
    const Vec3 view{alpha_x * w.x + r_xy * alpha_y * w.y, std::sqrt(1 - Sqr(r_xy)) * alpha_y * w.y,
                    Cosine(w)};
    return FromUnit(unit.SampleVisibleNormal(Normalize(view), u1, u2));
  }
};

// The cosine that masking goes by.
template <class Distribution>
float Cosine(const Distribution&, const Vec3& w) {
  return CosTheta(w);
}
template <class Base>
float Cosine(const Sheared<Base>& distribution, const Vec3& w) {
  return distribution.Cosine(w);
}

template <class Distribution>
float G1(const Distribution& distribution, const Vec3& w, const Vec3& wm) {
  if (Dot(w, wm) * Cosine(distribution, w) <= 0) return 0;
  return 1 / (1 + distribution.Lambda(w));
}

// Amplitudes of the two polarisations, from cosines and Snell's law.
struct Amplitudes {
  float parallel, perpendicular;
};

// eta over the incident index; 1 and 1 under total internal reflection.
inline Amplitudes FresnelAmplitudes(float cos_theta_i, float eta) {
  cos_theta_i = std::clamp(std::abs(cos_theta_i), 0.f, 1.f);
  const float sin2_theta_i = std::max(0.f, 1 - Sqr(cos_theta_i));
  const float sin2_theta_t = sin2_theta_i / Sqr(eta);
  if (sin2_theta_t >= 1) return {1, 1};
  const float cos_theta_t = std::sqrt(std::max(0.f, 1 - sin2_theta_t));
  return {(eta * cos_theta_i - cos_theta_t) / (eta * cos_theta_i + cos_theta_t),
          (cos_theta_i - eta * cos_theta_t) / (cos_theta_i + eta * cos_theta_t)};
}

inline float FrDielectric(float cos_theta_i, float eta) {
  const Amplitudes r = FresnelAmplitudes(cos_theta_i, eta);
  return (Sqr(r.parallel) + Sqr(r.perpendicular)) / 2;
}

// pbrt-v4's FrComplex, of the complex index eta + i k.
inline float FrComplex(float cos_theta_i, std::complex<float> eta) {
  cos_theta_i = std::clamp(std::abs(cos_theta_i), 0.f, 1.f);
  const float sin2_theta_i = 1 - Sqr(cos_theta_i);
  const std::complex<float> sin2_theta_t = sin2_theta_i / (eta * eta);
  const std::complex<float> cos_theta_t = std::sqrt(1.f - sin2_theta_t);
  const std::complex<float> parallel = (eta * cos_theta_i - cos_theta_t) / (eta * cos_theta_i + cos_theta_t);
  const std::complex<float> perpendicular =
      (cos_theta_i - eta * cos_theta_t) / (cos_theta_i + eta * cos_theta_t);
  return (std::norm(parallel) + std::norm(perpendicular)) / 2;
}

inline float FrSchlick(float cos_theta_i, float f0) {
  const float x = std::clamp(1 - std::abs(cos_theta_i), 0.f, 1.f);
  return f0 + (1 - f0) * Sqr(Sqr(x)) * x;
}

inline Vec3 Reflect(const Vec3& wi, const Vec3& m) { return 2 * Dot(wi, m) * m - wi; }

// Snell's law about m on wi's side.
inline bool Refract(const Vec3& wi, const Vec3& m, float eta, Vec3* wt) {
  const float cos_theta_i = Dot(wi, m);
  const float sin2_theta_t = std::max(0.f, 1 - Sqr(cos_theta_i)) / Sqr(eta);
  if (sin2_theta_t >= 1) return false;
  const float cos_theta_t = std::sqrt(1 - sin2_theta_t);
  *wt = (cos_theta_i / eta - cos_theta_t) * m - wi / eta;
  return true;
}

enum Lobes { kReflection = 1, kTransmission = 2, kBoth = 3 };

// Reflectances of facets, as functions of the cosine.
struct DielectricFresnel {
  float eta;
  float operator()(float cos_theta_i) const { return FrDielectric(cos_theta_i, eta); }
};
struct MirrorFresnel {
  explicit MirrorFresnel(const float*) {}
  float operator()(float) const { return 1; }
};
struct ConductorFresnel {
  std::complex<float> eta;
  explicit ConductorFresnel(const float* parameters) : eta(parameters[0], parameters[1]) {}
  float operator()(float cos_theta_i) const { return FrComplex(cos_theta_i, eta); }
};
struct SchlickFresnel {
  float f0;
  explicit SchlickFresnel(const float* parameters) : f0(parameters[0]) {}
  float operator()(float cos_theta_i) const { return FrSchlick(cos_theta_i, f0); }
};
template <Reflector kReflector>
using FresnelOf = std::conditional_t<
    kReflector == Reflector::kMirror, MirrorFresnel,
    std::conditional_t<kReflector == Reflector::kConductor, ConductorFresnel, SchlickFresnel>>;

template <DielectricQuantity::Joint kJoint, class Distribution>
float Masking(const Distribution& distribution, const Vec3& wi, const Vec3& wo, const Vec3& wm) {
  if constexpr (kJoint == DielectricQuantity::kVCavity) {
    const float facing = AbsDot(wi, wm), two_cos = 2 * AbsCosTheta(wm);
    return std::min(1.f, std::min(two_cos * AbsCosTheta(wi) / facing, two_cos * AbsCosTheta(wo) / facing));
  } else if constexpr (kJoint == DielectricQuantity::kKelemen) {
    return AbsCosTheta(wm) * AbsCosTheta(wi) * AbsCosTheta(wo) / Sqr(Dot(wi, wm));
  } else if constexpr (kJoint == DielectricQuantity::kSeparable) {
    return 1 / ((1 + distribution.Lambda(wi)) * (1 + distribution.Lambda(wo)));
  } else {
    return 1 / (1 + distribution.Lambda(wi) + distribution.Lambda(wo));
  }
}

// pbrt-v4: of a view above the surface; the sampler turns it there.
template <class Distribution>
float VisibleDensity(const Distribution& distribution, const Vec3& w, const Vec3& wm) {
  return 1 / (1 + distribution.Lambda(w)) / std::abs(Cosine(distribution, w)) * distribution.D(wm) *
         AbsDot(w, wm);
}

// eta is 1 of what only reflects.
template <class Distribution, DielectricQuantity::Joint kJoint, class Fresnel = DielectricFresnel,
          bool kVisible = false>
struct RoughDielectric {
  Distribution distribution;
  float eta;
  Transport transport;
  Fresnel fresnel;

  struct Sample {
    Vec3 wo;
    float weight, pdf;
    int lobe;
  };

  float G(const Vec3& wi, const Vec3& wo, const Vec3& wm) const {
    return Masking<kJoint>(distribution, wi, wo, wm);
  }

  // The normal that takes wi to wo, on the upper side; false if there is none.
  bool HalfVector(const Vec3& wi, const Vec3& wo, int lobes, bool* reflects, Vec3* wm) const {
    if (CosTheta(wi) == 0 || CosTheta(wo) == 0) return false;
    *reflects = SameHemisphere(wi, wo);
    if ((lobes & (*reflects ? kReflection : kTransmission)) == 0) return false;
    const Vec3 half = wi + (*reflects ? 1 : eta) * wo;
    if (LengthSquared(half) == 0) return false;
    *wm = Normalize(half);
    if (CosTheta(*wm) < 0) *wm = -*wm;
    return Dot(*wm, wi) * CosTheta(wi) > 0 && Dot(*wm, wo) * CosTheta(wo) > 0;
  }

  float Eval(const Vec3& wi, const Vec3& wo, int lobes) const {
    bool reflects;
    Vec3 wm;
    if (!HalfVector(wi, wo, lobes, &reflects, &wm)) return 0;
    const float F = fresnel(Dot(wi, wm));
    const float cos_i = AbsCosTheta(wi), cos_o = AbsCosTheta(wo);
    if (reflects) return distribution.D(wm) * G(wi, wo, wm) * F / (4 * cos_i * cos_o) * cos_o;
    const float denominator = Sqr(Dot(wi, wm) + eta * Dot(wo, wm)) * cos_i * cos_o;
    float f = Sqr(eta) * distribution.D(wm) * (1 - F) * G(wi, wo, wm) *
              std::abs(Dot(wi, wm) * Dot(wo, wm) / denominator);
    if (transport == Transport::kImportance) f /= Sqr(eta);
    return f * cos_o;
  }

  float Pdf(const Vec3& wi, const Vec3& wo, int lobes) const {
    bool reflects;
    Vec3 wm;
    if (!HalfVector(wi, wo, lobes, &reflects, &wm)) return 0;
    const float F = lobes == kBoth ? fresnel(Dot(wi, wm)) : reflects ? 1 : 0;
    const float pdf_wm = NormalDensity(wi, wm);
    if (reflects) return F * pdf_wm / (4 * AbsDot(wo, wm));
    return (1 - F) * pdf_wm * Sqr(eta) * AbsDot(wo, wm) / Sqr(Dot(wi, wm) + eta * Dot(wo, wm));
  }

  // Of the normals that are drawn.
  float NormalDensity(const Vec3& wi, const Vec3& wm) const {
    if constexpr (kVisible) {
      return VisibleDensity(distribution, wi, wm);
    } else {
      return distribution.D(wm) * AbsCosTheta(wm);
    }
  }
  Vec3 SampleUpperNormal(const Vec3& wi, float u1, float u2) const {
    if constexpr (kVisible) {
      return distribution.SampleVisibleNormal(CosTheta(wi) < 0 ? -wi : wi, u1, u2);
    } else {
      return distribution.SampleNormal(u1, u2);
    }
  }

  Sample SampleDirection(const Vec3& wi, float u1, float u2, float u3, int lobes) const {
    constexpr Sample kNone = {{0, 0, 0}, 0, 0, 0};
    if (CosTheta(wi) == 0) return kNone;
    const Vec3 upper = SampleUpperNormal(wi, u1, u2);
    const Vec3 wm = CosTheta(wi) < 0 ? -upper : upper;
    const float cos_i = Dot(wi, wm);
    if (!(cos_i > 0)) return kNone;
    const float F = fresnel(cos_i);
    const float pdf_wm = NormalDensity(wi, upper);
    const float pr = lobes == kBoth ? F : 1, pt = lobes == kBoth ? 1 - F : 1;
    Sample sample;
    if (lobes == kBoth ? u3 < F : lobes == kReflection) {
      sample.wo = Reflect(wi, wm);
      if (!SameHemisphere(wi, sample.wo)) return kNone;
      sample.lobe = kReflection;
      sample.pdf = pr * pdf_wm / (4 * AbsDot(sample.wo, wm));
    } else {
      if (!Refract(wi, wm, eta, &sample.wo) || !(CosTheta(wi) * CosTheta(sample.wo) < 0)) return kNone;
      sample.lobe = kTransmission;
      sample.pdf = pt * pdf_wm * Sqr(eta) * AbsDot(sample.wo, wm) / Sqr(cos_i + eta * Dot(sample.wo, wm));
    }
    sample.weight = kVisible ? G(wi, sample.wo, wm) * (1 + distribution.Lambda(wi))
                             : cos_i * G(wi, sample.wo, wm) / (AbsCosTheta(wi) * AbsCosTheta(wm));
    if (lobes != kBoth) sample.weight *= sample.lobe == kReflection ? F : 1 - F;
    if (sample.lobe == kTransmission && transport == Transport::kImportance) sample.weight /= Sqr(eta);
    return sample;
  }
};

// From the kernel list's inputs to the functions above.
inline Vec3 Load(const float* in) { return {in[0], in[1], in[2]}; }
inline void Store(const Vec3& v, float* out) {
  out[0] = v.x;
  out[1] = v.y;
  out[2] = v.z;
}

template <class Distribution>
float BoundedDensity(const Distribution& distribution, const Vec3& w, const Vec3& wm) {
  const float length =
      std::sqrt(Sqr(distribution.alpha_x * w.x) + Sqr(distribution.alpha_y * w.y) + Sqr(w.z));
  return 2 * AbsDot(w, wm) * distribution.D(wm) / (distribution.CapBound(w) * w.z + length);
}

// The density of a mirror direction about the visible normal wm.
template <bool kBounded, class Distribution>
float VisibleReflectionDensity(const Distribution& distribution, const Vec3& w, const Vec3& wm) {
  float density;
  if constexpr (kBounded) {
    density = BoundedDensity(distribution, w, wm);
  } else {
    density = VisibleDensity(distribution, w, wm);
  }
  return density / (4 * AbsDot(w, wm));
}
template <bool kBounded, class Distribution>
float PdfVisibleReflection(const Distribution& distribution, const Vec3& wi, const Vec3& wo) {
  if (CosTheta(wi) == 0 || CosTheta(wo) == 0 || !SameHemisphere(wi, wo)) return 0;
  const Vec3 w = wi.z < 0 ? -wi : wi;
  return VisibleReflectionDensity<kBounded>(distribution, w, Normalize(wi.z < 0 ? -(wi + wo) : wi + wo));
}

// pbrt-v4's conductor: f |cos(theta_o)| / pdf of a mirror direction about a visible normal.
struct VisibleReflection {
  Vec3 wo;
  float weight, pdf, lobe;
};
template <bool kBounded, DielectricQuantity::Joint kJoint, class Distribution, class Fresnel>
VisibleReflection SampleVisibleReflection(const Distribution& distribution, const Fresnel& fresnel,
                                          const Vec3& wi, float u1, float u2) {
  const Vec3 w = wi.z < 0 ? -wi : wi;
  Vec3 wm;
  if constexpr (kBounded) {
    wm = distribution.SampleVisibleNormalBounded(w, u1, u2);
  } else {
    wm = distribution.SampleVisibleNormal(w, u1, u2);
  }
  const Vec3 wo = Reflect(w, wm);
  if (!SameHemisphere(w, wo)) return {{0, 0, 0}, 0, 0, 0};
  const float pdf = VisibleReflectionDensity<kBounded>(distribution, w, wm);
  const float g = Masking<kJoint>(distribution, w, wo, wm);
  const float f = fresnel(Dot(w, wm)) * distribution.D(wm) * g / (4 * AbsCosTheta(w) * AbsCosTheta(wo));
  return {wi.z < 0 ? -wo : wo, f * AbsCosTheta(wo) / pdf, pdf, 1};
}

// Heitz and d'Eon 2014: the density of the normals that V-cavities show, and a normal of it.
template <class Distribution>
float VCavityDensity(const Distribution& distribution, const Vec3& w, const Vec3& wm) {
  if (Dot(w, wm) * CosTheta(w) <= 0 || CosTheta(wm) <= 0) return 0;
  const float g1 = std::min(1.f, 2 * CosTheta(wm) * AbsCosTheta(w) / AbsDot(w, wm));
  return g1 * AbsDot(w, wm) * distribution.D(wm) / AbsCosTheta(w);
}
template <class Distribution>
Vec3 SampleVCavityNormal(const Distribution& distribution, const Vec3& wi, float u1, float u2, float u3) {
  const Vec3 w = wi.z < 0 ? -wi : wi, wm = distribution.SampleNormal(u1, u2), other{-wm.x, -wm.y, wm.z};
  const float seen = std::max(0.f, Dot(w, wm)), seen_other = std::max(0.f, Dot(w, other));
  return u3 < seen_other / (seen + seen_other) ? other : wm;
}
template <class Distribution, class Fresnel>
VisibleReflection SampleVCavityReflection(const Distribution& distribution, const Fresnel& fresnel,
                                          const Vec3& wi, float u1, float u2, float u3) {
  const Vec3 w = wi.z < 0 ? -wi : wi, wm = SampleVCavityNormal(distribution, w, u1, u2, u3);
  const Vec3 wo = Reflect(w, wm);
  if (!(Dot(w, wm) > 0) || !SameHemisphere(w, wo)) return {{0, 0, 0}, 0, 0, 0};
  const float pdf = VCavityDensity(distribution, w, wm) / (4 * AbsDot(w, wm));
  const float g = Masking<DielectricQuantity::kVCavity>(distribution, w, wo, wm);
  const float f = fresnel(Dot(w, wm)) * distribution.D(wm) * g / (4 * AbsCosTheta(w) * AbsCosTheta(wo));
  return {wi.z < 0 ? -wo : wo, f * AbsCosTheta(wo) / pdf, pdf, 1};
}

template <class Sample>
void StoreSample(const Sample& sample, float* out) {
  Store(sample.wo, out);
  out[3] = sample.weight;
  out[4] = sample.pdf;
  out[5] = static_cast<float>(sample.lobe);
}

// A distribution from its parameters, as they follow the other inputs.
template <RoughnessKind kRoughness, class Anisotropic, class Isotropic, std::size_t kOwn = 0>
auto MakeRough(const float* in) {
  const float *const own = in, *const p = in + kOwn;
  const auto unit = [&] {
    if constexpr (kOwn == 1) return Anisotropic{own[0], 1, 1};
    if constexpr (kOwn == 0) return Anisotropic{1, 1};
  };
  if constexpr (kRoughness == RoughnessKind::kIsotropic) {
    return Isotropic::Make(in);
  } else if constexpr (kRoughness == RoughnessKind::kAnisotropic) {
    return Anisotropic::Make(in);
  } else if constexpr (kRoughness == RoughnessKind::kRotated) {
    return Sheared<Anisotropic>{unit(), p[0], p[1], p[2]};
  } else {
    return Sheared<Anisotropic>{unit(), p[0], p[1], p[2], p[3], p[4]};
  }
}
template <Normals kNormals, RoughnessKind kRoughness>
auto MakeNormals(const float* in) {
  if constexpr (kNormals == Normals::kPhong) return Phong::Make(in);
  if constexpr (kNormals == Normals::kBeckmann) return MakeRough<kRoughness, Beckmann, BeckmannIsotropic>(in);
  if constexpr (kNormals == Normals::kGgx) return MakeRough<kRoughness, Ggx, GgxIsotropic>(in);
  if constexpr (kNormals == Normals::kStudentT) {
    return MakeRough<kRoughness, StudentT, StudentTIsotropic, 1>(in);
  }
}

// A quantity of a distribution by its place in kNormalKernelPlaces.
template <std::size_t kPlace>
void OfNormals(const float* in, float* out, Transport) {
  constexpr NormalRow row = kNormalRows[kNormalKernelPlaces[kPlace].row];
  constexpr std::size_t parameters = Split(kNormalQuantities[row.what].lanes).count;
  const auto normals = [&] {
    constexpr RoughnessKind roughness = kNormalKernelPlaces[kPlace].roughness;
    if constexpr (row.normals == Normals::kTabulated) {
      // By the function that the table is made of, whose parameter comes last.
      constexpr std::size_t count = Split(kNormalText[kPlace].inputs.view()).columns;
      float own_first[kMaxInputs] = {in[count]};
      std::copy(in + parameters, in + count, own_first + 1);
      return MakeNormals<Normals::kStudentT, roughness>(own_first);
    } else {
      return MakeNormals<row.normals, roughness>(in + parameters);
    }
  }();
  if constexpr (row.what == NormalQuantity::kD) {
    out[0] = normals.D(Load(in));
  } else if constexpr (row.what == NormalQuantity::kLambda) {
    out[0] = normals.Lambda(Load(in));
  } else if constexpr (row.what == NormalQuantity::kG1 && row.normals == Normals::kPhong) {
    const Vec3 w = Load(in);
    out[0] = Dot(w, Load(in + 3)) * CosTheta(w) <= 0 ? 0 : RationalG1(normals.A(w));
  } else if constexpr (row.what == NormalQuantity::kG1) {
    out[0] = G1(normals, Load(in), Load(in + 3));
  } else if constexpr (row.what == NormalQuantity::kDVisibleVCavity) {
    out[0] = VCavityDensity(normals, Load(in), Load(in + 3));
  } else if constexpr (row.what == NormalQuantity::kSampleVCavity) {
    const Vec3 wm = SampleVCavityNormal(normals, Load(in), in[3], in[4], in[5]);
    Store(wm, out);
    out[3] = VCavityDensity(normals, Load(in), wm);
  } else if constexpr (row.what == NormalQuantity::kDVisible) {
    const Vec3 w = Load(in), wm = Load(in + 3);
    out[0] = Dot(w, wm) * Cosine(normals, w) <= 0 ? 0 : VisibleDensity(normals, w, wm);
  } else if constexpr (row.what == NormalQuantity::kSampleNormal) {
    const Vec3 wm = normals.SampleNormal(in[0], in[1]);
    Store(wm, out);
    out[3] = normals.D(wm) * AbsCosTheta(wm);
  } else if constexpr (row.what == NormalQuantity::kSampleReflection ||
                       row.what == NormalQuantity::kSampleReflectionBounded) {
    constexpr bool bounded = row.what == NormalQuantity::kSampleReflectionBounded;
    StoreSample(SampleVisibleReflection<bounded, DielectricQuantity::kCorrelated>(normals, MirrorFresnel(in),
                                                                                  Load(in), in[3], in[4]),
                out);
  } else if constexpr (row.what == NormalQuantity::kPdfReflection ||
                       row.what == NormalQuantity::kPdfReflectionBounded) {
    constexpr bool bounded = row.what == NormalQuantity::kPdfReflectionBounded;
    out[0] = PdfVisibleReflection<bounded>(normals, Load(in), Load(in + 3));
  } else {
    const Vec3 w = Cosine(normals, Load(in)) < 0 ? -Load(in) : Load(in);
    if constexpr (row.what == NormalQuantity::kSampleVisible) {
      const Vec3 wm = normals.SampleVisibleNormal(w, in[3], in[4]);
      Store(wm, out);
      out[3] = VisibleDensity(normals, w, wm);
    } else {
      const Vec3 wm = normals.SampleVisibleNormalBounded(w, in[3], in[4]);
      Store(wm, out);
      out[3] = BoundedDensity(normals, w, wm);
    }
  }
}

void SampleNormalWidened(const float* in, float* out, Transport) {
  const float scale = 1.2f - 0.2f * std::sqrt(std::abs(in[2]));
  const Beckmann distribution{scale * in[3], scale * in[4]};
  const Vec3 wm = distribution.SampleNormal(in[0], in[1]);
  Store(wm, out);
  out[3] = distribution.D(wm) * AbsCosTheta(wm);
}
void MaskingG1Rational(const float* in, float* out, Transport) {
  const Vec3 w = Load(in);
  out[0] = Dot(w, Load(in + 3)) * CosTheta(w) <= 0 ? 0 : RationalG1(Beckmann::Make(in + 6).A(w));
}

// The rough dielectric by its place in kDielectricQuantities.
template <class Distribution, std::size_t kQuantity>
void Dielectric(const float* in, float* out, Transport transport) {
  constexpr DielectricQuantity row = kDielectricQuantities[kQuantity];
  constexpr int lobes = (row.reflects ? kReflection : 0) | (row.transmits ? kTransmission : 0);
  constexpr bool one_lobe_sampled = row.what == DielectricQuantity::kSample && !row.HasBothLobes();
  const float* const parameters = in + (one_lobe_sampled ? 5 : 6);
  const float eta = parameters[Distribution::kParameters];
  const RoughDielectric<Distribution, row.joint, DielectricFresnel, row.visible> bsdf{
      Distribution::Make(parameters), eta, transport, {eta}};
  if constexpr (row.what == DielectricQuantity::kSample) {
    StoreSample(bsdf.SampleDirection(Load(in), in[3], in[4], one_lobe_sampled ? 0 : in[5], lobes), out);
  } else {
    if constexpr (row.HasValue()) out[0] = bsdf.Eval(Load(in), Load(in + 3), lobes);
    if constexpr (row.what != DielectricQuantity::kEval) {
      out[row.HasValue() ? 1 : 0] = bsdf.Pdf(Load(in), Load(in + 3), lobes);
    }
  }
}

// A kernel of an opaque surface.
template <class Distribution, std::size_t kKernel>
void OpaqueSurface(const float* in, float* out, Transport transport) {
  constexpr ReflectorKernelPlace place = PlaceOfReflectorKernel(kKernel);
  constexpr DielectricQuantity row = kReflectorQuantities[place.quantity];
  using Fresnel = FresnelOf<place.reflector>;
  const float* const parameters = in + Split(kKernels[kKernel].inputs).per_lane;
  const RoughDielectric<Distribution, row.joint, Fresnel> surface{
      Distribution::Make(parameters), 1, transport, Fresnel(parameters + Distribution::kParameters)};
  constexpr bool v_cavity = row.joint == DielectricQuantity::kVCavity;
  if constexpr (row.what == DielectricQuantity::kSample && v_cavity) {
    StoreSample(SampleVCavityReflection(surface.distribution, surface.fresnel, Load(in), in[3], in[4], in[5]),
                out);
  } else if constexpr (row.what == DielectricQuantity::kSample && row.visible) {
    StoreSample(SampleVisibleReflection<false, row.joint>(surface.distribution, surface.fresnel, Load(in),
                                                          in[3], in[4]),
                out);
  } else if constexpr (row.what == DielectricQuantity::kSample) {
    StoreSample(surface.SampleDirection(Load(in), in[3], in[4], 0, kReflection), out);
  } else {
    out[0] = surface.Eval(Load(in), Load(in + 3), kReflection);
    if constexpr (row.what == DielectricQuantity::kEvalPdf && v_cavity) {
      const Vec3 wi = Load(in), wo = Load(in + 3);
      const bool reflects = CosTheta(wi) != 0 && CosTheta(wo) != 0 && SameHemisphere(wi, wo);
      const Vec3 w = wi.z < 0 ? -wi : wi, wm = Normalize(wi.z < 0 ? -(wi + wo) : wi + wo);
      out[1] = reflects ? VCavityDensity(surface.distribution, w, wm) / (4 * AbsDot(w, wm)) : 0;
    } else if constexpr (row.what == DielectricQuantity::kEvalPdf && row.visible) {
      out[1] = PdfVisibleReflection<false>(surface.distribution, Load(in), Load(in + 3));
    } else if constexpr (row.what == DielectricQuantity::kEvalPdf) {
      out[1] = surface.Pdf(Load(in), Load(in + 3), kReflection);
    }
  }
}

// Meneveaux 2015 Eq. 10 as printed.
inline float DiffuseReflectance(float n) {
  if (n == 1) return 0;
  if (n < 1) return 1 - (1 - DiffuseReflectance(1 / n)) * Sqr(n);
  const float n2 = Sqr(n), n4 = Sqr(n2);
  return 0.5f - 2 * n * n2 * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
         (n - 1) * (3 * n + 1) / (6 * Sqr(n + 1)) +
         8 * n4 * (n4 + 1) / ((n2 + 1) * Sqr(n4 - 1)) * std::log(n) +
         n2 * Sqr(n2 - 1) / (Sqr(n2 + 1) * (n2 + 1)) * std::log((n - 1) / (n + 1));
}
void DiffuseExternal(const float* in, float* out, Transport) { out[0] = DiffuseReflectance(in[0]); }
void DiffuseInternal(const float* in, float* out, Transport) {
  out[0] = 1 - (1 - DiffuseReflectance(in[0])) / Sqr(in[0]);
}

// What a facet scatters, as a part of what a white Lambertian does: Meneveaux 2015 Eq. 8.
struct LambertianFacet {
  explicit LambertianFacet(const float*) {}
  float operator()(float, float) const { return 1; }
};
struct InterfacedFacet {
  float n, k, r_i;
  explicit InterfacedFacet(const float* in)
      : n(in[0]), k(in[1]), r_i(1 - (1 - DiffuseReflectance(n)) / Sqr(n)) {}
  float operator()(float cos_i, float cos_o) const {
    return (1 - FrDielectric(cos_i, n)) * (1 - FrDielectric(cos_o, n)) * k / (Sqr(n) * (1 - k * r_i));
  }
  // R_s/(R_s + R_b) of Meneveaux 2015 section 4.
  float SurfaceShare() const {
    const float r_s = DiffuseReflectance(n), r_b = Sqr(1 - r_s) * k / (Sqr(n) * (1 - k * r_i));
    return r_s + r_b > 0 ? r_s / (r_s + r_b) : 0;
  }
  template <class Distribution>
  float Pdf(const Distribution& distribution, const Vec3& wi, const Vec3& wo) const {
    const float surface = SurfaceShare();
    return surface * PdfVisibleReflection<false>(distribution, wi, wo) +
           (1 - surface) * AbsCosTheta(wo) / kPi;
  }
};
void FacetBody(const float* in, float* out, Transport) {
  out[0] = in[0] > 0 && in[1] > 0 ? InterfacedFacet(in + 2)(in[0], in[1]) / kPi : 0;
}

// One normal's part of Meneveaux 2015 Eq. 28, over D cos or over D_visible.
template <class Distribution, class Facet>
float OneNormal(const DielectricQuantity& row, const Distribution& distribution, const Facet& facet,
                const Vec3& wi, const Vec3& wo, const Vec3& wm, float masking) {
  const float side = wi.z < 0 ? -1.f : 1.f;
  const float cos_i = side * Dot(wi, wm), cos_o = side * Dot(wo, wm);
  if (cos_i <= 0 || cos_o <= 0 || wm.z <= 0) return 0;
  const float f = facet(cos_i, cos_o) / kPi;
  return row.visible ? f * cos_o * masking * (1 + distribution.Lambda(wi))
                     : f * cos_i * cos_o * masking / (AbsCosTheta(wi) * CosTheta(wm));
}

// Interface or body, with the value of both over the density of both; the body's by one more normal.
template <class Distribution>
void SampleWithInterface(const Distribution& distribution, const InterfacedFacet& facet, const Vec3& wi,
                         const float* u, float* out) {
  std::fill_n(out, 6, 0.f);
  if (wi.z == 0) return;
  const Vec3 up{wi.x, wi.y, std::abs(wi.z)};
  const bool specular = u[2] < facet.SurfaceShare();
  Vec3 wo;
  if (specular) {
    wo = Reflect(up, distribution.SampleVisibleNormal(up, u[0], u[1]));
  } else {
    const float radius = std::sqrt(u[0]), phi = 2 * kPi * u[1];
    wo = {radius * std::cos(phi), radius * std::sin(phi), std::sqrt(std::max(0.f, 1 - u[0]))};
  }
  if (wo.z <= 0) return;
  const Vec3 wm = distribution.SampleVisibleNormal(up, u[3], u[4]), wh = Normalize(up + wo);
  const float pdf = facet.Pdf(distribution, up, wo);
  const float masking = Masking<DielectricQuantity::kCorrelated>(distribution, up, wo, {0, 0, 1});
  constexpr DielectricQuantity kVisible = kDiffuseQuantities[FindDiffuseQuantity(
      DielectricQuantity::kEvalNormal, DielectricQuantity::kCorrelated, true)];
  const float f_s = FrDielectric(Dot(up, wh), facet.n) * distribution.D(wh) * masking / (4 * up.z);
  out[0] = wo.x;
  out[1] = wo.y;
  out[2] = wi.z < 0 ? -wo.z : wo.z;
  out[3] = (f_s + OneNormal(kVisible, distribution, facet, up, wo, wm, masking)) / pdf;
  out[4] = pdf;
  out[5] = specular ? 1.f : 2.f;
}

// Heitz 2014 Eq. 31 and Meneveaux 2015 Eq. 12 by normals from D cos at the midpoints of a grid of random
// numbers, as many as the kernel takes. They are other normals than the kernel's, so what is between the two
// is mostly the error of this rule.
template <class Distribution, std::size_t kKernel>
void DiffuseSurface(const float* in, float* out, Transport) {
  constexpr DiffuseKernelPlace place = PlaceOfDiffuseKernel(kKernel);
  constexpr DielectricQuantity kRow = kDiffuseQuantities[place.quantity];
  constexpr DielectricQuantity::Joint kJoint = kRow.joint;
  using Facet =
      std::conditional_t<place.scatterer == Scatterer::kInterfaced, InterfacedFacet, LambertianFacet>;
  constexpr std::size_t kParameters = Split(kKernels[kKernel].inputs).per_lane;
  const Facet facet(in + kParameters + 2);
  const Distribution distribution = Distribution::Make(in + kParameters);
  const Vec3 wi = Load(in);
  if constexpr (kRow.what == DielectricQuantity::kSample) {
    SampleWithInterface(distribution, facet, wi, in + 3, out);
    return;
  }
  const Vec3 wo = Load(in + 3);
  out[0] = 0;
  if (wi.z * wo.z <= 0) return;
  if constexpr (kRow.what == DielectricQuantity::kEvalNormal) {
    out[0] = OneNormal(kRow, distribution, facet, wi, wo, Load(in + 6),
                       Masking<kJoint>(distribution, wi, wo, {0, 0, 1}));
    return;
  }
  if constexpr (kRow.what == DielectricQuantity::kPdf) {
    out[0] = facet.Pdf(distribution, wi, wo);
    return;
  }
  const int order = static_cast<int>(in[Split(kKernels[kKernel].inputs).columns]);
  const float side = wi.z < 0 ? -1.f : 1.f, n = static_cast<float>(order);
  float sum = 0;
  for (int j = 0; j < order; ++j) {
    for (int k = 0; k < 3 * order; ++k) {
      const Vec3 wm = distribution.SampleNormal((static_cast<float>(j) + 0.5f) / n,
                                                (static_cast<float>(k) + 0.5f) / (3 * n));
      const float cos_i = std::max(0.f, side * Dot(wi, wm)), cos_o = std::max(0.f, side * Dot(wo, wm));
      sum += cos_i * cos_o * facet(cos_i, cos_o) / CosTheta(wm);
    }
  }
  out[0] = Masking<kJoint>(distribution, wi, wo, {0, 0, 1}) * sum / (3 * n * n * kPi * AbsCosTheta(wi));
}

// Heitz 2014 Eq. 105 by visible normals at the midpoints of a grid of random numbers, as many as the kernel
// takes.
template <class Distribution, std::size_t kKernel>
void MeanFresnel(const float* in, float* out, Transport) {
  constexpr std::size_t kQuantity = PlaceOfMeanFresnelKernel(kKernel).quantity;
  if constexpr (kQuantity == MeanFresnelQuantity::kCosine) {
    const auto& k = Distribution::kNormals == Normals::kGgx ? kGgxCosineFit : kBeckmannCosineFit;
    const float c = std::abs(in[0]), alpha = std::min(2.f, in[1]);
    const float r = std::sqrt(c * c + alpha * alpha * std::max(0.f, 1 - c * c));
    const float x = 2 * c / r - 1, y = 2 * std::sqrt(alpha / 2) - 1;
    float sum = 0;
    for (int i = 6; i >= 0; --i) {
      float row = 0;
      for (int j = 6; j >= 0; --j) row = row * y + static_cast<float>(k[i][j]);
      sum = sum * x + row;
    }
    out[0] = std::min(1.f, r / (1 + alpha) * sum);
  } else {
    constexpr std::size_t kColumns = Split(kKernels[kKernel].inputs).columns;
    const auto fresnel = [&] {
      if constexpr (kQuantity == MeanFresnelQuantity::kDielectric) return DielectricFresnel{in[5]};
      if constexpr (kQuantity == MeanFresnelQuantity::kConductor) return ConductorFresnel(in + 5);
      if constexpr (kQuantity == MeanFresnelQuantity::kSchlick) return SchlickFresnel(in + 5);
    }();
    const Distribution distribution = Distribution::Make(in + 3);
    const Vec3 v = Load(in), up = v.z < 0 ? -v : v;
    const int order = static_cast<int>(in[kColumns]),
              azimuths = Distribution::kNormals == Normals::kGgx ? 2 : 1;
    const float n = static_cast<float>(order), m = static_cast<float>(azimuths * order);
    float sum = 0;
    for (int j = 0; j < order; ++j) {
      for (int l = 0; l < azimuths * order; ++l) {
        const Vec3 wm = distribution.SampleVisibleNormal(up, (static_cast<float>(j) + 0.5f) / n,
                                                         (static_cast<float>(l) + 0.5f) / m);
        sum += fresnel(Dot(up, wm));
      }
    }
    out[0] = sum / (n * m);
  }
}

// Albedos of a material at equal steps of the cosine, the last twice, as renderers keep them.
class AlbedoSteps {
 public:
  AlbedoSteps(float m, float index) {
    for (int k = 0; k <= kSteps; ++k) {
      const SpecularLobe lobe = WardLobe(static_cast<double>(m), static_cast<double>(index));
      albedo_[k] = static_cast<float>(DirectionalAlbedo(lobe, static_cast<double>(k) / kSteps));
    }
    albedo_[kSteps + 1] = albedo_[kSteps];
    // Int (1 - a) mu dmu from the normal on, by midpoints, and cosines at equal steps of it.
    constexpr int kParts = 16 * kSteps;
    float sum = 0;
    for (int k = kParts; k-- > 0;) sum += Deficit((static_cast<float>(k) + 0.5f) / kParts);
    average_ = 1 - 2 * sum / kParts;
    float reached = 0;
    int step = 0;
    for (int k = kParts; k-- > 0;) {
      while (step < kSteps && reached >= sum * static_cast<float>(step) / kSteps) {
        cosine_[step++] = (static_cast<float>(k) + 1) / kParts;
      }
      reached += Deficit((static_cast<float>(k) + 0.5f) / kParts);
    }
    while (step <= kSteps + 1) cosine_[step++] = 0;
  }
  float operator()(float cos_theta) const {
    const float x = kSteps * std::min(1.f, std::abs(cos_theta));
    const int k = static_cast<int>(x);
    const float t = x - static_cast<float>(k);
    return (1 - t) * albedo_[k] + t * albedo_[k + 1];
  }

  float average() const { return average_; }
  float MatteCosine(float u) const {
    const float x = kSteps * std::min(1.f, u);
    const int k = static_cast<int>(x);
    const float t = x - static_cast<float>(k);
    return (1 - t) * cosine_[k] + t * cosine_[k + 1];
  }

 private:
  static constexpr int kSteps = 256;
  float Deficit(float mu) const { return (1 - (*this)(mu)) * mu; }

  float albedo_[kSteps + 2], cosine_[kSteps + 2], average_;
};

// That of the last material asked for is at hand.
const AlbedoSteps& AlbedoOf(float m, float index) {
  thread_local std::map<std::pair<float, float>, AlbedoSteps> all;
  thread_local std::pair<float, float> last{-1.f, -1.f};
  thread_local const AlbedoSteps* steps = nullptr;
  if (last != std::pair(m, index)) {
    last = {m, index};
    steps = &all.try_emplace(last, m, index).first->second;
  }
  return *steps;
}

void WardDensity(const float* in, float* out, Transport) {
  const Beckmann distribution{in[3], in[3]};
  out[0] = distribution.D(Load(in)) * CosTheta(Load(in));
}
void PhongDensity(const float* in, float* out, Transport) {
  const Phong distribution{in[3]};
  out[0] = distribution.D(Load(in)) * CosTheta(Load(in));
}

// Meneveaux 2015 Eq. 13 as printed, its integral by the trapezoidal rule.
struct Gaussian {
  float sigma;

  float C() const {
    constexpr int kSteps = 64;
    const float end = std::min(kPi / 2, 6 * sigma), step = end / kSteps;
    float sum = 0;
    for (int i = 1; i <= kSteps; ++i) {
      const float t = step * static_cast<float>(i);
      sum += (i == kSteps ? 0.5f : 1) * std::exp(-Sqr(t) / (2 * Sqr(sigma))) * std::sin(t);
    }
    return 1 / (2 * kPi * step * sum);
  }
  float D(const Vec3& wm) const {
    if (wm.z <= 0) return 0;
    const float theta = std::acos(std::min(CosTheta(wm), 1.f));
    return C() * std::exp(-Sqr(theta) / (2 * Sqr(sigma))) / CosTheta(wm);
  }
};
void GaussianC(const float* in, float* out, Transport) { out[0] = Gaussian{in[0]}.C(); }
void GaussianD(const float* in, float* out, Transport) { out[0] = Gaussian{in[3]}.D(Load(in)); }
void GaussianVCavity(const float* in, float* out, Transport) {
  const Vec3 v = Load(in), m = Load(in + 3);
  const float seen = v.z < 0 ? -Dot(v, m) : Dot(v, m);
  out[0] = seen <= 0 ? 0 : std::min(seen / AbsCosTheta(v), 2 * CosTheta(m)) * Gaussian{in[6]}.D(m);
}
void GaussianEval(const float* in, float* out, Transport) {
  const Vec3 wi = Load(in), wo = Load(in + 3);
  out[0] = 0;
  if (wi.z * wo.z <= 0) return;
  Vec3 h = Normalize(wi + wo);
  if (h.z < 0) h = -1 * h;
  const float wi_h = AbsDot(wi, h), wo_h = AbsDot(wo, h), scale = 2 * CosTheta(h);
  const float G = std::min({1.f, scale * AbsCosTheta(wi) / wi_h, scale * AbsCosTheta(wo) / wo_h});
  out[0] = Gaussian{in[6]}.D(h) * G / (4 * AbsCosTheta(wi));
}
void GaussianSample(const float* in, float* out, Transport) {
  const float sigma = in[2], q = 1 - std::exp(-Sqr(kPi) / (8 * Sqr(sigma)));
  const float theta = sigma * std::sqrt(-2 * std::log(1 - in[0] * q)), sin_theta = std::sin(theta);
  Store(SphericalDirection(sin_theta, std::cos(theta), 2 * kPi * in[1]), out);
  out[3] = theta * std::exp(-Sqr(theta) / (2 * Sqr(sigma))) / (2 * kPi * Sqr(sigma) * q * sin_theta);
}

// Kelemen 2001 as printed, with the sine that the cumulative reflection function lacks.
struct CoupledMaterial {
  const AlbedoSteps& albedo;
  Beckmann ward;
  float index, k;

  float WardDensity(const Vec3& h) const { return ward.D(h) * CosTheta(h); }
  float MatteDensity(const Vec3& wo) const {
    return (1 - albedo(CosTheta(wo))) * AbsCosTheta(wo) / (kPi * (1 - albedo.average()));
  }
  float Eval(const Vec3& wi, const Vec3& wo) const {
    if (wi.z * wo.z <= 0) return 0;
    const Vec3 h = wi + wo;
    const Vec3 unit = Normalize(wi.z < 0 ? -h : h);
    const float specular = WardDensity(unit) * FrDielectric(AbsDot(wi, unit), index) / LengthSquared(h);
    return specular * AbsCosTheta(wo) + k * (1 - albedo(CosTheta(wi))) * MatteDensity(wo);
  }
  float Pdf(const Vec3& wi, const Vec3& wo) const {
    if (wi.z * wo.z <= 0) return 0;
    const Vec3 unit = Normalize(wi.z < 0 ? -(wi + wo) : wi + wo);
    const float a = albedo(CosTheta(wi));
    return a * WardDensity(unit) / (4 * AbsDot(wi, unit)) + k * (1 - a) * MatteDensity(wo);
  }
  void Sample(const Vec3& wi, float u1, float u2, float u3, float* out) const {
    std::fill_n(out, 6, 0.f);
    const float side = wi.z < 0 ? -1.f : 1.f, a = albedo(CosTheta(wi));
    const bool specular = u3 < a;
    if (u3 >= a + k * (1 - a)) return;
    Vec3 wo;
    if (specular) {
      wo = Reflect(wi, side * ward.SampleNormal(u1, u2));
    } else {
      const float cos_theta = albedo.MatteCosine(u1), phi = 2 * kPi * u2;
      const float sin_theta = std::sqrt(std::max(0.f, 1 - Sqr(cos_theta)));
      wo = {sin_theta * std::cos(phi), sin_theta * std::sin(phi), side * cos_theta};
    }
    if (wi.z * wo.z <= 0) return;
    const float pdf = Pdf(wi, wo);
    Store(wo, out);
    out[3] = Eval(wi, wo) / pdf;
    out[4] = pdf;
    out[5] = specular ? 1.f : 2.f;
  }
};

CoupledMaterial MakeCoupled(const float* in) {
  return {AlbedoOf(in[1], in[2]), Beckmann{in[1], in[1]}, in[2], in[0]};
}
void CoupledEval(const float* in, float* out, Transport) {
  out[0] = MakeCoupled(in + 6).Eval(Load(in), Load(in + 3));
}
void CoupledPdf(const float* in, float* out, Transport) {
  out[0] = MakeCoupled(in + 6).Pdf(Load(in), Load(in + 3));
}
void CoupledEvalPdf(const float* in, float* out, Transport) {
  const CoupledMaterial material = MakeCoupled(in + 6);
  out[0] = material.Eval(Load(in), Load(in + 3));
  out[1] = material.Pdf(Load(in), Load(in + 3));
}
void CoupledSample(const float* in, float* out, Transport) {
  MakeCoupled(in + 6).Sample(Load(in), in[3], in[4], in[5], out);
}

void AlbedoAtCosine(const float* in, float* out, Transport) {
  out[0] = AlbedoOf(in[1], in[2])(in[0]);
  out[1] = 1 - out[0];
}

void Exp(const float* in, float* out, Transport) { out[0] = std::exp(in[0]); }
void NegLog1m(const float* in, float* out, Transport) { out[0] = -std::log(1 - in[0]); }
void SinCos2Pi(const float* in, float* out, Transport) {
  out[0] = std::sin(2 * kPi * in[0]);
  out[1] = std::cos(2 * kPi * in[0]);
}
void ErfcxDefect(const float* in, float* out, Transport) {
  out[0] = 1 - std::sqrt(kPi) * in[0] * std::exp(Sqr(in[0])) * std::erfc(in[0]);
}
void Erfcx(const float* in, float* out, Transport) { out[0] = std::exp(Sqr(in[0])) * std::erfc(in[0]); }
void InverseErf(const float* in, float* out, Transport) { out[0] = ErfInv(2 * in[0] - 1); }
void PhongExponent(const float* in, float* out, Transport) { out[0] = std::max(0.f, 2 / Sqr(in[0]) - 2); }
void Reflectance(const float* in, float* out, Transport) { out[0] = FrDielectric(in[0], in[1]); }
void Transmittance(const float* in, float* out, Transport) { out[0] = 1 - FrDielectric(in[0], in[1]); }
void ReflectanceS(const float* in, float* out, Transport) {
  out[0] = Sqr(FresnelAmplitudes(in[0], in[1]).perpendicular);
}
void ReflectanceP(const float* in, float* out, Transport) {
  out[0] = Sqr(FresnelAmplitudes(in[0], in[1]).parallel);
}

void ConductorReflectance(const float* in, float* out, Transport) {
  out[0] = FrComplex(in[0], {in[1], in[2]});
}
void SchlickReflectance(const float* in, float* out, Transport) { out[0] = FrSchlick(in[0], in[1]); }

void FromMoments(const float* in, float* out, Transport) {
  const float variance_x = in[2] - Sqr(in[0]), variance_y = in[3] - Sqr(in[1]);
  out[0] = std::sqrt(2 * std::max(variance_x, 5e-11f));
  out[1] = std::sqrt(2 * std::max(variance_y, 5e-11f));
  const float r = (in[4] - in[0] * in[1]) / (out[0] * out[1] / 2);
  out[2] = std::min(std::max(r, -0.9999f), 0.9999f);
}
void ToMoments(const float* in, float* out, Transport) {
  out[0] = Sqr(in[3]) + Sqr(in[0]) / 2;
  out[1] = Sqr(in[4]) + Sqr(in[1]) / 2;
  out[2] = in[3] * in[4] + in[2] * in[0] * in[1] / 2;
}

// Whether w sees wm from its side of the surface.
bool Sees(const Vec3& w, const Vec3& wm) { return Dot(w, wm) * CosTheta(w) > 0; }
void MaskingVCavity(const float* in, float* out, Transport) {
  const Vec3 w = Load(in), wm = Load(in + 3);
  out[0] =
      Sees(w, wm) && CosTheta(wm) > 0 ? std::min(1.f, 2 * CosTheta(wm) * AbsCosTheta(w) / AbsDot(w, wm)) : 0;
}
void MaskingImplicit(const float* in, float* out, Transport) {
  out[0] = Sees(Load(in), Load(in + 3)) ? AbsCosTheta(Load(in)) : 0;
}
void MaskingSchlickSmith(const float* in, float* out, Transport) {
  const Vec3 w = Load(in);
  const float k = in[6] * std::sqrt(2 / kPi), c = AbsCosTheta(w);
  out[0] = Sees(w, Load(in + 3)) ? c / (c * (1 - k) + k) : 0;
}
void MaskingKelemen(const float* in, float* out, Transport) {
  const Vec3 w = Load(in), wm = Load(in + 3);
  out[0] = Sees(w, wm) ? AbsCosTheta(w) / AbsDot(w, wm) : 0;
}

void StudentDefect(const float* in, float* out, Transport) {
  const StudentParts parts = OfStudent(in[0], in[1] - 1.5f);
  out[0] = 1 - parts.loss / parts.gain;
}
void MaskingStudentLambda(const float* in, float* out, Transport) {
  const float roughness = std::sqrt(Sqr(in[3] * in[0]) + Sqr(in[4] * in[1])) * std::sqrt(in[5] - 1);
  out[0] = StudentLambda(std::abs(in[2]) / roughness, in[5] - 1.5f);
}
void PhongLambda(const float* in, float* out, Transport) {
  out[0] = StudentLambda(1 / std::abs(TanTheta(Load(in))), (in[3] + 1) / 2);
}
void PhongG1Smith(const float* in, float* out, Transport) {
  const Vec3 w = Load(in);
  out[0] = Sees(w, Load(in + 3)) ? 1 / (1 + StudentLambda(1 / std::abs(TanTheta(w)), (in[6] + 1) / 2)) : 0;
}

// From atan2 of each azimuth, wrapped.
float AzimuthDifference(const float* in) {
  const float difference = std::abs(std::atan2(in[1], in[0]) - std::atan2(in[3], in[2]));
  return difference > kPi ? 2 * kPi - difference : difference;
}
float DirectionalCorrelation(float phi) { return 4.41f * phi / (4.41f * phi + 1); }
void AzimuthsApart(const float* in, float* out, Transport) { out[0] = AzimuthDifference(in); }
void JointSeparable(const float* in, float* out, Transport) { out[0] = 1 / (1 + in[0]) * (1 / (1 + in[1])); }
void JointHeight(const float* in, float* out, Transport) { out[0] = 1 / (1 + in[0] + in[1]); }
void JointTransmission(const float* in, float* out, Transport) { out[0] = std::beta(1 + in[0], 1 + in[1]); }
void JointDirection(const float* in, float* out, Transport) {
  const float g_i = 1 / (1 + in[0]), g_o = 1 / (1 + in[1]);
  const float lambda = DirectionalCorrelation(AzimuthDifference(in + 2));
  out[0] = lambda * g_i * g_o + (1 - lambda) * std::min(g_i, g_o);
}
void JointHeightDirection(const float* in, float* out, Transport) {
  const float lambda = DirectionalCorrelation(AzimuthDifference(in + 2));
  out[0] = 1 / (1 + std::max(in[0], in[1]) + lambda * std::min(in[0], in[1]));
}

void ReflectionHalf(const float* in, float* out, Transport) {
  const Vec3 half = Normalize(Load(in) + Load(in + 3));
  Store(in[2] < 0 ? -half : half, out);
}
void ReflectionJacobian(const float* in, float* out, Transport) {
  const Vec3 half = Load(in) + Load(in + 3);
  out[0] = AbsDot(Load(in + 3), Normalize(half)) / LengthSquared(half);
}
void ReflectionJacobianCos(const float* in, float* out, Transport) { out[0] = 1 / (4 * std::abs(in[0])); }
void RefractionHalf(const float* in, float* out, Transport) {
  Store(-Normalize(Load(in) + in[6] * Load(in + 3)), out);
}
void RefractionJacobian(const float* in, float* out, Transport) {
  const Vec3 half = Load(in) + in[6] * Load(in + 3);
  out[0] = Sqr(in[6]) * AbsDot(Load(in + 3), Normalize(half)) / LengthSquared(half);
}
void RefractionJacobianCos(const float* in, float* out, Transport) {
  out[0] = Sqr(in[2]) * std::abs(in[1]) / Sqr(in[0] + in[2] * in[1]);
}
void MirrorDirection(const float* in, float* out, Transport) { Store(Reflect(Load(in), Load(in + 3)), out); }
void RefractedDirection(const float* in, float* out, Transport) {
  const Vec3 wi = Load(in), m = Load(in + 3);
  const float sign = CosTheta(wi) < 0 ? -1.f : 1.f;
  const float cos_theta_i = Dot(wi, m);
  const float sin2_theta_t = std::max(0.f, 1 - Sqr(cos_theta_i)) / Sqr(in[6]);
  if (sin2_theta_t >= 1) {
    Store({0, 0, 0}, out);
    return;
  }
  Store((cos_theta_i / in[6] - sign * std::sqrt(1 - sin2_theta_t)) * m - wi / in[6], out);
}

using Lane = void (*)(const float* in, float* out, Transport transport);
using Batch = void (*)(const Call<float>& call, std::size_t n);

template <std::size_t kKernel, Lane kLane>
void Loop(const Call<float>& call, std::size_t n) {
  constexpr std::size_t kIn = Split(kKernels[kKernel].inputs).count;
  constexpr std::size_t kOut = Split(kKernels[kKernel].outputs).count;
  const float* from[kIn];
  std::size_t step[kIn];
  for (std::size_t k = 0; k < kIn; ++k) {
    from[k] = call.in[k];
    step[k] = call.uniform[k] ? 0 : 1;
  }
  const Transport transport = call.transport;
  for (std::size_t i = 0; i < n; ++i) {
    asm volatile("");  // one lane at a time, as a renderer calls it: keeps the loop from being vectorised
    float in[kIn], out[kOut];
    for (std::size_t k = 0; k < kIn; ++k) in[k] = from[k][i * step[k]];
    kLane(in, out, transport);
    for (std::size_t k = 0; k < kOut; ++k) call.out[k][i] = out[k];
  }
}

struct Entry {
  std::size_t kernel;
  Batch batch;
};

template <std::size_t kKernel, Lane kLane>
constexpr Entry Make() {
  static_assert(kKernel < kNumKernels, "no such entry in the kernel list");
  return {kKernel, &Loop<kKernel, kLane>};
}

constexpr std::array kEntries = {
    Make<KernelIndex("math.exp"), Exp>(),
    Make<KernelIndex("math.neg_log1m"), NegLog1m>(),
    Make<KernelIndex("math.sincos_2pi"), SinCos2Pi>(),
    Make<KernelIndex("math.erfcx_defect"), ErfcxDefect>(),
    Make<KernelIndex("math.erfcx"), Erfcx>(),
    Make<KernelIndex("math.erfinv"), InverseErf>(),

    Make<KernelIndex("math.azimuth_difference"), AzimuthsApart>(),
    Make<KernelIndex("math.student_defect"), StudentDefect>(),

    Make<KernelIndex("beckmann.G1_rational"), MaskingG1Rational>(),
    Make<KernelIndex("beckmann.sample_normal_widened"), SampleNormalWidened>(),

    Make<KernelIndex("phong.exponent"), PhongExponent>(),
    Make<KernelIndex("phong.Lambda"), PhongLambda>(),
    Make<KernelIndex("phong.G1_smith"), PhongG1Smith>(),

    Make<KernelIndex("gaussian.C"), GaussianC>(),
    Make<KernelIndex("gaussian.D"), GaussianD>(),
    Make<KernelIndex("gaussian.D_visible_v_cavity"), GaussianVCavity>(),
    Make<KernelIndex("gaussian.eval_v_cavity"), GaussianEval>(),
    Make<KernelIndex("gaussian.sample_normal"), GaussianSample>(),

    Make<KernelIndex("fresnel.dielectric"), Reflectance>(),
    Make<KernelIndex("fresnel.dielectric_transmittance"), Transmittance>(),
    Make<KernelIndex("fresnel.dielectric_s"), ReflectanceS>(),
    Make<KernelIndex("fresnel.dielectric_p"), ReflectanceP>(),

    Make<KernelIndex("fresnel.conductor"), ConductorReflectance>(),
    Make<KernelIndex("fresnel.schlick"), SchlickReflectance>(),
    Make<KernelIndex("fresnel.diffuse_external"), DiffuseExternal>(),
    Make<KernelIndex("fresnel.diffuse_internal"), DiffuseInternal>(),
    Make<KernelIndex("interfaced.facet_body"), FacetBody>(),

    Make<KernelIndex("half_vector.reflection"), ReflectionHalf>(),
    Make<KernelIndex("half_vector.reflection_jacobian"), ReflectionJacobian>(),
    Make<KernelIndex("half_vector.reflection_jacobian_cos"), ReflectionJacobianCos>(),
    Make<KernelIndex("half_vector.refraction"), RefractionHalf>(),
    Make<KernelIndex("half_vector.refraction_jacobian"), RefractionJacobian>(),
    Make<KernelIndex("half_vector.refraction_jacobian_cos"), RefractionJacobianCos>(),
    Make<KernelIndex("reflect"), MirrorDirection>(),
    Make<KernelIndex("refract"), RefractedDirection>(),

    Make<KernelIndex("half_vector_density.ward"), WardDensity>(),
    Make<KernelIndex("half_vector_density.phong"), PhongDensity>(),
    Make<KernelIndex("coupled.eval"), CoupledEval>(),
    Make<KernelIndex("coupled.pdf"), CoupledPdf>(),
    Make<KernelIndex("coupled.eval_pdf"), CoupledEvalPdf>(),
    Make<KernelIndex("coupled.sample"), CoupledSample>(),
    Make<KernelIndex("albedo.directional"), AlbedoAtCosine>(),

    Make<KernelIndex("roughness.from_moments"), FromMoments>(),
    Make<KernelIndex("roughness.to_moments"), ToMoments>(),
    Make<KernelIndex("masking.v_cavity"), MaskingVCavity>(),
    Make<KernelIndex("masking.implicit"), MaskingImplicit>(),
    Make<KernelIndex("masking.schlick_smith"), MaskingSchlickSmith>(),
    Make<KernelIndex("masking.kelemen"), MaskingKelemen>(),
    Make<KernelIndex("masking.separable"), JointSeparable>(),
    Make<KernelIndex("masking.height_correlated"), JointHeight>(),
    Make<KernelIndex("masking.height_correlated_transmission"), JointTransmission>(),
    Make<KernelIndex("masking.student_lambda"), MaskingStudentLambda>(),
    Make<KernelIndex("masking.direction_correlated"), JointDirection>(),
    Make<KernelIndex("masking.height_direction_correlated"), JointHeightDirection>(),
};

template <std::size_t... kPlace>
constexpr void AddNormals(KernelTable<Batch>& table, std::index_sequence<kPlace...>) {
  const auto add = [&](auto place) {
    constexpr std::size_t kThis = decltype(place)::value, kKernel = kNumComponentKernels + kThis;
    if constexpr (kNormalRows[kNormalKernelPlaces[kThis].row].what != NormalQuantity::kOwn) {
      table[kKernel] = {Loop<kKernel, OfNormals<kThis>>, true};
    }
  };
  (add(std::integral_constant<std::size_t, kPlace>()), ...);
}

template <class Distribution, std::size_t... kQuantity>
constexpr void AddDielectrics(KernelTable<Batch>& table, std::index_sequence<kQuantity...>) {
  ((table[DielectricKernel(Distribution::kNormals, kQuantity)] =
        {Loop<DielectricKernel(Distribution::kNormals, kQuantity), Dielectric<Distribution, kQuantity>>,
         true}),
   ...);
}

template <class Distribution>
constexpr void AddDielectrics(KernelTable<Batch>& table) {
  AddDielectrics<Distribution>(table,
                               std::make_index_sequence<NumDielectricQuantities(Distribution::kNormals)>());
}

template <class Distribution, std::size_t... kPlace>
constexpr void AddReflectors(KernelTable<Batch>& table, std::index_sequence<kPlace...>) {
  constexpr std::size_t kFirst = ReflectorKernel({Distribution::kNormals, Reflector::kMirror, 0});
  ((table[kFirst + kPlace] = {Loop<kFirst + kPlace, OpaqueSurface<Distribution, kFirst + kPlace>>, true}),
   ...);
}

template <class Distribution>
constexpr void AddReflectors(KernelTable<Batch>& table) {
  AddReflectors<Distribution>(table, std::make_index_sequence<NumReflectorKernels(Distribution::kNormals)>());
}

template <class Distribution, std::size_t... kQuantity>
constexpr void AddDiffuse(KernelTable<Batch>& table, std::index_sequence<kQuantity...>) {
  constexpr std::size_t kFirst = DiffuseKernel({Distribution::kNormals, Scatterer::kLambertian, 0});
  ((table[kFirst + kQuantity] = {Loop<kFirst + kQuantity, DiffuseSurface<Distribution, kFirst + kQuantity>>,
                                 true}),
   ...);
}

template <class Distribution, std::size_t... kQuantity>
constexpr void AddMeanFresnel(KernelTable<Batch>& table, std::index_sequence<kQuantity...>) {
  constexpr std::size_t kFirst = MeanFresnelKernel(Distribution::kNormals, 0);
  ((table[kFirst + kQuantity] = {Loop<kFirst + kQuantity, MeanFresnel<Distribution, kFirst + kQuantity>>,
                                 true}),
   ...);
}

constexpr KernelTable<Batch> Resolve() {
  KernelTable<Batch> table{};
  for (const Entry& entry : kEntries) table[entry.kernel] = {entry.batch, true};
  AddNormals(table, std::make_index_sequence<kNumNormalKernels>());
  AddDielectrics<Ggx>(table);
  AddDielectrics<Beckmann>(table);
  AddDielectrics<Phong>(table);
  AddReflectors<Ggx>(table);
  AddReflectors<Beckmann>(table);
  AddReflectors<Phong>(table);
  AddDiffuse<Ggx>(table, std::make_index_sequence<NumDiffuseKernels(Normals::kGgx)>());
  AddDiffuse<Beckmann>(table, std::make_index_sequence<NumDiffuseKernels(Normals::kBeckmann)>());
  AddMeanFresnel<Ggx>(table, std::make_index_sequence<kNumMeanFresnelQuantities>());
  AddMeanFresnel<Beckmann>(table, std::make_index_sequence<kNumMeanFresnelQuantities>());
  return table;
}

constexpr KernelTable<Batch> kTable = Resolve();

static_assert(HasEveryKernel(kTable), "every entry of the kernel list has its textbook code");

}  // namespace

void Run(std::size_t kernel, const Call<float>& call, std::size_t n) { kTable[kernel].function(call, n); }

}  // namespace microlane::textbook
// NOLINTEND(clang-analyzer-core*)
