// The report's plots, by gnuplot.
#ifndef MICROLANE_BENCH_PLOTS_H_
#define MICROLANE_BENCH_PLOTS_H_

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>

#include "report_data.h"

namespace microlane {

// Base names, without .svg or .png, within the report's folder.
std::string KernelPlot(std::size_t kernel);
std::string GlassPlot(const std::string& glass);
inline constexpr const char* kOverviewPlot = "plots/overview";
inline constexpr const char* kSpeedPlot = "plots/speed";
inline constexpr const char* kErrorPlot = "plots/error";
inline constexpr const char* kFloorPlot = "plots/floor";
inline constexpr const char* kLobesPlot = "plots/kelemen_lobes";             // Kelemen 2001 Figs. 2, 6
inline constexpr const char* kAlbedoPlot = "plots/kelemen_albedo";           // Figs. 3, 5
inline constexpr const char* kMattePlot = "plots/kelemen_matte";             // Fig. 4
inline constexpr const char* kFlatBodyPlot = "plots/meneveaux_flat";         // Meneveaux 2015 Figs. 4, 5
inline constexpr const char* kRoughBodyPlot = "plots/meneveaux_rough";       // Fig. 8
inline constexpr const char* kOrenNayarPlot = "plots/meneveaux_oren_nayar";  // Fig. 9
std::string CavityPlot(std::size_t figure);
inline constexpr const char* kTablesPlot = "plots/tables";

// Whether there is a gnuplot to run.
bool HasGnuplot();

// Writes every plot as SVG and PNG, with its data and script beside it. `progress` is called before each with
// its place and their number. Empty, or what went wrong.
std::string WritePlots(const ReportData& data, const std::filesystem::path& folder,
                       const std::function<void(std::size_t, std::size_t)>& progress);

}  // namespace microlane

#endif  // MICROLANE_BENCH_PLOTS_H_
