// `microlane bench`: time per lane beside both yardsticks.
#include <fmt/core.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "command.h"
#include "microlane/kernel_list.h"
#include "microlane/targets.h"
#include "performance.h"

namespace microlane {
namespace {

struct Request {
  std::vector<std::string> ids, accuracies, targets;
  std::size_t lanes = 4096;
  double seconds = 0.03;
  bool uniform = false;
};

void PrintCeilings(const Ceilings& ceilings) {
  fmt::print("nanoseconds per instruction:");
  for (const char* name : kUnitNames) fmt::print(" {:>9}", name);
  fmt::print("\n");
  for (std::size_t w = 0; w < kWidths; ++w) {
    for (std::size_t t = 0; t < 2; ++t) {
      const double* ns = ceilings.ns[w][t];
      if (ns[0] == 0) continue;
      const char* type = t == 0 ? "float" : "double";
      fmt::print("  {:<26}", w == 0 ? fmt::format("one {}", type)
                                    : fmt::format("{} {}s", kWidthBytes[w] / (t == 0 ? 4 : 8), type));
      for (std::size_t u = 0; u < kUnits; ++u)
        fmt::print(" {:>9}", ns[u] > 0 ? fmt::format("{:.3f}", ns[u]) : "");
      fmt::print("\n");
    }
  }
}

void Run(const Request& request) {
  const std::vector<std::size_t> kernels = SelectKernels(request.ids);
  std::vector<Accuracy> accuracies;
  for (const std::string& name : request.accuracies) accuracies.push_back(ParseAccuracy(name));
  if (accuracies.empty()) accuracies.assign(std::begin(kAccuracies), std::end(kAccuracies));
  std::vector<std::string> targets = request.targets;
  if (targets.empty()) {
    UseTarget("");
    targets.push_back(ChosenTarget());
  }
  for (const std::string& target : targets)
    UseTarget(target);  // a wrong name fails before anything is printed
  const Parameters parameters = request.uniform ? Parameters::kUniform : Parameters::kPerLane;

  for (const std::string& target : targets) {
    UseTarget(target);
    fmt::print("target {}, {} lane{} a call, {} parameters\n", ChosenTarget(), request.lanes,
               request.lanes == 1 ? "" : "s", request.uniform ? "uniform" : "per-lane");
    PrintCeilings(ChosenCeilings());
    fmt::print("{:<40} {:<9} {:>8} {:>8} {:>9} {:>9} {:>6} {:>6} {:>7} {:>6} {:>9} {:>10} {:>9}\n", "kernel",
               "accuracy", "ns/lane", "median", "textbook", "x textb.", "div", "root", "approx", "instr",
               "floor ns", "over floor", "copy ns");
    for (const std::size_t kernel : kernels) {
      const Workload workload(kernel, request.lanes, parameters);
      for (const Accuracy accuracy : accuracies) {
        const Floor floor = MeasureFloor(kernel, accuracy, parameters);
        const Timing time = MeasurePath(kernel, PathOf(accuracy), workload, request.seconds);
        const double textbook = TextbookTime(kernel, parameters);
        const Operations& operations = floor.per_vector;
        fmt::print("{:<40} {:<9} {:>8} {:>8} {:>9} {:>9}", kKernels[kernel].id, Name(accuracy),
                   Short(time.min), Short(time.median), Short(textbook), Short(textbook / time.min));
        if (CanCountOperations()) {
          fmt::print(" {:>6} {:>6} {:>7} {:>6.0f} {:>9} {:>10}", Short(operations.Count(Unit::kDivision)),
                     Short(operations.Count(Unit::kRoot)),
                     Short(operations.Count(Unit::kReciprocal) + operations.Count(Unit::kReciprocalRoot)),
                     operations.all, Short(floor.ns()), Short(time.min / floor.ns()));
        } else {
          fmt::print(" {:>6} {:>6} {:>7} {:>6} {:>9} {:>10}", "-", "-", "-", "-", "-", "-");
        }
        fmt::print(" {:>9}\n", Short(floor.memory));
        std::fflush(stdout);
      }
    }
  }
}

}  // namespace

void AddBench(CLI::App& app) {
  CLI::App* bench =
      app.add_subcommand("bench", "Time per lane, beside the textbook code and the machine's ceilings");
  auto request = std::make_shared<Request>();
  bench->add_option("ID", request->ids, "Kernels, or families such as `ggx` (the default: all)");
  bench
      ->add_option("--accuracy", request->accuracies,
                   "high, standard or fast; may be repeated (the default: all)")
      ->allow_extra_args(false);
  bench
      ->add_option("--target", request->targets,
                   "An instruction set of this machine; may be repeated (the default: the best)")
      ->allow_extra_args(false);
  bench->add_option("--lanes", request->lanes, "Lanes in a call, up to 2^20 (the default: 4096)")
      ->check(CLI::Range(1, 1 << 20))
      ->type_name("UINT");
  bench->add_flag("--uniform", request->uniform, "One value for the batch in each parameter that allows it");
  bench->add_option("--seconds", request->seconds, "How long to repeat each measurement (the default: 0.03)")
      ->check(RefuseNegative);
  bench->footer(
      "ns/lane is the least over the repetitions. div, root and approx are divisions, square roots and "
      "approximate\n"
      "reciprocals and reciprocal roots per whole vector of float lanes, instr all instructions, counted by "
      "stepping\n"
      "through the code. floor is the least time these take at the throughputs measured here (divider, "
      "vector units, or\n"
      "the arrays loaded and stored); copy is the last of the three. textbook is bench/textbook.cc.");
  bench->callback([request] { Run(*request); });
}

}  // namespace microlane
