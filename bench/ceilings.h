// The second yardstick: what the machine itself can do on the chosen target.
#ifndef MICROLANE_BENCH_CEILINGS_H_
#define MICROLANE_BENCH_CEILINGS_H_

#include <cstddef>

#include "microlane/packets.h"

namespace microlane {

// What instructions compete for.
enum class Unit {
  kMultiplication,  // and fused multiply-add
  kAddition,        // subtraction, comparison, minimum, maximum, rounding, conversion
  kLogic,           // bitwise and integer operations, selections, shuffles, masks
  kDivision,
  kRoot,
  kReciprocal,      // approximate
  kReciprocalRoot,  // approximate
};
inline constexpr std::size_t kUnits = 7;
inline constexpr const char* kUnitNames[kUnits] = {"multiply", "add",    "bitwise", "divide",
                                                   "root",     "~recip", "~rroot"};

// Width of an instruction's registers in bytes, as an index.
inline constexpr std::size_t kWidths = 4;
inline constexpr std::size_t kWidthBytes[kWidths] = {8, 16, 32, 64};  // the first: one number only

// Nanoseconds per instruction when nothing else runs and none waits for another: fused multiply-add
// (multiplication where the target has none), addition, bitwise and-not, and so on; Highway's approximations
// (float only) at the end.
struct Ceilings {
  double ns[kWidths][2][kUnits] = {};  // width, float or double, unit; 0 where the target has no such vector

  // That of the nearest width measured.
  double Of(std::size_t width, bool is_double, Unit unit) const;
};

// Measured on first use of each target, in about 0.3 s.
const Ceilings& ChosenCeilings();

// Lanes of a whole float vector of the chosen target.
std::size_t FloatLanes();

// The call's per-lane arrays loaded, combined by exclusive or, and the result stored to every output.
void LoadAndStore(const Call<float>& call, std::size_t loaded, std::size_t stored, std::size_t n);

}  // namespace microlane

#endif  // MICROLANE_BENCH_CEILINGS_H_
