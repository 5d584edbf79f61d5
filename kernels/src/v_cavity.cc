#include "microlane/v_cavity.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <utility>

#include "microlane/material.h"
#include "src/v_cavity_call.h"

namespace microlane {
namespace {

constexpr std::size_t kMaxCounts = std::size_t{1} << 26;

std::string SizeError(const char* name, std::size_t value) {
  if (value >= 1 && value <= kMaxCounts) return "";
  return std::string(name) + " = " + std::to_string(value) + " is outside [1, 2^26]";
}

std::string DirectionError(const double (&wi)[3]) {
  const double length = std::hypot(wi[0], wi[1], wi[2]);
  if (std::isfinite(length) && wi[2] / length >= 1e-6) return "";
  char text[128];
  std::snprintf(text, sizeof text, "wi = (%.9g, %.9g, %.9g) is not above the surface", wi[0], wi[1], wi[2]);
  return text;
}

}  // namespace

std::string VCavityError(const VCavityScene& scene) {
  std::string error;
  const auto check = [&](std::string found) {
    if (error.empty()) error = std::move(found);
  };
  check(CheckParameter("alpha_x", scene.alpha_x));
  check(CheckParameter("alpha_y", scene.alpha_y));
  if (scene.facets == VCavityFacets::kInterfaced) {
    check(CheckParameter("n_i", scene.n_i));
    check(CheckParameter("k", scene.k));
  }
  check(DirectionError(scene.wi));
  check(SizeError("rows", scene.rows));
  check(SizeError("columns", scene.columns));
  check(SizeError("orders", scene.orders));
  if (error.empty()) {
    const std::size_t cells = scene.rows * scene.columns;
    if (cells > kMaxCounts || cells * scene.orders > kMaxCounts) {
      error = "orders x rows x columns = " + std::to_string(scene.orders) + " x " +
              std::to_string(scene.rows) + " x " + std::to_string(scene.columns) + " is above 2^26";
    }
  }
  return error;
}

std::size_t VCavityCounts(const VCavityScene& scene) { return scene.orders * scene.rows * scene.columns; }

VCavityPlan::VCavityPlan(const VCavityScene& scene)
    : facets(scene.facets == VCavityFacets::kMirror ? Facets::kMirror
             : scene.n_i == 1                       ? Facets::kLambertian
                                                    : Facets::kInterfaced),
      alpha_x(static_cast<float>(scene.alpha_x)),
      alpha_y(static_cast<float>(scene.alpha_y)),
      rows(static_cast<std::uint32_t>(scene.rows)),
      columns(static_cast<std::uint32_t>(scene.columns)),
      orders(static_cast<std::uint32_t>(scene.orders)),
      seed(scene.seed),
      max_hits(scene.max_hits) {
  const double length = std::hypot(scene.wi[0], scene.wi[1], scene.wi[2]);
  for (int j = 0; j < 3; ++j) wi[j] = static_cast<float>(scene.wi[j] / length);
  const double n = scene.n_i, n2 = n * n;
  eta2 = static_cast<float>(n2);
  eta2_minus_1 = static_cast<float>((n - 1) * (n + 1));
  // T is greatest next to the normal, where it is 4 n/(n + 1)^2; away from it, by less than 1 percent for n
  // near 4.
  const double largest = std::min(1.0, 1.01 * 4 * n / ((n + 1) * (n + 1)));
  const double comes = largest * scene.k + n2 * (1 - scene.k);
  leave = static_cast<float>(scene.k / comes);
  stay = static_cast<float>(largest * scene.k / comes);
}

}  // namespace microlane
