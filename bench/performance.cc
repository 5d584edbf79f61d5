#include "performance.h"

#include <algorithm>
#include <array>
#include <vector>

#include "microlane/kernels.h"
#include "microlane/scalar/evaluate.h"
#include "textbook.h"

namespace microlane {
namespace {

scalar::Transport Scalar(Transport transport) {
  return transport == Transport::kRadiance ? scalar::Transport::kRadiance : scalar::Transport::kImportance;
}

template <class Real>
void RunScalar(std::size_t kernel, const Call<float>& call, std::size_t n) {
  const std::size_t inputs = Split(kKernels[kernel].inputs).count,
                    outputs = Split(kKernels[kernel].outputs).count;
  for (std::size_t i = 0; i < n; ++i) {
    Real in[kMaxInputs], out[kMaxOutputs];
    for (std::size_t k = 0; k < inputs; ++k) in[k] = static_cast<Real>(call.in[k][call.uniform[k] ? 0 : i]);
    scalar::Evaluate(kernel, in, out, Scalar(call.transport));
    for (std::size_t k = 0; k < outputs; ++k) call.out[k][i] = static_cast<float>(out[k]);
  }
}

}  // namespace

double Floor::ns() const { return std::max({divider, vector, memory}); }

Floor MeasureFloor(std::size_t kernel, Accuracy accuracy, Parameters parameters) {
  const Ceilings& ceilings = ChosenCeilings();
  Floor floor;
  const Workload memory_load(kernel, 4096, parameters);
  floor.memory =
      Measure(0.005,
              [&] { LoadAndStore(memory_load.call(), memory_load.loaded(), memory_load.stored(), 4096); })
          .min /
      4096;
  if (!CanCountOperations()) return floor;

  // A batch less a short one: what a call costs by itself falls out. Some vectors of a batch take a longer
  // path, so it has many.
  const std::size_t few = 64, many = few + (accuracy == Accuracy::kHigh ? 128 : 512);
  const Workload workload(kernel, many, parameters);
  RunKernel(kernel, accuracy, workload.call(), few);
  floor.per_vector = CountOperations([&] { RunKernel(kernel, accuracy, workload.call(), many); });
  floor.per_vector -= CountOperations([&] { RunKernel(kernel, accuracy, workload.call(), few); });
  const double lanes = static_cast<double>(FloatLanes());
  floor.per_vector *= lanes / static_cast<double>(many - few);

  double approximations = 0, multiplications = 0, additions = 0, all = 0;
  for (std::size_t w = 0; w < kWidths; ++w) {
    for (std::size_t t = 0; t < 2; ++t) {
      const auto count = [&](Unit unit) {
        return floor.per_vector.vector[w][t][static_cast<std::size_t>(unit)];
      };
      const auto time = [&](Unit unit) {
        return count(unit) > 0 ? count(unit) * ceilings.Of(w, t != 0, unit) : 0.0;
      };
      floor.divider += time(Unit::kDivision) + time(Unit::kRoot);
      approximations += time(Unit::kReciprocal) + time(Unit::kReciprocalRoot);
      multiplications += time(Unit::kMultiplication);
      additions += time(Unit::kAddition);
      all += (count(Unit::kMultiplication) + count(Unit::kAddition) + count(Unit::kLogic) +
              count(Unit::kDivision) + count(Unit::kRoot)) *
             ceilings.Of(w, t != 0, Unit::kLogic);
    }
  }
  floor.divider /= lanes;
  floor.vector = std::max({multiplications, additions, all}) + approximations;
  floor.vector /= lanes;
  return floor;
}

Timing MeasurePath(std::size_t kernel, Path path, const Workload& workload, double seconds) {
  const Call<float>& call = workload.call();
  const std::size_t n = workload.size();
  const auto measure = [&](const auto& function) {
    Timing timing = Measure(seconds, function);
    timing.min /= static_cast<double>(n);
    timing.median /= static_cast<double>(n);
    return timing;
  };
  switch (path) {
    case Path::kTextbook:
      return measure([&] { textbook::Run(kernel, call, n); });
    case Path::kScalarFloat:
      return measure([&] { RunScalar<float>(kernel, call, n); });
    case Path::kScalarDouble:
      return measure([&] { RunScalar<double>(kernel, call, n); });
    case Path::kHigh:
      return measure([&] { RunKernel(kernel, Accuracy::kHigh, call, n); });
    case Path::kFast:
      return measure([&] { RunKernel(kernel, Accuracy::kFast, call, n); });
    case Path::kStandard:
      break;
  }
  return measure([&] { RunKernel(kernel, Accuracy::kStandard, call, n); });
}

double TextbookTime(std::size_t kernel, Parameters parameters) {
  static std::array<std::array<double, 2>, kNumKernels> measured{};
  double& ns = measured[kernel][static_cast<std::size_t>(parameters)];
  if (ns == 0) ns = MeasurePath(kernel, Path::kTextbook, Workload(kernel, 4096, parameters), 0.03).min;
  return ns;
}

}  // namespace microlane
