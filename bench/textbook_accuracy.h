// The error of the textbook code against the oracle.
#ifndef MICROLANE_BENCH_TEXTBOOK_ACCURACY_H_
#define MICROLANE_BENCH_TEXTBOOK_ACCURACY_H_

#include <cstddef>
#include <cstdint>

namespace microlane {

struct TextbookError {
  std::uint64_t points = 0, nan_count = 0;  // of the latter, points with a NaN or an infinity in an output
  double max_ulp = 0, mean_ulp = 0;         // over finite outputs
};

// `samples` random points, a grid and the extremes, as for the kernels, all judged by the oracle.
TextbookError MeasureTextbook(std::size_t kernel, std::uint64_t samples, std::uint64_t seed);

}  // namespace microlane

#endif  // MICROLANE_BENCH_TEXTBOOK_ACCURACY_H_
