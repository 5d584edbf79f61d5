// Time of a kernel beside both yardsticks: the textbook code, and its own floor.
#ifndef MICROLANE_BENCH_PERFORMANCE_H_
#define MICROLANE_BENCH_PERFORMANCE_H_

#include <cstddef>
#include <cstdint>
#include <cstring>

#include "microlane/packets.h"
#include "operations.h"
#include "stopwatch.h"
#include "workload.h"

namespace microlane {

// The least time that a kernel's own operations take on the chosen target, in nanoseconds per lane: the
// largest of
//   divider: divisions and roots, at their measured throughputs, one after the other;
//   vector:  multiplications at theirs, additions at theirs, or all vector instructions at that of a bitwise
//   one,
//            whichever takes longest (they share ports), and the approximations at theirs;
//   memory:  its arrays loaded and stored and nothing else.
// So it says how well the operations overlap, not whether fewer would do; and it is a bound from below:
// latencies, the front end and scalar instructions are left out.
struct Floor {
  Operations per_vector;  // instructions per whole vector of float lanes
  double divider = 0, vector = 0, memory = 0;

  double ns() const;
};

// Of the operations that an accuracy of a kernel executes for a few hundred lanes on the chosen target. Zero
// in all but memory where operations cannot be counted.
Floor MeasureFloor(std::size_t kernel, Accuracy accuracy, Parameters parameters);

// The ways to compute a kernel that are compared.
enum class Path { kHigh, kStandard, kFast, kScalarFloat, kScalarDouble, kTextbook };
inline constexpr std::size_t kPaths = 6;
inline constexpr const char* kPathNames[kPaths] = {"high",         "standard",      "fast",
                                                   "scalar float", "scalar double", "textbook"};

inline constexpr Path kLanePaths[] = {Path::kHigh, Path::kStandard, Path::kFast};

Path PathOf(Accuracy accuracy);
Accuracy AccuracyOf(Path path);  // of a lane path

void RunPath(std::size_t kernel, Path path, const Call<float>& call, std::size_t n);

// Lanes of a batch whose throughput is measured.
inline constexpr std::size_t kBatches = 3;
inline constexpr std::size_t kBatchLanes[kBatches] = {16, 256, 4096};
inline constexpr std::size_t kLongBatch = kBatches - 1;

// One lane whose first input waits for the first output of the call before.
class Chain {
 public:
  Chain(std::size_t kernel, Parameters parameters);

  template <class Run>
  void Step(const Run& run) {
    std::memcpy(&input_, &bits_, sizeof input_);
    run(call_);
    std::memcpy(&bits_, &output_, sizeof bits_);
    bits_ = first_ ^ (bits_ & none_);
  }

 private:
  const Workload workload_;
  Call<float> call_;
  float input_ = 0, output_ = 0;
  std::uint32_t first_ = 0, bits_ = 0, none_ = 0;
};

// Nanoseconds per call of such a chain.
double MeasureLatency(std::size_t kernel, Path path, Parameters parameters, double seconds);

// Whether the kernel has parameters that may be one value for the batch.
bool HasParameters(std::size_t kernel);

// Nanoseconds per lane of batches of `workload` on the chosen target; `seconds` is how long to repeat.
Timing MeasurePath(std::size_t kernel, Path path, const Workload& workload, double seconds);

// Nanoseconds per lane of the textbook code at 4096 lanes; measured once for each kernel and choice of
// parameters.
double TextbookTime(std::size_t kernel, Parameters parameters);

}  // namespace microlane

#endif  // MICROLANE_BENCH_PERFORMANCE_H_
