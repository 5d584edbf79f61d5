// Tables of albedo.h.
#ifndef MICROLANE_SCALAR_ALBEDO_H_
#define MICROLANE_SCALAR_ALBEDO_H_

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "microlane/albedo.h"
#include "microlane/scalar/math.h"

namespace microlane::scalar {

// A place between nodes j and j + 1 of a table.
struct AlbedoCell {
  std::size_t j;
  double part;
};

inline AlbedoCell FindCell(const AlbedoEntries& table, double cosine) {
  const double mu = std::min(std::abs(cosine), 1.0);
  const double x = mu + table.offset * (1 - mu);
  int octave;
  const double mantissa = 2 * std::frexp(x / table.offset, &octave);  // in [1, 2)
  const double cells = (mantissa - 1) * AlbedoEntries::kCells, cell = std::floor(cells);
  return {static_cast<std::size_t>(octave - 1) * AlbedoEntries::kCells + static_cast<std::size_t>(cell),
          cells - cell};
}

// The last entry stands twice, so that mu = 1 has a cell.
inline double Interpolate(const float* entries, const AlbedoCell& cell) {
  const double y0 = double{entries[cell.j]}, y1 = double{entries[cell.j + 1]};
  return y0 + cell.part * (y1 - y0);
}

}  // namespace microlane::scalar

#endif  // MICROLANE_SCALAR_ALBEDO_H_
