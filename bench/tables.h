// The report's tables: CSV files, the one on the terminal, the README's.
#ifndef MICROLANE_BENCH_TABLES_H_
#define MICROLANE_BENCH_TABLES_H_

#include <filesystem>
#include <string>
#include <vector>

#include "report_data.h"

namespace microlane {

// A row of the stiff and extreme cases over all kernels it applies to.
struct StabilityRow {
  std::string row, what;
  std::size_t kernels = 0;
  std::uint64_t points = 0;
  // Error over bound where it is largest, and the kernel.
  double over_bound[kStabilityPaths] = {};
  std::size_t worst_kernel[kStabilityPaths] = {};
  std::uint64_t nan_count = 0;  // of all four
  TextbookError textbook;
  bool holds = true;
};
std::vector<StabilityRow> StabilityRows(const ReportData& data);

// One line: machine, target, compiler, commit, date; and one about the noise.
std::string Circumstances(const ReportData& data);
std::string Noise(const ReportData& data);

// CSV files and README_table.md into `folder`. Fails if it cannot.
void WriteTables(const ReportData& data, const std::filesystem::path& folder);

void PrintTables(const ReportData& data);

}  // namespace microlane

#endif  // MICROLANE_BENCH_TABLES_H_
