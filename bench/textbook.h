// The first yardstick: every entry of the kernel list as renderers carry it today. One lane at a time, float,
// normalised half vectors, D, Lambda and Fresnel apart, std:: mathematics. See textbook.cc.
#ifndef MICROLANE_BENCH_TEXTBOOK_H_
#define MICROLANE_BENCH_TEXTBOOK_H_

#include <cstddef>

#include "microlane/packets.h"

namespace microlane::textbook {

// Runs entry `kernel` of kKernels over n lanes.
void Run(std::size_t kernel, const Call<float>& call, std::size_t n);

}  // namespace microlane::textbook

#endif  // MICROLANE_BENCH_TEXTBOOK_H_
