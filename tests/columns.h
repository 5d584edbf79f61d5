// Batch calls by a kernel's id, with inputs as columns of numbers, for tests of properties of the packets.
#ifndef MICROLANE_TESTS_COLUMNS_H_
#define MICROLANE_TESTS_COLUMNS_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "microlane/kernel_list.h"
#include "microlane/kernels.h"
#include "microlane/packets.h"
#include "microlane/prepared.h"
#include "microlane/targets.h"

namespace microlane {

struct Direction {
  double x, y, z;
};

inline Direction operator+(const Direction& a, const Direction& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
inline Direction operator-(const Direction& a, const Direction& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
inline Direction operator*(double s, const Direction& v) { return {s * v.x, s * v.y, s * v.z}; }
inline double Dot(const Direction& a, const Direction& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
inline Direction Cross(const Direction& a, const Direction& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline double Length(const Direction& v) { return std::sqrt(Dot(v, v)); }
inline Direction Normalized(const Direction& v) { return (1 / Length(v)) * v; }

constexpr double kTestPi = 3.14159265358979323846;
constexpr double Radians(double degrees) { return degrees * (kTestPi / 180); }

inline Direction Spherical(double theta, double phi) {
  return {std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta)};
}

template <class T>
using Column = std::vector<T>;

template <class T>
struct DirectionColumns {
  Column<T> x, y, z;

  std::size_t size() const { return x.size(); }
  Direction operator[](std::size_t i) const { return {double{x[i]}, double{y[i]}, double{z[i]}}; }
  void PushBack(const Direction& v) {
    x.push_back(static_cast<T>(v.x));
    y.push_back(static_cast<T>(v.y));
    z.push_back(static_cast<T>(v.z));
  }
};

// One input of a call: a column, or one value for all lanes.
template <class T>
class Argument {
 public:
  Argument(const Column<T>& column) : column_(&column) {}    // NOLINT(google-explicit-constructor)
  Argument(double value) : value_(static_cast<T>(value)) {}  // NOLINT(google-explicit-constructor)
  const Column<T>* column() const { return column_; }
  const T& value() const { return value_; }

 private:
  const Column<T>* column_ = nullptr;
  T value_ = 0;
};

template <class T>
using Arguments = std::vector<Argument<T>>;

template <class T>
void Append(Arguments<T>& arguments, const DirectionColumns<T>& v) {
  arguments.insert(arguments.end(), {v.x, v.y, v.z});
}
template <class T>
void Append(Arguments<T>& arguments, const Direction& v) {
  arguments.insert(arguments.end(), {v.x, v.y, v.z});
}
template <class T>
void Append(Arguments<T>& arguments, const Column<T>& column) {
  arguments.push_back(column);
}
template <class T>
void Append(Arguments<T>& arguments, double value) {
  arguments.push_back(value);
}
template <class T>
void Append(Arguments<T>& arguments, std::initializer_list<double> values) {
  arguments.insert(arguments.end(), values.begin(), values.end());
}

struct Mode {
  Accuracy accuracy = Accuracy::kStandard;  // of float lanes
  Transport transport = Transport::kRadiance;
};

// The outputs of kernel `id` for n lanes, in the kernel list's order.
template <class T>
std::vector<Column<T>> RunArguments(std::string_view id, std::size_t n, Mode mode,
                                    const Arguments<T>& arguments) {
  const std::size_t kernel = KernelIndex(id);
  if (kernel == kNumKernels) {
    ADD_FAILURE() << "no kernel " << id;
    return std::vector<Column<T>>(kMaxOutputs, Column<T>(n));
  }
  const Names inputs = Split(kKernels[kernel].inputs);
  std::vector<Column<T>> outputs(Split(kKernels[kernel].outputs).count, Column<T>(n));
  if (arguments.size() != inputs.count) {
    ADD_FAILURE() << id << " takes " << inputs.count << " inputs, not " << arguments.size();
    return outputs;
  }
  std::vector<Column<T>> spread;
  spread.reserve(arguments.size());
  Call<T> call;
  call.transport = mode.transport;
  for (std::size_t k = 0; k < arguments.size(); ++k) {
    if (arguments[k].column() != nullptr) {
      EXPECT_EQ(arguments[k].column()->size(), n) << id << ", " << inputs.name[k];
      call.in[k] = arguments[k].column()->data();
    } else if (k >= inputs.per_lane) {
      call.in[k] = &arguments[k].value();
      call.uniform[k] = true;
    } else {
      call.in[k] = spread.emplace_back(n, arguments[k].value()).data();
    }
  }
  for (std::size_t k = 0; k < outputs.size(); ++k) call.out[k] = outputs[k].data();
  std::shared_ptr<const Prepared> prepared;
  if (TakesPrepared(kernel)) {
    double values[kMaxInputs] = {};
    for (std::size_t k = inputs.columns; k < inputs.count; ++k) {
      values[k - inputs.columns] = static_cast<double>(arguments[k].value());
    }
    prepared = Prepare(kernel, values);
    call.prepared = prepared.get();
  }
  if constexpr (std::is_same_v<T, float>) {
    RunKernel(kernel, mode.accuracy, call, n);
  } else {
    RunKernel(kernel, call, n);
  }
  return outputs;
}

// As above from directions, columns, values and lists of values in the kernel's order of inputs.
template <class T, class... V>
std::vector<Column<T>> RunAll(std::string_view id, std::size_t n, Mode mode, const V&... values) {
  Arguments<T> arguments;
  (Append(arguments, values), ...);
  return RunArguments<T>(id, n, mode, arguments);
}
template <class T, class... V>
Column<T> RunOne(std::string_view id, std::size_t n, Mode mode, const V&... values) {
  return std::move(RunAll<T>(id, n, mode, values...)[0]);
}
template <class T, class... V>
DirectionColumns<T> RunDirection(std::string_view id, std::size_t n, Mode mode, const V&... values) {
  std::vector<Column<T>> out = RunAll<T>(id, n, mode, values...);
  return {std::move(out[0]), std::move(out[1]), std::move(out[2])};
}

// The relative error that the kernel list declares: B ULP are at most B 2^(1 - digits).
template <class T>
double DeclaredError(std::string_view id, Accuracy accuracy = Accuracy::kStandard) {
  const Bounds& bounds = kKernels[KernelIndex(id)].bounds;
  if constexpr (std::is_same_v<T, double>) return bounds.double_lanes * 0x1p-52;
  const float bound = accuracy == Accuracy::kHigh    ? bounds.high
                      : accuracy == Accuracy::kFast  ? bounds.fast
                      : TargetHasFma(ChosenTarget()) ? bounds.standard
                                                     : bounds.standard_nofma;
  return bound * 0x1p-23;
}

// A distribution of normals with its parameters, as the kernel list names both. Its slopes spread over about
// scale_x, scale_y.
struct Distribution {
  std::string_view family;  // ggx, beckmann, phong, student_t, tabulated (whose gamma comes last)
  std::string_view form;    // "", or "_isotropic" for the kernels of one alpha
  std::vector<double> parameters;
  double scale_x, scale_y;

  std::string Id(std::string_view quantity) const {
    return std::string(family) + '.' + std::string(quantity) + std::string(form);
  }
  // The kernels of a model over this distribution.
  std::string Model(std::string_view model, std::string_view quantity) const {
    return std::string(model) + (family == "ggx" ? "." : "_" + std::string(family) + '.') +
           std::string(quantity);
  }
  std::string Dielectric(std::string_view quantity) const { return Model("rough_dielectric", quantity); }
  // A bound of |d log(D(m)) / d m|: what D makes of a rounding of m.
  double LogSlope(const Direction& m) const {
    if (family == "phong") return 1 + parameters[0] / m.z;
    const double u = m.x / (m.z * scale_x), w = m.y / (m.z * scale_y), r = std::sqrt(u * u + w * w);
    const double radial = family == "ggx"         ? 4 * r / (1 + r * r)
                          : family == "student_t" ? 2 * parameters[0] * r / (parameters[0] - 1 + r * r)
                          : family == "tabulated"
                              ? 2 * parameters.back() * r / (parameters.back() - 1 + r * r)
                              : 2 * r;
    return 4 / m.z + radial / (std::min(scale_x, scale_y) * m.z * m.z);
  }
  std::string Text() const {
    std::string text = std::string(family) + std::string(form);
    for (const double p : parameters) text += ' ' + std::to_string(p);
    return text;
  }
};

// Values for the batch.
struct Values {
  std::vector<double> list;
};
template <class T>
void Append(Arguments<T>& arguments, const Values& values) {
  arguments.insert(arguments.end(), values.list.begin(), values.list.end());
}

template <class T>
void Append(Arguments<T>& arguments, const Distribution& distribution) {
  arguments.insert(arguments.end(), distribution.parameters.begin(), distribution.parameters.end());
}

// Parameters are floats, so that float and double lanes see the same ones.
inline Distribution Ggx(float alpha_x, float alpha_y) {
  return {"ggx", "", {alpha_x, alpha_y}, alpha_x, alpha_y};
}
inline Distribution Beckmann(float alpha_x, float alpha_y) {
  return {"beckmann", "", {alpha_x, alpha_y}, alpha_x, alpha_y};
}
inline Distribution StudentT(float gamma, float alpha_x, float alpha_y) {
  return {"student_t", "", {gamma, alpha_x, alpha_y}, alpha_x, alpha_y};
}
// Of the table that tools make of a gamma.
inline Distribution Tabulated(float gamma, float alpha_x, float alpha_y) {
  return {"tabulated", "", {alpha_x, alpha_y, gamma}, alpha_x, alpha_y};
}
inline Distribution Isotropic(const Distribution& distribution) {
  if (distribution.family == "tabulated") {
    const double alpha = distribution.scale_x;
    return {distribution.family, "_isotropic", {alpha, distribution.parameters.back()}, alpha, alpha};
  }
  std::vector<double> parameters(distribution.parameters.begin(), distribution.parameters.end() - 2);
  parameters.push_back(distribution.scale_x);
  return {distribution.family, "_isotropic", parameters, distribution.scale_x, distribution.scale_x};
}
inline Distribution Phong(float exponent) {
  const double scale = std::sqrt(2 / (double{exponent} + 2));
  return {"phong", "", {exponent}, scale, scale};
}

// What a rounding of wi and wo makes of f |cos(theta_o)| and of its density, relatively and in units of that
// rounding, where the facet m scatters one into the other: through the half vector, whose own rounding is
// that of wi + eta wo over its length, through masking, and through Fresnel, of either side, at grazing and
// near the critical angle.
inline double Conditioning(const Distribution& distribution, const Direction& wi, const Direction& wo,
                           const Direction& m, double eta, bool reflects) {
  const double length = Length(wi + (reflects ? 1 : eta) * wo);
  const double ci = std::abs(Dot(wi, m)), co = std::abs(Dot(wo, m));
  const double g2 = std::abs((eta - 1) * (eta + 1) + ci * ci);
  return 1 + distribution.LogSlope(m) / length + 1 / (length * ci) + 1 / (length * co) +
         (1 + eta * eta) / (ci * ci) + 1 / g2 + 1 / std::abs(wi.z) + 1 / std::abs(wo.z);
}

}  // namespace microlane

#endif  // MICROLANE_TESTS_COLUMNS_H_
