#include "microlane/kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string_view>
#include <type_traits>
#include <utility>

#include "microlane/kernel_list.h"
#include "microlane/quadrature.h"
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
  if (kernel >= kFirstMeanFresnelKernel) {
    return PlaceOfMeanFresnelKernel(kernel).normals == Normals::kGgx ? MeanFresnelTable<Normals::kGgx>()
                                                                     : MeanFresnelTable<Normals::kBeckmann>();
  }
  if (kernel >= kFirstDiffuseKernel) {
    return PlaceOfDiffuseKernel(kernel).normals == Normals::kGgx ? RoughDiffuseTable<Normals::kGgx>()
                                                                 : RoughDiffuseTable<Normals::kBeckmann>();
  }
  if (kernel >= kFirstReflectorKernel) {
    return OfNormals(static_cast<std::size_t>(PlaceOfReflectorKernel(kernel).normals), families,
                     [](auto normals) -> const FamilyFunction* {
                       constexpr Normals kNormals = decltype(normals)::value;
                       if constexpr (NumReflectorKernels(kNormals) > 0)
                         return RoughReflectorTable<kNormals>();
                       return nullptr;
                     });
  }
  if (kernel >= kFirstDielectricKernel) {
    return OfNormals(static_cast<std::size_t>(PlaceOfDielectricKernel(kernel).normals), families,
                     [](auto normals) -> const FamilyFunction* {
                       constexpr Normals kNormals = decltype(normals)::value;
                       if constexpr (NumDielectricQuantities(kNormals) > 0)
                         return RoughDielectricTable<kNormals>();
                       return nullptr;
                     });
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

template <class T>
bool SameValue(T a, T b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

template <class T>
void RunWithRule(std::size_t kernel, Accuracy accuracy, const Call<T>& call, std::size_t n) {
  if (call.rule->ok()) {
    Run(CodeOf(Table(kernel), kernel), accuracy, call, n);
  } else {
    std::fill_n(call.out[0], n, std::numeric_limits<T>::quiet_NaN());
  }
}

// Lanes of equal order that follow each other, with one rule.
template <class T>
void RunByOrder(std::size_t kernel, Accuracy accuracy, const Call<T>& call, std::size_t n) {
  const Names inputs = Split(kKernels[kernel].inputs), outputs = Split(kKernels[kernel].outputs);
  const T* const orders = call.in[inputs.columns];
  const bool uniform = call.uniform[inputs.columns];
  for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
    const T order = orders[uniform ? 0 : begin];
    for (end = uniform ? n : begin + 1; end < n && SameValue(orders[end], order);) ++end;
    const QuadratureRule rule(order);
    Call<T> part = call;
    part.rule = &rule;
    for (std::size_t k = 0; k < inputs.columns; ++k) {
      if (!call.uniform[k]) part.in[k] += begin;
    }
    for (std::size_t k = 0; k < outputs.count; ++k) part.out[k] += begin;
    RunWithRule(kernel, accuracy, part, end - begin);
  }
}

template <class T>
void RunOne(std::size_t kernel, Accuracy accuracy, const Call<T>& call, std::size_t n) {
  static constexpr auto kTakesRule = [] {
    std::array<bool, kNumKernels> takes{};
    for (std::size_t k = kFirstDiffuseKernel; k < kNumKernels; ++k) takes[k] = TakesRule(k);
    return takes;
  }();
  if (!kTakesRule[kernel]) {
    Run(CodeOf(Table(kernel), kernel), accuracy, call, n);
  } else if (call.rule == nullptr) {
    RunByOrder(kernel, accuracy, call, n);
  } else {
    RunWithRule(kernel, accuracy, call, n);
  }
}

}  // namespace

void RunKernel(std::size_t kernel, Accuracy accuracy, const Call<float>& call, std::size_t n) {
  RunOne(kernel, accuracy, call, n);
}

void RunKernel(std::size_t kernel, const Call<double>& call, std::size_t n) {
  RunOne(kernel, Accuracy::kStandard, call, n);
}

}  // namespace microlane
