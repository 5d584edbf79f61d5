#include "microlane/kernels.h"

#include <array>
#include <string_view>
#include <utility>

#include "microlane/kernel_list.h"
#include "src/dispatch.h"

namespace microlane {
namespace {

template <std::size_t... kFamily>
const FamilyFunction* RoughDielectricTableOf(std::string_view family, std::index_sequence<kFamily...>) {
  const FamilyFunction* table = nullptr;
  ((family == kDielectricFamilies[kFamily].id
        ? void(table = RoughDielectricTable<static_cast<Normals>(kFamily)>())
        : void()),
   ...);
  return table;
}

const FamilyFunction* TableOf(std::string_view id) {
  const std::string_view family = id.substr(0, id.find('.'));
  const FamilyFunction* const rough_dielectric =
      RoughDielectricTableOf(family, std::make_index_sequence<kNumDielectricFamilies>());
  return rough_dielectric != nullptr ? rough_dielectric
         : family == "math"          ? MathTable()
         : family == "ggx"           ? GgxTable()
         : family == "beckmann"      ? BeckmannTable()
         : family == "phong"         ? PhongTable()
         : family == "fresnel"       ? FresnelTable()
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
  Run(CodeOf(Table(kernel), kernel), accuracy, call, n);
}

void RunKernel(std::size_t kernel, const Call<double>& call, std::size_t n) {
  Run(CodeOf(Table(kernel), kernel), Accuracy::kStandard, call, n);
}

}  // namespace microlane
