// Materials whose parameters have been checked.
#ifndef MICROLANE_MATERIAL_H_
#define MICROLANE_MATERIAL_H_

#include <string>
#include <string_view>

#include "microlane/rough_dielectric.h"
#include "microlane/rough_reflector.h"

namespace microlane {

// Empty if `value`, as a float, lies in the range that the kernel list gives the parameter `name` ("alpha_x",
// "eta",
// ...); else says so with name, value and range. NaN lies in no range.
std::string CheckParameter(std::string_view name, double value);

// Mean and covariance of the slopes under a footprint, as LEAN and LEADR maps filter them.
struct SlopeMoments {
  double mean_x, mean_y;
  double variance_x, variance_y, covariance;
};

// Off-centre roughness, checked.
class SlopeRoughness {
 public:
  SlopeRoughness(double alpha_x, double alpha_y, double r_xy, double mean_x, double mean_y);
  // That of the Beckmann distribution with these moments (Heitz 2014 Eq. 88, Sigma = Q^-1 / 2): alpha^2 is
  // twice the variance. GGX, whose slopes have no variance, takes the same alphas.
  explicit SlopeRoughness(const SlopeMoments& moments);

  bool ok() const { return error_.empty(); }
  // What is wrong with the parameters, else empty; then all of them are NaN.
  const std::string& error() const { return error_; }

  double alpha_x() const { return alpha_x_; }
  double alpha_y() const { return alpha_y_; }
  double r_xy() const { return r_xy_; }
  double mean_x() const { return mean_x_; }
  double mean_y() const { return mean_y_; }

 private:
  double alpha_x_, alpha_y_, r_xy_, mean_x_, mean_y_;
  std::string error_;
};

// A rough dielectric with GGX or Beckmann normals.
class RoughDielectricMaterial {
 public:
  RoughDielectricMaterial(double alpha_x, double alpha_y, double eta);

  bool ok() const { return error_.empty(); }
  // What is wrong with the parameters, else empty.
  const std::string& error() const { return error_; }

  // For batch calls. Of a material that is not ok, all are NaN, and so is what is computed from them.
  template <class T>
  DielectricParameters<T> Parameters() const {
    return {static_cast<T>(alpha_x_), static_cast<T>(alpha_y_), static_cast<T>(eta_)};
  }

 private:
  double alpha_x_, alpha_y_, eta_;
  std::string error_;
};

// A rough dielectric with Phong normals.
class PhongDielectricMaterial {
 public:
  PhongDielectricMaterial(double exponent, double eta);

  bool ok() const { return error_.empty(); }
  const std::string& error() const { return error_; }

  template <class T>
  PhongDielectricParameters<T> Parameters() const {
    return {static_cast<T>(exponent_), static_cast<T>(eta_)};
  }

 private:
  double exponent_, eta_;
  std::string error_;
};

// An opaque rough surface, given with one value for each parameter.
template <Normals kNormals, Reflector kReflector>
class OpaqueMaterial {
 public:
  explicit OpaqueMaterial(const OpaqueSurface<kNormals, kReflector, double>& surface);

  bool ok() const { return error_.empty(); }
  // What is wrong with the parameters, else empty.
  const std::string& error() const { return error_; }

  // For batch calls. Of a material that is not ok, all are NaN, and so is what is computed from them.
  template <class T>
  OpaqueSurface<kNormals, kReflector, T> Surface() const {
    if constexpr (kReflector == Reflector::kConductor) {
      return {Roughness<T>(), {facets_[0], facets_[1]}};
    } else if constexpr (kReflector == Reflector::kSchlick) {
      return {Roughness<T>(), {facets_[0]}};
    } else {
      return {Roughness<T>(), {}};
    }
  }

 private:
  template <class T>
  RoughnessOf<kNormals, T> Roughness() const {
    if constexpr (kNormals == Normals::kPhong) {
      return {roughness_[0]};
    } else {
      return {roughness_[0], roughness_[1]};
    }
  }

  double roughness_[2] = {}, facets_[2] = {};
  std::string error_;
};

using RoughMirrorMaterial = OpaqueMaterial<Normals::kGgx, Reflector::kMirror>;
using RoughConductorMaterial = OpaqueMaterial<Normals::kGgx, Reflector::kConductor>;
using RoughSchlickMaterial = OpaqueMaterial<Normals::kGgx, Reflector::kSchlick>;

}  // namespace microlane

#endif  // MICROLANE_MATERIAL_H_
