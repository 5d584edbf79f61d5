// Every kernel by its index in the kernel list: for tools and tests, which are driven by the list. A program
// that links this links every kernel; the family headers (ggx.h, ...) link one object per family.
#ifndef MICROLANE_KERNELS_H_
#define MICROLANE_KERNELS_H_

#include <cstddef>

#include "microlane/packets.h"

namespace microlane {

// Runs kernel `kernel` (an index into kKernels) on the chosen target. Thread-safe. Of a kernel that takes an
// object and a call without one, in[columns] and those after it are what it is made from: each run of lanes
// with equal values gets its own.
void RunKernel(std::size_t kernel, Accuracy accuracy, const Call<float>& call, std::size_t n);
// Double lanes; there is one accuracy.
void RunKernel(std::size_t kernel, const Call<double>& call, std::size_t n);

}  // namespace microlane

#endif  // MICROLANE_KERNELS_H_
