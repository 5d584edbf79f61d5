// Buffers and inputs for timing: lanes as a renderer meets them, none of them 0 by definition if it can be
// helped.
#ifndef MICROLANE_BENCH_WORKLOAD_H_
#define MICROLANE_BENCH_WORKLOAD_H_

#include <cstddef>
#include <cstdlib>
#include <memory>

#include "microlane/kernel_list.h"
#include "microlane/packets.h"
#include "microlane/prepared.h"

namespace microlane {

enum class Parameters { kPerLane, kUniform };

inline constexpr int kWorkloadOrder = 4;       // of quadratures
inline constexpr double kWorkloadM = 0.3;      // of tables
inline constexpr double kWorkloadIndex = 1.7;  // of tables

// One batch of one kernel. Roughness is log-uniform in 0.01 to 1; eta lies in 1.2 to 2.5, or is the inverse
// of such; wi is on either side; the normal is drawn from the distribution, and wo is wi mirrored or
// refracted by it, so that all lobes the kernel has occur equally often. Every call with the same arguments
// makes the same lanes.
class Workload {
 public:
  Workload(std::size_t kernel, std::size_t n, Parameters parameters);

  const Call<float>& call() const { return call_; }
  std::size_t size() const { return n_; }
  std::size_t loaded() const { return loaded_; }  // arrays read in every iteration
  std::size_t stored() const { return stored_; }

 private:
  struct Free {
    void operator()(float* memory) const { std::free(memory); }
  };

  std::size_t n_, loaded_, stored_;
  std::unique_ptr<float, Free> memory_;
  std::shared_ptr<const Prepared> prepared_;
  Call<float> call_;
};

}  // namespace microlane

#endif  // MICROLANE_BENCH_WORKLOAD_H_
