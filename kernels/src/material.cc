#include "microlane/material.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <iterator>
#include <limits>
#include <vector>

#include "microlane/kernel_list.h"

namespace microlane {
namespace {

std::string Text(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.9g", value);
  return text;
}

struct NamedValue {
  std::string_view name;
  double* value;
};

// The errors of all parameters; if there is one, the values become NaN.
template <class Parameters>
std::string CheckAll(const Parameters& parameters) {
  std::string errors;
  for (const NamedValue& parameter : parameters) {
    const std::string error = CheckParameter(parameter.name, *parameter.value);
    if (!errors.empty() && !error.empty()) errors += "; ";
    errors += error;
  }
  if (!errors.empty()) {
    for (const NamedValue& parameter : parameters) {
      *parameter.value = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return errors;
}

}  // namespace

std::string CheckParameter(std::string_view name, double value) {
  const auto* const input = std::find_if(std::begin(kInputs), std::end(kInputs),
                                         [&](const Input& known) { return known.name == name; });
  if (input == std::end(kInputs)) return "unknown parameter '" + std::string(name) + "'";
  // Ranges hold for floats: 1e-5f lies in [1e-5, 100] though it is the lesser number.
  const float rounded = static_cast<float>(value);
  if (rounded >= static_cast<float>(input->low) && rounded <= static_cast<float>(input->high)) return "";
  return std::string(name) + " = " + Text(value) + " is outside [" + Text(input->low) + ", " +
         Text(input->high) + "]";
}

SlopeRoughness::SlopeRoughness(double alpha_x, double alpha_y, double r_xy, double mean_x, double mean_y)
    : alpha_x_(alpha_x), alpha_y_(alpha_y), r_xy_(r_xy), mean_x_(mean_x), mean_y_(mean_y) {
  error_ = CheckAll(std::initializer_list<NamedValue>{{"alpha_x", &alpha_x_},
                                                      {"alpha_y", &alpha_y_},
                                                      {"r_xy", &r_xy_},
                                                      {"mean_x", &mean_x_},
                                                      {"mean_y", &mean_y_}});
}

SlopeRoughness::SlopeRoughness(const SlopeMoments& moments)
    : SlopeRoughness(std::sqrt(2 * moments.variance_x), std::sqrt(2 * moments.variance_y),
                     moments.covariance / (std::sqrt(moments.variance_x) * std::sqrt(moments.variance_y)),
                     moments.mean_x, moments.mean_y) {
  if (ok()) return;
  // By the names of what was given.
  const auto prefix = [](std::string_view name, double value) {
    return value > 0 ? "" : std::string(name) + " = " + Text(value) + " is not above 0; ";
  };
  error_ = prefix("variance_x", moments.variance_x) + prefix("variance_y", moments.variance_y) + error_;
}

RoughDielectricMaterial::RoughDielectricMaterial(double alpha_x, double alpha_y, double eta)
    : alpha_x_(alpha_x), alpha_y_(alpha_y), eta_(eta) {
  error_ = CheckAll(
      std::initializer_list<NamedValue>{{"alpha_x", &alpha_x_}, {"alpha_y", &alpha_y_}, {"eta", &eta_}});
}

PhongDielectricMaterial::PhongDielectricMaterial(double exponent, double eta)
    : exponent_(exponent), eta_(eta) {
  error_ = CheckAll(std::initializer_list<NamedValue>{{"exponent", &exponent_}, {"eta", &eta_}});
}

template <Normals kNormals, Reflector kReflector>
OpaqueMaterial<kNormals, kReflector>::OpaqueMaterial(
    const OpaqueSurface<kNormals, kReflector, double>& surface) {
  std::vector<NamedValue> parameters;
  const auto add = [&](std::string_view name, const Parameter<double>& parameter, double& value) {
    value = parameter.uniform() ? *parameter.data() : std::numeric_limits<double>::quiet_NaN();
    parameters.push_back({name, &value});
  };
  if constexpr (kNormals == Normals::kPhong) {
    add("exponent", surface.roughness.exponent, roughness_[0]);
  } else {
    add("alpha_x", surface.roughness.alpha_x, roughness_[0]);
    add("alpha_y", surface.roughness.alpha_y, roughness_[1]);
  }
  if constexpr (kReflector == Reflector::kConductor) {
    add("n", surface.facets.n, facets_[0]);
    add("kappa", surface.facets.kappa, facets_[1]);
  } else if constexpr (kReflector == Reflector::kSchlick) {
    add("f0", surface.facets.f0, facets_[0]);
  }
  error_ = CheckAll(parameters);
}

template class OpaqueMaterial<Normals::kGgx, Reflector::kMirror>;
template class OpaqueMaterial<Normals::kGgx, Reflector::kConductor>;
template class OpaqueMaterial<Normals::kGgx, Reflector::kSchlick>;
template class OpaqueMaterial<Normals::kBeckmann, Reflector::kMirror>;
template class OpaqueMaterial<Normals::kBeckmann, Reflector::kConductor>;
template class OpaqueMaterial<Normals::kBeckmann, Reflector::kSchlick>;
template class OpaqueMaterial<Normals::kPhong, Reflector::kMirror>;
template class OpaqueMaterial<Normals::kPhong, Reflector::kConductor>;
template class OpaqueMaterial<Normals::kPhong, Reflector::kSchlick>;

}  // namespace microlane
