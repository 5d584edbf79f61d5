// The subcommands of `microlane`, and what they share.
#ifndef MICROLANE_BENCH_COMMAND_H_
#define MICROLANE_BENCH_COMMAND_H_

#include <CLI/CLI.hpp>
#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "microlane/packets.h"

namespace microlane {

inline constexpr int kFailure = 2;      // exit code of any error
inline constexpr int kBoundBroken = 1;  // exit code of `accuracy` when a bound does not hold

// Each adds a subcommand, which sets `exit_code` where it is not 0.
void AddList(CLI::App& app);
void AddEval(CLI::App& app);
void AddAccuracy(CLI::App& app, int& exit_code);
void AddBench(CLI::App& app);
void AddQuadrature(CLI::App& app);
void AddCavities(CLI::App& app, int& exit_code);
void AddTables(CLI::App& app);
void AddReport(CLI::App& app);

// One line on standard error; ends the program with kFailure.
[[noreturn]] void Fail(std::string_view message);

// Names the subcommands; `given` stands where one is expected.
[[noreturn]] void FailWithoutCommand(const CLI::App& app, std::string_view given);

// Makes batch calls use `target` ("": as chosen). Fails with the library's message, followed by `others`, if
// there is no such target, or if the environment variable MICROLANE_TARGET names none.
void UseTarget(const std::string& target, std::string_view others = "");

inline constexpr Accuracy kAccuracies[] = {Accuracy::kHigh, Accuracy::kStandard, Accuracy::kFast};
std::string_view Name(Accuracy accuracy);

// Fails for any other name.
Accuracy ParseAccuracy(std::string_view name);

// Kernels by their ids, or by their families ("ggx"); all if there are none. Fails for an unknown one.
std::vector<std::size_t> SelectKernels(const std::vector<std::string>& ids);

// For numbers that count something.
std::string RefuseNegative(const std::string& text);

// A count or a time for a table: three significant digits, 6 characters or fewer where it can be.
std::string Short(double value);

// A declared bound: powers of two that have many digits as such.
std::string BoundText(double bound);

}  // namespace microlane

#endif  // MICROLANE_BENCH_COMMAND_H_
