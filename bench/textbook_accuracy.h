// The error of the textbook code against the oracle.
#ifndef MICROLANE_BENCH_TEXTBOOK_ACCURACY_H_
#define MICROLANE_BENCH_TEXTBOOK_ACCURACY_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "points.h"

namespace microlane {

struct TextbookError {
  std::uint64_t points = 0, nan_count = 0;  // of the latter, points with a NaN or an infinity in an output
  double max_ulp = 0, mean_ulp = 0;         // over finite outputs

  TextbookError& operator+=(const TextbookError& other);
};

// All points are judged by the oracle.
TextbookError MeasureTextbook(std::size_t kernel, const std::vector<Point>& points);

}  // namespace microlane

#endif  // MICROLANE_BENCH_TEXTBOOK_ACCURACY_H_
