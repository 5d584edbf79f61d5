#include "microlane/material.h"

#include <algorithm>
#include <cstdio>
#include <initializer_list>
#include <iterator>
#include <limits>

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
std::string CheckAll(std::initializer_list<NamedValue> parameters) {
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

RoughDielectricMaterial::RoughDielectricMaterial(double alpha_x, double alpha_y, double eta)
    : alpha_x_(alpha_x), alpha_y_(alpha_y), eta_(eta) {
  error_ = CheckAll({{"alpha_x", &alpha_x_}, {"alpha_y", &alpha_y_}, {"eta", &eta_}});
}

PhongDielectricMaterial::PhongDielectricMaterial(double exponent, double eta)
    : exponent_(exponent), eta_(eta) {
  error_ = CheckAll({{"exponent", &exponent_}, {"eta", &eta_}});
}

}  // namespace microlane
