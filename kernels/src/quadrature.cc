#include "microlane/quadrature.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "microlane/kernel_list.h"
#include "microlane/material.h"
#include "src/legendre.h"

namespace microlane {
namespace {

constexpr double kPi = 3.14159265358979323846;

static_assert(FindInput("order").low == 1 && FindInput("order").high == QuadratureRule::kMaxOrder);

std::string CheckOrder(double order) {
  std::string error = CheckParameter("order", order);
  if (error.empty() && order != std::floor(order)) {
    error = "order = " + std::to_string(order) + " is not a whole number in [1, 32]";
  }
  return error;
}

}  // namespace

QuadratureRule::QuadratureRule(double order) : Prepared(CheckOrder(order)) {
  constexpr std::size_t kRows = static_cast<std::size_t>(QuadratureRow::kNumRows);
  if (!ok()) return;
  order_ = static_cast<std::size_t>(order);
  beckmann_radius_ = std::sqrt(1 + 1.5 * order);
  beckmann_visible_ = std::sqrt(0.6 * (order + 1));
  doubles_.resize(kRows * order_);
  const auto normalize = [&](QuadratureRow row, double sum) {
    double* const first = doubles_.data() + static_cast<std::size_t>(row) * order_;
    const double factor = sum / std::accumulate(first, first + order_, 0.0);
    std::for_each(first, first + order_, [&](double& x) { x *= factor; });
  };
  const auto put = [&](QuadratureRow row, std::size_t i, double value) {
    doubles_[static_cast<std::size_t>(row) * order_ + i] = value;
  };
  for (std::size_t k = 0; k < (order_ + 1) / 2; ++k) {
    auto [below, weight] = LegendreNode(order_, k);
    const std::size_t mirrored = order_ - 1 - k;
    const bool middle = mirrored == k;
    if (middle) below = 0.5;
    const double small = std::tan(kPi / 2 * below);
    for (const bool upper : {false, true}) {
      const std::size_t i = upper ? mirrored : k;
      const double t = upper ? 1 - below : below, rest = upper ? below : 1 - below;
      const double p = middle ? 1 : upper ? 1 / small : small, r = t * beckmann_radius_;
      const double of_p = weight * p * (kPi / 2) * (1 + p * p);
      put(QuadratureRow::kFirst, i, rest * rest);
      put(QuadratureRow::kMiddle, i, 2 * t * rest);
      put(QuadratureRow::kLast, i, t * t);
      put(QuadratureRow::kWeight, i, weight);
      put(QuadratureRow::kGgxRadius, i, p);
      put(QuadratureRow::kGgxWeight, i, of_p);
      put(QuadratureRow::kGgxFree, i, of_p / ((1 + p * p) * (1 + p * p)));
      put(QuadratureRow::kBeckmannRadius, i, r);
      put(QuadratureRow::kBeckmannFree, i, weight * r * beckmann_radius_ * std::exp(-r * r));
      put(QuadratureRow::kBeckmannPart, i, t);
      put(QuadratureRow::kBeckmannRest, i, rest);
      put(QuadratureRow::kBeckmannWeight, i, weight * t);
      const double sine = std::sin(kPi / 2 * t), cosine = std::sin(kPi / 2 * rest),
                   y = (t - rest) * beckmann_visible_;
      put(QuadratureRow::kCapPart, i, sine * sine);
      put(QuadratureRow::kCapRest, i, cosine * cosine);
      put(QuadratureRow::kCapWeight, i, weight * sine * cosine);
      put(QuadratureRow::kBeckmannAcross, i, y);
      put(QuadratureRow::kBeckmannAcrossWeight, i, weight * std::exp(-y * y));
    }
  }
  normalize(QuadratureRow::kCapWeight, 0.5 / order);
  normalize(QuadratureRow::kBeckmannAcrossWeight, 1);
  for (std::size_t i = 0; i < order_; ++i) {
    const double phi = kPi * (static_cast<double>(i) + 0.5) / order;
    put(QuadratureRow::kCosine, i, std::cos(phi));
    put(QuadratureRow::kSine, i, std::sin(phi));
  }
  for (const double value : doubles_) floats_.push_back(static_cast<float>(value));
}

}  // namespace microlane
