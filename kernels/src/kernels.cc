#include "microlane/kernels.h"

#include <array>
#include <iterator>
#include <string_view>
#include <utility>

#include "microlane/kernel_list.h"
#include "src/dispatch.h"

namespace microlane {
namespace {

// The tables of all distributions, in the order of Normals.
template <std::size_t... kNormals>
const FamilyFunction* NormalsTableOf(std::size_t normals, std::index_sequence<kNormals...>) {
  const FamilyFunction* table = nullptr;
  ((normals == kNormals ? void(table = NormalsTable<static_cast<Normals>(kNormals)>()) : void()), ...);
  return table;
}
template <std::size_t... kNormals>
const FamilyFunction* RoughDielectricTableOf(std::size_t normals, std::index_sequence<kNormals...>) {
  const FamilyFunction* table = nullptr;
  ((normals == kNormals ? void(table = RoughDielectricTable<static_cast<Normals>(kNormals)>()) : void()),
   ...);
  return table;
}
template <std::size_t... kNormals>
const FamilyFunction* RoughReflectorTableOf(std::size_t normals, std::index_sequence<kNormals...>) {
  const FamilyFunction* table = nullptr;
  ((normals == kNormals ? void(table = RoughReflectorTable<static_cast<Normals>(kNormals)>()) : void()), ...);
  return table;
}

const FamilyFunction* TableOf(std::size_t kernel) {
  constexpr auto families = std::make_index_sequence<kNumModelFamilies>();
  if (kernel >= kFirstReflectorKernel) {
    return RoughReflectorTableOf(static_cast<std::size_t>(PlaceOfReflectorKernel(kernel).normals), families);
  }
  if (kernel >= kFirstDielectricKernel) {
    return RoughDielectricTableOf((kernel - kFirstDielectricKernel) / kNumDielectricQuantities, families);
  }
  if (kernel >= kNumComponentKernels) {
    const NormalRow& row = kNormalRows[kNormalKernelPlaces[kernel - kNumComponentKernels].row];
    return NormalsTableOf(static_cast<std::size_t>(row.normals),
                          std::make_index_sequence<std::size(kNormalFamilies)>());
  }
  const std::string_view id = kKernels[kernel].id;
  const std::string_view family = id.substr(0, id.find('.'));
  return family == "math"      ? MathTable()
         : family == "fresnel" ? FresnelTable()
         : family == "masking" ? MaskingTable()
                               : HalfVectorTable();
}

const FamilyFunction* Table(std::size_t kernel) {
  static const auto tables = [] {
    std::array<const FamilyFunction*, kNumKernels> all{};
    for (std::size_t i = 0; i < kNumKernels; ++i) all[i] = TableOf(i);
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
