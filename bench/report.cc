// `microlane report`: error against run time of every kernel, as CSV, plots and one page.
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "accuracy.h"
#include "command.h"
#include "commit.h"
#include "goals.h"
#include "microlane/kernel_list.h"
#include "microlane/targets.h"
#include "page.h"
#include "plots.h"
#include "points.h"
#include "report_data.h"
#include "tables.h"
#include "textbook_accuracy.h"

namespace microlane {
namespace {

namespace fs = std::filesystem;

struct Request {
  std::string out = "report", target;
  std::uint64_t samples = 20000, seed = 1;
  double seconds = 0.03;
};

constexpr int kRounds = 3;

// One line on standard error that is written over on a terminal.
class Progress {
 public:
  void Show(const std::string& phase, std::size_t done, std::size_t total, std::string_view what) const {
    if (!terminal_ && done % 8 != 0) return;
    const std::string line = fmt::format("[{:3.0f} s] {} {}/{} {}", Seconds(), phase, done + 1, total, what);
    fmt::print(stderr, terminal_ ? "\r\033[K{}" : "{}\n", line);
  }
  void Clear() const {
    if (terminal_) fmt::print(stderr, "\r\033[K");
  }
  double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
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

std::string Date() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  return fmt::format("{:04}-{:02}-{:02} {:02}:{:02} UTC", utc.tm_year + 1900, utc.tm_mon + 1, utc.tm_mday,
                     utc.tm_hour, utc.tm_min);
}

// One round over all batches of one kernel; keeps what is less than before.
void TimeKernel(std::size_t k, double seconds, KernelResult& result) {
  for (const Parameters parameters : {Parameters::kPerLane, Parameters::kUniform}) {
    const bool per_lane = parameters == Parameters::kPerLane;
    if (!per_lane && !HasParameters(k)) continue;
    const std::size_t u = per_lane ? 0 : 1;
    for (std::size_t b = kBatches; b-- > 0;) {
      const bool main = per_lane && b == kLongBatch;
      const Workload workload(k, kBatchLanes[b], parameters);
      for (std::size_t p = 0; p < kPaths; ++p) {
        const Path path = static_cast<Path>(p);
        const bool is_scalar = path == Path::kScalarFloat || path == Path::kScalarDouble;
        if (is_scalar && !main) continue;
        const Timing time = MeasurePath(k, path, workload, main ? seconds : seconds / 4);
        Timing& best = result[path].batch[u][b];
        if (best.min == 0 || time.min < best.min) best = time;
        if (main) result[path].slowest_round = std::max(result[path].slowest_round, time.min);
      }
    }
    for (const Path path : {Path::kHigh, Path::kStandard, Path::kFast, Path::kTextbook}) {
      const double latency = MeasureLatency(k, path, parameters, seconds / 4);
      double& best = result[path].latency[u];
      if (best == 0 || latency < best) best = latency;
    }
  }
}

// Rounds lie apart, so that no kernel falls altogether into a time when the machine was busy.
void MeasureTimes(const Request& request, const Progress& progress, ReportData& data) {
  for (std::size_t k = 0; k < kNumKernels; ++k) data.kernels.push_back({k, {}});
  for (int round = 0; round < kRounds; ++round) {
    for (std::size_t k = 0; k < kNumKernels; ++k) {
      progress.Show(fmt::format("timing, round {}/{},", round + 1, kRounds), k, kNumKernels, kKernels[k].id);
      TimeKernel(k, request.seconds / kRounds, data.kernels[k]);
    }
  }
  for (std::size_t k = 0; k < kNumKernels; ++k) {
    progress.Show("counting operations", k, kNumKernels, kKernels[k].id);
    for (const Path path : kLanePaths) {
      data.kernels[k][path].floor = MeasureFloor(k, AccuracyOf(path), Parameters::kPerLane);
    }
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

// How far the slowest round lies above the best.
void JudgeNoise(ReportData& data) {
  std::vector<double> excess;
  for (const KernelResult& result : data.kernels) {
    for (const PathResult& path : result.path) excess.push_back(path.slowest_round / path.time().min - 1);
  }
  std::sort(excess.begin(), excess.end());
  data.noise_median = excess[excess.size() / 2];
  data.noise_tenth = excess[excess.size() * 9 / 10];
}

// The rows of the stiff and extreme cases that apply to a kernel, under every accuracy and by the textbook
// code.
TextbookError MeasureExtremes(std::size_t kernel, ReportData& data) {
  TextbookError textbook;
  const std::vector<ExtremeCase> cases = ExtremeCases(kernel);
  std::vector<std::string_view> rows;
  for (const ExtremeCase& extreme : cases) {
    if (std::find(rows.begin(), rows.end(), extreme.row) == rows.end()) rows.push_back(extreme.row);
  }
  for (const std::string_view row : rows) {
    StabilityResult result;
    result.row = row;
    result.kernel = kernel;
    std::vector<Point> points;
    for (const ExtremeCase& extreme : cases) {
      if (extreme.row != row) continue;
      points.push_back(extreme.in);
      if (result.what.find(extreme.what) != std::string::npos) continue;
      result.what += fmt::format("{}{}", result.what.empty() ? "" : "; ", extreme.what);
    }
    const std::vector<AccuracyReport> reports = MeasureAccuracy(kernel, AllAccuracies(data.target), points);
    for (std::size_t p = 0; p < kStabilityPaths; ++p) {
      result.points = reports[p].points;
      result.max_ulp[p] = reports[p].max_ulp;
      result.bound[p] = reports[p].bound;
      result.nan_count[p] = reports[p].nan_count + reports[p].inf_count;
    }
    result.textbook = MeasureTextbook(kernel, points);
    textbook += result.textbook;
    data.stability.push_back(result);
  }
  return textbook;
}

// Puts the results of a row together, rows in the order of the kernel that has most.
void SortExtremes(ReportData& data) {
  std::vector<std::vector<std::string>> rows(kNumKernels);
  for (const StabilityResult& result : data.stability) rows[result.kernel].push_back(result.row);
  std::vector<std::string> order = *std::max_element(
      rows.begin(), rows.end(), [](const auto& a, const auto& b) { return a.size() < b.size(); });
  for (const StabilityResult& result : data.stability) {
    if (std::find(order.begin(), order.end(), result.row) == order.end()) order.push_back(result.row);
  }
  const auto rank = [&](const StabilityResult& result) {
    return std::find(order.begin(), order.end(), result.row) - order.begin();
  };
  std::sort(data.stability.begin(), data.stability.end(),
            [&](const StabilityResult& a, const StabilityResult& b) {
              return rank(a) != rank(b) ? rank(a) < rank(b) : a.kernel < b.kernel;
            });
}

void MeasureErrors(const Request& request, const Progress& progress, ReportData& data) {
  for (KernelResult& result : data.kernels) {
    progress.Show("judging", result.kernel, kNumKernels, kKernels[result.kernel].id);
    TextbookError textbook = MeasureExtremes(result.kernel, data);
    std::vector<Point> points = GridPoints(result.kernel, 1000);
    const RandomPoints random(result.kernel, request.seed);
    for (std::uint64_t i = 0; i < request.samples / 10; ++i) points.push_back(random(i));
    textbook += MeasureTextbook(result.kernel, points);
    for (std::size_t p = 0; p < kPaths; ++p) {
      const Path path = static_cast<Path>(p);
      PathResult& to = result.path[p];
      if (path == Path::kTextbook) {
        to.max_ulp = textbook.max_ulp;
        to.mean_ulp = textbook.mean_ulp;
        to.points = textbook.points;
        to.nan_count = textbook.nan_count;
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
      to.max_relative = report.max_relative;
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

void Run(const Request& request) {
  UseTarget(request.target);
  const fs::path folder(request.out);
  std::error_code error;
  fs::create_directories(folder / "plots", error);
  if (error) Fail(fmt::format("cannot make the folder {}: {}", (folder / "plots").string(), error.message()));

  const Progress progress;
  ReportData data;
  data.target = ChosenTarget();
  data.machine = Machine();
  data.processors = std::thread::hardware_concurrency();
  data.compiler = Compiler();
  data.commit = MICROLANE_COMMIT;
  data.date = Date();
  data.samples = request.samples;
  data.ceilings = ChosenCeilings();
  MeasureTimes(request, progress, data);
  JudgeNoise(data);
  MeasureOtherTargets(request, progress, data);
  MeasureErrors(request, progress, data);
  SortExtremes(data);
  data.glasses = MeasureGlasses();
  progress.Show("making tables", 0, 1, "");
  data.kelemen = MeasureKelemen();
  data.meneveaux = MeasureMeneveaux();
  data.albedo_tables = MeasureAlbedoTables();
  data.radial_tables = MeasureRadialTables();
  progress.Show("tracing V-cavities", 0, 1, "");
  data.cavities = MeasureCavities(20000000);
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
  data.seconds = progress.Seconds();
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
  report
      ->add_option(
          "--samples", request->samples,
          "Random points for each kernel and accuracy; a grid, the extremes and a search are added (the "
          "default: 20000). The slow paths take a tenth")
      ->check(RefuseNegative);
  report->add_option("--seed", request->seed, "Of the random points (the default: 1)")->check(RefuseNegative);
  report
      ->add_option("--seconds", request->seconds,
                   "How long to repeat each measurement of time, in all rounds (the default: 0.03)")
      ->check(RefuseNegative);
  report->footer(
      "Writes index.html, which needs no other file, and beside it the tables as CSV, readme_table.md, and "
      "plots/ as SVG\nand PNG with their gnuplot scripts. Takes a few minutes.");
  report->callback([request] { Run(*request); });
}

}  // namespace microlane
