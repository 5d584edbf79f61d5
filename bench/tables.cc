#include "tables.h"

#include <fmt/format.h>

#include <fstream>
#include <string_view>
#include <utility>

#include "command.h"
#include "microlane/kernel_list.h"

namespace microlane {
namespace {

namespace fs = std::filesystem;

constexpr Path kTimedPaths[] = {Path::kHigh, Path::kStandard, Path::kFast, Path::kTextbook};

std::string_view PathName(Path path) { return kPathNames[static_cast<std::size_t>(path)]; }

// A text file of the report's folder.
class Csv {
 public:
  Csv(const fs::path& path, std::string_view header) : path_(path.string()), file_(path) {
    if (!header.empty()) Line("{}", header);
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

void WriteReadmeTable(const ReportData& data, Csv& table) {
  constexpr std::string_view kShown[] = {"ggx.D",
                                         "ggx.Lambda",
                                         "beckmann.D",
                                         "beckmann.Lambda",
                                         "fresnel.dielectric",
                                         "half_vector.refraction",
                                         "refract",
                                         "rough_dielectric.eval_reflection",
                                         "rough_dielectric.eval",
                                         "rough_dielectric.eval_pdf",
                                         "rough_dielectric.sample",
                                         "rough_dielectric.sample_visible",
                                         "rough_dielectric_beckmann.eval",
                                         "rough_conductor.eval",
                                         "ggx.sample_visible_reflection",
                                         "beckmann.sample_visible_reflection"};
  table.Line("| kernel | textbook | high | standard | fast |\n|---|--:|--:|--:|--:|");
  for (const std::string_view id : kShown) {
    const KernelResult& result = data.kernels[KernelIndex(id)];
    std::string row = fmt::format("| `{}` | {} ns", id, Short(result[Path::kTextbook].time().min));
    for (const Path path : kLanePaths) {
      row += fmt::format(" | {} ns, {}×, {} ULP", Short(result[path].time().min), Short(result.Speedup(path)),
                         Short(result[path].max_ulp));
    }
    table.Line("{} |", row);
  }
  table.Line("\n{}. {}", Circumstances(data), Noise(data));
}

}  // namespace

std::vector<StabilityRow> StabilityRows(const ReportData& data) {
  std::vector<StabilityRow> rows;
  for (const StabilityResult& result : data.stability) {
    if (rows.empty() || rows.back().row != result.row) rows.emplace_back();
    StabilityRow& row = rows.back();
    row.row = result.row;
    if (row.kernels == 0 || result.what.size() > row.what.size()) row.what = result.what;
    ++row.kernels;
    row.points += result.points;
    row.textbook += result.textbook;
    row.holds = row.holds && result.Holds();
    for (std::size_t p = 0; p < kStabilityPaths; ++p) {
      row.nan_count += result.nan_count[p];
      if (result.OverBound(p) <= row.over_bound[p]) continue;
      row.over_bound[p] = result.OverBound(p);
      row.worst_kernel[p] = result.kernel;
    }
  }
  return rows;
}

std::string Circumstances(const ReportData& data) {
  return fmt::format("{} ({} processors, one thread timed), target {}, {}, commit {}, {}", data.machine,
                     data.processors, data.target, data.compiler, data.commit, data.date);
}

std::string Noise(const ReportData& data) {
  return fmt::format(
      "Times are the least of three rounds; the slowest round took {:.1f}% longer in the middle case and "
      "{:.0f}% or "
      "more in one of ten",
      100 * data.noise_median, 100 * data.noise_tenth);
}

void WriteTables(const ReportData& data, const fs::path& folder) {
  Csv kernels(
      folder / "kernels.csv",
      "kernel,path,target,ns_per_lane,median_ns_per_lane,times_textbook,max_ulp,mean_ulp,points,nan_points,"
      "bound_ulp,divisions,roots,approximations,instructions,"
      "floor_divider_ns,floor_vector_ns,floor_memory_ns,over_floor");
  for (const KernelResult& result : data.kernels) {
    for (std::size_t p = 0; p < kPaths; ++p) {
      const PathResult& path = result.path[p];
      const bool lanes = p < 3;
      std::string row = fmt::format("{},{},{},{:.5g},{:.5g},{:.5g},{:.5g},{:.5g},{},{}",
                                    kKernels[result.kernel].id, kPathNames[p], lanes ? data.target : "",
                                    path.time().min, path.time().median, result.Speedup(static_cast<Path>(p)),
                                    path.max_ulp, path.mean_ulp, path.points, path.nan_count);
      if (lanes) {
        row += fmt::format(",{:g}", path.bound);
      } else {
        row += ",";
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

  Csv times(folder / "times.csv", "kernel,path,target,parameters,lanes,ns_per_lane,median_ns_per_lane");
  for (const KernelResult& result : data.kernels) {
    for (const Path path : kTimedPaths) {
      const std::string target = path == Path::kTextbook ? "" : data.target;
      for (std::size_t u = 0; u < (HasParameters(result.kernel) ? 2 : 1); ++u) {
        const std::string start = fmt::format("{},{},{},{}", kKernels[result.kernel].id, PathName(path),
                                              target, u == 0 ? "per_lane" : "uniform");
        times.Line("{},1,{:.5g},", start, result[path].latency[u]);
        for (std::size_t b = 0; b < kBatches; ++b) {
          const Timing& time = result[path].batch[u][b];
          times.Line("{},{},{:.5g},{:.5g}", start, kBatchLanes[b], time.min, time.median);
        }
      }
    }
  }
  times.Close();

  Csv stability(
      folder / "stability.csv",
      "row,kernel,points,high_ulp,high_bound,standard_ulp,standard_bound,fast_ulp,fast_bound,double_ulp,"
      "double_bound,nan_points,textbook_ulp,textbook_nan_points,holds");
  for (const StabilityResult& result : data.stability) {
    std::string row = fmt::format("{},{},{}", result.row, kKernels[result.kernel].id, result.points);
    std::uint64_t nan_count = 0;
    for (std::size_t p = 0; p < kStabilityPaths; ++p) {
      row += fmt::format(",{:.5g},{:g}", result.max_ulp[p], result.bound[p]);
      nan_count += result.nan_count[p];
    }
    stability.Line("{},{},{:.5g},{},{}", row, nan_count, result.textbook.max_ulp, result.textbook.nan_count,
                   result.Holds() ? "yes" : "no");
  }
  stability.Close();

  Csv targets(folder / "targets.csv", "kernel,accuracy,target,ns_per_lane");
  for (const KernelResult& result : data.kernels) {
    for (const Path path : kLanePaths) {
      targets.Line("{},{},{},{:.5g}", kKernels[result.kernel].id, PathName(path), data.target,
                   result[path].time().min);
    }
  }
  for (const TargetTime& time : data.targets) {
    targets.Line("{},{},{},{:.5g}", kKernels[time.kernel].id, PathName(time.path), time.target, time.ns);
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
    goals.Line(R"("{}","{}","{}",{})", goal.what, goal.goal, goal.reached, goal.met ? "yes" : "no");
  }
  goals.Close();

  Csv readme(folder / "readme_table.md", "");
  WriteReadmeTable(data, readme);
  readme.Close();
}

void PrintTables(const ReportData& data) {
  fmt::print("{}.\n{}.\n\n", Circumstances(data), Noise(data));
  fmt::print("{:<44} | {:^32} | {:^13} | {:^11} | {:^9} | {:^40}\n", "", "ns per lane", "x textbook",
             "over floor", "std", "largest error, ULP");
  fmt::print(
      "{:<44} | {:>8} {:>7} {:>7} {:>7} | {:>6} {:>6} | {:>5} {:>5} | {:>4} {:>4} | {:>7} {:>7} {:>7} {:>7} "
      "{:>8}\n",
      "kernel", "textbook", "high", "std", "fast", "std", "fast", "std", "fast", "div", "root", "high", "std",
      "fast", "scalar", "textbook");
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
        kKernels[result.kernel].id, Short(result[Path::kTextbook].time().min), Short(high.time().min),
        Short(standard.time().min), Short(fast.time().min), Short(result.Speedup(Path::kStandard)),
        Short(result.Speedup(Path::kFast)), counted_or_dash(result.OverFloor(Path::kStandard)),
        counted_or_dash(result.OverFloor(Path::kFast)),
        counted_or_dash(standard.floor.per_vector.Count(Unit::kDivision)),
        counted_or_dash(standard.floor.per_vector.Count(Unit::kRoot)), ulp(high), ulp(standard), ulp(fast),
        Short(result[Path::kScalarFloat].max_ulp), ulp(result[Path::kTextbook]));
  }
  fmt::print("An error marked ! is above the declared bound.\n\n");
  fmt::print("{:<17} {:>7} {:>8} | {:^31} | {:>4} | {:^16} |\n", "", "", "", "largest error over bound", "",
             "textbook");
  fmt::print("{:<17} {:>7} {:>8} | {:>7} {:>7} {:>7} {:>7} | {:>4} | {:>8} {:>7} |\n", "extreme", "kernels",
             "points", "high", "std", "fast", "double", "NaN", "ULP", "NaN");
  for (const StabilityRow& row : StabilityRows(data)) {
    fmt::print("{:<17} {:>7} {:>8} | {:>7} {:>7} {:>7} {:>7} | {:>4} | {:>8} {:>7} | {}\n", row.row,
               row.kernels, row.points, Short(row.over_bound[0]), Short(row.over_bound[1]),
               Short(row.over_bound[2]), Short(row.over_bound[3]), row.nan_count, Short(row.textbook.max_ulp),
               row.textbook.nan_count, row.holds ? "pass" : "FAIL");
  }
  fmt::print("\n");
  for (const Goal& goal : data.goals) {
    fmt::print("{:<3} {:<75} goal {:<9} reached {}\n", goal.met ? "yes" : "no", goal.what, goal.goal,
               goal.reached);
  }
}

}  // namespace microlane
