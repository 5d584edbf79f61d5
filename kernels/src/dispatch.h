// From a public call to the chosen target's code. Includes no Highway.
#ifndef MICROLANE_SRC_DISPATCH_H_
#define MICROLANE_SRC_DISPATCH_H_

#include <atomic>
#include <cstddef>

#include "microlane/call.h"
#include "microlane/kernel_list.h"
#include "microlane/packets.h"

namespace microlane {

// One kernel on one target.
struct KernelCode {
  void (*standard)(const Call<float>&, std::size_t);
  void (*fast)(const Call<float>&, std::size_t);
  void (*high)(const Call<float>&, std::size_t);
  void (*double_lanes)(const Call<double>&, std::size_t);
};

// One family of kernels on one target: those of the kernel list from index `first` on.
struct FamilyCode {
  const KernelCode* kernels;
  std::size_t first;
};

using FamilyFunction = FamilyCode (*)();

// Index of the chosen target in the tables that HWY_EXPORT makes; kNotChosen before the first use.
inline constexpr std::size_t kNotChosen = ~std::size_t{0};
extern std::atomic<std::size_t> chosen_table_index;
std::size_t ChooseInitialTarget();  // its index

inline std::size_t ChosenTableIndex() {
  const std::size_t index = chosen_table_index.load(std::memory_order_relaxed);
  return index != kNotChosen ? index : ChooseInitialTarget();
}

// The code of a kernel of the family, by its index in the kernel list.
inline const KernelCode& CodeOf(const FamilyFunction* table, std::size_t kernel) {
  const FamilyCode family = table[ChosenTableIndex()]();
  return family.kernels[kernel - family.first];
}

inline void Run(const KernelCode& code, Accuracy accuracy, const Call<float>& call, std::size_t n) {
  (accuracy == Accuracy::kHigh   ? code.high
   : accuracy == Accuracy::kFast ? code.fast
                                 : code.standard)(call, n);
}
inline void Run(const KernelCode& code, Accuracy, const Call<double>& call, std::size_t n) {
  code.double_lanes(call, n);
}

// Each family's dispatch table.
const FamilyFunction* MathTable();
const FamilyFunction* FresnelTable();
const FamilyFunction* HalfVectorTable();
const FamilyFunction* HalfVectorDensityTable();
const FamilyFunction* MaskingTable();
const FamilyFunction* RoughnessTable();
const FamilyFunction* AlbedoLookupTable();
const FamilyFunction* CoupledTable();
const FamilyFunction* InterfacedTable();
const FamilyFunction* GaussianTable();
template <Normals kNormals>
const FamilyFunction* NormalsTable();
template <Normals kNormals>
const FamilyFunction* RoughDielectricTable();
template <Normals kNormals>
const FamilyFunction* RoughReflectorTable();
template <Normals kNormals, Scatterer kScatterer>
const FamilyFunction* RoughDiffuseTable();
template <Normals kNormals>
const FamilyFunction* MeanFresnelTable();
template <>
const FamilyFunction* NormalsTable<Normals::kGgx>();
template <>
const FamilyFunction* NormalsTable<Normals::kBeckmann>();
template <>
const FamilyFunction* NormalsTable<Normals::kPhong>();
template <>
const FamilyFunction* NormalsTable<Normals::kStudentT>();
template <>
const FamilyFunction* NormalsTable<Normals::kTabulated>();
template <>
const FamilyFunction* RoughDielectricTable<Normals::kGgx>();
template <>
const FamilyFunction* RoughDielectricTable<Normals::kBeckmann>();
template <>
const FamilyFunction* RoughDielectricTable<Normals::kPhong>();
template <>
const FamilyFunction* RoughReflectorTable<Normals::kGgx>();
template <>
const FamilyFunction* RoughReflectorTable<Normals::kBeckmann>();
template <>
const FamilyFunction* RoughReflectorTable<Normals::kPhong>();
template <>
const FamilyFunction* RoughDiffuseTable<Normals::kGgx, Scatterer::kLambertian>();
template <>
const FamilyFunction* RoughDiffuseTable<Normals::kBeckmann, Scatterer::kLambertian>();
template <>
const FamilyFunction* RoughDiffuseTable<Normals::kGgx, Scatterer::kInterfaced>();
template <>
const FamilyFunction* RoughDiffuseTable<Normals::kBeckmann, Scatterer::kInterfaced>();
template <>
const FamilyFunction* MeanFresnelTable<Normals::kGgx>();
template <>
const FamilyFunction* MeanFresnelTable<Normals::kBeckmann>();

// What CallBuilder::Run runs: the kernel of that index, of the family that the table stands for.
template <class T>
void RunFrom(const FamilyFunction* table, std::size_t kernel, Accuracy accuracy, const Call<T>& call,
             std::size_t n) {
  Run(CodeOf(table, kernel), accuracy, call, n);
}

}  // namespace microlane

#endif  // MICROLANE_SRC_DISPATCH_H_
