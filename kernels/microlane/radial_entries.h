// The numbers of a table of radial_table.h, which describes them: data, that lanes, scalar code and tests
// look up.
#ifndef MICROLANE_RADIAL_ENTRIES_H_
#define MICROLANE_RADIAL_ENTRIES_H_

#include <cstddef>

namespace microlane {

// Cells of x >= 0, by u = 1 + x: cell j is part (j mod 2^bits) of the 2^bits equal parts of octave j/2^bits
// of u.
//
// A function g of x: in a cell g = c0 + c1 p + c2 p^2 + c3 p^3, p from 0 where it begins to 1 where it ends.
// The last ends at x = end; from there on g = tail_value + tail_slope log(x/end).
struct RadialCurve {
  static constexpr std::size_t kCellBits = 5;

  const double* cells;  // c0, c1, c2, c3 of each
  std::size_t count;
  double end, tail_value, tail_slope;
};

// A function g of x and y. Each cell of y has such coefficients in every row; four rows stand at p = 0, 1/4,
// 3/4, 1 of a cell of x, neighbours sharing the last, and g is the cubic through them. g stays as it is
// beyond.
struct RadialSurface {
  static constexpr std::size_t kRowBits = 1, kCellBits = 3;

  const double* cells;           // c0, c1, c2, c3 of each cell of a row, row by row
  std::size_t row_cells, count;  // of x, and of y
};

// Of slopes of density f(r) at unit roughness.
struct RadialEntries {
  RadialCurve density;   // log(pi f(r) (1 + r^2)^2) of r
  RadialCurve masking;   // log(W(a)), W(a) = a Lambda(a), a = 1/tan(theta) (Heitz 2014 Eqs. 72, 73)
  RadialCurve quantile;  // log(1 + r^2)/y of sqrt(y), y = -log(1 - u), where slopes up to r have the share u
  // W, and the share of slopes with a part along one axis above a, which is -dW/da, where masking's cells
  // begin and the last ends; kNodes of them, 0 beyond.
  static constexpr std::size_t kNodes = 512;
  const double* area;
  const double* above;
  // asinh(y/sqrt(1 + t^2))/x of t and x: of slopes with the part t along one axis, e^-x have one above y
  // across it, in absolute value.
  RadialSurface across;
};

}  // namespace microlane

#endif  // MICROLANE_RADIAL_ENTRIES_H_
