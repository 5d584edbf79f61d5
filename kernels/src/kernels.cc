#include "microlane/kernels.h"

#include <array>

#include "microlane/kernel_list.h"
#include "src/dispatch.h"

namespace microlane {
namespace {

const FamilyFunction* TableOf(std::string_view id) {
  const std::string_view family = id.substr(0, id.find('.'));
  return family == "math"                        ? MathTable()
         : family == "ggx"                       ? GgxTable()
         : family == "beckmann"                  ? BeckmannTable()
         : family == "phong"                     ? PhongTable()
         : family == "fresnel"                   ? FresnelTable()
         : family == "rough_dielectric"          ? RoughDielectricGgxTable()
         : family == "rough_dielectric_beckmann" ? RoughDielectricBeckmannTable()
         : family == "rough_dielectric_phong"    ? RoughDielectricPhongTable()
                                                 : HalfVectorTable();
}

const FamilyFunction* Table(std::size_t kernel) {
  static const auto tables = [] {
    std::array<const FamilyFunction*, kNumKernels> all{};
    for (std::size_t i = 0; i < kNumKernels; ++i) all[i] = TableOf(kKernels[i].id);
    return all;
  }();
  return tables[kernel];
}

}  // namespace

void RunKernel(std::size_t kernel, Accuracy accuracy, const Call<float>& call, std::size_t n) {
  Run(FindKernel(Table(kernel), kKernels[kernel].id), accuracy, call, n);
}

void RunKernel(std::size_t kernel, const Call<double>& call, std::size_t n) {
  Run(FindKernel(Table(kernel), kKernels[kernel].id), Accuracy::kStandard, call, n);
}

}  // namespace microlane
