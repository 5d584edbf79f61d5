// The report's page.
#ifndef MICROLANE_BENCH_PAGE_H_
#define MICROLANE_BENCH_PAGE_H_

#include <filesystem>
#include <string>

#include "report_data.h"

namespace microlane {

// One HTML page that needs no other file: the plots are read from `folder` and put inside. Plots that are
// missing are left out.
std::string MakePage(const ReportData& data, const std::filesystem::path& folder);

}  // namespace microlane

#endif  // MICROLANE_BENCH_PAGE_H_
