#include "plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <utility>
#include <vector>

#include "microlane/kernel_list.h"

namespace microlane {
namespace {

constexpr const char* kPathColours[kPaths] = {"#1f6fb2", "#2e9e4f", "#e08214",
                                              "#9a9a9a", "#555555", "#c0392b"};
constexpr int kPathMarks[kPaths] = {7, 5, 9, 6, 4, 2};  // gnuplot's point types
constexpr const char* kIncidenceColours[] = {"#1f6fb2", "#2e9e4f", "#e08214", "#c0392b"};
constexpr double kErrorLow = 0.1, kErrorHigh = 1e9;  // errors beyond are drawn on the edge

double Clamped(double ulp) { return std::isnan(ulp) ? kErrorHigh : std::clamp(ulp, kErrorLow, kErrorHigh); }

std::size_t Index(Path path) { return static_cast<std::size_t>(path); }

std::string ErrorAxis(char axis) {
  return fmt::format(
      "set logscale {0}\nset {0}range [{1}:{2}]\n"
      "set {0}tics ('0.1' 0.1, '1' 1, '10' 10, '100' 100, '10^3' 1e3, '10^4' 1e4, '10^5' 1e5, '10^6' 1e6, "
      "'10^7' 1e7, "
      "'' 1e8, '≥10^9' 1e9)\n",
      axis, kErrorLow * 0.6, kErrorHigh * 2);
}

// Tics at powers of ten, and at 2 and 5 times these where there is room.
std::string DecadeTics(char axis, double low, double high) {
  std::string tics;
  const int last = static_cast<int>(std::floor(std::log10(high)));
  for (int exponent = static_cast<int>(std::floor(std::log10(low))); exponent <= last; ++exponent) {
    for (const int step : {1, 2, 5}) {
      if (step > 1 && high > 3000 * low) continue;
      const double at = step * std::pow(10, exponent);
      if (at >= low && at <= high) tics += fmt::format("{}'{:g}' {:g}", tics.empty() ? "" : ", ", at, at);
    }
  }
  return fmt::format("set {}tics ({})\n", axis, tics);
}

struct Range {
  double low = INFINITY, high = 0;
  void Add(double x) {
    if (!(x > 0) || std::isinf(x)) return;
    low = std::min(low, x);
    high = std::max(high, x);
  }
};

std::string LogAxis(char axis, Range range, double margin) {
  if (range.high == 0) range = {1, 1};
  range.low /= margin;
  range.high *= margin;
  return fmt::format("set logscale {0}\nset {0}range [{1:g}:{2:g}]\n", axis, range.low, range.high) +
         DecadeTics(axis, range.low, range.high);
}

std::string KernelScript(const KernelResult& result) {
  std::string script = fmt::format(
      "set title '{}' noenhanced\nset xlabel 'nanoseconds per lane'\nset ylabel 'largest error, ULP'\n"
      "set key outside right top Left reverse\nset grid xtics ytics lt 1 lw 0.5 lc rgb '#dddddd'\n",
      kKernels[result.kernel].id);
  Range range;
  for (const PathResult& path : result.path) range.Add(path.time().min);
  script += LogAxis('x', range, 1.6) + ErrorAxis('y');
  for (const Path path : kLanePaths) {
    script +=
        fmt::format("set arrow from graph 0, first {0:g} to graph 1, first {0:g} nohead dt 3 lc rgb '{1}'\n",
                    result[path].bound, kPathColours[Index(path)]);
  }
  std::string plot;
  for (std::size_t p = 0; p < kPaths; ++p) {
    const PathResult& path = result.path[p];
    script += fmt::format("$p{} << EOD\n{:g} {:g}\nEOD\n", p, path.time().min, Clamped(path.max_ulp));
    plot += fmt::format("{}$p{} using 1:2 with points pt {} ps 1.6 lw 2 lc rgb '{}' title '{}'",
                        p == 0 ? "plot " : ", ", p, kPathMarks[p], kPathColours[p], kPathNames[p]);
  }
  plot += ", NaN with lines dt 3 lc rgb '#555555' title 'declared bounds'";
  return script + plot + "\n";
}

// One row of points for each kernel.
template <class Value>
std::string Rows(const ReportData& data, const std::vector<Path>& paths, const Value& value) {
  std::string tics;
  for (std::size_t i = 0; i < data.kernels.size(); ++i) {
    tics += fmt::format("{}'{}' {}", i == 0 ? "" : ", ", kKernels[data.kernels[i].kernel].id, i);
  }
  std::string script = fmt::format(
      "set ytics ({}) noenhanced font ',10'\nset yrange [{}:-1]\nset grid xtics ytics lt 1 lw 0.5 lc rgb "
      "'#dddddd'\n"
      "set key outside right top Left reverse\n",
      tics, data.kernels.size());
  std::string plot;
  for (const Path path : paths) {
    const std::size_t p = Index(path);
    script += fmt::format("$p{} << EOD\n", p);
    for (std::size_t i = 0; i < data.kernels.size(); ++i) {
      script += fmt::format("{:g} {}\n", value(data.kernels[i], path), i);
    }
    script += "EOD\n";
    plot += fmt::format("{}$p{} using 1:2 with points pt {} ps 1.1 lw 1.5 lc rgb '{}' title '{}'",
                        plot.empty() ? "plot " : ", ", p, kPathMarks[p], kPathColours[p], kPathNames[p]);
  }
  return script + plot;
}

std::string VerticalLine(double x, const char* colour) {
  return fmt::format("set arrow from first {0:g}, graph 0 to first {0:g}, graph 1 nohead dt 2 lc rgb '{1}'\n",
                     x, colour);
}

std::string SpeedScript(const ReportData& data) {
  Range range;
  for (const KernelResult& result : data.kernels) {
    for (std::size_t p = 0; p + 1 < kPaths; ++p) range.Add(result.Speedup(static_cast<Path>(p)));
  }
  return fmt::format("set title 'Times as fast as the textbook code, {}, 4096 lanes, per-lane parameters'\n",
                     data.target) +
         "set xlabel 'textbook ns / ns'\n" + LogAxis('x', range, 1.3) + VerticalLine(1, "#c0392b") +
         Rows(data, {Path::kHigh, Path::kStandard, Path::kFast, Path::kScalarFloat, Path::kScalarDouble},
              [](const KernelResult& result, Path path) { return result.Speedup(path); }) +
         "\n";
}

std::string ErrorScript(const ReportData& data) {
  return fmt::format("set title 'Largest error against the oracle, {}'\nset xlabel 'ULP'\n", data.target) +
         ErrorAxis('x') + VerticalLine(1, kPathColours[0]) + VerticalLine(4, kPathColours[1]) +
         VerticalLine(16, kPathColours[1]) + VerticalLine(4096, kPathColours[2]) +
         Rows(data,
              {Path::kHigh, Path::kStandard, Path::kFast, Path::kScalarFloat, Path::kScalarDouble,
               Path::kTextbook},
              [](const KernelResult& result, Path path) { return Clamped(result[path].max_ulp); }) +
         ", NaN with lines dt 2 lc rgb '#555555' title 'goals: 1, 4 and 16, 4096'\n";
}

// All kernels in one picture.
std::string OverviewScript(const ReportData& data) {
  Range range;
  for (const KernelResult& result : data.kernels) {
    for (const Path path : kLanePaths) range.Add(result.Speedup(path));
  }
  range.Add(1);
  std::string script = fmt::format("set title 'Every kernel: error against speed, {}, one core of {}'\n",
                                   data.target, data.machine) +
                       "set xlabel 'times as fast as the textbook code'\nset ylabel 'largest error, ULP'\n"
                       "set grid xtics ytics lt 1 lw 0.5 lc rgb '#dddddd'\nset key outside right top Left "
                       "reverse\n" +
                       LogAxis('x', range, 1.3) + ErrorAxis('y');
  std::string plot;
  for (const Path path : {Path::kTextbook, Path::kFast, Path::kStandard, Path::kHigh}) {
    const std::size_t p = Index(path);
    script += fmt::format("$p{} << EOD\n", p);
    for (const KernelResult& result : data.kernels) {
      script += fmt::format("{:g} {:g}\n", result.Speedup(path), Clamped(result[path].max_ulp));
    }
    script += "EOD\n";
    plot += fmt::format("{}$p{} using 1:2 with points pt {} ps 0.9 lw 1.5 lc rgb '{}' title '{}'",
                        plot.empty() ? "plot " : ", ", p, kPathMarks[p], kPathColours[p], kPathNames[p]);
  }
  return script + plot + "\n";
}

std::string FloorScript(const ReportData& data) {
  double largest = 2;
  for (const KernelResult& result : data.kernels) {
    for (const Path path : kLanePaths) largest = std::max(largest, result.OverFloor(path));
  }
  return fmt::format("set title 'Time over the floor of the kernel''s own operations, {}'\n", data.target) +
         fmt::format("set xlabel 'ns / floor'\nset xrange [0.8:{:.1f}]\nset xtics 0.2\n", largest + 0.1) +
         VerticalLine(1.3, "#c0392b") +
         Rows(data, {Path::kHigh, Path::kStandard, Path::kFast},
              [](const KernelResult& result, Path path) { return result.OverFloor(path); }) +
         ", NaN with lines dt 2 lc rgb '#c0392b' title 'goal: 1.3'\n";
}

std::string GlassScript(const ReportData& data, const std::string& glass) {
  const bool narrow = glass == "antiglare";
  const double low = narrow ? -10 : -60, high = narrow ? 60 : 90;
  std::string script, curves, differences;
  float alphas[2] = {}, scales[2] = {};
  int count = 0;
  for (const GlassCurve& curve : data.glasses) {
    if (glass != curve.fit.glass) continue;
    const bool ggx = std::string(curve.fit.distribution) == "GGX";
    alphas[ggx] = curve.fit.alpha;
    scales[ggx] = curve.fit.scale;
    const std::size_t incidence = static_cast<std::size_t>(
        std::find(std::begin(kIncidence), std::end(kIncidence), curve.incidence) - std::begin(kIncidence));
    const char* colour = kIncidenceColours[incidence];
    script += fmt::format("$c{} << EOD\n", count);
    const std::size_t step = narrow ? 1 : 2;
    for (std::size_t i = 0; i < curve.angle.size(); i += step) {
      if (curve.angle[i] < low || curve.angle[i] > high) continue;
      script += fmt::format("{:.1f} {:.6g} {:.6g}\n", curve.angle[i], curve.fit.scale * curve.high[i],
                            curve.fit.scale * curve.fast[i]);
    }
    script += fmt::format("EOD\n$d{} << EOD\n", count);
    // The largest of each degree.
    for (std::size_t i = 0; i + 10 <= curve.angle.size(); i += 10) {
      double largest = 0;
      for (std::size_t j = i; j < i + 10; ++j) {
        const double exact = static_cast<double>(curve.high[j]);
        if (exact > 1e-37)
          largest = std::max(largest, std::abs(static_cast<double>(curve.fast[j]) / exact - 1));
      }
      if (largest > 0 && curve.angle[i] >= low && curve.angle[i] <= high) {
        script += fmt::format("{:.1f} {:.3g}\n", curve.angle[i] + 0.45, largest);
      }
    }
    script += "EOD\n";
    const char* dash = ggx ? "1" : "(9,5)";
    curves += fmt::format("{}$c{} using 1:2 with lines lw 2 dt {} lc rgb '{}' title '{} {}°'",
                          count == 0 ? "plot " : ", ", count, dash, colour, curve.fit.distribution,
                          curve.incidence);
    curves += fmt::format(", $c{} using 1:3 every {} with points pt 6 ps 0.5 lc rgb '{}' notitle", count,
                          narrow ? 4 : 25, colour);
    differences += fmt::format("{}$d{} using 1:2 with lines lw 1.3 dt {} lc rgb '{}' notitle",
                               count == 0 ? "plot " : ", ", count, dash, colour);
    ++count;
  }
  curves += ", NaN with points pt 6 ps 0.5 lc rgb '#555555' title 'fast'";
  curves += ", NaN with lines dt 3 lc rgb '#555555' title 'Snell'";
  differences += ", 2**-11 with lines dt 2 lc rgb '#555555' title '2^{-11}'";
  std::string snell;
  for (std::size_t k = 0; k < 4; ++k) {
    const double degree = 3.14159265358979323846 / 180;
    const double angle =
        std::asin(std::sin(kIncidence[k] * degree) / static_cast<double>(kGlassEta)) / degree;
    snell += fmt::format(
        "set arrow from first {0:.3f}, graph 0 to first {0:.3f}, graph 1 nohead dt 3 lc rgb '{1}'\n", angle,
        kIncidenceColours[k]);
  }
  return script +
         fmt::format(
             "set multiplot\nset lmargin at screen 0.1\nset rmargin at screen 0.81\nset xrange [{}:{}]\n"
             "set grid xtics ytics lt 1 lw 0.5 lc rgb '#dddddd'\nset key at screen 0.99, screen 0.93 right "
             "top Left reverse\n"
             "set tmargin at screen 0.93\nset bmargin at screen 0.44\n"
             "set title '{} glass, Walter 2007 Fig. 12. Beckmann: alpha {}, scale {}. GGX: alpha {}, scale "
             "{}'\n"
             "set ylabel 'scale f_t |cos {{/Symbol q}}_o|, 1/sr'\nset format x ''\nset yrange [0:*]\n{}{}\n"
             "unset arrow\nunset title\nset tmargin at screen 0.41\nset bmargin at screen 0.09\nset format x "
             "'%g'\n"
             "set xlabel 'transmitted angle, degrees'\nset ylabel '|fast / high - 1|'\nset logscale y\n"
             "set format y '10^{{%T}}'\nset yrange [1e-7:2e-3]\nset key at screen 0.99, screen 0.41 right "
             "top Left reverse\n"
             "{}\nunset multiplot\n",
             low, high, glass, alphas[0], scales[0], alphas[1], scales[1], snell, curves, differences);
}

// `curves` as data, of names that begin with `name`, and a plot of them.
std::string CurvesScript(const std::vector<Curve>& curves, const std::string& name) {
  std::string script, plot;
  int count = 0;
  for (const Curve& curve : curves) {
    script += fmt::format("${}{} << EOD\n", name, count);
    for (std::size_t i = 0; i < curve.x.size(); ++i)
      script += fmt::format("{:.6g} {:.6g}\n", curve.x[i], curve.y[i]);
    script += "EOD\n";
    plot += fmt::format("{}${}{} using 1:2 with lines lw 2 dt {} lc rgb '{}' title '{}'",
                        count == 0 ? "plot " : ", ", name, count, curve.dashed ? "(9,5)" : "1",
                        kIncidenceColours[curve.colour], curve.title);
    ++count;
  }
  return script + plot + "\n";
}

// Lobes to equal scales, with the mirror directions of those of 22.5, 45 and 67.5 degrees.
std::string PolarScript(const std::string& title, const std::vector<Curve>& curves, const std::string& name) {
  double width = 0, height = 0;
  for (const Curve& curve : curves) {
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      width = std::max(width, std::abs(curve.x[i]));
      height = std::max(height, 1.05 * curve.y[i]);
    }
  }
  std::string script = fmt::format(
      "set title '{}'\nset size ratio -1\nset grid xtics ytics lt 1 lw 0.5 lc rgb '#dddddd'\nset key top "
      "left Left "
      "reverse\nset xlabel 'along the surface'\nset ylabel 'along the normal'\nset yrange [0:{:g}]\n",
      title, height);
  for (int k = 0; k < 3; ++k) {
    const double angle = 22.5 * (k + 1) * 3.14159265358979323846 / 180;
    const double reach = std::min(width / std::sin(angle), height / std::cos(angle));
    script += fmt::format("set arrow from 0, 0 to {:.5g}, {:.5g} nohead dt 3 lc rgb '{}'\n",
                          reach * std::sin(angle), reach * std::cos(angle), kIncidenceColours[k]);
  }
  return script + CurvesScript(curves, name) + "unset arrow\nset size noratio\n";
}

std::string SideBySide(const std::string& left, const std::string& right) {
  return "set multiplot layout 1, 2\n" + left + right + "unset multiplot\n";
}

std::string LobesScript(const KelemenFigures& figures) {
  return SideBySide(PolarScript("Fig. 2: radiance of the specular lobe, F = 1, m = 0.1", figures.lobes, "l"),
                    "set title 'Fig. 6: Cook-Torrance and Eq. 3, n = 1.7, m = 0.3'\nset grid xtics ytics lt "
                    "1 lw 0.5 lc rgb "
                    "'#dddddd'\nset key top left Left reverse\nset xlabel 'degrees from the normal'\nset "
                    "ylabel 'radiance'\n"
                    "set xrange [-90:90]\nset logscale y\nset yrange [1e-5:100]\nset format y '10^{%T}'\n" +
                        CurvesScript(figures.cook_torrance, "c"));
}

std::string MatteScript(const KelemenFigures& figures) {
  return SideBySide(PolarScript("Fig. 4: the matte BRDF, n = 1.7, m = 0.8", figures.matte, "b"),
                    PolarScript("Fig. 4: the radiance it reflects", figures.matte_radiance, "r"));
}

std::string AlbedoScript(const KelemenFigures& figures) {
  const auto degrees = [](const std::string& title) {
    return fmt::format(
        "set title '{}'\nset grid xtics ytics lt 1 lw 0.5 lc rgb '#dddddd'\nset key bottom left Left "
        "reverse\nset "
        "xlabel 'degrees from the normal'\nset ylabel 'albedo'\nset xrange [0:90]\nset yrange [0:1.05]\n",
        title);
  };
  return SideBySide(
      degrees("Fig. 3: albedo of the specular lobe, F = 1") + CurvesScript(figures.albedos, "a"),
      degrees("Fig. 5: coupled, k = 1, n = 1.7, m = 0.8") + CurvesScript(figures.coupled, "s"));
}

// Curves over degrees of the plane of incidence, of values from `low` to `high`; logarithmic where low > 0.
std::string PlaneScript(const std::string& title, const std::string& value, double low, double high,
                        const std::vector<Curve>& curves, const std::string& name) {
  return fmt::format(
             "set title '{}'\nset grid xtics ytics lt 1 lw 0.5 lc rgb '#dddddd'\nset key top left Left "
             "reverse\nset xlabel 'degrees from the normal, light from -60'\nset ylabel '{}'\nset xrange "
             "[-90:90]\nset xtics 30\n{}set yrange [{:g}:{:g}]\n",
             title, value, low > 0 ? "set logscale y\n" : "unset logscale\n", low, high) +
         CurvesScript(curves, name);
}

std::string FlatBodyScript(const MeneveauxFigures& figures) {
  return SideBySide(
      "set title 'For Fig. 4: the body of a flat surface'\nset grid xtics ytics lt 1 lw 0.5 lc rgb "
      "'#dddddd'\nset key top left Left reverse\nset xlabel 'K_d'\nset ylabel 'R_b'\nset xrange "
      "[0:1]\nset yrange [0:1]\n" +
          CurvesScript(figures.albedos, "a"),
      PlaneScript("Fig. 5: flat, K_d = 0.6", "f, 1/sr", 0, 0.25, figures.flat, "f"));
}

std::string RoughBodyScript(const MeneveauxFigures& figures) {
  const char* const title = "Fig. 8: bodies of n = {}, K_d = 0.6, sigma = 0.4";
  return SideBySide(
      PlaneScript(fmt::format(fmt::runtime(title), 1.1), "f, 1/sr", 0.01, 1, figures.rough[0], "r"),
      PlaneScript(fmt::format(fmt::runtime(title), 1.5), "f, 1/sr", 0.01, 1, figures.rough[1], "s"));
}

std::string OrenNayarScript(const MeneveauxFigures& figures) {
  return PlaneScript("Fig. 9: K_d = 0.6, n = 1.5, Gaussian of the angle, V-cavities", "f, 1/sr", 0.02, 20,
                     figures.oren_nayar, "o");
}

// Error over size and over the time of making, of both kinds of tables.
std::string TablesScript(const ReportData& data) {
  std::string script;
  Range kib, ms;
  for (const auto* const tables : {&data.albedo_tables, &data.radial_tables}) {
    const bool albedo = tables == &data.albedo_tables;
    script += fmt::format("${} << EOD\n", albedo ? "albedo" : "radial");
    for (const TableCost& cost : *tables) {
      const double size = static_cast<double>(cost.bytes) / 1024;
      kib.Add(size);
      ms.Add(cost.ms);
      script += fmt::format("{:g} {:g} {:g}\n", size, cost.ms, std::max(cost.error, 1e-9));
    }
    script += "EOD\n";
  }
  const auto panel = [&](const char* axis, const Range& range, int column, double goal) {
    return fmt::format("set xlabel '{}'\n", axis) + LogAxis('x', range, 1.6) +
           "set logscale y\nset yrange [5e-10:1e-3]\nset format y '10^{%T}'\nset ylabel 'largest error'\n"
           "set grid xtics ytics lt 1 lw 0.5 lc rgb '#dddddd'\nset key bottom left Left reverse\n"
           "set arrow 1 from graph 0, first 1e-4 to graph 1, first 1e-4 nohead dt 3 lc rgb '#1f6fb2'\n" +
           fmt::format(
               "set arrow 2 from first {0:g}, graph 0 to first {0:g}, graph 1 nohead dt 3 lc rgb '#1f6fb2'\n",
               goal) +
           fmt::format(
               "plot $albedo using {0}:3 with points pt 7 ps 1.2 lc rgb '#1f6fb2' title 'albedo', $radial "
               "using {0}:3 with points pt 9 ps 1.4 lc rgb '#e08214' title 'slopes: D', NaN with lines dt 3 "
               "lc "
               "rgb '#1f6fb2' title 'goals of albedo'\n",
               column);
  };
  return script + SideBySide(panel("size, KiB", kib, 1, 16), panel("making, milliseconds", ms, 2, 5));
}

// Runs `script` once for each of the two formats.
std::string Draw(const std::filesystem::path& folder, const std::string& base, int width, int height,
                 const std::string& script) {
  const std::string path = (folder / base).string();
  std::ofstream file(path + ".gp");
  file << "# Drawn by `microlane report`; run `gnuplot` on it from the folder above.\nset encoding utf8\n"
       << "set terminal push\n"
       << fmt::format("set terminal svg size {},{} dynamic font 'sans-serif,13' background '#ffffff'\n",
                      width, height)
       << fmt::format("set output '{}.svg'\n", base) << script
       << fmt::format("reset\nset encoding utf8\nset terminal pngcairo size {},{} font 'sans-serif,11'\n",
                      width, height)
       << fmt::format("set output '{}.png'\n", base) << script << "set output\n";
  file.close();
  if (!file) return fmt::format("cannot write {}.gp", path);
  const std::string command = fmt::format("cd '{}' && gnuplot '{}.gp' 2>&1", folder.string(), base);
  std::FILE* const pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return "cannot run gnuplot";
  std::string output;
  char text[256];
  while (std::fgets(text, sizeof text, pipe) != nullptr) output += text;
  if (pclose(pipe) != 0) return fmt::format("gnuplot {}.gp: {}", path, output);
  return "";
}

}  // namespace

std::string KernelPlot(std::size_t kernel) {
  std::string name(kKernels[kernel].id);
  std::replace(name.begin(), name.end(), '.', '_');
  return "plots/kernel_" + name;
}

std::string GlassPlot(const std::string& glass) { return "plots/glass_" + glass; }

std::string CavityPlot(std::size_t figure) { return fmt::format("plots/cavities_{}", figure + 1); }

bool HasGnuplot() { return std::system("gnuplot --version > /dev/null 2>&1") == 0; }

std::string WritePlots(const ReportData& data, const std::filesystem::path& folder,
                       const std::function<void(std::size_t, std::size_t)>& progress) {
  const int rows = 130 + 17 * static_cast<int>(data.kernels.size());
  std::vector<std::pair<std::string, std::string>> plots;  // base name and script
  plots.emplace_back(kSpeedPlot, SpeedScript(data));
  plots.emplace_back(kErrorPlot, ErrorScript(data));
  plots.emplace_back(kFloorPlot, FloorScript(data));
  const std::size_t overviews = plots.size();
  plots.emplace_back(kOverviewPlot, OverviewScript(data));
  for (std::size_t f = 0; f < std::size(kFits); f += 2) {
    plots.emplace_back(GlassPlot(kFits[f].glass), GlassScript(data, kFits[f].glass));
  }
  const std::size_t pairs = plots.size();
  plots.emplace_back(kLobesPlot, LobesScript(data.kelemen));
  plots.emplace_back(kMattePlot, MatteScript(data.kelemen));
  plots.emplace_back(kAlbedoPlot, AlbedoScript(data.kelemen));
  plots.emplace_back(kFlatBodyPlot, FlatBodyScript(data.meneveaux));
  plots.emplace_back(kRoughBodyPlot, RoughBodyScript(data.meneveaux));
  plots.emplace_back(kOrenNayarPlot, OrenNayarScript(data.meneveaux));
  plots.emplace_back(kTablesPlot, TablesScript(data));
  for (std::size_t j = 0; j < data.cavities.size(); ++j) {
    const CavityFigure& figure = data.cavities[j];
    plots.emplace_back(CavityPlot(j), CavityScript(figure.result, figure.title, figure.ggx));
  }
  const std::size_t wide = plots.size();
  for (const KernelResult& result : data.kernels) {
    plots.emplace_back(KernelPlot(result.kernel), KernelScript(result));
  }
  for (std::size_t i = 0; i < plots.size(); ++i) {
    progress(i, plots.size());
    const int width = i < overviews ? 1150 : i < wide ? 1000 : 620;
    const int height = i < overviews ? rows : i == overviews ? 440 : i < pairs ? 760 : i < wide ? 420 : 340;
    const std::string error = Draw(folder, plots[i].first, width, height, plots[i].second);
    if (!error.empty()) return error;
  }
  return "";
}

}  // namespace microlane
