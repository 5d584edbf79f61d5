// User-supplied distributions of slopes (Heitz 2014 Eqs. 65, 73, 87): tables of a radial function f, from
// which tabulated.h has densities, masking and sampling in every kind of roughness.
//
// A table is made once from f(r) > 0, the density of slopes at distance r from their mean at unit roughness,
// up to a factor: the table normalises it. f is asked about 1000 times, in the constructor alone. It must be
// positive and finite from r = 0 until it is below 1e-30 of f(0), smooth, and fall at least as r^-3.05 in the
// end: Lambda exists where it falls faster than r^-3. Where it is negligible, and from r = 2^12 on, its last
// power of r is taken to go on.
//
// Entries are cubics of logarithms. error() of a table that is not ok names f, where it failed and what is
// wanted. A table is read only; calls in other threads may share it.
#ifndef MICROLANE_RADIAL_TABLE_H_
#define MICROLANE_RADIAL_TABLE_H_

#include <cstddef>
#include <functional>
#include <vector>

#include "microlane/prepared.h"
#include "microlane/radial_entries.h"

namespace microlane {

class RadialTable : public Prepared {
 public:
  explicit RadialTable(const std::function<double(double)>& f);

  // Entries point into the table itself.
  RadialTable(const RadialTable&) = delete;
  RadialTable& operator=(const RadialTable&) = delete;

  const RadialEntries& entries() const { return entries_; }
  std::size_t bytes() const { return cells_.size() * sizeof(double); }

  // What the entries are off by, largest relative errors found: of D and of Lambda, from the middle of cells,
  // where D at unit roughness, and a Lambda(a), are more than 1e-30 of what they are at 0; of the density
  // with which sample_normal finds normals, against D cos, from the ends of cells, where it is most.
  double density_error() const { return density_error_; }
  double masking_error() const { return masking_error_; }
  double sampling_error() const { return sampling_error_; }
  // Of the density with which sample_visible_normal finds normals, against D_visible, where all but 1e-12
  // are.
  double visible_sampling_error() const { return visible_sampling_error_; }

 private:
  class Builder;

  std::vector<double> cells_;
  RadialEntries entries_{};
  double density_error_ = 0, masking_error_ = 0, sampling_error_ = 0, visible_sampling_error_ = 0;
};

}  // namespace microlane

#endif  // MICROLANE_RADIAL_TABLE_H_
