// Instructions that a call executes, counted by executing it: the code is stepped through one instruction at
// a time (the processor's trap flag) and each is classified by its encoding. So the counts are of the very
// code that is timed. On x86-64 Linux only.
#ifndef MICROLANE_BENCH_OPERATIONS_H_
#define MICROLANE_BENCH_OPERATIONS_H_

#include <cstddef>
#include <functional>

#include "ceilings.h"

namespace microlane {

struct Operations {
  // Vector instructions by width and element type, as in Ceilings. Counts are of instructions, and become
  // fractions when scaled to one vector of lanes.
  double vector[kWidths][2][kUnits] = {};
  double loads = 0, stores = 0;  // of vectors
  double all = 0;                // scalar instructions too

  double Count(Unit unit) const;

  Operations& operator-=(const Operations& other);
  Operations& operator*=(double factor);
};

// Whether this machine can be stepped.
bool CanCountOperations();

// What `function` executes. Not re-entrant.
Operations CountOperations(const std::function<void()>& function);

}  // namespace microlane

#endif  // MICROLANE_BENCH_OPERATIONS_H_
