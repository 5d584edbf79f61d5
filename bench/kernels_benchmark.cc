// Google Benchmark over the kernel list: every kernel, accuracy and target, per-lane and uniform parameters,
// throughput at 16, 256 and 4096 lanes and latency at 1; the textbook code and the arrays merely loaded and
// stored beside them. Names read `<kernel>/<accuracy>/<target>/<parameters>/<lanes>`, so --benchmark_filter
// picks any part of it. rough_conductor.eval/channels_<N> is one call for N wavelengths, per lane of a
// surface:
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
#include "command.h"
#include "microlane/kernel_list.h"
#include "microlane/kernels.h"
#include "microlane/rough_reflector.h"
#include "microlane/targets.h"
#include "performance.h"
#include "stopwatch.h"
#include "textbook.h"
#include "workload.h"

namespace microlane {
namespace {

constexpr Parameters kParameters[] = {Parameters::kPerLane, Parameters::kUniform};

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

void Latency(benchmark::State& state, std::size_t kernel, Path path, const std::string& target,
             Parameters parameters) {
  if (!target.empty()) ChooseTarget(target);
  Chain chain(kernel, parameters);
  const auto run = [&](const Call<float>& call) { RunPath(kernel, path, call, 1); };
  const double textbook =
      path == Path::kTextbook ? 0 : MeasureLatency(kernel, Path::kTextbook, parameters, 0.005);
  Repeat(state, 1, textbook, 0, [&] { chain.Step(run); });
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

// Rough conductors of several wavelengths, the same for the batch; x_separate: how many times as fast as a
// call for each.
void Channels(benchmark::State& state, std::size_t channels, Accuracy accuracy, const std::string& target) {
  ChooseTarget(target);
  constexpr std::size_t kLanes = 4096;
  const Workload workload(KernelIndex("rough_conductor.eval"), kLanes, Parameters::kPerLane);
  const Call<float>& call = workload.call();
  const Directions<float> wi{call.in[0], call.in[1], call.in[2]}, wo{call.in[3], call.in[4], call.in[5]};
  const StretchedRoughness<float> roughness{call.in[6], call.in[7]};
  std::vector<std::vector<float>> out(channels, std::vector<float>(kLanes));
  std::vector<float*> to;
  std::vector<FacetParameters<Reflector::kConductor, float>> facets;
  for (std::size_t c = 0; c < channels; ++c) {
    const double at = static_cast<double>(c) / static_cast<double>(channels);
    facets.push_back({0.2 + 1.3 * at, 3.5 - 1.5 * at});  // about gold's
    to.push_back(out[c].data());
  }
  const double separate =
      Measure(0.03,
              [&] {
                for (std::size_t c = 0; c < channels; ++c) {
                  rough_conductor::Eval(kLanes, wi, wo, {roughness, facets[c]}, to[c], accuracy);
                }
              })
          .min /
      static_cast<double>(kLanes);
  Repeat(state, kLanes, 0, 0, [&] {
    rough_conductor::EvalChannels(kLanes, wi, wo, roughness, channels, facets.data(), to.data(), accuracy);
    benchmark::ClobberMemory();
  });
  state.counters["x_separate"] = separate / static_cast<double>(state.counters["ns_per_lane"]);
}

void RegisterChannels() {
  for (const std::string& target : SupportedTargets()) {
    for (const Accuracy accuracy : {Accuracy::kStandard, Accuracy::kFast}) {
      for (const std::size_t channels : {1, 3, 4, 8, 16}) {
        benchmark::RegisterBenchmark(
            fmt::format("rough_conductor.eval/channels_{}/{}/{}/uniform/4096", channels, Name(accuracy),
                        target)
                .c_str(),
            [=](benchmark::State& state) { Channels(state, channels, accuracy, target); });
      }
    }
  }
}

void RegisterKernel(std::size_t kernel) {
  const std::string id(kKernels[kernel].id);
  for (const Parameters parameters : kParameters) {
    if (parameters == Parameters::kUniform && !HasParameters(kernel)) continue;
    for (const std::size_t n : kBatchLanes) {
      benchmark::RegisterBenchmark(fmt::format("{}/textbook/{}/{}", id, Name(parameters), n).c_str(),
                                   [=](benchmark::State& state) { Textbook(state, kernel, parameters, n); });
    }
    benchmark::RegisterBenchmark(
        fmt::format("{}/textbook/{}/1", id, Name(parameters)).c_str(),
        [=](benchmark::State& state) { Latency(state, kernel, Path::kTextbook, "", parameters); });
    for (const std::string& target : SupportedTargets()) {
      for (const std::size_t n : kBatchLanes) {
        benchmark::RegisterBenchmark(
            fmt::format("{}/load_and_store/{}/{}/{}", id, target, Name(parameters), n).c_str(),
            [=](benchmark::State& state) { Copy(state, kernel, target, parameters, n); });
      }
      for (const Accuracy accuracy : kAccuracies) {
        for (const std::size_t n : kBatchLanes) {
          benchmark::RegisterBenchmark(
              fmt::format("{}/{}/{}/{}/{}", id, Name(accuracy), target, Name(parameters), n).c_str(),
              [=](benchmark::State& state) { Throughput(state, kernel, accuracy, target, parameters, n); });
        }
        benchmark::RegisterBenchmark(
            fmt::format("{}/{}/{}/{}/1", id, Name(accuracy), target, Name(parameters)).c_str(),
            [=](benchmark::State& state) { Latency(state, kernel, PathOf(accuracy), target, parameters); });
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
  microlane::RegisterChannels();
  if (!listing) microlane::AddCeilings();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
