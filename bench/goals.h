// The figures to reach, beside those reached.
#ifndef MICROLANE_BENCH_GOALS_H_
#define MICROLANE_BENCH_GOALS_H_

#include "report_data.h"

namespace microlane {

// Fills data.goals from the rest.
void SetGoals(ReportData& data);

}  // namespace microlane

#endif  // MICROLANE_BENCH_GOALS_H_
