// The figures of Kelemen 2001, and what tables cost: their error against their size and the time to build
// them.
#ifndef MICROLANE_BENCH_KELEMEN_H_
#define MICROLANE_BENCH_KELEMEN_H_

#include <cstddef>
#include <string>
#include <vector>

#include "curves.h"

namespace microlane {

// By the lanes of the chosen target, high accuracy. Lobes are in the plane of incidence: x and y are the part
// along the surface, on the side of the mirror direction, and that along the normal.
struct KelemenFigures {
  std::vector<Curve> lobes;           // Fig. 2: reflected radiance, F = 1, m = 0.1
  std::vector<Curve> albedos;         // Fig. 3: of Ward, Phong and GGX over degrees, F = 1
  std::vector<Curve> matte;           // Fig. 4, left: the matte BRDF, m = 0.8
  std::vector<Curve> matte_radiance;  // Fig. 4, right: the radiance it reflects
  std::vector<Curve> coupled;         // Fig. 5: albedo of the parts and of both over degrees, m = 0.8
  std::vector<Curve> cook_torrance;   // for Fig. 6: radiance over degrees, by V-cavities and by Eq. 3
};
KelemenFigures MeasureKelemen();

// The largest error of a table's albedo between its entries, against the quadrature that it is made with; of
// a table of slopes what the table itself states.
struct TableCost {
  std::string what;
  std::size_t bytes;
  double ms;                                      // the median of several
  double error;                                   // of the albedo; of D
  double masking = 0, sampling = 0, visible = 0;  // of tables of slopes
};
std::vector<TableCost> MeasureAlbedoTables();
std::vector<TableCost> MeasureRadialTables();

}  // namespace microlane

#endif  // MICROLANE_BENCH_KELEMEN_H_
