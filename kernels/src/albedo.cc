#include "microlane/albedo.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "microlane/material.h"
#include "src/legendre.h"

namespace microlane {
namespace {

constexpr double kPi = 3.14159265358979323846;

// ---- Facets and slopes ----

double Reflectance(const SpecularLobe& lobe, double c) {
  if (lobe.facets == Reflector::kMirror) return 1;
  if (lobe.facets == Reflector::kSchlick) {
    const double x = 1 - c, x2 = x * x;
    return lobe.f0 + (1 - lobe.f0) * x2 * x2 * x;
  }
  // conductor-inl.h
  const double n = lobe.n, kappa2 = lobe.kappa * lobe.kappa, s2 = (1 - c) * (1 + c);
  const double below = (n - 1) * (n - 1) + kappa2, above = (n + 1) * (n + 1) + kappa2;
  if (below == 0) return 0;
  const double t = (n - 1) * (n + 1) - kappa2 + c * c, twice = 2 * n * lobe.kappa;
  const double modulus = std::sqrt(t * t + twice * twice);
  const double re = t < 0 ? twice / std::sqrt(2 * (modulus - t)) : std::sqrt((modulus + t) / 2);
  const double cross = 2 * c * re, sum2 = modulus + c * c + cross, squares = modulus * c * c + s2 * s2;
  return below * above * squares / (sum2 * sum2 * (squares + cross * s2));
}

// The slopes' alpha, or that of Phong's, whose slopes are Student-T.
double Width(const SpecularLobe& lobe) {
  return lobe.normals == Normals::kPhong ? std::sqrt(2 / (lobe.roughness + 2)) : lobe.roughness;
}

// Density of slopes at the square of their length.
double SlopeDensity(const SpecularLobe& lobe, double width2, double r2) {
  const double q = r2 / width2;
  const double shape = lobe.normals == Normals::kGgx        ? 1 / ((1 + q) * (1 + q))
                       : lobe.normals == Normals::kBeckmann ? std::exp(-q)
                                                            : std::pow(1 + r2, -0.5 * lobe.roughness - 2);
  return shape / (kPi * width2);
}

// In widths: the radius that 1.5e-6 of the slopes are beyond, and how far lines of constant slope x are
// followed, in their widths LineWidth.
double Reach(const SpecularLobe& lobe) {
  return lobe.normals == Normals::kGgx ? 800
         : lobe.normals == Normals::kBeckmann
             ? 3.7
             : std::sqrt(std::pow(1.5e-6, -2 / (lobe.roughness + 2)) - 1) / Width(lobe);
}
double LineReach(const SpecularLobe& lobe) {
  return lobe.normals == Normals::kGgx ? 80
         : lobe.normals == Normals::kBeckmann
             ? 3.7
             : std::sqrt(std::pow(1.5e-6, -2 / (lobe.roughness + 3)) - 1) / Width(lobe);
}
double LineWidth(const SpecularLobe& lobe, double width, double x) {
  return lobe.normals == Normals::kGgx        ? std::sqrt(width * width + x * x)
         : lobe.normals == Normals::kBeckmann ? width
                                              : width * std::sqrt(1 + x * x);
}

// z Lambda(z) of Smith's, Heitz 2014 Eqs. 69, 72.
double CosineLambda(const SpecularLobe& lobe, double z) {
  const double s2 = std::max(0.0, (1 - z) * (1 + z)), b = lobe.roughness * std::sqrt(s2);
  if (b == 0) return 0;
  if (lobe.normals == Normals::kGgx) return 0.5 * b * b / (z + std::sqrt(z * z + b * b));
  const double a = z / b;
  return 0.5 * (b / std::sqrt(kPi) * std::exp(-a * a) - z * std::erfc(a));
}

// The cosine next to which F falls from 1 at grazing.
double ReflectanceScale(const SpecularLobe& lobe) {
  const bool falls = lobe.facets == Reflector::kConductor && lobe.kappa == 0 && lobe.n > 1;
  return falls ? std::sqrt((lobe.n - 1) * (lobe.n + 1)) : 1;
}

// ---- Quadrature ----

// kBefore and kBehind nodes on either side of x = 0, kLine on a line.
template <std::size_t kBefore, std::size_t kBehind, std::size_t kLine>
class Integral {
 public:
  Integral(const SpecularLobe& lobe, double mu)
      : lobe_(lobe),
        mu_(mu),
        sine_(std::sqrt((1 - mu) * (1 + mu))),
        width_(Width(lobe)),
        reach_(Reach(lobe) * width_),
        line_reach_(LineReach(lobe)),
        cosine_lambda_(lobe.masking == LobeMasking::kKelemen ? 0 : CosineLambda(lobe, mu)) {}

  double operator()() const {
    static const LegendreRule<kBefore> before;
    static const LegendreRule<kBehind> behind;
    double sum = 0;
    // x = -width sinh(v) down to the edge of the disc, where the line's length goes to 0 as a root.
    const double edge = std::min(mu_ / (1 + sine_), reach_), least = std::asinh(edge / width_);
    if (edge > 0) {
      for (std::size_t i = 0; i < before.t.size(); ++i) {
        const double t = before.t[i], v = least * (1 - t * t);
        sum += before.weight[i] * 2 * t * least * width_ * std::cosh(v) * Line(-width_ * std::sinh(v));
      }
    }
    // x = unit (e^v - 1) up to the other edge; unit is the least of what the slopes, F and Kelemen's 1/(mu +
    // sine x) vary over.
    const double far = mu_ > 0 ? std::min((1 + sine_) / mu_, reach_) : reach_;
    const double varies = std::min(width_, ReflectanceScale(lobe_));
    const double unit = mu_ > 0 && mu_ < sine_ * varies ? mu_ / sine_ : varies;
    const double most = std::log1p(far / unit);
    for (std::size_t i = 0; i < behind.t.size(); ++i) {
      const double t = behind.t[i], v = most * (1 - t * t);
      sum += behind.weight[i] * 2 * t * most * unit * std::exp(v) * Line(unit * std::expm1(v));
    }
    return sum;
  }

 private:
  // The facets of slope x: y = width sinh(v) of the line, both signs of y together.
  double Line(double x) const {
    static const LegendreRule<kLine> nodes;
    const double u = mu_ + sine_ * x;  // wi.m over cos(theta_m)
    const double width = LineWidth(lobe_, width_, x);
    double y = line_reach_ * width;
    if (mu_ > 0) {
      const double y2 = 2 * u / mu_ - 1 - x * x;
      if (!(y2 > 0)) return 0;
      y = std::min(y, std::sqrt(y2));
    }
    const double most = std::asinh(y / width);
    double sum = 0;
    for (std::size_t i = 0; i < nodes.t.size(); ++i) {
      const double e = std::exp(most * nodes.t[i]), slope_y = 0.5 * width * (e - 1 / e);
      const double r2 = x * x + slope_y * slope_y, cos_m = 1 / std::sqrt(1 + r2);
      const double jacobian = 0.5 * width * (e + 1 / e);
      sum += nodes.weight[i] * jacobian * SlopeDensity(lobe_, width_ * width_, r2) * Facet(u, r2, cos_m);
    }
    return 2 * most * sum;
  }

  // F times wo.z/(wi.m) of Kelemen's lobe, or times G2 (wi.m)/(cos(theta_m) mu).
  double Facet(double u, double r2, double cos_m) const {
    const double c = std::min(1.0, u * cos_m), z = 2 * u * cos_m * cos_m - mu_;
    if (!(z > 0)) return 0;
    const double f = Reflectance(lobe_, c);
    if (lobe_.masking == LobeMasking::kKelemen) return f * cos_m * (2 - mu_ * (1 + r2) / u);
    const double in = mu_ + cosine_lambda_, out = CosineLambda(lobe_, std::min(1.0, z));
    if (lobe_.masking == LobeMasking::kSeparable) return f * u * z / (in * (z + out));
    return f * u * z / (z * in + mu_ * out);
  }

  const SpecularLobe& lobe_;
  double mu_, sine_, width_, reach_, line_reach_, cosine_lambda_;
};

// ---- Parameters ----

std::string Check(const SpecularLobe& lobe) {
  const bool phong = lobe.normals == Normals::kPhong;
  std::string errors = CheckParameter(phong ? "exponent" : "alpha", lobe.roughness);
  const auto add = [&](const std::string& error) {
    if (!errors.empty() && !error.empty()) errors += "; ";
    errors += error;
  };
  if (phong && lobe.masking != LobeMasking::kKelemen) add("no table of Phong's with Smith's masking");
  if (lobe.facets == Reflector::kSchlick) add(CheckParameter("f0", lobe.f0));
  if (lobe.facets == Reflector::kConductor) {
    const std::string of_n = CheckParameter("n", lobe.n), of_kappa = CheckParameter("kappa", lobe.kappa);
    add(of_n);
    add(of_kappa);
    // Re g^2 = 0 at some angle, and the imaginary part of g^2 too small to round the kink off.
    const double t = lobe.n * lobe.n - lobe.kappa * lobe.kappa;
    if (of_n.empty() && of_kappa.empty() && t >= 0 && t < 1 && 2 * lobe.n * lobe.kappa < 0.5 && lobe.n != 1) {
      add("n = " + std::to_string(lobe.n) + " with kappa = " + std::to_string(lobe.kappa) +
          " has total internal reflection, or nearly so");
    }
  }
  return errors;
}

// k of the offset 2^-k, a 256th to a 128th of the least of the scales at which a changes next to grazing,
// where it is like mu log(mu), or half of it where a is smooth.
int OffsetBits(const SpecularLobe& lobe) {
  const double width = Width(lobe);
  const double scale = std::min({width, 1 / (width * width), ReflectanceScale(lobe)});
  const bool smooth = lobe.masking == LobeMasking::kSeparable ||
                      (lobe.masking == LobeMasking::kHeightCorrelated && lobe.normals == Normals::kBeckmann);
  return std::clamp(static_cast<int>(std::ceil(-std::log2(scale))) + (smooth ? 1 : 8), 3, 23);
}

// Lagrange's polynomial through `kCount` values of equal spacing between octaves, at x.
template <std::size_t kCount>
double Interpolated(const double* nodes, const double* values, double x) {
  double sum = 0;
  for (std::size_t i = 0; i < kCount; ++i) {
    double term = values[i];
    for (std::size_t j = 0; j < kCount; ++j) {
      if (j != i) term *= (x - nodes[j]) / (nodes[i] - nodes[j]);
    }
    sum += term;
  }
  return sum;
}

}  // namespace

double DirectionalAlbedo(const SpecularLobe& lobe, double mu) {
  // Beckmann's Lambda is slow, and nothing in its lobe varies fast.
  const bool smooth = lobe.masking != LobeMasking::kKelemen && lobe.normals == Normals::kBeckmann;
  return smooth ? Integral<12, 28, 12>(lobe, mu)() : Integral<16, 40, 14>(lobe, mu)();
}

AlbedoTable::AlbedoTable(const SpecularLobe& lobe) : Prepared(Check(lobe)), lobe_(lobe) {
  if (!ok()) return;
  // Quadrature at every fourth node; polynomials between them are off by less than what linear cells are.
  constexpr std::size_t kStep = 4, kPoints = 6;
  const int bits = OffsetBits(lobe);
  entries_.offset = std::ldexp(1.0, -bits);
  entries_.last = static_cast<std::size_t>(bits) * AlbedoEntries::kCells;
  std::vector<double> coarse_mu, coarse;
  for (std::size_t j = 0; j <= entries_.last; j += kStep) {
    coarse_mu.push_back(entries_.Node(j));
    coarse.push_back(DirectionalAlbedo(lobe, coarse_mu.back()));
  }
  const std::size_t stride = entries_.last + 2;
  floats_.resize(2 * stride);
  doubles_.resize(stride - 1);
  for (std::size_t j = 0; j < stride; ++j) {
    const std::size_t node = std::min(j, entries_.last), at = node / kStep;
    const std::size_t first =
        std::min(at > kPoints / 2 - 1 ? at - (kPoints / 2 - 1) : 0, coarse.size() - kPoints);
    const double a = node % kStep == 0
                         ? coarse[at]
                         : Interpolated<kPoints>(&coarse_mu[first], &coarse[first], entries_.Node(node));
    const double within = std::clamp(a, 0.0, 1.0);
    floats_[j] = static_cast<float>(within);
    floats_[stride + j] = static_cast<float>(1 - within);
  }
  entries_.albedo = floats_.data();
  entries_.deficit = floats_.data() + stride;
  for (std::size_t j = entries_.last; j-- > 0;) {
    const double mu0 = entries_.Node(j), mu1 = entries_.Node(j + 1);
    const double r0 = static_cast<double>(entries_.deficit[j]),
                 r1 = static_cast<double>(entries_.deficit[j + 1]);
    doubles_[j] = doubles_[j + 1] + (mu1 - mu0) / 6 * (r0 * (2 * mu0 + mu1) + r1 * (mu0 + 2 * mu1));
  }
  entries_.cumulative = doubles_.data();
  entries_.mean_deficit = 2 * doubles_[0];
  MakeGuide();
  entries_.matte_scale = doubles_[0] > 0 ? 1 / (kPi * entries_.mean_deficit) : 0;
}

void AlbedoTable::MakeGuide() {
  // The cell with u of the whole beyond it, cumulative[j] > u cumulative[0] >= cumulative[j + 1].
  const auto cell = [&](double u) {
    const auto reached = [&](double beyond) { return beyond <= u * doubles_[0]; };
    const auto first = std::find_if(doubles_.begin() + 1, doubles_.end() - 1, reached);
    return static_cast<std::uint32_t>(first - doubles_.begin() - 1);
  };
  constexpr double kMargin = 1e-12;  // of what lanes may round
  guide_.resize(entries_.last + 1);
  for (std::size_t j = 0; j < entries_.last; ++j) {
    const double low = entries_.Node(j) * (1 - kMargin),
                 high = std::min(1.0, entries_.Node(j + 1) * (1 + kMargin));
    guide_[j] = cell(1 - low * low);
    const int beyond = static_cast<int>(cell(1 - high * high)) - static_cast<int>(guide_[j]);
    entries_.guide_steps = std::max(entries_.guide_steps, beyond);
  }
  guide_[entries_.last] = static_cast<std::uint32_t>(entries_.last - 1);  // u = 0
  entries_.guide = guide_.data();
}

}  // namespace microlane
