// What `microlane report` measures.
#ifndef MICROLANE_BENCH_REPORT_DATA_H_
#define MICROLANE_BENCH_REPORT_DATA_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "ceilings.h"
#include "glasses.h"
#include "performance.h"

namespace microlane {

// One path of one kernel.
struct PathResult {
  Timing time;         // ns per lane, 4096 lanes, per-lane parameters
  double max_ulp = 0;  // over the outputs and all points; infinite where one is NaN without cause
  double mean_ulp = 0;
  std::uint64_t points = 0, nan_count = 0;
  // Of high, standard and fast only:
  double bound = 0;
  double time16 = 0, time_uniform = 0;  // ns per lane with 16 lanes, and with uniform parameters
  Floor floor;
};

struct KernelResult {
  std::size_t kernel;
  std::array<PathResult, kPaths> path;

  const PathResult& operator[](Path p) const { return path[static_cast<std::size_t>(p)]; }
  PathResult& operator[](Path p) { return path[static_cast<std::size_t>(p)]; }
  double Speedup(Path p) const { return (*this)[Path::kTextbook].time.min / (*this)[p].time.min; }
  double OverFloor(Path p) const { return (*this)[p].time.min / (*this)[p].floor.ns(); }
};

// Time of one kernel on one of the other targets.
struct TargetTime {
  std::string target;
  std::size_t kernel;
  Path path;
  double ns;
};

// A figure to reach, and the one reached.
struct Goal {
  std::string what, goal, reached;
  bool met;
};

struct ReportData {
  std::string target, machine, compiler;
  double seconds = 0;  // the whole run
  Ceilings ceilings;
  std::vector<KernelResult> kernels;
  std::vector<TargetTime> targets;
  std::vector<GlassCurve> glasses;
  std::vector<Goal> goals;
};

}  // namespace microlane

#endif  // MICROLANE_BENCH_REPORT_DATA_H_
