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
  const std::size_t few = 16, many = few + (accuracy == Accuracy::kHigh ? 64 : 512);
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

Path PathOf(Accuracy accuracy) {
  return accuracy == Accuracy::kHigh   ? Path::kHigh
         : accuracy == Accuracy::kFast ? Path::kFast
                                       : Path::kStandard;
}

Accuracy AccuracyOf(Path path) {
  return path == Path::kHigh ? Accuracy::kHigh : path == Path::kFast ? Accuracy::kFast : Accuracy::kStandard;
}

void RunPath(std::size_t kernel, Path path, const Call<float>& call, std::size_t n) {
  switch (path) {
    case Path::kTextbook:
      textbook::Run(kernel, call, n);
      break;
    case Path::kScalarFloat:
      RunScalar<float>(kernel, call, n);
      break;
    case Path::kScalarDouble:
      RunScalar<double>(kernel, call, n);
      break;
    case Path::kHigh:
    case Path::kStandard:
    case Path::kFast:
      RunKernel(kernel, AccuracyOf(path), call, n);
      break;
  }
}

Chain::Chain(std::size_t kernel, Parameters parameters)
    : workload_(kernel, 1, parameters), call_(workload_.call()) {
  std::memcpy(&first_, call_.in[0], sizeof first_);
  bits_ = first_;
  const volatile std::uint32_t none = 0;  // which the compiler cannot know
  none_ = none;
  call_.in[0] = &input_;
  call_.out[0] = &output_;
}

double MeasureLatency(std::size_t kernel, Path path, Parameters parameters, double seconds) {
  Chain chain(kernel, parameters);
  const auto run = [&](const Call<float>& call) { RunPath(kernel, path, call, 1); };
  return Measure(seconds, [&] { chain.Step(run); }).min;
}

bool HasParameters(std::size_t kernel) {
  const Names inputs = Split(kKernels[kernel].inputs);
  return inputs.per_lane < inputs.count;
}

Timing MeasurePath(std::size_t kernel, Path path, const Workload& workload, double seconds) {
  const std::size_t n = workload.size();
  Timing timing = Measure(seconds, [&] { RunPath(kernel, path, workload.call(), n); });
  timing.min /= static_cast<double>(n);
  timing.median /= static_cast<double>(n);
  return timing;
}

double TextbookTime(std::size_t kernel, Parameters parameters) {
  static std::array<std::array<double, 2>, kNumKernels> measured{};
  double& ns = measured[kernel][static_cast<std::size_t>(parameters)];
  if (ns == 0) ns = MeasurePath(kernel, Path::kTextbook, Workload(kernel, 4096, parameters), 0.03).min;
  return ns;
}

}  // namespace microlane
