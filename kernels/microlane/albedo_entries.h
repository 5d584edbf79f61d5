// The numbers of a table of albedo.h, which describes them: data, that lanes, scalar code and tests look up.
#ifndef MICROLANE_ALBEDO_ENTRIES_H_
#define MICROLANE_ALBEDO_ENTRIES_H_

#include <cstddef>
#include <cstdint>

namespace microlane {

// What is in a table.
struct AlbedoEntries {
  static constexpr std::size_t kCellBits = 5, kCells = std::size_t{1} << kCellBits;  // of an octave

  double offset;             // c
  std::size_t last;          // of the nodes 0, at mu = 0, to last, at mu = 1
  const float* albedo;       // a of each node; that of the last stands twice
  const float* deficit;      // 1 - a, likewise
  const double* cumulative;  // Int (1 - a) mu dmu from each node to 1, of the cells' linear 1 - a
  // Cosines of density (1 - a) mu dmu: those with u of it between them and the normal lie guide_steps cells
  // at most beyond guide[j], j the cell of sqrt(1 - u).
  const std::uint32_t* guide;
  int guide_steps;
  double mean_deficit;  // 2 Int (1 - a) mu dmu over all of them, which is 1 - the average albedo
  double matte_scale;   // s = 1/(pi (1 - the average albedo)) of Kelemen 2001 Eq. 7; 0 if nothing is left

  // mu of a node; the difference of two is exact to a rounding.
  double Node(std::size_t j) const {
    const double octave = offset * static_cast<double>(std::size_t{1} << (j / kCells));
    return (octave * (1 + static_cast<double>(j % kCells) / kCells) - offset) / (1 - offset);
  }
};

}  // namespace microlane

#endif  // MICROLANE_ALBEDO_ENTRIES_H_
