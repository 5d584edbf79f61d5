// The error of any kernel, in any accuracy and on any target, against the oracle.
#ifndef MICROLANE_TESTS_ACCURACY_H_
#define MICROLANE_TESTS_ACCURACY_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "microlane/kernel_list.h"
#include "microlane/packets.h"
#include "points.h"

namespace microlane {

struct AccuracyOptions {
  // "" or "best", one of SupportedTargets(), or the scalar code: "scalar" (float), "scalar-double".
  std::string target;
  Accuracy accuracy = Accuracy::kStandard;  // of float lanes
  bool double_lanes = false;                // errors are then in ULP of double
  Values values = Values::kFloats;          // declared bounds hold for kFloats
  std::uint64_t samples = 100000;  // random points; a tenth more goes to a search from the worst ones
  std::size_t grid = 10000;        // about how many grid points
  bool extremes = true;
  std::uint64_t seed = 1;
  // Float results are first compared with the scalar code in double; the oracle judges every point whose
  // error comes near the largest, and 1 in this many of the others. 1: the oracle judges all.
  std::uint64_t oracle_share = 64;
  unsigned threads = 0;  // 0: one for each processor
  std::function<void(std::uint64_t done, std::uint64_t total)>
      progress;  // called now and then, from one thread
};

// Where an error is largest.
struct WorstCase {
  double ulp = -1;
  Point in{};
  Transport transport = Transport::kRadiance;
  double got = 0, exact = 0;
};

struct OutputReport {
  std::string name;
  double max_ulp = 0;
  double mean_ulp = 0, correctly_rounded = 0;  // the latter a share; of all points but those of the search
  WorstCase worst;
};

struct AccuracyReport {
  std::uint64_t points = 0;  // random, grid, extremes and search
  std::uint64_t judged = 0;  // of which by the oracle
  std::vector<OutputReport> outputs;
  double max_ulp = 0;            // over the outputs
  std::size_t worst_output = 0;  // which
  double max_relative = 0;       // largest relative error of a normal float whose metric is kUlp
  std::uint64_t nan_count = 0;   // points with a NaN or an infinity in an output
  std::uint64_t inf_count = 0;
  std::uint64_t lobes_excused = 0;  // samples that took another lobe than the oracle where rounding decides
  // Weights and densities of samples that an input rounding moves by so much that no digit is determined (see
  // Metric::kConditioned); only that they are finite is asked of them.
  std::uint64_t undetermined = 0;
  double bound = 0;  // declared; infinite for the scalar code
  bool ok = false;   // max_ulp <= bound, and no NaN or infinity
};

// The bound that the kernel list declares.
double DeclaredBound(std::size_t kernel, const AccuracyOptions& options);

// Random points, the grid, the extremes and a search; the same for the same options but threads and progress.
// Chooses the target while it runs, so calls with different targets must not overlap.
AccuracyReport MeasureAccuracy(std::size_t kernel, const AccuracyOptions& options);

// Only the points given, in either transport, under each of several options; asks the oracle once for all of
// them.
std::vector<AccuracyReport> MeasureAccuracy(std::size_t kernel, const std::vector<AccuracyOptions>& options,
                                            const std::vector<Point>& points);

// Only point(0) ... point(count - 1), called from several threads.
AccuracyReport MeasureAccuracy(std::size_t kernel, const AccuracyOptions& options,
                               const std::function<Point(std::uint64_t)>& point, std::uint64_t count);

// The outputs at each of the points.
std::vector<std::array<double, kMaxOutputs>> Compute(std::size_t kernel, const AccuracyOptions& options,
                                                     const std::vector<Point>& points,
                                                     Transport transport = Transport::kRadiance);

// High, standard, fast and double lanes on a target.
std::vector<AccuracyOptions> AllAccuracies(const std::string& target = "");

// "standard", "double", ...
std::string AccuracyName(const AccuracyOptions& options);

// Names and values of a point's inputs as C hex floats: "mx=0x1p-1 ...".
std::string Describe(std::size_t kernel, const Point& in);

// One line: points, largest error, bound, worst input.
std::string Describe(std::size_t kernel, const AccuracyOptions& options, const AccuracyReport& report);

}  // namespace microlane

#endif  // MICROLANE_TESTS_ACCURACY_H_
