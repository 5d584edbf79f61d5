// The high-precision truth of every entry of the kernel list.
#ifndef MICROLANE_TESTS_ORACLE_ORACLE_H_
#define MICROLANE_TESTS_ORACLE_ORACLE_H_

#include <cstddef>
#include <limits>

#include "microlane/kernel_list.h"
#include "oracle/real.h"
#include "oracle/rough_dielectric.h"

namespace microlane::oracle {

struct Result {
  Real exact[kMaxOutputs];  // the value; infinite where it is, whatever the kernel saturates to
  // The value whose ulp is the unit of error: exact for kUlp and kExact, 1 for kDirection,
  // |exact| kappa for kConditioned.
  Real scale[kMaxOutputs];
  // Of kConditioned outputs: kappa holds for errors of the geometry up to a fraction of 1/curvature; beyond
  // it the output has other slopes.
  double curvature[kMaxOutputs] = {};
  // Sampling: the least change of wi.m, wo.z or u3, to first order, that turns a decision (side of m, choice
  // by Fresnel, total internal reflection, side of wo). Infinite where nothing was decided by rounding.
  double margin;
  // The same of the choice between the facets of a V-cavity, as a relative change of the dot products.
  double facet_margin = std::numeric_limits<double>::infinity();
};

// Evaluates entry `kernel` of the list at `inputs`, in its order and exactly as given. A NaN among them makes
// every output NaN. A lobe_hint of 0, 1 or 2 judges a sample as if that lobe had been chosen: callers pass
// the lobe of the code under test when margin excuses a different choice; other_facet as if the other facet
// of its V-cavity had been, when facet_margin does.
Result Evaluate(std::size_t kernel, const double* inputs, Transport transport = Transport::kRadiance,
                int lobe_hint = -1, bool other_facet = false);
Result Evaluate(std::size_t kernel, const Real* inputs, Transport transport = Transport::kRadiance,
                int lobe_hint = -1, bool other_facet = false);

// Whether the oracle knows the entry; otherwise Evaluate gives NaN.
bool HasKernel(std::size_t kernel);

}  // namespace microlane::oracle

#endif  // MICROLANE_TESTS_ORACLE_ORACLE_H_
