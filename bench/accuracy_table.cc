// `microlane accuracy`: the error of kernels against the oracle, beside the bounds that the kernel list
// declares.
#include <fmt/core.h>
#include <unistd.h>

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "accuracy.h"
#include "command.h"
#include "microlane/kernel_list.h"
#include "microlane/targets.h"

namespace microlane {
namespace {

struct Request {
  std::vector<std::string> ids, accuracies;
  std::string target;
  std::uint64_t samples = 100000, seed = 1;
};

void PrintHeader() {
  fmt::print("{:<45} {:<13} {:>9} {:>8} {:>8} {:>7} {:>4} {:>4} {:>8}  {:<6} {}\n", "kernel: output",
             "accuracy", "points", "max ulp", "mean ulp", "correct", "nan", "inf", "bound", "",
             "worst input");
}

void PrintRows(std::size_t kernel, const AccuracyOptions& options, const AccuracyReport& report) {
  for (const OutputReport& output : report.outputs) {
    const bool holds = output.max_ulp <= report.bound && report.nan_count == 0 && report.inf_count == 0;
    std::string worst;
    if (output.worst.ulp > 0) {
      worst = fmt::format("{}{} -> {:a}, exactly {:a}", Describe(kernel, output.worst.in),
                          output.worst.transport == Transport::kImportance ? " importance" : "",
                          output.worst.got, output.worst.exact);
    }
    fmt::print("{:<45} {:<13} {:>9} {:>8} {:>8} {:>6.1f}% {:>4} {:>4} {:>8}  {:<6} {}\n",
               fmt::format("{}: {}", kKernels[kernel].id, output.name), AccuracyName(options), report.points,
               Short(output.max_ulp), Short(output.mean_ulp), 100 * output.correctly_rounded,
               report.nan_count, report.inf_count,
               std::isfinite(report.bound) ? BoundText(report.bound) : "none", holds ? "" : "BROKEN", worst);
  }
  std::fflush(stdout);
}

void Run(const Request& request, int& exit_code) {
  const std::vector<std::size_t> kernels = SelectKernels(request.ids);
  const bool is_scalar = request.target == "scalar" || request.target == "scalar-double";
  AccuracyOptions base;
  base.target = request.target;
  base.samples = request.samples;
  base.seed = request.seed;
  std::vector<AccuracyOptions> configurations;
  if (is_scalar) {
    if (!request.accuracies.empty()) {
      Fail(fmt::format("--accuracy does not apply to the target {}", request.target));
    }
    configurations.push_back(base);
  } else {
    UseTarget(request.target, "; others: scalar scalar-double");
    base.target = ChosenTarget();
    std::vector<std::string> accuracies = request.accuracies;
    if (accuracies.empty()) accuracies = {"high", "standard", "fast", "double"};
    for (const std::string& name : accuracies) {
      AccuracyOptions options = base;
      options.double_lanes = name == "double";
      if (!options.double_lanes) options.accuracy = ParseAccuracy(name);
      configurations.push_back(options);
    }
  }

  std::size_t done = 0, broken = 0;
  const std::size_t total = kernels.size() * configurations.size();
  const bool is_terminal = isatty(STDERR_FILENO) != 0;
  fmt::print(
      "target {}, {} random points of seed {} for each row, and the grid, the extremes and a search; errors "
      "in "
      "ULP,\n\"correct\" is the share of correctly rounded results\n",
      base.target, request.samples, request.seed);
  PrintHeader();
  for (const std::size_t kernel : kernels) {
    for (AccuracyOptions options : configurations) {
      const std::string what = fmt::format("{} {}", kKernels[kernel].id, AccuracyName(options));
      if (is_terminal) {
        options.progress = [&](std::uint64_t points, std::uint64_t all) {
          fmt::print(stderr, "\r\033[K[{}/{}] {} {:.0f}%", done + 1, total, what,
                     100.0 * static_cast<double>(points) / static_cast<double>(all == 0 ? 1 : all));
        };
      } else {
        fmt::print(stderr, "[{}/{}] {}\n", done + 1, total, what);
      }
      const AccuracyReport report = MeasureAccuracy(kernel, options);
      if (is_terminal) fmt::print(stderr, "\r\033[K");
      PrintRows(kernel, options, report);
      ++done;
      broken += report.ok ? 0 : 1;
    }
  }
  if (broken > 0) {
    fmt::print("{} of {} bounds are broken\n", broken, total);
    exit_code = kBoundBroken;
  } else if (is_scalar) {
    fmt::print("the scalar code declares no bound\n");
  } else {
    fmt::print("all {} bounds hold\n", total);
  }
}

}  // namespace

void AddAccuracy(CLI::App& app, int& exit_code) {
  CLI::App* accuracy =
      app.add_subcommand("accuracy", "Largest and mean error against the oracle; fails where a bound does");
  auto request = std::make_shared<Request>();
  accuracy->add_option("ID", request->ids, "Kernels, or families such as `ggx` (the default: all)");
  accuracy
      ->add_option("--accuracy", request->accuracies,
                   "high, standard, fast, or double for double lanes; may be repeated (the default: all)")
      ->allow_extra_args(false);
  accuracy->add_option("--target", request->target,
                       "An instruction set of this machine (the default: the best), scalar or scalar-double");
  accuracy
      ->add_option(
          "--samples", request->samples,
          "Random points for each kernel and accuracy; the grid, the extremes and a search from the worst "
          "points are added (the default: 100000)")
      ->check(RefuseNegative);
  accuracy->add_option("--seed", request->seed, "Of the random points (the default: 1)")
      ->check(RefuseNegative);
  accuracy->footer("Exit code: 0 where all declared bounds hold, 1 where one is broken, 2 on an error.");
  accuracy->callback([request, &exit_code] { Run(*request, exit_code); });
}

}  // namespace microlane
