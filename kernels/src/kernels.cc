#include "microlane/kernels.h"

#include <array>
#include <string_view>
#include <type_traits>
#include <utility>

#include "microlane/kernel_list.h"
#include "src/dispatch.h"

namespace microlane {
namespace {

// table(a constant) of the distribution with that number in Normals.
template <class Table, std::size_t... kNormals>
const FamilyFunction* OfNormals(std::size_t normals, std::index_sequence<kNormals...>, const Table& table) {
  const FamilyFunction* found = nullptr;
  ((normals == kNormals
        ? void(found = table(std::integral_constant<Normals, static_cast<Normals>(kNormals)>()))
        : void()),
   ...);
  return found;
}

const FamilyFunction* TableOf(std::size_t kernel) {
  constexpr auto families = std::make_index_sequence<kNumModelFamilies>();
  if (kernel >= kFirstReflectorKernel) {
    return OfNormals(static_cast<std::size_t>(PlaceOfReflectorKernel(kernel).normals), families,
                     [](auto normals) { return RoughReflectorTable<decltype(normals)::value>(); });
  }
  if (kernel >= kFirstDielectricKernel) {
    return OfNormals(static_cast<std::size_t>(PlaceOfDielectricKernel(kernel).normals), families,
                     [](auto normals) { return RoughDielectricTable<decltype(normals)::value>(); });
  }
  if (kernel >= kNumComponentKernels) {
    const NormalRow& row = kNormalRows[kNormalKernelPlaces[kernel - kNumComponentKernels].row];
    return OfNormals(static_cast<std::size_t>(row.normals), families,
                     [](auto normals) { return NormalsTable<decltype(normals)::value>(); });
  }
  const std::string_view id = kKernels[kernel].id;
  const std::string_view family = id.substr(0, id.find('.'));
  return family == "math"        ? MathTable()
         : family == "fresnel"   ? FresnelTable()
         : family == "masking"   ? MaskingTable()
         : family == "roughness" ? RoughnessTable()
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
