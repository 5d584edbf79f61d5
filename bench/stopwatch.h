// Time of one call, by repetition.
#ifndef MICROLANE_BENCH_STOPWATCH_H_
#define MICROLANE_BENCH_STOPWATCH_H_

#include <algorithm>
#include <chrono>
#include <cstddef>
#include <vector>

namespace microlane {

struct Timing {
  double min = 0, median = 0;  // nanoseconds per call, over the repetitions
};

// Repetitions of at least 20 microseconds each for `seconds` in all. The smallest is what the machine can do;
// how far the median lies above it shows how quiet the machine was.
template <class Function>
Timing Measure(double seconds, const Function& function) {
  using Clock = std::chrono::steady_clock;
  const auto nanoseconds = [](Clock::duration d) {
    return std::chrono::duration<double, std::nano>(d).count();
  };
  std::size_t calls = 1;
  for (;; calls *= 2) {
    const auto start = Clock::now();
    for (std::size_t i = 0; i < calls; ++i) function();
    if (nanoseconds(Clock::now() - start) >= 20e3) break;
  }
  std::vector<double> times;
  const auto begin = Clock::now();
  do {
    const auto start = Clock::now();
    for (std::size_t i = 0; i < calls; ++i) function();
    times.push_back(nanoseconds(Clock::now() - start) / static_cast<double>(calls));
  } while (nanoseconds(Clock::now() - begin) < seconds * 1e9 || times.size() < 3);
  const auto middle = times.begin() + static_cast<std::ptrdiff_t>(times.size() / 2);
  std::nth_element(times.begin(), middle, times.end());
  return {*std::min_element(times.begin(), times.end()), *middle};
}

}  // namespace microlane

#endif  // MICROLANE_BENCH_STOPWATCH_H_
