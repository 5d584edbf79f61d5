#include "glasses.h"

#include <cmath>
#include <cstddef>
#include <string_view>

#include "microlane/kernel_list.h"
#include "microlane/kernels.h"

namespace microlane {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kStep = 0.1, kLargest = 89.9;

GlassCurve Measure(const Fit& fit, int incidence) {
  const std::size_t kernel =
      KernelIndex(std::string_view(fit.distribution) == "GGX" ? "rough_dielectric.eval_transmission_separable"
                                                              : "rough_dielectric_beckmann.eval_separable");
  GlassCurve curve{fit, incidence, {}, {}, {}};
  const int steps = static_cast<int>(std::lround(kLargest / kStep));
  std::vector<float> wox, woz;
  for (int i = -steps; i <= steps; ++i) {
    curve.angle.push_back(i * kStep);
    // wi leans towards +x, so the refracted side is -x.
    wox.push_back(static_cast<float>(-std::sin(i * kStep * kDegree)));
    woz.push_back(static_cast<float>(-std::cos(i * kStep * kDegree)));
  }
  const std::size_t n = wox.size();
  const std::vector<float> wix(n, static_cast<float>(std::sin(incidence * kDegree)));
  const std::vector<float> wiz(n, static_cast<float>(std::cos(incidence * kDegree)));
  const std::vector<float> zero(n, 0);
  Call<float> call;
  const float* const directions[] = {wix.data(), zero.data(), wiz.data(),
                                     wox.data(), zero.data(), woz.data()};
  for (std::size_t k = 0; k < 6; ++k) call.in[k] = directions[k];
  const float* const parameters[] = {&fit.alpha, &fit.alpha, &kGlassEta};
  for (std::size_t k = 0; k < 3; ++k) {
    call.in[6 + k] = parameters[k];
    call.uniform[6 + k] = true;
  }
  curve.high.resize(n);
  call.out[0] = curve.high.data();
  RunKernel(kernel, Accuracy::kHigh, call, n);
  curve.fast.resize(n);
  call.out[0] = curve.fast.data();
  RunKernel(kernel, Accuracy::kFast, call, n);
  return curve;
}

}  // namespace

std::vector<GlassCurve> MeasureGlasses() {
  std::vector<GlassCurve> curves;
  for (const Fit& fit : kFits) {
    for (const int incidence : kIncidence) curves.push_back(Measure(fit, incidence));
  }
  return curves;
}

}  // namespace microlane
