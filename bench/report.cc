// `microlane report`: error against run time of every kernel, as CSV, plots and one page.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <vector>

#include "accuracy.h"
#include "command.h"
#include "microlane/kernel_list.h"
#include "microlane/targets.h"
#include "page.h"
#include "plots.h"
#include "report_data.h"
#include "textbook_accuracy.h"

namespace microlane {
namespace {

namespace fs = std::filesystem;

struct Request {
  std::string out = "report", target;
  std::uint64_t samples = 20000, seed = 1;
  double seconds = 0.02;
};

constexpr Path kLanePaths[] = {Path::kHigh, Path::kStandard, Path::kFast};

Accuracy AccuracyOf(Path path) {
  return path == Path::kHigh ? Accuracy::kHigh : path == Path::kFast ? Accuracy::kFast : Accuracy::kStandard;
}

// One line on standard error that is written over on a terminal.
class Progress {
 public:
  void Show(const std::string& phase, std::size_t done, std::size_t total, std::string_view what) const {
    if (terminal_) {
      fmt::print(stderr, "\r\033[K{} {}/{} {}", phase, done + 1, total, what);
    } else if (done % 16 == 0) {
      fmt::print(stderr, "{} {}/{} {}\n", phase, done + 1, total, what);
    }
  }
  void Clear() const {
    if (terminal_) fmt::print(stderr, "\r\033[K");
  }

 private:
  const bool terminal_ = isatty(STDERR_FILENO) != 0;
};

std::string Machine() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    const auto colon = line.find(": ");
    if (line.rfind("model name", 0) == 0 && colon != std::string::npos) return line.substr(colon + 2);
  }
  return "an unnamed processor";
}

std::string Compiler() {
#if defined(__clang__)
  return "clang " __clang_version__;
#elif defined(__GNUC__)
  return "GCC " __VERSION__;
#else
  return "an unnamed compiler";
#endif
}

void MeasureTimes(const Request& request, const Progress& progress, ReportData& data) {
  for (std::size_t k = 0; k < kNumKernels; ++k) {
    progress.Show("timing", k, kNumKernels, kKernels[k].id);
    KernelResult result{k, {}};
    const Workload workload(k, 4096, Parameters::kPerLane), workload16(k, 16, Parameters::kPerLane),
        uniform(k, 4096, Parameters::kUniform);
    for (std::size_t p = 0; p < kPaths; ++p) {
      result.path[p].time = MeasurePath(k, static_cast<Path>(p), workload, request.seconds);
    }
    for (const Path path : kLanePaths) {
      result[path].time16 = MeasurePath(k, path, workload16, request.seconds).min;
      result[path].time_uniform = MeasurePath(k, path, uniform, request.seconds).min;
      result[path].floor = MeasureFloor(k, AccuracyOf(path), Parameters::kPerLane);
    }
    data.kernels.push_back(result);
  }
}

void MeasureOtherTargets(const Request& request, const Progress& progress, ReportData& data) {
  for (const std::string& target : SupportedTargets()) {
    if (target == data.target) continue;
    ChooseTarget(target);
    for (std::size_t k = 0; k < kNumKernels; ++k) {
      progress.Show("timing on " + target, k, kNumKernels, kKernels[k].id);
      const Workload workload(k, 4096, Parameters::kPerLane);
      for (const Path path : kLanePaths) {
        data.targets.push_back({target, k, path, MeasurePath(k, path, workload, request.seconds / 4).min});
      }
    }
  }
  ChooseTarget(data.target);
}

void MeasureErrors(const Request& request, const Progress& progress, ReportData& data) {
  for (KernelResult& result : data.kernels) {
    progress.Show("judging", result.kernel, kNumKernels, kKernels[result.kernel].id);
    for (std::size_t p = 0; p < kPaths; ++p) {
      const Path path = static_cast<Path>(p);
      PathResult& to = result.path[p];
      if (path == Path::kTextbook) {
        const TextbookError error = MeasureTextbook(result.kernel, request.samples / 10, request.seed);
        to.max_ulp = error.max_ulp;
        to.mean_ulp = error.mean_ulp;
        to.points = error.points;
        to.nan_count = error.nan_count;
        continue;
      }
      AccuracyOptions options;
      options.samples = request.samples;
      options.seed = request.seed;
      options.target = path == Path::kScalarFloat    ? "scalar"
                       : path == Path::kScalarDouble ? "scalar-double"
                                                     : data.target;
      options.accuracy = AccuracyOf(path);
      // Every point of the double code would be judged by the oracle.
      if (path == Path::kScalarDouble) options.samples /= 10;
      const AccuracyReport report = MeasureAccuracy(result.kernel, options);
      to.max_ulp = report.max_ulp;
      to.points = report.points;
      to.nan_count = report.nan_count + report.inf_count;
      to.bound = report.bound;
      for (const OutputReport& output : report.outputs) to.mean_ulp = std::max(to.mean_ulp, output.mean_ulp);
      // In ULP of float, as all others.
      if (path == Path::kScalarDouble) {
        to.max_ulp *= 0x1p-29;
        to.mean_ulp *= 0x1p-29;
      }
    }
  }
}

void SetGoals(ReportData& data) {
  const auto result_of = [&](std::string_view id) -> const KernelResult& {
    return data.kernels[KernelIndex(id)];
  };
  const auto errors = [&](const std::string& what, Path path, double goal, bool whole, bool component) {
    double largest = 0;
    std::size_t worst = 0, within = 0, broken = 0, count = 0;
    for (const KernelResult& result : data.kernels) {
      const bool is_whole = kKernels[result.kernel].id.substr(0, 16) == "rough_dielectric";
      if (!(is_whole ? whole : component)) continue;
      const PathResult& reached = result[path];
      ++count;
      within += reached.max_ulp <= goal ? 1 : 0;
      broken += reached.max_ulp <= reached.bound ? 0 : 1;
      if (!(reached.max_ulp <= largest)) {
        largest = reached.max_ulp;
        worst = result.kernel;
      }
    }
    const std::string bounds = broken == 0 ? "all" : fmt::format("{}", count - broken);
    data.goals.push_back(
        {what, fmt::format("{:g} ULP", goal),
         fmt::format("{} of {} within, {} within their declared bounds; largest {} ULP in {}", within, count,
                     bounds, Short(largest), kKernels[worst].id),
         within == count});
  };
  errors("standard: component kernels, largest error", Path::kStandard, 4, false, true);
  errors("standard: whole values, largest error", Path::kStandard, 16, true, false);
  errors("high: largest error", Path::kHigh, 1, true, true);
  errors("fast: largest error (2^-11 relative)", Path::kFast, 4096, true, true);

  const auto speed = [&](const std::string& what, std::string_view id, Path path, double goal) {
    const KernelResult& result = result_of(id);
    const double speedup = result.Speedup(path);
    data.goals.push_back({what, fmt::format("{:g} times", goal),
                          fmt::format("{} times ({} ns per lane; uniform parameters {} ns)", Short(speedup),
                                      Short(result[path].time.min), Short(result[path].time_uniform)),
                          speedup >= goal});
  };
  speed("GGX reflection value, height-correlated, standard, against textbook",
        "rough_dielectric.eval_reflection", Path::kStandard, 32);
  speed("the same, fast", "rough_dielectric.eval_reflection", Path::kFast, 50);
  speed("rough dielectric value, both sides, standard, against textbook", "rough_dielectric.eval",
        Path::kStandard, 20);
  speed("the same, fast", "rough_dielectric.eval", Path::kFast, 35);

  if (CanCountOperations()) {
    const Operations& operations =
        result_of("rough_dielectric.eval_reflection")[Path::kStandard].floor.per_vector;
    const double divisions = operations.Count(Unit::kDivision), roots = operations.Count(Unit::kRoot);
    data.goals.push_back({"GGX reflection value: divisions and square roots per vector, standard", "1 and 3",
                          fmt::format("{} and {}", Short(divisions), Short(roots)),
                          divisions <= 1.005 && roots <= 3.005});
  }
  const auto ratios = [&](const std::string& what, double goal, const std::vector<Path>& paths,
                          const auto& ratio) {
    double largest = 0;
    std::size_t worst = 0, within = 0, count = 0;
    Path worst_path = Path::kStandard;
    for (const KernelResult& result : data.kernels) {
      for (const Path path : paths) {
        const double value = ratio(result, path);
        ++count;
        within += value <= goal ? 1 : 0;
        if (value > largest) {
          largest = value;
          worst = result.kernel;
          worst_path = path;
        }
      }
    }
    data.goals.push_back({what, fmt::format("{:g}", goal),
                          fmt::format("{} of {} within; largest {} in {} {}", within, count, Short(largest),
                                      kKernels[worst].id, kPathNames[static_cast<std::size_t>(worst_path)]),
                          within == count});
  };
  if (CanCountOperations()) {
    ratios("every kernel, high, standard and fast: time over floor", 1.3,
           {Path::kHigh, Path::kStandard, Path::kFast},
           [](const KernelResult& result, Path path) { return result.OverFloor(path); });
  }
  ratios("standard and fast: time per lane with n = 16 over n = 4096", 1.5, {Path::kStandard, Path::kFast},
         [](const KernelResult& result, Path path) { return result[path].time16 / result[path].time.min; });
}

// A CSV file of the report's folder.
class Csv {
 public:
  Csv(const fs::path& path, std::string_view header) : path_(path.string()), file_(path) {
    Line("{}", header);
  }

  template <class... Arguments>
  void Line(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    file_ << fmt::format(format, std::forward<Arguments>(arguments)...) << '\n';
  }
  void Close() {
    file_.close();
    if (!file_) Fail(fmt::format("cannot write {}", path_));
  }

 private:
  std::string path_;
  std::ofstream file_;
};

void WriteTables(const ReportData& data, const fs::path& folder) {
  Csv kernels(
      folder / "kernels.csv",
      "kernel,path,target,ns_per_lane,median_ns_per_lane,times_textbook,max_ulp,mean_ulp,points,nan_points,"
      "bound_ulp,ns_per_lane_16,ns_per_lane_uniform,divisions,roots,approximations,instructions,"
      "floor_divider_ns,floor_vector_ns,floor_memory_ns,over_floor");
  for (const KernelResult& result : data.kernels) {
    for (std::size_t p = 0; p < kPaths; ++p) {
      const PathResult& path = result.path[p];
      const bool lanes = p < 3;
      std::string row = fmt::format("{},{},{},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g},{},{}",
                                    kKernels[result.kernel].id, kPathNames[p], lanes ? data.target : "",
                                    path.time.min, path.time.median, result.Speedup(static_cast<Path>(p)),
                                    path.max_ulp, path.mean_ulp, path.points, path.nan_count);
      if (lanes) {
        row += fmt::format(",{:g},{:.5g},{:.5g}", path.bound, path.time16, path.time_uniform);
      } else {
        row += ",,,";
      }
      if (lanes && CanCountOperations()) {
        const Operations& operations = path.floor.per_vector;
        row += fmt::format(",{:.4g},{:.4g},{:.4g},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g}",
                           operations.Count(Unit::kDivision), operations.Count(Unit::kRoot),
                           operations.Count(Unit::kReciprocal) + operations.Count(Unit::kReciprocalRoot),
                           operations.all, path.floor.divider, path.floor.vector, path.floor.memory,
                           result.OverFloor(static_cast<Path>(p)));
      } else {
        row += ",,,,,,,,";
      }
      kernels.Line("{}", row);
    }
  }
  kernels.Close();

  Csv targets(folder / "targets.csv", "kernel,accuracy,target,ns_per_lane");
  for (const KernelResult& result : data.kernels) {
    for (const Path path : kLanePaths) {
      targets.Line("{},{},{},{:.5g}", kKernels[result.kernel].id, kPathNames[static_cast<std::size_t>(path)],
                   data.target, result[path].time.min);
    }
  }
  for (const TargetTime& time : data.targets) {
    targets.Line("{},{},{},{:.5g}", kKernels[time.kernel].id, kPathNames[static_cast<std::size_t>(time.path)],
                 time.target, time.ns);
  }
  targets.Close();

  Csv ceilings(folder / "ceilings.csv", "target,bytes,type,unit,ns_per_instruction");
  for (std::size_t w = 0; w < kWidths; ++w) {
    for (std::size_t t = 0; t < 2; ++t) {
      for (std::size_t u = 0; u < kUnits; ++u) {
        const double ns = data.ceilings.ns[w][t][u];
        if (ns == 0) continue;
        ceilings.Line("{},{},{},{},{:.5g}", data.target, w == 0 ? (t == 0 ? 4 : 8) : kWidthBytes[w],
                      t == 0 ? "float" : "double", kUnitNames[u], ns);
      }
    }
  }
  ceilings.Close();

  Csv glasses(
      folder / "glasses.csv",
      "glass,distribution,alpha,scale,incidence_degrees,transmitted_degrees,high,fast,relative_difference");
  for (const GlassCurve& curve : data.glasses) {
    for (std::size_t i = 0; i < curve.angle.size(); ++i) {
      const double high = static_cast<double>(curve.high[i]), fast = static_cast<double>(curve.fast[i]);
      glasses.Line("{},{},{},{},{},{:.1f},{:.9g},{:.9g},{}", curve.fit.glass, curve.fit.distribution,
                   curve.fit.alpha, curve.fit.scale, curve.incidence, curve.angle[i], high, fast,
                   high > 0 ? fmt::format("{:.4g}", fast / high - 1) : "");
    }
  }
  glasses.Close();

  Csv goals(folder / "goals.csv", "figure,goal,reached,met");
  for (const Goal& goal : data.goals) {
    goals.Line("\"{}\",\"{}\",\"{}\",{}", goal.what, goal.goal, goal.reached, goal.met ? "yes" : "no");
  }
  goals.Close();
}

void PrintTables(const ReportData& data) {
  fmt::print("target {} of {}\n", data.target, data.machine);
  fmt::print(
      "{:<44} | {:>8} {:>7} {:>7} {:>7} | {:>6} {:>6} | {:>5} {:>5} | {:>4} {:>4} | {:>7} {:>7} {:>7} {:>7} "
      "{:>8}\n",
      "", "textbook", "high", "std", "fast", "std", "fast", "std", "fast", "div", "root", "high", "std",
      "fast", "scalar", "textbook");
  fmt::print("{:<44} | {:^32} | {:^13} | {:^11} | {:^9} | {:^40}\n", "kernel", "ns per lane", "x textbook",
             "over floor", "std", "largest error, ULP");
  const bool counted = CanCountOperations();
  for (const KernelResult& result : data.kernels) {
    const PathResult &high = result[Path::kHigh], &standard = result[Path::kStandard],
                     &fast = result[Path::kFast];
    const auto ulp = [](const PathResult& path) {
      return Short(path.max_ulp) + (path.bound > 0 && !(path.max_ulp <= path.bound) ? "!" : "");
    };
    const auto counted_or_dash = [&](double value) { return counted ? Short(value) : "-"; };
    fmt::print(
        "{:<44} | {:>8} {:>7} {:>7} {:>7} | {:>6} {:>6} | {:>5} {:>5} | {:>4} {:>4} | {:>7} {:>7} {:>7} "
        "{:>7} {:>8}\n",
        kKernels[result.kernel].id, Short(result[Path::kTextbook].time.min), Short(high.time.min),
        Short(standard.time.min), Short(fast.time.min), Short(result.Speedup(Path::kStandard)),
        Short(result.Speedup(Path::kFast)), counted_or_dash(result.OverFloor(Path::kStandard)),
        counted_or_dash(result.OverFloor(Path::kFast)),
        counted_or_dash(standard.floor.per_vector.Count(Unit::kDivision)),
        counted_or_dash(standard.floor.per_vector.Count(Unit::kRoot)), ulp(high), ulp(standard), ulp(fast),
        Short(result[Path::kScalarFloat].max_ulp), ulp(result[Path::kTextbook]));
  }
  fmt::print("An error marked ! is above the declared bound.\n\n");
  for (const Goal& goal : data.goals) {
    fmt::print("{:<3} {:<75} goal {:<9} reached {}\n", goal.met ? "yes" : "no", goal.what, goal.goal,
               goal.reached);
  }
}

void Run(const Request& request) {
  const auto start = std::chrono::steady_clock::now();
  UseTarget(request.target);
  const fs::path folder(request.out);
  std::error_code error;
  fs::create_directories(folder / "plots", error);
  if (error) Fail(fmt::format("cannot make the folder {}: {}", (folder / "plots").string(), error.message()));

  const Progress progress;
  ReportData data;
  data.target = ChosenTarget();
  data.machine = Machine();
  data.compiler = Compiler();
  data.ceilings = ChosenCeilings();
  MeasureTimes(request, progress, data);
  MeasureOtherTargets(request, progress, data);
  MeasureErrors(request, progress, data);
  data.glasses = MeasureGlasses();
  SetGoals(data);
  progress.Clear();
  WriteTables(data, folder);
  std::string plot_error = "gnuplot is not installed";
  if (HasGnuplot()) {
    plot_error = WritePlots(data, folder, [&](std::size_t done, std::size_t total) {
      progress.Show("drawing", done, total, "");
    });
    progress.Clear();
  }
  data.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  const fs::path page = folder / "index.html";
  std::ofstream file(page, std::ios::binary);
  file << MakePage(data, folder);
  file.close();
  if (!file) Fail(fmt::format("cannot write {}", page.string()));
  PrintTables(data);
  fmt::print("\nmeasured in {:.0f} s; the page is {}\n", data.seconds,
             fs::absolute(page).lexically_normal().string());
  if (!plot_error.empty()) Fail("no plots: " + plot_error);
}

}  // namespace

void AddReport(CLI::App& app) {
  CLI::App* report =
      app.add_subcommand("report", "Error against run time of every kernel: CSV, plots and one page");
  auto request = std::make_shared<Request>();
  report->add_option("--out", request->out, "The folder to write (the default: report)");
  report->add_option("--target", request->target, "The instruction set to report on (the default: the best)");
  report->add_option(
      "--samples", request->samples,
      "Random points for each kernel and accuracy; a grid, the extremes and a search are added (the "
      "default: 20000). The slow paths take a tenth");
  report->add_option("--seed", request->seed, "Of the random points (the default: 1)");
  report->add_option("--seconds", request->seconds,
                     "How long to repeat each measurement of time (the default: 0.02)");
  report->footer(
      "Writes index.html, which needs no other file, and beside it kernels.csv, targets.csv, ceilings.csv, "
      "glasses.csv,\n"
      "goals.csv and plots/ as SVG and PNG with their gnuplot scripts. Takes a few minutes.");
  report->callback([request] { Run(*request); });
}

}  // namespace microlane
