#include "points.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <numeric>
#include <set>
#include <string_view>
#include <utility>

namespace microlane {
namespace {

// Places in a Scene: those of kInputs.
enum Field : int {
  kMx,
  kMy,
  kMz,
  kVx,
  kVy,
  kVz,
  kWix,
  kWiy,
  kWiz,
  kWox,
  kWoy,
  kWoz,
  kCosI,
  kCosO,
  kAlpha,
  kAlphaX,
  kAlphaY,
  kRxy,
  kMeanX,
  kMeanY,
  kMomentXx,
  kMomentYy,
  kMomentXy,
  kExponent,
  kEta,
  kN,
  kKappa,
  kF0,
  kLambdaI,
  kLambdaO,
  kU1,
  kU2,
  kU3,
  kU4,
  kU5,
  kX,
  kA,
  kMu,
  kGamma,
  kOrder,
  kK,
  kM,
  kIndex,
  kNi,
  kSigma,
  kTail,
  kNumFields
};
constexpr std::string_view kFieldNames[] = {
    "mx",      "my",   "mz",     "vx",     "vy",        "vz",        "wix",       "wiy",
    "wiz",     "wox",  "woy",    "woz",    "cos_i",     "cos_o",     "alpha",     "alpha_x",
    "alpha_y", "r_xy", "mean_x", "mean_y", "moment_xx", "moment_yy", "moment_xy", "exponent",
    "eta",     "n",    "kappa",  "f0",     "Lambda_i",  "Lambda_o",  "u1",        "u2",
    "u3",      "u4",   "u5",     "x",      "a",         "mu",        "gamma",     "order",
    "k",       "m",    "index",  "n_i",    "sigma",     "tail"};
static_assert(std::size(kFieldNames) == kNumFields && std::size(kInputs) == kNumFields,
              "one field per input");

constexpr bool FieldsMatchInputs() {
  for (int i = 0; i < kNumFields; ++i) {
    if (kInputs[i].name != kFieldNames[i]) return false;
  }
  return true;
}
static_assert(FieldsMatchInputs(), "fields stand in the order of kInputs");

constexpr double kTwoPi = 6.283185307179586, kRootTwo = 1.4142135623730951;
constexpr double kLargestU = 1 - 0x1p-24;
constexpr double kSmallestCosine = 1e-7;

enum class Distribution { kGgx, kBeckmann, kPhong, kStudentT };

// What the points of a kernel are made of.
struct Shape {
  std::array<Field, kMaxInputs> field{};
  std::size_t count = 0;
  Distribution distribution = Distribution::kGgx;
  bool isotropic = false;
  bool reflects = true, transmits = true;  // lobes that are not 0 by definition
  bool samples = false;                    // a normal from u1, u2
  bool pairs = false;                      // wi and wo
  bool visible = false;                    // normals as seen from v
  bool v_cavity = false;                   // by V-cavities
  std::array<bool, kNumFields> has{};
};

constexpr bool Contains(std::string_view text, std::string_view part) {
  return text.find(part) != std::string_view::npos;
}

Shape MakeShape(std::size_t kernel) {
  const std::string_view id = kKernels[kernel].id;
  const Names names = Split(kKernels[kernel].inputs);
  Shape shape;
  shape.count = names.count;
  for (std::size_t i = 0; i < names.count; ++i) {
    int field = 0;
    while (kFieldNames[field] != names.name[i]) ++field;
    shape.field[i] = static_cast<Field>(field);
    shape.has[field] = true;
  }
  shape.distribution =
      shape.has[kExponent] ? Distribution::kPhong
      : Contains(id, "beckmann") || Contains(id, "ward") || shape.has[kM] || shape.has[kSigma]
          ? Distribution::kBeckmann
      : Contains(id, "student_t") || shape.has[kTail] ? Distribution::kStudentT
                                                      : Distribution::kGgx;
  shape.isotropic = shape.has[kAlpha] || shape.has[kExponent] || shape.has[kM] || shape.has[kSigma];
  shape.pairs = shape.has[kWox];
  shape.samples = shape.has[kWix] && shape.has[kU1];
  shape.visible = Contains(id, "visible");
  shape.v_cavity = Contains(id, "v_cavity");
  shape.reflects = !Contains(id, "transmission") && !Contains(id, "half_vector.refraction");
  shape.transmits = !Contains(id, "reflection") && shape.has[kEta];
  return shape;
}

const std::array<Shape, kNumKernels>& Shapes() {
  static const std::array<Shape, kNumKernels> shapes = [] {
    std::array<Shape, kNumKernels> all;
    for (std::size_t k = 0; k < kNumKernels; ++k) all[k] = MakeShape(k);
    return all;
  }();
  return shapes;
}

struct Vector {
  double x, y, z;
};
Vector operator+(const Vector& a, const Vector& b) { return {a.x + b.x, a.y + b.y, a.z + b.z}; }
Vector operator-(const Vector& a, const Vector& b) { return {a.x - b.x, a.y - b.y, a.z - b.z}; }
Vector operator-(const Vector& a) { return {-a.x, -a.y, -a.z}; }
Vector operator*(double s, const Vector& a) { return {s * a.x, s * a.y, s * a.z}; }
double Dot(const Vector& a, const Vector& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vector Normalized(const Vector& a) { return (1 / std::sqrt(Dot(a, a))) * a; }

Vector FromCosine(double cosine, double phi) {
  const double sine = std::sqrt((1 - cosine) * (1 + cosine));
  return {sine * std::cos(phi), sine * std::sin(phi), cosine};
}

// Turned by quarters, exactly.
Vector Turned(const Vector& v, int quarters) {
  switch (quarters) {
    case 0:
      return v;
    case 1:
      return {-v.y, v.x, v.z};
    case 2:
      return {-v.x, -v.y, v.z};
    default:
      return {v.y, -v.x, v.z};
  }
}

void Put(Scene& scene, Field first, const Vector& v) {
  scene[first] = v.x;
  scene[first + 1] = v.y;
  scene[first + 2] = v.z;
}

// The alphas that matter: the exponent's own for Phong.
double RoughnessX(const Shape& shape, const Scene& scene) {
  return shape.distribution == Distribution::kPhong ? 1 / std::sqrt(scene[kExponent] / 2 + 1)
         : shape.has[kM]                            ? scene[kM]
         : shape.has[kSigma]                        ? kRootTwo * scene[kSigma]
         : shape.isotropic                          ? scene[kAlpha]
                                                    : scene[kAlphaX];
}
double RoughnessY(const Shape& shape, const Scene& scene) {
  return shape.isotropic ? RoughnessX(shape, scene) : scene[kAlphaY];
}

Vector FromSlopes(double x, double y) { return Normalized({x, y, 1}); }

double Uncorrelated(const Scene& scene) { return std::sqrt((1 - scene[kRxy]) * (1 + scene[kRxy])); }

// The normal whose slopes are x, y at unit roughness: Heitz 2014 Eqs. 88, 95. Of the Gaussian of the angle,
// whose angle is sqrt(2) sigma times their length.
Vector Rough(const Shape& shape, const Scene& scene, double x, double y) {
  if (shape.has[kSigma]) {
    const double theta = std::fmod(kRootTwo * scene[kSigma] * std::hypot(x, y), 0.25 * kTwoPi);
    const double phi = std::atan2(y, x), sine = std::sin(theta);
    return {sine * std::cos(phi), sine * std::sin(phi), std::cos(theta)};
  }
  if (!shape.has[kRxy]) return FromSlopes(RoughnessX(shape, scene) * x, RoughnessY(shape, scene) * y);
  const double across = scene[kRxy] * x + Uncorrelated(scene) * y;
  const double mean_x = shape.has[kMeanX] ? scene[kMeanX] : 0, mean_y = shape.has[kMeanX] ? scene[kMeanY] : 0;
  return FromSlopes(scene[kAlphaX] * x - mean_x, scene[kAlphaY] * across - mean_y);
}

// The direction that x, y, z is at unit roughness, by the inverse transpose.
Vector FromUnitView(const Shape& shape, const Scene& scene, const Vector& v) {
  const double s = shape.has[kRxy] ? Uncorrelated(scene) : 1, r = shape.has[kRxy] ? scene[kRxy] : 0;
  const double y = v.y / s / RoughnessY(shape, scene), x = (v.x - r * v.y / s) / RoughnessX(shape, scene);
  const double z = shape.has[kMeanX] ? v.z + scene[kMeanX] * x + scene[kMeanY] * y : v.z;
  return Normalized({x, y, z});
}

// r^2 of Student-T slopes of unit roughness, of which u lies below, -log(1 - u) = log.
double StudentRadius2(double gamma, double log) { return (gamma - 1) * std::expm1(log / (gamma - 1)); }

// The normal that the samplers make of u1 and u2.
Vector SampledNormal(const Shape& shape, const Scene& scene) {
  const double u = std::min(scene[kU1], kLargestU), phi = kTwoPi * scene[kU2];
  double radius = 0;
  switch (shape.distribution) {
    case Distribution::kGgx:
      radius = std::sqrt(u / (1 - u));
      break;
    case Distribution::kBeckmann:
      radius = std::sqrt(-std::log1p(-u));
      break;
    case Distribution::kStudentT:
      radius = std::sqrt(StudentRadius2(scene[kGamma], -std::log1p(-u)));
      break;
    case Distribution::kPhong:
      return FromCosine(std::exp(std::log(std::max(u, 1e-300)) / (scene[kExponent] + 2)), phi);
  }
  return Rough(shape, scene, radius * std::cos(phi), radius * std::sin(phi));
}

double Reflectance(double c, double eta) {
  const double g2 = (eta - 1) * (eta + 1) + c * c;
  if (g2 <= 0) return 1;
  const double g = std::sqrt(g2), s = (g - c) / (g + c), p = (eta * eta * c - g) / (eta * eta * c + g);
  return 0.5 * (s * s + p * p);
}

Vector Mirrored(const Vector& wi, const Vector& m) { return 2 * Dot(wi, m) * m - wi; }

// wo behind m of c = wi.m > 0; mirrored under total internal reflection.
Vector Refracted(const Vector& wi, const Vector& m, double eta) {
  const double c = Dot(wi, m), g2 = (eta - 1) * (eta + 1) + c * c;
  if (g2 < 0) return Mirrored(wi, m);
  return 1 / eta * ((c - std::sqrt(g2)) * m - wi);
}

// The direction at cosine c to m, turned about m towards v.
Vector AtCosine(const Vector& m, double c, const Vector& v) {
  const Vector across = v - Dot(v, m) * m;
  const double length2 = Dot(across, across);
  if (!(length2 > 1e-12) || !(c < 1)) return m;
  return c * m + std::sqrt((1 - c) * (1 + c) / length2) * across;
}

double Floats(double x, int steps) {
  float y = static_cast<float>(x);
  const float to = steps < 0 ? std::numeric_limits<float>::lowest() : std::numeric_limits<float>::max();
  for (int i = 0; i < std::abs(steps); ++i) y = std::nextafter(y, to);
  return y;
}
double Doubles(double x, int steps) {
  const double to = steps < 0 ? std::numeric_limits<double>::lowest() : std::numeric_limits<double>::max();
  for (int i = 0; i < std::abs(steps); ++i) x = std::nextafter(x, to);
  return x;
}

// Materials of few tables: what a table is made from takes these values alone.
constexpr double kTableM[] = {1e-4, 1e-3, 0.03, 0.1, 0.3, 0.8, 2, 10};
constexpr double kTableTails[] = {1.55, 1.7, 2, 2.5, 4, 30, 1e3, 1e10};
constexpr double kTableIndices[] = {1, 1.0003, 1.1, 1.33, 1.5, 1.7, 2.42, 4};
template <std::size_t kCount>
double Nearest(const double (&values)[kCount], double x) {
  const double* best = values;
  for (const double& value : values) {
    if (std::abs(value - x) < std::abs(*best - x)) best = &value;
  }
  return static_cast<float>(*best);
}

bool IsDirection(Field field) { return field <= kWoz; }
bool IsCosine(Field field) { return field == kMz || field == kVz || field == kWiz || field == kWoz; }

// `x` as the kind of number wanted, within the domain of its field.
double Fit(Field field, double x, Values values) {
  const Input& input = kInputs[field];
  if (values == Values::kFloats) x = static_cast<float>(x);
  if (field >= kU1 && field <= kU5) return std::min(std::max(x, 0.0), kLargestU);
  if (field == kOrder) x = std::round(x);
  if (field == kM) x = Nearest(kTableM, x);
  if (field == kIndex) x = Nearest(kTableIndices, x);
  if (field == kTail) x = Nearest(kTableTails, x);
  if (IsCosine(field) && std::abs(x) < kSmallestCosine) {
    return std::copysign(static_cast<double>(static_cast<float>(kSmallestCosine)), x);
  }
  double low = input.low, high = input.high;
  if (values == Values::kFloats) {
    low = static_cast<float>(low);
    high = static_cast<float>(high);
  }
  return std::min(std::max(x, low), high);
}

// What the objects that calls take whole are made from.
struct PreparedValues {
  double order, m, index, tail;
};

class SceneMaker {
 public:
  // prepared: what the scene does not draw.
  SceneMaker(const Shape& shape, Random& random, Values values, const PreparedValues& prepared)
      : shape_(shape), random_(random), values_(values), prepared_(prepared) {}

  Scene Make() {
    scene_.fill(0);
    scene_[kOrder] = prepared_.order;
    scene_[kM] = prepared_.m;
    if (shape_.has[kK])
      scene_[kK] = Fit(kK, random_.Chance(0.2) ? random_.Index(2) : random_.Uniform(), values_);
    scene_[kIndex] = prepared_.index;
    scene_[kTail] = scene_[kGamma] = prepared_.tail;
    DrawRoughness();
    scene_[kEta] = Fit(kEta, Eta(), values_);
    scene_[kNi] = BodyIndex();
    scene_[kN] = ConductorIndex();
    scene_[kKappa] = random_.Chance(0.15)  ? 0
                     : random_.Chance(0.1) ? random_.LogUniform(1e-30, 1e-4)
                                           : random_.LogUniform(1e-4, 20);
    scene_[kF0] = random_.Chance(0.1)   ? 0
                  : random_.Chance(0.1) ? 1
                  : random_.Chance(0.5) ? random_.LogUniform(1e-9, 1)
                                        : random_.Uniform();
    scene_[kLambdaI] = SmithLambda();
    scene_[kLambdaO] = random_.Chance(0.1) ? scene_[kLambdaI] : SmithLambda();
    scene_[kU1] = U();
    scene_[kU2] = U();
    scene_[kU3] = U();
    if (shape_.has[kU4]) {
      scene_[kU4] = U();
      scene_[kU5] = U();
    }
    scene_[kX] = Exponential();
    scene_[kA] = random_.Chance(0.02)  ? 0
                 : random_.Chance(0.5) ? random_.LogUniform(1e-6, 1e4)
                                       : 12 * random_.Uniform();
    if (shape_.has[kGamma]) DrawStudent();
    if (shape_.has[kSigma]) scene_[kSigma] = Fit(kSigma, Sigma(), values_);
    DrawCosines();
    if (shape_.has[kMx] || shape_.pairs || shape_.samples || shape_.has[kVx]) DrawDirections();
    return scene_;
  }

 private:
  double Alpha() {
    const double u = random_.Uniform();
    if (u < 0.04) return 1;
    if (u < 0.07) return 1e-5;
    if (u < 0.10) return 1e2;
    if (u < 0.20) return std::exp2(random_.Index(23) - 16);
    if (u < 0.25) return Floats(1, random_.Index(9) - 4);
    return random_.LogUniform(1e-5, u < 0.6 ? 1 : 1e2);
  }

  void DrawRoughness() {
    double x = Fit(kAlpha, Alpha(), values_), y = x;
    const double u = random_.Uniform();
    if (u < 0.15) {
      x = Fit(kAlpha, random_.LogUniform(1e-5, 1e-3), values_);
      y = Fit(kAlpha, random_.LogUniform(1, 1e2), values_);
      if (random_.Chance(0.5)) std::swap(x, y);
    } else if (u < 0.25) {
      y = Fit(kAlpha, Floats(x, random_.Index(9) - 4), values_);
    } else if (u < 0.7) {
      y = Fit(kAlpha, Alpha(), values_);
    }
    scene_[kAlpha] = scene_[kAlphaX] = x;
    scene_[kAlphaY] = y;
    const double edge = random_.Uniform();
    scene_[kRxy] = Fit(kRxy,
                       random_.Sign() * (edge < 0.1   ? 0
                                         : edge < 0.2 ? 0.9999
                                         : edge < 0.5 ? 1 - random_.LogUniform(1e-4, 1)
                                                      : random_.Uniform()),
                       values_);
    for (const Field mean : {kMeanX, kMeanY}) {
      const double edge_of_mean = random_.Uniform();
      scene_[mean] = Fit(
          mean,
          random_.Sign() * (edge_of_mean < 0.1   ? 0
                            : edge_of_mean < 0.2 ? 16
                                                 : random_.LogUniform(edge_of_mean < 0.5 ? 1e-6 : 0.01, 16)),
          values_);
    }
    DrawMoments();
    double exponent = random_.LogUniform(1e-3, 2e10);
    const double v = random_.Uniform();
    if (v < 0.3 && x < 1) exponent = 2 / (x * x) - 2;
    if (v >= 0.3 && v < 0.4) exponent = std::floor(random_.LogUniform(1, 1e4));
    if (v >= 0.4 && v < 0.43) exponent = 0;
    if (v >= 0.43 && v < 0.46) exponent = 2e10;
    scene_[kExponent] = Fit(kExponent, exponent, values_);
  }

  // Those of the roughness, now and then within floats of what its variances cancel to, or of none.
  void DrawMoments() {
    const double x = scene_[kAlphaX], y = scene_[kAlphaY], mean_x = scene_[kMeanX], mean_y = scene_[kMeanY];
    const bool none = random_.Chance(0.2);
    const auto moment = [&](Field field, double of_means, double variance) {
      const double sum = of_means + (none ? 0 : variance);
      scene_[field] = Fit(field, random_.Chance(0.2) ? Floats(sum, random_.Index(9) - 4) : sum, values_);
    };
    moment(kMomentXx, mean_x * mean_x, x * x / 2);
    moment(kMomentYy, mean_y * mean_y, y * y / 2);
    moment(kMomentXy, mean_x * mean_y, scene_[kRxy] * x * y / 2);
  }

  // gamma from next to where Lambda is infinite to Beckmann's limit; mu about where Lambda falls, and
  // anywhere.
  void DrawStudent() {
    constexpr double kEdges[] = {1.55, 2, 2.5, 3, 1e10};
    const double u = random_.Uniform();
    const double gamma = u < 0.1   ? kEdges[random_.Index(5)]
                         : u < 0.4 ? 1.5 + random_.LogUniform(0.05, 10)
                                   : 1.5 + random_.LogUniform(0.05, 1e10);
    scene_[kGamma] = Fit(kGamma, gamma, values_);
    const double v = random_.Uniform(), a = v < 0.5 ? 12 * random_.Uniform() : random_.LogUniform(1e-6, 1e4);
    const double mu = v < 0.02   ? 0
                      : v < 0.15 ? random_.LogUniform(1e-30, 1e18)
                                 : a / std::sqrt(scene_[kGamma] - 1);
    scene_[kMu] = Fit(kMu, mu, values_);
  }

  double Eta() {
    constexpr double kGlasses[] = {1, 1.0003, 1.33, 1.5, 1.51, 2.42, 4};
    const double u = random_.Uniform();
    if (u < 0.25) return std::pow(kGlasses[random_.Index(7)], random_.Sign());
    if (u < 0.35) return 1 + random_.Sign() * std::pow(10, -1 - random_.Index(7));
    if (u < 0.5) return 1 + random_.Sign() * random_.LogUniform(1e-7, 0.3);
    return random_.LogUniform(0.25, 4);
  }

  // Of what is denser than its outside.
  double BodyIndex() {
    const double eta = scene_[kEta];
    return Fit(kNi, eta < 1 ? 1 / eta : eta, values_);
  }

  // Silver to germanium, and the indices of dielectrics.
  double ConductorIndex() {
    const double u = random_.Uniform();
    return u < 0.4 ? scene_[kEta] : u < 0.45 ? 0.05 : random_.LogUniform(0.05, 10);
  }

  // Of the Gaussian of the angle: its ends, and the more where the horizon cuts it off.
  double Sigma() {
    const double u = random_.Uniform();
    if (u < 0.1) return u < 0.05 ? 1e-3 : 2;
    if (u < 0.2) return std::exp2(1 - random_.Index(10));
    return u < 0.5 ? random_.LogUniform(0.1, 2) : random_.LogUniform(1e-3, 2);
  }

  double SmithLambda() {
    const double u = random_.Uniform();
    return u < 0.08   ? 0
           : u < 0.11 ? std::numeric_limits<float>::max()
           : u < 0.25 ? random_.LogUniform(1e-45, 1e38)
                      : random_.LogUniform(1e-6, 1e6);
  }

  double U() {
    constexpr double kEdges[] = {0, 0x1p-32, 0x1p-24, 0.125, 0.25, 0.5, 0.75, kLargestU};
    const double u = random_.Uniform();
    double x = random_.Uniform();
    if (u < 0.06) x = kEdges[random_.Index(8)];
    if (u >= 0.06 && u < 0.16) x = random_.LogUniform(1e-30, 1);
    if (u >= 0.16 && u < 0.26) x = 1 - random_.LogUniform(0x1p-24, 1);
    if (u >= 0.26 && u < 0.36) x = 0.125 * random_.Index(8) + random_.Sign() * random_.LogUniform(1e-9, 0.1);
    return Fit(kU1, x, values_);
  }

  double Exponential() {
    const double u = random_.Uniform();
    if (u < 0.2) return random_.Sign() * random_.LogUniform(1e-20, 1);
    if (u < 0.4) {  // near the multiples of ln(2) / 2
      return 0.34657359027997264 * (random_.Index(553) - 299) +
             random_.Sign() * random_.LogUniform(1e-9, 1e-3);
    }
    if (u < 0.5) return -87.4 - 16.6 * random_.Uniform();
    return -104 + 192 * random_.Uniform();
  }

  // A cosine of either sign.
  double Cosine() {
    const double u = random_.Uniform(), sign = random_.Sign();
    if (u < 0.03) return sign;
    if (u < 0.05) return sign * kSmallestCosine;
    if (u < 0.35) return sign * random_.LogUniform(kSmallestCosine, 1);
    if (u < 0.55) return sign * (1 - random_.LogUniform(1e-13, 1));
    return sign * random_.Uniform();
  }

  // About the axis of a random quarter: exactly, or nearly.
  Vector AnyDirection() {
    const double cosine = Cosine();
    if (random_.Chance(0.1)) {
      return Turned({std::sqrt((1 - cosine) * (1 + cosine)), 0, cosine}, random_.Index(4));
    }
    return FromCosine(cosine, Azimuth());
  }

  double Azimuth() {
    const double u = random_.Uniform();
    if (u < 0.15) return 0.25 * kTwoPi * random_.Index(4);
    if (u < 0.25) return 0.25 * kTwoPi * random_.Index(4) + random_.Sign() * random_.LogUniform(1e-9, 0.1);
    if (u < 0.30) return 0.125 * kTwoPi * (2 * random_.Index(4) + 1);
    return kTwoPi * random_.Uniform();
  }

  static double CriticalCosine(double eta) { return std::sqrt((1 - eta) * (1 + eta)); }
  static double BrewsterCosine(double eta) { return 1 / std::sqrt(1 + eta * eta); }
  // x and its neighbourhood, from a few roundings to a percent.
  double Near(double x) {
    return random_.Chance(0.5) ? Floats(x, random_.Index(9) - 4)
                               : x * (1 + random_.Sign() * random_.LogUniform(1e-9, 1e-2));
  }

  double SpecialCosine(double eta) {
    const double c = eta < 1 && random_.Chance(0.5) ? CriticalCosine(eta) : BrewsterCosine(eta);
    return std::min(Near(c), 1.0);
  }

  void DrawCosines() {
    const double eta = scene_[kEta];
    double i = Cosine(), o = Cosine();
    if (random_.Chance(0.3)) i = random_.Sign() * SpecialCosine(shape_.has[kN] ? scene_[kN] : eta);
    const double u = random_.Uniform();
    if (u < 0.6) {
      // i.h and o.h of a refraction.
      const double g2 = (eta - 1) * (eta + 1) + i * i;
      if (g2 >= 0) o = -std::copysign(std::sqrt(g2), i) / eta;
      o = std::min(std::max(o, -1.0), 1.0);
    } else if (u < 0.7) {
      o = std::min(std::max(Near(-i / eta), -1.0), 1.0);
    }
    scene_[kCosI] = std::abs(i) < kSmallestCosine ? std::copysign(kSmallestCosine, i) : i;
    scene_[kCosO] = std::abs(o) < kSmallestCosine ? std::copysign(kSmallestCosine, o) : o;
  }

  // Slopes in units of the roughness, heavy-tailed.
  double SlopeRadius() {
    const double u = random_.Uniform();
    const bool student = shape_.distribution == Distribution::kStudentT;
    const double largest = shape_.distribution == Distribution::kGgx ? 1e4
                           : student ? std::sqrt(std::min(1e8, StudentRadius2(scene_[kGamma], 110)))
                                     : 10.5;
    if (u < 0.4) return random_.LogUniform(1e-4, largest);
    if (u < 0.6) return largest * random_.Uniform() * random_.Uniform();
    const double v = random_.Uniform();
    return shape_.distribution == Distribution::kGgx ? std::sqrt(v / (1 - v))
           : student ? std::sqrt(StudentRadius2(scene_[kGamma], -std::log1p(-v)))
                     : std::sqrt(-std::log1p(-v));
  }

  Vector LobeNormal() {
    const double radius = SlopeRadius(), phi = Azimuth();
    return Rough(shape_, scene_, radius * std::cos(phi), radius * std::sin(phi));
  }

  // A direction at which the masking is neither 0 nor 1: a = 1/(alpha tan) of the order of 1.
  Vector MaskedDirection() {
    const double a = random_.LogUniform(1e-3, random_.Chance(0.7) ? 12 : 1e4), phi = Azimuth();
    if (shape_.has[kRxy]) {
      return FromUnitView(shape_, scene_, random_.Sign() * FromSlopes(std::cos(phi) / a, std::sin(phi) / a));
    }
    const double alpha =
        std::hypot(RoughnessX(shape_, scene_) * std::cos(phi), RoughnessY(shape_, scene_) * std::sin(phi));
    const double tangent = 1 / (a * alpha);
    return random_.Sign() * FromSlopes(tangent * std::cos(phi), tangent * std::sin(phi));
  }

  void DrawDirections() {
    const double eta = scene_[kEta];
    Vector m = random_.Chance(0.85) ? LobeNormal() : AnyDirection();
    Vector wi = random_.Chance(0.4) ? MaskedDirection() : AnyDirection();
    if (shape_.samples) m = SampledNormal(shape_, scene_);
    const bool upright = shape_.pairs || shape_.samples || shape_.has[kEta];
    const double side = std::copysign(1, wi.z);
    Vector facing = upright ? side * m : m;
    const double index = shape_.has[kN] ? scene_[kN] : eta;
    if ((shape_.has[kEta] || shape_.has[kN]) && random_.Chance(0.2)) {
      wi = AtCosine(facing, SpecialCosine(index), wi);
    }
    if (shape_.samples && random_.Chance(0.05)) wi = AtCosine(facing, random_.LogUniform(1e-8, 1e-2), wi);
    if (random_.Chance(0.7) && Dot(wi, facing) < 0 && upright) wi = wi - 2 * Dot(wi, facing) * facing;
    if (random_.Chance(0.03)) wi.z = std::copysign(random_.LogUniform(kSmallestCosine, 1e-2), wi.z);
    if (shape_.visible) SeeNormal(wi, m);
    wi = Rounded(kWix, Normalized(wi));
    if (shape_.has[kMx]) facing = Rounded(kMx, facing);
    if (shape_.pairs) Put(scene_, kWox, Rounded(kWox, Outgoing(wi, facing, eta)));
    if (shape_.samples && random_.Chance(0.3)) {
      scene_[kU3] = Fit(kU3, Near(Reflectance(std::abs(Dot(wi, facing)), eta)), values_);
    }
    Put(scene_, kMx, facing);
    Put(scene_, kVx, wi);
    Put(scene_, kWix, wi);
  }

  // Turns v so that it sees m most of the time, sometimes just so; draws a point of the cap opposite to v now
  // and then, where their sum cancels.
  void SeeNormal(Vector& v, const Vector& m) {
    const double u = random_.Uniform();
    if (u < 0.15) v = AtCosine(m, random_.LogUniform(1e-8, 1e-2), v);
    if (u < 0.8 && Dot(v, m) * v.z < 0) v = v - 2 * Dot(v, m) * m;
    if (!shape_.has[kU1] || u >= 0.2) return;
    const double phi = std::atan2(RoughnessY(shape_, scene_) * v.y, RoughnessX(shape_, scene_) * v.x);
    const double opposite =
        phi / kTwoPi + (v.z < 0 ? 0 : 0.5) + random_.Sign() * random_.LogUniform(1e-9, 0.1);
    scene_[kU1] = Fit(kU1, 1 - random_.LogUniform(0x1p-24, 1), values_);
    scene_[kU2] = Fit(kU2, opposite - std::floor(opposite), values_);
  }

  Vector Outgoing(const Vector& wi, const Vector& facing, double eta) {
    const double u = random_.Uniform();
    if (u < 0.10) return AnyDirection();
    if (u < 0.15) {  // retroreflection
      return Normalized(wi + random_.LogUniform(1e-8, 1e-1) * AnyDirection());
    }
    if (u < 0.20) {  // opposite
      return random_.Chance(0.1) ? -wi : Normalized(random_.LogUniform(1e-8, 1e-1) * AnyDirection() - wi);
    }
    if (u < 0.25) {  // h = n
      return random_.Chance(0.5) ? Vector{-wi.x, -wi.y, wi.z}
                                 : Refracted(wi, {0, 0, std::copysign(1.0, wi.z)}, eta);
    }
    if (u < 0.30) {  // grazing
      return FromCosine(random_.Sign() * random_.LogUniform(kSmallestCosine, 1e-2), Azimuth());
    }
    const double reflection = !shape_.transmits ? 1 : !shape_.reflects ? 0.05 : 0.5;
    Vector wo = random_.Chance(reflection) ? Mirrored(wi, facing) : Refracted(wi, facing, eta);
    if (random_.Chance(0.1)) wo.z = -wo.z;
    return Normalized(wo);
  }

  // Rounded to the kind of number wanted, some with a few more roundings.
  Vector Rounded(Field first, Vector v) {
    double* components[] = {&v.x, &v.y, &v.z};
    const bool nudge = random_.Chance(0.1);
    for (int k = 0; k < 3; ++k) {
      double& x = *components[k];
      if (nudge) {
        x = values_ == Values::kFloats ? Floats(x, random_.Index(9) - 4) : Doubles(x, random_.Index(9) - 4);
      }
      x = Fit(static_cast<Field>(first + k), x, values_);
    }
    return v;
  }

  const Shape& shape_;
  Random& random_;
  const Values values_;
  const PreparedValues prepared_;
  Scene scene_;
};

Point Cut(const Shape& shape, const Scene& scene, Values values) {
  Point point{};
  for (std::size_t i = 0; i < shape.count; ++i) {
    const Field field = shape.field[i];
    point[i] = IsDirection(field) ? scene[field] : Fit(field, scene[field], values);
  }
  return point;
}

// Values that a grid is made of.
constexpr double kGridCosines[] = {1,    0.999999, 0.9,  0.5, 0.1,  1e-2,  1e-3, 1e-5,
                                   1e-7, -0.1,     -0.5, -1,  -0.9, -1e-2, -1e-4};
constexpr double kGridAzimuths[] = {0, 0.4, 0.25 * kTwoPi, 2.5, 0.5 * kTwoPi, 5};
constexpr double kGridRadii[] = {0, 1e-3, 0.1, 0.5, 1, 2, 4, 9, 30};
constexpr double kGridAlphas[] = {1e-5, 1e-4, 1e-3, 0.01, 0.05, 0.1, 0.3, 0.5, 0.8, 1, 2, 10, 100};
constexpr double kGridCorrelations[] = {0, 0.5, -0.9, 0.9999, -0.9999, 1e-4};
constexpr double kGridMeans[] = {0, 0.1, -1, 3, -16};
constexpr double kGridMoments[] = {0, 1e-12, 5e-11, 1e-4, 0.02, 1, 256, 5e3};
constexpr double kGridExponents[] = {0, 0.5, 1, 2, 10, 100, 1e3, 1e4, 1e6, 1e8, 1e10, 2e10};
constexpr double kGridGammas[] = {1.55, 1.6, 1.8, 2, 2.5, 3, 5, 10, 30, 100, 1e3, 1e5, 1e7, 1e9, 1e10};
constexpr double kGridEtas[] = {1,    1.0003, 1.33, 1.5,      1.51,     2.42,     4,     1 / 1.0003, 1 / 1.33,
                                0.66, 0.41,   0.25, 1 + 1e-7, 1 - 1e-7, 1 + 1e-5, 1.001, 0.999,      1.1};
constexpr double kGridIndices[] = {0.05, 0.1, 0.25, 0.5, 0.9, 1 - 1e-7, 1, 1 + 1e-5, 1.5, 2.5, 4, 10};
constexpr double kGridKappas[] = {0, 1e-20, 1e-7, 1e-4, 0.01, 0.3, 1, 3, 10, 20};
constexpr double kGridK[] = {0, 0.18, 0.5, 1};
constexpr double kGridBodyIndices[] = {1, 1 + 0x1p-23, 1.00001, 1.0003, 1.01, 1.33, 1.5, 2.42, 4};
constexpr double kGridSigmas[] = {1e-3, 0.01, 0.05, 0.1, 0.17, 0.25, 0.3, 0.4, 0.5, 0.7, 1, 1.5, 2};
constexpr double kGridF0[] = {0, 1e-6, 0.04, 0.3, 0.9, 1 - 1e-7, 1};
constexpr double kGridLambdas[] = {0,   1e-40, 1e-8, 1e-3,           0.1, 0.5, 1, 3, 100,
                                   1e7, 1e19,  1e37, 0x1.fffffep+127};
constexpr double kGridOrders[] = {1, 2, 3, 4, 7};
constexpr double kGridU[] = {0,   0x1p-32, 0x1p-24, 0.05, 0.125, 0.25,     0.4,
                             0.5, 0.7,     0.75,    0.9,  0.999, kLargestU};

// A number in mixed radix, taken apart digit by digit.
class Digits {
 public:
  explicit Digits(std::uint64_t number = 0) : number_(number) {}
  std::size_t Take(std::size_t radix) {
    total_ *= radix;
    const std::size_t digit = number_ % radix;
    number_ /= radix;
    return digit;
  }
  template <std::size_t N>
  double Take(const double (&values)[N]) {
    return values[Take(N)];
  }
  std::uint64_t total() const { return total_; }

 private:
  std::uint64_t number_, total_ = 1;
};

Vector RoundedToFloats(Field first, Vector v) {
  return {Fit(first, v.x, Values::kFloats), Fit(static_cast<Field>(first + 1), v.y, Values::kFloats),
          Fit(static_cast<Field>(first + 2), v.z, Values::kFloats)};
}

Vector GridNormal(const Shape& shape, const Scene& scene, Digits& digits) {
  const double radius = digits.Take(kGridRadii), phi = digits.Take(kGridAzimuths);
  return Rough(shape, scene, radius * std::cos(phi), radius * std::sin(phi));
}

Vector GridDirection(Digits& digits) {
  const double cosine = digits.Take(kGridCosines);
  return FromCosine(cosine, digits.Take(kGridAzimuths));
}

Vector GridOutgoing(const Vector& wi, const Vector& facing, double eta, Digits& digits) {
  switch (digits.Take(9)) {
    case 0:
      return wi;
    case 1:
      return -wi;
    case 2:
      return GridDirection(digits);
    case 3:
    case 4:
    case 5:
      return Refracted(wi, facing, eta);
    default:
      return Mirrored(wi, facing);
  }
}

// The scene that a number stands for; every digit is taken, whatever the kernel uses.
Scene GridScene(const Shape& shape, Digits& digits) {
  Scene scene{};
  const auto take = [&](Field field, const auto& values) {
    if (shape.has[field]) scene[field] = Fit(field, digits.Take(values), Values::kFloats);
  };
  take(kAlpha, kGridAlphas);
  take(kAlphaX, kGridAlphas);
  take(kAlphaY, kGridAlphas);
  take(kRxy, kGridCorrelations);
  take(kMeanX, kGridMeans);
  take(kMeanY, kGridMeans);
  take(kMomentXx, kGridMoments);
  take(kMomentYy, kGridMoments);
  take(kMomentXy, kGridMoments);
  take(kExponent, kGridExponents);
  take(kEta, kGridEtas);
  take(kN, kGridIndices);
  take(kKappa, kGridKappas);
  take(kF0, kGridF0);
  take(kLambdaI, kGridLambdas);
  take(kLambdaO, kGridLambdas);
  take(kU1, kGridU);
  take(kU2, kGridU);
  take(kU3, kGridU);
  take(kU4, kGridU);
  take(kU5, kGridU);
  take(kOrder, kGridOrders);
  take(kK, kGridK);
  take(kM, kTableM);
  take(kIndex, kTableIndices);
  take(kTail, kTableTails);
  take(kNi, kGridBodyIndices);
  take(kSigma, kGridSigmas);
  take(kCosI, kGridCosines);
  take(kCosO, kGridCosines);
  if (shape.has[kX]) scene[kX] = -104 + 192.0 / 4096 * static_cast<double>(digits.Take(4097));
  if (shape.has[kA]) scene[kA] = 0x1p-8 * static_cast<double>(digits.Take(4097));
  take(kGamma, kGridGammas);
  if (shape.has[kTail]) scene[kGamma] = scene[kTail];
  if (shape.has[kMu]) {
    const std::size_t step = digits.Take(257);
    scene[kMu] = Fit(kMu, step == 0 ? 0 : std::exp2(0.25 * static_cast<double>(step) - 36), Values::kFloats);
  }
  Vector wi{0, 0, 1}, facing{0, 0, 1};
  if (shape.has[kVx] || shape.has[kWix]) wi = GridDirection(digits);
  const bool rough = shape.has[kAlpha] || shape.has[kAlphaX] || shape.has[kExponent] || shape.has[kSigma];
  if (shape.has[kMx] && shape.has[kVx] && !rough) {
    facing = GridDirection(digits);
  } else if (shape.has[kMx] || shape.pairs) {
    facing = GridNormal(shape, scene, digits);
  }
  if (wi.z < 0 && shape.has[kWix]) facing = -facing;
  wi = RoundedToFloats(kWix, wi);
  facing = RoundedToFloats(kMx, facing);
  Put(scene, kVx, wi);
  Put(scene, kWix, wi);
  Put(scene, kMx, facing);
  if (shape.pairs) {
    // Taken in any case, so that the number of digits does not depend on their values.
    Digits direction(digits.Take(std::size(kGridCosines) * std::size(kGridAzimuths) * 9));
    Put(scene, kWox,
        RoundedToFloats(kWox, GridOutgoing(wi, facing, scene[kEta] == 0 ? 1.5 : scene[kEta], direction)));
  }
  return scene;
}

// Collects the cases of one kernel.
class ExtremeMaker {
 public:
  explicit ExtremeMaker(const Shape& shape) : shape_(shape) {}

  std::vector<ExtremeCase> Make() {
    Roughness();
    Geometry();
    Interface();
    RandomNumbers();
    Rational();
    OffCentre();
    Conductor();
    Bodies();
    Azimuths();
    Cavity();
    Student();
    Angles();
    return std::move(cases_);
  }

 private:
  using List = std::initializer_list<double>;

  bool Has(std::initializer_list<Field> fields) const {
    return std::any_of(fields.begin(), fields.end(), [&](Field field) { return shape_.has[field]; });
  }

  static Scene Base() {
    Scene scene{};
    SetAlpha(scene, 0.3, 0.3);
    scene[kEta] = 1.5;
    scene[kN] = 0.2;
    scene[kKappa] = 3;
    scene[kF0] = 0.04;
    scene[kLambdaI] = 0.5;
    scene[kLambdaO] = 2;
    scene[kU1] = 0.4;
    scene[kU2] = 0.1;
    scene[kU3] = 0.5;
    scene[kU4] = 0.3;
    scene[kU5] = 0.7;
    scene[kCosI] = 0.8;
    scene[kCosO] = -0.9;
    scene[kX] = -1;
    scene[kA] = 1;
    scene[kMu] = 1;
    scene[kGamma] = 2.5;
    scene[kOrder] = 3;
    scene[kK] = 0.5;
    scene[kM] = 0.3f;
    scene[kIndex] = 1.7f;
    scene[kNi] = 1.5;
    scene[kTail] = 2.5;
    return scene;
  }

  static void SetAlpha(Scene& scene, double x, double y) {
    scene[kAlpha] = scene[kAlphaX] = static_cast<float>(x);
    scene[kAlphaY] = static_cast<float>(y);
    scene[kExponent] = x < 1 ? std::min(2 / (x * x) - 2, 2e10) : 0;
    scene[kSigma] = static_cast<float>(std::min(std::max(x / kRootTwo, 1e-3), 2.0));
  }

  // The scene as it stands; components and cosines need not be within the domain, but are floats.
  void Add(std::string_view row, std::string_view what, const Scene& scene) {
    ExtremeCase added{row, what, {}};
    for (std::size_t i = 0; i < shape_.count; ++i) added.in[i] = static_cast<float>(scene[shape_.field[i]]);
    if (seen_.emplace(row, added.in).second) cases_.push_back(added);
  }

  static Vector Single(const Vector& v) {
    return {static_cast<float>(v.x), static_cast<float>(v.y), static_cast<float>(v.z)};
  }

  // wi and the normal, with wo reflected and refracted in it.
  void AddPair(std::string_view row, std::string_view what, Scene scene, Vector wi, Vector m) {
    wi = Single(wi);
    const bool turn = shape_.has[kWix] && wi.z < 0;
    m = Single(turn ? -m : m);
    scene[kCosI] = Dot(wi, m);
    Put(scene, kVx, wi);
    Put(scene, kWix, wi);
    Put(scene, kMx, m);
    Put(scene, kWox, Mirrored(wi, m));
    Add(row, what, scene);
    Put(scene, kWox, Refracted(wi, m, scene[kEta]));
    Add(row, what, scene);
  }

  void AddAny(std::string_view row, std::string_view what, Scene scene, const Vector& wi, const Vector& wo) {
    const Vector h = wi + wo;
    Put(scene, kVx, wi);
    Put(scene, kWix, wi);
    Put(scene, kWox, wo);
    Put(scene, kMx, Dot(h, h) > 1e-12 ? Normalized(h) : Vector{0, 0, 1});
    Add(row, what, scene);
  }

  Vector Normal(const Scene& scene, double radius, double phi) const {
    return Rough(shape_, scene, radius * std::cos(phi), radius * std::sin(phi));
  }

  void AddLobe(std::string_view row, std::string_view what, const Scene& scene, List radii) {
    for (const double radius : radii) {
      for (const double phi : {0.0, 0.7, 0.25 * kTwoPi, 4.0}) {
        for (const double cosine : {1.0, 0.8, -0.8, 0.1}) {
          AddPair(row, what, scene, FromCosine(cosine, 0.3), Normal(scene, radius, phi));
        }
      }
    }
  }

  void Roughness() {
    if (!Has({kAlpha, kAlphaX, kExponent, kSigma})) return;
    Scene scene = Base();
    constexpr double kPairs[][2] = {{1e-5, 1e-5}, {1e-5, 1e-4}, {1e-4, 1e-4},
                                    {1e-3, 1e-5}, {1e-3, 1e-3}, {1, 1e-5}};
    for (const auto& pair : kPairs) {
      SetAlpha(scene, pair[0], pair[1]);
      AddLobe("alpha-product", "alpha_x alpha_y from 1e-10", scene, {0, 0.5, 1, 3});
    }
    for (const double alpha : {1e-3, 1e-4, 1e-5}) {
      SetAlpha(scene, alpha, alpha);
      for (const double phi : {0.0, 0.3, 1.0, 2.0, 3.5, 5.0}) {
        for (const double cosine : {1.0, 0.7, 0.2, -0.6}) {
          AddPair("alpha-peak", "theta_m = alpha", scene, FromCosine(cosine, 1),
                  FromCosine(std::cos(alpha), phi));
        }
      }
    }
    for (const double alpha : {1e-3, 1e-4, 1e-5}) {
      SetAlpha(scene, alpha, alpha);
      for (const double degrees : {30.0, 60.0, 80.0, 85.0, 89.0, 89.9}) {
        const Vector v = FromCosine(std::cos(degrees * kTwoPi / 360), 0.6);
        AddPair("lambda-small", "30 to 89.9 degrees", scene, v, {0, 0, 1});
        AddPair("lambda-small", "30 to 89.9 degrees", scene, -v, {0, 0, 1});
      }
    }
    for (const double alpha : {1e-5, 1e-2, 0.5, 1.0, 1e2}) {
      SetAlpha(scene, alpha, alpha);
      for (const double tiny : {0.0, 1e-42, 1e-38, 1e-20, 1e-10}) {
        for (const double side : {1.0, -1.0}) {
          AddPair("g1-normal", "v = n, or nearly so", scene, {tiny, -tiny, side}, {0, 0, 1});
          AddPair("g1-normal", "v = n, or nearly so", scene, {tiny, -tiny, side}, Normal(scene, 0.5, 1));
        }
      }
    }
    for (const double eta : {1.5, 1 / 1.5}) {
      SetAlpha(scene, 1e-6, 1e-6);
      scene[kEta] = eta;
      AddLobe("delta-limit", "alpha 1e-6", scene, {0, 0.5, 2});
    }
    scene = Base();
    for (const double alpha : {1.0, 1e2, 1e3}) {
      SetAlpha(scene, alpha, alpha);
      AddLobe("alpha-huge", "alpha 1, 1e2, 1e3", scene, {0, 1e-3, 0.3, 1, 3});
    }
    constexpr double kRatios[][2] = {{1e-2, 1e2}, {1e2, 1e-2}, {1e-4, 1},
                                     {1, 1e-4},   {1e-5, 0.1}, {0.1, 1e-5}};
    for (const auto& pair : kRatios) {
      SetAlpha(scene, pair[0], pair[1]);
      for (int k = 0; k < 32; ++k) {
        const double phi = kTwoPi * k / 32;
        for (const double radius : {0.1, 1.0, 3.0}) {
          AddPair("aniso-ratio", "alpha_x / alpha_y = 1e4", scene, FromCosine(0.6, phi),
                  Normal(scene, radius, phi));
          AddPair("aniso-ratio", "alpha_x / alpha_y = 1e4", scene, FromCosine(0.01, phi),
                  Normal(scene, radius, 1));
        }
      }
    }
  }

  // Unit vector with that cosine; at 0 and below the rounding of the sine, the horizon.
  static Vector AtHeight(double cosine, double phi) {
    Vector v = FromCosine(cosine, phi);
    v.z = cosine;
    return v;
  }

  void Geometry() {
    if (!Has({kMx, kVx, kWix, kCosI, kCosO})) return;
    Scene scene = Base();
    const List heights = {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-38, 1e-42, 0};
    for (const double alpha : {1e-5, 1e-3, 0.1, 1.0, 1e2}) {
      if (alpha != 0.1 && !Has({kAlpha, kAlphaX, kExponent, kSigma})) continue;
      SetAlpha(scene, alpha, alpha);
      for (const double height : heights) {
        for (const double side : {1.0, -1.0}) {
          const Vector wi = AtHeight(side * height, 0.2);
          scene[kCosI] = scene[kCosO] = side * height;
          AddPair("grazing", "one or both", scene, wi, {0, 0, 1});
          AddPair("grazing", "one or both", scene, wi, Normal(scene, 0.5, 1));
          AddPair("grazing", "one or both", scene, {0.6, 0, side * 0.8}, AtHeight(height, 1));
          for (const double phi : {0.2, 0.2001, 1.0, 3.0, 0.2 + 0.5 * kTwoPi}) {
            AddAny("grazing", "one or both", scene, wi, AtHeight(0.5, phi));
            AddAny("grazing", "one or both", scene, wi, AtHeight(-0.5, phi));
            AddAny("grazing", "one or both", scene, AtHeight(0.5, phi), wi);
            AddAny("grazing", "one or both", scene, wi, AtHeight(height, phi));
            AddAny("grazing", "one or both", scene, wi, AtHeight(-height, phi));
            AddAny("grazing", "one or both", scene, wi, AtHeight(height * 0.5, phi));
          }
          AddAny("retro-grazing", "wi = wo", scene, wi, wi);
        }
      }
    }
    scene = Base();
    for (const double eta : {1.5, 0.6, 1.0, 1.0003}) {
      scene[kEta] = eta;
      for (const double cosine : {1.0, 0.9, 0.3, 1e-3, 1e-7, -0.5}) {
        for (const double phi : {0.0, 0.4, 2.0}) {
          const Vector wi = Single(AtHeight(cosine, phi));
          scene[kCosI] = wi.z;
          scene[kCosO] = -wi.z;
          AddAny("opposite", "wi = -wo", scene, wi, -wi);
          AddAny("opposite", "wi = -wo, but for a float", scene, wi, {Floats(-wi.x, 1), -wi.y, -wi.z});
        }
      }
    }
    scene = Base();
    for (const double wi_z : {0.8, 0.05, -0.8, -0.05}) {
      for (const double wo_z : {0.6, 0.02, -0.6, -0.02}) {
        for (const double phi : {0.0, 1.0, 3.0}) {
          const Vector wi = AtHeight(wi_z, 0), wo = AtHeight(wo_z, phi);
          for (const double alpha : {0.05, 1.0}) {
            SetAlpha(scene, alpha, alpha);
            for (const double eta : {1.5, 0.7}) {
              scene[kEta] = eta;
              AddAny("below", "every pair of sides", scene, wi, wo);
              // The normal on one side of v, the surface on the other.
              Put(scene, kMx, FromCosine(0.1, 2));
              Put(scene, kVx, wi);
              Put(scene, kWix, wi);
              Put(scene, kWox, wo);
              Add("below", "micro and macro side disagree", scene);
            }
          }
        }
      }
    }
    scene = Base();
    for (const double alpha : {1e-5, 0.3, 1.0}) {
      SetAlpha(scene, alpha, alpha);
      for (const double cosine : {1.0, 0.9, 0.5, 0.1, 1e-3, 1e-6, -0.7}) {
        for (const double eta : {1.5, 0.8, 4.0}) {
          scene[kEta] = eta;
          const Vector wi = Single(AtHeight(cosine, 0.9));
          AddAny("parallel-half", "h = n", scene, wi, {-wi.x, -wi.y, wi.z});
          AddPair("parallel-half", "h = n", scene, wi, {0, 0, 1});
          AddPair("parallel-half", "h = n", scene, Turned(wi, 1), {0, 0, 1});
        }
      }
    }
    scene = Base();
    for (const double off : {-1e-3, 1e-3, -4e-7, 4e-7, 1e-7}) {
      for (const double cosine : {1.0, 0.99999, 0.7, 0.1, 1e-4, -0.7}) {
        for (const double alpha : {1e-3, 0.3}) {
          SetAlpha(scene, alpha, alpha);
          const Vector wi = AtHeight(cosine, 0.7), m = Normal(scene, 0.7, 2);
          AddPair("not-unit", "lengths off by 1e-3 and by a few roundings", scene, (1 + off) * wi, m);
          AddPair("not-unit", "lengths off by 1e-3 and by a few roundings", scene, wi, (1 + off) * m);
          AddAny("not-unit", "lengths off by 1e-3 and by a few roundings", scene, (1 + off) * wi,
                 (1 - 2 * off) * Mirrored(wi, m));
        }
      }
    }
  }

  // Where the index matters: cosines and pairs at each of them.
  void AddInterface(std::string_view row, std::string_view what, const Scene& scene) {
    for (const double cosine : {1.0, 0.9, 0.6, 0.3, 0.05, 1e-3, 1e-6, -0.4}) {
      for (const double radius : {0.0, 0.5, 1.5}) {
        AddPair(row, what, scene, AtHeight(cosine, 0.5), Normal(scene, radius, 2));
      }
    }
    Scene both = scene;
    for (const double cosine : {1.0, 0.7, 0.2, 0.01, -0.6}) {
      both[kCosI] = cosine;
      for (const double other : {-1.0, -0.8, -0.1, 0.5}) {
        both[kCosO] = other;
        Add(row, what, both);
      }
      const double g2 = (scene[kEta] - 1) * (scene[kEta] + 1) + cosine * cosine;
      if (g2 > 0) {
        both[kCosO] = -std::copysign(std::sqrt(g2), cosine) / scene[kEta];
        Add(row, what, both);
      }
    }
  }

  void Interface() {
    if (!shape_.has[kEta]) return;
    Scene scene = Base();
    for (const double alpha : {0.01, 0.5}) {
      SetAlpha(scene, alpha, alpha);
      for (const double step : {0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2}) {
        for (const double sign : {1.0, -1.0}) {
          scene[kEta] = static_cast<float>(1 + sign * step);
          AddInterface("eta-one", "1, and 1 +- 1e-7 to 1e-2", scene);
        }
      }
      for (const double eta : {1.0003, 2.42, 4.0}) {
        scene[kEta] = static_cast<float>(eta);
        AddInterface("eta-extreme", "air, diamond, germanium", scene);
        scene[kEta] = static_cast<float>(1 / eta);
        AddInterface("eta-extreme", "air, diamond, germanium, inverse", scene);
      }
      for (const double eta : {1.2, 1.5, 3.0}) {
        scene[kEta] = static_cast<float>(eta);
        AddInterface("order-of-eta", "both orders", scene);
        scene[kEta] = static_cast<float>(1 / eta);
        AddInterface("order-of-eta", "both orders", scene);
      }
      for (const double eta : {1.33, 0.75}) {
        scene[kEta] = static_cast<float>(eta);
        AddInterface("transport", "either transport", scene);
      }
    }
    TotalReflection();
  }

  void TotalReflection() {
    Scene scene = Base();
    for (const double alpha : {0.01, 0.2, 1.0}) {
      SetAlpha(scene, alpha, alpha);
      for (const double eta : {0.25, 1 / 2.42, 1 / 1.5, 0.75, 0.9, 0.999, 0.99999, 1 - 0x1p-23}) {
        scene[kEta] = static_cast<float>(eta);
        const double n = scene[kEta], critical = std::sqrt((1 - n) * (1 + n));
        for (int steps = -4; steps <= 4; ++steps) {
          const double c = Floats(critical, steps);
          scene[kCosI] = c;
          scene[kCosO] = steps == 0 ? 0 : -std::sqrt(std::max(c * c - critical * critical, 0.0)) / n;
          Add("tir-edge", "within floats of the critical angle", scene);
          for (const double radius : {0.0, 0.5, 1.0}) {
            for (const double side : {1.0, -1.0}) {
              Vector m = shape_.samples ? SampledNormal(shape_, scene) : Normal(scene, radius, 0.8);
              m = side * Single(m);
              const Vector wi = Single(AtCosine(m, c, FromCosine(0.1, 3)));
              if (wi.z * side <= 0) continue;
              Scene pair = scene;
              Put(pair, kVx, wi);
              Put(pair, kWix, wi);
              Put(pair, kMx, m);
              Put(pair, kWox, Mirrored(wi, m));
              Add("tir-edge", "within floats of the critical angle", pair);
              Put(pair, kWox, Refracted(wi, m, n));
              Add("tir-edge", "within floats of the critical angle", pair);
            }
          }
        }
        for (const double fraction : {0.9, 0.5, 0.1}) {
          for (const double side : {1.0, -1.0}) {
            AddPair("half-outward", "from inside, beyond the critical angle", scene,
                    AtHeight(side * fraction * critical, 0.5), Normal(scene, 0.3, 1));
          }
        }
      }
    }
  }

  // The cumulative function of Beckmann's visible slopes from a = 0 to infinity, from its one end to the
  // other.
  void InvertBeckmann(Scene scene) {
    for (const double alpha : {0.01, 1.0}) {
      SetAlpha(scene, alpha, alpha);
      for (const double a :
           {0.0, 1e-42, 1e-6, 1e-2, 0.059, 0.061, 0.3, 0.99, 1.01, 1.6, 2.5, 4.0, 7.0, 30.0, 1e4, 1e12}) {
        const double tangent = 1 / (alpha * a), cosine = a == 0 ? 0 : 1 / std::sqrt(1 + tangent * tangent);
        const double sine = a == 0 ? 1 : 1 / std::sqrt(1 + 1 / (tangent * tangent));
        for (const double side : {1.0, -1.0}) {
          const Vector view = Single({0.6 * sine, -0.8 * sine, side * cosine});
          Put(scene, kVx, view);
          Put(scene, kWix, view);
          for (const double u1 : {0.0, 0x1p-126, 0x1p-60, 0x1p-24, 1e-3, 0.3, 0.5, 0.7, 0.95, 0.999, 0.99999,
                                  1 - 0x1p-22, kLargestU}) {
            scene[kU1] = u1;
            scene[kU2] = side > 0 ? 0.3 : 0x1.fffff8p-1;
            Add("beckmann-invert", "from one end of the visible slopes to the other", scene);
          }
        }
      }
    }
  }

  void RandomNumbers() {
    if (!shape_.has[kU1]) return;
    Scene scene = Base();
    const List edges = {0, 0x1p-149, 0x1p-32, 0x1p-24, 0.25, 0.5, 1 - 0x1p-23, kLargestU};
    std::vector<double> heights = {1, 0.3, 1e-4, -0.7};
    if (shape_.visible) heights.insert(heights.end(), {-1, -1e-4, 1e-42, 0});
    for (const double alpha : {1e-5, 0.1, 1.0, 1e2}) {
      SetAlpha(scene, alpha, alpha);
      for (const double wi_z : heights) {
        const Vector wi = AtHeight(wi_z, 1);
        Put(scene, kVx, wi);
        Put(scene, kWix, wi);
        scene[kCosI] = wi_z;
        for (const double u1 : edges) {
          for (const double u2 : edges) {
            scene[kU1] = u1;
            scene[kU2] = u2;
            for (const double u3 : {0.0, 0x1p-32, 0.3, kLargestU}) {
              if (!shape_.has[kU3] && u3 != 0) continue;
              scene[kU3] = u3;
              Add("u-edges", "the boundary of the unit square", scene);
            }
          }
        }
      }
    }
    if (shape_.visible && shape_.distribution == Distribution::kBeckmann) InvertBeckmann(scene);
    if (!shape_.samples) return;
    // Tails of the density: a tiny density times a large Jacobian.
    for (const double alpha : {1e-5, 1e-3, 0.5}) {
      SetAlpha(scene, alpha, alpha);
      for (const double wi_z : {1.0, 1e-2, 1e-5, 1e-7, -1e-3}) {
        Put(scene, kWix, AtHeight(wi_z, 2));
        for (const double u1 : {0x1p-24, 0.5, 0.999, kLargestU}) {
          for (const double u2 : {0.1, 0.32, 0.7}) {
            for (const double u3 : {0.0, 0.5, kLargestU}) {
              scene[kU1] = u1;
              scene[kU2] = u2;
              scene[kU3] = u3;
              Add("pdf-zero", "a sample's own density", scene);
              Add("weight-ratio", "weight where value and density are tiny", scene);
            }
          }
        }
      }
    }
  }

  // Mean slopes that push the side seen below the horizon, or just onto it.
  void OffCentre() {
    if (!shape_.has[kRxy]) return;
    Scene scene = Base();
    for (const double alpha : {1e-5, 0.01, 0.3, 10.0}) {
      SetAlpha(scene, alpha, alpha * 0.5);
      for (const double r : {0.0, 0.7, -0.9999}) {
        scene[kRxy] = static_cast<float>(r);
        for (const double mean : {0.1, 1.0, 16.0}) {
          scene[kMeanX] = static_cast<float>(mean);
          scene[kMeanY] = static_cast<float>(-0.5 * mean);
          for (const double height : {0.3, 1e-3, 1e-6, 0.0, -1e-6, -1e-3, -0.3}) {
            for (const double phi : {0.0, 1.0, 2.5, 4.0}) {
              // Seen at that height over the mesosurface.
              const Vector unit{std::cos(phi), std::sin(phi), height};
              const Vector v = FromUnitView(shape_, scene, unit);
              for (const double radius : {0.0, 0.5, 2.0}) {
                Scene seen = scene;
                Put(seen, kVx, Single(v));
                Put(seen, kMx, Single(Normal(scene, radius, 1)));
                Add("off-centre", "views about the horizon of the mesosurface", seen);
              }
            }
          }
        }
      }
    }
  }

  // Dielectrics as conductors, their critical angles and indices near 1; weak and strong absorption; silver.
  void Conductor() {
    if (!shape_.has[kN]) return;
    Scene scene = Base();
    for (const double n :
         {0.05, 0.25, 0.5, 1 / 1.5, 0.999, 1 - 0x1p-23, 1.0, 1 + 0x1p-23, 1.0003, 1.5, 4.0, 10.0}) {
      scene[kN] = static_cast<float>(n);
      for (const double kappa : {0.0, 1e-42, 1e-20, 1e-10, 1e-7, 1e-4, 0.1, 1.0, 10.0, 20.0}) {
        scene[kKappa] = static_cast<float>(kappa);
        std::vector<double> cosines = {1, 0.9, 0.5, 0.1, 1e-3, 1e-7, 1e-38, 1e-42, 0, -0.7};
        if (n < 1) {
          const double critical = std::sqrt((1 - scene[kN]) * (1 + scene[kN]));
          for (int steps = -3; steps <= 3; ++steps) cosines.push_back(Floats(critical, steps));
          cosines.push_back(0.5 * critical);
        }
        for (const double cosine : cosines) {
          scene[kCosI] = cosine;
          if (!shape_.has[kWix]) {
            Add("conductor", "k = 0 to 20, n = 0.05 to 10", scene);
            continue;
          }
          const Vector m = shape_.samples ? SampledNormal(shape_, scene) : Normal(scene, 0.5, 0.8);
          AddPair("conductor", "k = 0 to 20, n = 0.05 to 10", scene,
                  AtCosine(Single(m), cosine, FromCosine(0.1, 3)), m);
        }
      }
    }
  }

  // Means of F, and what is left of a body, next to no interface at all and under every other.
  void Bodies() {
    const bool mean = shape_.count == 1 && shape_.has[kEta];
    if (!mean && !shape_.has[kNi]) return;
    Scene scene = Base();
    for (const double step : {0.0, 0x1p-23, 0x1p-22, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1, 0.5, 1.42, 3.0}) {
      for (const double n : {1 + step, 1 - std::min(step, 0.75)}) {
        scene[kEta] = n;
        scene[kNi] = std::max(n, 1.0);
        if (mean) {
          Add("mean-fresnel-one", "n = 1, and from 1 +- 2^-23 to 4 and 1/4", scene);
          continue;
        }
        for (const double k : {0.0, 0x1p-149, 0.5, 1 - 0x1p-24, 1.0}) {
          scene[kK] = k;
          for (const double cos_i : {1.0, 0.3, 1e-3, 1e-7, 0x1p-149, 0.0, -0.5}) {
            for (const double cos_o : {1.0, 0.2, 1e-7, 0x1p-149}) {
              scene[kCosI] = cos_i;
              scene[kCosO] = cos_o;
              Put(scene, kWix, AtHeight(cos_i, 0.5));
              Put(scene, kWox, AtHeight(cos_o, 2));
              Add("mean-fresnel-one", "n = 1, and from 1 + 2^-23 to 4, k = 0 to 1", scene);
            }
          }
        }
      }
    }
  }

  // Azimuths equal, opposite and on either side of both, and of normal incidence; Lambda of every size.
  void Azimuths() {
    if (!shape_.has[kWix] || shape_.has[kWiz]) return;
    Scene scene = Base();
    const double half = 0.5 * kTwoPi;
    for (const double from : {0.0, 1.0, 0.5 * half, 3.0, half, -3.0, -0.5 * half, -1e-4}) {
      for (const double by :
           {0.0, 1e-7, 1e-3, 0.25 * half, 0.5 * half, 3.1, half, half + 1e-6, half + 0.3, 1.9 * half}) {
        for (const double sine : {1.0, 0.3, 1e-3, 1e-20, 1e-42, 0.0}) {
          scene[kWix] = sine * std::cos(from);
          scene[kWiy] = sine * std::sin(from);
          scene[kWox] = 0.8 * std::cos(from + by);
          scene[kWoy] = 0.8 * std::sin(from + by);
          for (const double lambda_i : {0.0, 0.3, 1e30, 0x1.fffffep+127}) {
            for (const double lambda_o : {0.0, 2.0, 0x1.fffffep+127}) {
              scene[kLambdaI] = lambda_i;
              scene[kLambdaO] = lambda_o;
              Add("azimuth-wrap", "differences of 0 to 2 pi", scene);
            }
          }
        }
      }
    }
  }

  // Views and normals within floats of v.m = 2 mz vz, where the two branches of the V-cavity form meet.
  void Cavity() {
    const bool of_normal = shape_.has[kVx] && shape_.has[kMx];
    if (!(of_normal && !Has({kAlpha, kAlphaX, kExponent, kSigma})) &&
        !(shape_.v_cavity && (of_normal || shape_.pairs))) {
      return;
    }
    Scene scene = Base();
    SetAlpha(scene, 0.5, 0.5);
    for (const double mz : {0.99, 0.8, 0.5, 0.2, 0.01}) {
      for (const double phi : {0.0, 0.6, 1.9, 3.0}) {
        const Vector m = Single(FromCosine(mz, phi));
        for (const double azimuth : {0.0, 0.3, 2.0, 4.0}) {
          // tan(theta) (cos(azimuth) m.x + sin(azimuth) m.y) = m.z
          const double along = std::cos(azimuth) * m.x + std::sin(azimuth) * m.y;
          if (along <= 0) continue;
          const double tangent = m.z / along;
          for (int steps = -3; steps <= 3; ++steps) {
            for (const double side : {1.0, -1.0}) {
              Vector v = side * Single(FromSlopes(tangent * std::cos(azimuth), tangent * std::sin(azimuth)));
              v.z = Floats(v.z, steps);
              Put(scene, kVx, v);
              Put(scene, kMx, m);
              Put(scene, kWix, v);
              Put(scene, kWox, Single(Mirrored(v, side * m)));
              Add("vcavity-kink", "v.m = 2 mz vz, within floats", scene);
            }
          }
        }
      }
    }
  }

  // Gaussians of the angle: the ends of sigma and beyond, the peak, tails down to nothing, and the horizon.
  void Angles() {
    if (!shape_.has[kSigma]) return;
    Scene scene = Base();
    for (const double sigma : {-1.0, 0.0, 0x1p-149, 1e-5, Floats(1e-3, -1), 1e-3, Floats(1e-3, 1), 0.01, 0.1,
                               0.2, 0.25, 0.5, 1.0, Floats(2, -1), 2.0, Floats(2, 1), 3.0, 1e30}) {
      scene[kSigma] = sigma;
      const bool narrow = sigma < 0.05;
      const std::string_view row = narrow ? "delta-limit" : "alpha-huge";
      const std::string_view what = narrow ? "sigma 1e-3 and below" : "sigma 0.1 to 2 and above";
      if (shape_.count == 1) Add(row, what, scene);
      for (const double u1 : {0.0, 0x1p-149, 1e-10, 0.3, 0.9, 1 - 0x1p-12, kLargestU}) {
        scene[kU1] = u1;
        if (shape_.has[kU1]) Add(row, what, scene);
      }
      if (!shape_.has[kMx]) continue;
      const double unit = std::min(std::max(sigma, 1e-3), 2.0);
      for (const double cosine : {1.0, 0.3, 1e-3, 1e-7, 0.0, -0.5}) {
        const Vector v = Single(AtHeight(cosine, 0.3));
        Put(scene, kVx, v);
        for (const double radius : {0.0, 1e-20, 1e-3, 0.5, 1.0, 3.0, 8.0, 13.0, 14.2, 30.0}) {
          const double theta = std::min(radius * unit, 1.57);
          Put(scene, kMx, Single({0.6 * std::sin(theta), -0.8 * std::sin(theta), std::cos(theta)}));
          Add(row, what, scene);
        }
        for (const double height : {1e-3, 1e-7, 1e-20, 1e-38, 1e-42, 0.0, -0.1}) {
          Put(scene, kMx, Single(AtHeight(height, 1)));
          Add("grazing", "normals at the horizon", scene);
        }
      }
    }
  }

  // Every gamma from grazing to the normal, where a heavy tail leaves Lambda's bits as a power of mu alone.
  void Student() {
    if (!shape_.has[kGamma] && !shape_.has[kTail]) return;
    Scene scene = Base();
    for (const double gamma : {1.55, 1.7, 2.0, 2.5, 4.0, 30.0, 1e3, 1e6, 1e10}) {
      scene[kGamma] = scene[kTail] = static_cast<float>(gamma);
      for (const double mu :
           {0.0, 1e-42, 1e-20, 1e-10, 1e-6, 1e-5, 1e-3, 0.1, 1.0, 3.0, 30.0, 1e3, 1e7, 1e12, 1e18, 0x1p60}) {
        scene[kMu] = mu;
        for (const double alpha : {1e-5, 0.3, 1e2}) {
          SetAlpha(scene, alpha, 0.5 * alpha);
          const double slope = 1 / (mu * alpha * std::sqrt(gamma - 1));
          for (const double side : {1.0, -1.0}) {
            const Vector v = mu == 0 ? Vector{0.6, -0.8, 0} : FromSlopes(0.6 * slope, -0.8 * slope);
            Put(scene, kVx, Single(side * v));
            Add("lambda-small", "Student-T slopes from grazing to the normal", scene);
          }
        }
      }
    }
    if (Has({kAlpha, kAlphaX})) StudentTails();
  }

  // Normals and random numbers from the middle of the lobe to its ends, for the longest tails, GGX and both
  // sides of it, and what is next to Beckmann.
  void StudentTails() {
    Scene scene = Base();
    for (const double gamma : {1.55, 1.9999, 2.0, 2.0001, 4.0, 50.0, 1e4, 0x1p24, 1e10}) {
      scene[kGamma] = scene[kTail] = static_cast<float>(gamma);
      for (const double alpha : {1e-5, 0.3, 1.0, 1e2}) {
        SetAlpha(scene, alpha, 0.5 * alpha);
        for (const double cosine : {1.0, 0.5, 1e-3, 1e-7, 0.0, -0.5}) {
          const Vector v = AtHeight(cosine, 0.3);
          for (const double radius : {0.0, 1e-4, 0.5, 1.0, 3.0, 8.0, 10.0, 30.0, 1e3, 1e7}) {
            if (shape_.has[kU1]) continue;
            Put(scene, kVx, Single(v));
            Put(scene, kMx, Single(Normal(scene, radius, 0.3 + radius)));
            Add("gamma-ends", "gamma 1.55 to 1e10, from the normal to the horizon", scene);
          }
          for (const double u1 : {0.0, 0x1p-149, 0x1p-24, 1e-3, 0.3, 0.9, 0.999, 1 - 0x1p-20, kLargestU}) {
            if (!shape_.has[kU1]) continue;
            Put(scene, kVx, Single(v));
            scene[kU1] = u1;
            Add("gamma-ends", "gamma 1.55 to 1e10, from the normal to the horizon", scene);
          }
        }
      }
    }
  }

  // a = 1.6 +- a few floats, where Walter's rational G1 reaches 1.
  void Rational() {
    if (!shape_.has[kVx]) return;
    Scene scene = Base();
    for (const double alpha : {1e-4, 0.1, 0.7, 10.0}) {
      SetAlpha(scene, alpha, alpha);
      const double roughness = RoughnessX(shape_, scene);
      for (const double a : {1.5, 1.58, 1.595, 1.599, 1.6 - 1e-6, 1.6, 1.6 + 1e-6, 1.601, 1.7}) {
        for (const double side : {1.0, -1.0}) {
          const double tangent = 1 / (a * roughness);
          AddPair("rational-over-one", "a near 1.6", scene, side * FromSlopes(tangent * 0.6, tangent * 0.8),
                  {0, 0, 1});
          AddPair("rational-over-one", "a near 1.6", scene, side * FromSlopes(tangent, 0), {0, 0, 1});
        }
      }
    }
  }

  const Shape& shape_;
  std::vector<ExtremeCase> cases_;
  std::set<std::pair<std::string_view, Point>> seen_;
};

// The same for some lanes that follow each other, as a call takes one object for all. Orders are mostly low,
// for a sum has 3 order^2 terms.
PreparedValues PreparedValuesOf(std::uint64_t seed, std::uint64_t index) {
  Random random(seed ^ 0x0DE4, index / 32);
  const double u = random.Uniform();
  const double order = u < 0.9     ? 1 + random.Index(5)
                       : u < 0.985 ? 6 + random.Index(4)
                                   : 10 + random.Index(23);
  const auto pick = [&](const auto& values) {
    return static_cast<double>(static_cast<float>(values[random.Index(static_cast<int>(std::size(values)))]));
  };
  const double m = pick(kTableM);
  const double ratio = pick(kTableIndices);
  return {order, m, ratio, pick(kTableTails)};
}

}  // namespace

RandomPoints::RandomPoints(std::size_t kernel, std::uint64_t seed, Values values)
    : kernel_(kernel), seed_(seed + SeedOf(kKernels[kernel].id)), values_(values) {}

Point RandomPoints::operator()(std::uint64_t index) const {
  Random random(seed_, index);
  const Shape& shape = Shapes()[kernel_];
  return Cut(shape, SceneMaker(shape, random, values_, PreparedValuesOf(seed_, index)).Make(), values_);
}

std::vector<Point> GridPoints(std::size_t kernel, std::size_t count) {
  const Shape& shape = Shapes()[kernel];
  Digits all;
  GridScene(shape, all);
  const std::uint64_t total = all.total();
  const std::uint64_t points = std::min<std::uint64_t>(count, total);
  // Steps by the golden section, which no radix divides evenly.
  std::uint64_t stride =
      total == points ? 1 : static_cast<std::uint64_t>(0.6180339887 * static_cast<double>(total)) | 1;
  while (std::gcd(stride, total) != 1) stride += 2;
  std::vector<Point> grid;
  for (std::uint64_t i = 0, number = 0; i < points; ++i, number = (number + stride) % total) {
    Digits digits(number);
    grid.push_back(Cut(shape, GridScene(shape, digits), Values::kFloats));
  }
  return grid;
}

std::vector<ExtremeCase> ExtremeCases(std::size_t kernel) { return ExtremeMaker(Shapes()[kernel]).Make(); }

Point Perturbed(std::size_t kernel, const Point& in, Random& random, Values values) {
  const Shape& shape = Shapes()[kernel];
  const auto step = [&](double x) {
    const int steps = static_cast<int>(random.Sign()) * (1 + random.Index(4));
    return values == Values::kFloats ? Floats(x, steps) : Doubles(x, steps);
  };
  Point out = in;
  const int changes = 1 + random.Index(3);
  for (int change = 0; change < changes; ++change) {
    const int k = random.Index(static_cast<int>(shape.count));
    const Field field = shape.field[k];
    if (!IsDirection(field) || !shape.has[field - field % 3 + 2]) {
      const double x =
          random.Chance(0.6) ? step(out[k]) : out[k] * (1 + random.Sign() * random.LogUniform(1e-7, 0.1));
      out[k] = Fit(field, x, values);
      continue;
    }
    double* v = &out[k - field % 3];
    const Field first = static_cast<Field>(field - field % 3);
    Vector moved{v[0], v[1], v[2]};
    if (random.Chance(0.6)) {
      (field % 3 == 0 ? moved.x : field % 3 == 1 ? moved.y : moved.z) = step(out[k]);
    } else {
      const double distance = random.LogUniform(1e-7, 0.1);
      moved =
          moved + distance * Vector{random.Uniform() - 0.5, random.Uniform() - 0.5, random.Uniform() - 0.5};
      moved = Normalized(moved);
    }
    const double fitted[] = {Fit(first, moved.x, values), Fit(static_cast<Field>(first + 1), moved.y, values),
                             Fit(static_cast<Field>(first + 2), moved.z, values)};
    const double length2 = fitted[0] * fitted[0] + fitted[1] * fitted[1] + fitted[2] * fitted[2];
    if (std::abs(length2 - 1) < 1e-6) std::copy(fitted, fitted + 3, v);
  }
  return out;
}

}  // namespace microlane
