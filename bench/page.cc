#include "page.h"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <iterator>

#include "command.h"
#include "microlane/kernel_list.h"
#include "plots.h"
#include "tables.h"

namespace microlane {
namespace {

std::string Escaped(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '<') {
      escaped += "&lt;";
    } else if (c == '>') {
      escaped += "&gt;";
    } else if (c == '&') {
      escaped += "&amp;";
    } else if (c == '"') {
      escaped += "&quot;";
    } else {
      escaped += c;
    }
  }
  return escaped;
}

std::string Base64(const std::string& bytes) {
  constexpr const char* kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned value = 0;
    for (std::size_t j = 0; j < 3; ++j) {
      value = value << 8 | (i + j < bytes.size() ? static_cast<unsigned char>(bytes[i + j]) : 0u);
    }
    for (std::size_t j = 0; j < 4; ++j) {
      text += i + j <= bytes.size() ? kDigits[value >> (18 - 6 * j) & 63] : '=';
    }
  }
  return text;
}

std::string Image(const std::filesystem::path& folder, const std::string& base,
                  const std::string& description) {
  std::ifstream file(folder / (base + ".svg"), std::ios::binary);
  if (!file) return "";
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  return fmt::format("<img alt=\"{}\" src=\"data:image/svg+xml;base64,{}\">\n", Escaped(description),
                     Base64(bytes));
}

constexpr const char* kStyle = R"(
body { font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 1500px; margin: 2em auto; padding: 0 1.5em; }
h1 { font-size: 1.7em; } h2 { margin-top: 2.2em; border-bottom: 1px solid #ccc; }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; }
th, td { padding: 2px 8px; text-align: right; border-bottom: 1px solid #eee; white-space: nowrap; }
th { background: #f4f4f4; vertical-align: bottom; }
td:first-child, thead tr:first-child th:first-child { text-align: left; font-family: ui-monospace, monospace; }
tr:hover td { background: #f6faff; }
.bad { color: #b3261e; font-weight: 600; } .good { color: #1b7f3b; font-weight: 600; }
.left td, .left th { text-align: left; }
img { max-width: 100%; height: auto; } .grid { display: grid; grid-template-columns: repeat(auto-fill, minmax(600px, 1fr)); gap: 8px; }
td.text { text-align: left; white-space: normal; min-width: 14em; } small { color: #666; }
p, li { max-width: 70em; } .wide { overflow-x: auto; }
)";

std::string Cell(const std::string& text, const char* kind = "") {
  return *kind == '\0' ? fmt::format("<td>{}</td>", text)
                       : fmt::format("<td class=\"{}\">{}</td>", kind, text);
}

std::string ErrorCell(const PathResult& path, bool has_bound) {
  std::string text = Short(path.max_ulp);
  if (path.nan_count > 0) text += fmt::format(" ({} NaN)", path.nan_count);
  return Cell(text, has_bound && !(path.max_ulp <= path.bound) ? "bad" : "");
}

constexpr Path kTimedPaths[] = {Path::kHigh, Path::kStandard, Path::kFast, Path::kTextbook};

std::string HeaderCells(const std::vector<std::string>& names) {
  std::string html;
  for (const std::string& name : names) html += fmt::format("<th>{}", name);
  return html;
}

std::string TableStart(const std::string& groups, const std::vector<std::string>& names) {
  return fmt::format("<div class=\"wide\"><table><thead><tr>{}</tr><tr>{}</tr></thead><tbody>\n", groups,
                     HeaderCells(names));
}

std::string SpeedTable(const ReportData& data) {
  const bool counted = CanCountOperations();
  std::string html = TableStart(
      "<th rowspan=2>kernel<th colspan=6>ns per lane<th colspan=3>times textbook<th colspan=3>time over "
      "floor<th "
      "colspan=4>per vector, standard",
      {"high", "standard", "fast", "scalar float", "scalar double", "textbook", "high", "standard", "fast",
       "high", "standard", "fast", "divisions", "roots", "instructions", "floor by"});
  for (const KernelResult& result : data.kernels) {
    html += "<tr>" + Cell(std::string(kKernels[result.kernel].id));
    for (const PathResult& path : result.path) html += Cell(Short(path.time().min));
    for (const Path path : kLanePaths) html += Cell(Short(result.Speedup(path)));
    for (const Path path : kLanePaths) {
      html += counted ? Cell(Short(result.OverFloor(path)), result.OverFloor(path) > 1.3 ? "bad" : "")
                      : Cell("-");
    }
    const Floor& floor = result[Path::kStandard].floor;
    html += Cell(counted ? Short(floor.per_vector.Count(Unit::kDivision)) : "-");
    html += Cell(counted ? Short(floor.per_vector.Count(Unit::kRoot)) : "-");
    html += Cell(counted ? fmt::format("{:.0f}", floor.per_vector.all) : "-");
    html += Cell(floor.ns() == floor.memory ? "memory" : floor.ns() == floor.divider ? "divider" : "vector");
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string ErrorTable(const ReportData& data) {
  std::vector<std::string> names(std::begin(kPathNames), std::end(kPathNames));
  names.insert(names.end(), {"high", "standard", "fast", "high", "standard", "fast", "high", "textbook"});
  std::string html = TableStart(
      "<th rowspan=2>kernel<th colspan=6>largest error, ULP<th colspan=3>declared bound<th colspan=3>mean "
      "error, "
      "ULP<th colspan=2>points",
      names);
  for (const KernelResult& result : data.kernels) {
    html += "<tr>" + Cell(std::string(kKernels[result.kernel].id));
    for (std::size_t p = 0; p < kPaths; ++p) html += ErrorCell(result.path[p], p < 3);
    for (const Path path : kLanePaths) html += Cell(BoundText(result[path].bound));
    for (const Path path : kLanePaths) html += Cell(Short(result[path].mean_ulp));
    html += Cell(fmt::format("{}", result[Path::kHigh].points));
    html += Cell(fmt::format("{}", result[Path::kTextbook].points));
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string BatchTable(const ReportData& data, Parameters parameters) {
  const std::size_t u = parameters == Parameters::kPerLane ? 0 : 1;
  std::string groups = "<th rowspan=2>kernel";
  std::vector<std::string> names;
  for (const Path path : kTimedPaths) {
    groups += fmt::format("<th colspan=4>{}", kPathNames[static_cast<std::size_t>(path)]);
    names.insert(names.end(), {"1", "16", "256", "4096"});
  }
  groups += "<th colspan=3>16 over 4096";
  names.insert(names.end(), {"high", "standard", "fast"});
  std::string html = TableStart(groups, names);
  for (const KernelResult& result : data.kernels) {
    if (u == 1 && !HasParameters(result.kernel)) continue;
    html += "<tr>" + Cell(std::string(kKernels[result.kernel].id));
    for (const Path path : kTimedPaths) {
      html += Cell(Short(result[path].latency[u]));
      for (const Timing& time : result[path].batch[u]) html += Cell(Short(time.min));
    }
    for (const Path path : kLanePaths) {
      const double ratio = result[path].batch[u][0].min / result[path].batch[u][kLongBatch].min;
      html += Cell(Short(ratio), ratio > 1.5 && path != Path::kHigh ? "bad" : "");
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string StabilityTable(const ReportData& data) {
  std::string html = TableStart(
      "<th rowspan=2>row<th rowspan=2>cases<th rowspan=2>kernels<th rowspan=2>points<th colspan=5>largest "
      "error "
      "over declared bound<th rowspan=2>NaN, inf<th colspan=2>textbook<th rowspan=2>result",
      {"high", "standard", "fast", "double", "largest in", "error, ULP", "NaN, inf"});
  for (const StabilityRow& row : StabilityRows(data)) {
    html += "<tr>" + Cell(row.row) + Cell(Escaped(row.what), "text") + Cell(fmt::format("{}", row.kernels)) +
            Cell(fmt::format("{}", row.points));
    std::size_t worst = 0;
    for (std::size_t p = 0; p < kStabilityPaths; ++p) {
      if (row.over_bound[p] > row.over_bound[worst]) worst = p;
      html += Cell(Short(row.over_bound[p]), row.over_bound[p] <= 1 ? "" : "bad");
    }
    html += Cell(fmt::format("{}, {}", kKernels[row.worst_kernel[worst]].id, kStabilityNames[worst]));
    html += Cell(fmt::format("{}", row.nan_count), row.nan_count == 0 ? "" : "bad");
    html += Cell(Short(row.textbook.max_ulp)) + Cell(fmt::format("{}", row.textbook.nan_count));
    html += Cell(row.holds ? "pass" : "FAIL", row.holds ? "good" : "bad") + "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string GoalTable(const ReportData& data) {
  std::string html = "<table class=\"left\"><tr><th>figure<th>goal<th>reached</tr>\n";
  for (const Goal& goal : data.goals) {
    html += fmt::format("<tr><td>{}<td>{}<td class=\"{}\">{}</tr>\n", Escaped(goal.what), Escaped(goal.goal),
                        goal.met ? "good" : "bad", Escaped(goal.reached));
  }
  return html + "</table>\n";
}

std::string CavityTable(const ReportData& data) {
  std::string html = "<table><tr><th>V-cavities of";
  for (std::size_t order = 0; order < (data.cavities.empty() ? 0 : data.cavities[0].result.scene.orders);
       ++order) {
    const std::string name = HitsName(data.cavities[0].result.scene, order);
    html += fmt::format("<th>{} {}", name, name == "1" ? "hit" : "hits");
  }
  html += "<th>absorbed<th>lanes, 10<sup>6</sup>/s<th>scalar, 10<sup>6</sup>/s<th>times</tr>\n";
  for (const CavityFigure& figure : data.cavities) {
    const CavityResult& result = figure.result;
    const double paths = static_cast<double>(result.paths);
    html += fmt::format("<tr><td>{}", Escaped(figure.title));
    for (std::size_t order = 0; order < result.scene.orders; ++order) {
      html += Cell(fmt::format("{:.4f}", static_cast<double>(CountOfHits(result, order)) / paths));
    }
    html += Cell(fmt::format("{:.4f}", static_cast<double>(result.totals.absorbed) / paths)) +
            Cell(fmt::format("{:.1f}", figure.speed.lanes * 1e-6)) +
            Cell(fmt::format("{:.2f}", figure.speed.scalar * 1e-6)) +
            Cell(fmt::format("{:.1f}", figure.speed.lanes / figure.speed.scalar)) + "</tr>\n";
  }
  return html + "</table>\n";
}

std::string CeilingTable(const ReportData& data) {
  std::string html = "<table><tr><th>vector";
  for (const char* name : kUnitNames) html += fmt::format("<th>{}", Escaped(name));
  html += "</tr>\n";
  for (std::size_t w = 0; w < kWidths; ++w) {
    for (std::size_t t = 0; t < 2; ++t) {
      const double* ns = data.ceilings.ns[w][t];
      if (ns[0] == 0) continue;
      const char* type = t == 0 ? "float" : "double";
      html += "<tr>" + Cell(w == 0 ? fmt::format("one {}", type)
                                   : fmt::format("{} {}s", kWidthBytes[w] / (t == 0 ? 4 : 8), type));
      for (std::size_t u = 0; u < kUnits; ++u) html += Cell(ns[u] > 0 ? fmt::format("{:.3f}", ns[u]) : "");
      html += "</tr>\n";
    }
  }
  return html + "</table>\n";
}

std::string TargetTable(const ReportData& data) {
  if (data.targets.empty()) return "";
  std::vector<std::string> targets;
  for (const TargetTime& time : data.targets) {
    if (std::find(targets.begin(), targets.end(), time.target) == targets.end()) {
      targets.push_back(time.target);
    }
  }
  std::string html = "<div class=\"wide\"><table><thead><tr><th rowspan=2>kernel";
  for (const std::string& target : targets) html += fmt::format("<th colspan=3>{}", target);
  html += "</tr><tr>";
  for (std::size_t i = 0; i < targets.size(); ++i) html += "<th>high<th>standard<th>fast";
  html += "</tr></thead><tbody>\n";
  for (const KernelResult& result : data.kernels) {
    html += "<tr>" + Cell(std::string(kKernels[result.kernel].id));
    for (const std::string& target : targets) {
      for (const Path path : {Path::kHigh, Path::kStandard, Path::kFast}) {
        for (const TargetTime& time : data.targets) {
          if (time.target == target && time.kernel == result.kernel && time.path == path) {
            html += Cell(Short(time.ns));
          }
        }
      }
    }
    html += "</tr>\n";
  }
  return html + "</tbody></table></div>\n";
}

std::string TablesTable(const ReportData& data) {
  std::string html = TableStart("<th rowspan=2>table<th colspan=2>cost<th colspan=4>largest error",
                                {"bytes", "ms", "albedo, D", "Lambda", "sampling", "of visible normals"});
  for (const auto* const tables : {&data.albedo_tables, &data.radial_tables}) {
    for (const TableCost& cost : *tables) {
      html += "<tr>" + Cell(Escaped(cost.what)) + Cell(fmt::format("{}", cost.bytes)) + Cell(Short(cost.ms)) +
              Cell(fmt::format("{:.1e}", cost.error));
      for (const double error : {cost.masking, cost.sampling, cost.visible}) {
        html += Cell(tables == &data.albedo_tables ? "-" : fmt::format("{:.1e}", error));
      }
      html += "</tr>\n";
    }
  }
  return html + "</tbody></table></div>\n";
}

}  // namespace

std::string MakePage(const ReportData& data, const std::filesystem::path& folder) {
  std::string html = fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>Microlane: error against run "
      "time</title>"
      "<style>{}</style></head><body>\n<h1>Microlane: error against run time</h1>\n"
      "<p>{} kernels. {}. {}. The run took {:.0f} s.</p>\n",
      kStyle, data.kernels.size(), Escaped(Circumstances(data)), Noise(data), data.seconds);
  html += fmt::format(
      "<ul>\n<li><b>high</b>, <b>standard</b>, <b>fast</b>: the three accuracies of the library. <b>scalar "
      "float</b>, <b>scalar double</b>: its readable references. <b>textbook</b>: the code renderers carry "
      "today "
      "(<code>bench/textbook.cc</code>), one lane at a time, -O3 -march=native.</li>\n"
      "<li>Times are the least over repetitions, in nanoseconds per lane of batches of 4096 lanes on one "
      "core, "
      "one roughness and index per lane; directions are on either side of the surface and inside the "
      "lobe.</li>\n"
      "<li>Errors are in units in the last place (ULP) of float against the oracle, the largest over {} "
      "random "
      "points (a tenth for scalar double and textbook), a grid, the extreme cases and a search from the "
      "worst "
      "(alpha 1e-5 to 1e2, cosines 1e-7 to 1, eta 1/4 to 4). A relative error of 2<sup>-11</sup> is 4096 to "
      "8192 ULP. Textbook and "
      "scalar "
      "code declare no bound. A textbook error of 1e40 ULP is a value where 0, or next to it, is "
      "right.</li>\n"
      "<li>The floor is the least time in which this machine can do the operations that the kernel executes: "
      "its "
      "divisions and roots one after the other, or its vector instructions on the ports they share, or its "
      "arrays "
      "loaded and stored, whichever takes longest. Operations are counted by stepping through the code. The "
      "floor "
      "says how well they overlap, not whether fewer would do.</li>\n"
      "<li>Red: a goal of the project missed (time over floor 1.3, 16 over 4096 lanes 1.5), or a declared "
      "bound "
      "broken.</li>\n</ul>\n",
      data.samples);
  html += "<h2>Figures to reach</h2>\n" + GoalTable(data);
  html += Image(folder, kOverviewPlot, "Error of every kernel against its speed");
  html += "<h2>Speed</h2>\n" + SpeedTable(data);
  html += Image(folder, kSpeedPlot, "Speed of every kernel over the textbook code");
  html += Image(folder, kFloorPlot, "Time of every kernel over its floor");
  html += "<h2>Error</h2>\n" + ErrorTable(data);
  html += Image(folder, kErrorPlot, "Largest error of every kernel");
  html +=
      "<h2>Stiff and extreme cases</h2>\n<p>Each row is a failure seen in a renderer, tried with every "
      "kernel it "
      "applies to on this target. A row passes where every result is finite and within its kernel's declared "
      "bound "
      "of the oracle in all four accuracies (<code>stability.csv</code> has each kernel). The textbook "
      "columns are "
      "the same inputs through the textbook code. Rows about lanes, memory, materials and compilers are held "
      "by "
      "<code>tests/run</code> alone.</p>\n" +
      StabilityTable(data);
  html +=
      "<h2>The four glasses</h2>\n<p>Walter 2007 Fig. 12, both fits: the transmission f<sub>t</sub> |cos| "
      "times the fitted "
      "scale, in the plane of incidence, light coming through air at 0, 30, 60 and 80 degrees, with the "
      "paper's separable "
      "Smith G. Lines: high; circles: fast. Below each, the relative difference of the two, the largest of "
      "each degree.</p>\n";
  for (std::size_t f = 0; f < std::size(kFits); f += 2) {
    html +=
        Image(folder, GlassPlot(kFits[f].glass), fmt::format("Transmission of the {} glass", kFits[f].glass));
  }
  html +=
      "<h2>The coupled specular-matte model</h2>\n<p>The figures of Kelemen 2001, by this target. Dotted: "
      "the mirror "
      "directions; each lobe's maximum lies below its own. Fig. 6 shows pictures of a scene; here is what "
      "they differ by. "
      "The total albedo of Fig. 5 is integrated from the values.</p>\n" +
      Image(folder, kLobesPlot, "Specular lobes of Kelemen 2001") +
      Image(folder, kMattePlot, "Matte lobes of Kelemen 2001") +
      Image(folder, kAlbedoPlot, "Albedo curves of Kelemen 2001");
  html +=
      "<h2>Light inside V-cavities</h2>\n<p>Meneveaux 2015 section 3.3: the energy that leaves after one, "
      "two, "
      "three and more facets, and facet hits a second of one core in lanes and scalar. In the plane of "
      "incidence, "
      "the circles are the model without inter-reflection.</p>\n" +
      CavityTable(data);
  for (std::size_t j = 0; j < data.cavities.size(); ++j) {
    html += Image(folder, CavityPlot(j), "Simulated BRDF, " + data.cavities[j].title);
  }
  html +=
      "<h2>Interfaced Lambertian surfaces</h2>\n<p>The figures of Meneveaux 2015, by this target. Fig. 4 "
      "shows "
      "the spectra of "
      "painted samples, which are not at hand; here is what a body of any K<sub>d</sub> gives back of "
      "diffuse "
      "light. Fig. 8: "
      "with the masking of V-cavities, sums over 16384 normals; with Smith's, the rule of order 16; "
      "Beckmann's "
      "and GGX's "
      "alpha is sqrt(2) sigma. Dashed in Fig. 9: Oren and Nayar's qualitative model for the body.</p>\n" +
      Image(folder, kFlatBodyPlot, "Flat interfaced Lambertian surfaces") +
      Image(folder, kRoughBodyPlot, "Rough interfaced Lambertian bodies") +
      Image(folder, kOrenNayarPlot, "Interfaced Lambertian facets against Oren-Nayar");
  html +=
      "<h2>Tables</h2>\n<p>Of albedo: the largest error between entries, against the quadrature that makes "
      "them. Of "
      "slopes that a user gives as f(r): relative errors as the tables state them, of D, of Lambda, and of "
      "the densities "
      "with which normals are sampled.</p>\n" +
      TablesTable(data) +
      Image(folder, kTablesPlot, "Error of tables against their size and the time of making");
  html += "<h2>Error against run time, kernel by kernel</h2>\n<div class=\"grid\">\n";
  for (const KernelResult& result : data.kernels) {
    html += Image(folder, KernelPlot(result.kernel),
                  fmt::format("Error against run time of {}", kKernels[result.kernel].id));
  }
  html +=
      "</div>\n<h2>Batches</h2>\n<p>Nanoseconds per lane in batches of 16, 256 and 4096 lanes, and of one "
      "lane that "
      "waits for the result of the one before (1: the latency), with parameters per lane.</p>\n" +
      BatchTable(data, Parameters::kPerLane) +
      "<p>The same with one value of each parameter for the batch.</p>\n" +
      BatchTable(data, Parameters::kUniform);
  html += "<h2>The machine</h2>\n<p>Nanoseconds per instruction when nothing else runs, target " +
          data.target + ".</p>\n" + CeilingTable(data);
  if (!data.targets.empty()) {
    html += "<h2>The other targets</h2>\n<p>Nanoseconds per lane, 4096 lanes, per-lane parameters.</p>\n" +
            TargetTable(data);
  }
  return html + "</body></html>\n";
}

}  // namespace microlane
