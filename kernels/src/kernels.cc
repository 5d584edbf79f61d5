#include "microlane/kernels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <string_view>
#include <type_traits>
#include <utility>

#include "microlane/kernel_list.h"
#include "microlane/prepared.h"
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
    const DiffuseKernelPlace place = PlaceOfDiffuseKernel(kernel);
    const bool ggx = place.normals == Normals::kGgx;
    if (place.scatterer == Scatterer::kInterfaced) {
      return ggx ? RoughDiffuseTable<Normals::kGgx, Scatterer::kInterfaced>()
                 : RoughDiffuseTable<Normals::kBeckmann, Scatterer::kInterfaced>();
    }
    return ggx ? RoughDiffuseTable<Normals::kGgx, Scatterer::kLambertian>()
               : RoughDiffuseTable<Normals::kBeckmann, Scatterer::kLambertian>();
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
  return family == "math"                  ? MathTable()
         : family == "fresnel"             ? FresnelTable()
         : family == "masking"             ? MaskingTable()
         : family == "roughness"           ? RoughnessTable()
         : family == "albedo"              ? AlbedoLookupTable()
         : family == "coupled"             ? CoupledTable()
         : family == "interfaced"          ? InterfacedTable()
         : family == "gaussian"            ? GaussianTable()
         : family == "half_vector_density" ? HalfVectorDensityTable()
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

constexpr auto kTakesPrepared = [] {
  std::array<bool, kNumKernels> takes{};
  for (std::size_t i = 0; i < kNumKernels; ++i) takes[i] = TakesPrepared(i);
  return takes;
}();

template <class T>
bool SameValue(T a, T b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

template <class T>
void RunPrepared(std::size_t kernel, Accuracy accuracy, const Call<T>& call, std::size_t n) {
  if (call.prepared->ok()) {
    Run(CodeOf(Table(kernel), kernel), accuracy, call, n);
    return;
  }
  const std::size_t outputs = Split(kKernels[kernel].outputs).count;
  for (std::size_t k = 0; k < outputs; ++k) {
    std::fill_n(call.out[k], n, std::numeric_limits<T>::quiet_NaN());
  }
}

// Lanes that follow each other, with one object made from what they have in common.
template <class T>
void PrepareAndRun(std::size_t kernel, Accuracy accuracy, const Call<T>& call, std::size_t n) {
  const Names inputs = Split(kKernels[kernel].inputs), outputs = Split(kKernels[kernel].outputs);
  const auto value = [&](std::size_t k, std::size_t lane) { return call.in[k][call.uniform[k] ? 0 : lane]; };
  const auto alike = [&](std::size_t a, std::size_t b) {
    for (std::size_t k = inputs.columns; k < inputs.count; ++k) {
      if (!SameValue(value(k, a), value(k, b))) return false;
    }
    return true;
  };
  for (std::size_t begin = 0, end = 0; begin < n; begin = end) {
    for (end = begin + 1; end < n && alike(begin, end);) ++end;
    double values[kMaxInputs];
    for (std::size_t k = inputs.columns; k < inputs.count; ++k) {
      values[k - inputs.columns] = static_cast<double>(value(k, begin));
    }
    const std::shared_ptr<const Prepared> prepared = Prepare(kernel, values);
    Call<T> part = call;
    part.prepared = prepared.get();
    for (std::size_t k = 0; k < inputs.columns; ++k) {
      if (!call.uniform[k]) part.in[k] += begin;
    }
    for (std::size_t k = 0; k < outputs.count; ++k) part.out[k] += begin;
    RunPrepared(kernel, accuracy, part, end - begin);
  }
}

template <class T>
void RunOne(std::size_t kernel, Accuracy accuracy, const Call<T>& call, std::size_t n) {
  if (!kTakesPrepared[kernel]) {
    Run(CodeOf(Table(kernel), kernel), accuracy, call, n);
  } else if (call.prepared == nullptr) {
    PrepareAndRun(kernel, accuracy, call, n);
  } else {
    RunPrepared(kernel, accuracy, call, n);
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
