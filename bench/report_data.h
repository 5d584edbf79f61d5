// What `microlane report` measures.
#ifndef MICROLANE_BENCH_REPORT_DATA_H_
#define MICROLANE_BENCH_REPORT_DATA_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "cavities.h"
#include "ceilings.h"
#include "glasses.h"
#include "kelemen.h"
#include "meneveaux.h"
#include "performance.h"
#include "textbook_accuracy.h"

namespace microlane {

// One path of one kernel. Times are in nanoseconds per lane.
struct PathResult {
  // Of high, standard, fast and textbook by parameters and batch; of the scalar code the one with per-lane
  // parameters and the longest batch.
  Timing batch[2][kBatches];
  double latency[2] = {};
  double slowest_round = 0;  // least time of the worst round, where the batch above is that of the best
  double max_ulp = 0;        // over the outputs and all points; infinite where one is NaN without cause
  double mean_ulp = 0;
  double max_relative = 0;  // AccuracyReport's
  std::uint64_t points = 0, nan_count = 0;
  // Of high, standard and fast:
  double bound = 0;
  Floor floor;

  const Timing& time() const { return batch[0][kLongBatch]; }
  double ShortOverLong() const { return batch[0][0].min / time().min; }
};

struct KernelResult {
  std::size_t kernel;
  std::array<PathResult, kPaths> path;

  const PathResult& operator[](Path p) const { return path[static_cast<std::size_t>(p)]; }
  PathResult& operator[](Path p) { return path[static_cast<std::size_t>(p)]; }
  double Speedup(Path p) const { return (*this)[Path::kTextbook].time().min / (*this)[p].time().min; }
  double OverFloor(Path p) const { return (*this)[p].time().min / (*this)[p].floor.ns(); }
};

// Time of one kernel on one of the other targets.
struct TargetTime {
  std::string target;
  std::size_t kernel;
  Path path;
  double ns;
};

// One kernel at the inputs of one row of the stiff and extreme cases, on the report's target.
inline constexpr std::size_t kStabilityPaths = 4;
inline constexpr const char* kStabilityNames[kStabilityPaths] = {"high", "standard", "fast", "double"};
struct StabilityResult {
  std::string row, what;  // id of the row, its cases
  std::size_t kernel;
  std::uint64_t points = 0;
  double max_ulp[kStabilityPaths] = {}, bound[kStabilityPaths] = {};
  std::uint64_t nan_count[kStabilityPaths] = {};  // and infinities
  TextbookError textbook;

  double OverBound(std::size_t p) const { return max_ulp[p] / bound[p]; }
  bool Holds(std::size_t p) const { return nan_count[p] == 0 && max_ulp[p] <= bound[p]; }
  bool Holds() const { return Holds(0) && Holds(1) && Holds(2) && Holds(3); }
};

// A figure to reach, and the one reached.
struct Goal {
  std::string what, goal, reached;
  bool met;
};

struct ReportData {
  std::string target, machine, compiler, commit, date;
  unsigned processors = 0;
  std::uint64_t samples = 0;  // random points of each kernel and accuracy
  double noise_median = 0,
         noise_tenth = 0;  // of the slowest over the best round less 1: median, 9th decile
  double seconds = 0;      // the whole run
  Ceilings ceilings;
  std::vector<KernelResult> kernels;
  std::vector<TargetTime> targets;
  std::vector<StabilityResult> stability;  // the results of a row together
  std::vector<GlassCurve> glasses;
  KelemenFigures kelemen;
  MeneveauxFigures meneveaux;
  std::vector<CavityFigure> cavities;
  std::vector<TableCost> albedo_tables, radial_tables;
  std::vector<Goal> goals;
};

}  // namespace microlane

#endif  // MICROLANE_BENCH_REPORT_DATA_H_
