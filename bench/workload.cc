#include "workload.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <string_view>

namespace microlane {
namespace {

constexpr double kTwoPi = 6.283185307179586;

struct Vec {
  double x, y, z;
};
double Dot(const Vec& a, const Vec& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Vec Combine(double s, const Vec& a, double t, const Vec& b) {
  return {s * a.x + t * b.x, s * a.y + t * b.y, s * a.z + t * b.z};
}
Vec Normalized(const Vec& a) { return Combine(1 / std::sqrt(Dot(a, a)), a, 0, a); }

class Lanes {
 public:
  explicit Lanes(std::size_t kernel) {
    const std::string_view id = kKernels[kernel].id;
    const std::string_view inputs = kKernels[kernel].inputs;
    beckmann_ = Contains(id, "beckmann") || Contains(id, "gaussian");
    isotropic_ = Contains(inputs, "exponent") || Contains(inputs, "sigma") || Contains(id, "isotropic");
    student_ = Contains(id, "student_t") || Contains(id, "tabulated");
    table_ = Contains(id, "tabulated");
    reflects_ = !Contains(id, "transmission") && !Contains(id, "refract");
    transmits_ = !Contains(id, "reflect") && kernel < kFirstReflectorKernel;
    if (isotropic_) alpha_y_ = alpha_x_;
  }

  // Roughness and index for the lanes that follow.
  void NextMaterial() {
    eta_ = 1.2 + 1.3 * Uniform();
    if (Uniform() < 0.5) eta_ = 1 / eta_;
    alpha_x_ = std::pow(0.01, Uniform());
    alpha_y_ = isotropic_ ? alpha_x_ : std::pow(0.01, Uniform());
    if (student_ && !table_) gamma_ = 1.6 * std::pow(20, Uniform());
  }

  void Next() {
    do {
      Draw();
    } while (!live_);
    for (double& u : u_) u = Uniform();
    x_ = -20 * Uniform();
    a_ = std::pow(10, 3 * Uniform() - 2);
  }

  double Value(std::string_view name) const {
    switch (name[0]) {
      case 'm':
        return name == "mu" ? alpha_x_ * a_ : name == "m" ? kWorkloadM : Component(name, m_);
      case 'v':
        return Component(name, wi_.z < 0 ? Combine(-1, wi_, 0, wi_) : wi_);
      case 'w':
        return Component(name, name[1] == 'i' ? wi_ : wo_);
      case 'u':
        return u_[name[1] - '1'];
      default:
        return name == "cos_i"      ? Dot(wi_, facing_)
               : name == "cos_o"    ? Dot(wo_, facing_)
               : name == "alpha_y"  ? alpha_y_
               : name == "r_xy"     ? 0.6
               : name == "mean_x"   ? 0.1
               : name == "mean_y"   ? -0.05
               : name == "exponent" ? std::max(0.0, 2 / (alpha_x_ * alpha_x_) - 2)
               : name == "eta"      ? eta_
               : name == "n"        ? eta_
               : name == "kappa"    ? 2 * eta_
               : name == "n_i"      ? std::max(eta_, 1 / eta_)
               : name == "f0"       ? 0.04
               : name == "x"        ? x_
               : name == "a"        ? a_
               : name == "tail"     ? gamma_
               : name == "sigma"    ? alpha_x_ * 0.70710678118654752
               : name == "gamma"    ? (student_ ? gamma_ : 1.6 + a_)
               : name == "order"    ? static_cast<double>(kWorkloadOrder)
               : name == "index"    ? kWorkloadIndex
               : name == "k"        ? 0.5
               : name == "Lambda_i" ? a_
               : name == "Lambda_o" ? alpha_x_ * a_
                                    : alpha_x_;
    }
  }

 private:
  static bool Contains(std::string_view text, std::string_view part) {
    return text.find(part) != std::string_view::npos;
  }
  static double Component(std::string_view name, const Vec& v) {
    return name.back() == 'x' ? v.x : name.back() == 'y' ? v.y : v.z;
  }

  double Uniform() { return uniform_(random_); }

  void Draw() {
    const double cosine = Uniform(), sine = std::sqrt(1 - cosine * cosine), phi = kTwoPi * Uniform();
    wi_ = {sine * std::cos(phi), sine * std::sin(phi), Uniform() < 0.5 ? cosine : -cosine};
    const double u = Uniform(), psi = kTwoPi * Uniform();
    const double slope = std::sqrt(beckmann_  ? -std::log1p(-u)
                                   : student_ ? (gamma_ - 1) * std::expm1(-std::log1p(-u) / (gamma_ - 1))
                                              : u / (1 - u));
    m_ = Normalized({alpha_x_ * slope * std::cos(psi), alpha_y_ * slope * std::sin(psi), 1});
    facing_ = wi_.z < 0 ? Combine(-1, m_, 0, m_) : m_;
    const double c = Dot(wi_, facing_);
    const bool reflects = reflects_ && (!transmits_ || Uniform() < 0.5);
    if (reflects) {
      wo_ = Normalized(Combine(2 * c, facing_, -1, wi_));
      live_ = c > 0 && wo_.z * wi_.z > 0;
      return;
    }
    const double cos2 = 1 + (c * c - 1) / (eta_ * eta_);
    live_ = c > 0 && cos2 > 0;
    if (!live_) return;
    wo_ = Normalized(Combine(c / eta_ - std::sqrt(cos2), facing_, -1 / eta_, wi_));
    live_ = wo_.z * wi_.z < 0;
  }

  bool beckmann_, isotropic_, student_, table_, reflects_, transmits_;
  std::mt19937_64 random_{20070625};
  std::uniform_real_distribution<double> uniform_{0, 1};
  double eta_ = 1.5, alpha_x_ = 0.3, alpha_y_ = 0.15, gamma_ = 2.5, u_[5] = {}, x_ = 0, a_ = 0;
  Vec wi_{}, wo_{}, m_{}, facing_{};
  bool live_ = false;
};

}  // namespace

Workload::Workload(std::size_t kernel, std::size_t n, Parameters parameters) : n_(n) {
  const Names inputs = Split(kKernels[kernel].inputs);
  stored_ = Split(kKernels[kernel].outputs).count;
  const bool uniform = parameters == Parameters::kUniform;
  loaded_ = uniform ? inputs.per_lane : inputs.columns;

  // Arrays start on cache lines, and no two at the same place of a page.
  const std::size_t arrays = inputs.count + stored_, stride = (n + 15) / 16 * 16 + 80;
  memory_.reset(static_cast<float*>(std::aligned_alloc(64, arrays * stride * sizeof(float))));
  std::fill_n(memory_.get(), arrays * stride, 0.0f);
  for (std::size_t k = 0; k < arrays; ++k) {
    float* array = memory_.get() + k * stride;
    if (k < inputs.count) {
      call_.in[k] = array;
      call_.uniform[k] = uniform && k >= inputs.per_lane;
    } else {
      call_.out[k - inputs.count] = array;
    }
  }
  if (inputs.columns < inputs.count) {
    const Lanes lanes(kernel);
    double values[kMaxInputs];
    for (std::size_t k = inputs.columns; k < inputs.count; ++k) {
      values[k - inputs.columns] = lanes.Value(inputs.name[k]);
    }
    prepared_ = Prepare(kernel, values);
    call_.prepared = prepared_.get();
  }
  Lanes lanes(kernel);
  for (std::size_t i = 0; i < n; ++i) {
    if (!uniform) lanes.NextMaterial();
    lanes.Next();
    for (std::size_t k = 0; k < inputs.count; ++k) {
      memory_.get()[k * stride + i] = static_cast<float>(lanes.Value(inputs.name[k]));
    }
  }
}

}  // namespace microlane
