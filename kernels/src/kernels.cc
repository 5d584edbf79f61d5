#include "microlane/kernels.h"

#include "microlane/kernel_list.h"
#include "src/dispatch.h"

namespace microlane {
namespace {

const FamilyFunction* Table(std::string_view id) {
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

}  // namespace

void RunKernel(std::size_t kernel, Accuracy accuracy, const Call<float>& call, std::size_t n) {
  const std::string_view id = kKernels[kernel].id;
  Run(FindKernel(Table(id), id), accuracy, call, n);
}

void RunKernel(std::size_t kernel, const Call<double>& call, std::size_t n) {
  const std::string_view id = kKernels[kernel].id;
  Run(FindKernel(Table(id), id), Accuracy::kStandard, call, n);
}

}  // namespace microlane
