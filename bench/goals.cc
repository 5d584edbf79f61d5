#include "goals.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>
#include <vector>

#include "command.h"
#include "microlane/kernel_list.h"

namespace microlane {

void SetGoals(ReportData& data) {
  const auto result_of = [&](std::string_view id) -> const KernelResult& {
    return data.kernels[KernelIndex(id)];
  };
  const auto errors = [&](const std::string& what, Path path, double goal, bool whole, bool component) {
    double largest = 0;
    std::size_t worst = 0, within = 0, broken = 0, count = 0;
    for (const KernelResult& result : data.kernels) {
      const bool is_whole = result.kernel >= kFirstDielectricKernel;
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
  const auto relative_error = [&](const std::string& what, Path path) {
    double largest = 0;
    std::size_t worst = 0, within = 0;
    for (const KernelResult& result : data.kernels) {
      const double relative = result[path].max_relative;
      within += relative <= 0x1p-11 ? 1 : 0;
      if (relative <= largest) continue;
      largest = relative;
      worst = result.kernel;
    }
    data.goals.push_back({what, "2^-11",
                          fmt::format("{} of {} within; largest 2^{:.2f} in {}", within, kNumKernels,
                                      std::log2(largest), kKernels[worst].id),
                          within == kNumKernels});
  };
  relative_error("fast: largest relative error", Path::kFast);

  const auto speed = [&](const std::string& what, std::string_view id, Path path, double goal) {
    const KernelResult& result = result_of(id);
    const double speedup = result.Speedup(path);
    data.goals.push_back(
        {what, fmt::format("{:g} times", goal),
         fmt::format("{} times ({} ns per lane; uniform parameters {} ns)", Short(speedup),
                     Short(result[path].time().min), Short(result[path].batch[1][kLongBatch].min)),
         speedup >= goal});
  };
  speed("GGX reflection value, height-correlated, standard, against textbook",
        "rough_dielectric.eval_reflection", Path::kStandard, 32);
  speed("the same, fast", "rough_dielectric.eval_reflection", Path::kFast, 50);
  speed("rough dielectric value, both sides, standard, against textbook", "rough_dielectric.eval",
        Path::kStandard, 20);
  speed("the same, fast", "rough_dielectric.eval", Path::kFast, 35);
  speed("GGX: a visible normal, reflection, weight and density, standard, against textbook",
        "ggx.sample_visible_reflection", Path::kStandard, 40);
  speed("Beckmann: the same", "beckmann.sample_visible_reflection", Path::kStandard, 60);
  speed("Beckmann reflection value with exact Lambda, standard, against textbook",
        "rough_dielectric_beckmann.eval_reflection", Path::kStandard, 30);

  if (!data.cavities.empty()) {
    const auto slowest = [&](const auto& figure) {
      double least = INFINITY;
      for (const CavityFigure& cavities : data.cavities) least = std::min(least, figure(cavities.speed));
      return least;
    };
    const double hits = slowest([](const CavitySpeed& s) { return s.lanes * 1e-6; });
    const double times = slowest([](const CavitySpeed& s) { return s.lanes / s.scalar; });
    data.goals.push_back({"V-cavities: facet hits a second a core, the slowest of the scenes", "60 million",
                          fmt::format("{} million", Short(hits)), hits >= 60});
    data.goals.push_back(
        {"the same, against scalar", "12 times", fmt::format("{} times", Short(times)), times >= 12});
  }
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
         [](const KernelResult& result, Path path) { return result[path].ShortOverLong(); });
}

}  // namespace microlane
