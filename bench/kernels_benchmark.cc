// Google Benchmark over the kernel list: every kernel, accuracy and target, per-lane and uniform parameters,
// throughput at 16, 256 and 4096 lanes and latency at 1; the textbook code and the arrays merely loaded and
// stored beside them. Names read `<kernel>/<accuracy>/<target>/<parameters>/<lanes>`, so --benchmark_filter
// picks any part of it:
//   kernels_benchmark --benchmark_filter='ggx\.D/.*/AVX3/per_lane/4096'
#include <benchmark/benchmark.h>
#include <fmt/core.h>

#include <cstdint>
#include <cstring>
#include <ctime>
#include <map>
#include <string>
#include <tuple>
#include <vector>

#include "ceilings.h"
#include "microlane/kernel_list.h"
#include "microlane/kernels.h"
#include "microlane/targets.h"
#include "performance.h"
#include "textbook.h"
#include "workload.h"

namespace microlane {
namespace {

constexpr Accuracy kAccuracies[] = {Accuracy::kHigh, Accuracy::kStandard, Accuracy::kFast};
constexpr Parameters kParameters[] = {Parameters::kPerLane, Parameters::kUniform};
constexpr std::size_t kSizes[] = {16, 256, 4096};

std::string_view Name(Accuracy accuracy) {
  return accuracy == Accuracy::kHigh ? "high" : accuracy == Accuracy::kFast ? "fast" : "standard";
}
std::string_view Name(Parameters parameters) {
  return parameters == Parameters::kPerLane ? "per_lane" : "uniform";
}

double FloorTime(const std::string& target, std::size_t kernel, Accuracy accuracy, Parameters parameters) {
  static std::map<std::tuple<std::string, std::size_t, Accuracy, Parameters>, double> measured;
  const auto [place, is_new] = measured.try_emplace({target, kernel, accuracy, parameters});
  if (is_new) place->second = MeasureFloor(kernel, accuracy, parameters).ns();
  return place->second;
}

// Runs `once` as long as the benchmark wants, then sets nanoseconds of processor time per lane, how many
// times as fast as the textbook code that is, and time over the floor. A yardstick that is 0 is left out.
template <class Function>
void Repeat(benchmark::State& state, std::size_t n, double textbook_ns, double floor_ns,
            const Function& once) {
  const std::clock_t start = std::clock();
  for ([[maybe_unused]] auto _ : state) once();
  const double seconds = static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
  const double ns = seconds * 1e9 / static_cast<double>(state.iterations()) / static_cast<double>(n);
  state.counters["ns_per_lane"] = ns;
  if (textbook_ns > 0) state.counters["x_textbook"] = textbook_ns / ns;
  if (floor_ns > 0) state.counters["over_floor"] = ns / floor_ns;
}

void Throughput(benchmark::State& state, std::size_t kernel, Accuracy accuracy, const std::string& target,
                Parameters parameters, std::size_t n) {
  ChooseTarget(target);
  const Workload workload(kernel, n, parameters);
  const double textbook = TextbookTime(kernel, parameters),
               floor = FloorTime(target, kernel, accuracy, parameters);
  Repeat(state, n, textbook, floor, [&] {
    RunKernel(kernel, accuracy, workload.call(), n);
    benchmark::ClobberMemory();
  });
}

// Each call takes an input that waits for the result of the call before.
void Latency(benchmark::State& state, std::size_t kernel, Accuracy accuracy, const std::string& target,
             Parameters parameters) {
  ChooseTarget(target);
  const Workload workload(kernel, 1, parameters);
  Call<float> call = workload.call();
  std::uint32_t first, none = 0, bits;
  float input, output;
  std::memcpy(&first, call.in[0], sizeof first);
  benchmark::DoNotOptimize(none);
  call.in[0] = &input;
  call.out[0] = &output;
  bits = first;
  Repeat(state, 1, 0, 0, [&] {
    std::memcpy(&input, &bits, sizeof input);
    RunKernel(kernel, accuracy, call, 1);
    std::memcpy(&bits, &output, sizeof bits);
    bits = first ^ (bits & none);
  });
  benchmark::DoNotOptimize(bits);
}

void Textbook(benchmark::State& state, std::size_t kernel, Parameters parameters, std::size_t n) {
  const Workload workload(kernel, n, parameters);
  Repeat(state, n, 0, 0, [&] {
    textbook::Run(kernel, workload.call(), n);
    benchmark::ClobberMemory();
  });
}

void Copy(benchmark::State& state, std::size_t kernel, const std::string& target, Parameters parameters,
          std::size_t n) {
  ChooseTarget(target);
  const Workload workload(kernel, n, parameters);
  Repeat(state, n, 0, 0, [&] {
    LoadAndStore(workload.call(), workload.loaded(), workload.stored(), n);
    benchmark::ClobberMemory();
  });
}

void RegisterKernel(std::size_t kernel) {
  const std::string id(kKernels[kernel].id);
  const Names inputs = Split(kKernels[kernel].inputs);
  for (const Parameters parameters : kParameters) {
    if (parameters == Parameters::kUniform && inputs.per_lane == inputs.count) continue;
    for (const std::size_t n : kSizes) {
      benchmark::RegisterBenchmark(fmt::format("{}/textbook/{}/{}", id, Name(parameters), n).c_str(),
                                   [=](benchmark::State& state) { Textbook(state, kernel, parameters, n); });
    }
    for (const std::string& target : SupportedTargets()) {
      for (const std::size_t n : kSizes) {
        benchmark::RegisterBenchmark(
            fmt::format("{}/load_and_store/{}/{}/{}", id, target, Name(parameters), n).c_str(),
            [=](benchmark::State& state) { Copy(state, kernel, target, parameters, n); });
      }
      for (const Accuracy accuracy : kAccuracies) {
        for (const std::size_t n : kSizes) {
          benchmark::RegisterBenchmark(
              fmt::format("{}/{}/{}/{}/{}", id, Name(accuracy), target, Name(parameters), n).c_str(),
              [=](benchmark::State& state) { Throughput(state, kernel, accuracy, target, parameters, n); });
        }
        benchmark::RegisterBenchmark(
            fmt::format("{}/{}/{}/{}/1", id, Name(accuracy), target, Name(parameters)).c_str(),
            [=](benchmark::State& state) { Latency(state, kernel, accuracy, target, parameters); });
      }
    }
  }
}

// The machine's throughputs, as part of the printed context.
void AddCeilings() {
  for (const std::string& target : SupportedTargets()) {
    ChooseTarget(target);
    const Ceilings& ceilings = ChosenCeilings();
    for (std::size_t w = 0; w < kWidths; ++w) {
      for (std::size_t t = 0; t < 2; ++t) {
        std::string text;
        for (std::size_t u = 0; u < kUnits; ++u) {
          if (ceilings.ns[w][t][u] > 0)
            text += fmt::format("  {} {:.3f}", kUnitNames[u], ceilings.ns[w][t][u]);
        }
        if (text.empty()) continue;
        benchmark::AddCustomContext(
            fmt::format("{}: ns per instruction on {} bytes of {}", target,
                        w == 0 ? (t == 0 ? 4 : 8) : kWidthBytes[w], t == 0 ? "float" : "double"),
            text);
      }
    }
  }
}

}  // namespace
}  // namespace microlane

int main(int argc, char** argv) {
  // Ten thousand benchmarks: the library's half a second for each would be too long.
  std::vector<char*> arguments(argv, argv + argc);
  char min_time[] = "--benchmark_min_time=0.02";
  arguments.insert(arguments.begin() + 1, min_time);
  bool listing = false;
  for (int i = 1; i < argc; ++i)
    listing = listing || std::strncmp(argv[i], "--benchmark_list_tests", 22) == 0;
  int count = argc + 1;
  arguments.push_back(nullptr);
  benchmark::Initialize(&count, arguments.data());
  if (benchmark::ReportUnrecognizedArguments(count, arguments.data())) return 2;
  for (std::size_t k = 0; k < microlane::kNumKernels; ++k) microlane::RegisterKernel(k);
  if (!listing) microlane::AddCeilings();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
